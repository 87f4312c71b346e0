//! The schemes and their properties; no other file compares schemes.

use super::tableau::{ESDIRK4, TR_BDF2, Tableau};

/// The method of a step. The family is closed: a new scheme does not compile until every property
/// is defined.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scheme {
    /// The paper's displacement-based step at a fixed time step.
    Dda,
    /// TR-BDF2 with error control; the default.
    #[default]
    Adaptive,
    /// The same law with the fourth-order tableau and a tight tolerance.
    Reference,
    /// Rigid limit: impact map and velocity stepping.
    Rigid,
}

impl Scheme {
    /// The scheme that stands in for an exact solution of the same model where there is no closed form: the fourth-order
    /// one with springs, the rigid limit itself without.
    #[must_use]
    pub const fn finest(self) -> Self {
        if self.has_springs() { Self::Reference } else { Self::Rigid }
    }

    /// The scheme that is the limit of stiff springs of the same law.
    #[must_use]
    pub const fn limit(self) -> Self {
        if self.has_springs() { Self::Rigid } else { self }
    }

    /// Its name in scene files and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dda => "dda",
            Self::Adaptive => "adaptive",
            Self::Reference => "reference",
            Self::Rigid => "rigid",
        }
    }

    /// Work limit of one rock: steps, accepted or not, and flights. A minute of fall takes a few
    /// thousand, with the
    /// paper's fixed step of 1e-5 s six million.
    pub const fn most_work(self) -> u64 {
        if self.has_fixed_step() { 20_000_000 } else { 5_000_000 }
    }

    /// Whether contacts have springs; the rigid limit has none.
    pub const fn has_springs(self) -> bool {
        !matches!(self, Self::Rigid)
    }

    /// Whether heaps of many rocks continue in the rigid limit: only where the springs serve
    /// accuracy and not as a reference for others.
    pub const fn leaves_heaps_rigid(self) -> bool {
        matches!(self, Self::Adaptive)
    }

    /// Whether its steps are fixed, however large their error.
    pub const fn has_fixed_step(self) -> bool {
        matches!(self, Self::Dda)
    }

    /// Whether it controls the local error of every step: all with a tableau do.
    pub const fn controls_error(self) -> bool {
        self.tableau().is_some()
    }

    /// Unit of its fineness: the tolerance where it controls the error, else the step.
    pub const fn fineness_unit(self) -> &'static str {
        if self.controls_error() { "m/s" } else { "s" }
    }

    /// Order of its error in the step length without switching (–). The rigid limit evaluates
    /// geometry and velocities in the middle of the step; it is first order over a step in which
    /// sliding turns into rolling or a rock lifts off.
    pub const fn order(self) -> f64 {
        match self {
            Self::Dda => 1.0,
            Self::Adaptive | Self::Rigid => 2.0,
            Self::Reference => 4.0,
        }
    }

    /// The tableau of its stages, if it has stages.
    pub const fn tableau(self) -> Option<&'static Tableau> {
        match self {
            Self::Adaptive => Some(&TR_BDF2),
            Self::Reference => Some(&ESDIRK4),
            Self::Dda | Self::Rigid => None,
        }
    }

    /// All of them, the paper's first.
    pub const ALL: [Self; 4] = [Self::Dda, Self::Adaptive, Self::Reference, Self::Rigid];

    /// Its entry in a table of `dda`, `adaptive`, `reference` and `rigid`. A further scheme uses
    /// the entry of the scheme that it resembles, so that no table needs another column.
    pub fn of<T: Copy>(self, [dda, adaptive, reference, rigid]: [T; 4]) -> T {
        match self {
            Self::Dda => dda,
            Self::Adaptive => adaptive,
            Self::Reference => reference,
            Self::Rigid => rigid,
        }
    }
}

//! What a step of an island did.

use crate::rock::Vec3;
use crate::solver::loss::Loss;

/// Energy that a rock gives away through its contacts with other rocks (J), or power (W).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Given {
    /// Its half of what those contacts take.
    pub lost: f64,
    /// Handed on to the other rocks, negative if received.
    pub passed_on: f64,
}

impl Given {
    /// Of the two ends of a contact, from the work that each does on it.
    ///
    /// `lost` is half of the sum for each; what is left is equal and opposite, so that `passed_on`
    /// adds up to 0 over a world.
    pub(super) fn of_ends([a, b]: [f64; 2]) -> [Self; 2] {
        let lost = 0.5 * (a + b);
        [Self { lost, passed_on: a - lost }, Self { lost, passed_on: b - lost }]
    }

    /// Adds `other` times `factor`.
    pub(super) fn add(&mut self, other: &Self, factor: f64) {
        self.lost += factor * other.lost;
        self.passed_on += factor * other.passed_on;
    }

    /// All of it.
    pub fn sum(&self) -> f64 {
        self.lost + self.passed_on
    }
}

/// What one step did.
#[derive(Debug, Clone, Default)]
pub struct Done {
    /// Time gone (s).
    pub dt: f64,
    /// Energy lost to the ground, for each rock (J).
    pub losses: Vec<Loss>,
    /// Energy given to other rocks, for each rock (J).
    pub given: Vec<Given>,
    /// Steps tried and thrown away.
    pub rejected: u64,
    /// Impacts on the mesh (`rigid`; with the others the memory of a contact tells).
    pub hits: Vec<Hit>,
    /// Whether contact states did not settle (`dda`, `rigid`).
    pub unsettled: bool,
    /// Bonds that broke.
    pub broken: u64,
}

/// An impact on the mesh.
#[derive(Debug, Clone, Copy)]
pub struct Hit {
    /// The rock, as a place in the island.
    pub rock: usize,
    /// Normal of the patch there.
    pub normal: Vec3,
    /// Speed of approach along it (m/s).
    pub approach_m_s: f64,
    /// Point that is touched (m).
    pub point_m: Vec3,
    /// Where on the mesh.
    pub feature: crate::contact::FeatureKind,
    /// Triangle whose ground answers.
    pub triangle: u32,
}

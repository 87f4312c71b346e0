//! One implicit step of a rock in contact.

pub(crate) mod block;
pub mod step_control;
mod plane_impact;
pub mod dda;
pub(crate) mod explicit_impact;
pub(crate) mod plane_kernel;
pub mod contact_state;
pub(crate) mod impact;
pub mod island;
pub(crate) mod multi_contact;
pub mod law;
pub mod rigid;
pub(crate) mod friction_rolling;
pub mod stage;
pub mod tableau;
pub mod environment;

use contact_state::{ContactEnvironment, ContactState};
use step_control::{Advance, Control, StepError};
use tableau::{ESDIRK4, TR_BDF2};

/// How a step is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scheme {
    /// The paper's displacement-based step at a fixed time step.
    Dda,
    /// TR-BDF2 with error control; the default.
    Adaptive,
    /// The same law with the fourth-order tableau and a tight tolerance.
    Reference,
    /// Rigid limit: impact map and velocity stepping.
    Rigid,
}

impl Scheme {
    /// Its name in scene files and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dda => "dda",
            Self::Adaptive => "adaptive",
            Self::Reference => "reference",
            Self::Rigid => "rigid",
        }
    }

    /// Budget of work of one rock: steps, accepted or not, and flights. A minute of fall takes a few thousand, with the
    /// paper's fixed step of 1e-5 s six million.
    pub const fn most_work(self) -> u64 {
        match self {
            Self::Dda => 20_000_000,
            Self::Adaptive | Self::Reference | Self::Rigid => 5_000_000,
        }
    }
}

/// Settings of the step, all in force (defaults already filled in by the plan).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Scheme in force.
    pub scheme: Scheme,
    /// Local error allowed per step (m/s); `adaptive` and `reference`.
    pub tolerance_m_s: f64,
    /// Fixed step of `dda`, largest step of `rigid` (s).
    pub step_s: f64,
    /// `dda`: whether the shear spring remembers its stretch (false = as printed in the paper).
    pub shear_memory: bool,
    /// Whether an impact on one plane is followed as a whole; if not, step by step like any other (`adaptive`, `reference`).
    pub plane_impacts: bool,
    /// Impacts slower than this do not rebound (m/s); `None` = the speed that numerics and ground ask for.
    pub capture_speed_m_s: Option<f64>,
}

/// The stepping of one contact episode.
#[derive(Debug)]
pub enum Stepper {
    /// `adaptive` and `reference`, with the step to try next (s).
    Controlled(Control, f64),
    /// `rigid`, with the longest step (s).
    Rigid(f64),
    /// `dda`.
    Dda(dda::Fixed),
}

impl Stepper {
    /// Begins an episode.
    pub fn new(settings: &Settings, world: &ContactEnvironment, state: &mut ContactState) -> Self {
        let tableau = match settings.scheme {
            Scheme::Rigid => return Self::Rigid(settings.step_s),
            Scheme::Reference => &ESDIRK4,
            Scheme::Dda => return Self::Dda(dda::Fixed::new(settings, world, state)),
            Scheme::Adaptive => &TR_BDF2,
        };
        let control = Control::new(tableau, settings, world);
        Self::Controlled(control, step_control::first_step(world, state))
    }
}

/// One step of at most `h_max` (s).
///
/// # Errors
/// [`StepError`] if no step, however short, settles.
pub fn advance(
    stepper: &mut Stepper,
    world: &ContactEnvironment,
    state: &mut ContactState,
    h_max: f64,
) -> Result<Advance, StepError> {
    match stepper {
        Stepper::Controlled(control, h) => step_control::advance(world, control, state, h, h_max),
        Stepper::Dda(fixed) => fixed.advance(world, state, h_max),
        Stepper::Rigid(longest) => rigid::advance(world, state, *longest, h_max),
    }
}

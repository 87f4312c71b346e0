//! One implicit step of a rock in contact.
//!
//! Four schemes, one law. They share contact detection (`contact`), the law of `law.rs`, and states
//! and contact histories (`contact_state.rs`).
//!
//! ```text
//! dda        Newmark β = 1/2, γ = 1 at a fixed step, open–close iteration             dda, dda_system
//! adaptive   TR-BDF2, order 2, error control; impacts by an explicit pair 5(4)        step_control, stage, impact
//! reference  the same law with ESDIRK4(3), order 4, and a tight tolerance             the same files
//! rigid      limit p_N → ∞: impacts at an instant, sustained contact in velocities    rigid, impact/rigid_limit
//! ```
//!
//! One plane has kernels of its own (`plane_kernel`, `plane_impact`): the same sums over fewer
//! numbers. Rocks that touch each other are solved together (`island`); non-spherical blocks have
//! their own step (`block`).

pub(crate) mod block;
pub mod body;
pub mod loss;
pub mod step_control;
mod ground_change;
mod plane_ahead;
mod plane_impact;
pub mod dda;
pub(crate) mod dda_system;
mod block_factor;
mod impact_progress;
pub(crate) mod plane_state;
mod stem_load;
mod joint_blow;
pub(crate) mod explicit_impact;
pub(crate) mod plane_kernel;
pub mod contact_state;
pub(crate) mod impact;
pub mod island;
pub(crate) mod multi_contact;
pub mod law;
mod linear_forces;
pub mod scheme;
pub mod rigid;
mod contact_frame;
pub(crate) mod friction_rolling;
pub mod stage;
pub mod tableau;
pub mod environment;
mod springs;
pub mod impact_point;
pub(crate) mod stems;
pub(crate) mod roughness;
mod facet_motion;
pub(crate) mod scar;
pub(crate) mod slip;
pub(crate) mod yielding;

use contact_state::{ContactEnvironment, ContactState};
pub use scheme::Scheme;
use step_control::{Advance, Control, StepError};

/// The usual longest step of the scheme `rigid` (s).
pub const RIGID_STEP_S: f64 = 0.01;

/// Most rocks in sustained contact with each other that still have springs, where heaps continue in
/// the rigid limit.
pub(crate) const MOST_WITH_SPRINGS: usize = 8;

/// A block in the rigid limit misses contacts by no more than this in a step (–, relative to `√(g
/// R)`) …
const MISSED: f64 = 0.1;
/// … and from this share of it on a blow is distinguished from such a miss (–).
const TOLD: f64 = 0.1;

/// The usual [`Settings::corner_way`] (–).
pub const CORNER_WAY: f64 = 0.3;

/// Settings of the step in force (defaults already filled in by the plan).
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
    /// Whether impacts have kernels of their own: those of spheres on one plane are solved as a
    /// whole, those of blocks by explicit stages. If not, they are stepped like any other contact,
    /// blocks by implicit stages (`adaptive`, `reference`).
    pub impact_kernels: bool,
    /// Whether heaps of many touching rocks continue in the rigid limit (`adaptive`, without
    /// bonds).
    pub rigid_heaps: bool,
    /// Blocks: longest travel of a corner in one step over the radius of its rounding (–); a block
    /// rotates no further than a tenth of it (rad). In the rigid limit three times as much while
    /// every corner slides on one triangle.
    pub corner_way: f64,
    /// Impacts slower than this do not rebound (m/s); `None` = the speed that numerics and ground
    /// require.
    pub capture_speed_m_s: Option<f64>,
}

impl Settings {
    /// Error of a speed (m/s): a rebound slower than half of it is meaningless. Blocks in the rigid
    /// limit, of `block_radius_m` (m), miss contacts for a step; the speed that they gain meanwhile
    /// becomes an impact, which must not rebound again and again: twice a share of the change by
    /// gravity in the longest step. Blocks so small that they take shorter steps miss contacts by a
    /// small part of `√(g R)`.
    pub fn speed_error_m_s(&self, gravity_m_s2: f64, block_radius_m: Option<f64>) -> f64 {
        let radius_m = block_radius_m.filter(|_| !self.scheme.has_springs()).unwrap_or(0.0);
        let missed_m_s = MISSED * (gravity_m_s2 * radius_m).sqrt();
        self.tolerance_m_s.max(2.0 * TOLD * missed_m_s.min(gravity_m_s2 * self.step_s))
    }

    /// These settings in the limit of stiff springs, with its usual longest step.
    #[must_use]
    pub const fn in_rigid_limit(self) -> Self {
        Self { scheme: self.scheme.limit(), step_s: RIGID_STEP_S, ..self }
    }
}

/// The stepping method within one contact episode, made anew for each: after a flight, however
/// short, no step size is worth keeping.
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
        let Some(tableau) = settings.scheme.tableau() else {
            return if settings.scheme.has_springs() {
                Self::Dda(dda::Fixed::new(settings, world, state))
            } else {
                Self::Rigid(settings.step_s)
            };
        };
        let control = Control::new(tableau, settings, world);
        Self::Controlled(control, step_control::first_step(world, state))
    }
}

/// One step of at most `h_max` (s).
///
/// # Errors
/// [`StepError`] if no step, however short, settles.
///
/// Length, losses and effort come back as an [`Advance`]; position, velocity, spin and contact
/// histories are in `state`.
pub fn advance(
    stepper: &mut Stepper,
    world: &ContactEnvironment,
    state: &mut ContactState,
    h_max: f64,
) -> Result<Advance, StepError> {
    match stepper {
        Stepper::Controlled(control, h) => {
            let raised = state.lift_onto_stiffer(world);
            let mut done = step_control::advance(world, control, state, h, h_max)?;
            if let Some(loss) = raised {
                done.loss.add(&loss, 1.0);
            }
            Ok(done)
        }
        Stepper::Dda(fixed) => fixed.advance(world, state, h_max),
        Stepper::Rigid(longest) => rigid::advance(world, state, *longest, h_max),
    }
}

//! Impacts integrated in their own time `τ = ω t`, `ω = √(p_N/m)`, in which nothing is stiff.
//!
//! The law is the one of `law.rs`, with all three elements: normal force `max(0, p_N x + c_N x')`,
//! and shear and rolling, each a slider in series with (spring ∥ dashpot). An element without
//! dashpot or friction is left out. Only mass, inertia and radius of [`Body`](super::body::Body)
//! enter.
//!
//! **One plane, with weight** (schemes `adaptive` and `reference`):
//!
//! ```text
//! let plane = Plane::new(&body, law, 1e-4);          // once for a rock and a ground; 1e-10 for `reference`
//! let passage = plane.passage(&n, &v, depth_m)?;     // 0 at the first touch; None: gravity keeps it, step on from there
//! let out = plane.pass(&passage, (&v, &w), &pressed); // time, shift, velocity, spin, losses where penetration is 0 again
//! let first = plane.part(&passage, 0.5);             // the first half of the time alone
//! ```
//!
//! The normal motion is a closed form (`normal_motion.rs`). Slip, spin and springs are integrated
//! by an explicit pair of order 5(4) under the known normal force (`dormand_prince.rs`,
//! `integrate.rs`, `sliders.rs`); steps end where an element begins to slip or to stick.
//! `tolerance` is relative to `|v|`: at 1e-4 errors stay within about the tolerance, at 1e-6 and
//! below rare ones reach some ten times it. Without friction and rolling friction nothing is
//! integrated. The caller must check before whether an impact is captured.
//!
//! **Frozen geometry, no weight** (scheme `rigid`, the limit `p_N → ∞`): [`frozen_impact`] with up
//! to [`MAX_CONTACTS`](crate::contact::MAX_CONTACTS) contacts, all at penetration zero; contacts that do not close
//! at first act as soon as the motion closes them.
//!
//! - Ratios of stiffness between grounds are kept; own time is that of the stiffest contact.
//! - `stiffness_scale` (`|a|²` of a patch) multiplies `p_N`, its root `c_N`: the damping ratio
//!   stays. The shear and the rolling spring of a patch are not scaled.
//! - Dashpots share, `c_i = c_N/√(Σ_j max(0, n_i·n_j)²)` over the currently closed contacts; steps
//!   end where a contact closes or opens. A contact that closes again starts with unloaded springs.
//! - It ends as [`ImpactOutcome`] says. Every remaining approach speed, and the rebound of a
//!   captured contact by its own spring, is then removed from the normal velocity and booked as
//!   damping. Afterwards no contact closes, and captured contacts do not separate unless others
//!   throw them off.
//! - Energy never grows: if the integration error would make it grow, velocity and spin are scaled
//!   back. Without any loss (`e = 1`, no friction) the velocity is scaled to its magnitude before.
//! - A single contact is the impact on a plane without weight: exact normal restitution.
//!
//! **Several bodies** that touch each other and the mesh: [`frozen_collision`], the same rates with
//! two ends for each contact. A contact is captured if it was closed more slowly than its capture
//! speed.
//!
//! Losses are each ≥ 0 and add up to the lost energy to rounding: the parts are integrated along
//! the steps and scaled by the exact total. The energy of a spring whose contact opens is included,
//! under damping and rolling.

mod rigid_limit;
mod normal_motion;
pub(in crate::solver) mod dormand_prince;
mod plane;
mod sliders;
mod integrate;
#[cfg(test)]
mod tests;

pub(super) use plane::LOCAL_ERROR;
pub(crate) use plane::{
    BlowTable, InitialDeformation, NormalPassage, Plane, Rebound, blow_along_a_line,
};
pub(super) use rigid_limit::NEGLIGIBLE;
pub(crate) use rigid_limit::{
    BODIES, CONTACTS, ContactEnds, FrozenBody, FrozenCollision, FrozenContact, LONGEST_WAIT,
    frozen_collision, frozen_impact, largest_followed_ratio,
};

/// Number of steps of an impact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct ImpactEffort {
    /// Steps taken.
    pub(crate) steps: u32,
    /// Steps rejected.
    pub(crate) rejected: u32,
}

/// Length of the next trial step, and the length before a cut. Beyond a switching point the law is
/// as smooth as before it, so that the earlier length is taken up again.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct StepLength {
    pub(in crate::solver) wish: f64,
    before_cut: f64,
}

impl StepLength {
    pub(in crate::solver) const fn new(wish: f64) -> Self {
        Self { wish, before_cut: 0.0 }
    }

    /// A trial step of length `h` has to end at this share of it (–).
    pub(in crate::solver) fn cut(&mut self, h: f64, share: f64) {
        *self = Self { wish: h * share, before_cut: h.max(self.before_cut) };
    }

    /// A trial step is rejected for its error.
    pub(in crate::solver) fn shrink(&mut self, wish: f64) {
        *self = Self::new(wish);
    }

    /// A trial step is accepted.
    pub(in crate::solver) fn grow(&mut self, wish: f64) {
        *self = Self::new(wish.max(self.before_cut));
    }
}

/// End of a frozen impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ImpactOutcome {
    /// No contact pushes and none closes.
    Free,
    /// Friction jams the rock in a wedge, with compressed springs: it rests, or rolls along the
    /// wedge. The energy of the springs is lost.
    Jammed,
    /// It rattled until the time limit: the remaining approach speeds have been stopped without
    /// rebound.
    OutOfTime,
}

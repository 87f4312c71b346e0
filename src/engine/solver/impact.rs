//! Impacts followed in their own time `τ = ω t`, `ω = √(p_N/m)`, where nothing is stiff.
//!
//! The law is the one of `law.rs`, all three elements of it: normal force `max(0, p_N x + c_N x')`, shear and rolling a slider in
//! series with (spring ∥ dashpot). An element whose dashpot or friction is zero is left out. Only mass, inertia and radius of
//! [`Body`](super::body::Body) enter.
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
//! Normal motion is a closed form (`normal_motion.rs`); slip, spin and springs are integrated by an
//! explicit pair of order 5(4) under the known force (`dormand_prince.rs`, `integrate.rs`,
//! `sliders.rs`), steps ending where an element begins to slip or stick. `tolerance` is relative to
//! `|v|`: at 1e-4 errors stay within about it, at 1e-6 and below rare ones reach some ten times it.
//! Without friction and rolling friction nothing is integrated. Whether an impact is captured is
//! the caller's to ask before.
//!
//! **Frozen geometry, no weight** (scheme `rigid`, the limit `p_N → ∞`): [`throw`] with up to [`MOST`](crate::contact::MOST)
//! contacts, all at penetration zero; those that do not approach are pressed as soon as motion presses them.
//!
//! - Ratios of stiffness between grounds are kept; own time is that of the stiffest contact.
//! - `stiffness_scale` (`|a|²` of a patch) multiplies `p_N`, its root `c_N`: the damping ratio stays. The shear and the rolling
//!   spring of a patch are not scaled.
//! - Dashpots share, `c_i = c_N/√(Σ_j max(0, n_i·n_j)²)` over the contacts with penetration now; steps end where one is pressed or
//!   opens. The springs of a contact that opens are at rest when it is pressed again.
//! - It ends as [`ImpactOutcome`] says. Then every approach left, and what a captured contact has given back of itself, is taken out of the
//!   velocity along the normal and booked as damping: no contact approaches afterwards, captured ones do not separate unless thrown
//!   off by others.
//! - Energy never rises: should the steps' error make it, velocity and spin are scaled back; where nothing takes any (`e = 1`, no friction),
//!   velocity is scaled to its size before.
//! - One contact is the impact on a plane without weight: exact normal restitution.
//!
//! **Several bodies** that touch each other and the mesh: [`collide`], the same rates with two ends to a contact; which contacts give
//! nothing back is told by how fast each was pressed together.
//!
//! Losses are each ≥ 0 and add up to the energy that is gone to rounding: the parts are summed along the steps and scaled by the
//! exact total. What springs store when a contact opens is in them, under damping and rolling.

mod rigid_limit;
mod normal_motion;
pub(in crate::solver) mod dormand_prince;
mod plane;
mod sliders;
mod integrate;
#[cfg(test)]
mod tests;

pub(super) use plane::LOCAL;
pub(crate) use plane::{
    BlowTable, ContactDeformation, NormalPassage, Plane, Rebound, blow_along_a_line,
};
pub(super) use rigid_limit::NEGLIGIBLE;
pub(crate) use rigid_limit::{
    BODIES, CONTACTS, ContactEnds, FrozenBody, FrozenCollision, FrozenContact, LONGEST_WAIT,
    frozen_collision, frozen_impact, largest_followed_ratio,
};

/// What following an impact has cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct ImpactEffort {
    /// Steps taken.
    pub(crate) steps: u32,
    /// Steps thrown away.
    pub(crate) rejected: u32,
}

/// The step to try next, and that before it was cut: beyond a kink the law is as smooth as before it, and its length is taken up again.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct StepLength {
    pub(in crate::solver) wish: f64,
    before_cut: f64,
}

impl StepLength {
    pub(in crate::solver) const fn new(wish: f64) -> Self {
        Self { wish, before_cut: 0.0 }
    }

    /// A try of length `h` has to end at this share of it (–).
    pub(in crate::solver) fn cut(&mut self, h: f64, share: f64) {
        *self = Self { wish: h * share, before_cut: h.max(self.before_cut) };
    }

    /// The error of a try was too large.
    pub(in crate::solver) fn shrink(&mut self, wish: f64) {
        *self = Self::new(wish);
    }

    /// A try is taken.
    pub(in crate::solver) fn grow(&mut self, wish: f64) {
        *self = Self::new(wish.max(self.before_cut));
    }
}

/// How a frozen impact ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ImpactOutcome {
    /// Nothing pushes and nothing comes nearer.
    Free,
    /// Friction holds it in a wedge, its springs pressed in: it rests, or rolls along the wedge. What they store is lost.
    Jammed,
    /// It went on rattling: what was still coming nearer has been stopped without rebound.
    OutOfTime,
}

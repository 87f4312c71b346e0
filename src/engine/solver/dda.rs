//! Scheme `dda`: the paper's displacement-based step at a fixed time step.
//!
//! The unknown of a step is the displacement `D` under constant acceleration (Newmark β = 1/2, γ =
//! 1, the right-Riemann rule): `(2M/Δt² + K) D = m g + (2M/Δt) V₀ + F`, `V₁ = 2D/Δt − V₀`. Contacts
//! are those of the step's start, with their normals; open–close iteration finds whether they are
//! open, sliding or sticking.
//!
//! It is solved for `E = D − D₀`, the effect of contacts on the free displacement
//! `D₀ = V₀ Δt + g Δt²/2`: `(2M/Δt² + K) E = F − K D₀`. The equation is the same, and a motion
//! without contacts is not rounded.
//!
//! Work equals the change of kinetic energy exactly, `(V₁² − V₀²) M/2 = (F + m g)·D`, and all
//! forces but gravity are those of springs at the step's end or against the step's displacement:
//! springs lose `k (Δx)²/2` a step and no energy is created, whatever the step length. For that
//! reason dashpots act on the mean velocity `D/Δt`: on `V₁` they might add energy where a step
//! reverses the motion.
//!
//! The rule is unconditionally stable and first order. It damps an oscillation of phase `z = ω Δt`
//! by `exp(−π z/4)` in half a period. At fixed `p_N` and `Δt` small rocks, whose `ω` is large, lose
//! more than large ones: an artefact of the step, not of the rock. An impact with `z ≥ 2` is
//! reversed in one step. From 4 on an impact that begins within a step may keep anything between
//! none and all of its speed.
//!
//! The step serves `n ≥ 1` rocks; a rock alone has no pairs, and allocates nothing.
//!
//! ```text
//! step         open–close iteration over all contacts
//! body         one rock: its contacts, their losses, the end of its step
//! pairs        contacts between rocks, and the system of all, Eq. (4)
//! dda_system   beside this: a rock's contacts, their submatrices and states, its block of the system
//! ```

mod body;
mod pairs;
mod step;

use super::Settings;
use super::contact_state::{ContactEnvironment, ContactState};
use super::loss::Loss;
use super::step_control::{Advance, StepError};
use crate::math;
pub(super) use body::DdaBody;
pub(super) use pairs::DdaPairs;
use std::f64::consts::PI;
pub(super) use step::DdaStep;

/// Longest travel in one step (–, relative to R) where more than one plane is near: features are
/// known a tenth of the radius ahead.
pub const TRAVEL: f64 = 0.09;
/// Deepest valid penetration (–, relative to R). Where the centre passes the surface, `V` reverses
/// and the contact would push the rock through.
pub(super) const DEEPEST: f64 = 0.5;
/// Phase of the contact oscillation per step (rad) from which an impact is reversed within one
/// step; beyond, restitution grows with it.
pub const SINGLE_STEP_PHASE: f64 = 2.0;

/// Normal restitution (–) that the step leaves of an undamped impact at `ω Δt` = `phase` (rad, > 0), without gravity.
///
/// The impact begins at the contact, where the flight ends. The step shrinks the oscillation by
/// `ρ = (1+q)^(−1/2)` while its phase turns by `θ = acos((2−q)/(2 √(1+q)))`, `q = phase²/2`; the
/// rock is out after `N = ⌈π/θ⌉ − 1` steps, with `e = −ρᴺ (cos Nθ − √(q/(8−q)) sin Nθ)`, about
/// `exp(−π phase/4)` while the step resolves the impact. From phase 2 on one step reverses it,
/// with `e = (q−1)/(q+1)`. An impact that begins within a step, on another contact, keeps
/// `(1+q)^(−π/(2θ))` on average below phase 4 and anything less than the above beyond.
///
/// For Table 1 of the paper (1e9 N/m, 1e-5 s) and a block of 0.5 m the phase is 0.0084 and
/// `e = 0.993`.
pub fn own_restitution(phase: f64) -> f64 {
    let q = 0.5 * phase * phase;
    if phase >= SINGLE_STEP_PHASE {
        return (q - 1.0) / (q + 1.0);
    }
    let angle = math::acos((2.0 - q) / (2.0 * (1.0 + q).sqrt()));
    let steps = (PI / angle).ceil() - 1.0;
    let (sine, cosine) = math::sin_cos(steps * angle);
    math::pow(1.0 + q, -0.5 * steps) * ((q / (8.0 - q)).sqrt() * sine - cosine)
}

/// The fixed step of a rock alone through one contact episode.
#[derive(Debug)]
pub struct Fixed {
    step_s: f64,
    shear_memory: bool,
    /// Energy in the springs at the present state (J).
    stored: Loss,
}

impl Fixed {
    /// Begins an episode.
    pub fn new(settings: &Settings, world: &ContactEnvironment, state: &mut ContactState) -> Self {
        let stored = DdaBody::with_contact_points(*world, state).stored;
        Self { step_s: settings.step_s, shear_memory: settings.shear_memory, stored }
    }

    /// One step of at most `h_max` (s). Between steps the rock's contact points are those of its present place.
    ///
    /// # Errors
    /// [`StepError`] if the rock sank in or its motion is no longer finite.
    pub fn advance(
        &mut self,
        world: &ContactEnvironment,
        state: &mut ContactState,
        h_max: f64,
    ) -> Result<Advance, StepError> {
        // limited by events and by the travel for which features are known; a shorter step has a
        // smaller phase and damps less
        let dt = self.step_s.min(h_max).min(state.longest_step(world, TRAVEL));
        let bodies = &mut [DdaBody::new(*world, state, self.stored)];
        let (pairs, pair_histories) = (&mut DdaPairs::default(), &mut []);
        let done = DdaStep { bodies, pairs, pair_histories }.advance((dt, self.shear_memory))?;
        let [DdaBody { state, stored, loss, .. }] = bodies;
        state.sweeps += u64::from(done.solves);
        self.stored = *stored;
        Ok(Advance { dt, loss: *loss, steps: 1, unsettled: !done.settled, ..Advance::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed form against the step itself, taken again and again: rounding of some thousand steps.
    #[test]
    fn own_restitution_is_what_the_steps_leave() {
        for phase in [0.001, 0.01, 0.1, 0.3, 0.5, 1.0, 1.99, 2.0, 3.0, 4.0, 10.0, 100.0] {
            let q = 0.5 * phase * phase;
            let (mut depth, mut speed) = (0.0f64, 1.0);
            loop {
                let next = (depth + speed) / (1.0 + q);
                if next <= 0.0 {
                    break;
                }
                (depth, speed) = (next, 2.0 * (next - depth) - speed);
            }
            assert!((own_restitution(phase) + speed).abs() < 1e-11, "{phase}: {speed}");
        }
    }
}

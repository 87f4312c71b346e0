//! Scheme `dda`: the paper's displacement-based step at a fixed time step.
//!
//! The unknown of a step is the displacement `D` under constant acceleration (Newmark β = 1/2, γ = 1, the
//! right-Riemann rule): `(2M/Δt² + K) D = m g + (2M/Δt) V₀ + F`, `V₁ = 2D/Δt − V₀`. Contacts are those of the step's
//! start, with their normals; whether they are open, sliding or sticking is found by open–close iteration.
//!
//! Solved is for `E = D − D₀`, what contacts add to the free displacement `D₀ = V₀ Δt + g Δt²/2`:
//! `(2M/Δt² + K) E = F − K D₀`. It is the same equation; a motion no contact acts on keeps every bit.
//!
//! Work equals the change of kinetic energy exactly, `(V₁² − V₀²) M/2 = (F + m g)·D`, and all forces but gravity are
//! those of springs at the step's end or against the step's displacement: springs lose `k (Δx)²/2` a step and nothing
//! gains, however long the step. Dashpots act on the mean velocity `D/Δt` for that reason: on `V₁` they may add energy
//! where a step turns the motion round.
//!
//! Why this rule is stable and yet coarse: it is unconditionally stable and first order, and damps an oscillation
//! of phase `z = ω Δt` by `exp(−π z/4)` in half a period. At fixed `p_N` and `Δt` small rocks,
//! whose `ω` is large, lose more than large ones: an artefact of the step, not of the rock. From `z
//! = 2` on an impact is turned round in one step, and from 4 on that of an impact which begins within
//! a step is anything between nothing and all of its speed.

use super::Settings;
use super::body::Body;
use super::contact_state::{ContactEnvironment, ContactState};
use super::dda_system::contact::{DdaContact, StepConstants};
use super::loss::Loss;
use super::step_control::{Advance, StepError};
use crate::contact::submatrix::Vec6;
use crate::contact::{ContactPoint, MOST};
use crate::math;
use crate::rock::Vec3;
use std::f64::consts::PI;

/// Longest way in one step (–, relative to R) where more than one plane is near: features are seen a tenth of the
/// radius ahead.
pub const TRAVEL: f64 = 0.09;
/// Deepest penetration that still is one (–, relative to R). Where the centre passes the surface `V` turns round and
/// the contact would push the rock through.
pub(crate) const DEEPEST: f64 = 0.5;
/// Contact oscillation per step (rad) from which an impact is turned round within one step: the longer, the livelier.
pub const SINGLE_STEP_PHASE: f64 = 2.0;

/// Normal restitution (–) that the step leaves of an undamped impact at `ω Δt` = `phase` (rad, > 0), without gravity.
///
/// The impact begins at the touch, where the leap ends. The step shrinks the oscillation by `ρ = (1+q)^(−1/2)` while
/// its phase turns by `θ = acos((2−q)/(2 √(1+q)))`, `q = phase²/2`; the rock is out after `N = ⌈π/θ⌉ − 1` steps, with
/// `e = −ρᴺ (cos Nθ − √(q/(8−q)) sin Nθ)`, about `exp(−π phase/4)` while the step resolves the impact. From phase 2 on
/// one step turns it round, with `e = (q−1)/(q+1)`. An impact that begins within a step, on another contact, keeps
/// `(1+q)^(−π/(2θ))` on average below phase 4 and anything less than the above beyond.
///
/// For Table 1 of the paper (1e9 N/m, 1e-5 s) and a block of 0.5 m the phase is 0.0084 and `e =
/// 0.993`.
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

/// The fixed step of one contact episode.
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
        let c = state.c;
        state.look_ahead(world, &c);
        let stored = state.stored_j(world);
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
        // cut by events and by the way that has been looked ahead; the phase of a cut step is
        // smaller, so it damps less
        let dt = self.step_s.min(h_max).min(state.longest_step(world, TRAVEL));
        let step = StepConstants {
            dt,
            free: free_motion(world, state, dt),
            radius: world.body.radius,
            compliance: compliance(&world.body, dt),
            shear_memory: self.shear_memory,
        };
        meet(world, &step, state);
        let (added, settled) = solve(world, &step, state).ok_or(StepError::NotFinite)?;
        let d = step.free + added;
        let mut done = Advance { dt, steps: 1, unsettled: !settled, ..Advance::default() };
        for contact in state.scratch.contacts() {
            if contact.depth(&d) > DEEPEST * step.radius {
                return Err(StepError::SankIn);
            }
            done.loss.add(&contact.loss(&d).on(world, contact.triangle), 1.0);
        }
        carry_on(world, state, &d, &(added * (2.0 / dt)), dt);
        let stored = state.stored_j(world);
        done.loss.add(&stored, 1.0);
        done.loss.add(&self.stored, -1.0);
        self.stored = stored;
        Ok(done)
    }
}

/// A displacement and a rotation as the six unknowns of Eq. (1).
fn six(a: &Vec3, b: &Vec3) -> Vec6 {
    Vec6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// Displacement and rotation over `dt` without contacts.
/// `D₀ = V₀ Δt + g Δt²/2`; a free sphere keeps its spin.
pub(crate) fn free_motion(world: &ContactEnvironment, state: &ContactState, dt: f64) -> Vec6 {
    six(&(state.v * dt + world.body.gravity * (0.5 * dt * dt)), &(state.w * dt))
}

/// Way of the touched point per newton along the surface (m/N), turn of the sphere per newton metre, over `dt`.
///
/// `Δt²/(2m) + R² Δt²/(2I)`: displacement is force times half the square of the step over the mass,
/// and the contact point also turns.
pub(crate) fn compliance(body: &Body, dt: f64) -> (f64, f64) {
    let turn = 0.5 * dt * dt / body.inertia;
    (0.5 * dt * dt / body.mass + body.radius * body.radius * turn, turn)
}

/// Makes the touches of the step's start into contacts.
///
/// Normals stay those of the start for the whole step: on an edge that makes every order of the
/// rule first order.
fn meet(world: &ContactEnvironment, step: &StepConstants, state: &mut ContactState) {
    (state.scratch.count, state.scratch.taken) = (0, 0);
    for k in 0..state.touches.len() {
        add_contact(world, step, state, (k, state.touches[k].distance_m));
    }
}

/// Makes touch `k` of the last look into a contact, its plane being so far from the centre at the step's start (m).
fn add_contact(
    world: &ContactEnvironment,
    step: &StepConstants,
    state: &mut ContactState,
    (k, distance_m): (usize, f64),
) {
    let v = state.v;
    let history = state.history_of(world, k, state.scratch.taken, &v);
    let touch = ContactPoint { distance_m, ..state.touches[k] };
    let law = world.law_of(&state.touches, k);
    let scratch = &mut state.scratch;
    scratch.contacts[scratch.count] =
        DdaContact::new(step, &law, &touch, (history, &state.histories[history]));
    scratch.count += 1;
    scratch.taken |= 1 << history;
}

/// Solves the step, and solves it again with the contacts that it ran into: a rock that rolls into a fold would
/// otherwise find itself inside the other flank and be thrown out with energy from nowhere.
///
/// Ends with the touches of the step's end.
/// Ends: each round adds a contact, and there are no more than `MOST`.
fn solve(
    world: &ContactEnvironment,
    step: &StepConstants,
    state: &mut ContactState,
) -> Option<(Vec6, bool)> {
    loop {
        let (added, settled) = state.scratch.settle(world, step, &mut state.sweeps)?;
        let d = step.free + added;
        let way: Vec3 = d.fixed_rows::<3>(0).into();
        let end = state.c + way;
        state.look_ahead(world, &end);
        let touches = state.touches;
        let before = state.scratch.count;
        for (k, touch) in touches.iter().enumerate() {
            let is_inside = touch.distance_m < step.radius && state.scratch.count < MOST;
            if is_inside && !knows(state.scratch.contacts(), touch, &touches, &d) {
                add_contact(world, step, state, (k, touch.distance_m - touch.normal.dot(&way)));
            }
        }
        if state.scratch.count == before {
            return Some((added, settled));
        }
    }
}

/// Whether a touch of the step's end took part in it, by itself or as the part of the surface that it came from.
pub(crate) fn knows(
    contacts: &[DdaContact],
    touch: &ContactPoint,
    touches: &[ContactPoint],
    d: &Vec6,
) -> bool {
    contacts.iter().any(|contact| {
        contact.feature == touch.feature
            || contact.leads_to(touch, d)
                && touches.iter().all(|other| other.feature != contact.feature)
    })
}

/// Moves the rock by `d`, and changes its velocity by what contacts added.
/// `V₁ = 2D/Δt − V₀ = V₀ + g Δt + 2E/Δt`, as `D = D₀ + E`: what no contact acts on is not rounded.
fn carry_on(world: &ContactEnvironment, state: &mut ContactState, d: &Vec6, kick: &Vec6, dt: f64) {
    for history in state.histories.iter_mut() {
        history.closed = false;
    }
    for contact in state.scratch.contacts() {
        contact.remember(d, &mut state.histories[contact.history]);
    }
    state.merge_lost(world);
    state.histories.retain(|history| history.closed);
    state.c += d.fixed_rows::<3>(0);
    state.v += world.body.gravity * dt + kick.fixed_rows::<3>(0);
    state.w += kick.fixed_rows::<3>(3);
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

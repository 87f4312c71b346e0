//! An impact among any features, followed in its own time.
//!
//! While a contact rebounds it lasts about `π/ω`, `ω = √(p_N/m)`: in units of `1/ω` nothing is stiff, and an explicit pair of
//! order five is the cheapest way to follow it ([`dormand_prince`](super::impact::dormand_prince)). The error is controlled
//! relative to the speed of the impact, so that restitution is as right for a pebble as for a block. Geometry is that of every
//! stage; force is continuous wherever patches meet (`contact::patch`), and where friction begins to slip or a further contact
//! begins the step is cut.
//!
//! State: way, velocity and spin of the rock, shear and rolling stretch of each contact; summed
//! along: what friction, dashpots, rolling and trees take. What normal springs hold is a matter of place,
//! known at both ends of a step. Why explicit: the implicit stage costs
//! an iteration over geometry and contacts, and a rebound is over in `π` radians, a handful of
//! steps; stiffness enters only by the unit of time.

mod flow;

use super::contact_state::{ContactEnvironment, ContactState, longest_step};
use super::impact::LOCAL;
use super::impact::dormand_prince::{Attempt, Stages, growth};
use super::loss::Loss;
use super::stage::End;
use super::step_control::{Advance, StepError, TRAVEL};
use crate::contact::TOUCH;
use crate::contact::history::{ContactHistory, HISTORIES};
use flow::{Among, LOSSES};

/// First step of an impact (rad of its oscillation).
pub(super) const FIRST: f64 = 0.3;
/// Longest step (rad).
/// Beyond about a radian the error estimate of the pair is no longer to be trusted.
pub(super) const LONGEST_RAD: f64 = 0.9;
/// Local error allowed where patches meet and part, relative to that on a plane (–): the estimate sees too little of a kink.
const KINKED: f64 = 0.3;
/// Largest error of energy that is balanced (–, relative to motion).
/// A larger one is no error of steps, and hiding it would hide a fault.
pub(super) const BALANCED: f64 = 0.1;
/// Shortest step (rad): a contact that begins within a step is met this exactly.
pub(super) const SHORTEST_RAD: f64 = 1e-9;

/// How far a step may go, and how exactly.
#[derive(Debug, Clone, Copy)]
struct StepBounds {
    /// Stiffest contact (rad/s).
    omega: f64,
    /// Longest step that cannot jump over a feature (s).
    limit: f64,
    /// Longest step asked for (s).
    h_max: f64,
    /// Local error allowed (m/s).
    allowed: f64,
}

/// An accepted step.
struct Accepted {
    end: End,
    dt: f64,
    /// What contacts took, what springs hold counted in (J).
    loss: Loss,
}

/// Whether a whole try of `dt` (s) is accepted by its error (squared, over the one allowed), and the step to try next (s). One that was cut
/// short from outside says nothing of how long it could have been: what was `wished` stays. One that `is_short` is accepted
/// whatever its error.
///
/// # Errors
/// [`StepError`] if what was accepted is no longer finite.
pub(super) fn judge(
    (dt, wished): (f64, f64),
    (error2, is_smooth): (f64, bool),
    is_short: bool,
) -> Result<(bool, f64), StepError> {
    let error2 = error2 * if is_smooth { 1.0 } else { 1.0 / (KINKED * KINKED) };
    if error2 <= 1.0 || is_short {
        let least = if dt < wished { wished } else { 0.0 };
        let next_h = (dt * growth(error2)).max(least);
        return if error2.is_finite() { Ok((true, next_h)) } else { Err(StepError::NotFinite) };
    }
    let grown = if error2.is_finite() { growth(error2) } else { 0.2 };
    Ok((false, dt * grown.min(0.9)))
}

impl ContactState {
    /// Whether an impact is going on.
    pub(crate) fn is_rebounding(&self) -> bool {
        self.impact.left > 0.0 && self.histories.iter().any(|history| !history.captured)
    }

    /// One accepted step of an impact, of at most `h_max` (s), in contacts of at most `omega` (rad/s); `tolerance` is the local
    /// error allowed relative to the speed of the impact.
    ///
    /// # Errors
    /// [`StepError`] if the motion is no longer finite.
    ///
    /// Tried with room for two contacts first, the usual case: the numbers of a state live on the
    /// stack, and their count is a constant that the compiler unrolls. With more contacts the step
    /// is tried anew with room for all.
    pub(crate) fn step_impact(
        &mut self,
        world: &ContactEnvironment,
        (omega, tolerance): (f64, f64),
        h_max: f64,
        done: &mut Advance,
    ) -> Result<(), StepError> {
        if self.impact.h == 0.0 {
            self.impact.h = FIRST / omega;
        }
        let c = self.c;
        self.know(world, &c);
        let way = TRAVEL * world.body.radius;
        let limit = longest_step(&world.body, self.v.norm(), way).min(LONGEST_RAD / omega);
        // a share of the tolerance, as an impact takes a handful of steps; relative to the speed of
        // the impact, so it has no unit of its own
        let allowed = LOCAL * tolerance * self.impact.speed_m_s;
        let bounds = StepBounds { omega, limit, h_max, allowed };
        let known = self.histories.len();
        let mut accepted = None;
        if known <= 2 {
            accepted = if world.laws.iter().any(|law| law.rolling.is_on()) {
                self.step_among::<2, 21, { LOSSES + 2 }, 6>(world, &bounds, done)?
            } else {
                self.step_among::<2, 15, { LOSSES + 2 }, 6>(world, &bounds, done)?
            };
        }
        if accepted.is_none() {
            // what the crowded try has met is forgotten
            self.histories.truncate(known);
            accepted = self.step_among::<HISTORIES, { 9 + 6 * HISTORIES }, { LOSSES + HISTORIES }, { 3 * HISTORIES }>(
                world, &bounds, done,
            )?;
        }
        if let Some(accepted) = accepted {
            self.impact.left -= omega * accepted.dt;
            self.accept_impact(world, &accepted, &bounds, done);
        }
        Ok(())
    }

    /// Tries steps with room for `C` contacts until one is accurate; `None` if there are more of them.
    ///
    /// A try that is cut at a kink is shorter, not wrong; one whose error is too large shrinks by
    /// the usual rule.
    fn step_among<const C: usize, const N: usize, const Q: usize, const P: usize>(
        &mut self,
        world: &ContactEnvironment,
        bounds: &StepBounds,
        done: &mut Advance,
    ) -> Result<Option<Accepted>, StepError> {
        let StepBounds { omega, limit, h_max, allowed } = *bounds;
        let mut flow = Among::<C>::new(world, self, (omega, allowed));
        let y = flow.begin::<N>();
        let mut stages = Stages::<N, Q, P>::NONE;
        flow.rates_of(&y, stages.first());
        // what the present place touches is met whatever becomes of the tries
        flow.state.accept_meetings(world.least_impact_m_s());
        flow.note_start();
        let known = flow.state.histories.len();
        let mut kept = 0.0;
        loop {
            flow.state.histories.truncate(known);
            flow.begin_try();
            let wished = flow.state.impact.h.min(limit);
            let dt = wished.min(h_max);
            let is_short = dt * omega < SHORTEST_RAD;
            let attempt = stages.step(&mut flow, &y, dt, (!is_short).then_some(allowed));
            if flow.is_crowded && C < HISTORIES {
                return Ok(None);
            }
            done.rejected += 1;
            let tried = match attempt {
                Attempt::Whole(tried) => tried,
                Attempt::Cut(share) => {
                    flow.state.impact.h = dt * share;
                    // beyond a kink the law is as smooth as before it: the step before is taken up again
                    kept = dt.max(kept);
                    continue;
                }
            };
            let (accepted, next_h) = judge((dt, wished), (tried.error2, flow.is_smooth), is_short)?;
            flow.state.impact.h = if accepted { next_h.max(kept) } else { next_h };
            if accepted {
                done.rejected -= 1;
                let end = flow.end(&tried.y);
                let mut loss = flow.taken_up(&tried.q);
                loss.add(&summed(&tried.q), 1.0);
                flow.remember();
                return Ok(Some(Accepted { end, dt, loss }));
            }
            kept = 0.0;
        }
    }

    /// Takes over the step's end: motion, memories, losses. The last stage was there.
    fn accept_impact(
        &mut self,
        world: &ContactEnvironment,
        accepted: &Accepted,
        bounds: &StepBounds,
        done: &mut Advance,
    ) {
        let (body, end, loss) = (&world.body, &accepted.end, &accepted.loss);
        let before = self.motion_j(body);
        let lifted = -body.mass * body.gravity.dot(&(end.c - self.c));
        (self.c, self.v, self.w) = (end.c, end.v, end.w);
        // what the springs store is counted among the losses until they give it back
        self.impact.gained += self.motion_j(body) + lifted + loss.sum() - before;
        self.merge_lost(world);
        self.histories.retain(|history| history.closed);
        self.accept_meetings(world.least_impact_m_s());
        self.fresh = false;
        done.dt += accepted.dt + self.let_go(world, bounds, bounds.h_max - accepted.dt);
        // what rebounds no more goes on with other steps, also while something else still presses
        if self.is_free() || !self.is_rebounding() {
            self.balance(world);
        }
        done.loss.add(loss, 1.0);
        done.steps += 1;
    }

    /// Flies out of contacts that push no more, if nothing else is in the way there and it takes no longer than `longest` (s);
    /// returns the time that took (s).
    ///
    /// What still hangs on the contacts then has no force, and the parabola is exact.
    fn let_go(&mut self, world: &ContactEnvironment, bounds: &StepBounds, longest: f64) -> f64 {
        let dt = LONGEST_RAD / bounds.omega;
        if self.histories.is_empty() || dt > longest.min(bounds.limit) {
            return 0.0;
        }
        let leaves = |history: &ContactHistory| {
            let law = world.law(history.triangle);
            let n = &history.n;
            let weight = n.dot(&world.body.gravity).min(0.0);
            history.normal_force <= 0.0 && law.lets_go(n.dot(&self.v), weight, dt)
        };
        if !self.histories.iter().all(leaves) {
            return 0.0;
        }
        let (v, g) = (self.v, world.body.gravity);
        let c = self.c + (v + g * (0.5 * dt)) * dt;
        self.look(world, &c, world.body.radius * (1.0 + TOUCH));
        if !self.touches.is_empty() {
            return 0.0;
        }
        (self.c, self.v) = (c, v + g * dt);
        self.histories.clear();
        dt
    }

    /// Gives motion back what the steps of the impact have lost by themselves, or takes what they have gained: what is left of
    /// the energy is what came in less what the contacts took.
    ///
    /// Velocity and spin are scaled by one factor, so the direction of the rebound does not change.
    /// An impact with `e = 1` and no friction then keeps its energy to rounding. Where no ground has
    /// friction nothing can turn the rock, and the velocity alone is scaled.
    fn balance(&mut self, world: &ContactEnvironment) {
        let (body, gained) = (&world.body, self.impact.gained);
        let turns = world.laws.iter().any(|law| law.limits().caps(1.0) != (0.0, 0.0));
        let motion =
            if turns { self.motion_j(body) } else { 0.5 * body.mass * self.v.norm_squared() };
        if gained.abs() < BALANCED * motion {
            let kept = (1.0 - gained / motion).sqrt();
            self.v *= kept;
            self.w *= if turns { kept } else { 1.0 };
        }
        (self.impact.gained, self.impact.left) = (0.0, 0.0);
    }
}

/// What contacts took beside what their normal springs hold, from the sums of a step (J).
fn summed<const Q: usize>(sums: &[f64; Q]) -> Loss {
    Loss { friction: sums[0], damping: sums[1], rolling: sums[2], trees: sums[3] }
}

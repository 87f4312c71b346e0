//! Explicit integration of an impact on any features.
//!
//! A rebound lasts about `π/ω`, `ω = √(p_N/m)`. In units of `1/ω` nothing is stiff, and an explicit
//! pair of order five is the cheapest integrator
//! ([`dormand_prince`](super::impact::dormand_prince)). The error is controlled relative to the
//! speed of the impact, so that restitution is equally accurate for a pebble and for a boulder.
//! Geometry is that of every stage. The force is continuous where patches meet (`contact::patch`);
//! where friction switches between slipping and sticking, or a further contact begins, the step is
//! cut.
//!
//! State: displacement, velocity and spin of the rock, shear and rolling stretch of each contact.
//! Quadratures: losses by friction, damping, rolling and to trees. The energy of normal springs
//! depends on position only and is known at both ends of a step. The pair is explicit because an
//! implicit stage costs an iteration over geometry and contacts, whereas a rebound is over in `π`
//! radians, a handful of steps; stiffness enters only through the unit of time.

mod change_time;
mod changes;
mod flow;

use super::contact_state::{ContactEnvironment, ContactState};
use super::impact::dormand_prince::{Attempt, Flow, Stages, TrialResult, growth, vec3_at};
use super::impact::{LOCAL_ERROR, StepLength};
use super::loss::Loss;
use super::plane_ahead::longest_step;
use super::stage::StageMotion;
use super::step_control::{Advance, StepError, TRAVEL};
use crate::contact::TOUCH;
use crate::contact::history::{ContactHistory, MAX_HISTORIES};
pub(super) use flow::HeldEnergy;
use flow::{DISPLACEMENT, LOSSES, SphereFlow, V};

/// First step of an impact (rad of its oscillation).
pub(super) const FIRST: f64 = 0.3;
/// Longest step (rad). Beyond about a radian the error estimate of the pair is no longer reliable.
pub(super) const LONGEST_RAD: f64 = 0.9;
/// Local error allowed where patches meet and separate, relative to that on a plane (–): the
/// estimate sees too little of a switching point.
const KINKED: f64 = 0.3;
/// Largest energy error that is corrected (–, relative to the kinetic energy). A larger one is no
/// integration error, and correcting it would hide a fault.
pub(super) const BALANCED: f64 = 0.1;
/// A step is cut where contacts replace others only at shares of it within these (–).
const EXCHANGE_WITHIN: (f64, f64) = (0.02, 0.98);
/// Travel for which contacts are collected, over that of its speed in a step (–), and the number of
/// steps for which features are chosen at a time.
const AHEAD: f64 = 1.25;
const STEPS_AHEAD: f64 = 4.0;
/// Shortest step (rad): the accuracy to which an onset within a step is located.
pub(super) const SHORTEST_RAD: f64 = 1e-9;

/// Bounds of a step.
#[derive(Debug, Clone, Copy)]
struct StepBounds {
    /// Stiffest contact (rad/s).
    omega: f64,
    /// Longest step that cannot miss a feature (s).
    limit: f64,
    /// Longest step requested (s).
    h_max: f64,
    /// Local error allowed (m/s).
    allowed: f64,
}

/// An accepted step.
struct AcceptedStep {
    end: StageMotion,
    dt: f64,
    /// Loss, with the energy in springs counted in (J).
    loss: Loss,
    /// Whether the rates at its end hold for the next step: the same contacts, and the same
    /// normals.
    has_same_contacts: bool,
}

/// Whether a complete trial step of `dt` (s) is accepted by its error (squared, over the allowed
/// one), and the length of the next trial step (s). A step that was cut short from outside gives no
/// information on the possible length: the `wished` one stays. One that `is_short` is accepted with
/// any error.
///
/// # Errors
/// [`StepError`] if an accepted state is no longer finite.
pub(super) fn control_error(
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
    /// Whether there is a current impact.
    pub(crate) fn is_rebounding(&self) -> bool {
        self.impact.left_rad > 0.0 && self.histories.iter().any(|history| !history.captured)
    }

    /// One accepted step of an impact, of at most `h_max` (s), in contacts of at most `omega`
    /// (rad/s); `tolerance` is the local error allowed relative to the speed of the impact.
    ///
    /// # Errors
    /// [`StepError`] if the motion is no longer finite.
    ///
    /// Tried with room for two contacts first, the usual case: the state lives on the stack, and
    /// its length is a constant for which the compiler unrolls loops. With more contacts the step
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
        let known = self.histories.len();
        let scale = (omega, tolerance);
        let is_done = known <= 2
            && if world.laws.iter().any(|law| law.rolling.is_on()) {
                self.steps_among::<2, 21, { LOSSES + 2 }, 6>(world, scale, h_max, done)?
            } else {
                self.steps_among::<2, 15, { LOSSES + 2 }, 6>(world, scale, h_max, done)?
            };
        if !is_done {
            // contacts found by the trial that ran out of room are dropped
            self.histories.truncate(known);
            self.steps_among::<MAX_HISTORIES, { 9 + 6 * MAX_HISTORIES }, { LOSSES + MAX_HISTORIES }, { 3 * MAX_HISTORIES }>(
                world, scale, h_max, done,
            )?;
        }
        Ok(())
    }

    /// Bounds of the next step of an impact with contacts of `omega` (rad/s) and a tolerance
    /// relative to its speed, of at most `h_max` (s).
    fn step_bounds(
        &mut self,
        world: &ContactEnvironment,
        (omega, tolerance): (f64, f64),
        h_max: f64,
    ) -> StepBounds {
        let c = self.c;
        self.update_neighbours(world, &c);
        let way = TRAVEL * world.body.radius;
        let speed = self.v.norm();
        let limit = longest_step(&world.body, speed, way).min(LONGEST_RAD / omega);
        let next_m = AHEAD * speed * limit;
        let reach = world.body.radius * (1.0 + TOUCH);
        self.near.prepare_short_path(world.terrain, &c, (next_m, STEPS_AHEAD * next_m), reach);
        // a share of the tolerance, as an impact takes a handful of steps; relative to the speed of
        // the impact, so it has no unit of its own
        let allowed = LOCAL_ERROR * tolerance * self.impact.speed_m_s;
        StepBounds { omega, limit, h_max, allowed }
    }

    /// Steps with room for `C` contacts, as many in succession as pass without an event that others
    /// must know of; false if there are more contacts than that at the first.
    fn steps_among<const C: usize, const N: usize, const Q: usize, const P: usize>(
        &mut self,
        world: &ContactEnvironment,
        scale: (f64, f64),
        h_max: f64,
        done: &mut Advance,
    ) -> Result<bool, StepError> {
        let mut bounds = self.step_bounds(world, scale, h_max);
        let mut flow = SphereFlow::<C>::new(world, self, (bounds.omega, bounds.allowed));
        let mut stages = Stages::<N, Q, P>::NONE;
        flow.rates(0, &flow.initial_state::<N>(), stages.first());
        // contacts at the present position are recorded whatever becomes of the trial steps
        flow.state.accept_new_contacts(world);
        loop {
            let Some(accepted) = step_among(&mut flow, &mut stages, &bounds, done)? else {
                return Ok(done.steps > 0);
            };
            flow.state.impact.left_rad -= bounds.omega * accepted.dt;
            flow.state.accept_impact(world, &accepted, &bounds, done);
            if !(accepted.has_same_contacts && flow.state.can_continue(flow.pressed().len())) {
                return Ok(true);
            }
            let left_s = h_max - done.dt;
            if left_s <= 0.0 || flow.state.finish_plane_impact(world, scale.1, left_s, done) {
                return Ok(true);
            }
            bounds = flow.state.step_bounds(world, scale, left_s);
            // the rates of the step's end are those of the next one's start
            stages.reuse_last();
        }
    }

    /// Whether an impact with `count` contacts can continue without an event that must be known
    /// between its steps.
    fn can_continue(&self, count: usize) -> bool {
        self.is_rebounding()
            && self.histories.len() == count
            && self.histories.iter().all(|history| history.announced)
            && !self.may_yield
            && !self.facets.are_rough()
    }

    /// Accepts the end of the step: motion, histories, losses. The last stage was there.
    fn accept_impact(
        &mut self,
        world: &ContactEnvironment,
        accepted: &AcceptedStep,
        bounds: &StepBounds,
        done: &mut Advance,
    ) {
        let (body, end, loss) = (&world.body, &accepted.end, &accepted.loss);
        let before = self.motion_j(body);
        let lifted = body.lifted_j(&(end.c - self.c));
        (self.c, self.v, self.w) = (end.c, end.v, end.w);
        // the energy that springs store is counted as lost until they return it
        self.impact.gained_j += self.motion_j(body) + lifted + loss.sum() - before;
        self.impact.mixes_grounds |= self.is_on_several_grounds(world);
        self.merge_lost(world);
        self.histories.retain(|history| history.closed);
        self.accept_new_contacts(world);
        self.fresh = false;
        done.dt += accepted.dt + self.fly_clear(world, bounds, bounds.h_max - accepted.dt);
        // after the rebound other steps follow, also while another contact still presses
        if self.is_free() || !self.is_rebounding() {
            self.balance(world);
        }
        done.loss.add(loss, 1.0);
        done.steps += 1;
    }

    /// Flies clear of open contacts if no other contact is met and it takes at most `longest` (s);
    /// returns the flight time (s).
    ///
    /// The remaining contacts exert no force, and the parabola is exact.
    fn fly_clear(&mut self, world: &ContactEnvironment, bounds: &StepBounds, longest: f64) -> f64 {
        let dt = LONGEST_RAD / bounds.omega;
        if self.histories.is_empty() || dt > longest.min(bounds.limit) {
            return 0.0;
        }
        let leaves = |history: &ContactHistory| {
            let law = world.springs_of(history);
            let n = &history.n;
            let weight = n.dot(&world.body.gravity).min(0.0);
            history.normal_force <= 0.0 && law.stays_open(n.dot(&self.v), weight, dt)
        };
        if !self.histories.iter().all(leaves) {
            return 0.0;
        }
        let (v, g) = (self.v, world.body.gravity);
        let c = self.c + (v + g * (0.5 * dt)) * dt;
        self.find_contact_points(world, &c, world.body.radius * (1.0 + TOUCH));
        if !self.touches.is_empty() {
            return 0.0;
        }
        (self.c, self.v) = (c, v + g * dt);
        self.histories.clear();
        dt
    }

    /// Corrects the motion by the energy that the errors of the steps of the impact have lost or
    /// gained: the remaining energy is the initial energy less the losses of the contacts.
    ///
    /// Velocity and spin are scaled by one factor, so the direction of the rebound does not change.
    /// An impact with `e = 1` and no friction then keeps its energy to rounding. Where no ground
    /// has friction nothing can turn the rock, and the velocity alone is scaled. More than
    /// [`BALANCED`] is taken only where springs of several grounds were pressed at once: what these
    /// hand over to each other is no error of steps.
    pub(super) fn balance(&mut self, world: &ContactEnvironment) {
        let (body, gained) = (&world.body, self.impact.gained_j);
        let turns = world.laws.iter().any(|law| law.limits().caps(1.0) != (0.0, 0.0));
        let motion =
            if turns { self.motion_j(body) } else { 0.5 * body.mass * self.v.norm_squared() };
        let most = if self.impact.mixes_grounds { 1.0 } else { BALANCED };
        if (-BALANCED * motion..most * motion).contains(&gained) {
            let kept = (1.0 - gained / motion).sqrt();
            self.v *= kept;
            self.w *= if turns { kept } else { 1.0 };
        }
        (self.impact.gained_j, self.impact.left_rad, self.impact.mixes_grounds) = (0.0, 0.0, false);
    }
}

/// Tries steps until one is accurate; `None` if there are more contacts than `C`.
///
/// A trial step that is cut at a switching point is shorter; one whose error is too large shrinks
/// by the usual rule.
fn step_among<const C: usize, const N: usize, const Q: usize, const P: usize>(
    flow: &mut SphereFlow<C>,
    stages: &mut Stages<N, Q, P>,
    bounds: &StepBounds,
    done: &mut Advance,
) -> Result<Option<AcceptedStep>, StepError> {
    let StepBounds { omega, limit, h_max, allowed } = *bounds;
    let y = flow.initial_state::<N>();
    flow.record_start();
    let (known, start) = (flow.state.histories.len(), flow.state.c);
    let mut step = StepLength::new(flow.state.impact.h);
    loop {
        flow.state.histories.truncate(known);
        flow.begin_try();
        let wished = step.wish.min(limit);
        let dt = wished.min(h_max);
        let is_short = dt * omega < SHORTEST_RAD;
        let attempt = stages.step(flow, &y, dt, (!is_short).then_some(allowed));
        if flow.exceeds_room && C < MAX_HISTORIES {
            flow.state.histories.truncate(known);
            flow.state.impact.h = step.wish;
            return Ok(None);
        }
        let tried = match attempt {
            Attempt::Whole(tried) => tried,
            Attempt::Cut(share) => {
                done.rejected += 1;
                step.cut(dt, share);
                flow.changes.ends_past_exchange = false;
                continue;
            }
        };
        let (accepted, next_h) =
            control_error((dt, wished), (tried.error2, flow.is_smooth), is_short)?;
        if !accepted {
            done.rejected += 1;
            let between = stages.dense_output((&y, &tried), dt);
            let share =
                flow.exchange_share(|share| start + vec3_at(&between.at(share), DISPLACEMENT));
            let share =
                share.filter(|share| (EXCHANGE_WITHIN.0..EXCHANGE_WITHIN.1).contains(share));
            flow.changes.ends_past_exchange = share.is_some();
            match share {
                Some(share) => step.cut(dt, share),
                None => step.shrink(next_h),
            }
            continue;
        }
        step.grow(next_h);
        flow.state.impact.h = step.wish;
        return Ok(Some(end_of_step(flow, stages, (&y, &tried), dt)));
    }
}

/// A step of `dt` (s) from `y` that is accepted as `tried`, or up to the first contact that begins
/// or ends within it.
fn end_of_step<const C: usize, const N: usize, const Q: usize, const P: usize>(
    flow: &mut SphereFlow<C>,
    stages: &mut Stages<N, Q, P>,
    (y, tried): (&[f64; N], &TrialResult<N, Q>),
    dt: f64,
) -> AcceptedStep {
    let start = flow.state.c;
    let between = stages.dense_output((y, tried), dt);
    let path = |share: f64| {
        let y = between.at(share);
        (start + vec3_at(&y, DISPLACEMENT), vec3_at(&y, V))
    };
    let has_same_contacts = !flow.changes.are_any() && flow.has_unchanged_normals();
    let change = flow.change_share(dt, path);
    let (y_end, sums) = match change {
        Some(share) => (between.at(share), stages.dense_sums(tried, dt).at(share)),
        None => (tried.y, tried.q),
    };
    if change.is_some() {
        // from now on contacts that have begun press, and contacts that have ended are dropped
        flow.rates(0, &y_end, stages.first());
    }
    let end = flow.end(&y_end);
    let mut loss = flow.normal_energy_stored(&sums);
    loss.add(&summed_loss(&sums), 1.0);
    flow.remember();
    AcceptedStep { end, dt: dt * change.unwrap_or(1.0), loss, has_same_contacts }
}

/// Loss by the quadratures of a step, without the energy in normal springs (J).
fn summed_loss<const Q: usize>(sums: &[f64; Q]) -> Loss {
    Loss { friction: sums[0], damping: sums[1], rolling: sums[2], trees: sums[3] }
}

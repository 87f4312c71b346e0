//! One step of sustained contact: what holds the rock bears it, and what it comes to within the step ends the step.

use super::contact::{GroundContact, converge, sustained_m_s};
use super::{is_coming, remember};
use crate::contact::{ContactPoint, MOST, TOUCH};
use crate::rock::Vec3;
use crate::solver::body::Twist;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::step_control::Advance;
use arrayvec::ArrayVec;

/// How often a step is cut to where the rock comes to the next surface, at most: each cut knows the motion on the way better.
const CUTS: u32 = 6;
/// A step may end so far beyond what it meets (–, relative to R).
const OVERSHOOT: f64 = 1e-6;

/// A step as it is tried.
struct HeldStep {
    /// Its length (s).
    dt: f64,
    /// What holds the rock in its middle, with the impulses.
    contacts: ArrayVec<GroundContact, MOST>,
    /// Motion at its end.
    after: Twist,
}

/// One step of at most `longest` (s).
///
/// A step may slide over an edge: half of the turn of the normal lies before its middle and half
/// after it.
pub(super) fn step(
    world: &ContactEnvironment,
    state: &mut ContactState,
    longest: f64,
    done: &mut Advance,
) {
    let mut tried = HeldStep { dt: 0.0, contacts: ArrayVec::new(), after: (state.v, state.w) };
    tried.hold(world, state, closing(world, state, longest));
    for _ in 0..CUTS {
        let Some(met_s) = meets_s(world, state, &tried) else { break };
        tried.hold(world, state, met_s);
    }
    let before = (state.v, state.w);
    let mean = book((world, state), &tried.contacts, [&before, &tried.after], done);
    (state.v, state.w) = tried.after;
    // mean of both velocities: the parabola under weight alone is exact
    state.c += mean.0 * tried.dt;
    done.dt = tried.dt;
    // without any impulse the rock is free, and the next leap takes over
    let pushed = tried.contacts.iter().any(|contact| contact.normal_impulse > 0.0);
    push_out(world, state);
    remember(world, state, pushed);
}

/// What the rock meets at this instant, too slow to rebound, holds it from now on: impulses that take no time.
pub(super) fn meet(world: &ContactEnvironment, state: &mut ContactState, done: &mut Advance) {
    let reach = world.body.radius * (1.0 + TOUCH);
    let touches = || state.touches.iter().filter(|touch| touch.distance_m < reach);
    if !touches().any(|touch| is_coming(world, touch, &state.v)) {
        return;
    }
    let held = |touch: &ContactPoint| GroundContact::new(0, touch, world.law(touch.triangle));
    let mut contacts: ArrayVec<GroundContact, MOST> = touches().map(held).collect();
    let before = (state.v, state.w);
    let after = converge(&mut contacts, &world.body, before, &mut state.sweeps);
    book((world, state), &contacts, [&before, &after], done);
    (state.v, state.w) = after;
}

/// Books what contacts took of the motion between two instants; their mean motion.
fn book(
    (world, state): (&ContactEnvironment, &mut ContactState),
    contacts: &[GroundContact],
    [before, after]: [&Twist; 2],
    done: &mut Advance,
) -> Twist {
    let mean = (0.5 * (before.0 + after.0), 0.5 * (before.1 + after.1));
    for contact in contacts {
        let loss = contact.loss(&world.body, &mean);
        state.stem_load.book((world, contact.triangle), &loss, &mut done.loss);
    }
    mean
}

impl HeldStep {
    /// Takes `dt` (s), with the contacts of the middle, looked for there. What the rock comes to does nothing before it is met.
    fn hold(&mut self, world: &ContactEnvironment, state: &mut ContactState, dt: f64) {
        let half = state.v * (0.5 * dt);
        let middle = state.c + half;
        state.find_contact_points_ahead(world, &middle);
        self.dt = dt;
        self.contacts.clear();
        for touch in state.touches.iter() {
            // what is touched when the step begins is not come to any more: it has been met
            if is_coming(world, touch, &state.v) {
                continue;
            }
            let gap = gap_at_start(world, touch, &half);
            let mut contact = GroundContact::new(0, touch, world.law(touch.triangle));
            contact.target_m_s = sustained_m_s(gap, touch.normal.dot(&state.v), dt);
            self.contacts.push(contact);
        }
        let free = (state.v + world.body.gravity * dt, state.w);
        self.after = converge(&mut self.contacts, &world.body, free, &mut state.sweeps);
    }
}

/// How far a touch of the middle of a step was at its start (m): the rock has moved by `half` since.
fn gap_at_start(world: &ContactEnvironment, touch: &ContactPoint, half: &Vec3) -> f64 {
    touch.distance_m - world.body.radius - touch.normal.dot(half)
}

/// What of the last look the rock comes to.
fn ahead<'s>(
    world: &ContactEnvironment,
    state: &'s ContactState,
) -> impl Iterator<Item = &'s ContactPoint> {
    state.touches.iter().filter(|touch| is_coming(world, touch, &state.v))
}

/// Cuts a step where a gap to a touch of the last look, that at its start, closes.
fn closing(world: &ContactEnvironment, state: &ContactState, dt: f64) -> f64 {
    ahead(world, state).fold(dt, |dt, touch| {
        let gap = touch.distance_m - world.body.radius;
        if gap > TOUCH * world.body.radius { dt.min(gap / -touch.normal.dot(&state.v)) } else { dt }
    })
}

/// When the rock comes to the first of what is ahead (s), if that is within the step, with the acceleration of the step. Beside an edge or a
/// corner, whose normal turns on the way, this is a guess; where it tells nothing it is half of the step.
fn meets_s(world: &ContactEnvironment, state: &ContactState, tried: &HeldStep) -> Option<f64> {
    let (half, radius) = (state.v * (0.5 * tried.dt), world.body.radius);
    let met_s = ahead(world, state).filter_map(|touch| {
        let gap = gap_at_start(world, touch, &half);
        let [speed, end] = [state.v, tried.after.0].map(|v| -touch.normal.dot(&v));
        // `speed² + 2 a gap` with the mean acceleration `a`: negative where it turns back before
        let met2 = speed * speed + 2.0 * gap * (end - speed) / tried.dt;
        let is_met = 0.5 * (speed + end) * tried.dt > gap + OVERSHOOT * radius && met2 >= 0.0;
        let is_known = gap > TOUCH * radius;
        is_met.then(|| if is_known { 2.0 * gap / (speed + met2.sqrt()) } else { 0.5 * tried.dt })
    });
    met_s.reduce(f64::min)
}

/// Way (m) that takes a rock of a radius (m) out of all that it touches, which is `off` (m) from where it was looked for.
pub(in crate::solver) fn way_out(touches: &[ContactPoint], radius_m: f64, off: &Vec3) -> Vec3 {
    // each normal adds what the ones before it have not moved out already
    touches.iter().fold(Vec3::zeros(), |sum, touch| {
        let missing_m = radius_m - touch.distance_m - (sum + off).dot(&touch.normal);
        sum + touch.normal * missing_m.max(0.0)
    })
}

/// Moves a rock that got into the mesh out along the normals; the height it gains is paid by its motion.
///
/// The depth is the error of the step. Lifting the rock out for nothing would create energy at
/// every step of a slide over rough ground.
pub(super) fn push_out(world: &ContactEnvironment, state: &mut ContactState) {
    let (r, before) = (world.body.radius, state.c);
    for _ in 0..4 {
        let c = state.c;
        state.update_contact_points_ahead(world, &c);
        let out = way_out(&state.touches, r, &Vec3::zeros());
        if out.norm() <= TOUCH * r {
            break;
        }
        state.c += out;
    }
    let lifted_j = world.body.lifted_j(&(state.c - before));
    world.body.slow_down((&mut state.v, &mut state.w), lifted_j);
}

//! One step of sustained contact: closed contacts bear the rock, and the step ends where the rock
//! reaches a further surface.

use super::contact::{GroundContact, converge, sustained_m_s};
use super::{is_approaching, update_histories};
use crate::contact::{ContactPoint, MAX_CONTACTS, TOUCH, penetration_correction};
use crate::rock::Vec3;
use crate::solver::body::Twist;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::step_control::Advance;
use arrayvec::ArrayVec;

/// Most cuts of a step to the time at which a surface is reached: each improves the motion that
/// predicts it.
const CUTS: u32 = 6;
/// A step may overshoot a surface by this (–, relative to R).
const OVERSHOOT: f64 = 1e-6;

/// A trial step.
struct HeldStep {
    /// Its length (s).
    dt: f64,
    /// Contacts in its middle, with their impulses.
    contacts: ArrayVec<GroundContact, MAX_CONTACTS>,
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
    tried.solve(world, state, time_until_closed(world, state, longest));
    for _ in 0..CUTS {
        let Some(contact_s) = time_to_contact_s(world, state, &tried) else { break };
        tried.solve(world, state, contact_s);
    }
    let before = (state.v, state.w);
    let mean = book_losses((world, state), &tried.contacts, [&before, &tried.after], done);
    (state.v, state.w) = tried.after;
    // mean of both velocities: the parabola under weight alone is exact
    state.c += mean.0 * tried.dt;
    done.dt = tried.dt;
    // without any impulse the rock is free, and its flight follows
    let pushed = tried.contacts.iter().any(|contact| contact.normal_impulse > 0.0);
    push_out(world, state);
    update_histories(world, state, pushed);
}

/// Captures contacts at this instant that are too slow to rebound, by instantaneous impulses.
pub(super) fn capture(world: &ContactEnvironment, state: &mut ContactState, done: &mut Advance) {
    let reach = world.body.radius * (1.0 + TOUCH);
    let touches = || state.touches.iter().filter(|touch| touch.distance_m < reach);
    if !touches().any(|touch| is_approaching(world, touch, &state.v)) {
        return;
    }
    let held = |touch: &ContactPoint| GroundContact::new(0, touch, world.law(touch.triangle));
    let mut contacts: ArrayVec<GroundContact, MAX_CONTACTS> = touches().map(held).collect();
    let before = (state.v, state.w);
    let after = converge(&mut contacts, &world.body, before, &mut state.sweeps);
    book_losses((world, state), &contacts, [&before, &after], done);
    (state.v, state.w) = after;
}

/// Books the energy that contacts took between two motions; returns the mean motion.
fn book_losses(
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
    /// Solves the step over `dt` (s), with the contacts in its middle. A surface that the rock
    /// approaches exerts no force before it is reached.
    fn solve(&mut self, world: &ContactEnvironment, state: &mut ContactState, dt: f64) {
        let half = state.v * (0.5 * dt);
        let middle = state.c + half;
        state.find_contact_points_ahead(world, &middle);
        self.dt = dt;
        self.contacts.clear();
        for touch in state.touches.iter() {
            // contacts closed at the step's start no longer approach: they have been captured
            if is_approaching(world, touch, &state.v) {
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

/// Gap at the step's start of a contact point in its middle (m): the rock has moved by `half`
/// since.
fn gap_at_start(world: &ContactEnvironment, touch: &ContactPoint, half: &Vec3) -> f64 {
    touch.distance_m - world.body.radius - touch.normal.dot(half)
}

/// Contact points found last that the rock approaches.
fn ahead<'s>(
    world: &ContactEnvironment,
    state: &'s ContactState,
) -> impl Iterator<Item = &'s ContactPoint> {
    state.touches.iter().filter(|touch| is_approaching(world, touch, &state.v))
}

/// Cuts a step where the gap to a contact point found last, at the step's start, closes.
fn time_until_closed(world: &ContactEnvironment, state: &ContactState, dt: f64) -> f64 {
    ahead(world, state).fold(dt, |dt, touch| {
        let gap = touch.distance_m - world.body.radius;
        if gap > TOUCH * world.body.radius { dt.min(gap / -touch.normal.dot(&state.v)) } else { dt }
    })
}

/// Time at which the rock reaches the first surface ahead (s), if within the step, with the mean
/// acceleration of the step. Beside an edge or a corner, whose normal turns during the step, it is
/// an estimate; without a known gap it is half of the step.
fn time_to_contact_s(
    world: &ContactEnvironment,
    state: &ContactState,
    tried: &HeldStep,
) -> Option<f64> {
    let (half, radius) = (state.v * (0.5 * tried.dt), world.body.radius);
    let times_s = ahead(world, state).filter_map(|touch| {
        let gap = gap_at_start(world, touch, &half);
        let [speed, end] = [state.v, tried.after.0].map(|v| -touch.normal.dot(&v));
        // `speed² + 2 a gap` with the mean acceleration `a`: negative where it turns back before
        let speed2_at_contact = speed * speed + 2.0 * gap * (end - speed) / tried.dt;
        let is_met =
            0.5 * (speed + end) * tried.dt > gap + OVERSHOOT * radius && speed2_at_contact >= 0.0;
        let is_known = gap > TOUCH * radius;
        is_met.then(|| {
            if is_known { 2.0 * gap / (speed + speed2_at_contact.sqrt()) } else { 0.5 * tried.dt }
        })
    });
    times_s.reduce(f64::min)
}

/// Moves a rock out of the mesh along the normals; the potential energy gained is taken from its
/// motion.
///
/// The penetration is the error of the step. Lifting the rock without that would create energy at
/// every step of a slide over rough ground.
pub(super) fn push_out(world: &ContactEnvironment, state: &mut ContactState) {
    let (r, before) = (world.body.radius, state.c);
    for _ in 0..4 {
        let c = state.c;
        state.update_contact_points_ahead(world, &c);
        let out = penetration_correction(&state.touches, r, &Vec3::zeros());
        if out.norm() <= TOUCH * r {
            break;
        }
        state.c += out;
    }
    let lifted_j = world.body.lifted_j(&(state.c - before));
    world.body.slow_down((&mut state.v, &mut state.w), lifted_j);
}

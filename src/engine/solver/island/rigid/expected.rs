//! Which blows are due within a step, and when.
//!
//! Between two events of a step a rock that nothing holds is on a parabola, and two of them are on a straight line relative to each other: when they touch is a
//! closed form for a pair, and the first touch of a flight for the mesh, whatever it touches and however short that is. A rock that the mesh holds has
//! its mean velocity in the step: what it comes to is a plane there.

use super::RigidIsland;
use super::contacts::{ImpactScene, OnMesh, StepBody};
use crate::contact::pair::normal_and_distance;
use crate::flight::{FlightEnd, Parabola, time_of_impact_without};
use crate::rock::Vec3;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::island::pair_contact::TOUCH;
use crate::solver::law::capture_m_s;
use crate::solver::rigid::{HELD, is_fast};
use crate::solver::roughness::Meeting;
use std::cmp::Reverse;

/// A touch at the time of a blow that is no farther than this (–, relative to R): a rock that is held is not on a parabola.
pub(super) const NEAR: f64 = 1e-3;

impl RigidIsland {
    /// Notes the blow of a pair, if one is due.
    pub(super) fn expect_pair(&mut self, scene: &ImpactScene, place: usize) {
        let pair_history = &scene.pair_histories[place];
        let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.balls[k as usize]);
        let Some(s) = meeting_before_end_s(a, b) else { return };
        let (n, _) = normal_and_distance(&(a.c - a.v * s), &(b.c - b.v * s));
        if -n.dot(&(a.v - b.v)) >= capture_m_s(&pair_history.law) {
            self.due.push((s.to_bits(), Reverse(place), [a.times, b.times]));
        }
    }

    /// Notes the blow of a rock on the mesh, if one is due.
    pub(super) fn expect_ground(&mut self, scene: &mut ImpactScene, k: usize) {
        let ball = &mut self.balls[k];
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        let flies = ball.on_mesh != OnMesh::Held;
        let exact = if flies { first_touch(&world, state, ball) } else { None };
        // what is slow is met, and more may be struck where the step ends
        let first = match exact {
            Some((s, true)) => Some(s),
            _ => deepest_touch(&world, state, ball),
        };
        if flies {
            let is_slow = exact.is_some_and(|(_, is_fast)| !is_fast);
            ball.on_mesh = if is_slow { OnMesh::Settles } else { OnMesh::Free };
        }
        let meets_facet = || meets_facet(&world, state, ball).then_some(0.0);
        if let Some(s) = first.or_else(meets_facet) {
            let place = scene.pair_histories.len() + k;
            self.due.push((s.to_bits(), Reverse(place), [ball.times; 2]));
        }
    }
}

/// How long before the end of the step two rocks meet (s): on the way since their last blows, if they are apart where that begins, and else where they
/// overlap and come nearer.
fn meeting_before_end_s(a: &StepBody, b: &StepBody) -> Option<f64> {
    let (apart, closing) = (a.c - b.c, a.v - b.v);
    let reach = a.body.radius + b.body.radius;
    let (distance2, widest) = (apart.norm_squared(), reach * (1.0 + TOUCH));
    let (along, speed2, since_s) =
        (apart.dot(&closing), closing.norm_squared(), a.since_s.min(b.since_s));
    if along >= 0.0 {
        // they go apart at the end: they have met if they came nearer at first, and passed at less than the sum of their radii
        let began_along = along - speed2 * since_s;
        let nearest2 = distance2 - along * along / speed2.max(f64::MIN_POSITIVE);
        let began2 = distance2 - (along + began_along) * since_s;
        if began_along >= 0.0 || nearest2 >= reach * reach || began2 <= reach * reach {
            return None;
        }
        let root = (began_along * began_along - speed2 * (began2 - reach * reach)).max(0.0).sqrt();
        return Some(since_s - (began2 - reach * reach) / (root - began_along));
    }
    if distance2 > widest * widest {
        return None;
    }
    // |d − u s| = reach with the smaller cancellation; both parts of the root are positive
    let inside = (reach * reach - distance2).max(0.0);
    let root = (along * along + speed2 * inside).sqrt();
    Some((inside / (root - along)).min(since_s))
}

/// How long before the end of the step a rock in flight first touches the mesh (s), since its last blow, and whether so fast that it rebounds.
fn first_touch(
    world: &ContactEnvironment,
    state: &mut ContactState,
    ball: &StepBody,
) -> Option<(f64, bool)> {
    let (start, velocity) = ball.before_end(ball.since_s);
    let way = velocity.norm().max(ball.v.norm()) * ball.since_s;
    // most rocks of a heap are nowhere near the mesh
    state.know(world, &ball.c);
    let (gravity, radius) = (-world.body.gravity.z, world.body.radius);
    if state.near.are_out_of_reach(world.terrain, &ball.c, (way, radius * (1.0 + TOUCH))) {
        return None;
    }
    let flight = Parabola { start, velocity, gravity, radius };
    let (gone, mut tested) = (&state.near.broken_stems, 0);
    let end = time_of_impact_without(world.terrain, &flight, ball.since_s, gone, &mut tested);
    state.near.tested += tested;
    let FlightEnd::Touch(t) = end else { return None };
    let s = (ball.since_s - t).max(0.0);
    let (at, v) = ball.before_end(s);
    state.look(world, &at, radius * (1.0 + HELD));
    Some((s, state.touches.iter().any(|touch| is_fast(world, touch, &v))))
}

/// How long before the end of the step a rock touched what it is pressed into at the end (s), if it came fast.
fn deepest_touch(
    world: &ContactEnvironment,
    state: &mut ContactState,
    ball: &StepBody,
) -> Option<f64> {
    state.look_ahead_again(world, &ball.c);
    let mut first: Option<f64> = None;
    for touch in state.touches.iter() {
        let s = time_of_touch(ball, &touch.normal, world.body.radius - touch.distance_m);
        let is_fast = |s: &f64| {
            let (_, v) = ball.before_end(*s);
            -touch.normal.dot(&v) >= capture_m_s(world.law(touch.triangle))
        };
        if let Some(s) = s.filter(is_fast) {
            first = Some(first.unwrap_or(0.0).max(s));
        }
    }
    first
}

/// Whether a rock that slides or rolls strikes the next facet of rough ground, the last one being behind it.
fn meets_facet(world: &ContactEnvironment, state: &ContactState, ball: &StepBody) -> bool {
    let reach = ball.body.radius * (1.0 + HELD);
    let mut held = state.touches.iter().filter(|touch| touch.distance_m <= reach);
    held.any(|touch| {
        let at = Meeting { n: touch.normal, triangle: touch.triangle, c: ball.c, v: ball.v };
        state.facets.meet_next(world, &at)
    })
}

/// How long before the end of the step a rock that is pressed in by `pen` (m) along `n` touched (s), on its parabola.
fn time_of_touch(ball: &StepBody, n: &Vec3, penetration: f64) -> Option<f64> {
    let speed = -n.dot(&ball.v);
    let root2 = speed * speed + 2.0 * n.dot(&ball.body.gravity) * penetration.max(0.0);
    let touches = penetration >= -TOUCH * ball.body.radius && speed > 0.0 && root2 > 0.0;
    touches.then(|| (2.0 * penetration.max(0.0) / (speed + root2.sqrt())).min(ball.since_s))
}

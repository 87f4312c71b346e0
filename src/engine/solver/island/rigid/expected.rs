//! Prediction of the impacts within a step, and of their times.
//!
//! Between two impacts of a step a free rock moves on a parabola, and two free rocks move in a straight line relative to each
//! other. The time of contact of a pair is therefore a closed form, and that with the mesh is the first touch of a flight.
//! A rock in sustained contact moves with its mean velocity of the step, and the mesh around it is taken as planes.

use super::RigidIsland;
use super::contacts::{ImpactScene, OnMesh, StepBody};
use crate::contact::TOUCH;
use crate::contact::pair::normal_and_distance;
use crate::flight::{FlightEnd, Parabola, time_of_impact_without};
use crate::rock::Vec3;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::law::capture_m_s;
use crate::solver::rigid::{HELD, is_fast};
use crate::solver::roughness::SurfaceApproach;
use std::cmp::Reverse;

/// Farthest contact point at the time of an impact (–, relative to R): a rock in sustained contact is not on a parabola.
pub(super) const NEAR: f64 = 1e-3;

impl RigidIsland {
    /// Predicts the impact of a pair within the step, if there is one.
    pub(super) fn predict_pair_impact(&mut self, scene: &ImpactScene, place: usize) {
        let pair_history = &scene.pair_histories[place];
        let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.balls[k as usize]);
        let Some(s) = meeting_before_end_s(a, b) else { return };
        let (n, _) = normal_and_distance(&(a.c - a.v * s), &(b.c - b.v * s));
        if -n.dot(&(a.v - b.v)) >= capture_m_s(&pair_history.law) {
            self.pending.push((s.to_bits(), Reverse(place), [a.version, b.version]));
        }
    }

    /// Predicts the impact of a rock on the mesh within the step, if there is one.
    pub(super) fn predict_ground_impact(&mut self, scene: &mut ImpactScene, k: usize) {
        let ball = &mut self.balls[k];
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        let flies = ball.on_mesh != OnMesh::Held;
        let exact = if flies { first_touch(&world, state, ball) } else { None };
        // a slow first contact is captured; the rock may strike more where the step ends
        let first = match exact {
            Some((s, true)) => Some(s),
            _ => deepest_touch(&world, state, ball),
        };
        if flies {
            let is_slow = exact.is_some_and(|(_, is_fast)| !is_fast);
            ball.on_mesh = if is_slow { OnMesh::Captured } else { OnMesh::Free };
        }
        let meets_facet = || meets_facet(&world, state, ball).then_some(0.0);
        if let Some(s) = first.or_else(meets_facet) {
            let place = scene.pair_histories.len() + k;
            self.pending.push((s.to_bits(), Reverse(place), [ball.version; 2]));
        }
    }
}

/// Time from the first contact of two rocks to the end of the step (s): on their paths since their last impacts, if they are
/// apart where these begin; else where they overlap and approach.
fn meeting_before_end_s(a: &StepBody, b: &StepBody) -> Option<f64> {
    let (apart, closing) = (a.c - b.c, a.v - b.v);
    let reach = a.body.radius + b.body.radius;
    let (distance2, widest) = (apart.norm_squared(), reach * (1.0 + TOUCH));
    let (along, speed2, since_s) =
        (apart.dot(&closing), closing.norm_squared(), a.since_s.min(b.since_s));
    if along >= 0.0 {
        // they separate at the end: they have met if they approached at first, and passed at less than the sum of radii
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

/// Time from the first contact of a free rock with the mesh, since its last impact, to the end of the step (s), and whether
/// it is fast enough to rebound.
fn first_touch(
    world: &ContactEnvironment,
    state: &mut ContactState,
    ball: &StepBody,
) -> Option<(f64, bool)> {
    let (start, velocity) = ball.before_end(ball.since_s);
    let way = velocity.norm().max(ball.v.norm()) * ball.since_s;
    // most rocks of a heap are nowhere near the mesh
    state.update_neighbours(world, &ball.c);
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
    state.find_contact_points(world, &at, radius * (1.0 + HELD));
    Some((s, state.touches.iter().any(|touch| is_fast(world, touch, &v))))
}

/// Time from the contact with what a rock is pressed into at the end of the step to that end (s), if it came fast.
fn deepest_touch(
    world: &ContactEnvironment,
    state: &mut ContactState,
    ball: &StepBody,
) -> Option<f64> {
    state.update_contact_points_ahead(world, &ball.c);
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

/// Whether a rock that slides or rolls has left the last facet of rough ground and strikes the next one.
fn meets_facet(world: &ContactEnvironment, state: &ContactState, ball: &StepBody) -> bool {
    let reach = ball.body.radius * (1.0 + HELD);
    let mut held = state.touches.iter().filter(|touch| touch.distance_m <= reach);
    held.any(|touch| {
        let at =
            SurfaceApproach { n: touch.normal, triangle: touch.triangle, c: ball.c, v: ball.v };
        state.facets.meets_new_facet(world, &at)
    })
}

/// Time from the contact of a rock that is pressed in by `penetration` (m) along `n` to the end of the step (s), on its
/// parabola.
fn time_of_touch(ball: &StepBody, n: &Vec3, penetration: f64) -> Option<f64> {
    let speed = -n.dot(&ball.v);
    let root2 = speed * speed + 2.0 * n.dot(&ball.body.gravity) * penetration.max(0.0);
    let touches = penetration >= -TOUCH * ball.body.radius && speed > 0.0 && root2 > 0.0;
    touches.then(|| (2.0 * penetration.max(0.0) / (speed + root2.sqrt())).min(ball.since_s))
}

//! Longest step of a rock that rolls or slides on one plane.
//!
//! On a plane the geometry is constant: a step may be as long as its error allows, if certainly
//! nothing else is touched on the way. That is checked twice: for the straight path before a step
//! is tried, which limits its length, and for the path that it took. Elsewhere the travel in one
//! step is limited to a share of the radius, so that no feature is missed.

use super::body::Body;
use super::contact_state::{AHEAD, ContactEnvironment, ContactState, MARGIN};
use super::plane_state::FIRST_REACH;
use crate::contact::neighbours::{Neighbours, PressedPath};
use crate::flight::min_travel_time_s;
use crate::rock::Vec3;

/// Longest travel on one plane in one step (–, relative to R). From [`FIRST_REACH`] on it doubles
/// where the plane is clear, and is halved where it is not.
const LONGEST: f64 = 2.0;
/// A longer travel is checked only if it is this many times that of steps elsewhere (–) …
const WORTH: f64 = 1.5;
/// … and not again within this distance of where none was clear (–, relative to R).
const RETRY_DISTANCE: f64 = 0.3;
/// Assumed deviation of the path from the straight line (–, relative to its length).
const PATH_OFFSET: f64 = 0.05;

/// A step on a plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneStep {
    /// The plane's face.
    pub(super) face: u32,
    /// Its unit normal, from the mesh to the centre.
    pub(super) n: Vec3,
    /// Where the step begins (m).
    pub(super) start: Vec3,
}

impl PlaneStep {
    /// Whether a rock with the displacement `shift` (m) within `dt` (s), while its velocity changes
    /// by `change` (m/s), has touched nothing but the plane, and is on the same ground at the end.
    pub(super) fn touches_plane_only(
        &self,
        (world, near): (&ContactEnvironment, &Neighbours),
        (shift, change): (&Vec3, &Vec3),
        dt: f64,
    ) -> bool {
        let end = self.start + shift;
        if !near.covers(&end) {
            return false;
        }
        if near.plane() == Some(self.face) {
            return true;
        }
        let penetration_m = (-self.n.dot(shift)).max(0.0);
        let change_m_s = PressedPath::tangent(&self.n, change).norm();
        let path = PressedPath::of(&self.n, self.start, (shift, change_m_s), dt, penetration_m);
        let is_alike = |triangle| world.ground_of(triangle) == world.ground_of(self.face);
        near.meets_only_plane(self.face, &path) && near.is_foot_on_plane(self.face, &end, is_alike)
    }
}

impl ContactState {
    /// Longest step in which the rock misses no feature (s). On one plane its centre stays where
    /// features are known; among several its travel is at most `travel` (–, relative to R).
    pub fn longest_step(&mut self, world: &ContactEnvironment, travel: f64) -> f64 {
        let (c, way) = (self.c, travel * world.body.radius);
        self.update_neighbours(world, &c);
        let is_plane = self.near.plane().is_some();
        let room = if is_plane { self.near.margin_left_m(&c).max(way) } else { way };
        longest_step(&world.body, self.v.norm(), room)
    }

    /// Makes sure that the features along the straight displacement `way` (m), and a little beside
    /// it, are collected.
    pub(super) fn collect_along(&mut self, world: &ContactEnvironment, way: &Vec3) {
        if self.near.covers(&self.c) && self.near.covers(&(self.c + way)) {
            return;
        }
        let (r, length) = (world.body.radius, way.norm());
        let ahead = (0.5 * length).max(AHEAD * r);
        let centre = self.c + way * (ahead / length.max(f64::MIN_POSITIVE));
        self.collect_within(world, &centre, ahead + (MARGIN - AHEAD) * r);
    }

    /// Longest step on the plane of `face` (s), about `proposed_s` at most where it exceeds that of
    /// the travel `least` (m), which is allowed everywhere.
    pub(super) fn longest_on_plane_s(
        &mut self,
        world: &ContactEnvironment,
        face: u32,
        (proposed_s, least): (f64, f64),
    ) -> f64 {
        let (body, speed) = (&world.body, self.v.norm());
        let proposed_m = (speed + 0.5 * body.gravity.norm() * proposed_s) * proposed_s;
        longest_step(body, speed, self.clear_way_m(world, face, (proposed_m, least)))
    }

    /// Longest travel on the plane of `face` in one step (m), `proposed` at most; `least` is allowed
    /// everywhere.
    fn clear_way_m(
        &mut self,
        world: &ContactEnvironment,
        face: u32,
        (proposed_m, least): (f64, f64),
    ) -> f64 {
        let (radius, speed) = (world.body.radius, self.v.norm());
        // the next facet limits the step
        let to_facet = self.facets.distance_to_facet_m(&self.c);
        let most = proposed_m.min(self.plane.reach * radius).min(to_facet);
        let is_too_near =
            (self.c - self.plane.blocked_at).norm_squared() < (RETRY_DISTANCE * radius).powi(2);
        if most < WORTH * least || speed == 0.0 || is_too_near || self.plane.ploughs {
            return least;
        }
        let direction = self.v / speed;
        self.collect_along(world, &(direction * most));
        let most = most.min(self.near.margin_ahead_m(&self.c, &direction));
        if self.is_clear(face, &(direction * most)) {
            self.plane.reach = (2.0 * most / radius).clamp(FIRST_REACH, LONGEST);
            return most.max(least);
        }
        self.plane.reach *= 0.5;
        if self.plane.reach * radius < WORTH * least {
            (self.plane.reach, self.plane.blocked_at) = (FIRST_REACH, self.c);
        }
        least
    }

    /// Whether nothing but the plane of `face` is touched on a straight displacement (m).
    fn is_clear(&self, face: u32, way: &Vec3) -> bool {
        if self.near.plane() == Some(face) {
            return true;
        }
        let (start, into, deviation_m) = (self.c, Vec3::zeros(), PATH_OFFSET * way.norm());
        let reach_m = way.norm() + deviation_m;
        self.near
            .meets_only_plane(face, &PressedPath { start, along: *way, into, deviation_m, reach_m })
    }
}

/// Longest step in which a rock at `speed` travels no further than `room` (s), with acceleration by
/// its weight.
pub(crate) fn longest_step(body: &Body, speed: f64, room: f64) -> f64 {
    min_travel_time_s(room, speed, body.gravity.norm())
}

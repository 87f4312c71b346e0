//! Rough ground: at an impact a rock hits a facet that is tilted against the mesh.
//!
//! A falling rock sees the facets that face it: the tilt is uniform in its angle, from nothing to the ground's roughness, and in
//! its direction, weighted by `max(0, −v·n′)/|v|` with `n′` the tilted normal, the flux of the rock through the facet. The rock
//! is turned against the tilt, meets the smooth surface and is turned back when the impact is over; turning keeps every joule.
//! A rebound into the mean surface is simply the next impact.
//!
//! Roughness belongs to the place: until the rock has moved on by the ground's roughness length it meets the same facet, so
//! that the number of its small impacts, which is a matter of stiffness and steps, does not decide how often it is deflected.

use super::driver::Fall;
use crate::math;
use crate::random::{RandomStream, unit};
use crate::rock::Vec3;
use nalgebra::{Rotation3, Unit};
use std::f64::consts::TAU;

/// Facets drawn until one faces the rock; after that the impact is smooth. At 1° of incidence one in sixty does.
const DRAWS: u32 = 1000;

/// The facet met last, and the tilt in hand.
#[derive(Debug, Default)]
pub(super) struct Roughness {
    facet: Option<Facet>,
    tilt: Option<Tilt>,
}

#[derive(Debug)]
struct Facet {
    /// Where the rock was (m), and on which ground.
    centre: Vec3,
    ground: u16,
    turn: Rotation3<f64>,
}

#[derive(Debug)]
struct Tilt {
    turn: Rotation3<f64>,
    /// When the impact is over at the latest (s).
    until_s: f64,
}

impl Fall<'_> {
    /// Turns the rock against the facet of an impact on the surface with `normal` that has just begun on a triangle and
    /// lasts until `until_s` at most.
    pub(super) fn meet_facet(&mut self, normal: Vec3, triangle: u32, until_s: f64) {
        let law = self.world.law(triangle);
        if law.roughness_rad <= 0.0 {
            return;
        }
        let (most, length_m) = (law.roughness_rad, law.roughness_length_m);
        self.leave_facet();
        let v = self.state.v;
        let terrain = self.world.terrain;
        let ground = terrain.sheets[terrain.sheet_of[triangle as usize] as usize].ground;
        let faces = |turn: &Rotation3<f64>| -(turn * normal).dot(&v) > 0.0;
        let known = self.roughness.facet.as_ref().filter(|facet| {
            facet.ground == ground
                && (facet.centre - self.state.c).norm() < length_m
                && faces(&facet.turn)
        });
        let turn = if let Some(facet) = known {
            facet.turn
        } else {
            let Some(turn) = draw(self.random, &normal, most, &v) else { return };
            self.roughness.facet = Some(Facet { centre: self.state.c, ground, turn });
            turn
        };
        self.turn_rock(&turn.inverse());
        self.roughness.tilt = Some(Tilt { turn, until_s });
    }

    /// Turns the rock back if its impact is over: it is free, or the time of the impact is up.
    pub(super) fn leave_facet_in_time(&mut self) {
        let now_s = self.recorder.now.time_s;
        let is_over = |tilt: &Tilt| now_s >= tilt.until_s;
        if self.state.is_free() || self.roughness.tilt.as_ref().is_some_and(is_over) {
            self.leave_facet();
        }
    }

    /// Turns the rock back, if it is turned.
    pub(super) fn leave_facet(&mut self) {
        if let Some(tilt) = self.roughness.tilt.take() {
            self.turn_rock(&tilt.turn);
            // a rebound into the mean surface is the next impact
            self.recorder.impacts.forget_last();
            let now = &mut self.recorder.now;
            (now.velocity_m_s, now.spin_rad_s) = (self.state.v, self.state.w);
        }
    }

    fn turn_rock(&mut self, turn: &Rotation3<f64>) {
        self.state.redirect(&self.world, turn * self.state.v, turn * self.state.w);
    }
}

/// A facet that a rock with velocity `v` sees, as the rotation from the surface with `normal` to it.
fn draw(random: &mut RandomStream, normal: &Vec3, most: f64, v: &Vec3) -> Option<Rotation3<f64>> {
    let speed = v.norm();
    let beside = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let across = normal.cross(&beside);
    (0..DRAWS).find_map(|_| {
        let around = math::turn(&Unit::new_normalize(*normal), TAU * unit(random));
        let axis = Unit::new_normalize(around * across);
        let turn = math::turn(&axis, most * unit(random));
        let seen = -(turn * normal).dot(v);
        (seen > speed * unit(random)).then_some(turn)
    })
}

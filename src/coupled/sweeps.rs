//! Force sweeps: all contacts of an island solved one after the other until none changes.
//!
//! Nonlinear Gauss–Seidel in the forces, with the set-valued normal law and a warm start. Where contacts oppose each
//! other stiffly (a light rock under a heavy one, a high pile) sweeps creep; then the island is solved at once in the
//! modes that they have found, and the sweeps judge the result.

use super::bridge::Motion;
use super::cluster::Cluster;
use super::jump::jump;
use super::member::Member;
use crate::rock::Vec3;
use crate::step::joint::Normal;
use crate::step::law::within;

/// Sweeps before the first jump, and between two of them: at least, for each rock, and at most.
const SWEEPS: (usize, usize, usize) = (6, 2, 60);
/// Jumps after which a stage is given up; the step is then halved.
const JUMPS: usize = 10;
/// Change of velocity by a change of force, relative to the step's tolerance, below which the force has settled (–).
const SETTLED: f64 = 1e-6;
/// Change of a force, relative to itself, that is rounding (–).
const ROUNDING: f64 = 1e-11;

impl Cluster<'_> {
    /// Finds all contact forces of a stage of length `h`; whether they settled.
    pub(super) fn settle(&mut self, h: f64) -> bool {
        self.drive(h);
        let sweeps = (SWEEPS.0 + SWEEPS.1 * self.members.len()).min(SWEEPS.2);
        for round in 0..JUMPS {
            for k in 0..sweeps {
                self.sweeps += 1;
                if self.sweep(h, k % 2 == 1) {
                    return true;
                }
            }
            if round + 1 < JUMPS {
                self.jumps += 1;
                if let Some(motions) = jump(&self.members, &self.bridges, h) {
                    self.act_on(&motions, h);
                    self.drive(h);
                }
            }
        }
        false
    }

    /// Motions from all forces together.
    fn drive(&mut self, h: f64) {
        for member in &mut self.members {
            member.now = member.free;
            for spot in &member.grip.spots[..member.grip.spot_count] {
                let (dv, dw) = spot.effect(&member.body, h);
                member.now.0 += dv;
                member.now.1 += dw;
            }
        }
        for bridge in &self.bridges {
            for k in 0..2 {
                let Member { body, now, .. } = &mut *self.members[bridge.ends[k]];
                bridge.act(k, body, h, now);
            }
        }
    }

    /// One pass over the contacts, onwards or backwards; whether nothing changed.
    fn sweep(&mut self, h: f64, backwards: bool) -> bool {
        let (spots, bridges) = (self.members.len(), self.bridges.len());
        let mut settled = true;
        for k in 0..spots + bridges {
            let k = if backwards { spots + bridges - 1 - k } else { k };
            settled &=
                if k < spots { self.sweep_spots(k, h) } else { self.sweep_bridge(k - spots, h) };
        }
        settled
    }

    fn sweep_spots(&mut self, k: usize, h: f64) -> bool {
        let member = &mut *self.members[k];
        let (body, mut settled) = (&member.body, true);
        for spot in &mut member.grip.spots[..member.grip.spot_count] {
            let before = (spot.push, spot.drag, spot.moment);
            let (dv, dw) = spot.effect(body, h);
            let free = (member.now.0 - dv, member.now.1 - dw);
            spot.solve(body, &free.0, &free.1, h);
            let (dv, dw) = spot.effect(body, h);
            member.now = (free.0 + dv, free.1 + dw);
            let change = (spot.push - before.0).abs().max((spot.drag - before.1).norm());
            let change = change.max((spot.moment - before.2).norm() / body.radius);
            let allowed = SETTLED * self.tolerance * body.mass / h;
            settled &= change <= allowed.max(ROUNDING * spot.push);
        }
        settled
    }

    fn sweep_bridge(&mut self, k: usize, h: f64) -> bool {
        let bridge = &mut self.bridges[k];
        let before = (bridge.push, bridge.drag);
        let mut motions: [Motion; 2] = [(Vec3::zeros(), Vec3::zeros()); 2];
        for (k, motion) in motions.iter_mut().enumerate() {
            let member = &self.members[bridge.ends[k]];
            *motion = member.now;
            bridge.act(k, &member.body, -h, motion);
        }
        bridge.solve([&motions[0], &motions[1]], h);
        for (k, motion) in motions.iter_mut().enumerate() {
            let member = &mut self.members[bridge.ends[k]];
            bridge.act(k, &member.body, h, motion);
            member.now = *motion;
        }
        let change = (bridge.push - before.0).abs().max((bridge.drag - before.1).norm());
        let allowed = SETTLED * self.tolerance / (h * bridge.inv_m);
        change <= allowed.max(ROUNDING * bridge.push.abs())
    }

    /// Sets every force to what its law gives at these motions.
    fn act_on(&mut self, motions: &[Motion], h: f64) {
        for (member, (v, w)) in self.members.iter_mut().zip(motions) {
            let Member { grip, body, .. } = &mut **member;
            for spot in &mut grip.spots[..grip.spot_count] {
                let law = spot.law;
                let springs = (law.p_n, spot.c_n);
                let line = Normal::line(springs, (spot.pen, spot.push), body.mass, h);
                spot.push = line.at(spot.n.dot(v));
                let (stick, wound) = spot.trials(body, v, w, h);
                spot.drag = within(stick, law.friction * spot.push);
                spot.moment = within(wound, law.rolling_m * spot.push);
            }
        }
        for bridge in &mut self.bridges {
            let ends = bridge.ends.map(|k| &motions[k]);
            let (law, speed, stick) = (bridge.law, bridge.speed(ends), bridge.trial(ends, h));
            if bridge.bond.is_some() {
                bridge.push = law.p_n * (bridge.pen - h * speed) - bridge.c_n * speed;
                bridge.drag = stick;
            } else {
                let springs = (law.p_n, bridge.c_n);
                let state = (bridge.pen, bridge.push);
                bridge.push = Normal::line(springs, state, 1.0 / bridge.inv_m, h).at(speed);
                bridge.drag = within(stick, law.friction * bridge.push);
            }
        }
    }
}

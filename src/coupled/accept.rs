//! The end of an accepted step: memories, bonds, angular momentum.

use super::cluster::{Cluster, Done, Given};
use super::member::Member;
use crate::contact::hold::carry;
use crate::contact::pair::{Bond, Tie, between};
use crate::math;
use crate::rock::Vec3;
use crate::step::adaptive;
use crate::step::grip::{Loss, World};
use crate::step::law::within;
use crate::step::tableau::Tableau;
use nalgebra::Matrix3;

impl Cluster<'_> {
    /// Takes over the step's end.
    pub(super) fn accept(&mut self, tableau: &Tableau, dt: f64) -> Done {
        let mut done = Done { dt, ..Done::default() };
        let before = self.angular_state();
        for member in &mut self.members {
            let mut loss = Loss::default();
            let end = member.end;
            let Member { grip, body, laws, .. } = &mut **member;
            let world = World { terrain: self.terrain, body: *body, laws };
            adaptive::accept(&world, tableau, grip, (&end, dt), &mut loss);
            // a merged contact acts otherwise than its rates say
            self.fresh &= grip.fresh;
            done.losses.push(loss);
            let mut given = Given::default();
            for k in 0..tableau.stages {
                given.add(&member.given[k], dt * tableau.work_weight(k));
            }
            done.given.push(given);
            member.given[0] = member.given[tableau.stages - 1];
        }
        done.broken = self.accept_ties(tableau, dt);
        for member in &mut self.members {
            member.flying = member.grip.is_free();
        }
        for tie in self.ties.iter().filter(|tie| tie.is_held()) {
            for k in [tie.a, tie.b] {
                self.members[k as usize].flying = false;
            }
        }
        self.keep_spin(before);
        done
    }

    fn accept_ties(&mut self, tableau: &Tableau, dt: f64) -> u64 {
        let (last, hh) = (tableau.stages - 1, tableau.diagonal * dt);
        let mut broken = 0;
        let mut bridges = self.bridges.iter().peekable();
        for (k, tie) in self.ties.iter_mut().enumerate() {
            let Some(bridge) = bridges.next_if(|bridge| bridge.tie == k) else {
                (tie.closed, tie.push, tie.drag, tie.shear) =
                    (false, 0.0, Vec3::zeros(), Vec3::zeros());
                self.tie_rates[k][0] = Vec3::zeros();
                continue;
            };
            let [a, b] = bridge.ends.map(|k| &self.members[k]);
            let (_, distance) = between(&a.grip.c, &b.grip.c);
            let from = if tie.is_held() { tie.n } else { bridge.n };
            let rate = carry(self.tie_rates[k][last], &from, &bridge.n);
            let stretch = bridge.stretch(hh);
            // The spring turns with the two rocks about their line.
            let turn = 0.5 * dt * (a.grip.w + b.grip.w).dot(&bridge.n);
            let turned = |x: Vec3| x * math::cos(turn) + bridge.n.cross(&x) * math::sin(turn);
            (tie.push, tie.drag, tie.n) = (bridge.push, bridge.drag, bridge.n);
            tie.captured = bridge.captured;
            tie.closed = bridge.push > 0.0 || distance < a.body.radius + b.body.radius;
            tie.shear =
                if tie.closed || tie.bond.is_some() { turned(stretch) } else { Vec3::zeros() };
            self.tie_rates[k][0] = if tie.is_held() { turned(rate) } else { Vec3::zeros() };
            tie.slides =
                tie.bond.is_none() && tie.drag.norm() >= tie.law.friction * tie.push * (1.0 - 1e-9);
            let overload = |bond| Bond::overload(bond, tie.push, tie.drag.norm(), tie.law.friction);
            if tie.bond.as_ref().is_some_and(|bond| overload(bond) > 0.0) {
                break_bond(tie);
                self.tie_forces[k] = (tie.push, tie.drag);
                self.fresh = false;
                broken += 1;
                tie.closed = distance < a.body.radius + b.body.radius;
            }
        }
        broken
    }
}

/// A broken bond keeps what friction can hold; the rest of its stretch is lost.
pub(super) fn break_bond(tie: &mut Tie) {
    tie.bond = None;
    tie.captured = true;
    tie.push = tie.push.max(0.0);
    let cap = tie.law.friction * tie.push / tie.law.p_s;
    tie.shear = within(tie.shear, cap);
    tie.drag = within(tie.drag, tie.law.friction * tie.push);
}

impl Cluster<'_> {
    /// Angular momentum about the common centre of mass (kg m²/s) of an island that touches nothing but itself.
    fn angular_state(&self) -> Option<Vec3> {
        let alone = self.members.iter().all(|m| m.grip.holds.iter().all(|hold| !hold.closed))
            && self.ties.iter().any(Tie::is_held);
        alone.then(|| self.angular_momentum())
    }

    fn centre(&self) -> (f64, Vec3, Vec3) {
        let mut sum = (0.0, Vec3::zeros(), Vec3::zeros());
        for member in &self.members {
            sum.0 += member.body.mass;
            sum.1 += member.grip.c * member.body.mass;
            sum.2 += member.grip.v * member.body.mass;
        }
        (sum.0, sum.1 / sum.0, sum.2 / sum.0)
    }

    fn angular_momentum(&self) -> Vec3 {
        let (_, c, v) = self.centre();
        self.members.iter().fold(Vec3::zeros(), |sum, member| {
            let orbit = (member.grip.c - c).cross(&((member.grip.v - v) * member.body.mass));
            sum + orbit + member.grip.w * member.body.inertia
        })
    }

    /// Gives back the angular momentum that the step's own error took from a free island, by a turn of the whole:
    /// far less than the tolerance, but a free collision keeps it to rounding.
    fn keep_spin(&mut self, before: Option<Vec3>) {
        let Some(before) = before else { return };
        if self.members.iter().any(|m| m.grip.holds.iter().any(|hold| hold.closed)) {
            return;
        }
        let lost = before - self.angular_momentum();
        let (_, c, _) = self.centre();
        let spins = self.ties.iter().any(|tie| tie.law.friction > 0.0);
        let mut inertia = Matrix3::zeros();
        for member in &self.members {
            let d = member.grip.c - c;
            let (m, own) = (member.body.mass, if spins { member.body.inertia } else { 0.0 });
            inertia += Matrix3::identity() * (own + m * d.norm_squared()) - d * d.transpose() * m;
        }
        let Ok(turn) = inertia.pseudo_inverse(1e-9 * inertia.norm()).map(|inverse| inverse * lost)
        else {
            return;
        };
        for member in self.members.iter_mut().map(|seat| &mut **seat) {
            member.grip.v += turn.cross(&(member.grip.c - c));
            if spins {
                member.grip.w += turn;
            }
        }
    }
}

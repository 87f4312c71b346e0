//! One implicit stage of an island, and the rates at its start.

use super::bridge::Bridge;
use super::cluster::{Cluster, Given, TOUCH};
use super::member::Member;
use crate::contact::hold::carry;
use crate::rock::Vec3;
use crate::step::grip::World;
use crate::step::stage::{AGREED, PASSES};
use crate::step::tableau::Tableau;

impl Cluster<'_> {
    /// Solves implicit stage `i` of a step of length `h` and stores its rates.
    pub(super) fn stage(&mut self, tableau: &Tableau, i: usize, h: f64) -> Option<()> {
        let hh = tableau.diagonal * h;
        for member in &mut self.members {
            let before = &member.grip.rates[i - 1];
            let (ahead_c, ahead_v) = (before.c, before.v);
            member.base = member.grip.base(tableau, i, h);
            member.guess = member.base.c + (ahead_c + ahead_v * hh) * hh;
            member.free = (member.base.v + member.body.gravity * hh, member.base.w);
            member.look(self.terrain);
        }
        for _ in 0..PASSES {
            for member in &mut self.members {
                member.place_spots(self.terrain, tableau, (i, h));
            }
            self.place_bridges(tableau, (i, h));
            if !self.settle(hh) {
                return None;
            }
            let mut agreed = true;
            for member in &mut self.members {
                let c = member.base.c + member.now.0 * hh;
                let allowed = AGREED * member.body.radius;
                agreed &= (c - member.guess).norm() <= allowed;
                member.guess = c;
                member.look(self.terrain);
            }
            if agreed {
                self.store(i, hh);
                return Some(());
            }
        }
        None
    }

    /// Makes the ties of rocks that are near into bridges based at the stage's base.
    fn place_bridges(&mut self, tableau: &Tableau, (i, h): (usize, f64)) {
        self.bridges.clear();
        for (k, tie) in self.ties.iter().enumerate() {
            let [a, b] = [tie.a, tie.b].map(|k| &self.members[k as usize]);
            let slack = 0.1 * a.body.radius.min(b.body.radius);
            let bodies = [&a.body, &b.body];
            let Some(mut bridge) = Bridge::over(tie, bodies, [&a.guess, &b.guess], slack) else {
                continue;
            };
            bridge.tie = k;
            let apart = bridge.n.dot(&((a.base.c - b.base.c) - (a.guess - b.guess)));
            bridge.pen -= apart;
            if !tie.is_held() {
                bridge.captured = -bridge.n.dot(&(a.base.v - b.base.v)) < tie.law.capture_m_s;
                bridge.c_n = if bridge.captured { tie.law.c_n_captured } else { tie.law.c_n };
            }
            let from = if tie.is_held() { tie.n } else { bridge.n };
            let mut shear = tie.shear;
            for (rate, a) in self.tie_rates[k].iter().zip(tableau.a[i]) {
                shear += rate * (h * a);
            }
            bridge.shear = carry(shear, &from, &bridge.n);
            (bridge.push, bridge.drag) = self.tie_forces[k];
            self.bridges.push(bridge);
        }
    }

    fn store(&mut self, i: usize, hh: f64) {
        for member in &mut self.members {
            member.given[i] = Given::default();
        }
        for (rates, tie) in self.tie_rates.iter_mut().zip(&self.ties) {
            rates[i] = Vec3::zeros();
            debug_assert!(tie.a < tie.b);
        }
        for bridge in &self.bridges {
            let tie = &self.ties[bridge.tie];
            let from = if tie.is_held() { tie.n } else { bridge.n };
            let rate = (bridge.stretch(hh) - bridge.shear) / hh;
            self.tie_rates[bridge.tie][i] = carry(rate, &bridge.n, &from);
            self.tie_forces[bridge.tie] = (bridge.push, bridge.drag);
            let power = |k: usize| {
                let (v, w) = &self.members[bridge.ends[k]].now;
                let (force, moment) = bridge.load(k);
                -force.dot(v) - moment.dot(w)
            };
            for (end, given) in bridge.ends.into_iter().zip(Given::of_ends([power(0), power(1)])) {
                self.members[end].given[i].add(&given, 1.0);
            }
        }
        for member in &mut self.members {
            member.store(self.terrain, (i, hh));
        }
    }

    /// Rates at the present state, for the explicit first stage.
    pub(super) fn rates_now(&mut self) {
        for member in &mut self.members {
            let Member { grip, body, laws, .. } = &mut **member;
            let world = World { terrain: self.terrain, body: *body, laws };
            grip.rates_now(&world);
            member.given[0] = Given::default();
        }
        for (k, tie) in self.ties.iter_mut().enumerate() {
            self.tie_rates[k][0] = Vec3::zeros();
            let ends = [tie.a as usize, tie.b as usize];
            let [a, b] = ends.map(|k| &self.members[k]);
            let touch = TOUCH * (a.body.radius + b.body.radius);
            let at = [&a.grip.c, &b.grip.c];
            let Some(mut bridge) = Bridge::over(tie, [&a.body, &b.body], at, touch) else {
                continue;
            };
            let motions = [(a.grip.v, a.grip.w), (b.grip.v, b.grip.w)];
            if !tie.is_held() {
                bridge.captured = -bridge.speed([&motions[0], &motions[1]]) < tie.law.capture_m_s;
                bridge.c_n = if bridge.captured { tie.law.c_n_captured } else { tie.law.c_n };
                tie.n = bridge.n;
            }
            bridge.shear = carry(tie.shear, &tie.n, &bridge.n);
            let rate = bridge.act_now([&motions[0], &motions[1]]);
            self.tie_rates[k][0] = carry(rate, &bridge.n, &tie.n);
            let power = |k: usize| {
                let (force, moment) = bridge.load(k);
                -force.dot(&motions[k].0) - moment.dot(&motions[k].1)
            };
            let given = Given::of_ends([power(0), power(1)]);
            for end in 0..2 {
                let member = &mut *self.members[ends[end]];
                let (force, moment) = bridge.load(end);
                let rate = &mut member.grip.rates[0];
                rate.v += force / member.body.mass;
                rate.w += moment / member.body.inertia;
                member.given[0].add(&given[end], 1.0);
            }
        }
        self.fresh = true;
    }
}

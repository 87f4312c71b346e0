//! One implicit stage of an island, and the rates at its start.
//!
//! Stage `i` ends at `x_i = x_base + h γ f(x_i)` with `x_base = x + h Σ a_ij f_j` of the stages
//! before. Normals and penetrations are those at the end of the stage, so geometry and forces
//! depend on each other. A fixed-point iteration solves the forces with the geometry of a guess and
//! moves the guess to the resulting positions, until both agree. On planes one pass suffices,
//! around corners and between spheres a few.
//!
//! The equations of one rock are those of `solver::stage`. In addition forces between rocks act on
//! two of them with opposite signs, and all rocks must converge before the next stage begins.

use super::assembly::Island;
use super::pair_contact::PairContact;
use crate::contact::TOUCH;
use crate::contact::history::transport;
use crate::rock::Vec3;
use crate::solver::loss::EnergyGiven;
use crate::solver::stage::{PASSES, SHIFT_CONVERGED};
use crate::solver::tableau::{STAGES, Tableau};

/// Gap below which two rocks are in potential contact whatever their motion (–, relative to the
/// smaller radius): far more than the error that the passes of a stage leave.
const PAIR_GAP: f64 = 1e-6;

/// Change of a centre (–, relative to the radius) at which the iteration has converged in an island
/// of more than a few rocks …
const SHIFT_CONVERGED_OF_MANY: f64 = 1e-6;
/// … if the effect of the resulting rotation of normals on a velocity is at most this (–, relative
/// to the local error allowed).
const TURN_EFFECT: f64 = 1e-2;

impl Island<'_> {
    /// Solves implicit stage `i` of a step of length `h` and stores its rates.
    ///
    /// Outer loop: geometry; inner: forces (`converge`). A step in which either fails is tried
    /// again, shorter.
    pub(super) fn stage(&mut self, tableau: &Tableau, i: usize, h: f64) -> Option<()> {
        // γ h, the same for all stages: contacts keep their effective stiffness through the step
        let hh = tableau.diagonal * h;
        for member in &mut self.members {
            // the guess extrapolates with velocity and acceleration of the stage before
            let before = &member.state.rates[i - 1];
            let (ahead_c, ahead_v) = (before.c, before.v);
            member.base = member.state.base(tableau, i, h);
            member.guess = member.base.c + (ahead_c + ahead_v * hh) * hh;
            // motion in the stage without contacts: weight changes the velocity, the spin is
            // constant
            member.free = (member.base.v + member.body.gravity * hh, member.base.w);
            member.find_contact_points(self.terrain);
        }
        // without convergence within so many passes the step is too long: it is tried again,
        // shorter
        for _ in 0..PASSES {
            for member in &mut self.members {
                member.place_contacts(self.terrain, tableau, (i, h));
            }
            self.place_pairs(tableau, (i, h));
            // sweeps and Newton steps over all contacts of the island
            if !self.converge(hh) {
                return None;
            }
            let mut agreed = true;
            for (member, motion) in self.members.iter_mut().zip(&self.motions) {
                // the stage's end with the forces just found
                let c = member.base.c + motion.0 * hh;
                // every rock must converge: its contacts decide the forces on its neighbours
                let allowed = if self.active.is_small() {
                    SHIFT_CONVERGED
                } else {
                    // normals rotate by the change over the radius, and with them the velocity that
                    // contacts have given
                    let pushed_m_s = (motion.0 - member.free.0).norm().max(f64::MIN_POSITIVE);
                    (TURN_EFFECT * self.tolerance / pushed_m_s)
                        .clamp(SHIFT_CONVERGED, SHIFT_CONVERGED_OF_MANY)
                };
                agreed &= (c - member.guess).norm() <= allowed * member.body.radius;
                member.guess = c;
                member.find_contact_points(self.terrain);
            }
            if agreed {
                self.store(i, hh);
                return Some(());
            }
        }
        None
    }

    /// Makes contacts of the pairs of rocks in potential contact, based at the stage's base.
    ///
    /// A pair is a candidate if it may close within the stage by its relative velocity at the base;
    /// the solution decides whether it closes. Pairs that close because others set them in motion
    /// are found in the next pass, from the new guess.
    fn place_pairs(&mut self, tableau: &Tableau, (i, h): (usize, f64)) {
        let hh = tableau.diagonal * h;
        self.pairs.clear();
        for (k, pair_history) in self.pair_histories.iter().enumerate() {
            let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.members[k as usize]);
            let passes_m = (a.base.v - b.base.v).norm() * hh;
            let slack = PAIR_GAP * a.body.radius.min(b.body.radius) + 2.0 * passes_m;
            let bodies = [&a.body, &b.body];
            let Some(mut pair) =
                PairContact::of_pair(pair_history, bodies, [&a.guess, &b.guess], slack)
            else {
                continue;
            };
            pair.pair_history = k;
            // penetration is measured from the base, along the normal of the guess
            let apart = pair.n.dot(&((a.base.c - b.base.c) - (a.guess - b.guess)));
            pair.penetration -= apart;
            // a new contact: whether it rebounds is judged by the approach at the stage's base
            if !pair_history.is_held() {
                let impact_m_s = a.impact_m_s.max(b.impact_m_s);
                let approach_m_s = -pair.n.dot(&(a.base.v - b.base.v));
                pair.begin(approach_m_s, impact_m_s);
                if self.onset.deferred {
                    pair.defer_impact(approach_m_s);
                }
            }
            // the stored stretch is rotated with the normal: the spring stays in the tangent plane
            let from = if pair_history.is_held() { pair_history.n } else { pair.n };
            // base of the stretch: as for positions, from the state and the earlier stages
            let from_rates = (pair_history.shear, &self.pair_rates[k][..]);
            let shear = tableau.base((i, h), from_rates, |rate| *rate);
            pair.shear = transport(shear, &from, &pair.n);
            (pair.normal_force, pair.shear_force) = self.pair_forces[k];
            self.pairs.push(pair);
        }
    }

    /// Stores the results of stage `i`: rates of all springs, forces, and the power that each end
    /// gives through its contacts (W).
    fn store(&mut self, i: usize, hh: f64) {
        for member in &mut self.members {
            member.given[i] = EnergyGiven::default();
        }
        for (rates, pair_history) in self.pair_rates.iter_mut().zip(&self.pair_histories) {
            rates[i] = Vec3::zeros();
            debug_assert!(pair_history.a < pair_history.b);
        }
        for pair in &self.pairs {
            let pair_history = &self.pair_histories[pair.pair_history];
            let from = if pair_history.is_held() { pair_history.n } else { pair.n };
            // slope of the stage from its base to its end, as for position and velocity
            let rate = (pair.stretch(hh) - pair.shear) / hh;
            self.pair_rates[pair.pair_history][i] = transport(rate, &pair.n, &from);
            self.pair_forces[pair.pair_history] = (pair.normal_force, pair.shear_force);
            let power = |k: usize| {
                let (v, w) = &self.motions[pair.ends[k]];
                let (force, rolling_moment) = pair.load(k);
                -force.dot(v) - rolling_moment.dot(w)
            };
            let separation_m_s = pair.speed(pair.ends.map(|end| &self.motions[end]));
            self.onset.is_reached |= pair.deferred && pair.penetration_at(separation_m_s, hh) > 0.0;
            for (end, given) in
                pair.ends.into_iter().zip(EnergyGiven::of_ends([power(0), power(1)]))
            {
                self.members[end].given[i].add(&given, 1.0);
            }
        }
        for (member, motion) in self.members.iter_mut().zip(&self.motions) {
            member.store(self.terrain, *motion, (i, hh));
        }
    }

    /// Rates at the present state, for the explicit first stage.
    ///
    /// Nothing is solved: forces follow from positions, velocities and stretches as they are
    /// (`set_forces_now`).
    pub(super) fn rates_now(&mut self) {
        for member in &mut self.members {
            let (world, state) = member.with_environment(self.terrain);
            state.rates_now(&world);
            member.given[0] = EnergyGiven::default();
        }
        self.pair_rates.resize(self.pair_histories.len(), [Vec3::zeros(); STAGES]);
        for (k, pair_history) in self.pair_histories.iter_mut().enumerate() {
            self.pair_rates[k][0] = Vec3::zeros();
            let ends = [pair_history.a as usize, pair_history.b as usize];
            let [a, b] = ends.map(|k| &self.members[k]);
            let touch = TOUCH * (a.body.radius + b.body.radius);
            let at = [&a.state.c, &b.state.c];
            // pairs that do not touch at the start have no force
            let Some(mut pair) = PairContact::of_pair(pair_history, [&a.body, &b.body], at, touch)
            else {
                continue;
            };
            let motions = [(a.state.v, a.state.w), (b.state.v, b.state.w)];
            if !pair_history.is_held() {
                let approach_m_s = -pair.speed([&motions[0], &motions[1]]);
                pair.begin(approach_m_s, a.impact_m_s.max(b.impact_m_s));
                pair_history.n = pair.n;
            }
            pair.shear = transport(pair_history.shear, &pair_history.n, &pair.n);
            let rate = pair.set_forces_now([&motions[0], &motions[1]]);
            self.pair_rates[k][0] = transport(rate, &pair.n, &pair_history.n);
            let power = |k: usize| {
                let (force, rolling_moment) = pair.load(k);
                -force.dot(&motions[k].0) - rolling_moment.dot(&motions[k].1)
            };
            let given = EnergyGiven::of_ends([power(0), power(1)]);
            for end in 0..2 {
                let member = &mut *self.members[ends[end]];
                let (force, rolling_moment) = pair.load(end);
                let rate = &mut member.state.rates[0];
                rate.v += force / member.body.mass;
                rate.w += rolling_moment / member.body.inertia;
                member.given[0].add(&given[end], 1.0);
            }
        }
        self.fresh = true;
    }
}

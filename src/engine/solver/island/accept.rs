//! The end of an accepted step: contact histories, bonds, angular momentum.
//!
//! Until here a step may be tried again with another length; only this part changes the histories
//! of the island.
//!
//! Bonds are checked only at the end of accepted steps, by the forces there. A bond that breaks
//! leaves friction, with its stretch reduced to Coulomb's cone, so that nothing it stored becomes
//! motion.

use super::assembly::Island;
use super::body::note_flights;
use super::outcome::IslandAdvance;
use crate::contact::history::transport;
use crate::contact::pair::{PairHistory, PairImpact, normal_and_distance};
use crate::math;
use crate::rock::Vec3;
use crate::solver::loss::{EnergyGiven, Loss};
use crate::solver::step_control;
use crate::solver::tableau::Tableau;
use nalgebra::Matrix3;

impl Island<'_> {
    /// Accepts the end of the step.
    pub(super) fn accept(&mut self, tableau: &Tableau, dt: f64) -> IslandAdvance {
        let mut done = IslandAdvance { dt, ..IslandAdvance::default() };
        let before = self.free_angular_momentum();
        for member in &mut self.members {
            let mut loss = Loss::default();
            let omegas_dt = member.omega(self.terrain) * dt;
            let end = member.end;
            let (world, state) = member.with_environment(self.terrain);
            // an impact that begins as the step ends has all of its time ahead
            state.impact.elapse(omegas_dt);
            step_control::accept(&world, tableau, state, (&end, dt), &mut loss);
            // a merged contact acts differently than its rates say
            self.fresh &= state.fresh;
            done.losses.push(loss);
            let mut given = EnergyGiven::default();
            for k in 0..tableau.stages {
                // work through contacts: the power of the stages, summed with the weights of the
                // finer method
                given.add(&member.given[k], dt * tableau.work_weight(k));
            }
            done.given.push(given);
            // first same as last: the rates at the end are those at the start of the next step
            member.given[0] = member.given[tableau.stages - 1];
        }
        done.broken = self.accept_pairs(tableau, dt);
        note_flights(&mut self.members, &self.pair_histories);
        self.restore_angular_momentum(before);
        done
    }

    /// Accepts histories and forces of the pairs, and breaks overloaded bonds; the number of broken
    /// bonds.
    ///
    /// Pairs and histories are both in ascending order: one pass over both, O(n).
    fn accept_pairs(&mut self, tableau: &Tableau, dt: f64) -> u64 {
        let (last, hh) = (tableau.stages - 1, tableau.diagonal * dt);
        let mut broken = 0;
        let mut pairs = self.pairs.iter().peekable();
        for (k, pair_history) in self.pair_histories.iter_mut().enumerate() {
            let Some(pair) = pairs.next_if(|pair| pair.pair_history == k) else {
                pair_history.separate();
                self.pair_rates[k][0] = Vec3::zeros();
                continue;
            };
            let [a, b] = pair.ends.map(|k| &self.members[k]);
            let (_, distance) = normal_and_distance(&a.state.c, &b.state.c);
            let from = if pair_history.is_held() { pair_history.n } else { pair.n };
            let rate = transport(self.pair_rates[k][last], &from, &pair.n);
            let stretch = pair.stretch(hh);
            // the spring turns with the two rocks about their line of centres, by half the common
            // spin about the normal, over the step: ξ' += ((ω_a + ω_b)·n/2) n × ξ
            let turn = 0.5 * dt * (a.state.w + b.state.w).dot(&pair.n);
            let turned = |x: Vec3| x * math::cos(turn) + pair.n.cross(&x) * math::sin(turn);
            (pair_history.normal_force, pair_history.shear_force, pair_history.n) =
                (pair.normal_force, pair.shear_force, pair.n);
            pair_history.captured = pair.captured;
            pair_history.closed =
                pair.normal_force > 0.0 || distance < a.body.radius + b.body.radius;
            let elapsed_rad = pair_history.law.omega_rad_s() * dt;
            pair_history.impact = match (pair_history.closed, pair.deferred) {
                // it begins as the step ends
                (true, true) => pair.impact,
                (true, false) => pair.impact.after(elapsed_rad),
                (false, _) => PairImpact::default(),
            };
            // a contact that opens loses its stretch, a bond does not
            pair_history.shear = if pair_history.closed || pair_history.bond.is_some() {
                turned(stretch)
            } else {
                Vec3::zeros()
            };
            self.pair_rates[k][0] =
                if pair_history.is_held() { turned(rate) } else { Vec3::zeros() };
            // at its cap to rounding: the contact slips
            pair_history.slides = pair_history.bond.is_none()
                && pair_history
                    .law
                    .shear
                    .slides(pair_history.shear_force.norm(), pair_history.normal_force);
            // forces jump when a bond breaks: the next step must begin with new rates
            if pair_history.overload() > 0.0 {
                pair_history.break_bond();
                self.pair_forces[k] = (pair_history.normal_force, pair_history.shear_force);
                self.fresh = false;
                broken += 1;
                pair_history.closed = distance < a.body.radius + b.body.radius;
            }
        }
        broken
    }
}

impl Island<'_> {
    /// Angular momentum about the common centre of mass (kg m²/s) of an island without other
    /// contacts than between its rocks. `None` where it touches the mesh, or nothing at all: then
    /// there is nothing to conserve.
    fn free_angular_momentum(&self) -> Option<Vec3> {
        let alone = self.members.iter().all(|member| member.state.is_free())
            && self.pair_histories.iter().any(PairHistory::is_held);
        alone.then(|| self.angular_momentum())
    }

    /// Mass (kg), centre of mass (m) and its velocity (m/s).
    fn centre(&self) -> (f64, Vec3, Vec3) {
        let mut sum = (0.0, Vec3::zeros(), Vec3::zeros());
        for member in &self.members {
            sum.0 += member.body.mass;
            sum.1 += member.state.c * member.body.mass;
            sum.2 += member.state.v * member.body.mass;
        }
        (sum.0, sum.1 / sum.0, sum.2 / sum.0)
    }

    /// `Σ m (c − c̄) × (v − v̄) + I ω` about the centre of mass (kg m²/s).
    fn angular_momentum(&self) -> Vec3 {
        let (_, c, v) = self.centre();
        self.members.iter().fold(Vec3::zeros(), |sum, member| {
            let orbit = (member.state.c - c).cross(&((member.state.v - v) * member.body.mass));
            sum + orbit + member.state.w * member.body.inertia
        })
    }

    /// Restores the angular momentum that the step's error took from a free island, by a rigid
    /// rotation: far less than the tolerance, but so a free collision conserves it to rounding.
    ///
    /// `Δω = I⁻¹ (L₀ − L)` about the centre of mass, as a rigid rotation of all rocks: it changes
    /// neither the velocity of the centre of mass nor the relative normal speed of any two rocks.
    fn restore_angular_momentum(&mut self, before: Option<Vec3>) {
        let Some(before) = before else { return };
        if !self.members.iter().all(|member| member.state.is_free()) {
            return;
        }
        let lost = before - self.angular_momentum();
        let (_, c, _) = self.centre();
        let spins = self.pair_histories.iter().any(|pair_history| pair_history.law.shear.is_on());
        let mut inertia = Matrix3::zeros();
        for member in &self.members {
            let d = member.state.c - c;
            // without friction spins are constant: the rotation then moves centres only
            let (m, own) = (member.body.mass, if spins { member.body.inertia } else { 0.0 });
            inertia += Matrix3::identity() * (own + m * d.norm_squared()) - d * d.transpose() * m;
        }
        // two rocks without spins have no inertia about their line of centres: the pseudo-inverse
        // rotates about the other axes only
        let Ok(turn) = inertia.pseudo_inverse(1e-9 * inertia.norm()).map(|inverse| inverse * lost)
        else {
            return;
        };
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            member.state.v += turn.cross(&(member.state.c - c));
            if spins {
                member.state.w += turn;
            }
        }
    }
}

//! Force sweeps: all contacts of an island are solved one after the other until none changes.
//!
//! Nonlinear Gauss–Seidel in the forces, with the set-valued normal law and a warm start. Contacts whose rocks have not
//! changed their motion since are skipped. Where contacts oppose each other stiffly (a light rock under a heavy one, a
//! high pile) sweeps converge slowly; a Newton step then solves the part that still changes, with the contact modes
//! that the sweeps have found, and the following sweeps check the result.
//!
//! Converged means: the changes still to come alter no velocity by more than a hundredth of the step's tolerance.
//! A limit on forces would not do: a newton is nothing for a block and everything for a pebble.

use super::assembly::Island;
use super::body::IslandBody;
use super::newton_step::solve_linearised;
use crate::solver::body::{STILL, Twist};
use crate::solver::linear_forces::motion_under;

/// Sweeps before the first Newton step and between two of them: at least, for each rock that still changes, and at
/// most. A Newton step costs as much as some hundred contacts.
const SWEEPS: (usize, usize, usize) = (30, 4, 120);
/// Rounds of sweeps after which a stage is given up; the step is then halved.
const NEWTON_STEPS: usize = 10;
/// Change of velocity by the changes of a force that are still to come, relative to the step's tolerance, below which the
/// force has converged (–).
const CONVERGED: f64 = 1e-2;
/// Change of a force, relative to itself, that is rounding (–).
const ROUNDING: f64 = 1e-11;

impl Island<'_> {
    /// Finds all contact forces of a stage of length `h`; whether they have converged.
    ///
    /// Sweeps and Newton steps alternate. The last operation is a sweep, as a Newton step keeps neither to Coulomb's cone
    /// nor to forces that only push.
    pub(super) fn converge(&mut self, h: f64) -> bool {
        self.sum_forces(h);
        self.active.begin(self.members.len(), self.pairs.iter().map(|pair| pair.ends));
        // forces of the last stage were the first guess: a warm start
        for round in 0..NEWTON_STEPS {
            if self.sweep_until_newton_step(h) {
                return true;
            }
            if round + 1 < NEWTON_STEPS {
                self.newton_steps += 1;
                self.newton_step(h);
            }
        }
        false
    }

    /// Sweeps until the forces have converged or a Newton step is due; whether they have converged.
    ///
    /// The number of sweeps before a Newton step grows with the number of rocks that still change, and so does its cost.
    fn sweep_until_newton_step(&mut self, h: f64) -> bool {
        let mut most = SWEEPS.2;
        let mut k = 0;
        while k < most {
            self.sweeps += 1;
            self.active.begin_sweep();
            self.sweep(h, k % 2 == 1);
            if self.active.has_converged() {
                return true;
            }
            let changed = self.active.changed.iter().filter(|changed| **changed).count();
            most = (SWEEPS.0 + SWEEPS.1 * changed).min(SWEEPS.2);
            k += 1;
        }
        false
    }

    /// One linear solve over the rocks that changed in the last sweep and their neighbours.
    fn newton_step(&mut self, h: f64) {
        self.include_neighbours();
        if let Some(motions) =
            solve_linearised((&self.members, &self.motions), &self.pairs, &self.active.changed, h)
        {
            self.apply_newton_solution(&motions, h);
            self.sum_forces(h);
            self.active.begin(self.members.len(), self.pairs.iter().map(|pair| pair.ends));
        }
    }

    /// Adds the neighbours of the rocks that changed.
    /// Without them the linear solve would press these against neighbours of fixed motion.
    fn include_neighbours(&mut self) {
        let core = self.active.changed.clone();
        for [a, b] in self.pairs.iter().filter(|pair| pair.has_force()).map(|pair| pair.ends) {
            self.active.changed[a] |= core[b];
            self.active.changed[b] |= core[a];
        }
    }

    /// Sets the motions to those that all forces give together.
    fn sum_forces(&mut self, h: f64) {
        self.motions.clear();
        for member in &self.members {
            let IslandBody { state, body, free, .. } = &**member;
            self.motions.push(motion_under(body, state.stage_contacts(), *free, h));
        }
        for pair in self.pairs.iter().filter(|pair| pair.has_force()) {
            for k in 0..2 {
                pair.apply_effect(k, h, &mut self.motions[pair.ends[k]]);
            }
        }
    }

    /// One sweep over the queued contacts, forwards or backwards.
    /// Directions alternate, so that loads travel up and down a pile alike.
    fn sweep(&mut self, h: f64, backwards: bool) {
        let rocks = self.members.len();
        let mut at = self.active.next(None, backwards);
        while let Some(k) = at {
            if k < rocks {
                self.sweep_ground_contacts(k, h);
            } else {
                self.sweep_pair(k - rocks, h);
            }
            at = self.active.next(at, backwards);
        }
    }

    fn sweep_ground_contacts(&mut self, k: usize, h: f64) {
        let negligible = self.active.negligible();
        let IslandBody { state, body, .. } = &mut *self.members[k];
        let now = &mut self.motions[k];
        let count = state.contact_count;
        let mut worst = 0.0f64;
        for contact in &mut state.contacts[..count] {
            let change = contact.relax(body, now, h).sqrt();
            // a force that changes the velocity by CONVERGED · tolerance in a stage
            let allowed = CONVERGED * self.tolerance * body.mass / h;
            worst = worst.max(change / allowed.max(ROUNDING / negligible * contact.normal_force));
        }
        self.active.note_change(worst);
        let changes = worst > negligible;
        if changes {
            self.active.mark_changed(k);
        }
        // One contact alone is solved exactly; several must see each other's change.
        if count <= 1 || !changes {
            self.active.mark_solved(k);
        }
    }

    /// Removes the forces of a pair from both rocks, solves it, and applies the new ones.
    fn sweep_pair(&mut self, k: usize, h: f64) {
        let pair = &mut self.pairs[k];
        let ends = pair.ends;
        let before = (pair.normal_force, pair.shear_force);
        let mut motions: [Twist; 2] = ends.map(|end| self.motions[end]);
        if pair.has_force() {
            for (k, motion) in motions.iter_mut().enumerate() {
                pair.apply_effect(k, -h, motion);
            }
        }
        pair.solve([&motions[0], &motions[1]], h);
        let change = (pair.normal_force - before.0).abs().max((pair.shear_force - before.1).norm());
        if pair.has_force() || change > 0.0 {
            for (k, motion) in motions.iter_mut().enumerate() {
                pair.apply_effect(k, h, motion);
                self.motions[ends[k]] = *motion;
            }
        }
        let allowed = CONVERGED * self.tolerance / (h * pair.inv_m);
        // whichever is larger: a change that matters to the velocity, or rounding of a large force
        let negligible = self.active.negligible();
        let worst = change / allowed.max(ROUNDING / negligible * pair.normal_force.abs());
        self.active.note_change(worst);
        if worst > negligible {
            for end in ends {
                self.active.mark_changed(end);
            }
        }
        self.active.mark_solved(self.members.len() + k);
    }

    /// Takes over the motions of a Newton step, and sets the forces of these rocks by the contact law.
    ///
    /// The linear system knows neither friction cones nor that a contact cannot pull: the law does.
    fn apply_newton_solution(&mut self, motions: &[Option<Twist>], h: f64) {
        for ((member, now), motion) in self.members.iter_mut().zip(&mut self.motions).zip(motions) {
            let Some(motion) = motion else { continue };
            let IslandBody { state, body, .. } = &mut **member;
            *now = *motion;
            for contact in &mut state.contacts[..state.contact_count] {
                contact.set_forces_at(body, [motion, &STILL], h);
            }
        }
        for pair in &mut self.pairs {
            if pair.ends.iter().all(|&k| motions[k].is_none()) {
                continue;
            }
            let ends = pair.ends.map(|k| &self.motions[k]);
            pair.set_forces_at(ends, h);
        }
    }
}

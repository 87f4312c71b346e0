//! Force sweeps: all contacts of an island solved one after the other until none changes.
//!
//! Nonlinear Gauss–Seidel in the forces, with the set-valued normal law and a warm start. A contact whose two rocks have
//! not been stirred since it was solved is passed over, so a sweep costs what happens and not what is there. Where
//! contacts oppose each other stiffly (a light rock under a heavy one, a high pile) sweeps creep; then the stirred part
//! of the island is solved at once in the modes that they have found, and the sweeps judge the result.
//!
//! Settled means: what is still to come would change no velocity by more than a hundredth of the
//! step's tolerance. Absolute forces would not do: a newton is nothing for a block and everything
//! for a pebble.

use super::assembly::Island;
use super::body::IslandBody;
use super::newton_step::jump;
use crate::solver::body::{STILL, Twist};
use crate::solver::linear_forces::driven;

/// Sweeps before the first jump, and between two of them: at least, for each rock that is stirred, and at most. A jump
/// costs as much as some hundred contacts.
const SWEEPS: (usize, usize, usize) = (30, 4, 120);
/// Jumps after which a stage is given up; the step is then halved.
const JUMPS: usize = 10;
/// Change of velocity by a change of force that is still to come, relative to the step's tolerance, below which the force
/// has settled (–).
const SETTLED: f64 = 1e-2;
/// Change of a force, relative to itself, that is rounding (–).
const ROUNDING: f64 = 1e-11;

impl Island<'_> {
    /// Finds all contact forces of a stage of length `h`; whether they settled.
    ///
    /// Sweeps and jumps alternate; a jump is never the last word, as it knows neither Coulomb's
    /// cone nor that contacts do not pull.
    pub(super) fn settle(&mut self, h: f64) -> bool {
        self.drive(h);
        self.stirred.begin(self.members.len(), self.pairs.iter().map(|pair| pair.ends));
        // forces of the last stage were the first guess: a warm start
        for round in 0..JUMPS {
            if self.sweep_on(h) {
                return true;
            }
            if round + 1 < JUMPS {
                self.jumps += 1;
                self.jump_on(h);
            }
        }
        false
    }

    /// Sweeps until nothing changes or a jump is due; whether nothing changes any more.
    ///
    /// The number of sweeps before a jump grows with what is still stirred: a large stirred part
    /// makes a jump dear.
    fn sweep_on(&mut self, h: f64) -> bool {
        let mut most = SWEEPS.2;
        let mut k = 0;
        while k < most {
            self.sweeps += 1;
            self.stirred.begin_sweep();
            self.sweep(h, k % 2 == 1);
            if self.stirred.is_settled() {
                return true;
            }
            let stirred = self.stirred.lately.iter().filter(|lately| **lately).count();
            most = (SWEEPS.0 + SWEEPS.1 * stirred).min(SWEEPS.2);
            k += 1;
        }
        false
    }

    /// Solves what was stirred lately at once.
    fn jump_on(&mut self, h: f64) {
        self.grow_stirred();
        if let Some(motions) =
            jump((&self.members, &self.motions), &self.pairs, &self.stirred.lately, h)
        {
            self.act_on(&motions, h);
            self.drive(h);
            self.stirred.begin(self.members.len(), self.pairs.iter().map(|pair| pair.ends));
        }
    }

    /// The neighbours of what was stirred take part in a jump.
    /// Without them a jump would press stirred rocks against ones held fast.
    fn grow_stirred(&mut self) {
        let core = self.stirred.lately.clone();
        for [a, b] in self.pairs.iter().filter(|pair| pair.acts()).map(|pair| pair.ends) {
            self.stirred.lately[a] |= core[b];
            self.stirred.lately[b] |= core[a];
        }
    }

    /// Motions from all forces together.
    fn drive(&mut self, h: f64) {
        self.motions.clear();
        for member in &self.members {
            let IslandBody { state, body, free, .. } = &**member;
            let contacts = &state.contacts[..state.contact_count];
            self.motions.push(driven(body, contacts, *free, h));
        }
        for pair in self.pairs.iter().filter(|pair| pair.acts()) {
            for k in 0..2 {
                pair.act(k, h, &mut self.motions[pair.ends[k]]);
            }
        }
    }

    /// One pass over the contacts that are asked, onwards or backwards.
    /// To and fro, so that a load is handed up and down a pile alike.
    fn sweep(&mut self, h: f64, backwards: bool) {
        let rocks = self.members.len();
        let mut at = self.stirred.next(None, backwards);
        while let Some(k) = at {
            if k < rocks {
                self.sweep_ground_contacts(k, h);
            } else {
                self.sweep_pair(k - rocks, h);
            }
            at = self.stirred.next(at, backwards);
        }
    }

    fn sweep_ground_contacts(&mut self, k: usize, h: f64) {
        let nothing = self.stirred.nothing();
        let IslandBody { state, body, .. } = &mut *self.members[k];
        let now = &mut self.motions[k];
        let count = state.contact_count;
        let mut worst = 0.0f64;
        for contact in &mut state.contacts[..count] {
            let change = contact.solve_anew(body, now, h).sqrt();
            // a force that changes the velocity by SETTLED · tolerance in a stage
            let allowed = SETTLED * self.tolerance * body.mass / h;
            worst = worst.max(change / allowed.max(ROUNDING / nothing * contact.normal_force));
        }
        self.stirred.note(worst);
        let stirs = worst > nothing;
        if stirs {
            self.stirred.stir(k);
        }
        // One contact alone is solved exactly; several must see each other's change.
        if count <= 1 || !stirs {
            self.stirred.see(k);
        }
    }

    /// Takes the pair's own forces off both rocks, solves it, and puts the new ones on.
    fn sweep_pair(&mut self, k: usize, h: f64) {
        let pair = &mut self.pairs[k];
        let ends = pair.ends;
        let before = (pair.normal_force, pair.shear_force);
        let mut motions: [Twist; 2] = ends.map(|end| self.motions[end]);
        if pair.acts() {
            for (k, motion) in motions.iter_mut().enumerate() {
                pair.act(k, -h, motion);
            }
        }
        pair.solve([&motions[0], &motions[1]], h);
        let change = (pair.normal_force - before.0).abs().max((pair.shear_force - before.1).norm());
        if pair.acts() || change > 0.0 {
            for (k, motion) in motions.iter_mut().enumerate() {
                pair.act(k, h, motion);
                self.motions[ends[k]] = *motion;
            }
        }
        let allowed = SETTLED * self.tolerance / (h * pair.inv_m);
        // whichever is larger: a change that matters to the velocity, or rounding of a large force
        let nothing = self.stirred.nothing();
        let worst = change / allowed.max(ROUNDING / nothing * pair.normal_force.abs());
        self.stirred.note(worst);
        if worst > nothing {
            for end in ends {
                self.stirred.stir(end);
            }
        }
        self.stirred.see(self.members.len() + k);
    }

    /// Sets every force of rocks that jumped to what its law gives at their new motions.
    ///
    /// The linear system knows neither cones nor that a contact cannot pull: the law is asked once
    /// more.
    fn act_on(&mut self, motions: &[Option<Twist>], h: f64) {
        for ((member, now), motion) in self.members.iter_mut().zip(&mut self.motions).zip(motions) {
            let Some(motion) = motion else { continue };
            let IslandBody { state, body, .. } = &mut **member;
            *now = *motion;
            for contact in &mut state.contacts[..state.contact_count] {
                contact.act_at(body, [motion, &STILL], h);
            }
        }
        for pair in &mut self.pairs {
            if pair.ends.iter().all(|&k| motions[k].is_none()) {
                continue;
            }
            let ends = pair.ends.map(|k| &self.motions[k]);
            pair.act_at(ends, h);
        }
    }
}

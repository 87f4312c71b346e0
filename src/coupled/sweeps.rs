//! Force sweeps: all contacts of an island solved one after the other until none changes.
//!
//! Nonlinear Gauss–Seidel in the forces, with the set-valued normal law and a warm start. A contact whose two rocks have
//! not been stirred since it was solved is passed over, so a sweep costs what happens and not what is there. Where
//! contacts oppose each other stiffly (a light rock under a heavy one, a high pile) sweeps creep; then the stirred part
//! of the island is solved at once in the modes that they have found, and the sweeps judge the result.

use super::bridge::Motion;
use super::cluster::Cluster;
use super::jump::jump;
use super::member::Member;
use crate::step::joint::Normal;
use crate::step::law::within;

/// Sweeps before the first jump, and between two of them: at least, for each rock that is stirred, and at most. A jump
/// costs as much as some hundred contacts.
const SWEEPS: (usize, usize, usize) = (30, 4, 120);
/// Jumps after which a stage is given up; the step is then halved.
const JUMPS: usize = 10;
/// Change of velocity by a change of force that is still to come, relative to the step's tolerance, below which the force
/// has settled (–).
const SETTLED: f64 = 1e-2;
/// Part of that below which a change counts as settled however fast changes die out (–).
const SETTLED_AT_ONCE: f64 = 1e-4;
/// Part of that from which a change stirs the rocks: what is passed over adds up (–).
const STIRS: f64 = 1e-4;
/// An island of no more rocks than this is swept as a whole.
const SMALL: usize = 4;
/// Change of a force, relative to itself, that is rounding (–).
const ROUNDING: f64 = 1e-11;

/// Which rocks have been stirred, and what every contact has seen of that.
#[derive(Debug, Default)]
pub(super) struct Stirred {
    /// How often each rock was set in another motion.
    times: Vec<u32>,
    /// The count at which each rock's contacts with the mesh were solved …
    spots: Vec<u32>,
    /// … and each contact of two rocks.
    bridges: Vec<[u32; 2]>,
    /// Rocks whose forces changed in the last sweep.
    pub(super) lately: Vec<bool>,
    /// Largest change in the sweep in hand and in the two before, relative to what is allowed.
    changes: [f64; 3],
}

impl Stirred {
    /// Nothing has been solved yet.
    fn begin(&mut self, rocks: usize, bridges: usize) {
        self.times.clear();
        self.times.resize(rocks, 1);
        self.spots.clear();
        self.spots.resize(rocks, 0);
        self.bridges.clear();
        self.bridges.resize(bridges, [0; 2]);
        self.lately.clear();
        self.lately.resize(rocks, true);
        self.changes = [f64::INFINITY; 3];
    }

    /// Begins another sweep.
    fn begin_sweep(&mut self) {
        self.lately.fill(false);
        self.changes = [0.0, self.changes[0], self.changes[1]];
    }

    /// Notes a change, relative to what is allowed.
    fn note(&mut self, change: f64) {
        self.changes[0] = self.changes[0].max(change);
    }

    /// Whether all changes still to come are small: `q + q² + …` times the last one, if each sweep leaves the share `q` of
    /// the change before. Where sweeps creep, that is far more than the last change, and only the third sweep tells.
    fn is_settled(&self) -> bool {
        let [now, before, earlier] = self.changes;
        let share = f64::max(now / before, before / earlier);
        let knows = earlier.is_finite() && share < 1.0;
        now <= SETTLED_AT_ONCE || knows && now <= 1.0 && now * share <= 1.0 - share
    }

    fn stir(&mut self, k: usize) {
        self.times[k] += 1;
        self.lately[k] = true;
    }
}

impl Cluster<'_> {
    /// Finds all contact forces of a stage of length `h`; whether they settled.
    pub(super) fn settle(&mut self, h: f64) -> bool {
        self.drive(h);
        self.stirred.begin(self.members.len(), self.bridges.len());
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
        if let Some(motions) = jump(&self.members, &self.bridges, &self.stirred.lately, h) {
            self.act_on(&motions, h);
            self.drive(h);
            self.stirred.begin(self.members.len(), self.bridges.len());
        }
    }

    /// The neighbours of what was stirred take part in a jump.
    fn grow_stirred(&mut self) {
        let core = self.stirred.lately.clone();
        for [a, b] in self.bridges.iter().filter(|bridge| bridge.acts()).map(|bridge| bridge.ends) {
            self.stirred.lately[a] |= core[b];
            self.stirred.lately[b] |= core[a];
        }
    }

    /// Motions from all forces together.
    fn drive(&mut self, h: f64) {
        for member in &mut self.members {
            let Member { grip, body, free, now, .. } = &mut **member;
            *now = *free;
            for spot in &grip.spots[..grip.spot_count] {
                let (dv, dw) = spot.effect(body, h);
                now.0 += dv;
                now.1 += dw;
            }
        }
        for bridge in self.bridges.iter().filter(|bridge| bridge.acts()) {
            for k in 0..2 {
                let Member { body, now, .. } = &mut *self.members[bridge.ends[k]];
                bridge.act(k, body, h, now);
            }
        }
    }

    /// One pass over the contacts, onwards or backwards.
    fn sweep(&mut self, h: f64, backwards: bool) {
        let (spots, bridges) = (self.members.len(), self.bridges.len());
        for k in 0..spots + bridges {
            let k = if backwards { spots + bridges - 1 - k } else { k };
            if k < spots {
                self.sweep_spots(k, h);
            } else {
                self.sweep_bridge(k - spots, h);
            }
        }
    }

    /// Whether contacts at rest are passed over: in a small island little is saved, and every digit counts.
    fn passes_over(&self) -> bool {
        self.members.len() > SMALL
    }

    fn sweep_spots(&mut self, k: usize, h: f64) {
        if self.passes_over() && self.stirred.spots[k] == self.stirred.times[k] {
            return;
        }
        let Member { grip, body, now, .. } = &mut *self.members[k];
        let count = grip.spot_count;
        let mut worst = 0.0f64;
        for spot in &mut grip.spots[..count] {
            let before = (spot.push, spot.drag, spot.moment);
            let (dv, dw) = spot.effect(body, h);
            let free = (now.0 - dv, now.1 - dw);
            spot.solve(body, &free.0, &free.1, h);
            let (dv, dw) = spot.effect(body, h);
            *now = (free.0 + dv, free.1 + dw);
            let change = (spot.push - before.0).abs().max((spot.drag - before.1).norm());
            let change = change.max((spot.moment - before.2).norm() / body.radius);
            let allowed = SETTLED * self.tolerance * body.mass / h;
            worst = worst.max(change / allowed.max(ROUNDING / SETTLED_AT_ONCE * spot.push));
        }
        self.stirred.note(worst);
        let seen = self.stirred.times[k];
        if worst > STIRS {
            self.stirred.stir(k);
        }
        // One contact alone is solved exactly; several must see each other's change.
        self.stirred.spots[k] = if count > 1 { seen } else { self.stirred.times[k] };
    }

    fn sweep_bridge(&mut self, k: usize, h: f64) {
        let passes_over = self.passes_over();
        let bridge = &mut self.bridges[k];
        let ends = bridge.ends;
        if passes_over && self.stirred.bridges[k] == ends.map(|end| self.stirred.times[end]) {
            return;
        }
        let before = (bridge.push, bridge.drag);
        let mut motions: [Motion; 2] = ends.map(|end| self.members[end].now);
        if bridge.acts() {
            for k in 0..2 {
                bridge.act(k, &self.members[ends[k]].body, -h, &mut motions[k]);
            }
        }
        bridge.solve([&motions[0], &motions[1]], h);
        let change = (bridge.push - before.0).abs().max((bridge.drag - before.1).norm());
        if bridge.acts() || change > 0.0 {
            for (k, motion) in motions.iter_mut().enumerate() {
                let member = &mut *self.members[ends[k]];
                bridge.act(k, &member.body, h, motion);
                member.now = *motion;
            }
        }
        let allowed = SETTLED * self.tolerance / (h * bridge.inv_m);
        let worst = change / allowed.max(ROUNDING / SETTLED_AT_ONCE * bridge.push.abs());
        self.stirred.note(worst);
        if worst > STIRS {
            for end in ends {
                self.stirred.stir(end);
            }
        }
        self.stirred.bridges[k] = ends.map(|end| self.stirred.times[end]);
    }

    /// Sets every force of rocks that jumped to what its law gives at their new motions.
    fn act_on(&mut self, motions: &[Option<Motion>], h: f64) {
        for (member, motion) in self.members.iter_mut().zip(motions) {
            let Some((v, w)) = motion else { continue };
            let Member { grip, body, now, .. } = &mut **member;
            *now = (*v, *w);
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
            if bridge.ends.iter().all(|&k| motions[k].is_none()) {
                continue;
            }
            let ends = bridge.ends.map(|k| &self.members[k].now);
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

#[cfg(test)]
mod tests {
    use super::Stirred;

    /// A contact is looked at again exactly when one of its rocks was stirred after it had been solved.
    #[test]
    fn what_is_stirred_is_solved_again() {
        let mut stirred = Stirred::default();
        stirred.begin(2, 1);
        assert_ne!(stirred.bridges[0], [stirred.times[0], stirred.times[1]]);
        stirred.bridges[0] = [stirred.times[0], stirred.times[1]];
        stirred.stir(1);
        assert_ne!(stirred.bridges[0], [stirred.times[0], stirred.times[1]]);
        stirred.begin(2, 1);
        assert_ne!(stirred.bridges[0], [stirred.times[0], stirred.times[1]]);
    }
}

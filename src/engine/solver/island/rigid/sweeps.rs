//! Projected Gauss–Seidel sweeps over the contacts of an island until their impulses have converged.
//!
//! One sweep `S` passes a load on from rock to rock. Sweeps alone would need a number that grows with the
//! square of the heap's height. Between sweeps the impulses therefore advance along a conjugate direction:
//! `x ← S(x) + β p`, `p ← S(x) − x + β p`, with `β` the ratio of the squared changes of the last two sweeps;
//! the direction is dropped where `β ≥ 1` (nonsmooth nonlinear conjugate gradients, Silcowitz, Niebe and
//! Erleben 2010). The last operation is always a sweep, so that friction stays in its cone.
//!
//! A contact has converged when its change of speed is small against the speed that weight adds in the step,
//! or against the speed of its rocks. The criterion is relative: it means the same for pebbles and for blocks.

use super::RigidIsland;
use super::contacts::Impulses;
use crate::contact::pair::PairHistory;
use crate::rock::Rock;
use crate::solver::island::body::BodySlot;

/// Sweeps before a Newton step, at most, and after the last one. They cost little: a few contacts still change
/// while all others have converged and are skipped.
const SWEEPS: (u32, u32) = (1000, 3000);
/// Sweeps after which a Newton step is judged, at most.
const SWEEPS_AFTER: u32 = 30;
/// Newton steps, at most.
const NEWTON_STEPS: u32 = 4;
/// Change of speed at a contact in one sweep below which it has converged: relative to the speed that weight alone
/// adds in the step, and to the speed of the fastest of its rocks and their neighbours (–).
const CONVERGED: (f64, f64) = (3e-3, 1.8e-2);
/// The first of them for a small island, where it costs little to tell friction that just holds from friction that
/// just fails (–).
const CONVERGED_FEW: f64 = 6e-4;
/// Rocks of a small island, at most.
pub(super) const FEW: usize = 64;
/// The same relative to the capture speed, where there is hardly any weight (–).
const CONVERGED_OF_CAPTURE: f64 = 1e-6;

impl RigidIsland {
    /// Sweeps until all contacts have converged, with Newton steps where sweeps are slow; whether they have converged.
    /// A Newton step that does not halve the change is undone, and no other is tried.
    pub(super) fn converge(
        &mut self,
        (members, pair_histories): (&mut [BodySlot], &[PairHistory]),
        dt: f64,
    ) -> bool {
        self.dt = dt;
        self.set_allowed_changes();
        let mut change = self.sweep_up_to(SWEEPS.0);
        for _ in 0..NEWTON_STEPS {
            if change <= 1.0 {
                return true;
            }
            let versions: Vec<u32> = self.balls.iter().map(|ball| ball.version).collect();
            if self.sweep_up_to(1) <= 1.0 {
                return true;
            }
            let kept =
                (self.balls.clone(), self.ground_contacts.clone(), self.ball_contacts.clone());
            self.newton_steps += 1;
            if !self.newton_step((&mut *members, pair_histories), &versions) {
                break;
            }
            let after = self.sweep_up_to(SWEEPS_AFTER);
            if after > f64::max(1.0, 0.5 * change) {
                (self.balls, self.ground_contacts, self.ball_contacts) = kept;
                break;
            }
            change = after;
        }
        self.sweep_up_to(SWEEPS.1) <= 1.0
    }

    /// Sets the change of speed that is allowed at every rock: the slower it and its neighbours are, the less.
    ///
    /// Neighbours count, because a slow rock that a fast one strikes need not be solved as exactly as one at rest.
    fn set_allowed_changes(&mut self) {
        let few = self.balls.len() <= FEW;
        let of_weight = if few { CONVERGED_FEW } else { CONVERGED.0 };
        for ball in &mut self.balls {
            let weight = of_weight * ball.body.gravity.norm() * self.dt;
            let least = weight.max(CONVERGED_OF_CAPTURE * self.capture_m_s);
            ball.allowed_m_s = least + CONVERGED.1 * ball.before.0.norm();
        }
        for [a, b] in self.ball_contacts.iter().map(|ball_contact| ball_contact.ends) {
            let speeds = [a, b].map(|k| CONVERGED.1 * self.balls[k].before.0.norm());
            let Ok([a, b]) = self.balls.get_disjoint_mut([a, b]) else { continue };
            a.allowed_m_s = a.allowed_m_s.max(speeds[1]);
            b.allowed_m_s = b.allowed_m_s.max(speeds[0]);
        }
    }

    /// Sweeps until no change exceeds what is allowed, at most `most` times; the largest change of the last sweep
    /// relative to what is allowed (–).
    fn sweep_up_to(&mut self, most: u32) -> f64 {
        let count = self.ground_contacts.len() + self.ball_contacts.len();
        self.index_contacts();
        self.queue.all(count);
        let mut change = f64::INFINITY;
        self.conjugate.begin(count);
        for k in 0..most {
            self.sweeps += 1;
            change = self.sweep(k % 2 == 1);
            self.enqueue_changed();
            if change <= 1.0 {
                break;
            }
            if k + 1 < most {
                self.step_along_conjugate();
            }
        }
        change
    }

    /// Advances the impulses that the last sweep changed along their conjugate directions.
    fn step_along_conjugate(&mut self) {
        let changed = std::mem::take(&mut self.conjugate.changed);
        let mut squared_change = 0.0;
        for &k in &changed {
            let (now, inv) = self.impulses(k as usize);
            let contact = &mut self.conjugate.contacts[k as usize];
            contact.start = now.less(&contact.start);
            squared_change += contact.start.square(inv);
        }
        let beta = squared_change / self.conjugate.squared_change;
        // growing changes: drop the directions and restart from plain sweeps
        let is_useful = beta < 1.0;
        self.conjugate.squared_change = squared_change;
        let sweep = self.conjugate.sweep;
        self.conjugate.sweep += 1;
        for &k in &changed {
            let contact = &mut self.conjugate.contacts[k as usize];
            let change = contact.start;
            if is_useful && contact.direction_sweep + 1 == sweep {
                let step = contact.direction.times(beta);
                contact.direction = change.plus(&step);
                self.add_projected(k as usize, &step);
            } else {
                contact.direction = change;
            }
            self.conjugate.contacts[k as usize].direction_sweep = sweep;
        }
        self.conjugate.changed = changed;
        self.conjugate.changed.clear();
    }

    /// The impulses of a contact, and the weights that make their squares energies.
    ///
    /// `1/m` for the normal impulse, `7/2 · 1/m` for that along the surface (contact point), `1/I`
    /// for rolling.
    fn impulses(&self, k: usize) -> (Impulses, [f64; 3]) {
        let ground_contacts = self.ground_contacts.len();
        if k < ground_contacts {
            let ground_contact = &self.ground_contacts[k];
            let ball = &self.balls[ground_contact.rock];
            (ground_contact.impulses(), [ball.inv.0, Rock::SLIP_LIGHTNESS * ball.inv.0, ball.inv.1])
        } else {
            let ball_contact = &self.ball_contacts[k - ground_contacts];
            (ball_contact.impulses(), [ball_contact.inv.0, ball_contact.inv.1, 0.0])
        }
    }

    /// Adds a step to the impulses of a contact, projected onto its friction cone.
    fn add_projected(&mut self, k: usize, step: &Impulses) {
        let ground_contacts = self.ground_contacts.len();
        if k < ground_contacts {
            let ground_contact = &mut self.ground_contacts[k];
            let ball = &mut self.balls[ground_contact.rock];
            ground_contact.add_projected(step, ball);
            ball.version += 1;
        } else {
            let ball_contact = &mut self.ball_contacts[k - ground_contacts];
            if let Ok([a, b]) = self.balls.get_disjoint_mut(ball_contact.ends) {
                ball_contact.add_projected(step, a, b);
                (a.version, b.version) = (a.version + 1, b.version + 1);
            }
        }
    }

    /// One sweep over the queued contacts, forwards or backwards; the largest change of speed relative to what is
    /// allowed (–).
    fn sweep(&mut self, backwards: bool) -> f64 {
        let mut change = 0.0f64;
        let mut at = if backwards { self.queue.last() } else { self.queue.from(0) };
        while let Some(k) = at {
            change = change.max(self.sweep_contact(k));
            at = if backwards { self.queue.below(k) } else { self.queue.from(k + 1) };
        }
        change
    }

    /// Contacts with the mesh come first, then those between rocks.
    fn sweep_contact(&mut self, k: usize) -> f64 {
        self.queue.remove(k);
        match k.checked_sub(self.ground_contacts.len()) {
            None => self.sweep_ground_contact(k),
            Some(place) => self.sweep_ball_contact(k, place),
        }
    }

    /// Indexes the contacts by rock.
    fn index_contacts(&mut self) {
        let ground_contacts =
            self.ground_contacts.iter().map(|ground_contact| [ground_contact.rock; 2]);
        let ends: Vec<[usize; 2]> = ground_contacts
            .chain(self.ball_contacts.iter().map(|ball_contact| ball_contact.ends))
            .collect();
        self.of_rocks.index(&ends, self.balls.len());
    }

    /// Queues the contacts of a rock when a sweep changes its motion for the first time. Contacts whose rocks have not
    /// moved are up to date: the cost of a sweep follows the number of changes and not the number of contacts.
    fn mark_changed(&mut self, ball: usize) {
        let changed = &mut self.balls[ball].changed_in_sweep;
        if *changed != self.sweeps {
            *changed = self.sweeps;
            self.changed.push(ball);
            self.enqueue(ball);
        }
    }

    fn enqueue(&mut self, ball: usize) {
        for contact in self.of_rocks.of(ball) {
            self.queue.add(contact);
        }
    }

    /// Queues the contacts of all rocks that the sweep has changed: some were solved before the last change.
    fn enqueue_changed(&mut self) {
        while let Some(ball) = self.changed.pop() {
            self.enqueue(ball);
        }
    }

    fn sweep_ground_contact(&mut self, k: usize) -> f64 {
        let ground_contact = &mut self.ground_contacts[k];
        let end = ground_contact.rock;
        let ball = &mut self.balls[end];
        if ground_contact.seen_version == ball.version {
            return 0.0;
        }
        let start = ground_contact.impulses();
        let change = ground_contact.solve(ball) / ball.allowed_m_s;
        let changes = change > 1.0;
        ball.version += u32::from(changes);
        ground_contact.seen_version = ball.version;
        if changes {
            self.conjugate.note_start(k, start);
            self.mark_changed(end);
        }
        change
    }

    /// The contact with number `k` of all that stands at `place` among those between rocks.
    fn sweep_ball_contact(&mut self, k: usize, place: usize) -> f64 {
        let ball_contact = &mut self.ball_contacts[place];
        let ends = ball_contact.ends;
        let Ok([a, b]) = self.balls.get_disjoint_mut(ends) else { return 0.0 };
        if ball_contact.seen_versions == [a.version, b.version] {
            return 0.0;
        }
        let start = ball_contact.impulses();
        let change = ball_contact.solve(a, b) / a.allowed_m_s.min(b.allowed_m_s);
        let changes = change > 1.0;
        (a.version, b.version) = (a.version + u32::from(changes), b.version + u32::from(changes));
        ball_contact.seen_versions = [a.version, b.version];
        if changes {
            self.conjugate.note_start(k, start);
            self.mark_changed(ends[0]);
            self.mark_changed(ends[1]);
        }
        change
    }
}

/// The conjugate directions of all contacts.
#[derive(Debug, Default)]
pub(super) struct ConjugateDirections {
    contacts: Vec<ConjugateContact>,
    /// Contacts that the current sweep has changed.
    changed: Vec<u32>,
    /// Number of the current sweep.
    sweep: u64,
    /// Sum of the squared changes of the sweep before.
    squared_change: f64,
}

/// The conjugate direction of one contact.
#[derive(Debug, Clone, Copy)]
struct ConjugateContact {
    /// Impulses before the current sweep; after it their change.
    start: Impulses,
    direction: Impulses,
    /// Sweeps to which `start` and `direction` belong.
    start_sweep: u64,
    direction_sweep: u64,
}

impl ConjugateContact {
    const NONE: Self = Self {
        start: Impulses::NONE,
        direction: Impulses::NONE,
        start_sweep: 0,
        direction_sweep: 0,
    };
}

impl ConjugateDirections {
    fn begin(&mut self, count: usize) {
        // sweep numbers keep rising: what an earlier call left is older than the sweep before
        self.sweep += 2;
        self.contacts.resize(count.max(self.contacts.len()), ConjugateContact::NONE);
        self.changed.clear();
        self.squared_change = 0.0;
    }

    /// Remembers the impulses of a contact before its first change in the current sweep.
    fn note_start(&mut self, k: usize, start: Impulses) {
        let contact = &mut self.contacts[k];
        if contact.start_sweep != self.sweep {
            (contact.start_sweep, contact.start) = (self.sweep, start);
            self.changed.push(k as u32);
        }
    }
}

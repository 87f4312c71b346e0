//! Which contacts of an island must be solved again.
//!
//! Most contacts of a large heap converge within a few sweeps. A contact is solved again only where the motion of
//! one of its rocks has changed since; all others are skipped.

use super::contact_queue::{ContactQueue, ContactsOfRocks};

/// Change, relative to what is allowed, that is neglected: in an island of a few rocks and in a larger one (–). Contacts
/// with such changes are not solved again, and what is neglected adds up.
const NEGLIGIBLE: (f64, f64) = (1e-4, 1e-2);
/// In an island of no more rocks than this every sweep solves all contacts: little would be saved, and every digit counts.
const SMALL: usize = 4;

/// Rocks whose motion has changed, and the contacts that must therefore be solved again. The contacts of a rock with the
/// mesh are solved together and have its number; the contacts of two rocks follow.
#[derive(Debug, Default)]
pub(super) struct ActiveSet {
    queue: ContactQueue,
    /// Number of contacts.
    count: usize,
    /// Contacts with other rocks of every rock.
    of_rocks: ContactsOfRocks,
    ends: Vec<[usize; 2]>,
    /// Rocks whose forces changed in the last sweep.
    pub(super) changed: Vec<bool>,
    /// Largest change in the current sweep and in the two before, relative to what is allowed.
    changes: [f64; 3],
}

impl ActiveSet {
    /// Begins an iteration: all contacts are still to be solved.
    pub(super) fn begin(&mut self, rocks: usize, pairs: impl Iterator<Item = [usize; 2]>) {
        self.changed.clear();
        self.changed.resize(rocks, true);
        self.changes = [f64::INFINITY; 3];
        self.ends.clear();
        self.ends.extend(pairs);
        self.count = rocks + self.ends.len();
        self.queue.all(self.count);
        if !self.is_small() {
            self.of_rocks.index(&self.ends, rocks);
        }
    }

    /// Whether the island has a few rocks only.
    pub(super) fn is_small(&self) -> bool {
        self.changed.len() <= SMALL
    }

    /// Change, relative to what is allowed, that is neglected (–).
    pub(super) fn negligible(&self) -> f64 {
        if self.is_small() { NEGLIGIBLE.0 } else { NEGLIGIBLE.1 }
    }

    /// Begins another sweep.
    pub(super) fn begin_sweep(&mut self) {
        self.changed.fill(false);
        self.changes = [0.0, self.changes[0], self.changes[1]];
        if self.is_small() {
            self.queue.all(self.count);
        }
    }

    /// The next contact to solve after `last`, or the first of a sweep.
    pub(super) fn next(&self, last: Option<usize>, backwards: bool) -> Option<usize> {
        match (last, backwards) {
            (None, false) => self.queue.from(0),
            (None, true) => self.queue.last(),
            (Some(k), false) => self.queue.from(k + 1),
            (Some(k), true) => self.queue.below(k),
        }
    }

    /// Notes a change, relative to what is allowed.
    pub(super) fn note_change(&mut self, change: f64) {
        self.changes[0] = self.changes[0].max(change);
    }

    /// Whether the sum of all changes still to come is small.
    ///
    /// For a linearly convergent iteration it is the geometric series `q/(1 − q)` times the last change, with `q` the
    /// worse of the last two ratios of changes. Where convergence is slow that is far more than the last change; it is
    /// known from the third sweep on.
    pub(super) fn has_converged(&self) -> bool {
        let [now, before, earlier] = self.changes;
        let share = f64::max(now / before, before / earlier);
        let knows = earlier.is_finite() && share < 1.0;
        now <= self.negligible() || knows && now <= 1.0 && now * share <= 1.0 - share
    }

    /// Contact `k` has been solved for the present motions of its rocks.
    pub(super) fn mark_solved(&mut self, k: usize) {
        self.queue.remove(k);
    }

    /// The motion of rock `k` has changed: all its contacts must be solved again.
    pub(super) fn mark_changed(&mut self, k: usize) {
        self.changed[k] = true;
        if self.is_small() {
            return;
        }
        self.queue.add(k);
        for contact in self.of_rocks.of(k) {
            self.queue.add(self.changed.len() + contact);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ActiveSet;

    /// A contact is queued exactly when the motion of one of its rocks has changed after it was solved.
    #[test]
    fn what_is_stirred_is_solved_again() {
        let mut active = ActiveSet::default();
        active.begin(6, [[0, 1], [1, 5]].into_iter());
        let queued = |set: &ActiveSet| -> Vec<usize> {
            std::iter::successors(set.next(None, false), |k| set.next(Some(*k), false)).collect()
        };
        assert_eq!(queued(&active), [0, 1, 2, 3, 4, 5, 6, 7]);
        (0..8).for_each(|k| active.mark_solved(k));
        assert!(queued(&active).is_empty());
        active.mark_changed(5);
        assert_eq!(queued(&active), [5, 7]);
        assert_eq!(active.next(Some(7), true), Some(5));
        active.mark_solved(7);
        active.begin_sweep();
        assert_eq!(queued(&active), [5]);
        // a small island is swept as a whole
        active.begin(2, [[0, 1]].into_iter());
        (0..3).for_each(|k| active.mark_solved(k));
        active.begin_sweep();
        assert_eq!(queued(&active), [0, 1, 2]);
    }
}

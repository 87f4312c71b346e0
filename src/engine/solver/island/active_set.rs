//! Which contacts of an island must be solved again.
//!
//! Most contacts of a large heap have settled after a few sweeps. A contact is asked again where one
//! of its rocks was set in another motion since it was solved; all others are not even looked at.

use super::contact_queue::{ContactQueue, ContactsOfRocks};

/// Part of what is allowed below which a change counts as settled however fast changes die out, and stirs nothing, in an island of a few
/// rocks and in a larger one (–): what is passed over adds up.
const SETTLED_AT_ONCE: (f64, f64) = (1e-4, 1e-2);
/// In an island of no more rocks than this all contacts are asked in every sweep: little would be saved, and every digit counts.
const SMALL: usize = 4;

/// Which rocks have been stirred, and which contacts must be asked for that. A rock's contacts with the mesh are asked together and
/// have its number; the contacts of two rocks follow.
#[derive(Debug, Default)]
pub(super) struct ActiveSet {
    asked: ContactQueue,
    /// How many there are.
    count: usize,
    /// Contacts with others of every rock.
    of_rocks: ContactsOfRocks,
    ends: Vec<[usize; 2]>,
    /// Rocks whose forces changed in the last sweep.
    pub(super) lately: Vec<bool>,
    /// Largest change in the current sweep and in the two before, relative to what is allowed.
    changes: [f64; 3],
}

impl ActiveSet {
    /// Nothing has been solved yet.
    pub(super) fn begin(&mut self, rocks: usize, pairs: impl Iterator<Item = [usize; 2]>) {
        self.lately.clear();
        self.lately.resize(rocks, true);
        self.changes = [f64::INFINITY; 3];
        self.ends.clear();
        self.ends.extend(pairs);
        self.count = rocks + self.ends.len();
        self.asked.all(self.count);
        if !self.is_small() {
            self.of_rocks.lay(&self.ends, rocks);
        }
    }

    /// Whether the island has a few rocks only.
    pub(super) fn is_small(&self) -> bool {
        self.lately.len() <= SMALL
    }

    /// Part of what is allowed below which a change is none (–).
    pub(super) fn nothing(&self) -> f64 {
        if self.is_small() { SETTLED_AT_ONCE.0 } else { SETTLED_AT_ONCE.1 }
    }

    /// Begins another sweep.
    pub(super) fn begin_sweep(&mut self) {
        self.lately.fill(false);
        self.changes = [0.0, self.changes[0], self.changes[1]];
        if self.is_small() {
            self.asked.all(self.count);
        }
    }

    /// The next contact to ask after `last`, or the first of a sweep.
    pub(super) fn next(&self, last: Option<usize>, backwards: bool) -> Option<usize> {
        match (last, backwards) {
            (None, false) => self.asked.from(0),
            (None, true) => self.asked.last(),
            (Some(k), false) => self.asked.from(k + 1),
            (Some(k), true) => self.asked.below(k),
        }
    }

    /// Notes a change, relative to what is allowed.
    pub(super) fn note(&mut self, change: f64) {
        self.changes[0] = self.changes[0].max(change);
    }

    /// Whether all changes still to come are small: `q + q² + …` times the last one, if each sweep leaves the share `q` of
    /// the change before. Where sweeps creep, that is far more than the last change, and only the third sweep tells.
    ///
    /// The geometric series `q/(1 − q)` of a linearly convergent iteration, with `q` the worse of
    /// the last two ratios.
    pub(super) fn is_settled(&self) -> bool {
        let [now, before, earlier] = self.changes;
        let share = f64::max(now / before, before / earlier);
        let knows = earlier.is_finite() && share < 1.0;
        now <= self.nothing() || knows && now <= 1.0 && now * share <= 1.0 - share
    }

    /// Contact `k` is solved for the motions of its rocks.
    pub(super) fn see(&mut self, k: usize) {
        self.asked.remove(k);
    }

    /// Rock `k` has another motion: all its contacts must be asked again.
    pub(super) fn stir(&mut self, k: usize) {
        self.lately[k] = true;
        if self.is_small() {
            return;
        }
        self.asked.add(k);
        for contact in self.of_rocks.of(k) {
            self.asked.add(self.lately.len() + contact);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ActiveSet;

    /// A contact is asked again exactly when one of its rocks was stirred after it had been solved.
    #[test]
    fn what_is_stirred_is_solved_again() {
        let mut stirred = ActiveSet::default();
        stirred.begin(6, [[0, 1], [1, 5]].into_iter());
        let asked = |set: &ActiveSet| -> Vec<usize> {
            std::iter::successors(set.next(None, false), |k| set.next(Some(*k), false)).collect()
        };
        assert_eq!(asked(&stirred), [0, 1, 2, 3, 4, 5, 6, 7]);
        (0..8).for_each(|k| stirred.see(k));
        assert!(asked(&stirred).is_empty());
        stirred.stir(5);
        assert_eq!(asked(&stirred), [5, 7]);
        assert_eq!(stirred.next(Some(7), true), Some(5));
        stirred.see(7);
        stirred.begin_sweep();
        assert_eq!(asked(&stirred), [5]);
        // a small island is swept as a whole
        stirred.begin(2, [[0, 1]].into_iter());
        (0..3).for_each(|k| stirred.see(k));
        stirred.begin_sweep();
        assert_eq!(asked(&stirred), [0, 1, 2]);
    }
}

//! Which contacts of an island must be solved again.
//!
//! Most contacts of a large heap have settled after a few sweeps. Each rock carries a count of how
//! often it was set in another motion; a contact compares the counts of its rocks with those it
//! last saw, and is passed over where they agree.

/// Part of that below which a change counts as settled however fast changes die out (–).
pub(super) const SETTLED_AT_ONCE: f64 = 1e-4;

/// Which rocks have been stirred, and what every contact has seen of that.
#[derive(Debug, Default)]
pub(super) struct ActiveSet {
    /// How often each rock was set in another motion.
    pub(super) times: Vec<u32>,
    /// The count at which each rock's contacts with the mesh were solved …
    pub(super) contacts: Vec<u32>,
    /// … and each contact of two rocks: its rocks and their counts then. Kept here in a few bytes, because most contacts are only
    /// passed over.
    pairs: Vec<([u32; 2], [u32; 2])>,
    /// Rocks whose forces changed in the last sweep.
    pub(super) lately: Vec<bool>,
    /// Largest change in the current sweep and in the two before, relative to what is allowed.
    changes: [f64; 3],
}

impl ActiveSet {
    /// Nothing has been solved yet.
    pub(super) fn begin(&mut self, rocks: usize, pairs: impl Iterator<Item = [usize; 2]>) {
        self.times.clear();
        self.times.resize(rocks, 1);
        self.contacts.clear();
        self.contacts.resize(rocks, 0);
        self.pairs.clear();
        self.pairs.extend(pairs.map(|ends| (ends.map(|end| end as u32), [0; 2])));
        self.lately.clear();
        self.lately.resize(rocks, true);
        self.changes = [f64::INFINITY; 3];
    }

    /// Begins another sweep.
    pub(super) fn begin_sweep(&mut self) {
        self.lately.fill(false);
        self.changes = [0.0, self.changes[0], self.changes[1]];
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
        now <= SETTLED_AT_ONCE || knows && now <= 1.0 && now * share <= 1.0 - share
    }

    /// Whether neither rock of pair `k` was set in another motion since its contact was solved.
    pub(super) fn is_pair_settled(&self, k: usize) -> bool {
        let (ends, seen) = self.pairs[k];
        seen == ends.map(|end| self.times[end as usize])
    }

    /// The contact of pair `k` is solved for the motions of its rocks.
    pub(super) fn see_pair(&mut self, k: usize) {
        let (ends, seen) = &mut self.pairs[k];
        *seen = ends.map(|end| self.times[end as usize]);
    }

    /// Rock `k` has another motion: all its contacts must be asked again.
    pub(super) fn stir(&mut self, k: usize) {
        self.times[k] += 1;
        self.lately[k] = true;
    }
}

#[cfg(test)]
mod tests {
    use super::ActiveSet;

    /// A contact is looked at again exactly when one of its rocks was stirred after it had been solved.
    #[test]
    fn what_is_stirred_is_solved_again() {
        let mut stirred = ActiveSet::default();
        stirred.begin(2, [[0, 1]].into_iter());
        assert!(!stirred.is_pair_settled(0));
        stirred.see_pair(0);
        assert!(stirred.is_pair_settled(0));
        stirred.stir(1);
        assert!(!stirred.is_pair_settled(0));
        stirred.see_pair(0);
        stirred.begin(2, [[0, 1]].into_iter());
        assert!(!stirred.is_pair_settled(0));
    }
}

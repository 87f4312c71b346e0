//! What it took to follow a world, counted.

/// Counters of one world (no clock: the same on every machine).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WorldStats {
    /// Windows of time in which the whole world goes on, those gone through again included.
    pub windows: u64,
    /// Times that an island or the world went back because a rock was deviated further than was allowed for.
    pub returns: u64,
    /// Steps of islands.
    pub steps: u64,
    /// The same times the rocks of each.
    pub rock_steps: u64,
    /// Steps tried and thrown away.
    pub rejected: u64,
    /// Sweeps over the contacts of an island, or solves of its system.
    pub sweeps: u64,
    /// Systems factorised because sweeps crept.
    pub jumps: u64,
    /// Steps whose contact states did not settle (`dda`, `rigid`).
    pub unsettled: u64,
    /// Most rocks that took a step together.
    pub largest: u64,
}

impl WorldStats {
    /// Adds another's counts. Every field is named, so that a new counter does not compile until it is summed.
    pub(super) fn add(&mut self, one: &Self) {
        let Self {
            windows,
            returns,
            steps,
            rock_steps,
            rejected,
            sweeps,
            jumps,
            unsettled,
            largest,
        } = *one;
        self.windows += windows;
        self.returns += returns;
        self.steps += steps;
        self.rock_steps += rock_steps;
        self.rejected += rejected;
        self.sweeps += sweeps;
        self.jumps += jumps;
        self.unsettled += unsettled;
        self.largest = self.largest.max(largest);
    }
}

impl WorldStats {
    /// What was done after `before`. The largest island is that of the whole story.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        Self {
            windows: self.windows - before.windows,
            returns: self.returns - before.returns,
            steps: self.steps - before.steps,
            rock_steps: self.rock_steps - before.rock_steps,
            rejected: self.rejected - before.rejected,
            sweeps: self.sweeps - before.sweeps,
            jumps: self.jumps - before.jumps,
            unsettled: self.unsettled - before.unsettled,
            largest: self.largest,
        }
    }
}

//! Cost of the simulation of a world, in counts.

/// Counters of one world (no clock: the same on every machine).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WorldStats {
    /// Windows of time of the whole world, repeated ones included.
    pub windows: u64,
    /// Number of times that an island or the world returned to an earlier time because a rock
    /// deviated further than was allowed for.
    pub returns: u64,
    /// Steps of islands.
    pub steps: u64,
    /// Steps of islands, each times the number of its rocks.
    pub rock_steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Sweeps over the contacts of an island, or solves of its system.
    pub sweeps: u64,
    /// Systems factorised because sweeps converged slowly.
    pub jumps: u64,
    /// Steps whose contact states did not converge (`dda`, `rigid`).
    pub unsettled: u64,
    /// Largest number of rocks that took a step together.
    pub largest: u64,
}

impl WorldStats {
    /// Adds the counts of another. Every field is named, so that a new counter does not compile
    /// until it is summed.
    pub(super) fn add(&mut self, other: &Self) {
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
        } = *other;
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

    /// Counts since `before`. The largest island is that of the whole simulation.
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

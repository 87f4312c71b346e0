//! How often a year rocks arrive at a barrier, and what it does with them.

use super::super::arrival::Arrival;
use super::super::barriers::Barrier;
use super::super::lines::CrossingRow;
use super::super::rate::{ANY_ENERGY, EventRate, OpenSums, Sums};
use super::strata::{All, StratumSums, stratum_of};
use crate::frequency::Frequency;
use serde::{Deserialize, Serialize};

/// One barrier: of the rocks that arrive each is stopped, or reaches above its edge, or has too much energy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AnnualBarrier {
    /// Its name.
    pub name: String,
    /// Rocks that arrive; those that a barrier before has stopped do not.
    pub arriving: EventRate,
    /// Rocks that it stops.
    pub stopped: EventRate,
    /// Rocks that reach above its upper edge.
    pub over: EventRate,
    /// Rocks below its edge with more energy than it takes.
    pub through: EventRate,
}

/// Rocks that meet a barrier, stratum by stratum.
#[derive(Debug, Default)]
pub(super) struct Met {
    arriving: StratumSums,
    stopped: StratumSums,
    over: StratumSums,
    through: StratumSums,
    /// Rocks that may still arrive.
    open: OpenSums,
}

impl Met {
    /// Notes a rock that arrives; whether it is stopped.
    pub(super) fn add(
        &mut self,
        barrier: &Barrier,
        row: &CrossingRow,
        frequency: &Frequency,
    ) -> bool {
        let arrival = Arrival::of(row);
        let is_stopped = arrival.is_stopped(barrier.height_m, barrier.capacity_j);
        let fate = if is_stopped {
            &mut self.stopped
        } else if arrival.top_m > barrier.height_m {
            &mut self.over
        } else {
            &mut self.through
        };
        let (stratum, score) = stratum_of(frequency, row);
        let one = Sums::one(1.0, score);
        for strata in [fate, &mut self.arriving] {
            strata.entry(stratum).or_default().join(&one);
        }
        is_stopped
    }

    /// Notes rocks that may still arrive, by their releases.
    pub(super) fn leave_open(
        &mut self,
        releases: impl Iterator<Item = usize>,
        frequency: &Frequency,
    ) {
        for release in releases {
            let stratum = frequency.stratum_of(release) as u16;
            self.open.entry((ANY_ENERGY, stratum)).or_default().join(&Sums::one(1.0, 0.0));
        }
    }

    pub(super) fn said(&self, barrier: &Barrier, all: &All<'_>) -> AnnualBarrier {
        AnnualBarrier {
            name: barrier.name.clone(),
            arriving: all.rate_of_any(&self.arriving, &self.open),
            stopped: all.rate_of_any(&self.stopped, &self.open),
            over: all.rate_of_any(&self.over, &self.open),
            through: all.rate_of_any(&self.through, &self.open),
        }
    }
}

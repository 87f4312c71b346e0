//! What all places of a year share when they are told.

use super::super::barriers::Barrier;
use super::super::lines::CrossingRow;
use super::super::rate::{EventRate, Limits, OpenSums, Running, Sums};
use super::AnnualRequest;
use super::curve::Ceilings;
use crate::frequency::{Frequency, Weights, volume_m3};
use std::collections::BTreeMap;

/// Sums over rocks, stratum by stratum.
pub(super) type StratumSums = BTreeMap<u16, Sums>;

/// What all places share when they are told.
pub(super) struct All<'a> {
    pub(super) asked: &'a AnnualRequest,
    pub(super) frequency: &'a Frequency,
    pub(super) weights: Weights,
    pub(super) ceilings: Ceilings,
    pub(super) has_exponent: bool,
    pub(super) barriers: &'a [Barrier],
}

impl All<'_> {
    /// How often a year rocks do something that every rock might do, and that `open` ones may still do.
    pub(super) fn rate_of_any(&self, strata: &StratumSums, open: &OpenSums) -> EventRate {
        self.rate((Some(strata), open), &Limits::above(&self.weights, &[], 0.0))
    }

    pub(super) fn rate(
        &self,
        (strata, open): (Option<&StratumSums>, &OpenSums),
        limits: &Limits,
    ) -> EventRate {
        let mut running = Running::with_open(&self.weights, open);
        for (stratum, sums) in strata.into_iter().flatten() {
            running.add(*stratum, sums);
        }
        running.rate(limits, self.has_exponent)
    }
}

/// The stratum of the rock of a row, and how its frequency changes with the exponent.
pub(super) fn stratum_of(frequency: &Frequency, row: &CrossingRow) -> (u16, f64) {
    let stratum = frequency.stratum(row.index);
    let score = stratum.score(volume_m3(row.radius_m)).unwrap_or(0.0);
    (frequency.stratum_of(row.index) as u16, score)
}

//! Sums over all rocks of what `releases.csv` has no column for.

use crate::trajectory::{Effort, Ledger, Stop, Trajectory};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The largest value seen and whose it was: `rockfall run --only` shows that rock again.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Largest {
    /// Release number.
    pub release: usize,
    /// Its value.
    pub value: f64,
}

impl Largest {
    /// Keeps the larger one; the first among equals; nothing that is not a finite number.
    pub(super) fn update(this: &mut Option<Self>, release: usize, value: f64) {
        if value.is_finite() && this.is_none_or(|largest| value > largest.value) {
            *this = Some(Self { release, value });
        }
    }
}

/// Effort, energy ledger and failures of all rocks, added in the order of releases.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Release numbers of the rocks that failed, by reason.
    pub failures: BTreeMap<String, Vec<usize>>,
    /// What the computation cost, counted.
    pub effort: Effort,
    /// Where the energy of the rocks that did not fail went: sums (J), but [`Ledger::rise_j`] is the largest.
    pub ledger: Ledger,
    /// Energy released by the same rocks (J): the scale of the ledger.
    pub released_j: f64,
    /// Largest rise of mechanical energy over one contact episode (J).
    pub largest_energy_rise_j: Option<Largest>,
}

impl Totals {
    /// Adds one rock.
    pub fn add(&mut self, fall: &Trajectory) {
        add_effort(&mut self.effort, &fall.effort);
        // The ledger of a failed rock may hold anything, even no number: one such rock would blind all sums.
        if let Stop::Failed(reason) = &fall.stop {
            self.failures.entry(reason.clone()).or_default().push(fall.index);
            return;
        }
        add_ledger(&mut self.ledger, &fall.ledger);
        self.released_j += fall.released_j;
        Largest::update(&mut self.largest_energy_rise_j, fall.index, fall.ledger.rise_j);
    }
}

/// Every field is named, so that a new counter does not compile until it is summed.
fn add_effort(sum: &mut Effort, one: &Effort) {
    let Effort { steps, rejected, leaps, sweeps, triangles, unsettled } = *one;
    sum.steps += steps;
    sum.rejected += rejected;
    sum.leaps += leaps;
    sum.sweeps += sweeps;
    sum.triangles += triangles;
    sum.unsettled += unsettled;
}

/// Every field is named, so that a new entry does not compile until it is summed.
fn add_ledger(sum: &mut Ledger, one: &Ledger) {
    let Ledger { friction_j, damping_j, rolling_j, trees_j, others_j, remainder_j, rise_j } = *one;
    sum.friction_j += friction_j;
    sum.damping_j += damping_j;
    sum.rolling_j += rolling_j;
    sum.trees_j += trees_j;
    sum.others_j += others_j;
    sum.remainder_j += remainder_j;
    sum.rise_j = sum.rise_j.max(rise_j);
}

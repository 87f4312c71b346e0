//! Sums over all rocks of what `releases.csv` has no column for.

use super::profile::Profile;
use super::sum::Sum;
use crate::math;
use crate::simulation::{Effort, Ledger, Stop, Trajectory};
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

/// [`Ledger`]s added up (J).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LedgerSums {
    /// Sliding friction against the slope.
    pub friction_j: Sum,
    /// Normal and shear dashpots against the slope.
    pub damping_j: Sum,
    /// Rolling friction against the slope.
    pub rolling_j: Sum,
    /// Everything lost in contacts with trees.
    pub trees_j: Sum,
    /// Drag of soil that gives way.
    #[serde(default)]
    pub soil_j: Sum,
    /// Lost in contacts with other rocks.
    #[serde(default)]
    pub others_j: Sum,
    /// Handed on to other rocks.
    #[serde(default)]
    pub passed_on_j: Sum,
    /// Held by springs of contacts at the end.
    #[serde(default)]
    pub springs_j: Sum,
    /// What the numerics lost (positive) or gained (negative).
    pub remainder_j: Sum,
    /// The largest [`Ledger::rise_j`]; no sum.
    pub rise_j: f64,
}

/// Effort, energy ledger and failures of all rocks. The totals of a run's parts [join](Self::join) to the bits of
/// the whole.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Release numbers of the rocks that failed, by reason.
    pub failures: BTreeMap<String, Vec<usize>>,
    /// Release numbers of the rocks for which no place was found to start from, by reason.
    #[serde(default)]
    pub not_released: BTreeMap<String, Vec<usize>>,
    /// Release numbers of the rocks that had spent their budget of work.
    #[serde(default)]
    pub over_budget: Vec<usize>,
    /// What the computation cost, counted.
    pub effort: Effort,
    /// Where the energy of the rocks that did not fail went.
    pub ledger: LedgerSums,
    /// Energy released by the same rocks (J): the scale of the ledger.
    pub released_j: Sum,
    /// Largest rise of mechanical energy over one contact episode (J).
    pub largest_energy_rise_j: Option<Largest>,
    /// Speed and height by distance from the release, over the same rocks.
    #[serde(default, skip_serializing_if = "Profile::is_empty")]
    pub profile: Profile,
}

impl Totals {
    /// Adds one rock.
    pub fn add(&mut self, fall: &Trajectory) {
        self.effort.add(&fall.effort);
        // The ledger of a failed rock may hold anything, even no number: one such rock would blind all sums.
        if let Stop::Failed(reason) = &fall.stop {
            self.failures.entry(reason.clone()).or_default().push(fall.index);
            return;
        }
        if let Stop::NotReleased(why) = fall.stop {
            self.not_released.entry(why.to_owned()).or_default().push(fall.index);
            return;
        }
        if fall.stop == Stop::OverBudget {
            self.over_budget.push(fall.index);
        }
        self.ledger.add(&fall.ledger);
        self.released_j.add(fall.released_j);
        Largest::update(&mut self.largest_energy_rise_j, fall.index, fall.ledger.rise_j);
    }

    /// Adds the totals of the releases that follow.
    pub fn join(&mut self, next: &Self) {
        let Self {
            failures,
            not_released,
            over_budget,
            effort,
            ledger,
            released_j,
            largest_energy_rise_j,
            profile,
        } = next;
        self.profile.join(profile);
        for (why, releases) in not_released {
            self.not_released.entry(why.clone()).or_default().extend(releases);
        }
        self.over_budget.extend(over_budget);
        for (reason, releases) in failures {
            self.failures.entry(reason.clone()).or_default().extend(releases);
        }
        self.effort.add(effort);
        self.ledger.join(ledger);
        self.released_j.join(released_j);
        if let Some(largest) = largest_energy_rise_j {
            Largest::update(&mut self.largest_energy_rise_j, largest.release, largest.value);
        }
    }

    /// With sums as one number each, as a summary shows them.
    #[must_use]
    pub fn rounded(&self) -> Self {
        Self {
            ledger: self.ledger.rounded(),
            released_j: self.released_j.rounded(),
            ..self.clone()
        }
    }
}

impl Totals {
    /// What the numbers of the computation itself warn of, of so many rocks; empty when all is well. `least_j` stands for the energy released
    /// where that is less, as of rocks that stood still (J).
    pub(super) fn warnings(&self, rocks: usize, least_j: f64) -> Vec<String> {
        let mut warnings = Vec::new();
        let failed: usize = self.failures.values().map(Vec::len).sum();
        if let Some(first) = self.failures.values().flatten().min() {
            warnings.push(format!(
                "{failed} of {rocks} rocks failed: they count as far as they came; `--only {first}` shows one again"
            ));
        }
        for (why, releases) in &self.not_released {
            warnings.push(format!(
                "{} of {rocks} rocks were not released, {why}: they are counted, but in no statistic; the first is release {}",
                releases.len(),
                releases.first().copied().unwrap_or_default()
            ));
        }
        if let Some(first) = self.over_budget.first() {
            warnings.push(format!(
                "{} of {rocks} rocks were still moving when their budget of work was spent: they count as far as they came; `--only {first}` shows one again",
                self.over_budget.len()
            ));
        }
        let Effort { steps, unsettled, .. } = self.effort;
        if unsettled as f64 > UNSETTLED * steps as f64 {
            warnings.push(format!(
                "{unsettled} of {steps} contact steps did not settle: their contact forces do not agree with their motion; take a smaller tolerance_m_s, step_s or corner_way, whichever the scheme has"
            ));
        }
        let lost = self.ledger.remainder_j.value() / self.released_j.value().max(least_j);
        if lost.abs() > NUMERICAL {
            let what = if lost > 0.0 { "lost" } else { "gained" };
            warnings.push(format!(
                "the computation itself {what} {:.1} % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
                100.0 * lost.abs()
            ));
        }
        let released_j = self.released_j.value().max(least_j) / rocks.max(1) as f64;
        let allowed_j = self.allowed_rise() * released_j;
        if let Some(rise) = self.largest_energy_rise_j.filter(|rise| rise.value > allowed_j) {
            warnings.push(format!(
                "release {}: its mechanical energy rose by {} J in one contact; take a smaller tolerance or step",
                rise.release,
                math::rounded(rise.value, 3)
            ));
        }
        warnings
    }

    /// Rise of a rock's energy over one contact that is no sign of a fault, over what a rock releases on average (–).
    fn allowed_rise(&self) -> f64 {
        let exchanged = [&self.ledger.others_j, &self.ledger.passed_on_j];
        let strike_each_other = exchanged.iter().any(|sum| sum.value() != 0.0);
        if strike_each_other { RISE_BESIDE_OTHERS } else { RISE }
    }
}

/// Numerical loss of energy that is reported, over the energy released (–); the examples stay below half a per cent.
const NUMERICAL: f64 = 0.02;
/// Steps that did not settle are reported above this share of all (–).
const UNSETTLED: f64 = 1e-3;
/// A rise of energy over one contact is rounding up to this share of what a rock releases on average (–).
const RISE: f64 = 1e-6;
/// The same of rocks that strike each other: what one gets from another is known to the local error of their contact, up to 1 % of the speed of
/// a blow through a heap, whatever both have together.
const RISE_BESIDE_OTHERS: f64 = 5e-3;

impl LedgerSums {
    /// The sums; every field is named, so that a new entry does not compile until it is summed.
    fn sums(&mut self) -> [&mut Sum; 9] {
        let Self {
            friction_j,
            damping_j,
            rolling_j,
            trees_j,
            soil_j,
            others_j,
            passed_on_j,
            springs_j,
            remainder_j,
            rise_j: _,
        } = self;
        [
            friction_j,
            damping_j,
            rolling_j,
            trees_j,
            soil_j,
            others_j,
            passed_on_j,
            springs_j,
            remainder_j,
        ]
    }

    /// The entries in the order of [`Self::sums`].
    fn add(&mut self, one: &Ledger) {
        let Ledger {
            friction_j,
            damping_j,
            rolling_j,
            trees_j,
            soil_j,
            others_j,
            passed_on_j,
            springs_j,
            remainder_j,
            rise_j,
        } = *one;
        let entries = [
            friction_j,
            damping_j,
            rolling_j,
            trees_j,
            soil_j,
            others_j,
            passed_on_j,
            springs_j,
            remainder_j,
        ];
        for (sum, entry) in self.sums().into_iter().zip(entries) {
            sum.add(entry);
        }
        self.rise_j = self.rise_j.max(rise_j);
    }

    fn join(&mut self, other: &Self) {
        let mut other = other.clone();
        self.rise_j = self.rise_j.max(other.rise_j);
        for (sum, more) in self.sums().into_iter().zip(other.sums()) {
            sum.join(more);
        }
    }

    fn rounded(&self) -> Self {
        let mut rounded = self.clone();
        rounded.sums().into_iter().for_each(|sum| *sum = sum.rounded());
        rounded
    }
}

#[cfg(test)]
mod tests {
    use super::{Largest, Sum, Totals};

    /// A gain of 1e-3 of what a rock releases is a fault of a rock alone and the local error of rocks that strike each other; one of 1e-2 is a fault
    /// of both.
    #[test]
    fn rocks_that_strike_each_other_may_gain_their_local_error() {
        let mut totals = Totals::default();
        totals.released_j.add(20_000.0);
        let mut said = |rise_j: f64, passed_on_j: f64| {
            totals.largest_energy_rise_j = Some(Largest { release: 3, value: rise_j });
            totals.ledger.passed_on_j = Sum::default();
            totals.ledger.passed_on_j.add(passed_on_j);
            totals.warnings(2, 0.0).iter().filter(|one| one.contains("rose by")).count()
        };
        assert_eq!([said(10.0, 0.0), said(10.0, 50.0)], [1, 0]);
        assert_eq!([said(100.0, 0.0), said(100.0, 50.0)], [1, 1]);
        assert_eq!(said(1e-3, 0.0), 0);
    }
}

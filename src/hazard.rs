//! Statistics over all rocks: counts, percentiles and shares, each with its confidence interval.
//!
//! Values are kept exactly, 8 bytes each: the eleven [quantities](Quantity) take 88 MB per million releases.
//! Nothing is sketched or binned before it is asked for, so the statistics do not depend on the order or the
//! grouping in which rocks arrive, and a drawing from files shows the same bits as the run itself.

mod annual;
mod arrival;
mod barriers;
mod beta;
mod classes;
mod design;
mod difference;
mod lines;
mod maps;
mod observed;
mod open;
mod profile;
mod proportion;
mod quantile;
mod quantity;
mod rate;
mod residual;
mod row;
mod sample;
mod strata;
mod sum;
mod totals;

pub use annual::{
    Above, Annual, AnnualBarrier, AnnualFigures, AnnualPlace, AnnualRequest, ExceedancePoint,
    Matrix, Object, ReturnEnergy, Risk, RiskKind, Saved, UnseenPoint, Vehicles, YearMap, YearSums,
    annual, file_above, file_of_period, year_maps,
};
pub use arrival::Arrival;
pub use barriers::{
    Arrivals, AtPlace, Barrier, BarrierSummary, Elsewhere, arrivals, barrier_warnings, judge,
    stopping,
};
pub use design::{Design, DesignBlock, Rule};
pub use difference::{Difference, Reading, Values, WeightedCount};
pub use lines::{
    ClassReach, CrossingRow, Line, LineFloor, LineInfo, LineQuantity, LineSummary, SilentClasses,
    by_rock,
};
pub use maps::{INTENSITY_J, Layer, MapFrame, MapState, Maps};
pub use observed::{
    Agreement, EndDistances, EndSpread, KOLMOGOROV_95, ObservedPath, OpenEnds, RunoutDistances,
    Weighted, effective, ks_limit, mean_95, rank, runouts,
};
pub use open::{OpenRock, OpenRocks, RowBounds};
pub use profile::{Profile, ProfilePoint, StretchStatistic};
pub use proportion::Proportion;
pub(crate) use proportion::student_95;
pub use quantile::{Open, Percentile, Ranks};
pub use quantity::Quantity;
pub use rate::{EventRate, share_of, share_up_to};
pub use residual::{Passing, Residual, residual, unstopped};
pub use row::{Row, StopKind};
pub use sample::{Exceedance, Histogram, Mean, Sample};
pub use sum::Sum;
pub use totals::{Largest, LedgerSums, Totals};

use crate::frequency::{Frequency, RockSource, Weights};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Percentiles of every table (per cent).
pub const PERCENTS: [u8; 5] = [50, 90, 95, 98, 99];

/// Statistics over all rocks computed so far.
///
/// The statistics are over all rocks that were released. One that left the terrain, ran out of time or work, or failed counts
/// with what it had done until then; its runout is a lower bound, and so is every percentile of runout that such rocks decide. So are
/// the largest values of one that ran out of time or work, or failed, where it could come to [larger](RowBounds::of).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hazard {
    stops: BTreeMap<StopKind, EndCounts>,
    values: [Vec<f64>; Quantity::ALL.len()],
    /// Which values of each rock are only bounds, in the order of the values.
    bounds: Vec<RowBounds>,
    /// The lowest ground of the terrain; none where rocks push each other.
    floor: Option<LineFloor>,
    /// Those that would have gone on, by rising release.
    open: Vec<OpenRock>,
    largest: [Option<Largest>; Quantity::ALL.len()],
    largest_balance_error: Option<Largest>,
    /// Energies of falls by a tenth of the radius of the rocks that did not fail (J).
    small_falls_j: Sum,
    frequency: Option<Frequency>,
    /// The first release added, and those that were never released.
    first: Option<usize>,
    not_released: Vec<usize>,
    /// Effort, ledger and failures: what the rows do not hold.
    pub totals: Totals,
}

/// Rocks that ended in one way, stratum by stratum.
#[derive(Debug, Clone, PartialEq, Default)]
struct EndCounts(Vec<usize>);

impl EndCounts {
    fn add(&mut self, stratum: usize) {
        if self.0.len() <= stratum {
            self.0.resize(stratum + 1, 0);
        }
        self.0[stratum] += 1;
    }

    fn count(&self) -> usize {
        self.0.iter().sum()
    }
}

/// Statistics of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// Rocks with a value: all that were released, but for failed ones that left no number.
    pub rocks: usize,
    /// Mean with its normal interval.
    pub mean: Option<Mean>,
    /// Percentiles by name, `p50` to `p99`.
    pub percentiles: BTreeMap<String, Percentile>,
    /// The largest value and the release it belongs to.
    pub max: Option<Largest>,
    /// Rocks whose own value is only a bound: they left the terrain, ran out of time or failed.
    #[serde(default, skip_serializing_if = "is_0")]
    pub censored: usize,
    /// Which percentiles have no upper bound because there are too few rocks; empty when all have.
    pub too_few: String,
}

impl Hazard {
    /// No rocks, but these totals: the rows that belong to them are to be added.
    pub fn with(totals: Totals) -> Self {
        Self { totals, ..Self::default() }
    }

    /// The same, of rocks that are drawn by a frequency: they weigh what they stand for.
    #[must_use]
    pub fn weighing(self, frequency: Option<Frequency>) -> Self {
        Self { frequency, ..self }
    }

    /// The same, over terrain whose lowest ground is known: a rock that would have gone on gets no more energy than its fall to it gives.
    #[must_use]
    pub fn over(self, floor: Option<LineFloor>) -> Self {
        Self { floor, ..self }
    }

    /// What each rock stands for; none where all weigh the same.
    pub fn weights(&self) -> Option<Weights> {
        self.year_weights().filter(|weights| !weights.are_equal())
    }

    /// The same, one event for all where they weigh the same.
    pub fn weights_or_equal(&self) -> Weights {
        self.weights().unwrap_or_else(|| Weights::equal(self.released()))
    }

    /// Events a year that the rocks of each stratum stand for; none without sources. Those that were released
    /// share them: a rock without a place to start from says nothing of how far rocks come. A part of a run, or one rock of it,
    /// stands for the strata alone that it has releases of.
    pub fn year_weights(&self) -> Option<Weights> {
        self.weights_among(StopKind::is_released)
    }

    /// The same, shared by the rocks that ended in some ways.
    fn weights_among(&self, is_one: impl Fn(StopKind) -> bool) -> Option<Weights> {
        let frequency = self.frequency.as_ref()?;
        Some(frequency.weights_of(self.by_stratum(is_one)).within(&self.by_stratum(|_| true)))
    }

    /// Rocks of each stratum that ended in some ways.
    fn by_stratum(&self, is_one: impl Fn(StopKind) -> bool) -> Vec<usize> {
        let mut rocks = Vec::new();
        for (_, ended) in self.stops.iter().filter(|(stop, _)| is_one(**stop)) {
            rocks.resize(rocks.len().max(ended.0.len()), 0);
            for (all, count) in rocks.iter_mut().zip(&ended.0) {
                *all += count;
            }
        }
        rocks
    }

    /// Sources with events of which no rock was released: they are missing in all numbers.
    pub fn missing_events(&self) -> Vec<String> {
        let Some(frequency) = &self.frequency else { return Vec::new() };
        let [all, released] = [self.by_stratum(|_| true), self.by_stratum(StopKind::is_released)];
        let is_missing = |at: usize| {
            let rocks = |of: &[usize]| of.get(at).copied().unwrap_or(0);
            rocks(&all) > 0 && rocks(&released) == 0
        };
        let said = |(number, source): (usize, &RockSource)| {
            let strata = frequency.strata().iter().enumerate();
            let lost = strata.filter(|(at, one)| one.source == number && is_missing(*at));
            let missing: f64 = lost.map(|(_, one)| one.per_year).sum();
            (missing > 0.0).then(|| {
                format!(
                    "source “{}”: no rock of {missing:.3e} of its {:.3e} events a year was released: they are missing in every number",
                    source.name,
                    source.law.per_year()
                )
            })
        };
        frequency.sources().iter().enumerate().filter_map(said).collect()
    }

    /// Adds one rock. Its failure reason, ledger and effort go into [`Self::totals`].
    pub fn add(&mut self, row: &Row) {
        let stratum = self.frequency.as_ref().map_or(0, |one| one.stratum_of(row.index));
        self.stops.entry(row.stop).or_default().add(stratum);
        self.first.get_or_insert(row.index);
        self.open.extend(OpenRock::of(row));
        Largest::update(&mut self.largest_balance_error, row.index, balance_error(row));
        if !matches!(row.stop, StopKind::Failed | StopKind::NotReleased) {
            self.small_falls_j.add(small_fall_j(row));
        }
        if !row.stop.is_released() {
            self.not_released.push(row.index);
            return;
        }
        self.bounds.push(RowBounds::of(row, self.floor));
        for (slot, quantity) in Quantity::ALL.into_iter().enumerate() {
            let value = quantity.of(row);
            // a failed rock may have left no number; infinite, two equal runs stay equal
            self.values[slot].push(if value.is_nan() { f64::INFINITY } else { value });
            Largest::update(&mut self.largest[slot], row.index, value);
        }
    }

    /// What the numbers of the computation itself warn of; empty when all is well.
    pub fn warnings(&self) -> Vec<String> {
        self.totals.warnings(self.rocks(), self.small_falls_j.value())
    }

    /// Rocks added so far, never released ones included.
    pub fn rocks(&self) -> usize {
        self.stops.values().map(EndCounts::count).sum()
    }

    /// Rocks that would have gone on, by rising release.
    pub fn open_rocks(&self) -> &[OpenRock] {
        &self.open
    }

    /// Whether some rock that would have gone on could come to a larger speed, energy or height than it had.
    pub fn leaves_largest_open(&self) -> bool {
        let is_open = |of: &RowBounds| RowBounds::LARGEST.iter().any(|one| of.has(*one));
        self.bounds.iter().any(is_open)
    }

    /// Rocks that ended on the map and would have gone on: they are missing in its cells further on. None of none.
    pub fn open_on(&self, map: &MapFrame) -> Option<Proportion> {
        let open = self.open.iter().filter(|rock| rock.ended_on(map)).map(|rock| rock.release);
        rate::share_if_any(&self.weights_or_equal(), open)
    }

    /// Rocks that were released: shares of rocks are of these.
    pub fn released(&self) -> usize {
        self.rocks() - self.stops.get(&StopKind::NotReleased).map_or(0, EndCounts::count)
    }

    /// Rocks that ended so, as a share of all releases.
    pub fn ended(&self, stop: StopKind) -> Proportion {
        self.ended_among(stop, |_| true)
    }

    /// The same as a share of the rocks that were released, as shares at lines and on maps are.
    pub fn ended_of_released(&self, stop: StopKind) -> Proportion {
        self.ended_among(stop, StopKind::is_released)
    }

    fn ended_among(&self, stop: StopKind, is_one: impl Fn(StopKind) -> bool + Copy) -> Proportion {
        let count = self.stops.get(&stop).map_or(0, EndCounts::count);
        match self.weights_among(is_one).filter(|weights| !weights.are_equal()) {
            None => Proportion::new(count, self.by_stratum(is_one).iter().sum()),
            Some(weights) => {
                let strata = self.stops.get(&stop).map_or(&[][..], |ended| &ended.0);
                let each = strata.iter().enumerate().map(|(at, count)| (at as u16, *count));
                rate::proportion(&weights, each)
            }
        }
    }

    /// Largest energy balance error of one rock (–), over the energy of a fall by a tenth of its radius where it released less.
    pub fn largest_balance_error(&self) -> Option<Largest> {
        self.largest_balance_error
    }

    /// All values of one quantity, sorted: for curves and histograms.
    pub fn sample(&self, quantity: Quantity) -> Sample {
        let weights = self.weights_or_equal();
        let seen = self.of_releases(quantity).zip(&self.bounds);
        let each = seen.map(|((value, release), bounds)| (value, release, bounds.has(quantity)));
        Sample::censored_of_releases(each, &weights, quantity.open())
    }

    /// The same, the values of rocks that would have gone on taken as they were seen.
    pub fn sample_as_seen(&self, quantity: Quantity) -> Sample {
        Sample::of_releases(self.of_releases(quantity), &self.weights_or_equal())
    }

    /// Values in the order of releases, each with its own.
    fn of_releases(&self, quantity: Quantity) -> impl Iterator<Item = (f64, usize)> {
        let first = self.first.unwrap_or(0);
        let is_released = |at: &usize| self.not_released.binary_search(at).is_err();
        let released = (first..first + self.rocks()).filter(is_released);
        self.values(quantity).iter().copied().zip(released)
    }

    /// Share of the rocks whose value of a quantity `is_one`; a rock that left no number is none.
    pub fn share_with(&self, quantity: Quantity, is_one: impl Fn(f64) -> bool) -> Proportion {
        let some =
            self.of_releases(quantity).filter(|(value, _)| value.is_finite() && is_one(*value));
        share_of(&self.weights_or_equal(), some.map(|(_, release)| release))
    }

    /// The values of one quantity in the order of releases (rocks that were never released have none); infinite where a
    /// failed rock left no number.
    pub fn values(&self, quantity: Quantity) -> &[f64] {
        &self.values[quantity as usize]
    }

    /// Statistics of one quantity.
    pub fn statistic(&self, quantity: Quantity) -> Statistic {
        statistic(&self.sample(quantity), self.largest[quantity as usize])
    }
}

/// Statistics of a sample whose largest value is known.
fn statistic(sample: &Sample, max: Option<Largest>) -> Statistic {
    let percentiles: BTreeMap<String, Percentile> = PERCENTS
        .iter()
        .filter_map(|&percent| {
            let percentile = sample.percentile(f64::from(percent) / 100.0)?;
            Some((format!("p{percent}"), percentile))
        })
        .collect();
    Statistic {
        rocks: sample.values().len(),
        mean: sample.mean(),
        censored: sample.bounds(),
        too_few: too_few(sample.values().len(), &percentiles),
        percentiles,
        max,
    }
}

/// A rock that released less than it would in a fall by this much of its radius (–) as good as stood still.
const STANDS: f64 = 0.1;
/// What that fall is reckoned with (m/s²).
const EARTH_M_S2: f64 = 9.81;

/// Energy of a fall by a tenth of the radius of a rock (J).
fn small_fall_j(row: &Row) -> f64 {
    row.mass_kg * EARTH_M_S2 * STANDS * row.radius_m
}

/// What the numerics made or lost of the energy of a rock (–), over what it released or that of a fall by a tenth of its radius, whichever is
/// more: rounding of a rock that stood still is no share of the nothing that it released.
fn balance_error(row: &Row) -> f64 {
    // a share of a rock whose ledger is no number is its own
    row.energy_balance_error.min(row.remainder_j.abs() / small_fall_j(row))
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_0(count: &usize) -> bool {
    *count == 0
}

/// Names the percentiles that no value bounds, and how many rocks they need.
fn too_few(rocks: usize, percentiles: &BTreeMap<String, Percentile>) -> String {
    let missing: Vec<String> = percentiles
        .iter()
        .filter(|(_, percentile)| rocks < percentile.needs)
        .map(|(name, percentile)| format!("{name} needs {}", percentile.needs))
        .collect();
    if missing.is_empty() {
        return String::new();
    }
    format!("{rocks} rocks give no upper bound with 95 % confidence: {}", missing.join(", "))
}

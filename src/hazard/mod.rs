//! What all rocks say together: counts, percentiles and shares, each with its confidence interval.
//!
//! Values are kept exactly, 8 bytes each: the eleven [quantities](Quantity) take 88 MB per million releases.
//! Nothing is sketched or binned before it is asked for, so the statistics do not depend on the order or the
//! grouping in which rocks arrive, and a drawing from files shows the same bits as the run itself.

mod barriers;
mod lines;
mod maps;
mod observed;
mod proportion;
mod quantile;
mod quantity;
mod row;
mod sample;
mod sum;
mod totals;

pub use barriers::{
    Arrival, Arrivals, AtPlace, Barrier, BarrierSummary, Design, Elsewhere, Rule, arrivals, judge,
};
pub use lines::{CrossingRow, Line, LineInfo, LineQuantity, LineSummary};
pub use maps::{INTENSITY_J, Layer, MapFrame, MapState, Maps};
pub use observed::{Agreement, Spread, Way, effective};
pub use proportion::Proportion;
pub use quantile::{Percentile, Ranks};
pub use quantity::Quantity;
pub use row::{Row, StopKind};
pub use sample::{Exceedance, Histogram, Mean, Sample};
pub use sum::Sum;
pub use totals::{Largest, LedgerSums, Totals};

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Percentiles of every table (per cent).
pub const PERCENTS: [u8; 5] = [50, 90, 95, 98, 99];

/// All rocks so far.
///
/// The statistics are over all rocks but the failed and the never released: these have a row and are counted, but
/// where they stopped is where the computation did. A rock that left the terrain or ran out of time or work counts with what it
/// had done until then; its runout is a lower bound.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hazard {
    stops: BTreeMap<StopKind, usize>,
    values: [Vec<f64>; Quantity::ALL.len()],
    largest: [Option<Largest>; Quantity::ALL.len()],
    largest_balance_error: Option<Largest>,
    /// Effort, ledger and failures: what the rows do not hold.
    pub totals: Totals,
}

/// What is said of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// Rocks with a value: all that did not fail.
    pub rocks: usize,
    /// Mean with its normal interval.
    pub mean: Option<Mean>,
    /// Percentiles by name, `p50` to `p99`.
    pub percentiles: BTreeMap<String, Percentile>,
    /// The largest value and the release it belongs to.
    pub max: Option<Largest>,
    /// Which percentiles have no upper bound because there are too few rocks; empty when all have.
    pub too_few: String,
}

impl Hazard {
    /// No rocks, but these totals: the rows that belong to them are to be added.
    pub fn with(totals: Totals) -> Self {
        Self { totals, ..Self::default() }
    }

    /// Adds one rock. Its failure reason, ledger and effort go into [`Self::totals`].
    pub fn add(&mut self, row: &Row) {
        *self.stops.entry(row.stop).or_default() += 1;
        Largest::update(&mut self.largest_balance_error, row.index, row.energy_balance_error);
        if !row.stop.counts() {
            return;
        }
        for (slot, quantity) in Quantity::ALL.into_iter().enumerate() {
            let value = quantity.of(row);
            self.values[slot].push(value);
            Largest::update(&mut self.largest[slot], row.index, value);
        }
    }

    /// Rocks added so far, failed and never released ones included.
    pub fn rocks(&self) -> usize {
        self.stops.values().sum()
    }

    /// Rocks that ended so, as a share of all.
    pub fn ended(&self, stop: StopKind) -> Proportion {
        Proportion::new(self.stops.get(&stop).copied().unwrap_or(0), self.rocks())
    }

    /// Largest energy balance error of one rock (–); a failed rock counts too if it has a number.
    pub fn largest_balance_error(&self) -> Option<Largest> {
        self.largest_balance_error
    }

    /// All values of one quantity, sorted: for curves and histograms.
    pub fn sample(&self, quantity: Quantity) -> Sample {
        Sample::of(self.values[quantity as usize].iter().copied())
    }

    /// The values of one quantity in the order of releases (failed rocks have none).
    pub fn values(&self, quantity: Quantity) -> &[f64] {
        &self.values[quantity as usize]
    }

    /// Statistics of one quantity.
    pub fn statistic(&self, quantity: Quantity) -> Statistic {
        statistic(&self.sample(quantity), self.largest[quantity as usize])
    }
}

/// What is said of a sample whose largest value is known.
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
        too_few: too_few(sample.values().len(), &percentiles),
        percentiles,
        max,
    }
}

/// Names the percentiles that no value bounds, and how many rocks they need.
fn too_few(rocks: usize, percentiles: &BTreeMap<String, Percentile>) -> String {
    let missing: Vec<String> = percentiles
        .iter()
        .filter(|(_, percentile)| percentile.upper_95.is_none())
        .map(|(name, percentile)| format!("{name} needs {}", percentile.needs))
        .collect();
    if missing.is_empty() {
        return String::new();
    }
    format!("{rocks} rocks give no upper bound with 95 % confidence: {}", missing.join(", "))
}

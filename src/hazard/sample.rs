//! All values of one quantity, sorted, and what they say.

use super::proportion::NORMAL_95;
use super::quantile::Percentile;
use crate::math;
use serde::{Deserialize, Serialize};

/// Values of one quantity in ascending order; what is not a finite number is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    sorted: Vec<f64>,
}

/// A mean with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Mean {
    /// Mean.
    pub value: f64,
    /// Lower end of the interval; none for a single value.
    pub low_95: Option<f64>,
    /// Upper end of the interval; none for a single value.
    pub high_95: Option<f64>,
}

/// A share of rocks that exceeds a value, the value, and where it lies with 95 % confidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exceedance {
    /// Share of the rocks above the value (–), between 0 and 1.
    pub share: f64,
    /// The value exceeded by that share.
    pub value: f64,
    /// Lower end of the interval of the value; none when there are too few rocks.
    pub low_95: Option<f64>,
    /// Upper end of the interval of the value; none when there are too few rocks.
    pub high_95: Option<f64>,
}

/// How many values fall between neighbouring edges.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Ascending edges, one more than counts; round numbers.
    pub edges: Vec<f64>,
    /// Values from one edge up to below the next.
    pub counts: Vec<usize>,
}

/// Fewest and most bars of a histogram: enough to show a second peak, few enough to be read.
const BARS: (f64, f64) = (5.0, 60.0);

impl Sample {
    /// Sorts the finite ones of the values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        Self { sorted }
    }

    /// The values in ascending order.
    pub fn values(&self) -> &[f64] {
        &self.sorted
    }

    /// Mean with the normal interval `± 1.96 s/√n`; none of nothing.
    ///
    /// Summed in ascending order, so the same values give the same bits however they arrived.
    pub fn mean(&self) -> Option<Mean> {
        let n = self.sorted.len() as f64;
        let value = self.sorted.iter().sum::<f64>() / n;
        let squares: f64 = self.sorted.iter().map(|one| (one - value).powi(2)).sum();
        let half = NORMAL_95 * (squares / (n - 1.0) / n).sqrt();
        let spread = (n > 1.0).then_some(half);
        let mean = Mean {
            value,
            low_95: spread.map(|half| value - half),
            high_95: spread.map(|half| value + half),
        };
        (!self.sorted.is_empty()).then_some(mean)
    }

    /// Percentile `p` (0 < p < 1) with its interval; none of nothing.
    pub fn percentile(&self, p: f64) -> Option<Percentile> {
        Percentile::of(&self.sorted, p)
    }

    /// The curve of exceedance, from the share 0.995 down to `1/n`.
    ///
    /// Each point is a percentile with its order-statistic interval, so the curve passes exactly through the
    /// percentiles of the tables. The band is pointwise: each point keeps 95 % by itself, not all at once.
    pub fn exceedance(&self) -> Vec<Exceedance> {
        let point = |share: f64| {
            let Percentile { value, low_95, high_95, .. } = self.percentile(1.0 - share)?;
            Some(Exceedance { share, value, low_95, high_95 })
        };
        shares(self.sorted.len()).into_iter().filter_map(point).collect()
    }

    /// A histogram with bars of a round width near that of Freedman and Diaconis (1981), `2 IQR / ∛n`;
    /// none of nothing.
    pub fn histogram(&self) -> Option<Histogram> {
        let (&least, &most) = (self.sorted.first()?, self.sorted.last()?);
        let width = self.bar_width(least, most);
        let first = (least / width).floor();
        let bars = (most / width).floor() - first + 1.0;
        let edges: Vec<f64> = (0..=bars as usize).map(|bar| (first + bar as f64) * width).collect();
        // Cut at the inner edges as they are: rounding of the outer ones can lose no value.
        let below = |edge: &f64| self.sorted.partition_point(|value| value < edge);
        let inner = edges[1..edges.len() - 1].iter().map(below);
        let cuts: Vec<usize> = [0].into_iter().chain(inner).chain([self.sorted.len()]).collect();
        let counts = cuts.windows(2).map(|pair| pair[1] - pair[0]).collect();
        Some(Histogram { edges, counts })
    }

    /// A round bar width, positive.
    fn bar_width(&self, least: f64, most: f64) -> f64 {
        let range = most - least;
        let quarter = |p| self.percentile(p).map_or(0.0, |quarter| quarter.value);
        let wanted = 2.0 * (quarter(0.75) - quarter(0.25)) / math::cbrt(self.sorted.len() as f64);
        let width = wanted.clamp(range / BARS.1, range / BARS.0);
        // All values equal: one bar, wide enough to be told from its neighbours in f64.
        if width > 0.0 { round_up(width) } else { round_up(least.abs().max(1.0) * 1e-3) }
    }
}

/// The next of 1, 2, 5 times a power of ten.
fn round_up(width: f64) -> f64 {
    let power = math::pow(10_f64, math::log10(width).floor());
    [1.0, 2.0, 5.0]
        .map(|step| step * power)
        .into_iter()
        .find(|&step| step >= width)
        .unwrap_or(10.0 * power)
}

/// Shares at which a curve of `n` rocks is drawn: every half per cent, then ten a decade down to `1/n`.
fn shares(n: usize) -> Vec<f64> {
    let body = (1..200).rev().map(|step| f64::from(step) / 200.0);
    let tail = (24..).map(|tenth| math::pow(10_f64, -f64::from(tenth) / 10.0));
    body.chain(tail.take_while(|share| share * n as f64 >= 1.0)).collect()
}

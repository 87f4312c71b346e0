//! Counting values into bins of round width, for display only.

use super::axis::{Axis, nice_step};
use super::canvas::Canvas;
use super::colour::SKY;
use super::panel::Panel;
use crate::math;

/// Most and least number of bins over the range of the values.
const MOST_BINS: f64 = 40.0;
const LEAST_BINS: f64 = 8.0;

/// Counts of values in bins of equal width.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct EqualBins {
    /// Lower end of the first bin, a multiple of the width.
    pub(super) from: f64,
    /// Width of a bin.
    pub(super) width: f64,
    /// Values in each bin; a value on a boundary counts in the upper one.
    pub(super) counts: Vec<usize>,
    /// Values that are not finite and in no bin.
    pub(super) left_out: usize,
    /// Values beyond the last bin.
    pub(super) beyond: usize,
    /// Whether `from` and `width` are powers of ten.
    is_log: bool,
}

/// Share of the values that a clipped histogram shows.
const SHOWN: f64 = 0.995;
/// A histogram is clipped where the largest value lies farther out than this many times what is shown.
const FAR: f64 = 1.3;

impl EqualBins {
    /// Bins of round width, about √n of them.
    pub(super) fn of(values: &[f64]) -> Self {
        let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        let left_out = values.len() - finite.len();
        let Some((low, high)) = range(&finite) else {
            return Self {
                from: 0.0,
                width: 1.0,
                counts: Vec::new(),
                left_out,
                beyond: 0,
                is_log: false,
            };
        };
        let bins = (finite.len() as f64).sqrt().clamp(LEAST_BINS, MOST_BINS);
        let width = nice_step(spread(low, high) / bins);
        let from = (low / width).floor() * width;
        let bin = |v: f64| ((v - from) / width + 1e-9).floor().max(0.0) as usize;
        let mut counts = vec![0; bin(high) + 1];
        for &v in &finite {
            counts[bin(v)] += 1;
        }
        Self { from, width, counts, left_out, beyond: 0, is_log: false }
    }

    /// Bins up to the 99.5th percentile where the rest lies far out; how many lie beyond is counted.
    pub(super) fn clipped(values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let shown = ((SHOWN * sorted.len() as f64).ceil() as usize).min(sorted.len());
        let (Some(&last), Some(&most)) =
            (shown.checked_sub(1).and_then(|k| sorted.get(k)), sorted.last())
        else {
            return Self::of(values);
        };
        if last <= 0.0 || most < FAR * last {
            return Self::of(values);
        }
        let beyond = sorted.iter().filter(|v| **v > last).count();
        let shown: Vec<f64> = values.iter().copied().filter(|v| *v <= last).collect();
        let left_out = values.iter().filter(|v| !v.is_finite()).count();
        Self { left_out, beyond, ..Self::of(&shown) }
    }

    /// Bins of equal ratio over the values above 0, from the half per cent on; the few smaller ones count in the first.
    pub(super) fn of_ratios(values: &[f64]) -> Self {
        let mut logs: Vec<f64> =
            values.iter().filter(|v| v.is_finite() && **v > 0.0).map(|v| math::log10(*v)).collect();
        logs.sort_by(f64::total_cmp);
        let least = logs.get(((1.0 - SHOWN) * logs.len() as f64) as usize).copied();
        let raised: Vec<f64> = logs.iter().map(|&v| v.max(least.unwrap_or(v))).collect();
        let left_out = values.len() - logs.len();
        Self { left_out, is_log: true, ..Self::of(&raised) }
    }

    /// Upper end of the last bin.
    pub(super) fn to(&self) -> f64 {
        self.from + self.width * self.counts.len() as f64
    }

    /// The fullest bin.
    pub(super) fn largest(&self) -> usize {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// An axis on which all bins and some paper around them fit.
    pub(super) fn axis(&self, title: &str) -> Axis {
        let (from, to) = (self.from, self.to().max(self.from + self.width));
        if self.is_log {
            return Axis::ratios(math::pow(10.0, from + 1e-6), math::pow(10.0, to - 1e-6), title);
        }
        // a few bins do not fill the frame
        let missing = (LEAST_BINS - (to - from) / self.width).max(0.0);
        let margin = 0.5 * missing * self.width + 0.02 * (to - from);
        // where all values are positive there is nothing below 0
        let low = if from >= 0.0 { (from - margin).max(0.0) } else { from - margin };
        Axis::linear(low, to + margin, title)
    }

    /// The bars, as shares of `total` in per cent.
    pub(super) fn bars(&self, canvas: &Canvas<'_>, panel: &Panel, total: usize) {
        for (i, &count) in self.counts.iter().enumerate() {
            let ends = [i, i + 1].map(|k| self.from + k as f64 * self.width);
            let [from, to] = if self.is_log { ends.map(|end| math::pow(10.0, end)) } else { ends };
            panel.bar(canvas, (from, to), percent_of(count, total), SKY);
        }
    }
}

/// A share in per cent; 0 of nothing.
pub(super) fn percent_of(count: usize, total: usize) -> f64 {
    100.0 * count as f64 / total.max(1) as f64
}

fn range(values: &[f64]) -> Option<(f64, f64)> {
    let low = values.iter().copied().reduce(f64::min)?;
    let high = values.iter().copied().reduce(f64::max)?;
    Some((low, high))
}

/// Extent of the values, or a tenth of their size when they are all the same (to rounding).
fn spread(low: f64, high: f64) -> f64 {
    let size = low.abs().max(high.abs());
    if high - low > 1e-9 * size && high > low {
        high - low
    } else if size > 0.0 {
        0.1 * size
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_in_one_bin() {
        let cases: [&[f64]; 6] = [
            &[],
            &[0.0],
            &[7.3; 50],
            &[0.0, 0.1, 0.2, 0.3, 0.7, 1e9],
            &[-5.0, 5.0, f64::NAN, f64::INFINITY],
            &[2_600_000.0, 2_600_000.1],
        ];
        for values in cases {
            let bins = EqualBins::of(values);
            let counted: usize = bins.counts.iter().sum();
            assert_eq!(counted + bins.left_out, values.len(), "{values:?}");
            for bins in [EqualBins::clipped(values), EqualBins::of_ratios(values)] {
                let counted: usize = bins.counts.iter().sum();
                assert_eq!(counted + bins.left_out + bins.beyond, values.len(), "{values:?}");
            }
            assert!(bins.counts.len() < 200, "{} bins for {values:?}", bins.counts.len());
            assert!(bins.width > 0.0 && bins.from.is_finite());
        }
    }

    /// 0.3 / 0.1 is just below 3 in floating point; a value on a boundary still counts in the upper bin.
    #[test]
    fn a_value_on_a_boundary_counts_above_it() {
        let values: Vec<f64> = (0..80).map(|i| f64::from(i) * 0.1).collect();
        let bins = EqualBins::of(&values);
        assert!(bins.counts.iter().all(|&c| c == bins.counts[0]), "{bins:?}");
    }
}

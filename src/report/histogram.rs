//! Weighing values in bins of round width, for display only.

use super::axis::{Axis, nice_step};
use super::canvas::Canvas;
use super::colour::SKY;
use super::panel::Panel;
use crate::math;

/// Most and least number of bins over the range of the values.
const MOST_BINS: f64 = 40.0;
const LEAST_BINS: f64 = 8.0;

/// What values weigh in bins of equal width; all the same where they are counted.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct EqualBins {
    /// Lower end of the first bin, a multiple of the width.
    pub(super) from: f64,
    /// Width of a bin.
    pub(super) width: f64,
    /// What the values in each bin weigh; a value on a boundary counts in the upper one.
    weights: Vec<f64>,
    /// What all weigh of which the bars are shares.
    pub(super) all: f64,
    /// Number of values that are not finite and in no bin.
    pub(super) left_out: usize,
    /// Number of values beyond the last bin.
    pub(super) beyond: usize,
    /// Whether `from` and `width` are powers of ten.
    is_log: bool,
}

/// Share of all weight that a clipped histogram shows.
const SHOWN: f64 = 0.995;
/// A histogram is clipped where the largest value lies farther out than this many times what is shown.
const FAR: f64 = 1.3;

impl EqualBins {
    /// Bins of round width, about √n of them, of values with what each weighs.
    pub(super) fn of(values: &[(f64, f64)]) -> Self {
        let finite = finite(values);
        let bins = (finite.len() as f64).sqrt().clamp(LEAST_BINS, MOST_BINS);
        let width = range(&finite).map_or(1.0, |(low, high)| nice_step(spread(low, high) / bins));
        Self::of_width(values, width)
    }

    fn of_width(values: &[(f64, f64)], width: f64) -> Self {
        let finite = finite(values);
        let none = Self {
            from: 0.0,
            width: 1.0,
            weights: Vec::new(),
            all: weight(values),
            left_out: values.len() - finite.len(),
            beyond: 0,
            is_log: false,
        };
        let Some((low, high)) = range(&finite) else { return none };
        let from = (low / width).floor() * width;
        let bin = |v: f64| ((v - from) / width + 1e-9).floor().max(0.0) as usize;
        let mut weights = vec![0.0; bin(high) + 1];
        for &(v, weight) in &finite {
            weights[bin(v)] += weight;
        }
        Self { from, width, weights, ..none }
    }

    /// The same on an axis so much wider that bars of this width (`least`) are just seen: not narrower in all than that.
    pub(super) fn seen(self, values: &[(f64, f64)], least: f64) -> Self {
        let whole = self.width * self.weights.len() as f64;
        if self.is_empty() || whole >= least { self } else { Self::of_width(values, least) }
    }

    /// The same of counts: no bin is narrower than one of them.
    pub(super) fn whole(self, values: &[(f64, f64)]) -> Self {
        let Self { beyond, left_out, all, .. } = self;
        let last = self.to();
        if self.is_empty() || self.width >= 1.0 {
            return self;
        }
        let shown: Vec<(f64, f64)> = values.iter().copied().filter(|(v, _)| *v < last).collect();
        Self { all, left_out, beyond, ..Self::of_width(&shown, 1.0) }
    }

    /// Bins up to the 99.5th percentile where the rest lies far out; how many lie beyond is counted.
    pub(super) fn clipped(values: &[(f64, f64)]) -> Self {
        let finite = finite(values);
        let (Some(last), Some((_, most))) = (at_share(&finite, SHOWN), range(&finite)) else {
            return Self::of(values);
        };
        if last <= 0.0 || most < FAR * last {
            return Self::of(values);
        }
        let (shown, beyond): (Vec<_>, Vec<_>) = finite.iter().partition(|(v, _)| *v <= last);
        let left_out = values.len() - finite.len();
        Self { all: weight(values), left_out, beyond: beyond.len(), ..Self::of(&shown) }
    }

    /// Bins of equal ratio over the values above 0, from the half per cent on; the few smaller ones count in the first.
    pub(super) fn of_ratios(values: &[(f64, f64)]) -> Self {
        let positive = values.iter().filter(|(v, _)| v.is_finite() && *v > 0.0);
        let mut logs: Vec<(f64, f64)> =
            positive.map(|(v, weight)| (math::log10(*v), *weight)).collect();
        let left_out = values.len() - logs.len();
        let least = at_share(&logs, 1.0 - SHOWN);
        for (v, _) in &mut logs {
            *v = v.max(least.unwrap_or(*v));
        }
        Self { all: weight(values), left_out, is_log: true, ..Self::of(&logs) }
    }

    /// Upper end of the last bin.
    pub(super) fn to(&self) -> f64 {
        self.from + self.width * self.weights.len() as f64
    }

    /// Whether no value is in a bin.
    pub(super) fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }

    /// The tallest bar (per cent).
    pub(super) fn tallest(&self) -> f64 {
        self.percents().fold(0.0, f64::max)
    }

    /// The bars (per cent), from left to right; 0 where nothing weighs anything.
    fn percents(&self) -> impl Iterator<Item = f64> {
        let all = if self.all > 0.0 { self.all } else { 1.0 };
        self.weights.iter().map(move |weight| 100.0 * weight / all)
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

    /// Draws the bars.
    pub(super) fn bars(&self, canvas: &Canvas<'_>, panel: &Panel) {
        for (i, percent) in self.percents().enumerate() {
            let ends = [i, i + 1].map(|k| self.from + k as f64 * self.width);
            let [from, to] = if self.is_log { ends.map(|end| math::pow(10.0, end)) } else { ends };
            panel.bar(canvas, (from, to), percent, SKY);
        }
    }
}

fn finite(values: &[(f64, f64)]) -> Vec<(f64, f64)> {
    values.iter().copied().filter(|(v, _)| v.is_finite()).collect()
}

fn weight(values: &[(f64, f64)]) -> f64 {
    values.iter().map(|(_, weight)| weight).sum()
}

/// The smallest value that at least a share of all weight does not exceed; none of nothing.
fn at_share(values: &[(f64, f64)], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
    let (all, mut below) = (weight(&sorted), 0.0);
    let at = sorted.iter().find(|(_, weight)| {
        below += weight;
        below >= share * all
    });
    at.or(sorted.last()).map(|(v, _)| *v)
}

fn range(values: &[(f64, f64)]) -> Option<(f64, f64)> {
    let values = || values.iter().map(|(v, _)| *v);
    Some((values().reduce(f64::min)?, values().reduce(f64::max)?))
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

    fn alike(values: &[f64]) -> Vec<(f64, f64)> {
        values.iter().map(|v| (*v, 1.0)).collect()
    }

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
            let values = alike(values);
            for bins in
                [EqualBins::of(&values), EqualBins::clipped(&values), EqualBins::of_ratios(&values)]
            {
                let counted = bins.weights.iter().sum::<f64>() as usize;
                assert_eq!(counted + bins.left_out + bins.beyond, values.len(), "{values:?}");
                assert!(bins.weights.len() < 200, "{} for {values:?}", bins.weights.len());
                assert!(bins.width > 0.0 && bins.from.is_finite());
                assert!((bins.all - values.len() as f64).abs() < 1e-12);
            }
        }
    }

    /// Counts of 5 alone, or of 4 to 6, had bars and ticks of tenths.
    #[test]
    fn counts_have_bins_of_whole_numbers() {
        for counts in [&[5.0; 30][..], &[4.0, 5.0, 5.0, 6.0]] {
            let values = alike(counts);
            let bins = EqualBins::clipped(&values).whole(&values);
            assert!((bins.width - 1.0).abs() < 1e-12 && bins.from.fract() == 0.0, "{bins:?}");
            assert_eq!(bins.weights.iter().sum::<f64>() as usize, counts.len());
            let ticks = bins.axis("").ticks(6);
            assert!(ticks.iter().all(|tick| tick.value.fract() == 0.0), "{ticks:?}");
        }
    }

    /// A rock that stands for three is as tall as three, and the few heavy ones are not the rest that is clipped.
    #[test]
    fn a_bar_is_as_tall_as_what_its_rocks_stand_for() {
        let mut values = vec![(0.5, 1.0); 60];
        values.extend(vec![(9.5, 3.0); 20]);
        for bins in [EqualBins::of(&values), EqualBins::clipped(&values)] {
            let bars: Vec<f64> = bins.percents().filter(|bar| *bar > 0.0).collect();
            assert!((bars[0] - 50.0).abs() < 1e-12 && (bars[1] - 50.0).abs() < 1e-12, "{bars:?}");
        }
        // a tenth of the rocks, a thousandth of what all stand for
        values.extend(vec![(100.0, 0.015); 8]);
        assert_eq!(EqualBins::clipped(&values).beyond, 8);
        let counted: Vec<f64> = values.iter().map(|(v, _)| *v).collect();
        assert_eq!(EqualBins::clipped(&alike(&counted)).beyond, 0);
    }

    /// 0.3 / 0.1 is just below 3 in floating point; a value on a boundary still counts in the upper bin.
    #[test]
    fn a_value_on_a_boundary_counts_above_it() {
        let values: Vec<f64> = (0..80).map(|i| f64::from(i) * 0.1).collect();
        let bins = EqualBins::of(&alike(&values));
        let first = bins.weights[0];
        assert!(bins.weights.iter().all(|weight| (weight - first).abs() < 1e-12), "{bins:?}");
    }
}

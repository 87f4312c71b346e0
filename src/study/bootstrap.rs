//! Statistics of the same rocks under several settings: how far chance moves them, alone and against each other.

use super::weighing::Weighing;
use crate::math;
use crate::random::{Purpose, stream, unit};
use std::collections::BTreeMap;

/// Times that the rocks are drawn again: the ends of a 95 % interval are then known to a tenth of its width.
const DRAWS: usize = 400;

/// An estimate with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether 0 lies outside.
    pub fn is_certain(&self) -> bool {
        self.low > 0.0 || self.high < 0.0
    }

    /// The largest distance from 0 that it holds.
    pub fn at_most(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }
}

/// A percentile under every setting of a ladder, and what is left at the fine end.
#[derive(Debug, Clone, PartialEq)]
pub struct PercentileLadder {
    /// The percentile under each setting.
    pub values: Vec<f64>,
    /// Where the values go.
    pub limit: Interval,
    /// How far the line through all settings stands at the scene's own setting from its limit.
    pub own_error: Interval,
}

/// Values of the same rocks under several settings. A rock that failed under one of them counts under none; a rock that
/// has no value under one, because it never came there, counts under the others.
#[derive(Debug)]
pub struct Paired {
    /// Rocks in rising order of their values, setting by setting.
    order: Vec<Vec<u32>>,
    values: Vec<Vec<f64>>,
    /// What each rock stands for.
    weights: Vec<f64>,
    /// Rocks stratum by stratum: each stratum keeps its number when rocks are drawn again.
    strata: Vec<Vec<u32>>,
}

impl Paired {
    /// One vector a setting, the same rocks in the same order; NaN where a rock failed, −∞ where it has no value.
    pub fn new(values: &[Vec<f64>]) -> Self {
        Self::weighing(values, &Weighing::equal(values.first().map_or(0, Vec::len)))
    }

    /// The same of rocks that do not all weigh the same.
    pub fn weighing(values: &[Vec<f64>], Weighing(rocks): &Weighing) -> Self {
        let count = values.first().map_or(0, Vec::len);
        let is_whole = |rock: &usize| values.iter().all(|setting| !setting[*rock].is_nan());
        let whole: Vec<usize> = (0..count).filter(is_whole).collect();
        let values: Vec<Vec<f64>> =
            values.iter().map(|all| whole.iter().map(|&rock| all[rock]).collect()).collect();
        let sorted = |all: &Vec<f64>| {
            let has_value = |rock: &u32| all[*rock as usize].is_finite();
            let mut order: Vec<u32> = (0..all.len() as u32).filter(has_value).collect();
            order.sort_by(|&a, &b| all[a as usize].total_cmp(&all[b as usize]));
            order
        };
        let mut strata: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (k, &rock) in whole.iter().enumerate() {
            strata.entry(rocks[rock].0).or_default().push(k as u32);
        }
        Self {
            order: values.iter().map(sorted).collect(),
            weights: whole.iter().map(|&rock| rocks[rock].1).collect(),
            strata: strata.into_values().collect(),
            values,
        }
    }

    /// How often each rock counts when the rocks of each stratum are drawn again with replacement.
    fn redrawn(&self, seed: u64, draw: usize) -> Vec<u16> {
        let mut chance = stream(seed, Purpose::Redraw, draw);
        let mut times = vec![0u16; self.weights.len()];
        for stratum in &self.strata {
            for _ in stratum {
                let rock = stratum[(unit(&mut chance) * stratum.len() as f64) as usize];
                times[rock as usize] += 1;
            }
        }
        times
    }

    /// Percentile `p` (0..1) under every setting, of rocks that count so many times each.
    fn percentiles(&self, p: f64, times: &[u16]) -> Vec<f64> {
        let one = |(order, values): (&Vec<u32>, &Vec<f64>)| {
            let weight = |rock: u32| f64::from(times[rock as usize]) * self.weights[rock as usize];
            let wanted = p * order.iter().map(|&rock| weight(rock)).sum::<f64>();
            let mut passed = 0.0;
            let found = order.iter().find(|&&rock| {
                passed += weight(rock);
                passed >= wanted
            });
            found.map_or(f64::NAN, |&rock| values[rock as usize])
        };
        self.order.iter().zip(&self.values).map(one).collect()
    }

    /// Fits `value = limit + c xᵏ` to percentile `p`, where `x` is the fineness of each setting over the scene's own
    /// and `k` the order; the interval is that of the whole fit when the rocks are drawn again with replacement.
    ///
    /// All settings keep the same rocks in every draw: what chance does to all of them alike drops out.
    pub fn ladder(&self, p: f64, relative: &[f64], order: f64, seed: u64) -> PercentileLadder {
        let x: Vec<f64> = relative.iter().map(|fine| math::pow(*fine, order)).collect();
        let values = self.percentiles(p, &vec![1; self.weights.len()]);
        let (limit, slope) = fit(&x, &values);
        let mut draws = [Vec::with_capacity(DRAWS), Vec::with_capacity(DRAWS)];
        for draw in 0..DRAWS {
            let (limit, slope) = fit(&x, &self.percentiles(p, &self.redrawn(seed, draw)));
            draws[0].push(limit);
            draws[1].push(slope);
        }
        let [limits, slopes] = draws;
        PercentileLadder {
            values,
            limit: interval(limit, limits),
            own_error: interval(slope, slopes),
        }
    }

    /// Percentile `p` under setting `to` minus that under setting 0.
    pub fn shift(&self, p: f64, to: usize, seed: u64) -> Interval {
        let difference = |times: &[u16]| {
            let found = self.percentiles(p, times);
            found[to] - found[0]
        };
        let draws = (0..DRAWS).map(|draw| difference(&self.redrawn(seed, draw)));
        interval(difference(&vec![1; self.weights.len()]), draws.collect())
    }
}

/// Least squares line: value at 0 and slope.
fn fit(x: &[f64], y: &[f64]) -> (f64, f64) {
    let n = x.len() as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let (mut xx, mut xy) = (0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        xx += (x - mx).powi(2);
        xy += (x - mx) * (y - my);
    }
    let slope = if xx > 0.0 { xy / xx } else { 0.0 };
    (my - slope * mx, slope)
}

/// The middle 95 % of the draws.
fn interval(value: f64, mut draws: Vec<f64>) -> Interval {
    draws.sort_by(f64::total_cmp);
    let at =
        |share: f64| draws.get((share * draws.len() as f64) as usize).copied().unwrap_or(value);
    Interval { value, low: at(0.025), high: at(0.975) }
}

#[cfg(test)]
mod tests {
    use super::super::statistic::NEVER;
    use super::*;

    /// Values that follow the law exactly give it back, with no spread: every rock moves alike. To rounding.
    #[test]
    fn a_law_without_chance_is_found() {
        let x = [4.0, 1.0, 0.25];
        let all: Vec<Vec<f64>> = x.map(|x| (0..500).map(|_| 10.0 + 0.5 * x).collect()).into();
        let found = Paired::new(&all).ladder(0.5, &x, 1.0, 1);
        assert!((found.limit.value - 10.0).abs() < 1e-12);
        assert!((found.own_error.value - 0.5).abs() < 1e-12);
        assert!((found.own_error.high - found.own_error.low).abs() < 1e-12);
    }

    /// Rocks spread evenly over 0..1, the same under both settings but moved by 0.25: the shift is certain although it is
    /// what chance moves each percentile of 100 rocks by (±0.1).
    #[test]
    fn what_moves_both_settings_alike_drops_out() {
        let rock = |k: usize| (k as f64 * 0.618_034).fract();
        let all = [(0..100).map(rock).collect(), (0..100).map(|k| rock(k) + 0.25).collect()];
        let shift = Paired::new(&all).shift(0.5, 1, 7);
        assert!((shift.value - 0.25).abs() < 1e-12 && shift.is_certain());
        assert!(shift.high - shift.low < 1e-12);
    }

    /// A rock that never came there under one setting still counts under the other.
    #[test]
    fn rocks_without_a_value_count_elsewhere() {
        let all = [vec![1.0, NEVER, 3.0], vec![1.0, 9.0, 3.0]];
        let found = Paired::new(&all).percentiles(0.99, &[1, 1, 1]);
        assert!((found[0] - 3.0).abs() < 1e-12 && (found[1] - 9.0).abs() < 1e-12, "{found:?}");
    }

    /// Nine light rocks of value 1 to 9 and one heavy rock of value 20: the median of all weight is the heavy rock's, by hand;
    /// drawn again stratum by stratum it is always there, so that nothing moves. With equal weights the median is 5.
    #[test]
    fn heavy_rocks_count_for_more() {
        let values: Vec<f64> = (1..=9).map(f64::from).chain([20.0]).collect();
        let all = [values.clone(), values.iter().map(|value| value + 1.0).collect()];
        let rocks = (0..10).map(|k| (u32::from(k == 9), if k == 9 { 30.0 } else { 1.0 }));
        let heavy = Paired::weighing(&all, &Weighing(rocks.collect()));
        assert!((heavy.percentiles(0.5, &[1; 10])[0] - 20.0).abs() < 1e-12);
        let ladder = heavy.ladder(0.5, &[1.0, 2.0], 1.0, 3);
        assert!(
            (ladder.limit.low - 19.0).abs() < 1e-12 && (ladder.limit.high - 19.0).abs() < 1e-12
        );
        assert!((Paired::new(&all).percentiles(0.5, &[1; 10])[0] - 5.0).abs() < 1e-12);
    }

    /// A rock that failed once is left out everywhere.
    #[test]
    fn failed_rocks_count_nowhere() {
        let all = [vec![1.0, f64::NAN, 3.0], vec![1.0, 9.0, 3.0]];
        assert!(Paired::new(&all).shift(0.99, 1, 1).value.abs() < f64::EPSILON);
    }
}

//! Statistics of the same rocks under several settings: how far chance moves them, alone and against each other.

use super::weighing::Weighing;
use crate::math;
use crate::random::{Purpose, one_of, stream};
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

    /// The smallest distance from 0 that it holds.
    pub fn at_least(&self) -> f64 {
        if self.is_certain() { self.low.abs().min(self.high.abs()) } else { 0.0 }
    }

    /// The same estimate, with what `other` holds besides.
    #[must_use]
    pub fn holding(self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high), ..self }
    }

    /// So many times it (–, 0 or more).
    #[must_use]
    pub fn times(self, times: f64) -> Self {
        Self { value: self.value * times, low: self.low * times, high: self.high * times }
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
                let rock = stratum[one_of(&mut chance, stratum.len())];
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
    /// All settings keep the same rocks in every draw: what chance does to all of them alike drops out. Where the line misses by more than chance, as
    /// where nothing is chaotic, intervals hold what the finest settings say as well.
    pub fn ladder(&self, p: f64, relative: &[f64], order: f64, seed: u64) -> PercentileLadder {
        let x: Vec<f64> = relative.iter().map(|fine| math::pow(*fine, order)).collect();
        let values = self.percentiles(p, &vec![1; self.weights.len()]);
        let reading = LadderReading::of(&x, &values);
        let draws: Vec<LadderReading> = (0..DRAWS)
            .map(|draw| LadderReading::of(&x, &self.percentiles(p, &self.redrawn(seed, draw))))
            .collect();
        let told = |of: &dyn Fn(&LadderReading) -> f64| {
            interval(of(&reading), draws.iter().map(of).collect())
        };
        let (mut limit, mut own_error) = (told(&|r| r.limit), told(&|r| r.own_error));
        if told(&|r| r.own_error - r.own_of_finest).is_certain() {
            let finest = [told(&|r| r.own_of_finest), told(&|r| r.own_less_finest)];
            own_error = finest.iter().fold(own_error, Interval::holding);
            limit = limit.holding(&told(&|r| r.limit_of_finest));
        }
        PercentileLadder { values, limit, own_error }
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

/// What one ladder of values says of its limit and of the error of the scene's own setting.
#[derive(Debug, Clone, Copy)]
struct LadderReading {
    /// By the line through all settings.
    limit: f64,
    own_error: f64,
    /// By the line through the two finest.
    limit_of_finest: f64,
    own_of_finest: f64,
    /// Against the finest value itself, by the same line where the own setting is the finest.
    own_less_finest: f64,
}

impl LadderReading {
    /// Of values over `x`, from coarse to fine, that is 1 at the scene's own setting.
    fn of(x: &[f64], values: &[f64]) -> Self {
        let own = x.iter().position(|x| (x - 1.0).abs() < 1e-9).unwrap_or(0);
        let finest = x.len().saturating_sub(2);
        let (limit, own_error) = fit(x, values);
        let (limit_of_finest, _) = fit(&x[finest..], &values[finest..]);
        let own_of_finest = values[own] - limit_of_finest;
        let own_is_finest = own + 1 == x.len();
        let own_less_finest =
            if own_is_finest { own_of_finest } else { values[own] - values[x.len() - 1] };
        Self { limit, own_error, limit_of_finest, own_of_finest, own_less_finest }
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

    /// Values without chance that fall faster than the law assumed: the line misses the truth, and its interval was none. Now it holds the truth, whether
    /// the own setting is the coarsest or in the middle.
    #[test]
    fn a_law_of_higher_order_is_held() {
        for relative in [[1.0, 0.25, 0.0625], [2.0, 1.0, 0.5]] {
            for order in [1.0, 1.5, 2.0] {
                let rocks = |x: f64| (0..300).map(|_| 10.0 + 0.5 * x.powf(order)).collect();
                let all: Vec<Vec<f64>> = relative.map(rocks).into();
                let found = Paired::new(&all).ladder(0.5, &relative, 1.0, 1).own_error;
                let is_held = found.low < 0.5 + 1e-12 && found.high > 0.5 - 1e-12;
                assert!(is_held, "{relative:?} {order}: {found:?}");
            }
        }
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

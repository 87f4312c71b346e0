//! Differences between the statistics of two runs, with their intervals.
//!
//! Two runs of one seed release the same rocks from the same places: what chance does to one it does to the other, and
//! the difference is known better than either. A mean is taken with the pull of each release on it (its influence
//! over the number of rocks); the variance of a difference is the sum of the squared differences of the pulls where releases
//! pair, and the sum of both sums of squares where they do not.
//!
//! A percentile has no such pulls where few releases differ between the runs or values cluster: see [`percentile`]. Shares are
//! adjusted as in Bonett and Price (2012, J. Educ. Behav. Stat. 37, 479–488) for pairs and in Agresti and Caffo
//! (2000, Am. Stat. 54, 280–288) without: their intervals stay sound where hardly any rock counts.

mod percentile;
mod weighted;

pub use weighted::WeightedCount;

use super::proportion::NORMAL_95;
use super::sample::Sample;
use percentile::Places;
use std::cmp::Ordering;

/// Over the values, a difference of so much is rounding (–).
const NO_DIFFERENCE: f64 = 1e-12;

/// A value of each release that has one, by rising release number.
pub type Values = Vec<(usize, f64)>;

/// A statistic of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The statistic.
    pub value: f64,
    /// Rocks that it is of.
    pub rocks: usize,
    /// What chance may do to it; none where there are too few rocks to say.
    chance: Option<Chance>,
}

/// What chance may do to a statistic of a run.
#[derive(Debug, Clone, PartialEq)]
enum Chance {
    /// To a mean: how much each release moved it.
    Pulls(Values),
    /// To a percentile: where it may lie.
    Places(Places),
}

/// What changes from one run to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The statistic of the first run.
    pub a: f64,
    /// The statistic of the second run.
    pub b: f64,
    /// `b − a`.
    pub value: f64,
    /// Ends of the two-sided 95 % interval of `b − a`; none where there are too few rocks.
    pub interval: Option<(f64, f64)>,
}

impl Reading {
    /// The mean of the finite ones; none of nothing.
    pub fn mean(values: &[(usize, f64)]) -> Option<Self> {
        let values = finite(values);
        let n = values.len() as f64;
        let value = values.iter().map(|(_, x)| x).sum::<f64>() / n;
        let scale = (n / (n - 1.0)).sqrt() / n;
        let pull = |(release, x): &(usize, f64)| (*release, (x - value) * scale);
        let chance = (values.len() > 1).then(|| Chance::Pulls(values.iter().map(pull).collect()));
        (!values.is_empty()).then_some(Self { value, rocks: values.len(), chance })
    }

    /// Percentile `p` (0 < p < 1) of the finite ones; none of nothing.
    pub fn percentile(values: &[(usize, f64)], p: f64) -> Option<Self> {
        let weighed = finite(values).into_iter().map(|(release, x)| (release, x, 1.0));
        Self::of_percentile(weighed.collect(), p)
    }

    /// The same of release, value and weight.
    fn of_percentile(weighed: Vec<(usize, f64, f64)>, p: f64) -> Option<Self> {
        let value = sample(&weighed).percentile(p)?.value;
        let rocks = weighed.len();
        Some(Self { value, rocks, chance: Places::of(weighed, p).map(Chance::Places) })
    }

    /// The same times a number: a unit, a factor.
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        self.value *= factor;
        match &mut self.chance {
            Some(Chance::Pulls(pulls)) => pulls.iter_mut().for_each(|(_, pull)| *pull *= factor),
            Some(Chance::Places(places)) => places.scale(factor),
            None => {}
        }
        self
    }
}

fn finite(values: &[(usize, f64)]) -> Values {
    values.iter().copied().filter(|(_, x)| x.is_finite()).collect()
}

/// Of release, value and weight.
fn sample(weighed: &[(usize, f64, f64)]) -> Sample {
    Sample::weighted(weighed.iter().map(|&(_, x, weight)| (x, weight)))
}

impl Chance {
    /// Ends of the 95 % interval of the difference `value` from one statistic to another of its kind.
    fn apart(&self, other: &Self, (value, paired): (f64, bool)) -> Option<(f64, f64)> {
        match (self, other) {
            (Self::Pulls(one), Self::Pulls(other)) => {
                let half = NORMAL_95 * variance(one, other, paired).sqrt();
                Some((value - half, value + half))
            }
            (Self::Places(one), Self::Places(other)) => {
                let (low, high) = one.apart(other, paired);
                // interpolated, the difference itself is between values
                Some((low.min(value), high.max(value)))
            }
            _ => None,
        }
    }
}

impl Difference {
    /// From one statistic to the other; `paired` where the same release numbers are the same rocks.
    pub fn between(a: &Reading, b: &Reading, paired: bool) -> Self {
        let value = b.value - a.value;
        let both = a.chance.as_ref().zip(b.chance.as_ref());
        let interval = both.and_then(|(one, other)| one.apart(other, (value, paired)));
        Self { a: a.value, b: b.value, value, interval }
    }

    /// Between two shares; `a` and `b` name the releases that count, of so many each, by rising number.
    ///
    /// Where releases pair, both must be of the same ones.
    pub fn of_shares(a: (&[usize], usize), b: (&[usize], usize), paired: bool) -> Self {
        let share = |(of, all): (&[usize], usize)| of.len() as f64 / all.max(1) as f64;
        let (one, other) = (share(a), share(b));
        let (middle, variance) = if paired {
            let both = in_both(a.0, b.0);
            let n = a.1 as f64 + 2.0;
            let [lost, won] = [a.0, b.0].map(|of| ((of.len() - both) as f64 + 1.0) / n);
            (won - lost, (won + lost - (won - lost).powi(2)) / n)
        } else {
            let adjusted = |(of, all): (&[usize], usize)| {
                let n = all as f64 + 2.0;
                let p = (of.len() as f64 + 1.0) / n;
                (p, p * (1.0 - p) / n)
            };
            let ((p, var_p), (q, var_q)) = (adjusted(a), adjusted(b));
            (q - p, var_p + var_q)
        };
        let half = NORMAL_95 * variance.sqrt();
        let interval = (a.1 > 0 && b.1 > 0)
            .then(|| ((middle - half).clamp(-1.0, 1.0), (middle + half).clamp(-1.0, 1.0)));
        Self { a: one, b: other, value: other - one, interval }
    }

    /// The same where both runs are one and the same: nothing is left to chance.
    #[must_use]
    pub fn of_one_run(self) -> Self {
        Self { interval: Some((self.value, self.value)), ..self }
    }

    /// The same, where what differs by no more than the rounding of sums does not differ: other sums of the same numbers do so too.
    #[must_use]
    pub fn without_rounding(self) -> Self {
        let least = NO_DIFFERENCE * self.a.abs().max(self.b.abs());
        let told = |x: f64| if x.abs() <= least { 0.0 } else { x };
        let interval = self.interval.map(|(low, high)| (told(low), told(high)));
        Self { value: told(self.value), interval, ..self }
    }

    /// Whether nothing differs, for certain.
    pub fn is_none(&self) -> bool {
        self.interval == Some((0.0, 0.0))
    }

    /// Whether the interval leaves out zero.
    pub fn is_clear(&self) -> bool {
        self.interval.is_some_and(|(low, high)| low > 0.0 || high < 0.0)
    }
}

/// Variance of a difference from the pulls on both statistics.
fn variance(one: &Values, other: &Values, paired: bool) -> f64 {
    let squares = |pulls: &Values| pulls.iter().map(|(_, pull)| pull * pull).sum::<f64>();
    if paired { apart(one, other) } else { squares(one) + squares(other) }
}

/// Sum of the squared differences of pulls; a release that one run lacks pulls there with nothing.
fn apart(one: &Values, other: &Values) -> f64 {
    let (mut i, mut k, mut sum) = (0, 0, 0.0);
    while i < one.len() || k < other.len() {
        let order = match (one.get(i), other.get(k)) {
            (Some(a), Some(b)) => a.0.cmp(&b.0),
            (Some(_), None) => Ordering::Less,
            _ => Ordering::Greater,
        };
        let mut pull = 0.0;
        if order != Ordering::Greater {
            pull += one[i].1;
            i += 1;
        }
        if order != Ordering::Less {
            pull -= other[k].1;
            k += 1;
        }
        sum += pull * pull;
    }
    sum
}

/// How many numbers two rising lists share.
fn in_both(one: &[usize], other: &[usize]) -> usize {
    one.iter().filter(|release| other.binary_search(release).is_ok()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: pairs that differ by 1 always have no spread of the difference; without pairing it has.
    #[test]
    fn what_moves_both_alike_does_not_count_where_releases_pair() {
        let a: Values = (0..50).map(|k| (k, (k * k % 17) as f64)).collect();
        let b: Values = a.iter().map(|(k, x)| (*k, x + 1.0)).collect();
        let read = |values: &Values| Reading::mean(values).unwrap();
        let paired = Difference::between(&read(&a), &read(&b), true);
        let (low, high) = paired.interval.unwrap();
        assert!((low - 1.0).abs() < 1e-12 && (high - 1.0).abs() < 1e-12 && paired.is_clear());
        let apart = Difference::between(&read(&a), &read(&b), false);
        let (low, high) = apart.interval.unwrap();
        assert!(high - low > 1.0, "{low} {high}");
    }

    /// By hand: 3 of 10 count in both, 1 only in the first, 2 only in the second.
    #[test]
    fn shares_are_adjusted_by_one_each_way() {
        let found = Difference::of_shares((&[0, 1, 2, 3], 10), (&[1, 2, 3, 7, 8], 10), true);
        assert!((found.value - 0.1).abs() < 1e-15);
        let (lost, won) = (2.0 / 12.0, 3.0 / 12.0);
        let half = NORMAL_95 * ((won + lost - (won - lost) * (won - lost)) / 12.0_f64).sqrt();
        let (low, high) = found.interval.unwrap();
        assert!(
            (low - (won - lost - half)).abs() < 1e-12 && (high - (won - lost + half)).abs() < 1e-12
        );
    }

    /// The sums of one run in another order: 1e-14 of the value is no difference, 1e-9 of it is one.
    #[test]
    fn rounding_is_no_difference() {
        let one = |value: f64| Difference {
            a: 3e5,
            b: 3e5 + value,
            value,
            interval: Some((value, value)),
        };
        assert!(one(3e-9).is_clear());
        let none = one(3e-9).without_rounding();
        assert_eq!((none.value, none.interval, none.is_clear()), (0.0, Some((0.0, 0.0)), false));
        assert_eq!(one(3e-4).without_rounding(), one(3e-4));
    }

    /// None of 100 in either: the rule of three's size, not zero.
    #[test]
    fn nothing_seen_is_not_nothing_known() {
        let found = Difference::of_shares((&[], 100), (&[], 100), true);
        let (low, high) = found.interval.unwrap();
        assert!(low < -0.02 && high > 0.02 && high < 0.04 && !found.is_clear());
    }

    #[test]
    fn too_few_rocks_give_no_interval() {
        let few: Values = (0..20).map(|k| (k, k as f64)).collect();
        let p99 = Reading::percentile(&few, 0.99).unwrap();
        assert_eq!(Difference::between(&p99, &p99, true).interval, None);
        assert!(
            Reading::mean(&[]).is_none() && Reading::percentile(&[(0, f64::NAN)], 0.5).is_none()
        );
    }
}

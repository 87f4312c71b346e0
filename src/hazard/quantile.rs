//! Percentiles with distribution-free confidence intervals.
//!
//! How many of `n` rocks stay below the true percentile `q_p` is binomial(n, p), whatever the distribution
//! of the values. So the `l`-th and `u`-th smallest value enclose `q_p` with probability `P(l ≤ B < u)`
//! (Conover, Practical Nonparametric Statistics, section 3.2). The probabilities are summed, not approximated.

use super::proportion::NORMAL_95;
use crate::math;
use serde::{Deserialize, Serialize};

/// Chance that an interval misses on one side: half of 1 − 95 %.
const ONE_TAIL: f64 = 0.025;
/// Chance that a one-sided bound misses: 1 − 95 %.
const WHOLE_TAIL: f64 = 0.05;
/// 95 % quantile of the standard normal distribution (–).
const NORMAL_ONE_SIDED_95: f64 = 1.644_853_626_951_472_2;
/// Binomial probabilities below this part of the largest are left out: their sum stays under 1e-15.
const NEGLIGIBLE: f64 = 1e-22;

/// A percentile with its confidence interval.
///
/// The value is interpolated between the two nearest order statistics (definition 7 of Hyndman and Fan 1996),
/// as spreadsheets, numpy and pandas do; the ends of the intervals are order statistics themselves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Percentile {
    /// The sample's percentile.
    pub value: f64,
    /// Lower end of the two-sided 95 % interval; none when there are too few rocks.
    pub low_95: Option<f64>,
    /// Upper end of the two-sided 95 % interval; none when there are too few rocks.
    pub high_95: Option<f64>,
    /// The true percentile lies below this with 95 % confidence (one-sided); none when there are too few rocks.
    pub upper_95: Option<f64>,
    /// Rocks needed before any [`upper_95`](Self::upper_95) exists: 59 for P95, 299 for P99, more of unlike weight.
    pub needs: usize,
    /// Whether rocks whose own value is only a bound leave this percentile a bound too: see [`Open`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub censored: bool,
}

/// On which side the true value of a rock lies that was seen only in part.
///
/// A rock that left the terrain would have gone on. Its runout is *at least* what was seen; its reach angle *at most*,
/// since slopes flatten downwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Open {
    /// At or above what was seen.
    Above,
    /// At or below what was seen.
    Below,
}

impl Percentile {
    /// Percentile `p` (0 < p < 1) of values in ascending order; none of nothing.
    pub fn of(sorted: &[f64], p: f64) -> Option<Self> {
        let ranks = Ranks::of(sorted.len(), p);
        let at = |rank: Option<usize>| rank.map(|rank| sorted[rank - 1]);
        Some(Self {
            value: interpolated(sorted, p)?,
            low_95: at(ranks.low),
            high_95: at(ranks.high),
            upper_95: at(ranks.upper),
            needs: needed(p),
            censored: false,
        })
    }

    /// What is known of a percentile when some rocks were seen only in part: `self` takes each at what was seen, `far`
    /// moves each to the far end of where it may lie. The truth is between the two, however the rocks would have gone on
    /// (worst-case bounds, Manski 1990), so each end of the interval is taken from the one that gives the wider.
    pub(super) fn between(self, far: &Self, open: Open) -> Self {
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        let censored = far.value.total_cmp(&self.value).is_ne();
        match open {
            Open::Above => Self {
                high_95: finite(far.high_95),
                upper_95: finite(far.upper_95),
                censored,
                ..self
            },
            Open::Below => Self { low_95: finite(far.low_95), censored, ..self },
        }
    }
}

impl Percentile {
    /// Percentile `p` (0 < p < 1) of weighted values in ascending order: the smallest that at least the share `p` of all
    /// weight does not exceed; none of nothing.
    ///
    /// The interval is Woodruff's (1952): the share of weight below is known to `σ² = Σ w² (1{x ≤ q} − p)² / (Σ w)²`, and
    /// the values at the shares `p ± 1.96 σ` enclose the percentile. Where such a share is not below 1, or has no rock
    /// below it, that end is open. For the upper end one more rock of the heaviest weight lies above, as Fay and Feuer (1997) have it for
    /// rates: that no heavy rock was seen beyond the percentile does not say that none goes there. Of fewer rocks than it needs there is no
    /// lower end either: the few heavy ones that decide where it lies tell too little of `σ`.
    /// [`needs`](Self::needs) is as many of these rocks as it takes to be worth enough of equal weight, `(Σ w)² / Σ w²` (Kish 1965).
    pub(super) fn weighted((sorted, weights): (&[f64], &[f64]), p: f64) -> Option<Self> {
        let all: f64 = weights.iter().sum();
        let at = |share: f64| {
            let mut below = 0.0;
            let reaches = |weight: &f64| {
                below += weight;
                below >= share * all
            };
            let rank = weights.iter().position(reaches);
            rank.map_or(sorted.last(), |rank| sorted.get(rank)).copied()
        };
        let value = at(p)?;
        let side = |(x, w): (&f64, &f64)| (w * (f64::from(u8::from(*x <= value)) - p)).powi(2);
        let seen = sorted.iter().zip(weights).map(side).sum::<f64>() / (all * all);
        let worth = worth(weights);
        let heaviest = weights.iter().copied().fold(0.0, f64::max) / all;
        let (sd, wider) = (seen.sqrt(), (seen + (p * heaviest).powi(2)).sqrt());
        let end = |share: f64| (share > 0.0 && share < 1.0).then(|| at(share)).flatten();
        let needs = (needed(p) as f64 * sorted.len() as f64 / worth - 1e-9).ceil() as usize;
        Some(Self {
            value,
            low_95: end(p - NORMAL_95 * sd).filter(|_| sorted.len() >= needs),
            high_95: end(p + NORMAL_95 * wider),
            upper_95: end(p + NORMAL_ONE_SIDED_95 * wider),
            needs,
            censored: false,
        })
    }
}

/// So many rocks of equal weight would say as much (–): `(Σ w)² / Σ w²` (Kish 1965).
pub(super) fn worth(weights: &[f64]) -> f64 {
    let all: f64 = weights.iter().sum();
    all * all / weights.iter().map(|weight| weight * weight).sum::<f64>()
}

/// The value at `(n − 1) p` of the sorted values, counted from 0, linear in between.
fn interpolated(sorted: &[f64], p: f64) -> Option<f64> {
    Some(between(sorted, sorted.len().checked_sub(1)? as f64 * p))
}

/// The value at a place among sorted ones, counted from 0, linear in between.
pub(super) fn between(sorted: &[f64], place: f64) -> f64 {
    let below = sorted[place.floor() as usize];
    let above = sorted[place.ceil() as usize];
    // between two open ends nothing can be interpolated
    if above > below { below + place.fract() * (above - below) } else { below }
}

/// Fewest rocks of which the largest value bounds percentile `p` with 95 % confidence: `pⁿ ≤ 0.05`.
pub(super) fn needed(p: f64) -> usize {
    (math::ln(WHOLE_TAIL) / math::ln(p)).ceil() as usize
}

/// Which of `n` sorted values bound a percentile, counted from 1; none where no value does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ranks {
    /// Lower end of the two-sided 95 % interval: the largest `l` with `P(B < l) ≤ 0.025`.
    pub low: Option<usize>,
    /// Upper end of the two-sided 95 % interval: the smallest `u` with `P(B ≥ u) ≤ 0.025`.
    pub high: Option<usize>,
    /// One-sided 95 % upper bound: the smallest `u` with `P(B ≥ u) ≤ 0.05`.
    pub upper: Option<usize>,
}

impl Ranks {
    /// Ranks for percentile `p` (0 < p < 1) of `n` values.
    pub fn of(n: usize, p: f64) -> Self {
        let below = Binomial::new(n, p);
        let present = |rank: usize| (1..=n).contains(&rank).then_some(rank);
        Self {
            low: present(below.lower(ONE_TAIL)),
            high: present(below.upper(ONE_TAIL)),
            upper: present(below.upper(WHOLE_TAIL)),
        }
    }
}

/// The probabilities of binomial(n, p) that matter, from the count `first` on.
struct Binomial {
    first: usize,
    chances: Vec<f64>,
}

impl Binomial {
    /// Walks away from the most probable count by the ratio of neighbours and divides by the sum: no factorials.
    fn new(n: usize, p: f64) -> Self {
        let odds = p / (1.0 - p);
        let mode = ((n as f64 + 1.0) * p).floor().min(n as f64) as usize;
        let mut down =
            walk(mode, |k| (k > 0).then(|| (k - 1, k as f64 / ((n - k + 1) as f64 * odds))));
        let up = walk(mode, |k| (k < n).then(|| (k + 1, (n - k) as f64 * odds / (k + 1) as f64)));
        let first = mode - down.len();
        down.reverse();
        let weights: Vec<f64> = down.into_iter().chain([1.0]).chain(up).collect();
        let sum: f64 = weights.iter().sum();
        Self { first, chances: weights.into_iter().map(|weight| weight / sum).collect() }
    }

    /// The largest `l` with `P(B < l) ≤ tail`.
    fn lower(&self, tail: f64) -> usize {
        self.first + within(self.chances.iter(), tail)
    }

    /// The smallest `u` with `P(B ≥ u) ≤ tail`.
    fn upper(&self, tail: f64) -> usize {
        self.first + self.chances.len() - within(self.chances.iter().rev(), tail)
    }
}

/// Weights relative to the mode on one side of it, while they matter; `next` gives a neighbour and the ratio to it.
fn walk(mode: usize, next: impl Fn(usize) -> Option<(usize, f64)>) -> Vec<f64> {
    let mut weights = Vec::new();
    let (mut count, mut weight) = (mode, 1.0);
    while let Some((neighbour, ratio)) = next(count) {
        (count, weight) = (neighbour, weight * ratio);
        if weight < NEGLIGIBLE {
            break;
        }
        weights.push(weight);
    }
    weights
}

/// How many of the chances may be taken together without exceeding `tail`.
fn within<'a>(chances: impl Iterator<Item = &'a f64>, tail: f64) -> usize {
    let mut sum = 0.0;
    chances
        .take_while(|&&random| {
            sum += random;
            sum <= tail
        })
        .count()
}

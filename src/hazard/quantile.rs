//! Percentiles with distribution-free confidence intervals.
//!
//! How many of `n` rocks stay below the true percentile `q_p` is binomial(n, p), whatever the distribution
//! of the values. So the `l`-th and `u`-th smallest value enclose `q_p` with probability `P(l ≤ B < u)`
//! (Conover, Practical Nonparametric Statistics, section 3.2). The probabilities are summed, not approximated.

use super::beta;
use super::proportion::{ONE_TAIL, between_tails};
use crate::math;
use serde::{Deserialize, Serialize};

/// Chance that a one-sided bound misses: 1 − 95 %.
const WHOLE_TAIL: f64 = 0.05;
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
    /// How many of so many rocks are missing before anything bounds it; none where there are enough.
    pub fn lacks(&self, rocks: usize) -> Option<usize> {
        self.needs.checked_sub(rocks).filter(|missing| *missing > 0)
    }

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
    /// weight does not exceed; none of nothing. Its interval is that of [`WeightBelow::bounds`].
    pub(super) fn weighted((sorted, weights): (&[f64], &[f64]), p: f64) -> Option<Self> {
        let below = WeightBelow::of(weights.iter().map(|&weight| (weight, 1)));
        let value = *sorted.get(below.place(p))?;
        let Bounds { low, high, upper, needs } = below.bounds(p);
        let at = |place: Option<usize>| place.map(|place| sorted[place]);
        let (low_95, high_95, upper_95) = (at(low), at(high), at(upper));
        Some(Self { value, low_95, high_95, upper_95, needs, censored: false })
    }
}

/// What weighs below and up to each of some places in ascending order: of values one by one or in groups.
pub(super) struct WeightBelow {
    /// Sum of the weights below each place, and of their squares; all of them last.
    sums: Vec<[f64; 2]>,
    rocks: usize,
}

/// Which places bound a percentile, counted from 0; none where none does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Bounds {
    /// Lower end of the two-sided 95 % interval.
    pub(super) low: Option<usize>,
    /// Upper end of the two-sided 95 % interval.
    pub(super) high: Option<usize>,
    /// One-sided 95 % upper bound.
    pub(super) upper: Option<usize>,
    /// Rocks of this kind needed for an upper bound.
    pub(super) needs: usize,
}

/// How far a percentile is from a value, by the share of all weight below it; half of the value's own counts as below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Departure {
    /// Share below (–).
    pub(super) share: f64,
    /// Standard deviation of it (–); half a rock is added, as what was not seen may be there.
    pub(super) spread: f64,
    /// Where the percentile lies below the value with the chance that it does, a standard normal variable would be below this (–).
    pub(super) normal: f64,
}

/// What is added to the variance of a share (in the square of what one rock weighs).
const HALF_A_ROCK: f64 = 0.5;

/// What sums of weights lack by rounding where they are just a share (–).
const AT_A_TIE: f64 = 1e-12;

impl WeightBelow {
    /// Of groups of so many rocks of one weight each (weight, rocks); what has the same place has one group, or one after the other.
    pub(super) fn of(groups: impl Iterator<Item = (f64, usize)>) -> Self {
        let mut below = Self { sums: vec![[0.0; 2]], rocks: 0 };
        let mut last = [0.0; 2];
        for (weight, rocks) in groups {
            let n = rocks as f64;
            last = [last[0] + n * weight, last[1] + n * weight * weight];
            below.sums.push(last);
            below.rocks += rocks;
        }
        below
    }

    /// Sums of weights and of their squares over all.
    fn whole(&self) -> [f64; 2] {
        self.sums.last().copied().unwrap_or_default()
    }

    /// Share of all weight that sums are of, and its variance.
    fn share(&self, [below, its]: [f64; 2]) -> (f64, f64) {
        let [whole, squares] = self.whole();
        let share = (below / whole).min(1.0);
        let variance = its * (1.0 - share).powi(2) + (squares - its) * share * share;
        (share, variance.max(0.0) / (whole * whole))
    }

    /// How far percentile `p` is from a place.
    ///
    /// Of equal weights the share below the `i`-th of `n` values is a beta variable of `i` and `n + 1 − i` (David and Nagaraja 2003, Order
    /// Statistics, section 2.1). With weights so many rocks count as the share's variance is that of (Korn and Graubard 1998).
    pub(super) fn departure(&self, place: usize, p: f64) -> Departure {
        let [whole, squares] = self.whole();
        let middle = [0, 1].map(|k| 0.5 * (self.sums[place][k] + self.sums[place + 1][k]));
        let (one, (share, variance)) = (squares / (whole * whole), self.share(middle));
        let (variance, half) = (variance + HALF_A_ROCK * one * one, HALF_A_ROCK * one);
        let weight = variance / (share * (1.0 - share) + half);
        let normal =
            beta::normal_score(p, [share + half, 1.0 - share + half].map(|of| of / weight));
        Departure { share, spread: variance.sqrt(), normal }
    }

    /// The first place up to which at least the share `p` of all weight lies.
    pub(super) fn place(&self, p: f64) -> usize {
        let wanted = p * self.whole()[0] * (1.0 - AT_A_TIE);
        // rounding may keep the last sum from reaching the whole
        let inner = self.sums.get(1..self.sums.len() - 1).unwrap_or_default();
        inner.partition_point(|[below, _]| *below < wanted)
    }

    /// Which places bound percentile `p` with 95 % confidence: those at which the share below, or up to, leaves `p` out of its own interval
    /// (test inversion, Francisco and Fuller 1991; Woodruff's of 1952 with exact tails). One more rock has the weight that the rocks
    /// have by weight, `Σ w²/Σ w`. Of equal weights these are the [`Ranks`].
    ///
    /// Equal values count one after the other, as if they differed by less than is seen: together they would seem to know their share better
    /// than they do. Of fewer rocks than it [needs](Percentile::needs), so many as are worth enough of equal weight, there is no lower end
    /// either: the few heavy ones that decide where it lies tell too little of how well they do.
    pub(super) fn bounds(&self, p: f64) -> Bounds {
        let [whole, squares] = self.whole();
        let (last, one) = (self.sums.len() - 1, squares / (whole * whole));
        let ends = |sums: [f64; 2], tail: f64| {
            let (share, variance) = self.share(sums);
            between_tails(share, (variance, one), tail)
        };
        let upper = |tail: f64| {
            let place = self.sums[1..].partition_point(|up_to| ends(*up_to, tail)[0] <= p);
            (place < last).then_some(place)
        };
        let low = self.sums[..last].partition_point(|below| ends(*below, ONE_TAIL)[1] < p);
        let needs = (needed(p) as f64 * self.rocks as f64 * one - 1e-9).ceil() as usize;
        Bounds {
            low: low.checked_sub(1).filter(|_| self.rocks >= needs),
            high: upper(ONE_TAIL),
            upper: upper(WHOLE_TAIL),
            needs,
        }
    }
}

/// So many rocks of equal weight would say as much (–): `(Σ w)² / Σ w²` (Kish 1965).
pub(super) fn worth(weights: &[f64]) -> f64 {
    let all: f64 = weights.iter().sum();
    all * all / weights.iter().map(|weight| weight * weight).sum::<f64>()
}

/// The value at `(n − 1) p` of the sorted values, counted from 0, linear in between.
fn interpolated(sorted: &[f64], p: f64) -> Option<f64> {
    let place = sorted.len().checked_sub(1)? as f64 * p;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    // between two open ends nothing can be interpolated
    Some(if above > below { below + place.fract() * (above - below) } else { below })
}

impl Percentile {
    /// Rocks needed before percentile `p` has a two-sided interval with an upper end, `pⁿ ≤ 0.025`: 72 for P95 where 59 bound it on
    /// one side, more of unlike weight as [`needs`](Self::needs) says.
    pub fn needs_for_interval(&self, p: f64) -> usize {
        let both = (math::ln(ONE_TAIL) / math::ln(p)).ceil();
        (both * self.needs as f64 / needed(p) as f64).ceil() as usize
    }
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

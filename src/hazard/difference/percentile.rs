//! How far apart the percentiles of two runs may be.
//!
//! The percentile of a run may lie at any of its values, at some more likely than at others: a [`Departure`] says how far the share below a
//! value is from `p`, in standard deviations. A value of each run, with departures `u` and `v`, may both be the percentiles where
//! `(u² − 2 r u v + v²)/(1 − r²)` is within the 95 % of `χ²` with one degree of freedom (test inversion, as of one percentile in Francisco and
//! Fuller 1991, Annals of Statistics 19, 454; one degree, as not where both lie is asked but how far apart: Venzon and Moolgavkar
//! 1988, Applied Statistics 37, 87). The interval of the difference goes from the least to the largest of these.
//!
//! No density is estimated: gaps and clusters near the percentile count as they are. The correlation `r` of the shares below both values is
//! counted at just these. So where most releases are alike in both runs, those that lie between two values of unlike rank count as different.

use super::super::proportion::NORMAL_95;
use super::super::quantile::{Bounds, Departure, WeightBelow};

/// Where the percentile of a run may lie.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Places {
    /// Release, value and weight, by rising value; of equal ones by rising release, so that pairs that are alike have one order.
    ranked: Vec<(usize, f64, f64)>,
    /// The first rank at which it may lie, counted from 0.
    first: usize,
    /// From there on as far as it may lie.
    departures: Vec<Departure>,
}

impl Places {
    /// Of percentile `p` of values (release, value, weight); none where they are too few to bound it on both sides.
    pub(super) fn of(mut ranked: Vec<(usize, f64, f64)>, p: f64) -> Option<Self> {
        ranked.sort_unstable_by(|one, other| one.1.total_cmp(&other.1).then(one.0.cmp(&other.0)));
        let below = WeightBelow::of(ranked.iter().map(|&(.., weight)| (weight, 1)));
        let Bounds { low, high, .. } = below.bounds(p);
        let (first, last) = low.zip(high)?;
        let departures = (first..=last).map(|place| below.departure(place, p)).collect();
        Some(Self { ranked, first, departures })
    }

    /// The same where values are so many times as large.
    pub(super) fn scale(&mut self, factor: f64) {
        self.ranked.iter_mut().for_each(|(_, value, _)| *value *= factor);
    }

    /// Ends of the 95 % interval of how far the percentile of `other` lies above this one.
    pub(super) fn apart(&self, other: &Self, paired: bool) -> (f64, f64) {
        if paired && self.ranked == other.ranked {
            return (0.0, 0.0);
        }
        let mut joint = Joint::of([self, other], paired);
        let mut ends: Option<(f64, f64)> = None;
        for (i, one) in self.departures.iter().enumerate() {
            let correlations = joint.correlations(i);
            for (k, (two, r)) in other.departures.iter().zip(correlations).enumerate() {
                if may_be([one.normal, two.normal], r) {
                    let apart = other.value(k) - self.value(i);
                    let (low, high) = ends.unwrap_or((apart, apart));
                    ends = Some((low.min(apart), high.max(apart)));
                }
            }
        }
        // rocks so heavy that none of them is near to a percentile: each may lie anywhere in its own interval
        ends.unwrap_or_else(|| {
            let ends = |of: &Self| (of.value(0), of.value(of.departures.len() - 1));
            let ((low_a, high_a), (low_b, high_b)) = (ends(self), ends(other));
            (low_b - high_a, high_b - low_a)
        })
    }

    /// The value at one of the places.
    fn value(&self, place: usize) -> f64 {
        self.ranked[self.first + place].1
    }

    /// Rank of each release.
    fn ranks(&self) -> Vec<(usize, usize)> {
        let mut ranks: Vec<_> =
            self.ranked.iter().zip(0..).map(|(of, rank)| (of.0, rank)).collect();
        ranks.sort_unstable();
        ranks
    }

    fn whole(&self) -> f64 {
        self.ranked.iter().map(|(.., weight)| weight).sum()
    }
}

/// Whether two values may be the percentiles of their runs.
fn may_be([u, v]: [f64; 2], r: f64) -> bool {
    u * u - 2.0 * r * u * v + v * v <= NORMAL_95 * NORMAL_95 * (1.0 - r * r)
}

/// What the releases that both runs have weigh below a value of each, place by place of the first run.
struct Joint<'a> {
    places: [&'a Places; 2],
    /// By rank in the first run: product of the shares that a release has of all weight in each, and its rank in the second.
    pairs: Vec<(f64, usize)>,
    /// Sum of these products below the place of the first run.
    in_first: f64,
    /// The same below each place of the second run, whatever the first has.
    in_second: Vec<f64>,
    /// By how much what is below in both grows from place to place of the second run.
    steps: Vec<f64>,
    /// Sum of all products.
    all: f64,
}

impl<'a> Joint<'a> {
    fn of(places: [&'a Places; 2], paired: bool) -> Self {
        let [one, other] = places;
        let (ranks, whole) = (other.ranks(), one.whole() * other.whole());
        let pair = |&(release, _, weight): &(usize, f64, f64)| {
            let found = ranks.binary_search_by_key(&release, |of| of.0).ok().filter(|_| paired);
            found.map_or((0.0, 0), |k| {
                let rank = ranks[k].1;
                (weight * other.ranked[rank].2 / whole, rank)
            })
        };
        let pairs: Vec<(f64, usize)> = one.ranked.iter().map(pair).collect();
        let none = vec![0.0; other.departures.len()];
        let mut joint =
            Self { places, pairs, in_first: 0.0, in_second: none.clone(), steps: none, all: 0.0 };
        joint.take(0..one.ranked.len(), 1.0);
        let mut sum = 0.0;
        let below = |step: &f64| {
            sum += step;
            sum
        };
        let in_second = joint.steps.iter().map(below).collect();
        let all = joint.in_first;
        let steps = vec![0.0; joint.steps.len()];
        joint = Self { in_first: 0.0, in_second, steps, all, ..joint };
        joint.take(0..one.first, 1.0);
        joint
    }

    /// Counts a part of some ranks of the first run as below its place; at its own place in the second run half of a release is below.
    fn take(&mut self, ranks: std::ops::Range<usize>, part: f64) {
        let first = self.places[1].first;
        for (product, rank) in &self.pairs[ranks] {
            let amount = part * product;
            self.in_first += amount;
            let (at, half) = match rank.checked_sub(first) {
                None => (0, amount),
                Some(at) => (at, 0.5 * amount),
            };
            if let Some(step) = self.steps.get_mut(at) {
                *step += half;
            }
            if let Some(step) = self.steps.get_mut(at + 1) {
                *step += amount - half;
            }
        }
    }

    /// Correlations of the share below a place of the first run with those below each of the second; places are asked for one after the other.
    fn correlations(&mut self, place: usize) -> Vec<f64> {
        let [one, other] = self.places;
        let rank = one.first + place;
        self.take(rank..rank + 1, 0.5);
        let (of, mut both) = (&one.departures[place], 0.0);
        let places = other.departures.iter().zip(&self.steps).zip(&self.in_second);
        let correlation = |((two, step), in_second): ((&Departure, &f64), &f64)| {
            both += step;
            let alone = two.share * self.in_first + of.share * in_second;
            (both - alone + of.share * two.share * self.all) / (of.spread * two.spread)
        };
        let found = places.map(correlation).collect();
        self.take(rank..rank + 1, 0.5);
        found
    }
}

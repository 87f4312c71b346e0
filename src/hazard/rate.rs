//! Events a year from weighted counts, with their interval.
//!
//! A stratum of `n_j` rocks that stands for `f_j` events a year and of which `k_j` do something gives `f_j k_j / n_j`; the
//! strata add (Hantz et al. 2021, Geosciences 11, 158: passage frequency = Σ failure frequency × reach probability).
//! Every rock may count for more or less than one, by its exposure `y` for instance.

use super::classes::class_of;
use super::proportion::{Proportion, interval_95, unseen};
use super::strata::bessel;
use crate::frequency::Weights;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;

/// Events a year with their 95 % interval, and what moves them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EventRate {
    /// Rocks that count.
    pub rocks: usize,
    /// Events a year (1/year).
    pub per_year: f64,
    /// Lower end of the 95 % interval (1/year).
    pub low_95: f64,
    /// Upper end of the 95 % interval (1/year); where no rock counts, a one-sided 95 % bound. Rocks that would have gone on
    /// are taken as if they counted.
    pub high_95: f64,
    /// Whether such rocks decide the rate more than chance does: then it is only a lower bound.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub censored: bool,
    /// Change with the logarithm of all rates (1/year): 10 % more rocks make it 10 % of this more.
    pub by_log_rate: f64,
    /// Change with the exponents of all power laws (1/year), their events of 1 m³ or more kept; none without power law.
    pub by_exponent: Option<f64>,
}

impl EventRate {
    /// Return period `1/λ` (years); none of nothing.
    pub fn return_period_years(&self) -> Option<f64> {
        (self.per_year > 0.0).then(|| 1.0 / self.per_year)
    }

    /// Probability of one or more in a year, `1 − e^−λ` (Poisson).
    pub fn annual_probability(&self) -> f64 {
        -libm::expm1(-self.per_year)
    }

    /// The same scaled: a probability that each event is followed by another.
    #[must_use]
    pub fn times(&self, share: f64) -> Self {
        Self {
            rocks: self.rocks,
            per_year: share * self.per_year,
            low_95: share * self.low_95,
            high_95: share * self.high_95,
            censored: self.censored,
            by_log_rate: share * self.by_log_rate,
            by_exponent: self.by_exponent.map(|slope| share * slope),
        }
    }
}

/// Sums over the rocks of one stratum that count.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Sums {
    rocks: u32,
    /// Sum of what each counts for, and of its square.
    y: f64,
    y2: f64,
    /// Sum of `y ∂ ln(frequency)/∂ exponent`.
    score: f64,
}

impl Sums {
    /// One rock that counts for `y`, whose frequency changes so with the exponent.
    pub(super) fn one(y: f64, score: f64) -> Self {
        Self { rocks: 1, y, y2: y * y, score: y * score }
    }

    /// So many rocks that count for one each.
    pub(super) fn many(rocks: u32) -> Self {
        let y = f64::from(rocks);
        Self { rocks, y, y2: y, score: 0.0 }
    }

    /// The same, of rocks whose frequency changes so with the exponent on average.
    pub(super) fn scoring(self, mean: f64) -> Self {
        Self { score: self.y * mean, ..self }
    }

    /// How many there are.
    pub(super) fn rocks(&self) -> usize {
        self.rocks as usize
    }

    pub(super) fn join(&mut self, other: &Self) {
        self.rocks += other.rocks;
        self.y += other.y;
        self.y2 += other.y2;
        self.score += other.score;
    }
}

/// Rounding of a sum of frequencies (–): it must not decide which rock is the last of a sum.
const SUM_ROUNDING: f64 = 1e-12;

/// Whether a frequency that is a sum over rocks reaches another (1/year).
pub(super) fn reaches(per_year: f64, wanted: f64) -> bool {
    per_year >= wanted * (1.0 - SUM_ROUNDING)
}

/// What a rate can reach at most.
#[derive(Debug, Clone)]
pub(super) struct Limits {
    /// Events a year of all strata that can count (1/year).
    most: f64,
    /// Events a year that a rock of the heaviest of them stands for (1/year).
    heaviest: f64,
    /// Class of the least energy that counts: an open rock that can have no more does not.
    least_class: u16,
    /// Strata of few rocks that can count, the rate of each of which none may be seen (1/year), largest first.
    sparse: Vec<(usize, f64)>,
}

/// With fewer rocks in a stratum what none seen leaves open, `1 − 0.05^(1/n)` and all of it without rocks, may lie beyond what one more
/// rock of it adds to the upper end beside other strata; hardly from so many on.
const MANY: usize = 14;

impl Limits {
    /// Of passages with at least an energy (J): strata whose largest rock can never have it do not count. `most_j` is the
    /// most energy of each stratum; of none without an entry anything is known.
    pub(super) fn above(weights: &Weights, most_j: &[f64], energy_j: f64) -> Self {
        let can = |stratum: &usize| most_j.get(*stratum).is_none_or(|most| *most >= energy_j);
        let limits = Self::of(weights, (0..weights.strata()).filter(can), |_| 1.0);
        Self { least_class: class_of(energy_j), ..limits }
    }

    /// Of what every rock can do, where one of a stratum counts for so much at most.
    pub(super) fn weighing(weights: &Weights, most: impl Fn(usize) -> f64) -> Self {
        Self::of(weights, 0..weights.strata(), most)
    }

    fn of(
        weights: &Weights,
        strata: impl Iterator<Item = usize> + Clone,
        most: impl Fn(usize) -> f64,
    ) -> Self {
        let few = |at: &usize| weights.strata() > 1 && weights.rocks(*at) < MANY;
        let open = |at: usize| {
            // without a rock nothing is known
            let share = match weights.rocks(at) {
                0 => 1.0,
                rocks => unseen(1.0 / rocks as f64),
            };
            (at, most(at) * weights.per_year(at) * share)
        };
        let mut sparse: Vec<(usize, f64)> = strata.clone().filter(few).map(open).collect();
        sparse.sort_by(|one, other| other.1.total_cmp(&one.1));
        // of a stratum without rocks all events may belong to what none was seen to do
        let heaviest_of = |at: usize| match weights.rocks(at) {
            0 => weights.per_year(at),
            _ => weights.of_stratum(at),
        };
        let heaviest = strata.clone().map(|at| most(at) * heaviest_of(at));
        Self {
            most: strata.map(|at| most(at) * weights.per_year(at)).sum(),
            heaviest: heaviest.fold(0.0, f64::max),
            least_class: 0,
            sparse,
        }
    }
}

/// Rocks that may still count, by the class of the most energy that they can have and by stratum.
pub(super) type OpenSums = BTreeMap<(u16, u16), Sums>;

/// The class of rocks of whose energy nothing is known.
pub(super) const ANY_ENERGY: u16 = u16::MAX;

/// Where no rock may still count.
static NO_OPEN: OpenSums = BTreeMap::new();

/// The rate of all rocks added so far.
#[derive(Debug)]
pub(super) struct Running<'a> {
    weights: &'a Weights,
    strata: Vec<Sums>,
    touched: Vec<u16>,
    /// Rocks that may still count: they move the upper end.
    open: &'a OpenSums,
    value: f64,
    score: f64,
    variance: f64,
}

impl<'a> Running<'a> {
    /// Without rocks.
    pub(super) fn new(weights: &'a Weights) -> Self {
        let strata = vec![Sums::default(); weights.strata()];
        let (touched, open) = (Vec::new(), &NO_OPEN);
        Self { weights, strata, touched, open, value: 0.0, score: 0.0, variance: 0.0 }
    }

    /// Without rocks, where some may still count.
    pub(super) fn with_open(weights: &'a Weights, open: &'a OpenSums) -> Self {
        Self { open, ..Self::new(weights) }
    }

    /// The rate were all rocks to count that may, with the energy that counts; none where there are none.
    fn far(&self, limits: &Limits) -> Option<Self> {
        let mut open = self.open.range((limits.least_class, 0)..).peekable();
        open.peek()?;
        let mut far = Self::new(self.weights);
        for stratum in &self.touched {
            far.add(*stratum, &self.strata[usize::from(*stratum)]);
        }
        for (&(_, stratum), sums) in open {
            far.add(stratum, sums);
        }
        Some(far)
    }

    /// The classes in which rocks may still count, of some, falling.
    pub(super) fn open_classes(&self, within: Range<u16>) -> impl Iterator<Item = u16> {
        let range = (within.start, 0)..(within.end.max(within.start), 0);
        let mut last = None;
        let classes = self.open.range(range).rev().map(|((class, _), _)| *class);
        classes.filter(move |class| last.replace(*class) != Some(*class))
    }

    /// Adds rocks of a stratum. Sums depend on the order in their last bits: callers add in a fixed one.
    pub(super) fn add(&mut self, stratum: u16, sums: &Sums) {
        let at = usize::from(stratum);
        self.variance -= self.variance_of(at);
        if self.strata[at].rocks == 0 {
            self.touched.push(stratum);
        }
        self.strata[at].join(sums);
        let weight = self.weights.of_stratum(at);
        self.value += weight * sums.y;
        self.score += weight * sums.score;
        self.variance += self.variance_of(at);
    }

    /// Without rocks again.
    pub(super) fn clear(&mut self) {
        for stratum in self.touched.drain(..) {
            self.strata[usize::from(stratum)] = Sums::default();
        }
        (self.value, self.score, self.variance) = (0.0, 0.0, 0.0);
    }

    /// `f² s²/n` of one stratum: of independent rocks, those that do not count included.
    ///
    /// A stratum of which every rock counts is taken as if half a rock did not: that none was seen to fail does not make
    /// it certain. One of which none counts has its say in [`interval`].
    fn variance_of(&self, stratum: usize) -> f64 {
        let Sums { rocks, y, y2, .. } = self.strata[stratum];
        let n = self.weights.rocks(stratum) as f64;
        if rocks == 0 {
            return 0.0;
        }
        let mean = y / n;
        let spread = (y2 / n - mean * mean).max(0.0);
        // a whole stratum, but not a part of a class of it
        let full = if y >= n && rocks as usize == self.weights.rocks(stratum) {
            0.5 / n * y2 / n
        } else {
            0.0
        };
        // with one stratum the interval is that of a proportion, which wants p (1 − p)
        let few = if self.weights.strata() == 1 { 1.0 } else { bessel(n) };
        self.weights.per_year(stratum).powi(2) * (few * spread + full) / n
    }

    /// Value, and lower and upper end of the interval.
    pub(super) fn estimate(&self, limits: &Limits) -> [f64; 3] {
        let [value, low, high] = self.by_chance(limits);
        let far = self.far(limits).map_or(high, |far| far.by_chance(limits)[2]);
        [value, low, high.max(far)]
    }

    /// The same of the rocks that count.
    fn by_chance(&self, limits: &Limits) -> [f64; 3] {
        let [low, high] = interval(self.value, self.variance.max(0.0), limits);
        let unseen = limits.sparse.iter().find(|(stratum, _)| self.strata[*stratum].rocks == 0);
        let open = unseen.map_or(0.0, |(_, open)| (self.value + open).min(limits.most));
        [self.value, low, high.max(open)]
    }

    /// Whether all rocks count, of every stratum that has events.
    fn are_all(&self) -> bool {
        let all = |(stratum, sums): (usize, &Sums)| match self.weights.rocks(stratum) {
            0 => self.weights.per_year(stratum) <= 0.0,
            rocks => sums.rocks() == rocks,
        };
        self.strata.iter().enumerate().all(all)
    }

    /// Value alone.
    pub(super) fn per_year(&self) -> f64 {
        self.value
    }

    /// Change with the exponent.
    pub(super) fn by_exponent(&self) -> f64 {
        self.score
    }

    /// All of it; `has_exponent` where a source has one.
    pub(super) fn rate(&self, limits: &Limits, has_exponent: bool) -> EventRate {
        let [per_year, low_95, high_95] = self.estimate(limits);
        let by_chance = self.by_chance(limits)[2];
        EventRate {
            censored: self.far(limits).is_some_and(|far| far.value.min(limits.most) > by_chance),
            rocks: self.strata.iter().map(|sums| sums.rocks as usize).sum(),
            per_year,
            low_95,
            high_95,
            by_log_rate: per_year,
            by_exponent: has_exponent.then(|| self.by_exponent()),
        }
    }
}

/// 95 % interval of a sum of weighted counts: that of a [share](interval_95) of the most it can be. Only strata that can count at all are
/// asked for their heaviest rock. Of strata with a handful of rocks each the largest of which none was seen bounds the upper end from below, see
/// [`Running::estimate`].
fn interval(value: f64, variance: f64, &Limits { most, heaviest, .. }: &Limits) -> [f64; 2] {
    if most <= 0.0 {
        return [0.0, 0.0];
    }
    let share = (value / most).clamp(0.0, 1.0);
    interval_95(share, (variance / (most * most), heaviest / most)).map(|end| most * end)
}

/// Share of all events that some releases stand for.
pub fn share_of(weights: &Weights, releases: impl Iterator<Item = usize>) -> Proportion {
    if weights.are_equal() {
        return Proportion::new(releases.count(), weights.all_rocks());
    }
    proportion(weights, releases.map(|release| (weights.stratum_of(release) as u16, 1)))
}

/// The same; none of no releases.
pub(super) fn share_if_any(
    weights: &Weights,
    releases: impl Iterator<Item = usize>,
) -> Option<Proportion> {
    let found = share_of(weights, releases);
    (found.count > 0).then_some(found)
}

/// The share, where `open` rocks may still do what the others did.
pub fn share_up_to(
    weights: &Weights,
    releases: impl Iterator<Item = usize> + Clone,
    open: impl Iterator<Item = usize> + Clone,
) -> Proportion {
    let seen = share_of(weights, releases.clone());
    if open.clone().next().is_none() {
        return seen;
    }
    seen.up_to(&share_of(weights, releases.chain(open)))
}

/// Share of all events that some rocks stand for, given by their number in each stratum.
pub(super) fn proportion(
    weights: &Weights,
    counts: impl Iterator<Item = (u16, usize)>,
) -> Proportion {
    let mut running = Running::new(weights);
    let mut count = 0;
    for (stratum, rocks) in counts.filter(|(_, rocks)| *rocks > 0) {
        running.add(stratum, &Sums::many(rocks as u32));
        count += rocks;
    }
    let plain = Proportion::new(count, weights.all_rocks());
    if weights.are_equal() {
        return plain;
    }
    let [share, low_95, high_95] = running
        .estimate(&Limits::above(weights, &[], 0.0))
        .map(|value| value / weights.total_per_year());
    // all of them are all: the sum of what each stands for would be so to rounding only
    let share = if running.are_all() { 1.0 } else { share };
    Proportion { share, low_95, high_95, ..plain }
}

#[cfg(test)]
mod tests;

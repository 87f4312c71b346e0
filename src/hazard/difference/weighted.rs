//! Differences between runs whose rocks weigh what they stand for.
//!
//! Where all rocks of a stratum have a value, pulls are less their mean, which is no chance: how many rocks it got is known.
//! Values are those of [`Sample::weighted`](super::super::Sample::weighted) and of shares of events, and pulls are what the intervals of means and shares are made of: of a
//! mean `w (x − mean)/Σw` (delta method), of a share
//! `w (1 − k_j/n_j)` of a rock of stratum `j` that counts and `−w k_j/n_j` of one that does not. So each
//! statistic is that of its own run, and with equal weights the intervals are those of [`super`].

use super::super::proportion::NORMAL_95;
use super::super::rate::share_of;
use super::super::strata::{FEWEST_OF_STRATUM, bessel};
use super::{Chance, Difference, Reading, Values, sample, variance};
use crate::frequency::Weights;

/// Releases that count, among which, and what they stand for.
#[derive(Debug, Clone)]
pub struct WeightedCount<'a> {
    /// Those that count, by rising number.
    pub releases: &'a [usize],
    /// All that could, by rising number.
    pub among: &'a [usize],
    /// What each of them stands for.
    pub weights: &'a Weights,
}

impl Reading {
    /// The weighted mean of the finite ones; none of nothing.
    pub fn weighted_mean(values: &[(usize, f64)], weights: &Weights) -> Option<Self> {
        let weighed = weighed(values, weights);
        let value = sample(&weighed).mean()?.value;
        let all: f64 = weighed.iter().map(|(.., weight)| weight).sum();
        let pull =
            |&(release, x, weight): &(usize, f64, f64)| (release, weight * (x - value) / all);
        let mut pulls: Values = weighed.iter().map(pull).collect();
        within_strata(&mut pulls, weights);
        let chance = (weighed.len() > 1).then_some(Chance::Pulls(pulls));
        Some(Self { value, rocks: weighed.len(), chance })
    }

    /// The weighted percentile `p` (0 < p < 1) of the finite ones; none of nothing.
    pub fn weighted_percentile(values: &[(usize, f64)], weights: &Weights, p: f64) -> Option<Self> {
        Self::of_percentile(weighed(values, weights), p)
    }
}

/// Takes out of pulls what is the same for all rocks of a stratum, where it is complete and has rocks enough.
fn within_strata(pulls: &mut Values, weights: &Weights) {
    let mut strata = vec![(0_usize, 0.0); weights.strata()];
    for (release, pull) in pulls.iter() {
        let of = &mut strata[weights.stratum_of(*release)];
        *of = (of.0 + 1, of.1 + pull);
    }
    for (release, pull) in pulls.iter_mut() {
        let stratum = weights.stratum_of(*release);
        let (rocks, sum) = strata[stratum];
        if rocks >= FEWEST_OF_STRATUM && rocks == weights.rocks(stratum) {
            let n = rocks as f64;
            *pull = (*pull - sum / n) * bessel(n).sqrt();
        }
    }
}

/// Release, value and weight of the finite ones.
fn weighed(values: &[(usize, f64)], weights: &Weights) -> Vec<(usize, f64, f64)> {
    let finite = values.iter().filter(|(_, x)| x.is_finite());
    finite.map(|&(release, x)| (release, x, weights.of_release(release))).collect()
}

impl WeightedCount<'_> {
    /// How much each release moves the part that counts of so much in all.
    fn pulls(&self, most: f64) -> Values {
        let weights = self.weights;
        let mut counted = vec![0_usize; weights.strata()];
        self.releases.iter().for_each(|release| counted[weights.stratum_of(*release)] += 1);
        let each = most / weights.total_per_year();
        let mut next = self.releases.iter().copied().peekable();
        let pull = |release: usize| {
            let stratum = weights.stratum_of(release);
            let rocks = (weights.rocks(stratum) as f64).max(1.0);
            let own = f64::from(u8::from(next.next_if_eq(&release).is_some()));
            // the variance of a sample is over one less
            let few = bessel(rocks).sqrt();
            let pull = (own - counted[stratum] as f64 / rocks) * few;
            (release, pull * weights.of_stratum(stratum) * each)
        };
        self.among.iter().copied().map(pull).collect()
    }
}

impl Difference {
    /// Between two shares of all events (–); paired, both must be of the same releases.
    ///
    /// One more rock of the heaviest stratum of each run is added to the variance (Fay and Feuer 1997), as in the intervals of
    /// the shares themselves: with equal weights that is the one that [`Self::of_shares`] adds.
    pub fn of_weighted_shares(a: &WeightedCount, b: &WeightedCount, paired: bool) -> Self {
        between([a, b], [1.0, 1.0], paired)
    }

    /// The same between two numbers of events a year (1/year).
    pub fn of_rates(a: &WeightedCount, b: &WeightedCount, paired: bool) -> Self {
        between([a, b], [a, b].map(|of| of.weights.total_per_year()), paired)
    }
}

/// The difference of what counts of so much in all.
fn between(of: [&WeightedCount; 2], most: [f64; 2], paired: bool) -> Difference {
    let one = |k: usize| {
        let WeightedCount { releases, weights, .. } = of[k];
        let share = share_of(weights, releases.iter().copied()).share;
        let heaviest = weights.heaviest() / weights.total_per_year();
        (most[k] * share, (most[k] * heaviest).powi(2))
    };
    let ((a, more_a), (b, more_b)) = (one(0), one(1));
    let pulls = [0, 1].map(|k| of[k].pulls(most[k]));
    let half = NORMAL_95 * (variance(&pulls[0], &pulls[1], paired) + more_a + more_b).sqrt();
    let inside = |end: f64| end.clamp(-most[0], most[1]);
    let value = b - a;
    let interval = of
        .iter()
        .all(|of| !of.among.is_empty())
        .then(|| (inside(value - half), inside(value + half)));
    Difference { a, b, value, interval }
}

//! What the rocks of a study stand for, where sizes are sampled by importance.

use crate::frequency::{Frequency, Weights};
use crate::hazard::{Open, Percentile, Sample};
use crate::plan::{Part, Plan};

/// Fewest releases of which a sampling error is given.
pub(super) const FEWEST: usize = 100;

/// What rocks of a study stand for: stratum and weight of each, in the order of releases.
#[derive(Debug, Clone, PartialEq)]
pub struct Weighing(pub Vec<(u32, f64)>);

impl Weighing {
    /// So many rocks that all weigh the same.
    pub fn equal(rocks: usize) -> Self {
        Self(vec![(0, 1.0); rocks])
    }

    /// Rocks that stand for parts of a frequency.
    pub fn by(weights: &Weights) -> Self {
        let rock = |release| (weights.stratum_of(release) as u32, weights.of_release(release));
        Self((0..weights.all_rocks()).map(rock).collect())
    }
}

/// What rocks stand for; none where all weigh the same.
pub(super) struct Weigh(Option<Frequency>);

impl Weigh {
    pub(super) fn of(plan: &Plan) -> Self {
        let Part::Kept(year) = &plan.year else { return Self(None) };
        let weighs = !year.frequency.weights(plan.count).are_equal();
        Self(weighs.then(|| year.frequency.clone()))
    }

    /// So many of equal weight would know as much as so many releases (–).
    pub(super) fn effective(&self, count: usize) -> Option<f64> {
        self.0.as_ref().map(|frequency| frequency.weights(count).effective_rocks())
    }

    /// Of so many releases.
    pub(super) fn rocks(&self, count: usize) -> Weighing {
        match &self.0 {
            None => Weighing::equal(count),
            Some(frequency) => Weighing::by(&frequency.weights(count)),
        }
    }

    /// Of the values of the first so many releases, some of which may be only bounds.
    pub(super) fn percentile(
        &self,
        values: &[f64],
        open: Option<(&[bool], Open)>,
        p: f64,
    ) -> Option<Percentile> {
        let count = values.len();
        let weights = match &self.0 {
            None => Weights::equal(count),
            Some(frequency) => frequency.weights(count),
        };
        let each = values.iter().enumerate().map(|(release, value)| (*value, release));
        let sample = match open {
            None => Sample::of_releases(each, &weights),
            Some((bounds, side)) => {
                let seen = each.zip(bounds).map(|((value, release), is)| (value, release, *is));
                Sample::censored_of_releases(seen, &weights, side)
            }
        };
        sample.percentile(p)
    }

    /// Half widths of the 95 % interval for the first 100, 200, 500, 1000 … releases.
    pub(super) fn sampling(
        &self,
        values: &[f64],
        open: Option<(&[bool], Open)>,
        p: f64,
    ) -> Vec<(usize, f64)> {
        let numbers = (2..).flat_map(|power| [1, 2, 5].map(|step| step * 10usize.pow(power)));
        let inner = numbers.take_while(|&n| n < values.len()).filter(|&n| n >= FEWEST);
        let half = |n: usize| {
            let found = self.percentile(&values[..n], open, p)?;
            Some((n, 0.5 * (found.high_95? - found.low_95?)))
        };
        inner.chain([values.len()]).filter_map(half).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The half width of a median of a thousand values in a row is half of what lies between the ranks that enclose it: the highest below which
    /// no more than a fortieth of all samples have the median, and the one as far from the other end. Summed here from the binomial of a fair coin.
    #[test]
    fn half_the_interval_of_a_median_is_half_of_what_its_ranks_enclose() {
        let n = 1000_i32;
        // P(B = k) of a fair coin, from 2⁻ⁿ on by the ratio of neighbours
        let mut chance = 0.5_f64.powi(n);
        let (mut below, mut low) = (0.0, 0);
        while below + chance <= 0.025 {
            below += chance;
            chance *= f64::from(n - low) / f64::from(low + 1);
            low += 1;
        }
        let high = n + 1 - low;
        let values: Vec<f64> = (1..=n).map(f64::from).collect();
        let found = Weigh(None).sampling(&values, None, 0.5);
        assert_eq!(found.last(), Some(&(1000, 0.5 * f64::from(high - low))), "{low} to {high}");
    }
}

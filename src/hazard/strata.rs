//! The strata of a sample: rocks of which every class was released in a number of its own.
//!
//! Between strata chance decides nothing: what share of all events each has is known, and how many rocks it got. What varies is what the
//! rocks of one stratum do. So the variance of a sum over them is that of stratified sampling (Cochran 1977, Sampling Techniques,
//! section 5.4), `Σ_j n_j/(n_j − 1) (Σ z² − (Σ z)²/n_j)` with the pull `z` of each rock on what is estimated: 0 of those that do not come to
//! a place, 5A.2 of domains. A stratum of few rocks tells too little of what varies within: their pulls count whole.

use crate::frequency::Weights;

/// Rocks of a stratum from which on it tells what varies within.
pub(super) const FEWEST_OF_STRATUM: usize = 20;

/// What the mean square deviation of so many rocks is multiplied by to tell the variance of what they are drawn from.
pub(super) fn bessel(rocks: f64) -> f64 {
    rocks / (rocks - 1.0).max(1.0)
}

/// The strata of values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Strata {
    /// That of each value, in the order of the values.
    pub(super) of: Vec<u16>,
    /// Rocks of each that were released.
    pub(super) rocks: Vec<f64>,
}

/// Sums of pulls over the rocks of one stratum: how many they are, the sum, and those of the squares and cubes.
#[derive(Debug, Clone, Copy, Default)]
struct Pulls {
    rocks: f64,
    sum: f64,
    squares: f64,
    cubes: f64,
}

impl Strata {
    /// How many rocks of each stratum were released.
    pub(super) fn rocks_of(weights: &Weights) -> Vec<f64> {
        (0..weights.strata()).map(|stratum| weights.rocks(stratum) as f64).collect()
    }

    /// What the variance within a stratum is multiplied by, and one over its rocks; 1 and 0 of few.
    fn within(&self, stratum: u16) -> (f64, f64) {
        let n = self.rocks.get(usize::from(stratum)).copied().unwrap_or(0.0);
        if n >= FEWEST_OF_STRATUM as f64 { (bessel(n), 1.0 / n) } else { (1.0, 0.0) }
    }

    /// Variance of the sum of pulls, the third central moment of it, and its degrees of freedom (Satterthwaite 1946, by the rocks of each
    /// stratum that pull).
    pub(super) fn moments(&self, pulls: impl Iterator<Item = f64>) -> [f64; 3] {
        let mut strata = vec![Pulls::default(); self.rocks.len()];
        for (z, stratum) in pulls.zip(&self.of) {
            let all = &mut strata[usize::from(*stratum)];
            all.rocks += 1.0;
            all.sum += z;
            all.squares += z * z;
            all.cubes += z * z * z;
        }
        let (mut variance, mut third, mut doubt) = (0.0, 0.0, 0.0);
        for (stratum, all) in (0..).zip(&strata).filter(|(_, all)| all.rocks > 0.0) {
            let (few, one) = self.within(stratum);
            let mean = all.sum * one;
            let own = few * (all.squares - all.sum * mean).max(0.0);
            variance += own;
            third += all.cubes - 3.0 * mean * all.squares + 2.0 * mean * mean * all.sum;
            doubt += own * own / (all.rocks - 1.0).max(1.0);
        }
        [variance, third, if doubt > 0.0 { variance * variance / doubt } else { 1.0 }]
    }
}

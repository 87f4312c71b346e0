//! A share of the rocks, with its confidence interval.

use super::beta::quantile;
use crate::math;
use serde::{Deserialize, Serialize};

/// Chance that an interval misses on one side: half of 1 − 95 %.
pub(super) const ONE_TAIL: f64 = 0.025;
/// Chance that the one-sided bound of what was never seen misses: 1 − 95 %.
const UNSEEN: f64 = 0.05;
/// What is missing to all by no more than rounding (–).
const ALL: f64 = 1e-12;
/// Half width of the two-sided 95 % interval of the standard normal distribution (–).
pub(super) const NORMAL_95: f64 = 1.959_963_984_540_054;
/// The same of Student's distribution with one degree of freedom, `tan(0.475 π)` (–).
const STUDENT_95_OF_ONE: f64 = 12.706_204_736_432_1;

/// The same of Student's distribution with so many degrees of freedom (–, from 1 on): Fisher and Cornish's series in their reciprocal
/// (Abramowitz and Stegun 1964, 26.7.5), off by 1 % for two and by 0.1 % for three.
pub(crate) fn student_95(freedom: f64) -> f64 {
    if freedom < 1.5 {
        return STUDENT_95_OF_ONE;
    }
    let (z, over) = (NORMAL_95, 1.0 / freedom);
    let z2 = z * z;
    let terms = [
        (z2 + 1.0) / 4.0,
        ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0,
        (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0,
        ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92_160.0,
    ];
    z * (1.0 + terms.iter().rev().fold(0.0, |sum, term| (sum + term) * over))
}

/// Share of `count` among `of`, with a 95 % interval.
///
/// The interval is that of Clopper and Pearson (1934): the shares with which so few, or so many, would be counted in 2.5 % of all samples. It
/// holds the truth in at least 95 % of samples, however rare what is counted and however few the rocks; Wilson's (1927), which is
/// right on average, in 84 % at worst, where one or none is expected. Where nothing (or everything) was counted, the free end
/// is one-sided, `1 − 0.05^h`; so for shares from there to the two-sided `1 − 0.025^(1/n)` it is 93.8 %, of few rocks 93.0 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Proportion {
    /// How many were counted.
    pub count: usize,
    /// Among how many.
    pub of: usize,
    /// `count / of` (–), 0..1; none of none is 0.
    pub share: f64,
    /// Lower end of the 95 % interval (–), 0..1.
    pub low_95: f64,
    /// Upper end of the 95 % interval (–), 0..1; rocks that would have gone on counted, where they may still belong.
    pub high_95: f64,
    /// Whether such rocks decide the share more than chance does: then it is only a lower bound.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub censored: bool,
}

impl Proportion {
    /// Share of `count` among `of`; of nothing, nothing is known: 0..1.
    pub fn new(count: usize, of: usize) -> Self {
        let n = of.max(1) as f64;
        let share = count as f64 / n;
        Self::weighted((count, of), share, (share * (1.0 - share) / n, 1.0 / n))
    }

    /// A share of weighted rocks that is known with a variance; one rock stands for `heaviest` of all at most (–).
    pub(super) fn weighted(
        (count, of): (usize, usize),
        share: f64,
        (variance, heaviest): (f64, f64),
    ) -> Self {
        if of == 0 {
            return Self { count, of, share: 0.0, low_95: 0.0, high_95: 1.0, censored: false };
        }
        let [low_95, high_95] = interval_95(share, (variance, heaviest));
        Self { count, of, share, low_95, high_95, censored: false }
    }

    /// The same where some rocks may still belong: `far` counts them all. The truth lies between the two.
    #[must_use]
    pub(super) fn up_to(self, far: &Self) -> Self {
        let censored = far.share > self.high_95;
        Self { high_95: self.high_95.max(far.high_95), censored, ..self }
    }
}

/// Share (0..1) that a sample of which none was seen leaves open with 95 % confidence, where one rock stands for `h` of all at most:
/// `1 − 0.05^h`, of `n` rocks alike the exact `1 − 0.05^(1/n)` (3/n is its limit for large n). Rocks that weigh less only lower it, as
/// `1 − exp(−x)` is concave.
pub(super) fn unseen(heaviest: f64) -> f64 {
    1.0 - math::pow(UNSEEN, heaviest.min(1.0))
}

/// 95 % interval of a share that is known with a variance, see [`between_tails`]; one-sided where nothing or all is seen.
pub(super) fn interval_95(share: f64, (variance, heaviest): (f64, f64)) -> [f64; 2] {
    let open = unseen(heaviest);
    if share <= 0.0 {
        [0.0, open]
    } else if share >= 1.0 - ALL {
        [1.0 - open, 1.0]
    } else {
        between_tails(share, (variance, heaviest), ONE_TAIL)
    }
}

/// The shares that leave a tail on either side, where one was seen with a variance `σ²` and one rock stands for `h` of all at most.
///
/// The ends are quantiles of beta distributions: of `s/w` and `(1 − s + h)/w` the lower, of `(s + h)/w` and `(1 − s)/w` the
/// upper, `w` being the effective weight of a rock `(σ² + q h²)/(s (1 − s) + q h)`, with `q = s` for the lower and `1 − s` for the upper
/// end. With equal weights, `h = 1/n` and `σ² = s (1 − s) h`, it is Clopper and Pearson's (1934) of `s n` among `n`; a small share
/// has Fay and Feuer's (1997, Statistics in Medicine 16, 791), who add one more rock of the heaviest weight, as what was not seen may belong to the
/// stratum whose rocks stand for most; a large share has the same from the other side. In between it is that of Korn and Graubard (1998, Survey
/// Methodology 24, 193) with that rock, without which rare heavy rocks break it far too often.
pub(super) fn between_tails(share: f64, (variance, heaviest): (f64, f64), tail: f64) -> [f64; 2] {
    let (rest, h) = (1.0 - share, heaviest);
    let weight = |part: f64| (variance + part * h * h) / (share * rest + part * h);
    let (low, high) = (weight(share), weight(rest));
    [
        if share > 0.0 { quantile(tail, [share / low, (rest + h) / low]) } else { 0.0 },
        if rest > 0.0 { quantile(1.0 - tail, [(share + h) / high, rest / high]) } else { 1.0 },
    ]
}

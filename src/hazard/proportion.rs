//! A share of the rocks, with its confidence interval.

use serde::{Deserialize, Serialize};

/// Half width of the two-sided 95 % interval of the standard normal distribution (–).
pub(super) const NORMAL_95: f64 = 1.959_963_984_540_054;
/// The same of Student's distribution with one degree of freedom, `tan(0.475 π)` (–).
const STUDENT_95_OF_ONE: f64 = 12.706_204_736_432_1;

/// The same of Student's distribution with so many degrees of freedom (–, from 1 on): Fisher and Cornish's series in their reciprocal
/// (Abramowitz and Stegun 1964, 26.7.5), off by 1 % for two and by 0.1 % for three.
pub(super) fn student_95(freedom: f64) -> f64 {
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
/// The interval is Wilson's (1927, eq. 1). It never leaves 0..1 and stays sound for small shares, where
/// `p ± 1.96 √(p(1 − p)/n)` does not. Where nothing (or everything) was counted, the free end is the
/// rule of three: having seen none among `n`, the share is below `3/n` with 95 % confidence.
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
        let share = if of == 0 { 0.0 } else { count as f64 / of as f64 };
        let (low_95, high_95) = match count {
            _ if of == 0 => (0.0, 1.0),
            0 => (0.0, rule_of_three(of)),
            all if all == of => (1.0 - rule_of_three(of), 1.0),
            _ => wilson(share, of as f64),
        };
        Self { count, of, share, low_95, high_95, censored: false }
    }
}

impl Proportion {
    /// A share of weighted rocks: as many of equal weight as would know it equally well say how well it is known.
    pub(super) fn effective(count: usize, of: usize, share: f64, rocks: f64) -> Self {
        let (low_95, high_95) = match count {
            _ if of == 0 => (0.0, 1.0),
            0 => (0.0, (3.0 / rocks).min(1.0)),
            all if all == of => ((1.0 - 3.0 / rocks).max(0.0), 1.0),
            _ => wilson(share, rocks),
        };
        Self { count, of, share, low_95, high_95, censored: false }
    }
}

impl Proportion {
    /// The same where some rocks may still belong: `far` counts them all. The truth lies between the two.
    #[must_use]
    pub(super) fn up_to(self, far: &Self) -> Self {
        let censored = far.share > self.high_95;
        Self { high_95: self.high_95.max(far.high_95), censored, ..self }
    }
}

/// Upper 95 % bound of a share of which none was seen among `n`: `1 − 0.05^(1/n) ≈ 3/n`.
fn rule_of_three(n: usize) -> f64 {
    (3.0 / n as f64).min(1.0)
}

/// Wilson's score interval: `(p + z²/2n ± z √(p(1 − p)/n + z²/4n²)) / (1 + z²/n)`.
pub(super) fn wilson(p: f64, n: f64) -> (f64, f64) {
    let z2 = NORMAL_95 * NORMAL_95;
    let middle = p + z2 / (2.0 * n);
    let half = NORMAL_95 * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z2 / n;
    ((middle - half) / scale, (middle + half) / scale)
}

//! The normal distribution between two bounds, drawn by the inverse of its cumulative distribution.
//!
//! Exponential, logarithm and error function come from `libm`, so that a draw has the same bits on every platform.

use crate::error::Flaw;
use crate::math;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// A normal distribution between two bounds, either of which may be infinite.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Truncated {
    mean: f64,
    sd: f64,
    pub(super) low: f64,
    pub(super) high: f64,
    /// Probability below `low` and below `high`.
    below: [f64; 2],
    /// Probability above `low` and above `high`: kept apart, 1 − `below` would lose the upper tail.
    above: [f64; 2],
}

/// Smallest share of a distribution that its bounds may hold (–). With less the bounds and the
/// distribution contradict each other, and the draws would lean on the far tail alone.
const SMALLEST_SHARE: f64 = 1e-6;

impl Truncated {
    /// `sd` > 0 and `low` < `high` are the caller's to check.
    pub(super) fn new([mean, sd]: [f64; 2], [low, high]: [f64; 2]) -> Result<Self, Flaw> {
        let standard = [(low - mean) / sd, (high - mean) / sd];
        let below = standard.map(probability_below);
        let above = standard.map(|z| probability_below(-z));
        // the smaller of the two differences is the one that rounding has not eaten
        let share = if below[0] < 0.5 { below[1] - below[0] } else { above[0] - above[1] };
        if share.is_nan() || share < SMALLEST_SHARE {
            return Err(Flaw::new(
                "found min..max holding less than a millionth of the distribution",
                "write bounds that hold a good part of it",
            ));
        }
        Ok(Self { mean, sd, low, high, below, above })
    }

    /// The value below which the share `p` of all draws lies, `p` in the open interval 0..1.
    pub(super) fn quantile(&self, p: f64) -> f64 {
        let lower = self.below[0] * (1.0 - p) + self.below[1] * p;
        let upper = self.above[0] * (1.0 - p) + self.above[1] * p;
        let standard = if lower < upper { lower_quantile(lower) } else { -lower_quantile(upper) };
        (self.mean + self.sd * standard).clamp(self.low, self.high)
    }
}

/// Probability that a standard normal number is below `z`, accurate in the lower tail.
fn probability_below(z: f64) -> f64 {
    0.5 * math::erfc(-z * FRAC_1_SQRT_2)
}

/// Inverse of [`probability_below`] for 0 < `p` ≤ 1/2.
///
/// Starts from the rational approximation 26.2.23 of Abramowitz and Stegun (error below 4.5e-4) and
/// takes two steps of Halley, each of which cubes the error.
fn lower_quantile(p: f64) -> f64 {
    let t = (-2.0 * math::ln(p)).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let below = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    let mut z = above / below - t;
    for _ in 0..2 {
        let off = (probability_below(z) - p) * (2.0 * PI).sqrt() * math::exp(0.5 * z * z);
        z -= off / (1.0 + 0.5 * z * off);
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles of the standard normal to 16 digits (Wichura, algorithm AS 241, and tables).
    #[test]
    fn quantiles_agree_with_tables() {
        let table = [
            (0.5, 0.0),
            (0.25, -0.674_489_750_196_081_7),
            (0.025, -1.959_963_984_540_054),
            (0.001, -3.090_232_306_167_813_5),
            (1e-20, -9.262_340_089_798_408),
        ];
        for (p, z) in table {
            // rounding of erfc and exp over the slope of the distribution
            assert!((lower_quantile(p) - z).abs() < 4e-15 * (1.0 + z.abs()), "{p}");
        }
    }

    /// The quantile inverts the probability everywhere, far tails included.
    #[test]
    fn quantile_inverts_probability() {
        for exponent in 1..300 {
            let p = 10_f64.powi(-exponent);
            let back = probability_below(lower_quantile(p));
            // d(ln p)/dz grows like |z|, z² = −2 ln p: rounding of z costs |z|² ε
            let bound = 1e-15 * (4.0 - 2.0 * p.ln());
            assert!((back / p - 1.0).abs() < bound, "{p}: {back}");
        }
    }

    /// Without bounds nothing is infinite, even at the ends of what `unit` gives.
    #[test]
    fn unbounded_draws_are_finite() {
        let whole = Truncated::new([0.0, 1.0], [f64::NEG_INFINITY, f64::INFINITY]).unwrap();
        let half = Truncated::new([0.0, 1.0], [0.0, f64::INFINITY]).unwrap();
        let end = 0.5_f64.powi(53);
        for p in [end, 0.5, 1.0 - end] {
            assert!(whole.quantile(p).is_finite() && half.quantile(p).is_finite());
        }
        // symmetric: the median of the half normal is the upper quartile
        assert!((half.quantile(0.5) - 0.674_489_750_196_081_7).abs() < 1e-15);
    }
}

//! Sums that do not depend on the order of their terms.

use serde::{Deserialize, Serialize};

/// The exact sum of any number of terms.
///
/// Rounding makes a plain sum depend on the order and the grouping of its terms: the parts of a run would not add up
/// to the whole one. Here nothing is rounded until [`value`](Self::value) is asked for. The parts never overlap
/// (Shewchuk 1997, Adaptive precision floating-point arithmetic, theorem 10); there are seldom more than three.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "WrittenSum", into = "WrittenSum")]
pub struct Sum(Vec<f64>);

/// A sum in a file: one number where that is exact.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum WrittenSum {
    Number(f64),
    Parts(Vec<f64>),
}

impl From<WrittenSum> for Sum {
    fn from(written: WrittenSum) -> Self {
        match written {
            WrittenSum::Number(number) => Self::from(number),
            WrittenSum::Parts(parts) => Self(parts),
        }
    }
}

impl From<Sum> for WrittenSum {
    fn from(sum: Sum) -> Self {
        if sum.0.len() > 1 { Self::Parts(sum.0) } else { Self::Number(sum.value()) }
    }
}

impl From<f64> for Sum {
    fn from(number: f64) -> Self {
        let mut sum = Self::default();
        sum.add(number);
        sum
    }
}

impl Sum {
    /// Adds one term; what is not a finite number is passed over.
    pub fn add(&mut self, term: f64) {
        if !term.is_finite() {
            return;
        }
        let mut high = term;
        self.0.retain_mut(|part| {
            let (sum, rest) = two_sum(high, *part);
            (high, *part) = (sum, rest);
            rest != 0.0
        });
        if high != 0.0 {
            self.0.push(high);
        }
    }

    /// Adds all terms of another sum.
    pub fn join(&mut self, other: &Self) {
        for part in &other.0 {
            self.add(*part);
        }
    }

    /// The exact sum, rounded once to the nearest double (ties to even).
    pub fn value(&self) -> f64 {
        let mut parts = self.0.iter().rev().copied();
        let (mut high, mut rest) = (parts.next().unwrap_or(0.0), 0.0);
        while rest == 0.0 {
            let Some(part) = parts.next() else { return high };
            (high, rest) = two_sum(high, part);
        }
        // Halfway between two doubles so far: the sign of what is smaller still decides.
        let beyond = parts.next().unwrap_or(0.0);
        let (up, error) = two_sum(high, 2.0 * rest);
        if error == 0.0 && rest * beyond.signum() > 0.0 && beyond != 0.0 { up } else { high }
    }

    /// The sum as one number, as it is shown.
    #[must_use]
    pub fn rounded(&self) -> Self {
        Self::from(self.value())
    }
}

/// The rounded sum of two numbers and what the rounding left over, exactly (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

#[cfg(test)]
mod tests {
    use super::Sum;
    use proptest::prelude::*;

    fn sum(terms: &[f64]) -> Sum {
        let mut sum = Sum::default();
        for term in terms {
            sum.add(*term);
        }
        sum
    }

    /// By hand: what a plain sum loses, and a tie that the smallest part decides.
    #[test]
    #[expect(clippy::float_cmp, reason = "the exact sum is a double")]
    fn nothing_is_lost() {
        assert_eq!(sum(&[1e16, 1.0, -1e16]).value(), 1.0);
        assert_eq!(sum(&[0.1; 10]).value(), 1.0);
        let half_ulp = f64::EPSILON / 2.0;
        assert_eq!(sum(&[1.0, half_ulp]).value(), 1.0); // tie to even
        assert_eq!(sum(&[1.0, half_ulp, 1e-300]).value(), 1.0 + f64::EPSILON);
        assert_eq!(sum(&[1.0, half_ulp, -1e-300]).value(), 1.0);
        assert_eq!(sum(&[]).value(), 0.0);
        assert_eq!(sum(&[f64::NAN, 2.0, f64::INFINITY]).value(), 2.0);
    }

    proptest! {
        /// Any order and any grouping give the same bits, and so do the file and the sum behind it.
        #[test]
        fn order_and_grouping_do_not_matter(
            mut terms in prop::collection::vec(-1e9..1e9_f64, 1..80),
            scales in prop::collection::vec(-40..40_i32, 80),
            cut in 0_usize..80,
        ) {
            for (term, scale) in terms.iter_mut().zip(&scales) {
                *term *= 2_f64.powi(*scale);
            }
            let whole = sum(&terms).value();
            let (left, right) = terms.split_at(cut.min(terms.len()));
            let mut joined = sum(left);
            let text = serde_json::to_string(&sum(right)).unwrap();
            joined.join(&serde_json::from_str(&text).unwrap());
            prop_assert_eq!(joined.value().to_bits(), whole.to_bits());
            terms.reverse();
            prop_assert_eq!(sum(&terms).value().to_bits(), whole.to_bits());
        }

        /// Exact against whole numbers: terms of at most 2^60 in units that a double may not hold together.
        #[test]
        fn the_value_is_the_nearest_double(terms in prop::collection::vec(-(1_i64 << 60)..(1_i64 << 60), 1..50)) {
            let doubles: Vec<f64> = terms.iter().map(|term| *term as f64).collect();
            let exact: i128 = doubles.iter().map(|term| *term as i128).sum();
            // the conversion of an integer rounds to nearest, ties to even
            prop_assert_eq!(sum(&doubles).value().to_bits(), (exact as f64).to_bits());
        }
    }
}

//! Sign changes of a cubic.

use super::PathFractions;
use crate::math;
use arrayvec::ArrayVec;

/// Bisections of an interval until its ends are neighbours in `f64`.
const HALVINGS: u32 = 60;

/// Parameters at which a cubic, given by its Bézier ordinates over 0..1, changes between > 0 and ≤
/// 0, rising.
///
/// The curve stays within the hull of its ordinates, so their signs alone decide most steps.
/// Between its extremes (roots of a quadratic) it is monotone, and bisection finds the root to the
/// last bit.
pub(super) fn roots(ordinates: [f64; 4]) -> PathFractions {
    let [b0, b1, b2, b3] = ordinates;
    if ordinates.iter().all(|b| *b > 0.0) || ordinates.iter().all(|b| *b <= 0.0) {
        return PathFractions::new();
    }
    // Bernstein form: Σ C(3, k) s^k (1 − s)^(3 − k) b_k
    let value = |s: f64| {
        let r = 1.0 - s;
        r * r * r * b0 + 3.0 * s * r * (r * b1 + s * b2) + s * s * s * b3
    };
    // the derivative is a quadratic with the ordinates c_k; its roots, computed without
    // cancellation, split the curve into monotone pieces
    let (c0, c1, c2) = (b1 - b0, b2 - b1, b3 - b2);
    let (a, b, c) = (c0 - 2.0 * c1 + c2, c1 - c0, c0);
    let root = (b * b - a * c).sqrt();
    let q = -(b + root.copysign(b));
    let mut ends: ArrayVec<f64, 4> =
        [q / a, c / q].into_iter().filter(|s| *s > 0.0 && *s < 1.0).collect();
    ends.extend([0.0, 1.0]);
    ends.sort_by(f64::total_cmp);
    // the ends of the step are not evaluated, so that the next step sees the same side
    let above = |s: f64| match s {
        0.0 => b0 > 0.0,
        1.0 => b3 > 0.0,
        _ => value(s) > 0.0,
    };
    let changes = ends.windows(2).filter(|pair| above(pair[0]) != above(pair[1]));
    let place = |pair: &[f64]| {
        let at_first = above(pair[0]);
        math::bisected([pair[0], pair[1]], HALVINGS, |s| above(s) == at_first)[1]
    };
    changes.map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::roots;

    /// Ordinates of (s − 1/4)(s − 1/2)(s − 3/4) and of s² (3 − 2 s) − 1/2: their zeros are known.
    #[test]
    fn zeros_of_cubics_are_found_to_the_last_bits() {
        let three = roots([-0.09375, 0.135_416_666_666_666_67, -0.135_416_666_666_666_67, 0.09375]);
        assert_eq!(three.len(), 3);
        for (found, zero) in three.iter().zip([0.25, 0.5, 0.75]) {
            // the ordinates are rounded; near the middle zero the curve rises by 1/16 per unit
            assert!((found - zero).abs() < 1e-14, "{found}");
        }
        let one = roots([-0.5, -0.5, 0.5, 0.5]);
        assert!(one.len() == 1 && (one[0] - 0.5).abs() < 1e-15, "{one:?}");
        assert!(roots([1.0, 0.2, 0.3, 1.0]).is_empty());
        // dips below and comes back: two changes
        assert_eq!(roots([0.1, -1.0, -1.0, 0.1]).len(), 2);
    }

    /// A step that ends on the line and the next one, which begins there, cross it once together.
    #[test]
    fn a_line_at_a_seam_is_crossed_once() {
        let first = roots([-1.0, -0.7, -0.3, 0.0]);
        let second = roots([0.0, 0.3, 0.7, 1.0]);
        assert_eq!(first.len() + second.len(), 1);
    }
}

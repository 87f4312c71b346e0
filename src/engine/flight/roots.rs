//! Downcrossings: the times at which a polynomial of degree two or four first falls through zero.
//!
//! The polynomials are squared distances less `R²`, so a downcrossing is a contact and an
//! upcrossing a separation.

use super::{fast_max, fast_min};

/// The two roots of `a t² + b t + c`, ascending, without cancellation; `None` if there are none.
///
/// A linear polynomial has its one root twice.
///
/// `q = −(b + sign(b) √(b² − 4ac))/2`, roots `q/a` and `c/q`: both terms of `q` have one sign, so
/// the small root keeps its digits.
#[inline]
pub(super) fn quadratic(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    if a == 0.0 {
        return (b != 0.0).then(|| (-c / b, -c / b));
    }
    // a negative discriminant: the height is never reached
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let (first, second) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    Some((fast_min(first, second), fast_max(first, second)))
}

/// First time in `t0..t1` at which the quartic `p[0] + p[1] t + … + p[4] t⁴` falls through zero and
/// which `accepts` accepts.
///
/// The signs of the Bernstein coefficients over the window decide most cases at once: without a
/// change of sign there is no crossing. Otherwise the window is bisected until there is one change,
/// which is then refined by safeguarded Newton steps.
///
/// A general root finder computes all four roots; here only the earliest downcrossing in a window
/// is wanted, and most windows hold none.
pub(super) fn first_downcrossing(
    p: &[f64; 5],
    (t0, t1): (f64, f64),
    accepts: &impl Fn(f64) -> bool,
) -> Option<f64> {
    // `accepts` gets the refined time: there the caller tests whether the foot still lies on the
    // edge
    let fall = |b: &[f64; 5], from: f64, to: f64| {
        Some(polish(p, refined_crossing(b, from, to), t0, t1)).filter(|&t| accepts(t))
    };
    downcrossing_between(&bernstein(p, t0, t1), (t0, t1), 0, &fall)
}

/// Bernstein coefficients of a quartic on `t0..t1`.
///
/// With `p(t0 + h s) = Σ c_j s^j` they are `b_k = Σ_j C(k, j)/C(4, j) c_j`. The curve lies in the
/// convex hull of its coefficients and has no more zeros than they have changes of sign (variation
/// diminishing).
fn bernstein(p: &[f64; 5], t0: f64, t1: f64) -> [f64; 5] {
    // Taylor shift to t0 (Horner), then scale to 0..1.
    let mut s = *p;
    for last in 0..4 {
        for k in (last..4).rev() {
            s[k] += s[k + 1] * t0;
        }
    }
    let h = t1 - t0;
    let c = [s[0], s[1] * h, s[2] * h * h, s[3] * h * h * h, s[4] * h * h * h * h];
    [
        c[0],
        c[0] + c[1] / 4.0,
        c[0] + c[1] / 2.0 + c[2] / 6.0,
        c[0] + c[1] * 0.75 + c[2] / 2.0 + c[3] / 4.0,
        c[0] + c[1] + c[2] + c[3] + c[4],
    ]
}

/// Bisections after which a window is as narrow as rounding.
const HALVINGS: u32 = 48;

/// The first downcrossing on a window with Bernstein coefficients `b`; `fall` refines one if it is
/// the only crossing. The left half is searched before the right, so the first one found is the
/// earliest.
fn downcrossing_between(
    b: &[f64; 5],
    (t0, t1): (f64, f64),
    depth: u32,
    fall: &impl Fn(&[f64; 5], f64, f64) -> Option<f64>,
) -> Option<f64> {
    // all of one sign: no zero. A coefficient of exactly 0 counts as negative, so that a contact at
    // the end of the window is not lost
    if b.iter().all(|&c| c > 0.0) || b.iter().all(|&c| c <= 0.0) {
        return None;
    }
    let changes = b.windows(2).filter(|w| (w[0] > 0.0) != (w[1] > 0.0)).count();
    // one change of sign, one zero: a downcrossing if the curve starts above
    if changes == 1 || depth == HALVINGS {
        return if b[0] > 0.0 && b[4] <= 0.0 { fall(b, t0, t1) } else { None };
    }
    let (left, right) = split_at_middle(b);
    let middle = 0.5 * (t0 + t1);
    // a downcrossing exactly at the middle gives the left half a last coefficient of 0
    downcrossing_between(&left, (t0, middle), depth + 1, fall)
        .or_else(|| downcrossing_between(&right, (middle, t1), depth + 1, fall))
}

/// De Casteljau subdivision at the middle. It takes means of neighbours only: no cancellation, so
/// 48 bisections lose nothing.
fn split_at_middle(b: &[f64; 5]) -> ([f64; 5], [f64; 5]) {
    let mut row = *b;
    let (mut left, mut right) = ([0.0; 5], [0.0; 5]);
    for k in 0..5 {
        left[k] = row[0];
        right[4 - k] = row[4 - k];
        for j in 0..4 - k {
            row[j] = 0.5 * (row[j] + row[j + 1]);
        }
    }
    (left, right)
}

/// The only crossing between Bernstein coefficients of different sign: Newton steps, with bisection
/// where a step would leave the bracket.
fn refined_crossing(b: &[f64; 5], t0: f64, t1: f64) -> f64 {
    // Power basis on 0..1 from forward differences Δᵏb: the coefficients are C(4, k) Δᵏb. What
    // rounding costs close to a double root is recovered by `polish`.
    let (d1, d2, d3) = (b[1] - b[0], b[2] - 2.0 * b[1] + b[0], b[3] - 3.0 * (b[2] - b[1]) - b[0]);
    let d4 = b[4] - 4.0 * (b[3] + b[1]) + 6.0 * b[2] + b[0];
    let c = [b[0], 4.0 * d1, 6.0 * d2, 4.0 * d3, d4];
    let (mut lo, mut hi) = (0.0, 1.0);
    let mut s = b[0] / (b[0] - b[4]);
    // f > 0 before the crossing and < 0 after it: the bracket lo … hi keeps that
    for _ in 0..HALVINGS {
        let f = c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * c[4])));
        let slope = c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * (4.0 * c[4])));
        let step = f / slope;
        if step.abs() < 1e-14 {
            return t0 + (t1 - t0) * (s - step);
        }
        if f > 0.0 {
            lo = s;
        } else {
            hi = s;
        }
        let next = s - step;
        s = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
    }
    t0 + (t1 - t0) * s
}

/// Last bits of a root that are rounding (2⁻⁴⁴ of it): Newton's result in them depends on the start
/// value.
const ROUNDING: u64 = 0xff;

/// Two Newton steps on the polynomial itself remove the rounding of the window. The last bits are
/// then cleared, towards an earlier time: the root must not depend on which other features were
/// tested before.
fn polish(p: &[f64; 5], t: f64, t0: f64, t1: f64) -> f64 {
    let mut best = t;
    for _ in 0..2 {
        let f = p[0] + best * (p[1] + best * (p[2] + best * (p[3] + best * p[4])));
        let slope = p[1] + best * (2.0 * p[2] + best * (3.0 * p[3] + best * 4.0 * p[4]));
        if slope < 0.0 {
            best = (best - f / slope).clamp(t0, t1);
        }
    }
    f64::from_bits(best.to_bits() & !ROUNDING).clamp(t0, t1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_quadratic_keeps_its_small_root() {
        let (first, second) = quadratic(1.0, -1e8, 1.0).unwrap();
        assert!((first * 1e8 - 1.0).abs() < 1e-15 && (second / 1e8 - 1.0).abs() < 1e-15);
    }

    proptest! {
        /// A quartic with known real roots falls first at the first root with a negative slope, as
        /// exactly as its coefficients know it: their rounding moves a root by about `ε Σ|p_k| t^k
        /// / |p'|`, far where roots are close.
        #[test]
        fn the_first_fall_is_found(mut r in prop::array::uniform4(0.01f64..3.0), sign in prop::bool::ANY) {
            r.sort_by(f64::total_cmp);
            prop_assume!(r.windows(2).all(|w| w[1] - w[0] > 1e-3));
            let s = if sign { 1.0 } else { -1.0 };
            let mut p = [s, 0.0, 0.0, 0.0, 0.0];
            for root in r {
                for k in (0..5).rev() {
                    p[k] = if k == 0 { 0.0 } else { p[k - 1] } - root * p[k];
                }
            }
            let k = usize::from(!sign);
            for (root, from) in [(r[k], 0.0), (r[k + 2], r[k] + 5e-4)] {
                let found = first_downcrossing(&p, (0.0, 3.1), &|t| t > from).unwrap();
                let size = p.iter().rev().fold(0.0, |sum, c| sum * root + c.abs());
                let others = r.iter().map(|other| (root - other).abs()).filter(|off| *off > 0.0);
                let known = 100.0 * f64::EPSILON * size / others.product::<f64>() + 256.0 * f64::EPSILON * root;
                prop_assert!((found - root).abs() < known, "{found} {root} {known}");
            }
            prop_assert!(first_downcrossing(&p, (r[3] + 1e-3, 4.0), &|_| true).is_none());
        }
    }
}

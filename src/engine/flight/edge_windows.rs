//! Which edges and corners of a triangle a ball may touch during a time window, from two
//! coordinates.
//!
//! With `p₁ = e₁·(c − a)` and `p₂ = e₂·(c − a)` everything in the triangle's plane is linear in
//! `(p₁, p₂)`, and both are quadratic in time: their range over a window costs a few products and
//! avoids most of the quartics.
//!
//! ```text
//! d11 = e1·e1, d12 = e1·e2, d22 = e2·e2,   det = d11 d22 − d12² = (2 area)²
//! along e1: p₁ in 0 … d11               inside of it: d11 p₂ − d12 p₁ ≥ 0
//! along e2: p₂ in 0 … d22               inside of it: d22 p₁ − d12 p₂ ≥ 0
//! third:    p₂ − p₁ + d11 − d12 in 0 … |e2 − e1|²   inside: det − (d22 − d12) p₁ − (d11 − d12) p₂ ≥ 0
//! ```
//!
//! These are the barycentric coordinates of the foot, scaled so that no division is needed.

use super::{Parabola, fast_max, fast_min};
use crate::terrain::faces::Face;

/// A foot on the wrong side by this much still counts (–, relative to R): rounding.
const SLACK: f64 = 1e-6;

/// The two coordinates at the ends of a window, and their sag between. All in m²: scalar products
/// of two lengths.
pub(super) struct EdgeWindows {
    /// `(p₁, p₂)` at the start of the window …
    from: (f64, f64),
    /// … and at its end.
    to: (f64, f64),
    /// Second coefficients times a quarter of the window squared.
    sag: (f64, f64),
    /// Gram matrix of the sides `e1`, `e2` (m²).
    d11: f64,
    d12: f64,
    d22: f64,
    radius: f64,
}

impl EdgeWindows {
    pub(super) fn new(face: &Face, flight: &Parabola, (ta, tb): (f64, f64)) -> Self {
        // a is the corner that both sides start at
        let at = |t: f64| {
            let to = flight.centre(t) - face.a;
            (face.e1.dot(&to), face.e2.dot(&to))
        };
        // p(t) has the second coefficient −g e_z/2; over a window of length h it sags below its
        // chord by a quarter of that times h²
        let quarter = -0.125 * flight.gravity * (tb - ta) * (tb - ta);
        Self {
            from: at(ta),
            to: at(tb),
            sag: (face.e1.z * quarter, face.e2.z * quarter),
            d11: face.e1.norm_squared(),
            d12: face.e1.dot(&face.e2),
            d22: face.e2.norm_squared(),
            radius: flight.radius,
        }
    }

    /// Smallest and largest `α p₁ + β p₂` over the window.
    ///
    /// A bound, not the exact range: the chord's ends, extended by the sag on the side to which the
    /// parabola bulges.
    #[inline]
    fn range(&self, alpha: f64, beta: f64) -> (f64, f64) {
        let start = alpha * self.from.0 + beta * self.from.1;
        let end = alpha * self.to.0 + beta * self.to.1;
        let sag = alpha * self.sag.0 + beta * self.sag.1;
        (fast_min(start, end) - fast_max(sag, 0.0), fast_max(start, end) - fast_min(sag, 0.0))
    }

    /// Whether the ball may touch edge `k`: the foot between its ends, outside of the triangle and
    /// at most `lateral_m` (m) away.
    pub(super) fn edge(&self, k: usize, lateral_m: f64) -> bool {
        let (d11, d12, d22) = (self.d11, self.d12, self.d22);
        let det = d11 * d22 - d12 * d12;
        let d_third = d11 + d22 - 2.0 * d12;
        // Range along the edge, its squared length, and range of the inside coordinate, which grows
        // with √(length² det) per metre towards the inside. The last two swap ends where that
        // coordinate has a minus.
        let ((low, high), length2, (nearest, furthest)) = match k {
            0 => (self.range(1.0, 0.0), d11, self.range(-d12, d11)),
            1 => {
                let (low, high) = self.range(-1.0, 1.0);
                let (lowest, highest) = self.range(d22 - d12, d11 - d12);
                ((low + d11 - d12, high + d11 - d12), d_third, (det - highest, det - lowest))
            }
            _ => (self.range(0.0, 1.0), d22, self.range(d22, -d12)),
        };
        // a foot x metres inside has the inside coordinate x √(length² det)
        let per_metre = (length2 * det).sqrt();
        let along = SLACK * self.radius * length2.sqrt();
        high >= -along
            && low <= length2 + along
            && nearest <= SLACK * self.radius * per_metre
            && furthest >= -(lateral_m + SLACK * self.radius) * per_metre
    }

    /// Whether the ball may touch corner `k`: behind both sides that start there.
    pub(super) fn corner(&self, k: usize) -> bool {
        let (d11, d12, d22) = (self.d11, self.d12, self.d22);
        let (first, second) = match k {
            // at corner 0: e1·(c − a) ≤ 0 and e2·(c − a) ≤ 0; likewise at the others with their own
            // two sides
            0 => (self.range(1.0, 0.0).0, self.range(0.0, 1.0).0),
            1 => (d11 - self.range(1.0, 0.0).1, self.range(-1.0, 1.0).0 + d11 - d12),
            _ => (d22 - self.range(0.0, 1.0).1, self.range(1.0, -1.0).0 + d22 - d12),
        };
        let slack = SLACK * self.radius * (d11 + d22).sqrt();
        first <= slack && second <= slack
    }
}

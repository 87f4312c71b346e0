//! Nearest points of triangles and segments.
//!
//! Each query minimises a convex quadratic over a convex set. The minimum is unique and needs no
//! iteration: the space is divided into the Voronoi regions of the parts, and the signs of scalar
//! products identify the region.

use crate::rock::Vec3;

/// A segment from `a` (m) along a unit vector for its length (m).
#[derive(Debug, Clone, Copy)]
pub struct Segment {
    /// Its first end (m).
    pub a: Vec3,
    /// Unit vector towards the other end.
    pub along: Vec3,
    /// Its length (m).
    pub length: f64,
}

impl Segment {
    /// The segment between two points (m).
    pub fn between([a, b]: [Vec3; 2]) -> Self {
        let length = (b - a).norm();
        Self { a, along: (b - a) / length, length }
    }

    /// The vector from its first end to the other (m).
    #[inline]
    pub fn vector(&self) -> Vec3 {
        self.along * self.length
    }

    /// Its nearest point to `p` (m).
    #[inline]
    pub fn nearest_to(&self, p: &Vec3) -> Vec3 {
        self.a + self.along * self.along.dot(&(p - self.a)).clamp(0.0, self.length)
    }
}

/// The part of a triangle that holds its nearest point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrianglePart {
    /// Inside.
    Face,
    /// On side `k`, which runs from corner `k` to the next.
    Side(usize),
    /// At corner `k`.
    Corner(usize),
}

/// The point of a triangle closest to `p` (Ericson, Real-Time Collision Detection, 5.1.5: by
/// Voronoi regions). Cost: at most six scalar products and one division; no square root.
pub fn closest_on(corners: &[Vec3; 3], p: &Vec3) -> Vec3 {
    closest_part(corners, p).0
}

/// The closest point, with the part of the triangle on which it lies.
///
/// It needs neither unit vectors nor a normal, so triangles of any size will do. For a degenerate
/// triangle the point lies on its sides or corners.
pub fn closest_part(&[a, b, c]: &[Vec3; 3], p: &Vec3) -> (Vec3, TrianglePart) {
    // d1 … d6 are projections on the sides, times the length of the side: p projects before the
    // start of a side, within it, or beyond its end
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    // region of a corner: p lies behind the corner along both sides that start there
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, TrianglePart::Corner(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, TrianglePart::Corner(1));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, TrianglePart::Corner(2));
    }
    // va, vb, vc are the barycentric coordinates of the foot times (2 area)², by Lagrange's
    // identity from the projections alone: one that is negative or 0 puts the foot beyond that side
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), TrianglePart::Side(0));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), TrianglePart::Side(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return (b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), TrianglePart::Side(1));
    }
    // inside: a + v ab + w ac with the coordinates scaled to sum 1
    (a + (ab * vb + ac * vc) / (va + vb + vc), TrianglePart::Face)
}

/// Square of the sine of the angle below which segments count as parallel (–): the distance is
/// exact up to that angle times their length.
const PARALLEL: f64 = 1e-15;

/// Square of the least distance between two segments, each from its first point along its second
/// (Ericson, Real-Time Collision Detection, 5.1.9). A segment may be a point.
///
/// Minimises `|r + s d − t e|²` over the unit square of `(s, t)`, with `r = p − q`:
///
/// ```text
/// a s − b t = −c,   f t − b s = g      a = d·d,  b = d·e,  c = d·r,  f = e·e,  g = e·r
/// ```
///
pub fn segments_distance2((p, d): (&Vec3, &Vec3), (q, e): (&Vec3, &Vec3)) -> f64 {
    // a degenerate segment has its parameter at 0, without a division by its length
    let r = p - q;
    let (a, b, c, f, g) = (d.norm_squared(), d.dot(e), d.dot(&r), e.norm_squared(), e.dot(&r));
    let onto =
        |x: f64, length2: f64| if length2 > 0.0 { (x / length2).clamp(0.0, 1.0) } else { 0.0 };
    // a f − b² = |d × e|² is 0 for parallel segments: any s is a minimum then, and 0 is taken
    let across = a * f - b * b;
    let s =
        if across > PARALLEL * a * f { ((b * g - c * f) / across).clamp(0.0, 1.0) } else { 0.0 };
    // The unconstrained minimum may lie outside the unit square. With s clamped, take the best t;
    // with that t clamped, the best s; then the best t for that s. By convexity this is the minimum
    // over the square; no search is needed.
    let t = onto(b * s + g, f);
    let s = onto(b * t - c, a);
    let t = onto(b * s + g, f);
    (r + d * s - e * t).norm_squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No pair of points of the two segments is nearer, and some pair is as near: tested on a fine
    /// grid of both.
    #[test]
    fn the_distance_of_segments_is_the_least() {
        let mut state = 7u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for k in 0..2000 {
            let mut vector = || Vec3::new(uniform(), uniform(), uniform());
            let (p, d, q, mut e) = (vector(), vector(), vector(), vector());
            match k % 4 {
                1 => e = d * 0.7,
                2 => e = Vec3::zeros(),
                3 => e = d * -0.3 + Vec3::new(1e-9, 0.0, 0.0),
                _ => (),
            }
            let found = segments_distance2((&p, &d), (&q, &e)).sqrt();
            let share = |k: usize| k as f64 / 60.0;
            let least = (0..=60)
                .flat_map(|i| (0..=60).map(move |j| (share(i), share(j))))
                .map(|(s, t)| (p + d * s - q - e * t).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(found <= least + 1e-7, "{found} {least}");
            assert!(found >= least - (d.norm() + e.norm()) / 60.0, "{found} {least}");
        }
    }
}

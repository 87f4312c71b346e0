//! The nearest point of a triangle.

use crate::rock::Vec3;

/// The part of a triangle on which its nearest point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Inside.
    Face,
    /// On side `k`, which runs from corner `k` to the next.
    Side(usize),
    /// At corner `k`.
    Corner(usize),
}

/// The point of a triangle closest to `p` (Ericson, Real-Time Collision Detection, 5.1.5: by Voronoi regions).
pub fn closest_on(corners: &[Vec3; 3], p: &Vec3) -> Vec3 {
    closest_part(corners, p).0
}

/// The same, with the part of the triangle on which it lies.
pub fn closest_part(&[a, b, c]: &[Vec3; 3], p: &Vec3) -> (Vec3, Part) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Part::Corner(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Part::Corner(1));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Part::Corner(2));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), Part::Side(0));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), Part::Side(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return (b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), Part::Side(1));
    }
    (a + (ab * vb + ac * vc) / (va + vb + vc), Part::Face)
}

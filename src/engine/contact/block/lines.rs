//! Nearest points of lines and segments.

use crate::rock::Vec3;

/// Edges closer to parallel than this have their nearest points at their ends (–, squared sine).
const PARALLEL: f64 = 1e-12;

/// Nearest points of two infinite lines: the parameter along the first direction (in units of its
/// vector) and along the second, a unit vector (m). `None` if they are parallel.
pub(super) fn crossing((p, e): (Vec3, Vec3), (a, f): (Vec3, Vec3)) -> Option<(f64, f64)> {
    let w = p - a;
    let (ee, ef, ew, fw) = (e.norm_squared(), e.dot(&f), e.dot(&w), f.dot(&w));
    let across = ee - ef * ef;
    if across <= PARALLEL * ee {
        return None;
    }
    Some(((ef * fw - ew) / across, (ee * fw - ef * ew) / across))
}

/// The point of a segment nearest to `p`, and whether it is an end of the segment.
pub(super) fn foot_or_end([a, b]: [Vec3; 2], p: &Vec3) -> (Vec3, bool) {
    let side = b - a;
    let s = (p - a).dot(&side) / side.norm_squared();
    (a + side * s.clamp(0.0, 1.0), s <= 0.0 || s >= 1.0)
}

/// The point of a segment nearest to `p`.
pub(super) fn foot_between(ends: [Vec3; 2], p: &Vec3) -> Vec3 {
    foot_or_end(ends, p).0
}

/// Nearest points of two segments that do not cross between their ends: one point on each, at least
/// one of them an end.
pub(super) fn nearest_at_ends(first: [Vec3; 2], second: [Vec3; 2]) -> [Vec3; 2] {
    let from = first.map(|p| [p, foot_between(second, &p)]);
    let to = second.map(|p| [foot_between(first, &p), p]);
    let nearer = |near: [Vec3; 2], next: [Vec3; 2]| {
        let away2 = |[p, q]: [Vec3; 2]| (p - q).norm_squared();
        if away2(next) < away2(near) { next } else { near }
    };
    [from[1], to[0], to[1]].into_iter().fold(from[0], nearer)
}

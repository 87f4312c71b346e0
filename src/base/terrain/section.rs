//! The slope cut by the vertical plane over a straight way in plan view: the ground below a flight, seen from the side.

use super::Terrain;
use super::faces::Face;

/// A place this far beside a triangle still lies on it (–, relative to its size): rounding.
const ON_RIM: f64 = 1e-11;

/// What a triangle has of the section: a straight line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SectionLine {
    /// Shares of the way (–, 0..1) at which it comes over the triangle and leaves it.
    pub shares: [f64; 2],
    /// Heights of the triangle there (m, local).
    pub heights_m: [f64; 2],
}

impl Terrain {
    /// Calls `pass` with the line of every triangle of the slope under the way between two places in plan view, as far as
    /// it lies in boxes that begin not above `under_m` (m, local). Trees are no ground, nor are upright triangles.
    ///
    /// Barycentric coordinates are linear along the way, so each side of a triangle gives one end of its line.
    pub fn section(&self, ends: [[f64; 2]; 2], under_m: f64, mut pass: impl FnMut(SectionLine)) {
        self.index.over_way(ends, under_m, |start, count| {
            for t in start..start + count {
                let line = line_over(&self.face(t), ends);
                if let Some(line) = line.filter(|_| !self.is_tree(t)) {
                    pass(line);
                }
            }
        });
    }
}

/// The line of one triangle; none if the way passes beside it.
#[inline]
fn line_over(face: &Face, [from, to]: [[f64; 2]; 2]) -> Option<SectionLine> {
    let [start, end] = [from, to].map(|[x, y]| PlanShares::at(face, x, y));
    let slack = -ON_RIM * start.whole;
    let mut shares = [0.0_f64, 1.0];
    for (first, last) in [(start.u, end.u), (start.v, end.v), (start.third(), end.third())] {
        match (first >= slack, last >= slack) {
            (true, true) => {}
            (false, false) => return None,
            // comes over the triangle, or leaves it, where the coordinate passes the slack
            (is_on, _) => {
                let share = (first - slack) / (first - last);
                if is_on {
                    shares[1] = shares[1].min(share);
                } else {
                    shares[0] = shares[0].max(share);
                }
            }
        }
    }
    if start.whole == 0.0 || shares[0] > shares[1] {
        return None;
    }
    // of an almost upright triangle the height is hardly known, but that it lies between its corners
    let z = [face.a.z, face.a.z + face.e1.z, face.a.z + face.e2.z];
    let low = z[0].min(z[1]).min(z[2]);
    let high = z[0].max(z[1]).max(z[2]);
    let heights_m = shares.map(|s| {
        let between = |a: f64, b: f64| a + s * (b - a);
        let (u, v) = (between(start.u, end.u), between(start.v, end.v));
        (face.a.z + (u * face.e1.z + v * face.e2.z) / start.whole).max(low).min(high)
    });
    Some(SectionLine { shares, heights_m })
}

/// Barycentric coordinates of a place over a triangle in plan view, times twice its area there (m²).
#[derive(Clone, Copy)]
struct PlanShares {
    /// Of the second corner.
    u: f64,
    /// Of the third.
    v: f64,
    /// Their sum with that of the first: twice the area, 0 of an upright triangle.
    whole: f64,
}

impl PlanShares {
    #[inline]
    fn at(face: &Face, x: f64, y: f64) -> Self {
        let (dx, dy) = (x - face.a.x, y - face.a.y);
        let det = face.e1.x * face.e2.y - face.e1.y * face.e2.x;
        let (u, v) = (dx * face.e2.y - dy * face.e2.x, face.e1.x * dy - face.e1.y * dx);
        if det < 0.0 { Self { u: -u, v: -v, whole: -det } } else { Self { u, v, whole: det } }
    }

    /// Of the first corner.
    #[inline]
    fn third(&self) -> f64 {
        self.whole - self.u - self.v
    }
}

/// Height at which the vertical through (x, y) meets a triangle, −∞ if it does not (m).
pub(super) fn height_of(face: &Face, x: f64, y: f64) -> f64 {
    let at = PlanShares::at(face, x, y);
    let slack = -ON_RIM * at.whole;
    if at.whole > 0.0 && at.u >= slack && at.v >= slack && at.third() >= slack {
        face.a.z + (at.u * face.e1.z + at.v * face.e2.z) / at.whole
    } else {
        f64::NEG_INFINITY
    }
}

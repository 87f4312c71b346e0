//! Triangles in the plane of one of them: what others leave of it.

use crate::rock::Vec3;

/// A point in the plane of a triangle (m).
type PlanePoint = [f64; 2];

/// Cosine of the angle between two planes from which on they are no sheets on each other (–).
const ASTRAY: f64 = 0.9;

/// Largest share of a triangle that may be left where it counts as covered (–): of a needle narrower than the tolerance more is left.
const LEFT_SHARE: f64 = 0.01;

/// The plane of a triangle, and the triangle in it.
#[derive(Debug)]
pub(super) struct PlaneOutline {
    origin: Vec3,
    along: Vec3,
    across: Vec3,
    n: Vec3,
    corners: [PlanePoint; 3],
}

/// Another triangle seen from there: its outline against the clock, and its height over the plane, `base + slope · point`.
#[derive(Debug)]
pub(super) struct FlatCover {
    corners: [PlanePoint; 3],
    base: f64,
    slope: PlanePoint,
}

impl PlaneOutline {
    pub(super) fn of([a, b, c]: &[Vec3; 3]) -> Self {
        let along = (b - a).normalize();
        let n = (b - a).cross(&(c - a)).normalize();
        let across = n.cross(&along);
        let corners = [*a, *b, *c].map(|p| [along.dot(&(p - a)), across.dot(&(p - a))]);
        Self { origin: *a, along, across, n, corners }
    }

    pub(super) fn area_m2(&self) -> f64 {
        area_m2(&self.corners)
    }

    /// Another triangle in this plane; none where it stands askew.
    pub(super) fn flattened(&self, other: &[Vec3; 3]) -> Option<FlatCover> {
        let normal = (other[1] - other[0]).cross(&(other[2] - other[0])).normalize();
        let upright = normal.dot(&self.n);
        if upright.abs() < ASTRAY {
            return None;
        }
        let place = |p: &Vec3| {
            let to = p - self.origin;
            [self.along.dot(&to), self.across.dot(&to)]
        };
        let [a, b, c] = [0, 1, 2].map(|k| place(&other[k]));
        let corners = if upright > 0.0 { [a, b, c] } else { [a, c, b] };
        let base = normal.dot(&(other[0] - self.origin)) / upright;
        let slope = [&self.along, &self.across].map(|axis| -normal.dot(axis) / upright);
        Some(FlatCover { corners, base, slope })
    }
}

impl FlatCover {
    pub(super) fn area_m2(&self) -> f64 {
        area_m2(&self.corners)
    }

    /// How much of a triangle it covers within the reach (m).
    pub(super) fn area_over_m2(&self, outline: &PlaneOutline, reach_m: f64) -> f64 {
        let mut beside = Vec::new();
        let within = self.take_from(outline.corners.to_vec(), &mut beside);
        if self.is_near(&within, reach_m) { area_m2(&within) } else { 0.0 }
    }

    /// Cuts its outline out of a convex piece: returns what is inside, and hands out what lies beside.
    fn take_from(
        &self,
        piece: Vec<PlanePoint>,
        beside: &mut Vec<Vec<PlanePoint>>,
    ) -> Vec<PlanePoint> {
        let mut inside = piece;
        for k in 0..3 {
            let (within, beyond) = cut(&inside, self.corners[k], self.corners[(k + 1) % 3]);
            if beyond.len() > 2 {
                beside.push(beyond);
            }
            inside = within;
        }
        inside
    }

    /// Whether a piece lies within the reach (m) of it.
    fn is_near(&self, piece: &[PlanePoint], reach_m: f64) -> bool {
        let height = |p: &PlanePoint| self.base + self.slope[0] * p[0] + self.slope[1] * p[1];
        piece.iter().all(|p| height(p).abs() <= reach_m)
    }
}

/// Whether each point of a triangle lies within the reach (m) of one of the `covers`.
///
/// A border along that of a cover may be left as a strip narrower than the reach.
pub(super) fn lies_beneath(
    triangle: &[Vec3; 3],
    reach_m: f64,
    covers: impl Iterator<Item = [Vec3; 3]>,
) -> bool {
    let outline = PlaneOutline::of(triangle);
    let mut left = vec![outline.corners.to_vec()];
    let mut beside = Vec::new();
    for cover in covers.filter_map(|cover| outline.flattened(&cover)) {
        for piece in std::mem::take(&mut left) {
            beside.clear();
            let within = cover.take_from(piece.clone(), &mut beside);
            // apart, or too far above: the piece stays whole
            if within.len() > 2 && cover.is_near(&within, reach_m) {
                left.append(&mut beside);
            } else {
                left.push(piece);
            }
        }
    }
    let [a, b, c] = triangle;
    let around_m = (b - a).norm() + (c - b).norm() + (a - c).norm();
    let left_m2: f64 = left.iter().map(|piece| area_m2(piece)).sum();
    left_m2 <= (reach_m * around_m).min(LEFT_SHARE * outline.area_m2())
}

/// The parts of a convex piece on the left of a line and on its right.
fn cut(
    piece: &[PlanePoint],
    from: PlanePoint,
    to: PlanePoint,
) -> (Vec<PlanePoint>, Vec<PlanePoint>) {
    let (mut left, mut right) = (Vec::with_capacity(piece.len() + 1), Vec::new());
    let off =
        |p: PlanePoint| (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0]);
    for (k, &p) in piece.iter().enumerate() {
        let next = piece[(k + 1) % piece.len()];
        let (here, there) = (off(p), off(next));
        if here >= 0.0 {
            left.push(p);
        }
        if here <= 0.0 {
            right.push(p);
        }
        if here * there < 0.0 {
            let share = here / (here - there);
            let crossing = [0, 1].map(|axis| p[axis] + share * (next[axis] - p[axis]));
            left.push(crossing);
            right.push(crossing);
        }
    }
    (left, right)
}

/// Area of a convex piece (m²).
fn area_m2(piece: &[PlanePoint]) -> f64 {
    let Some(&[x, y]) = piece.first() else { return 0.0 };
    let across =
        |two: &[PlanePoint]| (two[0][0] - x) * (two[1][1] - y) - (two[1][0] - x) * (two[0][1] - y);
    0.5 * piece.windows(2).map(across).sum::<f64>().abs()
}

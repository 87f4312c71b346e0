//! Crossings of evaluation lines: exact on the parabola of a flight and on the cubic of a step.

mod roots;

use super::rock_geometry::{RockFlight, RockGeometry, RockInstant};
use crate::math;
use crate::plan::{EvaluationLine, Footprint, LinePiece};
use crate::rock::{Motion, Vec3};
use crate::scene::Corner;
use crate::terrain::Terrain;
use arrayvec::ArrayVec;
use roots::roots;

/// A rock's first crossing of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Which line, in the order of the scene.
    pub line: usize,
    /// Motion at the crossing (local coordinates).
    pub motion: Motion,
    /// Rotational energy (J).
    pub rotational_j: f64,
    /// Vertical distance from the ground below to the highest point of a block (m); none for a
    /// sphere, where the diameter gives it.
    pub top_m: Option<f64>,
    /// Position along the line (m), from its first corner.
    pub along_m: f64,
    /// Vertical distance from the ground below to the lowest point of the rock (m); NaN where there
    /// is no ground.
    pub height_m: f64,
    /// Distance from the slope to the nearest point of the rock along the slope's normal (m), the
    /// slope taken as the plane of the triangle below; NaN where there is no ground.
    pub height_normal_m: f64,
    /// Number of crossings of this line by this rock in all, 1 or more.
    pub times: u32,
}

impl Crossing {
    /// Slope of the path against the horizontal (degrees), positive downwards, −90..90.
    pub fn descent_deg(&self) -> f64 {
        let v = self.motion.velocity_m_s;
        math::atan2(-v.z, math::hypot(v.x, v.y)).to_degrees()
    }
}

/// The crossings of one rock so far.
///
/// Only the first crossing of a line is kept in full: statistics at a line ask how a rock arrives
/// there. All are counted.
#[derive(Debug)]
pub(super) struct Crossings<'a> {
    terrain: &'a Terrain,
    geometry: RockGeometry<'a>,
    lines: &'a [EvaluationLine],
    found: Vec<Crossing>,
    /// Work space: the intersections of a path with one line.
    intersections: Vec<LineIntersection>,
    /// South-western and north-eastern corner of a box in plan view that contains no line and no
    /// object: most steps are short and far from all of them. None where no such box is known.
    clear_box: Option<[Corner; 2]>,
    /// Start of the rock in plan view, and whether the rock has left it.
    start_m: Corner,
    has_left: bool,
}

/// State of the crossings at an instant, to restore.
#[derive(Debug)]
pub(super) struct CrossingsMark {
    found: Vec<Crossing>,
    has_left: bool,
}

/// Radius around its start within which a rock counts as not having left it (m): it does not cross
/// a line on which it stands, on whichever side rounding puts it.
const START_RADIUS_M: f64 = 1e-6;

/// Fraction of the free distance to the next line that is used (–): rounding must not make it too
/// large.
const CLEARANCE_FACTOR: f64 = 0.999;

impl<'a> Crossings<'a> {
    /// No crossings yet, for a rock that starts at `start`.
    pub(super) fn of(
        terrain: &'a Terrain,
        geometry: RockGeometry<'a>,
        lines: &'a [EvaluationLine],
        start: &Vec3,
    ) -> Self {
        let (found, intersections, start_m) = (Vec::new(), Vec::new(), plan_view(start));
        Self {
            terrain,
            geometry,
            lines,
            found,
            intersections,
            clear_box: None,
            start_m,
            has_left: false,
        }
    }

    /// The present state, to restore later.
    pub(super) fn mark(&self) -> CrossingsMark {
        CrossingsMark { found: self.found.clone(), has_left: self.has_left }
    }

    /// Restores an earlier state.
    pub(super) fn restore(&mut self, mark: &CrossingsMark) {
        // an object whose crossing is discarded may be met again
        self.clear_box = self.clear_box.filter(|_| self.found.len() == mark.found.len());
        self.found.clear();
        self.found.extend_from_slice(&mark.found);
        self.has_left = mark.has_left;
    }

    /// Whether a position is at the start, which the rock has not left so far.
    fn is_at_start(&self, [x, y]: Corner) -> bool {
        !self.has_left && math::hypot(x - self.start_m[0], y - self.start_m[1]) <= START_RADIUS_M
    }

    /// The crossings in the order of lines.
    pub(super) fn into_found(mut self) -> Vec<Crossing> {
        self.found.sort_by_key(|crossing| crossing.line);
        self.found
    }

    /// Records the lines that a flight crosses. In plan view it is straight and uniform: the time
    /// follows from one division.
    pub(super) fn record_flight(&mut self, flight: &RockFlight) {
        if self.lines.is_empty() {
            return;
        }
        // in plan view a parabola is a straight line: two signed distances to the line give the
        // fraction
        let [a, b] = [0.0, flight.duration_s].map(|t| plan_view(&flight.path.centre(t)));
        self.find_crossings(
            [a, a, b, b],
            |piece| {
                // signed distances to the infinite line through the piece, positive on its left
                let (start, end) = (piece.side_m(a), piece.side_m(b));
                // the path is straight in plan view: its fraction start/(start − end) lies before
                // the line
                let crosses = (start > 0.0) != (end > 0.0);
                crosses.then(|| start / (start - end)).into_iter().collect()
            },
            |s| flight.at(s * flight.duration_s),
        );
    }

    /// Records the lines that a step in contact crosses.
    pub(super) fn record_step(&mut self, ends: [&RockInstant; 2]) {
        if self.lines.is_empty() {
            return;
        }
        let [from, to] = ends.map(|end| &end.motion);
        // the Hermite cubic of the step as a Bézier curve: the path lies within the hull of these
        // four points
        let third = (to.time_s - from.time_s) / 3.0;
        let hull = [
            from.position_m,
            from.position_m + from.velocity_m_s * third,
            to.position_m - to.velocity_m_s * third,
            to.position_m,
        ];
        let hull = hull.map(|point| plan_view(&point));
        self.find_crossings(
            hull,
            |piece| roots(hull.map(|point| piece.side_m(point))),
            |s| RockInstant::interpolated(ends, s),
        );
    }

    /// Finds the crossings of all lines near the path inside `hull`. `when` gives the fractions of
    /// the path at which it meets the infinite line through a piece, rising; `at` gives the motion
    /// there.
    fn find_crossings(
        &mut self,
        hull: [Corner; 4],
        when: impl Fn(&LinePiece) -> PathFractions,
        at: impl Fn(f64) -> RockInstant,
    ) {
        // box of the path in plan view: most steps end here, without a test of any line
        let low = [0, 1].map(|k| hull.iter().fold(f64::INFINITY, |low, p| low.min(p[k])));
        let high = [0, 1].map(|k| hull.iter().fold(f64::NEG_INFINITY, |high, p| high.max(p[k])));
        let is_inside = |[west_south, east_north]: &[Corner; 2]| {
            (0..2).all(|k| low[k] >= west_south[k] && high[k] <= east_north[k])
        };
        if self.clear_box.as_ref().is_some_and(is_inside) {
            return;
        }
        for (line, evaluation_line) in self.lines.iter().enumerate() {
            if let Some(footprint) = evaluation_line.footprint {
                let rim_m = self.geometry.plan_radius_m();
                let extent = |k: usize| [low[k] - rim_m, high[k] + rim_m];
                // an object is touched by the rim of the rock, not by its centre
                let ([west, east], [south, north]) = (extent(0), extent(1));
                let is_recorded = self.found.iter().any(|crossing| crossing.line == line);
                if is_recorded || !evaluation_line.is_near([west, south], [east, north]) {
                    continue;
                }
                if let Some((s, along_m)) =
                    first_touch_of_object((evaluation_line, footprint), rim_m, hull, &at)
                {
                    self.record(line, (at(s), along_m), 1);
                }
                continue;
            }
            if !evaluation_line.is_near(low, high) {
                continue;
            }
            let place = |s: f64| plan_view(&at(s).motion.position_m);
            intersect_line(evaluation_line, &when, place, &mut self.intersections);
            if !self.has_left && !self.intersections.is_empty() {
                let mut intersections = std::mem::take(&mut self.intersections);
                intersections.retain(|intersection| !self.is_at_start(place(intersection.s)));
                self.intersections = intersections;
            }
            if let Some(&LineIntersection { s, along_m, .. }) = self.intersections.first() {
                self.record(line, (at(s), along_m), self.intersections.len() as u32);
            }
        }
        self.clear_box = self.clear_box_around([low, high]);
        self.has_left = !self.is_at_start(hull[3]);
    }

    /// The largest box around another one that contains no line and no object. An object counts
    /// with the radius of the rock, and no longer once it is hit.
    fn clear_box_around(&self, [low, high]: [Corner; 2]) -> Option<[Corner; 2]> {
        let distance_m = |(line, evaluation_line): (usize, &EvaluationLine)| {
            let apart_m = evaluation_line.apart_m(low, high);
            if evaluation_line.footprint.is_none() {
                return apart_m;
            }
            let is_recorded = self.found.iter().any(|crossing| crossing.line == line);
            if is_recorded { f64::INFINITY } else { apart_m - self.geometry.plan_radius_m() }
        };
        let free_m = CLEARANCE_FACTOR
            * self.lines.iter().enumerate().map(distance_m).fold(f64::INFINITY, f64::min);
        let grown = [low.map(|at| at - free_m), high.map(|at| at + free_m)];
        (free_m > 0.0).then_some(grown)
    }

    /// Records a crossing; a further crossing of the same line is only counted.
    ///
    /// A rock that has fallen through a hole of the mesh and is below the slope has left the
    /// terrain: it crosses nothing.
    fn record(&mut self, line: usize, (instant, along_m): (RockInstant, f64), times: u32) {
        let (terrain, geometry) = (self.terrain, self.geometry);
        let centre = instant.motion.position_m;
        if let Some(known) = self.found.iter_mut().find(|crossing| crossing.line == line) {
            known.times += if terrain.is_under_slope(&centre) { 0 } else { times };
            return;
        }
        // the slope without trees: bounce height is a height above the ground
        let below = terrain.slope_under(centre.x, centre.y, centre.z);
        if below.is_none() && terrain.is_under_slope(&centre) {
            return;
        }
        // Vertical height of the lowest point. Along the slope's normal: the centre's height times
        // cos of the slope, less the support of the rock towards the slope. For a sphere on a steep
        // slope the second is the clearance that a net must have.
        let (height_m, height_normal_m) = below.map_or((f64::NAN, f64::NAN), |(ground, normal)| {
            let over = centre.z - ground;
            let near = over * normal.z.abs() - geometry.support_m(&instant, &-up(normal));
            (over - geometry.depth_below_centre_m(&instant), near)
        });
        let over = |(ground, _)| centre.z - ground + geometry.support_m(&instant, &Vec3::z());
        let top_m = geometry.block.map(|_| below.map_or(f64::NAN, over));
        let rotational_j = geometry.rotational_j(&instant);
        let RockInstant { motion, .. } = instant;
        self.found.push(Crossing {
            line,
            motion,
            rotational_j,
            top_m,
            along_m,
            height_m,
            height_normal_m,
            times,
        });
    }
}

/// The upward normal of a slope; a mesh may be wound either way.
fn up(normal: Vec3) -> Vec3 {
    if normal.z < 0.0 { -normal } else { normal }
}

/// A path that passes within this distance of a corner of a line (m) meets both pieces there:
/// rounding, some 1e-12 m, must not let a rock pass between them.
const CORNER_M: f64 = 1e-9;

/// Fractions of a path (–), rising: a cubic meets a straight line three times at most.
type PathFractions = ArrayVec<f64, 3>;

/// Intersection of a path with a piece of a line.
#[derive(Debug)]
struct LineIntersection {
    /// Fraction of the path (–).
    s: f64,
    /// Position along the line (m).
    along_m: f64,
    /// The end of the piece, if the intersection is there.
    corner_m: Option<Corner>,
}

impl LineIntersection {
    /// Intersection with a piece at `at_m`, after a fraction `s` of the path; none beyond its ends.
    fn of(piece: &LinePiece, s: f64, at_m: Corner) -> Option<Self> {
        let length_m = piece.length_m();
        let along_m = piece.share(at_m) * length_m;
        if !(-CORNER_M..=length_m + CORNER_M).contains(&along_m) {
            return None;
        }
        let end = |k: usize| piece.from_m[k] + piece.way_m[k];
        let corner_m = if along_m <= CORNER_M {
            Some(piece.from_m)
        } else {
            (along_m >= length_m - CORNER_M).then(|| [0, 1].map(end))
        };
        Some(Self { s, along_m: piece.along_m + along_m.clamp(0.0, length_m), corner_m })
    }

    /// Whether both are at the same corner.
    fn is_at_corner_of(&self, other: &Self) -> bool {
        let apart_m =
            |(one, other): (Corner, Corner)| math::hypot(one[0] - other[0], one[1] - other[1]);
        self.corner_m.zip(other.corner_m).is_some_and(|corners| apart_m(corners) <= CORNER_M)
    }
}

/// Replaces `intersections` by those of a path with a line, in the order of the path. A line may be
/// intersected several times, but at a corner only once.
fn intersect_line(
    line: &EvaluationLine,
    when: impl Fn(&LinePiece) -> PathFractions,
    at_m: impl Fn(f64) -> Corner,
    intersections: &mut Vec<LineIntersection>,
) {
    intersections.clear();
    for piece in &line.pieces {
        intersections.extend(
            when(piece).into_iter().filter_map(|s| LineIntersection::of(piece, s, at_m(s))),
        );
    }
    // at the same fraction of the path, in the order of the line
    intersections
        .sort_unstable_by(|a, b| a.s.total_cmp(&b.s).then(a.along_m.total_cmp(&b.along_m)));
    intersections.dedup_by(|next, kept| next.is_at_corner_of(kept));
}

/// Distance below which a rock touches an object (m). A hit is found to 1e-5 m of path; a rim that
/// comes no deeper over an object than 1e-9 m may be missed.
const TOUCH_M: f64 = 1e-6;
/// Shortest advance along a path (m).
const SHORTEST_ADVANCE_M: f64 = 1e-5;

/// The fraction of a path inside `hull` at which the rim of a rock first touches an object, and the
/// position along the object.
///
/// Conservative advancement: each advance is the free distance. No point of the path moves faster
/// with `s` than three times the longest side of the hull, so the first contact cannot be skipped.
fn first_touch_of_object(
    (evaluation_line, footprint): (&EvaluationLine, Footprint),
    rim_m: f64,
    hull: [Corner; 4],
    at: impl Fn(f64) -> RockInstant,
) -> Option<(f64, f64)> {
    let side = |pair: &[Corner]| math::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
    // The derivative of a Bézier curve is 3 times the differences of its points: no point moves
    // faster than this per unit of s.
    let fastest_m = 3.0 * hull.windows(2).map(side).fold(0.0, f64::max);
    let mut s = 0.0;
    while s <= 1.0 {
        let (gap_m, along_m) =
            evaluation_line.gap_m(footprint, plan_view(&at(s).motion.position_m));
        let free_m = gap_m - rim_m;
        if free_m <= TOUCH_M {
            return Some((s, along_m));
        }
        // at least `SHORTEST_ADVANCE_M` each time: a path along the edge of the object must come to
        // an end
        s += free_m.max(SHORTEST_ADVANCE_M) / fastest_m;
    }
    None
}

/// Projection of a point to plan view.
fn plan_view(point: &Vec3) -> Corner {
    [point.x, point.y]
}

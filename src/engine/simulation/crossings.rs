//! Where a rock passes evaluation lines: exact on the parabola of a flight and on the cubic of a step.

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
    /// Vertical distance from the ground below to the highest point of a block (m); none for a sphere, whose diameter tells.
    pub top_m: Option<f64>,
    /// Where along the line (m), from its first corner.
    pub along_m: f64,
    /// Vertical distance from the ground below to the lowest point of the rock (m); NaN where there is no ground.
    pub height_m: f64,
    /// Distance from the slope to the nearest point of the rock along the slope's normal (m), the slope taken as the
    /// plane of the triangle below; NaN where there is no ground.
    pub height_normal_m: f64,
    /// How often this rock crosses this line in all, 1 or more.
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
    /// Work space for where a way meets one line.
    intersections: Vec<LineIntersection>,
    /// South-western and north-eastern corner of a box in plan view in which nothing can be met: most steps are short and
    /// far from all lines. None where nothing is known of it.
    clear_box: Option<[Corner; 2]>,
    /// Where the rock starts, in plan view, and whether it has come away from there.
    start_m: Corner,
    has_left: bool,
}

/// The crossings at a moment, to go back to.
#[derive(Debug)]
pub(super) struct CrossingsMark {
    found: Vec<Crossing>,
    has_left: bool,
}

/// A rock is where it starts up to this far away (m): it does not cross a line that it stands on, on whichever side rounding puts it.
const START_RADIUS_M: f64 = 1e-6;

/// What is kept of the room to the next line (–): rounding must not make it too large.
const CLEARANCE_FACTOR: f64 = 0.999;

impl<'a> Crossings<'a> {
    /// None so far, of a rock that starts at `start`.
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

    /// So far.
    pub(super) fn mark(&self) -> CrossingsMark {
        CrossingsMark { found: self.found.clone(), has_left: self.has_left }
    }

    /// Goes back to what was found before.
    pub(super) fn restore(&mut self, mark: &CrossingsMark) {
        // an object that is no longer known may be met again
        self.clear_box = self.clear_box.filter(|_| self.found.len() == mark.found.len());
        self.found.clear();
        self.found.extend_from_slice(&mark.found);
        self.has_left = mark.has_left;
    }

    /// Whether a place is where the rock starts, from where it has not come away so far.
    fn is_at_start(&self, [x, y]: Corner) -> bool {
        !self.has_left && math::hypot(x - self.start_m[0], y - self.start_m[1]) <= START_RADIUS_M
    }

    /// In the order of lines.
    pub(super) fn into_found(mut self) -> Vec<Crossing> {
        self.found.sort_by_key(|crossing| crossing.line);
        self.found
    }

    /// Notes the lines that a flight passes. Seen from above it is straight and even: the moment follows from one division.
    pub(super) fn fly(&mut self, flight: &RockFlight) {
        if self.lines.is_empty() {
            return;
        }
        // in plan view a parabola is a straight line: two distances to the line of a piece give the share of the way
        let [a, b] = [0.0, flight.lasts_s].map(|t| plan_view(&flight.path.centre(t)));
        self.find_crossings(
            [a, a, b, b],
            |piece| {
                // signed distances to the endless line through the piece, positive on its left
                let (start, end) = (piece.side_m(a), piece.side_m(b));
                // the way is straight in plan view: start/(start − end) of it lies before the line
                let crosses = (start > 0.0) != (end > 0.0);
                crosses.then(|| start / (start - end)).into_iter().collect()
            },
            |s| flight.at(s * flight.lasts_s),
        );
    }

    /// Notes the lines that a step in contact passes.
    pub(super) fn step(&mut self, ends: [&RockInstant; 2]) {
        if self.lines.is_empty() {
            return;
        }
        let [from, to] = ends.map(|end| &end.motion);
        // Hermite data of the step as a Bézier curve: the path lies within the hull of these four points
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

    /// Looks at every line near the way inside `hull`; `when` gives the shares of the way at which it meets the
    /// endless line of a piece, rising, `at` the motion there.
    fn find_crossings(
        &mut self,
        hull: [Corner; 4],
        when: impl Fn(&LinePiece) -> WayShares,
        at: impl Fn(f64) -> RockInstant,
    ) {
        // box of the way in plan view: most steps end here, without a look at any line
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
                // an object is met by the rim of the rock, not by its centre
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

    /// The largest box around another in which nothing can be met: an object counts with the rim of the rock, and not at
    /// all once it is hit.
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

    /// Records a crossing, or counts it where the rock has crossed this line before: only the first is kept in full.
    ///
    /// A rock that has fallen through a hole of the mesh and is under the slope has left the terrain: it crosses nothing.
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
        // Vertical height of the lowest point; along the slope's normal the centre's height times
        // cos of the slope, less how far the rock reaches towards the slope. For a sphere on a
        // steep slope the second is the clearance a net must have.
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

/// The normal of a slope that points up.
/// A mesh may be wound either way.
fn up(normal: Vec3) -> Vec3 {
    if normal.z < 0.0 { -normal } else { normal }
}

/// A way that comes as near to a corner of a line (m) meets both of its pieces there: rounding, some 1e-12 m, must not let a
/// rock pass between them.
const CORNER_M: f64 = 1e-9;

/// Shares of a way (–), rising: a cubic meets a straight line three times at most.
type WayShares = ArrayVec<f64, 3>;

/// Where a way meets a piece of a line.
#[derive(Debug)]
struct LineIntersection {
    /// Share of the way (–).
    s: f64,
    /// Along the line (m).
    along_m: f64,
    /// The end of the piece, if it is met there.
    corner_m: Option<Corner>,
}

impl LineIntersection {
    /// With a piece that is met at `at_m` after a share `s` of the way; none beyond its ends.
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

    /// Whether both are at one corner.
    fn is_at_corner_of(&self, other: &Self) -> bool {
        let apart_m =
            |(one, other): (Corner, Corner)| math::hypot(one[0] - other[0], one[1] - other[1]);
        self.corner_m.zip(other.corner_m).is_some_and(|corners| apart_m(corners) <= CORNER_M)
    }
}

/// Writes over `intersections` where a way meets a line, in the order of the way: a line may be met several times, at a corner once.
fn intersect_line(
    line: &EvaluationLine,
    when: impl Fn(&LinePiece) -> WayShares,
    at_m: impl Fn(f64) -> Corner,
    intersections: &mut Vec<LineIntersection>,
) {
    intersections.clear();
    for piece in &line.pieces {
        intersections.extend(
            when(piece).into_iter().filter_map(|s| LineIntersection::of(piece, s, at_m(s))),
        );
    }
    // at one share of the way, in the order of the line
    intersections.sort_unstable_by(|one, other| {
        one.s.total_cmp(&other.s).then(one.along_m.total_cmp(&other.along_m))
    });
    intersections.dedup_by(|next, kept| next.is_at_corner_of(kept));
}

/// Nearer than this (m) touches: a hit is found to 1e-5 m of way, and a rim that comes no deeper over an object than 1e-9 m may be missed.
const TOUCH_M: f64 = 1e-6;
/// Shortest way that is gone over at a time (m).
const SHORTEST_ADVANCE_M: f64 = 1e-5;

/// The share of a way inside `hull` at which the rim of a rock first comes over an object, and where along the object.
///
/// The way is gone along by what is free each time (conservative advancement): no place on it is farther from the next
/// than three times the longest side of the hull allows, so the first touch cannot be jumped over.
fn first_touch_of_object(
    (evaluation_line, footprint): (&EvaluationLine, Footprint),
    rim_m: f64,
    hull: [Corner; 4],
    at: impl Fn(f64) -> RockInstant,
) -> Option<(f64, f64)> {
    let side = |pair: &[Corner]| math::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
    // A Bézier curve's derivative is 3 times the differences of its points: no place moves faster
    // than this per unit of s.
    let fastest_m = 3.0 * hull.windows(2).map(side).fold(0.0, f64::max);
    let mut s = 0.0;
    while s <= 1.0 {
        let (gap_m, along_m) =
            evaluation_line.gap_m(footprint, plan_view(&at(s).motion.position_m));
        let free_m = gap_m - rim_m;
        if free_m <= TOUCH_M {
            return Some((s, along_m));
        }
        // at least `SHORTEST_ADVANCE_M` a time: a way along the object's own edge must come to an end
        s += free_m.max(SHORTEST_ADVANCE_M) / fastest_m;
    }
    None
}

/// The point in plan view.
fn plan_view(point: &Vec3) -> Corner {
    [point.x, point.y]
}

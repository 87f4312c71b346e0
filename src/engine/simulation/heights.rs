//! Largest height of a rock over the ground along a flight: computed, not sampled.
//!
//! In plan view a flight is straight, so the ground below it is a section of the mesh, made of
//! straight lines. Over each line the centre has one greatest height in closed form, where it
//! climbs as fast as the line rises, or at an end of the line:
//!
//! ```text
//! z(t) − h(t) = c_z + v_z t − g t²/2 − (h0 + h1 t),   greatest at t = (v_z − h1)/g, cut to the time over the line
//! ```
//!
//! A sphere of radius `R` has `R` below its centre, so its height is exact except for rounding. A
//! block rotates: over a short time its lowest point stays below a parabola
//! ([`Heights::bounding_parabola`]). Times are halved until that upper bound and a height that
//! occurs are within [`ERROR_M`].
//!
//! Few flights need this search: most are no higher over the lowest ground around (`Floor`), cell
//! by cell, than the height that is known already.
//!
//! Where there are several sheets, the ground is the highest sheet below the centre. A flight meets
//! no mesh before its end, so no sheet crosses its path.
//!
//! A step in contact is treated like a flight. On a slope the ground vertically below a rock is
//! lower than the ground that it touches, and a block that leans over a steep place may be higher
//! above it than it has ever flown.

use super::rock_geometry::{RockFlight, RockGeometry};
use crate::flight::Parabola;
use crate::math;
use crate::terrain::Terrain;
use crate::terrain::section::SectionLine;

/// Largest error of a block's height, which may come out too low by this (m).
pub(super) const ERROR_M: f64 = 1e-3;
/// Number of consecutive cells of the floor that are searched together: one search through the mesh
/// for all of them.
const BATCH_CELLS: u32 = 8;
/// Number of ground lines that are evaluated together; a cell has two or three as a rule. If there
/// are more, the span is halved …
const MAX_GROUND_LINES: usize = 24;
/// … down to this length in plan view (m): over a fan of triangles or a pile of sheets, where the
/// height at the greatest height of the centre must suffice.
const SHORTEST_SPAN_M: f64 = 1e-3;
/// Lines that end within this distance in plan view (m) leave no gap between them: rounding.
const SEAM_TOLERANCE_M: f64 = 1e-7;
/// Ground higher than a line by this (m) hides it.
const OCCLUSION_TOLERANCE_M: f64 = 1e-6;

/// A flight over the ground of a terrain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heights<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) geometry: &'a RockGeometry<'a>,
    pub(super) flight: &'a RockFlight<'a>,
}

/// A time of a flight and the height at that time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HighPoint {
    /// Time since the flight began (s).
    pub(super) time_s: f64,
    /// Vertical distance from the ground below to the lowest point of the rock (m).
    pub(super) height_m: f64,
}

impl HighPoint {
    fn raise_to(&mut self, other: Self) {
        if other.height_m > self.height_m {
            *self = other;
        }
    }
}

impl Heights<'_> {
    /// The highest point within a span of time (s); none where the rock is nowhere higher than
    /// `known_m` (m), or has no ground below.
    pub(super) fn largest(&self, span_s: [f64; 2], known_m: f64) -> Option<HighPoint> {
        let mut top = HighPoint { time_s: span_s[0], height_m: known_m };
        // consecutive cells whose bound exceeds the known height are searched together
        let (mut batch_s, mut cells) = (span_s, 0);
        self.for_each_floor_cell(span_s, |most_m, [from_s, to_s]| {
            let may_exceed = most_m > top.height_m;
            if may_exceed {
                batch_s = [if cells == 0 { from_s } else { batch_s[0] }, to_s];
                cells += 1;
            }
            if cells > 0 && (!may_exceed || cells == BATCH_CELLS) {
                self.search(batch_s, &mut top);
                cells = 0;
            }
        });
        if cells > 0 {
            self.search(batch_s, &mut top);
        }
        Some(top).filter(|top| top.height_m > known_m)
    }

    /// Calls `pass` for every cell of the floor below a span of time (s), with an upper bound of
    /// the height (m) over the cell and the part of the span over it.
    fn for_each_floor_cell(
        &self,
        span_s @ [from_s, to_s]: [f64; 2],
        mut pass: impl FnMut(f64, [f64; 2]),
    ) {
        let path = self.flight.path;
        let below_m = self.geometry.least_depth_below_centre_m();
        let highest_s = path.highest_over(0.0, span_s);
        self.terrain.floor.along(self.plan_view_ends(span_s), |low_m, from, to| {
            let cell_s = [from, to].map(|share| from_s + share * (to_s - from_s));
            let highest_m = path.centre(highest_s.max(cell_s[0]).min(cell_s[1])).z;
            pass(highest_m - below_m - low_m, cell_s);
        });
    }

    /// Positions of the centre in plan view at the ends of a span of time (m).
    fn plan_view_ends(&self, span_s: [f64; 2]) -> [[f64; 2]; 2] {
        span_s.map(|t| {
            let centre = self.flight.path.centre(t);
            [centre.x, centre.y]
        })
    }

    /// Greatest height of the centre within a span of time (m, local).
    fn highest_m(&self, span_s: [f64; 2]) -> f64 {
        let path = self.flight.path;
        path.centre(path.highest_over(0.0, span_s)).z
    }

    /// Raises `top` to the highest point within a span of time (s): collects the ground lines and
    /// searches over them.
    fn search(&self, span_s: [f64; 2], top: &mut HighPoint) {
        let mut lines = [GroundLine::default(); MAX_GROUND_LINES];
        if let Some(lines) = self.collect_lines(span_s, &mut lines) {
            return self.search_over_lines(span_s, lines, top);
        }
        let [from, to] = self.plan_view_ends(span_s);
        if math::hypot(to[0] - from[0], to[1] - from[1]) < SHORTEST_SPAN_M {
            self.evaluate_at(self.flight.path.highest_over(0.0, span_s), top);
        } else {
            for half in halves(span_s) {
                self.search(half, top);
            }
        }
    }

    /// Raises `top` to the highest point over some ground lines within a span of time (s), by
    /// branch and bound.
    fn search_over_lines(&self, span_s: [f64; 2], lines: &[GroundLine], top: &mut HighPoint) {
        let bound = self.bounding_parabola(span_s);
        let Some(highest) = self.highest_over_lines((lines, span_s), &bound, top.height_m) else {
            return;
        };
        let HighPoint { time_s, height_m: most_m } = highest;
        // distance between bound and lowest point: 0 for a sphere
        let slack_m = bound.centre(time_s).z - self.lowest_m(time_s);
        top.raise_to(HighPoint { time_s, height_m: most_m - slack_m });
        if most_m > top.height_m + ERROR_M {
            // the half with the greater bound first: what is found there rules out most of the
            // other half
            let mut halves = halves(span_s);
            if time_s > halves[0][1] {
                halves.reverse();
            }
            for half in halves {
                self.search_over_lines(half, lines, top);
            }
        }
    }

    /// Raises `top` to the height at one time (s).
    fn evaluate_at(&self, time_s: f64, top: &mut HighPoint) {
        let centre = self.flight.path.centre(time_s);
        if let Some(ground_m) = self.terrain.ground_under(centre.x, centre.y, centre.z) {
            top.raise_to(HighPoint { time_s, height_m: self.lowest_m(time_s) - ground_m });
        }
    }

    /// Height of the lowest point of the rock at a time (m, local).
    fn lowest_m(&self, time_s: f64) -> f64 {
        self.flight.path.centre(time_s).z
            - self.geometry.depth_below_centre_m(&self.flight.at(time_s))
    }

    /// A parabola that bounds the lowest point from above within a span of time (s).
    ///
    /// The lowest point is that of the lowest of all corners, so the corner that is lowest at the
    /// middle of the span bounds it from above. The height of that corner is `z·ρ + z·(ω × ρ) τ`
    /// and at most `a |ρ| τ²/2` more, with `a` of [`RockFlight::point_acceleration_per_m`]. Over
    /// long spans the largest sphere inside the block gives the better bound.
    fn bounding_parabola(&self, [from_s, to_s]: [f64; 2]) -> Parabola {
        let mut path = *self.flight.path;
        let least_m = self.geometry.least_depth_below_centre_m();
        path.start.z -= least_m;
        if let (Some(acceleration_per_m), Some(block)) =
            (self.flight.point_acceleration_per_m(), self.geometry.block)
        {
            let (middle_s, half_s) = (0.5 * (from_s + to_s), 0.5 * (to_s - from_s));
            let curvature_m = 0.5 * acceleration_per_m * block.bound_m * half_s * half_s;
            if curvature_m < block.bound_m - least_m
                && let Some((below_m, sinks_m_s)) =
                    RockGeometry::lowest_corner(block, &self.flight.at(middle_s))
            {
                path.start.z += least_m - below_m + curvature_m + sinks_m_s * middle_s;
                path.velocity.z -= sinks_m_s;
            }
        }
        path
    }

    /// The ground lines below the path within a span of time (s); none if there are more than fit
    /// in.
    fn collect_lines<'l>(
        &self,
        span_s @ [from_s, to_s]: [f64; 2],
        lines: &'l mut [GroundLine; MAX_GROUND_LINES],
    ) -> Option<&'l [GroundLine]> {
        let mut count = 0;
        self.terrain.section(self.plan_view_ends(span_s), self.highest_m(span_s), |line| {
            if let Some(free) = lines.get_mut(count) {
                let SectionLine { shares, heights_m } = line;
                let span_s = shares.map(|share| from_s + share * (to_s - from_s));
                let rise_m_s = (heights_m[1] - heights_m[0]) / (span_s[1] - span_s[0]);
                // a line without length has no slope
                let rise_m_s = if rise_m_s.is_finite() { rise_m_s } else { 0.0 };
                *free = GroundLine { span_s, from_m: heights_m[0], rise_m_s };
            }
            count += 1;
        });
        lines.get(..count)
    }

    /// Point within a span of time (s) at which `bound` is highest over the ground that the lines
    /// make, if higher than `known_m` (m).
    ///
    /// It is no higher than over any single line. Where another line hides the line there, the
    /// highest point over what is left of it is one of its ends: where another line begins, ends or
    /// is crossed.
    fn highest_over_lines(
        &self,
        (lines, [from_s, to_s]): (&[GroundLine], [f64; 2]),
        bound: &Parabola,
        known_m: f64,
    ) -> Option<HighPoint> {
        let path = self.flight.path;
        let seam_s = SEAM_TOLERANCE_M / math::hypot(path.velocity.x, path.velocity.y);
        let mut top = HighPoint { time_s: 0.0, height_m: known_m };
        let clearance_at = |time_s: f64| {
            let centre_m = path.centre(time_s).z;
            let below = lines.iter().filter(|line| line.is_below(time_s, seam_s));
            let heights = below.map(|line| line.at_m(time_s)).filter(|line| *line <= centre_m);
            let ground_m = heights.reduce(f64::max)?;
            Some(HighPoint { time_s, height_m: bound.centre(time_s).z - ground_m })
        };
        for line in lines {
            let span_s = [line.span_s[0].max(from_s), line.span_s[1].min(to_s)];
            if span_s[0] > span_s[1] {
                continue;
            }
            let time_s = bound.highest_over(line.rise_m_s, span_s);
            let height_bound_m = bound.centre(time_s).z - line.at_m(time_s);
            if height_bound_m <= top.height_m {
                continue;
            }
            if let Some(point) = clearance_at(time_s) {
                top.raise_to(point);
                if point.height_m >= height_bound_m - OCCLUSION_TOLERANCE_M {
                    continue;
                }
            }
            for other in lines {
                // just beside its ends, where it no longer hides the line
                let beside = [other.span_s[0] - 2.0 * seam_s, other.span_s[1] + 2.0 * seam_s];
                let ends = beside.into_iter().chain([line.crosses(other)]);
                let is_over = |time: &f64| (span_s[0]..=span_s[1]).contains(time);
                ends.filter(is_over).filter_map(clearance_at).for_each(|point| top.raise_to(point));
            }
        }
        Some(top).filter(|top| top.height_m > known_m)
    }
}

/// The two halves of a span.
fn halves([from, to]: [f64; 2]) -> [[f64; 2]; 2] {
    let middle = 0.5 * (from + to);
    [[from, middle], [middle, to]]
}

/// A straight piece of ground below a flight.
#[derive(Debug, Clone, Copy, Default)]
struct GroundLine {
    /// Time during which the rock is over it (s).
    span_s: [f64; 2],
    /// Its height at the start of that time (m, local).
    from_m: f64,
    /// Rate at which the ground rises below the rock (m/s).
    rise_m_s: f64,
}

impl GroundLine {
    /// Whether it lies below the rock, or ends within `seam_s` (s) of it.
    fn is_below(&self, time_s: f64, seam_s: f64) -> bool {
        time_s >= self.span_s[0] - seam_s && time_s <= self.span_s[1] + seam_s
    }

    /// Its height (m, local); beyond its ends that of the end.
    fn at_m(&self, time_s: f64) -> f64 {
        self.from_m
            + (time_s.clamp(self.span_s[0], self.span_s[1]) - self.span_s[0]) * self.rise_m_s
    }

    /// Time at which both are equally high (s); NaN or far away where they are parallel.
    fn crosses(&self, other: &Self) -> f64 {
        let apart_m =
            other.from_m - self.from_m + (self.span_s[0] - other.span_s[0]) * other.rise_m_s;
        self.span_s[0] + apart_m / (self.rise_m_s - other.rise_m_s)
    }
}

#[cfg(test)]
mod tests;

//! How high a rock flies over the ground: its largest height, found and not sampled.
//!
//! Seen in plan view a flight is straight, so the ground below it is a section of the mesh, made of straight lines. Over each
//! the centre has one greatest height in closed form, where it climbs as fast as the line rises or at an end of it:
//!
//! ```text
//! z(t) − h(t) = c_z + v_z t − g t²/2 − (h0 + h1 t),   greatest at t = (v_z − h1)/g, cut to the time over the line
//! ```
//!
//! A sphere of radius `R` has `R` below its centre, so its height is exact but for rounding. A block turns: over a short time its lowest
//! point stays under a parabola ([`Heights::bounding_parabola`]), and times are halved until the height of that and one that was met are
//! [`ERROR_M`] apart.
//!
//! Few flights are looked at so: over the lowest ground around (`Floor`), cell by cell, most are no higher than what is known.
//!
//! Of several sheets the ground is the highest below the centre. A flight meets no mesh before its end, so none crosses its path.
//!
//! A step in contact is looked at like a flight: on a slope the ground straight below a rock is lower than the one that it touches, and a
//! block that leans over a steep place may stand higher above it than it has ever flown.

use super::rock_geometry::{RockFlight, RockGeometry};
use crate::flight::Parabola;
use crate::math;
use crate::terrain::Terrain;
use crate::terrain::section::SectionLine;

/// A block's height may come out too low by this, no more (m).
pub(super) const ERROR_M: f64 = 1e-3;
/// Cells of the floor in a row that are looked at together: one search through the mesh for all of them.
const BATCH_CELLS: u32 = 8;
/// Lines of the ground that are looked at together, two or three a cell as a rule. More are parted …
const MAX_GROUND_LINES: usize = 24;
/// … down to this way in plan view (m), over a fan of triangles or a pile of sheets, where the height at the greatest height of the centre
/// has to do.
const SHORTEST_SPAN_M: f64 = 1e-3;
/// Lines that end so near to each other in plan view (m) leave no gap: rounding.
const SEAM_TOLERANCE_M: f64 = 1e-7;
/// Ground that lies this much (m) higher than a line hides it.
const OCCLUSION_TOLERANCE_M: f64 = 1e-6;

/// A flight over the ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct Heights<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) geometry: &'a RockGeometry<'a>,
    pub(super) flight: &'a RockFlight<'a>,
}

/// A moment of a flight and the height then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HighPoint {
    /// Since the flight began (s).
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
    /// Where a rock is highest within a span of time (s); none where it is nowhere higher than `known_m` (m) or has no ground below.
    pub(super) fn largest(&self, span_s: [f64; 2], known_m: f64) -> Option<HighPoint> {
        let mut top = HighPoint { time_s: span_s[0], height_m: known_m };
        // cells one behind the other that have room for more: looked at together
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

    /// Calls `pass` with every part of a span of time (s) over one cell of the floor and the most that the height can be there (m).
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

    /// Where the centre is in plan view when a span of time (s) begins and ends (m).
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

    /// Raises `top` to what is higher within a span of time (s): first collects the ground.
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

    /// Raises `top` to what is higher over some lines within a span of time (s).
    fn search_over_lines(&self, span_s: [f64; 2], lines: &[GroundLine], top: &mut HighPoint) {
        let bound = self.bounding_parabola(span_s);
        let Some(most) = self.highest_over_lines((lines, span_s), &bound, top.height_m) else {
            return;
        };
        let HighPoint { time_s, height_m: most_m } = most;
        // of a sphere nothing
        let room_m = bound.centre(time_s).z - self.lowest_m(time_s);
        top.raise_to(HighPoint { time_s, height_m: most_m - room_m });
        if most_m > top.height_m + ERROR_M {
            // what is found where there is most room rules out most of the other half
            let mut halves = halves(span_s);
            if time_s > halves[0][1] {
                halves.reverse();
            }
            for half in halves {
                self.search_over_lines(half, lines, top);
            }
        }
    }

    /// Raises `top` to the height at one moment (s).
    fn evaluate_at(&self, time_s: f64, top: &mut HighPoint) {
        let centre = self.flight.path.centre(time_s);
        if let Some(ground_m) = self.terrain.ground_under(centre.x, centre.y, centre.z) {
            top.raise_to(HighPoint { time_s, height_m: self.lowest_m(time_s) - ground_m });
        }
    }

    /// Height of the lowest point of the rock at a moment (m, local).
    fn lowest_m(&self, time_s: f64) -> f64 {
        self.flight.path.centre(time_s).z
            - self.geometry.depth_below_centre_m(&self.flight.at(time_s))
    }

    /// A parabola over which the lowest point does not come within a span of time (s).
    ///
    /// The lowest corner of a block in the middle of the span is one of those among which the lowest is sought: its way is
    /// `z·ρ + z·(ω × ρ) τ` and at most `bend |ρ| τ²/2` ([`RockFlight::bend`]) more. Over long spans the largest ball inside the block says more.
    fn bounding_parabola(&self, [from_s, to_s]: [f64; 2]) -> Parabola {
        let mut path = *self.flight.path;
        let least_m = self.geometry.least_depth_below_centre_m();
        path.start.z -= least_m;
        if let (Some(bend), Some(block)) =
            (self.flight.point_acceleration_per_m(), self.geometry.block)
        {
            let (middle_s, half_s) = (0.5 * (from_s + to_s), 0.5 * (to_s - from_s));
            let bend_m = 0.5 * bend * block.bound_m * half_s * half_s;
            if bend_m < block.bound_m - least_m
                && let Some((below_m, sinks_m_s)) =
                    RockGeometry::lowest_corner(block, &self.flight.at(middle_s))
            {
                path.start.z += least_m - below_m + bend_m + sinks_m_s * middle_s;
                path.velocity.z -= sinks_m_s;
            }
        }
        path
    }

    /// The lines of the ground below the way within a span of time (s); none if there are more than fit in.
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
                // a line without length rises no way
                let rise_m_s = if rise_m_s.is_finite() { rise_m_s } else { 0.0 };
                *free = GroundLine { span_s, from_m: heights_m[0], rise_m_s };
            }
            count += 1;
        });
        lines.get(..count)
    }

    /// Where `bound` is highest within a span of time (s) over the ground that lines make, if higher than `known_m` (m).
    ///
    /// No higher than over any line alone. Where another hides the line there, the highest place over what is left of it is one
    /// of its ends: where another line begins, ends or is crossed.
    fn highest_over_lines(
        &self,
        (lines, [from_s, to_s]): (&[GroundLine], [f64; 2]),
        bound: &Parabola,
        known_m: f64,
    ) -> Option<HighPoint> {
        let path = self.flight.path;
        let seam_s = SEAM_TOLERANCE_M / math::hypot(path.velocity.x, path.velocity.y);
        let mut top = HighPoint { time_s: 0.0, height_m: known_m };
        let over = |time_s: f64| {
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
            if let Some(met) = over(time_s) {
                top.raise_to(met);
                if met.height_m >= height_bound_m - OCCLUSION_TOLERANCE_M {
                    continue;
                }
            }
            for other in lines {
                // just beside its ends, where it hides nothing more
                let beside = [other.span_s[0] - 2.0 * seam_s, other.span_s[1] + 2.0 * seam_s];
                let ends = beside.into_iter().chain([line.crosses(other)]);
                let is_over = |time: &f64| (span_s[0]..=span_s[1]).contains(time);
                ends.filter(is_over).filter_map(over).for_each(|met| top.raise_to(met));
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

/// A straight line of ground below a flight.
#[derive(Debug, Clone, Copy, Default)]
struct GroundLine {
    /// When the rock is over it (s).
    span_s: [f64; 2],
    /// Its height at first (m, local).
    from_m: f64,
    /// How fast it rises below the rock (m/s).
    rise_m_s: f64,
}

impl GroundLine {
    /// Whether it lies below the rock, or ends within `seam_s` (s).
    fn is_below(&self, time_s: f64, seam_s: f64) -> bool {
        time_s >= self.span_s[0] - seam_s && time_s <= self.span_s[1] + seam_s
    }

    /// Its height (m, local); beside it that of its end.
    fn at_m(&self, time_s: f64) -> f64 {
        self.from_m
            + (time_s.clamp(self.span_s[0], self.span_s[1]) - self.span_s[0]) * self.rise_m_s
    }

    /// When both are equally high (s); NaN or far where they are parallel.
    fn crosses(&self, other: &Self) -> f64 {
        let apart_m =
            other.from_m - self.from_m + (self.span_s[0] - other.span_s[0]) * other.rise_m_s;
        self.span_s[0] + apart_m / (self.rise_m_s - other.rise_m_s)
    }
}

#[cfg(test)]
mod tests;

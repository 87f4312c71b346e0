//! Largest speed and height of a rock by distance from its release in plan view.
//!
//! Stretches are rings about the release point, not pieces of the path: a rock that turns back
//! passes its own stretch again. They give the profiles of speed and height over distance.

use super::contact_heights::StepHeights;
use super::heights::Heights;
use super::passages::{Passage, Passages};
use super::rock_geometry::time_fraction;
use crate::math;
use crate::rock::{Motion, Vec3};
use crate::scene::Corner;

/// One rock in one stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Number of the stretch: 0 begins at the release, each is one step long.
    pub number: u32,
    /// Largest speed of the centre in it (m/s).
    pub speed_m_s: f64,
    /// Largest vertical distance from the ground below to the lowest point of the rock in it (m), 0
    /// or more.
    pub height_m: f64,
}

/// The stretches of one rock so far.
#[derive(Debug)]
pub(super) struct Stretches {
    /// Length of a stretch (m); none where the plan asks for no profile.
    step_m: Option<f64>,
    /// Release in plan view (m).
    release_m: Corner,
    pub(super) found: Passages<Stretch>,
}

impl Stretches {
    pub(super) fn of(step_m: Option<f64>, start: &Motion) -> Self {
        let at = start.position_m;
        Self { step_m, release_m: [at.x, at.y], found: Passages::new() }
    }

    /// Records speed and height at a position. The number of the stretch is `⌊distance/step⌋`.
    pub(super) fn record(&mut self, at: &Vec3, speed_m_s: f64, height_m: f64) {
        let Some(step_m) = self.step_m else { return };
        self.found.add(Stretch { number: self.number_at(at, step_m), speed_m_s, height_m });
    }

    /// Whether stretches are recorded.
    pub(super) fn are_recorded(&self) -> bool {
        self.step_m.is_some()
    }

    fn number_at(&self, at: &Vec3, step_m: f64) -> u32 {
        (math::hypot(at.x - self.release_m[0], at.y - self.release_m[1]) / step_m) as u32
    }

    /// Records speed and height of a step in contact: the velocity is linear in time between its
    /// values at both ends.
    pub(super) fn record_step(&mut self, [from, to]: [&Motion; 2], heights: &StepHeights) {
        let Some(step_m) = self.step_m else { return };
        let [begins_m_s, ends_m_s] = [from, to].map(|at| at.velocity_m_s.norm());
        let number = self.number_at(&to.position_m, step_m);
        // steps are shorter than stretches as a rule: most stay within one
        let before = self.found.last().map(|last| last.number);
        if before.is_none_or(|before| before == number) {
            return self.record_part(number, begins_m_s.max(ends_m_s), (heights, [0.0, 1.0]));
        }
        let [start, displacement] = self.relative_to_release([&from.position_m, &to.position_m]);
        let speed_m_s = |s: f64| from.velocity_m_s.lerp(&to.velocity_m_s, s).norm();
        for_each_stretch(start, displacement, step_m, |number, entered, left| {
            let [s0, s1] = [entered, left].map(|share| time_fraction([from, to], share));
            self.record_part(number, speed_m_s(s0).max(speed_m_s(s1)), (heights, [entered, left]));
        });
    }

    /// Start relative to the release, and displacement, of a straight path between two positions in
    /// plan view (m).
    fn relative_to_release(&self, [from, to]: [&Vec3; 2]) -> [Corner; 2] {
        [[from.x - self.release_m[0], from.y - self.release_m[1]], [to.x - from.x, to.y - from.y]]
    }

    /// Records the part of a path between two fractions of it.
    fn record_part(
        &mut self,
        number: u32,
        speed_m_s: f64,
        (heights, shares): (&StepHeights, [f64; 2]),
    ) {
        let known_m = self.found.known_m(number).unwrap_or(0.0);
        let height_m = heights.largest_m(shares, known_m);
        self.found.add(Stretch { number, speed_m_s, height_m });
    }

    /// Records the stretches below a flight.
    ///
    /// The speed along a parabola has no maximum inside: the largest is at an end of its part in a
    /// stretch.
    pub(super) fn record_flight(&mut self, heights: &Heights) {
        let Some(step_m) = self.step_m else { return };
        let flight = heights.flight;
        let [from, to] = [0.0, flight.duration_s].map(|t| flight.path.centre(t));
        let [start, displacement] = self.relative_to_release([&from, &to]);
        let heights = StepHeights { heights: Some(*heights), height_bound_m: f64::INFINITY };
        let speed_m_s = |share: f64| flight.path.velocity(share * flight.duration_s).norm();
        for_each_stretch(start, displacement, step_m, |number, s0, s1| {
            self.record_part(number, speed_m_s(s0).max(speed_m_s(s1)), (&heights, [s0, s1]));
        });
    }
}

impl Passage for Stretch {
    fn place_number(&self) -> u32 {
        self.number
    }

    fn height_m(&self) -> f64 {
        self.height_m
    }

    fn merge(&mut self, other: &Self) {
        self.speed_m_s = self.speed_m_s.max(other.speed_m_s);
        self.height_m = self.height_m.max(other.height_m);
    }
}

/// Calls `pass` with every stretch under a straight path in plan view, and with the fractions of
/// the path at which the stretch is entered and left. The distance from the release falls up to the
/// nearest point of the path and rises behind it.
///
/// A ring of radius `r` is met where `a s² + 2 b s + c − r² = 0`, with `a = |displacement|²`,
/// `b = start·displacement`, `c = |start|²`.
fn for_each_stretch(
    start: Corner,
    displacement: Corner,
    step_m: f64,
    mut pass: impl FnMut(u32, f64, f64),
) {
    let dot = |a: Corner, b: Corner| a[0] * b[0] + a[1] * b[1];
    let (a, b, c) = (dot(displacement, displacement), dot(start, displacement), dot(start, start));
    let number_at = |s: f64| {
        let at = [0, 1].map(|k| start[k] + s * displacement[k]);
        (dot(at, at).sqrt() / step_m) as u32
    };
    // no displacement in plan view
    if a == 0.0 {
        return pass(number_at(0.0), 0.0, 1.0);
    }
    let nearest = (-b / a).clamp(0.0, 1.0);
    // where the path is this far from the release, on the branch that falls (−1) or rises (1)
    let ring_at = |edge_m: f64, branch: f64| {
        (-b + branch * (b * b - a * (c - edge_m * edge_m)).max(0.0).sqrt()) / a
    };
    for (from, to, branch) in [(0.0, nearest, -1.0), (nearest, 1.0, 1.0)] {
        if to <= from {
            continue;
        }
        let (first, last) = (number_at(from), number_at(to));
        let mut entered = from;
        let mut at = first;
        while at != last {
            let edge = if branch > 0.0 { at + 1 } else { at };
            let left = ring_at(f64::from(edge) * step_m, branch).clamp(entered, to);
            pass(at, entered, left);
            entered = left;
            at = if last > at { at + 1 } else { at - 1 };
        }
        pass(last, entered, to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passed_stretches(start: Corner, displacement: Corner) -> Vec<(u32, f64, f64)> {
        let mut passed = Vec::new();
        for_each_stretch(start, displacement, 2.0, |number, from, to| {
            passed.push((number, from, to));
        });
        passed
    }

    /// By hand: outwards along the axis over edges at 2 and 4 m; past the release at a distance of
    /// 3 m and away again.
    #[test]
    fn a_way_is_cut_where_the_distance_passes_a_stretch() {
        assert_eq!(
            passed_stretches([1.0, 0.0], [4.0, 0.0]),
            [(0, 0.0, 0.25), (1, 0.25, 0.75), (2, 0.75, 1.0)]
        );
        assert_eq!(passed_stretches([3.0, 0.0], [0.0, 0.0]), [(1, 0.0, 1.0)]);
        let past = passed_stretches([-4.0, 3.0], [8.0, 0.0]);
        let numbers: Vec<u32> = past.iter().map(|one| one.0).collect();
        assert_eq!(numbers, [2, 1, 1, 2]);
        // the edge at 4 m is met at x = −√7 and √7
        assert!((past[0].2 - (4.0 - 7.0_f64.sqrt()) / 8.0).abs() < 1e-12);
        assert!((past[2].2 - (4.0 + 7.0_f64.sqrt()) / 8.0).abs() < 1e-12);
        assert!(past.windows(2).all(|pair| (pair[0].2 - pair[1].1).abs() < 1e-15));
    }

    /// A rock that goes to and fro has one entry a stretch, with its largest values.
    #[test]
    fn a_stretch_holds_the_largest() {
        let (rest, start) = (Vec3::zeros(), Vec3::new(0.0, 0.0, 9.0));
        let start = Motion { time_s: 0.0, position_m: start, velocity_m_s: rest, spin_rad_s: rest };
        let mut all = Stretches::of(Some(1.0), &start);
        for (x, speed, height) in [(0.5, 1.0, 0.2), (1.5, 3.0, 0.0), (0.7, 2.0, 0.1)] {
            all.record(&Vec3::new(x, 0.0, 9.0), speed, height);
        }
        let stretch = |number, speed_m_s, height_m| Stretch { number, speed_m_s, height_m };
        assert_eq!(all.found.into_found(), [stretch(0, 2.0, 0.2), stretch(1, 3.0, 0.0)]);
    }
}

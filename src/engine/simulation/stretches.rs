//! How fast and how high a rock was, stretch by stretch of its distance from its release in plan view.
//!
//! Stretches are rings about the release point, not pieces of the path: a rock that turns back
//! passes its own stretch again. They make the profiles of speed and height over distance.

use super::contact_heights::StepHeights;
use super::heights::Heights;
use super::passages::{Passage, Passages};
use super::rock_geometry::time_share;
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
    /// Largest vertical distance from the ground below to the lowest point of the rock in it (m), 0 or more.
    pub height_m: f64,
}

/// The stretches of one rock so far.
#[derive(Debug)]
pub(super) struct Stretches {
    /// Length of a stretch (m); none where nobody asks.
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

    /// Notes a place with the speed and the height there.
    /// `⌊distance/step⌋` is the stretch.
    pub(super) fn note(&mut self, at: &Vec3, speed_m_s: f64, height_m: f64) {
        let Some(step_m) = self.step_m else { return };
        self.found.add(Stretch { number: self.number_at(at, step_m), speed_m_s, height_m });
    }

    /// Whether they are noted.
    pub(super) fn are_recorded(&self) -> bool {
        self.step_m.is_some()
    }

    fn number_at(&self, at: &Vec3, step_m: f64) -> u32 {
        (math::hypot(at.x - self.release_m[0], at.y - self.release_m[1]) / step_m) as u32
    }

    /// Notes a step in contact, how fast and how high it is: the velocity goes evenly in time from that at its start to that at its end.
    pub(super) fn step(&mut self, [from, to]: [&Motion; 2], heights: &StepHeights) {
        let Some(step_m) = self.step_m else { return };
        let [begins_m_s, ends_m_s] = [from, to].map(|at| at.velocity_m_s.norm());
        let number = self.number_at(&to.position_m, step_m);
        // steps are shorter than stretches as a rule: seldom is one left
        let before = self.found.last().map(|last| last.number);
        if before.is_none_or(|before| before == number) {
            return self.note_part(number, begins_m_s.max(ends_m_s), (heights, [0.0, 1.0]));
        }
        let [place, way] = self.relative_to_release([&from.position_m, &to.position_m]);
        let speed_m_s = |s: f64| from.velocity_m_s.lerp(&to.velocity_m_s, s).norm();
        for_each_stretch(place, way, step_m, |number, entered, left| {
            let [s0, s1] = [entered, left].map(|share| time_share([from, to], share));
            self.note_part(number, speed_m_s(s0).max(speed_m_s(s1)), (heights, [entered, left]));
        });
    }

    /// Place in plan view as seen from the release, and way from there, of a straight way between two places (m).
    fn relative_to_release(&self, [from, to]: [&Vec3; 2]) -> [Corner; 2] {
        [[from.x - self.release_m[0], from.y - self.release_m[1]], [to.x - from.x, to.y - from.y]]
    }

    /// Notes a part of a way, from one share to another.
    fn note_part(
        &mut self,
        number: u32,
        speed_m_s: f64,
        (heights, shares): (&StepHeights, [f64; 2]),
    ) {
        let known_m = self.found.known_m(number).unwrap_or(0.0);
        let height_m = heights.largest_m(shares, known_m);
        self.found.add(Stretch { number, speed_m_s, height_m });
    }

    /// Notes the stretches below a flight.
    ///
    /// The speed along a parabola has no largest value inside: the ends of its part in a stretch hold it exactly.
    pub(super) fn fly(&mut self, heights: &Heights) {
        let Some(step_m) = self.step_m else { return };
        let flight = heights.flight;
        let [from, to] = [0.0, flight.lasts_s].map(|t| flight.path.centre(t));
        let [place, way] = self.relative_to_release([&from, &to]);
        let heights = StepHeights { heights: Some(*heights), height_bound_m: f64::INFINITY };
        let speed_m_s = |share: f64| flight.path.velocity(share * flight.lasts_s).norm();
        for_each_stretch(place, way, step_m, |number, s0, s1| {
            self.note_part(number, speed_m_s(s0).max(speed_m_s(s1)), (&heights, [s0, s1]));
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

/// Calls `pass` with every stretch under a straight way in plan view and the shares of the way at which it is entered and
/// left. The distance from the release falls to the nearest point of the way and rises behind it.
///
/// Where the ring of radius `r` is met: `a s² + 2 b s + c − r² = 0` with `a = |way|²`, `b =
/// place·way`, `c = |place|²`.
fn for_each_stretch(place: Corner, way: Corner, step_m: f64, mut pass: impl FnMut(u32, f64, f64)) {
    let dot = |a: Corner, b: Corner| a[0] * b[0] + a[1] * b[1];
    let (a, b, c) = (dot(way, way), dot(place, way), dot(place, place));
    let number = |s: f64| {
        let at = [0, 1].map(|k| place[k] + s * way[k]);
        (dot(at, at).sqrt() / step_m) as u32
    };
    // straight up or down
    if a == 0.0 {
        return pass(number(0.0), 0.0, 1.0);
    }
    let nearest = (-b / a).clamp(0.0, 1.0);
    // where the way is so far from the release, on the branch that falls (−1) or rises (1)
    let reaches = |edge_m: f64, branch: f64| {
        (-b + branch * (b * b - a * (c - edge_m * edge_m)).max(0.0).sqrt()) / a
    };
    for (from, to, branch) in [(0.0, nearest, -1.0), (nearest, 1.0, 1.0)] {
        if to <= from {
            continue;
        }
        let (first, last) = (number(from), number(to));
        let mut entered = from;
        let mut at = first;
        while at != last {
            let edge = if branch > 0.0 { at + 1 } else { at };
            let left = reaches(f64::from(edge) * step_m, branch).clamp(entered, to);
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

    fn passed_stretches(place: Corner, way: Corner) -> Vec<(u32, f64, f64)> {
        let mut passed = Vec::new();
        for_each_stretch(place, way, 2.0, |number, from, to| passed.push((number, from, to)));
        passed
    }

    /// By hand: outwards along the axis over edges at 2 and 4 m; past the release at 3 m distance and away again.
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
            all.note(&Vec3::new(x, 0.0, 9.0), speed, height);
        }
        let stretch = |number, speed_m_s, height_m| Stretch { number, speed_m_s, height_m };
        assert_eq!(all.found.into_found(), [stretch(0, 2.0, 0.2), stretch(1, 3.0, 0.0)]);
    }
}

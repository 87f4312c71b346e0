//! Islands within a window: who may meet whom before its end.

use super::{Rover, State};
use crate::contact::pair::Tie;
use crate::coupled::islands::Islands;
use crate::rock::Vec3;
use crate::trajectory::fall::Course;

/// Passes in which islands grow by the reach of those that may be hit.
const PASSES: usize = 3;

/// A rock's place, radius and largest speed of its own within a window.
pub(super) type Place = (Vec3, f64, f64);

/// Where a rock is at `now_s` and how fast it may be within `dt` (s) if nothing hits it.
pub(super) fn place_of(rover: &Rover, course: &Course, (now_s, dt): (f64, f64)) -> Place {
    let speed = if rover.state == State::Asleep {
        0.0
    } else {
        rover.velocity_at(course, now_s).norm() + course.gravity_m_s2 * dt
    };
    (rover.position_at(course, now_s), rover.member.body.radius, speed)
}

/// Share of the radius by which reaches are larger than they must be: rounding (–).
const ROUNDING: f64 = 1e-6;

/// A window ahead: its length (s), and the speed that a rock may have after being hit, over the fastest speed around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ahead {
    pub(super) dt: f64,
    pub(super) kick: f64,
}

/// Who may meet whom in a window.
pub(super) struct Meetings {
    /// In ascending order.
    pub(super) pairs: Vec<(u32, u32)>,
    pub(super) islands: Islands,
    /// Radius of the ball that holds each rock to the window's end (m).
    reaches: Vec<f64>,
}

impl Meetings {
    /// Whether a rock was thrown out of its ball and, as far as its speed lets one know, may have met one that it was not
    /// compared with. `fastest` is the largest speed each rock had (m/s).
    pub(super) fn missed(&self, places: &[Place], dt: f64, fastest: impl Fn(usize) -> f64) -> bool {
        let pair = |a: usize, b: usize| (a.min(b) as u32, a.max(b) as u32);
        let went = |k: usize| places[k].1 + fastest(k) * dt;
        let thrown: Vec<usize> =
            (0..places.len()).filter(|&k| went(k) > self.reaches[k] * (1.0 + ROUNDING)).collect();
        thrown.into_iter().any(|k| {
            (0..places.len()).any(|other| {
                let reach = went(k) + self.reaches[other].max(went(other));
                k != other
                    && self.pairs.binary_search(&pair(k, other)).is_err()
                    && (places[k].0 - places[other].0).norm_squared() <= reach * reach
            })
        })
    }
}

/// Pairs that may touch and the islands they form: `near` gives the pairs whose reaches (m) overlap.
pub(super) fn grown(
    places: &[Place],
    ahead: Ahead,
    near: impl Fn(&[f64]) -> Vec<(u32, u32)>,
) -> Meetings {
    let mut fastest: Vec<f64> = places.iter().map(|place| place.2).collect();
    let (mut pairs, mut islands) = (Vec::new(), Islands::alone(places.len()));
    let mut reaches = Vec::new();
    for _ in 0..PASSES {
        let reach = |((_, radius, _), speed): (&Place, &f64)| {
            radius * (1.0 + ROUNDING) + ahead.kick * speed * ahead.dt
        };
        reaches = places.iter().zip(&fastest).map(reach).collect();
        pairs = near(&reaches);
        islands = Islands::alone(places.len());
        for &(a, b) in &pairs {
            islands.join(a, b);
        }
        let mut most = vec![0.0f64; places.len()];
        for (place, k) in places.iter().zip(0..) {
            let root = islands.of(k) as usize;
            most[root] = most[root].max(place.2);
        }
        for (speed, k) in fastest.iter_mut().zip(0..) {
            *speed = most[islands.of(k) as usize];
        }
    }
    Meetings { pairs, islands, reaches }
}

/// Whether anything of an island moves other than along a parabola that goes on beyond `end_s`.
pub(super) fn is_busy<'r, 'a: 'r>(
    mut rovers: impl ExactSizeIterator<Item = &'r Rover<'a>>,
    end_s: f64,
) -> bool {
    let alone = rovers.len() == 1;
    rovers.any(|rover| {
        let flies_on = rover.member.flying && rover.lands.as_ref().is_some_and(|(t, _)| *t > end_s);
        rover.state == State::Moving && !(alone && flies_on)
    })
}

/// Which ties join rocks that may meet within `dt` (s).
pub(super) fn meeting_ties(ties: &[Tie], places: &[Place], ahead: Ahead) -> Meetings {
    grown(places, ahead, |reaches| {
        let meets = |tie: &&Tie| {
            let [a, b] = [tie.a, tie.b].map(|k| k as usize);
            let reach = reaches[a] + reaches[b];
            tie.is_held() || (places[a].0 - places[b].0).norm_squared() <= reach * reach
        };
        ties.iter().filter(meets).map(|tie| (tie.a, tie.b)).collect()
    })
}

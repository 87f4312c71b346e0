//! Prediction of islands: which rocks may meet before the end of a window.
//!
//! Contact forces couple rocks, so all rocks that meet in a window must be solved as one system;
//! but who meets is known only after the solution. Therefore a bound on the velocity change of each
//! rock gives a sphere that contains the rock throughout the window, and pairs of overlapping
//! spheres are joined. Too large a bound makes islands large and slow. Too small a bound is
//! detected (`ContactCandidates::missed`), and the window is computed again: the bound decides the
//! cost and never the result.

use super::{BodyState, WorldBody};
use crate::contact::pair::PairHistory;
use crate::groups::Groups;
use crate::rock::Vec3;
use crate::simulation::settings::RunSettings;
use crate::solver::island::broad_phase::Ball;

/// Passes in which islands grow by the reach of rocks that may be hit.
///
/// Joined islands have faster members, which may throw others farther.
const GROWTH_PASSES: usize = 3;

/// Number of times that an impact is transmitted within a short window: a window hardly longer than
/// a contact has time for one impact to be felt beyond the pair.
const SHORT_TRANSMISSIONS: usize = 1;

/// … and within a window that is long compared with a contact.
const LONG_TRANSMISSIONS: usize = 4;

/// A rock at the start of a window.
#[derive(Debug, Clone, Copy)]
pub(super) struct PredictedRock {
    /// Centre (m).
    pub(super) centre: Vec3,
    /// Velocity (m/s).
    velocity: Vec3,
    /// Radius (m).
    pub(super) radius: f64,
    /// Mass (kg).
    mass: f64,
    /// Largest change of its velocity by gravity, by compressed springs and by the mesh (m/s).
    dv_bound: f64,
    /// Velocity change expected from the last pass through this window (m/s), 0 in the first.
    predicted_dv: f64,
}

impl PredictedRock {
    /// Largest speed without being hit (m/s): `|v| + dv_bound`.
    fn speed(&self) -> f64 {
        self.velocity.norm() + self.dv_bound
    }

    /// A sphere that contains the rock throughout `dt` (s) if it deviates no further than
    /// `deviation_m` (m) from its straight path.
    ///
    /// Its centre is the middle of the straight path; its radius is that of the rock, plus half the
    /// length of the path, plus the deviation.
    pub(super) fn swept(&self, deviation_m: f64, dt: f64) -> Ball {
        let half = self.velocity * (0.5 * dt);
        let radius = self.radius * (1.0 + REACH_ROUNDING) + half.norm() + deviation_m;
        Ball { centre: self.centre + half, radius }
    }
}

/// State of a rock at `now_s`, and bounds of its motion within `dt` (s) if no other rock hits it.
pub(super) fn predicted_rock(
    body: &WorldBody,
    settings: &RunSettings,
    (now_s, dt): (f64, f64),
) -> PredictedRock {
    let sleeps = body.state == BodyState::Asleep;
    let velocity = if sleeps { Vec3::zeros() } else { body.velocity_at(settings, now_s) };
    let speed = velocity.norm();
    // the mesh may reverse a rock that lands, or is near it: twice its speed at most
    let lands = body.flight_end.as_ref().is_some_and(|(time_s, _)| *time_s <= now_s + dt);
    let near_mesh = !body.member.flying && body.member.is_near_mesh(speed * dt);
    let reversal = if lands || near_mesh { 2.0 * speed } else { 0.0 };
    // gravity adds g dt; compressed springs may return what they hold
    let dv_bound = body.spring_dv_m_s + settings.gravity_m_s2 * dt + reversal;
    PredictedRock {
        centre: body.position_at(settings, now_s),
        velocity,
        radius: body.member.body.radius,
        mass: body.member.body.mass,
        dv_bound: if sleeps { 0.0 } else { dv_bound },
        predicted_dv: body.predicted_dv_m_s,
    }
}

/// Speed that a rock may have after an impact, over the fastest speed around it (–): twice for a
/// light rock hit by a heavy one.
///
/// An elastic impact of a far heavier rock of speed v gives 2 v; the rest is margin.
const HIT_SPEED_FACTOR: f64 = 2.2;
/// Fraction of the velocity change of an impact that is allowed for within a short window: an
/// impact takes its time (–).
const SHORT_WINDOW_FACTOR: f64 = 0.5;
/// Fraction of the radius by which reaches are enlarged for rounding (–).
const REACH_ROUNDING: f64 = 1e-6;

/// How far an impact is transmitted within a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HitSpread {
    /// To all rocks of an island.
    Island,
    /// To the next few rocks: the window is not much longer than a contact.
    Neighbours,
}

/// The window of a prediction: its length (s), and how far an impact is transmitted.
#[derive(Debug, Clone, Copy)]
pub(super) struct PredictionWindow {
    pub(super) dt: f64,
    pub(super) spread: HitSpread,
}

/// Pairs that may meet in a window.
pub(super) struct ContactCandidates {
    /// In ascending order.
    pub(super) pairs: Vec<(u32, u32)>,
    pub(super) islands: Groups,
    /// Velocity change of each rock that was allowed for (m/s).
    allowed_dv: Vec<f64>,
}

/// Smallest gap between two rocks within `dt` (s) on straight paths (m); negative where they
/// overlap. `|d + u t|` is least at `t = −d·u/|u|²`; clamped to the window.
fn nearest_gap(a: &PredictedRock, b: &PredictedRock, dt: f64) -> f64 {
    let (apart, closing) = (a.centre - b.centre, a.velocity - b.velocity);
    let speed2 = closing.norm_squared();
    let t = if speed2 > 0.0 { (-apart.dot(&closing) / speed2).clamp(0.0, dt) } else { 0.0 };
    (apart + closing * t).norm() - (a.radius + b.radius) * (1.0 + REACH_ROUNDING)
}

impl ContactCandidates {
    /// Rocks whose velocity changed more than was allowed for and that may therefore have met a
    /// rock that is not among their candidates, in ascending order. `after` gives the position of
    /// each rock at the end of the window and the largest change of its velocity (m/s). `near`
    /// gives the pairs to be checked, given how far each rock may have deviated from its flight
    /// (m).
    pub(super) fn missed(
        &self,
        rocks: &[PredictedRock],
        dt: f64,
        after: impl Fn(usize) -> (Vec3, f64),
        near: impl FnOnce(&[f64]) -> Vec<(u32, u32)>,
    ) -> Vec<usize> {
        let is_deviated = |k: usize| after(k).1 > self.allowed_dv[k] * (1.0 + REACH_ROUNDING);
        if !(0..rocks.len()).any(is_deviated) {
            return Vec::new();
        }
        // The deviation from the straight path is at most half the sum of the deviation at the end
        // and of the largest velocity change times the window.
        let deviation_m = |(k, rock): (usize, &PredictedRock)| {
            let (end, dv) = after(k);
            let straight = rock.centre + rock.velocity * dt;
            0.5 * ((end - straight).norm() + dv.max(rock.dv_bound) * dt)
        };
        let deviation_m: Vec<f64> = rocks.iter().enumerate().map(deviation_m).collect();
        let mut missed = Vec::new();
        for (a, b) in near(&deviation_m) {
            let ends = [a as usize, b as usize];
            let gap = nearest_gap(&rocks[ends[0]], &rocks[ends[1]], dt);
            if gap <= deviation_m[ends[0]] + deviation_m[ends[1]]
                && self.pairs.binary_search(&(a, b)).is_err()
            {
                missed.extend(ends.into_iter().filter(|&k| is_deviated(k)));
            }
        }
        missed.sort_unstable();
        missed.dedup();
        missed
    }
}

/// Candidate pairs and the islands they form, where the fastest rock of an island may hit any other
/// of it. `near` gives the pairs that overlap if each rock may be anywhere within the given
/// distance of its centre (m).
///
/// Any rock of an island may reach `HIT_SPEED_FACTOR` times the speed of its fastest: each pass
/// joins the rocks that may meet at such speeds.
pub(super) fn candidates_within_islands(
    rocks: &[PredictedRock],
    dt: f64,
    mut near: impl FnMut(&[f64]) -> Vec<(u32, u32)>,
) -> ContactCandidates {
    let mut fastest: Vec<f64> = rocks.iter().map(|rock| HIT_SPEED_FACTOR * rock.speed()).collect();
    let (mut pairs, mut islands) = (Vec::new(), Groups::of(rocks.len()));
    let mut allowed_dv = Vec::new();
    for _ in 0..GROWTH_PASSES {
        // velocity change, beyond the speed that the rock has
        let deviated = |(rock, speed): (&PredictedRock, &f64)| {
            let own = rock.velocity.norm();
            speed.max(own + rock.predicted_dv) - own
        };
        allowed_dv = rocks.iter().zip(&fastest).map(deviated).collect();
        let reach = |(rock, deviated): (&PredictedRock, &f64)| {
            rock.radius * (1.0 + REACH_ROUNDING) + (rock.velocity.norm() + deviated) * dt
        };
        pairs = near(&rocks.iter().zip(&allowed_dv).map(reach).collect::<Vec<_>>());
        islands = Groups::of_pairs(rocks.len(), pairs.iter().copied());
        // the largest speed of every island, then given to all of its rocks
        let mut largest_speed = vec![0.0f64; rocks.len()];
        for (rock, k) in rocks.iter().zip(0..) {
            let root = islands.lowest(k) as usize;
            largest_speed[root] = largest_speed[root].max(HIT_SPEED_FACTOR * rock.speed());
        }
        for (speed, k) in fastest.iter_mut().zip(0..) {
            *speed = largest_speed[islands.lowest(k) as usize];
        }
    }
    ContactCandidates { pairs, islands, allowed_dv }
}

/// Candidate pairs and the islands they form where rocks pass each other: only a change of relative
/// velocity brings two together, and an impact is transmitted to the next few rocks. `held` are
/// pairs that touch or are bonded, in ascending order; `near` as for [`candidates_within_islands`].
///
/// Rocks that roll down side by side are near each other all the time, and yet few meet. The gap on
/// straight paths separates them, where spheres of the size of their paths would join the whole
/// heap.
pub(super) fn candidates_on_straight_paths(
    rocks: &[PredictedRock],
    dt: f64,
    held: &[(u32, u32)],
    near: impl FnOnce(&[f64]) -> Vec<(u32, u32)>,
) -> ContactCandidates {
    let fastest = rocks.iter().map(PredictedRock::speed).fold(0.0, f64::max);
    let reach = |rock: &PredictedRock| {
        let deviated = rock.dv_bound.max(rock.predicted_dv).max(fastest);
        rock.radius * (1.0 + REACH_ROUNDING) + (rock.velocity.norm() + deviated) * dt
    };
    let mut pairs = near(&rocks.iter().map(reach).collect::<Vec<_>>());
    if !held.is_empty() {
        pairs.extend(held);
        // two rising lists: a stable sort finds and merges them
        pairs.sort_by(Ord::cmp);
        pairs.dedup();
    }
    let mut touching = held.iter().peekable();
    let gap = |pair: &(u32, u32)| {
        let touch = touching.next_if(|held| *held == pair).is_some();
        let [a, b] = [pair.0, pair.1].map(|k| &rocks[k as usize]);
        if touch { f64::NEG_INFINITY } else { nearest_gap(a, b, dt) }
    };
    let gaps: Vec<f64> = pairs.iter().map(gap).collect();
    candidates_by_gaps(rocks, dt, (&pairs, &gaps), (LONG_TRANSMISSIONS, 1.0))
}

/// The same among the pairs of `pair_histories`.
pub(super) fn candidates_among_pairs(
    pair_histories: &[PairHistory],
    rocks: &[PredictedRock],
    window: PredictionWindow,
) -> ContactCandidates {
    match window.spread {
        HitSpread::Neighbours => candidates_of_neighbours(pair_histories, rocks, window.dt),
        HitSpread::Island => candidates_within_islands(rocks, window.dt, |reaches| {
            let meets = |pair: &&PairHistory| {
                let [a, b] = [pair.a, pair.b].map(|k| k as usize);
                let reach = reaches[a] + reaches[b];
                pair.is_held()
                    || (rocks[a].centre - rocks[b].centre).norm_squared() <= reach * reach
            };
            pair_histories.iter().filter(meets).map(|pair| (pair.a, pair.b)).collect()
        }),
    }
}

/// Candidate pairs and the islands they form in a window not much longer than a contact: paths are
/// straight except for impacts, which are transmitted to the next few rocks.
fn candidates_of_neighbours(
    pair_histories: &[PairHistory],
    rocks: &[PredictedRock],
    dt: f64,
) -> ContactCandidates {
    let gaps: Vec<f64> = pair_histories
        .iter()
        .map(|pair| {
            if pair.is_held() {
                f64::NEG_INFINITY
            } else {
                nearest_gap(&rocks[pair.a as usize], &rocks[pair.b as usize], dt)
            }
        })
        .collect();
    let pairs: Vec<(u32, u32)> = pair_histories.iter().map(|pair| (pair.a, pair.b)).collect();
    candidates_by_gaps(rocks, dt, (&pairs, &gaps), (SHORT_TRANSMISSIONS, SHORT_WINDOW_FACTOR))
}

/// The same, given the smallest gap of each pair on straight paths (m).
///
/// The test is `gap ≤ (Δv_a + Δv_b) dt`: both may deviate from their straight paths by that much
/// towards each other.
fn candidates_by_gaps(
    rocks: &[PredictedRock],
    dt: f64,
    (pairs, gaps): (&[(u32, u32)], &[f64]),
    (transmissions, hit_fraction): (usize, f64),
) -> ContactCandidates {
    let mut allowed_dv: Vec<f64> =
        rocks.iter().map(|rock| rock.dv_bound.max(rock.predicted_dv)).collect();
    let meets = |allowed_dv: &[f64], (a, b): (u32, u32), gap: f64| {
        gap <= (allowed_dv[a as usize] + allowed_dv[b as usize]) * dt
    };
    let known = pairs.iter().copied().zip(gaps.iter().copied());
    let relative_speed_m_s =
        |&(a, b): &(u32, u32)| (rocks[a as usize].velocity - rocks[b as usize].velocity).norm();
    let relative_speed_m_s: Vec<f64> = pairs.iter().map(relative_speed_m_s).collect();
    for _ in 0..transmissions {
        let before = allowed_dv.clone();
        // the velocity change by the other rock is added to its own; `before` makes the result
        // independent of the order of pairs
        for (((a, b), gap), relative_speed_m_s) in known.clone().zip(&relative_speed_m_s) {
            if !meets(&before, (a, b), gap) {
                continue;
            }
            for (k, other) in [(a as usize, b as usize), (b as usize, a as usize)] {
                let (own, its) = (&rocks[k], &rocks[other]);
                // an elastic impact: twice the velocity of the common centre of mass
                let share = 2.0 * its.mass / (own.mass + its.mass);
                let closing = relative_speed_m_s + before[other];
                allowed_dv[k] = allowed_dv[k].max(own.dv_bound + hit_fraction * share * closing);
            }
        }
    }
    let pairs: Vec<_> =
        known.filter(|&(pair, gap)| meets(&allowed_dv, pair, gap)).map(|(pair, _)| pair).collect();
    let islands = Groups::of_pairs(rocks.len(), pairs.iter().copied());
    ContactCandidates { pairs, islands, allowed_dv }
}

/// For each of `count` rocks the number of its island and its place there; `usize::MAX` where it is
/// in none.
pub(super) fn island_of_each(islands: &[Vec<u32>], count: usize) -> Vec<(usize, u32)> {
    let mut membership = vec![(usize::MAX, 0); count];
    for (number, island) in islands.iter().enumerate() {
        for (&k, place) in island.iter().zip(0..) {
            membership[k as usize] = (number, place);
        }
    }
    membership
}

/// Whether any rock of an island moves other than along a parabola that lasts beyond `end_s`.
///
/// A rock alone whose flight outlasts the window needs no work: its parabola is recorded when it
/// lands.
pub(super) fn is_busy<'r, 'a: 'r>(
    mut bodies: impl ExactSizeIterator<Item = &'r WorldBody<'a>>,
    end_s: f64,
) -> bool {
    let alone = bodies.len() == 1;
    bodies.any(|body| body.state == BodyState::Moving && !(alone && body.flies_beyond(end_s)))
}

//! Islands within a window: who may meet whom before its end.
//!
//! Why a prediction: contact forces couple rocks, so all that meet in a window must be solved as
//! one system, and who meets is known only after the solution. A bound on how far each velocity may
//! change gives every rock a ball that holds it through the window; pairs of balls that overlap are
//! joined. Too large a bound makes islands large and slow, too small a one is found out
//! (`ContactCandidates::missed`) and the window is gone through again: the bound decides the cost and never
//! the result.

use super::{BodyState, WorldBody};
use crate::contact::pair::PairHistory;
use crate::groups::Groups;
use crate::rock::Vec3;
use crate::simulation::settings::RunSettings;
use crate::solver::island::broad_phase::Ball;

/// Passes in which islands grow by the reach of those that may be hit.
///
/// Joined islands have faster members, which may throw others farther.
const GROWTH_PASSES: usize = 3;

/// Times that a hit is handed on within a short window.
/// In a window hardly longer than a contact there is time for one hit to be felt beyond the pair.
const SHORT_TRANSMISSIONS: usize = 1;

/// … and within one that is long beside a contact.
const LONG_TRANSMISSIONS: usize = 4;

/// A rock at a window's start.
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
    /// Most that its velocity may change by weight, by what presses on it and by the mesh (m/s).
    dv_bound: f64,
    /// By how much its velocity changed when this window was gone through before (m/s), 0 if it was not.
    predicted_dv: f64,
}

impl PredictedRock {
    /// Largest speed of its own (m/s).
    /// `|v| + dv_bound`.
    fn speed(&self) -> f64 {
        self.velocity.norm() + self.dv_bound
    }

    /// A ball that holds the rock through `dt` (s) if it goes no further than `deviation_m` (m) off its straight way.
    ///
    /// Centred on the middle of the straight way: half the way and the deviation are its radius
    /// beyond the rock's own.
    pub(super) fn swept(&self, deviation_m: f64, dt: f64) -> Ball {
        let half = self.velocity * (0.5 * dt);
        let radius = self.radius * (1.0 + REACH_ROUNDING) + half.norm() + deviation_m;
        Ball { centre: self.centre + half, radius }
    }
}

/// Where a rock is at `now_s` and what it may do within `dt` (s) if no other hits it.
pub(super) fn predicted_rock(
    body: &WorldBody,
    settings: &RunSettings,
    (now_s, dt): (f64, f64),
) -> PredictedRock {
    let sleeps = body.state == BodyState::Asleep;
    let velocity = if sleeps { Vec3::zeros() } else { body.velocity_at(settings, now_s) };
    let speed = velocity.norm();
    // a rock that lands, or is near the mesh, may be turned round by it: twice its speed at most
    let flight_end = body.flight_end.as_ref().is_some_and(|(time_s, _)| *time_s <= now_s + dt);
    let near_mesh = !body.member.flying && body.member.is_near_mesh(speed * dt);
    let turned = if flight_end || near_mesh { 2.0 * speed } else { 0.0 };
    // weight adds g dt; springs that are pressed may give back what they hold
    let dv_bound = body.spring_dv_m_s + settings.gravity_m_s2 * dt + turned;
    PredictedRock {
        centre: body.position_at(settings, now_s),
        velocity,
        radius: body.member.body.radius,
        mass: body.member.body.mass,
        dv_bound: if sleeps { 0.0 } else { dv_bound },
        predicted_dv: body.predicted_dv_m_s,
    }
}

/// Speed that a rock may have after being hit, over the fastest speed around it (–): twice for a light one under a
/// heavy one.
///
/// An elastic hit from a far heavier rock of speed v gives 2 v; the rest is room.
const HIT_SPEED_FACTOR: f64 = 2.2;
/// Of a hit within a short window, the share that is allowed for: it takes its time (–).
const SHORT_WINDOW_FACTOR: f64 = 0.5;
/// Share of the radius by which reaches are larger than they must be: rounding (–).
const REACH_ROUNDING: f64 = 1e-6;

/// How far a hit is handed on within a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HitSpread {
    /// To all of an island.
    Island,
    /// To the next few rocks: the window is not much longer than a contact.
    Neighbours,
}

/// A window ahead: its length (s), and how far a hit is handed on.
#[derive(Debug, Clone, Copy)]
pub(super) struct PredictionWindow {
    pub(super) dt: f64,
    pub(super) spread: HitSpread,
}

/// Who may meet whom in a window.
pub(super) struct ContactCandidates {
    /// In ascending order.
    pub(super) pairs: Vec<(u32, u32)>,
    pub(super) islands: Groups,
    /// Change of each rock's velocity that was allowed for (m/s).
    allowed_dv: Vec<f64>,
}

/// Nearest that two rocks come to each other within `dt` (s) on straight ways, less their radii (m).
/// `|d + u t|` is least at `t = −d·u/|u|²`; clamped to the window. Negative where they overlap.
fn nearest_gap(a: &PredictedRock, b: &PredictedRock, dt: f64) -> f64 {
    let (apart, closing) = (a.centre - b.centre, a.velocity - b.velocity);
    let speed2 = closing.norm_squared();
    let t = if speed2 > 0.0 { (-apart.dot(&closing) / speed2).clamp(0.0, dt) } else { 0.0 };
    (apart + closing * t).norm() - (a.radius + b.radius) * (1.0 + REACH_ROUNDING)
}

impl ContactCandidates {
    /// Rocks that were deviated off their ways further than allowed and, as far as one knows, may have met one that they
    /// were not compared with, in ascending order. `after` gives each rock's place at the window's end and the largest
    /// change of its velocity (m/s), `near` the pairs that can come into question, given how far each may deviate from its flight (m).
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
        // Off its straight way by no more than half of what it is off at the end and of what it could be.
        let deviation_m = |(k, rock): (usize, &PredictedRock)| {
            let (end, off) = after(k);
            let straight = rock.centre + rock.velocity * dt;
            0.5 * ((end - straight).norm() + off.max(rock.dv_bound) * dt)
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

/// Pairs that may touch and the islands they form, where any rock of an island may be hit by its fastest: `near` gives the
/// pairs that overlap if each rock may be anywhere within so far of its centre (m).
///
/// The speed that any rock of an island may get is `HIT_SPEED_FACTOR` times that of its fastest: each pass
/// joins what this lets meet.
pub(super) fn candidates_within_islands(
    rocks: &[PredictedRock],
    dt: f64,
    mut near: impl FnMut(&[f64]) -> Vec<(u32, u32)>,
) -> ContactCandidates {
    let mut fastest: Vec<f64> = rocks.iter().map(|rock| HIT_SPEED_FACTOR * rock.speed()).collect();
    let (mut pairs, mut islands) = (Vec::new(), Groups::of(rocks.len()));
    let mut allowed_dv = Vec::new();
    for _ in 0..GROWTH_PASSES {
        // what its velocity may change by, beyond the speed it has
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
        // the fastest of every island, then handed back to all of its rocks
        let mut most = vec![0.0f64; rocks.len()];
        for (rock, k) in rocks.iter().zip(0..) {
            let root = islands.lowest(k) as usize;
            most[root] = most[root].max(HIT_SPEED_FACTOR * rock.speed());
        }
        for (speed, k) in fastest.iter_mut().zip(0..) {
            *speed = most[islands.lowest(k) as usize];
        }
    }
    ContactCandidates { pairs, islands, allowed_dv }
}

/// Pairs that may touch and the islands they form where rocks pass each other: only what changes the velocity of one
/// relative to the other brings them together, and a hit is handed on to the next few. `held` are pairs that touch or are
/// bonded, in ascending order; `near` as for [`candidates_within_islands`].
///
/// Rocks that roll down side by side are near each other all the time, and yet few meet: the gap on
/// straight ways tells them apart where balls of the size of their ways would join the whole heap.
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
        // two lists that rise: a stable sort finds them, and merges
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

/// The same among rocks that `pair_histories` join.
pub(super) fn candidates_among_pairs(
    pair_histories: &[PairHistory],
    rocks: &[PredictedRock],
    window: PredictionWindow,
) -> ContactCandidates {
    match window.spread {
        HitSpread::Neighbours => candidates_of_neighbours(pair_histories, rocks, window.dt),
        HitSpread::Island => candidates_within_islands(rocks, window.dt, |reaches| {
            let meets = |pair_history: &&PairHistory| {
                let [a, b] = [pair_history.a, pair_history.b].map(|k| k as usize);
                let reach = reaches[a] + reaches[b];
                pair_history.is_held()
                    || (rocks[a].centre - rocks[b].centre).norm_squared() <= reach * reach
            };
            pair_histories
                .iter()
                .filter(meets)
                .map(|pair_history| (pair_history.a, pair_history.b))
                .collect()
        }),
    }
}

/// Pairs that may touch and the islands they form in a window not much longer than a contact: rocks go straight on but
/// for hits, which are handed on to the next few.
fn candidates_of_neighbours(
    pair_histories: &[PairHistory],
    rocks: &[PredictedRock],
    dt: f64,
) -> ContactCandidates {
    let gaps: Vec<f64> = pair_histories
        .iter()
        .map(|pair_history| {
            if pair_history.is_held() {
                f64::NEG_INFINITY
            } else {
                nearest_gap(&rocks[pair_history.a as usize], &rocks[pair_history.b as usize], dt)
            }
        })
        .collect();
    let pairs: Vec<(u32, u32)> =
        pair_histories.iter().map(|pair_history| (pair_history.a, pair_history.b)).collect();
    candidates_by_gaps(rocks, dt, (&pairs, &gaps), (SHORT_TRANSMISSIONS, SHORT_WINDOW_FACTOR))
}

/// The same, given the nearest that each pair comes to each other on straight ways (m).
///
/// `gap ≤ (Δv_a + Δv_b) dt` is the test: both may leave their straight ways by so much towards each
/// other.
fn candidates_by_gaps(
    rocks: &[PredictedRock],
    dt: f64,
    (pairs, gaps): (&[(u32, u32)], &[f64]),
    (transmissions, transferred): (usize, f64),
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
        // what one rock may get from the other is added to what it may do by itself; `before` keeps
        // the order of pairs out of the result
        for (((a, b), gap), relative_speed_m_s) in known.clone().zip(&relative_speed_m_s) {
            if !meets(&before, (a, b), gap) {
                continue;
            }
            for (k, other) in [(a as usize, b as usize), (b as usize, a as usize)] {
                let (own, its) = (&rocks[k], &rocks[other]);
                // an elastic hit: twice the velocity of the common centre of mass
                let share = 2.0 * its.mass / (own.mass + its.mass);
                let closing = relative_speed_m_s + before[other];
                allowed_dv[k] = allowed_dv[k].max(own.dv_bound + transferred * share * closing);
            }
        }
    }
    let pairs: Vec<_> =
        known.filter(|&(pair, gap)| meets(&allowed_dv, pair, gap)).map(|(pair, _)| pair).collect();
    let islands = Groups::of_pairs(rocks.len(), pairs.iter().copied());
    ContactCandidates { pairs, islands, allowed_dv }
}

/// For each of `count` rocks the island of these that it is in and its place there; `usize::MAX` where it is in none.
pub(super) fn island_of_each(islands: &[Vec<u32>], count: usize) -> Vec<(usize, u32)> {
    let mut rocks = vec![(usize::MAX, 0); count];
    for (number, island) in islands.iter().enumerate() {
        for (&k, place) in island.iter().zip(0..) {
            rocks[k as usize] = (number, place);
        }
    }
    rocks
}

/// Whether anything of an island moves other than along a parabola that goes on beyond `end_s`.
///
/// A rock alone whose flight outlasts the window needs no work at all: its recorder goes along the
/// parabola when it lands.
pub(super) fn is_busy<'r, 'a: 'r>(
    mut bodies: impl ExactSizeIterator<Item = &'r WorldBody<'a>>,
    end_s: f64,
) -> bool {
    let alone = bodies.len() == 1;
    bodies.any(|body| {
        let flies_on =
            body.member.flying && body.flight_end.as_ref().is_some_and(|(t, _)| *t > end_s);
        body.state == BodyState::Moving && !(alone && flies_on)
    })
}

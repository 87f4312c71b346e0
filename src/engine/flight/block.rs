//! First touch of a block in free flight: a bound that cannot miss.
//!
//! The ball around the block is leapt ahead exactly; nothing touches before it does. From there the block is gone along feature by
//! feature (conservative advancement). The distance of a corner to a convex set is a convex function of its place, so with the present
//! distance `d`, direction `n`, velocity `ṗ` and acceleration `p̈`
//!
//! ```text
//! d(t+τ) ≥ d + n·ṗ τ + ½ n·p̈ τ² − ⅙ J τ³ ≥ d + n·ṗ τ − ½ B τ²   for τ ≤ T,   B = min(g + ρ b₂, −n·p̈ + ⅓ J T),   J = ρ b₃
//! ```
//!
//! where `ρ b₂` and `ρ b₃` bound what the turn does to the corner's acceleration and to the rate of it (`top::PointBounds`). With the speed of
//! approach `c = −n·ṗ` and the gap `δ = d − r` the step `τ = 2δ/(c + √(c² + 2Bδ))` is never too long, and near a touch it converges
//! faster than Newton's method, from one side. Edges and faces of the block are hulls of corners: with `n` from their own nearest points
//! the same bound holds for each of their corners.
//!
//! Frames: corners are fixed in the block's principal frame; `attitude` turns them to the
//! terrain's. `ρ` is a corner's distance from the centre of mass (m), `r` the radius of the balls
//! at the corners (m). Cost: about ten evaluations a corner over a second of flight without any
//! window, most of them in the last window before the touch.

mod ahead;
mod clearance;
mod window;

use super::top::{PointBounds, RotationSeries, Top};
use super::{FlightEnd, Parabola, min_travel_time_s, time_of_impact_without};
use crate::body::Block;
use crate::contact::block::Pose;
use crate::contact::closest::closest_on;
use crate::contact::neighbours::Neighbours;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use ahead::FeaturesAhead;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use window::{CornerMotions, WindowSearch};

/// No step forward is shorter (s): what comes so soon touches now.
/// Below it the time could not be told from the one before, at times of some hundred seconds.
const MIN_STEP_S: f64 = 1e-13;
/// Way of the centre for which features are collected at a time (–, relative to the radius of the ball around).
/// Longer windows collect more features, shorter ones collect more often.
const WINDOW: f64 = 0.5;
/// Features that are known from before will do for a window as long as this (–, relative to the radius of the ball around).
const MIN_WINDOW: f64 = 0.1;

/// Rounding of a sum of three products, with room (–): what is skipped because it is far away must be so for certain.
const ROUNDING_MARGIN: f64 = 1e-12;

/// A gap that counts as touching (–, relative to the radius of the sphere of equal volume).
/// A tenth of the gap at which contact begins: what is found here is a touch there.
const TOUCHING: f64 = 1e-10;

/// A block in free flight.
#[derive(Debug)]
pub struct BlockFlight<'a> {
    /// The block.
    pub block: &'a Block,
    /// Its rotation.
    pub top: Top,
    /// Way of its centre, with the radius of the ball around it.
    pub path: Parabola,
}

/// A moment of the flight.
struct FlightState {
    /// Time since the flight began (s).
    time_s: f64,
    /// Centre (m) and attitude.
    pose: Pose,
    /// Of the centre (m/s).
    velocity: Vec3,
    /// Angular velocity (rad/s) and acceleration (rad/s²) in the frame of the terrain.
    spin: Vec3,
    angular: Vec3,
}

/// A part of the block that may touch.
///
/// Parts are worked on in the order of the times until which they surely touch nothing.
#[derive(Debug, Clone, Copy)]
enum BlockPart {
    /// A rounded corner against faces, edges and vertices of the mesh.
    Corner(usize),
    /// An edge of the block against edges of the mesh that stand out.
    Ridge(usize),
    /// A face of the block against vertices of the mesh that stand out.
    Face(usize),
}

/// Work space of a flight; lists keep their memory from window to window.
#[derive(Debug, Default)]
pub struct WindowScratch {
    /// Parts of the block, in the order in which those due at once are asked.
    parts: Vec<BlockPart>,
    /// Until when each of them surely touches nothing, soonest first: the bits of the time (s), which rise with it as times are not
    /// negative, and its place among the parts.
    due_times: BinaryHeap<Reverse<(u64, u32)>>,
    ahead: FeaturesAhead,
    corners: CornerMotions,
}

impl BlockFlight<'_> {
    /// Where it is and how it is turned after `t` (s).
    pub fn pose(&self, t: f64) -> Pose {
        Pose { centre: self.path.centre(t), attitude: self.top.attitude(t) }
    }

    /// The flight at `t` (s); `near` is a short turn that begins at its time, renewed where it reaches no further than `t`. Nothing is
    /// asked later than `ends` (s).
    fn state(&self, t: f64, ends: f64, near: &mut Option<(f64, RotationSeries)>) -> FlightState {
        let centre = self.path.centre(t);
        let known = near.as_ref().filter(|(from, turn)| t - from <= turn.valid_s);
        let attitude = if let Some((from, turn)) = known {
            turn.attitude(t - from)
        } else {
            let attitude = self.top.attitude(t);
            // at first the series of the top itself reaches on
            if !self.top.is_in_series(t) {
                *near = self.top.series_at(attitude, ends - t).map(|turn| (t, turn));
            }
            attitude
        };
        let pose = Pose { centre, attitude };
        let (spin, angular) =
            (self.top.spin(&attitude), self.top.angular_acceleration_rad_s2(&attitude));
        FlightState { time_s: t, pose, velocity: self.path.velocity(t), spin, angular }
    }
}

/// Follows the flight for at most `longest_s`; `near` is overwritten.
///
/// Alternates between two gaits: where the ball around the block is free, it is leapt ahead to its
/// own touch, exactly; where it is not, the block goes on window by window. Both end at the same
/// time as a search without windows would.
pub fn first_touch(
    terrain: &Terrain,
    flight: &BlockFlight,
    longest_s: f64,
    (near, scratch): (&mut Neighbours, &mut WindowScratch),
) -> FlightEnd {
    let (block, mut t) = (flight.block, 0.0);
    loop {
        let centre = flight.path.centre(t);
        // as long as nothing is within the bounding ball the block cannot touch: its leap is exact,
        // in place of many evaluations
        if !is_within(terrain, block, &centre, near) {
            let ahead =
                Parabola { start: centre, velocity: flight.path.velocity(t), ..flight.path };
            let gone = std::mem::take(&mut near.broken_stems);
            let landing =
                time_of_impact_without(terrain, &ahead, longest_s - t, &gone, &mut near.tested);
            near.broken_stems = gone;
            match landing {
                FlightEnd::Touch(wait) => t += wait,
                FlightEnd::Leaves(wait) => return FlightEnd::Leaves(t + wait),
                FlightEnd::Flies => return FlightEnd::Flies,
            }
        }
        let way = known_path_m(terrain, block, &flight.path.centre(t), near);
        // within this time the centre stays inside the ball for which features were collected
        let speed = flight.path.velocity(t).norm();
        let ends = (t + min_travel_time_s(way, speed, flight.path.gravity)).min(longest_s);
        if let Some(touch) = advance(terrain, flight, near, (t, ends), scratch) {
            return FlightEnd::Touch(touch);
        }
        if ends >= longest_s {
            return FlightEnd::Flies;
        }
        t = ends;
    }
}

/// Whether a triangle is within the ball around a block at `centre`.
/// Where they are known no more are looked for; else the index is walked once, and what it finds is not kept.
fn is_within(terrain: &Terrain, block: &Block, centre: &Vec3, near: &mut Neighbours) -> bool {
    let reach = block.bound_m;
    let is_near = |t: u32| (closest_on(&terrain.corners_m(t), centre) - centre).norm() < reach;
    let (mut within, mut tested) = (false, 0);
    if near.block_margin_m(centre, (block.ball_m, block.bound_m)) >= 0.0 {
        within = near.triangles().iter().inspect(|_| tested += 1).any(|t| is_near(*t));
    } else {
        terrain.index.near(centre, reach, |start, count| {
            for t in start..start + count {
                tested += 1;
                within = within || !terrain.is_gone(t, &near.broken_stems) && is_near(t);
            }
        });
    }
    near.tested += tested;
    within
}

/// How far the centre of a block may go from `centre` among the features that are known (m): those around it are collected if that is not
/// far.
fn known_path_m(terrain: &Terrain, block: &Block, centre: &Vec3, near: &mut Neighbours) -> f64 {
    let way = WINDOW * block.bound_m;
    let room = near.block_margin_m(centre, (block.ball_m, block.bound_m));
    if room >= MIN_WINDOW * block.bound_m {
        return room.min(way);
    }
    // corners sit up to so far from the centre: what they can meet is that much farther than what the centre can
    let core = block.bound_m - block.ball_m;
    near.collect(terrain, centre, block.ball_m, core + way, block.ball_m);
    way
}

/// First touch within a window of time, among what was collected.
///
/// Always moves the part that is due first. A part that may touch now ends the search; all others
/// are due later, so nothing touched before.
fn advance(
    terrain: &Terrain,
    flight: &BlockFlight,
    near: &mut Neighbours,
    (begins, ends): (f64, f64),
    scratch: &mut WindowScratch,
) -> Option<f64> {
    let core = &flight.block.core;
    let WindowScratch { parts, due_times, ahead, corners } = scratch;
    ahead.collect(terrain, flight, near, (begins, ends));
    corners.begin(core.corners.len());
    parts.clear();
    // on ground without sharp edges or vertices only corners can touch
    let at_most = |count: usize, is_met: bool| if is_met { count } else { 0 };
    parts.extend(
        (0..at_most(core.corners.len(), !ahead.triangles.is_empty())).map(BlockPart::Corner),
    );
    parts.extend((0..at_most(core.ridges.len(), !ahead.edges.is_empty())).map(BlockPart::Ridge));
    parts.extend((0..at_most(core.faces.len(), !ahead.vertices.is_empty())).map(BlockPart::Face));
    let due = |time: f64, part: u32| Reverse((time.to_bits(), part));
    due_times.clear();
    let all = if begins < ends { parts.len() as u32 } else { 0 };
    due_times.extend((0..all).map(|part| due(begins, part)));
    let (bounds, mut series) = (flight.top.point_bounds(), None);
    let state = flight.state(begins, ends, &mut series);
    let tested = &mut near.tested;
    let mut search = WindowSearch { terrain, flight, ahead, bounds, state, corners, tested };
    while let Some(Reverse((bits, part))) = due_times.pop() {
        let time = f64::from_bits(bits);
        // the attitude is worked out once a moment, for all parts due then
        if time > search.state.time_s {
            search.state = flight.state(time, ends, &mut series);
        }
        let left = ends - time;
        let step = search.safe_step(parts[part as usize], left);
        // what rounding leaves of a window is shorter than any step, and no touch
        if step < left && (step < MIN_STEP_S || time + step <= time) {
            return Some(time);
        }
        if time + step < ends {
            due_times.push(due(time + step, part));
        }
    }
    None
}

#[cfg(test)]
mod tests;

//! First contact of a block in free flight: a conservative bound that cannot miss one.
//!
//! The flight of the bounding ball is advanced exactly to its own first contact; no part of the
//! block touches before. From there the parts of the block are advanced feature by feature
//! (conservative advancement). The distance of a corner from a convex set is a convex function of
//! its position. So with the present distance `d`, direction `n`, velocity `ṗ` and acceleration
//! `p̈`
//!
//! ```text
//! d(t+τ) ≥ d + n·ṗ τ + ½ n·p̈ τ² − ⅙ J τ³ ≥ d + n·ṗ τ − ½ B τ²   for τ ≤ T,   B = min(g + ρ b₂, −n·p̈ + ⅓ J T),   J = ρ b₃
//! ```
//!
//! where `ρ b₂` and `ρ b₃` bound the acceleration and the jerk of the corner due to the rotation
//! (`top::PointBounds`). With the speed of approach `c = −n·ṗ` and the gap `δ = d − r` the step `τ
//! = 2δ/(c + √(c² + 2Bδ))` is never too long, and near a contact it converges faster than Newton's
//! method, from one side. Edges and faces of the block are hulls of corners: with `n` from their
//! own nearest points the same bound holds for each of their corners.
//!
//! Frames: corners are fixed in the block's principal frame; `attitude` rotates them to the
//! terrain's. `ρ` is a corner's distance from the centre of mass (m), `r` the radius of the balls
//! at the corners (m). Cost: about ten evaluations per corner for a second of flight without
//! windows, most of them in the last window before the contact.

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

/// Shortest step (s): a contact sooner than this is now. A shorter step could not be resolved at
/// times of some hundred seconds.
const MIN_STEP_S: f64 = 1e-13;
/// Path of the centre covered by one collection of features (–, relative to the radius of the
/// bounding ball). Longer windows collect more features, shorter ones collect more often.
const WINDOW: f64 = 0.5;
/// An existing collection is reused if it covers a window of at least this length (–, relative to
/// the radius of the bounding ball).
const MIN_WINDOW: f64 = 0.1;

/// Rounding of a sum of three products, with a margin (–): a feature is skipped as distant only if
/// it is so for certain.
const ROUNDING_MARGIN: f64 = 1e-12;

/// A gap that counts as touching (–, relative to the radius of the sphere of equal volume): a tenth
/// of the gap at which contact begins, so that a contact found here is a contact there.
const TOUCHING: f64 = 1e-10;

/// A block in free flight.
#[derive(Debug)]
pub struct BlockFlight<'a> {
    /// The block.
    pub block: &'a Block,
    /// Its rotation.
    pub top: Top,
    /// Path of its centre, with the radius of the bounding ball.
    pub path: Parabola,
}

/// State of the flight at one time.
struct FlightState {
    /// Time since the flight began (s).
    time_s: f64,
    /// Centre (m) and attitude.
    pose: Pose,
    /// Velocity of the centre (m/s).
    velocity: Vec3,
    /// Angular velocity (rad/s) and acceleration (rad/s²) in the frame of the terrain.
    spin: Vec3,
    angular: Vec3,
}

/// A part of the block that may touch.
///
/// Parts are processed in the order of the times until which they certainly touch nothing.
#[derive(Debug, Clone, Copy)]
enum BlockPart {
    /// A rounded corner against faces, edges and vertices of the mesh.
    Corner(usize),
    /// An edge of the block against convex edges of the mesh.
    Ridge(usize),
    /// A face of the block against convex vertices of the mesh.
    Face(usize),
}

/// Work space of a flight; lists keep their memory from window to window.
#[derive(Debug, Default)]
pub struct WindowScratch {
    /// Parts of the block, in the order in which those due at the same time are processed.
    parts: Vec<BlockPart>,
    /// For each part the time until which it certainly touches nothing, soonest first: the bits of
    /// the time (s), which grow with it as times are not negative, and the index of the part.
    due_times: BinaryHeap<Reverse<(u64, u32)>>,
    ahead: FeaturesAhead,
    corners: CornerMotions,
}

impl BlockFlight<'_> {
    /// Its position and attitude after `t` (s).
    pub fn pose(&self, t: f64) -> Pose {
        Pose { centre: self.path.centre(t), attitude: self.top.attitude(t) }
    }

    /// The state at `t` (s). `local` holds a series that begins at its own time and is renewed if it
    /// is not valid up to `t`; no time later than `ends` (s) will be evaluated.
    fn state(&self, t: f64, ends: f64, local: &mut Option<(f64, RotationSeries)>) -> FlightState {
        let centre = self.path.centre(t);
        let valid = local.as_ref().filter(|(from, series)| t - from <= series.valid_s);
        let attitude = if let Some((from, series)) = valid {
            series.attitude(t - from)
        } else {
            let attitude = self.top.attitude(t);
            // at first the series of the top itself is valid
            if !self.top.is_in_series(t) {
                *local = self.top.series_at(attitude, ends - t).map(|series| (t, series));
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
/// Alternates between two kinds of step. If nothing is inside the bounding ball, the flight is
/// advanced exactly to the ball's own contact; otherwise the block is advanced window by window.
/// The result is the time that a search without windows would give.
pub fn first_touch(
    terrain: &Terrain,
    flight: &BlockFlight,
    longest_s: f64,
    (near, scratch): (&mut Neighbours, &mut WindowScratch),
) -> FlightEnd {
    let (block, mut t) = (flight.block, 0.0);
    loop {
        let centre = flight.path.centre(t);
        // as long as nothing is inside the bounding ball the block cannot touch: one exact step
        // replaces many evaluations
        if !is_within(terrain, block, &centre, near) {
            let ahead =
                Parabola { start: centre, velocity: flight.path.velocity(t), ..flight.path };
            let broken_stems = std::mem::take(&mut near.broken_stems);
            let ball_contact = time_of_impact_without(
                terrain,
                &ahead,
                longest_s - t,
                &broken_stems,
                &mut near.tested,
            );
            near.broken_stems = broken_stems;
            match ball_contact {
                FlightEnd::Touch(after_s) => t += after_s,
                FlightEnd::Leaves(after_s) => return FlightEnd::Leaves(t + after_s),
                FlightEnd::Flies => return FlightEnd::Flies,
            }
        }
        let path_m = known_path_m(terrain, block, &flight.path.centre(t), near);
        // within this time the centre stays inside the ball for which features were collected
        let speed = flight.path.velocity(t).norm();
        let ends = (t + min_travel_time_s(path_m, speed, flight.path.gravity)).min(longest_s);
        if let Some(touch) = advance(terrain, flight, near, (t, ends), scratch) {
            return FlightEnd::Touch(touch);
        }
        if ends >= longest_s {
            return FlightEnd::Flies;
        }
        t = ends;
    }
}

/// Whether a triangle is inside the bounding ball of a block at `centre`. Known triangles are used
/// if the collection covers them; otherwise the index is traversed once, and the result is not
/// kept.
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

/// How far the centre of a block may move from `centre` among known features (m); they are
/// collected anew if that is too short.
fn known_path_m(terrain: &Terrain, block: &Block, centre: &Vec3, near: &mut Neighbours) -> f64 {
    let path_m = WINDOW * block.bound_m;
    let margin_m = near.block_margin_m(centre, (block.ball_m, block.bound_m));
    if margin_m >= MIN_WINDOW * block.bound_m {
        return margin_m.min(path_m);
    }
    // corners are up to this far from the centre, and so are the features they can touch
    let core = block.bound_m - block.ball_m;
    near.collect(terrain, centre, block.ball_m, core + path_m, block.ball_m);
    path_m
}

/// First contact (s) within a time window, among the collected features.
///
/// Always advances the part that is due first. A part that may touch now ends the search; all
/// others are due later, so none has touched before.
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
    // on ground without convex edges or vertices only corners can touch
    let at_most = |count: usize, has_targets: bool| if has_targets { count } else { 0 };
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
        // the state is computed once per time, for all parts due then
        if time > search.state.time_s {
            search.state = flight.state(time, ends, &mut series);
        }
        let left = ends - time;
        let step = search.safe_step(parts[part as usize], left);
        // a remainder of the window due to rounding is shorter than any step, and no contact
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

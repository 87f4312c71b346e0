//! First touch of a block in free flight: a bound that cannot miss.
//!
//! The ball around the block is leapt ahead exactly; nothing touches before it does. From there the block is gone along feature by
//! feature (conservative advancement). The distance of a corner to a convex set is a convex function of its place, so with the present
//! distance `d`, direction `n` and velocity `ṗ`
//!
//! ```text
//! d(t+τ) ≥ d + n·ṗ τ − ½ B τ²,   B = g + ρ (ω_m² + α_m),   ω_m² = 2E/I_min,   α_m = ω_m² (I_max − I_min)/I_min
//! ```
//!
//! as `|ω|² ≤ ω_m²` and `|ω̇| ≤ α_m` for a body without torque. With the speed of approach `c = −n·ṗ` and the gap `δ = d − r` the step
//! `τ = 2δ/(c + √(c² + 2Bδ))` is never too long, and near a touch it converges like Newton's method from one side. Edges and faces of the
//! block are hulls of corners: with `n` from their own nearest points the same bound holds for each of their corners.
//!
//! Frames: corners are fixed in the block's principal frame; `attitude` turns them to the
//! terrain's. `ρ` is a corner's distance from the centre of mass (m), `r` the radius of the balls
//! at the corners (m). Cost: about ten evaluations a corner over a second of flight without any
//! window, most of them in the last window before the touch.

mod window;

use super::top::{ShortTurn, Top};
use super::{FlightEnd, Parabola, time_of_impact_past};
use crate::body::Block;
use crate::contact::block::Pose;
use crate::contact::closest::closest_on;
use crate::contact::neighbours::Neighbours;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use window::{Flying, WindowSearch};

/// No step forward is shorter (s): what comes so soon touches now.
/// Below it the time could not be told from the one before, at times of some hundred seconds.
const SHORTEST_S: f64 = 1e-13;
/// Way of the centre for which features are collected at a time (–, relative to the radius of the ball around).
/// Longer windows collect more features, shorter ones collect more often.
const WINDOW: f64 = 0.5;

/// A block in free flight.
#[derive(Debug, Clone, Copy)]
pub struct Tumble<'a> {
    /// The block.
    pub block: &'a Block,
    /// Its rotation.
    pub top: Top,
    /// Way of its centre, with the radius of the ball around it.
    pub path: Parabola,
}

/// A moment of the flight.
struct Moment {
    /// Centre (m) and attitude.
    pose: Pose,
    /// Of the centre (m/s).
    velocity: Vec3,
    /// Angular velocity in the frame of the terrain (rad/s).
    spin: Vec3,
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
    dues: BinaryHeap<Reverse<(u64, u32)>>,
    /// A corner and the unit normal of every triangle near: looked up once a window, asked hundreds of times.
    planes: Vec<(Vec3, Vec3)>,
    /// Corners of a face.
    corners: Vec<Flying>,
}

impl Tumble<'_> {
    /// Where it is and how it is turned after `t` (s).
    pub fn pose(&self, t: f64) -> Pose {
        Pose { centre: self.path.centre(t), attitude: self.top.attitude(t) }
    }

    /// The flight at `t` (s); `near` is a short turn that begins at its time, renewed where it reaches no further than `t`. Nothing is
    /// asked later than `ends` (s).
    fn moment(&self, t: f64, ends: f64, near: &mut Option<(f64, ShortTurn)>) -> Moment {
        let centre = self.path.centre(t);
        let known = near.as_ref().filter(|(from, turn)| t - from <= turn.holds_s);
        let attitude = if let Some((from, turn)) = known {
            turn.attitude(t - from)
        } else {
            let attitude = self.top.attitude(t);
            *near = self.top.short(attitude, ends - t).map(|turn| (t, turn));
            attitude
        };
        let pose = Pose { centre, attitude };
        let spin = self.top.spin(&pose.attitude);
        Moment { pose, velocity: self.path.velocity(t), spin }
    }

    /// Largest size of `ω × (ω × ρ) + ω̇ × ρ` over the length of `ρ` (1/s²).
    ///
    /// `ω_m² + α_m` of the head of this file: a free body's `|ω|² ≤ 2E/I_min`, and `|ω̇| ≤ ω_m²
    /// (I_max − I_min)/I_min` by Euler's equations. Times `ρ` it bounds the acceleration of a point
    /// relative to the centre of mass.
    fn bend(&self) -> f64 {
        let [low, high] = [f64::min, f64::max]
            .map(|pick| self.block.inertia_kg_m2.into_iter().reduce(pick).unwrap_or(1.0));
        let spin2 = 2.0 * self.top.energy_j() / low;
        spin2 * (1.0 + (high - low) / low)
    }

    /// Collects what the block can touch while its centre moves up to `way` (m) from `centre`.
    pub fn collect(
        block: &Block,
        near: &mut Neighbours,
        terrain: &Terrain,
        (centre, way): (&Vec3, f64),
    ) {
        // corners sit up to `bound − ball` from the centre: what they can meet is that much farther
        // than what the centre can
        let core = block.bound_m - block.ball_m;
        near.collect(terrain, centre, block.ball_m, core + way, block.ball_m);
    }
}

/// Follows the flight for at most `longest_s`; `near` is overwritten.
///
/// Alternates between two gaits: where the ball around the block is free, it is leapt ahead to its
/// own touch, exactly; where it is not, the block goes on window by window. Both end at the same
/// time as a search without windows would.
pub fn first_touch(
    terrain: &Terrain,
    tumble: &Tumble,
    longest_s: f64,
    (near, scratch): (&mut Neighbours, &mut WindowScratch),
) -> FlightEnd {
    let (bound, mut t) = (tumble.block.bound_m, 0.0);
    loop {
        let centre = tumble.path.centre(t);
        // as long as nothing is within the bounding ball the block cannot touch: its leap is exact,
        // in place of many evaluations
        if !is_within(terrain, &centre, bound, near) {
            let ahead =
                Parabola { start: centre, velocity: tumble.path.velocity(t), ..tumble.path };
            let gone = std::mem::take(&mut near.gone);
            let landing =
                time_of_impact_past(terrain, &ahead, longest_s - t, &gone, &mut near.tested);
            near.gone = gone;
            match landing {
                FlightEnd::Touch(wait) => t += wait,
                FlightEnd::Leaves(wait) => return FlightEnd::Leaves(t + wait),
                FlightEnd::Flies => return FlightEnd::Flies,
            }
        }
        let way = WINDOW * bound;
        // within this time the centre stays inside the ball for which features were collected
        let ends = (t + time_for(&tumble.path, t, way)).min(longest_s);
        Tumble::collect(tumble.block, near, terrain, (&tumble.path.centre(t), way));
        if let Some(touch) = advance(terrain, tumble, near, (t, ends), scratch) {
            return FlightEnd::Touch(touch);
        }
        if ends >= longest_s {
            return FlightEnd::Flies;
        }
        t = ends;
    }
}

/// Whether a triangle is nearer to a point than `reach` (m).
/// Walks the index once; what it finds is not kept.
fn is_within(terrain: &Terrain, point: &Vec3, reach: f64, near: &mut Neighbours) -> bool {
    let (mut within, mut tested) = (false, 0);
    terrain.index.near(point, reach, |start, count| {
        for t in start..start + count {
            tested += 1;
            within = within
                || !terrain.is_gone(t, &near.gone)
                    && (closest_on(&terrain.corners_m(t), point) - point).norm() < reach;
        }
    });
    near.tested += tested;
    within
}

/// A time in which the centre surely moves no further than `way` (m) from where it is at `t`.
fn time_for(path: &Parabola, t: f64, way: f64) -> f64 {
    // way ≥ |v| t + g t²/2, solved for t without cancellation
    let speed = path.velocity(t).norm();
    2.0 * way / (speed + (speed * speed + 2.0 * path.gravity * way).sqrt())
}

/// First touch within a window of time, among what was collected.
///
/// Always moves the part that is due first. A part that may touch now ends the search; all others
/// are due later, so nothing touched before.
fn advance(
    terrain: &Terrain,
    tumble: &Tumble,
    near: &mut Neighbours,
    (begins, ends): (f64, f64),
    scratch: &mut WindowScratch,
) -> Option<f64> {
    let core = &tumble.block.core;
    // on ground without sharp edges or peaks only corners can touch
    let (edges, peaks) = (near.sharp_edges().next().is_some(), near.peaks().next().is_some());
    scratch.parts.clear();
    scratch.parts.extend((0..core.corners.len()).map(BlockPart::Corner));
    scratch.parts.extend((0..core.ridges.len()).filter(|_| edges).map(BlockPart::Ridge));
    scratch.parts.extend((0..core.faces.len()).filter(|_| peaks).map(BlockPart::Face));
    let due = |time: f64, part: u32| Reverse((time.to_bits(), part));
    scratch.dues.clear();
    let all = if begins < ends { scratch.parts.len() as u32 } else { 0 };
    scratch.dues.extend((0..all).map(|part| due(begins, part)));
    scratch.planes.clear();
    let plane = |t: &u32| {
        let face = terrain.face(*t);
        (face.a, face.n)
    };
    scratch.planes.extend(near.triangles().iter().map(plane));
    let bend = tumble.bend();
    let mut short = None;
    let moment = tumble.moment(begins, ends, &mut short);
    let mut search = WindowSearch { terrain, tumble, near, bend, moment };
    let mut now = begins;
    while let Some(Reverse((bits, part))) = scratch.dues.pop() {
        let time = f64::from_bits(bits);
        // the attitude is worked out once a moment, for all parts due then
        if time > now {
            now = time;
            search.moment = tumble.moment(now, ends, &mut short);
        }
        let step = search.safe_step(scratch.parts[part as usize], ends - now, scratch);
        if step < SHORTEST_S {
            return Some(now);
        }
        if now + step < ends {
            scratch.dues.push(due(now + step, part));
        }
    }
    None
}

#[cfg(test)]
mod tests;

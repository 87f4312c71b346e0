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

use super::top::Top;
use super::{FlightEnd, Parabola, time_of_impact_past};
use crate::body::Block;
use crate::contact::block::Pose;
use crate::contact::closest::closest_on;
use crate::contact::neighbours::Neighbours;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A gap that counts as touching (–, relative to the radius of the sphere of equal volume).
/// A tenth of the gap at which contact begins: what is found here is a touch there.
const TOUCHING: f64 = 1e-10;
/// No step forward is shorter (s): what comes so soon touches now.
/// Below it the time could not be told from the one before, at times of some hundred seconds.
const SHORTEST_S: f64 = 1e-13;
/// Rounding of a sum of three products, with room (–): what is skipped because it is far away must be so for certain.
const CAUTION: f64 = 1e-12;
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
#[derive(Clone, Copy)]
enum BlockPart {
    /// A rounded corner against faces, edges and vertices of the mesh.
    Corner(usize),
    /// An edge of the block against edges of the mesh that stand out.
    Ridge(usize),
    /// A face of the block against vertices of the mesh that stand out.
    Face(usize),
}

/// Work space of a flight; lists keep their memory from window to window.
#[derive(Default)]
struct WindowScratch {
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

    fn moment(&self, t: f64) -> Moment {
        let pose = self.pose(t);
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
    near: &mut Neighbours,
) -> FlightEnd {
    let (bound, mut t) = (tumble.block.bound_m, 0.0);
    let mut scratch = WindowScratch::default();
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
        if let Some(touch) = advance(terrain, tumble, near, (t, ends), &mut scratch) {
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
    let mut search = WindowSearch { terrain, tumble, near, bend, moment: tumble.moment(begins) };
    let mut now = begins;
    while let Some(Reverse((bits, part))) = scratch.dues.pop() {
        let time = f64::from_bits(bits);
        // the attitude is a closed form, but dear (elliptic functions): once a moment, for all
        // parts due then
        if time > now {
            now = time;
            search.moment = tumble.moment(now);
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

/// The search of a window at one moment.
struct WindowSearch<'a> {
    terrain: &'a Terrain,
    tumble: &'a Tumble<'a>,
    near: &'a mut Neighbours,
    bend: f64,
    moment: Moment,
}

/// A corner as it flies.
/// Position `p` (m), velocity (m/s) in the frame of the terrain.
#[derive(Clone, Copy)]
struct Flying {
    p: Vec3,
    velocity: Vec3,
    /// Largest acceleration (m/s²).
    bend: f64,
}

impl WindowSearch<'_> {
    fn flying(&self, k: usize) -> Flying {
        let own = &self.tumble.block.core.corners[k];
        let arm = self.moment.pose.attitude * own;
        // v + ω × ρ, and the bound g + ρ (ω_m² + α_m) on its acceleration
        Flying {
            p: self.moment.pose.centre + arm,
            velocity: self.moment.velocity + self.moment.spin.cross(&arm),
            bend: self.tumble.path.gravity + own.norm() * self.bend,
        }
    }

    /// How long a corner surely keeps off a plane with unit normal `n` through `q` (s).
    ///
    /// `τ = 2δ/(c + √(c² + 2Bδ))` while it approaches, `(√(c² + 2Bδ) − c)/B` while it parts (`c ≤
    /// 0`): then gravity and spin need time to turn it round. Both are the positive root of `δ − c
    /// τ − B τ²/2 = 0`, each in the form without cancellation.
    fn safe(&self, corner: &Flying, n: &Vec3, q: &Vec3) -> f64 {
        let gap = n.dot(&(corner.p - q)) - self.tumble.block.ball_m;
        let closing = -n.dot(&corner.velocity);
        let touching = TOUCHING * self.tumble.block.radius_m;
        // only an approach touches: a corner that has just left lies within the same gap and must
        // be free to go
        if closing > 0.0 && gap <= touching {
            return 0.0;
        }
        let root = (closing * closing + 2.0 * corner.bend * gap.max(0.0)).sqrt();
        if closing > 0.0 {
            2.0 * gap / (closing + root)
        } else if corner.bend > 0.0 {
            (root - closing) / corner.bend
        } else {
            f64::INFINITY
        }
    }

    /// Whether [`Self::safe`] is surely not less than `least` (s): the same bound without its root.
    #[inline]
    fn keeps_off(&self, corner: &Flying, (gap, closing): (f64, f64), least: f64) -> bool {
        let bent = 0.5 * corner.bend * least;
        let rounding = CAUTION * (closing.abs() + bent);
        gap > TOUCHING * self.tumble.block.radius_m && gap >= least * (closing + bent + rounding)
    }

    /// How long a part surely touches nothing (s), no longer than `most`.
    fn safe_step(&mut self, part: BlockPart, most: f64, scratch: &mut WindowScratch) -> f64 {
        match part {
            BlockPart::Corner(k) => self.of_corner(k, most, &scratch.planes),
            BlockPart::Ridge(k) => self.of_ridge(k, most),
            BlockPart::Face(k) => self.of_face(k, most, &mut scratch.corners),
        }
    }

    fn of_corner(&mut self, k: usize, mut least: f64, planes: &[(Vec3, Vec3)]) -> f64 {
        let corner = self.flying(k);
        let ball = self.tumble.block.ball_m;
        self.near.tested += self.near.triangles().len() as u64;
        for (&t, (a, n)) in self.near.triangles().iter().zip(planes) {
            let (height, climbs) = (n.dot(&(corner.p - a)), n.dot(&corner.velocity));
            let closing = if height < 0.0 { climbs } else { -climbs };
            // the plane is never farther than the triangle
            if self.keeps_off(&corner, (height.abs() - ball, closing), least) {
                continue;
            }
            let side = if height < 0.0 { -n } else { *n };
            if self.safe(&corner, &side, a) >= least {
                continue;
            }
            // the true distance of a convex set is never less than that of its own supporting plane
            // at the nearest point
            let q = closest_on(&self.terrain.corners_m(t), &corner.p);
            // a corner exactly on the triangle has no direction: the plane's normal on its side
            // stands in
            let n = (corner.p - q).try_normalize(0.0).unwrap_or(side);
            least = least.min(self.safe(&corner, &n, &q));
        }
        least
    }

    /// An edge of the block: with `n` from the nearest points of two segments, the plane square to
    /// `n` keeps both apart, and the ridge stays on its side as long as both its ends do.
    fn of_ridge(&self, k: usize, mut least: f64) -> f64 {
        let ends = self.tumble.block.core.ridges[k].ends.map(|end| self.flying(usize::from(end)));
        let [a, b] = ends;
        let (middle, half) = ((a.p + b.p) * 0.5, 0.5 * (b.p - a.p).norm());
        let bend = a.bend.max(b.bend);
        let fastest = a.velocity.norm().max(b.velocity.norm());
        for edge in self.near.sharp_edges() {
            // distance of the ridge's middle to the edge less half a ridge: a lower bound without
            // the nearest points
            let along = edge.along.dot(&(middle - edge.a)).clamp(0.0, edge.length);
            let room =
                (middle - edge.a - edge.along * along).norm() - half - self.tumble.block.ball_m;
            // far away: whatever the directions
            if room > 0.0 && least * (fastest + 0.5 * bend * least) <= room {
                continue;
            }
            let far = edge.a + edge.along * edge.length;
            let (p, q) = nearest_of_segments((a.p, b.p), (edge.a, far));
            let Some(n) = (p - q).try_normalize(0.0) else { continue };
            for end in &ends {
                least = least.min(self.safe(end, &n, &q));
            }
        }
        least
    }

    /// A face of the block against a vertex of the mesh: nearest point over a fan of triangles,
    /// then the bound for all corners of the face.
    fn of_face(&self, k: usize, mut least: f64, corners: &mut Vec<Flying>) -> f64 {
        let face = &self.tumble.block.core.faces[k];
        corners.clear();
        corners.extend(face.corners.iter().map(|&k| self.flying(usize::from(k))));
        let most = |of: fn(&Flying) -> f64| corners.iter().map(of).fold(0.0, f64::max);
        let (bend, fastest) = (most(|c| c.bend), most(|c| c.velocity.norm()));
        let middle = corners.iter().map(|c| c.p).sum::<Vec3>() / corners.len() as f64;
        let around = corners.iter().map(|c| (c.p - middle).norm_squared()).fold(0.0, f64::max);
        let skin = self.tumble.block.ball_m + TOUCHING * self.tumble.block.radius_m;
        let around = around.sqrt() * (1.0 + CAUTION) + skin;
        for peak in self.near.peaks() {
            // far away: whatever the directions
            let far = around + least * (fastest + 0.5 * bend * least) * (1.0 + CAUTION);
            if (peak.p - middle).norm_squared() * (1.0 - CAUTION) > far * far {
                continue;
            }
            let nearest = (1..corners.len() - 1)
                .map(|k| closest_on(&[corners[0].p, corners[k].p, corners[k + 1].p], &peak.p))
                .min_by(|a, b| (a - peak.p).norm_squared().total_cmp(&(b - peak.p).norm_squared()));
            let Some(n) = nearest.and_then(|p| (p - peak.p).try_normalize(0.0)) else { continue };
            for corner in corners.iter() {
                least = least.min(self.safe(corner, &n, &peak.p));
            }
        }
        least
    }
}

/// The nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
/// As `closest::segments_distance2`, but it tells the points: `n` is wanted, not only the distance.
fn nearest_of_segments((p1, q1): (Vec3, Vec3), (p2, q2): (Vec3, Vec3)) -> (Vec3, Vec3) {
    let (d1, d2, r) = (q1 - p1, q2 - p2, p1 - p2);
    let (a, e, f) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&r));
    let (b, c) = (d1.dot(&d2), d1.dot(&r));
    let across = a * e - b * b;
    let mut s = if across > 0.0 { ((b * f - c * e) / across).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = (b * s + f) / e;
    if t < 0.0 {
        (t, s) = (0.0, (-c / a).clamp(0.0, 1.0));
    } else if t > 1.0 {
        (t, s) = (1.0, ((b - c) / a).clamp(0.0, 1.0));
    }
    (p1 + d1 * s, p2 + d2 * t)
}

#[cfg(test)]
mod tests;

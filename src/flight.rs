//! Free flight: the exact parabola to the first touch.
//!
//! Between touches nothing but gravity acts, so the flight is leapt over: the first time at which the ball meets a
//! face (a quadratic), an edge or a corner (quartics) is solved for, over the boxes that the parabola crosses.

mod edge_windows;
pub mod block;
mod roots;
mod parabola_box;
pub mod top;
mod touching;

use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::index::{BvhNode, Child, WAITING};
use parabola_box::ParabolaBox;
use roots::quadratic;
use wide::f32x4;

/// A ball in free flight: `c(t) = start + velocity t − g t²/2 ẑ`.
#[derive(Debug, Clone, Copy)]
pub struct Parabola {
    /// Centre at time 0 (m, local).
    pub start: Vec3,
    /// Velocity at time 0 (m/s).
    pub velocity: Vec3,
    /// Gravity (m/s²), ≥ 0, along −z.
    pub gravity: f64,
    /// Radius of the ball (m).
    pub radius: f64,
}

impl Parabola {
    /// Centre at time `t` (s).
    #[inline]
    pub fn centre(&self, t: f64) -> Vec3 {
        let mut c = self.start + self.velocity * t;
        c.z -= 0.5 * self.gravity * t * t;
        c
    }

    /// Velocity at time `t` (s).
    #[inline]
    pub fn velocity(&self, t: f64) -> Vec3 {
        let mut v = self.velocity;
        v.z -= self.gravity * t;
        v
    }
}

/// How a flight ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlightEnd {
    /// Touches the mesh after so many seconds.
    Touch(f64),
    /// Has left the box of the mesh after so many seconds and will not touch it again.
    Leaves(f64),
    /// Is still flying at the end of the time allowed.
    Flies,
}

/// Follows the flight for at most `longest_s`; `tested` counts triangles.
pub fn time_of_impact(
    terrain: &Terrain,
    flight: &Parabola,
    longest_s: f64,
    tested: &mut u64,
) -> FlightEnd {
    time_of_impact_past(terrain, flight, longest_s, &[], tested)
}

/// The same past the stems that are `gone`.
pub fn time_of_impact_past(
    terrain: &Terrain,
    flight: &Parabola,
    longest_s: f64,
    gone: &[u32],
    tested: &mut u64,
) -> FlightEnd {
    let leaves = leaves_box_after(terrain, flight);
    let limit = longest_s.min(leaves);
    match first_touch(terrain, flight, limit, (gone, tested)) {
        Some(t) => FlightEnd::Touch(t),
        None if leaves <= longest_s => FlightEnd::Leaves(leaves),
        None => FlightEnd::Flies,
    }
}

/// When the ball is outside the mesh's box for good (s): beside it, or below it; without gravity also above it.
fn leaves_box_after(terrain: &Terrain, flight: &Parabola) -> f64 {
    let (lo, hi) = terrain.index.bounds();
    let (c, v, r) = (flight.start, flight.velocity, flight.radius);
    let straight = |k: usize| {
        let to = if v[k] > 0.0 { hi[k] + r } else { lo[k] - r };
        if v[k] != 0.0 {
            ((to - c[k]) / v[k]).max(0.0)
        } else if c[k] > hi[k] + r || c[k] < lo[k] - r {
            0.0
        } else {
            f64::INFINITY
        }
    };
    let upright = if flight.gravity > 0.0 {
        // A ball that never comes up to the floor is below it from the start.
        let floor = quadratic(-0.5 * flight.gravity, v.z, c.z - (lo.z - r));
        floor.map_or(0.0, |(_, last)| last.max(0.0))
    } else {
        straight(2)
    };
    straight(0).min(straight(1)).min(upright)
}

/// Time at which the ball first touches the mesh, within `limit` (s).
fn first_touch(
    terrain: &Terrain,
    flight: &Parabola,
    limit: f64,
    (gone, tested): (&[u32], &mut u64),
) -> Option<f64> {
    let nodes = terrain.index.nodes();
    if nodes.is_empty() {
        return None;
    }
    let slabs = ParabolaBox::new(flight);
    let mut best = limit;
    let mut found = false;
    let mut stack = [Waiting::default(); WAITING];
    stack[0].ends = f32::INFINITY;
    let mut top = 1;
    while top > 0 {
        top -= 1;
        let Waiting { child, begins, ends } = stack[top];
        let (from, to) = (f64::from(begins), f64::from(ends));
        if from >= best && found {
            continue;
        }
        match Child::of(child) {
            Child::Inner(next) => {
                let node = &nodes[next as usize];
                top = wait(&mut stack, top, node, slabs.windows(node, best));
            }
            Child::Leaf(start, count) => {
                for triangle in start..start + count {
                    let window = (from, least(to, best));
                    if window.0 > window.1 {
                        break;
                    }
                    *tested += 1;
                    if terrain.is_gone(triangle, gone) {
                        continue;
                    }
                    if let Some(t) = touching::of_triangle(terrain, triangle, flight, window) {
                        best = t;
                        found = true;
                    }
                }
            }
        }
    }
    found.then_some(best)
}

/// A child of a node whose box the ball passes during a window of time (s).
#[derive(Clone, Copy, Default)]
struct Waiting {
    child: u32,
    begins: f32,
    ends: f32,
}

/// Puts the children with a window on the stack, the first to be passed on top; returns the stack's new height.
#[inline]
fn wait(
    stack: &mut [Waiting; WAITING],
    mut top: usize,
    node: &BvhNode,
    (begins, ends): (f32x4, f32x4),
) -> usize {
    let bottom = top;
    let mut passed = begins.simd_le(ends).to_bitmask();
    let (begins, ends) = (begins.to_array(), ends.to_array());
    while passed != 0 {
        let side = passed.trailing_zeros() as usize % begins.len();
        passed &= passed - 1;
        let mut place = top;
        while place > bottom && stack[place - 1].begins < begins[side] {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = Waiting { child: node.word(side), begins: begins[side], ends: ends[side] };
        top += 1;
    }
    top
}

/// The lesser of two numbers, neither of them NaN: one instruction.
#[inline]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The greater of two numbers, neither of them NaN.
#[inline]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

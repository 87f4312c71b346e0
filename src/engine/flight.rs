//! Free flight: the exact parabola to the first contact.
//!
//! Between contacts only gravity acts, so a flight needs no time steps: the first time at which the
//! ball touches a face (a quadratic), an edge or a corner (quartics) is computed over the boxes
//! that the parabola crosses.
//!
//! Why no time step: a rock of 0.3 m at 30 m/s moves by its own radius in 10 ms, so a stepped
//! flight must either step in milliseconds or tunnel through thin sheets. The roots cost some
//! microseconds a flight, whatever its length, and the gap at the contact is about 1e-12 m. Air
//! drag is left out; with it the path would not be a polynomial.
//!
//! Search: the boxes of the index in the order in which the ball enters them, each with the time
//! window in which the ball is inside. A contact found shortens all later windows. On 100 000
//! triangles a flight of a second visits about 50 nodes, 30 triangles and one or two quartics;
//! twice as many triangles in the same area cost little more until they become smaller than the
//! rock.

mod edge_windows;
pub mod block;
mod roots;
mod parabola_box;
pub mod top;
mod triangle_impact;

use crate::math;
use crate::rock::{Motion, Vec3};
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
    /// The parabola of a ball that continues from a motion.
    pub fn of(from: &Motion, gravity: f64, radius: f64) -> Self {
        Self { start: from.position_m, velocity: from.velocity_m_s, gravity, radius }
    }

    /// The parabola through two states between which nothing was touched, its gravity taken from
    /// the change of velocity.
    pub fn between(from: &Motion, to: &Motion, radius: f64) -> Self {
        let dt = to.time_s - from.time_s;
        let gravity = ((from.velocity_m_s.z - to.velocity_m_s.z) / dt).max(0.0);
        let mut velocity = (to.position_m - from.position_m) / dt;
        velocity.z += 0.5 * gravity * dt;
        Self { start: from.position_m, velocity, gravity, radius }
    }

    /// Centre at time `t` (s): `c0 + v0 t − g t²/2 ẑ`.
    #[inline]
    pub fn centre(&self, t: f64) -> Vec3 {
        let mut c = self.start + self.velocity * t;
        c.z -= 0.5 * self.gravity * t * t;
        c
    }

    /// Velocity at time `t` (s): `v0 − g t ẑ`.
    #[inline]
    pub fn velocity(&self, t: f64) -> Vec3 {
        let mut v = self.velocity;
        v.z -= self.gravity * t;
        v
    }

    /// Time within a span (s) at which the centre is highest above ground that rises at `rise_m_s`
    /// (m/s) below it: where it climbs at that rate, or an end of the span.
    #[inline]
    pub fn highest_over(&self, rise_m_s: f64, [from_s, to_s]: [f64; 2]) -> f64 {
        // for NaN (no gravity and no climb) `max` returns the first end
        ((self.velocity.z - rise_m_s) / self.gravity).max(from_s).min(to_s)
    }
}

/// Least time (s) to travel `distance_m` (m) from an initial `speed` (m/s), if gravity
/// accelerates the motion all along.
pub(crate) fn min_travel_time_s(distance_m: f64, speed: f64, gravity: f64) -> f64 {
    // distance ≥ |v| t + g t²/2, solved for t without cancellation
    2.0 * distance_m / (speed + (speed * speed + 2.0 * gravity * distance_m).sqrt())
}

/// How a flight ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlightEnd {
    /// Touches the mesh after this time (s).
    Touch(f64),
    /// Passes the last ground below it after this time (s) and will not touch the mesh again.
    Leaves(f64),
    /// Is still in flight at the end of the time allowed.
    Flies,
}

/// Follows the flight for at most `longest_s`; `tested` counts triangles.
///
/// At the contact the distance to the mesh equals the radius to about 1e-12 m and decreases. A ball
/// that starts on the mesh and moves into it touches after 0 s, one that moves away does not.
pub fn time_of_impact(
    terrain: &Terrain,
    flight: &Parabola,
    longest_s: f64,
    tested: &mut u64,
) -> FlightEnd {
    time_of_impact_without(terrain, flight, longest_s, &[], tested)
}

/// The same without the `broken_stems`.
///
/// A broken stem remains in the index: its triangles are skipped one by one, since a rock breaks
/// few.
pub fn time_of_impact_without(
    terrain: &Terrain,
    flight: &Parabola,
    longest_s: f64,
    broken_stems: &[u32],
    tested: &mut u64,
) -> FlightEnd {
    let leaves = leaves_box_after(terrain, flight);
    // no contact after the ball has left the box, or after the time allowed
    let limit = longest_s.min(leaves);
    match first_touch(terrain, flight, limit, (broken_stems, tested)) {
        Some(t) => FlightEnd::Touch(t),
        None if leaves <= longest_s => FlightEnd::Leaves(last_over_ground(terrain, flight, leaves)),
        None => FlightEnd::Flies,
    }
}

/// Points of the last flight at which the ground below the ball is looked up.
const GROUND_SAMPLES: u32 = 64;
/// Bisections of the time between two of them: 2⁻⁴⁰ of a flight is less than its rounding on a map.
const BISECTIONS: u32 = 40;

/// When a ball that touches nothing any more, and `leaves` its box, passes the last ground below it
/// (s): the border of the mesh, however it runs, or the rim of a hole. Below that it would only
/// fall, with a speed that no rock has; and no rock flies on under the slope.
///
/// Evaluated once per rock.
fn last_over_ground(terrain: &Terrain, flight: &Parabola, leaves: f64) -> f64 {
    let has_ground = |at: &Vec3| terrain.ground_under(at.x, at.y, at.z).is_some();
    let sample_s = |k: u32| leaves * f64::from(k) / f64::from(GROUND_SAMPLES);
    let mut last = None;
    for k in 0..=GROUND_SAMPLES {
        let at = flight.centre(sample_s(k));
        if has_ground(&at) {
            last = Some(k);
        } else if terrain.ground_below(at.x, at.y).is_some() {
            // under the slope
            break;
        }
    }
    match last {
        None => 0.0,
        Some(GROUND_SAMPLES) => leaves,
        Some(k) => math::bisected([sample_s(k), sample_s(k + 1)], BISECTIONS, |t| {
            has_ground(&flight.centre(t))
        })[0],
    }
}

/// When the ball leaves the mesh's box for good (s): sideways, or below it; without gravity also
/// above it.
///
/// The earliest of the three times: a ball cannot come back through a side it has left (linear),
/// nor up through the bottom (the parabola opens downwards). Above the box it has not left: it
/// falls back in.
fn leaves_box_after(terrain: &Terrain, flight: &Parabola) -> f64 {
    let (lo, hi) = terrain.index.bounds();
    let (c, v, r) = (flight.start, flight.velocity, flight.radius);
    // sides are moved out by the radius: the ball still touches what its centre has passed
    let leaves_axis_s = |k: usize| {
        let to = if v[k] > 0.0 { hi[k] + r } else { lo[k] - r };
        if v[k] != 0.0 {
            ((to - c[k]) / v[k]).max(0.0)
        } else if c[k] > hi[k] + r || c[k] < lo[k] - r {
            0.0
        } else {
            f64::INFINITY
        }
    };
    let leaves_vertically_s = if flight.gravity > 0.0 {
        // roots of c_z + v_z t − g t²/2 = lo_z − R: the later one is the way down. A ball that
        // never reaches the floor is below it from the start.
        let floor = quadratic(-0.5 * flight.gravity, v.z, c.z - (lo.z - r));
        floor.map_or(0.0, |(_, last)| last.max(0.0))
    } else {
        leaves_axis_s(2)
    };
    leaves_axis_s(0).min(leaves_axis_s(1)).min(leaves_vertically_s)
}

/// Time at which the ball first touches the mesh, within `limit` (s).
///
/// Depth first, nearest window first; a box that the ball enters after the earliest contact so far
/// is not opened.
fn first_touch(
    terrain: &Terrain,
    flight: &Parabola,
    limit: f64,
    (broken_stems, tested): (&[u32], &mut u64),
) -> Option<f64> {
    let nodes = terrain.index.nodes();
    if nodes.is_empty() {
        return None;
    }
    let parabola_box = ParabolaBox::new(flight);
    let mut best = limit;
    let mut found = false;
    // on the stack: no flight allocates
    let mut stack = [StackEntry::default(); WAITING];
    stack[0].ends_s = f32::INFINITY;
    let mut top = 1;
    while top > 0 {
        top -= 1;
        let StackEntry { child, begins_s, ends_s } = stack[top];
        let (from, to) = (f64::from(begins_s), f64::from(ends_s));
        // windows are rounded outwards, so this never drops a box that holds an earlier contact
        if from >= best && found {
            continue;
        }
        match Child::of(child) {
            Child::Inner(next) => {
                let node = &nodes[next as usize];
                top = push_children(&mut stack, top, node, parabola_box.windows(node, best));
            }
            Child::Leaf(start, count) => {
                for triangle in start..start + count {
                    // the window of the box holds for all its triangles and saves most of their
                    // tests
                    let window = (from, fast_min(to, best));
                    if window.0 > window.1 {
                        break;
                    }
                    *tested += 1;
                    if terrain.is_gone(triangle, broken_stems) {
                        continue;
                    }
                    if let Some(t) =
                        triangle_impact::first_contact_s(terrain, triangle, flight, window)
                    {
                        best = t;
                        found = true;
                    }
                }
            }
        }
    }
    found.then_some(best)
}

/// A child of a node, with the time window in which the ball passes its box (s). Times in `f32`, as
/// the boxes are; they are only bounds.
#[derive(Clone, Copy, Default)]
struct StackEntry {
    child: u32,
    begins_s: f32,
    ends_s: f32,
}

/// Pushes the children that have a window, the first to be passed on top; returns the new height of
/// the stack.
///
/// Insertion sort of the part of the stack above `bottom`: at most four children, so at most six
/// comparisons.
#[inline]
fn push_children(
    stack: &mut [StackEntry; WAITING],
    mut top: usize,
    node: &BvhNode,
    (begins, ends): (f32x4, f32x4),
) -> usize {
    let bottom = top;
    let mut passed = begins.simd_le(ends).to_bitmask();
    let (begins, ends) = (begins.to_array(), ends.to_array());
    while passed != 0 {
        let lane = passed.trailing_zeros() as usize % begins.len();
        passed &= passed - 1;
        let mut place = top;
        while place > bottom && stack[place - 1].begins_s < begins[lane] {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] =
            StackEntry { child: node.word(lane), begins_s: begins[lane], ends_s: ends[lane] };
        top += 1;
    }
    top
}

/// The lesser of two numbers, neither of them NaN: one instruction. `f64::min` must handle NaN and
/// is slower in these loops.
#[inline]
fn fast_min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The greater of two numbers, neither of them NaN.
#[inline]
fn fast_max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

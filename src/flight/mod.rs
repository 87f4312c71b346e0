//! Free flight: the exact parabola to the first touch.
//!
//! Between touches nothing but gravity acts, so the flight is leapt over: the first time at which the ball meets a
//! face (a quadratic), an edge or a corner (quartics) is solved for, over the boxes that the parabola crosses.

mod abreast;
mod roots;
mod touch;

use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::index::{Child, DEPTH, Pair};
use roots::quadratic;
use wide::f64x2;

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
pub enum Landing {
    /// Touches the mesh after so many seconds.
    Touch(f64),
    /// Has left the box of the mesh after so many seconds and will not touch it again.
    Leaves(f64),
    /// Is still flying at the end of the time allowed.
    Flies,
}

/// Follows the flight for at most `longest_s`; `tested` counts triangles.
pub fn leap(terrain: &Terrain, flight: &Parabola, longest_s: f64, tested: &mut u64) -> Landing {
    leap_past(terrain, flight, longest_s, &[], tested)
}

/// The same past the stems that are `gone`.
pub fn leap_past(
    terrain: &Terrain,
    flight: &Parabola,
    longest_s: f64,
    gone: &[u32],
    tested: &mut u64,
) -> Landing {
    let leaves = leaves_box_after(terrain, flight);
    let limit = longest_s.min(leaves);
    match first_touch(terrain, flight, limit, (gone, tested)) {
        Some(t) => Landing::Touch(t),
        None if leaves <= longest_s => Landing::Leaves(leaves),
        None => Landing::Flies,
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
    let pairs = terrain.index.pairs();
    if pairs.is_empty() {
        return None;
    }
    let slabs = Slabs::new(flight);
    let mut best = limit;
    let mut found = false;
    let mut stack = [(0u32, 0.0f64); DEPTH];
    let mut top = 1;
    while top > 0 {
        top -= 1;
        let (id, from) = stack[top];
        if from >= best && found {
            continue;
        }
        let pair = &pairs[id as usize];
        let (begins, ends) = slabs.windows(pair, best);
        let (begins, ends) = (begins.to_array(), ends.to_array());
        let nearer = usize::from(begins[1] < begins[0]);
        for side in [1 - nearer, nearer] {
            if begins[side] <= ends[side]
                && let Child::Inner(next) = pair.child(side)
            {
                stack[top] = (next, begins[side]);
                top += 1;
            }
        }
        for side in [nearer, 1 - nearer] {
            let (ta, tb) = (begins[side], ends[side]);
            if let Child::Leaf(start, count) = pair.child(side) {
                for triangle in start..start + count {
                    let window = (ta, least(tb, best));
                    if window.0 > window.1 {
                        break;
                    }
                    *tested += 1;
                    if terrain.is_gone(triangle, gone) {
                        continue;
                    }
                    if let Some(t) = touch::of_triangle(terrain, triangle, flight, window) {
                        best = t;
                        found = true;
                    }
                }
            }
        }
    }
    found.then_some(best)
}

/// Boxes are grown by this much more than the radius (–, relative to it): a ball that meets a plate as it enters the
/// plate's box, which has no thickness, must not be cut off by rounding.
const ROUNDING: f64 = 1e-6;

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

/// Reciprocal of a speed too small to leave any box: its sign decides, it never overflows to NaN.
const STANDING: f64 = 1e300;

/// The parabola's pass through boxes: linear in x and y, quadratic in z. Both boxes of a pair are clipped at once.
struct Slabs {
    /// Start less, and plus, the radius of the ball and a little more.
    less: [f64x2; 3],
    plus: [f64x2; 3],
    /// Reciprocal of the speeds; of the vertical one without gravity only.
    inv: [f64x2; 3],
    fall: Option<Fall>,
}

/// Height over time under gravity.
struct Fall {
    /// Time of the apex.
    apex_s: f64x2,
    /// Its height less, and plus, the radius.
    less: f64x2,
    plus: f64x2,
    /// `2/g`.
    over: f64x2,
}

impl Slabs {
    fn new(flight: &Parabola) -> Self {
        let (c, v, g) = (flight.start, flight.velocity, flight.gravity);
        let r = flight.radius * (1.0 + ROUNDING);
        let splat = f64x2::splat;
        let apex = c.z + 0.5 * v.z * v.z / g;
        let fall = (g > 0.0).then(|| Fall {
            apex_s: splat(v.z / g),
            less: splat(apex - r),
            plus: splat(apex + r),
            over: splat(2.0 / g),
        });
        Self {
            less: [0, 1, 2].map(|k| splat(c[k] - r)),
            plus: [0, 1, 2].map(|k| splat(c[k] + r)),
            inv: [0, 1, 2].map(|k| splat((1.0 / v[k]).clamp(-STANDING, STANDING))),
            fall,
        }
    }

    /// Times within `0..limit` between which the centre may be in the boxes grown by the radius: where the windows begin
    /// and where they end; empty if reversed.
    #[inline]
    fn windows(&self, pair: &Pair, limit: f64) -> (f64x2, f64x2) {
        let mut window = (f64x2::ZERO, f64x2::splat(limit));
        self.clip(pair, 0, &mut window);
        self.clip(pair, 1, &mut window);
        match &self.fall {
            None => self.clip(pair, 2, &mut window),
            Some(fall) => fall.clip(pair, &mut window),
        }
        window
    }

    /// Clips both windows to the time between two planes.
    #[inline]
    fn clip(&self, pair: &Pair, axis: usize, (begin, end): &mut (f64x2, f64x2)) {
        let one = (both(pair.lo[axis]) - self.plus[axis]) * self.inv[axis];
        let other = (both(pair.hi[axis]) - self.less[axis]) * self.inv[axis];
        *begin = begin.fast_max(one.fast_min(other));
        *end = end.fast_min(one.fast_max(other));
    }
}

impl Fall {
    /// Clips both windows to heights between floor and roof.
    #[inline]
    fn clip(&self, pair: &Pair, (begin, end): &mut (f64x2, f64x2)) {
        // Squares of the times that the fall from the apex takes to them.
        let floor2 = (self.plus - both(pair.lo[2])) * self.over;
        let roof2 = (self.less - both(pair.hi[2])) * self.over;
        let floor = floor2.fast_max(f64x2::ZERO).sqrt();
        let roof = roof2.fast_max(f64x2::ZERO).sqrt();
        let (up, down) = (self.apex_s - roof, self.apex_s + roof);
        *begin = begin.fast_max(self.apex_s - floor);
        *end = end.fast_min(self.apex_s + floor);
        // Above the roof between two times: the window's hull, unless the way up or the way down is out of it already.
        *begin = begin.simd_gt(up).select(begin.fast_max(down), *begin);
        *end = end.simd_lt(down).select(end.fast_min(up), *end);
        *begin = floor2.simd_lt(f64x2::ZERO).select(f64x2::splat(f64::INFINITY), *begin);
    }
}

#[inline]
fn both([one, other]: [f32; 2]) -> f64x2 {
    f64x2::new([f64::from(one), f64::from(other)])
}

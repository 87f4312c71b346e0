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
    let leaves = leaves_box_after(terrain, flight);
    let limit = longest_s.min(leaves);
    match first_touch(terrain, flight, limit, tested) {
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
fn first_touch(terrain: &Terrain, flight: &Parabola, limit: f64, tested: &mut u64) -> Option<f64> {
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

/// Reciprocal of a horizontal speed too small to leave any box: its sign decides, it never overflows to NaN.
const STANDING: f64 = 1e300;

/// The parabola's pass through boxes: linear in x and y, quadratic in z.
struct Slabs {
    /// Start less, and plus, the radius of the ball and a little more.
    less: Vec3,
    plus: Vec3,
    /// Reciprocal of the horizontal speeds.
    inv: [f64; 2],
    rise: Rise,
}

/// Height over time.
enum Rise {
    /// Without gravity: reciprocal of the vertical speed.
    Straight(f64),
    /// Time of the apex, its height less and plus the radius, and `2/g`.
    Parabola { apex_s: f64, less: f64, plus: f64, over: f64 },
}

/// Both children's windows of time: where they begin and where they end; empty if reversed.
type Windows = ([f64; 2], [f64; 2]);

impl Slabs {
    fn new(flight: &Parabola) -> Self {
        let (c, v, g) = (flight.start, flight.velocity, flight.gravity);
        let r = flight.radius * (1.0 + ROUNDING);
        let over = |v: f64| (1.0 / v).clamp(-STANDING, STANDING);
        let rise = if g > 0.0 {
            let apex = c.z + 0.5 * v.z * v.z / g;
            Rise::Parabola { apex_s: v.z / g, less: apex - r, plus: apex + r, over: 2.0 / g }
        } else {
            Rise::Straight(over(v.z))
        };
        let reach = Vec3::repeat(r);
        Self { less: c - reach, plus: c + reach, inv: [over(v.x), over(v.y)], rise }
    }

    /// Times within `0..limit` between which the centre may be in the boxes grown by the radius.
    #[inline]
    fn windows(&self, pair: &Pair, limit: f64) -> Windows {
        let mut windows = ([0.0; 2], [limit; 2]);
        self.clip(pair, 0, self.inv[0], &mut windows);
        self.clip(pair, 1, self.inv[1], &mut windows);
        match self.rise {
            Rise::Straight(inv) => self.clip(pair, 2, inv, &mut windows),
            Rise::Parabola { apex_s, less, plus, over } => {
                for side in 0..2 {
                    let floor = over * (plus - f64::from(pair.lo[2][side]));
                    let roof = over * (less - f64::from(pair.hi[2][side]));
                    clip_height((floor, roof), apex_s, side, &mut windows);
                }
            }
        }
        windows
    }

    /// Clips both windows to the time between two planes.
    #[inline]
    fn clip(&self, pair: &Pair, axis: usize, inv: f64, (begins, ends): &mut Windows) {
        let (lo, hi) = (&pair.lo[axis], &pair.hi[axis]);
        for side in 0..2 {
            let below = (f64::from(lo[side]) - self.plus[axis]) * inv;
            let above = (f64::from(hi[side]) - self.less[axis]) * inv;
            let (enter, leave) = if inv > 0.0 { (below, above) } else { (above, below) };
            begins[side] = most(begins[side], enter);
            ends[side] = least(ends[side], leave);
        }
    }
}

/// Clips a window to heights between floor and roof, given as the squares of the times that the fall from the apex takes
/// to them.
#[inline]
fn clip_height((floor2, roof2): (f64, f64), apex_s: f64, side: usize, windows: &mut Windows) {
    let (begins, ends) = (&mut windows.0[side], &mut windows.1[side]);
    let (floor, roof) = (most(floor2, 0.0).sqrt(), most(roof2, 0.0).sqrt());
    *begins = most(*begins, apex_s - floor);
    *ends = least(*ends, apex_s + floor);
    // Above the roof between two times: the window's hull, unless the way up or the way down is out of it already.
    if *begins > apex_s - roof {
        *begins = most(*begins, apex_s + roof);
    }
    if *ends < apex_s + roof {
        *ends = least(*ends, apex_s - roof);
    }
    if floor2 < 0.0 {
        *begins = f64::INFINITY;
    }
}

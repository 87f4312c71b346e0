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
        let windows = [slabs.window(pair, 0, best), slabs.window(pair, 1, best)];
        let nearer = usize::from(windows[1].0 < windows[0].0);
        for side in [1 - nearer, nearer] {
            let (ta, tb) = windows[side];
            if ta > tb {
                continue;
            }
            if let Child::Inner(next) = pair.child(side) {
                stack[top] = (next, ta);
                top += 1;
            }
        }
        for side in [nearer, 1 - nearer] {
            let (ta, tb) = windows[side];
            if let Child::Leaf(start, count) = pair.child(side) {
                for triangle in start..start + count {
                    if ta > tb.min(best) {
                        break;
                    }
                    *tested += 1;
                    if terrain.is_gone(triangle, gone) {
                        continue;
                    }
                    let window = (ta, tb.min(best));
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

/// The parabola's pass through boxes: linear in x and y, quadratic in z.
struct Slabs {
    c: Vec3,
    /// Reciprocal of the horizontal speeds; infinite when there is none.
    inv: [f64; 2],
    v_z: f64,
    g: f64,
    /// Radius of the ball and a little more.
    radius: f64,
    /// Time and height of the apex.
    apex: (f64, f64),
}

impl Slabs {
    fn new(flight: &Parabola) -> Self {
        let (c, v, g) = (flight.start, flight.velocity, flight.gravity);
        let inv = [1.0 / v.x, 1.0 / v.y];
        let apex = if g > 0.0 { (v.z / g, c.z + 0.5 * v.z * v.z / g) } else { (0.0, c.z) };
        Self { c, inv, v_z: v.z, g, radius: flight.radius * (1.0 + ROUNDING), apex }
    }

    /// Times within `0..limit` between which the centre may be in the box grown by the radius (empty if reversed).
    #[inline]
    fn window(&self, pair: &Pair, side: usize, limit: f64) -> (f64, f64) {
        const NEVER: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
        let (lo, hi) = (&pair.lo[side], &pair.hi[side]);
        let (mut ta, mut tb) = (0.0f64, limit);
        for k in 0..2 {
            let (near, far) = (
                f64::from(lo[k]) - self.radius - self.c[k],
                f64::from(hi[k]) + self.radius - self.c[k],
            );
            if self.inv[k].is_finite() {
                let (t1, t2) = (near * self.inv[k], far * self.inv[k]);
                ta = ta.max(t1.min(t2));
                tb = tb.min(t1.max(t2));
            } else if near > 0.0 || far < 0.0 {
                return NEVER;
            }
        }
        if ta > tb {
            return NEVER;
        }
        self.clip_height(f64::from(lo[2]) - self.radius, f64::from(hi[2]) + self.radius, (ta, tb))
    }

    /// Clips a window to heights between `floor` and `roof`; outside two falling-in times above the roof.
    #[inline]
    fn clip_height(&self, floor: f64, roof: f64, (mut ta, mut tb): (f64, f64)) -> (f64, f64) {
        const NEVER: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
        if self.g == 0.0 {
            let times = quadratic(0.0, self.v_z, self.c.z - roof).zip(quadratic(
                0.0,
                self.v_z,
                self.c.z - floor,
            ));
            return match times {
                Some(((t1, _), (t2, _))) => (ta.max(t1.min(t2)), tb.min(t1.max(t2))),
                None if self.c.z < floor || self.c.z > roof => NEVER,
                None => (ta, tb),
            };
        }
        // Heights relative to the apex: z = z_apex − g/2 (t − t_apex)².
        let (t_apex, z_apex) = self.apex;
        if z_apex < floor {
            return NEVER;
        }
        let half_floor = (2.0 * (z_apex - floor) / self.g).sqrt();
        ta = ta.max(t_apex - half_floor);
        tb = tb.min(t_apex + half_floor);
        if z_apex > roof {
            let half_roof = (2.0 * (z_apex - roof) / self.g).sqrt();
            // Inside on the way up or on the way down; the union's hull unless one way is already out of the window.
            if ta > t_apex - half_roof {
                ta = ta.max(t_apex + half_roof);
            }
            if tb < t_apex + half_roof {
                tb = tb.min(t_apex - half_roof);
            }
        }
        (ta, tb)
    }
}

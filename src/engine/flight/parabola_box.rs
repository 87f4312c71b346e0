//! Time windows in which a parabola passes the boxes of the index: four boxes at once, in `f32`,
//! never too narrow.
//!
//! Boxes are `f32` anyway. Inputs from the flight are rounded away from them, computed values are
//! off by a few roundings of their own size, and the resulting windows are extended by more than
//! that ([`WINDOW_MARGIN`]).
//!
//! ```text
//! x, y:  lo − R ≤ c0 + v t ≤ hi + R                          one interval each, from two products
//! z:     z(t) = z_a − g (t − t_a)²/2,   t_a = v_z/g,  z_a = c_z + v_z²/(2g)        (apex)
//!        above the floor: |t − t_a| ≤ √(2 (z_a − lo_z + R)/g)
//!        below the roof:  |t − t_a| ≥ √(2 (z_a − hi_z − R)/g)
//! ```
//!
//! The floor gives one interval and the roof cuts out its middle. The hull of the two ends is kept,
//! so a box under the arc of a flight is sometimes opened in vain. A window too narrow would lose a
//! contact, and with it a rock through the slope.

use super::Parabola;
use crate::terrain::index::{BvhNode, above, below};
use wide::f32x4;

/// Boxes are enlarged by this much more than the radius (–, relative to it): rounding must not
/// exclude a ball that touches a plate as it enters the plate's box, which has no thickness.
const RADIUS_MARGIN: f64 = 1e-6;
/// Windows are extended by this (–, relative to their ends): each is affected by four roundings of
/// 6e-8.
const WINDOW_MARGIN: f32 = 6e-7;
/// Error of the squares of times (–).
const SQUARE_MARGIN: f64 = 1e-6;
/// Reciprocal of a speed too small to leave any box: its sign decides, and it never overflows to
/// NaN.
const LARGEST_RECIPROCAL: f64 = 1e30;

/// The passage of a parabola through boxes: linear in x and y, quadratic in z.
pub(super) struct ParabolaBox {
    /// Start minus and plus the radius of the ball, with a margin. The first is compared with upper
    /// sides of boxes, the second with lower ones.
    minus_radius: [f32x4; 3],
    plus_radius: [f32x4; 3],
    /// Reciprocals of the speeds; of the vertical one only without gravity.
    inverse_speed: [f32x4; 3],
    fall: Option<HeightOverTime>,
}

/// Height over time under gravity.
struct HeightOverTime {
    /// Time of the apex, rounded down and up.
    apex_s: [f32x4; 2],
    /// Its height minus and plus the radius.
    minus_radius: f32x4,
    plus_radius: f32x4,
    /// `2/g`, rounded down and up.
    two_over_g: [f32x4; 2],
}

impl ParabolaBox {
    pub(super) fn new(flight: &Parabola) -> Self {
        let (c, v, g) = (flight.start, flight.velocity, flight.gravity);
        let r = flight.radius * (1.0 + RADIUS_MARGIN);
        let (down, up) = (|x: f64| f32x4::splat(below(x)), |x: f64| f32x4::splat(above(x)));
        // z_a = c_z + v_z²/(2 g)
        let apex = c.z + 0.5 * v.z * v.z / g;
        // gravity so weak that the apex overflows the scale does not bend any flight
        let has_apex = g > 0.0 && apex < LARGEST_RECIPROCAL;
        let fall = has_apex.then(|| HeightOverTime {
            apex_s: [down(v.z / g), up(v.z / g)],
            minus_radius: down(apex - r),
            plus_radius: up(apex + r),
            two_over_g: [
                down(2.0 / g * (1.0 - SQUARE_MARGIN)),
                up(2.0 / g * (1.0 + SQUARE_MARGIN)),
            ],
        });
        // 1/0 becomes 1e30: times a distance to a box it is ±1e30 s or more than any window, with
        // the right sign
        let inv = |speed: f64| (1.0 / speed).clamp(-LARGEST_RECIPROCAL, LARGEST_RECIPROCAL) as f32;
        Self {
            minus_radius: [0, 1, 2].map(|k| down(c[k] - r)),
            plus_radius: [0, 1, 2].map(|k| up(c[k] + r)),
            inverse_speed: [0, 1, 2].map(|k| f32x4::splat(inv(v[k]))),
            fall,
        }
    }

    /// Times within `0..limit` between which the centre may be in the boxes enlarged by the radius:
    /// starts and ends of the windows; empty if reversed. The four lanes are the four children of a
    /// node.
    #[inline]
    pub(super) fn windows(&self, node: &BvhNode, limit: f64) -> (f32x4, f32x4) {
        let mut window = (f32x4::ZERO, f32x4::splat(limit as f32));
        self.clip(node, 0, &mut window);
        self.clip(node, 1, &mut window);
        if self.fall.is_none() {
            self.clip(node, 2, &mut window);
        }
        let floor2 = self.fall.as_ref().map(|fall| fall.clip_to_floor(node, &mut window));
        let mut window = (window.0 * (1.0 - WINDOW_MARGIN), window.1 * (1.0 + WINDOW_MARGIN));
        if let (Some(fall), Some(floor2)) = (&self.fall, floor2) {
            fall.clip_to_roof(node, &mut window);
            // floor2 < 0: the apex lies below the floor of the enlarged box, which is never reached
            let never = f32x4::splat(f32::INFINITY);
            window.0 = floor2.simd_lt(f32x4::ZERO).select(never, window.0);
        }
        window
    }

    /// Clips the windows to the time between two planes.
    #[inline]
    fn clip(&self, node: &BvhNode, axis: usize, (begin, end): &mut (f32x4, f32x4)) {
        // one of the two products is the time of entry, whichever way the ball moves: the lesser
        // one
        let lower = (node.lo[axis] - self.plus_radius[axis]) * self.inverse_speed[axis];
        let upper = (node.hi[axis] - self.minus_radius[axis]) * self.inverse_speed[axis];
        *begin = begin.fast_max(lower.fast_min(upper));
        *end = end.fast_min(lower.fast_max(upper));
    }
}

impl HeightOverTime {
    /// Clips the windows to the time above the floors. Returns the squares of the times that the
    /// fall from the apex to the floors takes, negative if they are never reached.
    #[inline]
    fn clip_to_floor(&self, node: &BvhNode, (begin, end): &mut (f32x4, f32x4)) -> f32x4 {
        let floor2 = (self.plus_radius - node.lo[2]) * self.two_over_g[1];
        let floor = floor2.fast_max(f32x4::ZERO).sqrt();
        *begin = begin.fast_max(self.apex_s[0] - floor);
        *end = end.fast_min(self.apex_s[1] + floor);
        floor2
    }

    /// Removes the time above the roof, between two times, if that shortens the window: if the
    /// ascent or the descent lies outside it already. Otherwise the hull of the window stays.
    #[inline]
    fn clip_to_roof(&self, node: &BvhNode, (begin, end): &mut (f32x4, f32x4)) {
        // 2/g and heights rounded so that the time above the roof comes out too short: a window may
        // only be too wide
        let roof2 = (self.minus_radius - node.hi[2]) * self.two_over_g[0];
        let roof = roof2.fast_max(f32x4::ZERO).sqrt();
        let up = (self.apex_s[1] - roof) * (1.0 + WINDOW_MARGIN);
        let down = (self.apex_s[0] + roof) * (1.0 - WINDOW_MARGIN);
        *begin = begin.simd_gt(up).select(begin.fast_max(down), *begin);
        *end = end.simd_lt(down).select(end.fast_min(up), *end);
    }
}

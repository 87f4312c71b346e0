//! Lower bounds on the gap between a part of a block and a feature of the mesh, and how long it
//! certainly stays open.

use super::{PointBounds, ROUNDING_MARGIN};
use crate::rock::Vec3;

/// Most bisections, on a logarithmic scale, of the time for which a bound is sought.
const SEARCH_STEPS: u32 = 6;
/// A safe time is good enough if it is at least this share of one that is not known to be safe (–).
const GOOD_ENOUGH: f64 = 0.5;
/// Edges are followed only while they are farther from parallel than this (–, cosine).
const MAX_PARALLEL_COSINE: f64 = 0.99;

/// How long a gap to a convex feature certainly stays open (s): it closes at the speed `closing`,
/// which grows by no more than `max_acceleration`.
///
/// The first positive root of `δ − c τ − B τ²/2 = 0`: `τ = 2δ/(c + √(c² + 2Bδ))` for an approach,
/// `(√(c² + 2Bδ) − c)/B` for a separation (`c ≤ 0`), each in the form without cancellation.
/// Infinite if the motion turns back before the gap closes.
pub(super) fn safe_time_s((gap, closing): (f64, f64), max_acceleration: f64) -> f64 {
    let square = closing * closing + 2.0 * max_acceleration * gap;
    if closing > 0.0 && square >= 0.0 {
        2.0 * gap / (closing + square.sqrt())
    } else if closing <= 0.0 && max_acceleration > 0.0 {
        (square.sqrt() - closing) / max_acceleration
    } else {
        f64::INFINITY
    }
}

/// Motion of a point of the block: position `p` (m), velocity (m/s) and acceleration (m/s²) in the
/// frame of the terrain.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointMotion {
    pub(super) p: Vec3,
    pub(super) velocity: Vec3,
    pub(super) acceleration: Vec3,
    /// Bounds on the acceleration (m/s²) and on the jerk (m/s³).
    pub(super) max_acceleration: f64,
    pub(super) max_jerk: f64,
}

impl PointMotion {
    pub(super) const NONE: Self = Self {
        p: Vec3::new(0.0, 0.0, 0.0),
        velocity: Vec3::new(0.0, 0.0, 0.0),
        acceleration: Vec3::new(0.0, 0.0, 0.0),
        max_acceleration: 0.0,
        max_jerk: 0.0,
    };
}

/// Bounds on a gap: after `τ` it is no less than `δ + δ' τ + ½ δ'' τ² − ⅙ J τ³`, and no less than
/// `δ + δ' τ − ½ B τ²`, while `τ` is within the valid time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clearance {
    /// `δ` (m).
    pub(super) gap_m: f64,
    /// `δ'` (m/s).
    pub(super) opening_m_s: f64,
    /// `δ''` (m/s²).
    second_m_s2: f64,
    /// `B` (m/s²).
    max_acceleration: f64,
    /// `J` (m/s³).
    max_third_m_s3: f64,
    /// Time for which the bounds are valid (s).
    pub(super) valid_s: f64,
}

impl Clearance {
    /// Of a corner with its ball of radius `ball` (m) and the plane with unit normal `n` through
    /// `q` (m).
    #[inline]
    pub(super) fn of_corner(corner: &PointMotion, ball: f64, (n, q): (&Vec3, &Vec3)) -> Self {
        Self {
            gap_m: n.dot(&(corner.p - q)) - ball,
            opening_m_s: n.dot(&corner.velocity),
            second_m_s2: n.dot(&corner.acceleration),
            max_acceleration: corner.max_acceleration,
            max_third_m_s3: corner.max_jerk,
            valid_s: f64::INFINITY,
        }
    }

    /// Of two edges, for at most `most` (s): the distance of the infinite lines along the block's
    /// edge between two corners and along the mesh's edge from `e` (m) with a unit direction, less
    /// the radius of the block's corner balls (m). `None` if they are nearly parallel.
    ///
    /// With `u` along the block's edge, `w` along the mesh's, `x = a − e` and `N = |u × w|` the gap
    /// is `x·(u × w)/N − r`. As `u` rotates and `a` moves, `x·(u × w) − r N` over the present `N`
    /// is followed, which is zero when the gap is. `N = √(u² − z²)` with `z = u·w` has an upward
    /// curvature of at most `|z z''|/N`. When an edge rotates about its contact, one of its ends
    /// approaches the plane through it, so the bound by a plane finds an approach; this one does
    /// not.
    pub(super) fn of_lines(
        [a, b]: &[PointMotion; 2],
        ball: f64,
        (e, w): (&Vec3, &Vec3),
        (bounds, most): (&PointBounds, f64),
    ) -> Option<Self> {
        let (u, u1, u2) = (b.p - a.p, b.velocity - a.velocity, b.acceleration - a.acceleration);
        let (length, z, z1, x) = (u.norm(), u.dot(w), u1.dot(w), a.p - e);
        let (spin, turned) = (bounds.velocity, length * bounds.acceleration);
        // how long the edges are certainly not parallel
        let valid_s = ((MAX_PARALLEL_COSINE * length - z.abs()) / (spin * length)).min(most);
        if valid_s <= 0.0 {
            return None;
        }
        let widest = z.abs() + spin * length * valid_s;
        let (n, least_n) =
            ((length * length - z * z).sqrt(), (length * length - widest * widest).sqrt());
        let across = u.cross(w);
        let side = 1.0_f64.copysign(x.dot(&across)) / n;
        let (across1, across2) = (u1.cross(w), u2.cross(w));
        let volume = [
            x.dot(&across),
            a.velocity.dot(&across) + x.dot(&across1),
            a.acceleration.dot(&across) + 2.0 * a.velocity.dot(&across1) + x.dot(&across2),
        ];
        // bounds on |a'|, on the part of x normal to w, and by the product rule on the third
        // derivative of the numerator
        let fastest = a.velocity.norm() + a.max_acceleration * valid_s;
        let aside = (x - w * w.dot(&x)).norm() + fastest * valid_s;
        let third = a.max_jerk * length
            + 3.0 * a.max_acceleration * spin * length
            + 3.0 * fastest * turned
            + aside * length * bounds.jerk;
        Some(Self {
            gap_m: volume[0] * side - ball,
            opening_m_s: volume[1] * side + ball * z * z1 / (n * n),
            second_m_s2: volume[2] * side - ball * widest * turned / (least_n * n),
            max_acceleration: f64::INFINITY,
            max_third_m_s3: third / n,
            valid_s,
        })
    }

    /// Of a point of the mesh (m) and a plane fixed to a block that moves like `centre`, for at
    /// most `most` (s); the rounded surface is `ball` (m) outside the plane. `turn` rotates vectors
    /// of the block, and gives their rates.
    ///
    /// `δ = m·(p − c) − h − r` with the plane's unit normal `m` and its height `h` over the centre.
    pub(super) fn of_own_plane(
        ((normal, level), ball): ((&Vec3, f64), f64),
        point: &Vec3,
        (centre, turn): (&PointMotion, impl Fn(&Vec3) -> [Vec3; 3]),
        (bounds, most): (&PointBounds, f64),
    ) -> Self {
        let ([m, m1, m2], off) = (turn(normal), point - centre.p);
        let fastest = centre.velocity.norm() + centre.max_acceleration * most;
        let third = bounds.jerk * (off.norm() + fastest * most)
            + 3.0 * (bounds.acceleration * fastest + bounds.velocity * centre.max_acceleration);
        Self {
            gap_m: m.dot(&off) - level - ball,
            opening_m_s: m1.dot(&off) - m.dot(&centre.velocity),
            second_m_s2: m2.dot(&off)
                - 2.0 * m1.dot(&centre.velocity)
                - m.dot(&centre.acceleration),
            max_acceleration: f64::INFINITY,
            max_third_m_s3: third,
            valid_s: most,
        }
    }

    /// Lower bound of the gap after `t` (s) (m).
    #[cfg(test)]
    pub(super) fn at_least_m(&self, t: f64) -> f64 {
        self.gap_m
            + t * (self.opening_m_s + t * (0.5 * self.second_m_s2 - t * self.max_third_m_s3 / 6.0))
    }

    /// `B` for times up to `most` (s): `J τ³/6 ≤ (J T/3) τ²/2` for `τ ≤ T`.
    #[inline]
    fn max_acceleration_within(&self, most: f64) -> f64 {
        self.max_acceleration.min(self.max_third_m_s3 * most / 3.0 - self.second_m_s2)
    }

    /// Whether the gap certainly stays above `touching` (m) for `most` (s): as
    /// [`Clearance::open_time_s`], without a root.
    #[inline]
    pub(super) fn stays_open(&self, touching: f64, most: f64) -> bool {
        let bent = 0.5 * self.max_acceleration_within(most).max(0.0) * most;
        let rounding = ROUNDING_MARGIN * (self.opening_m_s.abs() + bent);
        self.gap_m > touching && self.gap_m >= most * (bent - self.opening_m_s + rounding)
    }

    /// How long the gap certainly stays open (s), at most `most`; 0 if it is no larger than
    /// `touching` (m) and decreasing.
    ///
    /// A bound for a shorter time is a better one: the search is for the longest time whose own
    /// bound covers it.
    pub(super) fn open_time_s(&self, touching: f64, most: f64) -> f64 {
        // only an approach touches: a part that has just separated lies within the same gap and
        // must be free to move away
        if self.opening_m_s < 0.0 && self.gap_m <= touching {
            return 0.0;
        }
        let motion = (self.gap_m.max(0.0), -self.opening_m_s);
        let within = |most: f64| safe_time_s(motion, self.max_acceleration_within(most)).min(most);
        let mut fails = most.min(self.valid_s);
        let mut safe = within(fails);
        if safe >= fails {
            return safe;
        }
        for _ in 0..SEARCH_STEPS {
            if safe >= GOOD_ENOUGH * fails {
                break;
            }
            let middle = (safe * fails).sqrt();
            let found = within(middle);
            if found < middle {
                fails = middle;
            }
            safe = safe.max(found);
        }
        safe
    }
}

//! What a rock looks like to those who note its way: a ball, or a block that is turned somehow.
//!
//! A sphere is the same from all sides; for a block heights and crossings depend on how it is
//! turned, so these are asked here and nowhere by radius. The support of a block along a direction
//! is `max_k ρ_k·d + r`, over its corners `ρ_k` with balls of radius `r`.

use crate::body::Block;
use crate::flight::Parabola;
use crate::flight::top::Top;
use crate::math;
use crate::rock::{Motion, Rock, Vec3};
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};

/// How a block is turned, and the energy of its rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turned {
    /// From the block's principal frame to the world.
    pub(super) attitude: Rotation3<f64>,
    /// Rotational energy (J).
    pub(super) rotational_j: f64,
}

/// A rock at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct RockInstant {
    pub(super) motion: Motion,
    /// None for a sphere.
    pub(super) turned: Option<Turned>,
}

/// How a block turns on its way.
#[derive(Debug, Clone, Copy)]
pub(super) enum AttitudeOnWay<'a> {
    /// Freely.
    Top(&'a Top),
    /// Through a step in contact, from one attitude to the other.
    Step([&'a Turned; 2]),
}

/// A rock in free flight, or on the way of a step in contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct RockFlight<'a> {
    /// How it began.
    pub(super) start: Motion,
    /// Way of its centre.
    pub(super) path: &'a Parabola,
    /// How a block turns; none for a sphere.
    pub(super) turning: Option<AttitudeOnWay<'a>>,
    /// How long it flies (s).
    pub(super) lasts_s: f64,
}

/// The rock itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Form<'a> {
    pub(super) rock: Rock,
    /// None for a sphere.
    pub(super) block: Option<&'a Block>,
}

impl Turned {
    /// The turn as a unit quaternion w, x, y, z with w ≥ 0.
    pub(super) fn quaternion(&self) -> [f64; 4] {
        quaternion(&self.attitude)
    }

    /// At share `s` of a step in contact. It turns a block by hardly a tenth of a radian: there the
    /// normed mean of the two quaternions is the turn about a fixed axis to 2e-5 rad, and takes
    /// no sine, whose bits would differ from machine to machine. The energy is linear.
    fn between([from, to]: [&Self; 2], s: f64) -> Self {
        let (a, b) = Self::nearer([from, to]);
        Self {
            attitude: UnitQuaternion::new_normalize(a.lerp(&b, s)).to_rotation_matrix(),
            rotational_j: from.rotational_j + (to.rotational_j - from.rotational_j) * s,
        }
    }

    /// How far it turns per unit of share, at share `s` of a step in contact (rad, as a vector along the axis).
    ///
    /// `2 vec(q′ q̄)` of `q = p/|p|` with `p = a + s (b − a)`: what norms `p` has no part along the axis.
    fn turning(ends: [&Self; 2], s: f64) -> Vec3 {
        let (a, b) = Self::nearer(ends);
        let (at, length) = UnitQuaternion::new_and_get(a.lerp(&b, s));
        ((b - a) * at.conjugate().into_inner()).imag() * (2.0 / length)
    }

    /// The quaternions of two attitudes; `q` and `−q` are the same turn, so the second is the nearer one.
    fn nearer(ends: [&Self; 2]) -> (Quaternion<f64>, Quaternion<f64>) {
        let [a, b] =
            ends.map(|end| UnitQuaternion::from_rotation_matrix(&end.attitude).into_inner());
        (a, if a.dot(&b) < 0.0 { -b } else { b })
    }
}

/// A turn as a unit quaternion w, x, y, z with w ≥ 0.
///
/// `q` and `−q` are the same turn; the sign is fixed, so that files do not depend on how the matrix
/// came about.
pub(super) fn quaternion(turn: &Rotation3<f64>) -> [f64; 4] {
    let turn = UnitQuaternion::from_rotation_matrix(turn);
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    [turn.w, turn.i, turn.j, turn.k].map(|x| x * sign)
}

impl RockFlight<'_> {
    /// The rock after `t` (s).
    pub(super) fn at(&self, t: f64) -> RockInstant {
        let turned = self.turning.map(|turning| self.turned(turning, t));
        let motion = Motion {
            time_s: self.start.time_s + t,
            position_m: self.path.centre(t),
            velocity_m_s: self.path.velocity(t),
            // a sphere keeps its spin in flight: nothing turns it
            spin_rad_s: turned.map_or(self.start.spin_rad_s, |(spin, _)| spin),
        };
        RockInstant { motion, turned: turned.map(|(_, turned)| turned) }
    }

    /// Spin (rad/s) and turn of a block after `t` (s).
    fn turned(&self, turning: AttitudeOnWay, t: f64) -> (Vec3, Turned) {
        match turning {
            // the attitude is a closed form of the time (`Top`); the energy of rotation is constant in flight
            AttitudeOnWay::Top(top) => {
                let attitude = top.attitude(t);
                (top.spin(&attitude), Turned { attitude, rotational_j: top.energy_j() })
            }
            AttitudeOnWay::Step(ends) => {
                let s = t / self.lasts_s;
                (Turned::turning(ends, s) / self.lasts_s, Turned::between(ends, s))
            }
        }
    }

    /// Largest size of `ω × (ω × ρ) + ω̇ × ρ` over the length of `ρ` (1/s²), see [`Top::point_bounds`]; none for a sphere.
    ///
    /// In a step the spin is largest in its middle, and by `ω = 4 S h/(h² + u²)` with the sine `S` and the cosine `h` of a fourth of
    /// the angle and `|u| ≤ S` it changes by no more than `ω³ dt/4` per second.
    pub(super) fn bend(&self) -> Option<f64> {
        Some(match self.turning? {
            AttitudeOnWay::Top(top) => top.point_bounds().acceleration,
            AttitudeOnWay::Step(ends) => {
                let spin = Turned::turning(ends, 0.5).norm() / self.lasts_s;
                spin * spin * (1.0 + 0.25 * spin * self.lasts_s)
            }
        })
    }
}

impl RockInstant {
    /// The rock at share `s` of a step in contact between two instants: see [`between`] and
    /// [`Turned::between`].
    pub(super) fn between([from, to]: [&Self; 2], s: f64) -> Self {
        let turns = from.turned.zip(to.turned);
        Self {
            motion: between(&from.motion, &to.motion, s),
            turned: turns.map(|(from, to)| Turned::between([&from, &to], s)),
        }
    }
}

impl From<Motion> for RockInstant {
    /// A sphere.
    fn from(motion: Motion) -> Self {
        Self { motion, turned: None }
    }
}

impl Form<'_> {
    /// How far the rock reaches from its centre along a unit direction (m).
    pub(super) fn reach_m(&self, at: &RockInstant, along: &Vec3) -> f64 {
        match (self.block, &at.turned) {
            (Some(block), Some(turned)) => {
                block.support_m(&turned.attitude.inverse_transform_vector(along))
            }
            _ => self.rock.radius_m,
        }
    }

    /// How far the lowest point lies below the centre (m).
    /// The radius of a sphere; for a block the support downwards.
    pub(super) fn below_m(&self, at: &RockInstant) -> f64 {
        self.reach_m(at, &-Vec3::z())
    }

    /// How far the lowest point lies below the centre at least, however it is turned (m).
    pub(super) fn least_below_m(&self) -> f64 {
        self.block.map_or(self.rock.radius_m, Block::min_support_m)
    }

    /// How far the lowest corner of a block lies below the centre (m), and how fast it sinks against it (m/s).
    pub(super) fn sinking(block: &Block, at: &RockInstant) -> Option<(f64, f64)> {
        let turned = at.turned.as_ref()?;
        let down = turned.attitude.inverse_transform_vector(&-Vec3::z());
        let corners = block.core.corners.iter().map(|corner| (corner.dot(&down), corner));
        let (below_m, lowest) = corners.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let sinks_m_s = -at.motion.spin_rad_s.cross(&(turned.attitude * lowest)).z;
        Some((below_m + block.ball_m, sinks_m_s))
    }

    /// Radius of the circle that it may cover on the map (m).
    ///
    /// That of the ball around a block, whichever way it is turned: on the map a block may turn as
    /// it passes.
    pub(super) fn rim_m(&self) -> f64 {
        self.block.map_or(self.rock.radius_m, |block| block.bound_m)
    }

    /// Rotational energy (J).
    pub(super) fn rotational_j(&self, at: &RockInstant) -> f64 {
        at.turned.map_or_else(|| at.motion.rotational_j(&self.rock), |turned| turned.rotational_j)
    }
}

/// The motion a share `s` of a step after its start: cubic in position, linear in velocity and spin.
///
/// Hermite's cubic through positions and velocities at both ends: it leaves and arrives with the
/// velocities of the step, and its error is of fourth order in the step. `bend` is what it differs
/// from the straight way by; 0 for a constant velocity.
pub(super) fn between(from: &Motion, to: &Motion, s: f64) -> Motion {
    let dt = to.time_s - from.time_s;
    let way = to.position_m - from.position_m;
    let (v0, v1) = (from.velocity_m_s * dt - way, to.velocity_m_s * dt - way);
    let bend = (v0 * (1.0 - s) - v1 * s) * (s * (1.0 - s));
    Motion {
        time_s: from.time_s + s * dt,
        position_m: from.position_m + way * s + bend,
        velocity_m_s: from.velocity_m_s.lerp(&to.velocity_m_s, s),
        spin_rad_s: from.spin_rad_s.lerp(&to.spin_rad_s, s),
    }
}

/// Halvings of a step to find when it has come so far: 2⁻⁴⁰ is rounding.
const TIMES_HALVED: u32 = 40;

/// The share of a step's time at which it has come a share of its way in plan view, on the cubic of [`between`]: a rock that slows down has most of
/// its way behind it at half of its time.
pub(super) fn time_share([from, to]: [&Motion; 2], way_share: f64) -> f64 {
    let way = (to.position_m - from.position_m).xy();
    let (dt, way2) = (to.time_s - from.time_s, way.norm_squared());
    if way2 == 0.0 || way_share <= 0.0 || way_share >= 1.0 {
        return way_share;
    }
    let along = |motion: &Motion| motion.velocity_m_s.xy().dot(&way) * (dt / way2) - 1.0;
    let (a, b) = (along(from), along(to));
    let come = |s: f64| s + (a * (1.0 - s) - b * s) * (s * (1.0 - s));
    math::bisected([0.0, 1.0], TIMES_HALVED, |s| come(s) <= way_share)[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Constant braking from 3 m/s to rest within 2 s: `x = 3 t − 0.75 t²`, so that half of the way of 3 m is behind after `2 − √2` s.
    #[test]
    fn a_rock_that_slows_down_is_early_half_way() {
        let at = |time_s: f64, x: f64, speed: f64| Motion {
            time_s,
            position_m: Vec3::new(x, 0.0, 0.0),
            velocity_m_s: Vec3::new(speed, 0.0, 0.0),
            spin_rad_s: Vec3::zeros(),
        };
        let (from, to) = (at(5.0, 1.0, 3.0), at(7.0, 4.0, 0.0));
        let half = time_share([&from, &to], 0.5);
        assert!((half - (1.0 - 0.5_f64.sqrt())).abs() < 1e-11, "{half}");
        assert!((between(&from, &to, half).velocity_m_s.x - 4.5_f64.sqrt()).abs() < 1e-10);
        for share in [0.0, 1.0] {
            assert!((time_share([&from, &to], share) - share).abs() < 1e-15);
        }
        assert!((time_share([&from, &from], 0.3) - 0.3).abs() < 1e-15);
    }

    #[test]
    fn within_a_step_a_block_turns_from_one_attitude_to_the_other() {
        let axis = nalgebra::Unit::new_normalize(Vec3::new(0.3, -0.5, 0.8));
        // far round, so that the quaternions of both ends lie on both sides of w = 0
        let turn = |angle: f64| Rotation3::from_axis_angle(&axis, 3.1 + angle);
        let end = |angle: f64, rotational_j| Turned { attitude: turn(angle), rotational_j };
        let ends = [&end(0.0, 2.0), &end(0.1, 4.0)];
        for s in [0.0, 0.25, 0.5, 0.9, 1.0] {
            let at = Turned::between(ends, s);
            assert!(at.attitude.angle_to(&turn(0.1 * s)) < 2e-5, "{s}");
            assert!((at.rotational_j - 2.0 - 2.0 * s).abs() < 1e-15);
        }
    }
}

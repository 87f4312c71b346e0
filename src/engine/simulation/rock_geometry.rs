//! The geometry of a rock as the recorders see it: a sphere, or a block with an attitude.
//!
//! A sphere is the same from all sides. For a block heights and crossings depend on its attitude,
//! so they are asked of this module and never computed from a radius. The support of a block along
//! a direction is `max_k ρ_k·d + r`, over its corners `ρ_k` with spheres of radius `r`.

use crate::body::Block;
use crate::flight::Parabola;
use crate::flight::top::Top;
use crate::math;
use crate::rock::{Motion, Rock, Vec3};
use nalgebra::{Quaternion, Rotation3, UnitQuaternion};

/// Attitude and rotational energy of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BlockRotation {
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
    pub(super) rotation: Option<BlockRotation>,
}

/// Attitude of a block over the time of a flight or a step.
#[derive(Debug, Clone, Copy)]
pub(super) enum AttitudePath<'a> {
    /// Free rotation.
    Top(&'a Top),
    /// Over a step in contact, from one attitude to the other.
    Step([&'a BlockRotation; 2]),
}

/// A rock in free flight, or on the path of a step in contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct RockFlight<'a> {
    /// Motion at its start.
    pub(super) start: Motion,
    /// Path of the centre.
    pub(super) path: &'a Parabola,
    /// Attitude over time of a block; none for a sphere.
    pub(super) attitude_path: Option<AttitudePath<'a>>,
    /// Duration (s).
    pub(super) duration_s: f64,
}

/// Size and shape of a rock.
#[derive(Debug, Clone, Copy)]
pub(super) struct RockGeometry<'a> {
    pub(super) rock: Rock,
    /// None for a sphere.
    pub(super) block: Option<&'a Block>,
}

impl BlockRotation {
    /// The attitude as a unit quaternion w, x, y, z with w ≥ 0.
    pub(super) fn quaternion(&self) -> [f64; 4] {
        quaternion(&self.attitude)
    }

    /// At fraction `s` of a step in contact. A step rotates a block by hardly a tenth of a radian.
    /// For that the normalised mean of the two quaternions equals the rotation about a fixed axis
    /// to 2e-5 rad, and needs no sine, whose bits would differ from machine to machine. The energy
    /// is linear.
    fn interpolated([from, to]: [&Self; 2], s: f64) -> Self {
        let (a, b) = Self::quaternions([from, to]);
        Self {
            attitude: UnitQuaternion::new_normalize(a.lerp(&b, s)).to_rotation_matrix(),
            rotational_j: from.rotational_j + (to.rotational_j - from.rotational_j) * s,
        }
    }

    /// Rotation per unit of `s` at fraction `s` of a step in contact (rad, as a vector along the
    /// axis).
    ///
    /// `2 vec(q′ q̄)` of `q = p/|p|` with `p = a + s (b − a)`: normalising `p` adds no part along
    /// the axis.
    fn angular_rate(ends: [&Self; 2], s: f64) -> Vec3 {
        let (a, b) = Self::quaternions(ends);
        let (at, length) = UnitQuaternion::new_and_get(a.lerp(&b, s));
        ((b - a) * at.conjugate().into_inner()).imag() * (2.0 / length)
    }

    /// The quaternions of two attitudes. `q` and `−q` are the same rotation; of these the second
    /// result is the one nearer to the first.
    fn quaternions(ends: [&Self; 2]) -> (Quaternion<f64>, Quaternion<f64>) {
        let [a, b] =
            ends.map(|end| UnitQuaternion::from_rotation_matrix(&end.attitude).into_inner());
        (a, if a.dot(&b) < 0.0 { -b } else { b })
    }
}

/// A rotation as a unit quaternion w, x, y, z with w ≥ 0.
///
/// `q` and `−q` are the same rotation. The sign is fixed, so that files do not depend on how the
/// matrix was computed.
pub(super) fn quaternion(turn: &Rotation3<f64>) -> [f64; 4] {
    let turn = UnitQuaternion::from_rotation_matrix(turn);
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    [turn.w, turn.i, turn.j, turn.k].map(|x| x * sign)
}

impl RockFlight<'_> {
    /// State of the rock after `t` (s).
    pub(super) fn at(&self, t: f64) -> RockInstant {
        let rotation = self.attitude_path.map(|attitude_path| self.rotation(attitude_path, t));
        let motion = Motion {
            time_s: self.start.time_s + t,
            position_m: self.path.centre(t),
            velocity_m_s: self.path.velocity(t),
            // a sphere keeps its spin in flight: no torque acts on it
            spin_rad_s: rotation.map_or(self.start.spin_rad_s, |(spin, _)| spin),
        };
        RockInstant { motion, rotation: rotation.map(|(_, rotation)| rotation) }
    }

    /// Spin (rad/s) and attitude of a block after `t` (s).
    fn rotation(&self, attitude_path: AttitudePath, t: f64) -> (Vec3, BlockRotation) {
        match attitude_path {
            // the attitude is a closed form of time (`Top`); rotational energy is constant in
            // flight
            AttitudePath::Top(top) => {
                let attitude = top.attitude(t);
                (top.spin(&attitude), BlockRotation { attitude, rotational_j: top.energy_j() })
            }
            AttitudePath::Step(ends) => {
                let s = t / self.duration_s;
                (
                    BlockRotation::angular_rate(ends, s) / self.duration_s,
                    BlockRotation::interpolated(ends, s),
                )
            }
        }
    }

    /// Bound of `|ω × (ω × ρ) + ω̇ × ρ|/|ρ|`, the acceleration of a point relative to the centre
    /// over its distance from it (1/s²), see [`Top::point_bounds`]; none for a sphere.
    ///
    /// In a step the spin is largest in its middle. By `ω = 4 S h/(h² + u²)`, with the sine `S` and
    /// the cosine `h` of a fourth of the angle and `|u| ≤ S`, it changes by no more than `ω³ dt/4`
    /// per second.
    pub(super) fn point_acceleration_per_m(&self) -> Option<f64> {
        Some(match self.attitude_path? {
            AttitudePath::Top(top) => top.point_bounds().acceleration,
            AttitudePath::Step(ends) => {
                let spin = BlockRotation::angular_rate(ends, 0.5).norm() / self.duration_s;
                spin * spin * (1.0 + 0.25 * spin * self.duration_s)
            }
        })
    }
}

impl RockInstant {
    /// The rock at fraction `s` of a step in contact between two instants: see [`hermite_motion`]
    /// and [`BlockRotation::interpolated`].
    pub(super) fn interpolated([from, to]: [&Self; 2], s: f64) -> Self {
        let rotations = from.rotation.zip(to.rotation);
        Self {
            motion: hermite_motion(&from.motion, &to.motion, s),
            rotation: rotations.map(|(from, to)| BlockRotation::interpolated([&from, &to], s)),
        }
    }
}

impl From<Motion> for RockInstant {
    /// A sphere.
    fn from(motion: Motion) -> Self {
        Self { motion, rotation: None }
    }
}

impl RockGeometry<'_> {
    /// Support of the rock: distance from its centre to its farthest point along a unit direction
    /// (m).
    pub(super) fn support_m(&self, at: &RockInstant, along: &Vec3) -> f64 {
        match (self.block, &at.rotation) {
            (Some(block), Some(rotation)) => {
                block.support_m(&rotation.attitude.inverse_transform_vector(along))
            }
            _ => self.rock.radius_m,
        }
    }

    /// Depth of the lowest point below the centre (m): the radius of a sphere; for a block the
    /// support downwards.
    pub(super) fn depth_below_centre_m(&self, at: &RockInstant) -> f64 {
        self.support_m(at, &-Vec3::z())
    }

    /// Least depth of the lowest point below the centre over all attitudes (m).
    pub(super) fn least_depth_below_centre_m(&self) -> f64 {
        self.block.map_or(self.rock.radius_m, Block::min_support_m)
    }

    /// Depth of the lowest corner of a block below the centre (m), and the speed at which it sinks
    /// relative to the centre (m/s).
    pub(super) fn lowest_corner(block: &Block, at: &RockInstant) -> Option<(f64, f64)> {
        let rotation = at.rotation.as_ref()?;
        let down = rotation.attitude.inverse_transform_vector(&-Vec3::z());
        let corners = block.core.corners.iter().map(|corner| (corner.dot(&down), corner));
        let (below_m, lowest) = corners.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let sinks_m_s = -at.motion.spin_rad_s.cross(&(rotation.attitude * lowest)).z;
        Some((below_m + block.ball_m, sinks_m_s))
    }

    /// Radius of the circle that it may cover in plan view (m).
    ///
    /// For a block that of its bounding sphere, whatever its attitude: a block may rotate as it
    /// passes.
    pub(super) fn plan_radius_m(&self) -> f64 {
        self.block.map_or(self.rock.radius_m, |block| block.bound_m)
    }

    /// Rotational energy (J).
    pub(super) fn rotational_j(&self, at: &RockInstant) -> f64 {
        at.rotation
            .map_or_else(|| at.motion.rotational_j(&self.rock), |rotation| rotation.rotational_j)
    }
}

/// The motion at fraction `s` of a step: cubic in position, linear in velocity and spin.
///
/// Hermite's cubic through positions and velocities at both ends: its velocities at the ends are
/// those of the step, and its error is of fourth order in the step. `bend` is its deviation from
/// the straight path; 0 for a constant velocity.
pub(super) fn hermite_motion(from: &Motion, to: &Motion, s: f64) -> Motion {
    let dt = to.time_s - from.time_s;
    let displacement = to.position_m - from.position_m;
    let (v0, v1) = (from.velocity_m_s * dt - displacement, to.velocity_m_s * dt - displacement);
    let bend = (v0 * (1.0 - s) - v1 * s) * (s * (1.0 - s));
    Motion {
        time_s: from.time_s + s * dt,
        position_m: from.position_m + displacement * s + bend,
        velocity_m_s: from.velocity_m_s.lerp(&to.velocity_m_s, s),
        spin_rad_s: from.spin_rad_s.lerp(&to.spin_rad_s, s),
    }
}

/// Bisections of a step to find the time of a position: 2⁻⁴⁰ is rounding.
const TIME_BISECTIONS: u32 = 40;

/// The fraction of a step's time after which a fraction `distance_fraction` of its distance in plan
/// view is covered, on the cubic of [`hermite_motion`]. A rock that slows down has most of its
/// distance behind it at half of its time.
pub(super) fn time_fraction([from, to]: [&Motion; 2], distance_fraction: f64) -> f64 {
    let displacement = (to.position_m - from.position_m).xy();
    let (dt, distance2) = (to.time_s - from.time_s, displacement.norm_squared());
    if distance2 == 0.0 || distance_fraction <= 0.0 || distance_fraction >= 1.0 {
        return distance_fraction;
    }
    let along =
        |motion: &Motion| motion.velocity_m_s.xy().dot(&displacement) * (dt / distance2) - 1.0;
    let (a, b) = (along(from), along(to));
    let distance_fraction_at = |s: f64| s + (a * (1.0 - s) - b * s) * (s * (1.0 - s));
    math::bisected([0.0, 1.0], TIME_BISECTIONS, |s| distance_fraction_at(s) <= distance_fraction)[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Constant braking from 3 m/s to rest within 2 s: `x = 3 t − 0.75 t²`, so that half of the
    /// distance of 3 m is covered after `2 − √2` s.
    #[test]
    fn a_rock_that_slows_down_is_early_half_way() {
        let at = |time_s: f64, x: f64, speed: f64| Motion {
            time_s,
            position_m: Vec3::new(x, 0.0, 0.0),
            velocity_m_s: Vec3::new(speed, 0.0, 0.0),
            spin_rad_s: Vec3::zeros(),
        };
        let (from, to) = (at(5.0, 1.0, 3.0), at(7.0, 4.0, 0.0));
        let half = time_fraction([&from, &to], 0.5);
        assert!((half - (1.0 - 0.5_f64.sqrt())).abs() < 1e-11, "{half}");
        assert!((hermite_motion(&from, &to, half).velocity_m_s.x - 4.5_f64.sqrt()).abs() < 1e-10);
        for share in [0.0, 1.0] {
            assert!((time_fraction([&from, &to], share) - share).abs() < 1e-15);
        }
        assert!((time_fraction([&from, &from], 0.3) - 0.3).abs() < 1e-15);
    }

    #[test]
    fn within_a_step_a_block_turns_from_one_attitude_to_the_other() {
        let axis = nalgebra::Unit::new_normalize(Vec3::new(0.3, -0.5, 0.8));
        // a large angle, so that the quaternions of both ends lie on both sides of w = 0
        let turn = |angle: f64| Rotation3::from_axis_angle(&axis, 3.1 + angle);
        let end = |angle: f64, rotational_j| BlockRotation { attitude: turn(angle), rotational_j };
        let ends = [&end(0.0, 2.0), &end(0.1, 4.0)];
        for s in [0.0, 0.25, 0.5, 0.9, 1.0] {
            let at = BlockRotation::interpolated(ends, s);
            assert!(at.attitude.angle_to(&turn(0.1 * s)) < 2e-5, "{s}");
            assert!((at.rotational_j - 2.0 - 2.0 * s).abs() < 1e-15);
        }
    }
}

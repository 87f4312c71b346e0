//! Mass, inertia and size of a rock as the equations of motion need them.
//!
//! A solid homogeneous sphere has `I = 2/5 m R²`. Its effective mass at the contact point along the
//! surface is `1/(1/m + R²/I) = 2/7 m`, and rolling without slip it has the inertia `7/5 m`. The
//! solver uses these numbers throughout.

use crate::body::Block;
use crate::rock::{Rock, Vec3};

/// A velocity (m/s) and a spin (rad/s), or a force and a moment, or an impulse and a rotational
/// impulse.
pub(crate) type Twist = (Vec3, Vec3);
/// No motion.
pub(super) const STILL: Twist = (Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.0));

/// A faster approach is a hard impact (–, relative to `√(g R)`).
const STRUCK_HARD: f64 = 4.0;

/// Whether position, velocity and spin are finite.
pub(super) fn are_finite(motion: [&Vec3; 3]) -> bool {
    motion.into_iter().flatten().all(|x| x.is_finite())
}

/// Mechanical properties of a rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia (kg m²).
    pub inertia: f64,
    /// Radius (m).
    pub radius: f64,
    /// Gravity vector (m/s²).
    pub gravity: Vec3,
}

impl Body {
    /// Kinetic energy (J) at a velocity (m/s) and a spin (rad/s).
    #[inline]
    pub(crate) fn motion_j(&self, (v, w): (&Vec3, &Vec3)) -> f64 {
        0.5 * (self.mass * v.norm_squared() + self.inertia * w.norm_squared())
    }

    /// Potential energy gained by a displacement (m) (J).
    #[inline]
    pub(crate) fn lifted_j(&self, way: &Vec3) -> f64 {
        -self.mass * self.gravity.dot(way)
    }

    /// Takes energy (J) out of the motion, at most all of it: velocity and spin keep their
    /// directions and their ratio.
    pub(crate) fn slow_down(&self, (v, w): (&mut Vec3, &mut Vec3), lost_j: f64) {
        let motion_j = self.motion_j((v, w));
        if motion_j > 0.0 && lost_j > 0.0 {
            let kept = ((motion_j - lost_j) / motion_j).max(0.0).sqrt();
            *v *= kept;
            *w *= kept;
        }
    }

    /// The body of a rock under gravity `g_m_s2` along −z.
    pub fn new(rock: &Rock, g_m_s2: f64) -> Self {
        let gravity = Vec3::new(0.0, 0.0, -g_m_s2);
        Self { mass: rock.mass_kg(), inertia: rock.inertia_kg_m2(), radius: rock.radius_m, gravity }
    }

    /// The body of a block for the laws of grounds: mass and radius of the sphere of equal volume.
    ///
    /// The mean of its three moments of inertia stands for the inertia; the block's own equations
    /// of motion use all three.
    pub(crate) fn of_block(block: &Block, g_m_s2: f64) -> Self {
        Self {
            mass: block.mass_kg,
            inertia: block.inertia_kg_m2.iter().sum::<f64>() / 3.0,
            radius: block.radius_m,
            gravity: Vec3::new(0.0, 0.0, -g_m_s2),
        }
    }

    /// Effective mass of the normal contact of two rocks (kg): `m_a m_b/(m_a + m_b)`.
    pub(crate) fn reduced_mass_with(&self, other: &Self) -> f64 {
        self.mass * other.mass / (self.mass + other.mass)
    }

    /// Speed of a rock that has fallen by half its radius (m/s), `√(g R)`: the scale of slow motion
    /// for its size.
    pub(crate) fn fall_speed_m_s(&self) -> f64 {
        (self.gravity.norm() * self.radius).sqrt()
    }

    /// Whether an approach at a speed (m/s) is a hard impact, for which it matters how the blow is
    /// transmitted through all contacts.
    pub(crate) fn is_struck_hard(&self, approach_m_s: f64) -> bool {
        approach_m_s > STRUCK_HARD * self.fall_speed_m_s()
    }

    /// Effective mass of a force along the surface at the contact point (kg): `m/(1 + m R²/I)`.
    #[inline]
    pub(crate) fn mass_along(&self) -> f64 {
        1.0 / Rock::SLIP_LIGHTNESS * self.mass
    }

    /// Share of the slip caused by a force along the surface through rotation, relative to that
    /// through translation (–): `m R²/I`.
    #[inline]
    pub(crate) fn turns(&self) -> f64 {
        self.mass * self.radius * self.radius / self.inertia
    }

    /// Velocity of the contact point along the surface with normal `n` (m/s): `Q (v + w × (−R n))`.
    /// `n × w R` is `w × (−R n)`: the lever from the centre to the contact point is `−R n`.
    #[inline]
    pub fn slip(&self, n: &Vec3, v: &Vec3, w: &Vec3) -> Vec3 {
        v - n * n.dot(v) + n.cross(w) * self.radius
    }
}

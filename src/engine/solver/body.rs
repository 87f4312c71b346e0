//! A rock as the mechanics sees it.
//!
//! A solid homogeneous sphere has `I = 2/5 m R²`; seen from its contact point the mass along the
//! surface is `1/(1/m + R²/I) = 2/7 m`, and a sphere that rolls without slip moves like the mass `7/5 m`. These numbers come back all over the solver.

use crate::body::Block;
use crate::rock::{Rock, Vec3};

/// A velocity (m/s) and a spin (rad/s), or an impulse and one of rotation.
pub(crate) type Twist = (Vec3, Vec3);
/// No motion.
pub(super) const STILL: Twist = (Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.0));

/// What comes at a rock faster than this strikes it hard (–, relative to `√(g R)`).
const STRUCK_HARD: f64 = 4.0;

/// Whether place, velocity and spin are numbers.
pub(super) fn are_finite(motion: [&Vec3; 3]) -> bool {
    motion.into_iter().flatten().all(|x| x.is_finite())
}

/// What of a rock the mechanics needs.
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
    /// Energy of motion (J) with a velocity (m/s) and a spin (rad/s).
    #[inline]
    pub(crate) fn motion_j(&self, (v, w): (&Vec3, &Vec3)) -> f64 {
        0.5 * (self.mass * v.norm_squared() + self.inertia * w.norm_squared())
    }

    /// Energy that its height gains on a way (J).
    #[inline]
    pub(crate) fn lifted_j(&self, way: &Vec3) -> f64 {
        -self.mass * self.gravity.dot(way)
    }

    /// Takes energy (J) out of its motion, as much as it has at most: velocity and spin keep their directions and their ratio.
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

    /// The body of a block as the laws of grounds want it: mass and radius of the sphere of equal volume.
    ///
    /// The mean of its three moments stands for the inertia; the block's own equations of motion take
    /// its three moments.
    pub(crate) fn of_block(block: &Block, g_m_s2: f64) -> Self {
        Self {
            mass: block.mass_kg,
            inertia: block.inertia_kg_m2.iter().sum::<f64>() / 3.0,
            radius: block.radius_m,
            gravity: Vec3::new(0.0, 0.0, -g_m_s2),
        }
    }

    /// Mass that moves where two rocks press each other (kg): `m_a m_b/(m_a + m_b)`.
    pub(crate) fn reduced_mass_with(&self, other: &Self) -> f64 {
        self.mass * other.mass / (self.mass + other.mass)
    }

    /// Speed of a rock that has fallen by half its radius (m/s): `√(g R)`, what is slow for a rock of its size.
    pub(crate) fn fall_speed_m_s(&self) -> f64 {
        (self.gravity.norm() * self.radius).sqrt()
    }

    /// Whether what comes at it at a speed (m/s) strikes it so hard that it matters how the blow runs through all that it touches.
    pub(crate) fn is_struck_hard(&self, approach_m_s: f64) -> bool {
        approach_m_s > STRUCK_HARD * self.fall_speed_m_s()
    }

    /// Mass that a force along the surface meets at the contact point (kg): `m/(1 + m R²/I)`.
    #[inline]
    pub(crate) fn mass_along(&self) -> f64 {
        1.0 / Rock::SLIP_LIGHTNESS * self.mass
    }

    /// How much more a force along the surface does to the slip by the turn than by the way (–): `m R²/I`.
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

//! A rock as the mechanics sees it.

use crate::body::Block;
use crate::rock::{Rock, Vec3};

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
    /// The body of a rock under gravity `g_m_s2` along −z.
    pub fn new(rock: &Rock, g_m_s2: f64) -> Self {
        let gravity = Vec3::new(0.0, 0.0, -g_m_s2);
        Self { mass: rock.mass_kg(), inertia: rock.inertia_kg_m2(), radius: rock.radius_m, gravity }
    }

    /// The body of a block as the laws of grounds want it: mass and radius of the sphere of equal volume.
    pub(crate) fn of_block(block: &Block, g_m_s2: f64) -> Self {
        Self {
            mass: block.mass_kg,
            inertia: block.inertia_kg_m2.iter().sum::<f64>() / 3.0,
            radius: block.radius_m,
            gravity: Vec3::new(0.0, 0.0, -g_m_s2),
        }
    }

    /// Mass that a force along the surface meets at the contact point (kg): `m/(1 + m R²/I)`.
    #[inline]
    pub(crate) fn mass_along(&self) -> f64 {
        1.0 / Rock::SLIP_LIGHTNESS * self.mass
    }

    /// Velocity of the contact point along the surface with normal `n` (m/s): `Q (v + w × (−R n))`.
    #[inline]
    pub fn slip(&self, n: &Vec3, v: &Vec3, w: &Vec3) -> Vec3 {
        v - n * n.dot(v) + n.cross(w) * self.radius
    }
}

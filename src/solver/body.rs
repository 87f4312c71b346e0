//! A rock as the mechanics sees it.

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

    /// Velocity of the contact point along the surface with normal `n` (m/s): `Q (v + w × (−R n))`.
    #[inline]
    pub fn slip(&self, n: &Vec3, v: &Vec3, w: &Vec3) -> Vec3 {
        v - n * n.dot(v) + n.cross(w) * self.radius
    }
}

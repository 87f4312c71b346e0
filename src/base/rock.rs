//! A rock and its motion.

use std::f64::consts::PI;

/// A vector in metres, metres per second, newtons …; z points up.
pub type Vec3 = nalgebra::Vector3<f64>;

/// A homogeneous solid sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rock {
    /// Radius (m), positive.
    pub radius_m: f64,
    /// Density (kg/m³), positive.
    pub density_kg_m3: f64,
}

impl Rock {
    /// Moment of inertia over `m R²` (–), that of a solid sphere.
    pub const INERTIA: f64 = 0.4;
    /// Mass over what a force along the surface meets at the contact point (–): `1 + m R²/I`, 7/2.
    pub const SLIP_LIGHTNESS: f64 = 1.0 + 1.0 / Self::INERTIA;
    /// Moment of inertia about the contact point over `m R²` (–): `1 + I/(m R²)`, 7/5.
    pub const ROLLING_INERTIA: f64 = 1.0 + Self::INERTIA;

    /// Mass `ρ 4/3 π R³` (kg).
    #[inline]
    pub fn mass_kg(&self) -> f64 {
        self.density_kg_m3 * 4.0 / 3.0 * PI * self.radius_m.powi(3)
    }

    /// Moment of inertia of a solid sphere about any axis, `2/5 m R²` (kg m²).
    #[inline]
    pub fn inertia_kg_m2(&self) -> f64 {
        Self::INERTIA * self.mass_kg() * self.radius_m * self.radius_m
    }
}

/// Where a rock is and how it moves. A sphere looks the same from all sides: no orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Time since release (s).
    pub time_s: f64,
    /// Centre (m), in the terrain's local coordinates (map minus the terrain's `origin_m`).
    pub position_m: Vec3,
    /// Velocity of the centre (m/s).
    pub velocity_m_s: Vec3,
    /// Angular velocity (rad/s), right-handed.
    pub spin_rad_s: Vec3,
}

impl Motion {
    /// Turns velocity and spin; the rock stays where it is.
    #[inline]
    pub fn turn(&mut self, turn: &nalgebra::Rotation3<f64>) {
        self.velocity_m_s = turn * self.velocity_m_s;
        self.spin_rad_s = turn * self.spin_rad_s;
    }

    /// `m v²/2` (J).
    #[inline]
    pub fn translational_j(&self, rock: &Rock) -> f64 {
        0.5 * rock.mass_kg() * self.velocity_m_s.norm_squared()
    }

    /// `I ω²/2` (J).
    #[inline]
    pub fn rotational_j(&self, rock: &Rock) -> f64 {
        0.5 * rock.inertia_kg_m2() * self.spin_rad_s.norm_squared()
    }

    /// Both (J).
    pub fn kinetic_j(&self, rock: &Rock) -> f64 {
        self.translational_j(rock) + self.rotational_j(rock)
    }
}

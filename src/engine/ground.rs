//! The contact law of a ground for a rock: springs, friction, damping from restitution, rolling
//! friction, roughness.

mod law;
mod soil;

use crate::math;

pub use law::{
    CAPTURE_DAMPING_RATIO, Capture, Damping, Law, NormalImpact, damping_ratio, normal_impact,
    restitution, tangential_restitution,
};
pub(crate) use law::{
    FixedStepNormal, FrictionElement, FrictionLimits, LinearFriction, NormalElement, NormalLine,
    STICK_THRESHOLD, SliderForce, clamp_norm,
};
pub(crate) use soil::over_unit;
pub use soil::{Scar, SlipFriction, cut_area_m2, swept_m3};

/// Ground values of one release (a scene may give distributions; these are drawn from them).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Stiffness of the normal contact spring `p_N` (N/m), positive.
    pub normal_stiffness_n_m: f64,
    /// Stiffness of the shear contact spring `p_s` (N/m), positive.
    pub shear_stiffness_n_m: f64,
    /// Friction angle φ (rad), 0..π/2.
    pub friction_angle_rad: f64,
    /// Normal restitution 0..1. `None` only with scheme `dda`: no dashpots, only the scheme's own
    /// dissipation.
    pub restitution: Option<f64>,
    /// Limit of the rolling torque over `N R` (–), 0 = none.
    pub rolling_friction: f64,
    /// Largest random tilt of the contact normal at an impact (rad), 0 = none.
    pub roughness_rad: f64,
    /// Length of one tilted facet (m), positive; `None` = the radius of the rock.
    pub roughness_length_m: Option<f64>,
    /// Friction that grows with slip; `None` = Coulomb's.
    pub slip_friction: Option<SlipFriction>,
    /// Soil in which a rock digs a scar and is slowed by drag; `None` = the surface is hard.
    pub scar: Option<Scar>,
    /// Normal impact speed at which the restitution has fallen to half (m/s), positive; `None` = it
    /// is constant.
    pub restitution_half_m_s: Option<f64>,
}

impl Ground {
    /// A ground of a normal and a shear stiffness (N/m), a friction angle (rad) and a restitution,
    /// without rolling friction, roughness and soil.
    pub const fn smooth(
        [normal_stiffness_n_m, shear_stiffness_n_m]: [f64; 2],
        friction_angle_rad: f64,
        restitution: Option<f64>,
    ) -> Self {
        Self {
            normal_stiffness_n_m,
            shear_stiffness_n_m,
            friction_angle_rad,
            restitution,
            rolling_friction: 0.0,
            roughness_rad: 0.0,
            roughness_length_m: None,
            slip_friction: None,
            scar: None,
            restitution_half_m_s: None,
        }
    }

    /// Coefficient of friction `tan φ` (–).
    pub fn friction_coefficient(&self) -> f64 {
        math::tan(self.friction_angle_rad)
    }
}

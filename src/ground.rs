//! How a ground answers a rock: springs, friction, damping from restitution, rolling friction, roughness.

/// Ground values in force for one release (a scene may give distributions; these are drawn).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Stiffness of the normal contact spring `p_N` (N/m), positive.
    pub normal_stiffness_n_m: f64,
    /// Stiffness of the shear contact spring `p_s` (N/m), positive.
    pub shear_stiffness_n_m: f64,
    /// Friction angle φ (rad), 0..π/2.
    pub friction_angle_rad: f64,
    /// Normal restitution 0..1. `None` only with scheme `dda`: no dashpots, the scheme's own dissipation.
    pub restitution: Option<f64>,
    /// Limit of the rolling torque over `N R` (–), 0 = none.
    pub rolling_friction: f64,
    /// Largest random tilt of the contact normal at an impact (rad), 0 = none.
    pub roughness_rad: f64,
}

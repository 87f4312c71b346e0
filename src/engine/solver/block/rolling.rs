//! Rolling friction of a block: one moment against its spin.
//!
//! As for a sphere, it is a spring and a dashpot in series with a slider of capacity `ρ R N`, with
//! `R` the radius of the sphere of equal volume. All contacts rotate the same body, so there is one
//! moment, whose capacity is the sum over the contacts. In a stage in which the moment acts for `a`
//! and the block turns for `b` (s), the moment `M = k θ + (k b + c) ω` takes the angular impulse
//! `T = a M` from the body:
//!
//! ```text
//! (s + I⁻¹) T = ω₀ + k θ/(k b + c),   s = 1/(a (k b + c)),   |T| ≤ a ρ R N
//! ```
//!
//! with `ω₀` the spin without it. If the slider yields, `s` is the larger value for which `|T|`
//! equals its limit; then the moment acts against the spin and only dissipates energy. In the rigid
//! limit `s = 0` and `θ = 0`.

use crate::ground::FrictionElement;
use crate::rock::Vec3;
use nalgebra::Matrix3;

/// Newton steps for `s`, at most: three are enough unless the moments of inertia differ widely.
const STEPS: u32 = 40;
/// Relative tolerance of `|T|` at its limit (–).
const AT_LIMIT: f64 = 1e-13;

/// Rolling friction of a body over a stage, and its angular impulse.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RollingImpulse {
    /// `s` (1/(kg m²)); `None` = no rolling friction.
    compliance: Option<f64>,
    /// Spin equivalent of the spring's stretch (rad/s): `k θ/(k b + c)`.
    spring_spin: Vec3,
    /// Angular impulse on the body (N m s).
    pub(crate) impulse: Vec3,
}

impl Default for RollingImpulse {
    fn default() -> Self {
        Self::NONE
    }
}

impl RollingImpulse {
    /// No rolling friction.
    pub(crate) const NONE: Self = Self {
        compliance: None,
        spring_spin: Vec3::new(0.0, 0.0, 0.0),
        impulse: Vec3::new(0.0, 0.0, 0.0),
    };

    /// Rolling friction in the rigid limit.
    pub(crate) const RIGID: Self = Self { compliance: Some(0.0), ..Self::NONE };

    /// Over a stage in which the moment acts for `a` and the block turns for `b` (s), from a
    /// stretch of its spring (rad).
    pub(super) fn of_stage(element: &FrictionElement, stretch: &Vec3, (a, b): (f64, f64)) -> Self {
        let stiffness = element.stage_stiffness(b);
        let spring_spin = element.spring_force(*stretch) / stiffness;
        Self { compliance: Some(1.0 / (a * stiffness)), spring_spin, ..Self::NONE }
    }

    /// The same with an initial guess of the impulse (N m s).
    pub(super) fn with_guess(self, impulse: Vec3) -> Self {
        Self { impulse, ..self }
    }

    /// The same with this compliance (1/(kg m²)), if there is rolling friction.
    pub(super) fn with_compliance(self, compliance: f64) -> Self {
        Self { compliance: self.compliance.map(|_| compliance), ..self }
    }

    /// Whether there is rolling friction.
    #[inline]
    pub(crate) fn is_on(&self) -> bool {
        self.compliance.is_some()
    }

    /// Updates the angular impulse of contacts with the capacity `limit` (N m s) at the spin `w`
    /// (rad/s) of a body with an inverse inertia (1/(kg m²)); returns the change of the spin.
    pub(crate) fn update(&mut self, inverse: &Matrix3<f64>, w: &Vec3, limit: f64) -> Vec3 {
        let Some(compliance) = self.compliance else { return Vec3::zeros() };
        let own = inverse * self.impulse;
        let next = -limited_impulse(inverse, &(w - own + self.spring_spin), (compliance, limit));
        self.impulse = next;
        inverse * next - own
    }

    /// The angular impulse that it takes from a body that turns with `w` at the stage's end, for
    /// contacts with the capacity `limit` (N m s), and its derivatives with respect to the spin and
    /// to the limit.
    pub(super) fn impulse_at(
        &mut self,
        w: &Vec3,
        limit: f64,
    ) -> Option<(Vec3, Matrix3<f64>, Vec3)> {
        let stiffness = 1.0 / self.compliance?;
        let demand = w + self.spring_spin;
        let size = demand.norm();
        let found = if size * stiffness <= limit {
            (demand * stiffness, Matrix3::identity() * stiffness, Vec3::zeros())
        } else {
            let direction = demand / size;
            let across = Matrix3::identity() - direction * direction.transpose();
            (direction * limit, across * (limit / size), direction)
        };
        self.impulse = -found.0;
        Some(found)
    }
}

/// `T` for a body with an inverse inertia (1/(kg m²)), the spin to be stopped (rad/s), the least
/// `s` and the limit (N m s). The norm of `(s + I⁻¹)⁻¹ ω` falls with `s`. Newton's method on its
/// reciprocal, which is nearly linear, converges from below without overshoot.
fn limited_impulse(inverse: &Matrix3<f64>, spin: &Vec3, (least, limit): (f64, f64)) -> Vec3 {
    if limit <= 0.0 {
        return Vec3::zeros();
    }
    let inverse_with = |s: f64| (inverse + Matrix3::identity() * s).try_inverse();
    let mut s = least;
    let Some(mut soft) = inverse_with(s) else { return Vec3::zeros() };
    let mut taken = soft * spin;
    for _ in 0..STEPS {
        let beyond = taken.norm() - limit;
        if beyond <= AT_LIMIT * limit {
            return taken;
        }
        s += taken.norm_squared() / taken.dot(&(soft * taken)) * beyond / limit;
        let Some(next) = inverse_with(s) else { break };
        (soft, taken) = (next, next * spin);
    }
    crate::solver::law::clamp_norm(taken, limit)
}

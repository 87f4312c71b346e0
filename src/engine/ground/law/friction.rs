//! The friction element of a contact, shear or rolling: a slider in series with a spring and a
//! dashpot side by side.
//!
//! While it sticks, the spring's stretch `ξ` follows the slip `u`: force `k ξ + c u`. The slider
//! slides at `limit × F_n`: Coulomb's cap along the surface, that of rolling friction about the
//! centre. Both are one element with other units:
//!
//! | | stretch | rate | force | `k` | `c` | limit |
//! |---|---|---|---|---|---|---|
//! | shear | m | m/s | N | `p_s` N/m | `c_s` N s/m | `tan φ` – |
//! | rolling | rad | rad/s | N m | `k_r` N m/rad | `c_r` N m s/rad | `ρ R` m |

use crate::rock::Vec3;
use nalgebra::Matrix3;
use std::ops::Mul;

/// A force below this share of its cap sticks (–).
pub(crate) const STICK_THRESHOLD: f64 = 1.0 - 1e-9;

/// Shortens `x` to a length of at most `cap`.
#[inline]
pub(crate) fn clamp_norm(x: Vec3, cap: f64) -> Vec3 {
    let size2 = x.norm_squared();
    if size2 > cap * cap { x * (cap / size2.sqrt()) } else { x }
}

/// Spring and dashpot in series with a slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FrictionElement {
    /// Stiffness.
    pub(super) k: f64,
    /// Damping.
    pub(super) c: f64,
    /// Largest force over the normal force; 0 = there is no such element.
    pub(super) limit: f64,
}

impl FrictionElement {
    /// None.
    pub(super) const NONE: Self = Self { k: 0.0, c: 0.0, limit: 0.0 };

    /// Whether there is any friction of this kind.
    #[inline]
    pub(crate) fn is_on(&self) -> bool {
        self.limit > 0.0
    }

    /// Whether it has a dashpot.
    #[inline]
    pub(crate) fn is_damped(&self) -> bool {
        self.c > 0.0
    }

    /// Largest force under a normal force (N).
    #[inline]
    pub(crate) fn cap(&self, normal_force: f64) -> f64 {
        self.limit * normal_force
    }

    /// A force shortened to the slider's limit under a normal force (N).
    #[inline]
    pub(crate) fn capped(&self, force: Vec3, normal_force: f64) -> Vec3 {
        clamp_norm(force, self.cap(normal_force))
    }

    /// Force of the spring at a stretch.
    #[inline]
    pub(crate) fn spring_force<T: Mul<f64, Output = T>>(&self, stretch: T) -> T {
        stretch * self.k
    }

    /// Force of the dashpot at a rate.
    #[inline]
    pub(crate) fn dashpot_force<T: Mul<f64, Output = T>>(&self, rate: T) -> T {
        rate * self.c
    }

    /// Increase of a sticking force per rate over a stage of length `h` (s): `k h + c`.
    #[inline]
    pub(crate) fn stage_stiffness(&self, h: f64) -> f64 {
        self.k * h + self.c
    }

    /// The element's response at a stretch and a rate, with a given cap of the slider.
    #[inline]
    pub(crate) fn at_rate(&self, stretch: Vec3, rate: Vec3, cap: f64) -> SliderForce {
        let held = self.spring_force(stretch);
        let trial = held + self.dashpot_force(rate);
        let force = clamp_norm(trial, cap);
        let stretch_rate = self.stretch_rate(force, held);
        SliderForce { force, stretch_rate, trial_force2: trial.norm_squared() }
    }

    /// Rate at which the spring stretches under `force` at the spring force `held`; zero without a
    /// dashpot.
    #[inline]
    pub(crate) fn stretch_rate(&self, force: Vec3, held: Vec3) -> Vec3 {
        if self.c > 0.0 { (force - held) / self.c } else { Vec3::new(0.0, 0.0, 0.0) }
    }

    /// `1/c`, or 0 without a dashpot.
    #[inline]
    pub(crate) fn mobility(&self) -> f64 {
        if self.c > 0.0 { 1.0 / self.c } else { 0.0 }
    }

    /// Stretch after a stage of length `h` from `stretch` under `force`: `ξ' = (h q + c ξ*)/(h k +
    /// c)`.
    #[inline]
    pub(crate) fn stretch_after(&self, force: &Vec3, stretch: &Vec3, h: f64) -> Vec3 {
        (force * h + stretch * self.c) / self.stage_stiffness(h)
    }

    /// Longest stretch that the slider's limit allows under a normal force (N).
    pub(crate) fn longest_stretch(&self, normal_force: f64) -> f64 {
        self.limit * normal_force / self.k
    }

    /// Whether a force of this size slides under a normal force (N): at its cap up to rounding.
    #[inline]
    pub(crate) fn slides(&self, size: f64, normal_force: f64) -> bool {
        size >= self.limit * normal_force * STICK_THRESHOLD
    }

    /// The same from the square of the size.
    #[inline]
    pub(crate) fn slides2(&self, size2: f64, normal_force: f64) -> bool {
        size2 >= (self.limit * normal_force * STICK_THRESHOLD).powi(2)
    }

    /// Stiffness, damping and limit in the units of another contact.
    #[inline]
    pub(crate) fn in_units(&self, [stiffness, damping, limit]: [f64; 3]) -> [f64; 3] {
        [self.k / stiffness, self.c / damping, self.limit / limit]
    }

    /// Spring and dashpot over a step of fixed length (s): force per displacement.
    pub(crate) fn over_step(&self, dt: f64) -> [f64; 2] {
        [self.k, self.c / dt]
    }

    /// The element over a stage of length `h` (s) in the mode, sticking or sliding, of a `force`
    /// under a normal force (N).
    pub(crate) fn stage_slider(&self, h: f64, (force, normal_force): (&Vec3, f64)) -> Slider {
        Slider {
            limit: self.limit,
            stiffness: self.stage_stiffness(h),
            sticks: force.norm() < self.limit * normal_force * STICK_THRESHOLD,
        }
    }

    /// The element in a bond, which never slides.
    pub(crate) fn bonded_slider(&self, h: f64) -> Slider {
        Slider { limit: f64::INFINITY, stiffness: self.stage_stiffness(h), sticks: true }
    }
}

/// Response of a friction element.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SliderForce {
    /// Its force (N) or moment (N m).
    pub(crate) force: Vec3,
    /// Rate of its spring's stretch (m/s, rad/s).
    pub(crate) stretch_rate: Vec3,
    /// Square of the trial force, before the cap.
    pub(crate) trial_force2: f64,
}

/// A friction element over a stage, and its mode.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slider {
    limit: f64,
    stiffness: f64,
    sticks: bool,
}

/// A slider's force and its derivatives with respect to speed and normal force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearFriction {
    pub(crate) force: Vec3,
    pub(crate) jacobian: Matrix3<f64>,
    /// Derivative with respect to the normal force; zero while it sticks.
    pub(crate) along: Vec3,
}

impl Slider {
    /// Force and derivatives for the trial force `trial`, that of a sticking element.
    pub(crate) fn at(&self, trial: Vec3, normal_force: f64) -> LinearFriction {
        let (cap, size) = (self.limit * normal_force, trial.norm());
        if self.sticks || size <= cap {
            let jacobian = Matrix3::identity() * self.stiffness;
            return LinearFriction { force: trial, jacobian, along: Vec3::zeros() };
        }
        let e = trial / size;
        let across = Matrix3::identity() - e * e.transpose();
        let jacobian = across * (self.stiffness * cap / size);
        LinearFriction { force: e * cap, jacobian, along: e * self.limit }
    }
}

/// The limits of friction (–) and of rolling friction (m), where impulses take the place of forces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct FrictionLimits {
    pub(super) shear: f64,
    pub(super) rolling: f64,
}

impl FrictionLimits {
    /// None.
    pub(crate) const NONE: Self = Self { shear: 0.0, rolling: 0.0 };

    /// The largest impulses along the surface and of rolling under a normal impulse.
    #[inline]
    pub(crate) fn caps(&self, normal: f64) -> (f64, f64) {
        (self.shear * normal, self.rolling * normal)
    }

    /// An impulse along the surface, shortened to its limit.
    #[inline]
    pub(crate) fn shear(&self, impulse: Vec3, normal: f64) -> Vec3 {
        clamp_norm(impulse, self.shear * normal)
    }

    /// An impulse of rolling, shortened to its limit.
    #[inline]
    pub(crate) fn rolling(&self, impulse: Vec3, normal: f64) -> Vec3 {
        clamp_norm(impulse, self.rolling * normal)
    }

    /// Whether an impulse of this size along the surface slides.
    #[inline]
    pub(crate) fn slides(&self, size: f64, normal: f64) -> bool {
        size >= self.shear * normal * STICK_THRESHOLD
    }

    /// Whether there is friction along the surface.
    pub(crate) fn has_friction(&self) -> bool {
        self.shear > 0.0
    }

    /// Whether there is rolling friction.
    pub(crate) fn has_rolling(&self) -> bool {
        self.rolling > 0.0
    }

    /// The same without rolling friction, which contacts between rocks do not have.
    pub(crate) fn without_rolling(self) -> Self {
        Self { rolling: 0.0, ..self }
    }
}

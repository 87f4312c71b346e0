//! The contact law: all that stiffness, damping and friction of a ground do to a rock, or to two
//! rocks.
//!
//! Normal: a spring beside a dashpot, no tension ([`normal`](NormalElement)). Shear and rolling: a
//! slider in series with a spring and a dashpot ([`friction`](FrictionElement)). **Nobody outside
//! this folder reads a coefficient**: callers ask for a quantity by its meaning, so that another
//! law is written in one place. The fields are private, which the compiler enforces.
//!
//! | quantity | function |
//! |---|---|
//! | a force at a motion | [`NormalElement::force`], [`FrictionElement::spring_force`], `dashpot_force`, `capped` |
//! | a force at the end of an implicit stage | [`NormalElement::stage_force`], [`FrictionElement::stage_stiffness`] |
//! | its derivatives | [`NormalElement::line`], [`FrictionElement::stage_slider`] |
//! | the energy in springs | [`Law::stored_j`], [`NormalElement::stored_j`] |
//! | the friction limits | [`FrictionElement::cap`], [`Law::limits`] |
//! | how long a contact lasts | [`Law::omega_rad_s`] |
//! | which impact rebounds, and how | [`Law::capture_m_s`], [`Law::restitution_at`] |

mod damping;
mod friction;
mod lever;
mod normal;

use super::Ground;
use crate::rock::Rock;
use damping::shear_ratio_at;
pub use damping::{
    CAPTURE_DAMPING_RATIO, Damping, NormalImpact, damping_ratio, normal_impact, restitution,
    tangential_restitution,
};
pub(crate) use friction::{
    FrictionElement, FrictionLimits, LinearFriction, STICK_THRESHOLD, SliderForce, clamp_norm,
};
pub(crate) use normal::{FixedStepNormal, NormalElement, NormalLine};

/// Rolling stiffness over `p_s R²` (–); with it the rolling spring is a tenth as stiff as the shear
/// spring.
const ROLLING_STIFFNESS: f64 = 0.1;
/// No impact slower than this rebounds (m/s), whatever the springs.
const SLOWEST_REBOUND_M_S: f64 = 0.02;
/// Lower bound of the capture speed in the rigid limit (m/s), whatever is asked for: an impact
/// takes no time there, and rounding errors would cause impacts without end.
const MIN_CAPTURE_M_S: f64 = 1e-6;

/// The contact law of one ground for one rock, or of two rocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Normal stiffness `p_N` (N/m).
    p_n: f64,
    /// Normal damping `c_N` (N s/m).
    c_n: f64,
    /// Normal damping of a captured impact (N s/m).
    c_n_captured: f64,
    /// Friction against slip along the surface.
    pub(crate) shear: FrictionElement,
    /// Friction against rolling.
    pub(crate) rolling: FrictionElement,
    /// Critical dashpots along the surface (N s/m) and of rolling (N m s/rad).
    critical: [f64; 2],
    /// Impacts slower than this do not rebound (m/s).
    pub capture_m_s: f64,
    /// Normal restitution (–) of slow impacts, see [`Self::restitution_at`].
    restitution: f64,
    /// Normal speed (m/s) at which it has fallen to half; infinite where it is constant.
    pub(crate) restitution_half_m_s: f64,
    /// Largest random tilt of the normal (rad).
    pub roughness_rad: f64,
    /// Length of one tilted facet (m).
    pub roughness_length_m: f64,
    /// `√(p_N/m)` (rad/s).
    omega: f64,
}

/// What the capture speed depends on besides ground and rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capture {
    /// Capture speed given by the user (m/s), if any.
    pub own_m_s: Option<f64>,
    /// Local error allowed (m/s): rebounds slower than half of it cannot be told from errors.
    pub tolerance_m_s: f64,
    /// Gravity (m/s²), positive.
    pub gravity_m_s2: f64,
}

impl Law {
    /// A ground without any effect.
    pub const NONE: Self = Self {
        p_n: 0.0,
        c_n: 0.0,
        c_n_captured: 0.0,
        shear: FrictionElement::NONE,
        rolling: FrictionElement::NONE,
        critical: [0.0; 2],
        capture_m_s: 0.0,
        restitution: 0.0,
        restitution_half_m_s: f64::INFINITY,
        roughness_rad: 0.0,
        roughness_length_m: 0.0,
        omega: 0.0,
    };

    /// The law of `ground` for `rock`; `damping` belongs to the ground's restitution.
    pub fn new(ground: &Ground, damping: &Damping, rock: &Rock, capture: &Capture) -> Self {
        Self::of_mass(ground, damping, (rock.mass_kg(), rock.radius_m), capture)
    }

    /// The law of a contact that moves the mass `m` (kg), with a rolling radius (m). For two rocks
    /// `m` is their reduced mass `m_a m_b/(m_a + m_b)`: the same formulas hold, along the surface
    /// too, as both are solid spheres.
    pub fn of_mass(
        ground: &Ground,
        damping: &Damping,
        (m, radius): (f64, f64),
        capture: &Capture,
    ) -> Self {
        let (p_n, p_s) = (ground.normal_stiffness_n_m, ground.shear_stiffness_n_m);
        let omega = (p_n / m).sqrt();
        let has_rolling = ground.rolling_friction > 0.0;
        let k_r = if has_rolling { ROLLING_STIFFNESS * p_s * radius * radius } else { 0.0 };
        let physical = damping.capture_number * capture.gravity_m_s2 / omega;
        let least = (0.5 * capture.tolerance_m_s).max(SLOWEST_REBOUND_M_S);
        let shear_ratio =
            if ground.restitution.is_some() { shear_ratio_at(damping.ratio) } else { 0.0 };
        let critical = [
            2.0 * (p_s * m / Rock::SLIP_LIGHTNESS).sqrt(),
            2.0 * (k_r * Rock::ROLLING_INERTIA * m).sqrt() * radius,
        ];
        Self {
            p_n,
            c_n: 2.0 * damping.ratio * m * omega,
            c_n_captured: 2.0 * CAPTURE_DAMPING_RATIO.max(damping.ratio) * m * omega,
            shear: FrictionElement {
                k: p_s,
                c: shear_ratio * critical[0],
                limit: ground.friction_coefficient(),
            },
            rolling: FrictionElement {
                k: k_r,
                c: shear_ratio_at(damping.ratio) * critical[1],
                limit: ground.rolling_friction * radius,
            },
            critical,
            capture_m_s: capture.own_m_s.unwrap_or_else(|| physical.max(least)),
            restitution: ground.restitution.unwrap_or(1.0),
            restitution_half_m_s: ground.restitution_half_m_s.unwrap_or(f64::INFINITY),
            roughness_rad: ground.roughness_rad,
            roughness_length_m: ground.roughness_length_m.unwrap_or(radius),
            omega,
        }
    }

    /// Penalty springs of a rigid contact, with the friction of another law on a rock of a radius
    /// (m). Their stiffness is an impulse (N s) per speed (m/s), hence in kg.
    pub(crate) fn penalty(stiffness_kg: f64, limits: FrictionLimits, radius: f64) -> Self {
        let k_r = if limits.has_rolling() { stiffness_kg * radius * radius } else { 0.0 };
        Self {
            p_n: stiffness_kg,
            shear: FrictionElement { k: stiffness_kg, c: 0.0, limit: limits.shear },
            rolling: FrictionElement { k: k_r, c: 0.0, limit: limits.rolling },
            ..Self::NONE
        }
    }

    /// The same law for a patch of stiffness `gain2 = |a|²` (–) among several that are pressed at
    /// once. Its effective mass is `m/|a|²`, so `c_N` scales with `|a|`. Parallel dashpots take
    /// `share` of theirs (–), so that the damping ratio, and with it the restitution, does not
    /// depend on the number of patches.
    #[must_use]
    #[inline]
    #[expect(clippy::float_cmp, reason = "a single point has exactly these")]
    pub fn of_patch(&self, gain2: f64, share: f64) -> Self {
        if gain2 == 1.0 && share == 1.0 {
            return *self;
        }
        let gain = gain2.sqrt();
        Self {
            p_n: self.p_n * gain2,
            c_n: self.c_n * (gain * share),
            c_n_captured: self.c_n_captured * (gain * share),
            ..*self
        }
    }

    /// The same law without rolling friction, which contacts between rocks do not have.
    #[must_use]
    pub(crate) fn without_rolling(&self) -> Self {
        Self { rolling: FrictionElement::NONE, ..*self }
    }

    /// Whether its springs have the stiffnesses of `other`; a friction spring that one of them
    /// lacks is not compared.
    pub(crate) fn has_springs_of(&self, other: &Self) -> bool {
        let are_alike = |own: &FrictionElement, other: &FrictionElement| {
            !(own.is_on() && other.is_on()) || own.k.to_bits() == other.k.to_bits()
        };
        self.p_n.to_bits() == other.p_n.to_bits()
            && are_alike(&self.shear, &other.shear)
            && are_alike(&self.rolling, &other.rolling)
    }

    /// Ratios of its depth and stretches to those of `other` under the same load (–): normal, shear
    /// and rolling; 1 where its springs are no stiffer.
    pub(crate) fn stretch_ratios_to(&self, other: &Self) -> [f64; 3] {
        let share = |own: f64, other: f64| if own > other { other / own } else { 1.0 };
        [
            share(self.p_n, other.p_n),
            share(self.shear.k, other.shear.k),
            share(self.rolling.k, other.rolling.k),
        ]
    }

    /// The same law with the friction of `other`, along the surface and in rolling; springs that
    /// may be stretched keep their stiffness and damping.
    pub(crate) fn with_friction_of(&self, other: &Self) -> Self {
        let replaced = |own: FrictionElement, other: FrictionElement| {
            if own.is_on() { FrictionElement { limit: other.limit, ..own } } else { other }
        };
        Self {
            shear: replaced(self.shear, other.shear),
            rolling: replaced(self.rolling, other.rolling),
            ..*self
        }
    }

    /// `√(p_N/m)` (rad/s): a contact lasts about `π` over this.
    #[inline]
    pub fn omega_rad_s(&self) -> f64 {
        self.omega
    }

    /// The limits of friction and of rolling friction.
    #[inline]
    pub(crate) fn limits(&self) -> FrictionLimits {
        FrictionLimits { shear: self.shear.limit, rolling: self.rolling.limit }
    }

    /// Coefficient of friction `tan φ` in force (–), before the increase by slip.
    #[inline]
    pub(crate) fn friction_coefficient(&self) -> f64 {
        self.shear.limit
    }

    /// Sets the coefficient of friction (–); returns whether it has changed.
    pub(crate) fn set_friction(&mut self, coefficient: f64) -> bool {
        std::mem::replace(&mut self.shear.limit, coefficient).to_bits() != coefficient.to_bits()
    }
}

impl Law {
    /// Energy in springs (J) at a penetration (m) and the squares of their stretches (m², rad²):
    /// `(p_N pen² + p_s ξ² + k_r θ²)/2`.
    #[inline]
    pub(crate) fn stored_j(&self, penetration: f64, shear2: f64, roll2: f64) -> f64 {
        0.5 * (self.p_n * penetration * penetration
            + self.shear.k * shear2
            + self.rolling.k * roll2)
    }

    /// Upper bound of the power dissipated in a contact (W), and half of its growth rate (W/s),
    /// under a normal force (N), at speeds inwards and along the surface (m/s): forces do not grow
    /// faster than those of springs without loss.
    pub(crate) fn power_bound_w(&self, force_n: f64, inwards: f64, slip: f64) -> (f64, f64) {
        // W(h) ≤ Σ (v_n + μ |u|) (F h + p_N v_n h²/2)
        let force = force_n.max(self.c_n * inwards);
        let speed = inwards + self.shear.limit * slip;
        (force * speed, 0.5 * self.p_n * inwards * speed)
    }
}

impl Law {
    /// Speed of approach above which an impact rebounds in the rigid limit (m/s).
    #[inline]
    pub(crate) fn rigid_capture_m_s(&self) -> f64 {
        self.capture_m_s.max(MIN_CAPTURE_M_S)
    }

    /// Normal restitution (–) of an impact at a normal speed (m/s): `e/(1 + (v/v_half)²)` (Pfeiffer
    /// and Bowen 1989).
    #[inline]
    pub fn restitution_at(&self, approach_m_s: f64) -> f64 {
        let relative = approach_m_s / self.restitution_half_m_s;
        self.restitution / (1.0 + relative * relative)
    }

    /// Whether the restitution is 0, however slow the impact.
    #[inline]
    pub(crate) fn is_plastic(&self) -> bool {
        self.restitution <= 0.0
    }

    /// Damping ratio (–) of an impact at a normal speed (m/s), if the restitution depends on the
    /// speed.
    pub(crate) fn ratio_at(&self, approach_m_s: f64) -> Option<f64> {
        let depends_on_speed = self.restitution_half_m_s.is_finite();
        depends_on_speed.then(|| damping_ratio(self.restitution_at(approach_m_s)))
    }

    /// Sets the dashpots to those of an impact at a normal speed (m/s), until the next one.
    pub fn set_impact_speed(&mut self, approach_m_s: f64) {
        if let Some(ratio) = self.ratio_at(approach_m_s) {
            self.set_damping_ratio(ratio);
        }
    }

    /// The same law with dashpots of a damping ratio (–).
    pub(crate) fn damped(&self, ratio: f64) -> Self {
        let mut law = *self;
        law.set_damping_ratio(ratio);
        law
    }

    /// Sets the dashpots to a damping ratio (–).
    fn set_damping_ratio(&mut self, ratio: f64) {
        let critical = 2.0 * self.p_n / self.omega;
        self.c_n = ratio * critical;
        self.c_n_captured = CAPTURE_DAMPING_RATIO.max(ratio) * critical;
        self.shear.c = shear_ratio_at(ratio) * self.critical[0];
        self.rolling.c = shear_ratio_at(ratio) * self.critical[1];
    }
}

/// The coefficients of a law, for tests that implement it a second time.
#[cfg(test)]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coefficients {
    /// Normal stiffness (N/m), damping, damping when captured (N s/m).
    pub(crate) normal: [f64; 3],
    /// Stiffness, damping, limit of shear (N/m, N s/m, –) and of rolling (N m/rad, N m s/rad, m).
    pub(crate) shear: [f64; 3],
    pub(crate) rolling: [f64; 3],
}

#[cfg(test)]
impl Law {
    /// All coefficients.
    pub(crate) fn coefficients(&self) -> Coefficients {
        let of = |element: &FrictionElement| [element.k, element.c, element.limit];
        Coefficients {
            normal: [self.p_n, self.c_n, self.c_n_captured],
            shear: of(&self.shear),
            rolling: of(&self.rolling),
        }
    }

    /// The same law without its normal dashpot.
    pub(crate) fn undamped(&self) -> Self {
        Self { c_n: 0.0, ..*self }
    }
}

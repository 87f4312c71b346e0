//! How a ground answers a rock: springs, friction, damping from restitution, rolling friction, roughness.

mod soil;

use crate::math;
use crate::rock::Rock;
pub use soil::{Scar, SlipFriction, cut_area_m2, swept_m3};
use std::f64::consts::{PI, TAU};

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
    /// Way over which one tilted facet reaches (m), positive; `None` = the radius of the rock.
    pub roughness_length_m: Option<f64>,
    /// Friction that grows while a rock slips; `None` = Coulomb's.
    pub slip_friction: Option<SlipFriction>,
    /// Soil that a rock digs into and that drags; `None` = the surface is hard.
    pub scar: Option<Scar>,
    /// Normal speed of impact at which half of the restitution is left (m/s), positive; `None` = it stays the same.
    pub restitution_half_m_s: Option<f64>,
}

/// Rolling stiffness over `p_s R²` (–); with it the rolling spring is a tenth as stiff as the shear spring.
const ROLLING_STIFFNESS: f64 = 0.1;
/// Damping ratio of the shear spring: without it the spring returns the slip like a super ball.
const SHEAR_DAMPING_RATIO: f64 = 1.0;
/// Damping ratio of an impact too slow to rebound; it ends all flutter.
const CAPTURE_DAMPING_RATIO: f64 = 2.0;
/// Below this restitution an impact is plastic (–): the damping ratio of e → 0 grows without bound.
const PLASTIC_RESTITUTION: f64 = 0.01;
/// Damping ratio of a plastic impact; `e(5) = 0.01`.
const PLASTIC_DAMPING_RATIO: f64 = 5.0;
/// No impact slower than this rebounds (m/s), whatever the springs say.
const SLOWEST_REBOUND_M_S: f64 = 0.02;

/// The contact law of one ground for one rock: every coefficient of springs, dashpots and sliders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Normal stiffness `p_N` (N/m).
    pub p_n: f64,
    /// Shear stiffness `p_s` (N/m).
    pub p_s: f64,
    /// Rolling stiffness `k_r` (N m/rad); 0 without rolling friction.
    pub k_r: f64,
    /// Normal damping `c_N` (N s/m).
    pub c_n: f64,
    /// Normal damping of a captured impact (N s/m).
    pub c_n_captured: f64,
    /// Shear damping (N s/m).
    pub c_s: f64,
    /// Rolling damping (N m s/rad); 0 without rolling friction.
    pub c_r: f64,
    /// Friction coefficient `tan φ` (–).
    pub friction: f64,
    /// Rolling friction times radius (m): the torque's limit over the normal force.
    pub rolling_m: f64,
    /// Impacts slower than this do not rebound (m/s).
    pub capture_m_s: f64,
    /// Normal restitution (–) of slow impacts, see [`Self::restitution_at`].
    pub restitution: f64,
    /// Normal speed (m/s) at which half of it is left; infinite where it stays the same.
    pub restitution_half_m_s: f64,
    /// Largest random tilt of the normal (rad).
    pub roughness_rad: f64,
    /// Way over which one tilted facet reaches (m).
    pub roughness_length_m: f64,
    /// `√(p_N/m)` (rad/s).
    pub omega: f64,
}

/// What a law needs to know besides ground and rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capture {
    /// Capture speed the user wrote (m/s), if any.
    pub own_m_s: Option<f64>,
    /// Local error allowed (m/s): slower rebounds than half of it cannot be told from error.
    pub tolerance_m_s: f64,
    /// Gravity (m/s²), positive.
    pub gravity_m_s2: f64,
}

impl Law {
    /// A ground that does nothing.
    pub const NONE: Self = Self {
        p_n: 0.0,
        p_s: 0.0,
        k_r: 0.0,
        c_n: 0.0,
        c_n_captured: 0.0,
        c_s: 0.0,
        c_r: 0.0,
        friction: 0.0,
        rolling_m: 0.0,
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

    /// The law of a contact that moves the mass `m` (kg), of a rolling radius (m). For two rocks that is their reduced
    /// mass `m_a m_b/(m_a + m_b)`: the same formulas hold, along the surface too, as both are solid spheres.
    pub fn of_mass(
        ground: &Ground,
        damping: &Damping,
        (m, radius): (f64, f64),
        capture: &Capture,
    ) -> Self {
        let (p_n, p_s) = (ground.normal_stiffness_n_m, ground.shear_stiffness_n_m);
        let omega = (p_n / m).sqrt();
        let rolls = ground.rolling_friction > 0.0;
        let k_r = if rolls { ROLLING_STIFFNESS * p_s * radius * radius } else { 0.0 };
        let physical = damping.capture_number * capture.gravity_m_s2 / omega;
        let least = (0.5 * capture.tolerance_m_s).max(SLOWEST_REBOUND_M_S);
        let damped = if ground.restitution.is_some() { SHEAR_DAMPING_RATIO } else { 0.0 };
        Self {
            p_n,
            p_s,
            k_r,
            c_n: 2.0 * damping.ratio * m * omega,
            c_n_captured: 2.0 * CAPTURE_DAMPING_RATIO.max(damping.ratio) * m * omega,
            // The contact point's mass along the surface is 2/7 m.
            c_s: 2.0 * damped * (p_s * m * 2.0 / 7.0).sqrt(),
            c_r: 2.0 * (k_r * 1.4 * m).sqrt() * radius,
            friction: math::tan(ground.friction_angle_rad),
            rolling_m: ground.rolling_friction * radius,
            capture_m_s: capture.own_m_s.unwrap_or_else(|| physical.max(least)),
            restitution: ground.restitution.unwrap_or(1.0),
            restitution_half_m_s: ground.restitution_half_m_s.unwrap_or(f64::INFINITY),
            roughness_rad: ground.roughness_rad,
            roughness_length_m: ground.roughness_length_m.unwrap_or(radius),
            omega,
        }
    }
}

impl Law {
    /// The same law for a patch of stiffness `gain2 = |a|²` (–) among several that are pressed at once: its effective mass is
    /// `m/|a|²`, so `c_N` goes with `|a|`, and parallel dashpots take `share` of theirs (–), so that the damping ratio, and
    /// with it the restitution, does not depend on how many patches there are.
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
}

impl Law {
    /// The same law for a contact with a lever, which moves other masses (kg) along its normal and along the surface than a ball of
    /// mass `mass_kg` does (all of it, and 2/7 of it): damping ratios stay.
    #[must_use]
    pub fn for_masses(&self, [along, across]: [f64; 2], mass_kg: f64) -> Self {
        let slower = (along / mass_kg).sqrt();
        Self {
            c_n: self.c_n * slower,
            c_n_captured: self.c_n_captured * slower,
            c_s: self.c_s * (3.5 * across / mass_kg).sqrt(),
            omega: self.omega / slower,
            ..*self
        }
    }

    /// Normal restitution (–) of an impact at a normal speed (m/s): `e/(1 + (v/v_half)²)` (Pfeiffer and Bowen 1989).
    #[inline]
    pub fn restitution_at(&self, approach_m_s: f64) -> f64 {
        let over = approach_m_s / self.restitution_half_m_s;
        self.restitution / (1.0 + over * over)
    }

    /// Takes the dashpot of an impact at a normal speed (m/s), until the next one.
    pub fn struck_at(&mut self, approach_m_s: f64) {
        if self.restitution_half_m_s.is_finite() {
            let ratio = damping_ratio(self.restitution_at(approach_m_s));
            let critical = 2.0 * self.p_n / self.omega;
            self.c_n = ratio * critical;
            self.c_n_captured = CAPTURE_DAMPING_RATIO.max(ratio) * critical;
        }
    }
}

/// Restitution of a no-tension spring and dashpot without gravity.
///
/// `e(ζ) = exp(−2 ζ acos ζ / √(1−ζ²))`; the contact ends when the force falls to zero, not when the spring is
/// back at its length (the textbook's `exp(−π ζ/√(1−ζ²))`), so nothing ever pulls.
pub fn restitution(zeta: f64) -> f64 {
    math::exp(-2.0 * zeta * angle_over_sine(zeta))
}

/// `acos ζ / √(1−ζ²)`, beyond ζ = 1 with acosh.
fn angle_over_sine(zeta: f64) -> f64 {
    let off = 1.0 - zeta * zeta;
    if off.abs() < 1e-9 {
        1.0 + off / 6.0
    } else if off > 0.0 {
        math::acos(zeta) / off.sqrt()
    } else {
        math::acosh(zeta) / (-off).sqrt()
    }
}

/// Share of its slip that an impact on a plane gives back where it sticks throughout (–), for a ratio `p_s/p_N` (–);
/// negative where the slip goes on when the rock leaves.
///
/// The slip is that of the contact point's `2/7 m` on the critically damped shear spring, `u = u₀ (1 − ω_s t) e^(−ω_s t)`
/// with `ω_s = ω √(7/2 p_s/p_N)`, over the `2 acos ζ/√(1 − ζ²)` radians of ω that [`restitution`] ends after.
pub fn tangential_restitution(ratio: f64, damping: &Damping) -> f64 {
    let phase = (3.5 * ratio).sqrt() * 2.0 * angle_over_sine(damping.ratio);
    (phase - 1.0) * math::exp(-phase)
}

/// The damping ratio ζ that gives restitution `e` (0..1), the inverse of [`restitution`] by bisection.
pub fn damping_ratio(e: f64) -> f64 {
    if e < PLASTIC_RESTITUTION {
        return PLASTIC_DAMPING_RATIO;
    }
    let (mut lo, mut hi) = (0.0, PLASTIC_DAMPING_RATIO);
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if restitution(middle) > e {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    0.5 * (lo + hi)
}

/// One impact on a plane with gravity, exact as far as the normal motion goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalImpact {
    /// When the force falls to zero after the touch (s).
    pub lift_s: f64,
    /// Rebound speed at the surface (m/s); `None` when the rock does not come out again.
    pub rebound_m_s: Option<f64>,
}

/// Closed form of the spring-dashpot impact at approach speed `v`, frequency `omega`, damping ratio `zeta < 1`.
///
/// `x'' = g_n − 2 ζω x' − ω² x` from `x = 0, x' = v` until the force vanishes, then free.
pub fn normal_impact(v: f64, omega: f64, zeta: f64, g_n: f64) -> NormalImpact {
    let al = zeta * omega;
    let wd = omega * (1.0 - zeta * zeta).sqrt();
    let (x0, b) = (g_n / (omega * omega), (v - al * g_n / (omega * omega)) / wd);
    let state = |t: f64| {
        let (s, c) = math::sin_cos(wd * t);
        let fade = math::exp(-al * t);
        let x = x0 + fade * (b * s - x0 * c);
        let speed = fade * ((b * wd + al * x0) * c + (x0 * wd - al * b) * s);
        (x, speed)
    };
    // In units of g_n and 1/ω the same swing has its first trough at a known time.
    let (low, deepest) = first_trough(v * omega / g_n, zeta);
    if deepest > 0.0 {
        return NormalImpact { lift_s: f64::INFINITY, rebound_m_s: None };
    }
    // Newton on the force, halving where a step would leave the bracket.
    let (mut lo, mut hi) = (0.0, low / omega);
    let mut t = 0.5 * hi;
    for _ in 0..60 {
        let (x, speed) = state(t);
        let push = omega * omega * x + 2.0 * al * speed;
        if push > 0.0 {
            lo = t;
        } else {
            hi = t;
        }
        let slope = omega * omega * speed + 2.0 * al * (g_n - push);
        let next = t - push / slope;
        let next = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
        let change = (next - t).abs();
        t = next;
        if change <= 1e-16 * low / omega {
            break;
        }
    }
    let (x, speed) = state(t);
    let out = speed * speed - 2.0 * g_n * x;
    let leaves = speed < 0.0 && out > 0.0;
    NormalImpact { lift_s: t, rebound_m_s: leaves.then(|| out.sqrt()) }
}

/// Time and depth of the contact force's first trough, in units of 1/ω and of the weight.
///
/// The force swings around the weight, `F = 1 + A e^(−ζt) cos(ω_d t + φ)`, with `F(0) = 2ζp`, `F'(0) = p + 2ζ(1 − 2ζp)`
/// at the approach speed `p = v ω/g_n`.
fn first_trough(p: f64, zeta: f64) -> (f64, f64) {
    let wd = (1.0 - zeta * zeta).sqrt();
    let (off, slope) = (2.0 * zeta * p - 1.0, p + 2.0 * zeta * (1.0 - 2.0 * zeta * p));
    let across = -(slope + zeta * off) / wd;
    let low = PI - math::atan(zeta / wd);
    let t = (low - math::atan2(across, off)).rem_euclid(TAU) / wd;
    (t, 1.0 + math::hypot(off, across) * math::exp(-zeta * t) * math::cos(low))
}

/// What restitution asks of the normal dashpot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// Restitution (–), `None` without dashpots.
    pub restitution: Option<f64>,
    /// Damping ratio ζ (–).
    pub ratio: f64,
    /// `p* = v ω/g` below which gravity keeps the rock in contact (–): the physical capture speed.
    pub capture_number: f64,
}

impl Damping {
    /// The dashpot of a restitution.
    pub fn of(restitution: Option<f64>) -> Self {
        let ratio = restitution.map_or(0.0, damping_ratio);
        Self {
            restitution,
            ratio,
            capture_number: restitution.map_or(0.0, |_| capture_number(ratio)),
        }
    }
}

fn capture_number(zeta: f64) -> f64 {
    // Towards ζ = 1 the swing dies out; so heavily damped an impact hardly rebounds at all.
    let zeta = zeta.min(0.95);
    let (mut lo, mut hi) = (0.0, 200.0);
    for _ in 0..50 {
        let middle = 0.5 * (lo + hi);
        if normal_impact(middle, 1.0, zeta, 1.0).rebound_m_s.is_some() {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    hi
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of exact damping ratios (closed form, 12 digits).
    #[test]
    fn restitution_and_damping_ratio_are_inverse() {
        for (e, zeta) in [
            (0.9, 0.034_265_204_126),
            (0.5, 0.255_275_637_649),
            (0.3, 0.497_239_394_699),
            (0.1, 1.243_187_851_014),
        ] {
            assert!((restitution(zeta) - e).abs() < 1e-11);
            assert!((damping_ratio(e) - zeta).abs() < 1e-11);
        }
        assert!((restitution(1.0) - (-2.0f64).exp()).abs() < 1e-12);
        assert!((restitution(1.0 + 1e-10) - restitution(1.0 - 1e-10)).abs() < 1e-8);
    }

    /// With gravity the rebound falls with speed; e = 0.5 from the closed form at p = v ω/g.
    #[test]
    fn gravity_lowers_the_restitution_of_slow_impacts() {
        let zeta = damping_ratio(0.5);
        for (p, e) in [(5.0, 0.283_85), (10.0, 0.411_35), (30.0, 0.473_29), (100.0, 0.492_24)] {
            let out = normal_impact(p, 1.0, zeta, 1.0).rebound_m_s.unwrap();
            assert!((out / p - e).abs() < 1e-5, "p = {p}: {}", out / p);
        }
    }

    /// p* of the table: below it no rebound.
    #[test]
    fn slow_impacts_are_captured_at_the_physical_speed() {
        for (e, p) in [(0.9, 0.722_657), (0.5, 3.492_462), (0.3, 8.714_621)] {
            let zeta = damping_ratio(e);
            let found = capture_number(zeta);
            assert!((found - p).abs() < 1e-5, "e = {e}: {found}");
        }
    }
}

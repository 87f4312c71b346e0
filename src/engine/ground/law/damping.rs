//! The normal dashpot that gives a restitution, and the rebound of one impact.

use crate::math;
use crate::rock::Rock;
use std::f64::consts::{PI, TAU};

/// Below this restitution an impact is plastic (–): the damping ratio of e → 0 grows without bound.
const PLASTIC_RESTITUTION: f64 = 0.01;
/// Damping ratio of an impact too slow to rebound; it ends all flutter.
pub const CAPTURE_DAMPING_RATIO: f64 = 2.0;
/// Damping ratio of a plastic impact; `e(5) = 0.01`.
const PLASTIC_DAMPING_RATIO: f64 = 5.0;

/// Damping ratio of the shear spring and of the rolling spring: without damping the spring returns
/// the slip like a super ball.
const SHEAR_DAMPING_RATIO: f64 = 1.0;

/// Damping ratio along the surface, for that along the normal. Where little rebounds, the dashpot
/// carries the normal force; with a critical dashpot along the surface, that force would be over
/// before friction has built up: at `e = 0.01` half of Coulomb's impulse `min(μ J, 2/7 m u)` was
/// missing. With equal ratios it is reached to 2 %.
pub(super) fn shear_ratio_at(ratio: f64) -> f64 {
    ratio.max(SHEAR_DAMPING_RATIO)
}

/// Restitution of a no-tension spring and dashpot without gravity.
///
/// `e(ζ) = exp(−2 ζ acos ζ / √(1−ζ²))`; the contact ends when the force falls to zero, not when the
/// spring is back at its length (the textbook's `exp(−π ζ/√(1−ζ²))`), so the contact never pulls.
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

/// Share of its slip that an impact on a plane gives back if it sticks throughout (–), for a ratio
/// `p_s/p_N` (–); negative if the slip still continues when the rock leaves.
///
/// The slip is that of the contact point's `2/7 m` on the shear spring with its dashpot of ratio
/// `ζ_s = max(1, ζ)`, `u = u₀ (1 − ω_s t) e^(−ω_s t)` where that is critical, with `ω_s = ω √(7/2
/// p_s/p_N)`, over the `2 acos ζ/√(1 − ζ²)` radians of ω after which [`restitution`] ends.
pub fn tangential_restitution(ratio: f64, damping: &Damping) -> f64 {
    let phase = (Rock::SLIP_LIGHTNESS * ratio).sqrt() * 2.0 * angle_over_sine(damping.ratio);
    let zeta = shear_ratio_at(damping.ratio);
    let root = (zeta * zeta - 1.0).sqrt();
    if root < 1e-4 {
        return (phase - 1.0) * math::exp(-phase);
    }
    // overdamped: two decaying rates
    let slow = (zeta / root - 1.0) * math::exp(-(zeta - root) * phase);
    0.5 * (slow - (zeta / root + 1.0) * math::exp(-(zeta + root) * phase))
}

/// The damping ratio ζ that gives restitution `e` (0..1), the inverse of [`restitution`] by
/// bisection.
pub fn damping_ratio(e: f64) -> f64 {
    if e < PLASTIC_RESTITUTION {
        return PLASTIC_DAMPING_RATIO;
    }
    let [lo, hi] = math::bisected([0.0, PLASTIC_DAMPING_RATIO], 60, |zeta| restitution(zeta) > e);
    0.5 * (lo + hi)
}

/// One impact on a plane with gravity, exact as far as the normal motion is concerned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalImpact {
    /// Time from the touch until the force falls to zero (s).
    pub lift_s: f64,
    /// Rebound speed at the surface (m/s); `None` if the rock does not come out again.
    pub rebound_m_s: Option<f64>,
}

/// Closed form of the spring-dashpot impact at approach speed `v`, frequency `omega`, damping ratio
/// `zeta < 1`.
///
/// `x'' = g_n − 2 ζω x' − ω² x` from `x = 0, x' = v` until the force vanishes, then free.
pub fn normal_impact(v: f64, omega: f64, zeta: f64, g_n: f64) -> NormalImpact {
    let decay = zeta * omega;
    let omega_d = omega * (1.0 - zeta * zeta).sqrt();
    let (x0, b) = (g_n / (omega * omega), (v - decay * g_n / (omega * omega)) / omega_d);
    let state = |t: f64| {
        let (s, c) = math::sin_cos(omega_d * t);
        let fade = math::exp(-decay * t);
        let x = x0 + fade * (b * s - x0 * c);
        let speed = fade * ((b * omega_d + decay * x0) * c + (x0 * omega_d - decay * b) * s);
        (x, speed)
    };
    // in units of g_n and 1/ω the first trough of the oscillation is at a known time
    let (low, deepest) = first_trough(v * omega / g_n, zeta);
    if deepest > 0.0 {
        return NormalImpact { lift_s: f64::INFINITY, rebound_m_s: None };
    }
    // Newton on the force, with bisection where a step would leave the bracket.
    let (mut lo, mut hi) = (0.0, low / omega);
    let mut t = 0.5 * hi;
    for _ in 0..60 {
        let (x, speed) = state(t);
        let force = omega * omega * x + 2.0 * decay * speed;
        if force > 0.0 {
            lo = t;
        } else {
            hi = t;
        }
        let slope = omega * omega * speed + 2.0 * decay * (g_n - force);
        let next = t - force / slope;
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

/// Time and depth of the first trough of the contact force, in units of 1/ω and of the weight.
///
/// The force oscillates about the weight, `F = 1 + A e^(−ζt) cos(ω_d t + φ)`, with `F(0) = 2ζp`,
/// `F'(0) = p + 2ζ(1 − 2ζp)` at the approach speed `p = v ω/g_n`.
fn first_trough(p: f64, zeta: f64) -> (f64, f64) {
    let omega_d = (1.0 - zeta * zeta).sqrt();
    let (off, slope) = (2.0 * zeta * p - 1.0, p + 2.0 * zeta * (1.0 - 2.0 * zeta * p));
    let across = -(slope + zeta * off) / omega_d;
    let low = PI - math::atan(zeta / omega_d);
    let t = (low - math::atan2(across, off)).rem_euclid(TAU) / omega_d;
    (t, 1.0 + math::hypot(off, across) * math::exp(-zeta * t) * math::cos(low))
}

/// The normal dashpot of a restitution.
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
    // towards ζ = 1 the oscillation dies out; an impact so heavily damped hardly rebounds at all
    let zeta = zeta.min(0.95);
    let stays = |speed: f64| normal_impact(speed, 1.0, zeta, 1.0).rebound_m_s.is_none();
    math::bisected([0.0, 200.0], 50, stays)[1]
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

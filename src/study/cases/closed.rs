//! Closed forms of the exact cases, with springs (Kelvin–Voigt, critically damped in shear) and in the rigid limit.
//!
//! Along a plane that falls at α the stretch ξ of the shear spring of a sphere that sticks obeys
//! `ξ'' = G − k (p_s ξ + c_s ξ')/m`, `G = g sin α`, where `k = 1 + m R²/I = 7/2` for one contact and 9/2 for the two of
//! a right-angled groove, and the centre moves as `s'' = G (1 − j/k) + (j/k) ξ''` with j contacts.

use crate::math;
use crate::study::bench::{GRAVITY_M_S2, Setup};

/// A sphere that sticks from rest: its way along the plane after `t` (s) and the stretch of the spring (m).
///
/// The oscillation is critically damped for one contact (`c_s = 2 √(p_s 2m/7)`), over-damped for two. `t` must be long
/// against the contact time: the stretch has then reached its rest value.
pub(super) fn stuck_way_m(setup: &Setup, angle_rad: f64, contacts: f64, t: f64) -> f64 {
    let pull = setup.gravity_m_s2 * math::sin(angle_rad);
    let k = stuck_factor(contacts);
    let stretch = pull * setup.rock.mass_kg() / (k * setup.ground.shear_stiffness_n_m);
    0.5 * pull * (1.0 - contacts / k) * t * t + contacts / k * stretch
}

/// `k`: how much faster the contact moves than the mass alone would, from `c (1/m + lever²/I)`: both contacts of a
/// groove act at the lever `R/√2`.
fn stuck_factor(contacts: f64) -> f64 {
    contacts + 2.5
}

/// The same in the rigid limit.
pub(super) fn rolled_way_m(angle_rad: f64, contacts: f64, t: f64) -> f64 {
    0.5 * GRAVITY_M_S2 * math::sin(angle_rad) * (1.0 - contacts / stuck_factor(contacts)) * t * t
}

/// Way (m) and spin (rad/s) after `t` (s) from rest on a plane too steep to roll.
///
/// With springs friction grows as `q = m G/k (1 + (τ−1) e^(−τ))`, `τ = ω_t t`, until it reaches the cap `μ N` within a
/// millisecond; from then on everything is uniform. `has_springs` = false leaves that millisecond out.
pub(super) fn slipped(setup: &Setup, angle_rad: f64, t: f64, has_springs: bool) -> (f64, f64) {
    let (g, r) = (setup.gravity_m_s2, setup.rock.radius_m);
    let (pull, drag) = (
        g * math::sin(angle_rad),
        math::tan(setup.ground.friction_angle_rad) * g * math::cos(angle_rad),
    );
    let omega = (3.5 * setup.ground.shear_stiffness_n_m / setup.rock.mass_kg()).sqrt();
    let tau = if has_springs {
        zero_of(|tau| 1.0 + (tau - 1.0) * math::exp(-tau) - 3.5 * drag / pull, 0.0, 1.0)
    } else {
        0.0
    };
    let begins = tau / omega;
    let fade = math::exp(-tau);
    let (stretch, rate) = (pull / omega.powi(2) * (1.0 - (1.0 + tau) * fade), pull * begins * fade);
    let way = 2.5 / 7.0 * pull * begins * begins + stretch / 3.5;
    let speed = 5.0 / 7.0 * pull * begins + rate / 3.5;
    let left = t - begins;
    let spin = (speed - rate) / r + 2.5 * drag / r * left;
    (way + speed * left + 0.5 * (pull - drag) * left * left, spin)
}

/// Way (m) and speed (m/s) of a sphere pushed with `v` (m/s) over level ground, at a time `t` after it has begun to roll.
///
/// It slides with `a = −μ g` until `v = 5/7` of the push. The stretch `μ N/p_s` that the spring then holds is given
/// back: the contact springs back by it, the centre by 2/7 of it.
pub(super) fn skidded(setup: &Setup, v: f64, t: f64, has_springs: bool) -> (f64, f64) {
    let drag = math::tan(setup.ground.friction_angle_rad) * setup.gravity_m_s2;
    let rolls = 2.0 / 7.0 * v / drag;
    let stretch = drag * setup.rock.mass_kg() / setup.ground.shear_stiffness_n_m;
    let back = if has_springs { stretch / 3.5 } else { 0.0 };
    let way = v * rolls - 0.5 * drag * rolls * rolls + 5.0 / 7.0 * v * (t - rolls);
    (way - back, 5.0 / 7.0 * v)
}

/// Where a rising function is zero.
pub(super) fn zero_of(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let [low, high] = math::bisected([low, high], 80, |x| f(x) < 0.0);
    0.5 * (low + high)
}

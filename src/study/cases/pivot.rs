//! A sphere that tips over a sharp edge, in polar coordinates about it: the law on springs by plain explicit
//! fourth-order steps, and the rigid limit in closed form. Nothing here knows the meshes, leaps and implicit steps that
//! it is compared with.

use super::closed::zero_of;
use crate::ground::Damping;
use crate::math;
use crate::study::bench::{GRAVITY_M_S2, Setup};

/// Explicit steps per radian of contact oscillation: the error of the orbit is then below 1e-9.
const STEPS_PER_RADIAN: f64 = 40.0;

/// Distance and angle (from the upright) of the centre, their rates, spin and stretch of the shear spring.
type PivotState = [f64; 6];

/// Where the centre is (x, z; m) after `t` (s), from rest at `angle_rad` and static penetration above an edge along y.
pub(super) fn on_springs(setup: &Setup, angle_rad: f64, t: f64) -> (f64, f64) {
    let pressed = setup.pressed_m(angle_rad);
    let mut state = [setup.rock.radius_m - pressed, angle_rad, 0.0, 0.0, 0.0, 0.0];
    let omega = setup.omega();
    let steps = (t * omega * STEPS_PER_RADIAN).ceil();
    let h = t / steps;
    let law = PivotLaw::of(setup);
    for _ in 0..steps as usize {
        state = math::runge_kutta_4(&state, h, |state| law.rate(state));
    }
    (state[0] * math::sin(state[1]), state[0] * math::cos(state[1]))
}

struct PivotLaw {
    mass: f64,
    radius: f64,
    inertia: f64,
    gravity: f64,
    friction: f64,
    stiff: [f64; 2],
    damp: [f64; 2],
}

impl PivotLaw {
    fn of(setup: &Setup) -> Self {
        let (mass, ground) = (setup.rock.mass_kg(), &setup.ground);
        let ratio = Damping::of(ground.restitution).ratio;
        let stiff = [ground.normal_stiffness_n_m, ground.shear_stiffness_n_m];
        Self {
            mass,
            radius: setup.rock.radius_m,
            inertia: setup.rock.inertia_kg_m2(),
            gravity: setup.gravity_m_s2,
            friction: math::tan(ground.friction_angle_rad),
            stiff,
            damp: [
                2.0 * ratio * (stiff[0] * mass).sqrt(),
                2.0 * (stiff[1] * 2.0 / 7.0 * mass).sqrt(),
            ],
        }
    }

    /// `F = max(0, p_N pen + c_N pen')`, `q = p_s ξ + c_s u` cut at `μ F`, `ξ' = (q − p_s ξ)/c_s`; the lever is R.
    fn rate(&self, &[r, angle, r_rate, turn, spin, stretch]: &PivotState) -> PivotState {
        let depth = self.radius - r;
        let push = (self.stiff[0] * depth - self.damp[0] * r_rate).max(0.0);
        let push = if depth > 0.0 { push } else { 0.0 };
        let slip = r * turn - self.radius * spin;
        let wished = self.stiff[1] * stretch + self.damp[1] * slip;
        let cap = self.friction * push;
        let drag = wished.clamp(-cap, cap);
        let g = self.gravity;
        [
            r_rate,
            turn,
            push / self.mass - g * math::cos(angle) + r * turn * turn,
            (g * math::sin(angle) - drag / self.mass - 2.0 * r_rate * turn) / r,
            drag * self.radius / self.inertia,
            (drag - self.stiff[1] * stretch) / self.damp[1],
        ]
    }
}

/// Where the centre is (x, z; m) after `t` (s) in the rigid limit as long as it neither slips nor lifts off, from rest at
/// `angle_rad`: `θ'' = 5/7 g/R sin θ`.
pub(super) fn rolling(radius_m: f64, angle_rad: f64, t: f64) -> (f64, f64) {
    const STEPS: usize = 10_000;
    let h = t / STEPS as f64;
    let bend = |angle: f64| 5.0 / 7.0 * GRAVITY_M_S2 / radius_m * math::sin(angle);
    let (mut angle, mut rate) = (angle_rad, 0.0);
    for _ in 0..STEPS {
        let k1 = (rate, bend(angle));
        let k2 = (rate + 0.5 * h * k1.1, bend(angle + 0.5 * h * k1.0));
        let k3 = (rate + 0.5 * h * k2.1, bend(angle + 0.5 * h * k2.0));
        let k4 = (rate + h * k3.1, bend(angle + h * k3.0));
        angle += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        rate += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
    }
    (radius_m * math::sin(angle), radius_m * math::cos(angle))
}

/// The rigid limit: where the rock lifts off (angle, time, speed) from rest at 0.1 rad with R = 0.5 m.
pub(super) struct Lift {
    /// From the upright (rad).
    pub(super) angle_rad: f64,
    /// Since the start (s).
    pub(super) time_s: f64,
    /// Speed of the centre (m/s).
    pub(super) speed_m_s: f64,
}

impl Lift {
    /// Lift-off where `v² = g R cos θ`, from energy: `v² = b g R (cos θ₀ − cos θ)`, with b = 2 where the edge is
    /// smooth, 10/7 where the rock rolls. `time_s` is the integral of `dθ R/v`.
    pub(super) fn by_energy(radius_m: f64, from_rad: f64, b: f64, time_s: f64) -> Self {
        let cos = b / (1.0 + b) * math::cos(from_rad);
        let speed_m_s = (GRAVITY_M_S2 * radius_m * cos).sqrt();
        Self { angle_rad: zero_of(|angle| cos - math::cos(angle), 0.0, 1.5), time_s, speed_m_s }
    }

    /// Centre (x, z; m) at `t` (s), in flight since the lift-off.
    pub(super) fn then(&self, radius_m: f64, t: f64) -> (f64, f64) {
        let (sin, cos) = math::sin_cos(self.angle_rad);
        let (left, v) = (t - self.time_s, self.speed_m_s);
        let fall = 0.5 * GRAVITY_M_S2 * left * left;
        (radius_m * sin + v * cos * left, radius_m * cos - v * sin * left - fall)
    }
}

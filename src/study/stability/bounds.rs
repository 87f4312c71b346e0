//! What a scheme may be off by, from the numbers of a case.

use super::{SchemeSetting, sprung};
use crate::ground::{
    CAPTURE_DAMPING_RATIO, NormalImpact, damping_ratio, normal_impact, restitution,
};
use crate::solver::step_control::{IMPACT, IMPACT_OF_REFERENCE};
use crate::study::bench::Setup;
use std::f64::consts::TAU;

/// Rounding of some thousand operations (–): what the closed forms are kept to. Far below the 1e-10 of its energy that an
/// implicit step may gain before it is refused.
pub(super) const DIGITS: f64 = 1e-12;
/// The rigid limit holds a sphere on a plane to this (–, relative to R): ten times what a flight takes for touching, the
/// square root of 1e-12 R² being no distance to a plane that it comes to at a right angle.
pub(super) const HOLDS: f64 = 1e-10;
/// Implicit steps of an impact: of half a period at three tenths of a radian each, and of the reference at the fourth order.
const IMPACT_STEPS: [f64; 2] = [10.0, 40.0];
/// What the speed after an impact on several planes is off by, over the speed before (–): the phase of a fixed step, which is
/// first order, or as many of the errors that a step is allowed as there are steps. The rigid limit rounds.
pub(super) fn impact_error(way: &SchemeSetting, omega: f64) -> f64 {
    let [steps, fine_steps] = IMPACT_STEPS;
    let (by_tolerance, coarsest) = IMPACT;
    way.scheme.of([
        way.fineness * omega,
        steps * (by_tolerance * way.fineness).min(coarsest),
        fine_steps * IMPACT_OF_REFERENCE,
        DIGITS,
    ])
}

/// The same on one plane, where all but the fixed step have a closed form.
pub(super) fn plane_error(way: &SchemeSetting, omega: f64) -> f64 {
    if way.scheme.has_fixed_step() { impact_error(way, omega) } else { DIGITS }
}

/// How deep what rests on a level plane may be in it (m): twice as deep as its weight presses it, for the last swing.
pub(super) fn rests_within(way: &SchemeSetting, setup: &Setup) -> f64 {
    if sprung(way) { 2.0 * setup.pressed_m(0.0) } else { HOLDS * setup.rock.radius_m }
}

/// How deep an impact at `speed_m_s` may press it (m): `v/ω`, and twice the weight.
pub(super) fn strikes_within(way: &SchemeSetting, setup: &Setup, speed_m_s: f64) -> f64 {
    let pressed = if sprung(way) { speed_m_s / setup.omega() } else { 0.0 };
    pressed + rests_within(way, setup)
}

/// What spring and dashpot of a captured impact give back (–): they swing it out once, however slow.
pub(super) fn captured_restitution() -> f64 {
    restitution(CAPTURE_DAMPING_RATIO)
}

/// An impact on a level plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpringImpact {
    /// Approach (m/s).
    pub(super) speed: f64,
    /// Oscillation (rad/s).
    pub(super) omega: f64,
    /// Damping ratio (–).
    pub(super) zeta: f64,
    /// Gravity (m/s²).
    pub(super) gravity: f64,
}

impl SpringImpact {
    /// A blow by its restitution (–), 0 for none: no dashpot where there is all.
    pub(super) fn of(setup: &Setup, speed: f64, e: f64) -> Self {
        let zeta = damping_ratio(e);
        Self { speed, omega: setup.omega(), zeta, gravity: setup.gravity_m_s2 }
    }

    /// The same if it is captured.
    pub(super) fn captured(self) -> Self {
        Self { zeta: self.zeta.max(CAPTURE_DAMPING_RATIO), ..self }
    }

    fn exact(&self) -> NormalImpact {
        normal_impact(self.speed, self.omega, self.zeta, self.gravity)
    }

    /// Rebound (m/s, 0 for none) of the closed form.
    pub(super) fn closed_form(&self) -> f64 {
        self.exact().rebound_m_s.unwrap_or(0.0)
    }

    /// Whether its weight holds it down in the closed form.
    pub(super) fn never_leaves(&self) -> bool {
        self.exact().rebound_m_s.is_none()
    }

    /// When the closed form pushes no more (s); for what never leaves, a swing.
    pub(super) fn lasts_s(&self) -> f64 {
        self.exact().lift_s.min(TAU / self.omega)
    }

    /// Rebound (m/s, 0 for none) and time (s) of the fixed step, written for one plane: displacement `d` over a step `h` solves
    /// `2 (d − u h − g h²/2)/h² = −ω² (x + d) − 2ζω d/h` while that pushes. Followed for `lasts` at most, the last step cut, as is
    /// one that would go further than `way` (m).
    pub(super) fn stepped(&self, step: f64, way: f64, lasts: f64) -> (f64, f64) {
        let Self { speed, omega, zeta, gravity } = *self;
        let (mut depth, mut inwards, mut time) = (0.0f64, speed, 0.0);
        while time < lasts {
            // its weight may speed it up on the way
            let fastest = (inwards * inwards + 2.0 * gravity * way).sqrt();
            let h = step.min(lasts - time).min(2.0 * way / (inwards.abs() + fastest));
            let free = h * (inwards + 0.5 * gravity * h);
            let dashpot = 2.0 * zeta * omega / h;
            let pull = omega * omega * (depth + free) + dashpot * free;
            // nothing pulls: open for the step
            let added = -pull.max(0.0) / (2.0 / (h * h) + omega * omega + dashpot);
            depth += free + added;
            inwards += gravity * h + 2.0 * added / h;
            time += h;
            if depth < 0.0 {
                break;
            }
        }
        let square = inwards * inwards - 2.0 * gravity * depth;
        (if inwards < 0.0 { square.max(0.0).sqrt() } else { 0.0 }, time)
    }
}

//! The errors that schemes may have.

use super::{Case, CaseKind};
use crate::math;
use crate::solver::Settings;

/// Half of `√(p_N/m)` of the cases' sphere of half a metre on springs of 1 GN/m (rad/s).
const HALF_OMEGA_RAD_S: f64 = 420.0;

/// `√(p_N/m)` of two corners with a lever over that of the whole block (–).
const CORNERS_FASTER: f64 = 2.44;

impl Case {
    /// The error that a scheme may have (–) and why.
    pub fn allowed(&self, step: &Settings) -> (f64, &'static str) {
        let dda = (
            self.half_omega_rad_s() * self.growth() * step.step_s,
            "first order: half the contact oscillation per step",
        );
        let adaptive = if self.kind == CaseKind::Smooth {
            (
                0.5 * step.tolerance_m_s + 1e-9,
                "only the first steps, which must resolve the springs, are as coarse as the local error allows",
            )
        } else {
            (
                0.2 * self.growth() * math::pow(step.tolerance_m_s, 2.0 / 3.0),
                "second order under a third-order local error: tolerance to the power 2/3, times what the motion itself makes of an error",
            )
        };
        let reference = (
            self.growth() * (10.0 * step.tolerance_m_s + 3e-8),
            "fourth order, and the nine digits of the exact value",
        );
        let rigid = if matches!(self.kind, CaseKind::Impact | CaseKind::Stairs) {
            (3e-6, "an impact is followed to 2e-5 of its speed a step")
        } else {
            (
                0.2 * step.step_s,
                "first order where sliding turns into rolling or the rock lifts off",
            )
        };
        step.scheme.of([dda, adaptive, reference, rigid])
    }

    /// Half of `√(p_N/m)` of its rock (rad/s), at least that of the usual sphere. Two corners of the box that is thrown are two springs on
    /// 0.336 of its mass: `√(2/0.336)` times as fast.
    fn half_omega_rad_s(&self) -> f64 {
        let setup = (self.setup)(true);
        let faster = if setup.block.is_some() { CORNERS_FASTER } else { 1.0 };
        HALF_OMEGA_RAD_S.max(0.5 * faster * setup.omega())
    }

    /// How much the motion multiplies an error: every impact on an edge by about three.
    fn growth(&self) -> f64 {
        if self.kind == CaseKind::Stairs { 50.0 } else { 1.0 }
    }
}

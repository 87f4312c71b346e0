//! The contact law of a contact with a lever arm, and the compliance of a contact over a stage.

use super::Law;
use crate::rock::Rock;

/// Compliance of a contact over an implicit stage, and the velocity it requires at its point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StageCompliance {
    /// Along the normal and along the surface (1/kg): speed over impulse.
    pub(crate) compliance: [f64; 2],
    /// Required normal speed over the penetration (1/s) …
    pub(crate) normal_recovery_per_s: f64,
    /// … and required speed against the shear stretch, over the stretch (1/s).
    pub(crate) shear_recovery_per_s: f64,
}

impl Law {
    /// The same law for a contact with a lever arm, which moves other effective masses (kg) along
    /// its normal and along the surface than a ball of mass `mass_kg` does: damping ratios stay the
    /// same.
    #[must_use]
    pub(crate) fn for_masses(&self, [along, across]: [f64; 2], mass_kg: f64) -> Self {
        let scale = (along / mass_kg).sqrt();
        let mut law = *self;
        law.c_n *= scale;
        law.c_n_captured *= scale;
        law.shear.c *= (Rock::SLIP_LIGHTNESS * across / mass_kg).sqrt();
        law.omega /= scale;
        law
    }

    /// The law with the dashpots of an impact at another normal speed (m/s) than it began with,
    /// because soil has slowed the rock or it has met a facet. The contact moves the mass `across`
    /// along the surface (kg) of all `mass_kg`. Springs stay the same.
    pub(crate) fn for_impact_speed(&self, approach_m_s: f64, [across, mass_kg]: [f64; 2]) -> Self {
        let mut law = *self;
        if let Some(ratio) = law.ratio_at(approach_m_s) {
            law.set_damping_ratio(ratio);
            law.shear.c *= (Rock::SLIP_LIGHTNESS * across / mass_kg).sqrt();
        }
        law
    }

    /// Amplification factor (–) of an implicit stage of length `h` (s) for a fast motion along the
    /// normal, of the mass `m_n` that the contact moves: `1/(1 + h (p_N h + c_N)/m_n)`.
    pub(crate) fn stage_amplification(&self, captured: bool, h: f64) -> f64 {
        let normal = self.normal(captured);
        let per_mass = self.omega * self.omega / normal.p_n;
        1.0 / (1.0 + h * (normal.p_n * h + normal.c_n) * per_mass)
    }

    /// Compliance over a stage in which impulses act for `a` and points move for `b` (s): from `F =
    /// p pen − (p b + c) u` and `P = a F`.
    pub(crate) fn stage_compliance(&self, captured: bool, (a, b): (f64, f64)) -> StageCompliance {
        let normal = self.normal(captured);
        let stiffness = [normal.p_n * b + normal.c_n, self.shear.stage_stiffness(b)];
        StageCompliance {
            compliance: stiffness.map(|k| 1.0 / (a * k)),
            normal_recovery_per_s: normal.p_n / stiffness[0],
            shear_recovery_per_s: self.shear.k / stiffness[1],
        }
    }
}

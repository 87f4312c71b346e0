//! `[rocks]` and `[rocks.contact]`.

use super::check::{Allowed, Checked, Complaint, drawn, number, optional};
use super::shapes::ShapeTable;
use crate::frequency::{Frequency, radius_of_m3};
use crate::random::Distribution;
use serde::Deserialize;

/// The rocks.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [rocks]")]
pub struct Rocks {
    /// Density (kg/m³), positive.
    pub density_kg_m3: f64,
    /// Radius (m), positive; absent in the file where `[frequency]` has volumes, and then filled in for the estimates of the plan.
    pub radius_m: Option<Distribution>,
    /// Shapes, drawn by their weights; none = spheres.
    #[serde(default)]
    pub shapes: Vec<ShapeTable>,
    /// Contact between rocks; needed only when they share one world.
    pub contact: Option<RockContact>,
}

/// `[rocks.contact]`: contact between two rocks.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [rocks.contact]")]
pub struct RockContact {
    /// Normal contact spring (N/m), positive.
    pub normal_stiffness_n_m: f64,
    /// Shear contact spring (N/m), positive.
    pub shear_stiffness_n_m: f64,
    /// Friction angle (degrees), 0..90.
    pub friction_angle_deg: f64,
    /// Normal restitution, 0..1; may be absent only with scheme `dda`.
    pub restitution: Option<f64>,
    /// Tensile strength of a bond between rocks that touch at the start (Pa), 0 or more.
    pub tensile_strength_pa: f64,
    /// Cohesion of such a bond (Pa), 0 or more.
    pub cohesion_pa: f64,
}

impl Rocks {
    pub(super) fn check(&self) -> Checked {
        number("density_kg_m3", self.density_kg_m3, Allowed::Positive, "rock is near 2700")?;
        let density = Allowed::Between(1.0, 1e5);
        number("density_kg_m3", self.density_kg_m3, density, "rock is near 2700")?;
        if let Some(radius_m) = &self.radius_m {
            drawn("radius_m", radius_m, Allowed::Positive, "")?;
            drawn("radius_m", radius_m, Allowed::Between(1e-3, 1e3), "")?;
        }
        match &self.contact {
            Some(contact) => contact.check().map_err(|wrong| wrong.inside("contact")),
            None => Ok(()),
        }
    }
}

impl Rocks {
    /// Checks `radius_m` against the laws: volumes of their own, or none.
    pub(super) fn check_radius(&self, frequency: Option<&Frequency>) -> Checked {
        let drawn = frequency.is_some_and(Frequency::draws_volumes);
        match (&self.radius_m, drawn) {
            (Some(_), true) => Err(Complaint::about(
                "radius_m",
                "remove it: the volumes of [frequency] say how large rocks are; or write per_year = … there",
            )),
            (None, false) => {
                Err(Complaint::missing("radius_m", "write radius_m = …; it has no default"))
            }
            _ => Ok(()),
        }
    }

    /// Takes the sizes of sources that have volumes of their own, as a list for the plan to compute with.
    pub(super) fn take_sizes(&mut self, frequency: Option<&Frequency>) {
        if let Some(frequency) = frequency.filter(|one| one.draws_volumes()) {
            self.radius_m = radii_m(frequency);
        }
    }

    /// Radius (m); where sources have volumes of their own it serves the estimates of the plan only.
    ///
    /// # Panics
    /// Never for a scene that was read: the check asks for a radius, or the sources fill it in.
    pub fn radius_m(&self) -> &Distribution {
        self.radius_m.as_ref().expect("a checked scene has sizes")
    }
}

impl RockContact {
    /// Whether rocks that touch at the start hold on to each other.
    pub fn has_bonds(&self) -> bool {
        self.tensile_strength_pa > 0.0 || self.cohesion_pa > 0.0
    }

    fn check(&self) -> Checked {
        for (key, value, allowed) in [
            ("normal_stiffness_n_m", self.normal_stiffness_n_m, Allowed::Positive),
            ("shear_stiffness_n_m", self.shear_stiffness_n_m, Allowed::Positive),
            ("friction_angle_deg", self.friction_angle_deg, Allowed::Slope),
            ("tensile_strength_pa", self.tensile_strength_pa, Allowed::NotNegative),
            ("cohesion_pa", self.cohesion_pa, Allowed::NotNegative),
        ] {
            number(key, value, allowed, "")?;
        }
        optional("restitution", self.restitution, Allowed::Share, "")
    }
}

/// Radii for the estimates of the plan (m) where the sources have volumes of their own: ends and middle of every stratum, as often as
/// it comes.
fn radii_m(frequency: &Frequency) -> Option<Distribution> {
    let shares = [0.0, 0.5, 1.0];
    let radii = frequency.strata().iter().flat_map(|stratum| {
        let volumes = shares.map(|p| Some((stratum.quantile_m3(p)?, stratum.per_year)));
        volumes.into_iter().flatten()
    });
    let (radii, weights): (Vec<f64>, Vec<f64>) =
        radii.map(|(volume, weight)| (radius_of_m3(volume), weight)).unzip();
    Distribution::values(radii, Some(weights)).ok()
}

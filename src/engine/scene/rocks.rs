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

/// Parts of a stratum whose ends stand for its sizes in the plan: they tell the median rock to a few per mille.
const PARTS: u32 = 20;

/// Radii for the estimates of the plan (m) where the sources have volumes of their own: evenly spread over the rocks of every stratum,
/// its smallest and largest among them, as often as it comes.
fn radii_m(frequency: &Frequency) -> Option<Distribution> {
    let radii = frequency.strata().iter().flat_map(|stratum| {
        let shares = (0..=PARTS).map(|part| f64::from(part) / f64::from(PARTS));
        shares.filter_map(|p| Some((stratum.quantile_m3(p)?, stratum.per_year)))
    });
    let (radii, weights): (Vec<f64>, Vec<f64>) =
        radii.map(|(volume, weight)| (radius_of_m3(volume), weight)).unzip();
    Distribution::values(radii, Some(weights)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frequency::{Class, FrequencyLaw, RockSource};

    /// Half of the events a year are of rocks above V: 0.01 (V^−0.7 − 5^−0.7) + 0.004 + 0.03 (1 − ln(V/0.05)/ln 10) = 0.0927 at V = 0.06767 m³,
    /// R = 0.2528 m. Ends and middle of the strata alone said 0.235 m.
    #[test]
    fn the_median_of_the_plan_is_that_of_the_sources() {
        let source = |law| RockSource { name: String::new(), law };
        let law =
            FrequencyLaw::PowerLaw { per_year_at_1m3: 0.01, exponent: 0.7, volume_m3: [0.02, 5.0] };
        let class = |volume_m3, per_year| Class { volume_m3, per_year };
        let classes = vec![class([2.0, 2.0], 0.004), class([0.05, 0.5], 0.03)];
        let sources = vec![source(law), source(FrequencyLaw::Classes(classes))];
        let radii = radii_m(&Frequency::new(sources, vec![], vec![])).expect("volumes");
        assert!((radii.quantile(0.5) / 0.2528 - 1.0).abs() < 0.01, "{}", radii.quantile(0.5));
        let (least, largest) = radii.support();
        assert!((least - radius_of_m3(0.02)).abs() < 1e-12);
        assert!((largest - radius_of_m3(5.0)).abs() < 1e-12);
    }
}

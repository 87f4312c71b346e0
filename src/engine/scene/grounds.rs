//! `[grounds.NAME]`.

use super::catalogue::{CATALOGUE, KnownValue, known_ground};
use super::check::{Allowed, Checked, Complaint, drawn, number, suggest};
use crate::ground::{Scar, SlipFriction};
use crate::random::Distribution;
use crate::solver::Scheme;
use serde::{Deserialize, Deserializer};

/// How one ground answers a rock; every value but those of soil may be a distribution, drawn once per release.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [grounds.NAME]")]
pub struct GroundTable {
    /// A ground of the catalogue that gives restitution, rolling friction, roughness and soil where they are absent here.
    pub like: Option<String>,
    /// Normal contact spring `p_N` (N/m), positive.
    pub normal_stiffness_n_m: Distribution,
    /// Shear contact spring `p_s` (N/m), positive; this or `tangential_ratio`.
    pub shear_stiffness_n_m: Option<Distribution>,
    /// Shear over normal contact spring `p_s/p_N` (–): how much of its slip an impact that sticks gives back.
    pub tangential_ratio: Option<Distribution>,
    /// Friction angle (degrees), 0..90.
    pub friction_angle_deg: Distribution,
    /// Normal restitution (–), 0..1; may be absent with scheme `dda` only.
    pub restitution: Option<Distribution>,
    /// Limit of the rolling torque over `N R` (–), 0 or more; absent = none.
    pub rolling_friction: Option<Distribution>,
    /// Largest random tilt of the contact normal at an impact (degrees), 0..90; absent = none.
    pub roughness_deg: Option<Distribution>,
    /// Way over which one tilted facet of a rough ground reaches (m), positive; absent = the radius of the rock.
    pub roughness_length_m: Option<Distribution>,
    /// Friction that grows with the way slipped, from that of the friction angle; absent = Coulomb's.
    #[serde(default, deserialize_with = "slip_friction")]
    pub slip_friction: Option<SlipFriction>,
    /// Soil that a rock digs into and that drags; absent = the surface is hard.
    #[serde(default, deserialize_with = "scar")]
    pub scar: Option<Scar>,
    /// Normal speed of impact at which half of the restitution is left (m/s), positive; absent = it stays the same.
    pub restitution_half_speed_m_s: Option<Distribution>,
    /// Trees only: energy that a stem takes before it gives way to a rock (J), positive; absent = it stands for good.
    pub breaks_above_j: Option<Distribution>,
}

impl GroundTable {
    pub(super) fn take_from_catalogue(&mut self) -> Checked {
        let Some(name) = &self.like else { return Ok(()) };
        let Some(known) = known_ground(name) else {
            let names = CATALOGUE.map(|ground| ground.name);
            return Err(Complaint::about("like", suggest(name, &names)));
        };
        let fill = |own: &mut Option<Distribution>, known: Option<KnownValue>| {
            *own = own.take().or_else(|| known.and_then(KnownValue::distribution));
        };
        fill(&mut self.restitution, Some(known.restitution));
        fill(&mut self.rolling_friction, known.rolling_friction);
        fill(&mut self.roughness_deg, known.roughness_deg);
        self.scar = self.scar.take().or(known.scar);
        Ok(())
    }

    pub(super) fn check(&self, scheme: Scheme) -> Checked {
        stiffness("normal_stiffness_n_m", &self.normal_stiffness_n_m)?;
        self.check_shear()?;
        let angle = &self.friction_angle_deg;
        drawn("friction_angle_deg", angle, Allowed::Slope, "scree is near 35")?;
        if self.restitution.is_none() && !scheme.has_fixed_step() {
            let remedy = "write restitution = 0..1; only scheme \"dda\" can do without";
            return Err(Complaint::missing("restitution", remedy));
        }
        let may_be_absent = [
            ("shear_stiffness_n_m", &self.shear_stiffness_n_m, Allowed::Positive),
            ("tangential_ratio", &self.tangential_ratio, TANGENTIAL),
            ("restitution", &self.restitution, Allowed::Share),
            ("rolling_friction", &self.rolling_friction, Allowed::NotNegative),
            ("roughness_deg", &self.roughness_deg, Allowed::Slope),
            ("roughness_length_m", &self.roughness_length_m, Allowed::Positive),
            ("restitution_half_speed_m_s", &self.restitution_half_speed_m_s, Allowed::Positive),
            ("breaks_above_j", &self.breaks_above_j, Allowed::Positive),
        ];
        self.check_soil()?;
        for (key, value, allowed) in may_be_absent {
            if let Some(value) = value {
                drawn(key, value, allowed, "")?;
            }
        }
        Ok(())
    }

    fn check_soil(&self) -> Checked {
        if let Some(soil) = &self.slip_friction {
            number("max", soil.most, Allowed::Positive, "")
                .and_then(|()| number("kappa_per_m", soil.kappa_per_m, Allowed::Positive, ""))
                .and_then(|()| number("beta_per_s", soil.beta_per_s, Allowed::NotNegative, ""))
                .map_err(|complaint| complaint.inside("slip_friction"))?;
        }
        if let Some(soil) = &self.scar {
            let density = ("soil_density_kg_m3", soil.soil_density_kg_m3);
            number("strength_kn_m2", soil.strength_kn_m2, STRENGTH, STRENGTHS)
                .and_then(|()| {
                    number("drag", soil.drag, Allowed::Between(0.0, 1e3), "2.5 is usual")
                })
                .and_then(|()| number(density.0, density.1, Allowed::Between(0.0, 5000.0), ""))
                .map_err(|complaint| complaint.inside("scar"))?;
        }
        if self.restitution_half_speed_m_s.is_some() && self.restitution.is_none() {
            let remedy =
                "write restitution = 0..1 of slow impacts, or remove restitution_half_speed_m_s";
            return Err(Complaint::missing("restitution", remedy));
        }
        Ok(())
    }

    fn check_shear(&self) -> Checked {
        match (&self.shear_stiffness_n_m, &self.tangential_ratio) {
            (Some(_), Some(_)) => {
                let remedy = "write it or shear_stiffness_n_m: each gives the other";
                Err(Complaint::about("tangential_ratio", remedy).finding("found both"))
            }
            (None, None) => {
                let remedy = "write it, or tangential_ratio: shear over normal spring; neither has a default";
                Err(Complaint::missing("shear_stiffness_n_m", remedy))
            }
            _ => Ok(()),
        }
    }

    /// Shear contact spring `p_s` (N/m) beside a normal one (N/m), from what `take` makes of the value that is written.
    pub fn shear_n_m(&self, normal_n_m: f64, take: impl FnOnce(&Distribution) -> f64) -> f64 {
        match (&self.tangential_ratio, &self.shear_stiffness_n_m) {
            (Some(ratio), _) => normal_n_m * take(ratio),
            // a scene that was read has one of the two
            (None, own) => own.as_ref().map_or(f64::NAN, take),
        }
    }
}

/// Shear over normal spring (–): below, an impact takes next to nothing of its slip; two elastic bodies have less than 1
/// (Mindlin 1949: 0.67 to 1).
pub(super) const TANGENTIAL: Allowed = Allowed::Between(1e-3, 10.0);

/// Strength of soil under a scar (kN/m²): softer is mud that no depth of a scar holds for.
pub(super) const STRENGTH: Allowed = Allowed::Between(100.0, 1e9);
const STRENGTHS: &str = "in kN/m²; Lu et al. (2019) have 10000 to 25000 on a meadow";

fn stiffness(key: &str, value: &Distribution) -> Checked {
    drawn(key, value, Allowed::Positive, "rock is near 1e9")
}

/// `slip_friction = { max = …, kappa_per_m = …, beta_per_s = … }`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { max, kappa_per_m, beta_per_s }")]
struct SlipTable {
    max: OneNumber,
    kappa_per_m: OneNumber,
    beta_per_s: OneNumber,
}

/// A value of soil: the energy of a scar and the way slipped are reckoned with one for all rocks.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "a number: values of slip_friction and scar are the same for every rock, no distributions"
)]
enum OneNumber {
    Number(f64),
}

impl OneNumber {
    fn value(&self) -> f64 {
        let Self::Number(value) = self;
        *value
    }
}

fn slip_friction<'de, D: Deserializer<'de>>(from: D) -> Result<Option<SlipFriction>, D::Error> {
    SlipTable::deserialize(from).map(|SlipTable { max, kappa_per_m, beta_per_s }| {
        Some(SlipFriction {
            most: max.value(),
            kappa_per_m: kappa_per_m.value(),
            beta_per_s: beta_per_s.value(),
        })
    })
}

/// `scar = { strength_kn_m2 = …, drag = …, soil_density_kg_m3 = … }`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { strength_kn_m2, drag, soil_density_kg_m3 }")]
struct ScarTable {
    strength_kn_m2: OneNumber,
    drag: OneNumber,
    soil_density_kg_m3: OneNumber,
}

fn scar<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Scar>, D::Error> {
    ScarTable::deserialize(from).map(|ScarTable { strength_kn_m2, drag, soil_density_kg_m3 }| {
        Some(Scar {
            strength_kn_m2: strength_kn_m2.value(),
            drag: drag.value(),
            soil_density_kg_m3: soil_density_kg_m3.value(),
        })
    })
}

//! `[grounds.NAME]`.

use super::catalogue::{CATALOGUE, known_ground};
use super::check::{Allowed, Checked, Complaint, drawn, suggest};
use crate::random::Distribution;
use crate::solver::Scheme;
use serde::Deserialize;

/// How one ground answers a rock; every value may be a distribution, drawn once per release.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [grounds.NAME]")]
pub struct GroundTable {
    /// A ground of the catalogue that gives restitution and rolling friction where they are absent here.
    pub like: Option<String>,
    /// Normal contact spring `p_N` (N/m), positive.
    pub normal_stiffness_n_m: Distribution,
    /// Shear contact spring `p_s` (N/m), positive.
    pub shear_stiffness_n_m: Distribution,
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
        let drawn = |range: [f64; 2]| Distribution::uniform(range).ok();
        self.restitution = self.restitution.take().or_else(|| drawn(known.restitution));
        self.rolling_friction =
            self.rolling_friction.take().or_else(|| known.rolling_friction.and_then(drawn));
        Ok(())
    }

    pub(super) fn check(&self, scheme: Scheme) -> Checked {
        stiffness("normal_stiffness_n_m", &self.normal_stiffness_n_m)?;
        stiffness("shear_stiffness_n_m", &self.shear_stiffness_n_m)?;
        let angle = &self.friction_angle_deg;
        drawn("friction_angle_deg", angle, Allowed::Slope, "scree is near 35")?;
        if self.restitution.is_none() && scheme != Scheme::Dda {
            let remedy = "write restitution = 0..1; only scheme \"dda\" can do without";
            return Err(Complaint::missing("restitution", remedy));
        }
        let may_be_absent = [
            ("restitution", &self.restitution, Allowed::Share),
            ("rolling_friction", &self.rolling_friction, Allowed::NotNegative),
            ("roughness_deg", &self.roughness_deg, Allowed::Slope),
            ("roughness_length_m", &self.roughness_length_m, Allowed::Positive),
            ("breaks_above_j", &self.breaks_above_j, Allowed::Positive),
        ];
        for (key, value, allowed) in may_be_absent {
            if let Some(value) = value {
                drawn(key, value, allowed, "")?;
            }
        }
        Ok(())
    }
}

fn stiffness(key: &str, value: &Distribution) -> Checked {
    drawn(key, value, Allowed::Positive, "rock is near 1e9")
}

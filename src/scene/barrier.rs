//! `[[barriers]]`.

use super::check::{Allowed, Checked, Complaint, number};
use super::places::Polyline;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A barrier over a line of the map: judged on the rocks that cross it, it changes no rock's way.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with name, points_m, height_m and capacity_j")]
pub struct BarrierTable {
    /// Name in the results; the crossings of its line carry it too.
    pub name: String,
    /// Its corners in map coordinates (m).
    pub points_m: Polyline,
    /// Height above the ground (m), positive.
    pub height_m: f64,
    /// Energy that it takes (J), positive.
    pub capacity_j: f64,
    /// How a design is derived.
    pub design: Option<DesignTable>,
}

/// A design rule: a percentile and factors by name. None of them has a default.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with percentile and free_height_m")]
pub struct DesignTable {
    /// Percentile of energy and height (per cent), above 0 and below 100.
    pub percentile: f64,
    /// Factors on the speed (–), squared in the energy.
    #[serde(default)]
    pub speed_factors: BTreeMap<String, f64>,
    /// Factors on the mass (–).
    #[serde(default)]
    pub mass_factors: BTreeMap<String, f64>,
    /// Factors on the height (–).
    #[serde(default)]
    pub height_factors: BTreeMap<String, f64>,
    /// Free height above the design height (m), 0 or more.
    pub free_height_m: f64,
}

impl BarrierTable {
    pub(super) fn check(&self) -> Checked {
        number("height_m", self.height_m, Allowed::Positive, "")?;
        number("capacity_j", self.capacity_j, Allowed::Positive, "1e6 is a net of 1000 kJ")?;
        self.design.as_ref().map_or(Ok(()), |d| d.check().map_err(|wrong| wrong.inside("design")))
    }
}

impl DesignTable {
    fn check(&self) -> Checked {
        number("free_height_m", self.free_height_m, Allowed::NotNegative, "")?;
        if !(self.percentile > 0.0 && self.percentile < 100.0) {
            return Err(Complaint::about("percentile", "write a number above 0 and below 100"));
        }
        let lists = [
            ("speed_factors", &self.speed_factors),
            ("mass_factors", &self.mass_factors),
            ("height_factors", &self.height_factors),
        ];
        for (list, factors) in lists {
            for (name, factor) in factors {
                number(name, *factor, Allowed::Positive, "").map_err(|wrong| wrong.inside(list))?;
            }
        }
        Ok(())
    }
}

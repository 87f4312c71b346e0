//! `[[barriers]]`.

use super::check::{Allowed, Checked, Complaint, number, optional};
use super::places::Polyline;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A barrier over a line of the map: judged on the rocks that cross it, it changes no rock's way.
#[derive(Debug, Clone, PartialEq)]
pub struct BarrierTable {
    /// Name in the results; the crossings of its line carry it too.
    pub name: String,
    /// Its corners in map coordinates (m).
    pub points_m: Polyline,
    /// Height above the ground (m), positive.
    pub height_m: f64,
    /// Energy that it takes (J), positive.
    pub capacity_j: f64,
    /// Other places to try it at: distances from its own (m), positive on the left of its line.
    pub offsets_m: Vec<f64>,
    /// How a design is derived.
    pub design: Option<DesignTable>,
}

/// A standard whose rule a design may follow, as far as it was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum Standard {
    /// UNI 11211-4 (Italy).
    #[serde(rename = "uni-11211-4")]
    Uni11211,
    /// ONR 24810 (Austria).
    #[serde(rename = "onr-24810")]
    Onr24810,
}

/// How well the topography is known (UNI 11211-4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Topography {
    /// Partial factor 1.02.
    Good,
    /// Partial factor 1.10.
    Poor,
}

/// Where the values of the simulation come from (UNI 11211-4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Simulation {
    /// Partial factor 1.02.
    BackAnalysed,
    /// Partial factor 1.10.
    Literature,
}

/// A design rule: a percentile and factors by name, of a standard or the scene's own.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with rule or percentile, and free_height_m")]
pub struct DesignTable {
    /// The standard it follows; absent = the scene's own rule.
    pub rule: Option<Standard>,
    /// Percentile of energy and height (per cent), above 0 and below 100; UNI 11211-4 takes 95 if it is absent, and none below.
    pub percentile: Option<f64>,
    /// UNI 11211-4 only, which must have it.
    pub topography: Option<Topography>,
    /// UNI 11211-4 only, which must have it.
    pub simulation: Option<Simulation>,
    /// Factors on the speed (–), squared in the energy.
    #[serde(default)]
    pub speed_factors: BTreeMap<String, f64>,
    /// Factors on the mass (–).
    #[serde(default)]
    pub mass_factors: BTreeMap<String, f64>,
    /// Factors on the height (–).
    #[serde(default)]
    pub height_factors: BTreeMap<String, f64>,
    /// Free height above the design height (m), 0 or more; UNI 11211-4 asks for 0.5 or more.
    pub free_height_m: f64,
    /// Elongation of the barrier at its design energy (m): the standard says what must be free behind it.
    pub elongation_m: Option<f64>,
    /// Volume of the design block (m³), positive: the design energy is that of its mass and the percentile of speed.
    pub block_volume_m3: Option<f64>,
    /// How many times the design energy the capacity must be (–), 1 or more.
    pub capacity_factor: Option<f64>,
}

/// Percentile of UNI 11211-4 unless the scene writes another (per cent).
const UNI_PERCENTILE: f64 = 95.0;
/// Least free height of UNI 11211-4 (m).
const UNI_FREE_HEIGHT_M: f64 = 0.5;
/// Largest factor on a capacity that makes sense (–).
const MOST_FACTOR: f64 = 10.0;
/// Percentiles of ONR 24810 (per cent).
const ONR_PERCENTILES: [f64; 2] = [95.0, 99.0];

impl BarrierTable {
    pub(super) fn check(&self) -> Checked {
        number("height_m", self.height_m, Allowed::Positive, "")?;
        number("capacity_j", self.capacity_j, Allowed::Positive, "1e6 is a net of 1000 kJ")?;
        for (k, offset) in self.offsets_m.iter().enumerate() {
            if self.beside(*offset).is_none() || self.offsets_m[..k].contains(offset) {
                let remedy = "write distances in metres that differ from 0 and each other, small against the line";
                return Err(Complaint::about("offsets_m", remedy));
            }
        }
        self.design.as_ref().map_or(Ok(()), |d| d.check().map_err(|wrong| wrong.inside("design")))
    }

    /// Names and lines of its other places.
    pub fn elsewhere(&self) -> impl Iterator<Item = (f64, String, Polyline)> {
        self.offsets_m.iter().filter_map(|&offset_m| {
            Some((offset_m, format!("{} {offset_m:+} m", self.name), self.beside(offset_m)?))
        })
    }

    fn beside(&self, offset_m: f64) -> Option<Polyline> {
        if offset_m == 0.0 { None } else { self.points_m.beside(offset_m) }
    }
}

impl DesignTable {
    fn check(&self) -> Checked {
        number("free_height_m", self.free_height_m, Allowed::NotNegative, "")?;
        optional("elongation_m", self.elongation_m, Allowed::Positive, "")?;
        optional("block_volume_m3", self.block_volume_m3, Allowed::Positive, "")?;
        if self.capacity_factor.is_some_and(|factor| !(1.0..=MOST_FACTOR).contains(&factor)) {
            let remedy =
                "write a factor of 1 to 10, by which the capacity must exceed the design energy";
            return Err(Complaint::about("capacity_factor", remedy));
        }
        if self.percentile.is_some_and(|percent| !(percent > 0.0 && percent < 100.0)) {
            return Err(Complaint::about("percentile", "write a number above 0 and below 100"));
        }
        let lists = [
            ("speed_factors", &self.speed_factors),
            ("mass_factors", &self.mass_factors),
            ("height_factors", &self.height_factors),
        ];
        for (list, factors) in lists {
            for (name, factor) in factors {
                self.check_factor(name, *factor).map_err(|wrong| wrong.inside(list))?;
            }
        }
        match self.rule {
            None => self.check_own(),
            Some(Standard::Uni11211) => self.check_uni(),
            Some(Standard::Onr24810) => self.check_onr(),
        }
    }

    /// Partial factors of a standard are on the safe side.
    fn check_factor(&self, name: &str, factor: f64) -> Checked {
        number(name, factor, Allowed::Positive, "")?;
        if self.rule.is_some() && factor < 1.0 {
            let remedy = "write 1.0 or more, as factors of a standard are, or leave rule out";
            return Err(Complaint::about(name, remedy));
        }
        Ok(())
    }

    fn check_own(&self) -> Checked {
        if self.percentile.is_none() {
            let remedy = "write a percentile, or rule = \"uni-11211-4\" or \"onr-24810\"";
            return Err(Complaint::missing("percentile", remedy));
        }
        self.check_no_uni()?;
        if self.elongation_m.is_some() {
            let remedy = "remove it, or write a rule that says what distance it asks for";
            return Err(Complaint::about("elongation_m", remedy));
        }
        Ok(())
    }

    fn check_no_uni(&self) -> Checked {
        let given =
            [("topography", self.topography.is_some()), ("simulation", self.simulation.is_some())];
        match given.iter().find(|(_, given)| *given) {
            Some((key, _)) => Err(Complaint::about(
                key,
                "remove it: only rule = \"uni-11211-4\" has factors for it; write your own under speed_factors and height_factors",
            )),
            None => Ok(()),
        }
    }

    fn check_uni(&self) -> Checked {
        if self.topography.is_none() {
            return Err(Complaint::missing(
                "topography",
                "write \"good\" (1.02) or \"poor\" (1.10)",
            ));
        }
        if self.simulation.is_none() {
            let remedy = "write \"back-analysed\" (1.02) or \"literature\" (1.10)";
            return Err(Complaint::missing("simulation", remedy));
        }
        if self.mass_factors.is_empty() {
            let remedy = "write mass_factors = { block_volume = … }: the standard has a factor for the block volume, its value is yours";
            return Err(Complaint::missing("mass_factors", remedy));
        }
        for (list, factors) in
            [("speed_factors", &self.speed_factors), ("height_factors", &self.height_factors)]
        {
            if let Some(name) =
                ["topography", "simulation"].into_iter().find(|name| factors.contains_key(*name))
            {
                let remedy = format!("remove it: the rule sets it from {name} = …");
                return Err(Complaint::about(name, remedy).inside(list));
            }
        }
        if self.percentile() < UNI_PERCENTILE {
            let remedy =
                "write 95.0 or more, or nothing for 95, as the standard has it, or leave rule out";
            return Err(Complaint::about("percentile", remedy));
        }
        if self.free_height_m < UNI_FREE_HEIGHT_M {
            let remedy = "write 0.5 or more, as the standard asks for, or leave rule out";
            return Err(Complaint::about("free_height_m", remedy));
        }
        Ok(())
    }

    fn check_onr(&self) -> Checked {
        if !self.percentile.is_some_and(|percent| ONR_PERCENTILES.contains(&percent)) {
            let remedy = "write 95.0 or 99.0, as the standard has it";
            let complaint = Complaint::about("percentile", remedy);
            return Err(if self.percentile.is_none() {
                complaint.finding("found nothing")
            } else {
                complaint
            });
        }
        if self.block_volume_m3.is_some() {
            let remedy = "remove it, or write rule = \"uni-11211-4\" or none: the energy of this rule is a percentile of energy";
            return Err(Complaint::about("block_volume_m3", remedy));
        }
        self.check_no_uni()
    }

    /// The standard in words.
    pub fn standard(&self) -> Option<&'static str> {
        self.rule.map(|rule| match rule {
            Standard::Uni11211 => "UNI 11211-4",
            Standard::Onr24810 => "ONR 24810",
        })
    }

    /// The percentile in force (per cent).
    pub fn percentile(&self) -> f64 {
        self.percentile.unwrap_or(UNI_PERCENTILE)
    }

    /// Factors on the speed: the scene's own and those of the standard.
    pub fn speed_factors(&self) -> BTreeMap<String, f64> {
        self.with_standard(&self.speed_factors)
    }

    /// Factors on the height: the scene's own and those of the standard.
    pub fn height_factors(&self) -> BTreeMap<String, f64> {
        self.with_standard(&self.height_factors)
    }

    /// Distance to be kept free behind the barrier (m), where elongation and standard are named.
    pub fn free_distance_m(&self) -> Option<f64> {
        let elongation_m = self.elongation_m?;
        self.rule.map(|rule| match rule {
            Standard::Uni11211 => elongation_m,
            Standard::Onr24810 => (1.2 * elongation_m).max(elongation_m + 1.0),
        })
    }

    fn with_standard(&self, own: &BTreeMap<String, f64>) -> BTreeMap<String, f64> {
        let topography = self.topography.map(|known| match known {
            Topography::Good => 1.02,
            Topography::Poor => 1.10,
        });
        let simulation = self.simulation.map(|from| match from {
            Simulation::BackAnalysed => 1.02,
            Simulation::Literature => 1.10,
        });
        let standard = [("topography", topography), ("simulation", simulation)];
        let standard =
            standard.into_iter().filter_map(|(name, factor)| Some((name.to_owned(), factor?)));
        own.iter().map(|(name, factor)| (name.clone(), *factor)).chain(standard).collect()
    }
}

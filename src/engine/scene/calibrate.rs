//! `[calibrate]`: measured ends, and which ground values may be fitted to them.

use super::check::{Allowed, Checked, Complaint, number, optional, suggest};
use super::grounds::{STRENGTH, TANGENTIAL};
use super::shapes::CORNER_RADIUS;
use super::{GroundTable, Scene};
use crate::random::Distribution;
use serde::Deserialize;
use std::fmt;
use std::path::PathBuf;

/// Most parts that are held out in turn: each is a search of its own.
const MOST_PARTS: usize = 20;

/// What a scene is compared with and what may be fitted.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [calibrate]")]
pub struct CalibrateTable {
    /// CSV file of measured ends with `release_x_m`, `release_y_m`, `x_m`, `y_m` in map coordinates.
    pub deposits: PathBuf,
    /// Computed rocks whose runout is less (m) are left out of the comparison, ≥ 0; absent = 0, none is. A list of throws
    /// holds none that stayed where it was set down: such a block is thrown again.
    pub least_runout_m: Option<f64>,
    /// Share of the measured ends that is held out of each fit to score it on (–), 0..0.5; absent = 0.5.
    pub held_out: Option<f64>,
    /// What a fit brings near: absent = [`CalibrationScore::Runout`].
    pub score: Option<CalibrationScore>,
    /// The values that `rockfall calibrate` searches; may be none.
    #[serde(default)]
    pub vary: Vec<VaryTable>,
    /// What `rockfall calibrate` has fitted, as it notes it in the fitted scene; empty elsewhere.
    #[serde(default)]
    pub fitted: Vec<FittedValue>,
}

/// Measured ends that computed ones are compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredEnds {
    /// CSV file of [`CalibrateTable::deposits`].
    pub file: PathBuf,
    /// [`CalibrateTable::least_runout_m`].
    pub least_runout_m: Option<f64>,
}

impl fmt::Display for MeasuredEnds {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "measured ends in {}", self.file.display())?;
        if let Some(least_m) = self.least_runout_m {
            write!(to, ", without computed rocks whose runout is less than {least_m} m")?;
        }
        Ok(())
    }
}

/// One fitted value.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { ground, key, value }")]
pub struct FittedValue {
    /// Name under `[grounds]`; none for a value of the shapes.
    pub ground: Option<String>,
    /// Which of its values.
    pub key: VaryKey,
    /// What the fit has made of it.
    pub value: Distribution,
}

/// What the computed ends are brought near to the measured ones in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrationScore {
    /// The distribution of runout over all ends, by the distance of Kolmogorov and Smirnov.
    #[default]
    Runout,
    /// The ends in plan view, block by block, by their energy distance: runout, its spread, side scatter and the differences
    /// between blocks at once.
    Ends,
}

/// One value of a ground, or of the shapes, and the range it is searched in.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { ground, key, from, to, before }")]
pub struct VaryTable {
    /// Name under `[grounds]`; none for a value of the shapes.
    pub ground: Option<String>,
    /// Which of its values.
    pub key: VaryKey,
    /// Smallest value tried.
    pub from: f64,
    /// Largest value tried.
    pub to: f64,
    /// The value that would stand there without calibration, from literature; reported beside the fitted one.
    pub before: f64,
}

/// A value that may be fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VaryKey {
    /// Friction angle (degrees).
    FrictionAngleDeg,
    /// Normal restitution (–).
    Restitution,
    /// Normal speed of impact at which half of it is left (m/s).
    RestitutionHalfSpeedMS,
    /// Shear over normal contact spring (–).
    TangentialRatio,
    /// Rolling friction (–); with a spread, its smallest and most frequent value.
    RollingFriction,
    /// How far rolling friction reaches above that (–), drawn once per rock from a triangle that falls to there: what the
    /// shapes of blocks, which spheres have not, do to their rolling.
    RollingFrictionSpread,
    /// Roughness (degrees).
    RoughnessDeg,
    /// Way over which one tilted facet reaches (m).
    RoughnessLengthM,
    /// Friction after a long slip (–).
    #[serde(rename = "slip_friction.max")]
    SlipFrictionMax,
    /// How soon friction grows with slip (1/m).
    #[serde(rename = "slip_friction.kappa_per_m")]
    SlipFrictionKappaPerM,
    /// How soon slip is forgotten in flight (1/s).
    #[serde(rename = "slip_friction.beta_per_s")]
    SlipFrictionBetaPerS,
    /// Strength of the soil (kN/m²).
    #[serde(rename = "scar.strength_kn_m2")]
    ScarStrengthKnM2,
    /// Drag coefficient of the soil (–).
    #[serde(rename = "scar.drag")]
    ScarDrag,
    /// Radius of the corners of all shapes over that of the sphere of equal volume (–).
    CornerRadius,
}

impl VaryKey {
    /// Its key in the scene; that of a table inside of the ground with a point between.
    pub fn name(self) -> &'static str {
        match self {
            Self::FrictionAngleDeg => "friction_angle_deg",
            Self::Restitution => "restitution",
            Self::RestitutionHalfSpeedMS => "restitution_half_speed_m_s",
            Self::TangentialRatio => "tangential_ratio",
            Self::RollingFriction => "rolling_friction",
            Self::RollingFrictionSpread => "rolling_friction_spread",
            Self::RoughnessDeg => "roughness_deg",
            Self::RoughnessLengthM => "roughness_length_m",
            Self::SlipFrictionMax => "slip_friction.max",
            Self::SlipFrictionKappaPerM => "slip_friction.kappa_per_m",
            Self::SlipFrictionBetaPerS => "slip_friction.beta_per_s",
            Self::ScarStrengthKnM2 => "scar.strength_kn_m2",
            Self::ScarDrag => "scar.drag",
            Self::CornerRadius => "corner_radius",
        }
    }

    /// Whether it is a value of `[[rocks.shapes]]`, not of a ground.
    fn is_of_shapes(self) -> bool {
        self == Self::CornerRadius
    }

    fn allowed(self) -> Allowed {
        match self {
            Self::FrictionAngleDeg | Self::RoughnessDeg => Allowed::Slope,
            Self::Restitution => Allowed::Share,
            Self::RestitutionHalfSpeedMS
            | Self::RoughnessLengthM
            | Self::SlipFrictionMax
            | Self::SlipFrictionKappaPerM => Allowed::Positive,
            Self::TangentialRatio => TANGENTIAL,
            Self::ScarStrengthKnM2 => STRENGTH,
            Self::CornerRadius => CORNER_RADIUS,
            Self::RollingFriction
            | Self::RollingFrictionSpread
            | Self::SlipFrictionBetaPerS
            | Self::ScarDrag => Allowed::NotNegative,
        }
    }
}

impl Scene {
    /// What to write where a value cannot be varied on the rocks and grounds of this scene; none where it can.
    pub fn refuses_to_vary(&self, vary: &VaryTable) -> Option<String> {
        let Some(name) = &vary.ground else {
            let remedy = "write [[rocks.shapes]] of blocks: spheres have no corners";
            return (!self.has_blocks()).then(|| remedy.to_owned());
        };
        let Some(ground) = self.grounds.get(name) else {
            let names: Vec<&str> = self.grounds.keys().map(String::as_str).collect();
            return Some(format!("write a name from [grounds]; {}", suggest(name, &names)));
        };
        let (table, _) = vary.key.name().split_once('.')?;
        let is_there =
            if table == "scar" { ground.scar.is_some() } else { ground.slip_friction.is_some() };
        (!is_there).then(|| {
            format!("write {table} = {{ ... }} in [grounds.{name}]: one of its values is varied, and the others have no default")
        })
    }

    /// Whether the values that were fitted to measured ends are those in force: a note in the file does not make a value
    /// fitted that was changed after it.
    pub fn is_fitted(&self) -> bool {
        let fitted = self.calibrate.as_ref().map_or(&[][..], |table| &table.fitted);
        let is_in_force = |one: &FittedValue| {
            let found = match &one.ground {
                Some(name) => self.grounds.get(name).and_then(|ground| ground.value_of(one.key)),
                None => self.corner_radius(),
            };
            found.as_ref() == Some(&one.value)
        };
        !fitted.is_empty() && fitted.iter().all(is_in_force)
    }

    /// Radius of the corners of the first shape that has some; a fit gives the same one to all.
    pub fn corner_radius(&self) -> Option<Distribution> {
        let radius = self.rocks.shapes.iter().find_map(|shape| shape.corner_radius)?;
        Distribution::fixed(radius).ok()
    }

    /// The table, and whether its values can be varied here.
    pub(super) fn check_calibrate(&self) -> Checked {
        let Some(table) = &self.calibrate else { return Ok(()) };
        table.check()?;
        for (index, vary) in table.vary.iter().enumerate() {
            let Some(remedy) = self.refuses_to_vary(vary) else { continue };
            let is_known = vary.ground.as_ref().is_none_or(|name| self.grounds.contains_key(name));
            let about = Complaint::about(if is_known { "key" } else { "ground" }, remedy);
            return Err(about.in_entry(index).inside("vary"));
        }
        Ok(())
    }
}

impl GroundTable {
    /// What a fit may have set; none where the ground leaves it out, or lacks the soil.
    pub fn value_of(&self, key: VaryKey) -> Option<Distribution> {
        if key == VaryKey::FrictionAngleDeg {
            return Some(self.friction_angle_deg.clone());
        }
        let mut own = self.clone();
        match own.drawn(key) {
            Some(drawn) => drawn.clone(),
            None => Distribution::fixed(*own.of_soil(key)?).ok(),
        }
    }

    /// Where a value stands that is drawn for each rock and that a ground may leave out; none of other values.
    pub fn drawn(&mut self, key: VaryKey) -> Option<&mut Option<Distribution>> {
        match key {
            VaryKey::Restitution => Some(&mut self.restitution),
            VaryKey::RestitutionHalfSpeedMS => Some(&mut self.restitution_half_speed_m_s),
            VaryKey::TangentialRatio => Some(&mut self.tangential_ratio),
            VaryKey::RollingFriction | VaryKey::RollingFrictionSpread => {
                Some(&mut self.rolling_friction)
            }
            VaryKey::RoughnessDeg => Some(&mut self.roughness_deg),
            VaryKey::RoughnessLengthM => Some(&mut self.roughness_length_m),
            _ => None,
        }
    }

    /// Where a value of the soil stands, a number; none of other values, nor without that soil.
    pub fn of_soil(&mut self, key: VaryKey) -> Option<&mut f64> {
        let (slip, scar) = (self.slip_friction.as_mut(), self.scar.as_mut());
        match key {
            VaryKey::SlipFrictionMax => slip.map(|slip| &mut slip.most),
            VaryKey::SlipFrictionKappaPerM => slip.map(|slip| &mut slip.kappa_per_m),
            VaryKey::SlipFrictionBetaPerS => slip.map(|slip| &mut slip.beta_per_s),
            VaryKey::ScarStrengthKnM2 => scar.map(|scar| &mut scar.strength_kn_m2),
            VaryKey::ScarDrag => scar.map(|scar| &mut scar.drag),
            _ => None,
        }
    }
}

impl CalibrateTable {
    /// What computed ends are compared with.
    pub fn measured(&self) -> MeasuredEnds {
        MeasuredEnds { file: self.deposits.clone(), least_runout_m: self.least_runout_m }
    }

    /// Parts of the measured ends that are held out in turn; 0 where none is.
    pub fn parts(&self) -> usize {
        match self.held_out.unwrap_or(0.5) {
            share if share > 0.0 => (1.0 / share).round() as usize,
            _ => 0,
        }
    }

    fn check(&self) -> Checked {
        optional("least_runout_m", self.least_runout_m, Allowed::NotNegative, "")?;
        optional("held_out", self.held_out, Allowed::Between(0.0, 0.5), "")?;
        if self.parts() > MOST_PARTS {
            let remedy = format!("write 0.0, or {} or more", 1.0 / MOST_PARTS as f64);
            return Err(Complaint::about("held_out", remedy));
        }
        for (index, vary) in self.vary.iter().enumerate() {
            let before = &self.vary[..index];
            let known = before.iter().any(|one| (&one.ground, one.key) == (&vary.ground, vary.key));
            let own = if known {
                let remedy = "remove it: an entry before varies the same value";
                Err(Complaint::about("key", remedy).finding(format!("found {:?}", vary.key.name())))
            } else {
                vary.check()
            };
            own.map_err(|wrong| wrong.in_entry(index).inside("vary"))?;
        }
        Ok(())
    }
}

impl VaryTable {
    /// Its name in results: `ground.key`, or `rocks.shapes.key`.
    pub fn name(&self) -> String {
        format!("{}.{}", self.ground.as_deref().unwrap_or("rocks.shapes"), self.key.name())
    }

    /// Whether there are values beyond either end of the range, which were not tried.
    pub fn goes_on(&self) -> [bool; 2] {
        // far less than any step of a search
        let little = 1e-9 * (self.to - self.from);
        [self.from - little, self.to + little]
            .map(|beyond| number("", beyond, self.key.allowed(), "").is_ok())
    }

    fn check(&self) -> Checked {
        let key = self.key.name();
        if self.ground.is_some() && self.key.is_of_shapes() {
            let remedy = format!("remove it: {key} is a value of [[rocks.shapes]]");
            return Err(Complaint::about("ground", remedy));
        }
        if self.ground.is_none() && !self.key.is_of_shapes() {
            let remedy =
                format!("write ground = \"NAME\", a name from [grounds] whose {key} is varied");
            return Err(Complaint::missing("ground", remedy));
        }
        for (key, value) in [("from", self.from), ("to", self.to), ("before", self.before)] {
            number(key, value, self.key.allowed(), "")?;
        }
        if self.from >= self.to {
            return Err(Complaint::about("to", "write a number above from"));
        }
        Ok(())
    }
}

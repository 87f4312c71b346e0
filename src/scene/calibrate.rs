//! `[calibrate]`: measured ends, and which ground values may be fitted to them.

use super::check::{Allowed, Checked, Complaint, number, optional, suggest};
use super::grounds::TANGENTIAL;
use serde::Deserialize;
use std::path::PathBuf;

/// Most parts that are held out in turn: each is a search of its own.
const MOST_PARTS: usize = 20;

/// What a scene is compared with and what may be fitted.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [calibrate]")]
pub struct CalibrateTable {
    /// CSV file of measured ends with `release_x_m`, `release_y_m`, `x_m`, `y_m` in map coordinates.
    pub deposits: PathBuf,
    /// Share of the measured ends that is held out of each fit to score it on (–), 0..0.5; absent = 0.5.
    pub held_out: Option<f64>,
    /// The ground values that `rockfall calibrate` searches; may be none.
    #[serde(default)]
    pub vary: Vec<VaryTable>,
}

/// One ground value and the range it is searched in.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table { ground, key, from, to, before }")]
pub struct VaryTable {
    /// Name under `[grounds]`.
    pub ground: String,
    /// Which of its values.
    pub key: VaryKey,
    /// Smallest value tried.
    pub from: f64,
    /// Largest value tried.
    pub to: f64,
    /// The value that would stand there without calibration, from literature; reported beside the fitted one.
    pub before: f64,
}

/// A ground value that may be fitted.
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
}

impl VaryKey {
    /// Its key in the scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::FrictionAngleDeg => "friction_angle_deg",
            Self::Restitution => "restitution",
            Self::RestitutionHalfSpeedMS => "restitution_half_speed_m_s",
            Self::TangentialRatio => "tangential_ratio",
            Self::RollingFriction => "rolling_friction",
            Self::RollingFrictionSpread => "rolling_friction_spread",
            Self::RoughnessDeg => "roughness_deg",
        }
    }

    fn allowed(self) -> Allowed {
        match self {
            Self::FrictionAngleDeg | Self::RoughnessDeg => Allowed::Slope,
            Self::Restitution => Allowed::Share,
            Self::RestitutionHalfSpeedMS => Allowed::Positive,
            Self::TangentialRatio => TANGENTIAL,
            Self::RollingFriction | Self::RollingFrictionSpread => Allowed::NotNegative,
        }
    }
}

impl CalibrateTable {
    /// Parts of the measured ends that are held out in turn; 0 where none is.
    pub fn parts(&self) -> usize {
        match self.held_out.unwrap_or(0.5) {
            share if share > 0.0 => (1.0 / share).round() as usize,
            _ => 0,
        }
    }

    pub(super) fn check(&self, grounds: &[&str]) -> Checked {
        optional("held_out", self.held_out, Allowed::Between(0.0, 0.5), "")?;
        if self.parts() > MOST_PARTS {
            let remedy = format!("write 0.0, or {} or more", 1.0 / MOST_PARTS as f64);
            return Err(Complaint::about("held_out", remedy));
        }
        for (index, vary) in self.vary.iter().enumerate() {
            vary.check(grounds).map_err(|wrong| wrong.in_entry(index).inside("vary"))?;
        }
        Ok(())
    }
}

impl VaryTable {
    fn check(&self, grounds: &[&str]) -> Checked {
        if !grounds.contains(&self.ground.as_str()) {
            let remedy = format!("write a name from [grounds]; {}", suggest(&self.ground, grounds));
            return Err(Complaint::about("ground", remedy));
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

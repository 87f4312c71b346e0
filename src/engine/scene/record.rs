//! `[record]`, `[[lines]]` and `[maps]`.

use super::check::{Allowed, Checked, Complaint, number, optional};
use super::places::Polyline;
use serde::{Deserialize, Serialize};

/// What is kept of every journey; optional as a whole.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [record]")]
pub struct RecordTable {
    /// How many releases keep their path, the first ones; 0 leaves paths out.
    pub paths: Option<usize>,
    /// Time between stored points of a path (s), positive.
    pub path_step_s: Option<f64>,
    /// Whether impacts are kept.
    pub impacts: Option<bool>,
    /// Length of the stretches in which the profile of speed and height is noted (m), positive.
    pub profile_step_m: Option<f64>,
}

/// One evaluation line: a vertical curtain over a polyline of the map.
#[derive(Debug, Clone, PartialEq)]
pub struct LineTable {
    /// Name in the results.
    pub name: String,
    /// Its corners in map coordinates (m).
    pub points_m: Polyline,
}

/// What stands on the report and cannot be told from the rest of the scene; all of it may be absent.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table [report]")]
pub struct ReportTable {
    /// For whom.
    pub client: Option<String>,
    /// Of what.
    pub project: Option<String>,
    /// By whom.
    pub author: Option<String>,
    /// When, as it shall be printed.
    pub date: Option<String>,
    /// Where the terrain comes from: survey, year, resolution.
    pub terrain_source: Option<String>,
    /// Where ground values come from: back-analysis, literature.
    pub ground_source: Option<String>,
    /// In which language page and figures speak; English without.
    pub language: Option<Language>,
}

/// A language of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// English.
    #[default]
    En,
    /// German.
    De,
    /// French.
    Fr,
    /// Italian.
    It,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::En, Self::De, Self::Fr, Self::It];
}

/// Rasters in plan view.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [maps]")]
pub struct MapsTable {
    /// Side of a cell (m), positive.
    pub cell_m: f64,
}

/// Shorter steps of a path (s) would fill any disk: a million points for each second of fall.
const SHORTEST_STEP_S: f64 = 1e-6;

impl RecordTable {
    pub(super) fn check(&self) -> Checked {
        if self.path_step_s.is_some_and(|step_s| step_s > 0.0 && step_s < SHORTEST_STEP_S) {
            return Err(Complaint::about(
                "path_step_s",
                format!("write {SHORTEST_STEP_S:e} or more"),
            ));
        }
        optional("path_step_s", self.path_step_s, Allowed::Positive, "")?;
        optional("profile_step_m", self.profile_step_m, Allowed::Positive, "")
    }
}

impl MapsTable {
    pub(super) fn check(&self) -> Checked {
        number("cell_m", self.cell_m, Allowed::Between(1e-6, 1e5), "")
    }
}

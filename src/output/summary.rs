//! `summary.json`: what a run says, in one page for people and scripts.

use super::RunInfo;
use super::progress::Identity;
use super::whole::{read_json, write_json};
use crate::error::Result;
use crate::hazard::{
    BarrierSummary, Hazard, Largest, Line, LineSummary, MapFrame, Proportion, Quantity, Statistic,
    StopKind, Totals, Way,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the file.
pub(super) const SUMMARY: &str = "summary.json";

/// What the numbers mean, printed beside them.
const DEFINITIONS: [(&str, &str); 9] = [
    (
        "barriers",
        "a barrier stops a rock whose highest point is not above its edge (height_m + 2 radius) and whose total energy it can take; it changes no rock's way, but what it stops does not arrive at the barriers behind it; design energy = percentile x speed factors squared x mass factors, design height = percentile of the highest point x height factors + free height",
    ),
    (
        "energy_balance_error",
        "|numerical remainder of the energy| / (potential energy released + kinetic energy at the start), the largest of all rocks",
    ),
    (
        "intervals",
        "95 %: of percentiles by order statistics, whatever the distribution (low_95 and high_95 two-sided, upper_95 one-sided); of means normal; of shares Wilson, 3/n where none was seen. Conditional on release: no annual frequency",
    ),
    (
        "lines",
        "over rocks, of the value at the first crossing, which is interpolated on the parabola of a flight or the cubic of a step; reach = rocks that cross / releases; height_m vertical, height_normal_m along the normal of the triangle below",
    ),
    (
        "maps",
        "one value per rock and cell, its largest there; 95th percentiles from classes of ratio 1.05: within 2.5 % of the ranked value; heights are taken at three places of a flight in the cell",
    ),
    ("max_height_m", "vertical, from the ground below to the lowest point of the rock"),
    (
        "percentiles",
        "over all rocks that did not fail, linear between neighbouring order statistics; rocks that left the terrain or ran out of time count with what they had done until then",
    ),
    ("reach_angle_deg", "atan(drop / runout)"),
    ("runout_m", "horizontal distance from release to end"),
];

/// The summary. All but [`run`](Self::run) is the same whenever and wherever the run is repeated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Title of the scene.
    pub title: String,
    /// Scene hash, version, seed, releases.
    #[serde(flatten)]
    pub identity: Identity,
    /// Map position of the local (0, 0, 0) (m).
    pub origin_m: [f64; 3],
    /// Rocks by reason of their end.
    pub stops: BTreeMap<String, usize>,
    /// The same as shares with intervals.
    pub stop_shares: BTreeMap<String, Proportion>,
    /// Statistics by the column of `releases.csv`.
    pub statistics: BTreeMap<String, Statistic>,
    /// What crosses each evaluation line, in the order of the scene.
    #[serde(default)]
    pub lines: Vec<LineSummary>,
    /// What each barrier stops and what its rule asks for.
    #[serde(default)]
    pub barriers: Vec<BarrierSummary>,
    /// Measured ways, if the scene names any.
    #[serde(default)]
    pub observed: Vec<Way>,
    /// Where the maps lie, if there are any.
    #[serde(default)]
    pub maps: Option<MapFrame>,
    /// Largest energy balance error of one rock (–).
    pub largest_energy_balance_error: Option<Largest>,
    /// Failures by reason, effort, energy ledger, largest rise of energy.
    #[serde(flatten)]
    pub totals: Totals,
    /// Length of each table (bytes): rows that are missing later are noticed.
    #[serde(default)]
    pub bytes: BTreeMap<String, u64>,
    /// What was computed, what was left out and why.
    pub plan: Vec<String>,
    /// What went in, as name and value.
    #[serde(default)]
    pub inputs: Vec<(String, String)>,
    /// Rows of the title block.
    #[serde(default)]
    pub title_block: Vec<(String, String)>,
    /// Where terrain and ground values come from, in words.
    #[serde(default)]
    pub sources: [String; 2],
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Health of the meshes.
    pub mesh_health: serde_json::Value,
    /// What the numbers mean.
    pub definitions: BTreeMap<String, String>,
    /// Clock and machine.
    pub run: Run,
}

/// The only part of the results that differs from one repetition to the next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// From the opening of the results to the last row on the disk, all sessions of a resumed run together (s).
    pub seconds: f64,
    /// Releases per second of that time, writing included.
    pub releases_per_second: f64,
    /// Worker threads of the last session.
    pub threads: usize,
}

impl Summary {
    /// The summary of a finished run that took so long.
    pub(super) fn new(info: RunInfo, (hazard, lines): (&Hazard, &[Line]), seconds: f64) -> Self {
        Self {
            title: info.title,
            stops: by_stop(|stop| hazard.ended(stop).count),
            stop_shares: by_stop(|stop| hazard.ended(stop)),
            statistics: statistics(hazard),
            lines: lines.iter().map(|line| line.summary(hazard.rocks())).collect(),
            barriers: Vec::new(),
            observed: info.observed,
            maps: info.maps,
            largest_energy_balance_error: hazard.largest_balance_error(),
            totals: hazard.totals.rounded(),
            origin_m: info.origin_m.into(),
            bytes: BTreeMap::new(),
            plan: info.plan,
            inputs: info.inputs,
            title_block: info.title_block,
            sources: info.sources,
            warnings: info.warnings,
            mesh_health: info.mesh_health,
            definitions: owned(&DEFINITIONS),
            run: Run {
                seconds,
                releases_per_second: info.identity.releases as f64 / seconds,
                threads: info.threads,
            },
            identity: info.identity,
        }
    }

    /// Reads the summary in `dir`; none if there is none.
    pub(super) fn read(dir: &Path) -> Result<Option<Self>> {
        read_json(&dir.join(SUMMARY))
    }

    /// Writes it into `dir`, whole.
    pub(super) fn write(&self, dir: &Path) -> Result<()> {
        write_json(&dir.join(SUMMARY), self)
    }
}

fn by_stop<T>(value: impl Fn(StopKind) -> T) -> BTreeMap<String, T> {
    StopKind::ALL.into_iter().map(|stop| (stop.word().to_owned(), value(stop))).collect()
}

fn statistics(hazard: &Hazard) -> BTreeMap<String, Statistic> {
    let of = |quantity: Quantity| (quantity.column().to_owned(), hazard.statistic(quantity));
    Quantity::ALL.into_iter().map(of).collect()
}

fn owned(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
    pairs.iter().map(|&(name, text)| (name.to_owned(), text.to_owned())).collect()
}

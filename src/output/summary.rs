//! `summary.json`: what a run says, in one page for people and scripts.

use super::RunInfo;
use super::atomic_file::{read_json, write_json};
use super::progress::Identity;
use super::site::Site;
use crate::error::Result;
use crate::hazard::{
    Annual, AnnualRequest, BarrierSummary, Hazard, Largest, Line, LineSummary, MapFrame,
    ObservedPath, Proportion, Quantity, Residual, Statistic, StopKind, Totals,
};
use crate::plan::PlanEntry;
use crate::scene::Language;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the file.
pub(super) const SUMMARY: &str = "summary.json";

/// What the numbers mean, printed beside them.
const DEFINITIONS: [(&str, &str); 13] = [
    (
        "annual",
        "numbers a year, not conditional on release: passage frequency = sum over classes of size and source of their events a year x share of their rocks that pass (with at least an energy); interval: beta quantiles with the effective weight of a rock (Clopper and Pearson, Korn and Graubard), upper end as if one more rock of the heaviest class passed (Fay and Feuer), 3 x that weight where none does; return period = 1 / frequency; annual probability = 1 - exp(-frequency); energy of return period T: passed with at least that much once in T years, its interval read off that of the frequency; by_log_rate = derivative by the logarithm of all rates, by_exponent = derivative by the exponents of all power laws with their events of 1 m3 or more kept; saved = passages whose rock a barrier stops before, told to the first that does",
    ),
    (
        "asked",
        "a rock hits an object when, seen from above, its rim first comes over it: within (width + diameter) / 2 of a line, half a diameter of an outline; at any height. Individual risk = hits x share of time there x vulnerability; of n vehicles a day of length l at speed v, n (l + diameter) / (24 h v) are in the way of a rock",
    ),
    (
        "barriers",
        "a barrier stops a rock whose highest point is not above its edge (height_m + 2 radius) and whose total energy it can take; it changes no rock's way, but what it stops does not arrive at the barriers behind it; design energy = percentile x speed factors squared x mass factors, or with a design block (block) half its mass x mass factors x (speed_percentile_m_s x speed factors) squared; capacity_j = design energy x capacity_factor, design height = percentile of the highest point x height factors + free height; none where fewer rocks arrive than bound the percentile, design_lacks says how many are missing; energy_95_j and height_95_m are the intervals of the percentile with the same factors, open where they are",
    ),
    (
        "censored",
        "the value is a bound only: rocks that left the terrain, ran out of time or failed decide it. Runout, drop and time are then at least, reach angle at most what is written; largest values and impacts of rocks that ran out of time or failed are at least that, but for speeds, energies and heights that no fall to the lowest ground of the terrain (site.floor) could make larger; those of rocks that left the terrain are those on it. Shares and numbers a year of rocks that come to a line are at least that too, where such rocks may still come to it; the interval is open on that side, or its upper end takes those rocks as arriving; censored counts those rocks",
    ),
    (
        "energy_balance_error",
        "|numerical remainder of the energy| / (potential energy released + kinetic energy at the start); largest_energy_balance_error is the largest of all rocks, each over the energy of a fall by a tenth of its radius where it released less",
    ),
    (
        "intervals",
        "95 %: of percentiles by order statistics, whatever the distribution (low_95 and high_95 two-sided, upper_95 one-sided); of means the outer ends of Student's and Hall's, normal for the logarithm of how far they lie above it where that would reach below what is possible (0; of heights of blocks at lines, where some are below 0, minus the mean of half their own heights), none where all values are equal; of shares Clopper and Pearson, 1 − 0.05^(1/n) (one-sided) where none or all were seen. Conditional on release; numbers a year stand under annual only. With sources that sample sizes by importance rocks weigh what they stand for: ratios of sums, intervals by the delta method, of percentiles Woodruff's",
    ),
    (
        "lines",
        "over rocks, of the value at the first crossing, which is interpolated on the parabola of a flight or the cubic of a step; reach = rocks that cross / rocks released; may_still_come = rocks that have not crossed but may, with any energy up to that of their fall to it: they are missing in the statistics, whose percentiles may be too low, or too high where the fast come first; floor = no ground of the line is lower, and no rock without the energy to come up to it comes; height_m vertical, height_normal_m along the normal of the triangle below",
    ),
    (
        "maps",
        "one value per rock and cell, its largest there; 95th percentiles from classes of ratio 1.05: within 2.5 % of the ranked value; heights are the largest along the way; intensity_class by the 95th percentile of energy, counted: weak below 30 kJ, strong from 300 kJ on; open_on_maps = rocks that ended on the map and would have gone on: further on they are missing, and probabilities and percentiles may be too low",
    ),
    ("max_height_m", "vertical, from the ground below to the lowest point of the rock"),
    (
        "percentiles",
        "over all rocks that were released, linear between neighbouring order statistics; of rocks that stand for unlike numbers of events the smallest value that at least this share of all weight does not exceed; rocks that left the terrain, ran out of time or failed count with what they had done until then",
    ),
    ("reach_angle_deg", "atan(drop / runout)"),
    (
        "residual",
        "each line without and with the barriers that rocks meet before it; a rock that a barrier lets through keeps its energy",
    ),
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
    /// What annual numbers were asked for: sources, objects, classes of hazard.
    #[serde(default)]
    pub asked: AnnualRequest,
    /// Annual numbers at each line and object; none without sources, and none in a shard.
    #[serde(default)]
    pub annual: Option<Annual>,
    /// What remains at each line behind the barriers.
    #[serde(default)]
    pub residual: Vec<Residual>,
    /// Where meshes and releases lie.
    #[serde(default)]
    pub site: Site,
    /// Measured ways, if the scene names any.
    #[serde(default)]
    pub observed: Vec<ObservedPath>,
    /// Independent ends that they are worth (–): throws of one block are alike. None in results of before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub observed_worth: Option<f64>,
    /// Least runout of a computed rock that is compared with them (m); none compares all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub observed_least_runout_m: Option<f64>,
    /// Where the maps lie, if there are any.
    #[serde(default)]
    pub maps: Option<MapFrame>,
    /// Rocks that ended on the map and would have gone on, as a share of all that were released; none of none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub open_on_maps: Option<Proportion>,
    /// Largest energy balance error of one rock (–).
    pub largest_energy_balance_error: Option<Largest>,
    /// Failures by reason, effort, energy ledger, largest rise of energy.
    #[serde(flatten)]
    pub totals: Totals,
    /// Length of each table (bytes): rows that are missing later are noticed.
    #[serde(default)]
    pub bytes: BTreeMap<String, u64>,
    /// Length of each raster of the maps (bytes): only the run itself could make one anew.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub map_bytes: BTreeMap<String, u64>,
    /// What was computed, what was left out and why.
    pub plan: Vec<String>,
    /// The same, as pairs of part and text.
    #[serde(default)]
    pub plan_entries: Vec<PlanEntry>,
    /// What went in, as name and value.
    #[serde(default)]
    pub inputs: Vec<(String, String)>,
    /// Rows of the title block.
    #[serde(default)]
    pub title_block: Vec<(String, String)>,
    /// Where terrain and ground values come from, in words.
    #[serde(default)]
    pub sources: [String; 2],
    /// In which language page and figures speak.
    #[serde(default)]
    pub language: Language,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Health of the meshes.
    pub mesh_health: serde_json::Value,
    /// What the numbers mean.
    pub definitions: BTreeMap<String, String>,
    /// Clock and machine.
    pub run: RunTimes,
}

/// The only part of the results that differs from one repetition to the next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RunTimes {
    /// From the opening of the results to the last row on the disk, all sessions of a resumed run together (s).
    pub seconds: f64,
    /// Releases per second of that time, writing included.
    pub releases_per_second: f64,
    /// Worker threads of the last session.
    pub threads: usize,
    /// The most memory that its process held at a time (bytes); none where the system does not say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory_bytes: Option<u64>,
}

impl Summary {
    /// The summary of a finished run that took so long.
    pub(super) fn new(info: RunInfo, (hazard, lines): (&Hazard, &[Line]), seconds: f64) -> Self {
        let frequency = info.asked.frequency.as_ref();
        let of_line = |line: &Line| line.summary(hazard.released(), frequency);
        Self {
            title: info.title,
            stops: by_stop(|stop| hazard.ended(stop).count),
            stop_shares: by_stop(|stop| hazard.ended(stop)),
            statistics: statistics(hazard),
            lines: lines.iter().map(of_line).collect(),
            barriers: Vec::new(),
            asked: info.asked,
            annual: None,
            residual: Vec::new(),
            site: info.site,
            observed: info.observed,
            observed_worth: info.observed_worth,
            observed_least_runout_m: info.observed_least_runout_m,
            open_on_maps: info.maps.and_then(|map| hazard.open_on(&map)),
            maps: info.maps,
            largest_energy_balance_error: hazard.largest_balance_error(),
            totals: hazard.totals.rounded(),
            origin_m: info.origin_m.into(),
            bytes: BTreeMap::new(),
            map_bytes: BTreeMap::new(),
            plan: info.plan.iter().map(ToString::to_string).collect(),
            plan_entries: info.plan,
            inputs: info.inputs,
            title_block: info.title_block,
            sources: info.sources,
            language: info.language,
            warnings: info.warnings,
            mesh_health: info.mesh_health,
            definitions: owned(&DEFINITIONS),
            run: RunTimes {
                seconds,
                releases_per_second: info.identity.releases as f64 / seconds,
                threads: info.threads,
                memory_bytes: most_memory_bytes(),
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

/// What Linux says of this process; none on other systems.
fn most_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kilobytes)
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

//! What a report is drawn from: plain numbers and text, filled by a run or read back from its result files.

use super::raster::GroundRaster;
use crate::hazard::{Agreement, Way};
use crate::trajectory::{PathState, Stop};
use std::collections::BTreeMap;

/// Everything a report shows.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Words and provenance.
    pub text: Text,
    /// One entry a release, in order; none is left out.
    pub releases: Vec<Fall>,
    /// Kept paths.
    pub paths: Vec<Path>,
    /// Height and trees in plan view; `None` leaves the maps without ground.
    pub ground: Option<GroundRaster>,
    /// Share of rocks that run out farther than `x` (m), rising in `x`, with its confidence band.
    pub runout_exceedance: Vec<BandPoint>,
    /// Quantiles of each quantity, each with its confidence interval.
    pub quantiles: BTreeMap<Quantity, Vec<Quantile>>,
    /// Count and share of each stop reason.
    pub stops: Vec<StopShare>,
    /// Headline numbers.
    pub headline: Vec<Row>,
    /// Further tables: one an evaluation line, for instance.
    pub tables: Vec<Table>,
    /// Evaluation lines, in the order of the scene.
    pub lines: Vec<Line>,
    /// What a year brings to each line and object; empty without sources.
    pub annual: Vec<AnnualView>,
    /// Barriers, in the order of the scene.
    pub barriers: Vec<BarrierView>,
    /// Measured ends, where the scene names some.
    pub observed: Option<Observed>,
    /// Maps, where the scene asks for them.
    pub maps: Option<CellMap>,
    /// Whether `view.html` and `view.glb` stand beside the page.
    pub has_view: bool,
}

/// Words and provenance.
#[derive(Debug, Clone, Default)]
pub struct Text {
    /// Title of the scene.
    pub title: String,
    /// One line below the title: place, date, file. May be empty.
    pub subtitle: String,
    /// Title block: client, project, author, date. May be empty.
    pub title_block: Vec<(String, String)>,
    /// How contacts were integrated, in one sentence; closes the method paragraph. May be empty.
    pub scheme: String,
    /// Inputs as name and value: rocks, release, grounds, stop rule.
    pub inputs: Vec<(String, String)>,
    /// Health of the meshes, one line each.
    pub mesh_health: Vec<String>,
    /// The plan: what was computed, what was left out and why.
    pub plan: Vec<String>,
    /// What the reader must know before using the numbers.
    pub warnings: Vec<String>,
    /// Where the terrain comes from and how fine it is.
    pub terrain_source: String,
    /// Whether ground values are calibrated or taken from literature. May be empty.
    pub parameter_source: String,
    /// Seed of all chance.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Hash of scene and meshes.
    pub scene_hash: String,
    /// Rocks per second with all files written; `None` where no clock ran.
    pub rate_per_s: Option<f64>,
    /// Largest share of the released energy of one rock that neither motion nor friction nor damping accounts for (–).
    pub energy_remainder: Option<f64>,
}

/// One release and its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Fall {
    /// Why it ended.
    pub stop: Stop,
    /// Horizontal distance from release to end (m).
    pub runout_m: f64,
    /// Height lost from release to end (m), positive downwards.
    pub drop_m: f64,
    /// `atan(drop/runout)` (degrees).
    pub reach_angle_deg: f64,
    /// Largest speed of the centre (m/s).
    pub max_speed_m_s: f64,
    /// Largest translational energy (J).
    pub max_translational_j: f64,
    /// Largest rotational energy (J).
    pub max_rotational_j: f64,
    /// Largest sum of both at one instant (J).
    pub max_total_j: f64,
    /// Largest vertical distance from the ground below to the lowest point of the rock (m).
    pub max_height_m: f64,
    /// Number of impacts, trees included.
    pub impacts: u32,
    /// Number of impacts on trees.
    pub tree_impacts: u32,
    /// Centre at release, map coordinates (m).
    pub start_m: [f64; 3],
    /// Centre at the end, map coordinates (m).
    pub end_m: [f64; 3],
}

/// One kept path.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// Release number, from 0.
    pub index: usize,
    /// Its points, in time order.
    pub points: Vec<Point>,
}

/// One instant of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Time since release (s).
    pub time_s: f64,
    /// Centre, map coordinates (m).
    pub place_m: [f64; 3],
    /// Speed of the centre (m/s).
    pub speed_m_s: f64,
    /// Vertical distance from the ground below to the lowest point of the rock (m); NaN where there is no ground.
    pub clearance_m: f64,
    /// Flight, sliding or sticking.
    pub state: PathState,
}

/// A number with its confidence interval; a bound that the sample is too small for is not finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// One point of a curve with a confidence band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandPoint {
    /// Where.
    pub x: f64,
    /// Curve and band there.
    pub y: Estimate,
}

/// A quantile of a quantity over rocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantile {
    /// Share of rocks below (0..1).
    pub probability: f64,
    /// The value, in the quantity's SI unit.
    pub at: Estimate,
}

/// How many releases ended in one way.
#[derive(Debug, Clone, PartialEq)]
pub struct StopShare {
    /// The way.
    pub stop: Stop,
    /// Number of releases.
    pub count: usize,
    /// Share of all releases (0..1) with its interval.
    pub share: Estimate,
}

/// One number of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What it is.
    pub name: String,
    /// The number and its interval.
    pub estimate: Estimate,
    /// Its unit; empty for a pure number.
    pub unit: String,
}

/// A table of estimates: one row a quantity, one column a statistic.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Heading.
    pub title: String,
    /// One line below it: counts, conditions. May be empty.
    pub note: String,
    /// Names of the statistics.
    pub columns: Vec<String>,
    /// Name with unit, and one cell a column (`None` = not available).
    pub rows: Vec<(String, Vec<Option<Estimate>>)>,
}

/// One barrier and the rocks that arrive at it.
#[derive(Debug, Clone, PartialEq)]
pub struct BarrierView {
    /// Its name.
    pub name: String,
    /// Its height (m).
    pub height_m: f64,
    /// Energy that it takes (J).
    pub capacity_j: f64,
    /// Height (m) and energy (J) that its rule asks for.
    pub design: Option<(f64, f64)>,
    /// Its own place first, then others.
    pub places: Vec<PlaceView>,
}

/// The rocks that arrive at one place of a barrier.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceView {
    /// Distance from the barrier's own place (m), positive on the left of its line.
    pub offset_m: f64,
    /// Share of all releases that arrive (–).
    pub arriving: f64,
    /// Height of the highest point (m) and total energy (J) of each.
    pub rocks: Vec<(f64, f64)>,
}

/// How often a year which energy is passed at a line or object.
#[derive(Debug, Clone, PartialEq)]
pub struct AnnualView {
    /// Its name.
    pub name: String,
    /// Whether it is an object.
    pub is_object: bool,
    /// λ(E ≥ x) (1/year) by rising `x` (J), as if there were no barrier.
    pub without: Vec<BandPoint>,
    /// The same of rocks that no barrier stops before; none where the scene has none.
    pub with: Option<Vec<BandPoint>>,
    /// Return periods asked for (years).
    pub return_periods_years: Vec<f64>,
}

impl AnnualView {
    /// Its curves.
    pub(super) fn curves(&self) -> impl Iterator<Item = &Vec<BandPoint>> {
        [&self.without].into_iter().chain(&self.with)
    }
}

/// One evaluation line.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// Its length (m).
    pub length_m: f64,
    /// All releases.
    pub releases: usize,
    /// Share of the releases that cross it.
    pub reach: Estimate,
    /// Rocks that cross it more than once.
    pub crossing_again: usize,
    /// First crossings.
    pub crossings: Vec<LinePoint>,
    /// Percentiles of total energy (J).
    pub energy_quantiles: Vec<Quantile>,
    /// Percentiles of height (m).
    pub height_quantiles: Vec<Quantile>,
    /// Share of the rocks that cross with more than `x` (J).
    pub energy_exceedance: Vec<BandPoint>,
    /// Share of the rocks that cross higher than `x` (m).
    pub height_exceedance: Vec<BandPoint>,
}

/// One first crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePoint {
    /// Along the line (m).
    pub along_m: f64,
    /// Vertical height of the lowest point (m); NaN where there is no ground.
    pub height_m: f64,
    /// Total energy (J).
    pub total_j: f64,
}

/// Measured ends beside the computed ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// Measured ways.
    pub measured: Vec<Way>,
    /// Computed ways, failed rocks left out.
    pub computed: Vec<Way>,
    /// How well they agree.
    pub agreement: Agreement,
}

/// Maps cell by cell; cells that no rock reaches are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CellMap {
    /// Western edge, map coordinates (m).
    pub west_m: f64,
    /// Southern edge, map coordinates (m).
    pub south_m: f64,
    /// Side of a cell (m).
    pub cell_m: f64,
    /// Number of columns; cell 0 is the most south-western, rows run east.
    pub columns: u32,
    /// Share of the releases that pass (–).
    pub reach: Vec<(u32, f64)>,
    /// Swiss class of intensity, 1 to 3.
    pub intensity: Vec<(u32, f64)>,
    /// Cells of each class.
    pub intensity_cells: [usize; 3],
}

impl CellMap {
    /// Middle of a cell, map coordinates (m).
    pub fn centre_m(&self, cell: u32) -> (f64, f64) {
        let at = |edge: f64, number: u32| edge + (f64::from(number) + 0.5) * self.cell_m;
        (at(self.west_m, cell % self.columns), at(self.south_m, cell / self.columns))
    }

    /// West and east, south and north end of the cells reached, with a cell round them (m).
    pub(super) fn extent(&self) -> ((f64, f64), (f64, f64)) {
        let empty = (f64::INFINITY, f64::NEG_INFINITY);
        let wider = |r: (f64, f64), v: f64| {
            (r.0.min(v - 1.5 * self.cell_m), r.1.max(v + 1.5 * self.cell_m))
        };
        let centres = self.reach.iter().map(|(cell, _)| self.centre_m(*cell));
        let (x, y) = centres.fold((empty, empty), |(x, y), c| (wider(x, c.0), wider(y, c.1)));
        if x.0 < x.1 { (x, y) } else { ((0.0, 1.0), (0.0, 1.0)) }
    }
}

/// What is measured of every release.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Horizontal distance from release to end (m).
    Runout,
    /// `atan(drop/runout)` (degrees).
    ReachAngle,
    /// Largest speed (m/s).
    Speed,
    /// Largest translational energy (J).
    Translational,
    /// Largest rotational energy (J).
    Rotational,
    /// Largest sum of both energies (J).
    Total,
    /// Largest bounce height (m).
    Height,
    /// Number of impacts (–).
    Impacts,
}

impl Quantity {
    /// Its value for one release, in SI (degrees for the angle).
    pub fn of(self, fall: &Fall) -> f64 {
        match self {
            Self::Runout => fall.runout_m,
            Self::ReachAngle => fall.reach_angle_deg,
            Self::Speed => fall.max_speed_m_s,
            Self::Translational => fall.max_translational_j,
            Self::Rotational => fall.max_rotational_j,
            Self::Total => fall.max_total_j,
            Self::Height => fall.max_height_m,
            Self::Impacts => f64::from(fall.impacts),
        }
    }

    /// Name as it stands on an axis.
    pub fn name(self) -> &'static str {
        match self {
            Self::Runout => "Runout",
            Self::ReachAngle => "Reach angle",
            Self::Speed => "Maximum speed",
            Self::Translational => "Maximum translational energy",
            Self::Rotational => "Maximum rotational energy",
            Self::Total => "Maximum total energy",
            Self::Height => "Maximum bounce height",
            Self::Impacts => "Impacts per rock",
        }
    }

    /// Unit and its size in SI that suit values up to `largest` (SI).
    pub fn unit(self, largest: f64) -> (&'static str, f64) {
        match self {
            Self::Runout | Self::Height => ("m", 1.0),
            Self::ReachAngle => ("°", 1.0),
            Self::Speed => ("m/s", 1.0),
            Self::Impacts => ("", 1.0),
            Self::Translational | Self::Rotational | Self::Total => energy_unit(largest),
        }
    }
}

/// J, kJ or MJ, whichever keeps numbers up to `largest_j` short.
pub(super) fn energy_unit(largest_j: f64) -> (&'static str, f64) {
    match largest_j {
        e if e >= 2e6 => ("MJ", 1e6),
        e if e >= 2e3 => ("kJ", 1e3),
        _ => ("J", 1.0),
    }
}

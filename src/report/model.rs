//! What a report is drawn from: plain numbers and text, filled by a run or read back from its result files.

mod places;

pub use places::{
    AnnualView, BarrierView, Behind, CellMap, DesignView, LevelCells, LinePoint, MapMark, Observed,
    PlaceView, ProfileStretch, ProfileView, ReportLine, ReportStretch, RockView, YearCells,
    ZoneMark,
};

pub use super::bound::Is;
use super::raster::GroundRaster;
use super::words::Words;
use crate::output::RunTimes;
use crate::scene::Language;
use crate::simulation::{PathState, Stop};
use std::collections::BTreeMap;

/// Everything a report shows.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// In which language page and figures speak.
    pub language: Language,
    /// Words and provenance.
    pub text: Text,
    /// One entry a release, in order; none is left out.
    pub releases: Vec<ReleaseEnd>,
    /// Kept paths.
    pub paths: Vec<Path>,
    /// Height and trees in plan view; `None` leaves the maps without ground.
    pub ground: Option<GroundRaster>,
    /// Share of rocks that run out farther than `x` (m), rising in `x`, with its confidence band.
    pub runout_exceedance: Vec<BandPoint>,
    /// Quantiles of each quantity, each with its confidence interval.
    pub quantiles: BTreeMap<ReportQuantity, Vec<Quantile>>,
    /// Count and share of each stop reason.
    pub stops: Vec<StopShare>,
    /// Whether rocks weigh what they stand for: then shares are by frequency, and no quotients of counts.
    pub is_weighted: bool,
    /// Headline numbers.
    pub headline: Vec<EstimateRow>,
    /// What arrives at lines and barriers, a row each: the first tables of the page.
    pub arrivals: Vec<EstimateTable>,
    /// Plausibility: what was looked at, what was found, whether it passes.
    pub checks: Vec<Check>,
    /// Where rocks are released.
    pub zones: Vec<ZoneMark>,
    /// Lines and barriers on the map.
    pub marks: Vec<MapMark>,
    /// Further tables: one an evaluation line, for instance.
    pub tables: Vec<EstimateTable>,
    /// Evaluation lines, in the order of the scene.
    pub lines: Vec<ReportLine>,
    /// What a year brings to each line and object; empty without sources.
    pub annual: Vec<AnnualView>,
    /// Barriers, in the order of the scene.
    pub barriers: Vec<BarrierView>,
    /// Measured ends, where the scene names some.
    pub observed: Option<Observed>,
    /// Maps, where the scene asks for them.
    pub maps: Option<CellMap>,
    /// The same of a year, where the scene says how often rocks are released.
    pub year_maps: Option<YearCells>,
    /// Speed and height by distance from the release; none of results that lack it.
    pub profile: Option<ProfileView>,
    /// Whether `view.html` stands beside the page.
    pub has_view: bool,
    /// Names of the kinds of shapes; empty where the scene has none.
    pub shapes: Vec<&'static str>,
}

impl Report {
    /// A value of every rock that was released, with what the rock weighs.
    pub(super) fn weighed(&self, value: impl Fn(&ReleaseEnd) -> f64) -> Vec<(f64, f64)> {
        let released = self.releases.iter().filter(|fall| fall.weight > 0.0);
        released.map(|fall| (value(fall), fall.weight)).collect()
    }

    /// Rocks that were released: those that figures and tables are of.
    pub(super) fn released(&self) -> usize {
        let is_one = |fall: &&ReleaseEnd| !matches!(fall.stop, Stop::NotReleased(_));
        self.releases.iter().filter(is_one).count()
    }

    /// The words of its language.
    pub(super) fn words(&self) -> &'static Words {
        Words::of(self.language)
    }
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
    /// How the numbers came about, one paragraph.
    pub method: String,
    /// Inputs as name and value: rocks, release, grounds, stop rule.
    pub inputs: Vec<(String, String)>,
    /// Health of the meshes, one line each.
    pub mesh_health: Vec<String>,
    /// The plan: each part, and what was computed of it or why it was left out.
    pub plan: Vec<(String, String)>,
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
    /// Run time with all files written; `None` where no clock ran.
    pub took: Option<RunTimes>,
    /// Largest share of the released energy of one rock that neither motion nor friction nor damping accounts for (–).
    pub energy_remainder: Option<f64>,
}

/// One release and its end.
#[derive(Debug, Clone, PartialEq)]
pub struct ReleaseEnd {
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
    /// As many of equal weight would stand for what it does (–): 1 where all weigh the same, 0 where it was not released.
    pub weight: f64,
}

/// One kept path.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// Release number, from 0.
    pub index: usize,
    /// Its points, in time order.
    pub points: Vec<ReportPathPoint>,
}

/// One instant of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReportPathPoint {
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

/// A number with its confidence interval; an end that nothing bounds is not finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The estimate; NaN where there is none.
    pub value: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// What the value is.
    pub is: Is,
}

impl Estimate {
    /// A value with its interval.
    pub fn new(value: f64, low: f64, high: f64) -> Self {
        Self { value, low, high, is: Is::Value }
    }

    /// A value without an interval.
    pub fn plain(value: f64) -> Self {
        Self::new(value, f64::NAN, f64::NAN)
    }

    /// No value, because so many rocks are missing.
    pub fn lacking(rocks: usize) -> Self {
        Self { is: Is::Lacking(rocks), ..Self::plain(f64::NAN) }
    }

    /// With what is smaller than a thousandth taken for 0 (m, degrees): how far a rolling rock is off the ground is rounding.
    #[must_use]
    pub(super) fn above_a_mm(self) -> Self {
        let mm = |v: f64| if v.abs() < 1e-3 { 0.0 } else { v };
        let Self { value, low, high, is } = self;
        Self { value: mm(value), low: mm(low), high: mm(high), is }
    }

    /// In a unit so many times as large.
    #[must_use]
    pub fn over(self, size: f64) -> Self {
        let Self { value, low, high, is } = self;
        Self { value: value / size, low: low / size, high: high / size, is }
    }
}

/// One look at whether the whole is plausible.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Check {
    /// What was looked at.
    pub name: String,
    /// What was found, and what is known from the field.
    pub found: String,
    /// What to think of it; what fails is a warning.
    pub verdict: Plausibility,
}

/// What to think of a number beside those from the field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plausibility {
    /// It is like those.
    Plausible,
    /// Its interval holds the limit: chance decides on which side it lies.
    AtLimit,
    /// It is not.
    Off,
    /// Too many rocks would have gone on.
    NotJudged,
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
pub struct EstimateRow {
    /// What it is.
    pub name: String,
    /// The number and its interval.
    pub estimate: Estimate,
    /// Its unit; empty for a pure number.
    pub unit: String,
}

/// A table of estimates: one row a quantity, one column a statistic.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EstimateTable {
    /// Heading.
    pub title: String,
    /// One line below it: counts, conditions. May be empty.
    pub note: String,
    /// Names of the statistics.
    pub columns: Vec<String>,
    /// Name with unit, and one cell a column (`None` = not available).
    pub rows: Vec<(String, Vec<Option<Estimate>>)>,
    /// The chapter it belongs to.
    pub about: About,
    /// Name of the line, object or barrier it tells of; empty where it tells of several.
    pub place: String,
}

/// What a table is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum About {
    /// All rocks along their ways.
    #[default]
    Rocks,
    /// Evaluation lines.
    Lines,
    /// Barriers.
    Barriers,
    /// Measured ends.
    Measured,
    /// Kinds of shapes.
    Shapes,
    /// What a year brings.
    Year,
}

/// What is measured of every release.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ReportQuantity {
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

impl ReportQuantity {
    /// Its value for one release, in SI (degrees for the angle).
    pub fn of(self, fall: &ReleaseEnd) -> f64 {
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
    pub(super) fn name(self, words: &Words) -> &'static str {
        match self {
            Self::Runout => words.runout,
            Self::ReachAngle => words.reach_angle,
            Self::Speed => words.max_speed,
            Self::Translational => words.max_translational,
            Self::Rotational => words.max_rotational,
            Self::Total => words.max_total,
            Self::Height => words.max_height,
            Self::Impacts => words.impacts,
        }
    }

    /// Whether it is an energy.
    pub fn is_energy(self) -> bool {
        matches!(self, Self::Translational | Self::Rotational | Self::Total)
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

/// J or kJ, in which barriers and classes of intensity are named too: one number has one unit wherever it stands.
pub(crate) fn energy_unit(largest_j: f64) -> (&'static str, f64) {
    if largest_j >= 2e3 { ("kJ", 1e3) } else { ("J", 1.0) }
}

//! Lines, barriers, maps and measured ends: what belongs to a place.

use super::{BandPoint, Estimate, Quantile};
use crate::hazard::{Agreement, ObservedPath, Proportion};
use crate::output::ReleaseZone;

/// Speed and height of all rocks by distance from their release.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileView {
    /// Length of a stretch (m).
    pub step_m: f64,
    /// From the release on.
    pub stretches: Vec<ProfileStretch>,
    /// Lines and barriers at the distance (m) at which rocks cross them, by the median.
    pub marks: Vec<(f64, MapMark)>,
}

/// One stretch of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileStretch {
    /// Where it begins (m).
    pub from_m: f64,
    /// Largest bounce height of each rock in it (m).
    pub height_m: ReportStretch,
    /// Largest speed of each rock in it (m/s).
    pub speed_m_s: ReportStretch,
}

/// What is shown of a quantity in a stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReportStretch {
    /// Median over the rocks that come so far.
    pub median: f64,
    /// Their 95th percentile; none of too few.
    pub p95: Estimate,
    /// The largest.
    pub largest: f64,
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
    /// What its rule asks for.
    pub design: Option<DesignView>,
    /// Rocks missing for a design value.
    pub design_lacks: usize,
    /// Percentile of its rule (per cent); none without a rule.
    pub percentile: Option<f64>,
    /// Whether the left of its line is uphill; none where the ground does not say.
    pub left_is_uphill: Option<bool>,
    /// Its own place first, then others.
    pub places: Vec<PlaceView>,
}

impl BarrierView {
    /// Whether a rock arrives at it, here or at another place.
    pub(in crate::report) fn is_met(&self) -> bool {
        self.places.iter().any(|place| !place.rocks.is_empty())
    }
}

/// What a rule asks of a barrier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignView {
    /// Height (m).
    pub height_m: Estimate,
    /// Energy (J).
    pub energy_j: Estimate,
}

/// The rocks that arrive at one place of a barrier.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceView {
    /// Distance from the barrier's own place (m), positive on the left of its line.
    pub offset_m: f64,
    /// Share of all releases that arrive (–).
    pub arriving: f64,
    /// Share of them that a barrier of its own height stops (%), by what each stands for; none where none arrives.
    pub stopped: Option<Estimate>,
    /// Each of them.
    pub rocks: Vec<RockView>,
}

/// A rock that arrives at a barrier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RockView {
    /// Height of its highest point (m).
    pub top_m: f64,
    /// Total energy (J).
    pub total_j: f64,
    /// What it stands for over the others (–); 1 where all weigh the same.
    pub weight: f64,
}

impl BarrierView {
    /// Whether the rocks that arrive weigh differently.
    pub fn is_weighted(&self) -> bool {
        let mut weights = self.places.iter().flat_map(|place| &place.rocks).map(|rock| rock.weight);
        let first = weights.next();
        weights.any(|weight| Some(weight) != first)
    }
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
    /// Rocks that come, 95 % upper end (1/year).
    pub most_per_year: f64,
    /// Rocks computed.
    pub rocks: usize,
    /// Rocks of equal weight that would know as much.
    pub effective_rocks: f64,
}

impl AnnualView {
    /// Whether any rock comes.
    pub(in crate::report) fn is_met(&self) -> bool {
        self.curves().flatten().any(|point| point.x > 0.0 && point.y.value > 0.0)
    }

    /// Its curves.
    pub(in crate::report) fn curves(&self) -> impl Iterator<Item = &Vec<BandPoint>> {
        [&self.without].into_iter().chain(&self.with)
    }
}

/// One evaluation line.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportLine {
    /// Its name.
    pub name: String,
    /// Its number in the scene, from 1: that of its figure's file.
    pub number: usize,
    /// Whether a barrier stands on it.
    pub is_barrier: bool,
    /// Mean height of the ground along it (m); NaN where there is none. Lines stand in downslope order.
    pub elevation_m: f64,
    /// Radius of the smallest rock that crosses it (m); infinite where none does.
    pub least_radius_m: f64,
    /// Its length (m).
    pub length_m: f64,
    /// All releases.
    pub releases: usize,
    /// Share of the releases that cross it.
    pub reach: Estimate,
    /// Whether that is by frequency, and no quotient of counts.
    pub is_weighted: bool,
    /// Rocks that cross it more than once.
    pub crossing_again: usize,
    /// First crossings.
    pub crossings: Vec<LinePoint>,
    /// Percentiles of total energy (J).
    pub energy_quantiles: Vec<Quantile>,
    /// Percentiles of height (m).
    pub height_quantiles: Vec<Quantile>,
    /// Share of all releases that cross with more than `x` (J).
    pub energy_exceedance: Vec<BandPoint>,
    /// Share of all releases that cross higher than `x` (m).
    pub height_exceedance: Vec<BandPoint>,
    /// What is left by the barriers before it; none where rocks meet no barrier before, and of a barrier's own line.
    pub behind: Option<Behind>,
    /// Share of the releases that still arrive, on a barrier's own line too; none where no barrier before stops any.
    pub arriving: Option<Estimate>,
}

impl ReportLine {
    /// Whether a rock crosses it.
    pub(in crate::report) fn is_met(&self) -> bool {
        !self.crossings.is_empty()
    }
}

/// What passes a line when the barriers before it have stopped what they can.
#[derive(Debug, Clone, PartialEq)]
pub struct Behind {
    /// The barriers.
    pub barriers: Vec<String>,
    /// Share of the releases that still cross.
    pub reach: Estimate,
    /// Share of all releases that still cross with more than `x` (J).
    pub energy_exceedance: Vec<BandPoint>,
    /// Share of all releases that still cross higher than `x` (m).
    pub height_exceedance: Vec<BandPoint>,
}

/// A line or a barrier on the map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapMark {
    /// Its name.
    pub name: String,
    /// Its corners, map coordinates (m).
    pub corners_m: Vec<[f64; 2]>,
    /// Height (m) and capacity (J) of a barrier; none of a line.
    pub barrier: Option<(f64, f64)>,
    /// Whether it is an object, which rocks hit; else they cross it.
    pub is_object: bool,
}

/// A place of release on the map.
#[derive(Debug, Clone, PartialEq)]
pub struct ZoneMark {
    /// Its name; empty where it has none.
    pub name: String,
    /// Where it lies.
    pub outline: ReleaseZone,
}

/// One first crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePoint {
    /// Release number.
    pub release: usize,
    /// Along the line (m).
    pub along_m: f64,
    /// Vertical height of the lowest point (m); NaN where there is no ground.
    pub height_m: f64,
    /// Total energy (J).
    pub total_j: f64,
    /// Whether no barrier has stopped the rock before.
    pub passes: bool,
    /// As many releases of equal weight would stand for what it does (–): 1 where all weigh the same.
    pub weight: f64,
}

/// Measured ends beside the computed ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// Measured ways.
    pub measured: Vec<ObservedPath>,
    /// Computed ways, failed rocks left out.
    pub computed: Vec<ObservedPath>,
    /// What each of these stands for (–); none where all weigh the same.
    pub weights: Option<Vec<f64>>,
    /// Whether they weigh as many as were measured at their own places of release.
    pub from_own_places: bool,
    /// Independent ends that the measured ones are worth (–).
    pub worth: f64,
    /// How well they agree; the limit is that of so many ends.
    pub agreement: Agreement,
}

/// Maps cell by cell; cells that no rock reaches are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CellMap {
    /// Western edge, map coordinates (m).
    pub west_m: f64,
    /// Southern edge, map coordinates (m).
    pub south_m: f64,
    /// Side of a drawn cell (m).
    pub cell_m: f64,
    /// Cells of the files along the side of a drawn one.
    pub joined: u32,
    /// Number of columns; cell 0 is the most south-western, rows run east.
    pub columns: u32,
    /// Share of the releases that pass (–).
    pub reach: Vec<(u32, f64)>,
    /// Swiss class of the 95th percentile of energy, 1 to 3.
    pub intensity: Vec<(u32, f64)>,
    /// 95th percentile of total energy (J).
    pub energy_j: Vec<(u32, f64)>,
    /// 95th percentile of bounce height (m).
    pub height_m: Vec<(u32, f64)>,
    /// Rocks at rest.
    pub deposits: Vec<(u32, f64)>,
    /// Share of the releases that pass with 30 kJ or more (–).
    pub exceeds: Vec<(u32, f64)>,
    /// Cells of each class.
    pub intensity_cells: [usize; 3],
    /// Cells that too few rocks pass for an upper bound of their 95th percentile.
    pub few_cells: usize,
    /// Rocks that ended on the map and would have gone on.
    pub open: Option<Proportion>,
}

/// Cells, row by row from the south-west, each with a value.
pub(crate) type CellValues = Vec<(u32, f64)>;

/// Maps of a year in plan view, over the cells of [`CellMap`]; values where rocks pass.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct YearCells {
    /// Energy of the frequencies (J).
    pub energy_j: f64,
    /// Passages a year with at least that energy (1/year), above 0.
    pub frequencies: CellValues,
    /// Their change with the exponents over themselves (–); none without power law.
    pub by_exponent: Option<CellValues>,
    /// Return periods asked for (years), rising.
    pub return_periods_years: Vec<f64>,
    /// The return period of the energies (years).
    pub years: f64,
    /// Energy of that return period (J), above 0.
    pub energies_j: CellValues,
    /// Levels of hazard; none without a table of them.
    pub levels: Option<LevelCells>,
}

/// A map of levels of hazard.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LevelCells {
    /// Name of the table.
    pub name: String,
    /// Where the table was read.
    pub source: String,
    /// Levels of the table, rising, each once.
    pub known: Vec<u8>,
    /// The level of each cell; 0 where rocks come more seldom than the table asks for.
    pub cells: CellValues,
}

impl CellMap {
    /// Middle of a cell, map coordinates (m).
    pub fn centre_m(&self, cell: u32) -> (f64, f64) {
        let at = |edge: f64, number: u32| edge + (f64::from(number) + 0.5) * self.cell_m;
        (at(self.west_m, cell % self.columns), at(self.south_m, cell / self.columns))
    }

    /// West and east, south and north end of the cells reached, with a cell round them (m).
    pub(in crate::report) fn extent(&self) -> ((f64, f64), (f64, f64)) {
        let empty = (f64::INFINITY, f64::NEG_INFINITY);
        let wider = |r: (f64, f64), v: f64| {
            (r.0.min(v - 1.5 * self.cell_m), r.1.max(v + 1.5 * self.cell_m))
        };
        let centres = self.reach.iter().map(|(cell, _)| self.centre_m(*cell));
        let (x, y) = centres.fold((empty, empty), |(x, y), c| (wider(x, c.0), wider(y, c.1)));
        if x.0 < x.1 { (x, y) } else { ((0.0, 1.0), (0.0, 1.0)) }
    }
}

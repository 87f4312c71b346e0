//! What all rocks say cell by cell: counts, largest values and percentiles.
//!
//! Memory grows with the cells that rocks pass, not with the rocks: percentiles come from counts over
//! [classes](class_of) of equal ratio. Counts and largest values are the same in whatever order rocks arrive, so a
//! resumed run gives the same maps.

use super::row::StopKind;
use crate::math;
use crate::trajectory::Visit;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Where the maps lie and how fine they are, in map coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MapFrame {
    /// Western edge (m).
    pub west_m: f64,
    /// Southern edge (m).
    pub south_m: f64,
    /// Side of a cell (m), positive.
    pub cell_m: f64,
    /// Number of columns.
    pub columns: u32,
    /// Number of rows.
    pub rows: u32,
    /// EPSG code of the coordinates.
    pub epsg: Option<u32>,
}

impl MapFrame {
    /// The cell of a place on the map; none outside.
    pub fn cell(&self, [x, y, _]: [f64; 3]) -> Option<u32> {
        let place = [(x - self.west_m) / self.cell_m, (y - self.south_m) / self.cell_m];
        let inside = place[0] >= 0.0
            && place[1] >= 0.0
            && place[0] < f64::from(self.columns)
            && place[1] < f64::from(self.rows);
        inside.then(|| place[1] as u32 * self.columns + place[0] as u32)
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.columns as usize * self.rows as usize
    }
}

/// Ratio of the upper to the lower end of a class of values (–): its middle is at most 2.5 % from any value in it.
const RATIO: f64 = 1.05;
/// Upper end of the first class (J or m): smaller values are not told apart from 0.
const SMALLEST: f64 = 1e-3;

/// How often values fell in each class, by rising class.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Counts(Vec<(u16, u32)>);

/// Class of a value: 0 up to [`SMALLEST`], then equal ratios. 65535 classes reach beyond any f64.
fn class_of(value: f64) -> u16 {
    if value > SMALLEST {
        (math::ln(value / SMALLEST) / math::ln(RATIO)).floor().min(65_534.0) as u16 + 1
    } else {
        0
    }
}

/// The value that stands for a class: the geometric middle of its ends, 0 for the first.
fn middle_of(class: u16) -> f64 {
    if class == 0 { 0.0 } else { SMALLEST * math::pow(RATIO, f64::from(class) - 0.5) }
}

impl Counts {
    fn add(&mut self, value: f64) {
        self.add_class(class_of(value), 1);
    }

    fn add_class(&mut self, class: u16, count: u32) {
        match self.0.binary_search_by_key(&class, |(known, _)| *known) {
            Ok(at) => self.0[at].1 += count,
            Err(at) => self.0.insert(at, (class, count)),
        }
    }

    fn join(&mut self, other: &Self) {
        for &(class, count) in &other.0 {
            self.add_class(class, count);
        }
    }

    /// The class that holds the ⌈p n⌉-th smallest value, by its middle; 0 of nothing.
    fn percentile(&self, p: f64) -> f64 {
        let n: u64 = self.0.iter().map(|(_, count)| u64::from(*count)).sum();
        let rank = (p * n as f64).ceil().max(1.0) as u64;
        let mut below = 0;
        for &(class, count) in &self.0 {
            below += u64::from(count);
            if below >= rank {
                return middle_of(class);
            }
        }
        0.0
    }
}

/// What is known of one cell.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "Packed", into = "Packed")]
struct Cell {
    passages: u32,
    deposits: u32,
    largest_j: f64,
    largest_m: f64,
    totals_j: Counts,
    heights_m: Counts,
}

/// A cell on the disk: in the order of its fields, without their names, which would be most of it.
type Packed = (u32, u32, f64, f64, Counts, Counts);

impl From<Packed> for Cell {
    fn from((passages, deposits, largest_j, largest_m, totals_j, heights_m): Packed) -> Self {
        Self { passages, deposits, largest_j, largest_m, totals_j, heights_m }
    }
}

impl From<Cell> for Packed {
    fn from(cell: Cell) -> Self {
        let Cell { passages, deposits, largest_j, largest_m, totals_j, heights_m } = cell;
        (passages, deposits, largest_j, largest_m, totals_j, heights_m)
    }
}

impl Cell {
    fn join(&mut self, other: &Self) {
        self.passages += other.passages;
        self.deposits += other.deposits;
        self.largest_j = self.largest_j.max(other.largest_j);
        self.largest_m = self.largest_m.max(other.largest_m);
        self.totals_j.join(&other.totals_j);
        self.heights_m.join(&other.heights_m);
    }
}

/// One of the maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Rocks that pass the cell, each counted once.
    Passages,
    /// The same over all releases (–).
    Reach,
    /// Rocks that come to rest in the cell.
    Deposits,
    /// Largest total energy of any rock (J).
    EnergyMax,
    /// 95th percentile over the rocks that pass of each one's largest total energy in the cell (J).
    EnergyP95,
    /// Largest height of any rock (m).
    HeightMax,
    /// 95th percentile over the rocks that pass of each one's largest height in the cell (m).
    HeightP95,
    /// Swiss intensity by the largest total energy: 1 below 30 kJ, 2 from 30 to 300 kJ, 3 above.
    Intensity,
}

/// Limits of the Swiss classes of intensity (J): weak below, medium, strong from the second on.
pub const INTENSITY_J: [f64; 2] = [30e3, 300e3];

impl Layer {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Passages,
        Self::Reach,
        Self::Deposits,
        Self::EnergyMax,
        Self::EnergyP95,
        Self::HeightMax,
        Self::HeightP95,
        Self::Intensity,
    ];

    /// File name without ending.
    pub fn file(self) -> &'static str {
        match self {
            Self::Passages => "passages",
            Self::Reach => "reach_probability",
            Self::Deposits => "deposits",
            Self::EnergyMax => "total_energy_max_j",
            Self::EnergyP95 => "total_energy_p95_j",
            Self::HeightMax => "height_max_m",
            Self::HeightP95 => "height_p95_m",
            Self::Intensity => "intensity_class",
        }
    }

    fn of(self, cell: &Cell, releases: usize) -> f64 {
        match self {
            Self::Passages => f64::from(cell.passages),
            Self::Reach => f64::from(cell.passages) / releases.max(1) as f64,
            Self::Deposits => f64::from(cell.deposits),
            Self::EnergyMax => cell.largest_j,
            // the middle of the highest class may lie above the largest value in it
            Self::EnergyP95 => cell.totals_j.percentile(0.95).min(cell.largest_j),
            Self::HeightMax => cell.largest_m,
            Self::HeightP95 => cell.heights_m.percentile(0.95).min(cell.largest_m),
            Self::Intensity => {
                1.0 + INTENSITY_J.iter().filter(|limit| cell.largest_j >= **limit).count() as f64
            }
        }
    }
}

/// All rocks so far, cell by cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Maps {
    /// Where the cells lie.
    pub frame: MapFrame,
    cells: BTreeMap<u32, Cell>,
}

/// What a resumed run needs of the maps before it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MapState(Vec<(u32, Cell)>);

impl Maps {
    /// Goes on from what earlier rocks left.
    pub fn new(frame: MapFrame, state: MapState) -> Self {
        Self { frame, cells: state.0.into_iter().collect() }
    }

    /// Cells that rocks have passed so far.
    pub fn known_cells(&self) -> usize {
        self.cells.len()
    }

    /// What a resumed run needs.
    pub fn state(&self) -> MapState {
        MapState(self.cells.iter().map(|(cell, known)| (*cell, known.clone())).collect())
    }

    /// Adds what other rocks left.
    pub fn join(&mut self, other: MapState) {
        for (number, cell) in other.0 {
            self.cells.entry(number).or_default().join(&cell);
        }
    }

    /// Adds the cells of one rock and where it ended (map coordinates).
    pub fn add(&mut self, visits: &[Visit], stop: StopKind, end_m: [f64; 3]) {
        for visit in visits {
            let cell = self.cells.entry(visit.cell).or_default();
            cell.passages += 1;
            cell.largest_j = cell.largest_j.max(visit.total_j);
            cell.largest_m = cell.largest_m.max(visit.height_m);
            cell.totals_j.add(visit.total_j);
            cell.heights_m.add(visit.height_m);
        }
        if let (StopKind::AtRest, Some(cell)) = (stop, self.frame.cell(end_m)) {
            self.cells.entry(cell).or_default().deposits += 1;
        }
    }

    /// Values of one layer where rocks came, with the numbers of their cells, rising; `releases` are all rocks.
    pub fn values(&self, layer: Layer, releases: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let came = self.cells.iter().filter(|(_, cell)| cell.passages + cell.deposits > 0);
        came.map(move |(number, cell)| (*number, layer.of(cell, releases)))
    }

    /// Cells of each Swiss class of intensity: weak, medium, strong.
    pub fn intensity_cells(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for (_, class) in self.values(Layer::Intensity, 1) {
            counts[class as usize - 1] += 1;
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The percentile of the classes lies within 2.5 % of the ⌈p n⌉-th value, over twelve decades.
    #[test]
    fn percentiles_by_class_keep_their_error() {
        let values: Vec<f64> = (0..5000).map(|k| 2e-3 * 1.006_f64.powi(k)).collect();
        let mut counts = Counts::default();
        for value in &values {
            counts.add(*value);
        }
        for p in [0.01, 0.5, 0.9, 0.95, 0.99] {
            let exact = values[(p * 5000.0_f64).ceil() as usize - 1];
            assert!((counts.percentile(p) / exact - 1.0).abs() < 0.025, "{p}");
        }
        assert_eq!(counts.0.iter().map(|(_, count)| count).sum::<u32>(), 5000);
    }

    /// By hand: three rocks in a cell, one of them at rest in it; 29.9, 30 and 299 kJ.
    #[test]
    fn a_cell_counts_each_rock_once() {
        let frame =
            MapFrame { west_m: 100.0, south_m: 50.0, cell_m: 2.0, columns: 3, rows: 2, epsg: None };
        let mut maps = Maps::new(frame, MapState::default());
        for (total_j, height_m) in [(29.9e3, 0.5), (30e3, 0.0), (299e3, 2.0)] {
            let visits = [Visit { cell: 4, total_j, height_m }];
            maps.add(&visits, StopKind::AtRest, [103.0, 53.0 - height_m, 7.0]);
        }
        let value = |layer| maps.values(layer, 6).find(|(cell, _)| *cell == 4).map(|(_, v)| v);
        assert_eq!(value(Layer::Passages), Some(3.0));
        assert_eq!(value(Layer::Reach), Some(0.5));
        // (103, 51) is in the row below
        assert_eq!(value(Layer::Deposits), Some(2.0));
        assert_eq!(value(Layer::EnergyMax), Some(299e3));
        assert_eq!(value(Layer::HeightMax), Some(2.0));
        assert_eq!(value(Layer::Intensity), Some(2.0));
        assert_eq!(maps.intensity_cells(), [1, 1, 0]);
    }
}

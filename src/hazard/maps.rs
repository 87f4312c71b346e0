//! What all rocks say cell by cell: counts, largest values and percentiles.
//!
//! Memory grows with the cells that rocks pass, not with the rocks: percentiles come from counts over
//! [classes](super::classes) of equal ratio. Counts and largest values are the same in whatever order rocks arrive, so a
//! resumed run gives the same maps.

use super::annual::proportion;
use super::classes::Counts;
use super::row::StopKind;
use crate::frequency::Weights;
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

    fn of(self, cell: &Cell, weights: &Weights) -> f64 {
        match self {
            Self::Passages => f64::from(cell.passages),
            Self::Reach if weights.are_equal() => {
                f64::from(cell.passages) / weights.all_rocks().max(1) as f64
            }
            Self::Reach => {
                let strata = cell.totals_j.entries().iter();
                proportion(weights, strata.map(|&(_, stratum, n)| (stratum, n as usize))).share
            }
            Self::Deposits => f64::from(cell.deposits),
            Self::EnergyMax => cell.largest_j,
            // the middle of the highest class may lie above the largest value in it
            Self::EnergyP95 => cell.totals_j.percentile(0.95, weights).min(cell.largest_j),
            Self::HeightMax => cell.largest_m,
            Self::HeightP95 => cell.heights_m.percentile(0.95, weights).min(cell.largest_m),
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

    /// Adds the cells of one rock of a stratum, and how and where it ended (map coordinates).
    pub fn add(&mut self, stratum: u16, visits: &[Visit], (stop, end_m): (StopKind, [f64; 3])) {
        for visit in visits {
            let cell = self.cells.entry(visit.cell).or_default();
            cell.passages += 1;
            cell.largest_j = cell.largest_j.max(visit.total_j);
            cell.largest_m = cell.largest_m.max(visit.height_m);
            cell.totals_j.add(visit.total_j, stratum);
            cell.heights_m.add(visit.height_m, stratum);
        }
        if let (StopKind::AtRest, Some(cell)) = (stop, self.frame.cell(end_m)) {
            self.cells.entry(cell).or_default().deposits += 1;
        }
    }

    /// Counts of total energy of the cells that rocks pass, rising.
    pub(super) fn energies(&self) -> impl Iterator<Item = (u32, &Counts)> + '_ {
        let came = self.cells.iter().filter(|(_, cell)| cell.passages > 0);
        came.map(|(number, cell)| (*number, &cell.totals_j))
    }

    /// Values of one layer where rocks came, with the numbers of their cells, rising.
    pub fn values<'a>(
        &'a self,
        layer: Layer,
        weights: &'a Weights,
    ) -> impl Iterator<Item = (u32, f64)> + 'a {
        let came = self.cells.iter().filter(|(_, cell)| cell.passages + cell.deposits > 0);
        came.map(move |(number, cell)| (*number, layer.of(cell, weights)))
    }

    /// Cells of each Swiss class of intensity: weak, medium, strong.
    pub fn intensity_cells(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for (_, class) in self.values(Layer::Intensity, &Weights::equal(1)) {
            counts[class as usize - 1] += 1;
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: three rocks in a cell, one of them at rest in it; 29.9, 30 and 299 kJ.
    #[test]
    fn a_cell_counts_each_rock_once() {
        let frame =
            MapFrame { west_m: 100.0, south_m: 50.0, cell_m: 2.0, columns: 3, rows: 2, epsg: None };
        let mut maps = Maps::new(frame, MapState::default());
        for (total_j, height_m) in [(29.9e3, 0.5), (30e3, 0.0), (299e3, 2.0)] {
            let visits = [Visit { cell: 4, total_j, height_m }];
            maps.add(0, &visits, (StopKind::AtRest, [103.0, 53.0 - height_m, 7.0]));
        }
        let weights = Weights::equal(6);
        let value =
            |layer| maps.values(layer, &weights).find(|(cell, _)| *cell == 4).map(|(_, v)| v);
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

//! What all rocks say cell by cell: counts, largest values and percentiles.
//!
//! Memory grows with the cells that rocks pass, not with the rocks: percentiles come from counts over
//! [classes](super::classes) of equal ratio. Counts and largest values are the same in whatever order rocks arrive, so a
//! resumed run gives the same maps.

mod cell;

use super::rate::proportion;
use super::row::StopKind;
use crate::frequency::Weights;
use crate::simulation::CellPassage;
pub(super) use cell::MapCell;
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

    /// The cell nearest to a place: at the border of the terrain a rock lies on it with its centre beyond.
    fn nearest_cell(&self, [x, y, _]: [f64; 3]) -> u32 {
        let along = |way_m: f64, cells: u32| {
            ((way_m / self.cell_m).max(0.0) as u32).min(cells.saturating_sub(1))
        };
        along(y - self.south_m, self.rows) * self.columns + along(x - self.west_m, self.columns)
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.columns as usize * self.rows as usize
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
    /// Swiss intensity by the 95th percentile of total energy: 1 below 30 kJ, 2 from 30 to 300 kJ, 3 above.
    Intensity,
    /// Rocks that pass with 30 kJ or more, over all releases (–).
    ExceedsWeak,
    /// Rocks that pass with 300 kJ or more, over all releases (–).
    ExceedsMedium,
}

/// Limits of the Swiss classes of intensity (J): weak below, medium, strong from the second on.
pub const INTENSITY_J: [f64; 2] = [30e3, 300e3];

impl Layer {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Passages,
        Self::Reach,
        Self::Deposits,
        Self::EnergyMax,
        Self::EnergyP95,
        Self::HeightMax,
        Self::HeightP95,
        Self::Intensity,
        Self::ExceedsWeak,
        Self::ExceedsMedium,
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
            Self::ExceedsWeak => "exceeds_30_kj_probability",
            Self::ExceedsMedium => "exceeds_300_kj_probability",
        }
    }

    /// Name and unit of its values, as a GIS shows them; a pure number has no unit.
    pub fn in_words(self) -> (&'static str, &'static str) {
        match self {
            Self::Passages => ("Rocks that pass", ""),
            Self::Reach => ("Reach probability, conditional on release", ""),
            Self::Deposits => ("Rocks at rest", ""),
            Self::EnergyMax => ("Total energy, largest", "J"),
            Self::EnergyP95 => ("Total energy, 95th percentile", "J"),
            Self::HeightMax => ("Bounce height, largest", "m"),
            Self::HeightP95 => ("Bounce height, 95th percentile", "m"),
            Self::Intensity => {
                ("Intensity of the 95th percentile of energy, 1 weak 2 medium 3 strong", "")
            }
            Self::ExceedsWeak => ("Probability of 30 kJ or more, conditional on release", ""),
            Self::ExceedsMedium => ("Probability of 300 kJ or more, conditional on release", ""),
        }
    }

    fn of(self, cell: &MapCell, weights: &Weights) -> f64 {
        match self {
            Self::Passages => f64::from(cell.passages),
            Self::Reach if weights.are_equal() => {
                f64::from(cell.passages) / weights.all_rocks().max(1) as f64
            }
            Self::Reach => {
                let strata = cell.totals_j.rocks();
                proportion(weights, strata.map(|(stratum, n)| (stratum, n as usize))).share
            }
            Self::Deposits => f64::from(cell.deposits),
            Self::EnergyMax => cell.largest_j,
            // the middle of the highest class may lie above the largest value in it
            Self::EnergyP95 => {
                // of whole classes: with and without a frequency the maps of equal rocks are the same
                let classes = cell.totals_j.by_class();
                let found = classes.percentile(0.95, weights).min(cell.largest_j);
                within_class(found, cell.intensity(weights))
            }
            Self::HeightMax => cell.largest_m,
            Self::HeightP95 => cell.heights_m.percentile(0.95, weights).min(cell.largest_m),
            Self::Intensity => cell.intensity(weights),
            Self::ExceedsWeak => cell.above[0].share(weights),
            Self::ExceedsMedium => cell.above[1].share(weights),
        }
    }
}

/// An energy read from classes of values (J), moved into the class of intensity that counting has found: the rock whose energy it stands for is there.
fn within_class(energy_j: f64, intensity: f64) -> f64 {
    let [weak_j, medium_j] = INTENSITY_J;
    // rasters hold 32-bit numbers, which are to lie below a limit too
    let below = |limit_j: f64| f64::from((limit_j as f32).next_down());
    match intensity {
        class if class < 2.0 => energy_j.min(below(weak_j)),
        class if class < 3.0 => energy_j.clamp(weak_j, below(medium_j)),
        _ => energy_j.max(medium_j),
    }
}

/// All rocks so far, cell by cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Maps {
    /// Where the cells lie.
    pub frame: MapFrame,
    /// Energies (J) above which rocks are counted: those of [`INTENSITY_J`], then what else is asked for.
    above_j: Vec<f64>,
    /// Whether energies of return periods are asked for: then cells tell energies apart as well as there is room.
    is_fine: bool,
    cells: BTreeMap<u32, MapCell>,
}

/// What a resumed run needs of the maps before it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MapState(Vec<(u32, MapCell)>);

impl Maps {
    /// Goes on from what earlier rocks left; `energies_j` (J) are those whose frequency is asked for, none where nothing a year is.
    pub fn new(frame: MapFrame, energies_j: &[f64], state: MapState) -> Self {
        let mut above_j = INTENSITY_J.to_vec();
        above_j.extend(energies_j.iter().filter(|joule| !INTENSITY_J.contains(joule)));
        let is_fine = !energies_j.is_empty();
        Self { frame, above_j, is_fine, cells: state.0.into_iter().collect() }
    }

    /// Number of an energy (J) above which rocks are counted; none of one that was not asked for.
    pub(super) fn number_of(&self, joule: f64) -> Option<usize> {
        self.above_j.iter().position(|one| one.total_cmp(&joule).is_eq())
    }

    /// A cell, and the energies (J) above which its rocks are counted.
    fn known(&mut self, number: u32) -> (&mut MapCell, &[f64]) {
        let new = || MapCell::new(self.above_j.len(), self.is_fine);
        (self.cells.entry(number).or_insert_with(new), &self.above_j)
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
            self.known(number).0.join(&cell);
        }
    }

    /// Adds the cells of one rock of a stratum, and how and where it ended (map coordinates).
    pub fn add(
        &mut self,
        stratum: u16,
        passages: &[CellPassage],
        (stop, end_m): (StopKind, [f64; 3]),
    ) {
        for passage in passages {
            let (cell, above_j) = self.known(passage.cell);
            cell.passages += 1;
            cell.largest_j = cell.largest_j.max(passage.total_j);
            cell.largest_m = cell.largest_m.max(passage.height_m);
            cell.totals_j.add(passage.total_j, stratum);
            cell.heights_m.add(passage.height_m, stratum);
            for (rocks, limit) in cell.above.iter_mut().zip(above_j) {
                if passage.total_j >= *limit {
                    rocks.add(stratum, 1);
                }
            }
        }
        if stop == StopKind::AtRest {
            self.known(self.frame.nearest_cell(end_m)).0.deposits += 1;
        }
    }

    /// The cells that rocks pass, rising by number.
    pub(super) fn passed(&self) -> impl Iterator<Item = (u32, &MapCell)> + '_ {
        let came = self.cells.iter().filter(|(_, cell)| cell.passages > 0);
        came.map(|(number, cell)| (*number, cell))
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
    pub fn intensity_cells(&self, weights: &Weights) -> [usize; 3] {
        let mut counts = [0; 3];
        for (_, class) in self.values(Layer::Intensity, weights) {
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
        let mut maps = Maps::new(frame, &[], MapState::default());
        for (total_j, height_m) in [(29.9e3, 0.5), (30e3, 0.0), (299e3, 2.0)] {
            let passages = [CellPassage { cell: 4, total_j, height_m }];
            maps.add(0, &passages, (StopKind::AtRest, [103.0, 53.0 - height_m, 7.0]));
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
        assert_eq!(maps.intensity_cells(&weights), [1, 1, 0]);
        assert_eq!(value(Layer::ExceedsWeak), Some(2.0 / 6.0));
        assert_eq!(value(Layer::ExceedsMedium), Some(0.0));
    }

    /// Energies are read from classes of a ratio of 1.05, intensity is counted: near a limit the energy of a cell lies on the side that was counted.
    #[test]
    fn energy_and_intensity_of_a_cell_agree() {
        let frame =
            MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 1.0, columns: 1, rows: 1, epsg: None };
        for total_j in
            (0..200).flat_map(|k| [30e3, 300e3].map(|limit| limit * (0.96 + 4e-4 * f64::from(k))))
        {
            let mut maps = Maps::new(frame, &[], MapState::default());
            for k in 0..40 {
                let total_j = if k < 39 { total_j } else { 1e6 };
                let passage = CellPassage { cell: 0, total_j, height_m: 0.0 };
                maps.add(0, &[passage], (StopKind::LeftTerrain, [9.0; 3]));
            }
            let weights = Weights::equal(40);
            let [p95_j, class] = [Layer::EnergyP95, Layer::Intensity]
                .map(|layer| maps.values(layer, &weights).next().map_or(f64::NAN, |(_, v)| v));
            let of_p95 = 1.0
                + INTENSITY_J.iter().filter(|limit| p95_j as f32 >= **limit as f32).count() as f64;
            assert!(
                (of_p95 - class).abs() < 0.5 && (p95_j / total_j - 1.0).abs() < 0.03,
                "{total_j} {p95_j} {class}"
            );
        }
    }

    /// A rock that lies on the border of the terrain has its centre beyond it, and still counts where it lies.
    #[test]
    fn a_rock_at_rest_on_the_border_counts_in_its_cell() {
        let frame =
            MapFrame { west_m: 100.0, south_m: 50.0, cell_m: 2.0, columns: 3, rows: 2, epsg: None };
        let mut maps = Maps::new(frame, &[], MapState::default());
        for end_m in [[99.8, 51.0, 0.0], [106.2, 54.3, 0.0], [103.0, 49.9, 0.0], [103.0, 51.0, 0.0]]
        {
            maps.add(0, &[], (StopKind::AtRest, end_m));
        }
        let weights = Weights::equal(4);
        let found: Vec<(u32, f64)> = maps.values(Layer::Deposits, &weights).collect();
        assert_eq!(found, [(0, 1.0), (1, 2.0), (5, 1.0)]);
    }

    /// One wild rock among a hundred leaves the class where it was; the sixth makes it: P95 of 100 is the 95th.
    #[test]
    fn the_class_does_not_grow_with_the_largest() {
        let frame =
            MapFrame { west_m: 0.0, south_m: 0.0, cell_m: 1.0, columns: 1, rows: 1, epsg: None };
        for (wild, class) in [(0, 1.0), (1, 1.0), (5, 1.0), (6, 3.0)] {
            let mut maps = Maps::new(frame, &[], MapState::default());
            for k in 0..100 {
                let total_j = if k < wild { 1e6 } else { 1e3 };
                let passage = CellPassage { cell: 0, total_j, height_m: 0.0 };
                maps.add(0, &[passage], (StopKind::LeftTerrain, [9.0; 3]));
            }
            let weights = Weights::equal(100);
            let found = maps.values(Layer::Intensity, &weights).next().map(|(_, found)| found);
            assert_eq!(found, Some(class), "{wild} wild rocks");
        }
    }
}

//! What is known of one cell of the maps.

use super::super::classes::{Counts, FineCounts};
use super::super::rate::proportion;
use super::INTENSITY_J;
use crate::frequency::Weights;
use serde::{Deserialize, Serialize};

/// What is known of one cell.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "PackedCell", into = "PackedCell")]
pub(in crate::hazard) struct MapCell {
    pub(super) passages: u32,
    pub(super) deposits: u32,
    pub(super) largest_j: f64,
    pub(super) largest_m: f64,
    pub(super) totals_j: FineCounts,
    pub(super) heights_m: Counts,
    /// Rocks with a total energy of at least each of [`Maps::above_j`](super::Maps): counted, as classes of values would tell them to 5 % of
    /// the energy only.
    pub(super) above: Vec<StratumCounts>,
}

/// A cell on the disk: in the order of its fields, without their names, which would be most of it.
type PackedCell = (u32, u32, f64, f64, FineCounts, Counts, Vec<StratumCounts>);

impl From<PackedCell> for MapCell {
    fn from(packed: PackedCell) -> Self {
        let (passages, deposits, largest_j, largest_m, totals_j, heights_m, above) = packed;
        Self { passages, deposits, largest_j, largest_m, totals_j, heights_m, above }
    }
}

impl From<MapCell> for PackedCell {
    fn from(cell: MapCell) -> Self {
        let MapCell { passages, deposits, largest_j, largest_m, totals_j, heights_m, above } = cell;
        (passages, deposits, largest_j, largest_m, totals_j, heights_m, above)
    }
}

impl MapCell {
    /// Of which nothing is known yet, with so many energies to count above; in narrow classes where energies of return periods
    /// are read from them.
    pub(super) fn new(energies: usize, is_fine: bool) -> Self {
        let totals_j = if is_fine { FineCounts::in_parts() } else { FineCounts::default() };
        Self { above: vec![StratumCounts::default(); energies], totals_j, ..Self::default() }
    }

    /// Total energies of the rocks that pass.
    pub(in crate::hazard) fn energies(&self) -> &FineCounts {
        &self.totals_j
    }

    /// Rocks by stratum that pass with at least one of the energies, given by its number.
    pub(in crate::hazard) fn above(&self, energy: usize) -> &[(u16, u32)] {
        self.above.get(energy).map_or(&[], |rocks| &rocks.0)
    }

    pub(super) fn join(&mut self, other: &Self) {
        self.passages += other.passages;
        self.deposits += other.deposits;
        self.largest_j = self.largest_j.max(other.largest_j);
        self.largest_m = self.largest_m.max(other.largest_m);
        self.totals_j.join(&other.totals_j);
        self.heights_m.join(&other.heights_m);
        for (rocks, others) in self.above.iter_mut().zip(&other.above) {
            for &(stratum, count) in &others.0 {
                rocks.add(stratum, count);
            }
        }
    }

    /// Swiss class of the 95th percentile of energy, counted and not read from classes of values: it reaches a limit when
    /// less than 95 % of all weight stays below. Of `n` rocks of equal weight at least `n − ⌈0.95 n⌉ + 1` must reach it
    /// then. The largest would grow with the number of releases.
    pub(super) fn intensity(&self, weights: &Weights) -> f64 {
        let reaches = |above: &&StratumCounts| {
            if weights.are_equal() {
                let rank = (0.95 * f64::from(self.passages)).ceil().max(1.0);
                let needed = (f64::from(self.passages) - rank + 1.0).max(1.0);
                return f64::from(above.rocks()) >= needed;
            }
            let strata = self.totals_j.rocks();
            let all = strata.map(|(s, n)| weights.of_stratum(usize::from(s)) * f64::from(n));
            let all: f64 = all.sum();
            all - above.weight(weights) < 0.95 * all
        };
        1.0 + self.above.iter().take(INTENSITY_J.len()).filter(reaches).count() as f64
    }
}

/// Rocks of each stratum, by rising stratum.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct StratumCounts(Vec<(u16, u32)>);

impl StratumCounts {
    pub(super) fn add(&mut self, stratum: u16, count: u32) {
        match self.0.binary_search_by_key(&stratum, |(stratum, _)| *stratum) {
            Ok(at) => self.0[at].1 += count,
            Err(at) => self.0.insert(at, (stratum, count)),
        }
    }

    fn rocks(&self) -> u32 {
        self.0.iter().map(|(_, count)| count).sum()
    }

    fn weight(&self, weights: &Weights) -> f64 {
        let each = self.0.iter();
        each.map(|&(s, n)| weights.of_stratum(usize::from(s)) * f64::from(n)).sum()
    }

    /// What they stand for, over what all releases stand for.
    pub(super) fn share(&self, weights: &Weights) -> f64 {
        if weights.are_equal() {
            return f64::from(self.rocks()) / weights.all_rocks().max(1) as f64;
        }
        proportion(weights, self.0.iter().map(|&(stratum, count)| (stratum, count as usize))).share
    }
}

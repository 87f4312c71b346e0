//! The cells of the maps that a rock passes, with its largest energy and height in each.
//!
//! Cells are numbered in plan view, whatever the height of the rock. Map values over many rocks
//! (how many passed, percentiles of energy and height) are computed elsewhere from these passages.
//! Here each rock has one entry per cell, however often it comes back.

use super::contact_heights::StepHeights;
use super::heights::Heights;
use super::passages::{Passage, Passages};
use super::rock_geometry::{RockGeometry, RockInstant, hermite_motion, time_fraction};
use crate::plan::MapGrid;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::way::cells_under;

/// One rock in one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellPassage {
    /// The cell's number in the grid of the maps.
    pub cell: u32,
    /// Largest sum of translational and rotational energy in the cell (J).
    pub total_j: f64,
    /// Largest vertical distance from the ground below to the lowest point of the rock in the cell
    /// (m), 0 or more.
    pub height_m: f64,
}

/// The cells of one rock so far. Memory grows with the cells passed, not with the size of the grid.
#[derive(Debug)]
pub(super) struct CellPassages<'a> {
    /// None where the plan keeps no maps: then nothing below costs anything.
    cells: Option<&'a MapGrid>,
    pub(super) found: Passages<CellPassage>,
}

impl<'a> CellPassages<'a> {
    pub(super) fn of(cells: Option<&'a MapGrid>) -> Self {
        Self { cells, found: Passages::new() }
    }

    /// Records the cells below a flight.
    ///
    /// The speed along a parabola has no maximum inside: the largest is at an end of its part in a
    /// cell.
    pub(super) fn record_flight(&mut self, heights: &Heights) {
        let Some(cells) = self.cells else { return };
        let Heights { terrain, geometry, flight } = *heights;
        let rotational_j = geometry.rotational_j(&flight.at(0.0));
        // m |v|²/2 of the parabola, plus the rotational energy, which is constant in flight
        let total_j = |t: f64| {
            0.5 * geometry.rock.mass_kg() * flight.path.velocity(t).norm_squared() + rotational_j
        };
        let [from, to] = [0.0, flight.duration_s].map(|t| flight.path.centre(t));
        // in plan view a flight is straight and uniform: equal fractions of distance and of time
        for_each_cell(cells, [&from, &to], |cell, s0, s1| {
            let [t0, t1] = [s0, s1].map(|share| share * flight.duration_s);
            let total_j = total_j(t0).max(total_j(t1));
            let known_m = self.found.known_m(cell);
            let top = heights.largest([t0, t1], known_m.unwrap_or(f64::NEG_INFINITY));
            // without ground below there is no height; a rock that has fallen through a hole of the
            // mesh passes no cell any more
            let is_lost = || terrain.is_under_slope(&flight.path.centre(0.5 * (t0 + t1)));
            if top.is_none() && known_m.is_none() && is_lost() {
                return;
            }
            let height_m = top.map_or(0.0, |top| top.height_m.max(0.0));
            self.found.add(CellPassage { cell, total_j, height_m });
        });
    }

    /// Whether cells are recorded.
    pub(super) fn are_recorded(&self) -> bool {
        self.cells.is_some()
    }

    /// Records the cells of a step in contact, with the energies at which the step enters and
    /// leaves each.
    pub(super) fn record_step(
        &mut self,
        (terrain, geometry): (&Terrain, &RockGeometry),
        ends: [&RockInstant; 2],
        heights: &StepHeights,
    ) {
        let Some(cells) = self.cells else { return };
        let [from, to] = ends.map(|end| &end.motion);
        // velocity is linear within the step: its square has no maximum inside either
        let total_j = |s: f64| {
            let at = RockInstant::interpolated(ends, s);
            at.motion.translational_j(&geometry.rock) + geometry.rotational_j(&at)
        };
        for_each_cell(cells, [&from.position_m, &to.position_m], |cell, entered, left| {
            let [s0, s1] = [entered, left].map(|share| time_fraction([from, to], share));
            // tested once per cell, where the step enters it: a rock below the mesh may be held by
            // it too
            let known_m = self.found.known_m(cell);
            if known_m.is_none() && terrain.is_under_slope(&hermite_motion(from, to, s1).position_m)
            {
                return;
            }
            let total_j = total_j(s0).max(total_j(s1));
            let height_m = heights.largest_m([entered, left], known_m.unwrap_or(0.0));
            self.found.add(CellPassage { cell, total_j, height_m });
        });
    }
}

impl Passage for CellPassage {
    fn place_number(&self) -> u32 {
        self.cell
    }

    fn height_m(&self) -> f64 {
        self.height_m
    }

    fn merge(&mut self, other: &Self) {
        self.total_j = self.total_j.max(other.total_j);
        self.height_m = self.height_m.max(other.height_m);
    }
}

/// Calls `pass` with every cell under the straight line between two positions, and with the
/// fractions of the line at which the cell is entered and left.
fn for_each_cell(cells: &MapGrid, ends: [&Vec3; 2], mut pass: impl FnMut(u32, f64, f64)) {
    cells_under(ends.map(|end| cells.place(end.x, end.y)), |[column, row], entered, leaves| {
        if let Some(cell) = cells.cell(column, row) {
            pass(cell, entered, leaves);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELLS: MapGrid =
        MapGrid { west_m: -10.0, south_m: 5.0, cell_m: 2.0, columns: 7, rows: 4 };

    fn passed_cells(from: [f64; 2], to: [f64; 2]) -> Vec<(u32, f64, f64)> {
        let mut cells = Vec::new();
        let [from, to] = [from, to].map(|[x, y]| Vec3::new(x, y, 0.0));
        for_each_cell(&CELLS, [&from, &to], |cell, s0, s1| cells.push((cell, s0, s1)));
        cells
    }

    /// By hand: from (−9, 6) to (−3, 9) the cells 0, 1, 8, 9, 10 and the corner of 17.
    #[test]
    fn a_way_is_cut_at_the_edges_of_cells() {
        let found = passed_cells([-9.0, 6.0], [-3.0, 9.0]);
        let cells: Vec<u32> = found.iter().map(|(cell, ..)| *cell).collect();
        assert_eq!(cells, [0, 1, 8, 9, 10, 17]);
        let cuts: Vec<f64> = found.iter().map(|(_, _, s1)| *s1).collect();
        for (cut, exact) in cuts.iter().zip([1.0 / 6.0, 1.0 / 3.0, 0.5, 5.0 / 6.0, 1.0, 1.0]) {
            // one division of numbers near 10
            assert!((cut - exact).abs() < 1e-14, "{cuts:?}");
        }
    }

    /// Whatever its direction, a line is covered once and without gaps; what lies outside the grid
    /// has no cell.
    #[test]
    fn parts_join_without_gaps() {
        for k in 0..500 {
            let turn = f64::from(k) * 0.37;
            let from = [-3.0 + turn.cos() * 4.0, 9.0 + turn.sin() * 3.0];
            let to = [-3.0 - (2.1 * turn).cos() * 4.0, 9.0 - (1.3 * turn).sin() * 3.0];
            let found = passed_cells(from, to);
            assert!(found.windows(2).all(|pair| (pair[0].2 - pair[1].1).abs() < 1e-15));
            let whole: f64 = found.iter().map(|(_, s0, s1)| s1 - s0).sum();
            assert!((whole - 1.0).abs() < 1e-12, "{k}: {found:?}");
        }
        assert!(passed_cells([100.0, 100.0], [101.0, 120.0]).is_empty());
        assert_eq!(passed_cells([-9.0, 6.0], [-9.0, 6.0]), [(0, 0.0, 1.0)]);
    }
}

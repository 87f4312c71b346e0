//! Which cells of the maps a rock passes, with its largest energy and height in each.
//!
//! Cells are numbered in plan view, whatever the rock's height over them. What a map shows of many
//! rocks (how many passed, percentiles of energy and height) is made elsewhere from these passages;
//! here each rock has one entry a cell, however often it comes back.

use super::form::{Form, RockInstant, between};
use super::passages::{Passage, Passages};
use crate::flight::Parabola;
use crate::plan::MapGrid;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// One rock in one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellPassage {
    /// The cell's number in the grid of the maps.
    pub cell: u32,
    /// Largest sum of translational and rotational energy in the cell (J).
    pub total_j: f64,
    /// Largest vertical distance from the ground below to the lowest point of the rock in the cell (m), 0 in contact.
    pub height_m: f64,
}

/// The cells of one rock so far.
/// Memory grows with the cells passed, not with the size of the grid.
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

    /// Notes the cells below a flight of `dt` (s).
    ///
    /// The speed along a parabola has no largest value inside: the ends of its part in a cell hold it exactly. The
    /// height is taken at both ends and in the middle of that part.
    pub(super) fn fly(
        &mut self,
        (terrain, form): (&Terrain, &Form),
        flight: &Parabola,
        dt: f64,
        at: impl Fn(f64) -> RockInstant,
    ) {
        let Some(cells) = self.cells else { return };
        let from = at(0.0);
        let rotational_j = form.rotational_j(&from);
        let from = &from.motion;
        // m |v|²/2 of the parabola, plus the rotational energy, which no flight changes
        let total_j =
            |t: f64| 0.5 * form.rock.mass_kg() * flight.velocity(t).norm_squared() + rotational_j;
        // lowest point of the rock over the ground below; where there is no ground there is no
        // height
        let height_m = |t: f64| {
            let centre = flight.centre(t);
            let ground = terrain.ground_under(centre.x, centre.y, centre.z);
            ground.map(|ground| (centre.z - form.below_m(&at(t)) - ground).max(0.0))
        };
        let end = flight.centre(dt);
        // in plan view the flight is straight and even, so a share of the way is the same share of
        // the time
        walk(cells, [&from.position_m, &end], |cell, s0, s1| {
            let (t0, t1) = (s0 * dt, s1 * dt);
            let middle = 0.5 * (t0 + t1);
            let heights_m = [t0, middle, t1].map(height_m);
            // fallen through a hole of the mesh, it passes no cell any more
            let has_ground = heights_m.iter().any(Option::is_some);
            if !has_ground && terrain.is_under_slope(&flight.centre(middle)) {
                return;
            }
            let height_m = heights_m.into_iter().flatten().fold(0.0, f64::max);
            self.found.add(CellPassage { cell, total_j: total_j(t0).max(total_j(t1)), height_m });
        });
    }

    /// Notes the cells of a step in contact, which are shorter than cells: its ends hold what it has.
    pub(super) fn step(&mut self, (terrain, form): (&Terrain, &Form), ends: [&RockInstant; 2]) {
        let Some(cells) = self.cells else { return };
        let [from, to] = ends.map(|end| &end.motion);
        // velocity linear within the step: its square has no largest value inside either
        let total_j = |s: f64| {
            let at = RockInstant::between(ends, s);
            at.motion.translational_j(&form.rock) + form.rotational_j(&at)
        };
        walk(cells, [&from.position_m, &to.position_m], |cell, s0, s1| {
            // looked for once a cell, where the step comes into it: from below the mesh holds a rock too
            let is_new = self.found.last().is_none_or(|last| last.cell != cell);
            if is_new && terrain.is_under_slope(&between(from, to, s1).position_m) {
                return;
            }
            let total_j = total_j(s0).max(total_j(s1));
            self.found.add(CellPassage { cell, total_j, height_m: 0.0 });
        });
    }
}

impl Passage for CellPassage {
    fn place(&self) -> u32 {
        self.cell
    }

    fn join(&mut self, other: &Self) {
        self.total_j = self.total_j.max(other.total_j);
        self.height_m = self.height_m.max(other.height_m);
    }
}

/// Calls `pass` with every cell under the straight way between two places and the shares of the way at which it is
/// entered and left (Amanatides and Woo 1987).
///
/// Steps from edge to edge, never cell by cell with a test: it visits exactly the cells under the
/// way, and the parts add up to 1.
fn walk(cells: &MapGrid, ends: [&Vec3; 2], mut pass: impl FnMut(u32, f64, f64)) {
    let [from, to] = ends.map(|end| cells.place(end.x, end.y));
    let mut at = from.map(|x| x.floor() as i64);
    let last = to.map(|x| x.floor() as i64);
    let way = [to[0] - from[0], to[1] - from[1]];
    let step = way.map(|x| if x > 0.0 { 1 } else { -1 });
    // share of the way at which the next line of the grid is met along one axis
    let edge = |axis: usize, at: i64| {
        let edge = if way[axis] > 0.0 { at + 1 } else { at };
        if way[axis] == 0.0 { f64::INFINITY } else { (edge as f64 - from[axis]) / way[axis] }
    };
    // so many edges lie between first and last cell: counting them ends the walk, not a comparison
    // of rounded numbers
    let mut left = (last[0] - at[0]).unsigned_abs() + (last[1] - at[1]).unsigned_abs();
    let mut entered = 0.0;
    loop {
        let next = [edge(0, at[0]), edge(1, at[1])];
        // an axis that has arrived is not stepped along any more, whatever rounding says
        let axis = usize::from(at[0] == last[0] || at[1] != last[1] && next[1] < next[0]);
        let leaves = if left == 0 { 1.0 } else { next[axis].clamp(entered, 1.0) };
        if let Some(cell) = cells.cell(at[0], at[1]) {
            pass(cell, entered, leaves);
        }
        if left == 0 {
            return;
        }
        at[axis] += step[axis];
        entered = leaves;
        left -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELLS: MapGrid =
        MapGrid { west_m: -10.0, south_m: 5.0, cell_m: 2.0, columns: 7, rows: 4 };

    fn walked(from: [f64; 2], to: [f64; 2]) -> Vec<(u32, f64, f64)> {
        let mut cells = Vec::new();
        let [from, to] = [from, to].map(|[x, y]| Vec3::new(x, y, 0.0));
        walk(&CELLS, [&from, &to], |cell, s0, s1| cells.push((cell, s0, s1)));
        cells
    }

    /// By hand: from (−9, 6) to (−3, 9) the cells 0, 1, 8, 9, 10 and the corner of 17.
    #[test]
    fn a_way_is_cut_at_the_edges_of_cells() {
        let found = walked([-9.0, 6.0], [-3.0, 9.0]);
        let cells: Vec<u32> = found.iter().map(|(cell, ..)| *cell).collect();
        assert_eq!(cells, [0, 1, 8, 9, 10, 17]);
        let cuts: Vec<f64> = found.iter().map(|(_, _, s1)| *s1).collect();
        for (cut, exact) in cuts.iter().zip([1.0 / 6.0, 1.0 / 3.0, 0.5, 5.0 / 6.0, 1.0, 1.0]) {
            // one division of numbers near 10
            assert!((cut - exact).abs() < 1e-14, "{cuts:?}");
        }
    }

    /// However it runs, a way is covered once, without gaps, and what lies outside has no cell.
    #[test]
    fn parts_join_without_gaps() {
        for k in 0..500 {
            let turn = f64::from(k) * 0.37;
            let from = [-3.0 + turn.cos() * 4.0, 9.0 + turn.sin() * 3.0];
            let to = [-3.0 - (2.1 * turn).cos() * 4.0, 9.0 - (1.3 * turn).sin() * 3.0];
            let found = walked(from, to);
            assert!(found.windows(2).all(|pair| (pair[0].2 - pair[1].1).abs() < 1e-15));
            let whole: f64 = found.iter().map(|(_, s0, s1)| s1 - s0).sum();
            assert!((whole - 1.0).abs() < 1e-12, "{k}: {found:?}");
        }
        assert!(walked([100.0, 100.0], [101.0, 120.0]).is_empty());
        assert_eq!(walked([-9.0, 6.0], [-9.0, 6.0]), [(0, 0.0, 1.0)]);
    }
}

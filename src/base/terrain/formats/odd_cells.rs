//! Cells of an elevation model that are most likely no ground.

use crate::parallel;
use crate::terrain::grid::Grid;

/// Share of cells at 0 m (–) above which they are more than a slip of a few.
const MANY: f64 = 1e-3;
/// Height of the lowest other cell (m) above which the zeros are no ground: no slope falls so far within a cell.
const FAR_ABOVE_M: f64 = 50.0;

/// What to say of cells that are exactly 0 m high where all others lie far above: most likely they have no data, and the file
/// does not say so.
fn zeros_for_no_data(grid: &Grid) -> Option<String> {
    let heights = || grid.values.iter().flatten().copied();
    let zeros = heights().filter(|height| height.abs() <= 0.0).count();
    let all = heights().count();
    let others = heights().filter(|height| height.abs() > 0.0);
    let lowest_m = others.fold(f64::INFINITY, f64::min);
    let is_odd = zeros < all && zeros as f64 > MANY * all as f64 && lowest_m > FAR_ABOVE_M;
    is_odd.then(|| {
        format!(
            "{zeros} of {all} cells are exactly 0 m high and all others above {lowest_m:.1} m: cells without data? then declare 0 as no data (gdal_translate -a_nodata 0)"
        )
    })
}

/// A cell that stands out from all its neighbours by more than this (m), and by more than so many of its sides (–), is a spike or a
/// pit: no single cell of ground does.
const OUT: (f64, f64) = (20.0, 10.0);
/// Neighbours with data that it takes to tell.
const FEWEST: usize = 3;

/// What to say of a grid's cells.
pub(super) fn warnings(grid: &Grid) -> impl Iterator<Item = String> + use<> {
    zeros_for_no_data(grid).into_iter().chain(spikes(grid))
}

/// What to say of single cells far above or below all around them.
fn spikes(grid: &Grid) -> Option<String> {
    let out_m = OUT.0.max(OUT.1 * grid.cell_m);
    let found = parallel::filter(grid.values.len(), |k| stands_out_m(grid, k as usize) > out_m);
    let first = *found.first()? as usize;
    let [x, y] = grid.centre_m(first % grid.columns, first / grid.columns);
    Some(format!(
        "cells that stand more than {out_m} m above or below all around them: {}, the first at ({x}, {y}); errors of measurement, or trees and masts? rocks meet them as ground",
        found.len()
    ))
}

/// How far a cell lies above the highest or below the lowest of its neighbours (m); 0 where it does not, or few are known.
fn stands_out_m(grid: &Grid, k: usize) -> f64 {
    let Some(own) = grid.values[k] else { return 0.0 };
    let (column, row) = (k % grid.columns, k / grid.columns);
    let (mut low, mut high, mut known) = (f64::INFINITY, f64::NEG_INFINITY, 0);
    for y in row.saturating_sub(1)..(row + 2).min(grid.rows) {
        for x in column.saturating_sub(1)..(column + 2).min(grid.columns) {
            if let Some(height) = grid.value(x, y).filter(|_| (x, y) != (column, row)) {
                (low, high, known) = (low.min(height), high.max(height), known + 1);
            }
        }
    }
    if known < FEWEST { 0.0 } else { (own - high).max(low - own).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope(height: impl Fn(usize, usize) -> f64) -> Grid {
        let values = (0..20 * 30).map(|k| Some(height(k % 30, k / 30))).collect();
        Grid { columns: 30, rows: 20, corner_m: [100.0, 200.0], cell_m: 2.0, values }
    }

    /// On a slope of 80° no cell stands out; one spike and one pit do, and are found at their places.
    #[test]
    fn single_cells_far_from_all_others_are_named() {
        let steep = |x: usize, _: usize| 11.3 * x as f64 + 500.0;
        assert_eq!(warnings(&slope(steep)).count(), 0);
        let odd = |x: usize, y: usize| match (x, y) {
            (7, 4) => 900.0,
            (12, 9) => 400.0,
            _ => steep(x, y),
        };
        let said: Vec<String> = warnings(&slope(odd)).collect();
        assert!(said.len() == 1 && said[0].contains("all around them: 2, the first"), "{said:?}");
        assert!(said[0].contains("(115, 231)"), "{said:?}");
    }
}

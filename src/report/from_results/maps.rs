//! The maps of the report, read back from their grids.

use super::super::model::CellMap;
use crate::error::Result;
use crate::hazard::Layer;
use crate::output::Results;
use std::collections::BTreeMap;

/// The maps; none where the scene asks for none.
pub(super) fn maps(results: &Results) -> Result<Option<CellMap>> {
    let Some(frame) = results.summary.maps else { return Ok(None) };
    let read = |layer: Layer| -> Result<Vec<(u32, f64)>> {
        let Some(grid) = results.map(layer)? else { return Ok(Vec::new()) };
        let mut cells = Vec::new();
        for row in 0..grid.rows {
            for column in 0..grid.columns {
                if let Some(value) = grid.value(column, grid.rows - 1 - row) {
                    cells.push(((row * grid.columns + column) as u32, value));
                }
            }
        }
        Ok(cells)
    };
    let some = |cells: Vec<(u32, f64)>| cells.into_iter().filter(|(_, v)| *v > 0.0).collect();
    let intensity = read(Layer::Intensity)?;
    let of_class = |class: u8| intensity.iter().filter(|(_, found)| *found as u8 == class).count();
    let intensity_cells = [1, 2, 3].map(of_class);
    let times = frame.columns.max(frame.rows).div_ceil(MOST_DRAWN);
    let drawn = |cells: Vec<(u32, f64)>| coarser(cells, frame.columns, times);
    Ok(Some(CellMap {
        west_m: frame.west_m,
        south_m: frame.south_m,
        cell_m: frame.cell_m * f64::from(times),
        columns: frame.columns.div_ceil(times),
        reach: drawn(read(Layer::Reach)?),
        intensity_cells,
        intensity: drawn(intensity),
        energy_j: drawn(read(Layer::EnergyP95)?),
        height_m: drawn(read(Layer::HeightP95)?),
        deposits: drawn(some(read(Layer::Deposits)?)),
        exceeds: drawn(some(read(Layer::ExceedsWeak)?)),
    }))
}

/// Most cells along a side of a drawn map: no print shows more, and a page with each of millions weighs tens of megabytes.
const MOST_DRAWN: u32 = 400;

/// Cells joined so many times so many; each takes the largest value of those in it.
fn coarser(cells: Vec<(u32, f64)>, columns: u32, times: u32) -> Vec<(u32, f64)> {
    if times < 2 {
        return cells;
    }
    let wide = columns.div_ceil(times);
    let mut joined: BTreeMap<u32, f64> = BTreeMap::new();
    for (cell, value) in cells {
        let (column, row) = (cell % columns / times, cell / columns / times);
        let largest = joined.entry(row * wide + column).or_insert(value);
        *largest = largest.max(value);
    }
    joined.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::coarser;

    /// By hand: 5 columns, 3 rows, joined two by two.
    #[test]
    fn joined_cells_take_the_largest_value() {
        let cells = vec![(0, 1.0), (6, 3.0), (4, 2.0), (14, 5.0)];
        assert_eq!(coarser(cells.clone(), 5, 2), [(0, 3.0), (2, 2.0), (5, 5.0)]);
        assert_eq!(coarser(cells.clone(), 5, 1), cells);
    }
}

//! The maps of the report, read back from their grids.

use super::super::model::{CellMap, LevelCells, YearCells};
use super::super::profile::NEEDS;
use crate::error::Result;
use crate::hazard::{Layer, Matrix, file_above, file_of_period};
use crate::math;
use crate::output::Results;
use crate::terrain::grid::Grid;
use std::collections::BTreeMap;

/// The maps; none where the scene asks for none.
pub(super) fn maps(results: &Results) -> Result<Option<CellMap>> {
    let Some(frame) = results.summary.maps else { return Ok(None) };
    let read = |layer: Layer| -> Result<Vec<(u32, f64)>> {
        Ok(results.map(layer)?.map_or(Vec::new(), |grid| cells_of(&grid)))
    };
    let some = |cells: Vec<(u32, f64)>| cells.into_iter().filter(|(_, v)| *v > 0.0).collect();
    let intensity = read(Layer::Intensity)?;
    let of_class = |class: u8| intensity.iter().filter(|(_, found)| *found as u8 == class).count();
    let intensity_cells = [1, 2, 3].map(of_class);
    let passages = read(Layer::Passages)?;
    let needs = NEEDS as f64;
    let few_cells = passages.iter().filter(|(_, rocks)| *rocks > 0.0 && *rocks < needs).count();
    let times = frame.columns.max(frame.rows).div_ceil(MOST_DRAWN);
    let drawn = |cells: Vec<(u32, f64)>| coarser(cells, frame.columns, times);
    Ok(Some(CellMap {
        west_m: frame.west_m,
        south_m: frame.south_m,
        cell_m: frame.cell_m * f64::from(times),
        joined: times,
        columns: frame.columns.div_ceil(times),
        reach: drawn(read(Layer::Reach)?),
        intensity_cells,
        few_cells,
        open: results.summary.open_on_maps,
        intensity: drawn(intensity),
        energy_j: drawn(read(Layer::EnergyP95)?),
        height_m: drawn(read(Layer::HeightP95)?),
        deposits: drawn(some(read(Layer::Deposits)?)),
        exceeds: drawn(some(read(Layer::ExceedsWeak)?)),
    }))
}

/// Maps of the largest energy and of the return period nearest to 300 years asked for; none where nothing is asked of a
/// year.
pub(super) fn of_year(results: &Results) -> Result<Option<YearCells>> {
    let asked = &results.summary.asked;
    let (Some(frame), Some(frequency), Some(_)) =
        (results.summary.maps, &asked.frequency, &results.summary.annual)
    else {
        return Ok(None);
    };
    let periods = frequency.return_periods_years();
    let from_300 = |years: &&f64| math::ln(**years / 300.0).abs();
    let nearest = periods.iter().min_by(|a, b| from_300(a).total_cmp(&from_300(b)));
    let (Some(&energy_j), Some(&years)) = (frequency.energies_j().last(), nearest) else {
        return Ok(None);
    };
    let times = frame.columns.max(frame.rows).div_ceil(MOST_DRAWN);
    let read = |name: &str| -> Result<Option<Vec<(u32, f64)>>> {
        let cells = results.year_map(name)?.map(|grid| cells_of(&grid));
        Ok(cells.map(|cells| coarser(cells, frame.columns, times)))
    };
    let above_0 = |cells: Vec<(u32, f64)>| -> Vec<(u32, f64)> {
        cells.into_iter().filter(|(_, value)| *value > 0.0).collect()
    };
    let above = file_above(energy_j);
    let Some(frequencies) = read(&above)?.map(above_0) else { return Ok(None) };
    let slopes = read(&format!("{above}_by_exponent"))?;
    let levels = match &asked.matrix {
        Some(matrix) => read(Matrix::FILE)?.map(|cells| LevelCells {
            name: matrix.name.clone(),
            source: matrix.source.clone(),
            known: matrix.known_levels(),
            cells,
        }),
        None => None,
    };
    Ok(Some(YearCells {
        energy_j,
        by_exponent: slopes.map(|slopes| over(&slopes, &frequencies)),
        frequencies,
        return_periods_years: periods.to_vec(),
        years,
        energies_j: read(&file_of_period(years))?.map(above_0).unwrap_or_default(),
        levels,
    }))
}

/// Values over others of the same cells, both by rising cell.
fn over(values: &[(u32, f64)], of: &[(u32, f64)]) -> Vec<(u32, f64)> {
    let ratio = |&(cell, of): &(u32, f64)| {
        let at = values.binary_search_by_key(&cell, |(cell, _)| *cell).ok()?;
        Some((cell, values[at].1 / of))
    };
    of.iter().filter_map(ratio).collect()
}

/// Cells that hold a value, rising from the south-western.
fn cells_of(grid: &Grid) -> Vec<(u32, f64)> {
    let mut cells = Vec::new();
    for row in 0..grid.rows {
        for column in 0..grid.columns {
            if let Some(value) = grid.value(column, grid.rows - 1 - row) {
                cells.push(((row * grid.columns + column) as u32, value));
            }
        }
    }
    cells
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

//! Lines and maps of the report, gathered from their result files.

use super::super::input::{CellMap, Line, LinePoint, Quantile, Quantity, Table};
use super::{band, estimate, of_percentile, statistics_table};
use crate::error::Result;
use crate::hazard::{self, Layer, LineQuantity, PERCENTS, Sample};
use crate::output::Results;
use crate::terrain::grid::Grid;
use std::collections::BTreeMap;

/// Quantities of a line's table: name, and the quantity of a release with the same unit.
const TABLED: [(LineQuantity, &str, Quantity); 7] = [
    (LineQuantity::Speed, "Speed", Quantity::Speed),
    (LineQuantity::Translational, "Translational energy", Quantity::Translational),
    (LineQuantity::Rotational, "Rotational energy", Quantity::Rotational),
    (LineQuantity::Total, "Total energy", Quantity::Total),
    (LineQuantity::Height, "Height, vertical", Quantity::Height),
    (LineQuantity::HeightNormal, "Height, normal to slope", Quantity::Height),
    (LineQuantity::Descent, "Descent of the path", Quantity::ReachAngle),
];

/// The lines of the scene: other places of barriers stand with the barriers.
fn shown(results: &Results) -> impl Iterator<Item = &hazard::Line> {
    results.lines.iter().filter(|line| !line.info.of_barrier)
}

/// All lines with their first crossings.
pub(super) fn lines(results: &Results) -> Result<Vec<Line>> {
    let releases = results.hazard.rocks();
    let mut lines: Vec<Line> = shown(results).map(|line| empty(line, releases)).collect();
    for row in results.crossings()? {
        let row = row?;
        if let Some(line) = lines.iter_mut().find(|line| line.name == row.line) {
            line.crossings.push(LinePoint {
                along_m: row.along_m,
                height_m: row.height_m,
                total_j: row.total_j(),
            });
        }
    }
    Ok(lines)
}

fn empty(line: &hazard::Line, releases: usize) -> Line {
    let reach = line.reach(releases);
    let (energy, height) = (line.sample(LineQuantity::Total), line.sample(LineQuantity::Height));
    Line {
        name: line.info.name.clone(),
        length_m: line.info.length_m,
        releases,
        reach: estimate(reach.share, Some(reach.low_95), Some(reach.high_95)),
        crossing_again: line.crossing_again(),
        crossings: Vec::new(),
        energy_quantiles: quantiles(&energy),
        height_quantiles: quantiles(&height),
        energy_exceedance: band(&energy.exceedance()),
        height_exceedance: band(&height.exceedance()),
    }
}

fn quantiles(sample: &Sample) -> Vec<Quantile> {
    let one = |percent: &u8| {
        let probability = f64::from(*percent) / 100.0;
        let found = sample.percentile(probability)?;
        Some(Quantile { probability, at: of_percentile(&found) })
    };
    PERCENTS.iter().filter_map(one).collect()
}

/// One table a line.
pub(super) fn tables(results: &Results) -> Vec<Table> {
    let releases = results.hazard.rocks();
    let table = |line: &hazard::Line| {
        let reach = line.reach(releases);
        let percent = |share: f64| format!("{:.2} %", 100.0 * share);
        let note = format!(
            "{} of {releases} releases cross: reach probability {} ({} to {}, conditional on release); {} cross more than once. Values at the first crossing.",
            reach.count,
            percent(reach.share),
            percent(reach.low_95),
            percent(reach.high_95),
            line.crossing_again()
        );
        let rows = TABLED.map(|(quantity, name, like)| (name, like, line.sample(quantity)));
        statistics_table(&format!("Evaluation line “{}”", line.info.name), note, &rows)
    };
    shown(results).map(table).collect()
}

/// The maps, read back from their grids.
pub(super) fn maps(results: &Results) -> Result<Option<CellMap>> {
    let Some(frame) = results.summary.maps else { return Ok(None) };
    let read = |layer: Layer| -> Result<Vec<(u32, f64)>> {
        let path = results.dir.join("maps").join(layer.file()).with_extension("asc");
        let grid = Grid::read(&path)?;
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

//! The maps of the report, read back from their grids.

use super::super::input::CellMap;
use crate::error::Result;
use crate::hazard::Layer;
use crate::output::Results;
use crate::terrain::grid::Grid;

/// The maps; none where the scene asks for none.
pub(super) fn maps(results: &Results) -> Result<Option<CellMap>> {
    let Some(frame) = results.summary.maps else { return Ok(None) };
    let read = |layer: Layer| -> Result<Vec<(u32, f64)>> {
        let path = results.dir.join("maps").join(layer.file()).with_extension("asc");
        // results of an earlier version lack the newer layers
        if !path.exists() {
            return Ok(Vec::new());
        }
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
    let some = |cells: Vec<(u32, f64)>| cells.into_iter().filter(|(_, v)| *v > 0.0).collect();
    let intensity = read(Layer::Intensity)?;
    let of_class = |class: u8| intensity.iter().filter(|(_, found)| *found as u8 == class).count();
    Ok(Some(CellMap {
        west_m: frame.west_m,
        south_m: frame.south_m,
        cell_m: frame.cell_m,
        columns: frame.columns,
        reach: read(Layer::Reach)?,
        intensity_cells: [1, 2, 3].map(of_class),
        intensity,
        energy_j: read(Layer::EnergyP95)?,
        height_m: read(Layer::HeightP95)?,
        deposits: some(read(Layer::Deposits)?),
        exceeds: some(read(Layer::ExceedsWeak)?),
    }))
}

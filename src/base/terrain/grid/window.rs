//! Parts of a grid, and the same in coarser cells.

use super::Grid;
use crate::math;

/// A box on the map (m): west, south, east, north.
pub(in crate::terrain) type BoxM = [f64; 4];

/// Share of a coarse cell that must have data (–): less is a hole.
const ENOUGH: f64 = 0.5;
/// A remainder of a cell below this share (–) is rounding.
const REMAINDER: f64 = 1e-9;

impl Grid {
    /// Cells without data.
    pub fn holes(&self) -> usize {
        self.values.iter().filter(|value| value.is_none()).count()
    }

    /// The part that covers a box: every triangle between cell centres that meets the box is kept. May have no cell.
    #[must_use]
    pub fn cropped(&self, [west, south, east, north]: BoxM) -> Self {
        let [x, y] = self.corner_m;
        let span = |low: f64, high: f64, count: usize| {
            let first = ((low / self.cell_m).floor() - 1.0).clamp(0.0, count as f64);
            let end = ((high / self.cell_m).ceil() + 1.0).clamp(first, count as f64);
            first as usize..end as usize
        };
        let (columns, up) =
            (span(west - x, east - x, self.columns), span(south - y, north - y, self.rows));
        // rows are counted from the north
        let rows = self.rows - up.end..self.rows - up.start;
        let values = rows.clone().flat_map(|row| {
            let row = row * self.columns;
            self.values[row + columns.start..row + columns.end].iter().copied()
        });
        Self {
            columns: columns.len(),
            rows: rows.len(),
            corner_m: [x + columns.start as f64 * self.cell_m, y + up.start as f64 * self.cell_m],
            cell_m: self.cell_m,
            values: values.collect(),
        }
    }

    /// The same in cells of `cell_m`, not smaller than the present ones: each holds the mean of the cells that it covers,
    /// weighted by area, or none where fewer than half of them have data. The south-west corner stays; a strip at the
    /// northern and eastern edge that fills no whole cell is left out.
    #[must_use]
    pub fn resampled(&self, cell_m: f64) -> Self {
        let ratio = cell_m / self.cell_m;
        let whole = |count: usize| (count as f64 / ratio + REMAINDER).floor() as usize;
        let (columns, rows) = (whole(self.columns), whole(self.rows));
        let mut values = Vec::with_capacity(columns * rows);
        for row in (0..rows).rev() {
            for column in 0..columns {
                values.push(
                    self.mean([column, row].map(|at| [at as f64 * ratio, (at + 1) as f64 * ratio])),
                );
            }
        }
        Self { columns, rows, corner_m: self.corner_m, cell_m, values }
    }

    /// Mean over a span of columns and one of rows from the south, both in cells.
    fn mean(&self, [columns, rows]: [[f64; 2]; 2]) -> Option<f64> {
        let cells = |[low, high]: [f64; 2], count: usize| {
            let (low, high) = (
                (low + REMAINDER).floor() as usize,
                ((high - REMAINDER).ceil() as usize).min(count),
            );
            low..high
        };
        let share =
            |[low, high]: [f64; 2], cell: usize| high.min(cell as f64 + 1.0) - low.max(cell as f64);
        let (mut sum, mut weight, mut whole) = (0.0, 0.0, 0.0);
        for row in cells(rows, self.rows) {
            for column in cells(columns, self.columns) {
                let area = share(columns, column) * share(rows, row);
                whole += area;
                if let Some(height) = self.value(column, self.rows - 1 - row) {
                    sum += area * height;
                    weight += area;
                }
            }
        }
        (weight > 0.0 && weight >= ENOUGH * whole).then(|| sum / weight)
    }

    /// The highest value in a box and one cell around it, if any cell centre lies there.
    pub fn highest_in(&self, [west, south, east, north]: BoxM) -> Option<f64> {
        self.cropped([west, south, east, north]).values.into_iter().flatten().max_by(f64::total_cmp)
    }

    /// The box of all cells that a rock from one of the `starts` can come to: those that lie below a straight line falling
    /// at `slope` (–, tangent) from the start's highest ground. `None` if there is none.
    pub fn reached(&self, starts: &[(BoxM, f64)], slope: f64) -> Option<BoxM> {
        let mut reached: Option<BoxM> = None;
        for row in 0..self.rows {
            for column in 0..self.columns {
                let Some(z) = self.value(column, row) else { continue };
                let at @ [x, y] = self.centre_m(column, row);
                let below = |&(start, top): &(BoxM, f64)| z <= top - slope * distance(start, at);
                if starts.iter().any(below) {
                    let [west, south, east, north] = reached.unwrap_or([x, y, x, y]);
                    reached = Some([west.min(x), south.min(y), east.max(x), north.max(y)]);
                }
            }
        }
        reached
    }
}

/// Distance from a point to a box, 0 inside (m).
pub(in crate::terrain) fn distance([west, south, east, north]: BoxM, [x, y]: [f64; 2]) -> f64 {
    let beyond = |low: f64, at: f64, high: f64| (low - at).max(at - high).max(0.0);
    math::hypot(beyond(west, x, east), beyond(south, y, north))
}

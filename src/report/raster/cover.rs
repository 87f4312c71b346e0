//! Which cells of a grid a triangle covers.

use super::GroundRaster;
use crate::math;

/// Largest gap inside a ring of tree cells that is taken for wood (m²): a stem, not a clearing.
const LARGEST_STEM_M2: f64 = 10.0;

/// West, south and cell edge (m).
type RasterGrid = (f64, f64, f64);

/// Calls `touch(column, row, z)` for each cell centre under a triangle in plan view; a vertical triangle has none.
pub(super) fn for_each_centre(
    (west, south, cell): RasterGrid,
    (columns, rows): (usize, usize),
    corners: [[f64; 3]; 3],
    mut touch: impl FnMut(usize, usize, f64),
) {
    // in units of cells, centres on whole numbers
    let [a, b, c] =
        corners.map(|p| [(p[0] - west) / cell - 0.5, (p[1] - south) / cell - 0.5, p[2]]);
    let span = |axis: usize, count: usize| {
        let low = a[axis].min(b[axis]).min(c[axis]);
        let high = a[axis].max(b[axis]).max(c[axis]);
        // a rounding error's worth wider: a centre on a shared edge must belong to one side at least
        ((low - 1e-9).ceil().max(0.0) as usize, (high + 1e-9).floor().min(count as f64 - 1.0))
    };
    let ((c0, c1), (r0, r1)) = (span(0, columns), span(1, rows));
    let twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if c1 < c0 as f64 || r1 < r0 as f64 || twice_area.abs() < 1e-12 {
        return;
    }
    for row in r0..=r1 as usize {
        for column in c0..=c1 as usize {
            let (x, y) = (column as f64, row as f64);
            let share = |p: [f64; 3], q: [f64; 3]| {
                ((q[0] - p[0]) * (y - p[1]) - (x - p[0]) * (q[1] - p[1])) / twice_area
            };
            let (of_c, of_a, of_b) = (share(a, b), share(b, c), share(c, a));
            if of_a.min(of_b).min(of_c) >= -1e-9 {
                touch(column, row, of_a * a[2] + of_b * b[2] + of_c * c[2]);
            }
        }
    }
}

/// Cells that something stands in, however small it is.
pub(super) struct Cover {
    grid: RasterGrid,
    size: (usize, usize),
    is_covered: Vec<bool>,
}

impl Cover {
    pub(super) fn over(raster: &GroundRaster) -> Self {
        let size = (raster.columns, raster.rows());
        let grid = (raster.west_m, raster.south_m, raster.cell_m);
        Self { grid, size, is_covered: vec![false; size.0 * size.1] }
    }

    /// Marks the cells under a triangle and those its edges pass: a stem is mostly upright faces.
    pub(super) fn mark(&mut self, corners: [[f64; 3]; 3]) {
        let (size, covered) = (self.size, &mut self.is_covered);
        for_each_centre(self.grid, size, corners, |column, row, _| {
            covered[row * size.0 + column] = true;
        });
        for i in 0..3 {
            self.mark_edge(corners[i], corners[(i + 1) % 3]);
        }
    }

    fn mark_edge(&mut self, a: [f64; 3], b: [f64; 3]) {
        let (west, south, cell) = self.grid;
        let length = math::hypot(b[0] - a[0], b[1] - a[1]) / cell;
        // two samples a cell leave no gap between neighbours
        let steps = (2.0 * length).ceil().clamp(1.0, 4.0 * (self.size.0 + self.size.1) as f64);
        for i in 0..=steps as usize {
            let t = i as f64 / steps;
            let column = ((a[0] + t * (b[0] - a[0]) - west) / cell).floor();
            let row = ((a[1] + t * (b[1] - a[1]) - south) / cell).floor();
            let is_inside = (0.0..self.size.0 as f64).contains(&column)
                && (0.0..self.size.1 as f64).contains(&row);
            if is_inside {
                self.is_covered[row as usize * self.size.0 + column as usize] = true;
            }
        }
    }

    /// The cells, with the hollow inside of open stems filled.
    pub(super) fn with_holes_filled(mut self) -> Vec<bool> {
        if self.is_covered.iter().any(|&covered| covered) {
            let largest = (LARGEST_STEM_M2 / (self.grid.2 * self.grid.2)) as usize;
            for hole in patches(&self.is_covered, self.size.0, false) {
                if hole.len() <= largest && !self.touches_border(&hole) {
                    for cell in hole {
                        self.is_covered[cell] = true;
                    }
                }
            }
        }
        self.is_covered
    }

    fn touches_border(&self, cells: &[usize]) -> bool {
        let (columns, rows) = self.size;
        cells.iter().any(|&cell| {
            let (row, column) = (cell / columns, cell % columns);
            row == 0 || column == 0 || row + 1 == rows || column + 1 == columns
        })
    }
}

/// Connected patches of cells equal to `wanted` (neighbours share an edge), each sorted, in order of their first cell.
pub(super) fn patches(cells: &[bool], columns: usize, wanted: bool) -> Vec<Vec<usize>> {
    let mut is_seen = vec![false; cells.len()];
    let mut found = Vec::new();
    for seed in 0..cells.len() {
        if cells[seed] == wanted && !is_seen[seed] {
            found.push(grow(cells, columns, seed, &mut is_seen));
        }
    }
    found
}

fn grow(cells: &[bool], columns: usize, seed: usize, is_seen: &mut [bool]) -> Vec<usize> {
    let mut patch = Vec::new();
    let mut open = vec![seed];
    is_seen[seed] = true;
    while let Some(cell) = open.pop() {
        patch.push(cell);
        let column = cell % columns;
        let beside = [
            (column > 0).then(|| cell - 1),
            (column + 1 < columns).then(|| cell + 1),
            cell.checked_sub(columns),
            (cell + columns < cells.len()).then(|| cell + columns),
        ];
        for next in beside.into_iter().flatten() {
            if cells[next] == cells[seed] && !is_seen[next] {
                is_seen[next] = true;
                open.push(next);
            }
        }
    }
    patch.sort_unstable();
    patch
}

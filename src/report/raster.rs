//! The ground in plan view: heights and trees on a square grid, enough to draw every map without the meshes.

mod ascii;
mod cover;

use crate::math;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// Heights of the ground and places of trees on a square grid in map coordinates.
///
/// Row 0 is the southernmost, column 0 the westernmost; the value of a cell stands at its centre.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundRaster {
    /// Western edge, map coordinates (m).
    pub west_m: f64,
    /// Southern edge, map coordinates (m).
    pub south_m: f64,
    /// Edge of a cell (m), positive.
    pub cell_m: f64,
    /// Number of columns.
    pub columns: usize,
    /// Height of the highest sheet of ground at each cell centre (m); NaN outside. Row by row.
    pub height_m: Vec<f64>,
    /// Whether a tree stands in the cell. Row by row.
    pub trees: Vec<bool>,
}

/// Cells along the longer side of the ground as it was used: fewer would hide what a map shows, more fill the disk.
const FEWEST_CELLS: usize = 400;
const MOST_CELLS: usize = 2000;

/// What stands round a raster: the smallest box of some vertices.
#[derive(Debug, Clone, Copy)]
struct BoundingBox {
    low: [f64; 3],
    high: [f64; 3],
}

impl GroundRaster {
    /// The ground of a terrain in cells about as fine as its triangles, for a GIS: what `maps/ground.asc` and `maps/ground.tif` both hold.
    pub fn as_used(terrain: &Terrain) -> Self {
        // two triangles a cell of a square model
        let across = (terrain.triangles.len() as f64 / 2.0).sqrt() as usize;
        Self::from_terrain(terrain, across.clamp(FEWEST_CELLS, MOST_CELLS))
    }

    /// The ground of a terrain on about `cells` cells along the longer side.
    ///
    /// Sheets of trees give the tree cells, all others the heights: the highest where sheets lie above each other. Heights are rounded to
    /// a thousandth of a cell: finer digits say nothing and make the files long.
    pub fn from_terrain(terrain: &Terrain, cells: usize) -> Self {
        let is_tree = |triangle: usize| {
            let sheet = terrain.sheet_of.get(triangle).map(|&s| usize::from(s));
            sheet.and_then(|s| terrain.sheets.get(s)).is_some_and(|s| s.is_tree)
        };
        let all = 0..terrain.triangles.len();
        let ground = || all.clone().filter(|&triangle| !is_tree(triangle));
        let corners = |triangle: usize| corners_on_map(terrain, triangle);
        let mut raster = Self::empty_over(bounds_of(ground().map(corners)), cells);
        ground().for_each(|triangle| raster.raise(corners(triangle)));
        raster.round_heights();
        let mut cover = cover::Cover::over(&raster);
        for triangle in all.clone().filter(|&triangle| is_tree(triangle)) {
            cover.mark(corners(triangle));
        }
        raster.trees = cover.with_holes_filled();
        raster
    }

    /// The same in cells of as many of its own as leave at most so many along the longer side: heights are means of what is known of half a cell
    /// or more, and a tree stands in a cell where it stands in a part of it.
    #[must_use]
    pub fn coarser(self, cells: usize) -> Self {
        let (columns, rows) = (self.columns, self.rows());
        let times = columns.max(rows).div_ceil(cells.max(1));
        if times < 2 {
            return self;
        }
        let (wide, tall) = (columns.div_ceil(times), rows.div_ceil(times));
        let (mut height_m, mut trees) = (Vec::new(), Vec::new());
        for (row, column) in (0..tall).flat_map(|row| (0..wide).map(move |column| (row, column))) {
            let of_row = row * times..rows.min((row + 1) * times);
            let of_column = column * times..columns.min((column + 1) * times);
            let own = of_row.flat_map(|r| of_column.clone().map(move |c| r * columns + c));
            let known = own.clone().map(|cell| self.height_m[cell]).filter(|z| z.is_finite());
            let (count, sum) = known.fold((0, 0.0), |(count, sum), z| (count + 1, sum + z));
            let is_known = 2 * count >= times * times;
            height_m.push(if is_known { sum / f64::from(count as u32) } else { f64::NAN });
            trees.push(own.into_iter().any(|cell| self.trees[cell]));
        }
        let cell_m = self.cell_m * times as f64;
        Self { cell_m, columns: wide, height_m, trees, ..self }
    }

    fn empty_over(bounds: Option<BoundingBox>, cells: usize) -> Self {
        let BoundingBox { low, high } =
            bounds.unwrap_or(BoundingBox { low: [0.0; 3], high: [1.0, 1.0, 0.0] });
        let longest = (high[0] - low[0]).max(high[1] - low[1]).max(1e-9);
        let cell_m = rounded_up(longest / cells.max(1) as f64);
        let decimals = decimals_for(cell_m);
        let edge = |value: f64| rounded((value / cell_m).floor() * cell_m, decimals);
        let (west_m, south_m) = (edge(low[0]), edge(low[1]));
        let count = |from: f64, to: f64| (((to - from) / cell_m).ceil() as usize).max(1);
        let (columns, rows) = (count(west_m, high[0]), count(south_m, high[1]));
        let trees = vec![false; columns * rows];
        Self { west_m, south_m, cell_m, columns, height_m: vec![f64::NAN; columns * rows], trees }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.height_m.len() / self.columns.max(1)
    }

    /// Eastern edge, map coordinates (m).
    pub fn east_m(&self) -> f64 {
        self.west_m + self.columns as f64 * self.cell_m
    }

    /// Northern edge, map coordinates (m).
    pub fn north_m(&self) -> f64 {
        self.south_m + self.rows() as f64 * self.cell_m
    }

    /// Height of the ground at a place of the map (m), linear between cell centres; NaN outside.
    ///
    /// Beside a cell without ground the others speak alone, as long as they hold half the weight.
    pub fn height_at(&self, x_m: f64, y_m: f64) -> f64 {
        let column = (x_m - self.west_m) / self.cell_m - 0.5;
        let row = (y_m - self.south_m) / self.cell_m - 0.5;
        if !(column >= -0.5 && row >= -0.5) {
            return f64::NAN;
        }
        let (c, r) = (column.floor(), row.floor());
        let (mut sum, mut weight) = (0.0, 0.0);
        for (dc, dr) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let w = (1.0 - (column - c - dc).abs()) * (1.0 - (row - r - dr).abs());
            let z = self.cell(c + dc, r + dr);
            if z.is_finite() {
                sum += w * z;
                weight += w;
            }
        }
        if weight >= 0.5 { sum / weight } else { f64::NAN }
    }

    /// Groups of neighbouring tree cells, each as indices into [`GroundRaster::trees`].
    pub fn tree_patches(&self) -> Vec<Vec<usize>> {
        cover::patches(&self.trees, self.columns, true)
    }

    /// Middle of some cells, map coordinates (m).
    pub fn centroid_m(&self, cells: &[usize]) -> (f64, f64) {
        let count = cells.len().max(1) as f64;
        let mean = |part: fn(usize, usize) -> usize| {
            cells.iter().map(|&cell| part(cell, self.columns) as f64 + 0.5).sum::<f64>() / count
        };
        let (column, row) =
            (mean(|cell, columns| cell % columns), mean(|cell, columns| cell / columns));
        (self.west_m + column * self.cell_m, self.south_m + row * self.cell_m)
    }

    fn cell(&self, column: f64, row: f64) -> f64 {
        if column < 0.0 || row < 0.0 || column >= self.columns as f64 {
            return f64::NAN;
        }
        let index = row as usize * self.columns + column as usize;
        self.height_m.get(index).copied().unwrap_or(f64::NAN)
    }

    /// Raises the cells whose centres lie under a triangle to its plane.
    fn raise(&mut self, corners: [[f64; 3]; 3]) {
        let columns = self.columns;
        let heights = &mut self.height_m;
        let grid = (self.west_m, self.south_m, self.cell_m);
        let rows = heights.len() / columns.max(1);
        cover::for_each_centre(grid, (columns, rows), corners, |column, row, z| {
            let cell = &mut heights[row * columns + column];
            // `max` ignores the NaN of a cell not yet touched
            *cell = cell.max(z);
        });
    }

    fn round_heights(&mut self) {
        let decimals = decimals_for(self.cell_m);
        for z in &mut self.height_m {
            *z = rounded(*z, decimals);
        }
    }
}

/// Corners of a triangle in map coordinates (m).
fn corners_on_map(terrain: &Terrain, triangle: usize) -> [[f64; 3]; 3] {
    terrain.triangles[triangle].map(|v| {
        let place: Vec3 = terrain.vertices_m[v as usize] + terrain.origin_m;
        [place.x, place.y, place.z]
    })
}

fn bounds_of(triangles: impl Iterator<Item = [[f64; 3]; 3]>) -> Option<BoundingBox> {
    triangles.flatten().fold(None, |bounds, p| {
        let BoundingBox { mut low, mut high } = bounds.unwrap_or(BoundingBox { low: p, high: p });
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
        Some(BoundingBox { low, high })
    })
}

/// Decimals that resolve a thousandth of a cell.
fn decimals_for(cell_m: f64) -> i32 {
    (3.0 - math::log10(cell_m).floor()).clamp(0.0, 9.0) as i32
}

/// The double nearest to a number of few decimals: its printed form is short and reads back to the same double.
fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    let scaled = (value * scale).round();
    // beyond 2⁵³ there is nothing left to round
    if scaled.abs() < 9e15 { scaled / scale } else { value }
}

fn rounded_up(cell_m: f64) -> f64 {
    let decimals = decimals_for(cell_m);
    let scale = 10f64.powi(decimals);
    (cell_m * scale - 1e-9).ceil().max(1.0) / scale
}

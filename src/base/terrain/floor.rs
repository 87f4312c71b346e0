//! How low the slope lies at most, cell by cell: tells without a search that a rock flies no higher than before.

use super::faces::Face;
use super::index::below;
use super::way::cells_under;
use crate::parallel;
use crate::rock::Vec3;
use std::sync::{Mutex, PoisonError};

/// Shares of the triangles that are looked at beside each other, each with cells of its own, and the fewest triangles in one.
const SHARES: usize = 16;
const LEAST_SHARE: usize = 1 << 16;
/// Cells a triangle, and their least and largest number.
const CELLS: usize = 4;
const LEAST_CELLS: usize = 64;
const MOST_CELLS: usize = 1 << 20;
/// Cells are taken to be wider by this (–, relative to the mesh): rounding of places.
const WIDER: f64 = 1e-9;
/// Planes steeper than this (–, vertical part of the normal) are left to the lowest of their corners.
const UPRIGHT: f64 = 1e-3;

/// Square cells over the map, each with a height (m, local) that no slope triangle in it lies below.
#[derive(Debug, Clone, Default)]
pub struct Floor {
    west_m: f64,
    south_m: f64,
    per_m: f64,
    columns: usize,
    rows: usize,
    low_m: Vec<f32>,
}

impl Floor {
    /// Of the first `triangles` faces, where they are ground, in the box from `lo` to `hi`.
    pub fn of(
        ground: impl Fn(u32) -> Option<Face> + Sync,
        triangles: usize,
        (lo, hi): (Vec3, Vec3),
    ) -> Self {
        let size = (hi - lo).xy().map(|length| length.max(f64::MIN_POSITIVE));
        let cells = (CELLS * triangles).clamp(LEAST_CELLS, MOST_CELLS);
        let longest = size.max();
        let cell_m = (size.x * size.y / cells as f64).sqrt().max(longest / cells as f64);
        let [columns, rows] = [size.x, size.y].map(|length| (length / cell_m) as usize + 1);
        let empty = Self {
            west_m: lo.x,
            south_m: lo.y,
            per_m: 1.0 / cell_m,
            columns,
            rows,
            low_m: vec![f32::INFINITY; columns * rows],
        };
        let share = triangles.div_ceil(SHARES).max(LEAST_SHARE);
        // As many floors of shares at once as there are threads; the lower one of two is the same in any order.
        let lowest = Mutex::new(empty.clone());
        parallel::each(triangles.div_ceil(share), &|number| {
            let mut floor = empty.clone();
            let of_share = number * share..triangles.min((number + 1) * share);
            for face in of_share.filter_map(|t| ground(t as u32)) {
                floor.lower_to(&face, WIDER * longest);
            }
            lowest.lock().unwrap_or_else(PoisonError::into_inner).lower(&floor);
        });
        lowest.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// The lower one of two, cell by cell.
    fn lower(&mut self, other: &Self) {
        for (low, other) in self.low_m.iter_mut().zip(&other.low_m) {
            *low = low.min(*other);
        }
    }

    /// A height that the slope at (x, y) is not below (m); infinite where there is none.
    pub fn under(&self, x_m: f64, y_m: f64) -> f64 {
        let mut lowest = f64::INFINITY;
        self.along([[x_m, y_m]; 2], |low, _, _| lowest = low);
        lowest
    }

    /// Calls `pass` with every cell under the straight way between two places in plan view: a height (m, local) that the slope in it is not
    /// below, infinite where there is none, and the shares of the way at which the cell is entered and left. Beside the mesh it is that of
    /// the nearest cell.
    #[inline]
    pub fn along(&self, ends: [[f64; 2]; 2], mut pass: impl FnMut(f64, f64, f64)) {
        let place =
            |[x, y]: [f64; 2]| [(x - self.west_m) * self.per_m, (y - self.south_m) * self.per_m];
        let inside = |at: i64, count: usize| (at.max(0) as usize).min(count.saturating_sub(1));
        cells_under(ends.map(place), |[column, row], from, to| {
            let cell = inside(row, self.rows) * self.columns + inside(column, self.columns);
            let low = self.low_m.get(cell).map_or(f64::INFINITY, |&low| f64::from(low));
            pass(low, from, to);
        });
    }

    /// Memory that it takes (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&self.low_m[..])
    }

    #[inline]
    fn column(&self, x: f64) -> usize {
        (((x - self.west_m) * self.per_m) as usize).min(self.columns.saturating_sub(1))
    }

    #[inline]
    fn row(&self, y: f64) -> usize {
        (((y - self.south_m) * self.per_m) as usize).min(self.rows.saturating_sub(1))
    }

    /// Lowers the cells that a face lies in.
    fn lower_to(&mut self, face: &Face, wider: f64) {
        let corners = [face.a, face.a + face.e1, face.a + face.e2];
        let (lo, hi) = corners.iter().fold((face.a, face.a), |(lo, hi), c| (lo.inf(c), hi.sup(c)));
        let half = 0.5 / self.per_m + wider;
        let n = if face.n.z.abs() < UPRIGHT { Vec3::zeros() } else { face.n / face.n.z };
        // How far the plane falls from the middle of a cell to its lowest corner.
        let falls = (n.x.abs() + n.y.abs()) * half + wider;
        for row in self.row(lo.y - wider)..=self.row(hi.y + wider) {
            for column in self.column(lo.x - wider)..=self.column(hi.x + wider) {
                let x = self.west_m + (column as f64 + 0.5) / self.per_m;
                let y = self.south_m + (row as f64 + 0.5) / self.per_m;
                let plane = face.a.z - n.x * (x - face.a.x) - n.y * (y - face.a.y) - falls;
                let low = if n.z == 0.0 { lo.z } else { plane.max(lo.z) };
                let known = &mut self.low_m[row * self.columns + column];
                *known = known.min(below(low - wider));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::make;

    /// Shares of the triangles give the floor that one after the other gives, and no ground lies under it.
    #[test]
    fn shares_change_no_height() {
        let facets = make::natural_slope(300, 300).facets;
        let faces: Vec<Face> = facets.iter().map(|&facet| Face::new(facet)).collect();
        assert!(faces.len() > 2 * LEAST_SHARE);
        let corners = || facets.iter().flatten();
        let first = facets[0][0];
        let low = corners().fold(first, |low, corner| low.inf(corner));
        let high = corners().fold(first, |high, corner| high.sup(corner));
        let ground = |t: u32| (!t.is_multiple_of(9)).then(|| faces[t as usize]);
        let floor = Floor::of(ground, faces.len(), (low, high));
        let mut one_by_one =
            Floor { low_m: vec![f32::INFINITY; floor.low_m.len()], ..floor.clone() };
        let longest = (high - low).xy().max();
        (0..faces.len() as u32)
            .filter_map(ground)
            .for_each(|face| one_by_one.lower_to(&face, WIDER * longest));
        assert!(floor.low_m == one_by_one.low_m);
        for face in (0..faces.len() as u32).filter_map(ground) {
            let middle = face.a + (face.e1 + face.e2) / 3.0;
            assert!(floor.under(middle.x, middle.y) <= middle.z);
        }
    }
}

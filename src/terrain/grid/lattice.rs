//! Triangles over a lattice of points, two for every cell.

use crate::rock::Vec3;
use crate::terrain::facets::{Facet, Facets};

/// Numbers of the corners of a cell: south-west, south-east, north-east, north-west.
pub(super) type Around = [u32; 4];

/// Points in columns from west to east and rows from south to north.
pub(super) struct Lattice {
    columns: usize,
    rows: usize,
    /// Row by row; no height where there is no point.
    points: Vec<Vec3>,
}

impl Lattice {
    /// Of the points that there are.
    pub(super) fn of(
        columns: usize,
        rows: usize,
        point: impl Fn(usize, usize) -> Option<Vec3>,
    ) -> Self {
        let none = Vec3::repeat(f64::NAN);
        let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let mut points = Vec::with_capacity(columns * rows);
        points.extend(places.map(|(column, row)| point(column, row).unwrap_or(none)));
        Self { columns, rows, points }
    }

    /// Whether there is a point.
    pub(super) fn has(&self, point: u32) -> bool {
        !self.points[point as usize].z.is_nan()
    }

    /// The facets of all cells that are `wanted`.
    pub(super) fn cut(self, wanted: impl Fn(&Self, &Around) -> bool) -> Facets {
        let (own, wanted) = (&self, &wanted);
        let halves = |row: usize| {
            let of_cell = move |column: usize| own.halves(column, row, wanted);
            (0..self.columns.saturating_sub(1)).flat_map(of_cell)
        };
        let rows = 0..self.rows.saturating_sub(1);
        // Counted first: millions of facets are not moved about while the list grows.
        let count = rows.clone().map(|row| halves(row).count()).sum();
        let mut corners = Vec::with_capacity(count);
        rows.for_each(|row| corners.extend(halves(row)));
        Facets::Shared { points: self.points, corners }
    }

    /// The facets of one cell.
    fn halves(
        &self,
        column: usize,
        row: usize,
        wanted: &dyn Fn(&Self, &Around) -> bool,
    ) -> impl Iterator<Item = [u32; 3]> + use<> {
        let number = |[right, up]: [usize; 2]| ((row + up) * self.columns + column + right) as u32;
        let around = [[0, 0], [1, 0], [1, 1], [0, 1]].map(number);
        let halves = if wanted(self, &around) {
            cut(around.map(|point| self.points[point as usize].z))
        } else {
            [None, None]
        };
        halves.into_iter().flatten().map(move |half| half.map(|corner| around[corner]))
    }
}

/// Two facets for every cell of a lattice of points, wound to face up when columns run east and rows run north.
///
/// Each cell is cut along the diagonal whose ends differ less in height, from the south-west to the north-east corner
/// when they are equal: ridges and valleys are followed, and a mirrored grid gives the mirrored mesh. A cell with one
/// missing corner keeps the triangle of the other three, a cell with more is left out.
pub fn triangulate(
    columns: usize,
    rows: usize,
    point: impl Fn(usize, usize) -> Option<Vec3>,
) -> Vec<Facet> {
    Lattice::of(columns, rows, point).cut(|_, _| true).iter().collect()
}

/// Which corners of a cell make its facets, from the heights at all four; no number where there is no point.
fn cut(z: [f64; 4]) -> [Option<[usize; 3]>; 2] {
    match z.map(f64::is_nan) {
        [false, false, false, false] => {
            if (z[0] - z[2]).abs() <= (z[1] - z[3]).abs() {
                [Some([0, 1, 2]), Some([0, 2, 3])]
            } else {
                [Some([0, 1, 3]), Some([1, 2, 3])]
            }
        }
        [true, false, false, false] => [Some([1, 2, 3]), None],
        [false, true, false, false] => [Some([2, 3, 0]), None],
        [false, false, true, false] => [Some([3, 0, 1]), None],
        [false, false, false, true] => [Some([0, 1, 2]), None],
        _ => [None, None],
    }
}

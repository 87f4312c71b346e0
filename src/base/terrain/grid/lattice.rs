//! Triangles over a lattice of points, two for every cell.

use crate::parallel;
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
        point: impl Fn(usize, usize) -> Option<Vec3> + Sync,
    ) -> Self {
        let none = Vec3::repeat(f64::NAN);
        let place = |at: usize| point(at % columns, at / columns).unwrap_or(none);
        let points = parallel::map(columns * rows, place);
        Self { columns, rows, points }
    }

    /// Whether there is a point.
    pub(super) fn has(&self, point: u32) -> bool {
        !self.points[point as usize].z.is_nan()
    }

    /// The facets of all cells that are `wanted`; no two points are closer than `apart_m` (m).
    pub(super) fn cut(
        self,
        apart_m: f64,
        wanted: impl Fn(&Self, &Around) -> bool + Sync,
    ) -> Facets {
        let (own, wanted) = (&self, &wanted);
        let halves = |row: usize| {
            let of_cell = move |column: usize| own.halves(column, row, wanted);
            (0..own.columns.saturating_sub(1)).flat_map(of_cell)
        };
        // Counted first: every row then knows its place.
        let counts = parallel::map_each(own.rows.saturating_sub(1), |row| halves(row).count());
        let mut corners = vec![[0; 3]; counts.iter().sum()];
        let mut free = &mut corners[..];
        let mut places: Vec<&mut [[u32; 3]]> = counts
            .into_iter()
            .map(|count| free.split_off_mut(..count).unwrap_or_default())
            .collect();
        parallel::update_shares(&mut places, 1, |row, places| {
            places[0].iter_mut().zip(halves(row)).for_each(|(place, half)| *place = half);
        });
        Facets::Shared { points: self.points, corners, apart_m }
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
    point: impl Fn(usize, usize) -> Option<Vec3> + Sync,
) -> Vec<Facet> {
    Lattice::of(columns, rows, point).cut(0.0, |_, _| true).iter().collect()
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

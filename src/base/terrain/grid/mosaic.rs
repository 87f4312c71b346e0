//! Tiles of one elevation model: where grids lie on one lattice, the surface goes on from one to the next.
//!
//! Every place of the lattice belongs to the first grid that has a height there, and every cell between four places to the
//! grid that one of its places belongs to. So grids that touch leave no gap, grids that overlap give no double surface, and
//! the triangles are those of one grid that holds all of them.

use super::Grid;
use super::lattice::Lattice;
use crate::rock::Vec3;
use crate::terrain::facets::Facets;

/// Difference of two cells (–, relative), and of two lattices (in cells), below which they are the same: digits of a writer.
const EQUAL: f64 = 1e-6;

/// How two grids stand to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::terrain) enum Standing {
    /// They have no place in common and none beside each other.
    Apart,
    /// On one lattice, common places or neighbouring ones: columns and rows from the first one's south-western cell to the
    /// other's.
    Joined([i64; 2]),
    /// Closer than a cell, and not on one lattice: there is a gap between them.
    Gap,
    /// Common ground, and not on one lattice: so wide and so high (m).
    Double([f64; 2]),
}

impl Grid {
    /// How another grid stands to this one.
    pub(in crate::terrain) fn standing(&self, other: &Self) -> Standing {
        let [low, high] =
            [self, other].map(Self::centres_m).into_iter().fold(
                [[f64::NEG_INFINITY; 2], [f64::INFINITY; 2]],
                |[low, high], [first, last]| {
                    [0, 1].map(|end| {
                        [0, 1].map(|k| {
                            if end == 0 { low[k].max(first[k]) } else { high[k].min(last[k]) }
                        })
                    })
                },
            );
        let common = [0, 1].map(|k| high[k] - low[k]);
        let cell_m = self.cell_m.max(other.cell_m);
        if common.iter().any(|&m| m < -(1.0 + EQUAL) * cell_m) {
            return Standing::Apart;
        }
        let steps = [0, 1].map(|k| (other.corner_m[k] - self.corner_m[k]) / self.cell_m);
        let on_lattice = steps.iter().all(|step| (step - step.round()).abs() <= EQUAL);
        if on_lattice && (self.cell_m - other.cell_m).abs() <= EQUAL * self.cell_m {
            return Standing::Joined(steps.map(|step| step.round() as i64));
        }
        if common.iter().all(|&m| m > 0.0) { Standing::Double(common) } else { Standing::Gap }
    }

    /// Its first and last cell centre (m): south-west and north-east.
    fn centres_m(&self) -> [[f64; 2]; 2] {
        let last = [self.columns, self.rows].map(|count| count as f64 - 0.5);
        [
            self.corner_m.map(|m| m + 0.5 * self.cell_m),
            [0, 1].map(|k| self.corner_m[k] + last[k] * self.cell_m),
        ]
    }

    /// A place counted from the south-western cell, around `map_origin_m`, if it has a height there.
    fn place(&self, [column, row]: [i64; 2], map_origin_m: Vec3) -> Option<Vec3> {
        let column = usize::try_from(column).ok().filter(|column| *column < self.columns)?;
        let row = usize::try_from(row).ok().filter(|row| *row < self.rows)?;
        let z = self.value(column, self.rows - 1 - row)?;
        Some(self.centre_around(column, row, map_origin_m, z))
    }

    /// The facets that are its own beside `others`, which it is joined with: each with its steps, and whether it comes first
    /// where both have a height.
    pub(in crate::terrain) fn facets_beside(
        &self,
        others: &[(&Self, [i64; 2], bool)],
        map_origin_m: Vec3,
    ) -> Facets {
        if others.is_empty() {
            return self.surface(map_origin_m);
        }
        let of = |&(other, [right, up], _): &(&Self, [i64; 2], bool), [column, row]: [i64; 2]| {
            other.place([column - right, row - up], map_origin_m)
        };
        // a cell further on each side: that is where it meets the others
        let (columns, rows) = (self.columns + 2, self.rows + 2);
        let inner = |column: usize, row: usize| [column, row].map(|n| n.cast_signed() as i64 - 1);
        let first = |at: [i64; 2]| others.iter().filter(|other| other.2).find_map(|o| of(o, at));
        let later = |at: [i64; 2]| others.iter().filter(|other| !other.2).find_map(|o| of(o, at));
        let own = |at: [i64; 2]| self.place(at, map_origin_m);
        let lattice = Lattice::of(columns, rows, |column, row| {
            let at = inner(column, row);
            first(at).or_else(|| own(at)).or_else(|| later(at))
        });
        let is_own = |point: u32| {
            let at = inner(point as usize % columns, point as usize / columns);
            own(at).is_some() && first(at).is_none()
        };
        lattice.cut(self.apart_m(), |lattice, around| {
            around.iter().find(|&&point| lattice.has(point)).is_some_and(|&point| is_own(point))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::facets::Facet;

    fn grid(columns: usize, rows: usize, corner_m: [f64; 2]) -> Grid {
        let mut grid = Grid { columns, rows, corner_m, cell_m: 0.5, values: Vec::new() };
        for row in 0..rows {
            for column in 0..columns {
                let [x, y] = grid.centre_m(column, row);
                let height = 0.25 * ((7.0 * x + 13.0 * y) % 5.0) + 0.5 * y;
                // holes on both sides of the seams and on them
                let is_hole = ((x + 3.0 * y) % 7.0 - 0.25).abs() < 1e-9;
                grid.values.push((!is_hole).then_some(height));
            }
        }
        grid
    }

    fn sorted(facets: Vec<Facet>) -> Vec<[[u64; 3]; 3]> {
        let bits = |facet: Facet| facet.map(|p| [p.x, p.y, p.z].map(f64::to_bits));
        let mut all: Vec<_> = facets.into_iter().map(bits).collect();
        all.sort_unstable();
        all
    }

    /// All facets of grids that are joined, the first ones first.
    fn joined(grids: &[Grid]) -> Vec<Facet> {
        let mut all = Vec::new();
        for (number, grid) in grids.iter().enumerate() {
            let others: Vec<_> = grids
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != number)
                .filter_map(|(other, tile)| match grid.standing(tile) {
                    Standing::Joined(steps) => Some((tile, steps, other < number)),
                    _ => None,
                })
                .collect();
            all.extend(grid.facets_beside(&others, ORIGIN_M).iter());
        }
        all
    }

    const ORIGIN_M: Vec3 = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);

    fn at(east: f64, north: f64) -> [f64; 2] {
        [2_600_000.0 + east, 1_200_000.0 + north]
    }

    /// Four tiles that touch, and four that overlap by three cells: the triangles of the one grid, bit for bit, each once.
    #[test]
    fn tiles_have_the_triangles_of_the_whole() {
        let whole = sorted(grid(30, 24, at(0.0, 0.0)).facets(ORIGIN_M));
        let touching = [
            grid(17, 10, at(0.0, 0.0)),
            grid(13, 10, at(8.5, 0.0)),
            grid(17, 14, at(0.0, 5.0)),
            grid(13, 14, at(8.5, 5.0)),
        ];
        let overlapping = [
            grid(13, 17, at(8.5, 3.5)),
            grid(20, 10, at(0.0, 0.0)),
            grid(16, 10, at(7.0, 0.0)),
            grid(20, 17, at(0.0, 3.5)),
        ];
        assert!(whole.len() > 1000);
        assert!(sorted(joined(&touching)) == whole);
        assert!(sorted(joined(&overlapping)) == whole);
    }

    #[test]
    fn tiles_stand_as_they_lie() {
        let tile = grid(10, 10, at(0.0, 0.0));
        let standing = |other: &Grid| tile.standing(other);
        assert_eq!(standing(&grid(4, 4, at(5.0, -2.0))), Standing::Joined([10, -4]));
        assert_eq!(standing(&grid(4, 4, at(5.5, 0.0))), Standing::Apart);
        assert_eq!(standing(&grid(4, 4, at(4.8, 0.0))), Standing::Gap);
        let shifted = grid(4, 4, at(2.25, 1.0));
        assert_eq!(standing(&shifted), Standing::Double([1.5, 1.5]));
        let coarse = Grid { cell_m: 1.0, ..grid(4, 4, at(0.0, 0.0)) };
        assert!(matches!(standing(&coarse), Standing::Double(_)));
    }
}

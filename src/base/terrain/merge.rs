//! Merging of close points: first come, first kept.

use crate::rock::Vec3;

/// Edge of a search cell in tolerances (–): large enough that few points are near the border of their cell.
const CELL_OF_TOLERANCE: f64 = 16.0;

/// Smallest cell relative to the size of the model (–): keeps cell numbers far below 2⁵³.
const CELL_OF_SIZE: f64 = 1e-9;

/// Smallest cell at all (m), so that a model of no size still has cells.
const SMALLEST_CELL_M: f64 = 1e-12;

/// Shift of the cells (in cells), so that coordinates in round numbers do not lie on cell borders.
const SHIFT: f64 = 0.381_966;

/// Room for rounding in "near the border of a cell" (in cells).
const SLACK: f64 = 1e-4;

/// Ends a chain of points.
const END_OF_CHAIN: u32 = u32::MAX;

/// Gives every point the number of the first kept point within the tolerance, or keeps it.
///
/// Kept points lie more than the tolerance apart, so a chain of close points cannot collapse into one, and equal points
/// always get the same number. The cells are chains in plain vectors; their order never shows in the answer.
#[derive(Debug)]
pub(super) struct Merger {
    tolerance_m: f64,
    cell_m: f64,
    /// How many buckets there are once a point is looked for.
    buckets: usize,
    /// First kept point of each bucket of cells; none before a point is looked for.
    heads: Vec<u32>,
    /// Next kept point in the same bucket.
    next: Vec<u32>,
    kept_m: Vec<Vec3>,
}

impl Merger {
    /// For about `points` points with repetitions, in a model of the given size (m).
    pub(super) fn new(tolerance_m: f64, size_m: f64, points: usize) -> Self {
        let cell_m =
            (CELL_OF_TOLERANCE * tolerance_m).max(CELL_OF_SIZE * size_m).max(SMALLEST_CELL_M);
        // A closed fan of triangles uses each vertex about six times: one bucket for three uses.
        let buckets = (points / 3).next_power_of_two().max(2);
        Self {
            tolerance_m,
            cell_m,
            buckets,
            heads: Vec::new(),
            next: Vec::new(),
            kept_m: Vec::new(),
        }
    }

    /// The first points, which are known to be farther apart than the tolerance: each is kept.
    pub(super) fn keep_apart(&mut self, points_m: Vec<Vec3>) {
        debug_assert!(self.kept_m.is_empty() && self.heads.is_empty());
        self.kept_m = points_m;
    }

    /// Makes room for looking for points, and sorts in those that were kept before.
    pub(super) fn open(&mut self) {
        if !self.heads.is_empty() {
            return;
        }
        self.heads = vec![END_OF_CHAIN; self.buckets];
        for number in 0..self.kept_m.len() as u32 {
            let bucket = self.bucket(self.place(self.kept_m[number as usize]).0);
            self.next.push(std::mem::replace(&mut self.heads[bucket], number));
        }
    }

    /// The number of the kept point that stands for `point_m`; the buckets must be open.
    pub(super) fn number_of(&mut self, point_m: Vec3) -> u32 {
        let (cell, inside) = self.place(point_m);
        if let Some(number) = self.first_within(cell, point_m, 0.0) {
            return number;
        }
        let near = self.nearest_neighbour_cells(&inside);
        match self.first_around(cell, near, point_m) {
            Some(number) => number,
            None => self.keep(cell, point_m),
        }
    }

    /// The kept points, by number.
    pub(super) fn kept_m(&self) -> &[Vec3] {
        &self.kept_m
    }

    /// The kept points, by number.
    pub(super) fn into_kept_m(mut self) -> Vec<Vec3> {
        // a lattice has a few more points than half its triangles: room for twice as many would stay
        self.kept_m.shrink_to_fit();
        self.kept_m
    }

    /// The cell of a point, and where it lies in it (0..1).
    fn place(&self, point_m: Vec3) -> ([i64; 3], Vec3) {
        let at = point_m / self.cell_m + Vec3::repeat(SHIFT);
        let home = at.map(f64::floor);
        ([home.x as i64, home.y as i64, home.z as i64], at - home)
    }

    /// For each axis the side (−1, 0, +1) on which the next cell is within the tolerance of a point at `inside`
    /// (0..1) of its cell.
    fn nearest_neighbour_cells(&self, inside: &Vec3) -> [i64; 3] {
        let reach = self.tolerance_m / self.cell_m + SLACK;
        [inside.x, inside.y, inside.z]
            .map(|share| if share < reach { -1 } else { i64::from(share > 1.0 - reach) })
    }

    /// The earliest kept point within the tolerance, in the cell and its up to seven near neighbours.
    fn first_around(&self, cell: [i64; 3], near: [i64; 3], point_m: Vec3) -> Option<u32> {
        (0..8)
            .filter(|corner| (0..3).all(|axis| corner >> axis & 1 == 0 || near[axis] != 0))
            .filter_map(|corner| {
                let step =
                    |axis: usize| cell[axis].saturating_add(near[axis] * (corner >> axis & 1));
                self.first_within([step(0), step(1), step(2)], point_m, self.tolerance_m)
            })
            .min()
    }

    /// The earliest kept point of the cell's bucket within `reach_m`.
    fn first_within(&self, cell: [i64; 3], point_m: Vec3, reach_m: f64) -> Option<u32> {
        let mut found = None;
        let mut number = self.heads[self.bucket(cell)];
        // Newer points stand first in a chain, so the last match is the earliest.
        while number != END_OF_CHAIN {
            if (self.kept_m[number as usize] - point_m).norm_squared() <= reach_m * reach_m {
                found = Some(number);
            }
            number = self.next[number as usize];
        }
        found
    }

    fn keep(&mut self, cell: [i64; 3], point_m: Vec3) -> u32 {
        let number = self.kept_m.len() as u32;
        let bucket = self.bucket(cell);
        self.next.push(self.heads[bucket]);
        self.heads[bucket] = number;
        self.kept_m.push(point_m);
        number
    }

    /// Mixes the cell numbers (the finaliser of `SplitMix64`, Steele et al. 2014).
    fn bucket(&self, cell: [i64; 3]) -> usize {
        let [x, y, z] = cell.map(i64::cast_unsigned);
        let mut bits = x
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .wrapping_add(y.wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
            .wrapping_add(z.wrapping_mul(0x1656_67b1_9e37_79f9));
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (bits ^ (bits >> 31)) as usize & (self.heads.len() - 1)
    }
}

//! Broad phase: pairs of rocks near each other, by grids of several sizes, one for each octave of
//! radii.
//!
//! No tree: rocks move in every window, and a sorted list of cells is rebuilt in O(n log n) without
//! persistent memory. Several sizes: in a single grid one boulder would make every cell as large as
//! itself, with a thousand pebbles in one of them.

use crate::math;
use crate::rock::Vec3;

/// A ball that contains a rock at all positions possible for a while.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Centre (m).
    pub centre: Vec3,
    /// Radius (m), positive.
    pub radius: f64,
}

/// One ball in its cell: the octave of the cell, the cell, the ball's number.
type CellEntry = (i32, [i64; 3], u32);

/// Offsets of the neighbouring columns of cells that follow in the order of cells. Of its own
/// column a cell uses the cells from itself upwards. So each pair of balls is visited once.
const NEXT_COLUMNS: [[i64; 2]; 5] = [[0, 0], [0, 1], [1, -1], [1, 0], [1, 1]];

/// All pairs `(a, b)`, `a < b`, of balls that overlap or touch, in ascending order.
///
/// Each ball lies in one cell of the grid whose cells are between one and two of its diameters
/// wide, and is compared with its neighbours there and in coarser grids: the work is nearly linear
/// in the number of balls, whatever their sizes. The result is sorted, so it does not depend on the
/// position of the grids.
pub fn overlapping(balls: &[Ball]) -> Vec<(u32, u32)> {
    let grids = Grids::of(balls);
    let mut entries: Vec<CellEntry> =
        balls.iter().zip(0..).map(|(ball, k)| entry(ball, grids.level(ball), k)).collect();
    entries.sort_unstable();
    let mut levels: Vec<i32> = entries.iter().map(|entry| entry.0).collect();
    levels.dedup();
    let mut pairs = Vec::with_capacity(4 * balls.len());
    let mut add = |a: u32, b: u32| {
        let [one, two] = [a, b].map(|k| &balls[k as usize]);
        let reach = one.radius + two.radius;
        if (one.centre - two.centre).norm_squared() <= reach * reach {
            pairs.push((a.min(b), a.max(b)));
        }
    };
    visit_own(&entries, &mut add);
    for &(own, _, k) in entries.iter().filter(|_| levels.len() > 1) {
        for &level in levels.iter().filter(|level| **level > own) {
            let home = entry(&balls[k as usize], level, k).1;
            visit_coarser(&entries, (level, home), |other| add(k, other));
        }
    }
    sorted_pairs(&pairs, balls.len())
}

/// Pairs in ascending order: a counting sort by the first ball, then a sort of the few pairs of
/// each by the second.
fn sorted_pairs(pairs: &[(u32, u32)], balls: usize) -> Vec<(u32, u32)> {
    let mut ends = vec![0; balls + 1];
    for (a, _) in pairs {
        ends[*a as usize + 1] += 1;
    }
    for k in 1..ends.len() {
        ends[k] += ends[k - 1];
    }
    let mut sorted = vec![(0, 0); pairs.len()];
    for pair in pairs {
        let end = &mut ends[pair.0 as usize];
        sorted[*end] = *pair;
        *end += 1;
    }
    sorted.chunk_by_mut(|one, two| one.0 == two.0).for_each(<[_]>::sort_unstable);
    sorted
}

/// Octave of the cells in which a ball lies, at least as wide as the ball: `⌈log₂ 2r⌉`. Two balls
/// of one octave that overlap lie in neighbouring cells.
fn level(ball: &Ball) -> i32 {
    math::log2(2.0 * ball.radius).ceil() as i32
}

/// A finer grid with more than this times the balls of the next coarser one is worth its cost (–).
const FINER_GRID_FACTOR: usize = 8;

/// Octaves that have a grid of their own: one that is slightly finer than a grid with many balls
/// has none.
struct Grids(Vec<(i32, i32)>);

impl Grids {
    fn of(balls: &[Ball]) -> Self {
        let mut levels: Vec<i32> = balls.iter().map(level).collect();
        levels.sort_unstable();
        let mut grids: Vec<(i32, i32)> = Vec::new();
        // from the coarsest down: the level, the grid it shares, and the number of balls in it
        let mut shared: Option<(i32, usize)> = None;
        for chunk in levels.chunk_by(|a, b| a == b).rev() {
            let (own, count) = (chunk[0], chunk.len());
            let joins = shared
                .filter(|(grid, balls)| grid - own == 1 && FINER_GRID_FACTOR * balls >= count);
            let (grid, balls) = joins.unwrap_or((own, 0));
            shared = Some((grid, balls + count));
            grids.push((own, grid));
        }
        Self(grids)
    }

    fn level(&self, ball: &Ball) -> i32 {
        let own = level(ball);
        self.0.iter().find(|known| known.0 == own).map_or(own, |known| known.1)
    }
}

/// The cell of a ball. Cell numbers are integers, so a point near an edge is on the same side of it
/// for every query.
fn entry(ball: &Ball, level: i32, k: u32) -> CellEntry {
    let cell = 2.0f64.powi(level);
    let [x, y, z]: [f64; 3] = (ball.centre / cell).into();
    (level, [x.floor() as i64, y.floor() as i64, z.floor() as i64], k)
}

/// Calls `visit` for every two balls in neighbouring cells of the same size. Balls are visited in
/// the order of their cells, and so are the first ones of each neighbouring column: no search is
/// needed.
fn visit_own(entries: &[CellEntry], visit: &mut impl FnMut(u32, u32)) {
    // one cursor per neighbouring column: together they pass the list once
    let mut first = [0; NEXT_COLUMNS.len()];
    for (place, &(level, [x, y, z], k)) in entries.iter().enumerate() {
        for (first, [dx, dy]) in first.iter_mut().zip(NEXT_COLUMNS) {
            let column = |z: i64| (level, [x + dx, y + dy, z]);
            while entries.get(*first).is_some_and(|entry| (entry.0, entry.1) < column(z - 1)) {
                *first += 1;
            }
            let start = if [dx, dy] == [0, 0] { place + 1 } else { *first };
            let near = entries[start..].iter();
            near.take_while(|entry| (entry.0, entry.1) <= column(z + 1))
                .for_each(|e| visit(k, e.2));
        }
    }
}

/// Calls `visit` for all balls in the 27 cells around `home`; three cells above each other are
/// contiguous in the list.
fn visit_coarser(
    entries: &[CellEntry],
    (level, home): (i32, [i64; 3]),
    mut visit: impl FnMut(u32),
) {
    for x in home[0] - 1..=home[0] + 1 {
        for y in home[1] - 1..=home[1] + 1 {
            let first = (level, [x, y, home[2] - 1], 0);
            let last = (level, [x, y, home[2] + 1], u32::MAX);
            let start = entries.partition_point(|entry| *entry < first);
            entries[start..].iter().take_while(|entry| **entry <= last).for_each(|e| visit(e.2));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The reference is the comparison of all with all; radii span a factor of 1000.
        #[test]
        fn the_grids_find_every_pair(
            list in proptest::collection::vec(
                ((-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64), -3.0..0.0f64), 0..120)
        ) {
            let balls: Vec<Ball> = list
                .iter()
                .map(|((x, y, z), size)| Ball { centre: Vec3::new(*x, *y, *z), radius: 10.0f64.powf(*size) })
                .collect();
            let mut all = Vec::new();
            for a in 0..balls.len() {
                for b in a + 1..balls.len() {
                    if (balls[a].centre - balls[b].centre).norm_squared()
                        <= (balls[a].radius + balls[b].radius).powi(2)
                    {
                        all.push((a as u32, b as u32));
                    }
                }
            }
            prop_assert_eq!(overlapping(&balls), all);
        }
    }
}

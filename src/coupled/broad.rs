//! Which rocks are near each other: grids of several sizes, one for each octave of radii.

use crate::rock::Vec3;

/// A ball that holds a rock wherever it may go for a while.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Centre (m).
    pub centre: Vec3,
    /// Radius (m), positive.
    pub radius: f64,
}

/// One ball in its cell.
type Entry = (i32, [i64; 3], u32);

/// All pairs `(a, b)`, `a < b`, of balls that overlap or touch, in ascending order.
///
/// Each ball lies in one cell of the grid whose cells are between one and two of its diameters wide, and is compared
/// with its neighbours there and in coarser grids: the work is near-linear in the number of balls, whatever their sizes.
pub fn overlapping(balls: &[Ball]) -> Vec<(u32, u32)> {
    let mut entries: Vec<Entry> =
        balls.iter().zip(0..).map(|(ball, k)| entry(ball, level(ball), k)).collect();
    entries.sort_unstable();
    let mut levels: Vec<i32> = entries.iter().map(|entry| entry.0).collect();
    levels.dedup();
    let mut pairs = Vec::with_capacity(4 * balls.len());
    let mut cursors = Cursors::default();
    for &(own, home, k) in &entries {
        let ball = &balls[k as usize];
        let mut see = |other: u32, once: bool| {
            let near = &balls[other as usize];
            let reach = ball.radius + near.radius;
            if once && (ball.centre - near.centre).norm_squared() <= reach * reach {
                pairs.push((k.min(other), k.max(other)));
            }
        };
        cursors.visit(&entries, (own, home), |other| see(other, other > k));
        for &level in levels.iter().filter(|level| **level > own) {
            let home = entry(ball, level, k).1;
            visit(&entries, (level, home), |other| see(other, true));
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Where the nine columns of cells around the ball in hand begin: balls come in the order of their cells, and so do
/// their neighbours.
#[derive(Default)]
struct Cursors([usize; 9]);

impl Cursors {
    /// Visits all balls in the 27 cells around `home`, which comes after those visited before.
    fn visit(
        &mut self,
        entries: &[Entry],
        (level, home): (i32, [i64; 3]),
        mut see: impl FnMut(u32),
    ) {
        for (cursor, column) in self.0.iter_mut().zip(0..) {
            let (x, y) = (home[0] + column / 3 - 1, home[1] + column % 3 - 1);
            let first = (level, [x, y, home[2] - 1], 0);
            while entries.get(*cursor).is_some_and(|entry| *entry < first) {
                *cursor += 1;
            }
            let last = (level, [x, y, home[2] + 1], u32::MAX);
            entries[*cursor..].iter().take_while(|entry| **entry <= last).for_each(|e| see(e.2));
        }
    }
}

/// Octave of the cells a ball lies in: they are at least as wide as the ball.
fn level(ball: &Ball) -> i32 {
    (2.0 * ball.radius).log2().ceil() as i32
}

fn entry(ball: &Ball, level: i32, k: u32) -> Entry {
    let cell = 2.0f64.powi(level);
    let [x, y, z]: [f64; 3] = (ball.centre / cell).into();
    (level, [x.floor() as i64, y.floor() as i64, z.floor() as i64], k)
}

/// Visits all balls in the 27 cells around `home`; the three above each other are one stretch of the list.
fn visit(entries: &[Entry], (level, home): (i32, [i64; 3]), mut see: impl FnMut(u32)) {
    for x in home[0] - 1..=home[0] + 1 {
        for y in home[1] - 1..=home[1] + 1 {
            let first = (level, [x, y, home[2] - 1], 0);
            let last = (level, [x, y, home[2] + 1], u32::MAX);
            let start = entries.partition_point(|entry| *entry < first);
            entries[start..].iter().take_while(|entry| **entry <= last).for_each(|e| see(e.2));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Nothing but the comparison of all with all defines the answer; radii span a factor of 1000.
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

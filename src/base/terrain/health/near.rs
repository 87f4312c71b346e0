//! Points in plan view by square cells: what lies near a place.

use crate::rock::Vec3;

/// Points by the cell that they lie in.
pub(super) struct PlanCells {
    size_m: f64,
    /// Row, column and number of each point.
    sorted: Vec<([i64; 2], u32)>,
}

impl PlanCells {
    /// `size_m` is the side of a cell, positive.
    pub(super) fn of(points: &[Vec3], size_m: f64) -> Self {
        let mut sorted: Vec<([i64; 2], u32)> =
            (0..).zip(points).map(|(k, point)| (cell(point, size_m), k)).collect();
        sorted.sort_unstable();
        Self { size_m, sorted }
    }

    /// Numbers of the points in the cell of a place and in the eight around it: all that are nearer than a cell is wide.
    pub(super) fn near(&self, place: &Vec3) -> impl Iterator<Item = u32> + '_ {
        let [row, column] = cell(place, self.size_m);
        (row.saturating_sub(1)..=row.saturating_add(1)).flat_map(move |row| {
            let from =
                self.sorted.partition_point(|(cell, _)| *cell < [row, column.saturating_sub(1)]);
            let in_row =
                move |(cell, _): &&([i64; 2], u32)| *cell <= [row, column.saturating_add(1)];
            self.sorted[from..].iter().take_while(in_row).map(|&(_, number)| number)
        })
    }
}

/// Row and column of a place.
fn cell(place: &Vec3, size_m: f64) -> [i64; 2] {
    [place.y, place.x].map(|m| (m / size_m).floor() as i64)
}

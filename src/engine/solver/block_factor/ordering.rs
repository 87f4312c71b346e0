//! Elimination order of the rocks of an island, and the pattern of the factor.
//!
//! Approximate minimum degree (Amestoy, Davis & Duff 1996) on the graph of rocks, by faer. It uses
//! integers only, so the order is the same on every machine.
//!
//! Eliminating a rock couples all its remaining neighbours: that is the fill. Eliminating the rock
//! with the fewest neighbours first keeps it small; for heaps, whose graphs are like grids in
//! space, far below that of any order by position.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Order of elimination and pattern of the factor; rows and columns count places in the order.
#[derive(Debug, Default)]
pub(super) struct Ordering {
    /// Place of each rock in the order.
    pub(super) place: Vec<usize>,
    /// Start of the rows of each column, and the end of the last.
    pub(super) starts: Vec<usize>,
    /// Rows below the diagonal, column by column, ascending.
    pub(super) rows: Vec<usize>,
}

impl Ordering {
    /// Orders `rocks` rocks of which these pairs are coupled.
    pub(super) fn of(rocks: usize, pairs: &[(usize, usize)]) -> Self {
        let place = places(rocks, pairs);
        // Columns of the matrix in the new order, then of its factor: the rows of a column below
        // its first row are added to the column of that row.
        let mut columns = vec![Vec::new(); rocks];
        for (a, b) in pairs.iter().map(|&(a, b)| (place[a], place[b])) {
            columns[a.min(b)].push(a.max(b));
        }
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for k in 0..rocks {
            let mut column = std::mem::take(&mut columns[k]);
            column.sort_unstable();
            column.dedup();
            if let Some((&first, rest)) = column.split_first() {
                // the elimination tree: the first row below the diagonal is the parent, and
                // inherits the rest of the column
                columns[first].extend_from_slice(rest);
            }
            rows.extend(column);
            starts.push(rows.len());
        }
        Self { place, starts, rows }
    }
}

/// The place of each rock in the order; the given order if none can be found.
fn places(rocks: usize, pairs: &[(usize, usize)]) -> Vec<usize> {
    let mut lower = vec![Vec::new(); rocks];
    for &(a, b) in pairs {
        lower[a.min(b)].push(a.max(b));
    }
    let (mut starts, mut rows) = (vec![0], Vec::with_capacity(rocks + pairs.len()));
    for (k, column) in lower.iter_mut().enumerate() {
        column.sort_unstable();
        column.dedup();
        rows.push(k);
        rows.extend_from_slice(column);
        starts.push(rows.len());
    }
    let graph = SymbolicSparseColMatRef::new_checked(rocks, rocks, &starts, None, &rows);
    let (mut order, mut place) = (vec![0; rocks], vec![0; rocks]);
    let need = amd::order_maybe_unsorted_scratch::<usize>(rocks, rows.len());
    let mut contact_history = MemBuffer::new(need);
    let stack = MemStack::new(&mut contact_history);
    let control = amd::Control::default();
    match amd::order_maybe_unsorted(&mut order, &mut place, graph, control, stack) {
        Ok(_) => place,
        Err(_) => (0..rocks).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of the factor of a graph in a given order, by elimination as it is defined.
    fn by_definition(
        rocks: usize,
        pairs: &[(usize, usize)],
        place: &[usize],
    ) -> Vec<(usize, usize)> {
        let mut joined = vec![vec![false; rocks]; rocks];
        for &(a, b) in pairs {
            let (a, b) = (place[a], place[b]);
            (joined[a][b], joined[b][a]) = (true, true);
        }
        let mut found = Vec::new();
        for k in 0..rocks {
            let rows: Vec<usize> = (k + 1..rocks).filter(|&row| joined[k][row]).collect();
            found.extend(rows.iter().map(|&row| (k, row)));
            for &a in &rows {
                for &b in &rows {
                    joined[a][b] = true;
                }
            }
        }
        found
    }

    fn pattern(ordering: &Ordering) -> Vec<(usize, usize)> {
        let column = |k: usize| {
            let rows = &ordering.rows[ordering.starts[k]..ordering.starts[k + 1]];
            rows.iter().map(move |&row| (k, row))
        };
        (0..ordering.place.len()).flat_map(column).collect()
    }

    /// A grid of rocks with some diagonals.
    fn grid(side: usize) -> Vec<(usize, usize)> {
        let at = |i: usize, j: usize| side * i + j;
        let mut pairs = Vec::new();
        for i in 0..side {
            for j in 0..side {
                if i + 1 < side {
                    pairs.push((at(i + 1, j), at(i, j)));
                }
                if j + 1 < side {
                    pairs.push((at(i, j + 1), at(i, j)));
                }
                if (i * 7 + j * 3) % 4 == 0 && i + 1 < side && j + 1 < side {
                    pairs.push((at(i + 1, j + 1), at(i, j)));
                }
            }
        }
        pairs
    }

    #[test]
    fn the_pattern_is_that_of_elimination() {
        let star: Vec<(usize, usize)> = (1..9).map(|k| (k, 0)).collect();
        for (rocks, pairs) in [(9, star), (64, grid(8)), (3, Vec::new())] {
            let ordering = Ordering::of(rocks, &pairs);
            let mut places = ordering.place.clone();
            places.sort_unstable();
            assert!(places.iter().copied().eq(0..rocks), "{places:?}");
            assert_eq!(pattern(&ordering), by_definition(rocks, &pairs, &ordering.place));
        }
    }

    /// A star has no fill when its middle comes late; of a grid, minimum degree leaves a good part
    /// of the band's fill out.
    #[test]
    fn the_order_keeps_the_fill_small() {
        let star: Vec<(usize, usize)> = (1..9).map(|k| (k, 0)).collect();
        assert_eq!(Ordering::of(9, &star).rows.len(), 8);
        let (side, pairs) = (24, grid(24));
        let found = Ordering::of(side * side, &pairs).rows.len();
        let straight: Vec<usize> = (0..side * side).collect();
        let band = by_definition(side * side, &pairs, &straight).len();
        assert!(3 * found < 2 * band, "{found} of {band}");
    }
}

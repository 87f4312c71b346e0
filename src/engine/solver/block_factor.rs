//! The system of an island in blocks of 6×6, factorised: `A = L U` with the blocks of `U` on the
//! diagonal the identity.
//!
//! The factorisation is our own although a library would be faster: libraries choose their kernels,
//! and with them the order of their sums, by the processor and its cache sizes, and a world must
//! have the same bytes on every machine. It uses one thread: islands are computed in parallel.
//!
//! ```text
//! pivot_k = A_kk − Σ_{j<k} L_kj U_jk
//! L_rk    = A_rk − Σ_j L_rj U_jk,        U_kr = pivot_k⁻¹ (A_kr − Σ_j L_kj U_jr)      r > k
//! ```
//!
//! Crout's form: `L` keeps the pivots' size, so that with `A` symmetric `U_kr = pivot_k⁻¹ L_rkᵀ`
//! and half of the work is saved. No pivoting between blocks: diagonal blocks carry inertia and are
//! far from singular. Cost: O(fill) products of 6×6.

mod ordering;

use crate::contact::submatrix::{Mat6, Vec6};
use nalgebra::{Cholesky, Const, LU};
use ordering::Ordering;

/// A block below the diagonal: row and column by rocks, row > column.
pub(super) type LowerBlock = (usize, usize, Mat6);

/// A system: one diagonal block for each rock, and the blocks that couple rocks. Sorted by column
/// and row, each block once.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockSystem<'a> {
    pub(super) diagonal: &'a [Mat6],
    pub(super) below: &'a [LowerBlock],
    /// The transposed position of each block below; `None` for a symmetric, positive definite
    /// system.
    pub(super) above: Option<&'a [Mat6]>,
}

/// A factor whose pattern is kept while the same rocks are coupled. Order and pattern cost more
/// than the numbers; a heap at rest keeps them for thousands of steps.
#[derive(Debug, Default)]
pub(super) struct BlockFactor {
    /// Rows and columns of the blocks below the diagonal.
    pattern: Vec<(usize, usize)>,
    ordering: Ordering,
    /// Position in the factor of each block below the diagonal, and whether it is transposed there.
    positions: Vec<(usize, bool)>,
    /// `L`, in the order of the pattern.
    lower: Vec<Mat6>,
    /// `Uᵀ`, likewise.
    upper: Vec<Mat6>,
    pivots: Vec<Pivot>,
    pending: PendingColumns,
    /// Number of symbolic analyses.
    pub(super) analysed: u64,
}

/// A factorised block of the diagonal.
#[derive(Debug)]
enum Pivot {
    Symmetric(Cholesky<f64, Const<6>>),
    General(LU<f64, Const<6>, Const<6>>),
}

/// Columns that contribute to later ones: each waits at the first of its rows that is still to be
/// eliminated.
///
/// Linked lists through the columns, as in sparse Cholesky by columns (George and Liu 1981): O(1)
/// to find the columns that reach row k.
#[derive(Debug, Default)]
struct PendingColumns {
    /// Linked lists of the columns that wait at each row: the first, and after each the next.
    first: Vec<Option<usize>>,
    after: Vec<Option<usize>>,
    /// Position in its rows at which each column waits.
    at: Vec<usize>,
    /// Position of each row in the current column.
    slot: Vec<usize>,
}

impl BlockFactor {
    /// Solves a system for `load` in place, six numbers a rock; `None` where [`Self::factorise`]
    /// finds none.
    pub(super) fn solve(&mut self, blocks: BlockSystem, load: &mut [f64]) -> Option<()> {
        self.factorise(blocks)?;
        self.substitute(load)
    }

    /// Factorises a system for [`Self::substitute`]; `None` where a pivot is singular, or not
    /// positive definite in a symmetric system.
    pub(super) fn factorise(&mut self, blocks: BlockSystem) -> Option<()> {
        let known = self.pattern.iter();
        let same = self.ordering.place.len() == blocks.diagonal.len()
            && self.pattern.len() == blocks.below.len()
            && known.zip(blocks.below).all(|(at, block)| *at == (block.0, block.1));
        if !same {
            self.analyse(blocks);
        }
        self.fill(blocks);
        self.eliminate(blocks)
    }

    /// Computes order and pattern anew, and the position of each block in it.
    fn analyse(&mut self, blocks: BlockSystem) {
        self.analysed += 1;
        self.pattern = blocks.below.iter().map(|block| (block.0, block.1)).collect();
        self.ordering = Ordering::of(blocks.diagonal.len(), &self.pattern);
        let Ordering { place, starts, rows } = &self.ordering;
        // in the elimination order a block may be on the other side of the diagonal: then it is the
        // other half of the pair
        let position = |&(row, column): &(usize, usize)| {
            let transposed = place[row] < place[column];
            let (row, column) = (place[row].max(place[column]), place[row].min(place[column]));
            let rows = &rows[starts[column]..starts[column + 1]];
            (starts[column] + rows.partition_point(|&one| one < row), transposed)
        };
        self.positions = self.pattern.iter().map(position).collect();
    }

    /// Copies the blocks of the matrix to their positions; the rest of the pattern is fill and
    /// starts as zero.
    fn fill(&mut self, blocks: BlockSystem) {
        let size = self.ordering.rows.len();
        for half in [&mut self.lower, &mut self.upper] {
            half.clear();
            half.resize(size, Mat6::zeros());
        }
        for (k, ((_, _, below), &(position, transposed))) in
            blocks.below.iter().zip(&self.positions).enumerate()
        {
            let above = blocks.above.map_or_else(|| below.transpose(), |above| above[k]);
            let (lower, upper) = if transposed { (above, *below) } else { (*below, above) };
            self.lower[position] += lower;
            self.upper[position] += upper.transpose();
        }
    }

    /// Column by column, each after those that reach it.
    fn eliminate(&mut self, blocks: BlockSystem) -> Option<()> {
        let Self { ordering: Ordering { place, starts, rows }, lower, upper, pending, .. } = self;
        let symmetric = blocks.above.is_none();
        let mut diagonal = vec![Mat6::zeros(); place.len()];
        place.iter().zip(blocks.diagonal).for_each(|(&at, block)| diagonal[at] = *block);
        pending.begin(place.len());
        self.pivots.clear();
        for (k, pivot) in diagonal.iter_mut().enumerate() {
            let (begin, end) = (starts[k], starts[k + 1]);
            rows[begin..end].iter().enumerate().for_each(|(slot, &row)| pending.slot[row] = slot);
            let (known_l, own_l) = lower.split_at_mut(begin);
            let (known_u, own_u) = upper.split_at_mut(begin);
            let mut waiting = pending.first[k];
            while let Some(j) = waiting {
                waiting = pending.after[j];
                let at = pending.at[j];
                let (l, u) = (known_l[at], known_u[at]);
                // A_kk less the products of the rows above, then the column below, then
                // (unsymmetric only) the row beside it
                subtract_product(pivot, &known_l[at], &u);
                for r in at + 1..starts[j + 1] {
                    let slot = pending.slot[rows[r]];
                    subtract_product(&mut own_l[slot], &known_l[r], &u);
                    if !symmetric {
                        subtract_product(&mut own_u[slot], &known_u[r], &l);
                    }
                }
                pending.wait(j, at + 1, &rows[..starts[j + 1]]);
            }
            let pivot = Pivot::of(pivot, symmetric)?;
            for (l, u) in own_l[..end - begin].iter().zip(&mut own_u[..end - begin]) {
                let mut row = if symmetric { l.transpose() } else { u.transpose() };
                pivot.solve(&mut row)?;
                *u = row.transpose();
            }
            self.pivots.push(pivot);
            pending.wait(k, begin, &rows[..end]);
        }
        Some(())
    }

    /// `L y = b`, then `U x = y`.
    /// The load is first permuted to the elimination order, and the solution permuted back.
    pub(super) fn substitute(&self, load: &mut [f64]) -> Option<()> {
        let Ordering { place, starts, rows } = &self.ordering;
        let mut x = vec![Vec6::zeros(); place.len()];
        for (&at, six) in place.iter().zip(load.chunks_exact(6)) {
            x[at] = Vec6::from_column_slice(six);
        }
        for (k, pivot) in self.pivots.iter().enumerate() {
            pivot.solve(&mut x[k])?;
            let own = x[k];
            for r in starts[k]..starts[k + 1] {
                x[rows[r]] -= self.lower[r] * own;
            }
        }
        for k in (0..x.len()).rev() {
            let mut own = x[k];
            for r in starts[k]..starts[k + 1] {
                own -= self.upper[r].tr_mul(&x[rows[r]]);
            }
            x[k] = own;
        }
        for (&at, six) in place.iter().zip(load.chunks_exact_mut(6)) {
            six.copy_from_slice(x[at].as_slice());
        }
        Some(())
    }
}

/// `c − a bᵀ` in place.
///
/// Loops in fixed order, unrolled by the compiler; no library kernel whose summation order depends
/// on the processor.
#[inline]
fn subtract_product(c: &mut Mat6, a: &Mat6, b: &Mat6) {
    for j in 0..6 {
        let mut column = c.column(j).into_owned();
        for k in 0..6 {
            let factor = b[(j, k)];
            for i in 0..6 {
                column[i] -= a[(i, k)] * factor;
            }
        }
        c.set_column(j, &column);
    }
}

impl Pivot {
    fn of(block: &Mat6, symmetric: bool) -> Option<Self> {
        if symmetric {
            return Cholesky::new(*block).map(Self::Symmetric);
        }
        let factor = LU::new(*block);
        factor.is_invertible().then_some(Self::General(factor))
    }

    fn solve<const C: usize>(&self, right: &mut nalgebra::SMatrix<f64, 6, C>) -> Option<()> {
        match self {
            Self::Symmetric(factor) => factor.solve_mut(right),
            Self::General(factor) => return factor.solve_mut(right).then_some(()),
        }
        Some(())
    }
}

impl PendingColumns {
    fn begin(&mut self, rocks: usize) {
        for list in [&mut self.first, &mut self.after] {
            list.clear();
            list.resize(rocks, None);
        }
        for list in [&mut self.at, &mut self.slot] {
            list.clear();
            list.resize(rocks, 0);
        }
    }

    /// Makes column `j` wait at the row at position `at` of `rows`, which end with its own; nothing
    /// after the last.
    fn wait(&mut self, j: usize, at: usize, rows: &[usize]) {
        let Some(&row) = rows.get(at) else { return };
        self.at[j] = at;
        self.after[j] = self.first[row].replace(j);
    }
}
#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    fn value(k: usize) -> f64 {
        ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5
    }

    /// Blocks on the diagonal, below and above it, of a grid of `side²` rocks.
    fn system(side: usize, round: usize) -> (Vec<Mat6>, Vec<LowerBlock>, Vec<Mat6>) {
        let rocks = side * side;
        let diagonal = (0..rocks).map(|k| Mat6::identity() * (20 + k % 5 + round) as f64).collect();
        let mut below = Vec::new();
        let block = |seed: usize| Mat6::from_fn(|i, j| value(97 * seed + 6 * i + j + round));
        for k in 0..rocks {
            if (k + 1) % side != 0 {
                below.push((k + 1, k, block(below.len())));
            }
            if k + side < rocks {
                below.push((k + side, k, block(below.len())));
            }
        }
        let above = (0..below.len()).map(|k| block(k + 1000)).collect();
        (diagonal, below, above)
    }

    /// By how much a solution fails the dense system, relative to its right side.
    fn off(blocks: BlockSystem, right: &DVector<f64>, solution: Vec<f64>) -> f64 {
        let size = right.len();
        let mut dense = DMatrix::zeros(size, size);
        for (k, block) in blocks.diagonal.iter().enumerate() {
            dense.view_mut((6 * k, 6 * k), (6, 6)).copy_from(block);
        }
        for (k, (row, column, below)) in blocks.below.iter().enumerate() {
            let above = blocks.above.map_or_else(|| below.transpose(), |above| above[k]);
            dense.view_mut((6 * row, 6 * column), (6, 6)).copy_from(below);
            dense.view_mut((6 * column, 6 * row), (6, 6)).copy_from(&above);
        }
        (&dense * DVector::from_vec(solution) - right).norm() / right.norm()
    }

    /// Symmetric and not; the second solve keeps the pattern.
    #[test]
    fn the_sparse_solution_is_the_dense_one() {
        for (side, symmetric) in [(2, true), (2, false), (6, true), (6, false)] {
            let mut factor = BlockFactor::default();
            for round in 0..2 {
                let (diagonal, below, above) = system(side, round);
                let above = (!symmetric).then_some(&above[..]);
                let blocks = BlockSystem { diagonal: &diagonal, below: &below, above };
                let right = DVector::from_fn(6 * side * side, |k, _| value(k));
                let mut load: Vec<f64> = right.iter().copied().collect();
                factor.solve(blocks, &mut load).unwrap();
                let off = off(blocks, &right, load);
                assert!(off < 1e-14, "{side} {symmetric}: {off:e}");
            }
            assert_eq!(factor.analysed, 1);
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_no_solution() {
        let mut load = vec![1.0; 6];
        let (negative, nothing) = ([-Mat6::identity()], [Mat6::zeros()]);
        let symmetric = BlockSystem { diagonal: &negative, below: &[], above: None };
        assert_eq!(BlockFactor::default().solve(symmetric, &mut load), None);
        let general = BlockSystem { diagonal: &nothing, below: &[], above: Some(&[]) };
        assert_eq!(BlockFactor::default().solve(general, &mut load), None);
    }
}

//! Sparse Cholesky of a symmetric system of 6×6 blocks.
//!
//! Rocks are ordered, not unknowns (approximate minimum degree on the graph of rocks: a third of the time of the scalar
//! ordering at the same fill), and the supernodal form is forced: faer would choose the simplicial one for flat
//! deposits, which takes twice as long. One thread: islands are what is computed at once.

use crate::contact::submatrix::Mat6;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// A block below the diagonal: row and column among the rocks, row > column.
pub(super) type Below = (usize, usize, Mat6);

/// A factor whose symbolic part is kept as long as the same rocks are joined.
#[derive(Debug, Default)]
pub(super) struct Factor {
    rocks: usize,
    /// Where the blocks below the diagonal stand.
    joined: Vec<(usize, usize)>,
    columns: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    symbolic: Option<SymbolicCholesky<usize>>,
    lower: Vec<f64>,
    memory: Memory,
    /// How often the symbolic part was made anew.
    pub(super) analysed: u64,
}

/// The work space of factor and solve.
#[derive(Default)]
struct Memory(Option<MemBuffer>);

impl std::fmt::Debug for Memory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("work space")
    }
}

impl Factor {
    /// Solves the system of `diagonal` and `below` (in ascending order of column and row) for `load` in place; `None` if
    /// it is not positive definite.
    pub(super) fn solve(
        &mut self,
        diagonal: &[Mat6],
        below: &[Below],
        load: &mut [f64],
    ) -> Option<()> {
        let same = self.rocks == diagonal.len()
            && self.joined.len() == below.len()
            && self.joined.iter().zip(below).all(|(at, block)| *at == (block.0, block.1));
        if !same {
            self.analyse(diagonal.len(), below)?;
        }
        self.fill(diagonal, below);
        let size = 6 * self.rocks;
        let symbolic = self.symbolic.as_ref()?;
        let pattern =
            SymbolicSparseColMatRef::new_checked(size, size, &self.columns, None, &self.rows);
        let stack = MemStack::new(self.memory.0.as_mut()?);
        symbolic
            .factorize_numeric_llt(
                &mut self.lower,
                SparseColMatRef::new(pattern, &self.values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                stack,
                faer::Spec::default(),
            )
            .ok()?;
        let right = MatMut::from_column_major_slice_mut(load, size, 1);
        LltRef::new(symbolic, &self.lower).solve_in_place_with_conj(
            Conj::No,
            right,
            Par::Seq,
            MemStack::new(self.memory.0.as_mut()?),
        );
        Some(())
    }

    /// Pattern, ordering and shape of the factor.
    fn analyse(&mut self, rocks: usize, below: &[Below]) -> Option<()> {
        self.analysed += 1;
        self.rocks = rocks;
        self.joined = below.iter().map(|block| (block.0, block.1)).collect();
        (self.columns, self.rows) = scalar_pattern(rocks, &self.joined);
        self.values.clear();
        self.values.resize(self.rows.len(), 0.0);
        let (forward, inverse) = order(rocks, &self.joined)?;
        let size = 6 * rocks;
        let pattern =
            SymbolicSparseColMatRef::new_checked(size, size, &self.columns, None, &self.rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, size));
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, ordering, params).ok()?;
        let factor = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, faer::Spec::default());
        let solve = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        self.memory = Memory(Some(MemBuffer::new(factor.or(solve))));
        self.lower.clear();
        self.lower.resize(symbolic.len_val(), 0.0);
        self.symbolic = Some(symbolic);
        Some(())
    }

    /// Values in the order of the pattern.
    fn fill(&mut self, diagonal: &[Mat6], below: &[Below]) {
        let mut next = self.values.iter_mut();
        let mut put = |value: f64| {
            if let Some(place) = next.next() {
                *place = value;
            }
        };
        let mut rest = below;
        for (k, own) in diagonal.iter().enumerate() {
            let count = rest.iter().take_while(|block| block.1 == k).count();
            for j in 0..6 {
                (j..6).for_each(|i| put(own[(i, j)]));
                for (.., block) in &rest[..count] {
                    (0..6).for_each(|i| put(block[(i, j)]));
                }
            }
            rest = &rest[count..];
        }
    }
}

/// Column starts and rows of the lower half, unknown by unknown.
fn scalar_pattern(rocks: usize, joined: &[(usize, usize)]) -> (Vec<usize>, Vec<usize>) {
    let (mut columns, mut rows) = (vec![0], Vec::with_capacity(21 * rocks + 36 * joined.len()));
    let mut rest = joined;
    for k in 0..rocks {
        let count = rest.iter().take_while(|(_, column)| *column == k).count();
        for j in 0..6 {
            rows.extend(6 * k + j..6 * k + 6);
            for (row, _) in &rest[..count] {
                rows.extend(6 * row..6 * row + 6);
            }
            columns.push(rows.len());
        }
        rest = &rest[count..];
    }
    (columns, rows)
}

/// A permutation of the unknowns that keeps each rock's six together, and its inverse.
fn order(rocks: usize, joined: &[(usize, usize)]) -> Option<(Vec<usize>, Vec<usize>)> {
    let (mut columns, mut rows) = (vec![0], Vec::with_capacity(rocks + joined.len()));
    let mut rest = joined;
    for k in 0..rocks {
        let count = rest.iter().take_while(|(_, column)| *column == k).count();
        rows.push(k);
        rows.extend(rest[..count].iter().map(|(row, _)| *row));
        columns.push(rows.len());
        rest = &rest[count..];
    }
    let graph = SymbolicSparseColMatRef::new_checked(rocks, rocks, &columns, None, &rows);
    let (mut forward, mut inverse) = (vec![0; rocks], vec![0; rocks]);
    let need = amd::order_maybe_unsorted_scratch::<usize>(rocks, rows.len());
    let mut memory = MemBuffer::new(need);
    let stack = MemStack::new(&mut memory);
    amd::order_maybe_unsorted(&mut forward, &mut inverse, graph, amd::Control::default(), stack)
        .ok()?;
    let six =
        |order: &[usize]| -> Vec<usize> { order.iter().flat_map(|k| 6 * k..6 * k + 6).collect() };
    Some((six(&forward), six(&inverse)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// A chain and a ring of blocks, factorised sparse and dense; the second solve reuses the symbolic part.
    #[test]
    fn the_sparse_solution_is_the_dense_one() {
        let value = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
        for joined in [vec![(1, 0), (2, 1), (3, 2)], vec![(1, 0), (3, 0), (2, 1), (3, 2)]] {
            let mut factor = Factor::default();
            for round in 0..2u32 {
                let diagonal: Vec<Mat6> = (0..4)
                    .map(|k| Mat6::identity() * (20.0 + f64::from(k) + f64::from(round)))
                    .collect();
                let below: Vec<Below> = joined
                    .iter()
                    .enumerate()
                    .map(|(n, &(row, column))| {
                        let block =
                            Mat6::from_fn(|i, j| value(97 * n + 6 * i + j + round as usize));
                        (row, column, block)
                    })
                    .collect();
                let mut dense = DMatrix::zeros(24, 24);
                for (k, block) in diagonal.iter().enumerate() {
                    dense.view_mut((6 * k, 6 * k), (6, 6)).copy_from(block);
                }
                for (row, column, block) in &below {
                    dense.view_mut((6 * row, 6 * column), (6, 6)).copy_from(block);
                    dense.view_mut((6 * column, 6 * row), (6, 6)).copy_from(&block.transpose());
                }
                let right = DVector::from_fn(24, |k, _| value(k));
                let mut load: Vec<f64> = right.iter().copied().collect();
                factor.solve(&diagonal, &below, &mut load).unwrap();
                let off = (&dense * DVector::from_vec(load) - &right).norm();
                assert!(off < 1e-13 * right.norm(), "{off:e}");
            }
            assert_eq!(factor.analysed, 1);
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_no_solution() {
        let mut load = vec![1.0; 6];
        assert_eq!(Factor::default().solve(&[-Mat6::identity()], &[], &mut load), None);
    }
}

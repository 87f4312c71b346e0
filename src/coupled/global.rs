//! The paper's global system, Eq. (4), of an island in a fixed step: `(2M/Δt² + K) E = F − K D₀` in blocks of 6×6.
//!
//! Rocks that no other touches have a block of their own; the rest is factorised together by sparse Cholesky, whose
//! symbolic part is kept as long as the same rocks touch.

use super::link::Link;
use super::member::Member;
use crate::contact::submatrix::{Mat6, Vec6, inertia};
use faer::Side;
use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use nalgebra::Cholesky;

/// What is kept between solves.
#[derive(Debug, Default)]
pub(super) struct Global {
    /// The links of the symbolic factor: their ends.
    pattern: Vec<[usize; 2]>,
    symbolic: Option<SymbolicLlt<usize>>,
}

impl Global {
    /// Writes into every member what contacts add to its free displacement over `dt`; false if there is no solution.
    pub(super) fn solve(&mut self, members: &mut [Box<Member>], links: &[Link], dt: f64) -> bool {
        let mut blocks: Vec<Mat6> = Vec::with_capacity(members.len());
        let mut loads: Vec<Vec6> = Vec::with_capacity(members.len());
        for member in members.iter() {
            let contacts = member
                .joints
                .iter()
                .fold(Mat6::zeros(), |sum, joint| sum + joint.shape().stiffness());
            let mut load = -(contacts * member.ways[0]);
            member.joints.iter().for_each(|joint| joint.add_load(&mut load));
            blocks.push(contacts + inertia(member.body.mass, member.body.inertia, dt));
            loads.push(load);
        }
        let mut place = vec![usize::MAX; members.len()];
        for link in links {
            for k in 0..2 {
                blocks[link.ends[k]] += link.stiffness(k, k);
                loads[link.ends[k]] += link.load(k);
                for l in 0..2 {
                    let way = members[link.ends[l]].ways[0];
                    loads[link.ends[k]] -= link.stiffness(k, l) * way;
                }
                place[link.ends[k]] = 0;
            }
        }
        let mut linked = 0;
        for (k, member) in members.iter_mut().enumerate() {
            if place[k] == usize::MAX {
                let Some(factor) = Cholesky::new(blocks[k]) else { return false };
                member.ways[1] = factor.solve(&loads[k]);
            } else {
                place[k] = linked;
                linked += 1;
            }
        }
        linked == 0 || self.solve_linked(members, links, &place, (&blocks, &loads)).is_some()
    }

    fn solve_linked(
        &mut self,
        members: &mut [Box<Member>],
        links: &[Link],
        place: &[usize],
        (blocks, loads): (&[Mat6], &[Vec6]),
    ) -> Option<()> {
        let rocks: Vec<usize> = (0..members.len()).filter(|&k| place[k] != usize::MAX).collect();
        let size = 6 * rocks.len();
        let mut triplets = Vec::with_capacity(21 * rocks.len() + 36 * links.len());
        for &k in &rocks {
            push_block(&mut triplets, (place[k], place[k]), &blocks[k]);
        }
        for link in links {
            // the lower half: rows of the later rock
            let ends = (place[link.ends[1]], place[link.ends[0]]);
            push_block(&mut triplets, ends, &link.stiffness(1, 0));
        }
        let matrix = SparseColMat::try_new_from_triplets(size, size, &triplets).ok()?;
        let pattern: Vec<[usize; 2]> = links.iter().map(|link| link.ends).collect();
        if self.symbolic.is_none() || self.pattern != pattern {
            self.symbolic = Some(SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).ok()?);
            self.pattern = pattern;
        }
        let symbolic = self.symbolic.clone()?;
        let factor = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower).ok()?;
        let load = faer::Col::from_fn(size, |row| loads[rocks[row / 6]][row % 6]);
        let x = factor.solve(&load);
        for &k in &rocks {
            members[k].ways[1] = Vec6::from_fn(|row, _| x[6 * place[k] + row]);
        }
        Some(())
    }
}

/// Adds a block; of one on the diagonal the lower half.
fn push_block(
    triplets: &mut Vec<Triplet<usize, usize, f64>>,
    (row, column): (usize, usize),
    block: &Mat6,
) {
    for j in 0..6 {
        for i in (if row == column { j } else { 0 })..6 {
            triplets.push(Triplet::new(6 * row + i, 6 * column + j, block[(i, j)]));
        }
    }
}

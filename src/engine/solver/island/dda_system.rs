//! The paper's global system, Eq. (4), of an island in a fixed step: `(2M/Δt² + K) E = F − K D₀` in blocks of 6×6.
//!
//! Rocks that no other touches have a block of their own; the rest is factorised together, and the
//! pattern is kept as long as the same rocks touch.
//!
//! `K_kk` of a rock is `2M/Δt²` with its contacts; `K_kl` couples two rocks that touch. The matrix
//! is symmetric and positive definite, so blocks are factorised without pivoting.

use super::body::BodySlot;
use super::dda_contact::DdaPairContact;
use crate::contact::submatrix::{Mat6, Vec6, inertia};
use crate::solver::block_factor::{Below, Blocks, Factor};
use nalgebra::Cholesky;

/// What is kept between solves.
#[derive(Debug, Default)]
pub(super) struct Global {
    factor: Factor,
    diagonal: Vec<Mat6>,
    below: Vec<Below>,
    load: Vec<f64>,
}

impl Global {
    /// Writes into every member what contacts add to its free displacement over `dt`; false if there is no solution.
    ///
    /// One block and one load a rock, then the blocks of contacts between rocks. A rock that no
    /// other touches is solved at once; the others are handed to the block factor.
    pub(super) fn solve(
        &mut self,
        members: &mut [BodySlot],
        links: &[DdaPairContact],
        dt: f64,
    ) -> bool {
        let mut blocks: Vec<Mat6> = Vec::with_capacity(members.len());
        let mut loads: Vec<Vec6> = Vec::with_capacity(members.len());
        for member in members.iter() {
            // springs of the rock's contacts with the mesh: they join no other block
            let contacts = member
                .joints
                .iter()
                .fold(Mat6::zeros(), |sum, joint| sum + joint.shape().stiffness());
            let mut load = -(contacts * member.ways[0]);
            member.joints.iter().for_each(|joint| joint.add_load(&mut load));
            // 2M/Δt²: constant acceleration over the step
            blocks.push(contacts + inertia(member.body.mass, member.body.inertia, dt));
            loads.push(load);
        }
        // usize::MAX: no other rock touches it
        let mut place = vec![usize::MAX; members.len()];
        for link in links {
            for k in 0..2 {
                // K_kk and F_k of both ends; K_kl follows below the diagonal
                blocks[link.ends[k]] += link.stiffness(k, k);
                loads[link.ends[k]] += link.load(k);
                for l in 0..2 {
                    // F − K D₀: each contact of two rocks sees the free displacements of both
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
                // alone: a 6×6 system of its own
                member.ways[1] = factor.solve(&loads[k]);
            } else {
                place[k] = linked;
                linked += 1;
            }
        }
        linked == 0 || self.solve_linked(members, links, &place, (&blocks, &loads)).is_some()
    }

    /// Those that touch each other, numbered among themselves: the pattern has no empty rows.
    fn solve_linked(
        &mut self,
        members: &mut [BodySlot],
        links: &[DdaPairContact],
        place: &[usize],
        (blocks, loads): (&[Mat6], &[Vec6]),
    ) -> Option<()> {
        let linked = |k: &usize| place[*k] != usize::MAX;
        self.diagonal.clear();
        self.load.clear();
        for k in (0..members.len()).filter(linked) {
            self.diagonal.push(blocks[k]);
            self.load.extend(loads[k].iter());
        }
        // Pairs stand in ascending order of their ends, and so do the blocks below the diagonal by
        // column and row.
        self.below.clear();
        self.below.extend(
            links
                .iter()
                .map(|link| (place[link.ends[1]], place[link.ends[0]], link.stiffness(1, 0))),
        );
        let blocks = Blocks { diagonal: &self.diagonal, below: &self.below, above: None };
        self.factor.solve(blocks, &mut self.load)?;
        for (k, x) in (0..members.len()).filter(linked).zip(self.load.chunks_exact(6)) {
            members[k].ways[1] = Vec6::from_column_slice(x);
        }
        Some(())
    }
}

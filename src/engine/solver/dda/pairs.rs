//! The contacts between rocks in a fixed step, and the system of the rocks that they couple.
//!
//! `(2M/Δt² + K) E = F − K D₀` in blocks of 6×6, paper Eq. (4): `K_kk` of a rock is `2M/Δt²` with
//! its contacts, `K_kl` couples two rocks that touch. The matrix is symmetric and positive
//! definite, so blocks are factorised without pivoting; its pattern is kept while the same rocks
//! touch, its factors while only loads change.

use super::DEEPEST;
use super::body::DdaBody;
use crate::contact::pair::PairHistory;
use crate::contact::submatrix::{Mat6, Vec6};
use crate::solver::block_factor::{BlockFactor, BlockSystem, LowerBlock};
use crate::solver::dda_system::pair_contact::DdaPairContact;
use crate::solver::dda_system::slider::Change;
use crate::solver::loss::EnergyGiven;
use crate::solver::step_control::StepError;

/// The contacts between rocks; for a rock alone nothing is allocated.
#[derive(Debug, Default)]
pub(in crate::solver) struct DdaPairs {
    pairs: Vec<DdaPairContact>,
    /// Place of each rock in the coupled system; `None` without contact to another rock.
    places: Vec<Option<usize>>,
    factor: Option<Box<BlockFactor>>,
}

impl DdaPairs {
    /// Begins the step with the contacts that are closed or may close within it.
    pub(super) fn begin_step(&mut self, bodies: &[DdaBody], pair_histories: &[PairHistory]) {
        let of_pair = |(k, pair_history): (usize, &PairHistory)| {
            let ends = [pair_history.a, pair_history.b].map(|end| &bodies[end as usize]);
            let steps = ends.map(|end| &end.state.scratch.step);
            DdaPairContact::of_pair((k, pair_history), steps, ends.map(|end| &end.state.c))
        };
        self.pairs.clear();
        self.pairs.extend(pair_histories.iter().enumerate().filter_map(of_pair));
        self.places.clear();
        if !self.pairs.is_empty() {
            self.places.resize(bodies.len(), None);
        }
        self.pairs.iter().flat_map(|pair| pair.ends).for_each(|end| self.places[end] = Some(0));
        // numbered consecutively: the pattern has no empty rows
        self.places.iter_mut().flatten().enumerate().for_each(|(k, place)| *place = k);
    }

    /// Solves Eq. (4), rocks without contact to others one by one, the others together; the matrix
    /// is rebuilt if contacts have changed it. `None` if there is no solution.
    pub(super) fn solve(&mut self, bodies: &mut [DdaBody], is_new: bool) -> Option<()> {
        let mut load = Vec::new();
        for (k, body) in bodies.iter_mut().enumerate() {
            if self.places.get(k).is_some_and(Option::is_some) {
                load.extend(body.state.scratch.load().iter());
            } else {
                body.state.scratch.solve()?;
            }
        }
        if self.pairs.is_empty() {
            return Some(());
        }
        if is_new {
            self.factorise(bodies)?;
        }
        for pair in &self.pairs {
            let free = pair
                .relative_displacement(pair.ends.map(|end| &bodies[end].state.scratch.step.free));
            for (k, end) in pair.ends.into_iter().enumerate() {
                let own = load[6 * self.places[end]?..].iter_mut();
                own.zip(&pair.load(k, &free)).for_each(|(sum, load)| *sum += load);
            }
        }
        self.factor.as_ref()?.substitute(&mut load)?;
        let joined = bodies.iter_mut().zip(&self.places).filter(|(_, place)| place.is_some());
        let mut solved = joined.zip(load.chunks_exact(6));
        solved.try_for_each(|((body, _), x)| {
            body.state.scratch.set_solution(Vec6::from_column_slice(x))
        })
    }

    /// Factorises the blocks of the coupled rocks and of the contacts between them.
    ///
    /// Pairs stand in ascending order of their ends, and so do the blocks below the diagonal by
    /// column and row.
    fn factorise(&mut self, bodies: &[DdaBody]) -> Option<()> {
        let joined = bodies.iter().zip(&self.places).filter(|(_, place)| place.is_some());
        let mut diagonal: Vec<Mat6> = joined.map(|(body, _)| body.state.scratch.block()).collect();
        let mut below: Vec<LowerBlock> = Vec::with_capacity(self.pairs.len());
        for pair in &self.pairs {
            let [a, b] = pair.ends.map(|end| self.places[end]);
            let (a, b) = (a?, b?);
            diagonal[a] += pair.stiffness(0, 0);
            diagonal[b] += pair.stiffness(1, 1);
            below.push((b, a, pair.stiffness(1, 0)));
        }
        let blocks = BlockSystem { diagonal: &diagonal, below: &below, above: None };
        self.factor.get_or_insert_default().factorise(blocks)
    }

    /// Updates the contact states by the displacements found; the largest change.
    pub(super) fn update_state(&mut self, bodies: &[DdaBody]) -> Change {
        let pairs = self.pairs.iter_mut();
        let changes = pairs.map(|pair| {
            pair.contact.update_state(&pair.relative_displacement(displacements(pair, bodies)))
        });
        changes.max().unwrap_or(Change::None)
    }

    /// Fixes the contact states for the fallback solution.
    pub(super) fn stick(&mut self) {
        self.pairs.iter_mut().for_each(|pair| pair.contact.stick());
    }

    /// Opens or closes the last contact that begins apart and has to change; whether there is one.
    pub(super) fn open_or_close_one_apart(&mut self, bodies: &[DdaBody]) -> bool {
        let mut pairs = self.pairs.iter_mut().rev();
        pairs.any(|pair| {
            pair.contact
                .open_or_close_apart(&pair.relative_displacement(displacements(pair, bodies)))
        })
    }

    /// Ends the step: writes the contact histories, and books the energy that each end gave to the
    /// other (J); the number of broken bonds.
    ///
    /// Energy: the work of a contact on each of its ends; half of what the contact itself takes is
    /// booked at each.
    ///
    /// # Errors
    /// [`StepError::SankIn`] if a contact is deeper than the springs are meant for: the step is too long for them.
    pub(super) fn finish_step(
        &self,
        bodies: &mut [DdaBody],
        pair_histories: &mut [PairHistory],
    ) -> Result<u64, StepError> {
        pair_histories.iter_mut().for_each(PairHistory::separate);
        let mut broken = 0;
        for pair in &self.pairs {
            let d = displacements(pair, bodies);
            if pair.relative_displacement(d).depth > DEEPEST * pair.contact.radius {
                return Err(StepError::SankIn);
            }
            let (given, lost) = (EnergyGiven::of_ends(pair.given_j(d)), 0.5 * pair.taken_j(d));
            broken += u64::from(pair.write_history(d, &mut pair_histories[pair.contact.history]));
            for (end, given) in pair.ends.into_iter().zip(given) {
                bodies[end].given.add(&EnergyGiven { lost, ..given }, 1.0);
            }
        }
        Ok(broken)
    }
}

/// Displacements of a pair's ends.
fn displacements<'b>(pair: &DdaPairContact, bodies: &'b [DdaBody]) -> [&'b Vec6; 2] {
    pair.ends.map(|end| &bodies[end].state.scratch.d)
}

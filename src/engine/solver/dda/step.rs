//! The fixed step of `n ≥ 1` rocks: open–close iteration, and a fallback without convergence.
//!
//! The system is solved, each contact state is updated by the displacements found, and both are
//! repeated until no state changes. The paper does not define what to do without convergence: with
//! lagged friction it failed in 7 to 26 % of the steps of a stiff heap of 48 spheres, and created
//! energy.
//!
//! A rock alone is a system of one without pairs.

use super::body::DdaBody;
use super::pairs::DdaPairs;
use crate::contact::pair::PairHistory;
use crate::solver::dda_system::slider::Change;
use crate::solver::step_control::StepError;

/// Most changes of state in the open–close iteration (Shi's practice; the paper states no limit) …
const ROUNDS: u32 = 6;
/// … and most solves for consistent friction forces, which need no new matrix.
///
/// Direction and cap of friction follow from the solution, so they are iterated too. In the
/// fallback, where one contact changes at a time, this limit counts per rock; usually one or two
/// are enough for all.
const SOLVES: u32 = 40;

/// The rocks of a step, and the contacts between them.
#[derive(Debug)]
pub(in crate::solver) struct DdaStep<'s, 'a> {
    pub(in crate::solver) bodies: &'s mut [DdaBody<'a>],
    pub(in crate::solver) pairs: &'s mut DdaPairs,
    pub(in crate::solver) pair_histories: &'s mut [PairHistory],
}

/// Result of a step.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct DdaOutcome {
    /// Whether contact states converged.
    pub(in crate::solver) settled: bool,
    /// Systems solved.
    pub(in crate::solver) solves: u32,
    /// Bonds that broke.
    pub(in crate::solver) broken: u64,
}

impl DdaStep<'_, '_> {
    /// Advances all rocks by `dt` (s). Each begins with the contact points of its present position
    /// and ends with those of the step's end.
    ///
    /// # Errors
    /// [`StepError`] if a rock sank in or its motion is no longer finite.
    pub(in crate::solver) fn advance(
        &mut self,
        (dt, shear_memory): (f64, bool),
    ) -> Result<DdaOutcome, StepError> {
        self.bodies.iter_mut().for_each(|body| body.begin_step((dt, shear_memory)));
        self.pairs.begin_step(self.bodies, self.pair_histories);
        let mut solves = 0;
        // a singular system means a motion that is not finite
        let settled = self.solve(&mut solves).ok_or(StepError::NotFinite)?;
        self.bodies.iter_mut().try_for_each(DdaBody::finish_step)?;
        let broken = self.pairs.finish_step(self.bodies, self.pair_histories)?;
        Ok(DdaOutcome { settled, solves, broken })
    }

    /// Solves the step, and repeats it with the contacts that closed during it: a rock that rolls
    /// into a fold would otherwise get inside the other flank and be thrown out with created
    /// energy. Returns whether states converged.
    ///
    /// It terminates: each round adds a contact, and no rock has more than `MAX_CONTACTS`.
    fn solve(&mut self, solves: &mut u32) -> Option<bool> {
        loop {
            let settled = self.iterate_open_close(solves)?;
            let mut more = false;
            for body in &mut *self.bodies {
                more |= body.add_new_contacts();
            }
            if !more {
                return Some(settled);
            }
        }
    }

    /// Open–close iteration; whether the states of all contacts converged.
    ///
    /// A step without convergence is solved by [`Self::stick`]. `None` if it has no solution.
    fn iterate_open_close(&mut self, solves: &mut u32) -> Option<bool> {
        let (mut rounds, mut change) = (0, Change::Mode);
        for _ in 0..SOLVES {
            *solves += 1;
            // the largest change of all contacts decides: a changed mode needs a new matrix, a
            // changed load only a new right-hand side
            self.pairs.solve(self.bodies, change == Change::Mode)?;
            change = self.update_state();
            match change {
                Change::None => return Some(true),
                Change::Load => {}
                Change::Mode => rounds += 1,
            }
            if rounds == ROUNDS {
                break;
            }
        }
        self.stick(solves).map(|()| false)
    }

    /// Fallback without iteration over states: contacts that begin inside stay closed and stick,
    /// even if they pull for this one step; those that begin apart are frictionless. A solution
    /// always exists, and no force in it adds energy.
    ///
    /// Of the contacts that begin apart one at a time changes, the last first, which excludes
    /// cycles (Murty 1974): their forces grow from zero with the penetration, and their mutual
    /// effect through rocks and sticking contacts is symmetric and positive definite, with pairs as
    /// without.
    fn stick(&mut self, solves: &mut u32) -> Option<()> {
        self.bodies.iter_mut().for_each(|body| body.state.scratch.stick());
        self.pairs.stick();
        for _ in 0..SOLVES * self.bodies.len() as u32 {
            *solves += 1;
            self.pairs.solve(self.bodies, true)?;
            let changes = self.pairs.open_or_close_one_apart(self.bodies)
                || self.bodies.iter_mut().rev().any(|b| b.state.scratch.open_or_close_one_apart());
            if !changes {
                break;
            }
        }
        Some(())
    }

    /// Updates every contact state at the displacements found; the largest change.
    fn update_state(&mut self) -> Change {
        let bodies = self.bodies.iter_mut().map(|body| body.state.scratch.update_state());
        let change = bodies.max().unwrap_or(Change::None);
        change.max(self.pairs.update_state(self.bodies))
    }
}

//! The fixed step of `n ≥ 1` rocks: open–close iteration, and what it does where that does not end.
//!
//! Solve, judge each contact by the displacements that came out, and solve again until none changes. The paper leaves open what
//! happens if that never ends: with lagged friction it
//! failed in 7 to 26 % of the steps of a stiff heap of 48 spheres, and energy appeared from nowhere.
//!
//! A rock alone is a system of one without pairs.

use super::body::DdaBody;
use super::pairs::DdaPairs;
use crate::contact::pair::PairHistory;
use crate::solver::dda_system::slider::Change;
use crate::solver::step_control::StepError;

/// Changes of state in the open–close iteration (Shi's practice; the paper states no limit) …
const ROUNDS: u32 = 6;
/// … and solves with friction forces brought to agree, which need no new matrix.
///
/// Direction and cap of friction follow from the solution, so they are iterated too. Where one contact changes at a time there
/// may be as many for each rock; one or two are usual for all.
const SOLVES: u32 = 40;

/// The rocks of a step, and the contacts between them.
#[derive(Debug)]
pub(in crate::solver) struct DdaStep<'s, 'a> {
    pub(in crate::solver) bodies: &'s mut [DdaBody<'a>],
    pub(in crate::solver) pairs: &'s mut DdaPairs,
    pub(in crate::solver) pair_histories: &'s mut [PairHistory],
}

/// What a step came to.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct DdaOutcome {
    /// Whether contact states settled.
    pub(in crate::solver) settled: bool,
    /// Systems solved.
    pub(in crate::solver) solves: u32,
    /// Bonds that broke.
    pub(in crate::solver) broken: u64,
}

impl DdaStep<'_, '_> {
    /// Takes all rocks over `dt` (s). Each begins with the touches of its present place and ends with those of the step's end.
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
        // a system that cannot be factored means a motion that is no number
        let settled = self.solve(&mut solves).ok_or(StepError::NotFinite)?;
        self.bodies.iter_mut().try_for_each(DdaBody::finish_step)?;
        let broken = self.pairs.finish_step(self.bodies, self.pair_histories)?;
        Ok(DdaOutcome { settled, solves, broken })
    }

    /// Solves the step, and solves it again with the contacts that it ran into: a rock that rolls into a fold would
    /// otherwise find itself inside the other flank and be thrown out with energy from nowhere. Whether states settled.
    ///
    /// Ends: each round adds a contact, and no rock has more than `MOST`.
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

    /// Open–close iteration; whether the states of all contacts settled.
    ///
    /// A step that does not settle is solved by [`Self::stick`]. `None` if it has no solution.
    fn iterate_open_close(&mut self, solves: &mut u32) -> Option<bool> {
        let (mut rounds, mut change) = (0, Change::Mode);
        for _ in 0..SOLVES {
            *solves += 1;
            // the largest change of all contacts decides: a changed mode needs a new matrix, a
            // changed load only a new right side
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

    /// The step without the search for states: contacts that begin inside hold and stick, even if they pull for this
    /// one step; those that begin apart are smooth. That always has a solution, and no force in it adds energy.
    ///
    /// Of those that begin apart one at a time changes, the last first, which cannot go round in circles (Murty 1974): their
    /// forces grow from nothing with the way past the touch, and what they do to each other through rocks and sticking
    /// contacts is symmetric and positive definite, with pairs as without.
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

    /// Judges every contact at the displacements found; the largest change.
    fn update_state(&mut self) -> Change {
        let bodies = self.bodies.iter_mut().map(|body| body.state.scratch.update_state());
        let change = bodies.max().unwrap_or(Change::None);
        change.max(self.pairs.update_state(self.bodies))
    }
}

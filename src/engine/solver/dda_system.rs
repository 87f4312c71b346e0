//! The system of a fixed step and its open–close iteration.
//!
//! A contact is open, sticks or slips; with these states given the step is one linear system,
//! `(2M/Δt² + K) E = F − K D₀`, paper Eq. (4) for one sphere. Solve, judge each contact by the
//! displacements that came out, and solve again until none changes. The paper leaves open what
//! happens if that never ends: with lagged friction it
//! failed in 7 to 26 % of the steps of a stiff heap of 48 spheres, and energy appeared from nowhere.

pub(crate) mod contact;
pub(crate) mod slider;

use super::environment::ContactEnvironment;
use crate::contact::MOST;
use crate::contact::submatrix::{Mat6, Vec6, inertia};
use contact::{ContactMatrixTerms, DdaContact, StepConstants};
use nalgebra::{Cholesky, U6};
use slider::Change;

/// Changes of state in the open–close iteration (Shi's practice; the paper states no limit) …
pub(crate) const ROUNDS: u32 = 6;
/// … and solves with friction forces brought to agree, which need no new matrix.
///
/// Direction and cap of friction follow from the solution, so they are iterated too.
pub(crate) const SOLVES: u32 = 40;

/// Work space of the steps.
#[derive(Debug)]
pub struct DdaScratch {
    pub(super) contacts: [DdaContact; MOST],
    pub(super) count: usize,
    /// Memories that belong to the contacts.
    pub(super) taken: u32,
    system: DdaSystem,
}

impl Default for DdaScratch {
    fn default() -> Self {
        Self {
            contacts: [DdaContact::NONE; MOST],
            count: 0,
            taken: 0,
            system: DdaSystem::default(),
        }
    }
}

impl DdaScratch {
    pub(super) fn contacts(&self) -> &[DdaContact] {
        &self.contacts[..self.count]
    }

    /// Open–close iteration: what contacts add to the free displacement, and whether their states settled.
    ///
    /// A step that does not settle is solved by [`Self::stick`]. `None` if it has no solution.
    pub(super) fn settle(
        &mut self,
        world: &ContactEnvironment,
        step: &StepConstants,
        sweeps: &mut u64,
    ) -> Option<(Vec6, bool)> {
        let contacts = &mut self.contacts[..self.count];
        let inertia = inertia(world.body.mass, world.body.inertia, step.dt);
        let mut rounds = 0;
        for _ in 0..SOLVES {
            *sweeps += 1;
            let added = self.system.solve(&inertia, &step.free, contacts)?;
            let d = step.free + added;
            // the largest change of all contacts decides: a changed mode needs a new matrix, a
            // changed load only a new right side
            match contacts.iter_mut().map(|contact| contact.judge(&d)).max() {
                None | Some(Change::None) => return Some((added, true)),
                Some(Change::Load) => {}
                Some(Change::Mode) => rounds += 1,
            }
            if rounds == ROUNDS {
                break;
            }
        }
        self.stick(&inertia, &step.free, sweeps).map(|added| (added, false))
    }

    /// The step without the search for states: contacts that begin inside hold and stick, even if they pull for this
    /// one step; those that begin apart are smooth. That always has a solution, and no force in it adds energy.
    ///
    /// Of those that begin apart one at a time changes, the last first, which cannot go round in circles (Murty 1974).
    fn stick(&mut self, inertia: &Mat6, free: &Vec6, sweeps: &mut u64) -> Option<Vec6> {
        let contacts = &mut self.contacts[..self.count];
        contacts.iter_mut().for_each(DdaContact::stick);
        let mut added = Vec6::zeros();
        for _ in 0..SOLVES {
            *sweeps += 1;
            added = self.system.solve(inertia, free, contacts)?;
            let d = free + added;
            if !contacts.iter_mut().rev().any(|contact| contact.open_or_close_apart(&d)) {
                break;
            }
        }
        Some(added)
    }
}

/// The matrix of a step; it is made anew only when it has changed.
///
/// In lasting contact neither step nor states change, so a whole slide needs one factorisation of
/// 6×6.
#[derive(Debug)]
pub(super) struct DdaSystem {
    inertia: Mat6,
    shapes: [ContactMatrixTerms; MOST],
    count: usize,
    /// What the contacts add to the matrix.
    springs: Mat6,
    /// Factor of inertia and contacts; `None` if there is none.
    factor: Option<Cholesky<f64, U6>>,
}

impl Default for DdaSystem {
    fn default() -> Self {
        Self {
            inertia: Mat6::zeros(),
            shapes: [ContactMatrixTerms::NONE; MOST],
            count: 0,
            springs: Mat6::zeros(),
            factor: None,
        }
    }
}

impl DdaSystem {
    /// Cholesky: inertia is positive definite and springs add `Vᵀ V` terms, so the matrix always
    /// is.
    fn solve(&mut self, inertia: &Mat6, free: &Vec6, contacts: &[DdaContact]) -> Option<Vec6> {
        let shapes = || contacts.iter().map(DdaContact::shape);
        let same = self.shapes[..self.count].iter().copied().eq(shapes());
        if !same || self.inertia != *inertia {
            self.inertia = *inertia;
            self.count = contacts.len();
            self.shapes.iter_mut().zip(shapes()).for_each(|(known, shape)| *known = shape);
            self.springs = shapes().fold(Mat6::zeros(), |sum, shape| sum + shape.stiffness());
            self.factor = Cholesky::new(self.springs + inertia);
        }
        // F − K D₀: the unknown is what contacts add to the free displacement
        let mut load = -(self.springs * free);
        for contact in contacts {
            contact.add_load(&mut load);
        }
        self.factor.as_ref()?.solve_mut(&mut load);
        load.iter().all(|x| x.is_finite()).then_some(load)
    }
}

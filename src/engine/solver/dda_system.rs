//! One rock's part of the system of a fixed step: its contacts with the mesh, and its block.
//!
//! A contact is open, sticks or slips; with these states given the step is one linear system, paper Eq. (4),
//! `(2M/Δt² + K) E = F − K D₀`: a block of 6×6 a rock, `2M/Δt²` and the contacts with the mesh, and the blocks of
//! contacts between rocks. What is here knows nothing of a rock's motion beyond the step.

pub(crate) mod contact;
pub(crate) mod pair_contact;
pub(crate) mod slider;

use super::body::Body;
use crate::contact::history::ContactHistory;
use crate::contact::submatrix::{Mat6, Vec6, inertia};
use crate::contact::{ContactPoint, MOST};
use crate::ground::Law;
use arrayvec::ArrayVec;
use contact::{ContactMatrixTerms, DdaContact};
use nalgebra::{Cholesky, U6};
use slider::Change;

/// What is the same for all contacts of a rock in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StepConstants {
    /// Length (s).
    pub(crate) dt: f64,
    /// Whether shear springs keep their stretch; if not, friction is that of the last step's end, as printed.
    pub(crate) shear_memory: bool,
    /// Displacement and rotation without contacts, `D₀`.
    pub(crate) free: Vec6,
    /// Radius of the sphere (m).
    pub(crate) radius: f64,
    /// Way of the touched point per newton along the surface (m/N) and turn of the sphere per newton metre.
    compliance: (f64, f64),
}

impl StepConstants {
    /// Those of a body that would move by `free` over `dt` (s).
    ///
    /// `Δt²/(2m) + R² Δt²/(2I)`: displacement is force times half the square of the step over the mass,
    /// and the contact point also turns.
    pub(crate) fn new(body: &Body, free: Vec6, (dt, shear_memory): (f64, bool)) -> Self {
        let turn = 0.5 * dt * dt / body.inertia;
        let way = 0.5 * dt * dt / body.mass + body.radius * body.radius * turn;
        Self { dt, shear_memory, free, radius: body.radius, compliance: (way, turn) }
    }
}

/// A rock in a fixed step: its contacts with the mesh, its displacement, and its block of the system.
///
/// The block is made anew only when it has changed. In lasting contact neither step nor states change, so a whole slide of a
/// rock alone needs one factorisation of 6×6.
#[derive(Debug, Default)]
pub struct DdaScratch {
    pub(super) step: StepConstants,
    contacts: ArrayVec<DdaContact, MOST>,
    /// Memories that belong to the contacts.
    pub(super) used_histories: u32,
    /// What contacts add to the free displacement, `E`, and both together, `D = D₀ + E`, Eq. (1).
    pub(super) added: Vec6,
    pub(super) d: Vec6,
    /// Of what the block was made: inertia, and contacts in their states.
    inertia: Mat6,
    terms: ArrayVec<ContactMatrixTerms, MOST>,
    /// What the contacts add to the block.
    springs: Mat6,
    /// Factor of the block; `None` if nobody has asked for it, or if there is none.
    factor: Option<Cholesky<f64, U6>>,
}

impl DdaScratch {
    /// Begins a step without contacts.
    pub(super) fn begin(&mut self, body: &Body, step: StepConstants) {
        (self.step, self.used_histories) = (step, 0);
        self.contacts.clear();
        let inertia = inertia(body.mass, body.inertia, step.dt);
        if self.inertia != inertia {
            (self.inertia, self.factor) = (inertia, None);
        }
    }

    /// Adds the contact of a touch and its memory.
    pub(super) fn add(&mut self, law: &Law, touch: &ContactPoint, left: (usize, &ContactHistory)) {
        self.contacts.push(DdaContact::with_mesh(&self.step, law, touch, left));
        self.used_histories |= 1 << left.0;
    }

    pub(super) fn contacts(&self) -> &[DdaContact] {
        &self.contacts
    }

    /// `2M/Δt² + K` of the contacts with the mesh, as [`Self::load`] has brought it up to date.
    pub(super) fn block(&self) -> Mat6 {
        self.springs + self.inertia
    }

    /// Brings the block up to the states of the contacts, and gives `F − K D₀`: the unknown is what contacts add to the
    /// free displacement.
    pub(super) fn load(&mut self) -> Vec6 {
        let contacts = &self.contacts;
        let terms = || contacts.iter().map(DdaContact::terms);
        if !self.terms.iter().copied().eq(terms()) {
            self.terms.clear();
            self.terms.extend(terms());
            self.springs = terms().fold(Mat6::zeros(), |sum, one| sum + one.stiffness());
            self.factor = None;
        }
        let mut load = -(self.springs * self.step.free);
        for contact in contacts {
            contact.add_load(&mut load);
        }
        load
    }

    /// Solves the step of a rock that no other touches: its block is all of the system. `None` if it has no solution.
    ///
    /// Cholesky: inertia is positive definite and springs add `Vᵀ V` terms, so the matrix always
    /// is.
    pub(super) fn solve(&mut self) -> Option<()> {
        let mut load = self.load();
        if self.factor.is_none() {
            self.factor = Cholesky::new(self.block());
        }
        self.factor.as_ref()?.solve_mut(&mut load);
        self.set_solution(load)
    }

    /// Takes a solution; `None` if it is none.
    pub(super) fn set_solution(&mut self, added: Vec6) -> Option<()> {
        (self.added, self.d) = (added, self.step.free + added);
        added.iter().all(|x| x.is_finite()).then_some(())
    }

    /// Judges its contacts by the displacement that came out; the largest change of all counts.
    pub(super) fn update_state(&mut self) -> Change {
        let contacts = self.contacts.iter_mut();
        let changes =
            contacts.map(|contact| contact.update_state(&contact.relative_displacement(&self.d)));
        changes.max().unwrap_or(Change::None)
    }

    /// Ends the search for the states of its contacts.
    pub(super) fn stick(&mut self) {
        self.contacts.iter_mut().for_each(DdaContact::stick);
    }

    /// Opens or closes one contact that begins apart, the last that asks for it; whether there is any.
    pub(super) fn open_or_close_one_apart(&mut self) -> bool {
        let mut contacts = self.contacts.iter_mut().rev();
        contacts.any(|contact| contact.open_or_close_apart(&contact.relative_displacement(&self.d)))
    }
}

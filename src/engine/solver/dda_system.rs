//! A rock's part of the system of a fixed step: its contacts with the mesh, and its block.
//!
//! A contact is open, sticks or slips. With given states the step is one linear system, paper Eq.
//! (4), `(2M/Δt² + K) E = F − K D₀`: a block of 6×6 a rock, from `2M/Δt²` and its contacts with the
//! mesh, and the blocks of contacts between rocks. This module depends on a rock's motion only
//! within the step.

pub(crate) mod contact;
pub(crate) mod pair_contact;
pub(crate) mod slider;

use super::body::Body;
use crate::contact::history::ContactHistory;
use crate::contact::submatrix::{Mat6, Vec6, inertia};
use crate::contact::{ContactPoint, MAX_CONTACTS};
use crate::ground::Law;
use arrayvec::ArrayVec;
use contact::{ContactMatrixTerms, DdaContact};
use nalgebra::{Cholesky, U6};
use slider::Change;

/// Constants of all contacts of a rock in a step.
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
    /// Compliance: displacement of the contact point per newton along the surface (m/N), and
    /// rotation of the sphere per newton metre.
    compliance: (f64, f64),
}

impl StepConstants {
    /// For a body with the free displacement `free` over `dt` (s).
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
/// The block is rebuilt only when it has changed. In sustained contact neither step nor states
/// change, so a whole slide of a rock alone needs one factorisation of 6×6.
#[derive(Debug, Default)]
pub struct DdaScratch {
    pub(super) step: StepConstants,
    contacts: ArrayVec<DdaContact, MAX_CONTACTS>,
    /// Histories that belong to the contacts, one bit each.
    pub(super) used_histories: u32,
    /// Effect of contacts on the free displacement, `E`, and the total displacement, `D = D₀ + E`,
    /// Eq. (1).
    pub(super) added: Vec6,
    pub(super) d: Vec6,
    /// Terms of the block: inertia, and contacts in their states.
    inertia: Mat6,
    terms: ArrayVec<ContactMatrixTerms, MAX_CONTACTS>,
    /// Stiffness of the contacts in the block.
    springs: Mat6,
    /// Factor of the block; `None` before it is needed, and where there is none.
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

    /// Adds the contact of a contact point and its history.
    pub(super) fn add(&mut self, law: &Law, touch: &ContactPoint, left: (usize, &ContactHistory)) {
        self.contacts.push(DdaContact::with_mesh(&self.step, law, touch, left));
        self.used_histories |= 1 << left.0;
    }

    pub(super) fn contacts(&self) -> &[DdaContact] {
        &self.contacts
    }

    /// `2M/Δt² + K` of the contacts with the mesh, as last updated by [`Self::load`].
    pub(super) fn block(&self) -> Mat6 {
        self.springs + self.inertia
    }

    /// Updates the block to the states of the contacts; returns `F − K D₀`, as the unknown is the
    /// effect of contacts on the free displacement.
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

    /// Solves the step of a rock without contact to others: its block is the whole system. `None`
    /// if it has no solution.
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

    /// Sets the solution; `None` if it is not finite.
    pub(super) fn set_solution(&mut self, added: Vec6) -> Option<()> {
        (self.added, self.d) = (added, self.step.free + added);
        added.iter().all(|x| x.is_finite()).then_some(())
    }

    /// Updates the states of its contacts by the displacement found; the largest change.
    pub(super) fn update_state(&mut self) -> Change {
        let contacts = self.contacts.iter_mut();
        let changes =
            contacts.map(|contact| contact.update_state(&contact.relative_displacement(&self.d)));
        changes.max().unwrap_or(Change::None)
    }

    /// Fixes the states of its contacts for the fallback solution.
    pub(super) fn stick(&mut self) {
        self.contacts.iter_mut().for_each(DdaContact::stick);
    }

    /// Opens or closes the last contact that begins apart and has to change; whether there is one.
    pub(super) fn open_or_close_one_apart(&mut self) -> bool {
        let mut contacts = self.contacts.iter_mut().rev();
        contacts.any(|contact| contact.open_or_close_apart(&contact.relative_displacement(&self.d)))
    }
}

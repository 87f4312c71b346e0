//! One rock in a fixed step: its contacts, and its motion at the end.

use super::DEEPEST;
use crate::contact::submatrix::Vec6;
use crate::contact::{ContactPoint, MAX_CONTACTS};
use crate::rock::Vec3;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::dda_system::StepConstants;
use crate::solver::dda_system::contact::DdaContact;
use crate::solver::loss::{EnergyGiven, Loss};
use crate::solver::springs::stretched_j;
use crate::solver::step_control::StepError;

/// A rock within a step.
#[derive(Debug)]
pub(in crate::solver) struct DdaBody<'a> {
    pub(in crate::solver) world: ContactEnvironment<'a>,
    pub(in crate::solver) state: &'a mut ContactState,
    /// Energy in the springs of its contacts with the mesh at the present state (J).
    pub(in crate::solver) stored: Loss,
    /// Energy that its contacts with the mesh have taken in the step (J).
    pub(in crate::solver) loss: Loss,
    /// Energy that it gave to other rocks in the step (J).
    pub(in crate::solver) given: EnergyGiven,
}

impl<'a> DdaBody<'a> {
    /// A rock whose contact points are known, with the energy of its springs.
    pub(in crate::solver) fn new(
        world: ContactEnvironment<'a>,
        state: &'a mut ContactState,
        stored: Loss,
    ) -> Self {
        Self { world, state, stored, loss: Loss::default(), given: EnergyGiven::default() }
    }

    /// A rock whose contact points and spring energy are still to be found.
    pub(in crate::solver) fn with_contact_points(
        world: ContactEnvironment<'a>,
        state: &'a mut ContactState,
    ) -> Self {
        let c = state.c;
        state.find_contact_points_ahead(&world, &c);
        let stored = state.stored_j(&world);
        Self::new(world, state, stored)
    }

    /// Begins the step with the contacts at its start.
    ///
    /// Normals and levers are those of the start for the whole step, as in the paper: over an edge
    /// that limits the rule to first order.
    pub(super) fn begin_step(&mut self, (dt, shear_memory): (f64, bool)) {
        let (body, state) = (&self.world.body, &mut *self.state);
        // D₀ = V₀ Δt + g Δt²/2; a free sphere keeps its spin
        let free = vec6(&(state.v * dt + body.gravity * (0.5 * dt * dt)), &(state.w * dt));
        state.scratch.begin(body, StepConstants::new(body, free, (dt, shear_memory)));
        for k in 0..self.state.touches.len() {
            self.add_contact(k, self.state.touches[k].distance_m);
        }
    }

    /// Adds contact point `k` as a contact, its plane at this distance from the centre at the
    /// step's start (m).
    fn add_contact(&mut self, k: usize, distance_m: f64) {
        let Self { world, state, .. } = self;
        let v = state.v;
        let history = state.history_of(world, k, state.scratch.used_histories, &v);
        let touch = ContactPoint { distance_m, ..state.touches[k] };
        let contact_history = &state.histories[history];
        let law = world.law_of(contact_history, &state.touches, k);
        state.scratch.add(&law, &touch, (history, contact_history));
    }

    /// Adds contacts that closed during the step; whether there are any. The contact points are
    /// then those of the step's end.
    pub(super) fn add_new_contacts(&mut self) -> bool {
        let way: Vec3 = self.state.scratch.d.fixed_rows::<3>(0).into();
        let end = self.state.c + way;
        self.state.find_contact_points_ahead(&self.world, &end);
        let touches = self.state.touches.clone();
        let before = self.state.scratch.contacts().len();
        for (k, touch) in touches.iter().enumerate() {
            let contacts = self.state.scratch.contacts();
            let is_inside =
                touch.distance_m < self.world.body.radius && contacts.len() < MAX_CONTACTS;
            if is_inside && !has_contact(contacts, touch, &touches, &self.state.scratch.d) {
                // its distance at the step's start
                self.add_contact(k, touch.distance_m - touch.normal.dot(&way));
            }
        }
        self.state.scratch.contacts().len() > before
    }

    /// Ends the step: books the losses of its contacts, updates their histories, and moves the
    /// rock.
    ///
    /// `V₁ = 2D/Δt − V₀ = V₀ + g Δt + 2E/Δt`, as `D = D₀ + E`: a motion without contacts is not
    /// rounded. The orientation of a sphere is not needed.
    ///
    /// # Errors
    /// [`StepError::SankIn`] if a contact is deeper than its spring is meant for.
    pub(super) fn finish_step(&mut self) -> Result<(), StepError> {
        let Self { world, state, loss, .. } = self;
        let ContactState { scratch, histories, .. } = &mut **state;
        let d = &scratch.d;
        for history in histories.iter_mut() {
            history.closed = false;
        }
        for contact in scratch.contacts() {
            let relative = contact.relative_displacement(d);
            if relative.depth > DEEPEST * contact.radius {
                return Err(StepError::SankIn);
            }
            loss.add(&contact.loss(&relative).on(world, contact.triangle), 1.0);
            contact.write_history(&relative, &mut histories[contact.history]);
        }
        let (d, dt) = (*d, scratch.step.dt);
        let velocity_change = scratch.added * (2.0 / dt);
        state.merge_lost(world);
        // open contacts lose the energy of their shear and rolling springs in their own dashpots
        for opened in state.histories.iter().filter(|history| !history.closed) {
            loss.add(&stretched_j(world, opened), 1.0);
        }
        state.histories.retain(|history| history.closed);
        state.c += d.fixed_rows::<3>(0);
        state.v += world.body.gravity * dt + velocity_change.fixed_rows::<3>(0);
        state.w += velocity_change.fixed_rows::<3>(3);
        // the increase of spring energy is taken from the motion, but is no loss
        let stored = state.stored_j(world);
        loss.add(&stored, 1.0);
        loss.add(&self.stored, -1.0);
        self.stored = stored;
        Ok(())
    }
}

/// Displacement and rotation as the six unknowns of Eq. (1).
fn vec6(a: &Vec3, b: &Vec3) -> Vec6 {
    Vec6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// Whether a contact point of the step's end was a contact of the step, as the same feature or as
/// the part of the surface that it came from.
fn has_contact(
    contacts: &[DdaContact],
    touch: &ContactPoint,
    touches: &[ContactPoint],
    d: &Vec6,
) -> bool {
    contacts.iter().any(|contact| {
        contact.feature == touch.feature
            || contact.moves_to(touch, d)
                && touches.iter().all(|other| other.feature != contact.feature)
    })
}

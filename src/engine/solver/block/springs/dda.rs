//! Scheme `dda` for blocks: the paper's step with constant acceleration.
//!
//! Over a step the block moves with the mean of its velocities at both ends, forces are those of
//! the springs at its end, and geometry is that of its start, as in the paper (Eqs. (1)–(5)):
//! impulses act for half the step before the mean velocity is reached.
//!
//! For a sphere on planes this conserves energy, however long the step: work equals the change of
//! the kinetic energy. A block rotates, and with it its levers and its inertia, so that a step
//! gains or loses energy to first order in its length. The energy gained in a step is therefore
//! removed from the motion ([`BlockContactState::limit_energy_to`]).

use super::super::{BlockContactState, BlockState, BlockStepOutcome, TOUCH};
use super::stage::{StageBase, StageState};
use super::{SpringContact, Springs};
use crate::body::Block;
use crate::contact::block::BlockContactPoint;
use crate::contact::history::SAME_CONTACT_COSINE;
use crate::flight::top::Top;
use crate::rock::Vec3;
use crate::solver::Settings;
use crate::solver::block::orthonormal;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;
use crate::solver::step_control::StepError;

/// Solves of a step with the contacts that it has run into, at most.
const MOST_SOLVES: u32 = 8;

impl SpringContact {
    /// Energy (J) that dashpots and slider dissipate where the point moves with `u` (m/s) for `b`
    /// (s). Its springs store their force at the end of the step times their change of length. A
    /// shear spring that is released relaxes against its own dashpot.
    fn dissipated(&self, world: &ContactEnvironment, (u, b): (&Vec3, f64)) -> Loss {
        let (pressed_m, end) = (self.penetration_after(u, b).max(0.0), self.stretch(b));
        // with displacements in place of speeds, powers are energies
        let (way, stretched) = (u * b, end - self.shear);
        let closed_m = -self.n.dot(&way);
        let sprung_j = self.law.normal(self.captured).storing_w(pressed_m, closed_m)
            + self.law.shear.spring_force(end).dot(&stretched);
        let left_j =
            if pressed_m > 0.0 { 0.0 } else { 0.5 * self.law.shear.spring_force(end).dot(&end) };
        let damping_j = self.normal_force * closed_m - sprung_j + left_j;
        self.shear_power(&way, &stretched, damping_j).on(world, self.triangle)
    }
}

impl BlockContactState {
    /// One step of at most `most_s`.
    ///
    /// # Errors
    /// [`StepError`] if a penetration is too large or the motion is no longer finite.
    pub(super) fn fixed_step(
        &mut self,
        world: &ContactEnvironment,
        settings: &Settings,
        (block, state): (&Block, &mut BlockState),
        most_s: f64,
    ) -> Result<BlockStepOutcome, StepError> {
        let limit = Self::travel_limit_s(world, (block, state), settings.corner_way);
        let dt = settings.step_s.min(most_s).min(limit);
        let start = state.clone();
        let ahead_m = Self::ahead_m(world, (block, &start), dt);
        self.detect_all(world, (block, &start.pose), ahead_m);
        self.springs.known = self.springs.histories.len();
        self.update_histories(world, (block, &start));
        let memory = settings.shear_memory;
        let shear_of = |contact_state: &Self, k: usize| {
            if memory { contact_state.springs.histories[k].shear } else { Vec3::zeros() }
        };
        self.place_contacts(world, (block, &start, &start), 0.0, &shear_of);
        let held = self.springs.stored_by_contacts(world);
        let rolled = if memory { self.springs.rolling.stretch } else { Vec3::zeros() };
        let base = StageState { state: start.clone(), turned: Vec3::zeros(), rolled };
        let stage = StageBase { start: &start, base, times_s: (0.5 * dt, dt) };
        let mean = self.mean_motion(world, block, &stage, &shear_of);
        let weight = world.body.gravity * dt;
        let (pushed_v, pushed_l) =
            (mean.v - start.v - weight * 0.5, mean.momentum - start.momentum);
        let top = Top::new(block.inertia_kg_m2, start.pose.attitude, mean.momentum);
        state.pose.centre = start.pose.centre + mean.v * dt;
        state.pose.attitude = orthonormal(&top.attitude(dt));
        state.v = start.v + weight + pushed_v * 2.0;
        state.momentum = start.momentum + pushed_l * 2.0;
        if !state.v.iter().chain(state.momentum.iter()).all(|x| x.is_finite()) {
            return Err(StepError::NotFinite);
        }
        let mut done =
            BlockStepOutcome { dt, unsettled: self.unsettled, ..BlockStepOutcome::default() };
        let Springs { contacts, rolling, .. } = &self.springs;
        for contact in contacts {
            let u = mean.velocity_at(block, &contact.lever);
            done.loss.add(&contact.dissipated(world, (&u, dt)), 1.0);
        }
        done.loss.add(&rolling.dissipated(world, contacts, (&mean.spin(block), dt)), 1.0);
        self.store_contacts((block, &mean), dt);
        self.detect_all(world, (block, &state.pose), TOUCH * block.radius_m);
        self.check_depth(block)?;
        let lifted_m = state.pose.centre - start.pose.centre;
        let fell_j = block.mass_kg * world.body.gravity.dot(&lifted_m);
        let had_j = start.motion_j(block) + held.sum() + fell_j;
        let holds = self.limit_energy_to(world, (block, state), had_j - done.loss.sum(), &shear_of);
        // an increase of the spring energy is taken from the motion, but not lost
        done.loss.add(&holds, 1.0);
        done.loss.add(&held, -1.0);
        done.slides = self.springs.histories.iter().any(|history| history.slides);
        done.is_free = self.springs.is_free();
        Ok(done)
    }

    /// Mean velocity and momentum of a step, solved again with the contacts that it ran into: a
    /// block that moves into a fold would otherwise penetrate its other flank and be thrown out
    /// with energy that it did not have.
    fn mean_motion(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        stage: &StageBase,
        shear_of: &impl Fn(&Self, usize) -> Vec3,
    ) -> BlockState {
        let (start, (half_s, dt)) = (stage.start, stage.times_s);
        let free_v = start.v + world.body.gravity * half_s;
        let mut mean = start.clone();
        for _ in 0..MOST_SOLVES {
            (mean.v, mean.momentum) = self.solve_contacts(block, stage, start, free_v);
            let mut end = mean.clone();
            end.drift(block, dt);
            let known = self.springs.contacts.len();
            self.add_new_contacts(world, (block, &mean, &end), dt, shear_of);
            if self.springs.contacts.len() == known {
                break;
            }
        }
        mean
    }

    /// Adds the contacts that press at the end of a step and took no part in it.
    pub(in crate::solver::block) fn add_new_contacts(
        &mut self,
        world: &ContactEnvironment,
        (block, mean, end): (&Block, &BlockState, &BlockState),
        dt: f64,
        shear_of: &impl Fn(&Self, usize) -> Vec3,
    ) {
        std::mem::swap(&mut self.touches.found, &mut self.selected);
        self.detect_all(world, (block, &end.pose), 0.0);
        std::mem::swap(&mut self.touches.found, &mut self.selected);
        for touch in self.selected.iter().filter(|touch| touch.gap_m < 0.0) {
            let mut known = self.springs.contacts.iter().zip(&self.touches.found);
            let took_part = known.any(|(contact, began)| {
                began.part == touch.part && contact.n.dot(&touch.normal) > SAME_CONTACT_COSINE
            });
            if !took_part {
                // with the gap that it had at the step's start
                let gap_m =
                    touch.gap_m - dt * touch.normal.dot(&mean.velocity_at(block, &touch.lever));
                self.touches.found.push(BlockContactPoint { gap_m, ..*touch });
            }
        }
        if self.touches.found.len() > self.springs.contacts.len() {
            // contacts that have been solved keep their places
            self.touches.found.iter_mut().for_each(|touch| touch.is_past_end = false);
            self.update_histories(world, (block, mean));
            let springs = &mut self.springs;
            std::mem::swap(&mut springs.contacts, &mut springs.solved);
            self.place_contacts(world, (block, mean, mean), 0.0, shear_of);
            let Springs { contacts, solved, .. } = &mut self.springs;
            contacts[..solved.len()].copy_from_slice(solved);
        }
    }

    /// Slows the block if motion and springs at the end of a step, after its detection, hold more
    /// than `had_j` (J) less its energy debt; returns the energy of the springs. A block that its
    /// springs have just turned round has no motion to correct: the rest is owed until they have
    /// accelerated it.
    fn limit_energy_to(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
        had_j: f64,
        shear_of: &impl Fn(&Self, usize) -> Vec3,
    ) -> Loss {
        // with the springs as the next step will find them
        let known = self.springs.histories.len();
        self.springs.known = known;
        self.update_histories(world, (block, state));
        self.place_contacts(world, (block, state, state), 0.0, shear_of);
        self.springs.histories.truncate(known);
        let part = state.motion_component(block, &self.springs.acting_along());
        let (motion_j, allowed_j) = (state.motion_j(block), had_j - self.springs.debt_j);
        let holds = self.springs.stored_by_contacts(world);
        let spurious_j = motion_j + holds.sum() - allowed_j;
        let paid_j = spurious_j.clamp(0.0, part.available_j());
        self.springs.debt_j = (spurious_j - paid_j).max(0.0);
        if paid_j > 0.0 {
            state.take_energy_from(&part, paid_j);
        }
        holds
    }
}

//! Scheme `dda` for blocks: the paper's step with constant acceleration.
//!
//! Over a step the block moves with the mean of its velocities at both ends, forces are those of the springs at its end, and geometry is
//! that of its start, as in the paper (Eqs. (1)–(5)): impulses act for half the step before the mean velocity is reached.

use super::super::{Footing, Moving, Stepped, TOUCH};
use super::SpringContact;
use super::stage::{BlockEnd, StageBase};
use crate::body::Block;
use crate::contact::history::SAME_GRIP;
use crate::flight::top::Top;
use crate::rock::Vec3;
use crate::solver::Settings;
use crate::solver::block::orthonormal;
use crate::solver::environment::ContactEnvironment;
use crate::solver::step_control::StepError;

/// Looks at a step's end for contacts that it has run into, at most.
const LOOKS: u32 = 8;

impl Footing {
    /// One step of at most `most_s`.
    ///
    /// # Errors
    /// [`StepError`] if the block sank in or its motion is no longer finite.
    pub(super) fn fixed_step(
        &mut self,
        world: &ContactEnvironment,
        settings: &Settings,
        (block, moving): (&Block, &mut Moving),
        most_s: f64,
    ) -> Result<Stepped, StepError> {
        let limit = Self::travel_limit_s(world, (block, moving));
        let dt = settings.step_s.min(most_s).min(limit);
        let start = moving.clone();
        let ahead_m = Self::ahead_m(world, (block, &start), dt);
        self.look_at_all(world, (block, &start.pose), ahead_m);
        self.springs.known = self.springs.histories.len();
        self.remember(world, (block, &start));
        let memory = settings.shear_memory;
        let shear_of = |footing: &Self, k: usize| {
            if memory { footing.springs.histories[k].shear } else { Vec3::zeros() }
        };
        self.place(world, (block, &start, &start), 0.0, &shear_of);
        let base = BlockEnd { moving: start.clone(), turned: Vec3::zeros() };
        let stage = StageBase { start: &start, base, times_s: (0.5 * dt, dt) };
        let mean = self.mean_motion(world, block, &stage);
        let weight = world.body.gravity * dt;
        let (pushed_v, pushed_l) =
            (mean.v - start.v - weight * 0.5, mean.momentum - start.momentum);
        let top = Top::new(block.inertia_kg_m2, start.pose.attitude, mean.momentum);
        moving.pose.centre = start.pose.centre + mean.v * dt;
        moving.pose.attitude = orthonormal(&top.attitude(dt));
        moving.v = start.v + weight + pushed_v * 2.0;
        moving.momentum = start.momentum + pushed_l * 2.0;
        if !moving.v.iter().chain(moving.momentum.iter()).all(|x| x.is_finite()) {
            return Err(StepError::NotFinite);
        }
        let mut done = Stepped { dt, ..Stepped::default() };
        for contact in &self.springs.contacts {
            let u = mean.at(block, &contact.lever);
            let shear_rate = (contact.stretch(dt) - contact.shear) / dt;
            done.loss.add(&contact.power(world, &u, &shear_rate), dt);
        }
        self.keep((block, &mean), dt);
        self.look_at_all(world, (block, &moving.pose), TOUCH * block.radius_m);
        self.check_depth(block)?;
        done.slides = self.springs.histories.iter().any(|history| history.slides);
        done.is_free = self.springs.is_free();
        Ok(done)
    }

    /// Mean velocity and momentum of a step, solved again with the contacts that it ran into: a block that comes into a fold would
    /// otherwise find itself inside the other flank and be thrown out with energy from nowhere.
    fn mean_motion(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        stage: &StageBase,
    ) -> Moving {
        let (start, (half_s, dt)) = (stage.start, stage.times_s);
        let free_v = start.v + world.body.gravity * half_s;
        let mut mean = start.clone();
        for _ in 0..LOOKS {
            (mean.v, mean.momentum) = self.pushed(block, stage, start, free_v);
            let mut end = mean.clone();
            end.drift(block, dt);
            let known = self.springs.contacts.len();
            self.run_into(world, block, (&mean, &end), dt);
            if self.springs.contacts.len() == known {
                break;
            }
        }
        mean
    }

    /// Adds the contacts that press at a step's end and took no part in it.
    fn run_into(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        (mean, end): (&Moving, &Moving),
        dt: f64,
    ) {
        let began = std::mem::take(&mut self.touches.found);
        self.look_at_all(world, (block, &end.pose), 0.0);
        let pressed = std::mem::replace(&mut self.touches.found, began);
        for touch in pressed.into_iter().filter(|touch| touch.gap_m < 0.0) {
            let known = self.springs.contacts.iter().zip(&self.touches.found);
            let took_part = { known }.any(|(contact, began)| {
                began.part == touch.part && contact.n.dot(&touch.normal) > SAME_GRIP
            });
            if !took_part {
                // as far from it as it was at the step's start
                let gap_m = touch.gap_m - dt * touch.normal.dot(&mean.at(block, &touch.lever));
                self.touches.found.push(crate::contact::block::BlockTouch { gap_m, ..touch });
            }
        }
        if self.touches.found.len() > self.springs.contacts.len() {
            self.remember(world, (block, mean));
            let contacts: Vec<SpringContact> = self.springs.contacts.clone();
            self.place(world, (block, mean, mean), 0.0, &|footing: &Self, k| {
                footing.springs.histories[k].shear
            });
            self.springs.contacts[..contacts.len()].copy_from_slice(&contacts);
        }
    }
}

//! Scheme `dda` for blocks: the paper's step with constant acceleration.
//!
//! Over a step the block moves with the mean of its velocities at both ends, forces are those of the springs at its end, and geometry is
//! that of its start, as in the paper (Eqs. (1)–(5)): impulses act for half the step before the mean velocity is reached.
//!
//! For a sphere on planes that gains nothing, however long the step: work is just what the energy of motion changes by. A block turns, and
//! with it its levers and its inertia; to the first order of the step that may give as well as take. So what a step has made is taken off
//! the motion again ([`Footing::hold_to`]).

use super::super::{Footing, Moving, Stepped, TOUCH};
use super::stage::{BlockEnd, StageBase};
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

/// Looks at a step's end for contacts that it has run into, at most.
const LOOKS: u32 = 8;

impl SpringContact {
    /// What dashpots and slider take (J) where its point moves with `u` (m/s) for `b` (s): its springs take, pressed and stretched as at the end, what
    /// they were pressed and stretched by. A shear spring that is let go runs out against its own dashpot.
    fn taken(&self, world: &ContactEnvironment, (u, b): (&Vec3, f64)) -> Loss {
        let (pressed_m, end) = (self.pen_at(u, b).max(0.0), self.stretch(b));
        // over ways in place of speeds, powers are energies
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
        let limit = Self::travel_limit_s(world, (block, moving), settings.corner_way);
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
        let held = self.springs.placed(world);
        let rolled = if memory { self.springs.rolling.stretch } else { Vec3::zeros() };
        let base = BlockEnd { moving: start.clone(), turned: Vec3::zeros(), rolled };
        let stage = StageBase { start: &start, base, times_s: (0.5 * dt, dt) };
        let mean = self.mean_motion(world, block, &stage, &shear_of);
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
        let mut done = Stepped { dt, unsettled: self.unsettled, ..Stepped::default() };
        let Springs { contacts, rolling, .. } = &self.springs;
        for contact in contacts {
            let u = mean.at(block, &contact.lever);
            done.loss.add(&contact.taken(world, (&u, dt)), 1.0);
        }
        done.loss.add(&rolling.taken(world, contacts, (&mean.spin(block), dt)), 1.0);
        self.keep((block, &mean), dt);
        self.look_at_all(world, (block, &moving.pose), TOUCH * block.radius_m);
        self.check_depth(block)?;
        let lifted_m = moving.pose.centre - start.pose.centre;
        let fell_j = block.mass_kg * world.body.gravity.dot(&lifted_m);
        let had_j = start.motion_j(block) + held.sum() + fell_j;
        let holds = self.hold_to(world, (block, moving), had_j - done.loss.sum(), &shear_of);
        // what springs hold more at the end than at the start is taken from motion, but not lost
        done.loss.add(&holds, 1.0);
        done.loss.add(&held, -1.0);
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
        shear_of: &impl Fn(&Self, usize) -> Vec3,
    ) -> Moving {
        let (start, (half_s, dt)) = (stage.start, stage.times_s);
        let free_v = start.v + world.body.gravity * half_s;
        let mut mean = start.clone();
        for _ in 0..LOOKS {
            (mean.v, mean.momentum) = self.pushed(block, stage, start, free_v);
            let mut end = mean.clone();
            end.drift(block, dt);
            let known = self.springs.contacts.len();
            self.run_into(world, (block, &mean, &end), dt, shear_of);
            if self.springs.contacts.len() == known {
                break;
            }
        }
        mean
    }

    /// Adds the contacts that press at a step's end and took no part in it.
    pub(in crate::solver::block) fn run_into(
        &mut self,
        world: &ContactEnvironment,
        (block, mean, end): (&Block, &Moving, &Moving),
        dt: f64,
        shear_of: &impl Fn(&Self, usize) -> Vec3,
    ) {
        std::mem::swap(&mut self.touches.found, &mut self.aside);
        self.look_at_all(world, (block, &end.pose), 0.0);
        std::mem::swap(&mut self.touches.found, &mut self.aside);
        for touch in self.aside.iter().filter(|touch| touch.gap_m < 0.0) {
            let mut known = self.springs.contacts.iter().zip(&self.touches.found);
            let took_part = known.any(|(contact, began)| {
                began.part == touch.part && contact.n.dot(&touch.normal) > SAME_CONTACT_COSINE
            });
            if !took_part {
                // as far from it as it was at the step's start
                let gap_m = touch.gap_m - dt * touch.normal.dot(&mean.at(block, &touch.lever));
                self.touches.found.push(BlockContactPoint { gap_m, ..*touch });
            }
        }
        if self.touches.found.len() > self.springs.contacts.len() {
            // what has been solved for keeps its place
            self.touches.found.iter_mut().for_each(|touch| touch.is_past_end = false);
            self.remember(world, (block, mean));
            let springs = &mut self.springs;
            std::mem::swap(&mut springs.contacts, &mut springs.solved);
            self.place(world, (block, mean, mean), 0.0, shear_of);
            let Springs { contacts, solved, .. } = &mut self.springs;
            contacts[..solved.len()].copy_from_slice(solved);
        }
    }

    /// Slows the block where motion and springs at a step's end, after its look, hold more than `had_j` (J), and than it owes; what the springs hold.
    /// A block that its springs have just turned round has no motion to pay with: it owes the rest until they have thrown it out.
    fn hold_to(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &mut Moving),
        had_j: f64,
        shear_of: &impl Fn(&Self, usize) -> Vec3,
    ) -> Loss {
        // as the next step will find its springs
        let known = self.springs.histories.len();
        self.springs.known = known;
        self.remember(world, (block, moving));
        self.place(world, (block, moving, moving), 0.0, shear_of);
        self.springs.histories.truncate(known);
        let part = moving.part(block, &self.springs.acting_along());
        let (motion_j, allowed_j) = (moving.motion_j(block), had_j - self.springs.owed_j);
        let holds = self.springs.placed(world);
        let made_j = motion_j + holds.sum() - allowed_j;
        let paid_j = made_j.clamp(0.0, part.most_j());
        self.springs.owed_j = (made_j - paid_j).max(0.0);
        if paid_j > 0.0 {
            moving.pay(&part, paid_j);
        }
        holds
    }
}

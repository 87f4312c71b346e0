//! Energy account of an impact.
//!
//! Every step has an error, which affects restitution and spin; the losses of the contacts are
//! known more accurately. So the motion is corrected at the end of the impact to the initial energy
//! less the losses of the contacts.

use super::super::energy::{ContactDirections, MotionComponent};
use super::{BlockContactState, BlockState, SpringContact, Springs};
use crate::body::Block;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::explicit_impact::BALANCED;
use crate::solver::loss::Loss;

/// Energy account of an impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImpactEnergy {
    /// Energy gained by the errors of the steps (J).
    gained_j: f64,
    /// Energy taken by the contacts, with the energy of their springs before the impact (J).
    taken_j: f64,
    /// Directions in which its contacts have acted.
    along: ContactDirections,
}

/// Increase of the kinetic and potential energy of a block over a step (J).
pub(super) fn gained_j(
    world: &ContactEnvironment,
    block: &Block,
    (start, end): (&BlockState, &BlockState),
) -> f64 {
    let lifted_m = end.pose.centre - start.pose.centre;
    end.motion_j(block) + world.body.lifted_j(&lifted_m) - start.motion_j(block)
}

impl SpringContact {
    /// Whether its normal spring returns all that it stores, for a mass (kg).
    pub(super) fn is_elastic(&self, mass_kg: f64) -> bool {
        !self.law.normal(self.captured).is_damped(mass_kg)
    }

    /// Power into it (W) at a velocity `u` of the contact point (m/s), except that of a normal
    /// spring without a dashpot, whose energy is known at the ends of a step.
    pub(super) fn power_of_stage(
        &self,
        world: &ContactEnvironment,
        (block, u): (&Block, &Vec3),
        shear_rate: &Vec3,
    ) -> Loss {
        if self.is_elastic(block.mass_kg) {
            return self.shear_power(u, shear_rate, 0.0).on(world, self.triangle);
        }
        self.power(world, u, shear_rate)
    }
}

impl Springs {
    /// Adds a step of an impact to the account: the energy that it gained by its error, the energy
    /// that contacts took in it, and the spring energy before it (J).
    pub(super) fn account(&mut self, (gained_j, taken_j): (f64, f64), held_j: f64) {
        let began =
            ImpactEnergy { gained_j: 0.0, taken_j: held_j, along: ContactDirections::default() };
        let energy = self.energy.get_or_insert(began);
        energy.along = energy.along.and_springs(&self.contacts);
        energy.gained_j += gained_j;
        energy.taken_j += taken_j;
    }
}

impl BlockContactState {
    /// Energy stored by normal springs without dashpots in a step whose last stage is `way_s` (s)
    /// long and ends at `end`. It is known at both ends of the step, whatever features came and
    /// went in between, whereas quadrature over the stages has the error of the step.
    pub(super) fn elastic_uptake(
        &self,
        world: &ContactEnvironment,
        (block, end): (&Block, &BlockState),
        way_s: f64,
    ) -> Loss {
        let mut taken = Loss::default();
        let mut add = |joule: f64, triangle: u32| {
            let one = Loss { damping: joule, ..Loss::default() };
            taken.add(&one.on(world, triangle), 1.0);
        };
        for history in &self.springs.histories[..self.springs.known] {
            if !history.law.normal(history.captured).is_damped(block.mass_kg) {
                add(-history.normal_j, history.triangle);
            }
        }
        for contact in &self.springs.contacts {
            if contact.is_elastic(block.mass_kg) {
                let pressed_m =
                    contact.penetration_after(&end.velocity_at(block, &contact.lever), way_s);
                add(contact.normal_j(pressed_m), contact.triangle);
            }
        }
        taken
    }

    /// Corrects the motion by the energy that the errors of the steps of the impact have gained or
    /// lost: the remaining energy is the initial energy less the losses of the contacts. The part
    /// of the motion that contacts can change is scaled by one factor, so that the direction of a
    /// rebound with friction is kept. Springs cannot return more than they had (J): the excess
    /// counts as an additional loss of the contacts and is returned.
    pub(super) fn balance(&mut self, block: &Block, state: &mut BlockState) -> f64 {
        let Some(energy) = self.springs.energy.take() else { return 0.0 };
        let beyond_j = (self.springs.stored_j - energy.taken_j).max(0.0);
        let gained_j = energy.gained_j + beyond_j;
        if gained_j == 0.0 {
            return 0.0;
        }
        // if the contact directions hold hardly any motion, the whole motion is scaled
        let ways = [energy.along, ContactDirections::ALL].into_iter();
        let mut parts = ways.map(|along| state.motion_component(block, &along));
        let suffices = |part: &MotionComponent| gained_j.abs() < BALANCED * part.energy_j();
        let Some(part) = parts.find(suffices) else { return 0.0 };
        state.take_energy_from(&part, gained_j);
        self.springs.invalidate_rates();
        beyond_j
    }
}

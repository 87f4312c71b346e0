//! Where the energy of an impact has gone.
//!
//! Every step has an error, of which restitution and spin know; what contacts have taken is known better. So the motion is balanced where the
//! impact is over: it has what came in less what the contacts took.

use super::super::energy::{ContactDirections, MotionComponent};
use super::{BlockContactState, BlockState, SpringContact, Springs};
use crate::body::Block;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::explicit_impact::BALANCED;
use crate::solver::loss::Loss;

/// What becomes of the energy in an impact.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImpactEnergy {
    /// What the steps have gained by themselves (J).
    gained_j: f64,
    /// What contacts have taken, with what their springs held before it (J).
    taken_j: f64,
    /// What its contacts have acted along.
    along: ContactDirections,
}

/// How much more energy of motion and height a block has at the end of a step than at its start (J).
pub(super) fn gained_j(
    world: &ContactEnvironment,
    block: &Block,
    (start, end): (&BlockState, &BlockState),
) -> f64 {
    let lifted_m = end.pose.centre - start.pose.centre;
    end.motion_j(block) + world.body.lifted_j(&lifted_m) - start.motion_j(block)
}

impl SpringContact {
    /// Whether its normal spring gives back all that it takes up from a mass (kg).
    pub(super) fn is_elastic(&self, mass_kg: f64) -> bool {
        !self.law.normal(self.captured).is_damped(mass_kg)
    }

    /// Power that goes into it (W) at a velocity `u` of the contact point (m/s), but for a normal spring without a dashpot: what that takes up is known at the
    /// ends of a step.
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
    /// Takes a step of an impact to account: what it has gained by itself and what contacts have taken in it, and what springs held before (J).
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
    /// What normal springs without dashpots have taken up in a step whose last stage is `way_s` (s) long and ends at `end`: they are known at both ends of
    /// it, whatever features came and went between, where sums over its stages are off by its error.
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

    /// Gives motion back what the steps of the impact have lost by themselves, or takes what they have gained: what is left of the energy is
    /// what came in less what the contacts took. What they act along is scaled by one factor, so that the direction of a
    /// rebound with friction stays. What springs would have given beyond what they had (J) is none: contacts have taken that much more.
    pub(super) fn balance(&mut self, block: &Block, state: &mut BlockState) -> f64 {
        let Some(energy) = self.springs.energy.take() else { return 0.0 };
        let beyond_j = (self.springs.stored_j - energy.taken_j).max(0.0);
        let gained_j = energy.gained_j + beyond_j;
        if gained_j == 0.0 {
            return 0.0;
        }
        // where there is hardly any motion along contacts, all of it answers for them
        let ways = [energy.along, ContactDirections::ALL].into_iter();
        let mut parts = ways.map(|along| state.motion_component(block, &along));
        let answers = |part: &MotionComponent| gained_j.abs() < BALANCED * part.energy_j();
        let Some(part) = parts.find(answers) else { return 0.0 };
        state.take_energy_from(&part, gained_j);
        self.springs.invalidate_rates();
        beyond_j
    }
}

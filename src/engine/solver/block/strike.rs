//! The impact of a block in no time.
//!
//! A blow fast enough to rebound is the limit of the springs' for stiff ones ([`blow`](Footing::blow)), on plastic ground as on any other.
//! What comes more slowly and what does not rub is a blow of impulses alone, contact by contact with Newton's restitution. With several
//! contacts that rule can gain energy (Glocker 2013); where it would, all restitutions are lowered together until it does not.

use super::energy::ContactDirections;
use super::solve::{BlockContact, SWEEPS, rigid_rolling, solve};
use super::{BlockContactState, BlockState, NO_APPROACH_M_S, ROUNDING, ROUNDING_OF_SPEED};
use crate::body::Block;
use crate::contact::block::BlockTouch;
use crate::ground::FrictionElement;
use crate::math;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;

/// Halvings of the restitution where it would gain energy.
const HALVINGS: u32 = 30;

impl BlockContactState {
    /// The impact of all contacts that touch, at the place and in no time; contacts too slow to rebound take part and give
    /// nothing back. What it takes, and whether there was any.
    pub(crate) fn strike(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        state: &mut BlockState,
    ) -> Option<Loss> {
        let bursts = self.carry_clamp(block);
        let approaches = |touch: &BlockTouch| {
            state.approach_m_s(block, touch) > NO_APPROACH_M_S && !self.clamp.contains(touch)
        };
        let approaches = bursts || self.touching(block).any(approaches);
        if !approaches && !self.reaches_next_facet(world, block, state) {
            return None;
        }
        let facet = self.facet(world, block, state);
        if !approaches && facet.is_none() {
            return None;
        }
        // what did not settle before, of this block or of another, is no part of this impact
        self.unsettled = false;
        // a facet is met as in the schemes with springs: the motion is turned against it, and back
        if let Some(turn) = &facet {
            state.redirect(block, &turn.inverse());
        }
        let mut loss = None;
        if bursts || self.is_followed_to_its_limit(world, (block, state)) {
            if !self.clamp.is_on() {
                loss = self.normal_blow(world, (block, state));
            }
            loss = loss.or_else(|| self.blow(world, (block, state)));
            if loss.is_none() {
                // what does not end gives nothing back
                self.clamp.open();
            }
        }
        let loss = loss.unwrap_or_else(|| self.impulses(world, (block, state), true));
        if let Some(turn) = &facet {
            state.redirect(block, turn);
        }
        Some(loss)
    }

    /// Whether a blow is fast enough to rebound and meets something that rubs and has dashpots. Ground that gives nothing back is no case of its
    /// own: its dashpots are those of the restitution that tends to 0, and where friction and lever couple, what they leave is not what
    /// impulses make of a contact that must stop dead. Nor is that what they leave of a contact that lasts and is pressed by the blow of another,
    /// with friction or without.
    fn is_followed_to_its_limit(
        &self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) -> bool {
        let law = |touch: &BlockTouch| world.law(touch.triangle);
        let is_struck = |touch: &BlockTouch| Self::is_struck(world, (block, state), touch);
        let shear = || self.touching(block).map(|touch| &law(touch).shear);
        let is_damped = |touch: &BlockTouch| law(touch).normal(false).is_damped(block.mass_kg);
        let is_struck_anywhere = self.touching(block).any(is_struck);
        if !shear().any(FrictionElement::is_on) {
            return is_struck_anywhere
                && self.touching(block).any(|touch| !is_struck(touch))
                && self.touching(block).all(is_damped);
        }
        (is_struck_anywhere || self.can_clamp(world, block))
            && shear().all(|shear| !shear.is_on() || shear.is_damped())
    }

    /// The blow of contacts that do not slip, where pushes alone leave nothing to slip either, as of a face that falls flat: friction has
    /// nothing to do then, and impulses are exact.
    fn normal_blow(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
    ) -> Option<Loss> {
        if self.slip_m_s(block, state) > NO_APPROACH_M_S {
            return None;
        }
        let mut rebounded = state.clone();
        let loss = self.impulses(world, (block, &mut rebounded), false);
        if self.slip_m_s(block, &rebounded) > NO_APPROACH_M_S {
            self.unsettled = false;
            return None;
        }
        *state = rebounded;
        Some(loss)
    }

    /// The blow of impulses alone, with friction if it `with_friction`; what it takes.
    fn impulses(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
        with_friction: bool,
    ) -> Loss {
        let mass = state.mass(block);
        let (v, w) = (state.v, state.spin(block));
        let mut targets = std::mem::take(&mut self.targets);
        targets.clear();
        self.select_touching(block);
        targets.extend(self.selected.iter().map(|touch| {
            let law = world.law(touch.triangle);
            let back = if Self::is_struck(world, (block, state), touch) {
                let speed = state.approach_m_s(block, touch);
                law.restitution_at(speed) * speed
            } else {
                0.0
            };
            let mut contact = self.contact(world, (&mass, touch), 0.0, Vec3::zeros());
            if !with_friction {
                contact.friction = 0.0;
            }
            (contact, back)
        }));
        let (before_j, rounding_m_s) = (state.motion_j(block), ROUNDING_OF_SPEED * v.norm());
        let mut rebounded = state.clone();
        let mut try_with = |share: f64| {
            self.contacts.clear();
            let goal = |(one, back): &(BlockContact, f64)| one.with_goal(one.n * (back * share));
            self.contacts.extend(targets.iter().map(goal));
            self.rolling = rigid_rolling(&self.contacts);
            let unknowns = (&mut self.contacts[..], &mut self.rolling);
            self.unsettled =
                !solve(&mass, unknowns, (v, w), (rounding_m_s, SWEEPS), &mut self.sweeps);
            rebounded = state.clone();
            rebounded.apply_impulses(&self.contacts, &self.rolling, block.mass_kg);
            rebounded.motion_j(block) <= before_j * (1.0 + ROUNDING)
        };
        if !try_with(1.0) {
            let [most, _] = math::bisected([0.0, 1.0], HALVINGS, &mut try_with);
            try_with(most);
        }
        self.targets = targets;
        let after = (&rebounded.v, &rebounded.spin(block));
        let loss =
            self.loss_of_impulses(world, [(&v, &w), after], before_j - rebounded.motion_j(block));
        let along = ContactDirections::of_impulses(&self.contacts, &self.rolling);
        rebounded.limit_energy_gain(block, (state, &Vec3::zeros()), &along);
        *state = rebounded;
        loss
    }
}

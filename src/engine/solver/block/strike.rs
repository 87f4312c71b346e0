//! The impact of a block in no time.
//!
//! A blow fast enough to rebound is the limit of the springs' for stiff ones ([`blow`](Footing::blow)), on plastic ground as on any other.
//! What comes more slowly and what does not rub is a blow of impulses alone, contact by contact with Newton's restitution. With several
//! contacts that rule can gain energy (Glocker 2013); where it would, all restitutions are lowered together until it does not.

use super::energy::ActingAlong;
use super::solve::{BlockContact, SWEEPS, rigid_turning, solve};
use super::{Footing, Moving, ROUNDING, ROUNDING_OF_SPEED, STILL_M_S};
use crate::body::Block;
use crate::contact::block::BlockContactPoint;
use crate::ground::FrictionElement;
use crate::math;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;

/// Halvings of the restitution where it would gain energy.
const HALVINGS: u32 = 30;

impl Footing {
    /// The impact of all contacts that touch, at the place and in no time; contacts too slow to rebound take part and give
    /// nothing back. What it takes, and whether there was any.
    pub(crate) fn strike(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        moving: &mut Moving,
    ) -> Option<Loss> {
        let bursts = self.carry_clamp(block);
        let comes = |touch: &BlockContactPoint| {
            moving.approach_m_s(block, touch) > STILL_M_S && !self.clamp.holds(touch)
        };
        let comes = bursts || self.touching(block).any(comes);
        if !comes && !self.comes_to_next_facet(world, block, moving) {
            return None;
        }
        let facet = self.facet(world, block, moving);
        if !comes && facet.is_none() {
            return None;
        }
        // what did not settle before, of this block or of another, is no part of this impact
        self.unsettled = false;
        // a facet is met as in the schemes with springs: the motion is turned against it, and back
        if let Some(turn) = &facet {
            moving.redirect(block, &turn.inverse());
        }
        let mut loss = None;
        if bursts || self.is_followed_to_its_limit(world, (block, moving)) {
            if !self.clamp.is_on() {
                loss = self.square_blow(world, (block, moving));
            }
            loss = loss.or_else(|| self.blow(world, (block, moving)));
            if loss.is_none() {
                // what does not end gives nothing back
                self.clamp.open();
            }
        }
        let loss = loss.unwrap_or_else(|| self.impulses(world, (block, moving), true));
        if let Some(turn) = &facet {
            moving.redirect(block, turn);
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
        (block, moving): (&Block, &Moving),
    ) -> bool {
        let law = |touch: &BlockContactPoint| world.law(touch.triangle);
        let is_struck = |touch: &BlockContactPoint| Self::is_struck(world, (block, moving), touch);
        let shear = || self.touching(block).map(|touch| &law(touch).shear);
        let is_damped =
            |touch: &BlockContactPoint| law(touch).normal(false).is_damped(block.mass_kg);
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
    fn square_blow(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &mut Moving),
    ) -> Option<Loss> {
        if self.slip_m_s(block, moving) > STILL_M_S {
            return None;
        }
        let mut thrown = moving.clone();
        let loss = self.impulses(world, (block, &mut thrown), false);
        if self.slip_m_s(block, &thrown) > STILL_M_S {
            self.unsettled = false;
            return None;
        }
        *moving = thrown;
        Some(loss)
    }

    /// The blow of impulses alone, with friction if it `rubs`; what it takes.
    fn impulses(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &mut Moving),
        rubs: bool,
    ) -> Loss {
        let mass = moving.mass(block);
        let (v, w) = (moving.v, moving.spin(block));
        let mut wanted = std::mem::take(&mut self.wanted);
        wanted.clear();
        self.set_touching_aside(block);
        wanted.extend(self.aside.iter().map(|touch| {
            let law = world.law(touch.triangle);
            let back = if Self::is_struck(world, (block, moving), touch) {
                let speed = moving.approach_m_s(block, touch);
                law.restitution_at(speed) * speed
            } else {
                0.0
            };
            let mut contact = self.contact(world, (&mass, touch), 0.0, Vec3::zeros());
            if !rubs {
                contact.friction = 0.0;
            }
            (contact, back)
        }));
        let (before_j, rounding_m_s) = (moving.motion_j(block), ROUNDING_OF_SPEED * v.norm());
        let mut thrown = moving.clone();
        let mut try_with = |share: f64| {
            self.contacts.clear();
            let goal = |(one, back): &(BlockContact, f64)| one.with_goal(one.n * (back * share));
            self.contacts.extend(wanted.iter().map(goal));
            self.turning = rigid_turning(&self.contacts);
            let asked = (&mut self.contacts[..], &mut self.turning);
            self.unsettled = !solve(&mass, asked, (v, w), (rounding_m_s, SWEEPS), &mut self.sweeps);
            thrown = moving.clone();
            thrown.take(&self.contacts, &self.turning, block.mass_kg);
            thrown.motion_j(block) <= before_j * (1.0 + ROUNDING)
        };
        if !try_with(1.0) {
            let [most, _] = math::bisected([0.0, 1.0], HALVINGS, &mut try_with);
            try_with(most);
        }
        self.wanted = wanted;
        let after = (&thrown.v, &thrown.spin(block));
        let loss = self.booked(world, [(&v, &w), after], before_j - thrown.motion_j(block));
        let along = ActingAlong::of_impulses(&self.contacts, &self.turning);
        thrown.hold_energy(block, (moving, &Vec3::zeros()), &along);
        *moving = thrown;
        loss
    }
}

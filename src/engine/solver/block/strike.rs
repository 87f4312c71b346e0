//! The instantaneous impact of a block.
//!
//! An impact fast enough to rebound is the limit of the springs' impact for stiff springs
//! ([`blow`](BlockContactState::blow)), on plastic ground too. Slower impacts and those without
//! friction are solved by impulses alone, with Newton's restitution at each contact. With several
//! contacts Newton's rule can gain energy (Glocker 2013); then all restitutions are reduced by one
//! factor until it does not.

use super::energy::ContactDirections;
use super::solve::{BlockContact, SWEEPS, rigid_rolling, solve};
use super::{BlockContactState, BlockState, NO_APPROACH_M_S, ROUNDING, ROUNDING_OF_SPEED};
use crate::body::Block;
use crate::contact::block::BlockContactPoint;
use crate::ground::FrictionElement;
use crate::math;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;

/// Bisections for the factor of the restitutions where they would gain energy.
const HALVINGS: u32 = 30;

impl BlockContactState {
    /// The instantaneous impact of all touching contacts, at the present pose. Contacts too slow to
    /// rebound take part and do not rebound. Returns the energy that it dissipates; `None` if there
    /// is no impact.
    pub(crate) fn strike(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        state: &mut BlockState,
    ) -> Option<Loss> {
        let bursts = self.carry_clamp(block);
        let approaches = |touch: &BlockContactPoint| {
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
        // an earlier solve that did not converge, of this block or of another, is no part of this
        // impact
        self.unsettled = false;
        // as in the schemes with springs, the motion is rotated against the facet, and back
        if let Some(turn) = &facet {
            state.rotate(block, &turn.inverse());
        }
        let mut loss = None;
        if bursts || self.is_followed_to_its_limit(world, (block, state)) {
            if !self.clamp.is_on() {
                loss = self.normal_blow(world, (block, state));
            }
            loss = loss.or_else(|| self.blow(world, (block, state)));
            if loss.is_none() {
                // an impact that does not end does not rebound
                self.clamp.open();
            }
        }
        let loss = loss.unwrap_or_else(|| self.impulses(world, (block, state), true));
        if let Some(turn) = &facet {
            state.rotate(block, turn);
        }
        Some(loss)
    }

    /// Whether an impact is followed as the limit of stiff springs: it is fast enough to rebound,
    /// and has friction and dashpots. Plastic ground is no special case. Its dashpots are those of
    /// a restitution that tends to 0; where friction and lever couple, they leave another motion
    /// than impulses that stop each contact dead. The same holds for a lasting contact that is
    /// pressed by the impact of another, with friction or without.
    fn is_followed_to_its_limit(
        &self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) -> bool {
        let law = |touch: &BlockContactPoint| world.law(touch.triangle);
        let is_struck = |touch: &BlockContactPoint| Self::is_struck(world, (block, state), touch);
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

    /// The impact of contacts that do not slip before it and, with normal impulses alone, not after
    /// it either, as of a face that falls flat. Friction has no effect then, and impulses are
    /// exact.
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

    /// The impact solved by impulses alone, `with_friction` or without; returns the energy that it
    /// dissipates.
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

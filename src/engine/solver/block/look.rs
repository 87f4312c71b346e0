//! What a block can touch where it is.

use super::{Footing, TOUCH};
use crate::body::Block;
use crate::contact::block::{
    BlockContactPoint, MAX_BLOCK_CONTACTS, Pose, reduce_contacts, touches,
};
use crate::solver::environment::ContactEnvironment;

/// Features are collected for a way of the centre (–, relative to the radius of the sphere of equal volume) …
const WAY: f64 = 0.5;
/// … and so far from the balls (–, relative to their radius): a corner that far from all need not be asked for a while.
const SEES: f64 = 3.0;

impl Footing {
    /// Forgets all that was seen (before the next block).
    pub(crate) fn forget(&mut self) {
        self.near.forget();
        self.touches.forget();
        self.looked = None;
        self.clamp.open();
    }

    /// Sees to it that the features around a block are known, with room for some looks.
    fn know(&mut self, world: &ContactEnvironment, block: &Block, pose: &Pose) {
        let core = block.bound_m - block.ball_m;
        if !self.near.covers_ball(&pose.centre, core) {
            let margin = core + WAY * block.radius_m;
            let slack = SEES * block.ball_m;
            self.near.collect(world.terrain, &pose.centre, block.ball_m, margin, slack);
        }
    }

    /// Looks for all contacts of a block that are no wider apart than `reach_m`.
    pub(super) fn look_at_all(
        &mut self,
        world: &ContactEnvironment,
        (block, pose): (&Block, &Pose),
        reach_m: f64,
    ) {
        self.looked = None;
        self.know(world, block, pose);
        touches(&mut self.near, world.terrain, (block, pose), reach_m, &mut self.touches);
    }

    /// Looks for the contacts of a block that are no wider apart than `reach_m`, unless that was the last look.
    pub(crate) fn look(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        pose: &Pose,
        reach_m: f64,
    ) {
        // the look that ended a step is the one that the next begins with
        if self.looked == Some((*pose, reach_m)) {
            return;
        }
        self.look_at_all(world, (block, pose), reach_m);
        self.looked = Some((*pose, reach_m));
    }

    /// Sets aside the contacts that touch, as [`Self::set_aside`].
    pub(super) fn set_touching_aside(&mut self, block: &Block) {
        let most = TOUCH * block.radius_m;
        self.set_aside(|touch| touch.gap_m <= most);
    }

    /// Sets aside the contacts found that are `wanted`, and those of a clamp: where more than can act at a time, those that span most.
    pub(super) fn set_aside(&mut self, wanted: impl Fn(&BlockContactPoint) -> bool) {
        self.aside.clear();
        self.aside.extend(
            self.touches.found.iter().filter(|touch| self.clamp.holds(touch) || wanted(touch)),
        );
        if self.aside.len() > MAX_BLOCK_CONTACTS {
            reduce_contacts(&mut self.aside, MAX_BLOCK_CONTACTS);
        }
    }
}

//! Contact detection of a block at its present pose.

use super::{BlockContactState, TOUCH};
use crate::body::Block;
use crate::contact::block::{
    BlockContactPoint, MAX_BLOCK_CONTACTS, Pose, reduce_contacts, touches,
};
use crate::solver::environment::ContactEnvironment;

/// Travel of the centre for which mesh features are collected at once (–, relative to the radius of
/// the sphere of equal volume).
const COLLECTED_TRAVEL: f64 = 0.5;
/// Distance from the balls within which features are collected (–, relative to their radius): a
/// corner that far from all features need not be tested for a while.
const COLLECTED_REACH: f64 = 3.0;

impl BlockContactState {
    /// Clears all detected contacts (before the next block).
    pub(crate) fn forget(&mut self) {
        self.near.forget();
        self.touches.forget();
        self.last_detection = None;
        self.clamp.open();
    }

    /// Ensures that the mesh features around a block are collected, with room for several
    /// detections.
    fn collect_features(&mut self, world: &ContactEnvironment, block: &Block, pose: &Pose) {
        let core = block.bound_m - block.ball_m;
        if !self.near.covers_ball(&pose.centre, core) {
            let margin = core + COLLECTED_TRAVEL * block.radius_m;
            let slack = COLLECTED_REACH * block.ball_m;
            self.near.collect(world.terrain, &pose.centre, block.ball_m, margin, slack);
        }
    }

    /// Detects all contacts of a block with gaps up to `reach_m`.
    pub(super) fn detect_all(
        &mut self,
        world: &ContactEnvironment,
        (block, pose): (&Block, &Pose),
        reach_m: f64,
    ) {
        self.last_detection = None;
        self.collect_features(world, block, pose);
        touches(&mut self.near, world.terrain, (block, pose), reach_m, &mut self.touches);
    }

    /// Detects the contacts of a block with gaps up to `reach_m`, unless the last detection was the
    /// same.
    pub(crate) fn detect(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        pose: &Pose,
        reach_m: f64,
    ) {
        // the detection that ended a step is the one that the next step begins with
        if self.last_detection == Some((*pose, reach_m)) {
            return;
        }
        self.detect_all(world, (block, pose), reach_m);
        self.last_detection = Some((*pose, reach_m));
    }

    /// Selects the contacts that touch, as [`Self::select`].
    pub(super) fn select_touching(&mut self, block: &Block) {
        let most = TOUCH * block.radius_m;
        self.select(|touch| touch.gap_m <= most);
    }

    /// Selects the detected contacts that are `wanted` and those of a clamp. If more are found than
    /// can act at a time, those that span the largest area are kept.
    pub(super) fn select(&mut self, wanted: impl Fn(&BlockContactPoint) -> bool) {
        self.selected.clear();
        self.selected.extend(
            self.touches.found.iter().filter(|touch| self.clamp.contains(touch) || wanted(touch)),
        );
        if self.selected.len() > MAX_BLOCK_CONTACTS {
            reduce_contacts(&mut self.selected, MAX_BLOCK_CONTACTS);
        }
    }
}

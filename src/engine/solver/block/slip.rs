//! How fast a block slips, and how far a step may take it.

use super::solve::BlockContact;
use super::{BlockContactState, BlockState, DETECTION_REACH, HELD};
use crate::body::Block;
use crate::contact::FeatureKind;
use crate::contact::block::BlockTouch;
use crate::rock::Vec3;

/// Corners that all skid over one triangle each may go this much further in a step (–): while they do, nothing of the contact changes.
const SKID_TRAVEL: f64 = 3.0;
/// They skid where each of them is at least so fast (–, relative to what any point of the block can be): the block hardly turns.
const SKID_SPEED: f64 = 0.7;

/// How fast a point of a block moves along a surface (m/s).
pub(super) fn slip_m_s(block: &Block, state: &BlockState, (n, lever): (&Vec3, &Vec3)) -> f64 {
    let u = state.velocity_at(block, lever);
    (u - n * n.dot(&u)).norm()
}

impl BlockContactState {
    /// Fastest slip of the contacts that touch (m/s).
    pub(super) fn slip_m_s(&self, block: &Block, state: &BlockState) -> f64 {
        let slip = |touch: &BlockTouch| slip_m_s(block, state, (&touch.normal, &touch.lever));
        let free = self.touching(block).filter(|touch| !self.clamp.contains(touch));
        free.map(slip).fold(0.0, f64::max)
    }

    /// How far the fastest point of a block, at `fastest` (m/s), may go in a step (m): `corner_way` of the balls, and further where every corner
    /// that is held skids over one triangle until it comes to the edge of that. No further than what touches is known.
    pub(super) fn step_travel_m(
        &self,
        (block, state): (&Block, &BlockState),
        corner_way: f64,
        fastest: f64,
    ) -> f64 {
        let short_m = corner_way * block.ball_m;
        let long_m = (SKID_TRAVEL * corner_way).min(DETECTION_REACH) * block.ball_m;
        let held = self.touches.found.iter().filter(|touch| touch.gap_m <= HELD * block.radius_m);
        let ways = held.map(|touch| {
            let u = state.velocity_at(block, &touch.lever);
            let skids = block.core.is_corner(touch.part)
                && touch.feature.kind == FeatureKind::Face
                && u.norm() >= SKID_SPEED * fastest;
            let foot = state.pose.centre + touch.lever;
            if skids { self.near.way_over(touch.feature.id, (&foot, &u)) } else { 0.0 }
        });
        let way_m = ways.reduce(f64::min).unwrap_or(0.0);
        way_m.clamp(short_m, long_m.max(short_m))
    }

    /// Fastest slip (m/s) of the contacts that have pushed in a step of the rigid limit, with the motion at one of its ends. Which of them
    /// touch at the end says little: what pushes may leave a hair's breadth.
    pub(super) fn pushed_slip_m_s(&self, block: &Block, state: &BlockState) -> f64 {
        let pushed = self.contacts.iter().filter(|contact| contact.pushes() && !contact.is_clamped);
        let slip = |contact: &BlockContact| slip_m_s(block, state, (&contact.n, &contact.lever));
        pushed.map(slip).fold(0.0, f64::max)
    }
}

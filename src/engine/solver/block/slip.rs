//! How fast a block slips, and how far a step may take it.

use super::solve::BlockContact;
use super::{AHEAD, Footing, HELD, Moving};
use crate::body::Block;
use crate::contact::FeatureKind;
use crate::contact::block::BlockContactPoint;
use crate::rock::Vec3;

/// Corners that all skid over one triangle each may go this much further in a step (–): while they do, nothing of the contact changes.
const SKIDS: f64 = 3.0;
/// They skid where each of them is at least so fast (–, relative to what any point of the block can be): the block hardly turns.
const SKIDS_AT: f64 = 0.7;

/// How fast a point of a block moves along a surface (m/s).
pub(super) fn slip_m_s(block: &Block, moving: &Moving, (n, lever): (&Vec3, &Vec3)) -> f64 {
    let u = moving.at(block, lever);
    (u - n * n.dot(&u)).norm()
}

impl Footing {
    /// Fastest slip of the contacts that touch (m/s).
    pub(super) fn slip_m_s(&self, block: &Block, moving: &Moving) -> f64 {
        let slip =
            |touch: &BlockContactPoint| slip_m_s(block, moving, (&touch.normal, &touch.lever));
        let free = self.touching(block).filter(|touch| !self.clamp.holds(touch));
        free.map(slip).fold(0.0, f64::max)
    }

    /// How far the fastest point of a block, at `fastest` (m/s), may go in a step (m): `corner_way` of the balls, and further where every corner
    /// that is held skids over one triangle until it comes to the edge of that. No further than what touches is known.
    pub(super) fn way_m(
        &self,
        (block, moving): (&Block, &Moving),
        corner_way: f64,
        fastest: f64,
    ) -> f64 {
        let short_m = corner_way * block.ball_m;
        let long_m = (SKIDS * corner_way).min(AHEAD) * block.ball_m;
        let held = self.touches.found.iter().filter(|touch| touch.gap_m <= HELD * block.radius_m);
        let ways = held.map(|touch| {
            let u = moving.at(block, &touch.lever);
            let skids = block.core.is_corner(touch.part)
                && touch.feature.kind == FeatureKind::Face
                && u.norm() >= SKIDS_AT * fastest;
            let foot = moving.pose.centre + touch.lever;
            if skids { self.near.path_on_face_m(touch.feature.id, (&foot, &u)) } else { 0.0 }
        });
        let way_m = ways.reduce(f64::min).unwrap_or(0.0);
        way_m.clamp(short_m, long_m.max(short_m))
    }

    /// Fastest slip (m/s) of the contacts that have pushed in a step of the rigid limit, with the motion at one of its ends. Which of them
    /// touch at the end says little: what pushes may leave a hair's breadth.
    pub(super) fn pushed_slip_m_s(&self, block: &Block, moving: &Moving) -> f64 {
        let pushed = self.contacts.iter().filter(|contact| contact.pushes() && !contact.is_clamped);
        let slip = |contact: &BlockContact| slip_m_s(block, moving, (&contact.n, &contact.lever));
        pushed.map(slip).fold(0.0, f64::max)
    }
}

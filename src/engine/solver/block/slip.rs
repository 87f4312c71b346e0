//! Slip speed of a block, and the largest travel of a step.

use super::solve::BlockContact;
use super::{BlockContactState, BlockState, DETECTION_REACH, HELD};
use crate::body::Block;
use crate::contact::FeatureKind;
use crate::contact::block::BlockContactPoint;
use crate::rock::Vec3;

/// If every supported corner skids over a single triangle, a step may be longer by this factor (–):
/// its contacts do not change meanwhile.
const SKID_TRAVEL: f64 = 3.0;
/// A corner skids if its speed is at least this share of the largest speed of any point of the
/// block (–): the block hardly turns.
const SKID_SPEED: f64 = 0.7;

/// Tangential speed of a point of a block along a surface (m/s).
pub(super) fn slip_m_s(block: &Block, state: &BlockState, (n, lever): (&Vec3, &Vec3)) -> f64 {
    let u = state.velocity_at(block, lever);
    (u - n * n.dot(&u)).norm()
}

impl BlockContactState {
    /// Largest slip speed of the touching contacts (m/s).
    pub(super) fn slip_m_s(&self, block: &Block, state: &BlockState) -> f64 {
        let slip =
            |touch: &BlockContactPoint| slip_m_s(block, state, (&touch.normal, &touch.lever));
        let free = self.touching(block).filter(|touch| !self.clamp.contains(touch));
        free.map(slip).fold(0.0, f64::max)
    }

    /// Largest travel in a step (m) of the fastest point of a block, which moves at `fastest`
    /// (m/s): `corner_way` times the balls' radius. It may be larger while every supported corner
    /// skids over one triangle, up to the edge of that triangle, but never beyond the reach of
    /// contact detection.
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
            if skids { self.near.path_on_face_m(touch.feature.id, (&foot, &u)) } else { 0.0 }
        });
        let way_m = ways.reduce(f64::min).unwrap_or(0.0);
        way_m.clamp(short_m, long_m.max(short_m))
    }

    /// Largest slip speed (m/s) of the contacts with an impulse in a step of the rigid limit, with
    /// the motion at one of its ends. Which contacts touch at the end says little: a contact with
    /// an impulse may leave a tiny gap.
    pub(super) fn pushed_slip_m_s(&self, block: &Block, state: &BlockState) -> f64 {
        let pushed = self.contacts.iter().filter(|contact| contact.pushes() && !contact.is_clamped);
        let slip = |contact: &BlockContact| slip_m_s(block, state, (&contact.n, &contact.lever));
        pushed.map(slip).fold(0.0, f64::max)
    }
}

//! How fast a block slips, and how long it can climb.

use super::{Footing, Moving};
use crate::body::Block;
use crate::contact::block::BlockTouch;
use crate::rock::Vec3;

impl Footing {
    /// Fastest slip of the contacts that touch (m/s).
    pub(super) fn slip_m_s(&self, block: &Block, moving: &Moving) -> f64 {
        let slip = |touch: &BlockTouch| {
            let u = moving.at(block, &touch.lever);
            (u - touch.normal * touch.normal.dot(&u)).norm()
        };
        self.touching(block).map(slip).fold(0.0, f64::max)
    }
}

/// No step ends sooner for want of energy (s).
const SHORTEST_S: f64 = 1e-6;

impl Moving {
    /// How long a step may be (s) in which the block climbs half of its way on the energy that it has (J): where a contact lets out a block
    /// that hardly moves, a longer one would lift it for nothing.
    pub(super) fn climbs_s(&self, (mass_kg, gravity): (f64, &Vec3), motion_j: f64) -> f64 {
        let power_w = -mass_kg * gravity.dot(&self.v);
        if power_w > 0.0 { (2.0 * motion_j / power_w).max(SHORTEST_S) } else { f64::INFINITY }
    }
}

//! How fast a block slips.

use super::{Footing, Moving};
use crate::body::Block;
use crate::contact::block::BlockTouch;

impl Footing {
    /// Fastest slip of the contacts that touch (m/s).
    pub(super) fn slip_m_s(&self, block: &Block, moving: &Moving) -> f64 {
        let slip = |touch: &BlockTouch| {
            let u = moving.at(block, &touch.lever);
            (u - touch.normal * touch.normal.dot(&u)).norm()
        };
        self.touching(block).map(slip).fold(0.0, f64::max)
    }

    /// Whether a contact that touches slides.
    pub(super) fn slides(&self, block: &Block, moving: &Moving) -> bool {
        self.slip_m_s(block, moving) > 1e-6 * (1.0 + moving.v.norm())
    }
}

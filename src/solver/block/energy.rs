//! A step of a block never gains energy.

use super::Moving;
use crate::body::Block;
use crate::solver::environment::ContactEnvironment;

/// No step is cut shorter than this for the height that motion can pay (s).
const SHORTEST_RISE_S: f64 = 1e-5;

/// Longest step (s) in which a block that rises, with motion of `motion_j`, gets no higher in its first half than that can pay.
pub(super) fn rising_s(world: &ContactEnvironment, moving: &Moving, motion_j: f64) -> f64 {
    let against_w = -world.body.mass * world.body.gravity.dot(&moving.v);
    if against_w > 0.0 { (2.0 * motion_j / against_w).max(SHORTEST_RISE_S) } else { f64::INFINITY }
}

/// Slows a block that has more energy of motion than it had and its weight gives it (J): what it had with what its weight gave on
/// the way that is behind it, and what it gives on the way to come, which is slowed too. Moving out of what it was pressed into is
/// paid by its motion.
pub(super) fn hold_energy(block: &Block, moving: &mut Moving, [had_j, comes_j]: [f64; 2]) {
    let motion_j = moving.motion_j(block);
    if motion_j > had_j + comes_j && motion_j > 0.0 {
        // motion k² = had + comes k
        let root = (comes_j * comes_j + 4.0 * motion_j * had_j.max(0.0)).sqrt();
        let kept = ((comes_j + root) / (2.0 * motion_j)).clamp(0.0, 1.0);
        moving.v *= kept;
        moving.momentum *= kept;
    }
}

//! A step of a block never gains energy.

use super::solve::{BlockContact, Mass, turning_limit};
use super::{Footing, Moving};
use crate::body::Block;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::loss::Loss;

/// Slows a block that has more energy of motion than it had, with what its weight gave on the way behind it, and than its weight gives
/// it on the way to come (J), which is slowed too. Moving out of what it was pressed into is paid by its motion.
pub(super) fn hold_energy(block: &Block, moving: &mut Moving, [had_j, comes_j]: [f64; 2]) {
    let motion_j = moving.motion_j(block);
    if motion_j > had_j + comes_j && motion_j > 0.0 {
        // motion k² = had + comes k
        let root = (comes_j * comes_j + 4.0 * motion_j * had_j.max(0.0)).sqrt();
        let kept = ((comes_j + root) / (2.0 * motion_j)).clamp(0.0, 1.0);
        moving.scale_motion(kept);
    }
}

/// No step ends sooner for want of energy (s).
const SHORTEST_S: f64 = 1e-6;

impl Moving {
    /// Scales velocity and momentum by one factor (–): the direction of the motion stays.
    pub(super) fn scale_motion(&mut self, kept: f64) {
        self.v *= kept;
        self.momentum *= kept;
    }

    /// How long a step may be (s) in which the block climbs half of its way on the energy that it has (J): where a contact lets out a block
    /// that hardly moves, a longer one would lift it for nothing.
    pub(super) fn climbs_s(&self, (mass_kg, gravity): (f64, &Vec3), motion_j: f64) -> f64 {
        let power_w = -mass_kg * gravity.dot(&self.v);
        if power_w > 0.0 { (2.0 * motion_j / power_w).max(SHORTEST_S) } else { f64::INFINITY }
    }
}

impl Footing {
    /// What friction, restitution and rolling friction of each contact took, together `lost_j`, each at least 0: impulses work with the
    /// mean of the motion before and after.
    pub(super) fn booked(
        &self,
        world: &ContactEnvironment,
        motion: [(&Vec3, &Vec3); 2],
        lost_j: f64,
    ) -> Loss {
        let limit = turning_limit(&self.contacts);
        let part = |contact: &BlockContact| {
            let [before, after] = motion.map(|motion| Mass::at(&contact.lever, motion));
            let (mean, spin) = ((before + after) * 0.5, (motion[0].1 + motion[1].1) * 0.5);
            let (push, up) = (contact.n.dot(&contact.impulse), contact.n.dot(&mean));
            let drag = contact.impulse - contact.n * push;
            let borne = contact.turning_limit() / limit.max(f64::MIN_POSITIVE);
            let rolling = -self.turning.impulse.dot(&spin) * borne;
            let taken = [-drag.dot(&mean), -push * up, rolling];
            (taken.map(|joule| joule.max(0.0)), contact.triangle)
        };
        let sum: f64 = self.contacts.iter().flat_map(|contact| part(contact).0).sum();
        let share = if sum > 0.0 { lost_j.max(0.0) / sum } else { 0.0 };
        let mut loss = Loss::default();
        for ([friction, damping, rolling], triangle) in self.contacts.iter().map(part) {
            let one = Loss { friction, damping, rolling, ..Loss::default() };
            loss.add(&one.on(world, triangle), share);
        }
        loss
    }
}

//! How far a block has slipped, and the friction that soil answers with.

use super::{Footing, Moving};
use crate::body::Block;
use crate::contact::block::BlockTouch;
use crate::ground::{Ground, Law, SlipFriction};
use crate::math;
use std::f64::consts::FRAC_PI_2;

/// How far a block has slipped.
#[derive(Debug, Default)]
pub(crate) struct Slip {
    way_m: f64,
    /// On which ground last.
    on: Option<u16>,
    /// What the grounds do.
    soils: Vec<Option<SlipFriction>>,
}

impl SlipFriction {
    /// Coefficient of friction (–) after a slip (m): `μ_0 + (2/π)(μ_max − μ_0) atan(κ s)`.
    pub(crate) fn at(&self, least: f64, slip_m: f64) -> f64 {
        least + (self.most - least) * math::atan(self.kappa_per_m * slip_m) / FRAC_PI_2
    }

    /// What is left of a slip (m) after a flight of `flight_s` (s): `s e^(−β t)`.
    pub(crate) fn left_m(&self, slip_m: f64, flight_s: f64) -> f64 {
        slip_m * math::exp(-self.beta_per_s * flight_s)
    }
}

impl Slip {
    /// Nothing has slipped yet on these grounds.
    pub(crate) fn begin(&mut self, grounds: &[Ground]) {
        (self.way_m, self.on) = (0.0, None);
        self.soils.clear();
        self.soils.extend(grounds.iter().map(|ground| ground.slip_friction));
    }

    fn soil(&self, ground: u16) -> Option<&SlipFriction> {
        self.soils.get(usize::from(ground)).and_then(Option::as_ref)
    }

    /// Coefficient of friction (–) on a ground where the block will have slipped `ahead_m` (m) further.
    pub(super) fn friction(&self, ground: u16, law: &Law, ahead_m: f64) -> f64 {
        self.soil(ground).map_or(law.friction, |soil| soil.at(law.friction, self.way_m + ahead_m))
    }

    /// Slips further, on a ground if it touches one.
    pub(super) fn grow(&mut self, slipped_m: f64, on: Option<u16>) {
        self.way_m += slipped_m;
        self.on = on.or(self.on);
    }

    /// Forgets in a flight of `flight_s` (s) what its last ground forgets.
    pub(crate) fn fly(&mut self, flight_s: f64) {
        let soil = self.on.and_then(|ground| self.soil(ground));
        self.way_m = soil.map_or(0.0, |soil| soil.left_m(self.way_m, flight_s));
    }
}

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

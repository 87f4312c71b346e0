//! Slip distance of a rock, and friction of soil that grows with it.
//!
//! `μ(s) = μ_min + (2/π)(μ_max − μ_min) atan(κ s)` (Leine et al. 2014, Eqs. 46, 47): the further a
//! rock has ploughed, the more soil it has pushed up in front. `s` grows with slip in contact and
//! decays in flight, `s' = −β s`. It is one number per rock, whatever its grounds.

use crate::ground::{Ground, Law, SlipFriction};

/// Slip distance of a rock.
#[derive(Debug, Default)]
pub(crate) struct Slip {
    slipped_m: f64,
    /// The ground touched last.
    on: Option<u16>,
    /// Slip-dependent friction of each ground, and its coefficient before any slip (–).
    soils: Vec<Option<(SlipFriction, f64)>>,
    /// Largest growth rate of friction with slip (1/m); 0 where none grows.
    fastest_per_m: f64,
}

impl Slip {
    /// No slip yet, on these grounds.
    pub(crate) fn begin(&mut self, grounds: &[Ground]) {
        (self.slipped_m, self.on) = (0.0, None);
        self.soils.clear();
        let soil = |ground: &Ground| {
            ground.slip_friction.map(|soil| (soil, ground.friction_coefficient()))
        };
        self.soils.extend(grounds.iter().map(soil));
        let rates = self.soils.iter().flatten().map(|(soil, _)| soil.kappa_per_m);
        self.fastest_per_m = rates.fold(0.0, f64::max);
    }

    /// Whether the friction of any ground grows.
    pub(crate) fn has_growing_friction(&self) -> bool {
        self.fastest_per_m > 0.0
    }

    fn soil(&self, ground: u16) -> Option<&(SlipFriction, f64)> {
        self.soils.get(usize::from(ground)).and_then(Option::as_ref)
    }

    /// Coefficient of friction (–) on a ground where the rock will have slipped `ahead_m` (m) further.
    pub(crate) fn friction(&self, ground: u16, law: &Law, ahead_m: f64) -> f64 {
        self.soil(ground).map_or(law.friction_coefficient(), |(soil, least)| {
            soil.at(*least, self.slipped_m + ahead_m)
        })
    }

    /// Largest growth rate of friction with slip (1/m).
    pub(crate) fn fastest_per_m(&self) -> f64 {
        self.fastest_per_m
    }

    /// Adds slip (m), on a ground if the rock touches one.
    pub(crate) fn grow(&mut self, slipped_m: f64, on: Option<u16>) {
        self.slipped_m += slipped_m;
        self.on = on.or(self.on);
    }

    /// Decay in a flight of `flight_s` (s), by the rate of the last ground: `s e^(−β t)` exactly.
    pub(crate) fn decay(&mut self, flight_s: f64) {
        let soil = self.on.and_then(|ground| self.soil(ground));
        self.slipped_m = soil.map_or(0.0, |(soil, _)| soil.left_m(self.slipped_m, flight_s));
    }
}

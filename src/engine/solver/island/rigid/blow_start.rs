//! What a blow begins with, and which gaps close while it lasts.

use crate::ground::Law;
use crate::solver::rigid::HELD;
use nalgebra::Rotation3;
use std::f64::consts::PI;

/// Widest gap that closes within a blow (–, relative to R of the smaller rock): beyond it normals would turn while it lasts.
pub(super) const WIDEST: f64 = 0.05;
/// A gap that is rounding of places (–, relative to R of the smaller rock).
const NO_GAP: f64 = 1e-8;

/// What a blow begins with.
pub(super) struct BlowStart {
    /// The pair of rocks, or none where one comes to the mesh.
    pub(super) pair: Option<usize>,
    /// Turn of the facet of rough ground that is struck, if there is one.
    pub(super) turn: Option<Rotation3<f64>>,
    /// Distance of its centre (m) at which a rock that comes to the mesh touches it: its radius, but for rounding.
    pub(super) touches_m: f64,
    /// How fast its ends come at each other (m/s) …
    pub(super) approach_m_s: f64,
    /// … and how long they stay near each other (s): gaps that close meanwhile belong to the blow.
    pub(super) lasts_s: f64,
}

impl BlowStart {
    /// How long springs of a law are pressed in one blow, and as long again (s): what has just let go is still near.
    pub(super) fn lasting_s(law: &Law) -> f64 {
        2.0 * PI / law.omega_rad_s()
    }

    /// Widest gap (m) beside a rock of this radius (m) that closes while the blow lasts, at `closing_m_s` (m/s) and what the blow gives: up to twice
    /// the approach, to a light rock that a heavy one strikes.
    pub(super) fn closes_m(&self, closing_m_s: f64, radius_m: f64) -> f64 {
        let way_m = (closing_m_s.max(0.0) + 2.0 * self.approach_m_s) * self.lasts_s;
        way_m.min(WIDEST * radius_m)
    }

    /// The gap (m) beside a rock of this radius (m) where so much is left. What is held is held though it is moved a little apart, and where no gap closes all is in touch that
    /// is as near; else rounding alone leaves none.
    pub(super) fn gap_m(&self, left_m: f64, radius_m: f64, is_held: bool) -> f64 {
        let none = if is_held || self.lasts_s <= 0.0 { HELD } else { NO_GAP };
        if left_m > none * radius_m { left_m } else { 0.0 }
    }

    /// Whether rock `k` of the blow is the one that comes to the mesh.
    pub(super) fn is_struck(&self, k: usize) -> bool {
        self.pair.is_none() && k == 0
    }

    /// Distance (m) at which rock `k` of the blow, of this radius (m), touches the mesh.
    pub(super) fn reach_m(&self, k: usize, radius_m: f64) -> f64 {
        if self.is_struck(k) { self.touches_m } else { radius_m }
    }
}

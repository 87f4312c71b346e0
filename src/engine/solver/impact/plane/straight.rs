//! An impact without weight and without rolling: slip keeps its line, so that one variable for slip
//! and one for the spring suffice.
//!
//! Two rocks that strike each other are such a case: their slip stays on a straight line while only
//! the contact acts on it. The law, its steps and their error are those of [`Plane::follow`]; only
//! the impulses are returned, neither displacements nor losses.

use super::{ImpactStart, Plane, SMOOTH};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::contact_frame::{Along, square};
use crate::solver::impact::ImpactEffort;
use crate::solver::impact::sliders::LineShearFlow;

/// Impulses over the mass (m/s) of an impact on `body` at a normal speed and a slip, both in m/s
/// and the first positive: along the normal, and against the slip. `tolerance` is relative to the
/// magnitude of both (–).
///
/// The same as [`frozen_impact`](super::super::frozen_impact) gives for one contact without
/// rolling, to rounding.
pub(crate) fn blow_along_a_line(
    (body, law): (&Body, &Law),
    captured: bool,
    [approach, slip]: [f64; 2],
    tolerance: f64,
) -> [f64; 2] {
    let plane = blow_plane((body, law), captured, tolerance);
    // without weight nothing keeps the rock except a speed too small to be squared
    let Some(exit) = plane.oscillator.exit(0.0) else { return [approach, 0.0] };
    let kept = if captured { 0.0 } else { exit.speed };
    let against = if slip > 0.0 && plane.shear.is_on() {
        approach * plane.friction_impulse(slip / approach, exit.lift_off)
    } else {
        0.0
    };
    [approach * (1.0 + kept), against]
}

/// The impacts of a body without weight.
pub(super) fn blow_plane((body, law): (&Body, &Law), captured: bool, tolerance: f64) -> Plane {
    let body = Body { gravity: Vec3::zeros(), ..*body };
    Plane::of_patch(&body, law, (captured, 1.0), tolerance)
}

impl Plane {
    /// Impulse against the slip `u` of an impact of this length, in units of mass, approach speed
    /// and `1/ω`.
    pub(super) fn friction_impulse(&self, u: f64, length: f64) -> f64 {
        let start = ImpactStart {
            v: [u, 0.0],
            w: [0.0; 3],
            shear: [0.0; 2],
            roll: [0.0; 3],
            gravity: [0.0; 2],
            gamma: 0.0,
            begin: self.oscillator.onset(0.0),
            leaves: true,
            allowed: SMOOTH * self.tolerance * (1.0 + u * u).sqrt(),
        };
        let (after, _) = self.along_a_line(u, &start, length, &mut ImpactEffort::default());
        (u - after) / (1.0 + self.body.turns())
    }

    /// As [`LineShearFlow`] from a slip in two directions: slip at the end, loss by slip, and the
    /// slip distance.
    pub(super) fn slips_along_a_line(
        &self,
        slip: Along,
        start: &ImpactStart,
        length: f64,
        effort: &mut ImpactEffort,
    ) -> (Along, f64, Along) {
        let size = square(slip).sqrt();
        if size == 0.0 {
            return ([0.0; 2], 0.0, [0.0; 2]);
        }
        let (after, [taken, way]) = self.along_a_line(size, start, length, effort);
        (slip.map(|u| u * (after / size)), taken, slip.map(|u| u * (way / size)))
    }

    /// The slip at the end from the slip `u`, the loss by slip, and the slip distance.
    fn along_a_line(
        &self,
        u: f64,
        start: &ImpactStart,
        length: f64,
        effort: &mut ImpactEffort,
    ) -> (f64, [f64; 2]) {
        let flow = LineShearFlow { element: self.shear, lightness: 1.0 + self.body.turns() };
        let ([after, _], sums) = self.run(&flow, [u, 0.0], start, length, effort);
        // the spring returns no more than it had, whatever the integration error
        (after.clamp(-u, u), sums)
    }
}

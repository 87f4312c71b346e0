//! Height of a rock in contact over the ground vertically below it.
//!
//! On a slope that ground is lower than the ground that the rock touches: a sphere that rolls on
//! even ground of inclination θ has `R (1/cos θ − 1)` below its lowest point. Contact steps are
//! many and short, so the mesh is searched in few of them only. The triangle last found below the
//! centre is the ground or lies below it; as long as the centre is over that triangle, it bounds
//! the height from above.

use super::heights::{ERROR_M, Heights};
use super::rock_geometry::{RockGeometry, RockInstant};
use crate::terrain::Terrain;

/// The triangle last found below the centre of a rock; none beside the terrain.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TriangleBelow(Option<u32>);

impl TriangleBelow {
    /// Upper bound of the height of a rock at both ends of a step (m); infinite where no triangle
    /// gives one.
    pub(super) fn height_bound_m(
        &mut self,
        (terrain, geometry): (&Terrain, &RockGeometry),
        ends: [&RockInstant; 2],
    ) -> f64 {
        let cached_m = self.cached_bound_m((terrain, geometry), ends);
        if cached_m.is_finite() {
            return cached_m;
        }
        self.find(terrain, ends[1]);
        self.cached_bound_m((terrain, geometry), ends)
    }

    /// The same bound from the triangle found last.
    fn cached_bound_m(
        self,
        (terrain, geometry): (&Terrain, &RockGeometry),
        ends: [&RockInstant; 2],
    ) -> f64 {
        let height_m = |at: &RockInstant| {
            let centre = at.motion.position_m;
            let ground_m = terrain.height_on(self.0?, centre.x, centre.y);
            let is_below = ground_m.is_finite() && ground_m <= centre.z;
            is_below.then(|| centre.z - geometry.depth_below_centre_m(at) - ground_m)
        };
        let [from, to] = ends.map(height_m);
        from.zip(to).map_or(f64::INFINITY, |(from, to)| from.max(to))
    }

    /// Searches for the triangle.
    fn find(&mut self, terrain: &Terrain, at: &RockInstant) {
        let centre = at.motion.position_m;
        let found = terrain.triangle_under(centre.x, centre.y, centre.z);
        self.0 = found.map(|(_, triangle)| triangle);
    }
}

/// The heights of a step in contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepHeights<'a> {
    /// Path of the step over the ground; none where it takes no time.
    pub(super) heights: Option<Heights<'a>>,
    /// Upper bound of the height (m).
    pub(super) height_bound_m: f64,
}

impl StepHeights<'_> {
    /// Largest height (m) between two fractions of the step, where a height of `known_m` (m) is
    /// known already. Accurate to a millimetre for a sphere, and to three for a block, which
    /// rotates within the step.
    pub(super) fn largest_m(&self, shares: [f64; 2], known_m: f64) -> f64 {
        let Some(heights) = self.heights.filter(|_| self.height_bound_m > known_m + ERROR_M) else {
            return known_m;
        };
        let span_s = shares.map(|share| share * heights.flight.duration_s);
        heights.largest(span_s, known_m).map_or(known_m, |top| top.height_m)
    }
}

//! What 32-bit coordinates do to a mesh.

use crate::math;
use crate::terrain::facets::Facets;
use std::fmt;

/// Spacing over median edge above which normals suffer visibly (–): 0.1 % is about 0.06°.
const WORTH_A_WARNING: f64 = 1e-3;

/// Spacing over median edge above which the mesh is no longer the terrain (–): 1 % is about 0.6°, more on short edges.
const SPOILS: f64 = 1e-2;

/// Decimals that a text is asked for: fewer than centimetres serve no slope, more no file.
const FEWEST_DECIMALS: f64 = 2.0;
/// Decimals that a text is asked for at most.
const MOST_DECIMALS: f64 = 9.0;

/// Distance of neighbouring 32-bit floats at the largest coordinate, beside the median edge, in the unit of the file.
///
/// Binary STL rounds to this: at an easting of 2 600 000 m the spacing is 0.25 m.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Spacing {
    /// Largest |coordinate|.
    pub largest_coordinate: f64,
    /// Distance to the next 32-bit float there.
    pub spacing: f64,
    /// Median length of the edges, each facet by itself; 0 without facets.
    pub median_edge: f64,
}

impl Spacing {
    /// Measures the facets.
    pub fn of(facets: &Facets) -> Self {
        let largest_coordinate = facets
            .iter()
            .flatten()
            .fold(0.0, |m: f64, corner| corner.iter().fold(m, |m, x| m.max(x.abs())));
        let mut edges2: Vec<f64> = facets
            .iter()
            .flat_map(|[a, b, c]| [b - a, c - b, a - c])
            .map(|edge| edge.norm_squared())
            .collect();
        let middle = edges2.len() / 2;
        let median_edge = if edges2.is_empty() {
            0.0
        } else {
            edges2.select_nth_unstable_by(middle, f64::total_cmp).1.sqrt()
        };
        let near = largest_coordinate as f32;
        let spacing = f64::from(near.next_up()) - f64::from(near);
        Self { largest_coordinate, spacing, median_edge }
    }

    /// Spacing over median edge (–).
    pub fn share(&self) -> f64 {
        self.spacing / self.median_edge
    }

    /// Decimals of a text whose steps are about 0.1 % of the median edge.
    pub fn decimals(&self) -> usize {
        let wanted = -math::log10(WORTH_A_WARNING * self.median_edge).round();
        // without an edge millimetres will do
        if wanted.is_finite() { wanted.clamp(FEWEST_DECIMALS, MOST_DECIMALS) as usize } else { 3 }
    }

    /// More than 0.1 % of the median edge: say so.
    pub fn is_worth_a_warning(&self) -> bool {
        self.share() > WORTH_A_WARNING
    }

    /// More than 1 % of the median edge: the facets point elsewhere than the terrain.
    pub fn spoils(&self) -> bool {
        // Beyond the range of f32 the share is no number; facets without any edge are another fault
        self.median_edge > 0.0 && (self.share() > SPOILS || self.share().is_nan())
    }
}

impl fmt::Display for Spacing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.largest_coordinate > f64::from(f32::MAX) {
            return write!(f, "the largest, {:.3e}, is no 32-bit number", self.largest_coordinate);
        }
        write!(
            f,
            "32-bit numbers are {:.2e} apart at the largest coordinate {:.1}, {:.2} % of the median edge {:.3}",
            self.spacing,
            self.largest_coordinate,
            100.0 * self.share(),
            self.median_edge
        )
    }
}

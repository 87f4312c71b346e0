//! The ground that exact cases stand on.

use crate::rock::Vec3;
use crate::terrain::make;
use crate::terrain::stl::Facet;

/// Degrees as radians.
pub(super) fn angle(degrees: f64) -> f64 {
    degrees.to_radians()
}

/// A plane through the origin that falls in +y.
pub(super) fn plane(degrees: f64) -> Vec<Facet> {
    make::jittered_plane(16.0, 12, angle(degrees))
}

/// Turned downwards in +y about the x axis.
pub(super) fn tilted(facets: Vec<Facet>, degrees: f64) -> Vec<Facet> {
    let down = crate::math::turn(&Vec3::x_axis(), -angle(degrees));
    facets.into_iter().map(|facet| facet.map(|corner| down * corner)).collect()
}

/// A roof with its edge along y through the origin, so steep that a rock tips off without touching the flanks.
pub(super) fn roof() -> Vec<Facet> {
    make::ridge(4.0, angle(80.0))
}

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

/// A valley along y at x = z = 0; its sides rise by half of `angle_rad` each.
pub(in crate::study) fn fold(angle_rad: f64, half_m: f64) -> Vec<Facet> {
    make::v_groove(half_m, 0.5 * angle_rad)
}

/// `cells` x `cells` squares of `cell_m` about the origin, their corners up to `0.5 noise_m` off the plane z = 0. The numbers
/// are plain arithmetic, so that another program can make the same mesh.
pub(in crate::study) fn bumpy(cells: usize, cell_m: f64, noise_m: f64) -> Vec<Facet> {
    let at = |i: usize, j: usize| {
        let noise = ((i * 7919 + j * 104_729 + i * j * 31) % 1009) as f64 / 1009.0 - 0.5;
        let place = |k: usize| (k as f64 - 0.5 * cells as f64) * cell_m;
        Vec3::new(place(i), place(j), noise_m * noise)
    };
    let cell = |i: usize, j: usize| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..cells).flat_map(|i| (0..cells).flat_map(move |j| cell(i, j))).collect()
}

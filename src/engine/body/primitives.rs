//! Named shapes: boxes, prisms, the test blocks of EOTA, points of an ellipsoid.

use super::hull::Core;
use super::solid::Surface;
use crate::math;
use crate::rock::Vec3;
use std::f64::consts::TAU;

/// The surface of a convex set of corners.
fn surface_of(points: &[Vec3]) -> Surface {
    let Ok(core) = Core::of(points) else { return Surface::default() };
    let fan = |corners: &Vec<u8>| {
        let corners = corners.clone();
        (1..corners.len() - 1).map(move |k| [corners[0], corners[k], corners[k + 1]].map(u32::from))
    };
    let triangles = core.faces.iter().flat_map(|face| fan(&face.corners)).collect();
    Surface { points: core.corners, triangles }
}

/// A box with these sides.
pub fn box_surface(sides: [f64; 3]) -> Surface {
    let corner = |k: u32| {
        Vec3::from([0, 1, 2].map(|axis| {
            let half = 0.5 * sides[axis];
            if k & (1 << axis) == 0 { -half } else { half }
        }))
    };
    surface_of(&(0..8).map(corner).collect::<Vec<_>>())
}

/// A straight prism over a regular polygon of `count` corners, its axis along z; `ratio` is its
/// height over the diameter of the circumscribed circle.
pub fn prism_surface(count: u32, ratio: f64) -> Surface {
    let corner = |k: u32| {
        let (sin, cos) = math::sin_cos(TAU * f64::from(k / 2) / f64::from(count));
        Vec3::new(cos, sin, if k.is_multiple_of(2) { -ratio } else { ratio })
    };
    surface_of(&(0..2 * count).map(corner).collect::<Vec<_>>())
}

/// The test block of EOTA (ETAG 027) with 26 faces, corners (±1/2, ±1/4, ±1/4) and permutations,
/// stretched to `sides`.
pub fn eota(sides: [f64; 3]) -> Surface {
    let corner = |k: u32| {
        let long = (k / 8) as usize;
        Vec3::from([0, 1, 2].map(|axis| {
            let half = if axis == long { 0.5 } else { 0.25 };
            sides[axis] * if k & (1 << axis) == 0 { -half } else { half }
        }))
    };
    surface_of(&(0..24).map(corner).collect::<Vec<_>>())
}

/// 42 points spread over the unit sphere: the corners of an icosahedron and the midpoints of its
/// edges, projected to the sphere.
pub fn sphere_points() -> Vec<Vec3> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut points: Vec<Vec3> = Vec::new();
    for (y, z) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        points.extend([Vec3::new(0.0, y, z), Vec3::new(y, z, 0.0), Vec3::new(z, 0.0, y)]);
    }
    let near = |a: &Vec3, b: &Vec3| (a - b).norm() < 2.1;
    for i in 0..12 {
        for j in i + 1..12 {
            if near(&points[i], &points[j]) {
                points.push(points[i] + points[j]);
            }
        }
    }
    points.iter().map(Vec3::normalize).collect()
}

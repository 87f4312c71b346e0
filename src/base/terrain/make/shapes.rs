//! Simple shapes on which the motion of a sphere is known.

use super::noise::hash;
use crate::math;
use crate::rock::Vec3;
use crate::terrain::grid::triangulate;
use crate::terrain::stl::Facet;

/// A flat square of side `2 half_m` around the origin, falling in +y at `angle_rad` (0 = level), from `cells` x `cells`
/// cells whose inner corners are moved about within the plane by up to 0.2 cells (0.25 could fold a cell).
///
/// Flat to rounding, but no two triangles are alike: a sphere that feels the seams shows it.
pub fn jittered_plane(half_m: f64, cells: usize, angle_rad: f64) -> Vec<Facet> {
    let (sin, cos) = math::sin_cos(angle_rad);
    let cell_m = 2.0 * half_m / cells as f64;
    let place = |seed: u64, i: usize, j: usize, along: usize| {
        let inner = (1..cells).contains(&i) && (1..cells).contains(&j);
        let jitter = if inner { 0.2 * hash(seed, i as u64, j as u64) } else { 0.0 };
        cell_m * (along as f64 + jitter) - half_m
    };
    triangulate(cells + 1, cells + 1, |i, j| {
        let (x, down) = (place(1, i, j, i), place(2, i, j, j));
        Some(Vec3::new(x, down * cos, -down * sin))
    })
}

/// Two planes that meet in the line x = z = 0, `2 half_m` long in y: flanks rise outwards at `angle_rad` over a width of
/// `half_m` each, seen in plan.
pub fn v_groove(half_m: f64, angle_rad: f64) -> Vec<Facet> {
    let rise = math::tan(angle_rad);
    triangulate(3, 2, |i, j| {
        let (x, y) = ((i as f64 - 1.0) * half_m, (2.0 * j as f64 - 1.0) * half_m);
        Some(Vec3::new(x, y, x.abs() * rise))
    })
}

/// A roof: [`v_groove`] upside down, the flanks fall outwards from the edge x = z = 0.
pub fn ridge(half_m: f64, angle_rad: f64) -> Vec<Facet> {
    v_groove(half_m, -angle_rad)
}

/// Four equilateral triangles with edges of `edge_m`, apex up at the origin, one lower corner towards +x; outward facing.
pub fn tetrahedron(edge_m: f64) -> Vec<Facet> {
    let out = edge_m / 3.0_f64.sqrt();
    let down = -edge_m * (2.0_f64 / 3.0).sqrt();
    let apex = Vec3::zeros();
    let a = Vec3::new(out, 0.0, down);
    let b = Vec3::new(-0.5 * out, 0.5 * edge_m, down);
    let c = Vec3::new(-0.5 * out, -0.5 * edge_m, down);
    vec![[apex, a, b], [apex, b, c], [apex, c, a], [a, c, b]]
}

/// Two boxes without lids side by side in x, each `width_m` in x, `2 half_m` in y and `height_m` deep, with floors at
/// z = 0. The wall between them ends in a ridge: it leans to the line x = 0, z = `height_m` from floors that begin at
/// `±foot_m`.
pub fn containers(width_m: f64, half_m: f64, height_m: f64, foot_m: f64) -> Vec<Facet> {
    let profile = [
        [-foot_m - width_m, height_m],
        [-foot_m - width_m, 0.0],
        [-foot_m, 0.0],
        [0.0, height_m],
        [foot_m, 0.0],
        [foot_m + width_m, 0.0],
        [foot_m + width_m, height_m],
    ];
    let at = |k: usize, y: f64| Vec3::new(profile[k][0], y, profile[k][1]);
    let mut facets = Vec::new();
    for k in 0..profile.len() - 1 {
        facets.push([at(k, -half_m), at(k + 1, -half_m), at(k + 1, half_m)]);
        facets.push([at(k, -half_m), at(k + 1, half_m), at(k, half_m)]);
    }
    // The two end walls of each box: a trapezium from the outer wall to the ridge, facing inwards.
    for y in [-half_m, half_m] {
        for [outer, corner, foot] in [[0, 1, 2], [6, 5, 4]] {
            let wall =
                [[at(outer, y), at(corner, y), at(foot, y)], [at(outer, y), at(foot, y), at(3, y)]];
            facets.extend(wall.map(|facet| facing(facet, -y.signum())));
        }
    }
    facets
}

/// The facet wound so that its normal has the given sign in y.
fn facing([a, b, c]: Facet, sign: f64) -> Facet {
    if (b - a).cross(&(c - a)).y * sign > 0.0 { [a, b, c] } else { [a, c, b] }
}

/// `steps` steps down in +y, each `rise_m` high and `tread_m` deep, `2 half_m` wide in x; the top tread begins at
/// y = z = 0, the lowest tread lies at `−steps rise_m`.
pub fn stairs(steps: usize, rise_m: f64, tread_m: f64, half_m: f64) -> Vec<Facet> {
    // Two rows of points a step: where the tread begins and where it ends.
    triangulate(2, 2 * steps + 2, |i, j| {
        let (step, end) = ((j / 2) as f64, (j % 2) as f64);
        Some(Vec3::new((2.0 * i as f64 - 1.0) * half_m, tread_m * (step + end), -rise_m * step))
    })
}

/// The ridge of the method paper's example 1b: 45° flanks, 0.5 m wide each and 1 m long.
pub(super) fn paper_ridge() -> Vec<Facet> {
    triangulate(3, 2, |i, j| {
        let (x, y) = (0.5 * (i as f64 - 1.0), j as f64 - 0.5);
        Some(Vec3::new(x, y, -x.abs()))
    })
}

/// The same ridge between two valleys, example 1a: beyond a foot 0.5 m below the edge the ground rises again at 45°.
pub(super) fn paper_roof() -> Vec<Facet> {
    triangulate(5, 2, |i, j| {
        let (x, y) = (0.5 * (i as f64 - 2.0), j as f64 - 0.5);
        Some(Vec3::new(x, y, -0.5 + (x.abs() - 0.5).abs()))
    })
}

/// The tetrahedron of example 2, edges of 1 m, apex at the origin, on a floor that catches what falls from it. Corners
/// are dyadic fractions near those of the regular body, so that every machine writes the same file.
pub(super) fn paper_tetrahedron() -> Vec<Facet> {
    let (apex, down) = (Vec3::zeros(), -0.816_406_25);
    let a = Vec3::new(0.577_148_437_5, 0.0, down);
    let b = Vec3::new(-0.288_574_218_75, 0.5, down);
    let c = Vec3::new(-0.288_574_218_75, -0.5, down);
    vec![[apex, a, b], [apex, b, c], [apex, c, a], [a, c, b]]
}

/// The two containers of example 3, 0.5 m wide, 0.625 m long and 0.625 m deep, on a floor 4 m wide.
pub(super) fn paper_containers() -> Vec<Facet> {
    let mut facets = containers(0.5, 0.3125, 0.625, 0.125);
    let (half, z) = (2.0, -0.125);
    let at = |x: f64, y: f64| Vec3::new(x * half, y * half, z);
    facets.push([at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0)]);
    facets.push([at(-1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]);
    facets
}

//! Meshes of every awkward kind, and the slow but obvious geometry that the fast one is compared with.

use super::terrain;
use rockfall::contact::closest::closest_on;
use rockfall::flight::Parabola;
use rockfall::random::{Purpose, RandomStream, stream, unit};
use rockfall::rock::Vec3;
use rockfall::terrain::Terrain;
use rockfall::terrain::stl::Facet;

/// Evenly drawn from a range.
pub fn between(random: &mut RandomStream, from: f64, to: f64) -> f64 {
    from + (to - from) * unit(random)
}

/// A point in the cube of half width `half`.
pub fn point(random: &mut RandomStream, half: f64) -> Vec3 {
    Vec3::from_fn(|_, _| between(random, -half, half))
}

/// A stream of chance for one case of one test.
pub fn dice(seed: u64, index: usize) -> RandomStream {
    stream(seed, Purpose::Place, index)
}

/// Names of the kinds of mesh in [`zoo`].
pub const KINDS: [&str; 8] =
    ["rough", "spiky", "terraces", "soup", "fans", "walls", "seams", "stones"];

/// A mesh of one kind, about 4 m wide and with at most some 130 triangles; every third one has faces flipped at
/// random, so that no test can rely on winding.
pub fn zoo(kind: usize, index: usize) -> Terrain {
    let random = &mut dice(100 + kind as u64, index);
    let mut facets = match KINDS[kind] {
        "rough" => heights(random, 8, 0.4),
        "spiky" => heights(random, 6, 1.6),
        "terraces" => terraces(random),
        "soup" => soup(random),
        "fans" => fans(random),
        "walls" => walls(random),
        "seams" => seams(random),
        _ => stones(random),
    };
    if index % 3 == 2 {
        for facet in &mut facets {
            if unit(random) < 0.5 {
                facet.swap(1, 2);
            }
        }
    }
    terrain(facets)
}

/// A jagged height field: ridges, valleys, peaks, pits.
fn heights(random: &mut RandomStream, cells: usize, amplitude: f64) -> Vec<Facet> {
    let z: Vec<f64> =
        (0..(cells + 1).pow(2)).map(|_| between(random, -amplitude, amplitude)).collect();
    map_grid(cells, |i, j| z[i * (cells + 1) + j])
}

/// Flat treads and vertical-free risers: heights rounded to steps, so that many edges are flat.
fn terraces(random: &mut RandomStream) -> Vec<Facet> {
    let z: Vec<f64> = (0..81).map(|_| (3.0 * unit(random)).floor() * 0.5).collect();
    map_grid(8, |i, j| z[i / 2 * 9 + j / 2])
}

fn map_grid(cells: usize, z: impl Fn(usize, usize) -> f64) -> Vec<Facet> {
    let at = |i: usize, j: usize| {
        let place = |k: usize| 4.0 * k as f64 / cells as f64 - 2.0;
        Vec3::new(place(i), place(j), z(i, j))
    };
    let mut facets = Vec::new();
    for i in 0..cells {
        for j in 0..cells {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if (i + j) % 2 == 0 {
                facets.extend([[a, b, c], [a, c, d]]);
            } else {
                facets.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    facets
}

/// Loose triangles that run through each other.
fn soup(random: &mut RandomStream) -> Vec<Facet> {
    (0..30)
        .map(|_| {
            let middle = point(random, 1.5);
            [0; 3].map(|_| middle + point(random, 0.8))
        })
        .collect()
}

/// Sheets that share one edge, three to six at a time.
fn fans(random: &mut RandomStream) -> Vec<Facet> {
    let mut facets = Vec::new();
    for _ in 0..4 {
        let (a, b) = (point(random, 1.5), point(random, 1.5));
        for _ in 0..3 + (4.0 * unit(random)) as usize {
            facets.push([a, b, point(random, 2.0)]);
        }
    }
    facets
}

/// Upright and level plates with corners on binary fractions: their boxes have no thickness and no rounding.
fn walls(random: &mut RandomStream) -> Vec<Facet> {
    let mut facets = Vec::new();
    for _ in 0..8 {
        let axis = (3.0 * unit(random)) as usize;
        let on = |random: &mut RandomStream| (between(random, -8.0, 8.0)).round() * 0.25;
        let (level, u, v) = (on(random), on(random), on(random));
        let at = |du: f64, dv: f64| {
            let mut p = Vec3::zeros();
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (level, u + du, v + dv);
            p
        };
        facets.push([at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)]);
        facets.push([at(0.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]);
    }
    facets
}

/// A folded sheet in two halves that meet along a seam with different vertices on either side.
fn seams(random: &mut RandomStream) -> Vec<Facet> {
    let (tilt, fold) = (between(random, -0.5, 0.5), between(random, -0.6, 0.6));
    let z = |x: f64, y: f64| tilt * y + if x > 0.0 { fold * x } else { 0.0 };
    let at = |x: f64, y: f64| Vec3::new(x, y, z(x, y));
    let mut facets = Vec::new();
    for (side, pieces) in [(-1.0, 3), (1.0, 4)] {
        for k in 0..pieces {
            let y = |k: i32| 4.0 * f64::from(k) / f64::from(pieces) - 2.0;
            let [a, b] = [at(0.0, y(k)), at(0.0, y(k + 1))];
            let [c, d] = [at(2.0 * side, y(k + 1)), at(2.0 * side, y(k))];
            facets.extend([[a, b, c], [a, c, d]]);
        }
    }
    facets
}

/// Closed tetrahedra lying about.
fn stones(random: &mut RandomStream) -> Vec<Facet> {
    let mut facets = Vec::new();
    for _ in 0..6 {
        let middle = point(random, 1.5);
        let [a, b, c, d] = [0; 4].map(|_| middle + point(random, 0.7));
        facets.extend([[a, b, c], [a, c, d], [a, d, b], [b, d, c]]);
    }
    facets
}

/// Distance from `p` to the nearest triangle (m), over all of them.
pub fn distance(terrain: &Terrain, p: &Vec3) -> f64 {
    (0..terrain.triangles.len() as u32)
        .map(|t| (p - closest_on(&terrain.corners_m(t), p)).norm())
        .fold(f64::INFINITY, f64::min)
}

/// First time at which a ball on `flight` comes within `reach` (m) of the mesh, at most `limit`, by steps that the gap
/// allows: it cannot jump over anything (but a graze of less than 0.1 ms).
pub fn crawl(terrain: &Terrain, flight: &Parabola, reach: f64, limit: f64) -> Option<f64> {
    let mut t = 0.0;
    while t <= limit {
        let gap = distance(terrain, &flight.centre(t)) - reach;
        if gap <= 1e-10 {
            return Some(t);
        }
        // Fastest speed while the gap is used up: v + g dt with dt <= gap/v.
        let v = flight.velocity(t).norm();
        let g = flight.gravity;
        t += (2.0 * gap / (v + (v * v + 2.0 * g * gap).sqrt())).max(1e-4);
    }
    None
}

//! Contact finding against the definition: a strict local minimum of the distance, looked for on every triangle.
#![allow(
    clippy::needless_range_loop,
    clippy::float_cmp,
    reason = "kinds are numbered; the same touch has the same bits"
)]

mod common;
use common::zoo::*;
use common::*;
use rockfall::contact::closest::closest_on;
use rockfall::contact::near::Near;
use rockfall::contact::{MOST, Touches};
use rockfall::rock::Vec3;
use rockfall::terrain::{Terrain, make};

/// Nearest points of triangles that are nearer than all of the mesh around them, with their distances, nearest first.
///
/// A triangle is convex: near one of its points it comes closer to `c` exactly if its nearest point is closer.
fn minima(terrain: &Terrain, c: &Vec3, reach: f64) -> Vec<(f64, Vec3)> {
    let all: Vec<_> = (0..terrain.triangles.len() as u32).map(|t| terrain.corners_m(t)).collect();
    let mut found: Vec<(f64, Vec3)> = Vec::new();
    for corners in &all {
        let p = closest_on(corners, c);
        let d = (c - p).norm();
        let is_minimum = || {
            all.iter().all(|other| {
                (p - closest_on(other, &p)).norm() > 1e-12
                    || (c - closest_on(other, c)).norm() > d - 1e-13
            })
        };
        if d < reach && found.iter().all(|(_, q)| (p - q).norm() > 1e-7) && is_minimum() {
            found.push((d, p));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Every touch is a minimum and every minimum a touch, wherever within the margin the features were collected.
#[test]
fn touches_are_the_local_minima_of_the_distance() {
    let (mut asked, mut most) = (0, 0);
    let (mut near, mut touches) = (Near::default(), Touches::default());
    for kind in 0..KINDS.len() {
        for mesh in 0..12 {
            let terrain = zoo(kind, mesh);
            for index in 0..100 {
                let chance = &mut dice(600, index + 1000 * mesh);
                let radius = 0.05 * 20f64.powf(between(chance, 0.0, 1.0));
                let t = between(chance, 0.0, terrain.triangles.len() as f64) as u32;
                let [a, b, c] = terrain.corners_m(t);
                let (u, v) = (between(chance, 0.0, 1.0), between(chance, 0.0, 1.0));
                let centre = a
                    + (b - a) * (u * (1.0 - v))
                    + (c - a) * (u * v)
                    + point(chance, 1.0).normalize() * (radius * between(chance, 0.0, 1.1));
                let (margin, slack) = (0.35 * radius, 0.1 * radius);
                let from = centre + point(chance, 1.0).normalize() * (0.999 * margin);
                near.collect(&terrain, &from, radius, margin, slack);
                near.touches(&terrain, &centre, radius, &mut touches);
                let right = minima(&terrain, &centre, radius);
                asked += 1;
                most = most.max(right.len());
                let name = format!("{} {mesh} {index} R {radius} {centre:?}", KINDS[kind]);
                assert_eq!(touches.len(), right.len().min(MOST), "{name}: {touches:?} {right:?}");
                for (d, p) in right.iter().take(MOST) {
                    let found = touches.iter().find(|touch| {
                        (touch.distance_m - d).abs() < 1e-9
                            && (centre - touch.normal * touch.distance_m - p).norm() < 1e-7
                    });
                    assert!(found.is_some(), "{name}: {p:?} is missing in {touches:?}");
                }
            }
        }
    }
    assert!(asked > 9000 && most > MOST, "{asked} {most}");
}

/// A sphere over one plane, wherever it stands on it: exactly above vertices, edges and their middles it has one contact,
/// with the normal of the plane. Also far out on the map, where coordinates are rounded to 1e-10 m.
#[test]
fn one_plane_is_one_contact() {
    for (angle, shift) in [(0.0, 0.0), (0.58, 0.0), (0.0, 1e6), (0.58, 1e6)] {
        let map = Vec3::new(shift, 2.0 * shift, 0.0);
        let facets = make::jittered_plane(6.0, 20, angle);
        let terrain = terrain(facets.into_iter().map(|f| f.map(|p| p + map)).collect());
        let normal = Vec3::new(0.0, f64::sin(angle), f64::cos(angle));
        let radius = 0.5;
        let (mut near, mut touches) = (Near::default(), Touches::default());
        let features = &terrain.features;
        let mut feet: Vec<Vec3> = terrain.vertices_m.clone();
        for &[a, b] in &features.edges.ends {
            let [a, b] = [a, b].map(|v| terrain.vertices_m[v as usize]);
            feet.extend([0.5, 0.1, 1e-6, 1e-7, 1e-9, 1e-12].map(|s| a + (b - a) * s));
        }
        let middle = map - terrain.origin_m;
        feet.retain(|p| (p - middle).amax() < 4.0);
        for foot in &feet {
            let centre = foot + normal * (radius - 1e-5);
            near.collect(&terrain, &centre, radius, 0.35 * radius, 0.1 * radius);
            near.touches(&terrain, &centre, radius, &mut touches);
            assert_eq!(touches.len(), 1, "{foot:?} {touches:?}");
            // On the map 1e-10 m over a triangle of 0.3 m.
            let off = (touches[0].normal - normal).norm();
            assert!(off < if shift > 0.0 { 3e-9 } else { 2e-14 }, "{off:e}");
        }
        assert!(feet.len() > 2000);
    }
}

/// Every triangle near a ball and every triangle over a point is visited, and none twice; none is below the floor.
#[test]
fn the_index_finds_every_triangle() {
    for kind in 0..KINDS.len() {
        for mesh in 0..12 {
            let terrain = zoo(kind, mesh);
            for index in 0..50 {
                let chance = &mut dice(700, index + 1000 * mesh);
                let (centre, radius) = (point(chance, 2.5), between(chance, 0.0, 1.0));
                let mut seen = vec![0; terrain.triangles.len()];
                terrain.index.near(&centre, radius, |start, count| {
                    (start..start + count).for_each(|t| seen[t as usize] += 1);
                });
                let mut over = seen.clone();
                over.fill(0);
                let everywhere = f64::INFINITY;
                terrain.index.along_vertical((centre.x, centre.y), everywhere, |start, count| {
                    (start..start + count).for_each(|t| over[t as usize] += 1);
                });
                let mut highest = f64::NEG_INFINITY;
                for t in 0..terrain.triangles.len() {
                    let corners = terrain.corners_m(t as u32);
                    let is_near = (centre - closest_on(&corners, &centre)).norm() <= radius;
                    assert!(seen[t] == 1 || seen[t] == 0 && !is_near);
                    let [a, b, c] = corners.map(|p| p.xy() - centre.xy());
                    let [ab, bc, ca] = [a.perp(&b), b.perp(&c), c.perp(&a)];
                    let whole = ab + bc + ca;
                    let is_under = whole != 0.0 && [ab, bc, ca].iter().all(|x| x / whole > 0.0);
                    assert!(over[t] == 1 || over[t] == 0 && !is_under);
                    if is_under {
                        let z = corners[0].z * bc + corners[1].z * ca + corners[2].z * ab;
                        highest = highest.max(z / whole);
                        // what is said to be the lowest is not above any triangle, however it rounds
                        assert!(terrain.floor.under(centre.x, centre.y) <= z / whole + 1e-6);
                    }
                }
                let found = terrain.ground_below(centre.x, centre.y).unwrap_or(f64::NEG_INFINITY);
                // A plate on edge has no inside; its height is rounding's.
                assert!((found - highest).abs() < 1e-6 || found == highest, "{found} {highest}");
            }
        }
    }
}

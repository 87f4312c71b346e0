//! Contact finding against the definition: a strict local minimum of the distance, looked for on every triangle.
#![allow(
    clippy::needless_range_loop,
    clippy::float_cmp,
    reason = "kinds are numbered; the same touch has the same bits"
)]

use crate::common;
use common::zoo::*;
use common::*;
use rockfall::contact::closest::closest_on;
use rockfall::contact::neighbours::Neighbours;
use rockfall::contact::{ContactPoints, MAX_CONTACTS};
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

/// `Σ max(0, Σ_σ w pen²)` over the connected parts of the mesh inside a ball, by the formula and nothing else. Parts are found by spreading from triangle to triangle over corners that both have.
fn patches(terrain: &Terrain, c: &Vec3, radius: f64) -> f64 {
    let pen2 = |p: Vec3| (radius - (c - p).norm()).max(0.0).powi(2);
    let on_segment = |a: Vec3, b: Vec3| {
        let s = (c - a).dot(&(b - a)) / (b - a).norm_squared();
        a + (b - a) * s.clamp(0.0, 1.0)
    };
    let all = terrain.triangles.len() as u32;
    let is_in = |t: u32| pen2(closest_on(&terrain.corners_m(t), c)) > 0.0;
    let pressed: Vec<u32> = (0..all).filter(|&t| is_in(t)).collect();
    let mut part: Vec<usize> = (0..pressed.len()).collect();
    // two triangles are joined where what they share is inside the ball
    let joined = |one: u32, other: u32| {
        let shared: Vec<Vec3> = terrain.triangles[one as usize]
            .iter()
            .filter(|v| terrain.triangles[other as usize].contains(v))
            .map(|&v| terrain.vertices_m[v as usize])
            .collect();
        match shared[..] {
            [a] => pen2(a) > 0.0,
            [a, b] => pen2(on_segment(a, b)) > 0.0,
            [_, _, _] => true,
            _ => false,
        }
    };
    for i in 0..pressed.len() {
        for j in 0..i {
            if part[i] != part[j] && joined(pressed[i], pressed[j]) {
                let (from, to) = (part[i], part[j]);
                part.iter_mut().filter(|p| **p == from).for_each(|p| *p = to);
            }
        }
    }
    let mut sums = std::collections::BTreeMap::<usize, f64>::new();
    let mut seen = std::collections::BTreeSet::new();
    for (&t, &part) in pressed.iter().zip(&part) {
        let sum = sums.entry(part).or_default();
        *sum += pen2(closest_on(&terrain.corners_m(t), c));
        let corners = terrain.triangles[t as usize];
        for k in 0..3 {
            let (i, j) = (corners[k], corners[(k + 1) % 3]);
            let [a, b] = [i, j].map(|v| terrain.vertices_m[v as usize]);
            if seen.insert((i.min(j), i.max(j))) {
                let faces = terrain.triangles.iter().filter(|t| t.contains(&i) && t.contains(&j));
                *sum += (1.0 - faces.count() as f64) * pen2(on_segment(a, b));
            }
            if seen.insert((i, i)) {
                let faces: Vec<_> = terrain.triangles.iter().filter(|t| t.contains(&i)).collect();
                let mut weight = 1.0 - faces.len() as f64;
                let mut around: Vec<u32> =
                    faces.iter().flat_map(|t| t.iter().copied()).filter(|v| *v != i).collect();
                around.sort_unstable();
                around.dedup();
                for v in around {
                    let sides = faces.iter().filter(|t| t.contains(&v)).count();
                    weight -= 1.0 - sides as f64;
                }
                *sum += weight * pen2(a);
            }
        }
    }
    sums.values().map(|sum| sum.max(0.0)).sum()
}

/// Every touch is a minimum and every minimum a touch, wherever within the margin the features were collected.
#[test]
fn touches_are_the_local_minima_of_the_distance() {
    let (mut asked, mut most, mut merged) = (0, 0, 0);
    let (mut near, mut touches) = (Neighbours::default(), ContactPoints::default());
    for kind in 0..KINDS.len() {
        for mesh in 0..12 {
            let terrain = zoo(kind, mesh);
            for index in 0..100 {
                let random = &mut dice(600, index + 1000 * mesh);
                let radius = 0.05 * 20f64.powf(between(random, 0.0, 1.0));
                let t = between(random, 0.0, terrain.triangles.len() as f64) as u32;
                let [a, b, c] = terrain.corners_m(t);
                let (u, v) = (between(random, 0.0, 1.0), between(random, 0.0, 1.0));
                let centre = a
                    + (b - a) * (u * (1.0 - v))
                    + (c - a) * (u * v)
                    + point(random, 1.0).normalize() * (radius * between(random, 0.0, 1.1));
                let (margin, slack) = (0.35 * radius, 0.1 * radius);
                let from = centre + point(random, 1.0).normalize() * (0.999 * margin);
                near.collect(&terrain, &from, radius, margin, slack);
                near.touches(&terrain, &centre, radius, &mut touches);
                let right = minima(&terrain, &centre, radius);
                asked += 1;
                most = most.max(right.len());
                let name = format!("{} {mesh} {index} R {radius} {centre:?}", KINDS[kind]);
                if touches.iter().any(|touch| touch.gain2 != 1.0)
                    || touches.len() < right.len().min(MAX_CONTACTS)
                {
                    // pressed into a fold: every connected part of the mesh in the ball counts once, however many they are
                    merged += 1;
                    let energy = patches(&terrain, &centre, radius);
                    let found: f64 = touches
                        .iter()
                        .map(|touch| touch.gain2 * (radius - touch.distance_m).powi(2))
                        .sum();
                    assert!(
                        (found - energy).abs() <= 1e-9 * radius * radius,
                        "{name}: {found:e} {energy:e}"
                    );
                    continue;
                }
                assert_eq!(
                    touches.len(),
                    right.len().min(MAX_CONTACTS),
                    "{name}: {touches:?} {right:?}"
                );
                for (d, p) in right.iter().take(MAX_CONTACTS) {
                    let found = touches.iter().find(|touch| {
                        (touch.distance_m - d).abs() < 1e-9
                            && (centre - touch.normal * touch.distance_m - p).norm() < 1e-7
                    });
                    assert!(found.is_some(), "{name}: {p:?} is missing in {touches:?}");
                }
            }
        }
    }
    assert!(asked > 9000 && most > 12 && merged > 500, "{asked} {most} {merged}");
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
        let (mut near, mut touches) = (Neighbours::default(), ContactPoints::default());
        let features = &terrain.features;
        let mut feet: Vec<Vec3> = terrain.vertices_m.clone();
        for edge in features.edges.all() {
            let [a, b] = terrain.mesh().ends_m(edge);
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
                let random = &mut dice(700, index + 1000 * mesh);
                let (centre, radius) = (point(random, 2.5), between(random, 0.0, 1.0));
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

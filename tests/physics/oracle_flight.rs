//! The leap against crawling along the parabola: never through anything, never a touch where there is none.
#![allow(
    clippy::print_stdout,
    clippy::needless_range_loop,
    reason = "a failure shows its flight; kinds are numbered"
)]

use crate::common;
use common::zoo::*;
use common::*;
use rockfall::flight::{FlightEnd, Parabola, time_of_impact};
use rockfall::rock::Vec3;
use rockfall::terrain::Terrain;
use std::f64::consts::FRAC_PI_2;

/// How deep a leap may run into the mesh (m): rounding of quartics, no more.
const DEEP: f64 = 1e-8;
/// Meshes of each kind, and flights in each.
const MESHES: usize = 24;
const FLIGHTS: usize = 120;

/// Checks one leap: nothing is touched before, the touch is one, and it closes.
fn check(terrain: &Terrain, flight: &Parabola, longest: f64) -> Result<FlightEnd, String> {
    let landing = time_of_impact(terrain, flight, longest, &mut 0);
    let (until, touch) = match landing {
        FlightEnd::Touch(t) => (t, true),
        FlightEnd::Leaves(t) => (t.max(longest), false),
        FlightEnd::Flies => (longest, false),
    };
    let early = crawl(terrain, flight, flight.radius - DEEP, until);
    if let Some(t) = early.filter(|&t| !touch || t < until - 1e-7) {
        return Err(format!("{landing:?}, but it runs into the mesh at {t}: {flight:?}"));
    }
    if touch {
        let gap = distance(terrain, &flight.centre(until)) - flight.radius;
        if gap.abs() >= DEEP {
            return Err(format!("{landing:?} at a gap of {gap:e}: {flight:?}"));
        }
        // A touch that only grazes bends away again.
        let dt = 1e-5;
        let bend = flight.velocity(until).norm_squared() / flight.radius + flight.gravity;
        let later = distance(terrain, &flight.centre(until + dt)) - flight.radius;
        if later > gap + 0.5 * bend * dt * dt + 1e-9 {
            return Err(format!("{landing:?} opens to {later:e}: {flight:?}"));
        }
    }
    Ok(landing)
}

fn assert_none(failures: &[String], of: usize) {
    for failure in failures.iter().take(8) {
        println!("{failure}");
    }
    assert!(failures.is_empty(), "{} of {of} flights", failures.len());
}

/// Flights that start clear of the mesh, from all sides, slow and fast, upwards and downwards.
#[test]
fn no_flight_from_the_air_misses_or_invents_a_touch() {
    let (mut touches, mut flights, mut failures) = (0, 0, Vec::new());
    for kind in 0..KINDS.len() {
        for mesh in 0..MESHES {
            let terrain = zoo(kind, mesh);
            for index in 0..FLIGHTS {
                let random = &mut dice(200, index + 1000 * mesh);
                let radius = 0.05 * 20f64.powf(between(random, 0.0, 1.0));
                let start = point(random, 3.0);
                if distance(&terrain, &start) < radius + 1e-6 {
                    continue;
                }
                let velocity = point(random, 1.0) * 10f64.powf(between(random, -1.0, 1.5));
                let gravity = if index % 10 == 0 { 0.0 } else { G };
                let flight = Parabola { start, velocity, gravity, radius };
                flights += 1;
                match check(&terrain, &flight, 3.0) {
                    Ok(landing) => touches += usize::from(matches!(landing, FlightEnd::Touch(_))),
                    Err(failure) => failures.push(format!("{} {mesh} {failure}", KINDS[kind])),
                }
            }
        }
    }
    assert_none(&failures, flights);
    assert!(touches > 5 * flights / 100, "only {touches} touches of {flights} flights");
}

/// Starts in touch: the ball is put on the mesh where a flight touched, pressed in by rounding, and sent off in any
/// direction.
#[test]
fn no_flight_from_a_touch_falls_through() {
    let (mut flights, mut failures) = (0, Vec::new());
    for kind in 0..KINDS.len() {
        for mesh in 0..MESHES {
            let terrain = zoo(kind, mesh);
            for index in 0..FLIGHTS {
                let random = &mut dice(300, index + 1000 * mesh);
                let radius = 0.05 * 20f64.powf(between(random, 0.0, 1.0));
                let start = point(random, 3.0);
                let velocity = point(random, 5.0);
                let flight = Parabola { start, velocity, gravity: G, radius };
                if distance(&terrain, &start) < radius + 1e-6 {
                    continue;
                }
                let FlightEnd::Touch(t) = time_of_impact(&terrain, &flight, 3.0, &mut 0) else {
                    continue;
                };
                if let Err(failure) = check(&terrain, &flight, 3.0) {
                    failures.push(format!("first {} {mesh} {failure}", KINDS[kind]));
                }
                let mut start = flight.centre(t);
                let gap = distance(&terrain, &start) - radius;
                // Pressed in or lifted by a rounding, as a contact leaves it.
                start -= velocity.normalize() * (gap + [0.0, 1e-17, 1e-15, -1e-15][index % 4]);
                let scale = [1.0, 1e-3, 1e-9, 0.0][index / 4 % 4];
                let velocity = point(random, 5.0) * scale;
                let again = Parabola { start, velocity, ..flight };
                flights += 1;
                if let Err(failure) = check(&terrain, &again, 3.0) {
                    failures.push(format!("{} {mesh} {failure}", KINDS[kind]));
                }
            }
        }
    }
    assert_none(&failures, flights);
}

/// Upright walls whose boxes have no thickness, met slowly, far from the origin: the window of time in which the box is
/// met begins at the touch itself and must not cut it off.
#[test]
fn a_wall_is_met_however_its_box_rounds() {
    let mut missed = Vec::new();
    for index in 0..2000 {
        let random = &mut dice(400, index);
        let x = between(random, -4000.0, 4000.0).round() * 0.25;
        let at = |y: f64, z: f64| Vec3::new(x, y, z);
        // Enough facets that some leaves of the index hold the wall alone.
        let wall = (0..16).flat_map(|k| {
            let (y, z) = (f64::from(k % 4) * 50.0, f64::from(k / 4) * 50.0 - 150.0);
            let [a, b, c, d] = [at(y, z), at(y + 50.0, z), at(y + 50.0, z + 50.0), at(y, z + 50.0)];
            [[a, b, c], [a, c, d]]
        });
        let far = [Vec3::new(-2000.0, 0.0, 0.0), Vec3::new(-2001.0, 0.0, 0.0), at(-900.0, -900.0)];
        let terrain = terrain(wall.chain([far]).collect());
        let radius = between(random, 0.001, 2.0);
        let speed = 10f64.powf(between(random, -4.0, 1.0));
        let gap = between(random, 0.0, speed);
        let start = at(110.0, 10.0) - Vec3::x() * (radius + gap) - terrain.origin_m;
        let gravity = if index % 2 == 0 { 0.0 } else { G };
        let velocity = Vec3::new(speed, between(random, -1.0, 1.0), between(random, -1.0, 1.0));
        let flight = Parabola { start, velocity, gravity, radius };
        match time_of_impact(&terrain, &flight, 3.0, &mut 0) {
            FlightEnd::Touch(t) if (t * speed - gap).abs() < 1e-11 => {}
            other => missed.push(format!("{other:?} for {}: {flight:?}", gap / speed)),
        }
    }
    assert_none(&missed, 2000);
}

/// Drops onto shared edges and vertices of one plane, where the foot lies on the border of every triangle around: none
/// may leave it to the other. Needles down to a hundred millionth of their length; tilted and turned so that nothing
/// is exact.
#[test]
fn no_drop_slips_between_triangles() {
    let mut missed = Vec::new();
    for index in 0..3000 {
        let random = &mut dice(500, index);
        let thin = 10f64.powf(-8.0 * between(random, 0.0, 1.0));
        let turn = nalgebra::Rotation3::from_euler_angles(
            between(random, -0.8, 0.8) * f64::from(u32::from(index % 2 == 0)),
            between(random, -0.8, 0.8) * f64::from(u32::from(index % 3 == 0)),
            between(random, -3.0, 3.0) * f64::from(u32::from(index % 5 == 0)),
        );
        let at = |x: f64, y: f64| turn * Vec3::new(x, y, 0.0);
        let (middle, bend) = (between(random, -1.0, 1.0), between(random, -0.4, 0.4) * thin);
        let shared = [at(0.0, -10.0), at(bend, middle), at(0.0, 10.0)];
        let outer = [at(-thin, middle), at(thin, middle)];
        let shell = [at(-10.0, -10.0), at(-10.0, 10.0), at(10.0, -10.0), at(10.0, 10.0)];
        let mut facets = Vec::new();
        for side in [0, 1] {
            facets.extend([
                [shared[0], shared[1], outer[side]],
                [shared[1], shared[2], outer[side]],
                [shared[0], outer[side], shell[2 * side]],
                [outer[side], shared[2], shell[2 * side + 1]],
                [shell[2 * side], shell[2 * side + 1], outer[side]],
            ]);
        }
        let terrain = terrain(facets);
        let (from, to) = (terrain.vertices_m[0], terrain.vertices_m[1]);
        let share = [0.0, 0.5, 1.0, between(random, 0.0, 1.0)][index % 4];
        let foot = from + (to - from) * (0.9 * share + 0.1);
        let normal = turn * Vec3::z();
        let radius = between(random, 0.05, 1.0);
        let velocity = -normal * between(random, 1.0, 20.0);
        let start = foot + normal * (radius + between(random, 0.0, 1.0));
        let flight = Parabola { start, velocity, gravity: 0.0, radius };
        if let Err(failure) = check(&terrain, &flight, 3.0) {
            missed.push(format!("thin {thin:e} share {share}: {failure}"));
        }
    }
    assert_none(&missed, 3000);
}

/// A flight that touches nothing any more ends where it passes the last ground below it, however the border runs: a square turned by any
/// angle is left after the same time, and from above a hole at once. What would fall on below the border has a speed that no rock has.
#[test]
fn a_flight_leaves_where_the_last_ground_is_below_it() {
    let around = |turn_rad: f64, k: u32| {
        let (sin, cos) = (turn_rad + FRAC_PI_2 * f64::from(k)).sin_cos();
        Vec3::new(10.0 * cos, 10.0 * sin, 0.0)
    };
    for turn in 0..7 {
        let turn_rad = 0.21 * f64::from(turn);
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| around(turn_rad, k));
        let square = terrain(vec![[a, b, c], [a, c, d]]);
        // across the middle of a side, 10/√2 m away, at 5 m/s
        let out = (a + b).normalize();
        let flight = |from: Vec3, speed_m_s: f64| Parabola {
            start: from + Vec3::new(0.0, 0.0, 40.0),
            velocity: out * speed_m_s,
            gravity: G,
            radius: 0.5,
        };
        let left = time_of_impact(&square, &flight(Vec3::zeros(), 5.0), 100.0, &mut 0);
        let FlightEnd::Leaves(t) = left else { panic!("{turn}: {left:?}") };
        assert!((t - 10.0 / 2f64.sqrt() / 5.0).abs() < 1e-9, "{turn}: {t} s");
        // a triangle of four is missing: from above it nothing is ever below
        let middle = Vec3::zeros();
        let hole = terrain(vec![[middle, b, c], [middle, c, d], [middle, d, a]]);
        let left = time_of_impact(&hole, &flight(out * 3.0, 0.1), 100.0, &mut 0);
        assert_eq!(left, FlightEnd::Leaves(0.0), "{turn}");
    }
}

//! Heaps of rocks with scheme `adaptive` go on in the rigid limit: what springs hold is not lost on the way there, and nothing is made.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;

use crate::pairs::momentum;
use common::together::{Sphere, WORLD, World, energy_j, space};
use common::{G, GROUND, terrain};
use rockfall::ground::Ground;
use rockfall::simulation::Stop;
use rockfall::solver::Scheme;
use rockfall::terrain::make::containers;

const R: f64 = 0.1;
const ADAPTIVE: World = World { scheme: Scheme::Adaptive, tolerance_m_s: 0.05, ..WORLD };

/// A cube of `side`³ spheres a hair apart in space, into which one of twice the radius flies at `speed_m_s`.
fn struck_cube(side: usize, speed_m_s: f64) -> Vec<Sphere> {
    let middle = 0.5 * (side as f64 - 1.0);
    let at = |k: usize| 2.0001 * R * (k as f64 - middle);
    let cell = |k: usize| [at(k % side), at(k / side % side), at(k / (side * side))];
    let mut all: Vec<Sphere> =
        (0..side.pow(3)).map(|k| (R, 2700.0, cell(k), [0.0; 3], [0.0; 3])).collect();
    let start = [-4.0 * R - at(side - 1), 0.3 * R, 0.2 * R];
    all.push((2.0 * R, 2700.0, start, [speed_m_s, 0.0, 0.0], [0.0; 3]));
    all
}

const ELASTIC: World = World {
    restitution: 1.0,
    friction_angle_rad: 0.0,
    stiffness_n_m: 1e7,
    gravity_m_s2: G,
    ..ADAPTIVE
};

/// Without friction and with restitution 1 a cube of 64 spheres, struck so that most of them hold each other at once, flies apart with the
/// momentum and the energy that came in. Contacts are unloaded in the middle of their impacts here: with what springs hold lost, a good
/// part of the energy of motion is.
#[test]
fn a_cube_that_is_struck_keeps_momentum_and_energy() {
    let run = |rigid_heaps: bool| {
        World { rigid_heaps, ..ELASTIC }.run(&space(), &struck_cube(4, 3.9), 0.3)
    };
    let (falls, census) = run(true);
    assert!(census.rock_steps < run(false).1.rock_steps, "{census:?}");
    let [before, after] = [false, true].map(|at_end| energy_j(&falls, at_end, G));
    let came_in = energy_j(&falls, false, 0.0);
    assert!((after - before).abs() < 2e-3 * came_in, "{before} {after} of {came_in}");
    let [(before, _), (after, _)] = [false, true].map(|at_end| momentum(&falls, at_end));
    assert!((after - before).xy().norm() < 1e-10 * before.norm(), "{before} {after}");
}

/// A heap that is struck hard keeps its springs: how a blow runs through all of it says what is thrown up.
#[test]
fn a_heap_that_is_struck_hard_keeps_its_springs() {
    let run = |rigid_heaps: bool| {
        World { rigid_heaps, ..ELASTIC }.run(&space(), &struck_cube(3, 20.0), 0.1).0
    };
    assert_eq!(run(true), run(false));
}

/// Spheres of 10 cm above a box whose middle is at x = 0.65 m.
fn rain(count: usize) -> Vec<Sphere> {
    let cell = |k: usize| {
        let [x, y] = [k % 4, k / 4 % 4].map(|k| 2.3 * R * (k as f64 - 1.5));
        let off = 1e-3 * ((k * 37 % 11) as f64 - 5.0);
        [0.65 + x + off, y - off, 1.2 + 2.3 * R * (k / 16) as f64]
    };
    (0..count).map(|k| (R, 2700.0, cell(k), [0.3, 0.1, 0.0], [0.0; 3])).collect()
}

/// Spheres fall into a box and come to rest as a heap: with springs in all contacts and with heaps in the rigid limit they lie as high, and
/// the balance of every rock closes as well, in less than half of the steps.
#[test]
fn a_heap_lies_as_with_springs() {
    let ground = Ground { rolling_friction: 0.1, ..GROUND };
    let boxes = terrain(containers(0.9, 0.45, 3.0, 0.2));
    let story = |rigid_heaps: bool| {
        let world = World { gravity_m_s2: G, ground, rigid_heaps, ..ADAPTIVE };
        let (falls, census) = world.run(&boxes, &rain(48), 4.0);
        assert!(falls.iter().all(|fall| fall.stop == Stop::AtRest || fall.stop == Stop::TimeUp));
        let mean_z = falls.iter().map(|fall| fall.end.position_m.z).sum::<f64>() / 48.0;
        let start_j: f64 = falls
            .iter()
            .map(|fall| fall.rock.mass_kg() * G * (fall.start.position_m.z - mean_z))
            .sum();
        let off: f64 = falls.iter().map(|fall| fall.ledger.remainder_j).sum();
        let passed: f64 = falls.iter().map(|fall| fall.ledger.passed_on_j).sum();
        let left_j = energy_j(&falls, true, 0.0);
        (mean_z, [off, passed, left_j].map(|j| j / start_j), census.rock_steps)
    };
    let (springs, limit) = (story(false), story(true));
    assert!((springs.0 - limit.0).abs() < 0.2 * R, "{springs:?} {limit:?}");
    for (j, most) in limit.1.into_iter().zip([1e-3, 1e-12, 1e-3]) {
        assert!(j.abs() < most, "{limit:?}");
    }
    assert!(2 * limit.2 < springs.2, "{springs:?} {limit:?}");
}

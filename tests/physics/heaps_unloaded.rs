//! Heaps of rocks with scheme `adaptive` go on in the rigid limit: what springs hold is not lost on the way there, and nothing is made.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;

use common::together::{Sphere, WORLD, World, plane};
use common::{G, GROUND, terrain};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::simulation::{Stop, Trajectory};
use rockfall::solver::Scheme;
use rockfall::terrain::make::containers;

const R: f64 = 0.1;
const ADAPTIVE: World = World { scheme: Scheme::Adaptive, tolerance_m_s: 0.05, ..WORLD };

fn kinetic_j(fall: &Trajectory, at_end: bool) -> f64 {
    let motion = if at_end { fall.end } else { fall.start };
    motion.translational_j(&fall.rock) + motion.rotational_j(&fall.rock)
}

/// Sum over the rocks, at the start and at the end.
fn sums(falls: &[Trajectory], of: impl Fn(&Trajectory, bool) -> f64) -> [f64; 2] {
    [false, true].map(|at_end| falls.iter().map(|fall| of(fall, at_end)).sum())
}

/// A cube of `side`³ spheres a hair apart, high above the ground, into which one as heavy flies.
fn struck_cube(side: usize) -> Vec<Sphere> {
    let middle = 0.5 * (side as f64 - 1.0);
    let at = |k: usize| 2.0001 * R * (k as f64 - middle);
    let cell = |k: usize| [at(k % side), at(k / side % side), 20.0 + at(k / (side * side))];
    let mut all: Vec<Sphere> =
        (0..side.pow(3)).map(|k| (R, 2700.0, cell(k), [0.0; 3], [0.0; 3])).collect();
    let start = [-4.0 * R - at(side - 1), 0.3 * R, 20.0 + 0.2 * R];
    all.push((2.0 * R, 2700.0, start, [20.0, 0.0, 0.0], [0.0; 3]));
    all
}

/// Without friction and with restitution 1 a cube of 64 spheres, struck so that most of them hold each other at once, flies apart with the
/// momentum and the energy that came in. Contacts are unloaded in the middle of their impacts here: with what springs hold lost, a good
/// part of the energy is.
#[test]
fn a_cube_that_is_struck_keeps_momentum_and_energy() {
    let world =
        World { restitution: 1.0, friction_angle_rad: 0.0, stiffness_n_m: 1e7, ..ADAPTIVE };
    let (falls, _) = world.run(&plane(), &struck_cube(4), 0.1);
    let [before, after] = sums(&falls, kinetic_j);
    assert!((after - before).abs() < 2e-3 * before, "{before} {after}");
    let momentum = |at_end: bool| {
        falls.iter().fold(Vec3::zeros(), |sum, fall| {
            let motion = if at_end { fall.end } else { fall.start };
            sum + motion.velocity_m_s * fall.rock.mass_kg()
        })
    };
    let (before, after) = (momentum(false), momentum(true));
    assert!((after - before).norm() < 1e-10 * before.norm(), "{before} {after}");
}

/// Spheres of 10 cm above a box.
fn rain(count: usize) -> Vec<Sphere> {
    let cell = |k: usize| {
        let [x, y] = [k % 4, k / 4 % 4].map(|k| 2.3 * R * (k as f64 - 1.5));
        let off = 1e-3 * ((k * 37 % 11) as f64 - 5.0);
        [x + off, y - off, 1.2 + 2.3 * R * (k / 16) as f64]
    };
    (0..count).map(|k| (R, 2700.0, cell(k), [0.3, 0.1, 0.0], [0.0; 3])).collect()
}

/// Spheres fall into two boxes and come to rest as a heap: with springs in all contacts and with heaps in the rigid limit they lie as high, and
/// the balance of every rock closes as well. The steps of the whole are a small part.
#[test]
fn a_heap_lies_as_with_springs() {
    let ground = Ground { rolling_friction: 0.1, ..GROUND };
    let boxes = terrain(containers(1.6, 1.0, 2.0, 0.2));
    let story = |rigid_heaps: bool| {
        let world = World { gravity_m_s2: G, ground, rigid_heaps, ..ADAPTIVE };
        let (falls, census) = world.run(&boxes, &rain(48), 4.0);
        assert!(falls.iter().all(|fall| fall.stop == Stop::AtRest || fall.stop == Stop::TimeUp));
        let mean_z = falls.iter().map(|fall| fall.end.position_m.z).sum::<f64>() / 48.0;
        let start_j: f64 =
            falls.iter().map(|fall| fall.rock.mass_kg() * G * (fall.start.position_m.z - mean_z)).sum();
        let off: f64 = falls.iter().map(|fall| fall.ledger.remainder_j).sum();
        let passed: f64 = falls.iter().map(|fall| fall.ledger.passed_on_j).sum();
        let [_, left_j] = sums(&falls, kinetic_j);
        (mean_z, [off, passed, left_j].map(|j| j / start_j), census.rock_steps)
    };
    let (springs, limit) = (story(false), story(true));
    println!("{springs:?} {limit:?}");
    assert!((springs.0 - limit.0).abs() < 0.2 * R, "{springs:?} {limit:?}");
    for j in limit.1 {
        assert!(j.abs() < 2e-3, "{limit:?}");
    }
    assert!(3 * limit.2 < springs.2, "{springs:?} {limit:?}");
}

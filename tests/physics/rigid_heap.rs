//! Rocks that share one world in the rigid limit: rest, heaps, and what must not differ.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;

use common::together::{Sphere, WORLD, World, energy_j, plane};
use common::{CASE, Case, G, GROUND, terrain};
use rockfall::contact::pair::PairHistory;
use rockfall::ground::{Capture, Damping, Ground, Law};
use rockfall::rock::{Rock, Vec3};
use rockfall::simulation::{Stop, Trajectory};
use rockfall::solver::Scheme;
use rockfall::solver::body::Body;
use rockfall::solver::island::{BodySlot, Island, IslandBody};
use rockfall::terrain::Terrain;
use rockfall::terrain::make::{containers, jittered_plane};

fn still(radius: f64, c: [f64; 3]) -> Sphere {
    (radius, 2700.0, c, [0.0; 3], [0.0; 3])
}

/// Deepest overlap of two spheres, over the smaller radius (–).
fn overlap(falls: &[Trajectory]) -> f64 {
    let mut deepest = 0.0f64;
    for (k, a) in falls.iter().enumerate() {
        for b in &falls[..k] {
            let distance = (a.end.position_m - b.end.position_m).norm();
            let [r, s] = [a.rock.radius_m, b.rock.radius_m];
            deepest = deepest.max((r + s - distance) / r.min(s));
        }
    }
    deepest
}

/// A column at rest stays where it is and falls asleep, whatever the masses; nothing is pressed in.
#[test]
fn a_stack_at_rest_stays_at_rest() {
    for densities in [[2700.0; 5], [1e3, 1e4, 1e5, 1e6, 1e7], [1e7, 1e6, 1e5, 1e4, 1e3]] {
        for step_s in [1e-3, 1e-2] {
            let world = World { gravity_m_s2: G, step_s, ..WORLD };
            let spheres: Vec<Sphere> = (0..5)
                .map(|k| {
                    let mut sphere = still(0.5, [0.0, 0.0, 0.5 + k as f64]);
                    sphere.1 = densities[k];
                    sphere
                })
                .collect();
            let (falls, census) = world.run(&plane(), &spheres, 5.0);
            for fall in &falls {
                assert_eq!(fall.stop, Stop::AtRest);
                let off = (fall.end.position_m - fall.start.position_m).norm();
                // an overlap of 1e-5 R is left alone at each of five contacts
                assert!(off < 5.0 * 1e-5 * 0.5, "{densities:?} {step_s}: off by {off:e}");
            }
            println!("{densities:?} {step_s}: {census:?} overlap {:e}", overlap(&falls));
            assert_eq!(census.unsettled, 0);
        }
    }
}

/// The extreme: a mass ratio of up to a billion, heavy on light.
#[test]
fn a_heavy_sphere_rests_on_a_light_one() {
    for ratio in [1e3, 1e6, 1e9] {
        let world = World { gravity_m_s2: G, ..WORLD };
        let mut spheres = [still(0.5, [0.0, 0.0, 0.5]), still(0.5, [0.0, 0.0, 1.5])];
        spheres[1].1 *= ratio;
        let (falls, census) = world.run(&plane(), &spheres, 2.0);
        for fall in &falls {
            let off = (fall.end.position_m - fall.start.position_m).norm();
            assert_eq!(fall.stop, Stop::AtRest, "{ratio}: off by {off:e} {census:?}");
            assert!(off < 1e-5, "{ratio}: off by {off:e}");
        }
        assert_eq!(census.unsettled, 0);
    }
}

/// The spheres of the paper's example 3, in a grid above the ridge between two boxes.
fn grid(count: usize) -> Vec<Sphere> {
    (0..count)
        .map(|k| {
            let (i, j, l) = (k % 4, k / 4 % 4, k / 16);
            let off = |k: usize| 1e-3 * ((k * 7919 % 101) as f64 / 50.0 - 1.0);
            let at = |i: usize| 0.12 * (i as f64 - 1.5);
            still(0.05, [at(i) + off(k), at(j) + off(k + 37), 0.875 + 0.12 * l as f64])
        })
        .collect()
}

fn boxes() -> Terrain {
    let mut facets = containers(0.5, 0.3125, 0.625, 0.125);
    let at = |x: f64, y: f64| Vec3::new(4.0 * x, 4.0 * y, -0.125);
    facets.push([at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0)]);
    facets.push([at(-1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]);
    terrain(facets)
}

const HEAP: World =
    World { gravity_m_s2: G, ground: Ground { rolling_friction: 0.05, ..GROUND }, ..WORLD };

/// At no time has the heap more energy than before; spheres overlap by no more than a five-hundredth of their radius on
/// the way.
#[test]
fn a_falling_heap_gains_nothing() {
    let (terrain, spheres) = (boxes(), grid(48));
    let mut before_j = f64::INFINITY;
    for k in 1..=20 {
        let (falls, census) = HEAP.run(&terrain, &spheres, 0.1 * f64::from(k));
        let now_j = energy_j(&falls, true, G);
        assert!(now_j <= before_j + 1e-9, "{k}: {now_j} after {before_j} J");
        assert!(overlap(&falls) < 2e-3, "{k}: {:e}", overlap(&falls));
        assert_eq!(census.unsettled, 0);
        before_j = now_j;
    }
}

/// All come to rest inside, none is lost, nothing is pressed in, what was released is found in the losses, and what rocks hand on others have.
/// Of a rock at rest that is moved out of another nobody pays the height: that is its rise, in heaps of 40 to 56 rocks up to 1.2e-4 of what a rock falls
/// with.
#[test]
fn a_falling_heap_comes_to_rest() {
    let (falls, census) = HEAP.run(&boxes(), &grid(48), 20.0);
    let (mut remainder_j, mut passed_on_j) = (0.0, 0.0);
    let released_j = energy_j(&falls, false, G) - energy_j(&falls, true, G);
    for fall in &falls {
        assert_eq!(fall.stop, Stop::AtRest);
        assert!(fall.impact_count > 0 || fall.effort.sweeps > 0);
        assert!(fall.ledger.rise_j < 2e-4 * released_j / 48.0, "{:e}", fall.ledger.rise_j);
        remainder_j += fall.ledger.remainder_j.abs();
        passed_on_j += fall.ledger.passed_on_j;
    }
    assert!(passed_on_j.abs() < 1e-12 * released_j, "{passed_on_j:e} of {released_j} J");
    println!("remainder {:e} {census:?}", remainder_j / released_j);
    assert!(remainder_j < 1e-3 * released_j, "{remainder_j} of {released_j} J");
    assert!(overlap(&falls) < 2e-5, "{:e}", overlap(&falls));
    assert_eq!(census.unsettled, 0);
}

/// The same bits on one thread and on three, counters included.
#[test]
fn a_heap_is_the_same_on_any_number_of_threads() {
    let (terrain, spheres) = (boxes(), grid(96));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| HEAP.run(&terrain, &spheres, 0.8))
    };
    let (alone, census) = on(1);
    assert!(census.largest > 1 && census.rock_steps > census.steps);
    assert_eq!((alone, census), on(3));
}

/// A sphere on three others that stand apart on a rough floor. Each of the three is turned by neither contact and pushed
/// by neither: friction is `N tan(θ/2)` at both, and `N = m g/3`, `θ` the slope of the line of centres.
#[test]
fn a_sphere_on_three_others_is_carried_by_a_third_each() {
    let (r, spread) = (0.5, 1.1);
    let aside = spread * 2.0 * r / 3.0f64.sqrt();
    let theta = (aside / (2.0 * r)).asin();
    let floor = plane();
    let rock = Rock { radius_m: r, density_kg_m3: 2700.0 };
    let capture = Capture { own_m_s: None, tolerance_m_s: 0.0, gravity_m_s2: G };
    let damping = Damping::of(Some(0.5));
    let law = Law::new(&GROUND, &damping, &rock, &capture);
    let member = |c: Vec3| {
        let start = (c - floor.origin_m, Vec3::zeros(), Vec3::zeros());
        BodySlot::new(IslandBody::new(Body::new(&rock, G), vec![law], start))
    };
    let around = |k: f64| {
        let (sin, cos) = (k * std::f64::consts::TAU / 3.0).sin_cos();
        Vec3::new(aside * cos, aside * sin, r)
    };
    let top = Vec3::new(0.0, 0.0, r + 2.0 * r * theta.cos());
    let members = vec![member(around(0.0)), member(around(1.0)), member(around(2.0)), member(top)];
    let mass = (rock.mass_kg() / 2.0, r);
    let between = Law::of_mass(&GROUND, &damping, mass, &capture);
    let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    let ties = pairs.into_iter().map(|(a, b)| PairHistory::new(a, b, between)).collect();
    let mut island = Island::new(&floor, members, ties);
    for _ in 0..1000 {
        assert!(!island.advance_rigid(1e-3, 1e-3).unwrap().unsettled);
    }
    let weight = rock.mass_kg() * G;
    for tie in island.pair_histories.iter().filter(|tie| tie.b == 3) {
        let (normal_force, shear_force) =
            (tie.normal_force / weight, tie.shear_force.norm() / weight);
        let exact = (theta / 2.0).tan() / 3.0;
        assert!((normal_force - 1.0 / 3.0).abs() < 5e-3, "{normal_force}");
        assert!((shear_force - exact).abs() < 5e-3, "{shear_force} {exact}");
    }
    let off = (island.members[3].state.c + floor.origin_m - top).norm();
    assert!(off < 1e-4 * r, "it sank by {off:e}");
}

/// A rock alone in its world is the single rock's scheme: steps are cut where windows end, and that alone differs.
#[test]
fn alone_it_falls_as_a_single_rock_does() {
    let tilted = terrain(jittered_plane(40.0, 8, 0.2));
    for ground in [GROUND, Ground { rolling_friction: 0.3, ..GROUND }] {
        let case = Case { scheme: Scheme::Rigid, step_s: 0.01, ground, ..CASE };
        let (start, v) = ([0.0, 0.0, 6.0], [1.0, 0.5, 0.0]);
        let single = case.run(&tilted, [start, v, [0.0; 3]], 3.0);
        let world = World { gravity_m_s2: G, ground, rest_time_s: case.rest_time_s, ..WORLD };
        let sphere = (0.5, 2700.0, start, v, [0.0; 3]);
        let (falls, _) = world.run(&tilted, &[sphere], 3.0);
        let end = falls[0].end.position_m + tilted.origin_m;
        let off = (end - single.end.position_m).norm();
        println!("off by {off:e} after {} m", (end - Vec3::from(start)).norm());
        assert!(off < 1e-6, "off by {off:e}");
        assert_eq!(falls[0].impact_count, single.impact_count);
    }
}

/// A neighbour that is never touched changes nothing: impacts are found within a step where they are.
#[test]
fn a_neighbour_that_is_not_touched_changes_nothing() {
    let world = World { gravity_m_s2: G, rest_time_s: 30.0, ..WORLD };
    let sphere = (0.5, 2700.0, [0.0, 0.0, 3.0], [0.3, 0.0, 0.0], [0.0, 3.0, 0.0]);
    let mut beside = sphere;
    beside.2[1] = 1.0 + 1e-3;
    // in the last hundredths of a metre per second the rebounds are captured, within one step of 10 ms or the next
    for (longest_s, bound) in [(1.0, 1e-12), (2.0, 1e-12), (4.0, 5e-3)] {
        let (alone, _) = world.run(&plane(), &[sphere], longest_s);
        let (two, _) = world.run(&plane(), &[sphere, beside], longest_s);
        let off = (alone[0].end.position_m - two[0].end.position_m).norm();
        println!("{longest_s} s: off by {off:e}");
        let counts = alone[0].impact_count.abs_diff(two[0].impact_count);
        assert!(counts <= u32::from(longest_s > 3.0), "{longest_s} s: {counts}");
        assert!(off < bound, "{longest_s} s: off by {off:e}");
    }
}

//! Rocks that share one world and do not touch each other meet the mesh as they do alone in the rigid limit: whatever they meet, however short that is, and
//! where they come to rest.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;
use crate::stem_loads::panel;
use common::together::{Sphere, WORLD, World, space};
use common::{G, GROUND, terrain};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::simulation::Trajectory;
use rockfall::terrain::Terrain;

const R: f64 = 0.2;

/// Ground that gives all back and does not rub.
const ELASTIC: Ground = Ground { restitution: Some(1.0), friction_angle_rad: 0.0, ..GROUND };

/// A plate that ends in a cliff, and a floor.
fn ledge() -> Terrain {
    let w = 40.0;
    let plate = panel([[-20., -w, 0.], [0., -w, 0.], [0., w, 0.], [-20., w, 0.]]);
    let cliff = panel([[0., -w, 0.], [0., -w, -30.], [0., w, -30.], [0., w, 0.]]);
    let floor = panel([[0., -w, -30.], [20., -w, -30.], [20., w, -30.], [0., w, -30.]]);
    terrain([plate, cliff, floor].concat())
}

/// A rock, and the same with another a little beside it along y: how each has gone.
fn alone_and_beside(
    world: &World,
    terrain: &Terrain,
    (rock, gap_m): (Sphere, f64),
    longest_s: f64,
) -> [Trajectory; 2] {
    let mut other = rock;
    other.2[1] += 2.0 * rock.0 + gap_m;
    let alone = world.falls(terrain, &[rock], longest_s).remove(0);
    [alone, world.falls(terrain, &[rock, other], longest_s).remove(0)]
}

/// From 5 % to 99.95 % of the radius beside an edge, so that the last have passed it within a twentieth of a step: each is thrown off as it is alone.
#[test]
fn an_edge_is_struck_beside_others_as_alone() {
    let terrain = ledge();
    let world = World { gravity_m_s2: G, ground: ELASTIC, ..WORLD };
    for beside in [0.05, 0.5, 0.9, 0.98, 0.998, 0.9995] {
        for (k, speed_m_s) in [2.0, 5.0, 10.0].into_iter().cycle().take(15).enumerate() {
            let from = [beside * R, 0.0, R + 0.05 + 0.023 * k as f64];
            let rock = (R, 2700.0, from, [0.0, 0.0, -speed_m_s], [0.0; 3]);
            let longest_s = 0.6 / speed_m_s;
            let [alone, pair] = alone_and_beside(&world, &terrain, (rock, 0.01), longest_s);
            let off = (alone.end.velocity_m_s - pair.end.velocity_m_s).norm();
            assert_eq!(alone.impact_count, pair.impact_count, "{beside} {speed_m_s}");
            assert!(off < 1e-8 * speed_m_s, "{beside} {speed_m_s}: {off:e} m/s");
            assert!((alone.end.position_m - pair.end.position_m).norm() < 1e-8, "{beside}");
        }
    }
}

/// Two rocks graze each other, overlapping by less and less of the sum of their radii: equal masses share `(1 + e) v_n/2` along the normal of the touch.
#[test]
fn rocks_that_graze_each_other_are_both_deviated() {
    let terrain = space();
    for depth in [0.1, 0.01, 0.002, 0.0005] {
        for k in 0..12 {
            let aside = 2.0 * R * (1.0 - depth);
            let from = -1.0 - 0.007 * f64::from(k);
            let struck = (R, 2700.0, [0.0, 0.0, 0.0], [0.0; 3], [0.0; 3]);
            let strikes = (R, 2700.0, [from, aside, 0.0], [10.0, 0.0, 0.0], [0.0; 3]);
            let world = World { restitution: 0.5, friction_angle_rad: 0.0, ..WORLD };
            let falls = world.falls(&terrain, &[struck, strikes], 0.2);
            let sine = aside / (2.0 * R);
            let normal_m_s = 10.0 * (1.0 - sine * sine).sqrt();
            let push = Vec3::new((1.0 - sine * sine).sqrt(), -sine, 0.0) * (0.75 * normal_m_s);
            let off = (falls[0].end.velocity_m_s - push).norm();
            assert!(off < 1e-8, "{depth} {k}: {off:e} of {:e} m/s", push.norm());
        }
    }
}

/// Dropped from any height onto a slope, a rock rebounds a few times and rolls out, beside another as alone: one that comes back too slowly to rebound is held.
#[test]
fn a_rock_that_settles_beside_others_does_not_hop() {
    let slope = terrain(rockfall::terrain::make::jittered_plane(60.0, 1, 3f64.to_radians()));
    let ground = Ground { restitution: Some(0.4), rolling_friction: 0.06, ..GROUND };
    let world = World { gravity_m_s2: G, ground, ..WORLD };
    for k in 0..40 {
        let from = [0.0, 0.0, 0.3 + 0.35 + 0.031 * f64::from(k)];
        let rock = (0.3, 2700.0, from, [1.0, 0.0, 0.0], [0.0; 3]);
        let [alone, pair] = alone_and_beside(&world, &slope, (rock, 0.02), 60.0);
        assert!(pair.impact_count <= alone.impact_count + 1, "{k}: {}", pair.impact_count);
        let [one, other] = [&alone, &pair].map(Trajectory::runout_m);
        assert!((one - other).abs() < 0.02 * one, "{k}: {one} alone, {other} beside another");
    }
}

/// A rock that sleeps until another strikes it has been nowhere else meanwhile, whatever speed it fell asleep with.
#[test]
fn a_rock_asleep_goes_nowhere() {
    let plane = common::together::plane();
    let ground = Ground { friction_angle_rad: 0.0, ..GROUND };
    for scheme in [rockfall::solver::Scheme::Rigid, rockfall::solver::Scheme::Adaptive] {
        let world = World {
            scheme,
            tolerance_m_s: 1e-3,
            gravity_m_s2: G,
            ground,
            friction_angle_rad: 0.0,
            ..WORLD
        };
        // the border of a cell is at 0
        let sleeper = (R, 2700.0, [-0.02, 0.1, R], [0.015, 0.0, 0.0], [0.0; 3]);
        let comes = (R, 2700.0, [15.0, 0.1, R], [-0.5, 0.0, 0.0], [0.0; 3]);
        let fall = world.falls(&plane, &[sleeper, comes], 34.0).remove(0);
        assert!(fall.end.velocity_m_s.x < -0.1, "{scheme:?}: was not struck, {:?}", fall.end);
        // 0.25 m cells, 400 of them from −50 m on
        let east = fall.passages.iter().map(|passage| passage.cell % 400).max();
        assert_eq!(east, Some(199), "{scheme:?}");
    }
}

/// What springs between rocks hold at the end is held, also with `adaptive` where heaps would go on without springs: half of it is each rock's.
#[test]
fn springs_between_rocks_hold_what_weight_presses() {
    let plane = common::together::plane();
    let ground = Ground {
        normal_stiffness_n_m: 1e7,
        shear_stiffness_n_m: 0.25e7,
        restitution: Some(0.1),
        ..GROUND
    };
    let weight_n = 2700.0 * 4.0 / 3.0 * std::f64::consts::PI * R.powi(3) * G;
    for scheme in [rockfall::solver::Scheme::Adaptive, rockfall::solver::Scheme::Reference] {
        let world = World {
            scheme,
            tolerance_m_s: 1e-3,
            gravity_m_s2: G,
            ground,
            restitution: 0.1,
            stiffness_n_m: 1e7,
            ..WORLD
        };
        let at = |z: f64| (R, 2700.0, [0.0, 0.0, z], [0.0; 3], [0.0; 3]);
        let falls = world.falls(&plane, &[at(R), at(3.0 * R)], 5.0);
        let held_j = falls[1].ledger.springs_j;
        let exact_j = 0.25 * weight_n * weight_n / 1e7;
        assert!((held_j / exact_j - 1.0).abs() < 0.05, "{scheme:?}: {held_j} for {exact_j} J");
    }
}

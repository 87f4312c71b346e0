//! Rocks answer each other by the law by which the ground answers a rock: the same map in the rigid limit, the same accuracy
//! relative to the impact with springs.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;

use common::together::{Sphere, WORLD, World, energy_j, plane, space};
use rockfall::ground::{damping_ratio, normal_impact};
use rockfall::rock::{Rock, Vec3};
use rockfall::simulation::Trajectory;
use rockfall::solver::Scheme;

const DENSITY: f64 = 2700.0;
/// Gravity (m/s²).
const G: f64 = 9.8;

/// Motion of two spheres that touch each other `t` after the start, the first above the second by a normal `n`, with velocities
/// then.
fn meeting(
    (radii, densities): ([f64; 2], [f64; 2]),
    n: [f64; 3],
    [v, u]: [[f64; 3]; 2],
    t: f64,
) -> [Sphere; 2] {
    let n = Vec3::from(n).normalize() * (radii[0] + radii[1]);
    let at = |c: Vec3, v: [f64; 3]| (c - Vec3::from(v) * t).into();
    let home = Vec3::new(0.3, 0.2, 20.0);
    [
        (radii[0], densities[0], at(home + n, v), v, [3.0, -5.0, 8.0]),
        (radii[1], densities[1], at(home, u), u, [0.0, 4.0, -2.0]),
    ]
}

/// Largest difference of velocities, and of spins times radius (m/s).
fn apart(one: &[Trajectory], other: &[Trajectory]) -> f64 {
    let both = one.iter().zip(other);
    let off = both.map(|(one, other)| {
        let dv = (one.end.velocity_m_s - other.end.velocity_m_s).norm();
        dv.max((one.end.spin_rad_s - other.end.spin_rad_s).norm() * one.rock.radius_m)
    });
    off.fold(0.0, f64::max)
}

/// Sticking and slipping blows, equal and unequal spheres: the rigid limit is that of the springs, `reference` at 1e12 N/m.
#[test]
fn a_blow_between_rocks_is_the_limit_of_their_springs() {
    let spheres = [([0.5, 0.5], [DENSITY; 2]), ([0.5, 0.2], [DENSITY, 2000.0])];
    let motions = [
        [[0.0, 0.0, -3.0], [0.0; 3]],
        [[2.0, 1.0, -3.0], [0.2, 0.0, 0.1]],
        [[4.0, -1.0, -2.5], [0.0, 0.5, 0.3]],
    ];
    for (sizes, angle) in spheres.into_iter().flat_map(|s| [(s, 10.0f64), (s, 30.0), (s, 50.0)]) {
        for [v, u] in motions {
            let rocks = meeting(sizes, [0.1, -0.05, 1.0], [v, u], 0.05);
            let world = World { friction_angle_rad: angle.to_radians(), ..WORLD };
            let stiff = World {
                scheme: Scheme::Reference,
                tolerance_m_s: 1e-6,
                stiffness_n_m: 1e12,
                ..world
            };
            let (rigid, _) = world.run(&space(), &rocks, 0.1);
            let (springs, _) = stiff.run(&space(), &rocks, 0.1);
            let speed = (Vec3::from(v) - Vec3::from(u)).norm();
            let off = apart(&rigid, &springs) / speed;
            println!("{sizes:?} {angle}° {v:?}: {off:.1e} of the impact's speed");
            assert!(off < 5e-4, "{sizes:?} {angle} {v:?}: {off:e}");
        }
    }
}

/// With e = 1 and without friction a blow keeps the energy, wherever the rocks meet and whatever they weigh.
#[test]
fn an_elastic_blow_between_rocks_keeps_the_energy() {
    let world = World { restitution: 1.0, friction_angle_rad: 0.0, ..WORLD };
    for ratio in [1e-3, 0.2, 1.0, 30.0] {
        for n in [[0.0, 0.0, 1.0], [0.5, 0.1, 1.0], [2.0, -1.0, 1.0]] {
            let sizes = ([0.5, 0.3], [DENSITY, ratio * DENSITY]);
            let rocks = meeting(sizes, n, [[-1.0, 0.3, -4.0], [0.1, 0.0, 0.2]], 0.05);
            let (falls, _) = world.run(&space(), &rocks, 0.1);
            let kept = energy_j(&falls, true, 0.0) / energy_j(&falls, false, 0.0);
            assert!((kept - 1.0).abs() < 1e-12, "{ratio} {n:?}: {kept}");
            assert_ne!(falls[0].end.velocity_m_s, falls[0].start.velocity_m_s, "they missed");
        }
    }
}

/// A rock that hits a far heavier one goes on as if it had hit the ground: the more so the heavier.
#[test]
fn a_heavy_rock_is_ground_to_a_light_one() {
    let t = 0.05;
    for v in [[5.0, 1.0, -5.0], [0.5, 0.0, -4.0], [12.0, 0.0, -3.0]] {
        let spin = [3.0, -5.0, 8.0];
        let start = Vec3::new(0.3, 0.2, 0.5) - Vec3::from(v) * t;
        let alone = (0.5, DENSITY, start.into(), v, spin);
        let (ground, _) = WORLD.run(&plane(), &[alone], 2.0 * t);
        for ratio in [1e3, 1e6] {
            let sizes = ([0.5, 0.5], [DENSITY, ratio * DENSITY]);
            let mut rocks = meeting(sizes, [0.0, 0.0, 1.0], [v, [0.0; 3]], t);
            rocks[1].4 = [0.0; 3];
            let (falls, _) = WORLD.run(&space(), &rocks, 2.0 * t);
            let off = apart(&falls[..1], &ground) / Vec3::from(v).norm();
            println!("{v:?}, {ratio:e} times heavier: {off:.1e} of the impact's speed");
            assert!(off < 3.0 / ratio + 1e-4, "{v:?} {ratio}: {off:e}");
        }
    }
}

/// At the default tolerance an impact of two rocks is as right as one of a rock alone (2e-3 of its speed), from a block to a grain:
/// error belongs to the impact and not to the run.
#[test]
fn impacts_in_a_world_are_accurate_relative_to_themselves() {
    for radius in [0.5, 0.01, 0.001] {
        for speed in [0.1, 1.0, 10.0] {
            let sizes = ([radius, 0.7 * radius], [DENSITY; 2]);
            let t = 0.5 * radius / speed;
            let of = |world: World, v: [f64; 3]| {
                let v = v.map(|v| v * speed);
                let mut rocks = meeting(sizes, [0.0, 0.0, 1.0], [v, [0.0; 3]], t);
                for rock in &mut rocks {
                    rock.4 = rock.4.map(|w| 0.1 * w * speed / radius);
                }
                world.run(&space(), &rocks, 3.0 * t).0
            };
            let usual = World { scheme: Scheme::Adaptive, tolerance_m_s: 0.05, ..WORLD };
            let fine = World { scheme: Scheme::Reference, tolerance_m_s: 1e-7, ..WORLD };
            let head_on = of(usual, [0.0, 0.0, -1.0]);
            let up = (head_on[0].end.velocity_m_s - head_on[1].end.velocity_m_s).z / speed;
            assert!((up - 0.5).abs() < 2e-3, "R {radius}, {speed} m/s: e = {up}");
            let oblique = [0.8, 0.2, -0.6];
            let off = apart(&of(usual, oblique), &of(fine, oblique)) / speed;
            println!("R {radius} m, {speed} m/s: e {up:.5}, oblique {off:.1e}");
            assert!(off < 2e-3, "R {radius}, {speed} m/s: {off:e}");
        }
    }
}

/// A blow that runs through a row of rocks, the second and third a hair apart: where contacts act at the same time the default
/// tolerance is right to 2 % of the blow's speed, from a block to a grain.
#[test]
fn a_blow_through_a_row_is_right_to_two_percent() {
    for radius in [0.5, 0.01, 0.001] {
        for (speed, gap) in [(0.2, 1e-9), (2.0, 1e-7), (2.0, 1e-4)] {
            let still = ([0.0; 3], [0.0; 3]);
            let at = |along: f64| [along * radius, 0.2, 20.0];
            let t = 0.5 * radius / speed;
            let rocks = [
                (radius, DENSITY, at(-2.5), [speed, 0.0, 0.0], still.1),
                (radius, DENSITY, at(0.0), still.0, still.1),
                (radius, DENSITY, at(2.0 + gap), still.0, still.1),
            ];
            let usual = World { scheme: Scheme::Adaptive, tolerance_m_s: 0.05, ..WORLD };
            let fine = World { scheme: Scheme::Reference, tolerance_m_s: 1e-7, ..WORLD };
            let of = |world: World| world.run(&space(), &rocks, 3.0 * t).0;
            let (usual, fine) = (of(usual), of(fine));
            let off = apart(&usual, &fine) / speed;
            println!("R {radius} m, {speed} m/s, gap {gap:e} R: {off:.1e}");
            assert!(fine[2].end.velocity_m_s.x > 0.4 * speed, "the third is not struck");
            assert!(off < 2e-2, "R {radius}, {speed} m/s: {off:e}");
        }
    }
}

/// Two pebbles that touch each other fall on the ground together: each rebounds as one alone does, to the same 2e-3.
#[test]
fn pebbles_side_by_side_rebound_like_one_alone() {
    let terrain = plane();
    for radius in [0.5, 0.01, 0.001] {
        let rock = Rock { radius_m: radius, density_kg_m3: DENSITY };
        let omega = (WORLD.stiffness_n_m / rock.mass_kg()).sqrt();
        let ground = rockfall::ground::Ground { friction_angle_rad: 0.0, ..WORLD.ground };
        let world = World {
            scheme: Scheme::Adaptive,
            tolerance_m_s: 0.05,
            gravity_m_s2: G,
            friction_angle_rad: 0.0,
            ground,
            ..WORLD
        };
        for speed in [0.2, 2.0] {
            let one = |x: f64| (radius, DENSITY, [x, 0.2, radius], [0.0, 0.0, -speed], [0.0; 3]);
            let rocks = [one(0.3), one(0.3 + 2.0 * radius)];
            let t = 8.0 / omega;
            let (falls, _) = world.run(&terrain, &rocks, t);
            let exact = normal_impact(speed, omega, damping_ratio(0.5), G).rebound_m_s.unwrap();
            for fall in &falls {
                // back to the level of the touch
                let height = fall.end.position_m.z + terrain.origin_m.z - radius;
                let up = (fall.end.velocity_m_s.z.powi(2) + 2.0 * G * height).sqrt();
                println!("R {radius} m, {speed} m/s: {:.5} for {:.5}", up / speed, exact / speed);
                assert!((up - exact).abs() < 2e-3 * speed, "R {radius}, {speed}: {up} for {exact}");
            }
        }
    }
}

//! Rocks that touch each other, against exact answers.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;

use common::GROUND;
use common::together::{self, Sphere, World, plane, space};
use rockfall::ground::Ground;
use rockfall::rock::{Rock, Vec3};
use rockfall::simulation::{Stop, Trajectory};
use rockfall::solver::Scheme;

const WORLD: World =
    World { scheme: Scheme::Adaptive, tolerance_m_s: 1e-4, step_s: 1e-5, ..together::WORLD };

pub(crate) fn free(x: f64, y: f64, v: [f64; 3]) -> Sphere {
    (0.5, 2700.0, [x, y, 20.0], v, [0.0; 3])
}

/// Linear momentum (kg m/s) and angular momentum about the origin (kg m²/s).
pub(crate) fn momentum(falls: &[Trajectory], at_end: bool) -> (Vec3, Vec3) {
    falls.iter().fold((Vec3::zeros(), Vec3::zeros()), |(p, l), fall| {
        let motion = if at_end { fall.end } else { fall.start };
        let (m, i) = (fall.rock.mass_kg(), fall.rock.inertia_kg_m2());
        let own = motion.velocity_m_s * m;
        (p + own, l + motion.position_m.cross(&own) + motion.spin_rad_s * i)
    })
}

fn kinetic_j(falls: &[Trajectory], at_end: bool) -> f64 {
    let motions = falls.iter().map(|fall| (if at_end { fall.end } else { fall.start }, fall.rock));
    motions.map(|(motion, rock)| motion.translational_j(&rock) + motion.rotational_j(&rock)).sum()
}

/// Linear and angular momentum before and after differ by rounding: 1e-12 of the largest single momentum, after some
/// hundred steps.
pub(crate) fn momentum_is_kept(falls: &[Trajectory]) {
    let (p0, l0) = momentum(falls, false);
    let (p1, l1) = momentum(falls, true);
    let largest = |of: &dyn Fn(&Trajectory) -> f64| falls.iter().map(of).fold(0.0, f64::max);
    let p = largest(&|f| f.rock.mass_kg() * f.extremes.speed_m_s);
    let l =
        largest(&|f| f.rock.mass_kg() * f.extremes.speed_m_s * f.end.position_m.norm().max(1.0));
    assert!((p1 - p0).norm() <= 1e-12 * p, "{:e}", (p1 - p0).norm() / p);
    assert!((l1 - l0).norm() <= 1e-12 * l, "{:e}", (l1 - l0).norm() / l);
}

/// A26: `v1' = (1−e)/2 v`, `v2' = (1+e)/2 v` for equal spheres; local error 1e-4 m/s a step, 20 steps.
#[test]
fn a_head_on_collision_has_the_restitution_asked_for() {
    for e in [0.0, 0.3, 0.5, 0.9, 1.0] {
        let world = World { restitution: e, ..WORLD };
        let falls = world.falls(
            &space(),
            &[free(-1.0, 0.0, [1.0, 0.0, 0.0]), free(1.0, 0.0, [0.0; 3])],
            2.0,
        );
        let speeds = [0, 1].map(|k| falls[k].end.velocity_m_s.x);
        // e below 0.01 counts as plastic
        let allowed = if e == 0.0 { 0.01 } else { 2e-3 };
        assert!((speeds[0] - 0.5 * (1.0 - e)).abs() < allowed, "{e}: {speeds:?}");
        assert!((speeds[1] - 0.5 * (1.0 + e)).abs() < allowed, "{e}: {speeds:?}");
        momentum_is_kept(&falls);
        assert!(kinetic_j(&falls, true) <= kinetic_j(&falls, false) * (1.0 + 1e-3));
    }
}

/// Unequal masses head-on: `v1' = (m1 − e m2)/(m1 + m2) v`, `v2' = (1 + e) m1/(m1 + m2) v`.
#[test]
fn unequal_masses_share_the_momentum() {
    for (radius, density) in [(0.1, 2700.0), (0.5, 27.0), (0.5, 2.7e-3), (0.05, 2.7e-2)] {
        let light = (radius, density, [1.0, 0.0, 20.0], [0.0; 3], [0.0; 3]);
        let falls = WORLD.falls(&space(), &[free(-1.0, 0.0, [1.0, 0.0, 0.0]), light], 1.5);
        let (m1, m2) = (falls[0].rock.mass_kg(), falls[1].rock.mass_kg());
        let expected = [(m1 - 0.5 * m2) / (m1 + m2), 1.5 * m1 / (m1 + m2)];
        for (fall, expected) in falls.iter().zip(expected) {
            let found = fall.end.velocity_m_s.x;
            assert!((found - expected).abs() < 3e-3, "{radius} {density}: {found} {expected}");
        }
        momentum_is_kept(&falls);
    }
}

/// An oblique hit with spin: momentum and angular momentum to rounding; what slides obeys `|J_t| ≤ μ J_n`, and the
/// energy falls.
#[test]
fn an_oblique_hit_with_spin_keeps_momentum_and_angular_momentum() {
    let one = (0.5, 2700.0, [-1.0, 0.3, 20.0], [2.0, 0.1, -0.2], [3.0, -5.0, 8.0]);
    let two = (0.3, 2000.0, [1.0, 0.0, 20.0], [-1.0, 0.0, 0.1], [0.0, 4.0, -2.0]);
    let falls = WORLD.falls(&space(), &[one, two], 2.0);
    momentum_is_kept(&falls);
    let kick = (falls[0].end.velocity_m_s - falls[0].start.velocity_m_s) * falls[0].rock.mass_kg();
    assert!(kick.norm() > 100.0, "they did not meet");
    assert!(kinetic_j(&falls, true) < kinetic_j(&falls, false));
}

/// Without friction spin is not touched, to the last bit, and the normal speed is returned e-fold.
#[test]
fn without_friction_spin_stays() {
    let world = World { friction_angle_rad: 0.0, ..WORLD };
    let one = (0.5, 2700.0, [-1.0, 0.6, 20.0], [2.0, 0.0, 0.0], [3.0, -5.0, 8.0]);
    let falls = world.falls(&space(), &[one, free(1.0, 0.0, [0.0; 3])], 2.0);
    assert_eq!(falls[0].end.spin_rad_s, falls[0].start.spin_rad_s);
    assert_eq!(falls[1].end.spin_rad_s, falls[1].start.spin_rad_s);
    momentum_is_kept(&falls);
    // the line of centres at the touch: sin = 0.6
    let n = Vec3::new(-0.8, 0.6, 0.0);
    let apart = (falls[0].end.velocity_m_s - falls[1].end.velocity_m_s).dot(&n);
    assert!((apart - 0.5 * 1.6).abs() < 3e-3, "{apart}");
}

/// Newton's cradle with gaps: equal spheres with e = 1 hand on the velocity one by one.
#[test]
fn a_cradle_with_gaps_hands_on_the_velocity() {
    let world = World { restitution: 1.0, ..WORLD };
    let mut spheres = vec![free(-2.0, 0.0, [1.0, 0.0, 0.0])];
    spheres.extend((0..4).map(|k| free(1.01 * f64::from(k), 0.0, [0.0; 3])));
    let falls = world.falls(&space(), &spheres, 3.0);
    for (k, fall) in falls.iter().enumerate() {
        let expected = if k == 4 { 1.0 } else { 0.0 };
        // five collisions at a local error of 1e-4 m/s a step
        assert!(
            (fall.end.velocity_m_s.x - expected).abs() < 5e-3,
            "{k}: {}",
            fall.end.velocity_m_s.x
        );
    }
    momentum_is_kept(&falls);
}

const G: f64 = 9.8;

/// A stack of two on the plane presses its springs by `(m1+m2)g/p_N` and `m2 g/p_N`, whatever the mass ratio, and comes
/// to rest.
fn stack(lower: (f64, f64), upper: (f64, f64)) {
    let world = World { gravity_m_s2: G, tolerance_m_s: 1e-3, rest_time_s: 1.0, ..WORLD };
    let (r1, r2) = (lower.0, upper.0);
    let [m1, m2] =
        [lower, upper].map(|(radius_m, density_kg_m3)| Rock { radius_m, density_kg_m3 }.mass_kg());
    let p_n = GROUND.normal_stiffness_n_m;
    let expected = [(m1 + m2) * G / p_n, m2 * G / p_n];
    // A heavy rock would swing for long on the springs of a light one: it starts where they carry it.
    let start = [r1 - expected[0], 2.0 * r1 + r2 - expected[0] - expected[1]];
    let spheres = [
        (r1, lower.1, [0.3, 0.2, start[0]], [0.0; 3], [0.0; 3]),
        (r2, upper.1, [0.3, 0.2, start[1]], [0.0; 3], [0.0; 3]),
    ];
    let falls = world.falls(&plane(), &spheres, 5.0);
    let z = [0, 1].map(|k| falls[k].end.position_m.z);
    let pens = [r1 - z[0], r1 + r2 - (z[1] - z[0])];
    for (pen, expected) in pens.iter().zip(expected) {
        // a position is known to 2e-16 m; the spring of 1e9 N/m makes of that much for a light rock; a heavy one on a
        // light one swings on, hardly damped, by what its first contact left
        let allowed = 5e-3 * expected + 2e-12;
        assert!((pen - expected).abs() < allowed, "{lower:?} {upper:?}: {pens:?} {expected:e}");
    }
    for fall in &falls {
        assert_eq!(fall.stop, Stop::AtRest);
        // the same rounding, through a step of 20 ms: 2e-16 m × 1e9 N/m × 0.02 s/m, at the heavier end
        assert!(fall.end.velocity_m_s.norm() < 1e-5, "{:e}", fall.end.velocity_m_s.norm());
    }
}

#[test]
fn a_stack_rests_on_its_springs() {
    stack((0.5, 2700.0), (0.5, 2700.0));
    stack((0.5, 2700.0), (0.1, 2700.0));
    stack((0.2, 2700.0), (0.5, 2700.0));
}

#[test]
fn a_stack_of_mass_ratio_one_million_rests() {
    stack((0.5, 2700.0), (0.5, 2.7e-3));
    stack((0.5, 2.7e-3), (0.5, 2700.0));
}

#[test]
fn a_stack_of_mass_ratio_one_billion_rests() {
    stack((0.5, 2700.0), (0.5, 2.7e-6));
    stack((0.5, 2.7e-6), (0.5, 2700.0));
}

/// A sphere on three others that touch each other: friction holds the three, each carries a third of its weight.
#[test]
fn a_sphere_rests_on_three_others() {
    let world = World { gravity_m_s2: G, tolerance_m_s: 1e-3, rest_time_s: 0.5, ..WORLD };
    let r = 0.5;
    let out = 2.0 * r / 3.0f64.sqrt();
    let mut spheres: Vec<Sphere> = (0..3)
        .map(|k| {
            let turn = std::f64::consts::TAU * f64::from(k) / 3.0;
            (r, 2700.0, [out * turn.cos(), out * turn.sin(), r], [0.0; 3], [0.0; 3])
        })
        .collect();
    let up = (4.0 * r * r - out * out).sqrt();
    spheres.push((r, 2700.0, [0.0, 0.0, r + up], [0.0; 3], [0.0; 3]));
    let falls = world.falls(&plane(), &spheres, 5.0);
    let weight = falls[0].rock.mass_kg() * G;
    for fall in &falls {
        assert_eq!(fall.stop, Stop::AtRest);
    }
    for fall in &falls[..3] {
        // force balance: each of the three carries its own weight and a third of the fourth
        let pen = r - fall.end.position_m.z;
        let expected = 4.0 / 3.0 * weight / GROUND.normal_stiffness_n_m;
        assert!((pen - expected).abs() < 2e-2 * expected, "{pen:e} {expected:e}");
    }
    let energy: f64 = falls.iter().map(|fall| fall.ledger.rise_j).fold(0.0, f64::max);
    assert!(energy < 1e-6 * weight * r, "{energy:e}");
}

/// The same bytes on one thread and on four.
#[test]
fn threads_change_nothing() {
    let world = World { gravity_m_s2: G, tolerance_m_s: 0.01, ..WORLD };
    let spheres: Vec<Sphere> = (0..24)
        .map(|k| {
            let (i, j, l) = (f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9));
            (0.2, 2700.0, [0.41 * i + 0.05 * l, 0.41 * j, 0.6 + 0.5 * l], [0.0; 3], [0.0; 3])
        })
        .collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| world.falls(&plane(), &spheres, 1.0))
    };
    assert_eq!(on(1), on(4));
}

/// Scheme `dda` with the dashpots of a restitution of 0.5 between rocks: at 1e-5 s the step itself takes another hundredth
/// (half an impact's oscillation, `ω Δt` = 0.012).
#[test]
fn the_fixed_step_keeps_the_restitution_between_rocks() {
    let world = World { scheme: Scheme::Dda, ..WORLD };
    // one above the other, the lower one first: its normal is the exact opposite of the vertical
    let sphere = |z: f64, up: f64| (0.5, 2700.0, [0.3, 0.2, z], [0.0, 0.0, up], [0.0; 3]);
    let falls = world.falls(&space(), &[sphere(-1.0, 1.0), sphere(0.5, 0.0)], 2.0);
    let speeds = [0, 1].map(|k| falls[k].end.velocity_m_s.z);
    assert!((speeds[0] - 0.25).abs() < 5e-3 && (speeds[1] - 0.75).abs() < 5e-3, "{speeds:?}");
    momentum_is_kept(&falls);
}

/// A stack under scheme `dda`: the lower rock is the first, so that the normal between them points straight down.
#[test]
fn a_stack_rests_on_fixed_steps() {
    let world = World { scheme: Scheme::Dda, gravity_m_s2: G, rest_time_s: 0.1, ..WORLD };
    let press = Rock { radius_m: 0.5, density_kg_m3: 2700.0 }.mass_kg() * G / 1e9;
    let sphere = |z: f64| (0.5, 2700.0, [0.3, 0.2, z], [0.0; 3], [0.0; 3]);
    let falls = world.falls(&plane(), &[sphere(0.5 - 2.0 * press), sphere(1.5 - 3.0 * press)], 1.0);
    let z = [0, 1].map(|k| falls[k].end.position_m.z);
    assert!((0.5 - z[0] - 2.0 * press).abs() < 1e-2 * press, "{z:?}");
    assert!((1.0 - (z[1] - z[0]) - press).abs() < 1e-2 * press, "{z:?}");
}

/// Rocks that slide on the ground and meet leave each other as in the air, however slowly they come: an impact that began at the end of a
/// long step was over before it had begun, and two that came at 0.4 m/s left with 0.65 for 0.60 of it.
#[test]
fn rocks_on_the_ground_keep_the_restitution_between_them() {
    let smooth = Ground { friction_angle_rad: 0.0, rolling_friction: 0.0, ..GROUND };
    for scheme in [Scheme::Adaptive, Scheme::Reference, Scheme::Rigid] {
        for restitution in [1.0, 0.6] {
            for speed_m_s in [0.2, 0.4, 1.0, 2.0, 5.0, 15.0] {
                let size = if scheme == Scheme::Reference { 1e-5 } else { 0.01 };
                let world = World {
                    scheme,
                    gravity_m_s2: G,
                    tolerance_m_s: 0.05,
                    step_s: size,
                    restitution,
                    friction_angle_rad: 0.0,
                    ground: smooth,
                    rest_time_s: 30.0,
                    ..WORLD
                };
                let z = 0.3 - Rock { radius_m: 0.3, density_kg_m3: 2700.0 }.mass_kg() * G / 1e9;
                let rock = |x: f64, v: f64| (0.3, 2700.0, [x, 0.0, z], [v, 0.0, 0.0], [0.0; 3]);
                let rocks = [rock(0.0, 0.0), rock(-1.1, speed_m_s)];
                let falls = world.falls(&plane(), &rocks, 0.5 / speed_m_s + 0.1);
                let [a, b] = [0, 1].map(|k| falls[k].end.velocity_m_s.x);
                let kept = (a - b) / speed_m_s;
                assert!(
                    (kept - restitution).abs() < 4e-3,
                    "{scheme:?}, {speed_m_s} m/s: {kept} for {restitution}"
                );
            }
        }
    }
}

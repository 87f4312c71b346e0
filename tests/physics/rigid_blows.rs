//! Blows between rocks that share one world in the rigid limit, against exact answers.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use crate::common;

use crate::common::together::space;
use crate::pairs::{free, momentum};
use crate::patch::fold;
use common::together::{Sphere, WORLD, World, energy_j, plane};
use common::{G, GROUND, terrain};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::simulation::Trajectory;
use rockfall::solver::Scheme;

/// Momentum and angular momentum differ by rounding, of the largest single ones.
fn momenta_are_kept(falls: &[Trajectory]) {
    let ((p, l), (q, k)) = (momentum(falls, false), momentum(falls, true));
    let size = falls.iter().map(|f| f.rock.mass_kg() * f.extremes.speed_m_s).fold(0.0, f64::max);
    let arm = falls.iter().map(|f| f.end.position_m.norm()).fold(1.0, f64::max);
    assert!((q - p).norm() <= 1e-12 * size, "{:e}", (q - p).norm() / size);
    assert!((k - l).norm() <= 1e-12 * size * arm, "{:e}", (k - l).norm() / size / arm);
}

/// `v1' = (m1 − e m2)/(m1 + m2) v`, `v2' = (1 + e) m1/(m1 + m2) v`, and the place to where both go on is that of the
/// exact moment of the touch.
#[test]
fn head_on_two_spheres_share_the_momentum_by_their_masses() {
    let terrain = space();
    for e in [0.0, 0.3, 0.9, 1.0] {
        for ratio in [1.0, 1e3, 1e6, 1e-6] {
            let world = World { restitution: e, ..WORLD };
            let mut spheres = [free(-1.0, 0.0, [1.0, 0.0, 0.0]), free(1.0, 0.0, [0.0; 3])];
            spheres[1].1 *= ratio;
            let (falls, census) = world.run(&terrain, &spheres, 2.0);
            let speeds = [0, 1].map(|k| falls[k].end.velocity_m_s.x);
            let exact = [(1.0 - e * ratio) / (1.0 + ratio), (1.0 + e) / (1.0 + ratio)];
            for k in 0..2 {
                assert!((speeds[k] - exact[k]).abs() < 1e-12, "{e} {ratio}: {speeds:?} {exact:?}");
                let x = [0.0, 1.0][k] + exact[k];
                let place = falls[k].end.position_m.x + terrain.origin_m.x;
                assert!((place - x).abs() < 1e-9, "{e} {ratio}: {place} {x}");
            }
            momenta_are_kept(&falls);
            assert_eq!(census.unsettled, 0);
        }
    }
}

/// An oblique blow with spin: momentum and angular momentum to rounding, friction along the slip within its cone.
#[test]
fn an_oblique_blow_keeps_both_momenta() {
    for offset in [0.1, 0.5, 0.8] {
        for angle in [0.0f64, 10.0, 30.0] {
            let world = World { friction_angle_rad: angle.to_radians(), ..WORLD };
            let mut spheres =
                [free(-1.5, offset, [3.0, 0.2, 0.1]), free(1.0, 0.0, [-1.0, 0.0, 0.0])];
            spheres[0].4 = [1.0, -2.0, 5.0];
            spheres[1].1 *= 3.0;
            let (falls, _) = world.run(&space(), &spheres, 1.5);
            momenta_are_kept(&falls);
            let impulse =
                (falls[0].end.velocity_m_s - falls[0].start.velocity_m_s) * falls[0].rock.mass_kg();
            assert!(impulse.norm() > 100.0, "they missed");
            // the normal at the touch: relative motion is a straight line
            let apart = falls[0].start.position_m - falls[1].start.position_m;
            let u = falls[0].start.velocity_m_s - falls[1].start.velocity_m_s;
            let t = rockfall::contact::pair::collision_time_s(&apart, &u, 1.0).unwrap();
            let n = apart + u * t;
            let push = impulse.dot(&n);
            let drag = (impulse - n * push).norm();
            assert!(drag <= (angle.to_radians().tan() + 1e-9) * push);
            assert_eq!(angle == 0.0, drag < 1e-9 * push);
            let after = falls[0].end.velocity_m_s - falls[1].end.velocity_m_s;
            assert!((n.dot(&after) + 0.5 * n.dot(&u)).abs() < 1e-9);
            assert!(energy_j(&falls, true, 0.0) < energy_j(&falls, false, 0.0));
        }
    }
}

/// Five equal spheres so far apart that springs let go before the next is met, one comes in: with e = 1 the last leaves with its speed and the others
/// stand; energy and momentum are kept.
#[test]
fn a_cradle_hands_on() {
    let world = World { restitution: 1.0, ..WORLD };
    for gap in [0.03, 0.05] {
        let (falls, census) = world.run(&space(), &cradle(gap), 1.5);
        for (k, fall) in falls.iter().enumerate() {
            let exact = if k == 4 { 2.0 } else { 0.0 };
            let speed = fall.end.velocity_m_s.x;
            assert!((speed - exact).abs() < 1e-12, "{gap}: {k} goes at {speed}");
        }
        momenta_are_kept(&falls);
        assert_eq!(census.unsettled, 0);
    }
}

/// Five spheres of which the first comes in at 2 m/s.
fn cradle(gap: f64) -> Vec<Sphere> {
    let mut spheres: Vec<Sphere> =
        (0..5).map(|k| free((1.0 + gap) * f64::from(k), 0.0, [0.0; 3])).collect();
    spheres[0].2[0] -= 0.7;
    spheres[0].3 = [2.0, 0.0, 0.0];
    spheres
}

/// Speeds of equal masses in a row of springs that push and do not pull, of which the first comes in at `speed`: leapfrog in units of
/// the springs.
fn row_of_springs(count: usize, speed: f64) -> Vec<f64> {
    const STEP: f64 = 1e-4;
    let (mut x, mut v) = (vec![0.0; count], vec![0.0; count]);
    v[0] = speed;
    for _ in 0..500_000 {
        for (x, v) in x.iter_mut().zip(&v) {
            *x += STEP * v;
        }
        for k in 1..count {
            let push = STEP * f64::max(0.0, x[k - 1] - x[k]);
            (v[k - 1], v[k]) = (v[k - 1] - push, v[k] + push);
        }
    }
    v
}

/// A tenth of a millimetre apart and more the blow is that of springs too, which are pressed until the next is met.
#[test]
fn a_cradle_a_little_apart_answers_as_springs_do() {
    for gap in [1e-4, 1e-3, 5e-3] {
        let [rigid, springs] =
            [(Scheme::Rigid, 0.0), (Scheme::Reference, 1e-8)].map(|(scheme, tolerance_m_s)| {
                World { scheme, tolerance_m_s, restitution: 1.0, ..WORLD }.falls(
                    &space(),
                    &cradle(gap),
                    1.5,
                )
            });
        for (k, (one, other)) in rigid.iter().zip(&springs).enumerate() {
            let [speed, exact] = [one, other].map(|fall| fall.end.velocity_m_s.x);
            assert!((speed - exact).abs() < 2e-3, "{gap}: {k} goes at {speed} for {exact}");
        }
        momenta_are_kept(&rigid);
    }
}

/// In touch the blow runs through all of them at once, as through springs in a row: none stands still behind it.
#[test]
fn a_cradle_in_touch_answers_as_springs_do() {
    let world = World { restitution: 1.0, ..WORLD };
    let (falls, census) = world.run(&space(), &cradle(0.0), 1.5);
    for (k, exact) in row_of_springs(5, 2.0).into_iter().enumerate() {
        let speed = falls[k].end.velocity_m_s.x;
        assert!((speed - exact).abs() < 2e-3, "{k} goes at {speed} for {exact}");
    }
    let kept = energy_j(&falls, true, 0.0) / energy_j(&falls, false, 0.0);
    // they part at different speeds, and what still meets slower than the capture speed does not rebound
    assert!((kept - 1.0).abs() < 1e-4 && kept <= 1.0 + 1e-12, "{kept}");
    momenta_are_kept(&falls);
    assert_eq!(census.unsettled, 0);
}

/// One rock strikes two that touch each other, off the middle and turning: both momenta are kept to rounding, what is lost is
/// in the books, and all go as they do with springs.
#[test]
fn a_blow_on_two_rocks_in_touch_is_that_of_springs() {
    for (restitution, friction_angle_rad) in [(1.0, 0.0), (0.6, 0.0), (0.6, 0.4)] {
        let mut spheres = [
            free(-1.5, 0.1, [3.0, 0.0, 0.0]),
            free(0.0, 0.5 + 1e-12, [0.0; 3]),
            free(0.0, -0.5, [0.0; 3]),
        ];
        spheres[0].4 = [1.0, -2.0, 3.0];
        let world = World { restitution, friction_angle_rad, ..WORLD };
        let (rigid, _) = world.run(&space(), &spheres, 0.5);
        momenta_are_kept(&rigid);
        let springs = World { scheme: Scheme::Reference, tolerance_m_s: 1e-6, ..world };
        let springs = World { stiffness_n_m: 1e12, ..springs };
        let (reference, _) = springs.run(&space(), &spheres, 0.5);
        for (own, other) in rigid.iter().zip(&reference) {
            let off = (own.end.velocity_m_s - other.end.velocity_m_s).norm();
            assert!(off < 0.01 * 3.0, "{restitution} {friction_angle_rad}: off by {off}");
            let off = (own.end.spin_rad_s - other.end.spin_rad_s).norm();
            assert!(off < 0.02 * 3.0, "{restitution} {friction_angle_rad}: spin off by {off}");
        }
        let lost = energy_j(&rigid, false, 0.0) - energy_j(&rigid, true, 0.0);
        let booked = |fall: &Trajectory| fall.ledger.others_j + fall.ledger.passed_on_j;
        let booked: f64 = rigid.iter().map(booked).sum();
        assert!((lost - booked).abs() < 1e-9 * lost.abs().max(1.0), "{lost} {booked}");
        assert!(restitution < 1.0 || lost.abs() < 1e-9, "{lost}");
    }
}

/// Two rocks that strike both sides of a hollow fold at once, neighbours and yet no touch between them, leave it as each does alone: both
/// sides answer in one blow. One side after the other would throw them out sideways.
#[test]
fn rocks_of_an_island_strike_both_sides_of_a_fold_at_once() {
    for (e, friction_angle_rad) in [(1.0, 0.0), (0.6, 0.4)] {
        for angle in [0.6f64, 1.0, 1.8] {
            let terrain = fold(angle);
            let ground = Ground {
                restitution: Some(e),
                friction_angle_rad,
                rolling_friction: 0.1,
                ..GROUND
            };
            let world = World { ground, restitution: e, friction_angle_rad, ..WORLD };
            let height = 0.5 / (0.5 * angle).cos() + 0.3;
            // along the fold too, and turning, so that friction has something to do
            let sphere = |y: f64| -> Sphere {
                (0.5, 2700.0, [0.0, y, height], [0.0, 0.4, -2.0], [1.0, 0.0, 0.0])
            };
            let (together, census) = world.run(&terrain, &[sphere(0.0), sphere(1.0 + 2e-4)], 0.4);
            let (alone, _) = world.run(&terrain, &[sphere(0.0)], 0.4);
            assert_eq!(census.unsettled, 0);
            for fall in &together {
                let [own, one] = [fall, &alone[0]].map(|fall| fall.end);
                assert!(one.velocity_m_s.z > 0.1, "{angle}: it has not left the fold");
                let off = (own.velocity_m_s - one.velocity_m_s).norm();
                // followed to a tolerance, in islands of a few rocks that of a rock alone
                assert!(off < 1e-3, "{e} {angle}: {} for {}", own.velocity_m_s, one.velocity_m_s);
                assert!((own.spin_rad_s - one.spin_rad_s).norm() < 4e-3, "{e} {angle}");
                assert_eq!(fall.impacts.len(), alone[0].impacts.len(), "{e} {angle}");
                let [own, one] = [fall, &alone[0]].map(|fall| {
                    let ledger = &fall.ledger;
                    ledger.friction_j + ledger.damping_j + ledger.rolling_j
                });
                assert!((own - one).abs() < 2e-3 * one.max(1.0), "{e} {angle}: {own} {one} J");
            }
        }
    }
}

/// Rocks that strike the ground one after the other within a step have each its own impacts, whoever comes first.
#[test]
fn impacts_of_every_rock_of_an_island_are_noted() {
    let sphere =
        |x: f64, z: f64| -> Sphere { (0.5, 2700.0, [x, 0.0, z], [0.0, 0.0, -2.0], [0.0; 3]) };
    let two = [sphere(0.0, 0.9), sphere(1.0 + 2e-4, 0.89)];
    for order in [[0, 1], [1, 0]] {
        let (falls, _) = WORLD.run(&plane(), &order.map(|k| two[k]), 0.4);
        for fall in &falls {
            let [impact] = &fall.impacts[..] else { panic!("{:?}", fall.impacts) };
            assert!((impact.speed_in_m_s - 2.0).abs() < 1e-9 && fall.end.velocity_m_s.z > 0.9);
        }
    }
}

/// Two rocks that roll down a valley one behind the other, neighbours and yet no touch between them, roll as each alone does: on two sides
/// friction may hold what the sides could carry, and what it holds must not stay from step to step. It did, they pressed less, and
/// rolled a quarter farther against rolling friction.
#[test]
fn neighbours_roll_down_a_valley_as_each_alone() {
    let at = |x: f64, y: f64| {
        Vec3::new(x, y, x.abs() * 30f64.to_radians().tan() - y * 20f64.to_radians().tan())
    };
    let (a, b, c) = (at(-5.0, -5.0), at(0.0, -5.0), at(5.0, -5.0));
    let (d, e, f) = (at(-5.0, 60.0), at(0.0, 60.0), at(5.0, 60.0));
    let valley = terrain(vec![[a, b, e], [a, e, d], [b, c, f], [b, f, e]]);
    let ground =
        Ground { friction_angle_rad: 0.6, restitution: Some(0.4), rolling_friction: 0.2, ..GROUND };
    let world = World { gravity_m_s2: 9.81, ground, ..WORLD };
    let sphere = |y: f64| -> Sphere {
        let height = 0.3 / 30f64.to_radians().cos() / 20f64.to_radians().cos() + 0.01;
        (0.3, 2700.0, [0.0, y, height - y * 20f64.to_radians().tan()], [0.0, 0.5, -0.18], [0.0; 3])
    };
    let (together, census) = world.run(&valley, &[sphere(0.0), sphere(-0.601)], 6.0);
    assert_eq!(census.unsettled, 0);
    for (fall, y) in together.iter().zip([0.0, -0.601]) {
        let (alone, _) = world.run(&valley, &[sphere(y)], 6.0);
        let [own, one] =
            [fall, &alone[0]].map(|fall| fall.end.position_m.y - fall.start.position_m.y);
        // steps of a hundredth of a second in both
        assert!(one > 10.0 && (own - one).abs() < 0.01 * one, "{own} for {one} m");
    }
}

/// Rocks that fall side by side share their steps: their largest speed, and the time and the speeds of their impacts, are those of the
/// blow and not those of the ends of the step in which it falls.
#[test]
fn speeds_and_times_of_a_blow_are_those_of_its_instant() {
    const FALL_M: f64 = 1.0;
    let (fall_s, fast_m_s) = ((2.0 * FALL_M / G).sqrt(), (2.0 * G * FALL_M).sqrt());
    let ball = |x: f64| -> Sphere { (0.5, 2700.0, [x, 0.0, 0.5 + FALL_M], [0.0; 3], [0.0; 3]) };
    for (restitution, step_s) in [(0.5, 1e-2), (0.5, 3e-3), (1.0, 1e-2)] {
        let ground = Ground { restitution: Some(restitution), ..GROUND };
        let world = World { gravity_m_s2: G, step_s, ground, ..WORLD };
        let (falls, _) = world.run(&plane(), &[ball(0.0), ball(1.0 + 1e-6)], 0.7);
        for fall in &falls {
            let [blow] = &fall.impacts[..] else { panic!("{:?}", fall.impacts) };
            let most_j = 0.5 * fall.rock.mass_kg() * fast_m_s * fast_m_s;
            let known = [
                (fall.extremes.speed_m_s, fast_m_s),
                (fall.extremes.total_j, most_j),
                (blow.time_s, fall_s),
                (blow.speed_in_m_s, fast_m_s),
            ];
            for (found, exact) in known {
                assert!((found / exact - 1.0).abs() < 1e-12, "{step_s} {restitution}: {known:?}");
            }
            // both blows are followed together, to 2e-5
            let kept = blow.speed_out_m_s / fast_m_s;
            assert!((kept - restitution).abs() < 2e-5, "{step_s}: {kept} for {restitution}");
        }
    }
}

/// A boulder that falls on stones a fifth of its radius which lie apart on the ground is thrown off as much among 25 of them, an island of more rocks than one blow
/// is followed with, as among 9: what lies out of its way changes nothing. Blow by blow between boulder and stone it was stopped dead.
#[test]
fn stones_out_of_the_way_change_no_rebound() {
    let rebound = |side: usize| {
        let at = |k: usize| 0.45 * (k as f64 - 0.5 * (side as f64 - 1.0));
        let stone = |k: usize| (0.2, 2700.0, [at(k % side), at(k / side), 0.2], [0.0; 3], [0.0; 3]);
        let mut rocks: Vec<Sphere> = (0..side * side).map(stone).collect();
        rocks.push((1.0, 2700.0, [0.03, 0.02, 1.45], [0.0, 0.0, -10.0], [0.0; 3]));
        let world = World { gravity_m_s2: G, restitution: 0.4, ..WORLD };
        let (falls, census) = world.run(&plane(), &rocks, 0.1);
        assert_eq!(census.unsettled, 0);
        falls[side * side].end.velocity_m_s.z
    };
    let (few, many) = (rebound(3), rebound(5));
    assert!(few > 5.0 && (many - few).abs() < 1e-2 * few, "{few} {many}");
}

/// A ball that strikes a row of twenty in touch, more than one blow is followed with, comes back, as from a row of ten: the blow runs through
/// all that touch at once. Taken from ball to ball it would stop dead, and the last would leave with all of its speed.
#[test]
fn a_hard_blow_runs_through_what_touches_in_a_heap() {
    let after = |count: usize| {
        let ball =
            |x: f64, v: f64| -> Sphere { (0.2, 2700.0, [x, 0.0, 0.2], [v, 0.0, 0.0], [0.0; 3]) };
        let row = (0..count).map(|k| ball(0.4 * k as f64, 0.0));
        let rocks: Vec<Sphere> = [ball(-0.41, 10.0)].into_iter().chain(row).collect();
        let ground = Ground { friction_angle_rad: 0.0, ..GROUND };
        let world =
            World { gravity_m_s2: G, restitution: 1.0, friction_angle_rad: 0.0, ground, ..WORLD };
        let (falls, _) = world.run(&plane(), &rocks, 0.01);
        falls.iter().map(|fall| fall.end.velocity_m_s.x).collect::<Vec<f64>>()
    };
    let (few, many) = (after(10), after(20));
    assert!(few[0] < -0.5 && (many[0] - few[0]).abs() < 0.1, "{few:?} {many:?}");
    let (last, sum) = (many[20], many.iter().sum::<f64>());
    let energy: f64 = many.iter().map(|v| v * v).sum();
    assert!(last > 7.0 && last < 9.5, "{many:?}");
    // blows too slow to rebound come after it
    assert!((sum - 10.0).abs() < 1e-9 && energy < 100.0 + 1e-9 && energy > 95.0, "{sum} {energy}");
}

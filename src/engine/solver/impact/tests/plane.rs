//! Impacts on one plane.

use super::{G, apart, case, ground, motion_j, oracle, uniforms};
use crate::ground::{Damping, Law, normal_impact};
use crate::math;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::impact::plane::Rebound;
use crate::solver::impact::{FrozenContact, Plane};
use nalgebra::Rotation3;
use proptest::prelude::*;

fn left(followed: Option<Rebound>) -> Rebound {
    let Some(rebound) = followed else { panic!("the rock stays") };
    rebound
}

fn hit((body, law): &(Body, Law), tolerance: f64, v: Vec3, w: Vec3) -> Rebound {
    left(Plane::new(body, law, tolerance).follow(&Vec3::z(), &v, &w))
}

fn drop((body, law): &(Body, Law), speed: f64) -> Option<Rebound> {
    let v = Vec3::new(0.0, 0.0, -speed);
    Plane::new(body, law, 1e-10).follow(&Vec3::z(), &v, &Vec3::zeros())
}

/// Largest penetration of the same (m).
fn deepest_m((body, law): &(Body, Law), speed: f64) -> f64 {
    let v = Vec3::new(0.0, 0.0, -speed);
    Plane::new(body, law, 1e-10).passage(&Vec3::z(), &v, 0.0).unwrap().deepest_m()
}

const ROLLING: [f64; 2] = [0.0, 0.3];

/// Oblique, sticking and slipping, backspin, spinning drops, nearly head-on, rolling, grazing.
const MOTIONS: [[[f64; 3]; 2]; 10] = [
    [[5.0, 1.0, -5.0], [0.0, 0.0, 0.0]],
    [[5.0, 1.0, -5.0], [3.0, -20.0, 4.0]],
    [[5.0, 1.0, -1.0], [0.0, 0.0, 0.0]],
    [[0.0, 0.0, -2.0], [0.0, 50.0, 0.0]],
    [[0.0, 0.0, -2.0], [0.0, 0.0, 30.0]],
    [[0.3, 0.0, -8.0], [0.0, 0.0, 0.0]],
    [[20.0, 0.0, -2.0], [0.0, -40.0, 0.0]],
    [[2.0, 3.0, -2.0], [-6.0, 4.0, 1.0]],
    [[0.0, 0.0, -3.0], [0.0, 0.0, 0.0]],
    [[30.0, 0.0, -0.5], [5.0, 5.0, 5.0]],
];

/// `e(ζ)` of the force that never pulls (numerics 2.1), by closed form: to rounding, and bisection
/// for ζ.
#[test]
fn without_weight_restitution_is_the_one_asked_for() {
    for e in [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.99, 1.0] {
        let case = case(&ground(1e9, e, 0.0), 0.5, 0.0);
        let out = left(drop(&case, 5.0));
        assert!((out.velocity_m_s.z / 5.0 - e).abs() < 1e-12, "{e}: {}", out.velocity_m_s.z / 5.0);
        // the largest penetration is √e v/ω
        let deep = deepest_m(&case, 5.0) * case.1.omega_rad_s() / 5.0;
        assert!((deep - e.sqrt()).abs() < 1e-12, "{e}");
    }
}

/// The table of numerics 2.1: `e_eff` falls with `p = v ω/g` (five digits); and the other closed
/// form of this program, to rounding, from just above the capture speed to heavy impacts.
#[test]
fn weight_lowers_restitution() {
    let of = |e: f64, p: f64| {
        let case = case(&ground(1e9, e, 0.0), 0.5, G);
        let v = p * G / case.1.omega_rad_s();
        left(drop(&case, v)).velocity_m_s.z / v
    };
    for (p, e) in [(5.0, 0.283_85), (10.0, 0.411_35), (30.0, 0.473_29), (100.0, 0.492_24)] {
        assert!((of(0.5, p) - e).abs() < 1e-5, "{p}");
    }
    for e in [0.15, 0.3, 0.5, 0.9] {
        let damping = Damping::of(Some(e));
        for p in [1.01, 1.3, 2.0, 10.0, 1e3, 1e6].map(|p| p * damping.capture_number) {
            if damping.ratio < 0.95 {
                let other = normal_impact(p, 1.0, damping.ratio, 1.0).rebound_m_s.unwrap() / p;
                // next to the capture speed a rebound is the root of a difference
                assert!((of(e, p) - other).abs() < 1e-9 * other, "{e} {p}: {}", of(e, p) - other);
            }
        }
    }
}

/// A2, A3: lift-off, restitution and largest penetration of the first two impacts after a drop from
/// 1 m (14 digits).
#[test]
fn a_dropped_rock_bounces_as_the_closed_form_says() {
    for (p_n, first, second, deep) in [
        (1e9, 0.497_977_344_990_19, 0.495_923_911_729_12, 0.003_731_018_763_723_5),
        (1e7, 0.479_113_826_342_19, 0.454_591_052_637_91, 0.038_119_756_710_436),
    ] {
        let case = case(&ground(p_n, 0.5, 0.0), 0.5, G);
        let v = (2.0 * G).sqrt();
        let out = left(drop(&case, v));
        let up = out.velocity_m_s.z;
        assert!((up / v - first).abs() < 1e-13, "{}", up / v);
        assert!((deepest_m(&case, v) - deep).abs() < 1e-15);
        let again = left(drop(&case, up));
        assert!((again.velocity_m_s.z / up - second).abs() < 1e-13);
        if p_n > 1e8 {
            assert!((deepest_m(&case, up) - 0.001_862_426_602_864_5).abs() < 1e-15);
            // second impact at 0.90552616278489 s
            let second_s = v / G + out.time_s + 2.0 * up / G;
            assert!((second_s - 0.905_526_162_784_89).abs() < 1e-13, "{second_s}");
        }
    }
}

/// Just below `p*` gravity keeps the rock, just above it does not; for every restitution, also
/// overdamped.
#[test]
fn gravity_keeps_what_is_too_slow() {
    for e in [0.005, 0.1, 0.2, 0.3, 0.5, 0.9, 1.0] {
        let case = case(&ground(1e9, e, 0.0), 0.5, G);
        let leaves = |p: f64| drop(&case, p * G / case.1.omega_rad_s()).is_some();
        let [_, hi] = math::bisected([0.0, 1e5], 60, |p| !leaves(p));
        // every slower impact stays, every faster one leaves
        for share in [0.01, 0.1, 0.5, 0.9, 0.999] {
            assert!(hi < 1e-9 || !leaves(hi * share), "{e}");
            assert!(leaves(hi / share), "{e}");
        }
        let known = Damping::of(Some(e));
        if known.ratio < 1e-12 {
            assert!(hi < 1e-9, "without damping every rock leaves: {hi}");
        } else if known.ratio < 0.95 {
            assert!((hi - known.capture_number).abs() < 1e-6, "{e}: {hi}");
        }
    }
}

/// Against the law as printed, with 4000 classical steps a radian: switching points cost those up
/// to 1e-8 or so, the kernel about its tolerance.
#[test]
fn it_is_the_law_as_printed() {
    for (rolling, e) in [(0.0, 0.5), (0.3, 0.5), (0.3, 1.0), (0.0, 0.2), (0.3, 0.2)] {
        let case = case(&ground(1e9, e, rolling), 0.5, G);
        let touch = FrozenContact {
            normal: Vec3::z(),
            law: &case.1,
            captured: false,
            ..FrozenContact::none()
        };
        for [v, w] in MOTIONS.map(|motion| motion.map(Vec3::from)) {
            let (slow, t) = oracle::follow(&case.0, &[touch], (v, w), 4000.0);
            for (tolerance, allowed) in [(1e-4, 1.5e-4), (1e-6, 2e-5), (1e-10, 2e-8)] {
                let fast = hit(&case, tolerance, v, w);
                let (after, printed) = ([fast.velocity_m_s, fast.spin_rad_s], [slow.v, slow.w]);
                let off = apart(&case.0, after, printed, v.norm());
                assert!(off < allowed, "{rolling} {e} {v:?} {w:?} {tolerance:e}: {off:e}");
                let way = (fast.shift_m - slow.way).norm() * case.1.omega_rad_s() / v.norm();
                assert!(way < 3.0 * allowed, "{rolling} {e} {v:?} {w:?} {tolerance:e}: {way:e}");
                assert!((fast.time_s - t).abs() < 1e-12);
                let energy = motion_j(&case.0, &v, &w);
                for (found, printed) in fast.loss.parts().into_iter().zip(slow.lost) {
                    let off = (found - printed).abs() / energy;
                    assert!(
                        off < 5.0 * allowed,
                        "{rolling} {e} {v:?} {w:?} {tolerance:e}: {off:e}"
                    );
                }
            }
        }
    }
}

/// A19: oblique on springs of 10⁹ N/m from 0.1 m above the plane, 0.2 s later (nine digits known).
#[test]
fn an_oblique_impact_on_springs() {
    let case = case(&ground(1e9, 0.5, 0.0), 0.5, G);
    let fall_s = (0.5f64 * 0.1 * 4.0 * G + 25.0).sqrt();
    let fall_s = (fall_s - 5.0) / G;
    let fly = |c: Vec3, v: Vec3, t: f64| {
        let g = Vec3::new(0.0, 0.0, -G);
        (c + v * t + g * (0.5 * t * t), v + g * t)
    };
    let (c, v) = fly(Vec3::new(0.0, 0.0, 0.6), Vec3::new(5.0, 1.0, -5.0), fall_s);
    assert!((c.z - 0.5).abs() < 1e-14);
    let out = hit(&case, 1e-10, v, Vec3::new(3.0, -20.0, 4.0));
    let (c, _) = fly(c + out.shift_m, out.velocity_m_s, 0.2 - fall_s - out.time_s);
    let exact = Vec3::new(0.202_693_999, 0.067_115_667, 0.804_023_327);
    assert!((c - exact).norm() < 2e-9, "{c:?}");
    assert!((out.spin_rad_s.y - 2.259_206_5).abs() < 1e-7, "{}", out.spin_rad_s.y);
}

/// Errors shrink with the tolerance: over 300 impacts the largest is below four of it at most, and
/// half are below one.
#[test]
fn errors_follow_the_tolerance() {
    for rolling in ROLLING {
        let case = case(&ground(1e9, 0.5, rolling), 0.5, G);
        let mut uniform = uniforms(7);
        let mut size = |size: f64| size * (2.0 * uniform() - 1.0);
        let mut errors = [const { Vec::new() }; 3];
        for _ in 0..300 {
            let v = Vec3::new(size(10.0), size(10.0), -0.5 - size(10.0).abs());
            let w = Vec3::new(size(30.0), size(30.0), size(30.0));
            let good = hit(&case, 1e-11, v, w);
            for (errors, tolerance) in errors.iter_mut().zip([1e-3, 1e-4, 1e-5]) {
                let fast = hit(&case, tolerance, v, w);
                let after = [fast.velocity_m_s, fast.spin_rad_s];
                let off = apart(&case.0, after, [good.velocity_m_s, good.spin_rad_s], v.norm());
                errors.push(off / tolerance);
            }
        }
        for errors in &mut errors {
            errors.sort_by(f64::total_cmp);
            assert!(errors[150] < 1.0 && errors[299] < 6.0, "{} {}", errors[150], errors[299]);
        }
    }
}

/// Turned about any axis together with normal and gravity, an impact gives the turned answer.
#[test]
fn a_turned_scene_gives_the_turned_answer() {
    let mut uniform = uniforms(3);
    for rolling in ROLLING {
        let (body, law) = case(&ground(1e8, 0.4, rolling), 0.3, G);
        let tilted = Rotation3::from_euler_angles(0.4, 0.2, 0.0);
        let body = Body { gravity: tilted * body.gravity, ..body };
        for [v, w] in MOTIONS.map(|motion| motion.map(Vec3::from)) {
            let plain = hit(&(body, law), 1e-4, v, w);
            let turn = Rotation3::from_euler_angles(6.0 * uniform(), 6.0 * uniform(), 1.0);
            let turned = Body { gravity: turn * body.gravity, ..body };
            let plane = Plane::new(&turned, &law, 1e-4);
            let turned = left(plane.follow(&(turn * Vec3::z()), &(turn * v), &(turn * w)));
            let off = apart(
                &body,
                [turned.velocity_m_s, turned.spin_rad_s],
                [turn * plain.velocity_m_s, turn * plain.spin_rad_s],
                v.norm(),
            );
            assert!(off < 1e-12, "{off:e}");
            assert!((turned.shift_m - turn * plain.shift_m).norm() < 1e-12);
            assert!((turned.time_s - plain.time_s).abs() < 1e-15);
        }
    }
}

/// Without friction and rolling friction the spin keeps its bits and velocity along the plane only
/// what gravity adds.
#[test]
fn a_smooth_ground_touches_nothing_but_the_normal() {
    let mut smooth = ground(1e9, 0.7, 0.0);
    smooth.friction_angle_rad = 0.0;
    let case = case(&smooth, 0.5, G);
    let (v, w) = (Vec3::new(5.0, 1.0, -5.0), Vec3::new(3.0, -20.0, 4.0));
    let out = hit(&case, 1e-4, v, w);
    assert_eq!(out.spin_rad_s, w);
    assert!((out.velocity_m_s.xy() - v.xy()).norm() <= 1e-15 * v.norm());
    assert_eq!(out.effort.steps, 0);
    // e = 1: to rounding
    let elastic = case.1.undamped();
    let out = hit(&(case.0, elastic), 1e-4, v, w);
    assert!((out.velocity_m_s.norm() / v.norm() - 1.0).abs() < 1e-15);
    assert!(out.loss.sum() >= 0.0 && out.loss.sum() < 1e-10);
}

/// Spin about the normal: friction at one point does not feel it, the rolling element takes some.
#[test]
fn spin_about_the_normal_is_for_rolling_friction_alone() {
    let (v, w) = (Vec3::new(0.0, 0.0, -5.0), Vec3::new(0.0, 0.0, 30.0));
    let out = hit(&case(&ground(1e9, 0.5, 0.0), 0.5, G), 1e-6, v, w);
    assert!((out.spin_rad_s.z - 30.0).abs() < 1e-13);
    let case = case(&ground(1e9, 0.5, 0.3), 0.5, G);
    let out = hit(&case, 1e-6, v, w);
    assert!(out.spin_rad_s.z < 30.0 && out.spin_rad_s.xy().norm() < 1e-12);
    // the moment's impulse is at most μ_r R times that of the force
    let normal_force = case.0.mass * (5.0 + out.velocity_m_s.z + G * out.time_s);
    let most = 0.3 * 0.5 * normal_force / case.0.inertia;
    assert!(30.0 - out.spin_rad_s.z <= most * (1.0 + 1e-6), "{} {most}", out.spin_rad_s.z);
}

proptest! {
    /// Any rock, ground, motion and gravity: the losses add up to what is gone, height included, to
    /// rounding; none is negative; all is finite.
    #[test]
    fn energy_is_accounted_for(
        radius in -1.3f64..0.7, p_n in 7.0f64..12.0, e in 0.02f64..1.0, rolling in 0.0f64..0.5, ratio in 0.05f64..2.0,
        angle in 0.0f64..89.0, speed in -1.0f64..1.7, dip in 0.01f64..1.57, along in 0.0f64..6.3,
        spin in prop::array::uniform3(-3.0f64..3.0), down in prop::array::uniform3(-1.0f64..1.0), fine in prop::bool::ANY,
    ) {
        let (radius, p_n, speed) = (10f64.powf(radius), 10f64.powf(p_n), 10f64.powf(speed));
        let mut ground = ground(p_n, if e > 0.9 { 1.0 } else { e }, if rolling < 0.2 { 0.0 } else { rolling });
        ground.shear_stiffness_n_m = ratio * p_n;
        ground.friction_angle_rad = if angle < 5.0 { 0.0 } else { angle.to_radians() };
        let (body, law) = case(&ground, radius, 0.0);
        let body = Body { gravity: Vec3::from(down) * 9.81, ..body };
        let v = Vec3::new(dip.cos() * along.cos(), dip.cos() * along.sin(), -dip.sin()) * speed;
        let w = Vec3::from(spin) * (speed / radius);
        let plane = Plane::new(&body, &law, if fine { 1e-8 } else { 1e-4 });
        if let Some(out) = plane.follow(&Vec3::z(), &v, &w) {
            let before = motion_j(&body, &v, &w);
            let after = motion_j(&body, &out.velocity_m_s, &out.spin_rad_s);
            let work = body.mass * body.gravity.dot(&out.shift_m);
            let scale = before + after + work.abs();
            prop_assert!((before + work - after - out.loss.sum()).abs() < 1e-12 * scale);
            for part in out.loss.parts() {
                prop_assert!(part >= 0.0, "{:?}", out.loss);
            }
            prop_assert!(after <= (before + work) * (1.0 + 1e-12));
            prop_assert!(out.shift_m.z.abs() < 1e-15 && out.time_s > 0.0 && out.velocity_m_s.z > 0.0);
            prop_assert!(out.effort.steps < 5000, "{:?}", out.effort);
        }
    }
}

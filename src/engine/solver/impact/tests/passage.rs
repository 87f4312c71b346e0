//! An impact on a plane, continued from any state within it.

use super::{G, case, ground, motion_j, uniforms};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::impact::{InitialDeformation, Plane};
use nalgebra::Rotation3;

/// Rocks, grounds and motions of all kinds: restitution from 0.05 to 1, with and without friction
/// and rolling friction, weight aslant.
fn cases() -> impl Iterator<Item = ((Body, Law), [Vec3; 2])> {
    let mut uniform = uniforms(7);
    (0..60).map(move |k| {
        let rolling = if k % 2 == 0 { 0.2 } else { 0.0 };
        let mut ground = ground(1e7 * 10f64.powf(4.0 * uniform()), 1.0 - 0.95 * uniform(), rolling);
        if k % 5 == 0 {
            ground.restitution = Some(1.0);
            ground.friction_angle_rad = 0.0;
            ground.rolling_friction = 0.0;
        }
        let (body, law) = case(&ground, 0.05 + uniform(), G);
        let aslant = Rotation3::from_euler_angles(uniform(), uniform(), 0.0);
        let body = Body { gravity: aslant * body.gravity, ..body };
        let mut one = |most: f64| most * (2.0 * uniform() - 1.0);
        let (v, w) = (Vec3::new(one(9.0), one(9.0), 0.0), Vec3::new(one(9.0), one(9.0), one(9.0)));
        let v = v - Vec3::z() * (0.5 + one(0.4) + 4.0 * one(1.0).abs());
        ((body, law), [v, w / body.radius])
    })
}

/// In two or three parts the motion is that of the whole, with the same losses, and each part loses
/// what its kinetic and potential energy lose.
#[test]
fn an_impact_in_parts_is_that_at_once() {
    let n = Vec3::z();
    for ((body, law), [v, w]) in cases() {
        let plane = Plane::new(&body, &law, 1e-9);
        let Some(whole) = plane.passage(&n, &v, 0.0) else { continue };
        let at_once = plane.pass(&whole, (&v, &w), &InitialDeformation::NONE);
        let unit_j = motion_j(&body, &v, &w);
        for shares in [&[0.03][..], &[0.5], &[0.97], &[0.3, 0.6]] {
            let (mut motion, mut pressed, mut shift, mut time_s) =
                ((v, w), InitialDeformation::NONE, Vec3::zeros(), 0.0);
            let mut lost = [0.0; 3];
            for share in shares.iter().copied().chain([1.0]) {
                let rest = plane.passage(&n, &motion.0, pressed.depth_m);
                let rest = rest.unwrap_or_else(|| {
                    panic!("{shares:?} {share} {motion:?} {pressed:?} {whole:?} {plane:?}")
                });
                let passage = if share < 1.0 { plane.part(&rest, share) } else { rest };
                let out = plane.pass(&passage, (&motion.0, &motion.1), &pressed);
                assert!(pressed.depth_m <= whole.deepest_m() * (1.0 + 1e-9));
                let before_j = motion_j(&body, &motion.0, &motion.1);
                motion = (out.velocity_m_s, out.spin_rad_s);
                let height_j = body.mass * body.gravity.dot(&out.shift_m);
                let gone_j = before_j + height_j - motion_j(&body, &motion.0, &motion.1);
                assert!((gone_j - out.loss.sum()).abs() < 1e-12 * unit_j);
                assert_eq!(out.pressed.is_some(), share < 1.0);
                pressed = out.pressed.unwrap_or(InitialDeformation::NONE);
                assert!((pressed.depth_m + (shift + out.shift_m).z).abs() < 1e-15);
                shift += out.shift_m;
                time_s += out.time_s;
                for (sum, part) in lost.iter_mut().zip(out.loss.parts()) {
                    *sum += part;
                }
            }
            let off = (motion.0 - at_once.velocity_m_s)
                .norm()
                .max((motion.1 - at_once.spin_rad_s).norm() * body.radius);
            assert!(off < 3e-8 * v.norm(), "{shares:?}: {off:e}");
            assert!((time_s - at_once.time_s).abs() < 1e-12 * time_s, "{shares:?}");
            assert!((shift - at_once.shift_m).norm() < 3e-8 * v.norm() * time_s, "{shares:?}");
            let all = at_once.loss.parts();
            for (sum, part) in lost.iter().zip(all) {
                assert!((sum - part).abs() < 1e-7 * unit_j, "{shares:?}: {lost:?} {all:?}");
            }
        }
    }
}

/// A rock lifts off where the force first falls to zero, from whatever state it is continued and
/// however long gravity holds it; if that never happens, there is no passage. One that ends too
/// early gains the energy still in the spring.
#[test]
fn a_rock_lifts_off_where_the_force_first_falls_to_zero() {
    let mut uniform = uniforms(3);
    let (mut passages, mut stays) = (0, 0);
    for _ in 0..4000 {
        let restitution = 0.01f64.powf(uniform());
        let ground = ground(1e6 * 10f64.powf(3.0 * uniform()), restitution, 0.0);
        let (body, law) = case(&ground, 0.1 + 2.0 * uniform(), G);
        let plane = Plane::new(&body, &law, 1e-4);
        // from the penetration of the weight to many times that, inwards or outwards
        let weight_m = G / law.omega_rad_s().powi(2);
        let depth_m = weight_m * 10f64.powf(3.5 * uniform() - 1.0);
        let speed = depth_m * law.omega_rad_s() * 2.0 * uniform();
        let v = Vec3::z() * if uniform() < 0.3 { speed } else { -speed };
        let pressed = InitialDeformation { depth_m, ..InitialDeformation::NONE };
        let Some(whole) = plane.passage(&Vec3::z(), &v, depth_m) else {
            stays += 1;
            continue;
        };
        passages += 1;
        let normal = law.normal(false);
        let force = |share: f64| {
            let part = plane.part(&whole, share);
            let out = plane.pass(&part, (&v, &Vec3::zeros()), &pressed);
            normal.bilateral_force(out.pressed.unwrap().depth_m, out.velocity_m_s.z)
        };
        let start = force(1e-6);
        assert!((1..40).all(|k| force(f64::from(k) / 40.0) > 0.0), "{whole:?}");
        assert!(force(1.0 - 1e-9).abs() < 1e-6 * start.max(law.stored_j(1.0, 0.0, 0.0) * weight_m));
        let out = plane.pass(&whole, (&v, &Vec3::zeros()), &pressed);
        let had_j = motion_j(&body, &v, &Vec3::zeros()) + law.stored_j(depth_m, 0.0, 0.0);
        let has_j = motion_j(&body, &out.velocity_m_s, &Vec3::zeros());
        assert!(has_j + body.mass * G * out.shift_m.z <= had_j * (1.0 + 1e-9), "{whole:?}");
    }
    assert!(passages > 1000 && stays > 300, "{passages} {stays}");
}

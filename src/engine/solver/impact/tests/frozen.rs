//! Impacts of frozen geometry.

use super::{G, apart, case, ground, motion_j, oracle, uniforms};
use crate::contact::MAX_CONTACTS;
use crate::ground::{Ground, Law};
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::impact::rigid_limit::FrozenRebound;
use crate::solver::impact::{FrozenContact, ImpactOutcome, Plane, frozen_impact};
use crate::solver::loss::Loss;
use nalgebra::Rotation3;
use proptest::prelude::*;

fn slope(n: [f64; 3], law: &Law) -> FrozenContact<'_> {
    let normal = Vec3::from(n).normalize();
    FrozenContact { normal, law, captured: false, ..FrozenContact::none() }
}

fn smooth(e: f64) -> Ground {
    Ground { friction_angle_rad: 0.0, ..ground(1e9, e, 0.0) }
}

fn after(out: &FrozenRebound) -> [Vec3; 2] {
    [out.velocity_m_s, out.spin_rad_s]
}

/// The losses add up to what is gone, and none is negative.
fn balances(body: &Body, out: &FrozenRebound, v: &Vec3, w: &Vec3) {
    let before = motion_j(body, v, w);
    let gone = before - motion_j(body, &out.velocity_m_s, &out.spin_rad_s);
    let lost: f64 = out.loss.iter().map(Loss::sum).sum();
    assert!((lost - gone).abs() < 1e-12 * before, "{lost} {gone} of {before}");
    assert!(gone >= -1e-14 * before);
    assert!(out.loss.iter().flat_map(Loss::parts).all(|part| part >= 0.0));
}

/// The limit of the printed law, as read off stiff springs (3.394 and 4.12); and the same law
/// integrated slowly.
#[test]
fn the_rebound_is_the_limit_of_the_springs() {
    let v = Vec3::new(5.0, 1.0, -5.0);
    let of = |rolling: f64, w: Vec3| {
        let (body, law) = case(&ground(1e9, 0.5, rolling), 0.5, 0.0);
        let contact = [slope([0.0, 0.0, 1.0], &law)];
        let out = frozen_impact(&body, &contact, (&v, &w), 1e-10);
        let (slow, _) = oracle::follow(&body, &contact, (v, w), 4000.0);
        assert!(apart(&body, after(&out), [slow.v, slow.w], v.norm()) < 2e-8);
        balances(&body, &out, &v, &w);
        out
    };
    let x = of(0.0, Vec3::zeros()).velocity_m_s.x;
    assert!((x - 3.394).abs() < 1e-3, "{x}");
    let y = of(0.3, Vec3::new(3.0, -20.0, 4.0)).spin_rad_s.y;
    assert!((y - 4.12).abs() < 5e-3, "{y}");
}

/// The rebound from springs of 10¹² N/m is that of the limit: velocity to 1e-4 of the impact speed.
/// There weight still adds about `g t_c` to the approach, of which friction turns `m R²/I` as much
/// into spin; without weight only the tolerance is left.
#[test]
fn stiff_springs_tend_to_it() {
    for (rolling, gravity, allowed) in
        [(0.0, G, 1e-4), (0.3, G, 1e-4), (0.0, 0.0, 1e-8), (0.3, 0.0, 1e-8)]
    {
        let (body, law) = case(&ground(1e12, 0.5, rolling), 0.5, gravity);
        for (v, w) in [
            ([5.0, 1.0, -5.0], [0.0, 0.0, 0.0]),
            ([5.0, 1.0, -5.0], [3.0, -20.0, 4.0]),
            ([8.0, 0.0, -2.0], [0.0, 16.0, 0.0]),
            ([0.0, 0.0, -9.0], [7.0, 0.0, 9.0]),
        ] {
            let (v, w) = (Vec3::from(v), Vec3::from(w));
            let limit = frozen_impact(&body, &[slope([0.0, 0.0, 1.0], &law)], (&v, &w), 1e-10);
            let Some(springs) = Plane::new(&body, &law, 1e-10).follow(&Vec3::z(), &v, &w) else {
                panic!("stays")
            };
            let dv = (limit.velocity_m_s - springs.velocity_m_s).norm() / v.norm();
            let dw = (limit.spin_rad_s - springs.spin_rad_s).norm() * body.radius / v.norm();
            assert!(dv < allowed && dw < 2.5 * allowed, "{v:?} {w:?} {rolling}: {dv:e} {dw:e}");
        }
    }
}

const FOLDS: [[[f64; 3]; 3]; 5] = [
    [[0.3, 0.0, 1.0], [-0.4, 0.1, 1.0], [0.0, 0.5, 1.0]],
    [[0.01, 0.0, 1.0], [-0.01, 0.0, 1.0], [0.0, 0.02, 1.0]],
    [[1.0, 0.0, 0.2], [-0.1, 0.0, 1.0], [0.1, 1.0, 0.1]],
    [[1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [0.0, 1.0, -0.2]],
    [[1.0, 0.0, 0.1], [-1.0, 0.0, 0.1], [0.0, 0.0, 1.0]],
];

/// Two and three contacts on different grounds and with different stiffness, against the slow
/// integration: that one finds a contact up to one of its 2000 steps a radian late, where dashpots
/// jump, which is 1e-5 or so.
#[test]
fn several_contacts_are_the_law_as_printed() {
    for (rolling, e) in [(0.0, 1.0), (0.0, 0.5), (0.3, 1.0), (0.3, 0.5)] {
        let (body, law) = case(&ground(1e9, e, rolling), 0.5, 0.0);
        let other = case(&ground(2e8, e, rolling), 0.5, 0.0).1;
        for normals in &FOLDS[..4] {
            for count in [1, 2, 3] {
                let mut contacts: Vec<FrozenContact> =
                    normals[..count].iter().map(|n| slope(*n, &law)).collect();
                if let Some(second) = contacts.get_mut(1) {
                    (second.law, second.stiffness_scale) = (&other, 1.5);
                }
                for (v, w) in [([2.0, 1.0, -6.0], [1.0, -5.0, 3.0]), ([-3.0, -5.0, -1.0], [0.0; 3])]
                {
                    let (v, w) = (Vec3::from(v), Vec3::from(w));
                    let (slow, _) = oracle::follow(&body, &contacts, (v, w), 2000.0);
                    for (tolerance, allowed) in [(1e-4, 2e-4), (1e-8, 2e-5)] {
                        let fast = frozen_impact(&body, &contacts, (&v, &w), tolerance);
                        let off = apart(&body, after(&fast), [slow.v, slow.w], v.norm());
                        assert!(off < allowed, "{rolling} {e} {normals:?} {count} {v:?}: {off:e}");
                        assert_eq!(fast.settled, ImpactOutcome::Free);
                        balances(&body, &fast, &v, &w);
                    }
                }
            }
        }
    }
}

/// A single patch has a stiffer normal spring than a point, and the same tangential one: friction
/// takes another part of the impact.
#[test]
fn a_patch_alone_is_the_law_as_printed() {
    let (v, w) = (Vec3::new(1.0, 1.0, -5.0), Vec3::new(3.0, -2.0, 4.0));
    let (body, law) = case(&ground(1e9, 0.5, 0.1), 0.5, 0.0);
    let [patch, point] = [1.6, 1.0].map(|stiffness_scale| {
        let contact = [FrozenContact { stiffness_scale, ..slope([0.0, 0.0, 1.0], &law) }];
        let out = frozen_impact(&body, &contact, (&v, &w), 1e-10);
        let (slow, _) = oracle::follow(&body, &contact, (v, w), 4000.0);
        let off = apart(&body, after(&out), [slow.v, slow.w], v.norm());
        assert!(off < 2e-8, "{stiffness_scale}: {off:e}");
        out
    });
    assert!(apart(&body, after(&patch), after(&point), v.norm()) > 1e-3);
}

/// A smooth right angle between two walls: each returns its own component of the velocity,
/// independent of the other.
#[test]
fn walls_at_right_angles_do_not_know_of_each_other() {
    let (body, law) = case(&smooth(0.8), 0.5, 0.0);
    let other = case(&Ground { normal_stiffness_n_m: 3e7, ..smooth(0.3) }, 0.5, 0.0).1;
    let contacts = [slope([1.0, 0.0, 0.0], &law), slope([0.0, 0.0, 1.0], &other)];
    let v = Vec3::new(-4.0, 2.0, -3.0);
    let out = frozen_impact(&body, &contacts, (&v, &Vec3::zeros()), 1e-9);
    let expected = Vec3::new(0.8 * 4.0, 2.0, 0.3 * 3.0);
    assert!((out.velocity_m_s - expected).norm() < 5e-7, "{:?}", out.velocity_m_s);
    // and each has its own loss
    let paid = |e: f64, speed: f64| 0.5 * body.mass * (1.0 - e * e) * speed * speed;
    assert!((out.loss[0].damping / paid(0.8, 4.0) - 1.0).abs() < 1e-7);
    assert!((out.loss[1].damping / paid(0.3, 3.0) - 1.0).abs() < 1e-7);
}

/// However many contacts share one impact, its restitution is the same: the dashpots share.
#[test]
fn restitution_does_not_depend_on_how_many_contacts_there_are() {
    let (body, law) = case(&smooth(0.5), 0.5, 0.0);
    let v = Vec3::new(0.0, 0.0, -5.0);
    for count in 1..=MAX_CONTACTS {
        let contacts = [slope([0.0, 0.0, 1.0], &law); MAX_CONTACTS];
        let out = frozen_impact(&body, &contacts[..count], (&v, &Vec3::zeros()), 1e-9);
        // local errors of 3e-10 add up over a hundred steps
        assert!((out.velocity_m_s.z - 2.5).abs() < 5e-7, "{count}: {}", out.velocity_m_s.z);
    }
    // a stiffer patch damps alike
    let stiff = FrozenContact { stiffness_scale: 1.7, ..slope([0.0, 0.0, 1.0], &law) };
    let out = frozen_impact(&body, &[stiff], (&v, &Vec3::zeros()), 1e-9);
    assert!((out.velocity_m_s.z - 2.5).abs() < 1e-12);
    let out = frozen_impact(&body, &[stiff, stiff], (&v, &Vec3::zeros()), 1e-9);
    assert!((out.velocity_m_s.z - 2.5).abs() < 5e-7);
}

/// A captured contact leaves no velocity along its normal; one that rebounds beside it still does.
#[test]
fn captured_contacts_give_nothing_back() {
    let (body, law) = case(&ground(1e9, 0.5, 0.3), 0.5, 0.0);
    let caught = FrozenContact { captured: true, ..slope([0.0, 0.0, 1.0], &law) };
    let (v, w) = (Vec3::new(1.0, 0.0, -0.02), Vec3::new(0.0, 1.0, 2.0));
    let out = frozen_impact(&body, &[caught], (&v, &w), 1e-4);
    assert!(out.velocity_m_s.z.abs() < 1e-15);
    balances(&body, &out, &v, &w);
    let v = Vec3::new(-5.0, 1.0, -0.02);
    let wall = slope([1.0, 0.0, 0.0], &law);
    let out = frozen_impact(&body, &[caught, wall], (&v, &w), 1e-4);
    assert!(out.velocity_m_s.x > 2.0);
    assert!(out.velocity_m_s.z > -1e-12);
    balances(&body, &out, &v, &w);
}

/// Between parallel walls a rock rattles until it is too slow; nothing is lost with e = 1, and it
/// ends.
#[test]
fn rattling_ends() {
    for e in [0.5, 0.9] {
        let (body, law) = case(&ground(1e9, e, 0.3), 0.5, 0.0);
        let walls = [slope([1.0, 0.0, 0.0], &law), slope([-1.0, 0.0, 0.0], &law)];
        let (v, w) = (Vec3::new(-5.0, 2.0, 0.5), Vec3::new(3.0, 1.0, 2.0));
        let out = frozen_impact(&body, &walls, (&v, &w), 1e-4);
        assert!(out.velocity_m_s.x.abs() < 1e-6, "{out:?}");
        balances(&body, &out, &v, &w);
    }
}

/// The order in which contacts are listed changes nothing, and a turned scene gives the turned
/// answer.
#[test]
fn order_and_axes_do_not_matter() {
    let mut uniform = uniforms(5);
    let (body, law) = case(&ground(1e9, 0.5, 0.3), 0.5, 0.0);
    for normals in FOLDS {
        let contacts = normals.map(|n| slope(n, &law));
        let (v, w) = (Vec3::new(2.0, 1.0, -6.0), Vec3::new(1.0, -5.0, 3.0));
        let plain = frozen_impact(&body, &contacts, (&v, &w), 1e-4);
        let [a, b, c] = contacts;
        let other = frozen_impact(&body, &[c, a, b], (&v, &w), 1e-4);
        assert!(apart(&body, after(&plain), after(&other), v.norm()) < 1e-12);
        assert!((plain.loss[2].sum() - other.loss[0].sum()).abs() < 1e-9 * motion_j(&body, &v, &w));
        let turn = Rotation3::from_euler_angles(6.0 * uniform(), 6.0 * uniform(), 1.0);
        let turned =
            contacts.map(|contact| FrozenContact { normal: turn * contact.normal, ..contact });
        let turned = frozen_impact(&body, &turned, (&(turn * v), &(turn * w)), 1e-4);
        let back = after(&plain).map(|x| turn * x);
        assert!(apart(&body, after(&turned), back, v.norm()) < 1e-11);
    }
}

fn direction() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.0f64..1.0)
}

proptest! {
    /// e = 1 without friction on any number of contacts in any directions: energy is kept to 1e-12,
    /// spin to the bit.
    #[test]
    fn elastic_impacts_conserve(normals in prop::collection::vec(direction(), 1..5), fine in prop::bool::ANY) {
        let (body, law) = case(&smooth(1.0), 0.5, 0.0);
        let contacts: Vec<FrozenContact> = normals.iter().map(|[x, y, z]| slope([*x, *y, z.abs() + 0.05], &law)).collect();
        let (v, w) = (Vec3::new(3.0, -1.0, -5.0), Vec3::new(1.0, 2.0, 3.0));
        let out = frozen_impact(&body, &contacts, (&v, &w), if fine { 1e-9 } else { 1e-4 });
        prop_assert!((out.velocity_m_s.norm_squared() / v.norm_squared() - 1.0).abs() < 1e-12);
        prop_assert_eq!(out.spin_rad_s, w);
        prop_assert_eq!(out.settled, ImpactOutcome::Free);
        for contact in &contacts {
            prop_assert!(contact.normal.dot(&out.velocity_m_s) > -1e-6);
        }
    }

    /// Any contacts, grounds, rocks and motions: no gain, losses add up, nothing closes at the end,
    /// however it ends; about one in a thousand of these wild cases rattles until it is stopped.
    #[test]
    fn several_contacts_account_for_their_energy(
        normals in prop::collection::vec(direction(), 1..9), e in 0.0f64..1.0, other in 0.05f64..1.0, rolling in -0.2f64..0.5,
        ratio in 0.05f64..2.0, softer in 1.0f64..30.0, angle in 0.0f64..89.0, v in direction(), w in direction(),
        radius in -1.3f64..0.7, speed in -1.0f64..1.7, caught in 0u32..512, scale in 1.0f64..2.0,
    ) {
        let radius = 10f64.powf(radius);
        let ground = |p_n: f64, e: f64| Ground {
            shear_stiffness_n_m: ratio * p_n, friction_angle_rad: angle.to_radians(), ..ground(p_n, e, rolling.max(0.0))
        };
        let (body, law) = case(&ground(1e9, e), radius, 0.0);
        let soft = case(&ground(1e9 / softer, other), radius, 0.0).1;
        let contacts: Vec<FrozenContact> = normals.iter().enumerate().map(|(k, [x, y, z])| FrozenContact {
            normal: Vec3::new(*x, *y, z.abs() + 0.02).normalize(),
            law: if k % 2 == 0 { &law } else { &soft },
            stiffness_scale: if k % 3 == 1 { scale } else { 1.0 },
            captured: caught < 64 && caught >> k & 1 == 1, ..FrozenContact::none() }).collect();
        let v = (Vec3::from(v) - Vec3::z()) * 10f64.powf(speed);
        let w = Vec3::from(w) * (v.norm() / radius);
        let out = frozen_impact(&body, &contacts, (&v, &w), 1e-4);
        balances(&body, &out, &v, &w);
        prop_assert!(out.effort.steps <= 20_000, "{:?}", out.effort);
        for contact in &contacts {
            prop_assert!(contact.normal.dot(&out.velocity_m_s) > -1e-6 * v.norm());
        }
    }
}

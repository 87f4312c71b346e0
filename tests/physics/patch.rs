//! A ball pressed into a mesh: one energy, whatever the triangulation.

use crate::common;
use common::*;
use rockfall::contact::ContactPoints;
use rockfall::contact::closest::closest_on;
use rockfall::contact::neighbours::Neighbours;
use rockfall::rock::{Rock, Vec3};
use rockfall::solver::Scheme;
use rockfall::terrain::Terrain;
use rockfall::terrain::stl::Facet;

/// Energy and force over `p_N` of a ball of `radius` at `centre`, as the contacts say: `½ Σ |a|² pen²`, `Σ |a|² pen n̂`.
pub(crate) fn pressed(
    terrain: &Terrain,
    near: &mut Neighbours,
    centre: &Vec3,
    radius: f64,
) -> (f64, Vec3) {
    let mut touches = ContactPoints::default();
    near.collect(terrain, centre, radius, 0.1 * radius, 0.1 * radius);
    near.touches(terrain, centre, radius, &mut touches);
    touches.iter().fold((0.0, Vec3::zeros()), |(energy, force), touch| {
        let pen = radius - touch.distance_m;
        (energy + 0.5 * touch.gain2 * pen * pen, force + touch.normal * (touch.gain2 * pen))
    })
}

/// A valley along y at x = 0; its sides rise by half the angle each.
pub(crate) fn fold(angle: f64) -> Terrain {
    let z = 3.0 * (0.5 * angle).tan();
    let at = |x: f64, y: f64| Vec3::new(x, y, if x == 0.0 { 0.0 } else { z });
    let (a, b, c) = (at(-3.0, -3.0), at(0.0, -3.0), at(3.0, -3.0));
    let (d, e, f) = (at(-3.0, 3.0), at(0.0, 3.0), at(3.0, 3.0));
    terrain(vec![[a, b, e], [a, e, d], [b, c, f], [b, f, e]])
}

/// Energies and forces of the sum over all simplices, computed elsewhere (`tests/patch/energies.csv`), to 1e-9.
#[test]
fn energies_are_those_of_the_sum_over_all_simplices() {
    let read = |text: &str| -> Vec<Vec<String>> {
        text.lines().skip(1).map(|row| row.split(',').map(str::to_owned).collect()).collect()
    };
    let number = |text: &String| text.parse::<f64>().unwrap();
    let point = |row: &[String]| Vec3::new(number(&row[0]), number(&row[1]), number(&row[2]));
    let rough = read(include_str!("patch/rough.csv"));
    let facets = rough.iter().map(|row| [point(&row[0..3]), point(&row[3..6]), point(&row[6..9])]);
    let rough = terrain(facets.collect());
    let mut near = Neighbours::default();
    let mut several = 0;
    for row in read(include_str!("patch/energies.csv")) {
        let made;
        let terrain = match row[0].strip_prefix("fold ") {
            Some(angle) => {
                made = fold(angle.parse().unwrap());
                &made
            }
            None => &rough,
        };
        let (centre, radius) = (point(&row[1..4]) - terrain.origin_m, number(&row[4]));
        let (energy, force) = pressed(terrain, &mut near, &centre, radius);
        let (right, push) = (number(&row[5]), point(&row[6..9]));
        assert!((energy - right).abs() <= 1e-9 * (right + 1e-12), "{row:?}: {energy:e}");
        assert!((force - push).norm() <= 1e-9 * (push.norm() + 1e-12), "{row:?}: {force:?}");
        several += usize::from(2.0 * energy * 1.000_001 < force.norm_squared());
    }
    assert!(several > 20, "{several}");
}

/// On both sides of a blunt valley a ball presses on one patch, which is told by the triangle in it that is nearest: by that its ground is told.
#[test]
fn a_patch_is_told_by_its_nearest_triangle() {
    let (terrain, radius) = (fold(0.1), 0.5);
    let (mut near, mut touches) = (Neighbours::default(), ContactPoints::default());
    for x in [-0.05, -0.02, 0.02, 0.05] {
        for y in [-1.7, -0.4, 0.3, 1.1] {
            let centre = Vec3::new(x, y, 0.45) - terrain.origin_m;
            near.collect(&terrain, &centre, radius, 0.1 * radius, 0.1 * radius);
            near.touches(&terrain, &centre, radius, &mut touches);
            let far = |t: u32| (closest_on(&terrain.corners_m(t), &centre) - centre).norm();
            let nearest = (0..4).map(far).fold(f64::INFINITY, f64::min);
            let [touch] = touches[..] else { panic!("{} touches", touches.len()) };
            assert!(far(touch.triangle) < nearest + 1e-12, "{x} {y}: {}", touch.triangle);
        }
    }
}

/// One elastic impact without friction: energy after over before, height included.
pub(crate) fn kept(terrain: &Terrain, case: &Case, [c, v]: [[f64; 3]; 2]) -> f64 {
    let fallen = case.run(terrain, [c, v, [0.0; 3]], 0.2);
    let energy = |p: &Vec3, v: &Vec3| 0.5 * v.norm_squared() + G * p.z;
    let end = energy(&fallen.end.position_m, &fallen.end.velocity_m_s);
    end / energy(&fallen.start.position_m, &fallen.start.velocity_m_s)
}

/// e = 1 without friction on folds, wherever the rock lands: energy is kept.
#[test]
fn elastic_impacts_on_folds_keep_their_energy() {
    let mut worst = [0.0f64; 4];
    for angle in [1e-6, 1e-3, 0.02, 0.2, 0.6, 2.0] {
        let terrain = fold(angle);
        for (p_n, radius, speed) in [(1e9, 0.5, 10.0), (1e7, 0.05, 5.0), (1e12, 1.0, 50.0)] {
            for place in [-0.6, -0.35, -0.1, 0.0, 0.2, 0.5] {
                let ground = rockfall::ground::Ground {
                    normal_stiffness_n_m: p_n,
                    shear_stiffness_n_m: 0.25 * p_n,
                    friction_angle_rad: 0.0,
                    restitution: Some(1.0),
                    ..GROUND
                };
                let rock = Rock { radius_m: radius, ..ROCK };
                let x = place * f64::min(angle, 0.6) * radius;
                let z = 1.2 * radius / (0.5 * angle).cos() + x.abs() * (0.5 * angle).tan();
                let start = [[x, 0.1, z], [0.2 * speed, 0.0, -speed]];
                for (k, (scheme, tolerance)) in
                    [(Scheme::Reference, 1e-8), (Scheme::Adaptive, 0.05), (Scheme::Rigid, 0.05)]
                        .into_iter()
                        .enumerate()
                {
                    let case = Case {
                        scheme,
                        ground,
                        rock,
                        tolerance_m_s: tolerance,
                        step_s: 0.01,
                        capture_speed_m_s: Some(0.0),
                        ..CASE
                    };
                    let off = (kept(&terrain, &case, start) - 1.0).abs();
                    if off > [1e-6, 2e-3, 1e-12, 0.0][k] {
                        println!(
                            "{scheme:?} fold {angle} p_n {p_n:e} R {radius} place {place}: {off:e}"
                        );
                    }
                    worst[k] = worst[k].max(off);
                }
            }
        }
    }
    println!("{worst:?}");
    assert!(worst[0] < 1e-6 && worst[1] < 2e-3 && worst[2] < 1e-12, "{worst:?}");
}

/// The kernel of impacts on one plane and the general way agree within what both may err, and neither gains energy: speeds from
/// 0.1 to 50 m/s, grazing and upright, with spin, on grounds of every kind.
#[test]
fn the_plane_kernel_is_the_general_law() {
    use common::zoo::{between, dice};
    let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let corners = [at(-50.0, -50.0), at(50.0, -50.0), at(50.0, 50.0), at(-50.0, 50.0)];
    let [a, b, c, d] = corners;
    let floor = terrain(vec![[a, b, c], [a, c, d]]);
    let mut worst = [0.0f64; 3];
    for index in 0..300 {
        let random = &mut dice(900, index);
        let speed = 0.2 * 250f64.powf(between(random, 0.0, 1.0));
        let steep = between(random, 0.05, 1.57);
        let spin = || [0; 3];
        let w = spin().map(|_| between(random, -1.0, 1.0) * speed / ROCK.radius_m);
        let ground = rockfall::ground::Ground {
            restitution: Some(between(random, 0.1, 1.0)),
            friction_angle_rad: between(random, 0.0, 0.8),
            rolling_friction: if index % 2 == 0 { 0.0 } else { between(random, 0.1, 0.6) },
            ..GROUND
        };
        let start =
            [[0.3, 0.2, ROCK.radius_m], [speed * steep.cos(), 0.0, -speed * steep.sin()], w];
        let end = |scheme, impact_kernels| {
            let tolerance_m_s = if scheme == Scheme::Reference { 1e-8 } else { 0.05 };
            let capture_speed_m_s = Some(0.02);
            let case =
                Case { scheme, tolerance_m_s, impact_kernels, ground, capture_speed_m_s, ..CASE };
            let run = case.run(&floor, start, 5e-3);
            assert!(run.ledger.rise_j <= 1e-9 * run.released_j, "{index}: {:?}", run.ledger);
            (run.end.velocity_m_s, run.end.spin_rad_s * ROCK.radius_m)
        };
        let (v, w) = end(Scheme::Reference, true);
        for (k, impact_kernels) in [true, false].into_iter().enumerate() {
            let (v1, w1) = end(Scheme::Adaptive, impact_kernels);
            let off = (v1 - v).norm().max((w1 - w).norm()) / speed;
            if off > 1e-3 {
                println!("{index} {impact_kernels} {off:e} steep {steep} speed {speed} {ground:?}");
            }
            worst[k] = worst[k].max(off);
        }
        let (v1, w1) = end(Scheme::Reference, false);
        worst[2] = worst[2].max((v1 - v).norm().max((w1 - w).norm()) / speed);
    }
    println!("{worst:?}");
    assert!(worst[0] < 2e-3 && worst[1] < 2e-3 && worst[2] < 1e-7, "{worst:?}");
}

/// Default settings, a rock that tips off a sharp edge without slipping: it lifts off at cos θ = 10/17, from a pebble to a block.
#[test]
fn rocks_of_every_size_lift_off_an_edge_alike() {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    for radius in [0.05, 0.2, 0.5, 2.0] {
        let (l, d) = (20.0 * radius, 30.0 * radius);
        let facets = vec![
            [at(-l, -l, 0.0), at(0.0, -l, 0.0), at(0.0, l, 0.0)],
            [at(-l, -l, 0.0), at(0.0, l, 0.0), at(-l, l, 0.0)],
            [at(0.0, -l, 0.0), at(0.0, -l, -d), at(0.0, l, -d)],
            [at(0.0, -l, 0.0), at(0.0, l, -d), at(0.0, l, 0.0)],
        ];
        let terrain = terrain(facets);
        let rock = Rock { radius_m: radius, ..ROCK };
        let ground = rockfall::ground::Ground {
            normal_stiffness_n_m: 1e9 * radius,
            shear_stiffness_n_m: 0.25e9 * radius,
            friction_angle_rad: 1.5,
            ..GROUND
        };
        let case = Case { rock, ground, tolerance_m_s: 0.05, ..CASE };
        let from: f64 = 0.1;
        let speed = (10.0 / 7.0 * G * radius * (1.0 - from.cos())).sqrt();
        let start = [radius * from.sin(), 0.0, radius * from.cos()];
        let velocity = [speed * from.cos(), 0.0, -speed * from.sin()];
        // long enough to lift off, too short to land
        let run = case.run(
            &terrain,
            [start, velocity, [0.0, speed / radius, 0.0]],
            4.0 * (radius / G).sqrt(),
        );
        // v² = g R cos θ where it lifts, and the speed forward stays: v cos θ
        let cos = (run.end.velocity_m_s.x.powi(2) / (G * radius)).cbrt();
        println!("R {radius}: {cos} {}", cos - 10.0 / 17.0);
        assert!((cos - 10.0 / 17.0).abs() < 0.005, "R {radius}: {cos}");
    }
}

/// A noisy plane of square cells, larger than the ball sees.
pub(crate) fn noisy(cell: f64, cells: usize, noise_m: f64) -> Terrain {
    use common::zoo::{between, dice};
    let random = &mut dice(77, 0);
    let half = 0.5 * cell * cells as f64;
    let heights: Vec<f64> =
        (0..(cells + 1).pow(2)).map(|_| noise_m * between(random, -1.7, 1.7)).collect();
    let at = |i: usize, j: usize| {
        Vec3::new(i as f64 * cell - half, j as f64 * cell - half, heights[i * (cells + 1) + j])
    };
    let mut facets = Vec::new();
    for i in 0..cells {
        for j in 0..cells {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            facets.extend([[a, b, c], [a, c, d]]);
        }
    }
    terrain(facets)
}

/// A rock far larger than its triangles on a noisy surface: e = 1 keeps the energy, e = 0.5 rebounds as on a plane, within 5 %.
#[test]
fn a_rock_larger_than_its_triangles_rebounds_as_on_a_plane() {
    for noise_m in [0.001, 0.005] {
        let terrain = noisy(0.1, 40, noise_m);
        for restitution in [1.0, 0.5] {
            for place in [[0.02, 0.01], [-0.07, 0.05]] {
                let (radius, speed) = (5.0, 10.0);
                let ground = rockfall::ground::Ground {
                    friction_angle_rad: 0.0,
                    restitution: Some(restitution),
                    ..GROUND
                };
                let rock = Rock { radius_m: radius, ..ROCK };
                let case = Case { ground, rock, tolerance_m_s: 0.05, ..CASE };
                let start = [[place[0], place[1], radius + 0.02], [0.0, 0.0, -speed], [0.0; 3]];
                let run = case.run(&terrain, start, 0.2);
                let v = run.end.velocity_m_s;
                // speed where it touched, by energy
                let up = (v.norm_squared() + 2.0 * G * (run.end.position_m.z - radius)).sqrt();
                let e = up / (speed * speed + 2.0 * G * 0.02).sqrt();
                println!("noise {noise_m} e {restitution} {place:?}: {e} {:?}", run.effort);
                let omega = (GROUND.normal_stiffness_n_m / rock.mass_kg()).sqrt();
                let fall = (speed * speed + 2.0 * G * 0.02).sqrt();
                let zeta = rockfall::ground::damping_ratio(restitution);
                let plane = rockfall::ground::normal_impact(fall, omega, zeta, G);
                let right = plane.rebound_m_s.unwrap() / fall;
                let allowed = if restitution > 0.9 { 2e-3 } else { 0.05 * right };
                assert!((e - right).abs() < allowed, "noise {noise_m} {place:?}: {e} for {right}");
            }
        }
    }
}

/// e = 1 without friction on the rim of a rough sheet, where the ball presses into several points of its border: energy is kept.
#[test]
fn elastic_impacts_on_the_rim_of_a_rough_sheet_keep_their_energy() {
    let terrain = noisy(0.25, 16, 0.005);
    let ground = rockfall::ground::Ground {
        normal_stiffness_n_m: 1e10,
        shear_stiffness_n_m: 0.25e10,
        friction_angle_rad: 0.0,
        restitution: Some(1.0),
        ..GROUND
    };
    let rock = Rock { radius_m: 1.5, ..ROCK };
    let case = Case { scheme: Scheme::Reference, tolerance_m_s: 1e-8, ground, rock, ..CASE };
    let places = (0..400).map(|k| [1.95 + 0.005 * f64::from(k % 40), -1.0 + 0.005 * f64::from(k)]);
    let off = places.map(|[x, y]| kept(&terrain, &case, [[x, y, 1.55], [0.0, 3.0, -12.0]]) - 1.0);
    let worst = off.map(f64::abs).fold(0.0, f64::max);
    println!("{worst:e}");
    assert!(worst < 1e-6, "{worst:e}");
}

/// Without friction nothing can turn a rock: its spin stays to the last bit, also where the steps of an impact among patches are
/// balanced.
#[test]
fn an_impact_without_friction_leaves_the_spin_alone() {
    let terrain = noisy(0.1, 40, 0.005);
    let ground = rockfall::ground::Ground { friction_angle_rad: 0.0, ..GROUND };
    let spin = [1.0, 2.0, 3.0];
    for k in 0..20 {
        let case = Case { ground, tolerance_m_s: 0.05, ..CASE };
        let start = [[0.05 * f64::from(k) - 0.5, 0.31, 0.55], [2.0, 0.0, -8.0], spin];
        let run = case.run(&terrain, start, 0.1);
        assert_eq!(run.end.spin_rad_s, Vec3::from(spin), "{k}");
    }
}

/// Two sheets that rise by half the angle on either side of their common line x = 0, which is cut into other pieces on each.
fn seam(angle: f64, shares: [&[f64]; 2]) -> Vec<Facet> {
    let mut facets = Vec::new();
    for (side, shares) in [-1.0, 1.0].into_iter().zip(shares) {
        let at =
            |x: f64, share: f64| Vec3::new(side * x, 6.0 * share - 3.0, x * (0.5 * angle).tan());
        for pair in shares.windows(2) {
            let [a, b, c, d] =
                [at(0.0, pair[0]), at(0.0, pair[1]), at(3.0, pair[1]), at(3.0, pair[0])];
            facets.extend([[a, b, c], [a, c, d]]);
        }
    }
    facets
}

const WHOLE: [f64; 2] = [0.0, 1.0];
const THREE: [f64; 4] = [0.0, 0.3, 0.55, 1.0];

/// Corners that only one side of a seam has take part in the energy like all others: a ball is pressed as where both sides
/// have them, in a plane, in hollow folds and on ridges.
#[test]
fn a_seam_with_other_corners_on_either_side_presses_like_one_with_the_same() {
    let mut near = Neighbours::default();
    let mut several = 0;
    for angle in [0.0, 1e-3, 0.02, 0.2, 0.6, 1.5, -0.02, -0.4] {
        let same = terrain(seam(angle, [&THREE, &THREE]));
        for shares in [[&WHOLE[..], &THREE[..]], [&THREE[..], &[0.0, 0.4, 0.55, 0.8, 1.0][..]]] {
            let other = terrain(seam(angle, shares));
            for k in 0..200 {
                let random = &mut common::zoo::dice(901, k);
                let mut of = |from, to| common::zoo::between(random, from, to);
                let pen = of(0.0, 0.05);
                // in a fold the centre is above the line where the ball presses into both sides
                let x = of(-1.0, 1.0) * f64::min(angle.abs(), 0.4);
                let z = (1.0 - pen) / (0.5 * angle).cos() + x.abs() * (0.5 * angle).tan();
                let centre = Vec3::new(x, of(-2.9, 2.9), z);
                let [right, found] = [&same, &other]
                    .map(|terrain| pressed(terrain, &mut near, &(centre - terrain.origin_m), 1.0));
                assert!(
                    (found.0 - right.0).abs() <= 1e-12,
                    "{angle} {centre:?} {found:?} {right:?}"
                );
                assert!(
                    (found.1 - right.1).norm() <= 1e-9,
                    "{angle} {centre:?} {found:?} {right:?}"
                );
                several += usize::from(2.0 * right.0 * 1.000_001 < right.1.norm_squared());
            }
        }
    }
    assert!(several > 100, "{several}");
}

/// e = 1 without friction in hollow folds with one edge on the one side and three on the other: energy is kept.
#[test]
fn elastic_impacts_on_seams_with_other_corners_on_either_side_keep_their_energy() {
    let ground =
        rockfall::ground::Ground { friction_angle_rad: 0.0, restitution: Some(1.0), ..GROUND };
    let schemes = [(Scheme::Reference, 1e-8), (Scheme::Adaptive, 0.05), (Scheme::Rigid, 0.05)];
    let mut worst = [0.0f64; 3];
    for angle in [0.0, 1e-3, 0.02, 0.1, 0.5] {
        let terrain = terrain(seam(angle, [&WHOLE, &THREE]));
        for k in 0..40 {
            let random = &mut common::zoo::dice(902, k);
            let x = common::zoo::between(random, -0.6, 0.6) * angle * ROCK.radius_m;
            let y = common::zoo::between(random, -2.0, 2.0);
            let start = [[x, y, 0.6 + x.abs() * angle], [1.0, 2.0, -10.0]];
            for (worst, (scheme, tolerance_m_s)) in worst.iter_mut().zip(schemes) {
                let case =
                    Case { scheme, tolerance_m_s, ground, capture_speed_m_s: Some(0.0), ..CASE };
                *worst = worst.max((kept(&terrain, &case, start) - 1.0).abs());
            }
        }
    }
    println!("{worst:?}");
    assert!(worst[0] < 1e-6 && worst[1] < 2e-3 && worst[2] < 1e-12, "{worst:?}");
}

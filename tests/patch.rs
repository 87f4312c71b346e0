//! A ball pressed into a mesh: one energy, whatever the triangulation.

mod common;
use common::*;
use rockfall::contact::Touches;
use rockfall::contact::near::Near;
use rockfall::rock::{Rock, Vec3};
use rockfall::step::Scheme;
use rockfall::terrain::Terrain;

/// Energy and force over `p_N` of a ball of `radius` at `centre`, as the contacts say: `½ Σ |a|² pen²`, `Σ |a|² pen n̂`.
fn pressed(terrain: &Terrain, near: &mut Near, centre: &Vec3, radius: f64) -> (f64, Vec3) {
    let mut touches = Touches::default();
    near.collect(terrain, centre, radius, 0.1 * radius, 0.1 * radius);
    near.touches(terrain, centre, radius, &mut touches);
    touches.iter().fold((0.0, Vec3::zeros()), |(energy, force), touch| {
        let pen = radius - touch.distance_m;
        (energy + 0.5 * touch.gain2 * pen * pen, force + touch.normal * (touch.gain2 * pen))
    })
}

/// A valley along y at x = 0; its sides rise by half the angle each.
fn fold(angle: f64) -> Terrain {
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
    let mut near = Near::default();
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

/// One elastic impact without friction: energy after over before, height included.
fn kept(terrain: &Terrain, case: &Case, [c, v]: [[f64; 3]; 2]) -> f64 {
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

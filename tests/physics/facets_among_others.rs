//! Rough ground under rocks that touch each other: a rock is rotated against its facet, as alone,
//! whatever touches it.

use crate::common;

use common::GROUND;
use common::together::{self, Sphere, World, energy_j, plane};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::simulation::Trajectory;
use rockfall::solver::Scheme;

const SCHEMES: [Scheme; 3] = [Scheme::Adaptive, Scheme::Reference, Scheme::Rigid];
/// Groups in a world, each far from all others.
const GROUPS: usize = 24;

fn world(scheme: Scheme, (restitution, friction_angle_rad): (f64, f64)) -> World {
    let ground = Ground {
        normal_stiffness_n_m: 1e9,
        shear_stiffness_n_m: 0.25e9,
        restitution: Some(restitution),
        friction_angle_rad,
        roughness_rad: 25f64.to_radians(),
        ..GROUND
    };
    let tolerance_m_s = if scheme == Scheme::Reference { 1e-8 } else { 0.05 };
    let base = World { restitution, stiffness_n_m: 1e9, friction_angle_rad, ..together::WORLD };
    World { scheme, gravity_m_s2: 9.81, tolerance_m_s, ground, ..base }
}

/// Groups of two rocks that fall at 6 m/s: one of `radii_m`, 1 mm above the ground, and one of the
/// other radius, `gap_m` above it and `rad` from straight above.
fn groups(radii_m: [f64; 2], (gap_m, rad): (f64, f64)) -> Vec<Sphere> {
    let group = |place: usize| -> [Sphere; 2] {
        let x = 3.5 * (place % 12) as f64 - 20.0;
        let y = 8.0 * (place / 12) as f64 - 4.0;
        let apart_m = radii_m[0] + radii_m[1] + gap_m;
        let low = [x, y, radii_m[0] + 1e-3];
        let high = [x, y + rad.sin() * apart_m, low[2] + rad.cos() * apart_m];
        [(radii_m[0], low), (radii_m[1], high)]
            .map(|(radius_m, at)| (radius_m, 2700.0, at, [0.0, 0.0, -6.0], [0.0; 3]))
    };
    (0..GROUPS).flat_map(group).collect()
}

/// Velocities of the lower rocks.
fn lower(falls: &[Trajectory]) -> Vec<Vec3> {
    falls.iter().step_by(2).map(|fall| fall.end.velocity_m_s).collect()
}

fn sideways(velocities: &[Vec3]) -> f64 {
    velocities.iter().map(|v| v.x.hypot(v.y)).sum::<f64>() / velocities.len() as f64
}

fn farthest(one: &[Vec3], other: &[Vec3]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// A pebble of 1/1728 of its mass takes no facet away from a boulder, on top of it or beside it: with
/// springs the boulder came off straight up, with 0.007 m/s sideways for 1.35.
#[test]
fn a_pebble_takes_no_facet_away() {
    for scheme in SCHEMES {
        let world = world(scheme, (0.4, std::f64::consts::FRAC_PI_6));
        let thrown = |gap_m: f64, rad: f64| {
            lower(&world.falls(&plane(), &groups([0.6, 0.05], (gap_m, rad)), 0.03))
        };
        // the same facets, as they belong to the numbers of the rocks
        let alone = thrown(1.0, 0.0);
        assert!(sideways(&alone) > 0.8, "{scheme:?}: {alone:?}");
        for rad in [0.0, 1.4] {
            let beside = thrown(1e-6, rad);
            let off = farthest(&alone, &beside);
            assert!(off < 0.12, "{scheme:?} {rad}: {off} of {}", sideways(&alone));
        }
    }
}

/// One rock on another of its size: all schemes throw both from the same facets alike.
#[test]
fn schemes_agree_on_facets_under_two_rocks() {
    for friction_rad in [0.0, std::f64::consts::FRAC_PI_6] {
        let thrown = SCHEMES.map(|scheme| {
            let falls = world(scheme, (0.4, friction_rad)).falls(
                &plane(),
                &groups([0.5, 0.5], (1e-6, 0.0)),
                0.03,
            );
            falls.iter().map(|fall| fall.end.velocity_m_s).collect::<Vec<_>>()
        });
        let [adaptive, rigid] = [0, 2].map(|k| farthest(&thrown[k], &thrown[1]));
        let mean = sideways(&thrown[1]);
        assert!(mean > 0.5 && adaptive < 0.2 && rigid < 0.35, "{mean} {adaptive} {rigid}");
    }
}

/// Without loss in the contacts facets keep the energy of two rocks that touch.
#[test]
fn facets_keep_the_energy_of_rocks_that_touch() {
    for (scheme, part) in [(Scheme::Adaptive, 0.01), (Scheme::Reference, 1e-6)] {
        for gap_m in [1e-6, 1e-3, 1e-2] {
            let elastic = World { gravity_m_s2: 1e-9, ..world(scheme, (1.0, 0.0)) };
            let falls = elastic.falls(&plane(), &groups([0.5, 0.3], (gap_m, 0.3)), 0.05);
            let [before, after] = [false, true].map(|at_end| energy_j(&falls, at_end, 0.0));
            assert!((after / before - 1.0).abs() < part, "{scheme:?} {gap_m}: {}", after / before);
        }
    }
}

//! A rock between steep flanks, beside others: a flank that it neither holds to nor has come to takes no part in its impact on the other.

use crate::common;

use common::together::{self, Sphere, World, energy_j};
use common::{GROUND, terrain};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::solver::Scheme;
use rockfall::terrain::Terrain;

/// A crevice along y with flanks of this slope (–).
fn crevice(slope: f64) -> Terrain {
    let at = |x: f64, y: f64| Vec3::new(x, y, slope * x.abs());
    let flank = |x: f64| {
        let [a, b, c, d] = [at(0.0, -9.0), at(x, -9.0), at(x, 9.0), at(0.0, 9.0)];
        if x > 0.0 { [[a, b, c], [a, c, d]] } else { [[b, a, d], [b, d, c]] }
    };
    terrain([flank(4.0), flank(-4.0)].concat())
}

/// Elastic and without friction a stone that falls to the middle of a crevice keeps its energy, with another above it that it meets later. Of the second flank,
/// which it comes to some microseconds after the first, it gave up to a quarter of it away.
#[test]
fn a_stone_in_a_crevice_keeps_its_energy_beside_others() {
    for slope in [1.8, 3.0] {
        let terrain = crevice(slope);
        let cosine = 1.0 / (1.0 + slope * slope).sqrt();
        for k in 0..60 {
            let off_m = 1e-5 * (f64::from(k) - 29.5);
            let ground = Ground {
                normal_stiffness_n_m: 1e12,
                shear_stiffness_n_m: 0.25e12,
                friction_angle_rad: 0.0,
                restitution: Some(1.0),
                ..GROUND
            };
            let base = World { stiffness_n_m: 1e12, restitution: 1.0, ..together::WORLD };
            let world = World {
                scheme: Scheme::Rigid,
                gravity_m_s2: 9.81,
                friction_angle_rad: 0.0,
                ground,
                ..base
            };
            let low = [off_m, 0.0, 0.3003 / cosine + slope * off_m.abs()];
            let high = [off_m, 0.47, low[2] + 0.4];
            let spheres: [Sphere; 2] =
                [low, high].map(|at| (0.3, 2700.0, at, [0.7, 0.0, -6.0], [0.0; 3]));
            let falls = world.falls(&terrain, &spheres, 0.004);
            let [before, after] = [false, true].map(|at_end| energy_j(&falls, at_end, 9.81));
            assert!((after / before - 1.0).abs() < 1e-9, "{slope} {off_m:e}: {}", after / before);
        }
    }
}

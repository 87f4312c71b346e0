//! Blows on a stone just above the ground: springs that are pressed long enough close the gap, and the ground answers.

use crate::common;

use common::GROUND;
use common::together::{self, Sphere, World, energy_j, plane};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::simulation::Trajectory;
use rockfall::solver::Scheme;

const RADII_M: [f64; 2] = [0.5, 0.29];

fn world(
    scheme: Scheme,
    stiffness_n_m: f64,
    (restitution, friction_angle_rad): (f64, f64),
) -> World {
    let ground = Ground {
        normal_stiffness_n_m: stiffness_n_m,
        shear_stiffness_n_m: 0.25 * stiffness_n_m,
        restitution: Some(restitution),
        friction_angle_rad,
        ..GROUND
    };
    let base = World { restitution, stiffness_n_m, friction_angle_rad, ground, ..together::WORLD };
    World { scheme, gravity_m_s2: 9.81, tolerance_m_s: 1e-8, ..base }
}

/// A boulder that rolls down 42° with 16 m/s and comes on a stone which rolls on with `stone_m_s` a gap above level ground; `rad` from straight above.
fn ridden_over(world: &World, (rad, stone_m_s, gap_m): (f64, f64, f64)) -> Vec<Trajectory> {
    let [boulder_m, stone_m] = RADII_M;
    let apart_m = boulder_m + stone_m + 1e-3;
    let up_m = stone_m + gap_m;
    let at = [0.0, -rad.sin() * apart_m, up_m + rad.cos() * apart_m];
    let boulder: Sphere = (boulder_m, 2700.0, at, [0.0, 12.0, -10.7], [-32.0, 0.0, 0.0]);
    let rolls = [-stone_m_s / stone_m, 0.0, 0.0];
    let stone = (stone_m, 2700.0, [0.0, 0.0, up_m], [0.0, stone_m_s, 0.0], rolls);
    world.falls(&plane(), &[boulder, stone], 0.012)
}

fn velocities(falls: &[Trajectory]) -> [Vec3; 2] {
    [0, 1].map(|k| falls[k].end.velocity_m_s)
}

/// A boulder that rides over a stone is thrown up as springs throw it, whether the stone lies on the ground or has just hopped 3 mm up: blow by blow,
/// as if springs took no time, it came off with 3.0 to 5.9 m/s for 8.2 to 12 m/s, and what leaps over a line in worlds with `rigid` was too low.
#[test]
fn a_stone_that_hops_is_ridden_over_like_one_that_lies() {
    let friction_rad = std::f64::consts::FRAC_PI_6;
    let of = |scheme| world(scheme, 1e10, (0.4, friction_rad));
    for deg in [5.0_f64, 20.0, 35.0, 50.0, 65.0] {
        for (stone_m_s, gap_m) in [(0.0, 0.0), (0.0, 3e-3), (6.0, 1e-3), (6.0, 3e-3)] {
            let case = (deg.to_radians(), stone_m_s, gap_m);
            let [springs, rigid] = [Scheme::Reference, Scheme::Rigid]
                .map(|scheme| velocities(&ridden_over(&of(scheme), case)));
            for (one, other) in springs.iter().zip(&rigid) {
                assert!((one - other).norm() < 0.45, "{case:?}: {springs:?} {rigid:?}");
            }
        }
    }
}

/// Springs so stiff that they are no longer pressed when the stone comes to the ground throw as their limit does, blow by blow.
#[test]
fn a_gap_that_stays_open_is_one() {
    for deg in [20.0_f64, 50.0] {
        let case = (deg.to_radians(), 0.0, 3e-3);
        let [springs, rigid] = [Scheme::Reference, Scheme::Rigid]
            .map(|scheme| velocities(&ridden_over(&world(scheme, 1e14, (0.4, 0.0)), case)));
        for (one, other) in springs.iter().zip(&rigid) {
            assert!((one - other).norm() < 0.1, "{deg}: {springs:?} {rigid:?}");
        }
    }
}

/// Elastic and without friction no gap makes or takes energy.
#[test]
fn gaps_keep_the_energy_of_a_blow() {
    for stiffness_n_m in [1e8, 1e10, 1e12] {
        let world = world(Scheme::Rigid, stiffness_n_m, (1.0, 0.0));
        for deg in [5.0_f64, 30.0, 60.0] {
            for gap_m in [0.0, 1e-4, 1e-3, 5e-3, 2e-2] {
                let falls = ridden_over(&world, (deg.to_radians(), 3.0, gap_m));
                let [before, after] = [false, true].map(|end| energy_j(&falls, end, 9.81));
                let off = (after - before) / before;
                assert!(off.abs() < 1e-9, "{stiffness_n_m:e} {deg} {gap_m}: {off:e}");
            }
        }
    }
}

//! The energy ledger of the fixed step: what contacts took, apart from what the step lost.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use common::together::{WORLD, World, plane};
use common::{CASE, Case, GROUND, falls, plan_in};
use rockfall::ground::Ground;
use rockfall::simulation::Trajectory;
use rockfall::solver::Scheme;
use rockfall::terrain::make::jittered_plane;
use rockfall::terrain::stl::write_binary;

const SOFT: Ground = Ground {
    normal_stiffness_n_m: 1e9,
    shear_stiffness_n_m: 0.25e8,
    rolling_friction: 0.1,
    ..GROUND
};

/// What went into contacts, and the remainder, of all rocks together (J).
fn taken_and_left(falls: &[Trajectory]) -> [f64; 2] {
    let taken = |fall: &Trajectory| {
        let row = &fall.ledger;
        row.friction_j + row.damping_j + row.rolling_j + row.others_j
    };
    let left = |fall: &Trajectory| fall.ledger.remainder_j;
    [falls.iter().map(taken).sum(), falls.iter().map(left).sum()]
}

/// Contacts take what they take in short steps, `reference`'s, of the energy that came in (J), and what the step itself loses goes with its
/// length: none of it is said to have gone into dashpots, and nothing that ran out in springs let go is left over.
fn is_parted(name: &str, energy_j: f64, run: impl Fn(Scheme, f64) -> [f64; 2]) {
    let [exact_j, _] = run(Scheme::Reference, 0.0);
    let of = |step_s: f64| run(Scheme::Dda, step_s).map(|joule| joule / energy_j);
    let [long, short] = [1e-5, 2e-6].map(of);
    let off = short[0] - exact_j / energy_j;
    assert!(
        long[1] > 1e-3 && (0.17..0.23).contains(&(short[1] / long[1])),
        "{name}: {long:?} {short:?}"
    );
    assert!(off.abs() < 1.2e-3, "{name}: {off:e} of {energy_j} J, {exact_j} J taken");
}

/// A sphere that comes down aslant: its shear and rolling springs are stretched as it lifts off.
#[test]
fn what_a_fixed_step_loses_of_a_sphere_is_not_damping() {
    let floor = common::terrain(jittered_plane(50.0, 1, 0.0));
    for restitution in [1.0, 0.4] {
        let run = |scheme: Scheme, step_s: f64| {
            let ground = Ground { restitution: Some(restitution), ..SOFT };
            let case = Case { scheme, step_s, ground, tolerance_m_s: 1e-6, ..CASE };
            let start = [[0.3, 0.2, 0.5], [3.0, 0.0, -5.0], [0.0; 3]];
            taken_and_left(&[case.run(&floor, start, 0.1)])
        };
        let energy_j = 0.5 * common::ROCK.mass_kg() * 34.0;
        is_parted(&format!("sphere, e = {restitution}"), energy_j, run);
    }
}

/// Two spheres that strike each other aslant in flight: each other's springs are let go stretched, too. They are stiff, as levers are the radii in the
/// printed step and end at the middle of the overlap in the other schemes.
#[test]
fn what_a_fixed_step_loses_between_spheres_is_not_taken_by_them() {
    for restitution in [1.0, 0.4] {
        let run = |scheme: Scheme, step_s: f64| {
            let soft =
                World { stiffness_n_m: 1e9, gravity_m_s2: common::G, tolerance_m_s: 1e-6, ..WORLD };
            let world = World { scheme, restitution, step_s, ..soft };
            let sphere =
                |x: f64, y: f64, vx: f64| (0.5, 2700.0, [x, y, 5.0], [vx, 0.0, 0.0], [0.0; 3]);
            taken_and_left(&world.falls(
                &plane(),
                &[sphere(-0.6, 0.0, 4.0), sphere(0.6, 0.5, -4.0)],
                0.15,
            ))
        };
        let energy_j = common::ROCK.mass_kg() * 16.0;
        is_parted(&format!("pair, e = {restitution}"), energy_j, run);
    }
}

/// Boxes that strike with a corner and rock on: what a step has made counts beyond what contacts took.
#[test]
fn what_a_fixed_step_loses_of_a_block_is_not_damping() {
    let folder = tempfile::tempdir().unwrap();
    write_binary(&folder.path().join("plane.stl"), &jittered_plane(50.0, 1, 0.0)).unwrap();
    for restitution in [1.0, 0.4] {
        let run = |scheme: Scheme, step_s: f64| {
            let scheme = match scheme {
                Scheme::Dda => format!("scheme = \"dda\"\nstep_s = {step_s}"),
                _ => "scheme = \"reference\"".into(),
            };
            let scene = format!(
                "title = \"boxes\"\nseed = 1\n[[terrain]]\nmesh = \"plane.stl\"\nground = \"soft\"\n\
                 [grounds.soft]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 0.25e8\n\
                 friction_angle_deg = 30.0\nrolling_friction = 0.1\nrestitution = {restitution}\n\
                 [rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.5\n\
                 [[rocks.shapes]]\nkind = \"box\"\naxes = [1.0, 1.2, 0.8]\ncorner_radius = 0.1\n\
                 [release]\ncount = 4\nvelocity_m_s = [2.0, 0.0, -5.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
                 orientation = \"random\"\npoints_m = [[0.0, 0.0, 1.0]]\n\
                 [solver]\n{scheme}\nlongest_s = 0.35\n"
            );
            taken_and_left(&falls(&plan_in(folder.path(), &scene)))
        };
        let energy_j = 4.0 * 0.5 * common::ROCK.mass_kg() * 29.0;
        is_parted(&format!("boxes, e = {restitution}"), energy_j, run);
    }
}

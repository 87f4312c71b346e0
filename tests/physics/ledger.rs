//! The numerical remainder of a rock's energy ledger is what its steps lost or gained, not an error of the ledger.

#![allow(clippy::unwrap_used, reason = "a closed form without an answer has failed")]

use crate::common::uneven_cells;
use rockfall::ground::{Ground, damping_ratio, normal_impact};
use rockfall::rock::Vec3;
use rockfall::simulation::Scratch;
use rockfall::solver::Scheme;
use rockfall::study::bench::{GRAVITY_M_S2, GROUND, SETUP, Setup, settings, terrain};
use rockfall::terrain::make;

/// One rock dropped upright: what one impact lost by the ledger's own account (J over the energy of the approach), and
/// what it lost more than the closed form says.
fn one_impact(restitution: f64, speed_m_s: f64, tolerance_m_s: f64) -> (f64, f64) {
    let floor = terrain(make::jittered_plane(50.0, 1, 0.0));
    let ground = Ground { restitution: Some(restitution), ..GROUND };
    let omega = (ground.normal_stiffness_n_m / SETUP.rock.mass_kg()).sqrt();
    let setup = Setup {
        ground,
        centre_m: Vec3::new(0.3, 0.2, SETUP.rock.radius_m),
        velocity_m_s: Vec3::new(0.0, 0.0, -speed_m_s),
        // long enough for a rebound, too short to come down again
        longest_s: 4.0 / omega,
        ..SETUP
    };
    let step = settings(Scheme::Adaptive, tolerance_m_s, Some(0.0));
    let journey = setup.follow(&floor, &step, &mut Scratch::default());
    let exact = normal_impact(speed_m_s, omega, damping_ratio(restitution), GRAVITY_M_S2);
    let end = journey.end;
    let rise = end.position_m.z - SETUP.rock.radius_m;
    let square = end.velocity_m_s.z.powi(2) + 2.0 * GRAVITY_M_S2 * rise;
    let more = exact.rebound_m_s.unwrap().powi(2) - square;
    let energy = 0.5 * SETUP.rock.mass_kg() * speed_m_s * speed_m_s;
    (journey.ledger.remainder_j / energy, more / speed_m_s.powi(2))
}

/// On a plane the normal motion has a closed form: nothing is lost that is not booked, and no more than should be, over
/// restitutions and speeds, to rounding.
#[test]
fn an_impact_on_a_plane_leaves_no_remainder() {
    for restitution in [0.25, 0.5, 0.9, 1.0] {
        for speed in [0.5, 1.0, 3.0, 10.0] {
            let (booked, more) = one_impact(restitution, speed, 1e-3);
            let name = format!("e {restitution}, {speed} m/s: {booked:e} for {more:e}");
            assert!(booked.abs() < 1e-13 && more.abs() < 1e-12, "{name}");
        }
    }
}

/// A rock that slides along without friction and strikes a wall, of which the steps of its lasting contact know nothing before: it
/// comes back with e times its speed and neither gains nor loses beside. `adaptive` once let the wall press from the middle of a long
/// step, which made up to an eighth of the energy out of nothing or lost as much.
#[test]
fn a_sliding_rock_that_strikes_a_wall_neither_gains_nor_loses_by_steps() {
    let floor = make::jittered_plane(50.0, 1, 0.0);
    let wall = [[-20.0, 0.0], [20.0, 0.0], [20.0, 9.0], [-20.0, 9.0]];
    let wall = wall.map(|[y, z]| Vec3::new(2.0, y, z));
    let wall = [[wall[0], wall[1], wall[2]], [wall[0], wall[2], wall[3]]];
    let site = terrain(floor.into_iter().chain(wall).collect());
    let ground = Ground { friction_angle_rad: 0.0, ..GROUND };
    let e = ground.restitution.unwrap();
    for (speed, gap_m) in [0.3, 0.6, 1.0, 5.0, 15.0].into_iter().zip([0.0, 1e-3, 0.0, 1e-3, 1e-3]) {
        for tolerance in [0.05, 0.005] {
            let setup = Setup {
                ground,
                centre_m: Vec3::new(0.0, 0.1, SETUP.rock.radius_m + gap_m),
                velocity_m_s: Vec3::new(speed, 0.0, 0.0),
                longest_s: 2.5 / speed,
                ..SETUP
            };
            let step = settings(Scheme::Adaptive, tolerance, None);
            let journey = setup.follow(&site, &step, &mut Scratch::default());
            let booked = journey.ledger.remainder_j
                / (0.5 * SETUP.rock.mass_kg() * speed.powi(2)
                    + SETUP.rock.mass_kg() * GRAVITY_M_S2 * gap_m);
            let back = -journey.end.velocity_m_s.x / (e * speed);
            let name = format!("{speed} m/s, {gap_m} m, {tolerance}: {booked:e}, {back}");
            assert!(booked.abs() < 5e-4 && (back - 1.0).abs() < 2e-3, "{name}");
        }
    }
}

/// A rock that slides in the rigid limit over uneven ground without friction gets into it step by step and is lifted out: its motion pays for the height, so
/// that nothing is left of the ledger but rounding.
#[test]
fn what_lifts_a_rock_out_of_the_ground_is_paid_by_its_motion() {
    let ground = Ground { friction_angle_rad: 0.0, ..GROUND };
    for (unevenness_m, speed) in [(0.02, 0.5), (0.02, 2.0), (0.1, 0.5), (0.1, 2.0)] {
        let cells = uneven_cells(80, 0.25, unevenness_m);
        let site = terrain(cells.flat_map(|(_, facets)| facets).collect());
        let setup = Setup {
            ground,
            centre_m: Vec3::new(0.0, 0.1, SETUP.rock.radius_m + 0.1),
            velocity_m_s: Vec3::new(speed, 0.0, 0.0),
            longest_s: 2.5,
            ..SETUP
        };
        let step = settings(Scheme::Rigid, 0.05, None);
        let journey = setup.follow(&site, &step, &mut Scratch::default());
        let left = journey.ledger.remainder_j / (0.5 * SETUP.rock.mass_kg() * speed.powi(2));
        assert!(left.abs() < 1e-9, "{unevenness_m} m, {speed} m/s: {left:e}");
    }
}

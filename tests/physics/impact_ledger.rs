//! Where the energy of impacts goes: dashpots take what dashpots take, also where patches come and go within a step, and what springs
//! hold is not lost.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test says what it saw")]

use crate::common::*;
use crate::patch::{fold, noisy};
use crate::stems::{shoot_from, stand_on};
use rockfall::ground::Ground;
use rockfall::rock::{Rock, Vec3};
use rockfall::simulation::{Ledger, Scratch, Trajectory};
use rockfall::solver::Scheme;
use rockfall::terrain::Terrain;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

/// Rocks that strike noisy meshes and folds again and again: far larger than their triangles, and smaller ones.
fn journeys(ground: &Ground, scheme: Scheme, see: &mut impl FnMut(&str, &Trajectory)) {
    let sites: [(&str, Terrain, f64); 5] = [
        ("1 mm of noise, R 5 m", noisy(0.1, 40, 0.001), 5.0),
        ("5 mm of noise, R 5 m", noisy(0.1, 40, 0.005), 5.0),
        ("5 mm of noise, R 0.5 m", noisy(0.1, 40, 0.005), 0.5),
        ("fold of 0.02 rad", fold(0.02), 0.5),
        ("fold of 0.6 rad", fold(0.6), 0.5),
    ];
    let tolerance_m_s = if scheme == Scheme::Reference { 1e-8 } else { 0.05 };
    for (name, site, radius_m) in &sites {
        // a step of the finest scheme on hundreds of triangles at once takes milliseconds, and one rock a thousand of them
        let is_costly = scheme == Scheme::Reference && *radius_m > 1.0;
        let rock = Rock { radius_m: *radius_m, ..ROCK };
        let case = Case { scheme, tolerance_m_s, ground: *ground, rock, ..CASE };
        for k in 0..if is_costly { 3 } else { 8 } {
            let x = 0.013 * f64::from(k) - 0.05;
            let start = [[x, 0.03, 1.05 * radius_m + 0.05], [0.1, 0.05, -8.0], [0.0; 3]];
            see(&format!("{scheme:?}, {name}, {k}"), &case.run(site, start, 2.0));
        }
    }
}

/// Without dashpots and friction nothing is taken: `damping_j` is 0 to rounding, however often patches have met and parted.
#[test]
fn dashpots_that_are_not_there_take_nothing() {
    let ground = Ground { restitution: Some(1.0), friction_angle_rad: 0.0, ..GROUND };
    for scheme in [Scheme::Adaptive, Scheme::Reference] {
        let (mut damping, mut remainder) = (0.0f64, 0.0f64);
        journeys(&ground, scheme, &mut |_, run| {
            let share = |joule: f64| joule.abs() / run.extremes.total_j;
            damping = damping.max(share(run.ledger.damping_j));
            remainder = remainder.max(share(run.ledger.remainder_j));
        });
        println!("{scheme:?}: damping {damping:e}, remainder {remainder:e}");
        assert!(damping < 1e-12 && remainder < 1e-12, "{scheme:?}: {damping:e} {remainder:e}");
    }
}

/// Energy at the end (J) besides height: of motion.
fn motion_j(run: &Trajectory) -> f64 {
    run.end.translational_j(&run.rock) + run.end.rotational_j(&run.rock)
}

fn booked_j(row: &Ledger) -> f64 {
    row.friction_j + row.damping_j + row.rolling_j + row.trees_j + row.springs_j + row.remainder_j
}

/// With friction and with dashpots: no entry is negative, all add up to what the rock lost, and gains of the steps, counted apart from their
/// losses, are small.
#[test]
fn entries_are_losses_and_add_up() {
    for (restitution, rolling_friction) in [(1.0, 0.0), (0.5, 0.0), (0.5, 0.3)] {
        let ground = Ground { restitution: Some(restitution), rolling_friction, ..GROUND };
        let (mut gained, mut lost, mut all) = (0.0, 0.0, 0.0);
        journeys(&ground, Scheme::Adaptive, &mut |name, run| {
            let (row, scale) = (&run.ledger, run.extremes.total_j);
            for entry in [row.friction_j, row.damping_j, row.rolling_j] {
                assert!(entry >= -1e-9 * scale, "e {restitution}, {name}: {row:?}");
            }
            let off = run.released_j - motion_j(run) - booked_j(row);
            assert!(off.abs() < 1e-9 * scale, "e {restitution}, {name}: {off} J, {row:?}");
            *(if row.remainder_j < 0.0 { &mut gained } else { &mut lost }) += row.remainder_j;
            all += scale;
        });
        println!("e {restitution}, rolling {rolling_friction}: {gained:e} {lost:e} of {all:e} J");
        assert!(-gained < 1e-4 * all && lost < 2e-3 * all, "e {restitution}: {gained} {lost}");
    }
}

/// The row of a rock whose time is up in the middle of an impact says what its springs hold then.
#[test]
fn what_springs_hold_when_time_is_up_is_in_the_row() {
    let site = noisy(0.1, 40, 0.001);
    for (scheme, tolerance_m_s) in
        [(Scheme::Adaptive, 0.05), (Scheme::Reference, 1e-8), (Scheme::Dda, 0.0)]
    {
        let omega = (GROUND.normal_stiffness_n_m / ROCK.mass_kg()).sqrt();
        let case = Case { scheme, tolerance_m_s, ..CASE };
        let start = [[0.02, 0.03, 0.502], [0.0, 0.0, -8.0], [0.0; 3]];
        let run = case.run(&site, start, 2e-3 / 8.0 + 0.3 * PI / omega);
        let (row, scale) = (&run.ledger, run.extremes.total_j);
        let off = run.released_j - motion_j(&run) - booked_j(row);
        println!("{scheme:?}: {off:e} of {scale:e} J, {row:?}");
        assert!(row.springs_j > 0.1 * scale, "{scheme:?}: {row:?}");
        assert!(off.abs() < 1e-9 * scale, "{scheme:?}: {off} J, {row:?}");
    }
}

/// An impact that hardly rebounds is over, by its time, while its spring still gives back against the dashpot: its row says what has been
/// lost by then, neither more nor less.
#[test]
fn the_row_of_an_impact_leaves_out_what_its_spring_still_holds() {
    let site = noisy(0.1, 40, 0.0);
    for restitution in [0.0, 0.01, 0.1] {
        let ground = Ground { restitution: Some(restitution), friction_angle_rad: 0.0, ..GROUND };
        let omega = (GROUND.normal_stiffness_n_m / ROCK.mass_kg()).sqrt();
        let start = [[0.02, 0.03, 0.5], [0.0, 0.0, -8.0], [0.0; 3]];
        let run = Case { ground, ..CASE }.run(&site, start, 3.0 * PI / omega * (1.0 + 1e-6));
        let (row, scale) = (&run.ledger, run.extremes.total_j);
        let lost = row.friction_j + row.damping_j + row.rolling_j;
        let off = run.impacts[0].energy_lost_j - lost;
        println!("e {restitution}: {off:e} of {scale:e} J, {row:?}");
        assert!(off.abs() < 1e-6 * scale, "e {restitution}: {off} of {scale} J, {row:?}");
    }
}

/// Where a contact begins or ends its dashpot and the others' share of it jump, and a step ends there: it does not feel its way to the place.
/// Impacts beside the bottom of valleys with restitution 0.5 and friction, and what both schemes make of them.
#[test]
fn contacts_that_come_and_go_cost_few_tries() {
    let ground = Ground { restitution: Some(0.5), ..GROUND };
    let (mut steps, mut rejected, mut apart) = (0, 0, 0.0f64);
    for angle in [0.2, 0.4, 0.6] {
        let valley = fold(angle);
        for k in 0..24 {
            let x = (0.02 * f64::from(k) - 0.23) * angle;
            let z = ROCK.radius_m / (0.5 * angle).cos() + x.abs() * (0.5 * angle).tan() + 1e-3;
            let start = [[x, 0.1, z], [1.0, 0.3, -5.0], [0.0; 3]];
            let run = |scheme, tolerance_m_s| {
                let capture_speed_m_s = Some(0.0);
                let case = Case { scheme, tolerance_m_s, ground, capture_speed_m_s, ..CASE };
                case.run(&valley, start, 0.03)
            };
            let (usual, exact) = (run(Scheme::Adaptive, 0.05), run(Scheme::Reference, 1e-8));
            steps += usual.effort.steps;
            rejected += usual.effort.rejected;
            let off = usual.end.velocity_m_s - exact.end.velocity_m_s;
            apart = apart.max(off.norm() / 5.0);
        }
    }
    println!("{steps} steps, {rejected} thrown away, off by {apart:e} at most");
    // felt for by shorter and shorter steps it is two for three steps, and 1.1e-3
    assert!(100 * rejected < 58 * steps, "{rejected} of {steps}");
    assert!(apart < 7e-4, "{apart:e}");
}

/// A rock that strikes ground and stem at the same time: the row of the stem has what the stem took, no more than breaks it, and that of
/// the ground the rest. Shared by the squares of their approach speeds each row had half of both.
#[test]
fn the_row_of_a_stem_is_what_the_stem_took() {
    let limit_j = 0.02 * ROCK.mass_kg() * 100.0;
    let ground_m = -3.0;
    let terrain = stand_on(ground_m, 1, Some(limit_j));
    let start = Vec3::new(-3.5 - ROCK.radius_m, 0.0, ground_m + ROCK.radius_m + 3.0);
    for scheme in [Scheme::Adaptive, Scheme::Reference, Scheme::Dda, Scheme::Rigid] {
        let way = [start, Vec3::new(10.0, 0.0, -10.0)];
        let run = shoot_from(&terrain, scheme, way, &mut Scratch::default());
        let ledger = &run.ledger;
        let ground_j = ledger.friction_j + ledger.damping_j + ledger.rolling_j;
        let of = |is_tree: bool| -> f64 {
            let rows = run.impacts.iter().filter(|row| (row.sheet == 1) == is_tree);
            rows.map(|row| row.energy_lost_j).sum()
        };
        println!("{scheme:?}: {} and {} J, {ledger:?}", of(true), of(false));
        assert!((ledger.trees_j - limit_j).abs() < 1e-9 * limit_j, "{scheme:?}: {ledger:?}");
        assert!(ground_j > 2.0 * limit_j, "{scheme:?}: {ledger:?}");
        assert!((of(true) / limit_j - 1.0).abs() < 1e-9, "{scheme:?}: {} of {limit_j} J", of(true));
        assert!(of(false) <= ground_j * (1.0 + 1e-9), "{scheme:?}: {} {ground_j}", of(false));
        assert!(of(false) > 0.5 * ground_j, "{scheme:?}: {} {ground_j}", of(false));
    }
}

/// A rock that strikes both sides of a right-angled groove at once, one twice as fast as the other: each side takes `(1 − e²) m u²/2` of its
/// own speed `u`, so their rows stand four to one.
#[test]
fn rows_of_a_groove_share_by_the_squares_of_the_speeds() {
    let groove = fold(FRAC_PI_2);
    let ground = Ground { restitution: Some(0.5), friction_angle_rad: 0.0, ..GROUND };
    let (fast, slow, r) = (8.0, 4.0, ROCK.radius_m);
    // normals (±1, 0, 1)/√2 from the sides into the rock
    let v = [(slow - fast) * FRAC_1_SQRT_2, 0.0, -(fast + slow) * FRAC_1_SQRT_2];
    let before_s = 1e-3;
    let start = [-v[0] * before_s, 0.1, r / FRAC_1_SQRT_2 - v[2] * before_s];
    for (scheme, tolerance_m_s) in [
        (Scheme::Adaptive, 1e-3),
        (Scheme::Reference, 1e-8),
        (Scheme::Dda, 0.0),
        (Scheme::Rigid, 0.0),
    ] {
        let case = Case { scheme, tolerance_m_s, ground, ..CASE };
        let run = case.run(&groove, [start, v, [0.0; 3]], 0.02);
        let mut rows: Vec<f64> = run.impacts.iter().map(|row| row.energy_lost_j).collect();
        rows.sort_by(f64::total_cmp);
        println!("{scheme:?}: {rows:?}");
        let exact = [slow, fast].map(|u| 0.5 * ROCK.mass_kg() * u * u * 0.75);
        assert_eq!(rows.len(), 2, "{scheme:?}: {rows:?}");
        for (found, exact) in rows.iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 0.02, "{scheme:?}: {found} for {exact} J");
        }
    }
}

//! Scheme `dda`: no step of any length adds energy.

use crate::common;

use common::episode::Episode;
use common::{CASE, Case, G, terrain};
use rockfall::flight::{FlightEnd, Parabola, time_of_impact};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::solver::Scheme;
use rockfall::solver::contact_state::{ContactEnvironment, ContactState};
use rockfall::terrain::grid::triangulate;
use rockfall::terrain::stl::Facet;
use rockfall::terrain::{Terrain, make};

/// Stiff, so that no rock gets in deep enough for the exception below.
const STIFF: Ground =
    Ground { normal_stiffness_n_m: 1e11, shear_stiffness_n_m: 0.25e11, ..common::GROUND };
const BARE: Ground = Ground { restitution: None, ..STIFF };
const DDA: Case = Case { scheme: Scheme::Dda, ground: BARE, ..CASE };

/// No step of any length adds energy, springs included: on a plane, over an edge, into a fold, settled or not.
///
/// A rock already pressed in by more than `R δ²/2` that comes over a fold of angle δ is excepted: the other flank's
/// spring is there at once, in the law itself.
#[test]
fn no_step_adds_energy() {
    let grounds = [
        BARE,
        STIFF,
        Ground { rolling_friction: 0.4, ..STIFF },
        Ground { friction_angle_rad: 0.0, ..BARE },
        Ground { friction_angle_rad: 1.4, rolling_friction: 0.1, ..BARE },
    ];
    let mut steps = 0u64;
    for facets in [
        make::jittered_plane(4.0, 8, 0.6),
        make::ridge(4.0, 0.5),
        make::v_groove(4.0, 0.7),
        make::stairs(8, 0.5, 0.6, 2.0),
        make::tetrahedron(1.5),
        rough_slope(),
    ] {
        let terrain = terrain(facets);
        for ground in grounds {
            for step_s in [1e-5, 1e-4, 1e-3, 1e-2] {
                for shear_memory in [true, false] {
                    steps += observe(&terrain, &Case { step_s, shear_memory, ground, ..DDA });
                }
            }
        }
    }
    assert!(steps > 100_000, "{steps}");
}

/// Flights and contacts of one rock.
const IMPACTS: u32 = 12;

/// A slope of 20° with waves of 1 m and 5 cm, in triangles of half a rock: two or three contacts at a time.
fn rough_slope() -> Vec<Facet> {
    triangulate(41, 41, |i, j| {
        let (x, y) = (0.25 * (i as f64 - 20.0), 0.25 * (j as f64 - 20.0));
        let waves = (6.3 * x + 1.7 * y).sin() + (5.1 * y - 2.3 * x).sin();
        Some(Vec3::new(x, y, 0.05 * waves - 0.36 * y))
    })
}

/// Throws rocks at the terrain and follows them over some impacts; every step's energy, springs included, against the
/// one before.
fn observe(terrain: &Terrain, case: &Case) -> u64 {
    let episode = Episode::new(terrain, case, G);
    let mut steps = 0;
    for k in 0..8u32 {
        let (s, c) = (2.4 * f64::from(k)).sin_cos();
        let mut start = Vec3::new(0.3 * c, 0.3 * s + 0.2, 2.0);
        let mut velocity = Vec3::new(2.0 * s, 3.0 + 3.0 * c, -2.0);
        let mut spin = [4.0 * c, 4.0 * s, 1.0];
        for _ in 0..IMPACTS {
            let local = start - terrain.origin_m;
            let flight =
                Parabola { start: local, velocity, gravity: G, radius: case.rock.radius_m };
            let FlightEnd::Touch(t) = time_of_impact(terrain, &flight, 9.0, &mut 0) else { break };
            let touch = flight.centre(t) + terrain.origin_m;
            let mut before = f64::INFINITY;
            let at_touch = [touch.into(), flight.velocity(t).into(), spin];
            let grip = episode.run(at_touch, 300, |world, grip| {
                steps += 1;
                let energy = total_j(world, grip);
                // rounding of coordinates of 1 m in springs of 1e11 N/m
                assert!(energy < before + 1e-5, "rock {k}, {case:?}: {before} -> {energy}");
                before = energy;
            });
            (start, velocity, spin) = (grip.c + terrain.origin_m, grip.v, grip.w.into());
        }
    }
    steps
}

/// Energy of motion, height and springs (J).
fn total_j(world: &ContactEnvironment, grip: &ContactState) -> f64 {
    let weight = world.body.mass * world.body.gravity.dot(&grip.c);
    grip.motion_j(&world.body) - weight + grip.stored_j(world).sum()
}

/// Rolling at speed into a shallow fold, the rock is inside the other flank before that was a contact: the step is
/// solved again with it, else its spring would throw the rock out with energy that nobody paid.
#[test]
fn a_fold_met_within_a_step_is_paid_for() {
    let fold = terrain(make::v_groove(4.0, 0.03));
    let (s, c) = 0.03f64.sin_cos();
    for ground in [BARE, STIFF] {
        for step_s in [2e-3, 5e-3, 1e-2] {
            let case = Case { step_s, ground, ..DDA };
            for k in 0..10 {
                let x = -0.3 - 0.01 * f64::from(k);
                let height = (0.5 - s * x) / c;
                let start = [[x, 0.3, height], [4.0 * c, 0.0, -4.0 * s], [0.0, 8.0, 0.0]];
                let mut before = f64::INFINITY;
                Episode::new(&fold, &case, G).run(start, 100, |world, grip| {
                    let energy = total_j(world, grip);
                    assert!(energy < before + 1e-5, "{x}, {case:?}: {before} -> {energy}");
                    before = energy;
                });
            }
        }
    }
}

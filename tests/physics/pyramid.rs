//! Four spheres, three on the ground and one on top: the smallest heap, with an exact answer to whether it stands.
//!
//! The lower spheres do not press on each other. Each is pushed by the upper one along the line of centres, at `sin θ = 1/√3`
//! to the vertical, and nothing turns it: friction at the top and at the ground are equal, and horizontal balance gives
//! `q = N tan(θ/2)`. Below `μ = tan(θ/2) = 0.3178` there is no balance, whatever the stiffness; rolling is free.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that has no rock has failed, and says what it saw"
)]

use crate::common;

use common::G;
use common::together::{Sphere, WORLD, World, energy_j, plane};
use rockfall::ground::Ground;
use rockfall::simulation::{Stop, Trajectory};
use rockfall::solver::Scheme;

fn pyramid(r: f64) -> Vec<Sphere> {
    let aside = 2.0 * r / 3.0f64.sqrt();
    let still = |c: [f64; 3]| (r, 2700.0, c, [0.0; 3], [0.0; 3]);
    let mut spheres: Vec<Sphere> = (0..3)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 3.0).sin_cos();
            still([aside * cos, aside * sin, r])
        })
        .collect();
    spheres.push(still([0.0, 0.0, r + 2.0 * r * (2.0f64 / 3.0).sqrt()]));
    spheres
}

/// The friction coefficient that it needs.
fn needed() -> f64 {
    (0.5 * (1.0 / 3.0f64.sqrt()).asin()).tan()
}

fn with_friction(world: World, mu: f64) -> World {
    let angle = mu.atan();
    let ground = Ground { friction_angle_rad: angle, ..world.ground };
    World { gravity_m_s2: G, friction_angle_rad: angle, ground, ..world }
}

fn sunk_m(falls: &[Trajectory]) -> f64 {
    falls[3].start.position_m.z - falls[3].end.position_m.z
}

const ADAPTIVE: World = World { scheme: Scheme::Adaptive, tolerance_m_s: 0.05, ..WORLD };

/// Defaults first: `rigid` with its step of 10 ms, `adaptive` with its tolerance of 0.05 m/s.
const WORLDS: [World; 5] = [
    WORLD,
    ADAPTIVE,
    World { step_s: 1e-3, ..WORLD },
    World { tolerance_m_s: 1e-3, ..ADAPTIVE },
    World { scheme: Scheme::Reference, tolerance_m_s: 1e-8, ..WORLD },
];

/// Two hundredths below the threshold all lie on the ground after a while, two above all rest where they were.
#[test]
fn a_pyramid_stands_if_friction_holds_it() {
    for world in WORLDS {
        let name = format!("{:?} {} {}", world.scheme, world.step_s, world.tolerance_m_s);
        for r in [0.05, 0.5] {
            let (stands, _) = with_friction(world, 1.02 * needed()).run(&plane(), &pyramid(r), 3.0);
            println!("{name} R {r}: stands, sunk by {:e} m", sunk_m(&stands));
            for fall in &stands {
                assert_eq!(fall.stop, Stop::AtRest, "{name} R {r}");
            }
            assert!(sunk_m(&stands) < 1e-3 * r, "{name} R {r}: sunk by {} m", sunk_m(&stands));
            let (falls, census) =
                with_friction(world, 0.98 * needed()).run(&plane(), &pyramid(r), 3.0);
            println!("{name} R {r}: falls, sunk by {:.4} m, {census:?}", sunk_m(&falls));
            assert!(
                sunk_m(&falls) > 0.5 * r,
                "{name} R {r}: it stands, sunk by {} m",
                sunk_m(&falls)
            );
            assert_eq!(census.unsettled, 0, "{name} R {r}");
        }
    }
}

/// Scheme `dda` has a step of 10 µs, and is followed for less long.
#[test]
fn a_pyramid_of_the_fixed_step_stands_if_friction_holds_it() {
    let world = World { scheme: Scheme::Dda, step_s: 1e-5, ..WORLD };
    let run = |share: f64| {
        let friction = with_friction(world, share * needed());
        sunk_m(&friction.run(&plane(), &pyramid(0.5), 0.4).0)
    };
    let (stands, falls) = (run(1.05), run(0.95));
    println!("sunk by {stands:e} and {falls:e} m");
    assert!(stands < 1e-4 && falls > 2e-3, "{stands} {falls}");
}

/// At no time has it more energy than before, and it does not lean to one side more than a rock's error.
#[test]
fn a_collapsing_pyramid_gains_nothing() {
    let mut before_j = f64::INFINITY;
    for k in 1..=15 {
        let world = with_friction(WORLD, 0.9 * needed());
        let (falls, _) = world.run(&plane(), &pyramid(0.5), 0.2 * f64::from(k));
        let now_j = energy_j(&falls, true, G);
        assert!(now_j <= before_j + 1e-9, "{k}: {now_j} after {before_j} J");
        before_j = now_j;
    }
}

//! Pyramid
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that has no rock has failed")]

mod common;

use common::G;
use common::together::{Sphere, WORLD, World, plane};
use rockfall::step::Scheme;

fn pyramid(r: f64) -> Vec<Sphere> {
    let aside = 2.0 * r / 3.0f64.sqrt();
    let mut spheres: Vec<Sphere> = (0..3)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 3.0).sin_cos();
            (r, 2700.0, [aside * cos, aside * sin, r], [0.0; 3], [0.0; 3])
        })
        .collect();
    spheres.push((r, 2700.0, [0.0, 0.0, r + 2.0 * r * (2.0f64 / 3.0).sqrt()], [0.0; 3], [0.0; 3]));
    spheres
}

#[test]
fn explore() {
    let schemes: Vec<(Scheme, f64, f64)> = vec![
        (Scheme::Rigid, 0.01, 0.0),
        (Scheme::Rigid, 1e-3, 0.0),
        (Scheme::Adaptive, 0.0, 0.05),
        (Scheme::Adaptive, 0.0, 1e-3),
    ];
    for (scheme, step_s, tolerance_m_s) in schemes {
        for mu in [0.28f64, 0.287, 0.30, 0.306, 0.312, 0.316, 0.32, 0.33] {
            let ground = rockfall::ground::Ground { friction_angle_rad: mu.atan(), ..WORLD.ground };
            for longest in [0.3, 3.0] {
                let world = World {
                    gravity_m_s2: G,
                    ground,
                    friction_angle_rad: mu.atan(),
                    step_s,
                    scheme,
                    tolerance_m_s,
                    ..WORLD
                };
                let (falls, census) = world.run(&plane(), &pyramid(0.5), longest);
                let top = &falls[3];
                println!(
                    "{scheme:?} {step_s} {tolerance_m_s} mu {mu} t {longest}: dz {:.6} vz {:.6} {:?} end {:.3} returns {} uns {} sweeps {} steps {}",
                    top.end.position_m.z - top.start.position_m.z,
                    top.end.velocity_m_s.z,
                    top.stop,
                    top.end.time_s,
                    census.returns,
                    census.unsettled,
                    census.sweeps,
                    census.steps
                );
            }
        }
    }
}

//! Very stiff springs under a rock that rolls on two contacts.

use crate::common::*;
use rockfall::ground::Ground;
use rockfall::rock::{Rock, Vec3};
use rockfall::solver::Scheme;
use rockfall::terrain::Terrain;

/// A groove along y with sides of 27°, which falls by 25° over 15 m.
fn groove() -> Terrain {
    let fall = 25f64.to_radians().tan();
    let at = |[x, y]: [f64; 2]| Vec3::new(x, y, 0.5 * x.abs() - fall * y);
    let side = |x: f64| {
        let [a, b, c, d] = [[0.0, 0.0], [0.0, 15.0], [x, 15.0], [x, 0.0]].map(|[x, y]| at([x, y]));
        let [first, second] = [[a, b, c], [a, c, d]];
        if x < 0.0 {
            vec![first, second]
        } else {
            [first, second].map(|[a, b, c]| [a, c, b]).into()
        }
    };
    terrain([side(-4.0), side(4.0)].concat())
}

/// A rock that sticks to both sides of a groove takes no more steps on springs a hundred thousand times as stiff.
///
/// Forces found from velocities were known no better than the rounding of these times stiffness, and sweeps between two contacts that stick
/// never agreed on them: every other step was refused: 147 000 tries for the smallest rock.
#[test]
fn stiff_springs_of_two_contacts_take_no_more_steps() {
    let groove = groove();
    let most = |stiffness_n_m: f64, radius_m: f64, friction_deg: f64| {
        let ground = Ground {
            normal_stiffness_n_m: stiffness_n_m,
            shear_stiffness_n_m: 0.25 * stiffness_n_m,
            friction_angle_rad: f64::to_radians(friction_deg),
            restitution: Some(0.0),
            ..GROUND
        };
        let rock = Rock { radius_m, ..ROCK };
        let case = Case { scheme: Scheme::Adaptive, tolerance_m_s: 0.05, ground, rock, ..CASE };
        let start = [[0.01, 1.0, 1.5 * radius_m - 0.3], [0.05, 0.5, 0.0], [0.0; 3]];
        let run = case.run(&groove, start, 20.0);
        let tried = run.effort.steps + run.effort.rejected;
        println!("{stiffness_n_m:e} N/m, R = {radius_m} m, {friction_deg}°: {tried} tries");
        tried
    };
    for radius_m in [0.1, 0.14, 0.2, 0.3] {
        for friction_deg in [80.0, 85.0, 89.0] {
            assert!(most(1e9, radius_m, friction_deg) < 8000);
            assert!(most(1e14, radius_m, friction_deg) < 8000, "{radius_m} m, {friction_deg}°");
        }
    }
}

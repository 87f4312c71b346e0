//! Impacts along one line compared with those in two directions.

use super::{G, case, ground, motion_j, uniforms};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::impact::{BlowTable, Plane, blow_along_a_line};

/// Tolerance that leaves rounding and little more (–).
const FINE: f64 = 1e-10;

/// Impulses over the mass, along the normal and against the slip (m/s), of an impact in two
/// directions. A weight along the surface too small to change any result prevents the integration
/// along a line.
fn in_two_directions(
    (body, law): (&Body, &Law),
    captured: bool,
    [approach, slip]: [f64; 2],
) -> [f64; 2] {
    let along = Vec3::new(0.6, 0.8, 0.0);
    let v = along * slip - Vec3::z() * approach;
    let body = Body { gravity: along * 1e-200, ..*body };
    let plane = Plane::of_patch(&body, law, (captured, 1.0), FINE);
    let Some(out) = plane.follow(&Vec3::z(), &v, &Vec3::zeros()) else { panic!("it stays") };
    let after = out.velocity_m_s;
    let kept = if captured { 0.0 } else { after.z };
    [kept + approach, slip - along.dot(&after)]
}

/// Largest difference of the impulses over the speed (–) from those in two directions, by the
/// tolerance of the blow.
fn difference(tolerance: f64) -> f64 {
    let mut uniform = uniforms(7);
    let mut largest = 0.0f64;
    for k in 0..400 {
        let e = [0.0, 0.2, 0.5, 0.8, 1.0][k % 5];
        let (body, law) = case(&ground(1e7, e, 0.0), 0.1 + uniform(), G);
        let speeds = [0.01 + 5.0 * uniform(), 8.0 * uniform() * uniform()];
        let captured = k % 3 == 0 || law.is_plastic();
        let exact = in_two_directions((&body, &law), captured, speeds);
        let found = blow_along_a_line((&body, &law), captured, speeds, tolerance);
        // the rebound is a closed form
        assert!((found[0] - exact[0]).abs() < 1e-12 * speeds[0], "{found:?} {exact:?}");
        let off = (found[1] - exact[1]).abs() / speeds[0].hypot(speeds[1]);
        largest = largest.max(off);
        // no impact gains energy: the impulses on a rock at rest beside them
        let v = Vec3::new(speeds[1] - found[1], 0.0, found[0] - speeds[0]);
        let w = Vec3::y() * (body.mass * body.radius * found[1] / body.inertia);
        let before = motion_j(&body, &Vec3::new(speeds[1], 0.0, -speeds[0]), &Vec3::zeros());
        assert!(motion_j(&body, &v, &w) <= before * (1.0 + 1e-12));
    }
    largest
}

/// Slip that nothing deflects stays on its line: the same impulses, with a third of the variables.
/// Both err by their tolerance: at that of impacts in a large island (1e-3) by 3.7e-4 of the speed,
/// a thirtieth or less of the error allowed to sustained contact, 3e-2 of a rock's speed.
#[test]
fn a_blow_along_a_line_is_that_in_two_directions() {
    for (tolerance, allowed) in [(FINE, 1e-8), (1e-3, 1e-3)] {
        let off = difference(tolerance);
        assert!(off < allowed, "{tolerance:e}: {off:e}");
    }
}

/// Spheres of one material rebound by one table, whatever their mass: its friction impulse has a
/// smaller error than an impact integrated to 2e-5 of its speed, the rebound is the closed form,
/// and no impact gains energy. Another material has another table.
#[test]
fn a_table_is_that_of_all_spheres_of_a_material() {
    let mut uniform = uniforms(11);
    let mut largest = 0.0f64;
    for e in [0.2, 0.5, 0.8, 1.0] {
        let ground = ground(1e7, e, 0.0);
        let (body, law) = case(&ground, 0.7, G);
        let table = BlowTable::new(&body, &law).unwrap();
        for _ in 0..200 {
            let (body, law) = case(&ground, 0.1 + uniform(), G);
            let [approach, slip] = [0.01 + 5.0 * uniform(), 8.0 * uniform() * uniform()];
            let exact = in_two_directions((&body, &law), false, [approach, slip]);
            let found = table.blow((&body, &law), [approach, slip]).unwrap();
            assert!((found[0] - exact[0]).abs() < 1e-12 * approach, "{found:?} {exact:?}");
            largest = largest.max((found[1] - exact[1]).abs() / approach.hypot(slip));
            let gone = found[1] * (2.0 * slip - 3.5 * found[1]);
            assert!(gone >= -1e-12 * slip * slip, "{e} {approach} {slip}: {gone:e}");
        }
        let (body, law) = case(&super::ground(1e7, 0.9 * e, 0.0), 0.7, G);
        assert_eq!(table.blow((&body, &law), [1.0, 1.0]), None);
    }
    assert!(largest < 2e-5, "{largest:e}");
}

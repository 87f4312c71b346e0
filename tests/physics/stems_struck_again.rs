//! Stems that have taken a part of one blow and take a part of another, and what blocks on springs put into a stem.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::stem_loads::{SCHEMES, falls_among, panel, shot, shot_j, weak};
use rockfall::simulation::Trajectory;
use rockfall::terrain::stl::Facet;
use std::f64::consts::FRAC_1_SQRT_2;

/// The shape of a cube.
const CUBE: &str =
    "[[rocks.shapes]]\nkind = \"box\"\ncorner_radius = 0.1\naxes = [1.0, 1.0, 1.0]\n";

/// Two stems at a right angle to each other, that a rock on the diagonal strikes at once, each with half of its energy. The strong one has a
/// second side, parallel to the weak stem and a quarter of a metre behind it.
fn corner_of_stems() -> [Vec<Facet>; 2] {
    let wall = |[a, b]: [[f64; 2]; 2]| {
        let at = |[x, y]: [f64; 2], z: f64| [x, y, z];
        panel([at(a, 0.5), at(b, 0.5), at(b, 9.0), at(a, 9.0)])
    };
    let sides = [[[2.0, 0.0], [10.25, 0.0]], [[10.25, 0.0], [10.25, -8.0]]];
    [wall([[10.0, -0.015_625], [10.0, -8.0]]), sides.map(wall).concat()]
}

/// A rock comes at 10 m/s into a corner of two stems without friction, of limits 0.1 and `strong` of its energy.
fn into_corner(scheme: &str, block: &str, strong: f64) -> Trajectory {
    let [weaker, stronger] = corner_of_stems();
    let (breaks, stands) = (weak(0.1, 0.2), weak(strong, 0.2));
    let way = format!("velocity_m_s = [{along}, {along}, 0.0]", along = 10.0 * FRAC_1_SQRT_2);
    let shot = shot(scheme, block)
        .replace("velocity_m_s = [10.0, 0.0, 0.0]", &way)
        .replace("[6.0, 0.0, 6.0]", "[7.5, -2.5, 6.0]");
    let even = "orientation = [1.0, 0.0, 0.0, 0.0]\npoints_m";
    let shot = if block.is_empty() { shot } else { shot.replace("points_m", even) };
    falls_among(&[(&weaker, &breaks), (&stronger, &stands)], &shot).remove(0)
}

/// A rock strikes two stems at once. The weak one breaks at 0.1 of its energy, when the other has taken as much; of the 0.8 that are left the half
/// across goes into that one too, which has then taken 0.5 but for the rebound, and stands with a limit of 0.6. The half along it, 0.4,
/// goes against its other side: more than it has left. So it breaks, both have taken 0.7, and the rock goes on with 0.3.
fn assert_both_break(schemes: &[&str], block: &str) {
    for scheme in schemes {
        // e² of each half comes back
        let stands = into_corner(scheme, block, 10.0);
        let (taken, v) = (stands.ledger.trees_j / shot_j(), stands.end.velocity_m_s);
        assert!((taken - 0.1 - 0.9 * 0.96).abs() < 0.02 && v.x < 0.0, "{scheme}: {taken} {v:?}");
        let falls = into_corner(scheme, block, 0.6);
        let (taken, v) = (falls.ledger.trees_j / shot_j(), falls.end.velocity_m_s);
        assert!((taken - 0.7).abs() < 1e-5, "{scheme}: {taken}");
        assert!(
            v.x > 0.0 && (v.xy().norm() - 10.0 * 0.3_f64.sqrt()).abs() < 0.1,
            "{scheme}: {v:?}"
        );
    }
}

/// What a sphere has put into a stem while it broke another counts in the next blow.
#[test]
fn a_stem_remembers_its_part_of_a_blow_in_which_another_broke() {
    assert_both_break(&SCHEMES, "");
}

/// The same of a cube that strikes each side flat.
#[test]
fn a_stem_remembers_its_part_of_the_blow_of_a_block() {
    assert_both_break(&SCHEMES, CUBE);
}

/// A cube comes against a wall of one stem nearly flat: the corners of one edge press already when those of the other edge come, within the same blow.
/// Whatever springs had taken in the step in which the stem broke, no more than its limit is booked.
#[test]
fn a_stem_that_springs_of_a_block_break_has_taken_its_limit() {
    let fence = panel([[10., -5., 0.5], [10., 5., 0.5], [10., 5., 9.], [10., -5., 9.]]);
    for scheme in ["adaptive", "reference", "dda"] {
        let mut most = 0.0_f64;
        for k in 0..24 {
            let half = (0.025 * f64::from(k)).to_radians() * 0.5;
            let turned =
                format!("orientation = [{}, 0.0, 0.0, {}]\npoints_m", half.cos(), half.sin());
            let shot = shot(scheme, CUBE).replace("points_m", &turned);
            let fall = falls_among(&[(&fence, &weak(0.6, 0.2))], &shot).remove(0);
            let taken = fall.ledger.trees_j / shot_j() / 0.6;
            assert!(taken < 1.0 + 1e-6, "{scheme} {k}: {taken} of the limit");
            let goes_on = fall.end.velocity_m_s.x > 0.0;
            assert!(!goes_on || taken > 1.0 - 1e-6, "{scheme} {k}: {taken} of the limit");
            most = most.max(taken);
        }
        assert!(most > 1.0 - 1e-6, "{scheme}: none breaks, {most}");
    }
}

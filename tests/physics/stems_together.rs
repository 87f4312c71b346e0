//! Several stems that are struck at once: each takes what goes into its own contacts, however stiff it is and whenever it is met.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::stem_loads::{falls_among, panel, shot, shot_j, weak};
use rockfall::simulation::Trajectory;

/// A rock comes with two speeds (m/s) into a corner of two stems without friction, and meets the one across y when it is `later_m` before the one across x. The
/// stems break at shares of the rock's energy at 10 m/s; the second is softer by a factor. They give back 0.2 of the speed.
fn into_corner(
    scheme: &str,
    speeds_m_s: [f64; 2],
    later_m: f64,
    (limits, softer): ([f64; 2], f64),
) -> Trajectory {
    let wall = |[a, b]: [[f64; 2]; 2]| {
        let at = |[x, y]: [f64; 2], z: f64| [x, y, z];
        panel([at(a, 0.5), at(b, 0.5), at(b, 9.0), at(a, 9.0)])
    };
    let across_x = wall([[10.0, -0.015_625], [10.0, -8.0]]);
    let across_y = wall([[2.0, 0.0], [9.984_375, 0.0]]);
    let soft = format!(
        "normal_stiffness_n_m = {:e}\nshear_stiffness_n_m = {:e}\n{}",
        1e10 / softer,
        0.25e10 / softer,
        weak(limits[1], 0.2)
    );
    // a fifth of a second before
    let [x, y] = [9.6 - 0.2 * speeds_m_s[0] - later_m, -0.4 - 0.2 * speeds_m_s[1]];
    let shot = shot(scheme, "")
        .replace("[10.0, 0.0, 0.0]", &format!("[{}, {}, 0.0]", speeds_m_s[0], speeds_m_s[1]))
        .replace("[6.0, 0.0, 6.0]", &format!("[{x}, {y}, 6.0]"));
    falls_among(&[(&across_x, &weak(limits[0], 0.2)), (&across_y, &soft)], &shot).remove(0)
}

/// Speeds (m/s) after stems without friction have taken these shares of the energy at 10 m/s.
fn left_m_s(speed_m_s: f64, taken: f64) -> f64 {
    (speed_m_s * speed_m_s - 100.0 * taken).sqrt()
}

/// Each of two unlike stems takes its limit of the half of the energy that goes against it: stiffness is no matter.
#[test]
fn unlike_stems_each_take_their_own_part() {
    let speed_m_s = 10.0 * 0.5_f64.sqrt();
    for scheme in ["adaptive", "reference", "rigid"] {
        for softer in [1.0, 2.0, 10.0, 100.0] {
            let limits = [0.4, 0.4];
            let fall = into_corner(scheme, [speed_m_s; 2], 0.0, (limits, softer));
            let (v, exact) = (fall.end.velocity_m_s, left_m_s(speed_m_s, 0.4));
            let off = (v.x - exact).abs().max((v.y - exact).abs());
            assert!(off < 0.25, "{scheme}, {softer} times softer: {v:?} for {exact}");
        }
    }
}

/// A stem that bears the blow against it stands, whatever another takes at the same time: none that nothing breaks is broken by how energy is shared.
#[test]
fn a_stem_that_bears_its_own_blow_stands_beside_another() {
    let speed_m_s = 10.0 * 0.5_f64.sqrt();
    for scheme in ["adaptive", "reference", "rigid"] {
        for later_m in [0.0, 0.002, 0.01, 0.02] {
            let limits = [0.55, 0.55];
            let fall = into_corner(scheme, [speed_m_s; 2], later_m, (limits, 1.0));
            let v = fall.end.velocity_m_s;
            let off = (v.x + 0.2 * speed_m_s).abs().max((v.y + 0.2 * speed_m_s).abs());
            assert!(off < 0.03, "{scheme}, {later_m} m: {v:?}");
        }
    }
}

/// A stem that is grazed while another takes the blow has taken next to nothing, and stands.
#[test]
fn a_grazed_stem_stands() {
    for scheme in ["adaptive", "reference", "rigid"] {
        let fall = into_corner(scheme, [10.0, 1.0], 0.0, ([10.0, 0.02], 1.0));
        let v = fall.end.velocity_m_s;
        assert!((v.x + 2.0).abs() < 0.02 && (v.y + 0.2).abs() < 0.01, "{scheme}: {v:?}");
    }
}

/// Stems that stand close behind each other and break within a millisecond are struck one after the other: an impact and a row each, with
/// what each has taken.
#[test]
fn stems_broken_within_a_millisecond_are_an_impact_each() {
    // not on one axis: those would be pieces of one stem
    let wall = |x: f64, [from, to]: [f64; 2]| {
        panel([[x, from, 0.5], [x, to, 0.5], [x, to, 9.0], [x, from, 9.0]])
    };
    let walls = [wall(10.0, [-2.0, 2.0]), wall(10.003, [-1.9, 2.1])].concat();
    for scheme in ["adaptive", "reference", "rigid"] {
        let shot = shot(scheme, "[record]\nimpacts = true\n");
        let fall = falls_among(&[(&walls, &weak(0.1, 0.2))], &shot).remove(0);
        let on_stems: Vec<f64> =
            fall.impacts.iter().filter(|one| one.sheet == 1).map(|one| one.energy_lost_j).collect();
        assert_eq!((fall.tree_impact_count, on_stems.len()), (2, 2), "{scheme}: {on_stems:?}");
        let (taken_j, exact_j) = (on_stems.iter().sum::<f64>(), 0.2 * shot_j());
        assert!((taken_j / exact_j - 1.0).abs() < 1e-3, "{scheme}: {on_stems:?}");
    }
}

//! Restitution that falls with the speed of an impact is that of each impact by itself, also where another begins while it lasts.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;
use crate::stem_loads::panel;
use rockfall::terrain::stl::write_binary;

/// Two walls without friction, of one ground or of two that are alike, are struck one `later_m` after the other: each throws back by its own speed,
/// `e/(1 + (v/v_half)²)`.
#[test]
fn an_impact_keeps_its_own_restitution_while_another_begins() {
    let of_speed = |speed_m_s: f64| 0.8 / (1.0 + (speed_m_s / 5.0).powi(2)) * speed_m_s;
    for scheme in ["adaptive", "reference", "rigid"] {
        for ([along, across], later_m) in
            [([10.0, 1.0], 5e-4), ([10.0, 2.0], 2e-3), ([1.0, 10.0], 5e-3)]
        {
            for grounds in ["wall", "other"] {
                let dir = tempfile::tempdir().unwrap();
                let floor = [[-60., -60., 0.], [60., -60., 0.], [60., 60., 0.], [-60., 60., 0.]];
                for (name, corners) in [
                    ("floor", floor),
                    ("x", [[10., -9., 0.5], [10., 2., 0.5], [10., 2., 9.], [10., -9., 9.]]),
                    ("y", [[12., 0., 0.5], [-9., 0., 0.5], [-9., 0., 9.], [12., 0., 9.]]),
                ] {
                    let file = dir.path().join(format!("{name}.stl"));
                    write_binary(&file, &panel(corners)).unwrap();
                }
                let mesh = |name: &str, ground: &str| {
                    format!("[[terrain]]\nmesh = \"{name}.stl\"\nground = \"{ground}\"\n")
                };
                let ground = |name: &str| {
                    format!(
                        "[grounds.{name}]\nnormal_stiffness_n_m = 1e9\nshear_stiffness_n_m = 2.5e8\n\
                         friction_angle_deg = 0.0\nrestitution = 0.8\nrestitution_half_speed_m_s = 5.0\n"
                    )
                };
                let other = if grounds == "other" { ground("other") } else { String::new() };
                // the wall across x is met after the one across y
                let [x, y] = [9.6 - 0.2 * along - later_m, -0.4 - 0.2 * across];
                let text = format!(
                    "title = \"t\"\nseed = 1\n{}{}{}{}{other}[rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.4\n\
                     [release]\ncount = 1\nvelocity_m_s = [{along}, {across}, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
                     points_m = [[{x}, {y}, 6.0]]\n[solver]\nscheme = \"{scheme}\"\nlongest_s = 0.4\n",
                    mesh("floor", "wall"),
                    mesh("x", "wall"),
                    mesh("y", grounds),
                    ground("wall"),
                );
                let end = common::falls(&common::plan_in(dir.path(), &text))[0].end.velocity_m_s;
                let off = (end.x + of_speed(along)).abs().max((end.y + of_speed(across)).abs());
                assert!(off < 0.02, "{scheme} {along} {across} {grounds}: {end:?}");
            }
        }
    }
}

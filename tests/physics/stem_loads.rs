//! What stems have taken so far counts in every scheme, also where a rock comes and goes within one step.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;
use rockfall::rock::Vec3;
use rockfall::simulation::Trajectory;
use rockfall::terrain::make::{Stem, stem};
use rockfall::terrain::stl::{Facet, write_binary};
use std::f64::consts::PI;

/// Two triangles between four corners (m).
fn panel(corners: [[f64; 3]; 4]) -> Vec<Facet> {
    let [a, b, c, d] = corners.map(Vec3::from);
    vec![[a, b, c], [a, c, d]]
}

/// Rocks of 0.4 m and density 2700 kg/m³ on level ground with trees of these facets; `more` ends the scene.
fn falls(trees: &[Facet], trunk: &str, more: &str) -> Vec<Trajectory> {
    let dir = tempfile::tempdir().unwrap();
    let ground = panel([[-60., -60., 0.], [60., -60., 0.], [60., 60., 0.], [-60., 60., 0.]]);
    write_binary(&dir.path().join("ground.stl"), &ground).unwrap();
    write_binary(&dir.path().join("trees.stl"), trees).unwrap();
    let text = format!(
        "title = \"t\"\nseed = 1\n[[terrain]]\nmesh = \"ground.stl\"\nground = \"rock\"\n[[trees]]\nmesh = \"trees.stl\"\n\
         ground = \"trunk\"\n[grounds.rock]\nnormal_stiffness_n_m = 1e10\nshear_stiffness_n_m = 0.25e10\n\
         friction_angle_deg = 30.0\nrestitution = 0.4\n[grounds.trunk]\nnormal_stiffness_n_m = 1e10\n\
         shear_stiffness_n_m = 0.25e10\n{trunk}\n[rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.4\n{more}"
    );
    common::falls(&common::plan_in(dir.path(), &text))
}

/// `m v²/2` at 10 m/s (J).
fn shot_j() -> f64 {
    0.5 * 2700.0 * 4.0 / 3.0 * PI * 0.4_f64.powi(3) * 100.0
}

const SCHEMES: [&str; 4] = ["adaptive", "reference", "dda", "rigid"];

fn solver(scheme: &str) -> String {
    let step = if scheme == "dda" { "step_s = 1e-5" } else { "" };
    format!("[solver]\nscheme = \"{scheme}\"\nlongest_s = 2.0\n{step}\n")
}

/// Two walls of one stem at a right angle. A rock glances off the first, which takes some 0.23 of its energy and has 0.25 at most, and strikes the
/// second with 0.73: each alone stands below a limit of 0.85, both together do not.
#[test]
fn what_an_earlier_blow_took_counts() {
    let mut walls = panel([[10., -9., 0.5], [10., 8., 0.5], [10., 8., 9.], [10., -9., 9.]]);
    walls.extend(panel([[10., 8., 0.5], [-9., 8., 0.5], [-9., 8., 9.], [10., 8., 9.]]));
    let limit_j = 0.85 * shot_j();
    for scheme in SCHEMES {
        let trunk = |limit_j: f64| {
            format!("friction_angle_deg = 1.0\nrestitution = 0.3\nbreaks_above_j = {limit_j}")
        };
        let more = format!(
            "[release]\ncount = 1\nvelocity_m_s = [5.0, 8.660254, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
             points_m = [[6.0, 0.0, 6.0]]\n{}",
            solver(scheme)
        );
        let stands = &falls(&walls, &trunk(1.5 * shot_j()), &more)[0];
        assert!(stands.end.position_m.y < 8.0 && stands.tree_impact_count == 2, "{scheme}");
        let fall = &falls(&walls, &trunk(limit_j), &more)[0];
        assert!((fall.ledger.trees_j / limit_j - 1.0).abs() < 1e-6, "{scheme}: {:?}", fall.ledger);
        assert!(fall.end.velocity_m_s.y > 1.0, "{scheme}: {:?}", fall.end);
    }
}

/// A rock that comes along the ground breaks a stem as one that flies does: one impact, and a row with all that it took.
#[test]
fn a_stem_that_a_rolling_rock_breaks_is_an_impact() {
    let tree = stem(&Stem { x_m: 4.0, y_m: 0.0, dbh_m: 0.6, height_m: 8.0 }, 0.0);
    let trunk = "friction_angle_deg = 30.0\nrestitution = 0.3\nbreaks_above_j = 500.0";
    for scheme in SCHEMES {
        let more = format!(
            "[release]\ncount = 1\nvelocity_m_s = [6.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
             points_m = [[0.0, 0.1, 0.4]]\n[record]\nimpacts = true\n{}",
            solver(scheme)
        );
        let fall = &falls(&tree, trunk, &more)[0];
        assert!((fall.ledger.trees_j - 500.0).abs() < 1e-3, "{scheme}: {:?}", fall.ledger);
        assert_eq!(fall.tree_impact_count, 1, "{scheme}");
        let rows = fall.impacts.iter().filter(|row| row.sheet == 1);
        let taken_j: f64 = rows.map(|row| row.energy_lost_j).sum();
        assert!((taken_j - fall.ledger.trees_j).abs() < 1e-6, "{scheme}: {taken_j}");
    }
}

/// No glancing blow, whose friction goes on taking while the spring pushes out, takes more than the limit; nor do blocks, of
/// which a corner may come and go within one step.
#[test]
fn no_stem_takes_more_than_its_limit() {
    let tree = stem(&Stem { x_m: 3.0, y_m: 0.0, dbh_m: 0.6, height_m: 8.0 }, 0.0);
    let trunk = |limit: &str| {
        format!("friction_angle_deg = 30.0\nrestitution = 0.3\nbreaks_above_j = {limit}")
    };
    let boxes = "[[rocks.shapes]]\nkind = \"box\"\ncorner_radius = 0.15\naxes = [1.0, 0.8, 0.6]\n";
    for (scheme, limit_j, shape) in [
        ("rigid", 5000.0, ""),
        ("adaptive", 5000.0, ""),
        ("rigid", 300.0, boxes),
        ("adaptive", 300.0, boxes),
    ] {
        let beside = |k: u32| format!("[0.0, {}, {}]", 0.004 * f64::from(k) - 0.8, 2.0);
        let points: Vec<String> = (0..400).map(beside).collect();
        let more = format!(
            "{shape}[release]\ncount = 400\nvelocity_m_s = [10.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
             points_m = [{}]\n{}",
            points.join(","),
            solver(scheme)
        );
        let falls = falls(&tree, &trunk(&limit_j.to_string()), &more);
        let most_j = falls.iter().map(|fall| fall.ledger.trees_j).fold(0.0, f64::max);
        assert!((most_j / limit_j - 1.0).abs() < 1e-6, "{scheme} {shape}: {most_j} J");
    }
}

/// A rock that comes between two stems strikes both at once: each takes half of the blow, and none breaks at a limit of 0.6 of the rock's
/// energy. All of it counted against the one that was pressed hardest, which broke, and the rock left to its side.
#[test]
fn stems_struck_at_once_share_the_blow() {
    let (sin, cos) = 35f64.to_radians().sin_cos();
    let wall = |side: f64| {
        let at = |far: f64, z: f64| [10.0 - sin * far, side * (0.05 + cos * far), z];
        panel([at(0.0, 0.5), at(8.0, 0.5), at(8.0, 9.0), at(0.0, 9.0)])
    };
    let walls = [wall(1.0), wall(-1.0)].concat();
    let more = |scheme: &str| {
        format!(
            "[release]\ncount = 1\nvelocity_m_s = [10.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
             points_m = [[6.0, 0.0, 6.0]]\n{}",
            solver(scheme).replace("longest_s = 2.0", "longest_s = 0.6")
        )
    };
    for scheme in SCHEMES {
        let fall = |share: f64| {
            let limit_j = share * shot_j();
            let trunk =
                format!("friction_angle_deg = 30.0\nrestitution = 0.2\nbreaks_above_j = {limit_j}");
            falls(&walls, &trunk, &more(scheme)).remove(0)
        };
        let (stands, limited) = (fall(10.0), fall(0.6));
        let [whole_j, taken_j] = [&stands, &limited].map(|fall| fall.ledger.trees_j / shot_j());
        assert!(whole_j > 0.8 && (taken_j - whole_j).abs() < 0.01, "{scheme}: {whole_j} {taken_j}");
        let off = limited.end.velocity_m_s - stands.end.velocity_m_s;
        assert!(off.norm() < 0.1, "{scheme}: {:?} {:?}", stands.end, limited.end);
    }
}

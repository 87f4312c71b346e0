//! What stems have taken so far counts in every scheme, also where a rock comes and goes within one step.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;
use crate::stems::stand_on;
use common::together::{WORLD, World};
use rockfall::rock::Vec3;
use rockfall::simulation::Trajectory;
use rockfall::solver::Scheme;
use rockfall::terrain::make::{Stem, stem};
use rockfall::terrain::stl::{Facet, write_binary};
use std::f64::consts::PI;

/// Two triangles between four corners (m).
pub(crate) fn panel(corners: [[f64; 3]; 4]) -> Vec<Facet> {
    let [a, b, c, d] = corners.map(Vec3::from);
    vec![[a, b, c], [a, c, d]]
}

/// Rocks of 0.4 m and density 2700 kg/m³ on level ground with trees of these facets; `more` ends the scene.
fn falls(trees: &[Facet], trunk: &str, more: &str) -> Vec<Trajectory> {
    falls_among(&[(trees, trunk)], more)
}

/// The same among trees of several kinds, each with its facets and what its trunks are.
pub(crate) fn falls_among(kinds: &[(&[Facet], &str)], more: &str) -> Vec<Trajectory> {
    let dir = tempfile::tempdir().unwrap();
    let ground = panel([[-60., -60., 0.], [60., -60., 0.], [60., 60., 0.], [-60., 60., 0.]]);
    write_binary(&dir.path().join("ground.stl"), &ground).unwrap();
    for (k, (trees, _)) in kinds.iter().enumerate() {
        write_binary(&dir.path().join(format!("trees{k}.stl")), trees).unwrap();
    }
    let mesh = |k: usize| format!("[[trees]]\nmesh = \"trees{k}.stl\"\nground = \"trunk{k}\"\n");
    let meshes: Vec<String> = (0..kinds.len()).map(mesh).collect();
    let trunk = |(k, (_, trunk)): (usize, &(&[Facet], &str))| {
        let stiff = "normal_stiffness_n_m = 1e10\nshear_stiffness_n_m = 0.25e10\n";
        let own = if trunk.contains("stiffness") { "" } else { stiff };
        format!("[grounds.trunk{k}]\n{own}{trunk}\n")
    };
    let trunks: Vec<String> = kinds.iter().enumerate().map(trunk).collect();
    let (meshes, trunks) = (meshes.concat(), trunks.concat());
    let text = format!(
        "title = \"t\"\nseed = 1\n[[terrain]]\nmesh = \"ground.stl\"\nground = \"rock\"\n{meshes}\
         [grounds.rock]\nnormal_stiffness_n_m = 1e10\nshear_stiffness_n_m = 0.25e10\n\
         friction_angle_deg = 30.0\nrestitution = 0.4\n{trunks}[rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.4\n{more}"
    );
    common::falls(&common::plan_in(dir.path(), &text))
}

/// `m v²/2` at 10 m/s (J).
pub(crate) fn shot_j() -> f64 {
    0.5 * 2700.0 * 4.0 / 3.0 * PI * 0.4_f64.powi(3) * 100.0
}

pub(crate) const SCHEMES: [&str; 4] = ["adaptive", "reference", "dda", "rigid"];

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

/// Rock at the level of the trees, 6 m before them, that comes along x at 10 m/s, and `more`; it has passed them after 0.6 s and has not come down.
pub(crate) fn shot(scheme: &str, more: &str) -> String {
    format!(
        "{more}[release]\ncount = 1\nvelocity_m_s = [10.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
         points_m = [[6.0, 0.0, 6.0]]\n{}",
        solver(scheme).replace("longest_s = 2.0", "longest_s = 0.6")
    )
}

/// Trees without friction that break at a share of the shot's energy.
pub(crate) fn weak(share: f64, restitution: f64) -> String {
    let limit_j = share * shot_j();
    format!("friction_angle_deg = 0.0\nrestitution = {restitution}\nbreaks_above_j = {limit_j}")
}

/// Goes straight on with what stems have left of 10 m/s that took this share of the energy: `v √(1 − E/E₀)`, to the error of
/// the fixed step and of `adaptive`.
fn assert_goes_on(fall: &Trajectory, taken: f64, what: &str) {
    let v = fall.end.velocity_m_s;
    assert!((fall.ledger.trees_j / shot_j() - taken).abs() < 1e-5, "{what}: {:?}", fall.ledger);
    assert!((v.x - 10.0 * (1.0 - taken).sqrt()).abs() < 0.25, "{what}: {v:?}");
    assert!(v.y.abs() < 1e-6 && fall.end.spin_rad_s.norm() < 1e-6, "{what}: {:?}", fall.end);
}

/// Two walls that a sphere strikes at once, so far apart (m).
fn funnel(apart_m: f64) -> Vec<Facet> {
    let (sin, cos) = 35f64.to_radians().sin_cos();
    let wall = |side: f64| {
        let at = |far: f64, z: f64| [10.0 - sin * far, side * (0.5 * apart_m + cos * far), z];
        panel([at(0.0, 0.5), at(8.0, 0.5), at(8.0, 9.0), at(0.0, 9.0)])
    };
    [wall(1.0), wall(-1.0)].concat()
}

/// A sphere strikes two stems at once, or one with two sides, and breaks them: it goes on, in `rigid` too, which threw it back with all that the stems
/// had left; and what gives way in mid-blow has given nothing back yet, however elastic it is.
#[test]
fn a_sphere_goes_on_through_stems_struck_at_once() {
    for scheme in SCHEMES {
        for (apart_m, share, taken) in
            [(0.1, 0.1, 0.2), (0.1, 0.3, 0.6), (0.0, 0.2, 0.2), (0.0, 0.6, 0.6)]
        {
            for restitution in [0.2, 0.8] {
                let trunk = weak(share, restitution);
                let fall = falls(&funnel(apart_m), &trunk, &shot(scheme, "")).remove(0);
                assert_goes_on(&fall, taken, &format!("{scheme} {apart_m} {share} {restitution}"));
            }
        }
    }
}

/// The same of a rock in a world, wide enough to strike two stems of 1 m that stand 4 m apart.
#[test]
fn a_rock_of_a_world_goes_on_through_stems_struck_at_once() {
    let (radius_m, density) = (3.0_f64, 2700.0);
    let shot_j = 0.5 * density * 4.0 / 3.0 * PI * radius_m.powi(3) * 100.0;
    let terrain = stand_on(-50.0, 2, Some(0.3 * shot_j));
    for (scheme, tolerance_m_s) in
        [(Scheme::Adaptive, 1e-3), (Scheme::Reference, 1e-8), (Scheme::Rigid, 0.0)]
    {
        let world = World { scheme, tolerance_m_s, grounds: 2, ..WORLD };
        let rock = (radius_m, density, [2.0, -6.0, 0.0], [0.0, 10.0, 0.0], [0.0; 3]);
        let apart = (0.4, density, [20.0, -6.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]);
        let fall = &world.falls(&terrain, &[rock, apart], 0.6)[0];
        let v = fall.end.velocity_m_s;
        assert!((v.y - 10.0 * 0.4f64.sqrt()).abs() < 0.1, "{scheme:?}: {:?}", fall.end);
        assert!(v.x.abs() < 1e-6, "{scheme:?}: {:?}", fall.end);
        let taken = fall.ledger.trees_j / shot_j;
        assert!((taken - 0.6).abs() < 1e-5, "{scheme:?}: {taken}");
    }
}

/// A face that strikes stems flat loads all its corners alike: what the stems take slows the block and does not turn it. The whole limit went through one corner, in
/// `rigid` a stronger stem threw the block back as it broke, and of two stems springs broke one and left the other.
#[test]
fn a_block_goes_on_straight_through_stems_that_it_strikes_flat() {
    let tree = |y: f64, half: f64| {
        panel([
            [10., y - half, 0.5],
            [10., y + half, 0.5],
            [10., y + half, 9.],
            [10., y - half, 9.],
        ])
    };
    let shape = |axes: &str| {
        format!("[[rocks.shapes]]\nkind = \"box\"\ncorner_radius = 0.1\naxes = {axes}\n")
    };
    let (cube, bar) = (shape("[1.0, 1.0, 1.0]"), shape("[1.0, 4.0, 1.0]"));
    let (stem, fence) = (tree(0.0, 0.15), tree(0.0, 5.0));
    let two = [tree(0.6, 0.1), tree(-0.6, 0.1)].concat();
    for scheme in SCHEMES {
        for (name, trees, block, share, taken) in [
            ("stem", &stem, &cube, 0.3, 0.3),
            ("stem", &stem, &cube, 0.9, 0.9),
            ("fence", &fence, &cube, 0.5, 0.5),
            ("two", &two, &bar, 0.1, 0.2),
            ("two", &two, &bar, 0.3, 0.6),
        ] {
            let more = shot(scheme, block)
                .replace("points_m", "orientation = [1.0, 0.0, 0.0, 0.0]\npoints_m");
            let fall = falls(trees, &weak(share, 0.2), &more).remove(0);
            assert_goes_on(&fall, taken, &format!("{scheme} {name} {share}"));
        }
    }
}

/// A sphere on the ground comes to a stem that leans over it: the ground does not let it go below, and it presses with all its energy, 0.75 of which is that
/// across the stem. One that can take 0.85 breaks, and the sphere goes on; with `rigid` it was thrown back with what was left.
#[test]
fn a_stem_breaks_against_which_the_ground_presses_a_sphere() {
    let at = |y: f64, z: f64| [5.0 - z * 30f64.to_radians().tan(), y, z];
    let tree = panel([at(-5.0, 0.01), at(5.0, 0.01), at(5.0, 8.0), at(-5.0, 8.0)]);
    for scheme in SCHEMES {
        let more = format!(
            "[release]\ncount = 1\nvelocity_m_s = [10.0, 0.0, 0.0]\nspin_rad_s = [0.0, 25.0, 0.0]\n\
             points_m = [[0.0, 0.0, 0.4]]\n{}",
            solver(scheme).replace("longest_s = 2.0", "longest_s = 0.6")
        );
        let fall = &falls(&tree, &weak(0.85, 0.2), &more)[0];
        let taken = fall.ledger.trees_j / shot_j();
        assert!((taken - 0.85).abs() < 1e-5, "{scheme}: {taken}");
        assert!(fall.end.velocity_m_s.x > 3.0, "{scheme}: {:?}", fall.end);
    }
}

//! Input at the edge of sense gets words of its own, short ones, and an exit status even where nobody can read them.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]
#![cfg(target_os = "linux")]

use crate::{asked, program};

use asked::{Asked, IN_THE_BOX, USUAL, closed_box, plate, scene, word};
use program::{command, rockfall};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// The line of a refusal; none is longer than a few lines on a screen.
fn refused(args: &[&str]) -> String {
    let done = rockfall(args);
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{args:?}: {said}");
    assert!(said.len() < 400, "{said}");
    said
}

#[test]
fn grids_that_are_no_slope_are_refused_with_words() {
    let dir = tempfile::tempdir().unwrap();
    let (grid, out) = (dir.path().join("grid.asc"), dir.path().join("out.stl"));
    let head = |columns: usize, corner: &str, cell: &str| {
        format!(
            "ncols {columns}\nnrows {columns}\nxllcorner {corner}\nyllcorner 0\ncellsize {cell}\nNODATA_value -9999\n"
        )
    };
    let flat = "5 5\n5 5\n";
    for (text, says) in [
        (head(2, "0", "1") + "1e300 5\n5 5\n", "heights: found 1e300; write metres"),
        (head(2, "0", "1") + "-9999 -9999\n-9999 -9999\n", "found 0 heights in 2 x 2 cells"),
        (head(2, "0", "1") + "5 -9999\n-9999 5\n", "found 2 heights in 2 x 2 cells"),
        (head(1, "0", "1") + "5\n", "found 1 heights in 1 x 1 cells"),
        (head(2, "0", "1e-300") + flat, "cellsize: found 1e-300; write metres"),
        (head(2, "1e300", "1") + flat, "xllcorner, yllcorner: found 1e300; write map"),
    ] {
        fs::write(&grid, &text).unwrap();
        let said = refused(&["mesh", "from-grid", grid.to_str().unwrap(), out.to_str().unwrap()]);
        assert!(said.contains(says), "{said} {text}");
        assert!(!out.exists());
    }
}

fn stl(path: &Path, facets: &[[[f64; 3]; 3]]) {
    let corner = |[x, y, z]: &[f64; 3]| format!("vertex {x:?} {y:?} {z:?}\n");
    let facet = |corners: &[[f64; 3]; 3]| {
        let corners: String = corners.iter().map(corner).collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let all: String = facets.iter().map(facet).collect();
    fs::write(path, format!("solid a\n{all}endsolid a\n")).unwrap();
}

#[test]
fn meshes_without_ground_are_told_as_such() {
    let dir = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string("tests/bad/tolerance_zero.toml").unwrap();
    let scene =
        scene.replace("[solver]\ntolerance_m_s = 0.0", "").replace("square.stl", "mesh.stl");
    let file = dir.path().join("scene.toml");
    fs::write(&file, scene.replace("[[5.0, 5.0]]", "[[0.0, 0.0]]")).unwrap();
    let s = 1e-30;
    let dust = [[[-s, -s, 0.0], [s, -s, 0.0], [0.0, s, 0.0]]];
    let wall = [[[0.0, -5.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 5.0]]];
    for (facets, says) in [
        (&dust[..], "[[terrain]] scale: found meshes of 2.0e-30 m in all; write scale ="),
        (&wall[..], "the meshes cover no ground in plan view"),
    ] {
        stl(&dir.path().join("mesh.stl"), facets);
        let said = refused(&["plan", file.to_str().unwrap()]);
        assert!(said.contains(says), "{said}");
    }
}

/// A name that a spreadsheet would take for a formula does not come into a table, whether the scene has it or a drawing.
#[test]
fn names_that_are_formulas_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let drawn = dir.path().join("lines.geojson");
    for name in ["=1+1", "+1", "-1", "@cell"] {
        let line = format!(
            r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","properties":{{"name":"{name}"}},"geometry":{{"type":"LineString","coordinates":[[-4,2],[4,2]]}}}}]}}"#
        );
        fs::write(&drawn, line).unwrap();
        for more in [
            "[[lines]]\nfile = \"lines.geojson\"".to_owned(),
            "[[barriers]]\nfile = \"lines.geojson\"\nheight_m = 3.0\ncapacity_j = 1e6".to_owned(),
            format!("[[lines]]\nname = \"{name}\"\npoints_m = [[-4.0, 2.0], [4.0, 2.0]]"),
            format!(
                "[grounds.\"{name}\"]\nlike = \"rstone/debris\"\nfriction_angle_deg = 30.0\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 1e7"
            ),
        ] {
            let scene = scene(dir.path(), &plate(5.0, 0.0), &Asked { more: &more, ..USUAL });
            let said = refused(&["plan", word(&scene)]);
            assert!(said.contains(name) && said.contains("spreadsheets take that"), "{said}");
        }
    }
}

/// What a computation loses by itself is said: in an elastic box without friction a fixed step loses nearly all.
#[test]
fn energy_that_the_numerics_lose_is_warned_of() {
    let dir = tempfile::tempdir().unwrap();
    let run = |scheme: &str| {
        let more = format!("[solver]\nlongest_s = 20.0\nscheme = {scheme}");
        let asked = Asked { more: &more, ..IN_THE_BOX };
        let scene = scene(dir.path(), &closed_box(), &asked);
        let text = fs::read_to_string(&scene).unwrap();
        let smooth = text.replace("friction_angle_deg = 30.0", "friction_angle_deg = 0.0");
        fs::write(&scene, smooth).unwrap();
        let out = dir.path().join("out");
        let done = rockfall(&["run", word(&scene), "--overwrite", "--out", word(&out)]);
        assert!(done.status.success());
        String::from_utf8(done.stdout).unwrap()
    };
    let said = run("\"dda\"\nstep_s = 1e-4");
    assert!(said.contains("warning: the computation itself lost"), "{said}");
    assert!(said.contains("% of the energy released, beside friction and damping"), "{said}");
    for scheme in ["\"rigid\"", "\"reference\""] {
        let said = run(scheme);
        assert!(!said.contains("the computation itself"), "{scheme}: {said}");
    }
}

/// Where the message cannot be written the status still says it.
#[test]
fn a_full_stderr_keeps_the_status() {
    let full = || Stdio::from(fs::File::options().write(true).open("/dev/full").unwrap());
    let mut wrong = command(&["plan", "no_such_scene.toml"]);
    assert_eq!(wrong.stderr(full()).status().unwrap().code(), Some(2));
    let mut right = command(&["grounds"]);
    assert_eq!(right.stdout(full()).stderr(full()).status().unwrap().code(), Some(2));
}

/// A limit on the length of files is an error with words, not a signal.
#[test]
fn a_limit_of_file_length_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_rockfall");
    let out = dir.path().join("out");
    let script = format!(
        "ulimit -f 64; exec {program} run examples/quick.toml --quiet --releases 300 --out {}",
        out.display()
    );
    let done = Command::new("sh").args(["-c", &script]).output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains(": File too large"), "{said}");
}

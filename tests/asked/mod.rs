//! Scenes of one rock on a small mesh, and how its rocks end.

#![allow(missing_docs, dead_code, unreachable_pub, clippy::unwrap_used)]

use crate::program::rockfall;
use rockfall::rock::Vec3;
use rockfall::terrain::stl::{Facet, write_ascii};
use std::fs;
use std::path::{Path, PathBuf};

pub fn p(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A four-sided face.
pub fn quad([a, b, c, d]: [Vec3; 4]) -> [Facet; 2] {
    [[a, b, c], [a, c, d]]
}

/// A level square of side `2 half` at height z.
pub fn plate(half: f64, z: f64) -> Vec<Facet> {
    quad([p(-half, -half, z), p(half, -half, z), p(half, half, z), p(-half, half, z)]).into()
}

/// A closed box of 2 m.
pub fn closed_box() -> Vec<Facet> {
    let side = |turn: fn(f64, f64, f64) -> Vec3| {
        [0.0, 2.0].map(|w| {
            quad([turn(0.0, 0.0, w), turn(2.0, 0.0, w), turn(2.0, 2.0, w), turn(0.0, 2.0, w)])
        })
    };
    let sides = [side(p), side(|u, v, w| p(w, u, v)), side(|u, v, w| p(v, w, u))];
    sides.as_flattened().as_flattened().to_vec()
}

/// What a scene of one rock on one mesh says beside the usual.
pub struct Asked<'a> {
    pub restitution: f64,
    /// Lines of `[release]`.
    pub place: &'a str,
    pub velocity: [f64; 3],
    /// Lines at the end.
    pub more: &'a str,
}

pub const USUAL: Asked<'_> = Asked {
    restitution: 0.4,
    place: "count = 1\nheight_m = 1.0\npoints_m = [[0.0, 0.0]]",
    velocity: [0.0; 3],
    more: "",
};

/// A rock thrown in [`closed_box`] that loses nothing by restitution.
pub const IN_THE_BOX: Asked<'_> = Asked {
    restitution: 1.0,
    place: "count = 1\npoints_m = [[1.0, 1.0, 1.0]]",
    velocity: [3.0, 2.0, 1.0],
    more: "",
};

pub fn scene(dir: &Path, mesh: &[Facet], asked: &Asked) -> PathBuf {
    write_ascii(&dir.join("mesh.stl"), "mesh", mesh).unwrap();
    let Asked { restitution, place, velocity, more } = asked;
    let text = format!(
        r#"title = "One rock"
seed = 5
[[terrain]]
mesh = "mesh.stl"
ground = "rock"
[grounds.rock]
normal_stiffness_n_m = 1e8
shear_stiffness_n_m = 0.25e8
friction_angle_deg = 30.0
restitution = {restitution:?}
[rocks]
density_kg_m3 = 2700.0
radius_m = 0.2
[release]
{place}
velocity_m_s = {velocity:?}
spin_rad_s = [0.0, 0.0, 0.0]
{more}
"#
    );
    let file = dir.join("scene.toml");
    fs::write(&file, text).unwrap();
    file
}

pub fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Runs a scene; the words under `stop`, row by row.
pub fn stops(scene: &Path, more: &[&str]) -> Vec<String> {
    stops_and_words(scene, &[&["--quiet"], more].concat()).0
}

/// The same, and what the run says.
pub fn stops_and_words(scene: &Path, more: &[&str]) -> (Vec<String>, String) {
    let out = scene.with_file_name("out");
    let args = ["run", word(scene), "--overwrite", "--out", word(&out)];
    let done = rockfall(&[&args[..], more].concat());
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    (ends(&out), said)
}

/// The words under `stop`, row by row.
fn ends(out: &Path) -> Vec<String> {
    let rows = fs::read_to_string(out.join("releases.csv")).unwrap();
    rows.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().to_owned()).collect()
}

//! The same scene gives the same bytes: on any number of threads, one release alone, from whatever program's mesh file.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use rockfall::rock::Vec3;
use rockfall::terrain::stl::{Facet, write_ascii, write_binary};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Runs a scene and returns the bytes of one of its result files.
fn run(scene: &Path, out: &Path, options: &[&str], file: &str) -> Vec<u8> {
    let done = Command::new(env!("CARGO_BIN_EXE_rockfall"))
        .args(["run", "--quiet", "--out"])
        .args([out, scene])
        .args(options)
        .output()
        .unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    fs::read(out.join(file)).unwrap()
}

#[test]
fn threads_change_no_byte() {
    let dir = tempfile::tempdir().unwrap();
    let scene = Path::new("examples/quick.toml");
    let files = ["releases.csv", "paths.csv", "impacts.csv"];
    let of = |threads: &str| {
        let out = dir.path().join(threads);
        run(scene, &out, &["--releases", "120", "--threads", threads], files[0]);
        files.map(|file| fs::read(out.join(file)).unwrap())
    };
    let [one, two, seven] = ["1", "2", "7"].map(of);
    for (k, file) in files.into_iter().enumerate() {
        assert!(one[k].len() > 10_000);
        assert!(one[k] == two[k] && one[k] == seven[k], "{file} differs");
    }
}

/// Rock 17 alone is rock 17 among many, digit for digit.
#[test]
fn one_release_alone_is_the_same_rock() {
    let dir = tempfile::tempdir().unwrap();
    let scene = Path::new("examples/quick.toml");
    let all = run(scene, &dir.path().join("all"), &["--releases", "40"], "releases.csv");
    let one =
        run(scene, &dir.path().join("one"), &["--releases", "40", "--only", "17"], "releases.csv");
    let line =
        |bytes: &[u8], k: usize| String::from_utf8_lossy(bytes).lines().nth(k).unwrap().to_owned();
    assert_eq!(line(&all, 18), line(&one, 1));
    assert!(line(&one, 1).starts_with("17,"));
}

/// The roof that `tests/meshes/make.py` writes, as our own writers write it.
fn roof() -> Vec<Facet> {
    let p = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0], [2.0, 2.0, 1.5]]
        .map(Vec3::from);
    [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]].map(|facet| facet.map(|k| p[k])).into()
}

fn scene_over(mesh: &Path, dir: &Path, name: &str) -> PathBuf {
    let scene = dir.join(format!("{name}.toml"));
    let text = format!(
        r#"title = "Roof"
seed = 3
[[terrain]]
mesh = "{}"
ground = "tiles"
[grounds.tiles]
normal_stiffness_n_m = 1e7
shear_stiffness_n_m = 0.25e7
friction_angle_deg = 30.0
restitution = 0.4
rolling_friction = 0.1
roughness_deg = 5.0
[rocks]
density_kg_m3 = 2700.0
radius_m = 0.1
[release]
count = 60
height_m = {{ uniform = [0.1, 1.0] }}
velocity_m_s = [0.0, 0.0, 0.0]
spin_rad_s = [0.0, 0.0, 0.0]
polygon_m = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]]
[record]
impacts = true
"#,
        mesh.display()
    );
    fs::write(&scene, text).unwrap();
    scene
}

#[test]
fn a_mesh_gives_the_same_bytes_whatever_program_wrote_it() {
    let dir = tempfile::tempdir().unwrap();
    let ours = [dir.path().join("ours_ascii.stl"), dir.path().join("ours_binary.stl")];
    write_ascii(&ours[0], "roof", &roof()).unwrap();
    write_binary(&ours[1], &roof()).unwrap();
    let theirs = [
        "meshio_ascii",
        "meshio_binary",
        "trimesh_ascii",
        "trimesh_binary",
        "numpy_stl_ascii",
        "numpy_stl_binary",
    ];
    let here = fs::canonicalize("tests/meshes").unwrap();
    let meshes = ours.into_iter().chain(theirs.map(|name| here.join(format!("{name}.stl"))));
    let results: Vec<(PathBuf, Vec<u8>)> = meshes
        .map(|mesh| {
            let name = mesh.file_stem().unwrap().to_string_lossy().into_owned();
            let scene = scene_over(&mesh, dir.path(), &name);
            let out = dir.path().join(&name);
            let mut bytes = run(&scene, &out, &[], "releases.csv");
            bytes.extend(fs::read(out.join("paths.csv")).unwrap());
            bytes.extend(fs::read(out.join("impacts.csv")).unwrap());
            (mesh, bytes)
        })
        .collect();
    let (_, first) = &results[0];
    for (mesh, bytes) in &results {
        assert!(bytes == first, "{} gives other results", mesh.display());
    }
}

//! Many rocks that fall onto a slope together and strike each other.
#![allow(clippy::unwrap_used, reason = "a test that has no rock has failed")]

use std::fs;
use std::process::Command;

/// A block of 125 spheres without bonds, 3 cm apart at first, thrown along the slope.
fn scene(seed: u32, along_m_s: f64) -> String {
    let at = |k: u32, from: f64, step: f64| from + step * f64::from(k);
    let points = (0..125).map(|k| {
        let place = [at(k % 5, 22.0, 0.43), at(k / 5 % 5, 8.0, 0.43), at(k / 25, 33.0, 0.45)];
        format!("{place:?}")
    });
    let points = points.collect::<Vec<_>>().join(", ");
    let slope = fs::canonicalize("terrain/quick_slope.stl").unwrap();
    let springs = "normal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 0.25e8\nfriction_angle_deg = 32.0\nrestitution = 0.35\n";
    format!(
        "title = \"A crowd\"\nseed = {seed}\n[[terrain]]\nmesh = \"{}\"\nground = \"rock\"\n[grounds.rock]\n{springs}rolling_friction = 0.35\n\
         [rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.2\n[rocks.contact]\n{springs}tensile_strength_pa = 0.0\ncohesion_pa = 0.0\n\
         [release]\ncount = 125\ntogether = true\nvelocity_m_s = [0.0, {along_m_s}, 0.5]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
         points_m = [{points}]\n[record]\npaths = 0\n",
        slope.display()
    )
}

/// Every step of a dense crowd settles: in each of these stories one was halved without end, and 4 to 116 rocks stood as failed.
#[test]
fn no_rock_of_a_crowd_fails() {
    let dir = tempfile::tempdir().unwrap();
    for (seed, along_m_s) in [(1, 1.0), (20, 2.6), (23, 2.99)] {
        let path = dir.path().join(format!("crowd{seed}.toml"));
        fs::write(&path, scene(seed, along_m_s)).unwrap();
        let out = dir.path().join(format!("out{seed}"));
        let mut run = Command::new(env!("CARGO_BIN_EXE_rockfall"));
        let done =
            run.arg("run").arg(&path).arg("--out").arg(&out).arg("--quiet").output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let rows = fs::read_to_string(out.join("releases.csv")).unwrap();
        let stops: Vec<&str> =
            rows.lines().skip(1).filter_map(|row| row.split(',').nth(1)).collect();
        assert_eq!(stops.len(), 125);
        assert!(stops.iter().all(|stop| *stop != "failed"), "{seed}: {stops:?}");
    }
}

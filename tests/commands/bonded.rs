//! Rocks that hold on to each other are written as rocks alone are.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::asked::{Asked, plate, scene, stops};
use std::fs;

/// Two bonded spheres are thrown up with 5 m/s from 3 m over a plate: they rise by v²/(2 g) = 1.2742 m, in every scheme with bonds, and the
/// map knows it. Held by each other they counted as on the ground: 3 m in the table, 0 m on the map.
#[test]
fn rocks_that_hold_each_other_have_a_height_in_flight() {
    let dir = tempfile::tempdir().unwrap();
    for scheme in ["\"adaptive\"", "\"dda\"\nstep_s = 1e-4"] {
        let more = format!(
            "[rocks.contact]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 1e7\nfriction_angle_deg = 30.0\nrestitution = 0.5\n\
             tensile_strength_pa = 1e6\ncohesion_pa = 1e6\n[maps]\ncell_m = 2.0\n[solver]\nlongest_s = 1.0\nscheme = {scheme}"
        );
        let asked = Asked {
            restitution: 0.4,
            place: "count = 2\ntogether = true\npoints_m = [[-0.2, 0.5, 3.2], [0.2, 0.5, 3.2]]",
            velocity: [0.0, 0.0, 5.0],
            more: &more,
        };
        stops(&scene(dir.path(), &plate(5.0, 0.0), &asked), &[]);
        let mut table = csv::Reader::from_path(dir.path().join("out/releases.csv")).unwrap();
        let column = table.headers().unwrap().iter().position(|name| name == "max_height_m");
        let highest_m = 3.0 + 25.0 / (2.0 * 9.81);
        for row in table.records() {
            let height_m: f64 = row.unwrap()[column.unwrap()].parse().unwrap();
            assert!((height_m - highest_m).abs() < 1e-3, "{scheme}: {height_m}");
        }
        let map = fs::read_to_string(dir.path().join("out/maps/height_max_m.asc")).unwrap();
        let cells = map.lines().skip(6).flat_map(str::split_whitespace);
        let most = cells.map(|cell| cell.parse::<f64>().unwrap()).fold(0.0, f64::max);
        assert!((most - highest_m).abs() < 1e-3, "{scheme}: {most} on the map");
    }
}

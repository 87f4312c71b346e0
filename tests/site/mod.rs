//! One slope in every format, and scenes over it.

#![allow(
    missing_docs,
    missing_debug_implementations,
    dead_code,
    unreachable_pub,
    clippy::unwrap_used
)]

use crate::program::rockfall;
use crate::tiff::{DEFLATE, Kind, Spec, write};
use rockfall::terrain::grid::Grid;
use rockfall::terrain::stl::write_ascii;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

/// Columns and rows; cells of 2 m, so that places have few digits in binary.
pub const SIZE: [usize; 2] = [31, 41];
pub const SOUTH_M: f64 = 1_200_100.25 - 2.0 * SIZE[1] as f64;
pub const ORIGIN: &str = "origin_m = [2600000.0, 1200000.0, 0.0]\n";

/// A slope of about 40° down to the south, with humps; heights in quarters.
pub fn height(column: usize, row: usize) -> f64 {
    let hump = ((column * 7 + row * 13) % 5) as f64;
    60.0 - 1.75 * row as f64 + 0.25 * hump
}

/// A scene over one terrain table; the rest is the same for all.
pub fn scene(terrain: &str, more: &str) -> String {
    let place = "line_m = [[2600010.5, 1200090.25], [2600050.5, 1200090.25]]";
    let place = if more.contains("zones =") { "" } else { place };
    let (release, rest) = more.split_once('|').unwrap_or(("", more));
    format!(
        "title = \"In\"\nseed = 5\nepsg = 2056\n{ORIGIN}[[terrain]]\nground = \"rock\"\n{terrain}\n\
         [grounds.rock]\nnormal_stiffness_n_m = 1e9\nshear_stiffness_n_m = 0.25e9\nfriction_angle_deg = 33.0\nrestitution = 0.3\n\
         rolling_friction = 0.4\n\
         [grounds.scree]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 2.5e7\nfriction_angle_deg = 36.0\nrestitution = 0.1\n\
         rolling_friction = 0.6\n\
         [rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.3\n\
         [release]\ncount = 40\nheight_m = 0.5\nvelocity_m_s = [0.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n{place}\n{release}\n\
         [maps]\ncell_m = 4.0\n[solver]\nlongest_s = 20.0\n{rest}\n"
    )
}

pub struct Folder(pub tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn put(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs a scene and gives the folder of its results.
    pub fn run(&self, name: &str, scene: &str) -> PathBuf {
        let (file, out) = (self.put(&format!("{name}.toml"), scene), self.path(name));
        let said =
            rockfall(&["run", file.to_str().unwrap(), "--quiet", "--out", out.to_str().unwrap()]);
        assert!(said.status.success(), "{name}: {}", String::from_utf8_lossy(&said.stderr));
        out
    }

    pub fn plan(&self, scene: &str) -> String {
        let file = self.put("plan.toml", scene);
        let said = rockfall(&["plan", file.to_str().unwrap()]);
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        String::from_utf8(said.stdout).unwrap()
    }

    pub fn refusal(&self, scene: &str) -> String {
        let file = self.put("refused.toml", scene);
        let said = rockfall(&["plan", file.to_str().unwrap()]);
        let stderr = String::from_utf8(said.stderr).unwrap();
        assert_eq!((said.status.code(), stderr.lines().count()), (Some(2), 1), "{stderr}");
        stderr
    }

    /// The slope in every format of a mesh or a grid.
    pub fn slope(&self) {
        let tif = Spec {
            tile: Some([16, 16]),
            packing: DEFLATE,
            predictor: 3,
            ..Spec::new(Kind::F32, SIZE)
        };
        self.put("dem.tif", write(&[(&tif, &height)]));
        let values =
            (0..SIZE[1]).flat_map(|row| (0..SIZE[0]).map(move |column| Some(height(column, row))));
        let grid = Grid {
            columns: SIZE[0],
            rows: SIZE[1],
            corner_m: [2_600_000.5, SOUTH_M],
            cell_m: 2.0,
            values: values.collect(),
        };
        self.put("dem.asc", grid.text());
        let facets = grid.facets([2_600_000.0, 1_200_000.0, 0.0].into());
        write_ascii(&self.path("dem.stl"), "slope", &facets).unwrap();
        let (mut obj, mut ply) = (String::new(), String::new());
        for (number, facet) in facets.iter().enumerate() {
            for corner in facet {
                let line = format!("{} {} {}\n", corner.x, corner.y, corner.z);
                let _ = write!(obj, "v {line}");
                ply += &line;
            }
            let _ = writeln!(obj, "f {} {} {}", 3 * number + 1, 3 * number + 2, 3 * number + 3);
        }
        for number in 0..facets.len() {
            let _ = writeln!(ply, "3 {} {} {}", 3 * number, 3 * number + 1, 3 * number + 2);
        }
        self.put("dem.obj", obj);
        self.put("dem.ply", format!(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
             element face {}\nproperty list uchar int vertex_indices\nend_header\n{ply}",
            3 * facets.len(), facets.len()
        ));
    }
}

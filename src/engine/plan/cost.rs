//! What a run may take of memory and disk, estimated before it begins.

use super::{DiskUse, Plan};
use crate::count::counted;
use crate::error::{Error, Result};
use crate::terrain::MANY_TRIANGLES;
use std::fmt;

/// Memory that a run may take unasked (bytes).
const MOST_MEMORY: f64 = 2e9;
/// Disk that a run may take unasked (bytes).
const MOST_DISK: f64 = 10e9;

/// What the statistics keep of a release (bytes).
const ROW_MEMORY: f64 = 220.0;
/// The program itself, and what its figures need (bytes).
const PROGRAM_MEMORY: f64 = 25e6;
/// A triangle as it is read and laid into the index (bytes).
const TRIANGLE_MEMORY: f64 = 130.0;
/// What the faces and smaller leaves of a smaller terrain take on top (bytes).
const FACES_MEMORY: f64 = 160.0;
/// What a triangle takes more where a list of trees is stood on the slope before all is welded (bytes): it is there twice.
const STOOD_ON_MEMORY: f64 = 100.0;
/// Most points of all paths together that the view in three dimensions shows.
pub const MOST_SHOWN_POINTS: usize = 400_000;
/// One of them while it is drawn (bytes), and a path (bytes).
const POINT_MEMORY: f64 = 260.0;
const PATH_MEMORY: f64 = 2e4;
/// A point of a path while its rock falls (bytes).
const FALLING_POINT_MEMORY: f64 = 104.0;
/// Rocks that fall or wait for the disk at a time, at least.
const IN_HAND: f64 = 64.0;
/// A cell while a layer is written or read (bytes).
const CELL_MEMORY: f64 = 60.0;
/// A cell that rocks have passed (bytes).
const PASSED_MEMORY: f64 = 250.0;
/// A class of energy in a cell, where numbers a year are asked for (bytes), and the most of them before they are joined.
const ENERGY_MEMORY: f64 = 8.0;
const CELL_ENERGIES: f64 = 2048.0;
/// A rock in a world with others (bytes).
const TOGETHER_MEMORY: f64 = 6000.0;

/// What a run may take: of memory the most, of disk about so much, as no one knows the number of impacts before.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// Rows of `releases.csv`.
    pub releases: f64,
    /// Rows of `paths.csv`, if all rocks fall until their time is up.
    pub path_points: f64,
    /// Cells of the maps.
    pub cells: f64,
    /// Results on the disk.
    pub disk: DiskUse,
    /// Memory of the program and its meshes, as if they stood there alone (bytes) …
    pub mesh_bytes: f64,
    /// … and of results (bytes).
    pub memory_bytes: f64,
    /// Memory while the meshes are read, before there are results (bytes).
    pub reading_bytes: f64,
}

impl Plan {
    /// What computing so many of its releases may take.
    pub fn cost(&self, releases: usize) -> Cost {
        let releases = releases as f64;
        let (paths, points) = self.paths.kept().map_or((0.0, 0.0), |paths| {
            (releases.min(paths.first as f64), self.longest_s / paths.step_s)
        });
        let path_points = paths * (points + 2.0);
        let map = self.maps.kept().map(|map| [map.columns, map.rows].map(f64::from));
        let cells = map.map_or(0.0, |[columns, rows]| columns * rows);
        let together = if self.rock_against_rock.is_kept() { TOGETHER_MEMORY } else { 0.0 };
        // a rock passes the map from side to side a few times at most
        let passages = map.map_or(0.0, |[columns, rows]| 4.0 * releases * (columns + rows));
        let passed = cells.min(passages);
        let energies = if self.year.is_kept() { passages.min(CELL_ENERGIES * passed) } else { 0.0 };
        let triangles = self.terrain.triangles.len();
        let faces = if triangles > MANY_TRIANGLES { 0.0 } else { FACES_MEMORY };
        let stood_on = if self.terrain.has_tree_list { STOOD_ON_MEMORY } else { 0.0 };
        let of_triangles = |bytes: f64| PROGRAM_MEMORY + bytes * triangles as f64;
        Cost {
            releases,
            path_points,
            cells,
            disk: self.disk_use(releases),
            mesh_bytes: of_triangles(TRIANGLE_MEMORY + faces),
            reading_bytes: of_triangles(TRIANGLE_MEMORY + faces + stood_on),
            memory_bytes: (ROW_MEMORY + together) * releases
                + POINT_MEMORY * path_points.min(MOST_SHOWN_POINTS as f64)
                + PATH_MEMORY * paths
                + FALLING_POINT_MEMORY * points * paths.min(IN_HAND)
                + CELL_MEMORY * cells
                + PASSED_MEMORY * passed
                + ENERGY_MEMORY * energies,
        }
    }
}

impl Cost {
    /// The most memory that a run takes at a time (bytes).
    pub fn most_memory_bytes(&self) -> f64 {
        self.reading_bytes.max(self.mesh_bytes + self.memory_bytes)
    }

    /// Whether a run may take it unasked.
    pub fn is_modest(&self) -> bool {
        self.memory_bytes <= MOST_MEMORY && self.disk.most() <= MOST_DISK
    }

    /// Refuses what is beyond the limits.
    ///
    /// # Errors
    /// More memory or disk than a run may take unasked.
    pub fn check(&self) -> Result<()> {
        if self.is_modest() {
            return Ok(());
        }
        Err(Error::Request(format!(
            "found a run that may take {self}; write fewer releases, [record] paths or a longer path_step_s, or larger cells of [maps], or say --yes (asked above {} of memory beside program and meshes, or {} of disk)",
            size(MOST_MEMORY),
            size(MOST_DISK)
        )))
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { releases, path_points, cells, disk, .. } = self;
        let what = counted(*releases as usize, "release", "releases");
        write!(
            to,
            "{} of memory, and about {} of disk ({}): {releases} {what}, up to {path_points:.0} points of paths, {cells} cells of maps",
            size(self.most_memory_bytes()),
            size(disk.about()),
            disk.largest(size)
        )
    }
}

fn size(bytes: f64) -> String {
    match bytes {
        _ if bytes >= 1e9 => format!("{:.1} GB", bytes / 1e9),
        _ => format!("{:.0} MB", (bytes / 1e6).ceil()),
    }
}

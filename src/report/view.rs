//! The slope in three dimensions: `view.html`, one page that needs nothing else, and `view.glb` for other programs.
//!
//! ```text
//! Terrain ─► Mesh ───┐
//! Results ─► Shown ──┼─► page  (sections of packed columns, own WebGL 2)
//!                    └─► glb   (glTF 2.0: meshes, lines, one moving node a rock)
//! ```
//!
//! The page carries a policy that forbids it to load anything. Drawn again from files alone, it keeps the terrain of the
//! page before.

pub mod frame;
pub mod glb;
mod layers;
pub mod mesh;
pub mod pack;
mod part;
pub mod page;
mod paths;
mod rocks;
mod thin;
mod walls;

use super::raster::GroundRaster;
use super::words::Words;
use crate::error::{Error, Result};
use crate::hazard::Row;
use crate::output::{Results, write_atomic};
use layers::MapLayers;
use mesh::ViewMesh;
use paths::Ways;
use std::fs;
use std::path::Path;
use walls::Wall;

/// File name of the page.
pub const PAGE: &str = "view.html";
/// File name of the scene for other programs.
pub const GLB: &str = "view.glb";

/// Most rocks whose ends are shown and whose rows can be asked for: more dots cover each other.
const MOST_ROCKS: usize = 20_000;

/// All that a view shows.
#[derive(Debug, Clone)]
pub struct Shown {
    words: &'static Words,
    title: String,
    mesh: ViewMesh,
    rows: Vec<Row>,
    ways: Ways,
    walls: Vec<Wall>,
    layers: Option<MapLayers>,
    first_release: usize,
    releases: usize,
}

impl Shown {
    /// What there is to show of a run on a terrain.
    ///
    /// # Errors
    /// A result file that cannot be read.
    pub fn of(results: &Results, mesh: ViewMesh, ground: Option<&GroundRaster>) -> Result<Self> {
        let rows = results.rows()?.take(MOST_ROCKS).collect::<Result<Vec<Row>>>()?;
        let words = Words::of(results.summary.language);
        let mut walls = walls::of(results, ground);
        for wall in &mut walls {
            wall.words = words.of_view(&wall.words);
        }
        Ok(Self {
            words,
            title: results.summary.title.clone(),
            ways: Ways::of(results, &rows)?,
            walls,
            layers: MapLayers::of(results)?,
            first_release: results.summary.identity.first_release,
            releases: results.summary.identity.releases,
            mesh,
            rows,
        })
    }

    /// Which paths and rocks are not shown, and what of the terrain; empty when all is there.
    fn notes(&self) -> Vec<String> {
        let mut notes = self.mesh.notes.clone();
        notes.extend(self.ways.notes());
        if self.rows.len() < self.releases {
            notes.push(format!(
                "Shown are the first {} of {} rocks.",
                self.rows.len(),
                self.releases
            ));
        }
        if self.rows.iter().any(|row| row.shape.is_some()) {
            notes.push("Blocks are shown as balls of their volume.".to_owned());
        }
        notes.extend(self.layers.as_ref().and_then(MapLayers::note));
        notes
    }
}

/// Writes both files into the folder of the results.
///
/// # Errors
/// When a result file cannot be read or a file cannot be written.
pub fn write(results: &Results, mesh: ViewMesh, ground: Option<&GroundRaster>) -> Result<()> {
    let shown = Shown::of(results, mesh, ground)?;
    write_atomic(&results.dir.join(PAGE), page::page(&shown).as_bytes())?;
    write_atomic(&results.dir.join(GLB), &glb::glb(&shown))
}

/// The terrain of the view in `dir`, which was drawn when the meshes were at hand; none where there is no view.
///
/// # Errors
/// When the page is there but cannot be read, or does not hold a terrain.
pub fn mesh_in(dir: &Path) -> Result<Option<ViewMesh>> {
    let path = dir.join(PAGE);
    if !path.exists() {
        return Ok(None);
    }
    let text = fs::read_to_string(&path).map_err(Error::file("read", &path))?;
    match page::section(&text, page::TERRAIN).and_then(ViewMesh::read) {
        Some(mesh) => Ok(Some(mesh)),
        None => Err(Error::input(
            &path,
            "terrain",
            "found none that can be read",
            "restore the file, or remove it: the figures are then drawn without it",
        )),
    }
}

//! The slope in three dimensions: `view.html`, one page that needs nothing else, and `view.glb` for other programs.
//!
//! ```text
//! Terrain ─► Mesh ───┐
//! Results ─► Shown ──┼─► page  (sections of packed columns, own WebGL 2)
//! shapes ─► Hulls ───┘   glb   (glTF 2.0: meshes, lines, one moving node a rock)
//! ```
//!
//! The page carries a policy that forbids it to load anything. Drawn again from files alone, it keeps the terrain and
//! the hulls of the page before.

pub mod frame;
pub mod glb;
pub mod hulls;
mod layers;
pub mod mesh;
pub mod pack;
mod part;
pub mod page;
mod paths;
mod rocks;
mod thin;
mod turn;
mod walls;

use super::raster::GroundRaster;
use super::words::Words;
use crate::body::ShapeKind;
use crate::error::{Error, Result};
use crate::hazard::Row;
use crate::output::{Results, write_atomic};
use hulls::{BlockHull, BlockHulls};
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
    hulls: BlockHulls,
    walls: Vec<Wall>,
    layers: Option<MapLayers>,
    first_release: usize,
    releases: usize,
}

impl Shown {
    /// What there is to show of a run on a terrain; `hull_of` makes the hulls of its blocks.
    ///
    /// # Errors
    /// A result file that cannot be read.
    pub fn of(
        results: &Results,
        mesh: ViewMesh,
        hull_of: impl Fn(usize) -> Option<BlockHull>,
        ground: Option<&GroundRaster>,
    ) -> Result<Self> {
        let rows = results.rows()?.take(MOST_ROCKS).collect::<Result<Vec<Row>>>()?;
        let words = Words::of(results.summary.language);
        let mut walls = walls::of(results, ground);
        for wall in &mut walls {
            wall.words = words.of_view(&wall.words);
        }
        let mut hulls = BlockHulls::default();
        Ok(Self {
            words,
            title: results.summary.title.clone(),
            ways: Ways::of(results, &rows, hull_of, &mut hulls)?,
            hulls,
            walls,
            layers: MapLayers::of(results)?,
            first_release: results.summary.identity.first_release,
            releases: results.summary.identity.releases,
            mesh,
            rows,
        })
    }

    /// Whether a block is shown whose hull is not known.
    fn has_hidden_shapes(&self) -> bool {
        let hidden = |way: &paths::ViewPath| {
            let row = way.release.checked_sub(self.first_release).and_then(|k| self.rows.get(k));
            let shape = row.and_then(|row| row.shape);
            way.hull.is_none() && shape.is_some_and(|shape| shape.kind != ShapeKind::Sphere)
        };
        self.ways.ways.iter().any(hidden)
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
        if self.has_hidden_shapes() {
            notes.push("Blocks are shown as balls of their volume.".to_owned());
        }
        notes.extend(self.layers.as_ref().and_then(MapLayers::note));
        notes
    }
}

/// Writes both files into the folder of the results; `hull_of` makes the hulls of the blocks of releases.
///
/// # Errors
/// When a result file cannot be read or a file cannot be written.
pub fn write(
    results: &Results,
    mesh: ViewMesh,
    hull_of: impl Fn(usize) -> Option<BlockHull>,
    ground: Option<&GroundRaster>,
) -> Result<()> {
    let shown = Shown::of(results, mesh, hull_of, ground)?;
    write_atomic(&results.dir.join(PAGE), page::page(&shown).as_bytes())?;
    write_atomic(&results.dir.join(GLB), &glb::glb(&shown))
}

/// What was drawn when meshes and shapes were at hand: terrain and hulls of the views in `folders`, the terrain that of the
/// first; none where that has no view.
///
/// # Errors
/// When a page is there but cannot be read, or does not hold a terrain.
pub fn kept_in(folders: &[impl AsRef<Path>]) -> Result<Option<(ViewMesh, BlockHulls)>> {
    let (mut mesh, mut hulls) = (None, Vec::new());
    for (number, folder) in folders.iter().enumerate() {
        let path = folder.as_ref().join(PAGE);
        if !path.exists() {
            continue;
        }
        let text = fs::read_to_string(&path).map_err(Error::file("read", &path))?;
        let read = |what: &str| {
            Error::input(
                &path,
                what,
                "found none that can be read",
                "restore the file, or remove it: the figures are then drawn without it",
            )
        };
        if number == 0 {
            let found = page::section(&text, page::TERRAIN).and_then(ViewMesh::read);
            mesh = Some(found.ok_or_else(|| read("terrain"))?);
        }
        if let Some(section) = page::section(&text, page::BLOCKS) {
            hulls.push(BlockHulls::read(section).ok_or_else(|| read("blocks"))?);
        }
    }
    Ok(mesh.map(|mesh| (mesh, BlockHulls::joined(&hulls))))
}

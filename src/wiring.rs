//! Where the commands meet the floors that compute: running releases, drawing results, meshes.

#![expect(
    dead_code,
    clippy::unused_self,
    reason = "a run has nothing to keep until releases are computed here"
)]

use rockfall::error::{Error, Result};
use rockfall::output::Mode;
use rockfall::plan::Plan;
use rockfall::rock::Vec3;
use rockfall::terrain::grid::Grid;
use rockfall::terrain::read::Source;
use rockfall::terrain::stl::write_binary;
use rockfall::terrain::weld::Up;
use rockfall::terrain::{Sheet, Terrain, make};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// How a run is asked for.
#[derive(Debug)]
pub(crate) struct Order {
    /// Folder for the results.
    pub(crate) out: PathBuf,
    /// What to do with results that it holds already.
    pub(crate) mode: Mode,
    /// One release alone, with its full path.
    pub(crate) only: Option<usize>,
    /// Worker threads; `None` = all cores.
    pub(crate) threads: Option<usize>,
}

/// A run under way.
pub(crate) struct Run {}

impl Run {
    /// Opens the result folder.
    pub(crate) fn begin(_plan: &Plan, _order: &Order) -> Result<Self> {
        Err(not_built("running releases"))
    }

    /// Raise it, and no chunk follows the one in hand.
    pub(crate) fn stop_flag(&self) -> Arc<AtomicBool> {
        Arc::default()
    }

    /// Computes and writes one more chunk; says how many releases are on the disk, `None` when no chunk follows.
    pub(crate) fn next_chunk(&mut self) -> Result<Option<usize>> {
        Err(not_built("running releases"))
    }

    /// Writes the summary and draws figures and page.
    pub(crate) fn finish(self) -> Result<()> {
        Err(not_built("reports"))
    }
}

/// Draws figures and page again from the results in `dir`.
pub(crate) fn draw(_dir: &Path) -> Result<()> {
    Err(not_built("drawing"))
}

/// Health of mesh files as they will be welded, in words.
pub(crate) fn check_meshes(files: &[PathBuf]) -> Result<String> {
    let source = |path: &PathBuf| Source {
        sheet: Sheet { path: path.clone(), ground: 0, is_tree: false },
        up: Up::default(),
        scale: 1.0,
    };
    let sources: Vec<Source> = files.iter().map(source).collect();
    let (_, health) = Terrain::read(&sources, Vec3::zeros(), None)?;
    Ok(health.to_string())
}

/// Turns an ESRI ASCII grid into an STL file; says what was subtracted.
pub(crate) fn mesh_from_grid(grid: &Path, out: &Path) -> Result<String> {
    let grid = Grid::read(grid)?;
    let origin_m = grid.map_origin_m();
    let facets = grid.facets(origin_m);
    write_binary(out, &facets)?;
    Ok(format!(
        "{} triangles written to {}\norigin_m = [{:?}, {:?}, {:?}]  # write this into the scene",
        facets.len(),
        out.display(),
        origin_m.x,
        origin_m.y,
        origin_m.z
    ))
}

/// Writes one of the made slopes and shapes.
pub(crate) fn make_mesh(kind: &str, out: &Path) -> Result<String> {
    let shipped = make::shipped();
    let name = |file: &'static str| file.trim_end_matches(".stl");
    let Some((_, facets)) = shipped.iter().find(|(file, _)| name(file) == kind) else {
        let known: Vec<&str> = shipped.iter().map(|(file, _)| name(file)).collect();
        let known = known.join(", ");
        return Err(Error::Request(format!("mesh make: found {kind}; write one of {known}")));
    };
    write_binary(out, facets)?;
    Ok(format!("{} triangles written to {}", facets.len(), out.display()))
}

fn not_built(what: &str) -> Error {
    Error::Request(format!("{what} is not wired into this build"))
}

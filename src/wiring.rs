//! Where the commands meet the floors that compute: reading meshes, running releases, drawing results.

use rockfall::error::{Error, Result};
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::terrain::Terrain;
use std::path::Path;

/// What to do with results that the folder holds already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    /// Refuse them.
    Fresh,
    /// Go on with them.
    Resume,
    /// Replace them.
    Overwrite,
}

/// A run under way.
pub(crate) struct Run {}

impl Run {
    /// Opens the result folder; `only` = one release, with its full path.
    pub(crate) fn begin(
        _plan: &Plan,
        _out: &Path,
        _mode: Mode,
        _only: Option<usize>,
    ) -> Result<Self> {
        Err(not_built("running releases"))
    }

    /// Computes and writes one more chunk; says how many releases are on the disk, `None` after the last.
    pub(crate) fn next_chunk(&mut self) -> Result<Option<usize>> {
        Err(not_built("running releases"))
    }

    /// Writes the summary and draws figures and page.
    pub(crate) fn finish(self) -> Result<()> {
        Err(not_built("reports"))
    }
}

/// Reads and welds the meshes of a scene; says what was found in them.
pub(crate) fn read_terrain(_scene: &Scene) -> Result<(Terrain, String)> {
    Err(not_built("reading meshes"))
}

/// Draws figures and page again from the results in `dir`.
pub(crate) fn draw(_dir: &Path) -> Result<()> {
    Err(not_built("drawing"))
}

/// Health of mesh files as they will be welded, in words.
pub(crate) fn check_meshes(_files: &[std::path::PathBuf]) -> Result<String> {
    Err(not_built("checking meshes"))
}

/// Turns an ESRI ASCII grid into an STL file; says what was subtracted.
pub(crate) fn mesh_from_grid(_grid: &Path, _out: &Path) -> Result<String> {
    Err(not_built("turning grids into meshes"))
}

/// Writes one of the made slopes and shapes.
pub(crate) fn make_mesh(_kind: &str, _out: &Path) -> Result<String> {
    Err(not_built("making meshes"))
}

fn not_built(what: &str) -> Error {
    Error::Request(format!("{what} is not wired into this build"))
}

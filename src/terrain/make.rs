//! Made terrain: the slopes that ship with the project and simple shapes with known answers.
//!
//! The slopes use integer hashes, `+ − × /` and square roots only, which every machine rounds the same way: the files
//! in `terrain/` come out bit for bit.

mod forest;
mod noise;
mod shapes;
mod slopes;
mod stems;
#[cfg(test)]
mod tests;
mod valley;

pub(super) use forest::begins_like_list;
pub use forest::{List, plant, read_list};
pub use shapes::{containers, jittered_plane, ridge, stairs, tetrahedron, v_groove};
pub use slopes::{Slope, natural_slope, paper_slope, quick_slope};
pub use stems::{Stem, square_stem, stem};
pub use valley::valley_slope;

use crate::error::{Error, Result};
use crate::terrain::stl::{Facet, write_binary};
use std::path::Path;

/// The made files of `terrain/` by name.
pub fn shipped() -> Vec<(&'static str, Vec<Facet>)> {
    let (paper, quick, valley) = (paper_slope(), quick_slope(), valley_slope());
    vec![
        ("paper_trees.stl", slopes::paper_trees(&paper)),
        ("paper_slope.stl", paper.facets),
        ("quick_trees.stl", slopes::quick_trees(&quick)),
        ("quick_slope.stl", quick.facets),
        ("valley_trees.stl", valley::valley_trees(&valley)),
        ("valley_slope.stl", valley.facets),
        ("paper_ridge.stl", shapes::paper_ridge()),
        ("paper_roof.stl", shapes::paper_roof()),
        ("paper_tetrahedron.stl", shapes::paper_tetrahedron()),
        ("paper_containers.stl", shapes::paper_containers()),
    ]
}

/// Writes the made files of `terrain/` into a directory.
///
/// # Errors
/// A file that cannot be written.
pub fn write_shipped(dir: &Path) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    for (name, facets) in shipped() {
        write_binary(&dir.join(name), &facets)?;
    }
    Ok(())
}

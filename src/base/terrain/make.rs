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

pub use forest::{Planted, TreeList, plant, read_list};
pub(super) use forest::{begins_like_list, is_list};
pub use shapes::{containers, jittered_plane, ridge, stairs, tetrahedron, v_groove};
pub use slopes::{Slope, natural_slope, paper_slope, quick_slope};
pub use stems::{Stem, square_stem, stem};
pub use valley::valley_slope;

use crate::terrain::stl::Facet;

/// Names of the made slopes and shapes, those of the files in `terrain/` without their ending.
pub const KINDS: [&str; 10] = [
    "paper_trees",
    "paper_slope",
    "quick_trees",
    "quick_slope",
    "valley_trees",
    "valley_slope",
    "paper_ridge",
    "paper_roof",
    "paper_tetrahedron",
    "paper_containers",
];

/// The made slope or shape of one of the [`KINDS`].
pub fn made(kind: &str) -> Option<Vec<Facet>> {
    Some(match kind {
        "paper_trees" => slopes::paper_trees(&paper_slope()),
        "paper_slope" => paper_slope().facets,
        "quick_trees" => slopes::quick_trees(&quick_slope()),
        "quick_slope" => quick_slope().facets,
        "valley_trees" => valley::valley_trees(&valley_slope()),
        "valley_slope" => valley_slope().facets,
        "paper_ridge" => shapes::paper_ridge(),
        "paper_roof" => shapes::paper_roof(),
        "paper_tetrahedron" => shapes::paper_tetrahedron(),
        "paper_containers" => shapes::paper_containers(),
        _ => return None,
    })
}

/// The made files of `terrain/` by name.
pub fn shipped() -> Vec<(String, Vec<Facet>)> {
    let file = |kind| Some((format!("{kind}.stl"), made(kind)?));
    KINDS.into_iter().filter_map(file).collect()
}

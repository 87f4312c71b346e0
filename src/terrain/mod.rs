//! The fixed world: welded triangles of slope and trees, what a sphere can touch of them, and the spatial index.

pub mod edges;
pub mod grid;
mod groups;
pub mod health;
pub mod make;
mod merge;
pub mod stl;
pub mod t_junctions;
pub mod weld;

use crate::rock::Vec3;
use std::path::PathBuf;

/// One mesh file of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The STL file.
    pub path: PathBuf,
    /// Index of its ground in the scene's list of grounds.
    pub ground: u16,
    /// Whether it was given under `[[trees]]`.
    pub is_tree: bool,
}

/// The terrain as it is computed with.
#[derive(Debug)]
pub struct Terrain {
    /// Map position of the local (0, 0, 0): `map = local + origin` (m).
    pub origin_m: Vec3,
    /// Welded vertices in local coordinates (m).
    pub vertices_m: Vec<Vec3>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Which [`Sheet`] each triangle came from.
    pub sheet_of: Vec<u16>,
    /// The mesh files.
    pub sheets: Vec<Sheet>,
}

//! Several STL soups become one mesh with shared vertices and known neighbours.
//!
//! Order of work: turn and scale each file, subtract the whole-metre centre of the common box (before anything is
//! rounded), merge vertices, drop triangles without area and exact duplicates, then list the edges. Everything follows
//! the order of the input: the same files give the same mesh, bit for bit.

use crate::error::{Error, Result};
use crate::rock::Vec3;
use crate::terrain::edges::Edges;
use crate::terrain::stl::Soup;
use std::path::Path;

/// Weld tolerance relative to the longest side of the box of the model (–).
const TOLERANCE_OF_SIZE: f64 = 1e-6;

/// A triangle with an area below this share of its longest edge squared (–) has no normal in `f64`.
const ZERO_AREA: f64 = 1e-14;

/// How many places a [`Tally`] names.
const EXAMPLES: usize = 5;

/// Which axis of a file points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Up {
    /// z up: the file is taken as it is.
    #[default]
    Z,
    /// y up: turned by +90° about x, `(x, y, z) → (x, −z, y)`.
    Y,
}

/// One soup and how it enters the mesh.
#[derive(Debug, Clone, Copy)]
pub struct Piece<'a> {
    /// The file it came from, for messages.
    pub file: &'a Path,
    /// Its facets.
    pub soup: &'a Soup,
    /// Its up axis.
    pub up: Up,
    /// Metres per unit of the file, positive.
    pub scale: f64,
    /// Number of the sheet its triangles belong to.
    pub sheet: u16,
}

/// How often something was found, and where the first few are.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Tally {
    /// How often.
    pub count: usize,
    /// Up to five places in map coordinates (m), in input order.
    pub examples_m: Vec<[f64; 3]>,
}

impl Tally {
    /// Counts one more, at `place_m` (map coordinates).
    pub fn add(&mut self, place_m: Vec3) {
        self.count += 1;
        if self.examples_m.len() < EXAMPLES {
            self.examples_m.push(place_m.into());
        }
    }
}

/// The welded mesh. Every vertex is used, every triangle has an area and occurs once.
#[derive(Debug, Clone)]
pub struct Welded {
    /// Map position of the local (0, 0, 0): `map = local + origin` (m). Whole metres plus the scene's origin.
    pub origin_m: Vec3,
    /// Vertices closer than this were merged (m).
    pub tolerance_m: f64,
    /// Vertices in local coordinates (m), more than the tolerance apart, in order of first use.
    pub vertices_m: Vec<Vec3>,
    /// Vertex indices of each triangle, wound as in the file.
    pub triangles: Vec<[u32; 3]>,
    /// [`Piece::sheet`] of each triangle.
    pub sheet_of: Vec<u16>,
    /// Number of the facet in its file, from 0.
    pub facet_of: Vec<u32>,
    /// Edges and who shares them.
    pub edges: Edges,
    /// Facets left out because they have repeated corners or no area.
    pub zero_area: Tally,
    /// Facets left out because a triangle with the same corners (wound either way) came before.
    pub duplicates: Tally,
    /// Corners that were moved onto a vertex up to the tolerance away.
    pub moved_corners: usize,
}

/// Welds the pieces into one mesh around the whole-metre centre of their box.
///
/// `map_origin_m` is the map position of the files' (0, 0, 0). Vertices within `tolerance_m` (1e-6 of the longest side
/// of the box if `None`, 0 merges exact copies only) of an earlier vertex become that vertex: no vertex moves further
/// than the tolerance, and chains of close vertices do not collapse.
///
/// # Errors
/// A scale or tolerance that is not usable, or no triangle with an area.
pub fn weld(pieces: &[Piece], map_origin_m: Vec3, tolerance_m: Option<f64>) -> Result<Welded> {
    todo!()
}

//! Several STL soups become one mesh with shared vertices and known neighbours.
//!
//! Order of work: turn and scale each file, subtract the whole-metre centre of the common box (before anything is
//! rounded), merge vertices, drop triangles without area, exact duplicates and what lies on others, list the edges, then
//! split triangles on whose edges vertices of others lie. Everything follows the order of the input: the same files give
//! the same mesh, bit for bit.

use crate::error::{Error, Result};
use crate::parallel;
use crate::rock::Vec3;
use crate::terrain::edges::{self, Edges};
use crate::terrain::faces::Mesh;
use crate::terrain::merge::Merger;
use crate::terrain::stl::Soup;
use common_box::CommonBox;
use parts::Parts;
use split::Splits;
use std::path::Path;
use std::sync::OnceLock;

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

impl Up {
    /// A point of the file, z up.
    pub(super) fn turned(self, point: Vec3) -> Vec3 {
        match self {
            Self::Z => point,
            Self::Y => Vec3::new(point.x, -point.z, point.y),
        }
    }
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

/// The box of a piece, from its lowest to its highest corner (m); of nothing, turned inside out.
type PieceBox = (Vec3, Vec3);

/// Longest side of a box (m), 0 without any facet.
fn longest_m((low, high): &PieceBox) -> f64 {
    (high - low).max().max(0.0)
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

/// The welded mesh. Every vertex is used, every triangle has an area and occurs once; those of one facet may be several.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Welded {
    /// Map position of the local (0, 0, 0): `map = local + origin` (m). Whole metres plus the scene's origin.
    pub origin_m: Vec3,
    /// Map position of the files' (0, 0, 0) (m), part of `origin_m`.
    pub map_origin_m: Vec3,
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
    /// Facets left out because triangles that came before cover them, within the tolerance.
    pub covered: Tally,
    /// Corners that were moved onto a vertex up to the tolerance away.
    pub moved_corners: usize,
    /// What was done where a vertex lies on an edge.
    pub splits: Splits,
    /// What hangs together, once it was asked for.
    pub(super) parts: OnceLock<Parts>,
}

/// Welds the pieces into one mesh around the whole-metre centre of their box.
///
/// `map_origin_m` is the map position of the files' (0, 0, 0). Vertices within `tolerance_m` (1e-6 of the longest side
/// of the box if `None`, 0 merges exact copies only) of an earlier vertex become that vertex: no vertex moves further
/// than the tolerance, and chains of close vertices do not collapse.
///
/// # Errors
/// A scale or tolerance that is not usable, coordinates larger than the Earth, pieces or triangles far from all others, or no
/// triangle with an area.
pub fn weld(pieces: &[Piece], map_origin_m: Vec3, tolerance_m: Option<f64>) -> Result<Welded> {
    join(pieces, map_origin_m, tolerance_m).map(Joined::finish)
}

/// Triangles over common vertices, when the pieces are needed no more: they take most of the memory.
#[derive(Debug)]
pub(super) struct Joined(Welded);

/// The first half of [`weld`].
///
/// # Errors
/// As [`weld`].
fn join(pieces: &[Piece], map_origin_m: Vec3, tolerance_m: Option<f64>) -> Result<Joined> {
    join_all(pieces, map_origin_m, tolerance_m).map(|(joined, _)| joined)
}

/// The same for the files of a scene, which a tolerance of its own must not take apart.
///
/// # Errors
/// As [`weld`], and a tolerance that merges away more than a trace of a piece.
pub(super) fn join_files(
    pieces: &[Piece],
    map_origin_m: Vec3,
    tolerance_m: Option<f64>,
) -> Result<Joined> {
    let (joined, lost) = join_all(pieces, map_origin_m, tolerance_m)?;
    if let Some(tolerance_m) = tolerance_m {
        collapsed::check(pieces, &lost, tolerance_m)?;
    }
    Ok(joined)
}

/// Joins the pieces; which triangles of each lost their area.
fn join_all(
    pieces: &[Piece],
    map_origin_m: Vec3,
    tolerance_m: Option<f64>,
) -> Result<(Joined, Vec<Vec<u32>>)> {
    let frame = CommonBox::around(pieces)?;
    let own_m = tolerance_m;
    let tolerance_m = own_m.unwrap_or(TOLERANCE_OF_SIZE * frame.size_m);
    if !(tolerance_m >= 0.0 && tolerance_m.is_finite()) {
        return Err(Error::Request(format!(
            "weld tolerance = {tolerance_m} m is not a length; write 0 or a few millimetres (0.001)"
        )));
    }
    let mut welded = Welded {
        origin_m: map_origin_m + frame.centre_m,
        map_origin_m,
        tolerance_m,
        sheet_of: Vec::with_capacity(frame.facets),
        ..Welded::default()
    };
    let lost = welded.take(pieces, &frame);
    if own_m.is_none() {
        far::check_collapsed(pieces, &lost, (tolerance_m, frame.size_m))?;
    }
    if welded.triangles.is_empty() {
        return Err(nothing_left(pieces, &welded));
    }
    Ok((Joined(welded), lost))
}

impl Joined {
    /// The second half of [`weld`].
    pub(super) fn finish(self) -> Welded {
        let Self(mut welded) = self;
        welded.list_edges();
        welded.drop_covered();
        welded.split_at_t_junctions();
        if welded.zero_area.count + welded.duplicates.count + welded.covered.count > 0 {
            welded.drop_unused_vertices();
        }
        welded
    }
}

impl Piece<'_> {
    /// A point of the file in metres, z up, not yet recentred.
    pub(super) fn placed(&self, point: Vec3) -> Vec3 {
        self.up.turned(point) * self.scale
    }

    fn check_scale(&self) -> Result<()> {
        if !(self.scale > 0.0 && self.scale.is_finite()) {
            let found = format!("{} is not a positive number", self.scale);
            let remedy = "write 1.0 for metres, 0.001 for millimetres";
            return Err(Error::input(self.file, "scale", found, remedy));
        }
        Ok(())
    }
}

impl Welded {
    /// The parts of the mesh as it is now.
    pub(super) fn parts(&self) -> &Parts {
        self.parts.get_or_init(|| Parts::of(self))
    }

    /// Frees what is known of parts: nobody asks for it once the mesh is indexed.
    pub(super) fn forget_parts(&mut self) {
        self.parts.take();
    }

    /// A local point in map coordinates.
    pub fn on_map(&self, local_m: Vec3) -> Vec3 {
        local_m + self.origin_m
    }

    /// The corners of a triangle, local (m).
    pub fn corners_m(&self, triangle: usize) -> [Vec3; 3] {
        Mesh { vertices_m: &self.vertices_m, triangles: &self.triangles }.corners_m(triangle as u32)
    }

    /// The two vertices of an edge, the lower number first.
    pub fn ends(&self, edge: u32) -> [u32; 2] {
        edges::ends(&self.triangles, edge)
    }

    /// From the first to the second end of an edge (m).
    pub fn edge_m(&self, edge: u32) -> Vec3 {
        let [a, b] = self.ends(edge);
        self.vertices_m[b as usize] - self.vertices_m[a as usize]
    }

    /// Merges vertices and keeps every facet that has an area; which of each piece had one before.
    fn take(&mut self, pieces: &[Piece], frame: &CommonBox) -> Vec<Vec<u32>> {
        let mut collapsed = vec![Vec::new(); pieces.len()];
        let mut merger = Merger::new(self.tolerance_m, frame.size_m, 3 * frame.facets);
        for (piece, collapsed) in pieces.iter().zip(&mut collapsed) {
            let facets = &piece.soup.facets;
            // `+ 0.0` turns −0.0 into 0.0.
            let local = |corner: Vec3| (piece.placed(corner) - frame.centre_m).map(|x| x + 0.0);
            let reach = self.tolerance_m / piece.scale;
            let (mut all, moved) = numbers::of(facets, reach, &local, &mut merger);
            self.moved_corners += moved;
            let merged = |number: usize| all[number].map(|v| merger.kept_m()[v as usize]);
            let flat = parallel::filter(all.len(), |number| !has_area(&merged(number as usize)));
            for &number in &flat {
                self.zero_area.add(merged(number as usize)[0] + self.origin_m);
                let had_one = has_area(&facets.at(number as usize).map(local));
                collapsed.extend(had_one.then_some(number));
            }
            let mut numbers: Vec<u32> = (0..all.len() as u32).collect();
            drop_at(&mut numbers, &flat);
            drop_at(&mut all, &flat);
            self.sheet_of.resize(self.sheet_of.len() + all.len(), piece.sheet);
            append(&mut self.facet_of, numbers);
            append(&mut self.triangles, all);
        }
        self.vertices_m = merger.into_kept_m();
        collapsed
    }

    /// Vertices that only dropped triangles used go; the others keep their order.
    fn drop_unused_vertices(&mut self) {
        let mut renumbered = vec![0u32; self.vertices_m.len()];
        for &v in self.triangles.iter().flatten() {
            renumbered[v as usize] = 1;
        }
        let mut used = renumbered.iter();
        self.vertices_m.retain(|_| used.next() == Some(&1));
        let mut next = 0;
        for number in &mut renumbered {
            next += std::mem::replace(number, next);
        }
        for v in self.triangles.iter_mut().flatten() {
            *v = renumbered[*v as usize];
        }
    }
}

/// Puts one list behind another; the first one is taken as it is.
fn append<T>(list: &mut Vec<T>, more: Vec<T>) {
    if list.is_empty() {
        *list = more;
    } else {
        list.extend(more);
    }
}

/// Removes the elements at the given ascending positions.
fn drop_at<T>(list: &mut Vec<T>, positions: &[u32]) {
    if positions.is_empty() {
        return;
    }
    let mut positions = positions.iter().peekable();
    let mut at = 0;
    list.retain(|_| {
        let drop = positions.next_if(|&&position| position == at).is_some();
        at += 1;
        !drop
    });
}

/// Whether the area exceeds [`ZERO_AREA`] of the longest edge squared (repeated corners have none).
fn has_area([a, b, c]: &[Vec3; 3]) -> bool {
    let longest2 = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    0.5 * (b - a).cross(&(c - a)).norm() >= ZERO_AREA * longest2 && longest2 > 0.0
}

fn nothing_left(pieces: &[Piece], welded: &Welded) -> Error {
    let Some(first) = pieces.first() else {
        return Error::Request("no mesh file is given; name at least one STL file".into());
    };
    let found = format!(
        "none of {} facets has an area after welding within {:.1e} m",
        welded.zero_area.count, welded.tolerance_m
    );
    Error::input(
        first.file,
        "mesh",
        found,
        "export the mesh again, or write another scale or weld_tolerance_m",
    )
}

mod collapsed;
mod common_box;
mod covered;
mod far;
mod numbers;
pub(in crate::terrain) mod parts;
mod repeated;
pub mod split;
pub mod t_junctions;
#[cfg(test)]
mod tests;

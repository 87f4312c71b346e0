//! What is wrong with the meshes of a scene, counted and located, and what is done about it.

mod found;
mod gaps;
mod holes;
mod measure;
mod near;
mod overlaps;
mod spikes;
mod table;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod seam_tests;

pub use found::Found;
pub use gaps::Gap;
pub use holes::Hole;
pub use overlaps::{HangingSheet, Overlap};
pub use spikes::Spike;

use crate::error::{Error, Result};
use crate::rock::Vec3;
use crate::terrain::stl::{CoarseText, Format, Spacing};
use crate::terrain::weld::{Piece, Tally, Welded};
use std::path::Path;

/// Steepest triangles that make a sheet, as cosine of their inclination (–): 80°. The rim of a wall or a stem looks nowhere.
const LEAST_FLAT: f64 = 0.17;

/// Most gaps and overlaps that are kept.
const MOST_NAMED: usize = 50;

/// What to do with a text of too few digits.
pub(super) const MORE_DIGITS: &str = "export it with three decimals or more, or with a map origin subtracted and origin_m in the scene";

/// One file as it was read.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FileHealth {
    /// The file, as people write it.
    pub file: String,
    /// What kind of file.
    pub format: Format,
    /// Solids in the file.
    pub solids: usize,
    /// Facets in the file.
    pub facets: usize,
    /// Share of facets whose winding faces down (–); about half for closed stems.
    pub facing_down: f64,
    /// Stored normals more than 30° off the winding; never used.
    pub normals_off: Tally,
    /// What 32-bit numbers do to the coordinates, in the unit of the file; `None` where they are stored with all digits.
    pub spacing: Option<Spacing>,
    /// What too few digits do to the coordinates of a text, where they do.
    #[serde(skip)]
    pub coarse: Option<CoarseText>,
    /// EPSG code of its coordinates, where the file names one.
    pub epsg: Option<u32>,
    /// What the file holds and what was done with it, in words.
    pub notes: Vec<String>,
    /// What looks wrong in it, in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

impl FileHealth {
    /// Examines files; `map_origin_m` is the map position of their (0, 0, 0).
    pub(super) fn of_all(pieces: &[Piece], map_origin_m: Vec3) -> Vec<Self> {
        pieces.iter().map(|piece| measure::file(piece, map_origin_m)).collect()
    }
}

/// The state of a welded terrain. All places are map coordinates (m).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Health {
    /// The files, in the order of the scene.
    pub files: Vec<FileHealth>,
    /// Map position of the local (0, 0, 0) (m).
    pub origin_m: [f64; 3],
    /// Weld tolerance (m).
    pub tolerance_m: f64,
    /// Triangles after welding.
    pub triangles: usize,
    /// Vertices after welding.
    pub vertices: usize,
    /// Edges after welding.
    pub edges: usize,
    /// Corners that moved when welded.
    pub moved_corners: usize,
    /// Facets left out: repeated corners or no area.
    pub zero_area: Tally,
    /// Facets left out: same corners as an earlier one.
    pub duplicates: Tally,
    /// Facets left out: those before cover them, within the tolerance.
    pub covered: Tally,
    /// Triangles more than 10⁴ times as long as high.
    pub needles: Tally,
    /// Edges of three or more triangles.
    pub non_manifold_edges: Tally,
    /// Edges of one triangle.
    pub border_edges: Tally,
    /// Connected runs of border edges: the outline, holes, and the ends of open stems.
    pub border_loops: usize,
    /// Border vertices on the inside of a border edge, before triangles were split there.
    pub t_junctions: Tally,
    /// Facets that were split there.
    pub split_facets: usize,
    /// What they were split into.
    pub split_into: usize,
    /// Vertices that still lie on an edge: its triangle is too thin to be split.
    pub t_junctions_left: Tally,
    /// Edges whose two triangles are wound against each other.
    pub flipped_edges: Tally,
    /// Triangles of each part that shares no edge with another, the largest first.
    pub parts: Vec<usize>,
    /// Where borders of the slope face each other across a small distance: the longest first, up to fifty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gaps: Vec<Gap>,
    /// A weld tolerance that closes the gaps of tiles that nearly meet (m); none where there are none, or where it would spoil the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closing_tolerance_m: Option<f64>,
    /// Places in the slope without ground.
    #[serde(skip_serializing_if = "Found::is_empty")]
    pub holes: Found<Hole>,
    /// Single corners of meshes far above or below all around them.
    #[serde(skip_serializing_if = "Found::is_empty")]
    pub spikes: Found<Spike>,
    /// Sheets that hang above another part of the slope.
    #[serde(skip_serializing_if = "Found::is_empty")]
    pub hanging: Found<HangingSheet>,
    /// Where two parts of the slope lie over each other, a rock's radius or less apart: the largest first, up to fifty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub overlaps: Vec<Overlap>,
    /// Lowest x, y and z (m).
    pub low_m: [f64; 3],
    /// Highest x, y and z (m).
    pub high_m: [f64; 3],
    /// Surface (m²).
    pub area_m2: f64,
    /// Edge lengths (m): shortest, 5 %, median, 95 %, longest.
    pub edge_quantiles_m: [f64; 5],
}

impl Health {
    /// Examines a welded terrain, all of it slope; `pieces` are what it was welded from.
    pub fn of(welded: &Welded, pieces: &[Piece]) -> Self {
        Self::with_files(welded, FileHealth::of_all(pieces, welded.map_origin_m), &|_| true)
    }

    /// Examines a welded terrain; `files` is what there is to say of what it was welded from, `is_slope` tells triangles of
    /// the slope from those of trees.
    pub(super) fn with_files(
        welded: &Welded,
        files: Vec<FileHealth>,
        is_slope: &(dyn Fn(u32) -> bool + Sync),
    ) -> Self {
        let edges = &welded.edges;
        let parts = welded.parts();
        let mut gaps = gaps::gaps(welded, parts, is_slope);
        gaps.truncate(MOST_NAMED);
        let (mut overlaps, hanging) = overlaps::overlaps(welded, parts, is_slope);
        overlaps.truncate(MOST_NAMED);
        let odd = measure::odd_edges(welded);
        let [low_m, high_m] = measure::box_m(welded);
        let edge_quantiles_m = measure::edge_quantiles_m(welded);
        // cells of an elevation model have been looked at as it was read
        let is_mesh = |t: u32| {
            let file = files.get(usize::from(welded.sheet_of[t as usize]));
            is_slope(t) && file.is_none_or(|file| file.format.is_mesh())
        };
        let spikes = spikes::spikes(welded, &is_mesh);
        Self {
            files,
            origin_m: welded.origin_m.into(),
            tolerance_m: welded.tolerance_m,
            triangles: welded.triangles.len(),
            vertices: welded.vertices_m.len(),
            edges: edges.len(),
            moved_corners: welded.moved_corners,
            zero_area: welded.zero_area.clone(),
            duplicates: welded.duplicates.clone(),
            covered: welded.covered.clone(),
            needles: measure::needles(welded),
            non_manifold_edges: odd.non_manifold,
            border_edges: odd.borders,
            border_loops: measure::border_loops(welded),
            t_junctions: welded.splits.junctions.clone(),
            split_facets: welded.splits.facets,
            split_into: welded.splits.pieces,
            t_junctions_left: welded.splits.left.clone(),
            flipped_edges: odd.flipped,
            parts: parts.sizes.clone(),
            closing_tolerance_m: gaps::closing_m(&gaps, edge_quantiles_m[1]),
            gaps,
            holes: holes::holes(welded, is_slope),
            spikes,
            hanging,
            overlaps,
            low_m,
            high_m,
            area_m2: measure::area_m2(welded),
            edge_quantiles_m,
        }
    }

    /// What looks wrong in the files, each with its name.
    pub fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let of_file = |file: &FileHealth| {
            let named = |warning: &String| format!("{}: {warning}", file.file);
            file.warnings.iter().map(named).collect::<Vec<_>>()
        };
        self.files.iter().flat_map(of_file).chain(self.mostly_flat()).chain(self.odd_places())
    }

    /// What to say of holes, spikes and sheets that hang in the air.
    fn odd_places(&self) -> impl Iterator<Item = String> + use<> {
        let place = |[x, y, _]: [f64; 3]| format!("({x:.1}, {y:.1})");
        let (holes, spikes, hanging) = (&self.holes, &self.spikes, &self.hanging);
        let hole = holes.largest.first().map(|of| {
            format!("holes in the slope: {}, the largest of {:.1} m² near {}; rocks that come there leave the terrain: fill them", holes.count, of.area_m2, place(of.at_m))
        });
        let spike = spikes.largest.first().map(|of| {
            format!("single corners far above or below all around them: {}, the farthest by {:.1} m at {}; errors of measurement, or trees and masts? rocks meet them as ground", spikes.count, of.height_m.abs(), place(of.at_m))
        });
        let sheet = hanging.largest.first().map(|of| {
            format!("sheets that hang above another part of the slope: {}, the largest of {:.1} m², {:.1} m above it near {}; rocks meet them as ground: leave them out if they are none", hanging.count, of.area_m2, of.height_m, place(of.at_m))
        });
        [hole, spike, sheet].into_iter().flatten()
    }

    /// Says that most triangles have no area, if so.
    pub(super) fn mostly_flat(&self) -> Option<String> {
        let (flat, all) = (self.zero_area.count, self.triangles + self.zero_area.count);
        (2 * flat > all).then(|| {
            format!("{flat} of {all} triangles have no area and are left out: what is left is hardly the terrain; does the file have too few digits?")
        })
    }

    /// Refuses a terrain whose binary files hold coordinates too large for 32 bits, or whose texts hold too few digits.
    ///
    /// # Errors
    /// Names the first such file and what to do.
    pub fn check(&self) -> Result<()> {
        let spoiled = self.files.iter().find_map(|file| {
            file.spacing.filter(Spacing::spoils).map(|spacing| (&file.file, spacing))
        });
        let wrong = |file: &str, found: String, remedy: String| {
            Err(Error::input(Path::new(file), "coordinates", found, remedy))
        };
        if let Some((file, spacing)) = spoiled {
            let remedy = format!(
                "export it as ASCII with {} decimals, or with a map origin subtracted and origin_m in the scene",
                spacing.decimals()
            );
            return wrong(file, spacing.to_string(), remedy);
        }
        let is_rounded = |file: &&FileHealth| file.coarse.is_some_and(|coarse| coarse.spoils());
        let Some(file) = self.files.iter().find(is_rounded) else { return Ok(()) };
        let found = file.coarse.map_or_else(String::new, |coarse| coarse.to_string());
        wrong(&file.file, found, MORE_DIGITS.to_owned())
    }
}

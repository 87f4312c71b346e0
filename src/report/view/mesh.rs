//! The terrain as a view shows it: whole-number vertices in order of first use.

use super::frame::QuantizedBox;
use super::pack::Section;
use super::part::TerrainPart;
use super::thin;
use crate::terrain::Terrain;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// Most triangles of ground, and most of trees, that a view shows: finer terrain is drawn coarser, and says so.
pub const MOST_TRIANGLES: usize = 400_000;

/// A mesh of ground and trees.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewMesh {
    /// Where it lies.
    pub frame: QuantizedBox,
    /// Vertices in steps of the frame, numbered in the order in which triangles first use them.
    pub vertices: Vec<[u32; 3]>,
    /// Corners of the triangles: ground first, then trees.
    pub triangles: Vec<[u32; 3]>,
    /// How many of them are ground.
    pub ground: usize,
    /// What was left out to keep it small; empty when nothing was.
    pub notes: Vec<String>,
}

/// What a section of a mesh says besides its columns.
#[derive(Serialize, Deserialize)]
struct Facts {
    frame: QuantizedBox,
    ground: usize,
    notes: Vec<String>,
}

impl ViewMesh {
    /// The mesh of a terrain, thinned where it has more than [`MOST_TRIANGLES`].
    pub fn of(terrain: &Terrain) -> Self {
        Self::limited(terrain, MOST_TRIANGLES)
    }

    /// The same with another limit.
    pub fn limited(terrain: &Terrain, most: usize) -> Self {
        let mut notes = Vec::new();
        let ground = thin::ground(&TerrainPart::of(terrain, false), most, &mut notes);
        let trees = thin::trees(TerrainPart::of(terrain, true).soup(), most, &mut notes);
        let places = || ground.places_m.iter().chain(&trees.places_m).copied();
        let frame = QuantizedBox::round(places());
        let shift = ground.places_m.len() as u32;
        let shifted = trees.triangles.iter().map(|corners| corners.map(|v| v + shift));
        let triangles: Vec<[u32; 3]> = ground.triangles.iter().copied().chain(shifted).collect();
        let (vertices, triangles) = by_first_use(&places().collect::<Vec<_>>(), &triangles);
        let vertices = vertices.into_iter().map(|place| frame.steps(place)).collect();
        Self { frame, vertices, triangles, ground: ground.triangles.len(), notes }
    }

    /// Place of a vertex, map coordinates (m).
    pub fn place_m(&self, vertex: u32) -> [f64; 3] {
        self.frame.place_m(self.vertices[vertex as usize])
    }

    /// Packed as text.
    pub fn text(&self) -> String {
        let mut section = Section::new(json!({
            "frame": self.frame, "ground": self.ground, "notes": self.notes
        }));
        section.add("vertices", 3, 1, self.vertices.concat());
        section.add("corners", 3, 0, counted_back(&self.triangles));
        section.text()
    }

    /// Reads [`Self::text`] back; none when it is none.
    pub fn read(text: &str) -> Option<Self> {
        let section = Section::read(text)?;
        let Facts { frame, ground, notes } = serde_json::from_value(section.facts.clone()).ok()?;
        let (vertices, _) = section.numbers("vertices").as_chunks();
        let corners = counted_up(section.numbers("corners"), vertices.len())?;
        let (triangles, _) = corners.as_chunks();
        let (vertices, triangles) = (vertices.to_vec(), triangles.to_vec());
        (ground <= triangles.len()).then_some(Self { frame, vertices, triangles, ground, notes })
    }
}

/// Vertices numbered in the order in which triangles first use them; unused ones go.
fn by_first_use(places: &[[f64; 3]], triangles: &[[u32; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut number = vec![u32::MAX; places.len()];
    let mut used = Vec::new();
    let mut renumbered = Vec::with_capacity(triangles.len());
    for corners in triangles {
        renumbered.push(corners.map(|v| {
            let number = &mut number[v as usize];
            if *number == u32::MAX {
                *number = used.len() as u32;
                used.push(places[v as usize]);
            }
            *number
        }));
    }
    (used, renumbered)
}

/// Corners counted back from the vertices seen so far; 0 is a new one.
fn counted_back(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut seen = 0;
    let code = |&corner: &u32| {
        let code = seen - corner;
        seen += u32::from(code == 0);
        code
    };
    triangles.as_flattened().iter().map(code).collect()
}

/// The corners again; none when one is not below `vertices`.
fn counted_up(codes: &[u32], vertices: usize) -> Option<Vec<u32>> {
    let mut seen = 0;
    let corner = |&code: &u32| {
        let corner = u32::checked_sub(seen, code)?;
        seen += u32::from(code == 0);
        ((corner as usize) < vertices).then_some(corner)
    };
    codes.iter().map(corner).collect()
}

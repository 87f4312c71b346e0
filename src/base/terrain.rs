//! The fixed world: welded triangles of slope and trees, what a sphere can touch of them, and the spatial index.

pub mod brims;
pub mod cliffs;
#[cfg(feature = "cloud")]
pub mod cloud;
pub mod coarser;
pub mod edges;
pub mod faces;
pub mod facets;
pub mod features;
pub mod floor;
mod ground;
pub mod formats;
pub mod geotiff;
pub mod grid;
pub mod health;
pub mod index;
pub mod make;
mod merge;
mod options;
pub mod read;
pub mod patches;
pub mod section;
pub mod seen;
pub mod standing;
mod stem_pieces;
pub mod stems;
pub mod stl;
pub mod walls;
pub mod way;
pub mod weld;

use crate::parallel;
use crate::rock::Vec3;
use faces::{Face, Mesh};
use features::Features;
use floor::Floor;
use index::Index;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Triangle;
use std::path::PathBuf;
use stems::Stems;
use weld::Welded;

/// A terrain of more triangles than this is kept in less than half of the memory: its faces are made anew at every look, and
/// the leaves of its index hold more triangles. Rocks come to rest at the same places, somewhat later.
pub const MANY_TRIANGLES: usize = 1 << 20;

/// One mesh file of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The file.
    pub path: PathBuf,
    /// Index of its ground in the scene's list of grounds.
    pub ground: u16,
    /// Whether it was given under `[[trees]]`.
    pub is_tree: bool,
}

/// The slope and the trees, welded, indexed and ready for computation. Triangles are in the order of the index.
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
    /// Number of the facet in its file, from 0; where zones of ground cut a file, in the file as cut.
    pub facet_of: Vec<u32>,
    /// The mesh files; a file on which zones lay other grounds stands there once for each.
    pub sheets: Vec<Sheet>,
    /// What a sphere can touch.
    pub features: Features,
    /// The spatial index.
    pub index: Index,
    /// Lower bounds of the slope's height, area by area.
    pub floor: Floor,
    /// Stems that can give way to a rock; none if all stand for good. The plan, which knows the limits, puts them here.
    pub stems: Option<Stems>,
    /// EPSG code of the map coordinates, where a file names one.
    pub epsg: Option<u32>,
    /// What zones of ground have done to the triangles; none without zones.
    pub patched: Option<patches::Patched>,
    /// Whether trees of a list were stood on the slope.
    pub has_tree_list: bool,
}

impl Terrain {
    /// Indexes a welded mesh.
    pub fn new(mut welded: Welded, sheets: Vec<Sheet>) -> Self {
        welded.forget_parts();
        let is_many = welded.triangles.len() > MANY_TRIANGLES;
        let sizes = if is_many { index::Sizes::SMALL } else { index::Sizes::FAST };
        let corners = |t: u32| welded.corners_m(t as usize);
        let (index, order) = Index::build(welded.triangles.len(), sizes, corners);
        let Welded { vertices_m, triangles, sheet_of, facet_of, edges, origin_m, .. } = welded;
        let triangles = in_order(&order, triangles);
        let (sheet_of, facet_of) = (in_order(&order, sheet_of), in_order(&order, facet_of));
        let edges = edges.reordered(&order);
        drop(order);
        let mesh = Mesh { vertices_m: &vertices_m, triangles: &triangles };
        let features = Features::of_edges(edges, mesh, !is_many);
        let is_ground = |t: u32| !sheets[usize::from(sheet_of[t as usize])].is_tree;
        let ground = |t: u32| is_ground(t).then(|| features.faces.at(t, mesh));
        let floor = Floor::of(ground, triangles.len(), index.bounds());
        Self {
            origin_m,
            vertices_m,
            triangles,
            sheet_of,
            facet_of,
            sheets,
            features,
            index,
            floor,
            stems: None,
            epsg: None,
            patched: None,
            has_tree_list: false,
        }
    }

    /// Memory that it takes (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val::<[Vec3]>(&self.vertices_m)
            + size_of_val::<[[u32; 3]]>(&self.triangles)
            + size_of_val::<[u16]>(&self.sheet_of)
            + size_of_val::<[u32]>(&self.facet_of)
            + size_of_val(self.index.nodes())
            + self.floor.bytes()
            + self.features.bytes()
    }

    /// The same with no edge and no corner left out.
    #[must_use]
    pub fn with_every_feature(mut self) -> Self {
        self.features = self.features.with_everything(&self.triangles);
        self
    }

    /// The same with every edge and corner looked at from wherever a ball is.
    #[must_use]
    pub fn from_anywhere(mut self) -> Self {
        self.features = self.features.from_anywhere();
        self
    }

    /// Whether a triangle belongs to a tree.
    #[inline]
    pub fn is_tree(&self, triangle: u32) -> bool {
        self.sheets[self.sheet_of[triangle as usize] as usize].is_tree
    }

    /// Its vertices and triangles.
    #[inline]
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh { vertices_m: &self.vertices_m, triangles: &self.triangles }
    }

    /// A triangle ready for use.
    #[inline]
    pub fn face(&self, triangle: u32) -> Face {
        self.features.faces.at(triangle, self.mesh())
    }

    /// The vertices joined to `vertex` by an edge, each once.
    pub fn neighbours(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        self.features.neighbours(vertex, self.mesh())
    }

    /// Corners of a triangle (m, local).
    #[inline]
    pub fn corners_m(&self, triangle: u32) -> [Vec3; 3] {
        self.mesh().corners_m(triangle)
    }

    /// Height of the highest slope surface above or below the map-plane point (x, y), local coordinates (m); trees
    /// are not ground. `None` outside the slope.
    pub fn ground_below(&self, x_m: f64, y_m: f64) -> Option<f64> {
        self.ground_under(x_m, y_m, f64::INFINITY)
    }

    /// Whether a place (m, local) is under the slope: there is some above it and none below. So are rocks that have fallen
    /// through a hole; beside the terrain, and over a hole, there is none above either.
    pub fn is_under_slope(&self, at: &Vec3) -> bool {
        self.ground_under(at.x, at.y, at.z).is_none() && self.ground_below(at.x, at.y).is_some()
    }

    /// The highest slope surface at (x, y) that is not above `under_m` (m, local).
    pub fn ground_under(&self, x_m: f64, y_m: f64, under_m: f64) -> Option<f64> {
        self.slope_under(x_m, y_m, under_m).map(|(height_m, _)| height_m)
    }

    /// Distance from a point to the nearest triangle (m), or `reach_m` when none is nearer.
    pub fn distance_m(&self, point: &Vec3, reach_m: f64) -> f64 {
        self.distance_to(point, reach_m, |_| true)
    }

    /// The same of the slope alone, without trees.
    pub fn slope_distance_m(&self, point: &Vec3, reach_m: f64) -> f64 {
        self.distance_to(point, reach_m, |triangle| !self.is_tree(triangle))
    }

    #[inline]
    fn distance_to(&self, point: &Vec3, reach_m: f64, is_one: impl Fn(u32) -> bool) -> f64 {
        let mut nearest = reach_m;
        self.index.near(point, reach_m, |start, count| {
            for triangle in (start..start + count).filter(|&t| is_one(t)) {
                let [a, b, c] = self.corners_m(triangle).map(Into::into);
                let distance =
                    Triangle::new(a, b, c).distance_to_local_point((*point).into(), true);
                nearest = nearest.min(distance);
            }
        });
        nearest
    }

    /// The highest slope surface at (x, y) that is not above `under_m`, and its unit normal (m, local).
    pub fn slope_under(&self, x_m: f64, y_m: f64, under_m: f64) -> Option<(f64, Vec3)> {
        self.triangle_under(x_m, y_m, under_m).map(|(height_m, triangle)| {
            let face = self.face(triangle);
            (height_m, face.e1.cross(&face.e2).normalize())
        })
    }

    /// The same surface, and its triangle.
    pub fn triangle_under(&self, x_m: f64, y_m: f64, under_m: f64) -> Option<(f64, u32)> {
        let (mut best, mut of) = (f64::NEG_INFINITY, None);
        self.index.along_vertical((x_m, y_m), under_m, |start, count| {
            for t in start..start + count {
                let height = self.height_on(t, x_m, y_m);
                if height > best && height <= under_m && !self.is_tree(t) {
                    (best, of) = (height, Some(t));
                }
            }
        });
        of.map(|triangle| (best, triangle))
    }

    /// Height of a triangle at (x, y) (m, local); −∞ beside it.
    pub fn height_on(&self, triangle: u32, x_m: f64, y_m: f64) -> f64 {
        section::height_of(&self.face(triangle), x_m, y_m)
    }
}

/// A list in another order.
#[expect(clippy::needless_pass_by_value, reason = "the old list goes at once: it is large")]
fn in_order<T: Copy + Default + Send + Sync>(order: &[u32], list: Vec<T>) -> Vec<T> {
    parallel::map(order.len(), |k| list[order[k] as usize])
}

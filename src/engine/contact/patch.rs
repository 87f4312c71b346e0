//! Contact patches: each connected part of the mesh inside a ball is one contact.
//!
//! The elastic energy of a ball of radius `R` with centre `c` on a mesh `K` counts every connected
//! part once,
//!
//! ```text
//! U(c) = p_N ∫₀ᴿ χ(K ∩ B(c, r)) (R − r) dr = p_N/2 Σ_σ w(σ) max(0, R − dist(c, σ))²
//! w(triangle) = 1,   w(edge) = 1 − its triangles,   w(vertex) = 1 − Σ w of the triangles and edges that hold it
//! ```
//!
//! with χ the Euler characteristic and the sum over all triangles, edges and vertices. Distances to
//! convex sets are continuously differentiable, so energy and force are continuous for every
//! triangulation. Where the ball just touches, and at ridges and apexes, a patch is the single
//! nearest point of the paper's sphere–plane and sphere–edge contacts.
//!
//! A patch is equivalent to one point contact: with `p = √(2U/p_N)`, `a = −∇p` and `n̂ = a/|a|`,
//! its force `p_N p a` is that of a spring of stiffness `p_N |a|²` pressed in by `p/|a|` along
//! `n̂`, with the same energy.
//!
//! Why not one spring per nearest point: where the foot of the centre crosses a seam between two
//! blunt faces, one nearest point vanishes with its whole penetration, and its energy is lost. On a
//! fold of 0.02 rad a rock left with 0.6 to 1.9 times the energy it came with, depending on where
//! it landed. With the sum above it leaves with 1.00000.
//!
//! Checks by hand. Coplanar triangles: all but one cancel, `U = p_N pen²/2`. Ridge: `+1 +1 −1` at
//! one point. Apex of three faces: `3 − 3 + 1`. Sharp valley with its fold out of reach: two
//! contacts. Blunt valley: `pen_A² + pen_B² − pen_fold²`.
//!
//! Cost: O(k log k) in the k triangles inside the ball, from the sort that brings the copies of an
//! edge together. It is paid only where a saddle of the distance may be inside the ball
//! (`has_saddle`); most steps need no patches.

use super::closest::{TrianglePart, closest_part};
use super::{ContactPoint, Feature, FeatureKind, PatchSums};
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::edges::ends;

/// One triangle inside the ball. Triangles of one patch form a tree (union–find); its root has the
/// sums of the patch.
#[derive(Debug, Clone, Copy)]
struct PressedTriangle {
    triangle: u32,
    /// Another triangle of the same patch, or itself at the root.
    parent: u32,
    /// Sums of the whole patch, once its parts are joined: kept at the root.
    sums: PatchSums,
    /// Nearest point of the patch.
    nearest: ContactPoint,
}

/// An edge or a vertex inside the ball, once for every triangle on it.
#[derive(Debug, Clone, Copy)]
struct SharedFeature {
    /// Edges by the numbers of their ends, then vertices by their own number.
    ///
    /// Sorting by the key brings the copies of one edge or vertex together, in an order that
    /// depends on no thread or hash.
    key: u64,
    /// Index of its triangle in the list of pressed triangles.
    index: u32,
    /// For an edge, one of its sides: three times the triangle plus 0, 1 or 2.
    side: u32,
    /// Distance from the centre to its nearest point (m), and the unit vector from there to the
    /// centre.
    distance_m: f64,
    normal: Vec3,
}

/// Bit that marks the key of a vertex. There are fewer than 2³¹ vertices, so the key of an edge,
/// two vertex numbers side by side, never sets it.
const VERTEX: u64 = 1 << 63;

/// Work space.
#[derive(Debug, Default)]
pub(super) struct PatchScratch {
    pressed: Vec<PressedTriangle>,
    shared: Vec<SharedFeature>,
}

impl PatchScratch {
    /// With capacity for the usual number of triangles.
    pub(super) fn with_room() -> Self {
        Self { pressed: Vec::with_capacity(128), shared: Vec::with_capacity(1024) }
    }

    /// Finds the patches of a ball of `radius` (m) at `centre` among `sheets`, all triangles near
    /// it. Calls `found` for each, in the order of their first triangles, with the equivalent point
    /// contact and the patch's nearest point.
    pub(super) fn find(
        &mut self,
        terrain: &Terrain,
        sheets: &[u32],
        (centre, radius): (&Vec3, f64),
        mut found: impl FnMut(ContactPoint, &ContactPoint),
    ) {
        self.pressed.clear();
        self.shared.clear();
        // triangles add w = 1 each; edges and vertices follow once each, after the sort
        for &t in sheets {
            self.add_triangle(terrain, t, (centre, radius));
        }
        self.shared.sort_unstable_by_key(|shared| (shared.key, shared.index));
        self.add_shared_features(terrain, radius);
        for k in 0..self.pressed.len() {
            // only roots of the union–find represent a patch
            let patch = &self.pressed[k];
            if patch.parent as usize == k
                && let Some(touch) = patch.sums.equivalent_contact(&patch.nearest, radius)
            {
                found(touch, &patch.nearest);
            }
        }
    }

    /// Removes the patches found last.
    pub(super) fn clear(&mut self) {
        self.pressed.clear();
    }

    /// The nearest feature of the patch, among those found last, that contains `feature`: the patch
    /// into which a lost contact has merged, so that its springs can be passed on.
    pub(super) fn holding(&self, terrain: &Terrain, feature: Feature) -> Option<Feature> {
        let has = |pressed: &PressedTriangle| feature.belongs_to(terrain, pressed.triangle);
        let mut index = self.pressed.iter().position(has)?;
        while self.pressed[index].parent as usize != index {
            index = self.pressed[index].parent as usize;
        }
        Some(self.pressed[index].nearest.feature)
    }

    /// Adds a triangle that is inside the ball, and those of its sides and corners that are.
    ///
    /// Distances to convex sets make each term `max(0, R − dist)²` continuously differentiable in
    /// the centre.
    fn add_triangle(&mut self, terrain: &Terrain, t: u32, (centre, radius): (&Vec3, f64)) {
        let face = terrain.face(t);
        // |height| is a lower bound of the distance to the triangle: most are rejected by one
        // scalar product
        let height = face.n.dot(&(centre - face.a));
        if height.abs() >= radius {
            return;
        }
        let corners = terrain.corners_m(t);
        let (point, part) = closest_part(&corners, centre);
        let off = centre - point;
        let distance2 = off.norm_squared();
        // a centre exactly on the mesh has no normal; it cannot get there while the springs are
        // stiff enough (pen < 0.1 R)
        if distance2 >= radius * radius || distance2 == 0.0 {
            return;
        }
        let (edges, vertices) = (&terrain.features.edges, terrain.triangles[t as usize]);
        let feature = match part {
            TrianglePart::Face => Feature { kind: FeatureKind::Face, id: t },
            TrianglePart::Side(k) => {
                Feature { kind: FeatureKind::Edge, id: edges.edge_of(3 * t + k as u32) }
            }
            TrianglePart::Corner(k) => Feature { kind: FeatureKind::Vertex, id: vertices[k] },
        };
        // on a face the plane's normal is more exact than the difference of two close points
        let (distance_m, normal) = match part {
            TrianglePart::Face => (height.abs(), if height < 0.0 { -face.n } else { face.n }),
            _ => (distance2.sqrt(), off / distance2.sqrt()),
        };
        let index = self.pressed.len() as u32;
        let nearest = ContactPoint::with_normal(feature, t, (normal, distance_m));
        let sums = PatchSums::of(&nearest, radius);
        self.pressed.push(PressedTriangle { triangle: t, parent: index, sums, nearest });
        // Every side and corner inside the ball is stored once for each of its triangles; this
        // joins triangles into patches. No copy is missing: if an edge is inside the ball, so are
        // all its triangles, as none is farther away than its edge.
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let side = b - a;
            let s = (side.dot(&(centre - a)) / side.norm_squared()).clamp(0.0, 1.0);
            let side_id = 3 * t + k as u32;
            // the two ends in ascending order: both triangles of an edge give it the same key,
            // whichever way they run along it
            let [lower, upper] = ends(&terrain.triangles, side_id).map(u64::from);
            let edge = (lower << 32 | upper, index, side_id);
            self.add_shared(edge, (centre - (a + side * s), radius));
            let vertex = (VERTEX + u64::from(vertices[k]), index, side_id);
            self.add_shared(vertex, (centre - a, radius));
        }
    }

    #[inline]
    fn add_shared(&mut self, (key, index, side): (u64, u32, u32), (off, radius): (Vec3, f64)) {
        let distance2 = off.norm_squared();
        if distance2 < radius * radius && distance2 > 0.0 {
            let distance_m = distance2.sqrt();
            self.shared.push(SharedFeature {
                key,
                index,
                side,
                distance_m,
                normal: off / distance_m,
            });
        }
    }

    /// Adds every edge and vertex once to its patch, and joins the triangles that share it.
    ///
    /// `w(edge) = 1 − its triangles` is −1 for an ordinary edge, 0 at a border, −2 where three
    /// sheets meet. The weight of a vertex is stored with the terrain: it involves all triangles
    /// and edges around the vertex, and all of them are inside the ball if the vertex is.
    fn add_shared_features(&mut self, terrain: &Terrain, radius: f64) {
        let mut start = 0;
        while start < self.shared.len() {
            let first = self.shared[start];
            let same = self.shared[start..].iter().take_while(|next| next.key == first.key).count();
            for k in start + 1..start + same {
                self.unite(first.index, self.shared[k].index);
            }
            let features = &terrain.features;
            let weight = if first.key < VERTEX {
                1.0 - features.edges.count_on(first.side) as f64
            } else {
                f64::from(features.vertex_weight[(first.key - VERTEX) as usize])
            };
            // the copies differ by rounding at most; the first is used for all
            let penetration = radius - first.distance_m;
            let root = self.root(first.index);
            let sums = &mut self.pressed[root as usize].sums;
            sums.pen2 += weight * penetration * penetration;
            sums.pen_n += first.normal * (weight * penetration);
            start += same;
        }
    }

    /// Root of a patch, with path halving (Tarjan): nearly O(1) a call.
    fn root(&mut self, mut index: u32) -> u32 {
        while self.pressed[index as usize].parent != index {
            let up = self.pressed[index as usize].parent;
            self.pressed[index as usize].parent = self.pressed[up as usize].parent;
            index = up;
        }
        index
    }

    /// Joins two patches. The root with the smaller number stays, so the result does not depend on
    /// the order of joins.
    fn unite(&mut self, first: u32, second: u32) {
        let (first, second) = (self.root(first), self.root(second));
        if first == second {
            return;
        }
        let (kept, merged) = (first.min(second) as usize, first.max(second) as usize);
        let from = self.pressed[merged];
        self.pressed[merged].parent = kept as u32;
        let patch = &mut self.pressed[kept];
        patch.sums.add(&from.sums);
        if from.nearest.distance_m < patch.nearest.distance_m {
            patch.nearest = from.nearest;
        }
    }
}

//! Features that a rock may touch, as stored for the tests at each position.

use crate::contact::closest::Segment;
use crate::contact::{ContactPoint, Feature, FeatureKind};
use crate::rock::Vec3;

/// A face that may hold the foot of a centre within the margin. Its three sides are planes through
/// its edges, so the test for a foot takes three scalar products.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearFace {
    pub(super) id: u32,
    /// First corner (m).
    pub(super) a: Vec3,
    /// Unit normal.
    pub(super) n: Vec3,
    /// Unit vectors in the plane of the face, outwards across each side.
    pub(super) out: [Vec3; 3],
    /// `out[k] · x ≤ rim[k]` inside.
    pub(super) rim: [f64; 3],
}

/// A convex edge, or one at a border, that can be outside of all its faces as seen from the centre.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearEdge {
    pub(super) id: u32,
    pub(super) triangle: u32,
    /// Its segment.
    pub(super) line: Segment,
    /// Range of outward face normals in `directions`.
    pub(super) directions: (u32, u32),
    /// Whether only one face is at the edge: then another sheet may pass through it.
    pub(super) at_border: bool,
}

/// A vertex that is behind none of its edges for some centre within the margin.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearVertex {
    pub(super) id: u32,
    pub(super) triangle: u32,
    /// Its position (m).
    pub(super) p: Vec3,
    /// Range of edge directions in `directions`.
    pub(super) directions: (u32, u32),
    /// Whether a border of the mesh passes through it.
    pub(super) at_border: bool,
}

/// A feature where the distance may have a saddle or a maximum inside the ball.
#[derive(Debug, Clone, Copy)]
pub(super) enum NearSaddle {
    /// A concave edge, with its range of outward face normals in `directions`.
    Edge { line: Segment, directions: (u32, u32) },
    /// A vertex.
    Vertex { id: u32, p: Vec3 },
}

/// Whether a rock at `centre` (m) may touch an edge from within `reach` while the centre moves up
/// to `distance` (m): the foot on the edge, and the line within reach.
#[inline]
pub(super) fn may_touch_edge(line: &Segment, centre: &Vec3, (distance, reach): (f64, f64)) -> bool {
    let to = centre - line.a;
    let s = line.along.dot(&to);
    s >= -distance
        && s <= line.length + distance
        && (to - line.along * s).norm_squared() <= reach * reach
}

impl NearFace {
    /// Whether the foot of `point` lies inside, or at most `slack` (m) outside.
    #[inline]
    pub(super) fn holds_foot_of(&self, point: &Vec3, slack: f64) -> bool {
        (0..3).all(|k| self.out[k].dot(point) <= self.rim[k] + slack)
    }

    /// The contact of a centre at `height` (m).
    #[inline]
    pub(super) fn touch(&self, height: f64) -> ContactPoint {
        let normal = if height < 0.0 { -self.n } else { self.n };
        let feature = Feature { kind: FeatureKind::Face, id: self.id };
        ContactPoint::with_normal(feature, self.id, (normal, height.abs()))
    }
}

/// Features that may be touched, by kind; the lists keep their memory from query to query.
#[derive(Debug, Default)]
pub(super) struct NearFeatures {
    pub(super) faces: Vec<NearFace>,
    pub(super) edges: Vec<NearEdge>,
    pub(super) vertices: Vec<NearVertex>,
    pub(super) saddles: Vec<NearSaddle>,
    /// All triangles within reach; used only near a border or a saddle.
    pub(super) sheets: Vec<u32>,
}

impl NearFeatures {
    /// With capacity for the usual number of features.
    pub(super) fn with_room() -> Self {
        Self {
            faces: Vec::with_capacity(64),
            edges: Vec::with_capacity(64),
            vertices: Vec::with_capacity(64),
            saddles: Vec::with_capacity(64),
            sheets: Vec::with_capacity(256),
        }
    }

    pub(super) fn clear(&mut self) {
        self.faces.clear();
        self.edges.clear();
        self.vertices.clear();
        self.saddles.clear();
        self.sheets.clear();
    }
}

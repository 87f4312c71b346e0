//! Convex edges and vertices among the collected features, for the contact search of blocks.
//!
//! The edges and faces of a block touch the mesh's edges and vertices too (`contact::block`). The
//! search for a block needs the features themselves, that for a sphere only the contacts found. All
//! vectors are in the terrain's frame.

use super::Neighbours;
use crate::contact::closest::Segment;
use crate::contact::{Feature, FeatureKind};
use crate::rock::Vec3;

/// Edges are collinear if direction and offset differ by less than this (–, offset over length).
const COLLINEAR: f64 = 1e-6;

/// A convex edge of the mesh.
///
/// `outward` are unit vectors in the planes of its triangles, outwards across the edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SharpEdge<'a> {
    pub(crate) feature: Feature,
    pub(crate) triangle: u32,
    pub(crate) line: Segment,
    pub(crate) outward: &'a [Vec3],
    pub(crate) at_border: bool,
}

impl SharpEdge<'_> {
    /// Whether another edge is part of the same straight line.
    pub(crate) fn is_collinear_with(&self, other: &Self) -> bool {
        let (line, other) = (&self.line, &other.line);
        let normal_part = |x: Vec3| x - line.along * line.along.dot(&x);
        normal_part(other.along).norm() <= COLLINEAR
            && normal_part(other.a - line.a).norm() <= COLLINEAR * line.length
    }
}

/// A convex vertex of the mesh at `p` (m); `edges` are unit vectors along the edges that start
/// there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SharpVertex<'a> {
    pub(crate) feature: Feature,
    pub(crate) triangle: u32,
    pub(crate) p: Vec3,
    pub(crate) edges: &'a [Vec3],
    pub(crate) at_border: bool,
}

impl SharpVertex<'_> {
    /// Whether it is the extreme point of its edges in a direction, up to a sine of `slack` (–).
    pub(crate) fn is_extreme_along(&self, up: &Vec3, slack: f64) -> bool {
        self.edges.iter().all(|edge| edge.dot(up) <= slack)
    }

    /// Whether an edge passes straight through the vertex, up to a sine of `slack` (–): such a
    /// vertex only divides an edge.
    pub(crate) fn divides_straight_edge(&self, slack: f64) -> bool {
        let continues = |edge: &Vec3| {
            self.edges.iter().any(|other| (edge + other).norm_squared() <= slack * slack)
        };
        self.edges.iter().any(continues)
    }
}

impl Neighbours {
    /// Length of the path (m) on which a foot that moves with `u` (m/s) stays on a face; 0 if the
    /// face is not among those collected.
    pub(crate) fn path_on_face_m(&self, face: u32, (foot, u): (&Vec3, &Vec3)) -> f64 {
        let Some(face) = self.all.faces.iter().find(|near| near.id == face) else { return 0.0 };
        let leaves_s = (0..3).filter_map(|k| {
            let speed = face.out[k].dot(u);
            (speed > 0.0).then(|| (face.rim[k] - face.out[k].dot(foot)).max(0.0) / speed)
        });
        leaves_s.fold(f64::INFINITY, f64::min) * u.norm()
    }

    /// Number of edges that can be touched within the margin.
    pub(crate) fn sharp_edge_count(&self) -> usize {
        self.all.edges.len()
    }

    /// The edges that can be touched within the margin, with unit directions outwards from their
    /// triangles.
    pub(crate) fn sharp_edges(&self) -> impl Iterator<Item = SharpEdge<'_>> {
        self.all.edges.iter().map(|edge| SharpEdge {
            feature: Feature { kind: FeatureKind::Edge, id: edge.id },
            triangle: edge.triangle,
            line: edge.line,
            outward: self.directions_of(edge.directions),
            at_border: edge.at_border,
        })
    }

    /// The vertices that can be touched within the margin, with unit directions along their edges.
    pub(crate) fn sharp_vertices(&self) -> impl Iterator<Item = SharpVertex<'_>> {
        self.all.vertices.iter().map(|vertex| SharpVertex {
            feature: Feature { kind: FeatureKind::Vertex, id: vertex.id },
            triangle: vertex.triangle,
            p: vertex.p,
            edges: self.directions_of(vertex.directions),
            at_border: vertex.at_border,
        })
    }

    /// Whether the collection is valid for all points within `around_m` of a point. For a block the
    /// corners, not only the centre, must stay inside the margin.
    pub(crate) fn covers_ball(&self, point: &Vec3, around_m: f64) -> bool {
        (point - self.centre).norm() + around_m <= self.margin
    }

    /// How far (m) the centre of a block, of bounding radius `bound` with corner balls of radius
    /// `ball` (m), may move from `centre` while all features it can touch are known; negative if
    /// they are not.
    pub(crate) fn block_margin_m(&self, centre: &Vec3, (ball, bound): (f64, f64)) -> f64 {
        // a collection for another radius has other features; contacts are as far away as the
        // ball's radius, and half of that again is reserved for rounding
        let is_own = (self.radius - ball).abs() <= f64::EPSILON * ball
            && self.query_radius_m() >= 1.5 * ball;
        let known = if is_own { self.margin + ball - bound } else { f64::NEG_INFINITY };
        known - (centre - self.centre).norm()
    }

    /// Distance from a centre within the margin up to which features are known (m).
    pub(crate) fn query_radius_m(&self) -> f64 {
        self.reach - self.margin
    }

    /// All triangles within reach, including those without convex features: a corner may touch
    /// their faces.
    pub(crate) fn triangles(&self) -> &[u32] {
        &self.all.sheets
    }
}

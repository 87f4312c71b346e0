//! Features of the mesh that a block may touch within a window, sorted by the earliest possible
//! time.
//!
//! No part of a block touches a feature before the bounding ball does, whatever the rotation.
//! Features that the ball does not reach within the window are left out. A part whose safe time
//! already ends at a nearer feature examines no later one.

use super::clearance::safe_time_s;
use super::{BlockFlight, ROUNDING_MARGIN, TOUCHING};
use crate::contact::closest::{Segment, closest_on};
use crate::contact::neighbours::Neighbours;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// A feature, and the time (s) before which no part of the block touches it.
#[derive(Debug, Clone, Copy)]
pub(super) struct FeatureAhead<T> {
    pub(super) from_s: f64,
    pub(super) feature: T,
}

/// A triangle with a corner (m) and the unit normal of its plane: looked up once per window, used
/// hundreds of times.
#[derive(Debug, Clone, Copy)]
pub(super) struct TriangleAhead {
    pub(super) id: u32,
    pub(super) a: Vec3,
    pub(super) n: Vec3,
}

/// All features ahead, soonest first; lists keep their memory from window to window.
#[derive(Debug, Default)]
pub(super) struct FeaturesAhead {
    /// For the corners of the block.
    pub(super) triangles: Vec<FeatureAhead<TriangleAhead>>,
    /// For its edges: convex edges of the mesh.
    pub(super) edges: Vec<FeatureAhead<Segment>>,
    /// For its faces: convex vertices of the mesh (m).
    pub(super) vertices: Vec<FeatureAhead<Vec3>>,
}

/// The bounding ball of a block at the beginning of a window.
struct BallAhead<'a> {
    flight: &'a BlockFlight<'a>,
    begins_s: f64,
    centre: Vec3,
    velocity: Vec3,
}

impl BallAhead<'_> {
    /// Time (s) before which the ball certainly does not touch a convex feature whose point nearest
    /// to its centre is given (m).
    fn earliest_s(&self, nearest: &Vec3) -> f64 {
        let block = self.flight.block;
        let off = self.centre - nearest;
        let distance = off.norm();
        let gap = distance * (1.0 - ROUNDING_MARGIN) - block.bound_m - TOUCHING * block.radius_m;
        if gap <= 0.0 {
            return self.begins_s;
        }
        // weight alone bends the path of the centre
        let (closing, acceleration) = (-off.dot(&self.velocity), self.flight.path.gravity * off.z);
        self.begins_s + safe_time_s((gap, closing / distance), acceleration / distance)
    }
}

impl FeaturesAhead {
    /// Collects those of the `near` features that may be touched in a window of the flight that
    /// `begins` and `ends` (s).
    pub(super) fn collect(
        &mut self,
        terrain: &Terrain,
        flight: &BlockFlight,
        near: &mut Neighbours,
        (begins, ends): (f64, f64),
    ) {
        let path = &flight.path;
        let (centre, velocity) = (path.centre(begins), path.velocity(begins));
        let ball = BallAhead { flight, begins_s: begins, centre, velocity };
        near.tested += near.triangles().len() as u64;
        let triangles = near.triangles().iter().map(|&id| {
            let face = terrain.face(id);
            let nearest = closest_on(&terrain.corners_m(id), &ball.centre);
            (TriangleAhead { id, a: face.a, n: face.n }, nearest)
        });
        let edges = near.sharp_edges().map(|edge| (edge.line, edge.line.nearest_to(&ball.centre)));
        let vertices = near.sharp_vertices().map(|vertex| (vertex.p, vertex.p));
        list(&mut self.triangles, triangles, (&ball, ends));
        list(&mut self.edges, edges, (&ball, ends));
        list(&mut self.vertices, vertices, (&ball, ends));
    }
}

/// Lists the features that may be touched before the window `ends` (s), each with its point nearest
/// to the ball's centre.
fn list<T>(
    to: &mut Vec<FeatureAhead<T>>,
    features: impl Iterator<Item = (T, Vec3)>,
    (ball, ends): (&BallAhead, f64),
) {
    to.clear();
    let ahead = features.map(|(feature, p)| FeatureAhead { from_s: ball.earliest_s(&p), feature });
    to.extend(ahead.filter(|ahead| ahead.from_s < ends));
    // a stable sort: the order is fixed also for equal times
    to.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
}

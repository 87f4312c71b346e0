//! What of the mesh a block may meet within a window, in the order of the times from which on it may.
//!
//! No part of a block meets a feature before the ball around it does, however it turns. What that ball does not reach within the window
//! is left out of it, and of what is left a part of the block that has found a nearer feature looks at no later one.

use super::clearance::safe_time_s;
use super::{BlockFlight, ROUNDING_MARGIN, TOUCHING};
use crate::contact::closest::{Segment, closest_on};
use crate::contact::neighbours::Neighbours;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// A feature, and the time (s) before which nothing of the block meets it.
#[derive(Debug, Clone, Copy)]
pub(super) struct FeatureAhead<T> {
    pub(super) from_s: f64,
    pub(super) feature: T,
}

/// A triangle with a corner (m) and the unit normal of its plane: looked up once a window, asked hundreds of times.
#[derive(Debug, Clone, Copy)]
pub(super) struct TriangleAhead {
    pub(super) id: u32,
    pub(super) a: Vec3,
    pub(super) n: Vec3,
}

/// All of them, soonest first; lists keep their memory from window to window.
#[derive(Debug, Default)]
pub(super) struct FeaturesAhead {
    /// For the corners of the block.
    pub(super) triangles: Vec<FeatureAhead<TriangleAhead>>,
    /// For its edges: those of the mesh that stand out.
    pub(super) edges: Vec<FeatureAhead<Segment>>,
    /// For its faces: vertices of the mesh that stand out (m).
    pub(super) vertices: Vec<FeatureAhead<Vec3>>,
}

/// The ball around a block as a window begins.
struct BallAhead<'a> {
    flight: &'a BlockFlight<'a>,
    begins_s: f64,
    centre: Vec3,
    velocity: Vec3,
}

impl BallAhead<'_> {
    /// Before which time (s) the ball surely does not come to a convex feature with this point (m) nearest to its centre.
    fn earliest_s(&self, nearest: &Vec3) -> f64 {
        let block = self.flight.block;
        let off = self.centre - nearest;
        let distance = off.norm();
        let gap = distance * (1.0 - ROUNDING_MARGIN) - block.bound_m - TOUCHING * block.radius_m;
        if gap <= 0.0 {
            return self.begins_s;
        }
        // weight alone bounds the way of the centre
        let (closing, bend) = (-off.dot(&self.velocity), self.flight.path.gravity * off.z);
        self.begins_s + safe_time_s((gap, closing / distance), bend / distance)
    }
}

impl FeaturesAhead {
    /// Those among the `near` ones that may be met in a window of the flight that `begins` and `ends` (s).
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
        let vertices = near.sharp_vertices().map(|peak| (peak.p, peak.p));
        list(&mut self.triangles, triangles, (&ball, ends));
        list(&mut self.edges, edges, (&ball, ends));
        list(&mut self.vertices, vertices, (&ball, ends));
    }
}

/// Lists features, each with its point nearest to the ball's centre, that may be met before the window `ends` (s).
fn list<T>(
    to: &mut Vec<FeatureAhead<T>>,
    features: impl Iterator<Item = (T, Vec3)>,
    (ball, ends): (&BallAhead, f64),
) {
    to.clear();
    let ahead = features.map(|(feature, p)| FeatureAhead { from_s: ball.earliest_s(&p), feature });
    to.extend(ahead.filter(|ahead| ahead.from_s < ends));
    // in a fixed order also where times are the same
    to.sort_by(|one, other| one.from_s.total_cmp(&other.from_s));
}

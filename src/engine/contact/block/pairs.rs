//! Contacts of an edge or a face of the block with an edge or a vertex of the mesh.

use super::lines::{crossing, foot_or_end, nearest_at_ends};
use super::{BlockContactPoint, DIRECTION_SLACK, PosedBlock};
use crate::body::Ridge;
use crate::contact::closest::Segment;
use crate::contact::neighbours::{Neighbours, SharpEdge, SharpVertex};
use crate::contact::{ContactPoint, Feature};
use crate::rock::Vec3;
use crate::terrain::Terrain;

impl PosedBlock<'_> {
    /// Adds the contacts of the block's edges with one edge of the mesh: those of the active pairs,
    /// or of all other pairs.
    pub(super) fn add_edge_contacts(
        &self,
        (near, terrain): (&Neighbours, &Terrain),
        edge: &SharpEdge,
        (reach, is_active_pass): (f64, bool),
        found: &mut Vec<BlockContactPoint>,
    ) {
        let nearest = edge.line.nearest_to(&self.pose.centre);
        if is_active_pass && !self.is_any_active(edge.feature)
            || !self.is_near(&nearest, reach)
            || self.is_outside_box([&edge.line.a, &(edge.line.a + edge.line.vector())], reach)
        {
            return;
        }
        let is_same = |other: Feature| {
            near.sharp_edges()
                .any(|near_edge| near_edge.feature == other && near_edge.is_collinear_with(edge))
        };
        let low = self.corners_below(&nearest, reach);
        for (part, ridge) in self.ridges_below(low) {
            if self.is_active(part, edge.feature) != is_active_pass {
                continue;
            }
            let Some((p, foot, is_past_end)) = self.nearest_of(ridge, &edge.line, is_active_pass)
            else {
                continue;
            };
            let off = p - foot;
            let distance = off.norm();
            if distance >= reach || distance <= DIRECTION_SLACK * self.block.ball_m {
                continue;
            }
            let normal = off / distance;
            let [own, other] = self.slacks((part, edge.feature), (&p, found), is_same);
            if edge.outward.iter().any(|out| out.dot(&normal) < -other)
                || !self.is_in_normal_cone(&ridge.into, &normal, own)
                || edge.at_border && near.is_covered(terrain, edge.feature, &foot, (&p, distance))
            {
                continue;
            }
            let touch = ContactPoint::with_normal(edge.feature, edge.triangle, (normal, distance));
            self.add((part, &p), (&touch, is_past_end), found);
        }
    }

    /// Nearest points of an edge of the block and one of the mesh, and whether they lie past an
    /// end. Past an end only an active pair remains in contact.
    fn nearest_of(
        &self,
        ridge: &Ridge,
        edge: &Segment,
        is_active_pass: bool,
    ) -> Option<(Vec3, Vec3, bool)> {
        let [a, b] = ridge.ends.map(|k| self.corners[usize::from(k)]);
        let cross = crossing((a, b - a), (edge.a, edge.along));
        let inside = |(s, t): &(f64, f64)| *s > 0.0 && *s < 1.0 && *t > 0.0 && *t < edge.length;
        if let Some((s, t)) = cross.filter(inside) {
            return Some((a + (b - a) * s, edge.a + edge.along * t, false));
        }
        let ends = [edge.a, edge.a + edge.vector()];
        is_active_pass.then(|| {
            let [p, foot] = nearest_at_ends([a, b], ends);
            (p, foot, true)
        })
    }

    /// Adds the contacts of the block's edges and faces with one vertex of the mesh: those of the
    /// active pairs, or of all other pairs.
    pub(super) fn add_vertex_contacts(
        &self,
        on: (&Neighbours, &Terrain),
        vertex: &SharpVertex,
        (reach, is_active_pass): (f64, bool),
        found: &mut Vec<BlockContactPoint>,
    ) {
        if is_active_pass && !self.is_any_active(vertex.feature)
            || !self.is_near(&vertex.p, reach)
            || self.is_outside_box([&vertex.p, &vertex.p], reach)
        {
            return;
        }
        let low = self.corners_below(&vertex.p, reach);
        if low == 0 {
            return;
        }
        for (part, ridge) in self.ridges_below(low) {
            if self.is_active(part, vertex.feature) != is_active_pass {
                continue;
            }
            let ends = ridge.ends.map(|k| self.corners[usize::from(k)]);
            let (p, is_beside) = foot_or_end(ends, &vertex.p);
            let distance = (p - vertex.p).norm();
            let is_apart = distance > DIRECTION_SLACK * self.block.ball_m && distance < reach;
            if is_beside && !is_active_pass || !is_apart {
                continue;
            }
            let normal = (p - vertex.p) / distance;
            let [own, other] = self.slacks((part, vertex.feature), (&p, found), |_| false);
            if self.is_in_normal_cone(&ridge.into, &normal, own)
                && is_extreme_and_uncovered(on, vertex, (&normal, other), (&p, distance))
            {
                let touch =
                    ContactPoint::with_normal(vertex.feature, vertex.triangle, (normal, distance));
                // if one of the vertex's edges is nearer, the contact continues there
                let is_past_end = is_beside || !vertex.is_extreme_along(&normal, DIRECTION_SLACK);
                self.add((part, &p), (&touch, is_past_end), found);
            }
        }
        // a face that lies on a straight edge touches it where the face's own edges cross it,
        // however many vertices divide that edge
        if !vertex.divides_straight_edge(DIRECTION_SLACK) {
            self.add_face_contacts(on, vertex, (reach, is_active_pass), found);
        }
    }

    /// Adds the contacts of the block's faces with one vertex of the mesh: those of the active
    /// pairs, or of all other pairs.
    fn add_face_contacts(
        &self,
        on: (&Neighbours, &Terrain),
        vertex: &SharpVertex,
        (reach, is_active_pass): (f64, bool),
        found: &mut Vec<BlockContactPoint>,
    ) {
        let own = self.pose.attitude.inverse_transform_vector(&(vertex.p - self.pose.centre));
        let before = self.corners.len() + self.block.core.ridges.len();
        for (face, part) in self.block.core.faces.iter().zip(before..) {
            if self.is_active(part, vertex.feature) != is_active_pass {
                continue;
            }
            let height = face.normal.dot(&own) - face.level;
            let over = || self.block.core.is_over(face, &own);
            let (p, normal, is_past_end) = if height > 0.0 && height < reach && over() {
                let normal = -(self.pose.attitude * face.normal);
                (vertex.p + normal * height, normal, false)
            } else if is_active_pass {
                let p = self.nearest_on_rim(face, &vertex.p);
                let Some(normal) =
                    (p - vertex.p).try_normalize(DIRECTION_SLACK * self.block.ball_m)
                else {
                    continue;
                };
                (p, normal, !over())
            } else {
                continue;
            };
            let distance = normal.dot(&(p - vertex.p));
            let [_, other] = self.slacks((part, vertex.feature), (&p, found), |_| false);
            if distance < reach
                && is_extreme_and_uncovered(on, vertex, (&normal, other), (&p, distance))
            {
                let touch =
                    ContactPoint::with_normal(vertex.feature, vertex.triangle, (normal, distance));
                self.add((part, &p), (&touch, is_past_end), found);
            }
        }
    }
}

/// Whether a vertex is the extreme point of its edges along a normal, within a slack (–), and no
/// other sheet lies between it and the block at `p`.
fn is_extreme_and_uncovered(
    (near, terrain): (&Neighbours, &Terrain),
    vertex: &SharpVertex,
    (normal, slack): (&Vec3, f64),
    (p, distance): (&Vec3, f64),
) -> bool {
    let is_covered =
        || vertex.at_border && near.is_covered(terrain, vertex.feature, &vertex.p, (p, distance));
    vertex.is_extreme_along(normal, slack) && !is_covered()
}

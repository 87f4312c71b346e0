//! Pairs of an edge or a face of the block with an edge or a vertex of the mesh.

use super::lines::{crossing, foot_or_end, nearest_at_ends};
use super::{BlockTouch, DIRECTION_SLACK, Placed};
use crate::body::Ridge;
use crate::contact::closest::Segment;
use crate::contact::neighbours::{Neighbours, Peak, SharpEdge};
use crate::contact::{ContactPoint, Feature};
use crate::rock::Vec3;
use crate::terrain::Terrain;

impl Placed<'_> {
    /// The block's edges that cross an edge of the mesh: those held, or all others.
    pub(super) fn on_edge(
        &self,
        (near, terrain): (&Neighbours, &Terrain),
        edge: &SharpEdge,
        (reach, is_held): (f64, bool),
        found: &mut Vec<BlockTouch>,
    ) {
        let nearest = edge.line.nearest_to(&self.pose.centre);
        if is_held && !self.holds_any(edge.feature)
            || !self.is_near(&nearest, reach)
            || self.is_beside([&edge.line.a, &(edge.line.a + edge.line.way())], reach)
        {
            return;
        }
        let is_same = |other: Feature| {
            near.sharp_edges().any(|one| one.feature == other && one.goes_straight_on(edge))
        };
        let low = self.low_corners(&nearest, reach);
        for (part, ridge) in self.low_ridges(low) {
            if self.holds(part, edge.feature) != is_held {
                continue;
            }
            let Some((p, foot, is_past)) = self.nearest_of(ridge, &edge.line, is_held) else {
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
                || !self.faces_out(&ridge.into, &normal, own)
                || edge.at_border && near.is_covered(terrain, edge.feature, &foot, (&p, distance))
            {
                continue;
            }
            let touch = point(edge.feature, edge.triangle, (normal, distance));
            self.add((part, &p), (&touch, is_past), found);
        }
    }

    /// Where an edge of the block and one of the mesh are nearest, a point on each, and whether that is past an end, where only one held still is.
    fn nearest_of(
        &self,
        ridge: &Ridge,
        edge: &Segment,
        is_held: bool,
    ) -> Option<(Vec3, Vec3, bool)> {
        let [a, b] = ridge.ends.map(|k| self.corners[usize::from(k)]);
        let cross = crossing((a, b - a), (edge.a, edge.along));
        let inside = |(s, t): &(f64, f64)| *s > 0.0 && *s < 1.0 && *t > 0.0 && *t < edge.length;
        if let Some((s, t)) = cross.filter(inside) {
            return Some((a + (b - a) * s, edge.a + edge.along * t, false));
        }
        let ends = [edge.a, edge.a + edge.way()];
        is_held.then(|| {
            let [p, foot] = nearest_at_ends([a, b], ends);
            (p, foot, true)
        })
    }

    /// The block's edges and faces over a vertex of the mesh: those held, or all others.
    pub(super) fn on_peak(
        &self,
        on: (&Neighbours, &Terrain),
        peak: &Peak,
        (reach, is_held): (f64, bool),
        found: &mut Vec<BlockTouch>,
    ) {
        if is_held && !self.holds_any(peak.feature)
            || !self.is_near(&peak.p, reach)
            || self.is_beside([&peak.p, &peak.p], reach)
        {
            return;
        }
        let low = self.low_corners(&peak.p, reach);
        if low == 0 {
            return;
        }
        for (part, ridge) in self.low_ridges(low) {
            if self.holds(part, peak.feature) != is_held {
                continue;
            }
            let ends = ridge.ends.map(|k| self.corners[usize::from(k)]);
            let (p, is_beside) = foot_or_end(ends, &peak.p);
            let distance = (p - peak.p).norm();
            let is_apart = distance > DIRECTION_SLACK * self.block.ball_m && distance < reach;
            if is_beside && !is_held || !is_apart {
                continue;
            }
            let normal = (p - peak.p) / distance;
            let [own, other] = self.slacks((part, peak.feature), (&p, found), |_| false);
            if self.faces_out(&ridge.into, &normal, own)
                && stands_out(on, peak, (&normal, other), (&p, distance))
            {
                let touch = point(peak.feature, peak.triangle, (normal, distance));
                // where one of its edges is nearer, that goes on for it
                let is_past = is_beside || !peak.is_top(&normal, DIRECTION_SLACK);
                self.add((part, &p), (&touch, is_past), found);
            }
        }
        // a face that lies on a straight edge is held where its own edges cross that edge, however many vertices divide it
        if !peak.is_straight(DIRECTION_SLACK) {
            self.faces_on(on, peak, (reach, is_held), found);
        }
    }

    /// The block's faces over a vertex of the mesh: those held, or all others.
    fn faces_on(
        &self,
        on: (&Neighbours, &Terrain),
        peak: &Peak,
        (reach, is_held): (f64, bool),
        found: &mut Vec<BlockTouch>,
    ) {
        let own = self.pose.attitude.inverse_transform_vector(&(peak.p - self.pose.centre));
        let before = self.corners.len() + self.block.core.ridges.len();
        for (face, part) in self.block.core.faces.iter().zip(before..) {
            if self.holds(part, peak.feature) != is_held {
                continue;
            }
            let height = face.normal.dot(&own) - face.level;
            let over = || self.block.core.is_over(face, &own);
            let (p, normal, is_past) = if height > 0.0 && height < reach && over() {
                let normal = -(self.pose.attitude * face.normal);
                (peak.p + normal * height, normal, false)
            } else if is_held {
                let p = self.on_rim(face, &peak.p);
                let Some(normal) = (p - peak.p).try_normalize(DIRECTION_SLACK * self.block.ball_m)
                else {
                    continue;
                };
                (p, normal, !over())
            } else {
                continue;
            };
            let distance = normal.dot(&(p - peak.p));
            let [_, other] = self.slacks((part, peak.feature), (&p, found), |_| false);
            if distance < reach && stands_out(on, peak, (&normal, other), (&p, distance)) {
                let touch = point(peak.feature, peak.triangle, (normal, distance));
                self.add((part, &p), (&touch, is_past), found);
            }
        }
    }
}

/// Whether a vertex stands out of the mesh along a normal, within a slack (–), and no other sheet lies between it and the block at `p`.
fn stands_out(
    (near, terrain): (&Neighbours, &Terrain),
    peak: &Peak,
    (normal, slack): (&Vec3, f64),
    (p, distance): (&Vec3, f64),
) -> bool {
    let is_covered =
        || peak.at_border && near.is_covered(terrain, peak.feature, &peak.p, (p, distance));
    peak.is_top(normal, slack) && !is_covered()
}

fn point(feature: Feature, triangle: u32, (normal, distance_m): (Vec3, f64)) -> ContactPoint {
    ContactPoint { feature, triangle, normal, distance_m, gain2: 1.0 }
}

//! Where a block touches the mesh.
//!
//! A contact is a strict local minimum of the distance to the mesh for **one feature of the block** (not of the distance between the
//! two bodies: a box lying flat would then have one contact at a time and rattle). Each pair of features owns its contacts:
//!
//! | block | mesh | test |
//! |---|---|---|
//! | corner | face, edge, vertex | that of a ball |
//! | edge | edge | feet inside both; the normal outside of every triangle at the mesh's edge, its opposite between the block's two faces |
//! | edge | vertex | foot inside the block's edge; the vertex behind none of its own edges; the same of the block |
//! | face | vertex | foot inside the face; the vertex behind none of its own edges, and none of them goes straight on in another |
//!
//! Only edges and vertices that stand out of the mesh take part, so most pairs need no test at all.
//!
//! A pair that presses goes on beyond the ends and the rims of its features, at the points of both that are nearest, until it lets go: the distance
//! of two convex sets has neither a jump nor a kink. Where an edge of the block slides off over its corner, the corner presses too, and what
//! the edge's spring held would be lost. Where the next feature begins there, it takes the spring over: `remember` of the blocks' springs.

use super::neighbours::SAME;
use super::neighbours::{Neighbours, Peak, SharpEdge};
use super::{ContactPoint, ContactPoints, Feature};
use crate::body::{Block, HullFace, Ridge};
use crate::rock::Vec3;
use crate::terrain::Terrain;
use nalgebra::Rotation3;

/// Tests of directions are inclusive to this (–) …
const DIRECTION_SLACK: f64 = 1e-9;
/// … and to this for a contact that is held (–, sine of an angle): a block that lies flat on an edge rests on both sides of it.
const HELD_SLACK: f64 = 0.2;
/// Edges closer to parallel than this meet at their ends (–, squared sine).
const PARALLEL: f64 = 1e-12;

/// Most contacts that act on a block at a time: a block has 64 corners at most, so a prism has half of them on a face. On a face with more than
/// 32 those that span most are kept.
pub(crate) const MOST_TOUCHES: usize = 32;

/// Where a block is and how it is turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Centre of mass (m, local).
    pub centre: Vec3,
    /// From the block's principal frame to the world.
    pub attitude: Rotation3<f64>,
}

impl Pose {
    /// A point of the block's frame in the world (m, local).
    #[inline]
    pub fn point(&self, own: &Vec3) -> Vec3 {
        self.centre + self.attitude * own
    }
}

/// One contact of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockTouch {
    /// What of the block touches: corners, then edges, then faces, counted through.
    pub part: u16,
    /// What of the mesh is touched.
    pub feature: Feature,
    /// Triangle whose sheet and ground it answers with.
    pub triangle: u32,
    /// Unit normal from the mesh to the block.
    pub normal: Vec3,
    /// From the centre of mass to the touching point of the block's surface (m).
    pub lever: Vec3,
    /// Distance between the surfaces (m); pressed in when negative.
    pub gap_m: f64,
    /// Stiffness relative to that of a single point (–), of a corner pressed into a fold; see [`ContactPoint::gain2`].
    pub gain2: f64,
    /// Whether it is past the ends of its features, and there only because it presses already.
    pub is_past: bool,
}

/// A block at a pose, with its corners there.
struct Placed<'a> {
    block: &'a Block,
    pose: &'a Pose,
    corners: &'a [Vec3],
    held: &'a [(u16, Feature)],
}

/// The contacts of a block, and the work space of the search for them.
#[derive(Debug, Default)]
pub struct BlockTouches {
    /// Those found last.
    pub found: Vec<BlockTouch>,
    /// Pairs of a part of the block and a feature of the mesh that press already.
    pub held: Vec<(u16, Feature)>,
    corners: Vec<Vec3>,
    /// Corner by corner, a place where it was (m) and how far from there nothing was at least (m).
    clear: Vec<(Vec3, f64)>,
}

impl BlockTouches {
    /// Forgets what was seen of another block.
    pub fn forget(&mut self) {
        self.found.clear();
        self.held.clear();
        self.clear.clear();
    }
}

/// The contacts of a block that are no further away than `reach_m`, in a fixed order: corners, edges, faces. `near` must have been
/// collected with the balls' radius, for a margin that holds the core. A pair in `touches.held` stays a contact as long as it presses.
pub fn touches(
    near: &mut Neighbours,
    terrain: &Terrain,
    (block, pose): (&Block, &Pose),
    reach_m: f64,
    touches: &mut BlockTouches,
) {
    let BlockTouches { found, held, corners, clear } = touches;
    found.clear();
    corners.clear();
    corners.extend(block.core.corners.iter().map(|own| pose.point(own)));
    let placed = Placed { block, pose, corners, held };
    let reach = block.ball_m + reach_m;
    let (mut of_ball, sees) = (ContactPoints::default(), near.sees_m().max(reach));
    clear.resize(corners.len(), (Vec3::repeat(f64::INFINITY), 0.0));
    for ((k, p), (seen, far)) in corners.iter().enumerate().zip(clear) {
        // where nothing was near, nothing is nearer than the corner has moved since
        if *far > reach && (p - *seen).norm_squared() < (*far - reach).powi(2) {
            continue;
        }
        near.touches(terrain, p, sees, &mut of_ball);
        (*seen, *far) = (*p, of_ball.iter().map(|touch| touch.distance_m).fold(sees, f64::min));
        for touch in of_ball.iter().filter(|touch| touch.distance_m < reach) {
            placed.add((k, p), (touch, false), found);
        }
    }
    for edge in near.sharp_edges() {
        placed.on_edge((near, terrain), &edge, reach, found);
    }
    for peak in near.peaks() {
        placed.on_peak((near, terrain), &peak, reach, found);
    }
}

impl Placed<'_> {
    /// Adds the contact of a core point `p` on a part of the block, unless it is there already.
    fn add(
        &self,
        (part, p): (usize, &Vec3),
        (touch, is_past): (&ContactPoint, bool),
        found: &mut Vec<BlockTouch>,
    ) {
        let ball = self.block.ball_m;
        let (lever, gap_m) = (p - self.pose.centre - touch.normal * ball, touch.distance_m - ball);
        let near = SAME * ball;
        // sheets over each other touch the same point of the block at different distances: each has its spring
        let is_known = found.iter().any(|other| {
            (other.normal - touch.normal).norm_squared() <= SAME * SAME
                && (other.lever - lever).norm_squared() <= near * near
                && (other.gap_m - gap_m).abs() <= near
        });
        // what presses has a spring of its own, also where another contact comes to the same place
        if !is_known || self.holds(part, touch.feature) {
            found.push(BlockTouch {
                part: part as u16,
                feature: touch.feature,
                triangle: touch.triangle,
                normal: touch.normal,
                lever,
                gap_m,
                gain2: touch.gain2,
                is_past,
            });
        }
    }

    /// The block's edges that cross an edge of the mesh.
    fn on_edge(
        &self,
        (near, terrain): (&Neighbours, &Terrain),
        edge: &SharpEdge,
        reach: f64,
        found: &mut Vec<BlockTouch>,
    ) {
        let along = edge.along.dot(&(self.pose.centre - edge.a)).clamp(0.0, edge.length);
        let nearest = edge.a + edge.along * along;
        if !self.is_near(&nearest, reach) {
            return;
        }
        let low = self.low_corners(&nearest, reach);
        for (part, ridge) in self.low_ridges(low) {
            let [a, b] = ridge.ends.map(|k| self.corners[usize::from(k)]);
            let cross = crossing((a, b - a), (edge.a, edge.along));
            let inside = |(s, t): &(f64, f64)| *s > 0.0 && *s < 1.0 && *t > 0.0 && *t < edge.length;
            let within = cross.filter(inside);
            let [p, foot] = match within {
                Some((s, t)) => [a + (b - a) * s, edge.a + edge.along * t],
                None if self.holds(part, edge.feature) => {
                    nearest_at_ends([a, b], [edge.a, edge.a + edge.along * edge.length])
                }
                None => continue,
            };
            let off = p - foot;
            let distance = off.norm();
            if distance >= reach || distance <= DIRECTION_SLACK * self.block.ball_m {
                continue;
            }
            let normal = off / distance;
            let slack = self.slack(part, edge.feature);
            if edge.outward.iter().any(|out| out.dot(&normal) < -slack)
                || !self.faces_out(&ridge.into, &normal, slack)
                || edge.at_border && near.is_covered(terrain, edge.feature, &foot, (&p, distance))
            {
                continue;
            }
            let touch = point(edge.feature, edge.triangle, (normal, distance));
            self.add((part, &p), (&touch, within.is_none()), found);
        }
    }

    /// The block's edges and faces over a vertex of the mesh.
    fn on_peak(
        &self,
        (near, terrain): (&Neighbours, &Terrain),
        peak: &Peak,
        reach: f64,
        found: &mut Vec<BlockTouch>,
    ) {
        if !self.is_near(&peak.p, reach) {
            return;
        }
        let low = self.low_corners(&peak.p, reach);
        if low == 0 {
            return;
        }
        let own = self.pose.attitude.inverse_transform_vector(&(peak.p - self.pose.centre));
        let touches = |part: usize, normal: &Vec3| {
            let slack = self.slack(part, peak.feature);
            peak.edges.iter().all(|edge| edge.dot(normal) <= slack)
        };
        let covered = |p: &Vec3, distance: f64| {
            peak.at_border && near.is_covered(terrain, peak.feature, &peak.p, (p, distance))
        };
        for (part, ridge) in self.low_ridges(low) {
            let [a, b] = ridge.ends.map(|k| self.corners[usize::from(k)]);
            let s = (peak.p - a).dot(&(b - a)) / (b - a).norm_squared();
            let p = a + (b - a) * s.clamp(0.0, 1.0);
            let distance = (p - peak.p).norm();
            let is_beside = s <= 0.0 || s >= 1.0;
            if is_beside && !self.holds(part, peak.feature)
                || distance >= reach
                || distance <= DIRECTION_SLACK * self.block.ball_m
            {
                continue;
            }
            let normal = (p - peak.p) / distance;
            let slack = self.slack(part, peak.feature);
            if touches(part, &normal)
                && self.faces_out(&ridge.into, &normal, slack)
                && !covered(&p, distance)
            {
                let touch = point(peak.feature, peak.triangle, (normal, distance));
                self.add((part, &p), (&touch, is_beside), found);
            }
        }
        // a face that lies on a straight edge is held where its own edges cross that edge, however many vertices divide it
        if peak.is_straight(DIRECTION_SLACK) {
            return;
        }
        let before = self.corners.len() + self.block.core.ridges.len();
        for (k, face) in self.block.core.faces.iter().enumerate() {
            let part = before + k;
            let height = face.normal.dot(&own) - face.level;
            let over = || self.block.core.is_over(face, &own);
            let (p, normal, is_past) = if height > 0.0 && height < reach && over() {
                let normal = -(self.pose.attitude * face.normal);
                (peak.p + normal * height, normal, false)
            } else if self.holds(part, peak.feature) {
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
            if distance < reach && touches(part, &normal) && !covered(&p, distance) {
                let touch = point(peak.feature, peak.triangle, (normal, distance));
                self.add((part, &p), (&touch, is_past), found);
            }
        }
    }

    /// The point of the rim of a face of the block that is nearest to a point.
    fn on_rim(&self, face: &HullFace, at: &Vec3) -> Vec3 {
        let place = |k: &u8| self.corners[usize::from(*k)];
        let ends = face.corners.iter().zip(face.corners.iter().cycle().skip(1));
        let feet = ends.map(|(a, b)| foot_between([place(a), place(b)], at));
        let away2 = |p: &Vec3| (p - at).norm_squared();
        feet.min_by(|p, q| away2(p).total_cmp(&away2(q))).unwrap_or(*at)
    }

    /// Whether a point of the mesh may be nearer to the core than `reach` (m).
    fn is_near(&self, point: &Vec3, reach: f64) -> bool {
        let core = self.block.bound_m - self.block.ball_m;
        (point - self.pose.centre).norm_squared() <= (core + reach).powi(2)
    }

    /// The block's corners, bit by bit, that stand less than `reach` (m) off the plane through the nearest point of a part of the mesh,
    /// square to the line to the block's centre. The part lies behind that plane, so what has no end among them is further away.
    fn low_corners(&self, nearest: &Vec3, reach: f64) -> u64 {
        let Some(up) = (self.pose.centre - nearest).try_normalize(0.0) else { return u64::MAX };
        let level = up.dot(nearest) + reach + DIRECTION_SLACK * self.block.ball_m;
        let bit = |(k, p): (usize, &Vec3)| u64::from(up.dot(p) < level) << k;
        self.corners.iter().enumerate().map(bit).fold(0, std::ops::BitOr::bitor)
    }

    /// The block's edges with an end among such corners, with their numbers among its parts.
    fn low_ridges(&self, low: u64) -> impl Iterator<Item = (usize, &Ridge)> {
        self.ridges().filter(move |(_, ridge)| ridge.ends.iter().any(|end| low >> end & 1 != 0))
    }

    /// The block's edges with their numbers among its parts.
    fn ridges(&self) -> impl Iterator<Item = (usize, &Ridge)> {
        (self.corners.len()..).zip(&self.block.core.ridges)
    }

    /// Whether the opposite of a direction lies between the normals of the two faces at an edge of the block.
    fn faces_out(&self, into: &[Vec3; 2], normal: &Vec3, slack: f64) -> bool {
        let own = self.pose.attitude.inverse_transform_vector(normal);
        into.iter().all(|into| into.dot(&own) >= -slack)
    }

    /// How far the normal of a pair may be out of bounds (–).
    fn slack(&self, part: usize, feature: Feature) -> f64 {
        if self.holds(part, feature) { HELD_SLACK } else { DIRECTION_SLACK }
    }

    /// Whether a pair presses already.
    fn holds(&self, part: usize, feature: Feature) -> bool {
        self.held.contains(&(part as u16, feature))
    }
}

fn point(feature: Feature, triangle: u32, (normal, distance_m): (Vec3, f64)) -> ContactPoint {
    ContactPoint { feature, triangle, normal, distance_m, gain2: 1.0 }
}

/// Where two endless lines are nearest: the share along the first direction, the way along the second, a unit vector.
fn crossing((p, e): (Vec3, Vec3), (a, f): (Vec3, Vec3)) -> Option<(f64, f64)> {
    let w = p - a;
    let (ee, ef, ew, fw) = (e.norm_squared(), e.dot(&f), e.dot(&w), f.dot(&w));
    let across = ee - ef * ef;
    if across <= PARALLEL * ee {
        return None;
    }
    Some(((ef * fw - ew) / across, (ee * fw - ef * ew) / across))
}

/// The point of a line between two ends that is nearest to `p`.
fn foot_between([a, b]: [Vec3; 2], p: &Vec3) -> Vec3 {
    let way = b - a;
    a + way * ((p - a).dot(&way) / way.norm_squared()).clamp(0.0, 1.0)
}

/// Where two lines that do not cross between their ends are nearest: a point on each, one of which is an end.
fn nearest_at_ends(one: [Vec3; 2], other: [Vec3; 2]) -> [Vec3; 2] {
    let from = one.map(|p| [p, foot_between(other, &p)]);
    let to = other.map(|p| [foot_between(one, &p), p]);
    let nearer = |near: [Vec3; 2], next: [Vec3; 2]| {
        let away2 = |[p, q]: [Vec3; 2]| (p - q).norm_squared();
        if away2(next) < away2(near) { next } else { near }
    };
    [from[1], to[0], to[1]].into_iter().fold(from[0], nearer)
}

/// Keeps the `most` contacts that span most: the deepest, then always the one farthest from those kept.
pub(crate) fn keep_widest(touches: &mut Vec<BlockTouch>, most: usize) {
    let deepest = (0..touches.len()).min_by(|&i, &j| touches[i].gap_m.total_cmp(&touches[j].gap_m));
    touches.swap(0, deepest.unwrap_or(0));
    for kept in 1..most {
        let apart = |k: usize| {
            let to = |other: &BlockTouch| (other.lever - touches[k].lever).norm();
            touches[..kept].iter().map(to).fold(f64::INFINITY, f64::min) - touches[k].gap_m.max(0.0)
        };
        let next = (kept..touches.len()).max_by(|&i, &j| apart(i).total_cmp(&apart(j)));
        touches.swap(kept, next.unwrap_or(kept));
    }
    touches.truncate(most);
}

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
//! That is looked for with the slack with which the pair was held: a box that friction tips forward by a hair is nearest to a crest at its front edge
//! alone, and its rear edge presses on as it did.

mod lines;
mod pairs;

use super::neighbours::Neighbours;
use super::neighbours::SAME;
use super::{ContactPoint, ContactPoints, Feature};
use crate::body::{Block, HullFace, Ridge};
use crate::rock::Vec3;
use crate::terrain::Terrain;
use lines::foot_between;
use nalgebra::Rotation3;

/// Tests of directions are inclusive to this (–) …
const DIRECTION_SLACK: f64 = 1e-9;
/// … and to this for a contact that is held (–, sine of an angle): a block that lies flat on an edge rests on both sides of it.
const ACTIVE_SLACK: f64 = 0.2;
/// A contact whose point was no further away than this is the same one that has gone on to the next feature (–, relative to
/// the balls' radius).
pub(crate) const SAME_POINT: f64 = 0.5;

/// Most contacts that act on a block at a time: a block has 64 corners at most, so a prism has half of them on a face. On a face with more than
/// 32 those that span most are kept.
pub(crate) const MAX_BLOCK_CONTACTS: usize = 32;

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
pub struct BlockContactPoint {
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
    pub is_past_end: bool,
}

impl BlockContactPoint {
    /// Whether a pair may go on for this one, which is past the ends of its features: with the next feature of the mesh, or the next part
    /// of the block.
    pub(crate) fn can_continue_as(&self, part: u16, feature: Feature) -> bool {
        self.is_past_end && (self.part == part || self.feature == feature)
    }
}

/// Edges of the mesh near a block from which on it pays to ask first which of them lie beside it.
const BOX_TEST_EDGES: usize = 64;

/// A block at a pose, with its corners there.
struct PosedBlock<'a> {
    block: &'a Block,
    pose: &'a Pose,
    corners: &'a [Vec3],
    /// Lowest and highest coordinates of the core in its own frame (m).
    core_box_m: Option<[Vec3; 2]>,
    /// In order of their features.
    held: &'a [(u16, Feature)],
}

/// The contacts of a block, and the work space of the search for them.
#[derive(Debug, Default)]
pub struct BlockContactPoints {
    /// Those found last.
    pub found: Vec<BlockContactPoint>,
    /// Pairs of a part of the block and a feature of the mesh that press already.
    pub held: Vec<(u16, Feature)>,
    corners: Vec<Vec3>,
    /// Corner by corner, a place where it was (m) and how far from there nothing was at least (m).
    clearances: Vec<(Vec3, f64)>,
}

impl BlockContactPoints {
    /// Forgets what was seen of another block.
    pub fn forget(&mut self) {
        self.found.clear();
        self.held.clear();
        self.clearances.clear();
    }
}

/// The contacts of a block that are no further away than `reach_m`, in a fixed order: corners, edges, faces. `near` must have been
/// collected with the balls' radius, for a margin that holds the core. A pair in `touches.held` stays a contact as long as it presses.
pub fn touches(
    near: &mut Neighbours,
    terrain: &Terrain,
    (block, pose): (&Block, &Pose),
    reach_m: f64,
    touches: &mut BlockContactPoints,
) {
    let BlockContactPoints { found, held, corners, clearances } = touches;
    // hundreds press on cells much smaller than the block, and each feature near is looked up among them
    held.sort_unstable_by_key(by_feature);
    found.clear();
    corners.clear();
    corners.extend(block.core.corners.iter().map(|own| pose.point(own)));
    let own = block.core.corners.iter();
    let bounding_box = || own.fold([Vec3::zeros(); 2], |[a, b], p| [a.inf(p), b.sup(p)]);
    let core_box_m = (near.sharp_edge_count() > BOX_TEST_EDGES).then(bounding_box);
    let posed = PosedBlock { block, pose, corners, core_box_m, held };
    let reach = block.ball_m + reach_m;
    let (mut of_corner, query_radius) =
        (ContactPoints::default(), near.query_radius_m().max(reach));
    clearances.resize(corners.len(), (Vec3::repeat(f64::INFINITY), 0.0));
    for ((k, p), (queried_at, clearance)) in corners.iter().enumerate().zip(clearances) {
        // where nothing was near, nothing is nearer than the corner has moved since
        if *clearance > reach && (p - *queried_at).norm_squared() < (*clearance - reach).powi(2) {
            continue;
        }
        near.touches(terrain, p, query_radius, &mut of_corner);
        (*queried_at, *clearance) =
            (*p, of_corner.iter().map(|touch| touch.distance_m).fold(query_radius, f64::min));
        for touch in of_corner.iter().filter(|touch| touch.distance_m < reach) {
            posed.add((k, p), (touch, false), found);
        }
    }
    // those held come first, and vertices: where one is past its end, the next goes on for it
    for is_active_pass in [true, false] {
        if is_active_pass && held.is_empty() {
            continue;
        }
        for vertex in near.sharp_vertices() {
            posed.add_vertex_contacts((near, terrain), &vertex, (reach, is_active_pass), found);
        }
        for edge in near.sharp_edges() {
            posed.add_edge_contacts((near, terrain), &edge, (reach, is_active_pass), found);
        }
    }
}

impl PosedBlock<'_> {
    /// Adds the contact of a core point `p` on a part of the block, unless it is there already; one that is past its end gives way to it.
    fn add(
        &self,
        (part, p): (usize, &Vec3),
        (touch, is_past_end): (&ContactPoint, bool),
        found: &mut Vec<BlockContactPoint>,
    ) {
        let ball = self.block.ball_m;
        let new = BlockContactPoint {
            part: part as u16,
            feature: touch.feature,
            triangle: touch.triangle,
            normal: touch.normal,
            lever: p - self.pose.centre - touch.normal * ball,
            gap_m: touch.distance_m - ball,
            gain2: touch.gain2,
            is_past_end,
        };
        let near = SAME * ball;
        // sheets over each other touch the same point of the block at different distances: each has its spring
        let mut known = found.iter_mut().filter(|other| {
            (other.normal - new.normal).norm_squared() <= SAME * SAME
                && (other.lever - new.lever).norm_squared() <= near * near
                && (other.gap_m - new.gap_m).abs() <= near
        });
        // what presses has a spring of its own, also where another contact comes to the same place
        if self.is_active(part, touch.feature) {
            found.push(new);
        } else if let Some(other) = known.next() {
            if other.can_continue_as(new.part, new.feature) {
                *other = new;
            }
        } else {
            found.push(new);
        }
    }

    /// The point of the rim of a face of the block that is nearest to a point.
    fn nearest_on_rim(&self, face: &HullFace, at: &Vec3) -> Vec3 {
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

    /// Whether a straight line between two points of the mesh lies further away than `reach` (m) by one side of the box around the core: on cells much
    /// smaller than the block most that is near its centre does.
    fn is_outside_box(&self, ends: [&Vec3; 2], reach: f64) -> bool {
        let Some([low, high]) = &self.core_box_m else { return false };
        let inverse = self.pose.attitude.inverse();
        let [a, b] = ends.map(|end| inverse * (end - self.pose.centre));
        (0..3).any(|k| a[k].max(b[k]) < low[k] - reach || a[k].min(b[k]) > high[k] + reach)
    }

    /// The block's corners, bit by bit, that stand less than `reach` (m) off the plane through the nearest point of a part of the mesh,
    /// square to the line to the block's centre. The part lies behind that plane, so what has no end among them is further away.
    fn corners_below(&self, nearest: &Vec3, reach: f64) -> u64 {
        let Some(up) = (self.pose.centre - nearest).try_normalize(0.0) else { return u64::MAX };
        let level = up.dot(nearest) + reach + DIRECTION_SLACK * self.block.ball_m;
        let bit = |(k, p): (usize, &Vec3)| u64::from(up.dot(p) < level) << k;
        self.corners.iter().enumerate().map(bit).fold(0, std::ops::BitOr::bitor)
    }

    /// The block's edges with an end among such corners, with their numbers among its parts.
    fn ridges_below(&self, low: u64) -> impl Iterator<Item = (usize, &Ridge)> {
        self.ridges().filter(move |(_, ridge)| ridge.ends.iter().any(|end| low >> end & 1 != 0))
    }

    /// The block's edges with their numbers among its parts.
    fn ridges(&self) -> impl Iterator<Item = (usize, &Ridge)> {
        (self.corners.len()..).zip(&self.block.core.ridges)
    }

    /// Whether the opposite of a direction lies between the normals of the two faces at an edge of the block.
    fn is_in_normal_cone(&self, into: &[Vec3; 2], normal: &Vec3, slack: f64) -> bool {
        let own = self.pose.attitude.inverse_transform_vector(normal);
        into.iter().all(|into| into.dot(&own) >= -slack)
    }

    /// How far the normal of a pair may be out of the bounds of its part of the block, and of its feature of the mesh (–). Where it goes on for one that
    /// is past its end, what stays the same is held as it was; `is_same` tells whether the mesh's edge is the same line.
    fn slacks(
        &self,
        (part, feature): (usize, Feature),
        (at, found): (&Vec3, &[BlockContactPoint]),
        is_same: impl Fn(Feature) -> bool,
    ) -> [f64; 2] {
        if self.is_active(part, feature) {
            return [ACTIVE_SLACK; 2];
        }
        let part = part as u16;
        let near = |touch: &&BlockContactPoint| {
            let away = touch.lever + touch.normal * self.block.ball_m + self.pose.centre - at;
            away.norm() <= SAME_POINT * self.block.ball_m
        };
        let mut before =
            found.iter().filter(|touch| touch.can_continue_as(part, feature)).filter(near);
        match before.next() {
            Some(other) if other.part != part => [DIRECTION_SLACK, ACTIVE_SLACK],
            Some(other) if is_same(other.feature) => [ACTIVE_SLACK; 2],
            Some(_) => [ACTIVE_SLACK, DIRECTION_SLACK],
            None => [DIRECTION_SLACK; 2],
        }
    }

    /// Whether a pair presses already.
    fn is_active(&self, part: usize, feature: Feature) -> bool {
        self.held.binary_search_by_key(&(feature, part as u16), by_feature).is_ok()
    }

    /// Whether a part of the block presses on a feature already.
    fn is_any_active(&self, feature: Feature) -> bool {
        let first = self.held.partition_point(|(_, other)| *other < feature);
        self.held.get(first).is_some_and(|(_, other)| *other == feature)
    }
}

/// Order of the pairs that press, by which they are looked up.
fn by_feature(&(part, feature): &(u16, Feature)) -> (Feature, u16) {
    (feature, part)
}

/// Keeps the `most` contacts that span most: the deepest, then always the one farthest from those kept.
pub(crate) fn reduce_contacts(touches: &mut Vec<BlockContactPoint>, most: usize) {
    let deepest = (0..touches.len()).min_by(|&i, &j| touches[i].gap_m.total_cmp(&touches[j].gap_m));
    touches.swap(0, deepest.unwrap_or(0));
    for kept in 1..most {
        let distance = |k: usize| {
            let to = |other: &BlockContactPoint| (other.lever - touches[k].lever).norm();
            touches[..kept].iter().map(to).fold(f64::INFINITY, f64::min) - touches[k].gap_m.max(0.0)
        };
        let next = (kept..touches.len()).max_by(|&i, &j| distance(i).total_cmp(&distance(j)));
        touches.swap(kept, next.unwrap_or(kept));
    }
    touches.truncate(most);
}

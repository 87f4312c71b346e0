//! Contacts of a block with the mesh.
//!
//! A contact is a strict local minimum of the distance to the mesh for **one feature of the
//! block**. It is not one of the distance between the two bodies: a box lying flat would then have
//! one contact at a time and rattle. Each pair of features has its own contacts:
//!
//! | block | mesh | test |
//! |---|---|---|
//! | corner | face, edge, vertex | that of a ball |
//! | edge | edge | feet inside both; the normal outside every triangle at the mesh's edge, its opposite between the block's two faces |
//! | edge | vertex | foot inside the block's edge; the vertex is an extreme point of its own edges along the normal; the block's edge likewise |
//! | face | vertex | foot inside the face; the vertex is an extreme point of its own edges, and none of them continues straight in another |
//!
//! Only convex edges and vertices of the mesh take part, so most pairs need no test.
//!
//! An active pair, one that presses already, stays in contact past the ends and rims of its
//! features, at the nearest points of both, until it separates: the distance between two convex
//! sets is continuous with continuous derivatives. Otherwise the energy in an edge's spring would
//! be lost when the edge slides over its end and the corner touches instead. Where the next feature
//! begins, that feature takes over the spring (`remember` in the block's springs). It is searched
//! with the slack of an active pair: when friction tips a box slightly forward, only its front edge
//! is nearest to a crest, but the rear edge stays in contact.

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

/// Slack of the tests on directions (–) …
const DIRECTION_SLACK: f64 = 1e-9;
/// … and for an active contact (–, sine of an angle): a block that lies flat on an edge rests on
/// both sides of it.
const ACTIVE_SLACK: f64 = 0.2;
/// A contact whose point has moved less than this is the same contact continued on the next feature
/// (–, relative to the radius of the corner balls).
pub(crate) const SAME_POINT: f64 = 0.5;

/// Most contacts of a block at a time. A block has at most 64 corners, so the face of a prism has
/// at most half of them. If there are more contacts, a widely spread subset is kept.
pub(crate) const MAX_BLOCK_CONTACTS: usize = 32;

/// Position and attitude of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Centre of mass (m, local).
    pub centre: Vec3,
    /// From the block's principal frame to the world.
    pub attitude: Rotation3<f64>,
}

impl Pose {
    /// A point of the block's frame in the terrain's frame (m, local).
    #[inline]
    pub fn point(&self, own: &Vec3) -> Vec3 {
        self.centre + self.attitude * own
    }
}

/// One contact of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockContactPoint {
    /// The touching part of the block, numbered through: corners, then edges, then faces.
    pub part: u16,
    /// The touched feature of the mesh.
    pub feature: Feature,
    /// The triangle whose ground and sheet apply.
    pub triangle: u32,
    /// Unit normal from the mesh to the block.
    pub normal: Vec3,
    /// From the centre of mass to the contact point on the block's surface (m).
    pub lever: Vec3,
    /// Distance between the surfaces (m); negative when pressed in.
    pub gap_m: f64,
    /// Stiffness relative to that of a single point (–), for a corner pressed into a fold; see
    /// [`ContactPoint::gain2`].
    pub gain2: f64,
    /// Whether it lies past the ends of its features and exists only because its pair was active
    /// before.
    pub is_past_end: bool,
}

impl BlockContactPoint {
    /// Whether this contact, past the ends of its features, may continue as another pair: with the
    /// next feature of the mesh, or with the next part of the block.
    pub(crate) fn can_continue_as(&self, part: u16, feature: Feature) -> bool {
        self.is_past_end && (self.part == part || self.feature == feature)
    }
}

/// Number of mesh edges near a block above which a bounding-box test of each edge pays.
const BOX_TEST_EDGES: usize = 64;

/// A block at a pose, with its corners in the terrain's frame.
struct PosedBlock<'a> {
    block: &'a Block,
    pose: &'a Pose,
    corners: &'a [Vec3],
    /// Bounding box of the core in its own frame: lowest and highest coordinates (m).
    core_box_m: Option<[Vec3; 2]>,
    /// Active pairs, sorted by feature.
    active: &'a [(u16, Feature)],
}

/// The contacts of a block, and the work space of their search.
#[derive(Debug, Default)]
pub struct BlockContactPoints {
    /// Contacts found by the last search.
    pub found: Vec<BlockContactPoint>,
    /// Active pairs: a part of the block and a feature of the mesh that press on each other
    /// already.
    pub active: Vec<(u16, Feature)>,
    corners: Vec<Vec3>,
    /// For each corner, a position (m) and a lower bound of its distance from the mesh there (m).
    clearances: Vec<(Vec3, f64)>,
}

impl BlockContactPoints {
    /// Clears everything known of another block.
    pub fn forget(&mut self) {
        self.found.clear();
        self.active.clear();
        self.clearances.clear();
    }
}

/// Finds the contacts of a block that are no farther than `reach_m`, in a fixed order: corners,
/// edges, faces. `near` must have been collected with the radius of the corner balls, for a margin
/// that covers the core. A pair in `touches.active` stays in contact as long as it presses.
pub fn touches(
    near: &mut Neighbours,
    terrain: &Terrain,
    (block, pose): (&Block, &Pose),
    reach_m: f64,
    touches: &mut BlockContactPoints,
) {
    let BlockContactPoints { found, active, corners, clearances } = touches;
    // hundreds of pairs may be active on cells much smaller than the block, and each near feature
    // is looked up among them
    active.sort_unstable_by_key(by_feature);
    found.clear();
    corners.clear();
    corners.extend(block.core.corners.iter().map(|own| pose.point(own)));
    let own = block.core.corners.iter();
    let bounding_box = || own.fold([Vec3::zeros(); 2], |[a, b], p| [a.inf(p), b.sup(p)]);
    let core_box_m = (near.sharp_edge_count() > BOX_TEST_EDGES).then(bounding_box);
    let posed = PosedBlock { block, pose, corners, core_box_m, active };
    let reach = block.ball_m + reach_m;
    let (mut of_corner, query_radius) =
        (ContactPoints::default(), near.query_radius_m().max(reach));
    clearances.resize(corners.len(), (Vec3::repeat(f64::INFINITY), 0.0));
    for ((k, p), (queried_at, clearance)) in corners.iter().enumerate().zip(clearances) {
        // the distance to the mesh decreases by no more than the corner has moved
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
    // active pairs first, and vertices before edges: a contact past its end continues in a later
    // one
    for is_active_pass in [true, false] {
        if is_active_pass && active.is_empty() {
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
    /// Adds the contact of point `p` of a core part, unless it is known already; a known contact
    /// past its end is replaced.
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
        // overlapping sheets touch the same point of the block at different distances, each with
        // its own spring
        let mut known = found.iter_mut().filter(|other| {
            (other.normal - new.normal).norm_squared() <= SAME * SAME
                && (other.lever - new.lever).norm_squared() <= near * near
                && (other.gap_m - new.gap_m).abs() <= near
        });
        // an active pair keeps its own spring, even where another contact reaches the same place
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

    /// The point nearest to `at` on the rim of a face of the block.
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

    /// Whether a segment of the mesh is farther away than `reach` (m) on one side of the core's
    /// bounding box. On cells much smaller than the block this excludes most edges.
    fn is_outside_box(&self, ends: [&Vec3; 2], reach: f64) -> bool {
        let Some([low, high]) = &self.core_box_m else { return false };
        let inverse = self.pose.attitude.inverse();
        let [a, b] = ends.map(|end| inverse * (end - self.pose.centre));
        (0..3).any(|k| a[k].max(b[k]) < low[k] - reach || a[k].min(b[k]) > high[k] + reach)
    }

    /// Bit mask of the block's corners less than `reach` (m) above the plane through the nearest
    /// point of a mesh part, normal to the line to the block's centre. The part lies below that
    /// plane, so a feature of the block with no corner in the mask is farther away.
    fn corners_below(&self, nearest: &Vec3, reach: f64) -> u64 {
        let Some(up) = (self.pose.centre - nearest).try_normalize(0.0) else { return u64::MAX };
        let level = up.dot(nearest) + reach + DIRECTION_SLACK * self.block.ball_m;
        let bit = |(k, p): (usize, &Vec3)| u64::from(up.dot(p) < level) << k;
        self.corners.iter().enumerate().map(bit).fold(0, std::ops::BitOr::bitor)
    }

    /// The block's edges with at least one end in such a mask, with their part numbers.
    fn ridges_below(&self, low: u64) -> impl Iterator<Item = (usize, &Ridge)> {
        self.ridges().filter(move |(_, ridge)| ridge.ends.iter().any(|end| low >> end & 1 != 0))
    }

    /// The block's edges with their part numbers.
    fn ridges(&self) -> impl Iterator<Item = (usize, &Ridge)> {
        (self.corners.len()..).zip(&self.block.core.ridges)
    }

    /// Whether the opposite of a direction lies in the normal cone of an edge of the block, between
    /// the normals of its two faces.
    fn is_in_normal_cone(&self, into: &[Vec3; 2], normal: &Vec3, slack: f64) -> bool {
        let own = self.pose.attitude.inverse_transform_vector(normal);
        into.iter().all(|into| into.dot(&own) >= -slack)
    }

    /// Slacks of the normal cone tests (–) for the part of the block and for the feature of the
    /// mesh. Where a pair continues a contact past its end, the feature that stays the same keeps
    /// the slack of an active pair; `is_same` tells whether the mesh's edge is part of the same
    /// line.
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

    /// Whether a pair is active.
    fn is_active(&self, part: usize, feature: Feature) -> bool {
        self.active.binary_search_by_key(&(feature, part as u16), by_feature).is_ok()
    }

    /// Whether any part of the block is active on a feature.
    fn is_any_active(&self, feature: Feature) -> bool {
        let first = self.active.partition_point(|(_, other)| *other < feature);
        self.active.get(first).is_some_and(|(_, other)| *other == feature)
    }
}

/// Sort key of the active pairs.
fn by_feature(&(part, feature): &(u16, Feature)) -> (Feature, u16) {
    (feature, part)
}

/// Keeps the `most` contacts that are spread widest: the deepest, then always the one farthest from
/// those kept.
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

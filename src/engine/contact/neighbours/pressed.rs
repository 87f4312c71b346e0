//! Patches where a ball presses into the mesh, and whether an impact meets only one plane.
//!
//! The second question concerns a whole impact: does the rock, on its path in and out, touch
//! anything but one plane? Its path is enclosed in the rectangle of `along` and `into`, widened by
//! `deviation_m`. A linear function on a rectangle has its extremes at the corners, so each test
//! takes a few scalar products.

use super::{NearFace, NearSaddle, Neighbours, SLACK};
use crate::contact::closest::{Segment, segments_distance2};
use crate::contact::{ContactPoint, ContactPoints, Feature, FeatureKind};
use crate::math;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// A bound on the path of a rock's centre while it is pressed into a plane and comes out again.
#[derive(Debug, Clone, Copy)]
pub struct PressedPath {
    /// Centre at the first touch (m).
    pub start: Vec3,
    /// Displacement along the plane (m).
    pub along: Vec3,
    /// Largest displacement into the plane, against the normal (m).
    pub into: Vec3,
    /// Largest deviation from the straight path (m).
    pub deviation_m: f64,
    /// Largest distance from `start` (m).
    pub reach_m: f64,
}

/// A path deviates from the straight line between its ends by no more than this factor times its
/// duration times the total change of its velocity along the plane (–). A constant force causes
/// half of that, an impulse in the middle all of it.
const DEVIATION_FACTOR: f64 = 0.25;

impl PressedPath {
    /// The path from `start` that displaces the centre by `shift` (m) within `dt` (s) while its
    /// velocity along the plane with unit normal `n` changes by `change_m_s` in total; its depth
    /// below the start is at most `deepest_m`.
    pub fn of(
        n: &Vec3,
        start: Vec3,
        (shift, change_m_s): (&Vec3, f64),
        dt: f64,
        deepest_m: f64,
    ) -> Self {
        let along = Self::tangent(n, shift);
        let deviation_m = DEVIATION_FACTOR * dt * change_m_s;
        let reach_m = math::hypot(along.norm() + deviation_m, deepest_m);
        Self { start, along, into: n * -deepest_m, deviation_m, reach_m }
    }

    /// The component of a vector along the plane with unit normal `n`.
    pub fn tangent(n: &Vec3, x: &Vec3) -> Vec3 {
        x - n * n.dot(x)
    }

    /// Least and largest value of a linear function on the rectangle of `along` and `into`:
    /// `d·(start + s along + t into)` over `0 ≤ s, t ≤ 1`.
    fn range(&self, direction: &Vec3, at_start: f64) -> (f64, f64) {
        let (s, d) = (direction.dot(&self.along), direction.dot(&self.into));
        (at_start + s.min(0.0) + d.min(0.0), at_start + s.max(0.0) + d.max(0.0))
    }

    /// Whether the path may come nearer than `reach` to a plane, from either side: a ball that
    /// reaches over a ridge may approach a plane from behind.
    fn comes_nearer_to_plane(&self, (n, p): (&Vec3, &Vec3), reach: f64) -> bool {
        let (low, high) = self.range(n, n.dot(&(self.start - p)));
        low < reach + self.deviation_m && high > -reach - self.deviation_m
    }

    /// Whether the path stays where `direction · x` is larger than `rim`. Then the foot of the
    /// centre is never on the face of which `rim` is that side.
    fn stays_beyond(&self, direction: &Vec3, rim: f64) -> bool {
        self.range(direction, direction.dot(&self.start)).0 > rim + self.deviation_m
    }

    /// Whether the path may come nearer than `reach` to a segment. It is nearest to a segment below
    /// the centre at its deepest point.
    fn comes_nearer(&self, (p, d): (&Vec3, &Vec3), reach: f64) -> bool {
        // `into` points against the normal: a point farther in that direction than the deepest
        // centre is below it
        let below = |x: &Vec3| self.into.dot(&(x - self.start - self.into)) >= 0.0;
        if below(p) && below(&(p + d)) {
            let reach = reach + self.deviation_m;
            let lowest = self.start + self.into;
            segments_distance2((&lowest, &self.along), (p, d)) < reach * reach
        } else {
            // above the deepest centre: the plain bound with the distance from the start
            let reach = reach + self.reach_m;
            segments_distance2((&self.start, &Vec3::zeros()), (p, d)) < reach * reach
        }
    }
}

impl Neighbours {
    /// How far the centre may move from `centre` in `direction`, a unit vector, before a new
    /// collection is needed (m).
    pub fn margin_ahead_m(&self, centre: &Vec3, direction: &Vec3) -> f64 {
        let from = centre - self.centre;
        let towards = -direction.dot(&from);
        let across2 = from.norm_squared() - towards * towards;
        towards + (self.margin * self.margin - across2).max(0.0).sqrt()
    }

    /// Whether a rock on its `passage` touches nothing but the plane of `face`, however many
    /// triangles that plane has.
    pub fn meets_only_plane(&self, face: u32, passage: &PressedPath) -> bool {
        let Some(own) = self.all.faces.iter().find(|own| own.id == face) else { return false };
        // other triangles of the same plane do no harm: their seams have no effect
        let in_plane = |p: &Vec3| self.is_in_plane(own, p);
        let lies_flat = |directions: (u32, u32)| {
            let directions = self.directions_of(directions);
            directions.len() > 1
                && directions.iter().all(|direction| own.n.dot(direction).abs() <= SLACK)
        };
        // Whether the centre may be outside (or inside) of all faces at an edge through `a`:
        // `directions` point out of them and are normal to the edge, so any point of the edge will
        // do.
        let beyond = passage.deviation_m + SLACK * self.radius;
        let may_stand = |directions: (u32, u32), a: &Vec3, outside: bool| {
            self.directions_of(directions).iter().all(|direction| {
                let (low, high) = passage.range(direction, direction.dot(&(passage.start - a)));
                if outside { high >= -beyond } else { low <= beyond }
            })
        };
        let reach = self.radius;
        // a face does no harm if it lies in the same plane (either winding), is never near, or
        // never holds the foot
        self.all.faces.iter().all(|other| {
            self.is_coplanar(own, other)
                || !passage.comes_nearer_to_plane((&other.n, &other.a), reach)
                || (0..3).any(|k| passage.stays_beyond(&other.out[k], other.rim[k]))
        }) && self.all.edges.iter().all(|edge| {
            // an edge: never near, never with the centre outside all its faces, or flat in the
            // plane itself
            !passage.comes_nearer((&edge.line.a, &edge.line.vector()), reach)
                || !may_stand(edge.directions, &edge.line.a, true)
                || !edge.at_border && lies_flat(edge.directions) && in_plane(&edge.line.a)
        }) && self.all.vertices.iter().all(|vertex| {
            !passage.comes_nearer((&vertex.p, &Vec3::zeros()), reach)
                || !vertex.at_border && lies_flat(vertex.directions) && in_plane(&vertex.p)
        }) && self.all.saddles.iter().all(|saddle| match saddle {
            NearSaddle::Edge { line, directions } => {
                !passage.comes_nearer((&line.a, &line.vector()), reach)
                    || directions.0 < directions.1 && !may_stand(*directions, &line.a, false)
                    || lies_flat(*directions) && in_plane(&line.a)
            }
            // a vertex that may be a saddle does no harm only out of reach: its sectors are not
            // examined here
            NearSaddle::Vertex { p, .. } => !passage.comes_nearer((p, &Vec3::zeros()), reach),
        })
    }

    fn is_in_plane(&self, own: &NearFace, p: &Vec3) -> bool {
        own.n.dot(&(p - own.a)).abs() <= SLACK * self.radius
    }

    /// Whether two triangles lie in one plane, with either winding.
    pub(super) fn is_coplanar(&self, own: &NearFace, other: &NearFace) -> bool {
        let turned = (other.n - own.n).norm_squared().min((other.n + own.n).norm_squared());
        turned <= SLACK * SLACK && self.is_in_plane(own, &other.a)
    }

    /// Whether the foot of `centre` is on the triangle `face`, or on another triangle of its plane
    /// if all of that plane near the centre are `alike`.
    pub fn is_foot_on_plane(&self, face: u32, centre: &Vec3, alike: impl Fn(u32) -> bool) -> bool {
        let Some(own) = self.all.faces.iter().find(|own| own.id == face) else { return false };
        let slack = SLACK * self.radius;
        let mut plane = self.all.faces.iter().filter(|other| self.is_coplanar(own, other));
        own.holds_foot_of(centre, slack)
            || plane.clone().all(|other| alike(other.id))
                && plane.any(|other| other.holds_foot_of(centre, slack))
    }

    /// Whether a saddle or a maximum of the distance is inside the ball.
    ///
    /// It decides whether single nearest points suffice (the usual case) or patches must be summed.
    /// It is evaluated at every stage, so it is cheap.
    #[inline]
    pub(super) fn has_saddle(
        &self,
        terrain: &Terrain,
        saddles: &[NearSaddle],
        centre: &Vec3,
    ) -> bool {
        saddles.iter().any(|saddle| match saddle {
            NearSaddle::Edge { line: Segment { a, along, length }, directions } => {
                let to = centre - a;
                let s = along.dot(&to);
                let off = to - along * s;
                let slack = SLACK * self.radius;
                // the foot lies on the edge and the centre inside both faces: both are minima, and
                // the edge between them is the saddle
                let outward = self.directions_of(*directions);
                // beyond its ends the edge is as near as its vertices, and those have tests of
                // their own
                s >= -slack
                    && s <= length + slack
                    && off.norm_squared() < self.radius * self.radius
                    && outward.iter().all(|out| out.dot(&off) <= slack)
            }
            NearSaddle::Vertex { id, p } => {
                let off = centre - p;
                off.norm_squared() < self.radius * self.radius
                    && !terrain.features.is_regular(*id, &off, SLACK * self.radius, terrain.mesh())
            }
        })
    }

    /// The feature of the patch that contains `feature`, if the last query found one.
    pub fn patch_holding(&self, terrain: &Terrain, feature: Feature) -> Option<Feature> {
        self.patches.holding(terrain, feature)
    }

    /// Replaces the contacts that the ball presses into by patches.
    #[cold]
    pub(super) fn replace_by_patches(
        &mut self,
        terrain: &Terrain,
        (centre, reach): (&Vec3, f64),
        touches: &mut ContactPoints,
    ) {
        // contacts not reached yet stay as they are: a patch contains only what is pressed in
        touches.retain(|touch| touch.distance_m >= self.radius);
        let mut patches = std::mem::take(&mut self.patches);
        patches.find(
            terrain,
            &self.candidates((centre, reach)).sheets,
            (centre, self.radius),
            |touch, nearest: &ContactPoint| {
                let features = &terrain.features;
                let at_border = match touch.feature.kind {
                    FeatureKind::Face => false,
                    FeatureKind::Edge => features.edges.is_border(touch.feature.id),
                    FeatureKind::Vertex => {
                        features.is_border_vertex(touch.feature.id, terrain.mesh())
                    }
                };
                // The border of one sheet on another (T-junction, overlap) is no contact of its
                // own. The test uses the nearest point of the mesh: that of the equivalent point
                // contact lies beside the mesh, and the patch's own triangles would cover it.
                let foot = centre - nearest.normal * nearest.distance_m;
                let covered = at_border
                    && self.is_covered(terrain, touch.feature, &foot, (centre, nearest.distance_m));
                if !covered {
                    self.add_unless_known(touch, centre, touches);
                }
            },
        );
        self.patches = patches;
    }
}

//! How long the parts of a block certainly stay clear of the near features.

use super::ahead::{FeatureAhead, FeaturesAhead, TriangleAhead};
use super::clearance::{Clearance, PointMotion};
use super::{BlockFlight, BlockPart, FlightState, PointBounds, ROUNDING_MARGIN, TOUCHING};
use crate::body::HullFace;
use crate::contact::closest::closest_on;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// A safe time below this share of the one asked for is short (–) and is improved: a block that
/// hangs over a vertex or an edge by a hair would otherwise need very many of them.
const SHORT_SHARE: f64 = 0.01;

/// The search of a window, at one state of the flight.
pub(super) struct WindowSearch<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) flight: &'a BlockFlight<'a>,
    pub(super) ahead: &'a FeaturesAhead,
    pub(super) bounds: PointBounds,
    pub(super) state: FlightState,
    pub(super) corners: &'a mut CornerMotions,
    /// Triangles tested so far.
    pub(super) tested: &'a mut u64,
}

/// The motions of a block's corners, computed once per time for all parts that need them.
#[derive(Debug, Default)]
pub(super) struct CornerMotions {
    /// For each corner the time (s) of its last evaluation and its motion then.
    known: Vec<(f64, PointMotion)>,
    /// Work space: the corners of one face.
    of_face: Vec<PointMotion>,
}

impl CornerMotions {
    /// Prepares for another flight, of a block with `count` corners.
    pub(super) fn begin(&mut self, count: usize) {
        self.known.clear();
        self.known.resize(count, (f64::NAN, PointMotion::NONE));
    }
}

impl WindowSearch<'_> {
    /// A vector of the block's frame in that of the terrain, with its first and second time
    /// derivatives.
    pub(super) fn turned(&self, own: &Vec3) -> [Vec3; 3] {
        let FlightState { pose, spin, angular, .. } = &self.state;
        let arm = pose.attitude * own;
        let turning = spin.cross(&arm);
        [arm, turning, angular.cross(&arm) + spin.cross(&turning)]
    }

    /// Motion of the block's centre.
    pub(super) fn centre(&self) -> PointMotion {
        let (path, FlightState { pose, velocity, .. }) = (&self.flight.path, &self.state);
        let acceleration = Vec3::new(0.0, 0.0, -path.gravity);
        let (p, velocity) = (pose.centre, *velocity);
        PointMotion { p, velocity, acceleration, max_acceleration: path.gravity, max_jerk: 0.0 }
    }

    pub(super) fn corner_motion(&mut self, k: usize) -> PointMotion {
        let known = self.corners.known[k];
        if known.0.to_bits() == self.state.time_s.to_bits() {
            return known.1;
        }
        let own = &self.flight.block.core.corners[k];
        let ([arm, turning, bending], far, centre) = (self.turned(own), own.norm(), self.centre());
        let motion = PointMotion {
            p: centre.p + arm,
            velocity: centre.velocity + turning,
            acceleration: centre.acceleration + bending,
            max_acceleration: centre.max_acceleration + far * self.bounds.acceleration,
            max_jerk: far * self.bounds.jerk,
        };
        self.corners.known[k] = (self.state.time_s, motion);
        motion
    }

    /// Whether no part of the block touches a feature, and those listed after it, within `least`
    /// (s).
    #[inline]
    fn is_later<T>(&self, ahead: &FeatureAhead<T>, least: f64) -> bool {
        ahead.from_s >= self.state.time_s + least
    }

    /// A gap that counts as touching (m).
    fn touching(&self) -> f64 {
        TOUCHING * self.flight.block.radius_m
    }

    /// How long all these corners certainly stay on their side of a plane (s), at most `most`.
    fn off_plane(&self, corners: &[PointMotion], plane: (&Vec3, &Vec3), most: f64) -> f64 {
        let (ball, touching) = (self.flight.block.ball_m, self.touching());
        corners.iter().fold(most, |least, corner| {
            Clearance::of_corner(corner, ball, plane).open_time_s(touching, least)
        })
    }

    /// How long a part certainly touches nothing (s), at most `most`.
    pub(super) fn safe_step(&mut self, part: BlockPart, most: f64) -> f64 {
        match part {
            BlockPart::Corner(k) => self.of_corner(k, most),
            BlockPart::Ridge(k) => self.of_ridge(k, most),
            BlockPart::Face(k) => self.of_face(k, most),
        }
    }

    /// The longer of two times (s) for which a part stays clear of a feature: a known one, and that
    /// of a gap which is never larger than theirs.
    fn open_at_least(&self, known_s: f64, gap: Option<Clearance>, most: f64) -> f64 {
        let touching = self.touching();
        // lines and planes may intersect where edges and faces do not: that proves nothing
        let gap = gap.filter(|gap| gap.gap_m >= -touching);
        gap.map_or(known_s, |gap| gap.open_time_s(touching, most).max(known_s))
    }

    fn of_corner(&mut self, k: usize, mut least: f64) -> f64 {
        let corner = self.corner_motion(k);
        let (ball, touching) = (self.flight.block.ball_m, self.touching());
        for ahead in &self.ahead.triangles {
            if self.is_later(ahead, least) {
                break;
            }
            *self.tested += 1;
            let TriangleAhead { id, a, n } = &ahead.feature;
            let side = if n.dot(&(corner.p - a)) < 0.0 { -n } else { *n };
            // the plane is never farther than the triangle; if the ball reaches through the plane
            // beside the triangle, that proves nothing
            let gap = Clearance::of_corner(&corner, ball, (&side, a));
            if gap.stays_open(touching, least) || self.open_at_least(0.0, Some(gap), least) >= least
            {
                continue;
            }
            // the distance from a convex set is never less than that from its supporting plane at
            // the nearest point
            let q = closest_on(&self.terrain.corners_m(*id), &corner.p);
            // a corner exactly on the triangle has no direction: the plane's normal on its side is
            // used instead
            let n = (corner.p - q).try_normalize(0.0).unwrap_or(side);
            least = Clearance::of_corner(&corner, ball, (&n, &q)).open_time_s(touching, least);
        }
        least
    }

    /// The gap between a point of the mesh and a plane of the block with a normal and a level (m),
    /// for at most `most` (s).
    fn to_own_plane(&self, plane: (&Vec3, f64), point: &Vec3, most: f64) -> Clearance {
        let moving = (&self.centre(), |own: &Vec3| self.turned(own));
        let ball = self.flight.block.ball_m;
        Clearance::of_own_plane((plane, ball), point, moving, (&self.bounds, most))
    }

    /// How long the hull of some corners certainly stays clear of the hull of points of the mesh
    /// (s), at most `most`; evaluated only if `known_s` is short. The plane normal to `n`, from the
    /// block to the points, is fixed to the block here. A block that rotates about its contact does
    /// not approach in this measure, while its corners do approach a plane fixed to the terrain.
    fn off_own_plane(
        &self,
        corners: &[u8],
        (n, points): (&Vec3, &[Vec3]),
        (known_s, most): (f64, f64),
    ) -> f64 {
        if known_s >= SHORT_SHARE * most {
            return known_s;
        }
        let own = self.state.pose.attitude.inverse() * n;
        let corner = |k: u8| &self.flight.block.core.corners[usize::from(k)];
        let levels = corners.iter().map(|&k| own.dot(corner(k)));
        let level = levels.fold(f64::NEG_INFINITY, f64::max);
        let found_s = points.iter().fold(most, |least, point| {
            self.open_at_least(0.0, Some(self.to_own_plane((&own, level), point, least)), least)
        });
        found_s.max(known_s)
    }

    /// An edge of the block. With `n` from the nearest points of two segments, the plane normal to
    /// `n` separates both, and the ridge stays on its side as long as both its ends do. Nor do the
    /// edges touch before the infinite lines along them do.
    fn of_ridge(&mut self, k: usize, mut least: f64) -> f64 {
        let ends =
            self.flight.block.core.ridges[k].ends.map(|end| self.corner_motion(usize::from(end)));
        let [a, b] = ends;
        let (middle, half) = ((a.p + b.p) * 0.5, 0.5 * (b.p - a.p).norm());
        let max_acceleration = a.max_acceleration.max(b.max_acceleration);
        let fastest = a.velocity.norm().max(b.velocity.norm());
        let ball = self.flight.block.ball_m;
        let around = half + ball;
        for ahead in &self.ahead.edges {
            if self.is_later(ahead, least) {
                break;
            }
            // the edge's distance from the ridge's middle less half a ridge: a lower bound without
            // the nearest points; distant edges are skipped whatever the directions
            let edge = &ahead.feature;
            let far = (around + least * (fastest + 0.5 * max_acceleration * least))
                * (1.0 + ROUNDING_MARGIN);
            if (middle - edge.nearest_to(&middle)).norm_squared() > far * far {
                continue;
            }
            let end = edge.a + edge.vector();
            let (p, q) = nearest_of_segments((a.p, b.p), (edge.a, end));
            let Some(n) = (p - q).try_normalize(0.0) else { continue };
            let off_plane = self.off_plane(&ends, (&n, &q), least);
            if off_plane < least {
                let line = (&edge.a, &edge.along);
                let gap = Clearance::of_lines(&ends, ball, line, (&self.bounds, least));
                let known_s = self.open_at_least(off_plane, gap, least);
                let own = &self.flight.block.core.ridges[k].ends;
                least = self.off_own_plane(own, (&-n, &[edge.a, end]), (known_s, least));
            }
        }
        least
    }

    /// A face of the block against the vertices of the mesh: nearest point on a fan of triangles,
    /// then the bound for all corners of the face, or that of the vertex against the face's plane.
    fn of_face(&mut self, k: usize, most: f64) -> f64 {
        let mut corners = std::mem::take(&mut self.corners.of_face);
        corners.clear();
        let face = &self.flight.block.core.faces[k];
        corners.extend(face.corners.iter().map(|&k| self.corner_motion(usize::from(k))));
        let least = self.of_fan(face, &corners, most);
        self.corners.of_face = corners;
        least
    }

    fn of_fan(&self, face: &HullFace, corners: &[PointMotion], mut least: f64) -> f64 {
        let most = |of: fn(&PointMotion) -> f64| corners.iter().map(of).fold(0.0, f64::max);
        let (max_acceleration, fastest) =
            (most(|c| c.max_acceleration), most(|c| c.velocity.norm()));
        let middle = corners.iter().map(|c| c.p).sum::<Vec3>() / corners.len() as f64;
        let around = corners.iter().map(|c| (c.p - middle).norm_squared()).fold(0.0, f64::max);
        let skin = self.flight.block.ball_m + TOUCHING * self.flight.block.radius_m;
        let around = around.sqrt() * (1.0 + ROUNDING_MARGIN) + skin;
        for ahead in &self.ahead.vertices {
            if self.is_later(ahead, least) {
                break;
            }
            let vertex = &ahead.feature;
            // distant vertices are skipped whatever the directions
            let far = around
                + least * (fastest + 0.5 * max_acceleration * least) * (1.0 + ROUNDING_MARGIN);
            if (vertex - middle).norm_squared() * (1.0 - ROUNDING_MARGIN) > far * far {
                continue;
            }
            let nearest = (1..corners.len() - 1)
                .map(|k| closest_on(&[corners[0].p, corners[k].p, corners[k + 1].p], vertex))
                .min_by(|a, b| (a - vertex).norm_squared().total_cmp(&(b - vertex).norm_squared()));
            let Some(n) = nearest.and_then(|p| (p - vertex).try_normalize(0.0)) else { continue };
            let off_plane = self.off_plane(corners, (&n, vertex), least);
            if off_plane < least {
                let gap = self.to_own_plane((&face.normal, face.level), vertex, least);
                let known_s = self.open_at_least(off_plane, Some(gap), least);
                least = self.off_own_plane(&face.corners, (&-n, &[*vertex]), (known_s, least));
            }
        }
        least
    }
}

/// The nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9). As
/// `closest::segments_distance2`, but with the points, from which the direction `n` follows.
fn nearest_of_segments((p1, q1): (Vec3, Vec3), (p2, q2): (Vec3, Vec3)) -> (Vec3, Vec3) {
    let (d1, d2, r) = (q1 - p1, q2 - p2, p1 - p2);
    let (a, e, f) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&r));
    let (b, c) = (d1.dot(&d2), d1.dot(&r));
    let across = a * e - b * b;
    let mut s = if across > 0.0 { ((b * f - c * e) / across).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = (b * s + f) / e;
    if t < 0.0 {
        (t, s) = (0.0, (-c / a).clamp(0.0, 1.0));
    } else if t > 1.0 {
        (t, s) = (1.0, ((b - c) / a).clamp(0.0, 1.0));
    }
    (p1 + d1 * s, p2 + d2 * t)
}

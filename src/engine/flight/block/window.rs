//! How long the parts of a block surely keep off what is near it.

use super::{BlockPart, Moment, Tumble, WindowScratch};
use crate::contact::closest::closest_on;
use crate::contact::neighbours::Neighbours;
use crate::rock::Vec3;
use crate::terrain::Terrain;

/// A gap that counts as touching (–, relative to the radius of the sphere of equal volume).
/// A tenth of the gap at which contact begins: what is found here is a touch there.
const TOUCHING: f64 = 1e-10;
/// Rounding of a sum of three products, with room (–): what is skipped because it is far away must be so for certain.
const CAUTION: f64 = 1e-12;

/// The search of a window at one moment.
pub(super) struct WindowSearch<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) tumble: &'a Tumble<'a>,
    pub(super) near: &'a mut Neighbours,
    pub(super) bend: f64,
    pub(super) moment: Moment,
}

/// A corner as it flies.
/// Position `p` (m), velocity (m/s) in the frame of the terrain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flying {
    p: Vec3,
    velocity: Vec3,
    /// Largest acceleration (m/s²).
    pub(super) bend: f64,
}

impl WindowSearch<'_> {
    fn flying(&self, k: usize) -> Flying {
        let own = &self.tumble.block.core.corners[k];
        let arm = self.moment.pose.attitude * own;
        // v + ω × ρ, and the bound g + ρ (ω_m² + α_m) on its acceleration
        Flying {
            p: self.moment.pose.centre + arm,
            velocity: self.moment.velocity + self.moment.spin.cross(&arm),
            bend: self.tumble.path.gravity + own.norm() * self.bend,
        }
    }

    /// How long a corner surely keeps off a plane with unit normal `n` through `q` (s).
    ///
    /// `τ = 2δ/(c + √(c² + 2Bδ))` while it approaches, `(√(c² + 2Bδ) − c)/B` while it parts (`c ≤
    /// 0`): then gravity and spin need time to turn it round. Both are the positive root of `δ − c
    /// τ − B τ²/2 = 0`, each in the form without cancellation.
    fn safe(&self, corner: &Flying, n: &Vec3, q: &Vec3) -> f64 {
        let gap = n.dot(&(corner.p - q)) - self.tumble.block.ball_m;
        let closing = -n.dot(&corner.velocity);
        let touching = TOUCHING * self.tumble.block.radius_m;
        // only an approach touches: a corner that has just left lies within the same gap and must
        // be free to go
        if closing > 0.0 && gap <= touching {
            return 0.0;
        }
        let root = (closing * closing + 2.0 * corner.bend * gap.max(0.0)).sqrt();
        if closing > 0.0 {
            2.0 * gap / (closing + root)
        } else if corner.bend > 0.0 {
            (root - closing) / corner.bend
        } else {
            f64::INFINITY
        }
    }

    /// Whether [`Self::safe`] is surely not less than `least` (s): the same bound without its root.
    #[inline]
    fn keeps_off(&self, corner: &Flying, (gap, closing): (f64, f64), least: f64) -> bool {
        let bent = 0.5 * corner.bend * least;
        let rounding = CAUTION * (closing.abs() + bent);
        gap > TOUCHING * self.tumble.block.radius_m && gap >= least * (closing + bent + rounding)
    }

    /// How long a part surely touches nothing (s), no longer than `most`.
    pub(super) fn safe_step(
        &mut self,
        part: BlockPart,
        most: f64,
        scratch: &mut WindowScratch,
    ) -> f64 {
        match part {
            BlockPart::Corner(k) => self.of_corner(k, most, &scratch.planes),
            BlockPart::Ridge(k) => self.of_ridge(k, most),
            BlockPart::Face(k) => self.of_face(k, most, &mut scratch.corners),
        }
    }

    fn of_corner(&mut self, k: usize, mut least: f64, planes: &[(Vec3, Vec3)]) -> f64 {
        let corner = self.flying(k);
        let ball = self.tumble.block.ball_m;
        self.near.tested += self.near.triangles().len() as u64;
        for (&t, (a, n)) in self.near.triangles().iter().zip(planes) {
            let (height, climbs) = (n.dot(&(corner.p - a)), n.dot(&corner.velocity));
            let closing = if height < 0.0 { climbs } else { -climbs };
            // the plane is never farther than the triangle
            if self.keeps_off(&corner, (height.abs() - ball, closing), least) {
                continue;
            }
            let side = if height < 0.0 { -n } else { *n };
            if self.safe(&corner, &side, a) >= least {
                continue;
            }
            // the true distance of a convex set is never less than that of its own supporting plane
            // at the nearest point
            let q = closest_on(&self.terrain.corners_m(t), &corner.p);
            // a corner exactly on the triangle has no direction: the plane's normal on its side
            // stands in
            let n = (corner.p - q).try_normalize(0.0).unwrap_or(side);
            least = least.min(self.safe(&corner, &n, &q));
        }
        least
    }

    /// An edge of the block: with `n` from the nearest points of two segments, the plane square to
    /// `n` keeps both apart, and the ridge stays on its side as long as both its ends do.
    fn of_ridge(&self, k: usize, mut least: f64) -> f64 {
        let ends = self.tumble.block.core.ridges[k].ends.map(|end| self.flying(usize::from(end)));
        let [a, b] = ends;
        let (middle, half) = ((a.p + b.p) * 0.5, 0.5 * (b.p - a.p).norm());
        let bend = a.bend.max(b.bend);
        let fastest = a.velocity.norm().max(b.velocity.norm());
        for edge in self.near.sharp_edges() {
            // distance of the ridge's middle to the edge less half a ridge: a lower bound without
            // the nearest points
            let along = edge.along.dot(&(middle - edge.a)).clamp(0.0, edge.length);
            let room =
                (middle - edge.a - edge.along * along).norm() - half - self.tumble.block.ball_m;
            // far away: whatever the directions
            if room > 0.0 && least * (fastest + 0.5 * bend * least) <= room {
                continue;
            }
            let far = edge.a + edge.along * edge.length;
            let (p, q) = nearest_of_segments((a.p, b.p), (edge.a, far));
            let Some(n) = (p - q).try_normalize(0.0) else { continue };
            for end in &ends {
                least = least.min(self.safe(end, &n, &q));
            }
        }
        least
    }

    /// A face of the block against a vertex of the mesh: nearest point over a fan of triangles,
    /// then the bound for all corners of the face.
    fn of_face(&self, k: usize, mut least: f64, corners: &mut Vec<Flying>) -> f64 {
        let face = &self.tumble.block.core.faces[k];
        corners.clear();
        corners.extend(face.corners.iter().map(|&k| self.flying(usize::from(k))));
        let most = |of: fn(&Flying) -> f64| corners.iter().map(of).fold(0.0, f64::max);
        let (bend, fastest) = (most(|c| c.bend), most(|c| c.velocity.norm()));
        let middle = corners.iter().map(|c| c.p).sum::<Vec3>() / corners.len() as f64;
        let around = corners.iter().map(|c| (c.p - middle).norm_squared()).fold(0.0, f64::max);
        let skin = self.tumble.block.ball_m + TOUCHING * self.tumble.block.radius_m;
        let around = around.sqrt() * (1.0 + CAUTION) + skin;
        for peak in self.near.peaks() {
            // far away: whatever the directions
            let far = around + least * (fastest + 0.5 * bend * least) * (1.0 + CAUTION);
            if (peak.p - middle).norm_squared() * (1.0 - CAUTION) > far * far {
                continue;
            }
            let nearest = (1..corners.len() - 1)
                .map(|k| closest_on(&[corners[0].p, corners[k].p, corners[k + 1].p], &peak.p))
                .min_by(|a, b| (a - peak.p).norm_squared().total_cmp(&(b - peak.p).norm_squared()));
            let Some(n) = nearest.and_then(|p| (p - peak.p).try_normalize(0.0)) else { continue };
            for corner in corners.iter() {
                least = least.min(self.safe(corner, &n, &peak.p));
            }
        }
        least
    }
}

/// The nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
/// As `closest::segments_distance2`, but it tells the points: `n` is wanted, not only the distance.
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

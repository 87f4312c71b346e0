//! Where a ball presses into the mesh: patches in place of minima, and how far a single plane reaches.

use super::{NearSaddle, Neighbours, SLACK};
use crate::contact::{ContactPoint, ContactPoints, Feature, FeatureKind};
use crate::rock::Vec3;
use crate::terrain::Terrain;

impl Neighbours {
    /// Whether a rock touches nothing but the plane of `face`, however many triangles that is, wherever its centre goes up to
    /// `way` (m) from `centre`: distances change no faster than the centre moves.
    pub fn is_plane_within(&self, face: u32, centre: &Vec3, way: f64) -> bool {
        let Some(own) = self.faces.iter().find(|own| own.id == face) else { return false };
        let reach = self.radius + way;
        let plane_kernel = SLACK * self.radius;
        let in_plane = |p: &Vec3| own.n.dot(&(p - own.a)).abs() <= plane_kernel;
        let lies_flat = |rays: (u32, u32)| {
            let rays = &self.rays[rays.0 as usize..rays.1 as usize];
            rays.len() > 1 && rays.iter().all(|ray| own.n.dot(ray).abs() <= SLACK)
        };
        let outward = |rays: (u32, u32), off: &Vec3, side: f64| {
            let rays = &self.rays[rays.0 as usize..rays.1 as usize];
            rays.iter().all(|ray| side * ray.dot(off) >= -way)
        };
        self.faces.iter().all(|other| {
            let turned = (other.n - own.n).norm_squared().min((other.n + own.n).norm_squared());
            turned <= SLACK * SLACK && in_plane(&other.a)
                || other.n.dot(&(centre - other.a)).abs() >= reach
                || !other.holds_foot_of(centre, way)
        }) && self.edges.iter().all(|edge| {
            let to = centre - edge.a;
            let off = to - edge.along * edge.along.dot(&to).clamp(0.0, edge.length);
            off.norm_squared() >= reach * reach
                || !outward(edge.rays, &off, 1.0)
                || !edge.at_border && lies_flat(edge.rays) && in_plane(&edge.a)
        }) && self.corners.iter().all(|corner| {
            (centre - corner.p).norm_squared() >= reach * reach
                || !corner.at_border && lies_flat(corner.rays) && in_plane(&corner.p)
        }) && self.saddles.iter().all(|saddle| match saddle {
            NearSaddle::Edge { a, along, length, rays } => {
                let to = centre - a;
                let off = to - along * along.dot(&to).clamp(0.0, *length);
                off.norm_squared() >= reach * reach
                    || rays.0 < rays.1 && !outward(*rays, &off, -1.0)
                    || lies_flat(*rays) && in_plane(a)
            }
            NearSaddle::Vertex { p, .. } => (centre - p).norm_squared() >= reach * reach,
        })
    }

    /// Whether a saddle or a maximum of the distance is inside the ball.
    #[inline]
    pub(super) fn has_saddle(&self, terrain: &Terrain, centre: &Vec3) -> bool {
        self.saddles.iter().any(|saddle| match saddle {
            NearSaddle::Edge { a, along, length, rays } => {
                let to = centre - a;
                let s = along.dot(&to);
                let off = to - along * s;
                let slack = SLACK * self.radius;
                let outward = &self.rays[rays.0 as usize..rays.1 as usize];
                // beyond its ends the edge is as near as its vertices, and those are asked by themselves
                s >= -slack
                    && s <= length + slack
                    && off.norm_squared() < self.radius * self.radius
                    && outward.iter().all(|out| out.dot(&off) <= slack)
            }
            NearSaddle::Vertex { id, p } => {
                let off = centre - p;
                off.norm_squared() < self.radius * self.radius
                    && !terrain.features.is_regular(
                        *id,
                        &off,
                        SLACK * self.radius,
                        &terrain.vertices_m,
                    )
            }
        })
    }

    /// The feature under which the patch that holds `feature` was found by the last look, if there was one.
    pub fn patch_holding(&self, terrain: &Terrain, feature: Feature) -> Option<Feature> {
        self.patches.holding(terrain, feature)
    }

    /// Puts the patches in place of the touches that the ball presses into.
    #[cold]
    pub(super) fn gather(&mut self, terrain: &Terrain, centre: &Vec3, touches: &mut ContactPoints) {
        touches.drop_nearer(self.radius);
        let mut patches = std::mem::take(&mut self.patches);
        patches.find(terrain, &self.sheets, (centre, self.radius), |touch: ContactPoint| {
            let ground_contact = centre - touch.normal * touch.distance_m;
            let features = &terrain.features;
            let at_border = match touch.feature.kind {
                FeatureKind::Face => false,
                FeatureKind::Edge => features.edges.triangles_on(touch.feature.id).len() == 1,
                FeatureKind::Vertex => features.is_border_vertex(touch.feature.id),
            };
            let covered =
                at_border && self.is_covered(terrain, &ground_contact, centre, touch.distance_m);
            if !covered {
                self.merge(touch, centre, touches);
            }
        });
        self.patches = patches;
    }
}

//! Finding contacts: the strict local minima of the distance from a rock's centre to the mesh.
//!
//! Around a place, the features that could touch anywhere within a margin are collected once and asked many times.
//! A face touches where the centre's foot lies inside it; an edge where the centre stands outside of every face on
//! it; a vertex where the centre stands behind every edge at it. Flat and hollow edges fail by themselves, from
//! either side of a sheet, and every contact belongs to one feature.

use super::closest::closest_on;
use super::seen::Seen;
use super::{Feature, Touch, Touches};
use crate::contact::FeatureKind;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::brims::Brim;
use crate::terrain::features::Face;

/// Inclusive tests, relative to the radius (–): a point on a border must not fall between two features.
const SLACK: f64 = 1e-9;
/// Feet closer than this times the radius, with normals within it, are one contact (–). Loose enough for the
/// rounding of map coordinates, which bends flat edges by 1e-9.
const SAME: f64 = 1e-6;

/// What stands out on one side of a triangle is not touched from further than this on the other (–, relative to the
/// distance): edges turn by 1e-6 at least before they are said to stand out, and tests have a slack of 1e-9.
const ASIDE: f64 = 0.01;
/// Rounding of the sine of a brim's steepest direction (–).
const ASIDE_SLACK: f32 = 1e-3;

#[derive(Debug, Clone, Copy)]
struct NearFace {
    id: u32,
    a: Vec3,
    n: Vec3,
    out: [Vec3; 3],
    /// `out[k] · x ≤ rim[k]` inside.
    rim: [f64; 3],
}

#[derive(Debug, Clone, Copy)]
struct NearEdge {
    id: u32,
    triangle: u32,
    a: Vec3,
    along: Vec3,
    length: f64,
    /// Range of outward face normals in `rays`.
    rays: (u32, u32),
    at_border: bool,
}

#[derive(Debug, Clone, Copy)]
struct NearCorner {
    id: u32,
    triangle: u32,
    p: Vec3,
    /// Range of edge directions in `rays`.
    rays: (u32, u32),
}

impl NearFace {
    /// Whether the foot of `point` lies inside, or at most `slack` (m) outside.
    #[inline]
    fn holds_foot_of(&self, point: &Vec3, slack: f64) -> bool {
        (0..3).all(|k| self.out[k].dot(point) <= self.rim[k] + slack)
    }
}

/// The features a rock can touch while its centre stays within a margin of a place.
#[derive(Debug)]
pub struct Near {
    centre: Vec3,
    margin: f64,
    radius: f64,
    reach: f64,
    faces: Vec<NearFace>,
    edges: Vec<NearEdge>,
    corners: Vec<NearCorner>,
    rays: Vec<Vec3>,
    /// All triangles within reach; only looked at when a border is near.
    sheets: Vec<u32>,
    /// Stems that have given way: they touch nothing any more.
    pub gone: Vec<u32>,
    /// Triangles tested so far.
    pub tested: u64,
}

impl Default for Near {
    fn default() -> Self {
        Self {
            faces: Vec::with_capacity(64),
            edges: Vec::with_capacity(64),
            corners: Vec::with_capacity(64),
            rays: Vec::with_capacity(512),
            sheets: Vec::with_capacity(256),
            ..Self::empty()
        }
    }
}

impl Near {
    /// No features yet and no memory taken: for rocks that are kept by the thousand.
    pub fn empty() -> Self {
        Self {
            centre: Vec3::repeat(f64::INFINITY),
            margin: 0.0,
            radius: 0.0,
            reach: 0.0,
            faces: Vec::new(),
            edges: Vec::new(),
            corners: Vec::new(),
            rays: Vec::new(),
            sheets: Vec::new(),
            gone: Vec::new(),
            tested: 0,
        }
    }

    /// Forgets the place (before the next rock).
    pub fn forget(&mut self) {
        self.centre = Vec3::repeat(f64::INFINITY);
    }

    /// Collects around `centre`, for a rock of `radius`, all that touches within `slack` of it while the centre
    /// moves up to `margin` (all m).
    pub fn collect(
        &mut self,
        terrain: &Terrain,
        centre: &Vec3,
        radius: f64,
        margin: f64,
        slack: f64,
    ) {
        (self.centre, self.margin, self.radius) = (*centre, margin, radius);
        self.reach = radius + slack + margin;
        self.faces.clear();
        self.edges.clear();
        self.corners.clear();
        self.rays.clear();
        self.sheets.clear();
        terrain.index.near(centre, self.reach, |start, count| {
            for t in start..start + count {
                self.tested += 1;
                let face = &terrain.features.faces[t as usize];
                let to = centre - face.a;
                let height = face.n.dot(&to);
                if height.abs() <= self.reach && !terrain.is_gone(t, &self.gone) {
                    self.take(terrain, t, (to, height));
                }
            }
        });
    }

    /// Takes of one triangle what may touch; the centre is `to` from its first corner and `height` over its plane (m).
    fn take(&mut self, terrain: &Terrain, t: u32, (to, height): (Vec3, f64)) {
        self.sheets.push(t);
        let face = &terrain.features.faces[t as usize];
        let near = self.margin + SLACK * self.radius;
        let (owned, beside) = self.within_sight(&terrain.features.brims[t as usize], height);
        let Some(seen) = Seen::of(face, to, (height, beside.max(near))) else { return };
        if seen.is_within(near) {
            self.take_face(t, face);
        }
        for k in (0..3).filter(|_| owned != 0) {
            if owned & (1 << k) != 0 && seen.may_meet_edge(k, (near, self.reach)) {
                self.take_edge(terrain, terrain.features.edges.of_triangle[t as usize][k], t);
            }
            if owned & (8 << k) != 0 && seen.may_meet_corner(k, (near, self.reach)) {
                self.take_corner(terrain, terrain.triangles[t as usize][k], t);
            }
        }
    }

    fn take_face(&mut self, t: u32, face: &Face) {
        let corners = [face.a, face.a + face.e1, face.a + face.e2];
        let sides = [face.e1, face.e2 - face.e1, -face.e2];
        let out = sides.map(|side| side.cross(&face.n).normalize());
        let rim = [0, 1, 2].map(|k| out[k].dot(&corners[k]));
        self.faces.push(NearFace { id: t, a: face.a, n: face.n, out, rim });
    }

    /// Those of the edges and corners on a triangle's brim that can be touched from the side on which the centre is, and
    /// how far beside the triangle it can be then (m).
    #[inline]
    fn within_sight(&self, brim: &Brim, height: f64) -> (u8, f64) {
        let sure = self.margin + ASIDE * self.reach;
        let (mut owned, mut steepest) = (0, 1.0);
        if height >= -sure && brim.front != 0 {
            (owned, steepest) = (brim.front, brim.least_front);
        }
        if height <= sure && brim.back != 0 {
            (owned, steepest) = (owned | brim.back, brim.least_back.min(steepest));
        }
        if brim.anywhere != 0 {
            return (owned | brim.anywhere, self.reach);
        }
        let aside = (1.0 - steepest * steepest).max(0.0).sqrt() + ASIDE_SLACK;
        (owned, self.margin + (self.reach - self.margin) * f64::from(aside))
    }

    fn take_edge(&mut self, terrain: &Terrain, id: u32, owner: u32) {
        let [a, b] =
            terrain.features.edges.ends[id as usize].map(|v| terrain.vertices_m[v as usize]);
        let length = (b - a).norm();
        let along = (b - a) / length;
        let to = self.centre - a;
        let s = along.dot(&to);
        if s < -self.margin || s > length + self.margin || (to - along * s).norm() > self.reach {
            return;
        }
        let first = self.rays.len();
        let faces = terrain.features.edges.triangles_on(id);
        for &t in faces {
            let outward = terrain.features.outward(id, t, &terrain.vertices_m);
            if outward.dot(&to) < -self.margin - SLACK * self.radius {
                self.rays.truncate(first);
                return;
            }
            self.rays.push(outward);
        }
        let rays = (first as u32, self.rays.len() as u32);
        let at_border = faces.len() == 1;
        self.edges.push(NearEdge { id, triangle: owner, a, along, length, rays, at_border });
    }

    fn take_corner(&mut self, terrain: &Terrain, id: u32, owner: u32) {
        let p = terrain.vertices_m[id as usize];
        let to = self.centre - p;
        if to.norm() > self.reach {
            return;
        }
        let first = self.rays.len();
        for &v in terrain.features.neighbours(id) {
            let along = (terrain.vertices_m[v as usize] - p).normalize();
            if along.dot(&to) > self.margin + SLACK * self.radius {
                self.rays.truncate(first);
                return;
            }
            self.rays.push(along);
        }
        let rays = (first as u32, self.rays.len() as u32);
        self.corners.push(NearCorner { id, triangle: owner, p, rays });
    }

    /// Whether what was collected holds for a rock at `centre`.
    #[inline]
    pub fn covers(&self, centre: &Vec3) -> bool {
        (centre - self.centre).norm_squared() <= self.margin * self.margin
    }

    /// How far the centre may still go before it must be collected anew (m).
    #[inline]
    pub fn room_m(&self, centre: &Vec3) -> f64 {
        self.margin - (centre - self.centre).norm()
    }

    /// The one face that can touch within the margin, if nothing else can: a certificate that geometry is a plane there.
    #[inline]
    pub fn plane(&self) -> Option<u32> {
        match &self.faces[..] {
            [face] if self.edges.is_empty() && self.corners.is_empty() => Some(face.id),
            _ => None,
        }
    }

    /// The touches of a rock at `centre` that are nearer than `reach` (m), in fixed order: faces, edges, corners.
    #[inline]
    pub fn touches(&self, terrain: &Terrain, centre: &Vec3, reach: f64, touches: &mut Touches) {
        touches.clear();
        let faces = self.faces.iter().filter_map(|face| self.on_face(face, centre, reach));
        let edges = self.edges.iter().filter_map(|edge| self.on_edge(terrain, edge, centre, reach));
        let corners =
            self.corners.iter().filter_map(|corner| self.on_corner(terrain, corner, centre, reach));
        for touch in faces.chain(edges).chain(corners) {
            self.merge(touch, centre, touches);
        }
    }

    /// Whether the foot of `centre` is still on `face`, one of those collected.
    #[inline]
    pub fn is_over(&self, face: u32, centre: &Vec3) -> bool {
        let slack = SLACK * self.radius;
        self.faces.iter().any(|own| own.id == face && own.holds_foot_of(centre, slack))
    }

    /// Whether a rock at `centre` comes nearer than `reach` (m) to nothing but `face`.
    #[inline]
    pub fn is_alone(&self, terrain: &Terrain, face: u32, (centre, reach): (&Vec3, f64)) -> bool {
        let (mut faces, mut edges) = (self.faces.iter(), self.edges.iter());
        faces.all(|other| other.id == face || self.on_face(other, centre, reach).is_none())
            && edges.all(|edge| self.on_edge(terrain, edge, centre, reach).is_none())
            && self
                .corners
                .iter()
                .all(|corner| self.on_corner(terrain, corner, centre, reach).is_none())
    }

    #[inline]
    fn on_face(&self, face: &NearFace, centre: &Vec3, reach: f64) -> Option<Touch> {
        let height = face.n.dot(&(centre - face.a));
        if height.abs() >= reach || !face.holds_foot_of(centre, SLACK * self.radius) {
            return None;
        }
        let feature = Feature { kind: FeatureKind::Face, id: face.id };
        let normal = if height < 0.0 { -face.n } else { face.n };
        Some(Touch { feature, triangle: face.id, normal, distance_m: height.abs() })
    }

    #[inline]
    fn on_edge(
        &self,
        terrain: &Terrain,
        edge: &NearEdge,
        centre: &Vec3,
        reach: f64,
    ) -> Option<Touch> {
        let to = centre - edge.a;
        let s = edge.along.dot(&to);
        let slack = SLACK * self.radius;
        if s < -slack || s > edge.length + slack {
            return None;
        }
        let off = to - edge.along * s.clamp(0.0, edge.length);
        let distance2 = off.norm_squared();
        if distance2 >= reach * reach {
            return None;
        }
        let distance = distance2.sqrt();
        let rays = &self.rays[edge.rays.0 as usize..edge.rays.1 as usize];
        if distance <= slack || rays.iter().any(|out| out.dot(&off) < -SLACK * distance) {
            return None;
        }
        if edge.at_border && self.is_covered(terrain, &(centre - off), centre, distance) {
            return None;
        }
        let feature = Feature { kind: FeatureKind::Edge, id: edge.id };
        let normal = off / distance;
        Some(Touch { feature, triangle: edge.triangle, normal, distance_m: distance })
    }

    #[inline]
    fn on_corner(
        &self,
        terrain: &Terrain,
        corner: &NearCorner,
        centre: &Vec3,
        reach: f64,
    ) -> Option<Touch> {
        let off = centre - corner.p;
        let distance2 = off.norm_squared();
        if distance2 >= reach * reach {
            return None;
        }
        let distance = distance2.sqrt();
        let rays = &self.rays[corner.rays.0 as usize..corner.rays.1 as usize];
        if distance <= SLACK * self.radius
            || rays.iter().any(|along| along.dot(&off) > SLACK * distance)
            || self.is_covered(terrain, &corner.p, centre, distance)
        {
            return None;
        }
        let feature = Feature { kind: FeatureKind::Vertex, id: corner.id };
        let normal = off / distance;
        Some(Touch { feature, triangle: corner.triangle, normal, distance_m: distance })
    }

    /// Whether another triangle runs through `foot` and comes nearer to the centre: then the border or corner at
    /// `foot` lies on the inside of a sheet (a T-junction, a seam) and touches nothing by itself.
    fn is_covered(&self, terrain: &Terrain, foot: &Vec3, centre: &Vec3, distance: f64) -> bool {
        let near = SAME * self.radius;
        self.sheets.iter().any(|&t| {
            let corners = terrain.corners_m(t);
            let gap = |p: &Vec3| (p - closest_on(&corners, p)).norm();
            gap(foot) <= near && gap(centre) < distance * (1.0 - 1e-12)
        })
    }

    /// Adds a touch unless the same point was found on a lower feature before.
    #[inline]
    fn merge(&self, touch: Touch, centre: &Vec3, touches: &mut Touches) {
        let near2 = (SAME * self.radius).powi(2);
        let foot = centre - touch.normal * touch.distance_m;
        let known = touches.iter().any(|other| {
            (other.normal - touch.normal).norm_squared() <= SAME * SAME
                && (centre - other.normal * other.distance_m - foot).norm_squared() <= near2
        });
        if !known {
            touches.add(touch);
        }
    }
}

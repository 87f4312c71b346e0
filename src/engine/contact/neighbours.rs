//! Contact search for a ball: the strict local minima of the distance from its centre to the mesh,
//! and patches where it presses into a fold.
//!
//! The features that may be touched anywhere within a margin of a place are collected once and
//! queried many times. A face is touched where the centre's foot lies inside it; an edge where the
//! centre is outside every face at the edge; a vertex where the centre is behind every edge at it.
//! Flat and concave edges fail these tests from either side of a sheet, and every contact belongs
//! to one feature. Several minima can belong together only where a saddle of the distance is inside
//! the ball too. A saddle is a concave edge that holds the foot of the centre on both its faces, or
//! a vertex among such edges. Then `contact::patch` decides.

mod short_path;
mod features;
mod sharp_features;
mod pressed;
mod collect;

pub(crate) use sharp_features::{SharpEdge, SharpVertex};

use super::closest::{Segment, closest_on};
use super::patch::PatchScratch;
use super::{ContactPoint, ContactPoints, Feature};
use crate::contact::FeatureKind;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use features::{NearEdge, NearFace, NearFeatures, NearSaddle, NearVertex};
pub use pressed::PressedPath;
use short_path::ShortPath;

/// Slack of the tests, relative to the radius (–): a point on a border must not fall between two
/// features. For a rock of 0.1 m it is 1e-10 m, a thousand times the rounding of coordinates of 1
/// km.
const SLACK: f64 = 1e-9;
/// Contacts are the same if their feet are closer than this times the radius and their normals
/// differ by less than this (–). It is larger than the rounding of map coordinates, which bends
/// flat edges by 1e-9.
pub(super) const SAME: f64 = 1e-6;
/// Cosine of the fold between two sheets above which a ball can press into both at the border of
/// one of them (–): springs are compressed by less than a tenth of the radius.
const BLUNT_COSINE: f64 = 0.9;

/// The features that a rock can touch while its centre stays within a margin of a place.
#[derive(Debug)]
pub struct Neighbours {
    /// Centre of the collection (m); infinite before the first one, so that no point is covered.
    centre: Vec3,
    /// Largest distance of a rock's centre from there (m).
    margin: f64,
    /// Radius of the rock (m); slacks are relative to it.
    radius: f64,
    /// Radius, slack and margin together (m): a feature farther from `centre` can touch no rock
    /// within the margin.
    reach: f64,
    /// Features that may be touched within the margin.
    all: NearFeatures,
    /// The subset that may be touched on a short path, and where that path is.
    close: NearFeatures,
    short_path: ShortPath,
    /// Work space for patches around saddles.
    patches: PatchScratch,
    /// Directions that belong to edges and vertices, one after the other: normals of faces, or
    /// edges at a vertex. One list for all keeps them together in memory and avoids an allocation
    /// for each edge.
    directions: Vec<Vec3>,
    /// Broken stems: their triangles are ignored.
    pub broken_stems: Vec<u32>,
    /// Triangles tested so far.
    pub tested: u64,
}

impl Default for Neighbours {
    fn default() -> Self {
        Self {
            all: NearFeatures::with_room(),
            close: NearFeatures::with_room(),
            patches: PatchScratch::with_room(),
            directions: Vec::with_capacity(512),
            ..Self::empty()
        }
    }
}

impl Neighbours {
    /// No features, and no memory allocated: for rocks that are kept by the thousand.
    pub fn empty() -> Self {
        Self {
            centre: Vec3::repeat(f64::INFINITY),
            margin: 0.0,
            radius: 0.0,
            reach: 0.0,
            all: NearFeatures::default(),
            close: NearFeatures::default(),
            short_path: ShortPath::NONE,
            patches: PatchScratch::default(),
            directions: Vec::new(),
            broken_stems: Vec::new(),
            tested: 0,
        }
    }

    /// Invalidates the collection (before the next rock).
    pub fn forget(&mut self) {
        self.centre = Vec3::repeat(f64::INFINITY);
    }

    /// Collects, around `centre` and for a rock of `radius`, all features within `slack` of its
    /// surface while the centre moves up to `margin` (all m).
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
        self.all.clear();
        self.directions.clear();
        self.short_path = ShortPath::NONE;
        // O(log n + k) in the n triangles of the mesh: the tree is traversed once per margin, not
        // once per step
        terrain.index.near(centre, self.reach, |start, count| {
            for t in start..start + count {
                self.tested += 1;
                let face = terrain.face(t);
                let to = centre - face.a;
                let height = face.n.dot(&to);
                if height.abs() <= self.reach && !terrain.is_gone(t, &self.broken_stems) {
                    self.collect_triangle(terrain, (t, &face), (to, height));
                }
            }
        });
    }

    /// The directions of an edge or a vertex.
    #[inline]
    fn directions_of(&self, (first, end): (u32, u32)) -> &[Vec3] {
        &self.directions[first as usize..end as usize]
    }

    /// Whether the collection is valid for a rock at `centre`.
    #[inline]
    pub fn covers(&self, centre: &Vec3) -> bool {
        (centre - self.centre).norm_squared() <= self.margin * self.margin
    }

    /// How far the centre may still move before a new collection is needed (m).
    #[inline]
    pub fn margin_left_m(&self, centre: &Vec3) -> f64 {
        self.margin - (centre - self.centre).norm()
    }

    /// The only face that can be touched within the margin, if there is nothing else: a certificate
    /// that the geometry is a plane there.
    #[inline]
    pub fn plane(&self) -> Option<u32> {
        let NearFeatures { faces, edges, vertices, saddles, .. } = &self.all;
        match &faces[..] {
            // a plane of several triangles has several faces here and gets no certificate;
            // `meets_only_plane` handles it
            [face] if edges.is_empty() && vertices.is_empty() && saddles.is_empty() => {
                Some(face.id)
            }
            _ => None,
        }
    }

    /// The contacts of a rock at `centre` that are nearer than `reach` (m), in fixed order: faces,
    /// edges, vertices. If a saddle is inside the ball, the patches it presses into follow those
    /// contacts that it does not reach yet.
    #[inline]
    pub fn touches(
        &mut self,
        terrain: &Terrain,
        centre: &Vec3,
        reach: f64,
        touches: &mut ContactPoints,
    ) {
        touches.clear();
        self.patches.clear();
        let near = self.candidates((centre, reach));
        // faces before edges before vertices: on a flat mesh the same point is found on several
        // features, and the face keeps it
        for face in &near.faces {
            if let Some(height) = self.face_height(face, centre, reach) {
                self.add_unless_known(face.touch(height), centre, touches);
            }
        }
        for edge in &near.edges {
            if let Some(touch) = self.edge_contact(terrain, edge, centre, reach) {
                self.add_unless_known(touch, centre, touches);
            }
        }
        for vertex in &near.vertices {
            if let Some(touch) = self.vertex_contact(terrain, vertex, centre, reach) {
                self.add_unless_known(touch, centre, touches);
            }
        }
        if self.has_saddle(terrain, &near.saddles, centre) {
            self.replace_by_patches(terrain, (centre, reach), touches);
        }
    }

    /// Whether the foot of `centre` is on `face`, one of those collected.
    #[inline]
    pub fn is_foot_on(&self, face: u32, centre: &Vec3) -> bool {
        let slack = SLACK * self.radius;
        self.all.faces.iter().any(|own| own.id == face && own.holds_foot_of(centre, slack))
    }

    /// Whether a rock at `centre` is nearer than `reach` (m) to nothing but `face`, or a sheet that
    /// lies on it.
    ///
    /// Cheapest tests first: heights over faces need three products, borders a search through all
    /// near triangles.
    #[inline]
    pub fn is_only_contact(
        &self,
        terrain: &Terrain,
        face: u32,
        (centre, reach): (&Vec3, f64),
    ) -> bool {
        let (mut faces, mut edges) = (self.all.faces.iter(), self.all.edges.iter());
        faces.all(|other| {
            other.id == face
                || self.face_height(other, centre, reach).is_none()
                || self.is_duplicate_sheet(face, other, centre)
        }) && !self.has_saddle(terrain, &self.all.saddles, centre)
            && edges.all(|edge| self.edge_contact(terrain, edge, centre, reach).is_none())
            && self
                .all
                .vertices
                .iter()
                .all(|vertex| self.vertex_contact(terrain, vertex, centre, reach).is_none())
    }

    /// Whether another face lies in the plane of `face` and holds the foot of `centre` well inside:
    /// a second sheet, whose contact is the same as that of the first. A seam is no such case:
    /// there the rock rolls from one face to the other.
    #[cold]
    fn is_duplicate_sheet(&self, face: u32, other: &NearFace, centre: &Vec3) -> bool {
        let own = self.all.faces.iter().find(|own| own.id == face);
        own.is_some_and(|own| self.is_coplanar(own, other))
            && other.holds_foot_of(centre, -SLACK * self.radius)
    }

    /// Height over a face (m), if it is smaller than `reach` and the foot of `centre` is on the
    /// face.
    #[inline]
    fn face_height(&self, face: &NearFace, centre: &Vec3, reach: f64) -> Option<f64> {
        let height = face.n.dot(&(centre - face.a));
        let touches = height.abs() < reach && face.holds_foot_of(centre, SLACK * self.radius);
        touches.then_some(height)
    }

    #[inline]
    fn edge_contact(
        &self,
        terrain: &Terrain,
        edge: &NearEdge,
        centre: &Vec3,
        reach: f64,
    ) -> Option<ContactPoint> {
        let Segment { a, along, length } = edge.line;
        let to = centre - a;
        let s = along.dot(&to);
        let slack = SLACK * self.radius;
        // beyond the ends a vertex is nearer
        if s < -slack || s > length + slack {
            return None;
        }
        // the nearest point of the edge: that of its line, clamped to its ends
        let off = to - along * s.clamp(0.0, length);
        let distance2 = off.norm_squared();
        if distance2 >= reach * reach {
            return None;
        }
        let distance = distance2.sqrt();
        let directions = self.directions_of(edge.directions);
        // the centre must be outside every face at the edge: otherwise the nearest point lies on
        // that face
        if distance <= slack || directions.iter().any(|out| out.dot(&off) < -SLACK * distance) {
            return None;
        }
        let feature = Feature { kind: FeatureKind::Edge, id: edge.id };
        if edge.at_border && self.is_covered(terrain, feature, &(centre - off), (centre, distance))
        {
            return None;
        }
        Some(ContactPoint::single(feature, edge.triangle, &off, distance))
    }

    #[inline]
    fn vertex_contact(
        &self,
        terrain: &Terrain,
        vertex: &NearVertex,
        centre: &Vec3,
        reach: f64,
    ) -> Option<ContactPoint> {
        let off = centre - vertex.p;
        let distance2 = off.norm_squared();
        if distance2 >= reach * reach {
            return None;
        }
        let distance = distance2.sqrt();
        let directions = self.directions_of(vertex.directions);
        let feature = Feature { kind: FeatureKind::Vertex, id: vertex.id };
        if distance <= SLACK * self.radius
            // the same for the edges at a vertex: one that leads towards the centre comes nearer
            || directions.iter().any(|along| along.dot(&off) > SLACK * distance)
            || vertex.at_border
                && self.is_covered(terrain, feature, &vertex.p, (centre, distance))
        {
            return None;
        }
        Some(ContactPoint::single(feature, vertex.triangle, &off, distance))
    }

    /// Whether another triangle passes through the `nearest` point of a border edge or vertex and
    /// is nearer to the centre. Then the border lies inside a sheet (a T-junction, a seam) and is
    /// no contact of its own.
    ///
    /// Not at a blunt fold between the two sheets: the ball presses into both at once, each with
    /// its own spring, until the foot on one of them reaches its border. If that border were
    /// covered, the energy of its spring would vanish at once. Coplanar sheets are one contact
    /// throughout, and at a sharp fold the border is already out of reach.
    pub(crate) fn is_covered(
        &self,
        terrain: &Terrain,
        border: Feature,
        nearest: &Vec3,
        (centre, distance): (&Vec3, f64),
    ) -> bool {
        let near = SAME * self.radius;
        let gap = |t: u32, p: &Vec3| (p - closest_on(&terrain.corners_m(t), p)).norm();
        let mut through = self.all.sheets.iter().filter(|&&t| gap(t, nearest) <= near);
        let others = through.clone();
        if !through.any(|&t| gap(t, centre) < distance * (1.0 - 1e-12)) {
            return false;
        }
        let is_own = |&&t: &&u32| border.belongs_to(terrain, t);
        let continues = |own: &u32| {
            others.clone().filter(|t| !is_own(t)).any(|&t| !is_blunt_fold(terrain, *own, t))
        };
        others.clone().filter(is_own).all(continues)
    }

    /// Adds a contact unless the same point was found on a lower feature before.
    #[inline]
    fn add_unless_known(&self, touch: ContactPoint, centre: &Vec3, touches: &mut ContactPoints) {
        if touches.is_empty() {
            touches.add(touch, self.radius);
            return;
        }
        let near2 = (SAME * self.radius).powi(2);
        let nearest = centre - touch.normal * touch.distance_m;
        let known = touches.iter().any(|other| {
            (other.normal - touch.normal).norm_squared() <= SAME * SAME
                && (centre - other.normal * other.distance_m - nearest).norm_squared() <= near2
        });
        if !known {
            touches.add(touch, self.radius);
        }
    }
}

/// Whether two triangles through one point are neither coplanar nor sharply folded.
fn is_blunt_fold(terrain: &Terrain, first: u32, second: u32) -> bool {
    let [first, second] = [first, second].map(|t| terrain.face(t).n);
    let misaligned2 = (first - second).norm_squared().min((first + second).norm_squared());
    misaligned2 > SAME * SAME && first.dot(&second).abs() > BLUNT_COSINE
}

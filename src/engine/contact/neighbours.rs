//! Finding contacts: where a ball touches, the strict local minima of the distance from its centre to the mesh; where it
//! presses into a fold, patches.
//!
//! Around a place, the features that could touch anywhere within a margin are collected once and asked many times.
//! A face touches where the centre's foot lies inside it; an edge where the centre stands outside of every face on
//! it; a vertex where the centre stands behind every edge at it. Flat and hollow edges fail by themselves, from
//! either side of a sheet, and every contact belongs to one feature. Only where a saddle of the distance is inside the
//! ball too – a hollow edge that holds the foot of the centre on both its faces, or a vertex among such – can several
//! minima belong together: then `contact::patch` tells.

mod close;
mod features;
mod offered;
mod pressed;
mod collect;

pub(crate) use offered::{SharpEdge, SharpVertex};

use super::closest::{Segment, closest_on};
use super::patch::PatchScratch;
use super::{ContactPoint, ContactPoints, Feature};
use crate::contact::FeatureKind;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use close::ShortPath;
use features::{NearEdge, NearFace, NearFeatures, NearSaddle, NearVertex};
pub use pressed::PressedPath;

/// Inclusive tests, relative to the radius (–): a point on a border must not fall between two features.
/// For a rock of 0.1 m that is 1e-10 m, a thousand times the rounding of coordinates of 1 km.
const SLACK: f64 = 1e-9;
/// Feet closer than this times the radius, with normals within it, are one contact (–). Loose enough for the
/// rounding of map coordinates, which bends flat edges by 1e-9.
pub(super) const SAME: f64 = 1e-6;
/// Cosine of the fold between two sheets from which on a ball can press into both where one of them ends (–): springs give way by
/// less than a tenth of the radius.
const BLUNT_COSINE: f64 = 0.9;

/// The features a rock can touch while its centre stays within a margin of a place.
#[derive(Debug)]
pub struct Neighbours {
    /// Centre around which it was collected (m); infinite before the first look, so that nothing is covered.
    centre: Vec3,
    /// How far a rock's centre may be from there (m).
    margin: f64,
    /// Radius of the rock (m); slacks are relative to it.
    radius: f64,
    /// Radius, slack and margin together (m): what lies farther from `centre` can touch no rock within the margin.
    reach: f64,
    /// Features that may touch there.
    all: NearFeatures,
    /// Those of them that may touch on a short way, and where that is.
    close: NearFeatures,
    short_path: ShortPath,
    /// Work space for what is pressed into around saddles.
    patches: PatchScratch,
    /// Directions that belong to edges and vertices, one after the other: normals of faces, or edges at a vertex.
    /// One list for all keeps them side by side in memory, and spares an allocation for each edge.
    directions: Vec<Vec3>,
    /// Stems that have given way: they touch nothing any more.
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
    /// No features yet and no memory taken: for rocks that are kept by the thousand.
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
        self.all.clear();
        self.directions.clear();
        self.short_path = ShortPath::NONE;
        // O(log n + k) in the n triangles of the mesh: the tree is walked once per margin, not once per step
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

    /// The directions that belong to an edge or a vertex.
    #[inline]
    fn directions_of(&self, (first, end): (u32, u32)) -> &[Vec3] {
        &self.directions[first as usize..end as usize]
    }

    /// Whether what was collected holds for a rock at `centre`.
    #[inline]
    pub fn covers(&self, centre: &Vec3) -> bool {
        (centre - self.centre).norm_squared() <= self.margin * self.margin
    }

    /// How far the centre may still go before it must be collected anew (m).
    #[inline]
    pub fn margin_left_m(&self, centre: &Vec3) -> f64 {
        self.margin - (centre - self.centre).norm()
    }

    /// The one face that can touch within the margin, if nothing else can: a certificate that geometry is a plane there.
    #[inline]
    pub fn plane(&self) -> Option<u32> {
        let NearFeatures { faces, edges, vertices, saddles, .. } = &self.all;
        match &faces[..] {
            // a plane of several triangles has several faces here, and no certificate: that is
            // asked of `meets_only_plane`
            [face] if edges.is_empty() && vertices.is_empty() && saddles.is_empty() => {
                Some(face.id)
            }
            _ => None,
        }
    }

    /// The touches of a rock at `centre` that are nearer than `reach` (m), in fixed order: faces, edges, corners; where a
    /// saddle is inside the ball, the patches that it presses into after those that it does not reach yet.
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
        // faces before edges before vertices: on a flat mesh the same point is found on several, and the face keeps it
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

    /// Whether the foot of `centre` is still on `face`, one of those collected.
    #[inline]
    pub fn is_foot_on(&self, face: u32, centre: &Vec3) -> bool {
        let slack = SLACK * self.radius;
        self.all.faces.iter().any(|own| own.id == face && own.holds_foot_of(centre, slack))
    }

    /// Whether a rock at `centre` comes nearer than `reach` (m) to nothing but `face`, or a sheet that lies on it.
    ///
    /// Cheapest tests first: heights over faces need three products, borders a search through all
    /// triangles near.
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

    /// Whether another face lies in the plane of `face` with the foot of `centre` well inside of it: a second sheet there, which is
    /// one contact with the first. Both are not told apart by a seam, where a rock rolls from one to the other.
    #[cold]
    fn is_duplicate_sheet(&self, face: u32, other: &NearFace, centre: &Vec3) -> bool {
        let own = self.all.faces.iter().find(|own| own.id == face);
        own.is_some_and(|own| self.is_coplanar(own, other))
            && other.holds_foot_of(centre, -SLACK * self.radius)
    }

    /// Height over a face (m), if it is nearer than `reach` and has the foot of `centre` on it.
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
        // the nearest point of the edge: its line's, held between its ends
        let off = to - along * s.clamp(0.0, length);
        let distance2 = off.norm_squared();
        if distance2 >= reach * reach {
            return None;
        }
        let distance = distance2.sqrt();
        let directions = self.directions_of(edge.directions);
        // the centre must stand outside of every face on the edge: else its nearest point lies on that face
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

    /// Whether another triangle runs through the `nearest` point of a border edge or corner and comes nearer to the centre: then
    /// it lies on the inside of a sheet (a T-junction, a seam) and touches nothing by itself.
    ///
    /// Not where the two sheets part bluntly there: the ball presses into both at once, each with its spring, until the foot
    /// on one of them comes to its border; were that covered, all that its spring holds would vanish at a stroke. Sheets that go
    /// on in one plane are one contact all along, and of a sharp fold the border is out of reach by then.
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

    /// Adds a touch unless the same point was found on a lower feature before.
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

/// Whether two triangles through one point are neither of one plane nor sharply folded against each other.
fn is_blunt_fold(terrain: &Terrain, first: u32, second: u32) -> bool {
    let [first, second] = [first, second].map(|t| terrain.face(t).n);
    let misaligned2 = (first - second).norm_squared().min((first + second).norm_squared());
    misaligned2 > SAME * SAME && first.dot(&second).abs() > BLUNT_COSINE
}

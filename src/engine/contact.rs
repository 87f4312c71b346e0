//! Where a sphere touches the mesh, what it remembers of it, and the paper's 6×6 submatrices.
//!
//! Signs and frames of everything in here; all lengths in metres, in the terrain's local frame (z
//! up, near its origin):
//!
//! ```text
//! c            centre of the sphere, R its radius, q the nearest point of the mesh
//! n            (c − q)/|c − q|, from the mesh towards the centre; the paper's V = −n
//! d, pen       |c − q| and R − d: pen > 0 is pressed in, pen < 0 a gap
//! P1, P2       c − R n and q: the two ends of the contact's springs, Eq. (5)
//! ```
//!
//! Nothing here knows of forces: a contact is geometry and a memory. What passes through it is the
//! law's affair.

pub mod block;
pub mod closest;
pub mod history;
pub mod neighbours;
pub mod pair;
mod patch;
pub mod submatrix;

use crate::rock::Vec3;
use crate::terrain::Terrain;
use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

/// Most contacts one rock keeps at a time, the deepest first.
///
/// Three contacts hold a sphere; more press at the same instant only in hollows with many walls.
/// Should a mesh offer more than fit, those that press least are left out: they carry the least of
/// the load.
pub const MOST: usize = 8;
/// A gap this small is a touch (–, relative to R): rounding of the leap.
///
/// Looser than what sums of positions and times are rounded by, far tighter than any penetration
/// that carries weight: at rest `m g/p_N`, 3e-5 R for a block of 0.5 m on 1e9 N/m.
pub const TOUCH: f64 = 1e-9;

/// What of the mesh was touched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FeatureKind {
    /// Inside of a triangle.
    Face,
    /// Edge between or beside triangles.
    Edge,
    /// Corner.
    Vertex,
}

/// What of the mesh a contact belongs to.
///
/// A kind and a number are the identity of a contact from step to step: the springs' memory is
/// found again by it. Faces of a flat part are different features all the same, so a rock that
/// rolls over a seam hands its memory on by its normal (`history`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Feature {
    /// Face, edge or vertex.
    pub kind: FeatureKind,
    /// Its number in the terrain's triangles, edges or vertices.
    pub id: u32,
}

impl Feature {
    /// Nothing.
    pub const NONE: Self = Self { kind: FeatureKind::Face, id: u32::MAX };

    /// Whether a triangle is this face, or has this edge or vertex.
    pub(crate) fn is_of(self, terrain: &Terrain, triangle: u32) -> bool {
        match self.kind {
            FeatureKind::Face => triangle == self.id,
            FeatureKind::Edge => {
                terrain.features.edges.triangles_on(self.id).any(|on| on == triangle)
            }
            FeatureKind::Vertex => terrain.triangles[triangle as usize].contains(&self.id),
        }
    }
}

impl Default for Feature {
    fn default() -> Self {
        Self::NONE
    }
}

/// Where a ball touches the mesh or presses into it: a patch (`contact::patch`), nearly always a single nearest point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPoint {
    /// What of the mesh is nearest.
    pub feature: Feature,
    /// Triangle whose sheet and ground it answers with.
    pub triangle: u32,
    /// Unit normal from the mesh to the centre; the paper's `V` is its opposite.
    pub normal: Vec3,
    /// Distance from the centre to the mesh (m); pressed in when smaller than the radius. For a patch of several points
    /// that of the point contact that acts like it.
    pub distance_m: f64,
    /// `|a|²`: stiffness of the patch relative to that of a single point (–), 1 for a single point.
    ///
    /// Energy of the patch is `p_N gain2 pen²/2` with `pen = R − distance_m`, its force `p_N gain2
    /// pen` along `normal`: two points pressed in alike, with an angle θ between their normals,
    /// have `1 + cos θ`, never more than 2.
    pub gain2: f64,
}

impl ContactPoint {
    /// A single nearest point, from which the centre is `off` and `distance_m` away (m).
    #[inline]
    pub(crate) fn single(feature: Feature, triangle: u32, off: &Vec3, distance_m: f64) -> Self {
        // off = c − q: the normal comes out of the distance vector itself, so a face, an edge and a
        // vertex are treated alike
        Self { feature, triangle, normal: off / distance_m, distance_m, gain2: 1.0 }
    }

    /// No contact.
    pub const NONE: Self = Self {
        feature: Feature::NONE,
        triangle: 0,
        normal: Vec3::new(0.0, 0.0, 0.0),
        distance_m: f64::INFINITY,
        gain2: 1.0,
    };

    /// Whether it is one point of one face, whose plane tells everything.
    ///
    /// Then `n` is constant and `d` linear in `c`, so the contact is a linear spring: closed forms
    /// and plane kernels apply.
    #[inline]
    pub fn is_on_plane(&self) -> bool {
        self.feature.kind == FeatureKind::Face && self.is_single()
    }

    /// Whether it is one point, no patch of several.
    #[inline]
    #[expect(clippy::float_cmp, reason = "a single point has exactly 1")]
    pub(crate) fn is_single(&self) -> bool {
        self.gain2 == 1.0
    }
}

/// The touches of one rock, without allocation: the list is made anew at every stage of every step.
#[derive(Debug, Clone, Default)]
pub struct ContactPoints(ArrayVec<ContactPoint, MOST>);

impl ContactPoints {
    /// Forgets all.
    #[inline]
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// The same touches from another centre, if all are on faces: their planes tell, nothing need be searched.
    ///
    /// Signed on purpose: a centre that has passed through the plane within a trial step gets a
    /// negative distance, hence more penetration and a force back to the side it came from. An
    /// unsigned distance would push it out on the other side.
    #[inline]
    pub fn slide_to(&mut self, terrain: &Terrain, centre: &Vec3) -> bool {
        if self.0.iter().any(|touch| !touch.is_on_plane()) {
            return false;
        }
        for touch in &mut self.0 {
            // d = n·(c − a): exact for any centre, as long as the foot stays on the face, which the
            // caller sees to
            let corner = terrain.face(touch.feature.id).a;
            touch.distance_m = touch.normal.dot(&(centre - corner));
        }
        true
    }

    /// Those that are nearer than `reach` (m).
    pub(crate) fn nearer(&self, reach: f64) -> Self {
        Self(self.0.iter().filter(|touch| touch.distance_m < reach).copied().collect())
    }

    /// Forgets what a ball with this radius (m) and velocity `v` does not touch, nor comes to within `together` (–, relative to the radius).
    pub(crate) fn keep_struck(&mut self, radius_m: f64, v: &Vec3, together: f64) {
        let [touched, near] = [TOUCH, together].map(|gap| radius_m * (1.0 + gap));
        self.retain(|touch| {
            let comes = touch.normal.dot(v) < 0.0;
            touch.distance_m < touched || touch.distance_m < near && comes
        });
    }

    /// Forgets those that are not nearer than `reach` (m).
    pub fn keep_nearer(&mut self, reach: f64) {
        self.retain(|touch| touch.distance_m < reach);
    }

    /// Forgets those that are not `wanted`.
    pub(crate) fn retain(&mut self, wanted: impl Fn(&ContactPoint) -> bool) {
        self.0.retain(|touch| wanted(touch));
    }

    /// Adds one; when full, it takes the place of the shallowest if it is deeper.
    ///
    /// O(1) until it is full, O(`MOST`) after. Which one gives way depends on distances alone, not
    /// on the order of the search.
    #[inline]
    pub fn add(&mut self, touch: ContactPoint) {
        if self.0.try_push(touch).is_ok() {
            return;
        }
        // the largest distance from the centre is the least penetration
        let shallowest = self.0.iter_mut().max_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        if let Some(place) = shallowest.filter(|place| place.distance_m > touch.distance_m) {
            *place = touch;
        }
    }
}

impl std::ops::Deref for ContactPoints {
    type Target = [ContactPoint];
    #[inline]
    fn deref(&self) -> &[ContactPoint] {
        &self.0
    }
}

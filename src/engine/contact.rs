//! Contact geometry: where a sphere touches the mesh, the history of each contact, and the paper's
//! 6×6 submatrices.
//!
//! Signs and frames used in this module. All lengths are in metres, in the terrain's local frame (z
//! up, origin near the terrain):
//!
//! ```text
//! c            centre of the sphere, R its radius, q the nearest point of the mesh
//! n            (c − q)/|c − q|, from the mesh towards the centre; the paper's V = −n
//! d, pen       |c − q| and R − d: pen > 0 is pressed in, pen < 0 a gap
//! P1, P2       c − R n and q: the two ends of the contact's springs, Eq. (5)
//! ```
//!
//! Nothing here depends on forces: a contact is geometry and a history. The contact law (`ground`)
//! computes what it transmits.

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

/// Most contacts of one rock at a time.
///
/// Three contacts hold a sphere. More act at the same instant only in hollows with many walls. If a
/// mesh has more, those whose normals are nearest to each other are merged, with all their energy
/// and force ([`ContactPoints::add`]).
pub const MAX_CONTACTS: usize = 16;
/// A gap this small counts as a touch (–, relative to R): the rounding error of a flight's end.
///
/// It is larger than the rounding of sums of positions and times, and far smaller than any
/// penetration that carries weight: at rest that is `m g/p_N`, 3e-5 R for a block of 0.5 m on 1e9
/// N/m.
pub const TOUCH: f64 = 1e-9;

/// The kind of a feature of the mesh.
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

/// The feature of the mesh that a contact belongs to.
///
/// Kind and number identify a contact from step to step: its spring history is looked up by them.
/// The triangles of a flat region are different features, so a rock that rolls over a seam passes
/// its history on by the contact normal (`history`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Feature {
    /// Face, edge or vertex.
    pub kind: FeatureKind,
    /// Its number in the terrain's triangles, edges or vertices.
    pub id: u32,
}

impl Feature {
    /// No feature.
    pub const NONE: Self = Self { kind: FeatureKind::Face, id: u32::MAX };

    /// Whether this is a triangle itself, or one of its edges or vertices.
    pub(crate) fn belongs_to(self, terrain: &Terrain, triangle: u32) -> bool {
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

/// A contact of a sphere with the mesh: a patch (`contact::patch`), nearly always a single nearest
/// point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPoint {
    /// The nearest feature of the mesh.
    pub feature: Feature,
    /// The triangle whose ground and sheet apply.
    pub triangle: u32,
    /// Unit normal from the mesh to the centre; the opposite of the paper's `V`.
    pub normal: Vec3,
    /// Distance from the centre to the mesh (m); pressed in when smaller than the radius. For a
    /// patch of several points it is that of the equivalent point contact.
    pub distance_m: f64,
    /// `|a|²`: stiffness of the patch relative to that of a single point (–), 1 for a single point.
    ///
    /// The energy of the patch is `p_N gain2 pen²/2` with `pen = R − distance_m`, and its force
    /// `p_N gain2 pen` along `normal`. Two equally deep points with an angle θ between their
    /// normals have `1 + cos θ`, never more than 2.
    pub gain2: f64,
}

impl ContactPoint {
    /// A contact at a single nearest point; `off` leads from that point to the centre, `distance_m`
    /// long (m).
    #[inline]
    pub(crate) fn single(feature: Feature, triangle: u32, off: &Vec3, distance_m: f64) -> Self {
        // off = c − q: the normal follows from the distance vector itself, so faces, edges and
        // vertices need no separate cases
        Self::with_normal(feature, triangle, (off / distance_m, distance_m))
    }

    /// A contact at a single nearest point, from its unit normal and its distance (m).
    #[inline]
    pub(crate) fn with_normal(
        feature: Feature,
        triangle: u32,
        (normal, distance_m): (Vec3, f64),
    ) -> Self {
        Self { feature, triangle, normal, distance_m, gain2: 1.0 }
    }

    /// No contact.
    pub const NONE: Self = Self {
        feature: Feature::NONE,
        triangle: 0,
        normal: Vec3::new(0.0, 0.0, 0.0),
        distance_m: f64::INFINITY,
        gain2: 1.0,
    };

    /// Whether it is a single point on one face, described completely by the face's plane.
    ///
    /// Then `n` is constant and `d` linear in `c`, so the contact is a linear spring: closed forms
    /// and plane kernels apply.
    #[inline]
    pub fn is_on_plane(&self) -> bool {
        self.feature.kind == FeatureKind::Face && self.is_single()
    }

    /// Whether it is a single point rather than a patch of several.
    #[inline]
    #[expect(clippy::float_cmp, reason = "a single point has exactly 1")]
    pub(crate) fn is_single(&self) -> bool {
        self.gain2 == 1.0
    }
}

/// Sums over the parts of a patch, from which its equivalent point contact follows.
#[derive(Debug, Clone, Copy)]
struct PatchSums {
    /// `Σ w pen²` (m²): the patch holds `U = p_N pen2/2`.
    pen2: f64,
    /// `Σ w pen n` (m): its force is `−∇U = p_N pen_n`.
    pen_n: Vec3,
}

impl PatchSums {
    /// Squared length of `a` below which the forces of a patch cancel (–).
    ///
    /// A ball wedged between two parallel walls has `a = 0`: the forces cancel and no normal is
    /// defined.
    const CANCELLED: f64 = 1e-12;

    /// The sums of one contact with a ball of `radius` (m).
    fn of(touch: &ContactPoint, radius: f64) -> Self {
        let pen = touch.gain2 * (radius - touch.distance_m);
        Self { pen2: pen * (radius - touch.distance_m), pen_n: touch.normal * pen }
    }

    fn add(&mut self, other: &Self) {
        self.pen2 += other.pen2;
        self.pen_n += other.pen_n;
    }

    /// The point contact with the same energy and force, identified by the patch's `nearest` point;
    /// `None` if the patch exerts no force.
    fn equivalent_contact(&self, nearest: &ContactPoint, radius: f64) -> Option<ContactPoint> {
        let pen_n2 = self.pen_n.norm_squared();
        // U ≤ 0 can only be rounding of a sum that cancels; a force without a direction is left out
        // as well
        if self.pen2 <= 0.0 || pen_n2 <= Self::CANCELLED * self.pen2 {
            return None;
        }
        let pen_norm = pen_n2.sqrt();
        // p = √pen2, a = pen_n/p: pressed in by p/|a| = pen2/|pen_n|
        Some(ContactPoint {
            normal: self.pen_n / pen_norm,
            distance_m: radius - self.pen2 / pen_norm,
            gain2: pen_n2 / self.pen2,
            ..*nearest
        })
    }
}

/// The contacts of one rock, without allocation: the list is rebuilt at every stage of every step.
#[derive(Debug, Clone, Default)]
pub struct ContactPoints(ArrayVec<ContactPoint, MAX_CONTACTS>);

impl ContactPoints {
    /// Removes all contacts.
    #[inline]
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Updates the distances for another centre without a new search, if all contacts are on faces;
    /// returns whether they are.
    ///
    /// Distances are signed on purpose. A centre that has passed through the plane within a trial
    /// step gets a negative distance, hence a larger penetration and a force back to the side it
    /// came from. An unsigned distance would push it out on the other side.
    #[inline]
    pub fn update_on_planes(&mut self, terrain: &Terrain, centre: &Vec3) -> bool {
        if self.0.iter().any(|touch| !touch.is_on_plane()) {
            return false;
        }
        for touch in &mut self.0 {
            // d = n·(c − a): exact for any centre, as long as its foot stays on the face, which the
            // caller ensures
            let corner = terrain.face(touch.feature.id).a;
            touch.distance_m = touch.normal.dot(&(centre - corner));
        }
        true
    }

    /// The contacts that are nearer than `reach` (m).
    pub(crate) fn nearer(&self, reach: f64) -> Self {
        Self(self.0.iter().filter(|touch| touch.distance_m < reach).copied().collect())
    }

    /// Keeps the contacts that a ball of this radius (m) touches, and those it approaches with
    /// velocity `v` from within the relative distance `together` (–, over the radius).
    pub(crate) fn retain_impacting(&mut self, radius_m: f64, v: &Vec3, together: f64) {
        let [touched, near] = [TOUCH, together].map(|gap| radius_m * (1.0 + gap));
        self.retain(|touch| {
            let approaches = touch.normal.dot(v) < 0.0;
            touch.distance_m < touched || touch.distance_m < near && approaches
        });
    }

    /// Keeps the contacts that are nearer than `reach` (m).
    pub fn retain_nearer(&mut self, reach: f64) {
        self.retain(|touch| touch.distance_m < reach);
    }

    /// Keeps the contacts for which `keep` holds.
    pub(crate) fn retain(&mut self, keep: impl Fn(&ContactPoint) -> bool) {
        self.0.retain(|touch| keep(touch));
    }

    /// Adds a contact of a ball of `radius` (m). If the list is full, the farthest contact is
    /// dropped if it is not pressed in; otherwise the two contacts with the most similar normals
    /// are merged like the parts of a patch.
    ///
    /// Merging keeps total energy and force, so both stay continuous when the number of contacts
    /// changes. The pair is chosen by normals because these turn slowly, while depths overtake one
    /// another. O(1) until the list is full, O(`MAX_CONTACTS`²) after.
    #[inline]
    pub fn add(&mut self, touch: ContactPoint, radius: f64) {
        if let Err(full) = self.0.try_push(touch) {
            self.make_room(full.element(), radius);
        }
    }

    #[cold]
    fn make_room(&mut self, touch: ContactPoint, radius: f64) {
        let farthest = self.0.iter_mut().max_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        if let Some(place) = farthest.filter(|place| place.distance_m >= radius) {
            if touch.distance_m < place.distance_m {
                *place = touch;
            }
            return;
        }
        if touch.distance_m >= radius {
            return;
        }
        let pairs = (0..MAX_CONTACTS)
            .flat_map(|first| (first + 1..=MAX_CONTACTS).map(move |second| (first, second)));
        let of = |place: usize| *self.0.get(place).unwrap_or(&touch);
        let misaligned =
            |&(first, second): &(usize, usize)| -of(first).normal.dot(&of(second).normal);
        let Some((first, second)) = pairs.min_by(|a, b| misaligned(a).total_cmp(&misaligned(b)))
        else {
            return;
        };
        let (kept, merged) = (of(first), of(second));
        let mut both = PatchSums::of(&kept, radius);
        both.add(&PatchSums::of(&merged, radius));
        // Not the feature of the deeper one: two equally deep contacts would take turns at every
        // query.
        let known = if kept.feature <= merged.feature { kept } else { merged };
        if let Some(last) = self.0.get_mut(second) {
            *last = touch;
        }
        self.0[first] = both.equivalent_contact(&known, radius).unwrap_or(known);
    }
}

impl std::ops::Deref for ContactPoints {
    type Target = [ContactPoint];
    #[inline]
    fn deref(&self) -> &[ContactPoint] {
        &self.0
    }
}

/// Displacement (m) that moves a rock of a radius (m) out of all that it touches, at `off` (m) from
/// where that was found.
pub(crate) fn penetration_correction(touches: &[ContactPoint], radius_m: f64, off: &Vec3) -> Vec3 {
    // each normal adds what the previous ones have not corrected
    touches.iter().fold(Vec3::zeros(), |sum, touch| {
        let missing_m = radius_m - touch.distance_m - (sum + off).dot(&touch.normal);
        sum + touch.normal * missing_m.max(0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_and_force_are_whole_however_many_press() {
        let radius = 2.0;
        let mut touches = ContactPoints::default();
        let mut all = PatchSums { pen2: 0.0, pen_n: Vec3::zeros() };
        for k in 0..3 * MAX_CONTACTS {
            // on a spiral over the lower half, some of them not pressed
            let (turn, down) = (2.4 * k as f64, 0.3 + 0.2 * k as f64 / MAX_CONTACTS as f64);
            let side = (1.0f64 - down * down).sqrt();
            let normal = Vec3::new(side * turn.cos(), side * turn.sin(), down);
            let pen = 0.1 * (1.3 * k as f64).sin();
            let feature = Feature { kind: FeatureKind::Face, id: k as u32 };
            let touch =
                ContactPoint { feature, normal, distance_m: radius - pen, ..ContactPoint::NONE };
            touches.add(touch, radius);
            if pen > 0.0 {
                all.add(&PatchSums::of(&touch, radius));
            }
        }
        let mut kept = PatchSums { pen2: 0.0, pen_n: Vec3::zeros() };
        for touch in touches.iter().filter(|touch| touch.distance_m < radius) {
            kept.add(&PatchSums::of(touch, radius));
        }
        assert_eq!(touches.len(), MAX_CONTACTS);
        assert!((kept.pen2 - all.pen2).abs() < 1e-14, "{} {}", kept.pen2, all.pen2);
        assert!((kept.pen_n - all.pen_n).norm() < 1e-14, "{} {}", kept.pen_n, all.pen_n);
    }
}

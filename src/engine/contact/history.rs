//! Contact histories: the stretches of the shear and rolling springs of a rock's contacts.
//!
//! The normal spring needs no history: its length is geometry, `R − d`. Shear and rolling springs
//! do. Their stretch ξ is the slip against the spring since the contact began, less what the slider
//! of Coulomb's law has released. The method paper has no history (its Eq. (14) vanishes
//! identically), so a sphere held by friction creeps at `T/(p_s dt)`, faster the smaller the step.

use super::{ContactPoint, Feature, MAX_CONTACTS};
use crate::rock::Vec3;
use arrayvec::ArrayVec;

/// Most histories: the contacts at a step's start and those that begin during the step. One bit of
/// a `u32` marks each as taken, so more than 32 would need a change there.
pub const MAX_HISTORIES: usize = 2 * MAX_CONTACTS;

/// Cosine of the rotation of the normal up to which a new contact takes over the springs of an old
/// one (–): a rock that rolls from face to edge to face keeps its friction.
///
/// 45.6°. Between faces that meet at a sharper angle the new contact is another impact and starts
/// without stretch.
pub const SAME_CONTACT_COSINE: f64 = 0.7;

/// The history of one contact.
#[derive(Debug, Clone, Copy)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a fact of its own: none excludes another"
)]
pub struct ContactHistory {
    /// The touched feature.
    pub feature: Feature,
    /// The touched triangle.
    pub triangle: u32,
    /// The triangle on whose ground the springs were first loaded; stiffness and damping are those
    /// of that ground. The springs of an impact stay the same from beginning to end; a lasting
    /// contact changes to the ground it touches (`solver::ground_change`).
    pub springs_of: u32,
    /// Normal to which `shear` is tangent: unit, from the mesh to the centre, at the end of the
    /// last accepted step.
    pub n: Vec3,
    /// Stretch of the shear spring ξ (m).
    ///
    /// Positive in the direction in which the sphere's contact point has moved over the mesh; the
    /// force on the sphere is `−p_s ξ`.
    pub shear: Vec3,
    /// Stretch of the rolling spring (rad).
    ///
    /// All three components, so it holds the spin about the normal (torsion) as well as rolling;
    /// the moment is `−k_r θ`.
    pub roll: Vec3,
    /// Approached too slowly to rebound: overdamped for good, or until another rock strikes through
    /// it.
    ///
    /// Below the capture speed a rebound would be smaller than the errors of the steps, and the
    /// rock would flutter for ever.
    pub captured: bool,
    /// Normal force at the end of the last step (N).
    ///
    /// Used where a lagged force is wanted: first guesses of the next step, the energy of its
    /// spring, stems, and `dda` as printed, whose Eq. (15) caps friction by this force. All other
    /// caps use the force of the stage that is being solved.
    pub normal_force: f64,
    /// Whether it was sliding at the end of the last step.
    pub slides: bool,
    /// Whether the contact was closed at the last accepted step.
    pub closed: bool,
    /// Approach speed at the onset of a contact that may rebound, until the impact has registered
    /// it (m/s); else 0.
    pub onset_m_s: f64,
    /// Damping ratio of its impact (–), where the restitution of the ground falls with the impact
    /// speed; 0 = that of the ground.
    pub damping_ratio: f64,
    /// Whether its beginning has been recorded.
    pub announced: bool,
    /// Number of its impact among those of the rock, from 1; 0 if it was none.
    pub impact: u32,
}

impl ContactHistory {
    /// A new history without stretch.
    pub fn new(touch: &ContactPoint, captured: bool) -> Self {
        Self {
            feature: touch.feature,
            triangle: touch.triangle,
            springs_of: touch.triangle,
            n: touch.normal,
            shear: Vec3::zeros(),
            roll: Vec3::zeros(),
            captured,
            normal_force: 0.0,
            slides: false,
            closed: false,
            onset_m_s: 0.0,
            damping_ratio: 0.0,
            announced: false,
            impact: 0,
        }
    }
}

/// Transports a tangent vector from the normal `from` to the normal `to` by the shortest rotation;
/// its length is kept.
///
/// `x' = x − (n'·x)/(1 + n·n') (n + n')`, Rodrigues' rotation about `n × n'` for a vector with `n·x
/// = 0`: then `n'·x' = 0` and `|x'| = |x|` exactly, so the curvature of the ground does not change
/// the spring's energy `p_s ξ²/2`. A projection would lose stretch at every step of a rock that
/// pivots on an edge. Singular only for `n' = −n`, where no history is kept.
#[inline]
pub fn transport(x: Vec3, from: &Vec3, to: &Vec3) -> Vec3 {
    if from == to { x } else { x - (from + to) * (to.dot(&x) / (1.0 + from.dot(to))) }
}

impl ContactHistory {
    /// Takes over the stretches of a contact that has merged into this one. The merged springs
    /// never store more than both did: `ξ = (ξ_A + ξ_B) min(1, √((ξ_A² + ξ_B²)/|ξ_A + ξ_B|²))`, and
    /// the same for rolling.
    ///
    /// Springs that pull in the same direction merge with less stretch than their sum, because one
    /// spring of stiffness `p_s` holds `p_s (ξ_A + ξ_B)²/2`, up to twice what both held. Springs
    /// that pull against each other cancel; the energy lost counts as friction.
    fn absorb(&mut self, other: &Self) {
        // |ξ|² of the merged spring is capped by the sum of squares: a bound on energy, not on force
        let merged = |own: Vec3, other: Vec3| {
            let (sum, max2) = (own + other, own.norm_squared() + other.norm_squared());
            let size2 = sum.norm_squared();
            if size2 > max2 { sum * (max2 / size2).sqrt() } else { sum }
        };
        // the other stretch is tangent to another normal and is transported first; rolling is a
        // vector in space and needs no transport
        self.shear = merged(self.shear, transport(other.shear, &other.n, &self.n));
        self.roll = merged(self.roll, other.roll);
    }
}

/// The contact histories of one rock, without allocation. Linear search: with one to three entries
/// it is faster than any index.
#[derive(Debug, Clone, Default)]
pub struct ContactHistories(ArrayVec<ContactHistory, MAX_HISTORIES>);

impl ContactHistories {
    /// Removes all histories.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Replaces all histories by these, as many as there is room for.
    pub fn restore(&mut self, histories: &[ContactHistory]) {
        self.0 = histories.iter().take(MAX_HISTORIES).copied().collect();
    }

    /// Adds a history, if there is room.
    pub fn push(&mut self, history: ContactHistory) {
        let _ = self.0.try_push(history);
    }

    /// Removes all after the first `len`.
    pub fn truncate(&mut self, len: usize) {
        self.0.truncate(len);
    }

    /// Index of the history of a contact: its own, else that of a similar contact that has lost its
    /// feature, else a new one.
    ///
    /// `taken` marks histories that belong to other contacts of the same instant.
    ///
    /// The second rule lets a rolling rock keep its friction over seams: the face it leaves is no
    /// contact any more, the face it enters has no history yet, and both normals agree within
    /// `SAME_CONTACT_COSINE`. `captured` is evaluated only for a new contact.
    #[inline]
    pub fn find(
        &mut self,
        touch: &ContactPoint,
        touches: &[ContactPoint],
        taken: u32,
        captured: impl FnOnce() -> bool,
    ) -> usize {
        // two contacts of one instant must not share a spring: it would be stretched twice
        let free = |k: usize| taken & (1 << k) == 0;
        if let Some(k) = (0..self.len()).find(|&k| free(k) && self[k].feature == touch.feature) {
            return k;
        }
        // a history whose feature is still touched stays with it, whatever its normal
        let orphan =
            |history: &ContactHistory| touches.iter().all(|other| other.feature != history.feature);
        let similar = (0..self.len()).find(|&k| {
            free(k) && self[k].n.dot(&touch.normal) > SAME_CONTACT_COSINE && orphan(&self[k])
        });
        similar.unwrap_or_else(|| {
            // there is room for twice the possible contacts; if the list is full all the same, the
            // youngest history is dropped
            self.0.truncate(MAX_HISTORIES - 1);
            self.0.push(ContactHistory::new(touch, captured()));
            self.0.len() - 1
        })
    }

    /// Passes the stretches of every lost contact to the contact it merged into; returns whether
    /// there was any. `successor` gives the feature of that contact. `are_alike` says whether the
    /// grounds of two triangles have the same springs, since other springs give another force for
    /// the same stretch.
    ///
    /// Where two contacts meet at a blunt fold they become one patch. Otherwise its spring would
    /// start without stretch, and the energy of the lost contact would vanish from one step to the
    /// next.
    pub fn merge_lost(
        &mut self,
        successor: impl Fn(Feature) -> Option<Feature>,
        are_alike: impl Fn(u32, u32) -> bool,
    ) -> bool {
        let mut merged = false;
        for k in 0..self.len() {
            let lost = self[k];
            // a closed contact is not lost, and one without stretch has nothing to pass on
            if lost.closed || lost.shear == Vec3::zeros() && lost.roll == Vec3::zeros() {
                continue;
            }
            let Some(feature) = successor(lost.feature) else { continue };
            let takes_over = |history: &&mut ContactHistory| {
                history.closed
                    && history.feature == feature
                    && are_alike(history.springs_of, lost.springs_of)
            };
            if let Some(history) = self.0.iter_mut().find(takes_over) {
                history.absorb(&lost);
                merged = true;
            }
        }
        merged
    }

    /// Keeps only the histories for which `keep` holds, in order.
    pub fn retain(&mut self, mut keep: impl FnMut(&ContactHistory) -> bool) {
        self.0.retain(|history| keep(history));
    }
}

impl std::ops::Deref for ContactHistories {
    type Target = [ContactHistory];
    #[inline]
    fn deref(&self) -> &[ContactHistory] {
        &self.0
    }
}

impl std::ops::DerefMut for ContactHistories {
    #[inline]
    fn deref_mut(&mut self) -> &mut [ContactHistory] {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::FeatureKind;

    /// The history of a contact with face `id`, along a normal.
    fn on_face(id: u32, normal: Vec3) -> ContactHistory {
        let feature = Feature { kind: FeatureKind::Face, id };
        ContactHistory::new(&ContactPoint { feature, normal, ..ContactPoint::NONE }, false)
    }

    /// The history of the contact with face 0 after that with face 1, which has another normal, has
    /// merged into it; the springs of both are alike or not.
    fn merged(stretches: [Vec3; 2], rolls: [Vec3; 2], are_alike: bool) -> (ContactHistory, bool) {
        let normals = [Vec3::z(), Vec3::new(0.6, 0.0, 0.8)];
        let mut both = [0, 1].map(|k| on_face(k, normals[k as usize]));
        for (history, (shear, roll)) in both.iter_mut().zip(stretches.into_iter().zip(rolls)) {
            (history.shear, history.roll) = (shear, roll);
        }
        both[0].closed = true;
        let mut all = ContactHistories::default();
        all.restore(&both);
        let successor = |feature: Feature| (feature == both[1].feature).then_some(both[0].feature);
        let is_merged = all.merge_lost(successor, |_, _| are_alike);
        (all[0], is_merged)
    }

    /// Springs that pull in the same direction merge with the energy of both, `ξ² = ξ_A² + ξ_B²`,
    /// and those that pull against each other with the difference. The stretch of the lost contact
    /// keeps its length and becomes tangent to the other's surface. Unlike springs take nothing
    /// over.
    #[test]
    fn merged_springs_hold_no_more_than_both_did() {
        // up the slope of the other normal; the shortest rotation takes it to x
        let (along, up) = (Vec3::x(), Vec3::new(0.8, 0.0, -0.6));
        let none = [Vec3::zeros(); 2];
        let (history, is_merged) = merged([along * 3.0, up * 4.0], [up * 5.0, up * 12.0], true);
        assert!(is_merged && (history.shear - along * 5.0).norm() < 1e-12, "{:?}", history.shear);
        assert!((history.roll - up * 13.0).norm() < 1e-12, "{:?}", history.roll);
        let (history, _) = merged([along * -3.0, up * 4.0], none, true);
        assert!((history.shear - along).norm() < 1e-12, "{:?}", history.shear);
        let (history, is_merged) = merged([along * 3.0, up * 4.0], none, false);
        assert!(!is_merged && (history.shear - along * 3.0).norm() < 1e-12, "{:?}", history.shear);
    }
}

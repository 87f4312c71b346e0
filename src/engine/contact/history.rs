//! What a rock remembers of its contacts: the stretch of their shear and rolling springs.
//!
//! The normal spring needs no memory: its length is geometry, `R − d`. Shear and rolling springs
//! do: their stretch ξ is what has been slipped against the spring since the contact began, less
//! what Coulomb's law has let go. The method paper has none (its Eq. (14) vanishes identically), so
//! a sphere held by friction creeps at `T/(p_s dt)`, faster the smaller the step.

use super::{ContactPoint, Feature, MAX_CONTACTS};
use crate::rock::Vec3;
use arrayvec::ArrayVec;

/// Most memories: the contacts of a step's start and those that come up during the step.
/// A bit of a `u32` marks each as taken, so no more than 32 would do without a change there.
pub const MAX_HISTORIES: usize = 2 * MAX_CONTACTS;

/// Cosine of the turn of the normal up to which a new contact takes over an old one's springs (–): a rock rolling
/// from face to edge to face keeps its grip.
///
/// 45.6°. Between faces that meet at a sharper angle the new contact is another impact, and starts
/// without stretch.
pub const SAME_CONTACT_COSINE: f64 = 0.7;

/// The memory of one contact.
#[derive(Debug, Clone, Copy)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a fact of its own: none excludes another"
)]
pub struct ContactHistory {
    /// What it touches.
    pub feature: Feature,
    /// Triangle that it touches.
    pub triangle: u32,
    /// Triangle on whose ground its springs were pressed, which has their stiffness and damping. Those of an impact stay the same from
    /// beginning to end; what lasts goes over to the ground it touches (`solver::ground_change`).
    pub springs_of: u32,
    /// Normal to which `shear` is tangent.
    /// Unit, from the mesh to the centre, as of the end of the last accepted step.
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
    /// Came in too slowly to rebound: damped for good, or until another rock strikes through it.
    ///
    /// Below the capture speed a rebound would be smaller than the errors of the steps, and the
    /// rock would flutter for ever.
    pub captured: bool,
    /// Normal force at the end of the last step (N).
    ///
    /// Asked where the last force is wanted: first guesses of the next step, the energy of its
    /// spring, stems, and `dda` as printed, whose Eq. (15) caps friction by this lagged force. All
    /// other caps take the force of the stage that is being solved.
    pub normal_force: f64,
    /// Whether it slid at the end of the last step.
    pub slides: bool,
    /// Whether it was there at the last accepted step.
    pub closed: bool,
    /// Approach at which it has come up, if it may rebound, until the impact has taken notice (m/s); else 0.
    pub onset_m_s: f64,
    /// Damping ratio of its impact (–), where the restitution of the ground falls with the speed of the blow; 0 = that of the ground.
    pub damping_ratio: f64,
    /// Whether its beginning has been noted down.
    pub announced: bool,
    /// As which of the rock's impacts, from 1; 0 where it was none.
    pub impact: u32,
}

impl ContactHistory {
    /// A new memory without stretch.
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

/// Turns a vector tangent at `from` into one tangent at `to` by the shortest rotation; its length stays.
///
/// `x' = x − (n'·x)/(1 + n·n') (n + n')`, Rodrigues' rotation about `n × n'` for a vector with `n·x
/// = 0`: then `n'·x' = 0` and `|x'| = |x|` exactly, so the spring's energy `p_s ξ²/2` does not
/// change because the ground curves. Projecting instead would lose stretch at every step of a rock
/// that pivots on an edge. Singular only for `n' = −n`, which no memory survives.
#[inline]
pub fn transport(x: Vec3, from: &Vec3, to: &Vec3) -> Vec3 {
    if from == to { x } else { x - (from + to) * (to.dot(&x) / (1.0 + from.dot(to))) }
}

impl ContactHistory {
    /// Takes over the stretches of a contact that has merged into this one. They never store more than both did before:
    /// `ξ = (ξ_A + ξ_B) min(1, √((ξ_A² + ξ_B²)/|ξ_A + ξ_B|²))`, and the same for rolling.
    ///
    /// In words: springs that pull the same way merge with less stretch than their sum, because one
    /// spring of stiffness `p_s` holds `p_s (ξ_A + ξ_B)²/2`, up to twice what both held; springs
    /// that pull against each other cancel and the loss is friction's.
    fn absorb(&mut self, other: &Self) {
        // |ξ|² of the merged spring is capped by the sum of squares: an upper bound on energy, not
        // on force
        let merged = |own: Vec3, other: Vec3| {
            let (sum, max2) = (own + other, own.norm_squared() + other.norm_squared());
            let size2 = sum.norm_squared();
            if size2 > max2 { sum * (max2 / size2).sqrt() } else { sum }
        };
        // the stretch of the other is tangent to another normal: it is turned first; rolling is a
        // vector in space and needs no turn
        self.shear = merged(self.shear, transport(other.shear, &other.n, &self.n));
        self.roll = merged(self.roll, other.roll);
    }
}

/// The memories of one rock, without allocation.
/// Searched linearly: with one to three entries that is faster than any index.
#[derive(Debug, Clone, Default)]
pub struct ContactHistories(ArrayVec<ContactHistory, MAX_HISTORIES>);

impl ContactHistories {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Knows these instead, no more than there is room for.
    pub fn restore(&mut self, histories: &[ContactHistory]) {
        self.0 = histories.iter().take(MAX_HISTORIES).copied().collect();
    }

    /// Adds one, if there is room.
    pub fn push(&mut self, history: ContactHistory) {
        let _ = self.0.try_push(history);
    }

    /// Forgets all after the first `len`.
    pub fn truncate(&mut self, len: usize) {
        self.0.truncate(len);
    }

    /// The memory of a touch: its own, else that of a like one which has lost its feature, else a new one.
    ///
    /// `taken` marks memories that belong to other touches of the same instant.
    ///
    /// The second rule lets a rolling rock keep its grip over seams: the face it leaves is no touch
    /// any more, the face it enters has none yet, and both normals agree within `SAME_CONTACT_COSINE`.
    /// `captured` is asked only for a contact that is new.
    #[inline]
    pub fn find(
        &mut self,
        touch: &ContactPoint,
        touches: &[ContactPoint],
        taken: u32,
        captured: impl FnOnce() -> bool,
    ) -> usize {
        // two touches of one instant must not share a spring: it would be stretched twice
        let free = |k: usize| taken & (1 << k) == 0;
        if let Some(k) = (0..self.len()).find(|&k| free(k) && self[k].feature == touch.feature) {
            return k;
        }
        // a memory whose feature is still touched keeps it, whatever its normal
        let orphan =
            |history: &ContactHistory| touches.iter().all(|other| other.feature != history.feature);
        let similar = (0..self.len()).find(|&k| {
            free(k) && self[k].n.dot(&touch.normal) > SAME_CONTACT_COSINE && orphan(&self[k])
        });
        similar.unwrap_or_else(|| {
            // room for twice the contacts there can be; should it be full all the same, the
            // youngest memory is given up
            self.0.truncate(MAX_HISTORIES - 1);
            self.0.push(ContactHistory::new(touch, captured()));
            self.0.len() - 1
        })
    }

    /// Hands the stretches of every contact that is no more to the one that it merged into: `successor` names its feature, `are_alike` says
    /// whether the grounds of two triangles have the same springs, as a stretch means another force by others. Whether there was any.
    ///
    /// Where two contacts meet at a blunt fold they become one patch. Without this its spring would
    /// start slack, and the energy of the one that vanished would be lost from one step to the
    /// next.
    pub fn merge_lost(
        &mut self,
        successor: impl Fn(Feature) -> Option<Feature>,
        are_alike: impl Fn(u32, u32) -> bool,
    ) -> bool {
        let mut merged = false;
        for k in 0..self.len() {
            let lost = self[k];
            // what is still closed is not lost, and what has no stretch leaves nothing
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

    /// Keeps only the memories that `keep` wants, in order.
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

    /// A contact with face `id`, along a normal.
    fn on_face(id: u32, normal: Vec3) -> ContactHistory {
        let feature = Feature { kind: FeatureKind::Face, id };
        ContactHistory::new(&ContactPoint { feature, normal, ..ContactPoint::NONE }, false)
    }

    /// What the contact with face 0 remembers after that with face 1, whose normal is another, has merged into it; the springs of both are alike or not.
    fn merged(stretches: [Vec3; 2], rolls: [Vec3; 2], are_alike: bool) -> (ContactHistory, bool) {
        let normals = [Vec3::z(), Vec3::new(0.6, 0.0, 0.8)];
        let mut both = [0, 1].map(|k| on_face(k, normals[k as usize]));
        for (one, (shear, roll)) in both.iter_mut().zip(stretches.into_iter().zip(rolls)) {
            (one.shear, one.roll) = (shear, roll);
        }
        both[0].closed = true;
        let mut all = ContactHistories::default();
        all.restore(&both);
        let successor = |feature: Feature| (feature == both[1].feature).then_some(both[0].feature);
        let is_merged = all.merge_lost(successor, |_, _| are_alike);
        (all[0], is_merged)
    }

    /// Springs that pull the same way merge with the energy of both, `ξ² = ξ_A² + ξ_B²`, and those that pull against each other with what is
    /// left; the stretch of the one that is gone lies along the other's surface, as long as it was. Other springs take nothing over.
    #[test]
    fn merged_springs_hold_no_more_than_both_did() {
        // up the side of the other normal, which the shortest turn lays on x
        let (along, up) = (Vec3::x(), Vec3::new(0.8, 0.0, -0.6));
        let none = [Vec3::zeros(); 2];
        let (one, is_merged) = merged([along * 3.0, up * 4.0], [up * 5.0, up * 12.0], true);
        assert!(is_merged && (one.shear - along * 5.0).norm() < 1e-12, "{:?}", one.shear);
        assert!((one.roll - up * 13.0).norm() < 1e-12, "{:?}", one.roll);
        let (one, _) = merged([along * -3.0, up * 4.0], none, true);
        assert!((one.shear - along).norm() < 1e-12, "{:?}", one.shear);
        let (one, is_merged) = merged([along * 3.0, up * 4.0], none, false);
        assert!(!is_merged && (one.shear - along * 3.0).norm() < 1e-12, "{:?}", one.shear);
    }
}

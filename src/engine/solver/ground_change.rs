//! Contacts of a rock that moves from one ground to another while it is pressed in.
//!
//! The stiffness of a compressed spring must not change by itself: at one depth a spring of a
//! hundred times the stiffness holds a hundred times the energy. So springs and dashpots of a
//! contact are those of the ground on which it began ([`ContactHistory::springs_of`]); friction
//! stores no energy and is always that of the ground that is touched
//! ([`ContactEnvironment::law_touched`]). An impact keeps these springs to its end, on both sides
//! of a blunt fold.
//!
//! Sustained contact of a rock that rolls, slides or rests takes over the springs of the touched
//! ground as soon as these hold no more energy. On softer ground that is at the end of a step in
//! which little is lost by the change. On stiffer ground it is when the spring has unloaded, or,
//! for a rock alone on one face, at once: the rock is lifted to where the new springs bear the same
//! load. (In worlds it is not lifted, as a rock that moves farther than predicted may run into
//! another.)
//!
//! Where patches of several grounds merge or split in an impact, one passes on what the new spring
//! does not store; that is balanced when the impact is over.

use super::contact_state::{ContactEnvironment, ContactState};
use super::loss::Loss;
use super::plane_kernel::is_on_face;
use crate::contact::TOUCH;
use crate::contact::history::{ContactHistory, SAME_CONTACT_COSINE};
use crate::rock::Vec3;

/// A contact that is this deep when it begins is split off an existing patch (–, relative to the
/// radius of the sphere).
const PRESSED_AT_ONSET: f64 = 1e-5;

/// Largest loss of sustained contact by the change to softer springs (–, relative to kinetic energy
/// and weight times radius). Weight alone stores less. A contact under a larger load, as in a slow
/// impact, changes after it has unloaded.
const MAX_LOSS: f64 = 1e-3;

/// Whether a new patch of a sphere of this radius (m) at this depth (m) is split off an existing
/// one.
pub(super) fn begins_pressed(pressed_m: f64, radius_m: f64) -> bool {
    pressed_m > PRESSED_AT_ONSET * radius_m
}

/// The springs, as a triangle of their ground, that a patch with this normal takes over at a blunt
/// fold: those of the pressed contact, given by normal and springs, whose normal is closest, if
/// both form one patch.
pub(super) fn springs_across_fold(
    normal: &Vec3,
    pressed: impl Iterator<Item = (Vec3, u32)>,
) -> Option<u32> {
    let along = |(n, _): &(Vec3, u32)| n.dot(normal);
    let nearest = pressed.max_by(|one, other| along(one).total_cmp(&along(other)));
    nearest.filter(|one| along(one) > SAME_CONTACT_COSINE).map(|(_, springs_of)| springs_of)
}

/// The lift of a rock that takes over stiffer springs under the load of its softer ones.
struct LiftOntoStiffer {
    /// History of its contact with the new springs.
    after: ContactHistory,
    /// Displacement of the lift (m).
    displacement: Vec3,
    /// Potential energy gained, and the part of it released by the softer spring (J).
    lifted_j: f64,
    from_spring_j: f64,
}

impl ContactState {
    /// Changes the springs of sustained contacts to those of the touched ground where these store
    /// no more energy.
    ///
    /// Called at the end of a step, with the contact points there.
    pub(super) fn update_springs_of_grounds(&mut self, world: &ContactEnvironment) {
        if world.laws.len() == 1 || self.is_rebounding() {
            return;
        }
        let body = &world.body;
        let most_j =
            MAX_LOSS * (self.motion_j(body) + body.mass * body.gravity.norm() * body.radius);
        for k in 0..self.histories.len() {
            let before = self.histories[k];
            let is_seen = self.touches.iter().any(|touch| touch.feature == before.feature);
            if is_seen && !world.are_alike(before.springs_of, before.triangle) {
                let after = ContactHistory { springs_of: before.triangle, ..before };
                let lost_j =
                    self.contact_stored_j(world, &before) - self.contact_stored_j(world, &after);
                if (0.0..=most_j).contains(&lost_j) {
                    self.histories[k] = after;
                    self.fresh = false;
                }
            }
        }
    }

    /// Lifts a rock on one face of stiffer ground, which still lies on the springs of softer
    /// ground, to the depth at which the springs of the face bear the same load. The released
    /// spring energy and the motion supply the potential energy. Returns the released energy, which
    /// was counted as loss when the spring was compressed.
    ///
    /// Without the lift the depth from the soft ground would blunt the folds ahead: ramps of 2 to 4° on
    /// hard ground formed one patch with the face before, without an impact.
    pub(super) fn lift_onto_stiffer(&mut self, world: &ContactEnvironment) -> Option<Loss> {
        let [one] = &self.histories[..] else { return None };
        let has_own_springs =
            world.laws.len() == 1 || world.are_alike(one.springs_of, one.triangle);
        if has_own_springs || self.is_rebounding() || !is_on_face(world, self) {
            return None;
        }
        let LiftOntoStiffer { after, displacement, lifted_j, from_spring_j } = self.lift(world)?;
        let (motion_j, from_motion_j) = (self.motion_j(&world.body), lifted_j - from_spring_j);
        if from_motion_j > MAX_LOSS * motion_j || !self.is_alone_at(world, &(self.c + displacement))
        {
            return None;
        }
        self.leave_plane(world);
        let kept = (1.0 - from_motion_j / motion_j).sqrt();
        (self.c, self.v, self.w) = (self.c + displacement, self.v * kept, self.w * kept);
        self.histories[0] = after;
        self.fresh = false;
        Some(Loss::on_slope([0.0, -from_spring_j, 0.0]).on(world, after.triangle))
    }

    /// The lift of a rock on one face, if the springs of the face are stiffer than its own.
    fn lift(&self, world: &ContactEnvironment) -> Option<LiftOntoStiffer> {
        let (before, pressed_m) = (self.histories[0], self.plane_penetration_m(world));
        let mut after = ContactHistory { springs_of: before.triangle, ..before };
        let (soft, stiff) = (world.springs_of(&before), world.springs_of(&after));
        let [normal, shear, roll] = stiff.stretch_ratios_to(&soft);
        (after.shear, after.roll) = (before.shear * shear, before.roll * roll);
        let displacement = before.n * (pressed_m * (1.0 - normal));
        let lifted_j = world.body.lifted_j(&displacement);
        let released_j =
            soft.stored_j(pressed_m, 0.0, 0.0) - stiff.stored_j(pressed_m * normal, 0.0, 0.0);
        let rises = lifted_j > 0.0 && released_j > 0.0;
        // a spring that unloads anyway does not lift the rock
        rises.then(|| LiftOntoStiffer {
            after,
            displacement,
            lifted_j,
            from_spring_j: released_j.min(lifted_j),
        })
    }

    /// Whether a rock on one face touches nothing else at `c`.
    fn is_alone_at(&mut self, world: &ContactEnvironment, c: &Vec3) -> bool {
        let feature = self.histories[0].feature;
        self.find_contact_points(world, c, world.body.radius * (1.0 + TOUCH));
        self.touches.iter().all(|touch| touch.feature == feature)
    }

    /// Gives a contact that begins at contact point `k` the springs of the pressed contact from
    /// which it splits off, and in an impact those of one with a close normal: at a blunt fold
    /// their patches merge, and energy is conserved only with equal springs.
    pub(super) fn inherit_springs(&mut self, world: &ContactEnvironment, place: usize, k: usize) {
        let touch = &self.touches[k];
        let (radius_m, rebounds) = (world.body.radius, self.is_rebounding());
        let pressed_m = radius_m - touch.distance_m;
        if world.laws.len() == 1 || !(rebounds || begins_pressed(pressed_m, radius_m)) {
            return;
        }
        let is_tree = world.terrain.is_tree(touch.triangle);
        let pressed = self.histories[..place]
            .iter()
            .filter(|one| one.closed || rebounds)
            .filter(|one| world.terrain.is_tree(one.triangle) == is_tree)
            .map(|one| (one.n, one.springs_of));
        if let Some(springs_of) = springs_across_fold(&touch.normal, pressed) {
            self.histories[place].springs_of = springs_of;
        }
    }

    /// Merges the springs of contacts that became part of others; whether there were any.
    pub(crate) fn merge_lost(&mut self, world: &ContactEnvironment) -> bool {
        let Self { histories, near, .. } = self;
        histories.merge_lost(
            |feature| near.patch_holding(world.terrain, feature),
            |one, other| world.are_alike(one, other),
        )
    }

    /// Whether the springs of its contacts are those of several grounds.
    pub(super) fn is_on_several_grounds(&self, world: &ContactEnvironment) -> bool {
        let [first, others @ ..] = &self.histories[..] else { return false };
        others.iter().any(|other| !world.are_alike(first.springs_of, other.springs_of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A patch takes over the springs of the closest normal, and keeps its own where the fold
    /// between them is too sharp for one patch.
    #[test]
    fn a_patch_parts_from_the_likest_side_of_a_blunt_fold() {
        let tilted = |angle: f64| Vec3::new(angle.sin(), 0.0, angle.cos());
        let parted = |sides: &[(f64, u32)]| {
            let pressed = sides.iter().map(|(angle, springs_of)| (tilted(*angle), *springs_of));
            springs_across_fold(&Vec3::z(), pressed)
        };
        let sharp = SAME_CONTACT_COSINE.acos() + 0.01;
        assert_eq!(parted(&[(-0.3, 4), (0.2, 7), (0.5, 9)]), Some(7));
        assert_eq!(parted(&[(sharp - 0.02, 4), (sharp, 7)]), Some(4));
        assert_eq!(parted(&[(sharp, 4), (-1.5, 7)]), None);
    }
}

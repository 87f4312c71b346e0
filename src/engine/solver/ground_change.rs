//! Where a rock comes from one ground to another while it is pressed in.
//!
//! The stiffness of a spring that is pressed must not grow by itself: at one depth a spring of a hundred times the stiffness holds a
//! hundred times the energy. So springs and dashpots of a contact are those of the ground on which they were pressed
//! ([`ContactHistory::springs_of`]); friction holds no energy, and is that of the ground that is touched, in an impact as in all else
//! ([`ContactEnvironment::law_touched`]). An impact is answered by the springs of that one ground to its end, on both sides of a blunt fold. What lasts, a rock
//! that rolls, slides or rests, has the springs of the ground that it touches as soon as these hold no more energy: those of a softer ground
//! at the end of a step in which little is lost so, those of a stiffer one when it has let go, or when a rock alone lies on one face of it: it is lifted to where
//! these bear the same load (in worlds it is not, where a rock that moves farther than it was said to may come into another). Patches of several grounds that meet or part in an impact hand over
//! what the new spring does not hold; that is balanced when the impact is over.

use super::contact_state::{ContactEnvironment, ContactState};
use super::loss::Loss;
use super::plane_kernel::is_on_face;
use crate::contact::TOUCH;
use crate::contact::history::{ContactHistory, SAME_GRIP};
use crate::rock::Vec3;

/// A contact that is so deep when it comes up is part of one that was there, as patches part (–, relative to the radius of the ball).
const PRESSED_AT_ONSET: f64 = 1e-5;

/// What lasting contact loses to softer springs at most, of motion and of the weight lifted by the radius (–): what weight presses in is less. A contact that
/// is pressed harder, as in a slow impact, waits until it is let out.
const MAX_LOSS: f64 = 1e-3;

/// Whether a patch of a ball of this radius (m) that comes up so deep (m) is part of one that was there.
pub(super) fn begins_pressed(pressed_m: f64, radius_m: f64) -> bool {
    pressed_m > PRESSED_AT_ONSET * radius_m
}

/// The springs, by a triangle of their ground, of the patch that one with this normal parts from or meets at a blunt fold: of those that are pressed,
/// told by normal and springs, the one on the likest side, if it is one patch with it.
pub(super) fn springs_across_fold(
    normal: &Vec3,
    pressed: impl Iterator<Item = (Vec3, u32)>,
) -> Option<u32> {
    let along = |(n, _): &(Vec3, u32)| n.dot(normal);
    let nearest = pressed.max_by(|one, other| along(one).total_cmp(&along(other)));
    nearest.filter(|one| along(one) > SAME_GRIP).map(|(_, springs_of)| springs_of)
}

/// What a rock does that comes on stiffer springs under the load of its softer ones.
struct LiftOntoStiffer {
    /// The memory of its contact with the new springs.
    after: ContactHistory,
    /// How far it is lifted (m).
    way: Vec3,
    /// What that costs, and what of it the softer spring gives back (J).
    lifted_j: f64,
    given_j: f64,
}

impl ContactState {
    /// Lets the springs of lasting contacts be those of the ground that they touch, where these hold no more energy.
    ///
    /// Asked at the end of a step, with the touches of that place.
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

    /// Lifts a rock that lies on one face of stiffer ground, on the springs of the softer one from which it came, to the depth at which those of the face
    /// bear the same load; the softer spring and the motion pay for the height. Returns what the spring gives back, booked as taken when it was pressed.
    ///
    /// Its depth on soft ground would blunt the folds ahead: ramps of 2 to 4° of hard ground were met as one patch with what it lay on, without a blow.
    pub(super) fn lift_onto_stiffer(&mut self, world: &ContactEnvironment) -> Option<Loss> {
        let [one] = &self.histories[..] else { return None };
        let has_own_springs =
            world.laws.len() == 1 || world.are_alike(one.springs_of, one.triangle);
        if has_own_springs || self.is_rebounding() || !is_on_face(world, self) {
            return None;
        }
        let LiftOntoStiffer { after, way, lifted_j, given_j } = self.lift(world)?;
        let (motion_j, paid_j) = (self.motion_j(&world.body), lifted_j - given_j);
        if paid_j > MAX_LOSS * motion_j || !self.is_alone_at(world, &(self.c + way)) {
            return None;
        }
        self.leave_plane(world);
        let kept = (1.0 - paid_j / motion_j).sqrt();
        (self.c, self.v, self.w) = (self.c + way, self.v * kept, self.w * kept);
        self.histories[0] = after;
        self.fresh = false;
        Some(Loss::on_slope([0.0, -given_j, 0.0]).on(world, after.triangle))
    }

    /// How a rock on one face would come on its springs, if these are stiffer than those that it lies on.
    fn lift(&self, world: &ContactEnvironment) -> Option<LiftOntoStiffer> {
        let (before, pressed_m) = (self.histories[0], self.plane_penetration_m(world));
        let mut after = ContactHistory { springs_of: before.triangle, ..before };
        let (soft, stiff) = (world.springs_of(&before), world.springs_of(&after));
        let [normal, shear, roll] = stiff.shares_of(&soft);
        (after.shear, after.roll) = (before.shear * shear, before.roll * roll);
        let way = before.n * (pressed_m * (1.0 - normal));
        let lifted_j = world.body.lifted_j(&way);
        let released_j =
            soft.stored_j(pressed_m, 0.0, 0.0) - stiff.stored_j(pressed_m * normal, 0.0, 0.0);
        let rises = lifted_j > 0.0 && released_j > 0.0;
        // what weight does not hold, a spring that is let out, gives no height
        rises.then(|| LiftOntoStiffer { after, way, lifted_j, given_j: released_j.min(lifted_j) })
    }

    /// Whether a rock on one face touches nothing else at `c`.
    fn is_alone_at(&mut self, world: &ContactEnvironment, c: &Vec3) -> bool {
        let feature = self.histories[0].feature;
        self.find_contact_points(world, c, world.body.radius * (1.0 + TOUCH));
        self.touches.iter().all(|touch| touch.feature == feature)
    }

    /// Gives a contact that has just come up at touch `k` the springs of a pressed one that it is parted from, if it is, and in an impact of
    /// one on a like side: at a blunt fold their patches meet, and only of equal springs does the energy stay what it was.
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

    /// Hands the springs of contacts that merged into others to those; whether there were any.
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

    /// A patch has the springs of the likest of those that it may part from, and its own where a fold between them is too sharp for one patch.
    #[test]
    fn a_patch_parts_from_the_likest_side_of_a_blunt_fold() {
        let tilted = |angle: f64| Vec3::new(angle.sin(), 0.0, angle.cos());
        let parted = |sides: &[(f64, u32)]| {
            let pressed = sides.iter().map(|(angle, springs_of)| (tilted(*angle), *springs_of));
            springs_across_fold(&Vec3::z(), pressed)
        };
        let sharp = SAME_GRIP.acos() + 0.01;
        assert_eq!(parted(&[(-0.3, 4), (0.2, 7), (0.5, 9)]), Some(7));
        assert_eq!(parted(&[(sharp - 0.02, 4), (sharp, 7)]), Some(4));
        assert_eq!(parted(&[(sharp, 4), (-1.5, 7)]), None);
    }
}

//! Where a rock comes from one ground to another while it is pressed in.
//!
//! The stiffness of a spring that is pressed must not grow by itself: at one depth a spring of a hundred times the stiffness holds a
//! hundred times the energy. So springs and dashpots of a contact are those of the ground on which they were pressed
//! ([`ContactHistory::springs_of`]); friction holds no energy, and is that of the ground that is touched, in an impact as in all else
//! ([`ContactEnvironment::law_touched`]). An impact is answered by the springs of that one ground to its end, on both sides of a blunt fold. What lasts, a rock
//! that rolls, slides or rests, has the springs of the ground that it touches as soon as these hold no more energy: those of a softer ground
//! at the end of a step in which little is lost so, those of a stiffer one when it has let go. Patches of several grounds that meet or part in an impact hand over
//! what the new spring does not hold; that is balanced when the impact is over.

use super::contact_state::{ContactEnvironment, ContactState};
use crate::contact::history::{ContactHistory, SAME_GRIP};

/// A contact that is so deep when it comes up is part of one that was there, as patches part (–, relative to R).
const PRESSED_AT_BIRTH: f64 = 1e-5;

/// What lasting contact loses to softer springs at most, of motion and of the weight lifted by the radius (–): what weight presses in is less. A contact that
/// is pressed harder, as in a slow impact, waits until it is let out.
const LOSES: f64 = 1e-3;

impl ContactState {
    /// Lets the springs of lasting contacts be those of the ground that they touch, where these hold no more energy.
    ///
    /// Asked at the end of a step, with the touches of that place.
    pub(super) fn follow_grounds(&mut self, world: &ContactEnvironment) {
        if world.laws.len() == 1 || self.is_rebounding() {
            return;
        }
        let body = &world.body;
        let most_j = LOSES * (self.motion_j(body) + body.mass * body.gravity.norm() * body.radius);
        for k in 0..self.histories.len() {
            let before = self.histories[k];
            let is_seen = self.touches.iter().any(|touch| touch.feature == before.feature);
            if is_seen && !world.are_alike(before.springs_of, before.triangle) {
                let after = ContactHistory { springs_of: before.triangle, ..before };
                let lost_j = self.contact_j(world, &before) - self.contact_j(world, &after);
                if (0.0..=most_j).contains(&lost_j) {
                    self.histories[k] = after;
                    self.fresh = false;
                }
            }
        }
    }

    /// Gives a contact that has just come up at touch `k` the springs of a pressed one that it is parted from, if it is, and in an impact of
    /// one on a like side: at a blunt fold their patches meet, and only of equal springs does the energy stay what it was.
    pub(super) fn part_springs(&mut self, world: &ContactEnvironment, place: usize, k: usize) {
        let touch = &self.touches[k];
        let pressed_m = world.body.radius - touch.distance_m;
        let is_parted = pressed_m > PRESSED_AT_BIRTH * world.body.radius;
        let rebounds = self.is_rebounding();
        if world.laws.len() == 1 || !(is_parted || rebounds) {
            return;
        }
        let along = |history: &&ContactHistory| history.n.dot(&touch.normal);
        let is_tree = world.terrain.is_tree(touch.triangle);
        let pressed = self.histories[..place]
            .iter()
            .filter(|one| one.closed || rebounds)
            .filter(|one| world.terrain.is_tree(one.triangle) == is_tree);
        let nearest = pressed.max_by(|a, b| along(a).total_cmp(&along(b)));
        if let Some(one) = nearest.filter(|one| along(one) > SAME_GRIP) {
            self.histories[place].springs_of = one.springs_of;
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

//! Stems that break.
//!
//! The energy that a rock puts into its contact with a stem, springs and friction included, counts
//! against the stem's limit. When the limit is reached, the stem is removed and the rock goes on:
//! schemes with springs cut their step there, in the rigid limit the impulse ends there. Energy
//! taken in earlier contacts with the same rock is not given back. A stem breaks for one rock
//! alone: the next one, also in the same world, finds it intact.
//!
//! A stem struck at one contact alone has a solution of its own (`yielding`); every other case,
//! also with the ground touched, is one blow of all contacts (`joint_blow`): the velocity after a
//! truncated impulse does not follow from that after the whole blow.
//!
//! The limit is an energy (J), drawn for each stem and rock from the scene's distribution: the
//! energy until a trunk breaks is known from pull and impact tests, and it needs no model of the
//! trunk's motion.

use super::body::Twist;
use super::contact_state::{ContactEnvironment, ContactState};
use super::joint_blow::{Breakage, JointContact, JointContacts, JointEnd, joint_blow};
use super::loss::Loss;
use super::rigid::STRUCK_TOGETHER;
use super::stem_load::{PressedTrees, SEVERAL_TREES_RAD};
use super::yielding::yielding_impact;
use crate::contact::history::ContactHistory;
use crate::contact::{ContactPoint, MAX_CONTACTS};
use crate::rock::Vec3;
use crate::terrain::stems::Stems;
use arrayvec::ArrayVec;

/// Stems broken by a blow in the rigid limit.
#[derive(Debug, Clone)]
pub(crate) struct BrokenStems {
    /// The broken stems.
    stems: ArrayVec<u32, MAX_CONTACTS>,
    /// Velocity (m/s) and spin (rad/s) with which the rock goes on.
    pub(crate) motion: Twist,
    /// The contact points struck, and the loss at each.
    pub(crate) struck: ArrayVec<(ContactPoint, Loss), MAX_CONTACTS>,
}

impl ContactState {
    /// Determines whether a pressed stem may break in the next step; returns the longest step (s)
    /// in which it does not take more than is left of its limit.
    pub(crate) fn longest_before_yield_s(&mut self, world: &ContactEnvironment) -> f64 {
        let Some(stems) = world.terrain.stems.as_ref() else { return f64::INFINITY };
        self.stem_load.pressed = self.pressed_trees(world);
        let motion_j = self.motion_j(&world.body);
        // the shares of several trees are evaluated between steps
        let mut may_yield =
            self.stem_load.needs_energy_by_tree(stems, &self.stem_load.pressed, motion_j);
        let mut longest_s =
            if may_yield { SEVERAL_TREES_RAD / self.stiffest_rad_s(world) } else { f64::INFINITY };
        for stem in self.stem_load.pressed.iter().filter_map(|tree| tree.stem) {
            // a stem that the rock's kinetic energy cannot break does not limit the step
            if self.stem_load.may_yield(stems, stem, motion_j) {
                let left_j = self.stem_load.left_j(stems, stem);
                let of_stem =
                    |history: &ContactHistory| stems.of_triangle(history.triangle) == Some(stem);
                longest_s = longest_s.min(self.time_to_take_s(world, left_j, of_stem));
                may_yield = true;
            }
        }
        self.may_yield = may_yield;
        longest_s
    }

    /// After a step with these losses: the pressed stems have taken those of contacts with trees.
    /// Returns whether one has broken; the excess over its limit is then given back to the motion.
    pub(crate) fn load_stems(
        &mut self,
        world: &ContactEnvironment,
        has_springs: bool,
        loss: &mut Loss,
    ) -> bool {
        let Some(stems) = world.terrain.stems.as_ref().filter(|_| loss.trees != 0.0) else {
            self.stem_load.pressed = PressedTrees::default();
            return false;
        };
        // stems broken in the limit of stiff springs have had their energy: the rest went into
        // those standing
        let standing_j = loss.trees - std::mem::take(&mut self.stem_load.broken_j);
        // with springs their energy now; without them, blows have set the weights
        let end = if has_springs { self.pressed_trees(world) } else { PressedTrees::default() };
        let broken = self.stem_load.distribute_until(stems, &end, standing_j);
        for &(stem, beyond_j) in &broken {
            let direction = self.normal_force_direction(stems, stem);
            self.v += given_back(world.body.mass, &self.v, beyond_j, &direction);
            loss.trees -= beyond_j;
            self.remove_stem(stems, stem);
        }
        !broken.is_empty()
    }

    /// Direction of the total normal force of all contacts with a stem, of their normals if forces
    /// are unknown.
    fn normal_force_direction(&self, stems: &Stems, stem: u32) -> Vec3 {
        let of_stem = |history: &&ContactHistory| stems.of_triangle(history.triangle) == Some(stem);
        let histories = || self.histories.iter().filter(of_stem);
        let push: Vec3 = histories().map(|history| history.n * history.normal_force).sum();
        if push == Vec3::zeros() { histories().map(|history| history.n).sum() } else { push }
    }

    /// Stems that break in the blow on all contact points found last, at a velocity and a spin, if
    /// any.
    ///
    /// A stem struck alone breaks as if nothing else were there; the rest of the blow follows with
    /// the remaining motion. Where several contacts with trees are struck, or another contact
    /// presses the rock against a tree, all are solved together.
    pub(crate) fn broken_by(
        &self,
        world: &ContactEnvironment,
        (v, w): (&Vec3, &Vec3),
    ) -> Option<BrokenStems> {
        let stems = world.terrain.stems.as_ref()?;
        let motion_j = world.body.motion_j((v, w));
        let is_standing =
            |touch: &&ContactPoint| !world.terrain.is_gone(touch.triangle, &self.near.broken_stems);
        let standing: ArrayVec<ContactPoint, MAX_CONTACTS> =
            self.touches.iter().filter(is_standing).copied().collect();
        let may_break =
            |touch: &ContactPoint| self.stem_load.may_yield_at(stems, touch.triangle, motion_j);
        if !standing.iter().any(may_break) {
            return None;
        }
        let approaches = |touch: &&ContactPoint| {
            world.terrain.is_tree(touch.triangle) && touch.normal.dot(v) < 0.0
        };
        let mut struck = standing.iter().filter(approaches);
        let first = struck.next()?;
        let alone = struck.next().is_none().then(|| self.broken_alone(world, first, (v, w)));
        let is_among = standing.len() > 1;
        let jointly = || is_among.then(|| self.broken_jointly(world, &standing, (*v, *w)));
        alone.flatten().or_else(|| jointly().flatten())
    }

    /// The break of the stem at `touch`, struck there alone.
    fn broken_alone(
        &self,
        world: &ContactEnvironment,
        touch: &ContactPoint,
        motion: (&Vec3, &Vec3),
    ) -> Option<BrokenStems> {
        let stems = world.terrain.stems.as_ref()?;
        let stem = stems.of_triangle(touch.triangle)?;
        let taken_j = self.stem_load.left_j(stems, stem);
        let contact = (world.law(touch.triangle), &touch.normal);
        let motion = yielding_impact(&world.body, contact, motion, taken_j)?;
        let loss = Loss { trees: taken_j, ..Loss::default() };
        let (stems, struck) =
            ([stem].into_iter().collect(), [(*touch, loss)].into_iter().collect());
        Some(BrokenStems { stems, motion, struck })
    }

    /// The break of stems among all these contact points of one instant.
    fn broken_jointly(
        &self,
        world: &ContactEnvironment,
        touches: &[ContactPoint],
        (v, w): Twist,
    ) -> Option<BrokenStems> {
        let stems = world.terrain.stems.as_ref()?;
        let contact = |(k, touch): (usize, &ContactPoint)| JointContact {
            n: touch.normal,
            end: JointEnd { rock: 0, lever: touch.normal * -world.body.radius },
            other: None,
            gap_m: 0.0,
            law: world.law(touch.triangle).of_patch(touch.gain2, world.dashpot_share(touches, k)),
            captured: world.captures(touch, &v),
            stem: stems.of_triangle(touch.triangle),
        };
        let contacts: JointContacts = touches.iter().enumerate().map(contact).collect();
        let body = world.body.joint((v, w));
        let left_j = |(_, stem)| self.stem_load.left_j(stems, stem);
        let Breakage { after, stems } = joint_blow(&[body], &contacts, left_j)?;
        let taken = touches.iter().zip(&after.loss);
        Some(BrokenStems {
            stems: stems.into_iter().map(|(_, stem)| stem).collect(),
            motion: after.motions[0],
            struck: taken.map(|(touch, loss)| (*touch, loss.on(world, touch.triangle))).collect(),
        })
    }

    /// Removes stems broken within a step whose losses include their energy.
    pub(crate) fn remove_broken_stems(&mut self, world: &ContactEnvironment, broken: &BrokenStems) {
        let Some(stems) = world.terrain.stems.as_ref() else { return };
        let struck = broken.struck.iter().map(|(touch, loss)| (touch.triangle, loss.trees));
        self.remove_stems(stems, struck, broken.stems.iter().copied());
    }

    /// Removes stems, given the energy (J) of each triangle `struck` as part of a tree, and the
    /// stems that are gone.
    pub(crate) fn remove_stems(
        &mut self,
        stems: &Stems,
        struck: impl Iterator<Item = (u32, f64)>,
        gone: impl Iterator<Item = u32> + Clone,
    ) {
        for (triangle, energy_j) in struck {
            self.stem_load.broken_j += energy_j;
            // stems that withstand the same blow have taken energy too
            let touched = stems.of_triangle(triangle);
            if let Some(stem) = touched.filter(|stem| !gone.clone().any(|other| other == *stem)) {
                self.stem_load.add_taken(stem, energy_j);
            }
        }
        for stem in gone {
            self.remove_stem(stems, stem);
        }
    }

    /// Breaks the stems that do not withstand the current blow, in the rigid limit; `note` is
    /// called for every contact point struck, with its loss and whether the rock has just reached
    /// it.
    ///
    /// Before the blow itself: a stem that breaks takes its energy, and the blow follows with what
    /// is left.
    pub(crate) fn break_stems(
        &mut self,
        world: &ContactEnvironment,
        mut note: impl FnMut(&Self, &ContactPoint, (&Loss, bool)),
    ) {
        let Some(stems) = world.terrain.stems.as_ref() else { return };
        let c = self.c;
        self.update_contact_points_ahead(world, &c);
        if !self.touches.iter().any(|touch| world.terrain.is_tree(touch.triangle)) {
            return;
        }
        self.find_contact_points(world, &c, world.body.radius * (1.0 + STRUCK_TOGETHER));
        self.touches.retain_impacting(world.body.radius, &self.v, STRUCK_TOGETHER);
        while let Some(broken) = self.broken_by(world, (&self.v, &self.w)) {
            for (touch, loss) in &broken.struck {
                note(self, touch, (loss, self.is_new_contact(stems, touch)));
            }
            (self.v, self.w) = broken.motion;
            self.remove_broken_stems(world, &broken);
            // its energy is booked here, and is not part of the losses of the step
            self.stem_load.broken_j = 0.0;
        }
    }

    /// Whether a rock has just reached the stem that it touches: only the next blow has been
    /// announced, and a history alone belongs to a rock that rolls up to it.
    fn is_new_contact(&self, stems: &Stems, touch: &ContactPoint) -> bool {
        let stem = stems.of_triangle(touch.triangle);
        let known = |one: &ContactHistory| {
            let is_same = stems.of_triangle(one.triangle) == stem;
            one.announced && !one.captured && is_same && (stem.is_some() || one.n == touch.normal)
        };
        !self.impact_announced
            || !self.histories.iter().chain(self.upcoming_impacts.iter()).any(known)
    }

    /// Removes a stem for this rock, with all its contact histories.
    fn remove_stem(&mut self, stems: &Stems, stem: u32) {
        self.near.broken_stems.push(stem);
        self.near.forget();
        self.histories.retain(|history| stems.of_triangle(history.triangle) != Some(stem));
        self.fresh = false;
        self.plane.forget();
    }
}

/// Change of the velocity `v` (m/s) of a mass (kg) that returns the energy (J) by which the last
/// step exceeded the limit (negative if it did not reach it), along the normal force of the stem.
/// From `m v²/2` along it: `v₁ = ±√(v² + 2 J/m)`; the other components stay.
pub(super) fn given_back(mass_kg: f64, v: &Vec3, energy_j: f64, normal_force: &Vec3) -> Vec3 {
    let along =
        normal_force.try_normalize(0.0).or_else(|| v.try_normalize(0.0)).unwrap_or(Vec3::z());
    let speed = along.dot(v);
    let after = (speed * speed + 2.0 * energy_j / mass_kg).max(0.0).sqrt();
    // a rock that still moves inwards, as nearly always, moves against the force
    let after = if speed > 0.0 { after } else { -after };
    along * (after - speed)
}

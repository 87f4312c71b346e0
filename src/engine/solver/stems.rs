//! Stems that give way.
//!
//! What a rock puts into its contact with a stem, springs and friction included, counts against what the stem can take. When
//! that is what was left of the stem, the stem is gone and the rock goes on: the schemes with springs cut their step there,
//! in the rigid limit the impulse ends there. What a stem took in earlier contacts with the same rock is not given back. A stem
//! gives way to one rock alone: the next, also one that shares its world, finds it whole.
//!
//! A stem that is struck by one contact alone has a law of its own (`yielding`); all else, with the ground that is touched, is one blow of all
//! contacts (`joint_blow`): a push that is cut short goes on forward, and must not be read from the speed with which the whole blow has thrown the rock off.
//!
//! The limit is an energy (J), drawn for each stem and rock from the scene's distribution: what a
//! trunk takes until it breaks is known from pull and impact tests as an energy, and it needs no
//! model of the trunk's motion.

use super::body::Twist;
use super::contact_state::{ContactEnvironment, ContactState};
use super::joint_blow::{Breakage, JointContact, JointContacts, JointEnd, joint_blow};
use super::loss::Loss;
use super::rigid::STRUCK_TOGETHER;
use super::stem_load::{APART_RAD, PressedTrees};
use super::yielding::yielding_impact;
use crate::contact::history::ContactHistory;
use crate::contact::{ContactPoint, MOST};
use crate::rock::Vec3;
use crate::terrain::stems::Stems;
use arrayvec::ArrayVec;

/// How stems give way to a blow in the rigid limit.
#[derive(Debug, Clone)]
pub(crate) struct BrokenStems {
    /// The stems that are gone.
    stems: ArrayVec<u32, MOST>,
    /// Velocity (m/s) and spin (rad/s) with which the rock goes on.
    pub(crate) motion: Twist,
    /// What was struck, and what the blow has lost there.
    pub(crate) struck: ArrayVec<(ContactPoint, Loss), MOST>,
}

impl ContactState {
    /// Sees whether a stem that is pressed may give way in the next step, and returns the longest step (s) in which it does
    /// not take more than is left of it.
    pub(crate) fn longest_before_yield_s(&mut self, world: &ContactEnvironment) -> f64 {
        let Some(stems) = world.terrain.stems.as_ref() else { return f64::INFINITY };
        self.stem_load.pressed = self.pressed_trees(world);
        let motion_j = self.motion_j(&world.body);
        // what each of several takes is known between steps
        let mut may_yield =
            self.stem_load.needs_energy_by_tree(stems, &self.stem_load.pressed, motion_j);
        let mut longest_s =
            if may_yield { APART_RAD / self.stiffest_rad_s(world) } else { f64::INFINITY };
        for stem in self.stem_load.pressed.iter().filter_map(|tree| tree.stem) {
            // all of the rock's motion would not break another: no step need be limited
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

    /// After a step with these losses: the stems pressed have taken what went into contacts with trees. Whether one has
    /// given way; what the step took beyond its limit is then given back.
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
        // what broke in the limit of stiff springs has had its energy and is gone: the rest went into what stands
        let standing_j = loss.trees - std::mem::take(&mut self.stem_load.broken_j);
        // with springs what each holds now; without them blows have told what each took
        let end = if has_springs { self.pressed_trees(world) } else { PressedTrees::default() };
        let giving_way = self.stem_load.distribute_until(stems, &end, standing_j);
        for &(stem, beyond_j) in &giving_way {
            let push = self.push_of(stems, stem);
            self.v += given_back(world.body.mass, &self.v, beyond_j, &push);
            loss.trees -= beyond_j;
            self.remove_stem(stems, stem);
        }
        !giving_way.is_empty()
    }

    /// Direction of the push of all contacts with a stem, by their forces if these are known.
    fn push_of(&self, stems: &Stems, stem: u32) -> Vec3 {
        let of_stem = |history: &&ContactHistory| stems.of_triangle(history.triangle) == Some(stem);
        let histories = || self.histories.iter().filter(of_stem);
        let push: Vec3 = histories().map(|history| history.n * history.normal_force).sum();
        if push == Vec3::zeros() { histories().map(|history| history.n).sum() } else { push }
    }

    /// How stems give way to the blow on all that the last look has found, at a velocity and a spin, if one does.
    ///
    /// One that is struck alone breaks as if nothing else were there; the rest of the blow falls with what it leaves. Where several contacts with trees
    /// are struck, or what else is touched presses the rock against one, all are followed together.
    pub(crate) fn broken_by(
        &self,
        world: &ContactEnvironment,
        (v, w): (&Vec3, &Vec3),
    ) -> Option<BrokenStems> {
        let stems = world.terrain.stems.as_ref()?;
        let motion_j = world.body.motion_j((v, w));
        let stands =
            |touch: &&ContactPoint| !world.terrain.is_gone(touch.triangle, &self.near.gone);
        let standing: ArrayVec<ContactPoint, MOST> =
            self.touches.iter().filter(stands).copied().collect();
        let may_break =
            |touch: &ContactPoint| self.stem_load.may_yield_at(stems, touch.triangle, motion_j);
        if !standing.iter().any(may_break) {
            return None;
        }
        let comes = |touch: &&ContactPoint| {
            world.terrain.is_tree(touch.triangle) && touch.normal.dot(v) < 0.0
        };
        let mut struck = standing.iter().filter(comes);
        let first = struck.next()?;
        let alone = struck.next().is_none().then(|| self.broken_alone(world, first, (v, w)));
        let is_among = standing.len() > 1;
        let jointly = || is_among.then(|| self.broken_jointly(world, &standing, (*v, *w)));
        alone.flatten().or_else(|| jointly().flatten())
    }

    /// How the stem at `touch` gives way that is struck there alone.
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

    /// How stems give way among all these touches of one instant.
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

    /// Stems are gone within a step whose losses hold what they took.
    pub(crate) fn remove_broken_stems(&mut self, world: &ContactEnvironment, broken: &BrokenStems) {
        let Some(stems) = world.terrain.stems.as_ref() else { return };
        let struck = broken.struck.iter().map(|(touch, loss)| (touch.triangle, loss.trees));
        self.remove_stems(stems, struck, broken.stems.iter().copied());
    }

    /// The same with what each triangle has taken that was `struck` as part of a tree (J), and the stems that are gone.
    pub(crate) fn remove_stems(
        &mut self,
        stems: &Stems,
        struck: impl Iterator<Item = (u32, f64)>,
        gone: impl Iterator<Item = u32> + Clone,
    ) {
        for (triangle, energy_j) in struck {
            self.stem_load.broken_j += energy_j;
            // what stands after the same blow has taken its part too
            let stands = stems.of_triangle(triangle);
            if let Some(stem) = stands.filter(|stem| !gone.clone().any(|other| other == *stem)) {
                self.stem_load.add_taken(stem, energy_j);
            }
        }
        for stem in gone {
            self.remove_stem(stems, stem);
        }
    }

    /// Breaks the stems that cannot take the current blow, in the rigid limit; `note` hears of all that is struck, with the touch and
    /// what it took, and whether the rock has just come to it.
    ///
    /// Before the blow itself: a stem that breaks takes its energy, and the rock goes on with what is left.
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
        self.touches.keep_struck(world.body.radius, &self.v, STRUCK_TOGETHER);
        while let Some(broken) = self.broken_by(world, (&self.v, &self.w)) {
            for (touch, loss) in &broken.struck {
                note(self, touch, (loss, self.is_new(stems, touch)));
            }
            (self.v, self.w) = broken.motion;
            self.remove_broken_stems(world, &broken);
            // what it took is booked, and is not among the losses of the step
            self.stem_load.broken_j = 0.0;
        }
    }

    /// Whether a rock has just come to the stem that it touches: only the blow that falls next has been announced, and a memory alone is of a
    /// rock that rolls up to it.
    fn is_new(&self, stems: &Stems, touch: &ContactPoint) -> bool {
        let stem = stems.of_triangle(touch.triangle);
        let known = |one: &ContactHistory| {
            let is_same = stems.of_triangle(one.triangle) == stem;
            one.announced && !one.captured && is_same && (stem.is_some() || one.n == touch.normal)
        };
        !self.impact_announced
            || !self.histories.iter().chain(self.upcoming_impacts.iter()).any(known)
    }

    /// A stem is gone for this rock, with all that its contacts remember.
    fn remove_stem(&mut self, stems: &Stems, stem: u32) {
        self.near.gone.push(stem);
        self.near.forget();
        self.histories.retain(|history| stems.of_triangle(history.triangle) != Some(stem));
        self.fresh = false;
        self.plane.forget();
    }
}

/// Change of the velocity `v` (m/s) of a mass (kg) that gives back what the last step took beyond the limit (J), negative for what
/// it left, along the push of the stem.
/// From `m v²/2` along the push: `v₁ = ±√(v² + 2 J/m)`; the part across it is not touched.
pub(super) fn given_back(mass_kg: f64, v: &Vec3, energy_j: f64, normal_force: &Vec3) -> Vec3 {
    let along =
        normal_force.try_normalize(0.0).or_else(|| v.try_normalize(0.0)).unwrap_or(Vec3::z());
    let speed = along.dot(v);
    let after = (speed * speed + 2.0 * energy_j / mass_kg).max(0.0).sqrt();
    // a rock that is still on its way in, as nearly always, goes against the push
    let after = if speed > 0.0 { after } else { -after };
    along * (after - speed)
}

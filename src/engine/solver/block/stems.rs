//! Stems that give way to a block.
//!
//! The rule is that of spheres (`solver::stems`): what a block puts into its contacts with a stem counts against what the stem can
//! take; when that is what was left of the stem, the stem is gone and the block goes on. A blow that would take more ends there
//! ([`BlockContact::yielding`](super::solve::BlockContact), and of several contacts `solver::joint_blow`).

use super::rolling::Turning;
use super::springs::BlockHistory;
use super::{Footing, Moving, STILL_M_S};
use crate::body::Block;
use crate::contact::block::BlockTouch;
use crate::flight::top::momentum_of;
use crate::rock::Vec3;
use crate::solver::environment::ContactEnvironment;
use crate::solver::joint_blow::{
    Breakage, JointBody, JointContact, JointContacts, JointEnd, joint_blow,
};
use crate::solver::law::capture_m_s;
use crate::solver::loss::Loss;
use crate::solver::stem_load::{PressedTree, PressedTrees, SEVERAL_TREES_RAD};
use crate::solver::stems::given_back;
use crate::terrain::stems::Stems;
use arrayvec::ArrayVec;

impl Footing {
    /// Breaks the stems among the contacts that touch which cannot take the current blow; what it has lost there.
    ///
    /// One that is struck by one contact alone breaks as if nothing else were there; the rest of the blow falls with what it leaves. Where several
    /// contacts with trees are struck, or what else is touched presses the block against one, all are followed together.
    pub(crate) fn break_stems(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        moving: &mut Moving,
    ) -> Option<Loss> {
        let stems = world.terrain.stems.as_ref()?;
        let mut taken: Option<Loss> = None;
        while let Some(loss) = self.break_next(world, stems, (block, moving)) {
            taken.get_or_insert_default().add(&loss, 1.0);
            let pose = moving.pose;
            self.look(world, block, &pose, block.ball_m);
        }
        taken
    }

    /// Breaks the next stems that cannot take the blow; what it has lost.
    fn break_next(
        &mut self,
        world: &ContactEnvironment,
        stems: &Stems,
        (block, moving): (&Block, &mut Moving),
    ) -> Option<Loss> {
        let motion_j = moving.motion_j(block);
        let may_break =
            |touch: &BlockTouch| self.stem_load.may_yield_at(stems, touch.triangle, motion_j);
        if !self.touching(block).any(may_break) {
            return None;
        }
        let comes = |touch: &&BlockTouch| {
            world.terrain.is_tree(touch.triangle) && moving.approach_m_s(block, touch) > STILL_M_S
        };
        let struck: ArrayVec<BlockTouch, 2> =
            self.touching(block).filter(comes).take(2).copied().collect();
        // what springs have pressed already is theirs to follow
        let on_trees = |one: &BlockHistory| world.terrain.is_tree(one.triangle);
        let goes_on = |one: &BlockHistory| on_trees(one) && one.normal_force > 0.0;
        let begins = !self.springs.histories.iter().any(goes_on);
        let is_among = begins && self.touching(block).nth(1).is_some();
        let alone = match struck.as_slice() {
            [] => return None,
            [touch] => self.break_alone(world, touch, (block, moving)),
            _ => None,
        };
        let jointly = alone.is_none() && is_among;
        if jointly { self.break_jointly(world, (block, moving)) } else { alone }
    }

    /// Breaks the stem at a touch, if it is struck there alone and cannot take that; what it had left is lost.
    fn break_alone(
        &mut self,
        world: &ContactEnvironment,
        touch: &BlockTouch,
        (block, moving): (&Block, &mut Moving),
    ) -> Option<Loss> {
        let stems = world.terrain.stems.as_ref()?;
        let stem = stems.of_triangle(touch.triangle)?;
        let left_j = self.stem_load.left_j(stems, stem);
        let mut contact = self.contact(world, (&moving.mass(block), touch), 0.0, Vec3::zeros());
        contact.impulse = contact.yielding(&moving.at(block, &touch.lever), left_j)?;
        moving.take(&[contact], &Turning::NONE, block.mass_kg);
        self.fell(stem);
        Some(Loss { trees: left_j, ..Loss::default() })
    }

    /// Breaks the stems among all contacts that touch which cannot take the blow on all of them; what they have lost.
    fn break_jointly(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &mut Moving),
    ) -> Option<Loss> {
        let stems = world.terrain.stems.as_ref()?;
        self.set_touching_aside(block);
        let mass = moving.mass(block);
        let contact = |touch: &BlockTouch| {
            let approach_m_s = moving.approach_m_s(block, touch);
            let mut law =
                Self::law_of_touch(world, &mass, touch, (approach_m_s, self.aside.iter()));
            let ground = world.ground_of(touch.triangle);
            law.rub_with(self.slip.friction(ground, world.law(touch.triangle), 0.0));
            JointContact {
                n: touch.normal,
                end: JointEnd { rock: 0, lever: touch.lever },
                other: None,
                captured: approach_m_s < capture_m_s(&law),
                gap_m: 0.0,
                law,
                stem: stems.of_triangle(touch.triangle),
            }
        };
        let contacts: JointContacts = self.aside.iter().map(contact).collect();
        let motion = (moving.v, moving.spin(block));
        let body = JointBody { mass_kg: mass.mass, inverse: mass.inverse, motion };
        let left_j = |(_, stem)| self.stem_load.left_j(stems, stem);
        let Breakage { after, stems: broken } = joint_blow(&[body], &contacts, left_j)?;
        let (v, w) = after.motions[0];
        moving.v = v;
        moving.momentum = momentum_of(block.inertia_kg_m2, &moving.pose.attitude, &w);
        let mut lost = Loss::default();
        for ((contact, touch), loss) in contacts.iter().zip(&self.aside).zip(&after.loss) {
            lost.add(&loss.on(world, touch.triangle), 1.0);
            // what stands after the same blow has taken its part too
            if let Some(stem) = contact.stem.filter(|&stem| !broken.contains(&(0, stem))) {
                self.stem_load.add_taken(stem, loss.sum());
            }
        }
        broken.iter().for_each(|&(_, stem)| self.fell(stem));
        Some(lost)
    }

    /// After impulses with these losses: the stems that are touched have taken what went into contacts with trees. One for which that
    /// is more than it can take gives way, and the block gets back what was too much.
    pub(crate) fn bend_stems(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &mut Moving),
        loss: &mut Loss,
    ) {
        let Some(stems) = world.terrain.stems.as_ref().filter(|_| loss.trees != 0.0) else {
            return;
        };
        let mut end = self.pressed_by_springs(world, stems, (block, moving));
        if end.have_no_weight() && self.stem_load.pressed.have_no_weight() {
            self.deepest(stems).into_iter().for_each(|tree| end.add(tree));
        }
        for (stem, beyond_j) in self.stem_load.distribute_until(stems, &end, loss.trees) {
            let push = self.push_of(stems, stem);
            moving.v += given_back(block.mass_kg, &moving.v, beyond_j, &push);
            self.springs.refresh();
            loss.trees -= beyond_j;
            self.fell(stem);
        }
    }

    /// Direction of the joint push of the contacts with a stem: by the forces of their springs, or where these are not known, that of the
    /// contact of the last look that is pressed deepest; 0 if there is none.
    fn push_of(&self, stems: &Stems, stem: u32) -> Vec3 {
        let is_of = |triangle: u32| stems.of_triangle(triangle) == Some(stem);
        let springs = self.springs.histories.iter().filter(|history| is_of(history.triangle));
        let push: Vec3 = springs.map(|history| history.n * history.normal_force.max(0.0)).sum();
        let touched = self.touches.found.iter().filter(|touch| is_of(touch.triangle));
        let deepest = touched.min_by(|one, other| one.gap_m.total_cmp(&other.gap_m));
        if push == Vec3::zeros() { deepest.map_or(push, |touch| touch.normal) } else { push }
    }

    /// Notes which trees are pressed before a blow or a step: by springs, or else what is struck, by the squares of its approaches.
    pub(crate) fn press_stems(
        &mut self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &Moving),
    ) {
        let Some(stems) = world.terrain.stems.as_ref() else { return };
        let mut pressed = self.pressed_by_springs(world, stems, (block, moving));
        if pressed.have_no_weight() {
            let trees = self.touching(block).filter(|touch| world.terrain.is_tree(touch.triangle));
            for touch in trees {
                let weight = moving.approach_m_s(block, touch).max(0.0).powi(2);
                let stem = stems.of_triangle(touch.triangle);
                pressed.add(PressedTree { stem, held_j: 0.0, weight });
            }
        }
        self.stem_load.pressed = pressed;
    }

    /// The longest step (s) in which it is told what each of several trees takes that springs press.
    pub(crate) fn longest_apart_s(
        &self,
        world: &ContactEnvironment,
        (block, moving): (&Block, &Moving),
    ) -> f64 {
        let Some(stems) = world.terrain.stems.as_ref() else { return f64::INFINITY };
        let pressed = self.pressed_by_springs(world, stems, (block, moving));
        if !self.stem_load.needs_energy_by_tree(stems, &pressed, moving.motion_j(block)) {
            return f64::INFINITY;
        }
        SEVERAL_TREES_RAD / self.springs.stiffest(world)
    }

    /// The trees that springs press, with what these hold and the power of their dashpots and of friction.
    fn pressed_by_springs(
        &self,
        world: &ContactEnvironment,
        stems: &Stems,
        (block, moving): (&Block, &Moving),
    ) -> PressedTrees {
        let mut pressed = PressedTrees::default();
        let histories = self.springs.histories.iter();
        for history in histories.filter(|one| one.closed && world.terrain.is_tree(one.triangle)) {
            let velocity = moving.at(block, &(history.point - moving.pose.centre));
            let (held_j, weight) = (history.held_j(), history.taking_w(&velocity));
            let stem = stems.of_triangle(history.triangle);
            pressed.add(PressedTree { stem, held_j, weight });
        }
        pressed
    }

    /// The stem that the contacts of the last look press deepest, if they press one.
    fn deepest(&self, stems: &Stems) -> Option<PressedTree> {
        let touched =
            self.touches.found.iter().filter_map(|touch| {
                stems.of_triangle(touch.triangle).map(|stem| (stem, touch.gap_m))
            });
        let deepest = touched.min_by(|one, other| one.1.total_cmp(&other.1));
        deepest.map(|(stem, _)| PressedTree { stem: Some(stem), held_j: 0.0, weight: 1.0 })
    }

    /// A stem is gone for this block.
    fn fell(&mut self, stem: u32) {
        self.near.gone.push(stem);
        self.near.forget();
        self.looked = None;
        self.springs.forget_look();
    }
}

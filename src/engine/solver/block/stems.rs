//! Stems that break under a block.
//!
//! The rule is that of spheres (`solver::stems`). The energy that a block puts into its contacts
//! with a stem is subtracted from the capacity of the stem. When the capacity is used up, the stem
//! is removed and the block goes on. An impact that would take more ends there
//! ([`BlockContact::yielding`](super::solve::BlockContact), and for several contacts
//! `solver::joint_blow`).

use super::rolling::RollingImpulse;
use super::springs::BlockHistory;
use super::{BlockContactState, BlockState, NO_APPROACH_M_S};
use crate::body::Block;
use crate::contact::block::BlockContactPoint;
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

impl BlockContactState {
    /// Breaks the touching stems that cannot withstand the current impact; returns the energy lost
    /// there.
    ///
    /// A stem that is struck by a single contact breaks as if there were no other contacts; the
    /// rest of the impact follows with the motion that remains. If several contacts with trees are
    /// struck, or if another contact presses the block against a stem, all contacts are followed
    /// together.
    pub(crate) fn break_stems(
        &mut self,
        world: &ContactEnvironment,
        block: &Block,
        state: &mut BlockState,
    ) -> Option<Loss> {
        let stems = world.terrain.stems.as_ref()?;
        let mut taken: Option<Loss> = None;
        while let Some(loss) = self.break_next(world, stems, (block, state)) {
            taken.get_or_insert_default().add(&loss, 1.0);
            let pose = state.pose;
            self.detect(world, block, &pose, block.ball_m);
        }
        taken
    }

    /// Breaks the next stems that cannot withstand the impact; returns the energy lost.
    fn break_next(
        &mut self,
        world: &ContactEnvironment,
        stems: &Stems,
        (block, state): (&Block, &mut BlockState),
    ) -> Option<Loss> {
        let motion_j = state.motion_j(block);
        let may_break = |touch: &BlockContactPoint| {
            self.stem_load.may_yield_at(stems, touch.triangle, motion_j)
        };
        if !self.touching(block).any(may_break) {
            return None;
        }
        let approaches = |touch: &&BlockContactPoint| {
            world.terrain.is_tree(touch.triangle)
                && state.approach_m_s(block, touch) > NO_APPROACH_M_S
        };
        let struck: ArrayVec<BlockContactPoint, 2> =
            self.touching(block).filter(approaches).take(2).copied().collect();
        // a contact that springs have already loaded is followed by them
        let on_trees = |one: &BlockHistory| world.terrain.is_tree(one.triangle);
        let continues = |one: &BlockHistory| on_trees(one) && one.normal_force > 0.0;
        let begins = !self.springs.histories.iter().any(continues);
        let is_among = begins && self.touching(block).nth(1).is_some();
        let alone = match struck.as_slice() {
            [] => return None,
            [touch] => self.break_alone(world, touch, (block, state)),
            _ => None,
        };
        let jointly = alone.is_none() && is_among;
        if jointly { self.break_jointly(world, (block, state)) } else { alone }
    }

    /// Breaks the stem at a contact if it is struck there alone and cannot withstand that; its
    /// remaining capacity is lost.
    fn break_alone(
        &mut self,
        world: &ContactEnvironment,
        touch: &BlockContactPoint,
        (block, state): (&Block, &mut BlockState),
    ) -> Option<Loss> {
        let stems = world.terrain.stems.as_ref()?;
        let stem = stems.of_triangle(touch.triangle)?;
        let left_j = self.stem_load.left_j(stems, stem);
        let mut contact = self.contact(world, (&state.mass(block), touch), 0.0, Vec3::zeros());
        contact.impulse = contact.yielding(&state.velocity_at(block, &touch.lever), left_j)?;
        state.apply_impulses(&[contact], &RollingImpulse::NONE, block.mass_kg);
        self.remove_stem(stem);
        Some(Loss { trees: left_j, ..Loss::default() })
    }

    /// Breaks the stems among all touching contacts that cannot withstand the joint impact; returns
    /// the energy lost.
    fn break_jointly(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
    ) -> Option<Loss> {
        let stems = world.terrain.stems.as_ref()?;
        self.select_touching(block);
        let mass = state.mass(block);
        let contact = |touch: &BlockContactPoint| {
            let approach_m_s = state.approach_m_s(block, touch);
            let mut law =
                Self::law_of_touch(world, &mass, touch, (approach_m_s, self.selected.iter()));
            let ground = world.ground_of(touch.triangle);
            law.set_friction(self.slip.friction(ground, world.law(touch.triangle), 0.0));
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
        let contacts: JointContacts = self.selected.iter().map(contact).collect();
        let motion = (state.v, state.spin(block));
        let body = JointBody { mass_kg: mass.mass, inverse: mass.inverse, motion };
        let left_j = |(_, stem)| self.stem_load.left_j(stems, stem);
        let Breakage { after, stems: broken } = joint_blow(&[body], &contacts, left_j)?;
        let (v, w) = after.motions[0];
        state.v = v;
        state.momentum = momentum_of(block.inertia_kg_m2, &state.pose.attitude, &w);
        let mut lost = Loss::default();
        for ((contact, touch), loss) in contacts.iter().zip(&self.selected).zip(&after.loss) {
            lost.add(&loss.on(world, touch.triangle), 1.0);
            // a stem that withstands the same impact has absorbed its part too
            if let Some(stem) = contact.stem.filter(|&stem| !broken.contains(&(0, stem))) {
                self.stem_load.add_taken(stem, loss.sum());
            }
        }
        broken.iter().for_each(|&(_, stem)| self.remove_stem(stem));
        Some(lost)
    }

    /// After impulses with these losses: the touched stems have absorbed the energy that went into
    /// contacts with trees. A stem whose capacity that exceeds breaks, and the block gets the
    /// excess back.
    pub(crate) fn bend_stems(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &mut BlockState),
        loss: &mut Loss,
    ) {
        let Some(stems) = world.terrain.stems.as_ref().filter(|_| loss.trees != 0.0) else {
            return;
        };
        let mut end = self.pressed_by_springs(world, stems, (block, state));
        if end.have_no_weight() && self.stem_load.pressed.have_no_weight() {
            self.deepest(stems).into_iter().for_each(|tree| end.add(tree));
        }
        for (stem, beyond_j) in self.stem_load.distribute_until(stems, &end, loss.trees) {
            let push = self.push_direction(stems, stem);
            state.v += given_back(block.mass_kg, &state.v, beyond_j, &push);
            self.springs.invalidate_rates();
            loss.trees -= beyond_j;
            self.remove_stem(stem);
        }
    }

    /// Direction of the resultant push of the contacts with a stem: by the forces of their springs
    /// or, if these are unknown, the normal of the deepest contact of the last detection; 0 if
    /// there is none.
    fn push_direction(&self, stems: &Stems, stem: u32) -> Vec3 {
        let is_of = |triangle: u32| stems.of_triangle(triangle) == Some(stem);
        let springs = self.springs.histories.iter().filter(|history| is_of(history.triangle));
        let push: Vec3 = springs.map(|history| history.n * history.normal_force.max(0.0)).sum();
        let touched = self.touches.found.iter().filter(|touch| is_of(touch.triangle));
        let deepest = touched.min_by(|one, other| one.gap_m.total_cmp(&other.gap_m));
        if push == Vec3::zeros() { deepest.map_or(push, |touch| touch.normal) } else { push }
    }

    /// Records which trees are loaded before an impact or a step: by springs or, without any, the
    /// trees that are struck, weighted by the squares of their approach speeds.
    pub(crate) fn press_stems(
        &mut self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) {
        let Some(stems) = world.terrain.stems.as_ref() else { return };
        let mut pressed = self.pressed_by_springs(world, stems, (block, state));
        if pressed.have_no_weight() {
            let trees = self.touching(block).filter(|touch| world.terrain.is_tree(touch.triangle));
            for touch in trees {
                let weight = state.approach_m_s(block, touch).max(0.0).powi(2);
                let stem = stems.of_triangle(touch.triangle);
                pressed.add(PressedTree { stem, held_j: 0.0, weight });
            }
        }
        self.stem_load.pressed = pressed;
    }

    /// Longest step (s) in which the energies can be attributed to each of several trees that
    /// springs load.
    pub(crate) fn longest_apart_s(
        &self,
        world: &ContactEnvironment,
        (block, state): (&Block, &BlockState),
    ) -> f64 {
        let Some(stems) = world.terrain.stems.as_ref() else { return f64::INFINITY };
        let pressed = self.pressed_by_springs(world, stems, (block, state));
        if !self.stem_load.needs_energy_by_tree(stems, &pressed, state.motion_j(block)) {
            return f64::INFINITY;
        }
        SEVERAL_TREES_RAD / self.springs.stiffest(world)
    }

    /// The trees that springs load, with the stored energies and the power of their dashpots and of
    /// friction.
    fn pressed_by_springs(
        &self,
        world: &ContactEnvironment,
        stems: &Stems,
        (block, state): (&Block, &BlockState),
    ) -> PressedTrees {
        let mut pressed = PressedTrees::default();
        let histories = self.springs.histories.iter();
        for history in histories.filter(|one| one.closed && world.terrain.is_tree(one.triangle)) {
            let velocity = state.velocity_at(block, &(history.point - state.pose.centre));
            let (held_j, weight) = (history.held_j(), history.dissipating_w(&velocity));
            let stem = stems.of_triangle(history.triangle);
            pressed.add(PressedTree { stem, held_j, weight });
        }
        pressed
    }

    /// The stem with the deepest contact of the last detection, if there is one.
    fn deepest(&self, stems: &Stems) -> Option<PressedTree> {
        let touched =
            self.touches.found.iter().filter_map(|touch| {
                stems.of_triangle(touch.triangle).map(|stem| (stem, touch.gap_m))
            });
        let deepest = touched.min_by(|one, other| one.1.total_cmp(&other.1));
        deepest.map(|(stem, _)| PressedTree { stem: Some(stem), held_j: 0.0, weight: 1.0 })
    }

    /// Removes a stem for this block.
    fn remove_stem(&mut self, stem: u32) {
        self.near.broken_stems.push(stem);
        self.near.forget();
        self.last_detection = None;
        self.springs.invalidate_touches();
    }
}

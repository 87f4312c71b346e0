//! Energies that one rock has put into stems.

use super::environment::ContactEnvironment;
use super::loss::Loss;
use crate::contact::MAX_CONTACTS;
use crate::random::{Purpose, RandomStream, beside};
use crate::terrain::Terrain;
use crate::terrain::stems::Stems;
use arrayvec::ArrayVec;

/// A stem with at most this share of its limit left (–) breaks: the steps approach its limit
/// asymptotically.
const AT_LIMIT: f64 = 1e-6;

/// Longest step while several trees are pressed (rad of the stiffest contact): their shares are
/// evaluated at both ends of a step.
pub(super) const SEVERAL_TREES_RAD: f64 = 0.1;

/// A stem with more than this times the kinetic energy left (–) cannot break. The tenth on top
/// covers the work of weight during the contact.
const WITHSTANDS: f64 = 1.1;

/// The shares of several trees are irrelevant while each has more than this times the kinetic
/// energy left (–): a rock that rests between stems is not stepped on the time scale of its
/// springs.
const UNNOTICED: f64 = 1e4;

/// A tree that is pressed.
#[derive(Debug, Clone, Copy)]
pub(super) struct PressedTree {
    /// The stem; `None` for a tree that cannot break.
    pub(super) stem: Option<u32>,
    /// Energy in the springs on it (J).
    pub(super) held_j: f64,
    /// Weight of its share of other energy (–): power of dashpots and friction, loss of a blow, or
    /// squared approach speed.
    pub(super) weight: f64,
}

/// The trees that are pressed, each once.
#[derive(Debug, Clone, Default)]
pub(super) struct PressedTrees(ArrayVec<PressedTree, MAX_CONTACTS>);

impl PressedTrees {
    /// Adds a contact with a tree.
    pub(super) fn add(&mut self, tree: PressedTree) {
        match self.0.iter_mut().find(|known| known.stem == tree.stem) {
            Some(known) => {
                known.held_j += tree.held_j;
                known.weight += tree.weight;
            }
            None => self.0.try_push(tree).unwrap_or_default(),
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &PressedTree> {
        self.0.iter()
    }

    /// Whether there are several, so that their shares matter.
    fn are_several(&self) -> bool {
        self.0.len() > 1
    }

    /// Whether no weight and no spring energy distinguishes them.
    pub(super) fn have_no_weight(&self) -> bool {
        self.0.iter().all(|tree| tree.weight == 0.0 && tree.held_j == 0.0)
    }

    /// Energy that each has taken of `lost_j` (J) until `end`: the increase of its springs, and a
    /// share of the rest by its weights at both ends.
    fn energies_until(
        mut self,
        end: &Self,
        lost_j: f64,
    ) -> ArrayVec<(Option<u32>, f64), MAX_CONTACTS> {
        for tree in &mut self.0 {
            tree.held_j = -tree.held_j;
        }
        end.0.iter().for_each(|tree| self.add(*tree));
        let sum = |of: fn(&PressedTree) -> f64| self.0.iter().map(of).sum::<f64>();
        let (rest_j, weight) = (lost_j - sum(|tree| tree.held_j), sum(|tree| tree.weight));
        let evenly = 1.0 / self.0.len() as f64;
        let share = |tree: &PressedTree| if weight > 0.0 { tree.weight / weight } else { evenly };
        self.0.iter().map(|tree| (tree.stem, tree.held_j + rest_j * share(tree))).collect()
    }
}

/// Energies that one rock has put into stems; allocated once for all rocks of a thread.
#[derive(Debug, Clone, Default)]
pub(crate) struct StemLoad {
    /// Limit of a stem of each ground for this rock (J).
    pub(super) limits_j: Vec<f64>,
    /// Stems touched, and the energy each has taken (J).
    pub(super) taken: Vec<(u32, f64)>,
    /// The trees pressed since the last step.
    pub(super) pressed: PressedTrees,
    /// Energy taken by stems that broke within the step; it is part of the step's losses (J).
    pub(super) broken_j: f64,
}

impl StemLoad {
    /// Restores all stems, none of them `gone`, and draws their limits from the rock's random
    /// stream.
    pub(crate) fn reset(&mut self, terrain: &Terrain, random: &RandomStream, gone: &mut Vec<u32>) {
        gone.clear();
        let Some(stems) = &terrain.stems else { return };
        gone.reserve(stems.count());
        self.taken.clear();
        self.taken.reserve(stems.count());
        self.pressed.0.clear();
        self.broken_j = 0.0;
        let mut random = beside(random, Purpose::Stems);
        self.limits_j.clear();
        let limits = stems.limits_j.iter();
        self.limits_j.extend(
            limits.map(|limit| limit.as_ref().map_or(f64::INFINITY, |l| l.draw(&mut random))),
        );
    }

    /// Adds energy taken by a stem (J). Returns its excess over the limit (J), possibly negative by
    /// rounding, if the stem breaks.
    pub(super) fn add_and_check(&mut self, stems: &Stems, stem: u32, energy_j: f64) -> Option<f64> {
        self.add_taken(stem, energy_j);
        let left_j = self.left_j(stems, stem);
        (left_j <= AT_LIMIT * self.limits_j[stems.ground_of(stem)]).then_some(-left_j)
    }

    /// Energy that a stem can still take (J), positive while it stands.
    pub(super) fn left_j(&self, stems: &Stems, stem: u32) -> f64 {
        let taken = self.taken.iter().find(|(known, _)| *known == stem).map_or(0.0, |(_, j)| *j);
        self.limits_j[stems.ground_of(stem)] - taken
    }

    /// Whether this kinetic energy (J) might break a stem.
    pub(super) fn may_yield(&self, stems: &Stems, stem: u32, motion_j: f64) -> bool {
        self.left_j(stems, stem) <= WITHSTANDS * motion_j
    }

    /// Whether the energy of each of these trees matters, given the kinetic energy (J) and that of
    /// the springs on them.
    pub(super) fn needs_energy_by_tree(
        &self,
        stems: &Stems,
        pressed: &PressedTrees,
        motion_j: f64,
    ) -> bool {
        let held_j: f64 = pressed.iter().map(|tree| tree.held_j).sum();
        let moved_j = UNNOTICED * (motion_j + held_j);
        let mut stems_pressed = pressed.iter().filter_map(|tree| tree.stem);
        pressed.are_several() && stems_pressed.any(|stem| self.left_j(stems, stem) <= moved_j)
    }

    /// Whether this kinetic energy (J) might break the stem of a triangle, if it belongs to one.
    pub(super) fn may_yield_at(&self, stems: &Stems, triangle: u32, motion_j: f64) -> bool {
        stems.of_triangle(triangle).is_some_and(|stem| self.may_yield(stems, stem, motion_j))
    }

    /// Adds energy taken by a stem (J), negative where its springs gave some back.
    pub(super) fn add_taken(&mut self, stem: u32, energy_j: f64) {
        match self.taken.iter_mut().find(|(known, _)| *known == stem) {
            Some((_, taken)) => *taken += energy_j,
            None => self.taken.push((stem, energy_j)),
        }
    }

    /// Books the energy that a contact with a triangle has taken, for the `step` and for the stem.
    pub(super) fn book(
        &mut self,
        (world, triangle): (&ContactEnvironment, u32),
        taken: &Loss,
        step: &mut Loss,
    ) {
        step.add(&taken.on(world, triangle), 1.0);
        self.note_impact(world.terrain, triangle, taken.sum());
    }

    /// Notes the loss of a blow on a triangle (J): a tree's triangle gets that weight in the energy
    /// of trees since the last step.
    pub(super) fn note_impact(&mut self, terrain: &Terrain, triangle: u32, energy_j: f64) {
        if let Some(stems) = terrain.stems.as_ref().filter(|_| terrain.is_tree(triangle)) {
            let weight = energy_j.max(0.0);
            self.pressed.add(PressedTree {
                stem: stems.of_triangle(triangle),
                held_j: 0.0,
                weight,
            });
        }
    }

    /// Distributes `lost_j` (J) to the trees pressed since the last step and to those at its `end`.
    /// Returns the stems that break, with their excess over the limit (J).
    pub(super) fn distribute_until(
        &mut self,
        stems: &Stems,
        end: &PressedTrees,
        lost_j: f64,
    ) -> ArrayVec<(u32, f64), MAX_CONTACTS> {
        let taken = std::mem::take(&mut self.pressed).energies_until(end, lost_j);
        let of_stem = |(stem, energy_j): (Option<u32>, f64)| {
            let stem = stem?;
            self.add_and_check(stems, stem, energy_j).map(|beyond_j| (stem, beyond_j))
        };
        taken.into_iter().filter_map(of_stem).collect()
    }
}

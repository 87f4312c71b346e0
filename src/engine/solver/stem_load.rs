//! What one rock has done to the stems.

use crate::contact::MOST;
use crate::contact::history::{ContactHistories, ContactHistory};
use crate::random::{Purpose, RandomStream, beside};
use crate::terrain::Terrain;
use crate::terrain::stems::Stems;
use arrayvec::ArrayVec;

/// A stem with no more than this left of what it can take (–) gives way: the steps come ever nearer to the end of it.
const AT_LIMIT: f64 = 1e-6;

/// A stem that has more than this times the motion left (–) cannot give way.
/// The tenth on top is for what weight may add within the contact.
const WITHSTANDS: f64 = 1.1;

/// What one rock has done to the stems; its memory is taken once for all rocks of a thread.
#[derive(Debug, Clone, Default)]
pub(crate) struct StemLoad {
    /// What a stem of each ground can take of this rock (J).
    pub(super) limits_j: Vec<f64>,
    /// Stems touched, and what each has taken (J).
    pub(super) taken: Vec<(u32, f64)>,
    /// The stems pressed at the last look, each with its share (–) of what trees take.
    pub(super) pressed: ArrayVec<(u32, f64), MOST>,
    /// What stems took that broke within the step, and that is among its losses (J).
    pub(super) broken_j: f64,
}

impl StemLoad {
    /// All stems stand again, none of them `gone`, with limits drawn for the rock of this random stream.
    pub(crate) fn raise(&mut self, terrain: &Terrain, random: &RandomStream, gone: &mut Vec<u32>) {
        gone.clear();
        let Some(stems) = &terrain.stems else { return };
        gone.reserve(stems.count());
        self.taken.clear();
        self.taken.reserve(stems.count());
        self.pressed.clear();
        self.broken_j = 0.0;
        let mut random = beside(random, Purpose::Stems);
        self.limits_j.clear();
        let limits = stems.limits_j.iter();
        self.limits_j.extend(
            limits.map(|limit| limit.as_ref().map_or(f64::INFINITY, |l| l.draw(&mut random))),
        );
    }

    /// Notes what a stem has taken (J); what it took beyond its limit (J), at most rounding less than that, if it gives way.
    pub(super) fn yields(&mut self, stems: &Stems, stem: u32, joule: f64) -> Option<f64> {
        self.take(stem, joule);
        let left_j = self.left_j(stems, stem);
        (left_j <= AT_LIMIT * self.limits_j[stems.ground_of(stem)]).then_some(-left_j)
    }

    /// What a stem can still take (J), positive while it stands.
    pub(super) fn left_j(&self, stems: &Stems, stem: u32) -> f64 {
        let taken = self.taken.iter().find(|(known, _)| *known == stem).map_or(0.0, |(_, j)| *j);
        self.limits_j[stems.ground_of(stem)] - taken
    }

    /// Whether all of this motion (J) might break a stem.
    pub(super) fn may_yield(&self, stems: &Stems, stem: u32, motion_j: f64) -> bool {
        self.left_j(stems, stem) <= WITHSTANDS * motion_j
    }

    /// The same of the stem that a triangle belongs to, if it does to one.
    pub(super) fn may_yield_at(&self, stems: &Stems, triangle: u32, motion_j: f64) -> bool {
        stems.of_triangle(triangle).is_some_and(|stem| self.may_yield(stems, stem, motion_j))
    }

    /// Notes what a stem has taken (J), negative where its springs gave something back.
    pub(super) fn take(&mut self, stem: u32, joule: f64) {
        match self.taken.iter_mut().find(|(known, _)| *known == stem) {
            Some((_, taken)) => *taken += joule,
            None => self.taken.push((stem, joule)),
        }
    }

    /// This stem alone is pressed.
    pub(super) fn press(&mut self, stem: u32) {
        self.pressed.clear();
        self.pressed.push((stem, 1.0));
    }

    /// The stems of these triangles of trees are pressed, with what they take by these weights (–); whether there is any weight. A tree that
    /// stands for good has its share too.
    pub(super) fn share(
        &mut self,
        stems: &Stems,
        weights: impl Iterator<Item = (u32, f64)> + Clone,
    ) -> bool {
        let all: f64 = weights.clone().map(|(_, weight)| weight).sum();
        if all <= 0.0 {
            return false;
        }
        self.pressed.clear();
        for (triangle, weight) in weights.filter(|(_, weight)| *weight > 0.0) {
            let Some(stem) = stems.of_triangle(triangle) else { continue };
            let share = weight / all;
            if let Some((_, known)) = self.pressed.iter_mut().find(|(known, _)| *known == stem) {
                *known += share;
            } else if !self.pressed.is_full() {
                self.pressed.push((stem, share));
            }
        }
        true
    }

    /// Sees which stems are pressed. Springs hold energy by the squares of their forces, and so what trees take is shared, evenly in the
    /// limit of stiff springs, where no force is known; a tree that stands for good has its share too.
    pub(super) fn look(&mut self, terrain: &Terrain, stems: &Stems, histories: &ContactHistories) {
        let trees = histories.iter().filter(|history| terrain.is_tree(history.triangle));
        let force2 = |one: &ContactHistory| (one.triangle, one.normal_force * one.normal_force);
        if !self.share(stems, trees.clone().map(force2)) {
            self.share(stems, trees.map(|history| (history.triangle, 1.0)));
        }
    }
}

//! Stems that give way.
//!
//! What a rock puts into its contact with a stem, springs and friction included, counts against what the stem can take. When
//! that is what was left of the stem, the stem is gone and the rock goes on: the schemes with springs cut their step there,
//! in the rigid limit the impulse ends there. What a stem took in earlier contacts with the same rock is not given back. A stem gives way to one
//! rock alone: the next finds it whole.

use super::driver::Fall;
use crate::contact::history::{ContactHistories, ContactHistory};
use crate::random::{Purpose, RandomStream, beside};
use crate::rock::Vec3;
use crate::solver::Stepper;
use crate::solver::contact_state::TOUCH;
use crate::solver::yielding::yielding_impact;
use crate::terrain::Terrain;
use crate::terrain::stems::Stems;

/// A stem with no more than this left of what it can take (–) gives way: the steps come ever nearer to the end of it.
const AT_LIMIT: f64 = 1e-6;

/// What one rock has done to the stems; its memory is taken once for all rocks of a thread.
#[derive(Debug, Default)]
pub(super) struct StemLoad {
    /// What a stem of each ground can take of this rock (J).
    limits_j: Vec<f64>,
    /// Stems touched, and what each has taken (J).
    taken: Vec<(u32, f64)>,
    /// The stem pressed hardest at the last look.
    pressed: Option<u32>,
}

impl StemLoad {
    /// All stems stand again, with limits drawn for this rock.
    pub(super) fn begin(&mut self, terrain: &Terrain, gone: &mut Vec<u32>, random: &RandomStream) {
        gone.clear();
        let Some(stems) = &terrain.stems else { return };
        gone.reserve(stems.count());
        self.taken.clear();
        self.taken.reserve(stems.count());
        self.pressed = None;
        let mut random = beside(random, Purpose::Stems);
        self.limits_j.clear();
        let limits = stems.limits_j.iter();
        self.limits_j.extend(
            limits.map(|limit| limit.as_ref().map_or(f64::INFINITY, |l| l.draw(&mut random))),
        );
    }

    /// Sees which stem is pressed hardest; a tree that stands for good may be pressed harder.
    fn look(&mut self, terrain: &Terrain, stems: &Stems, histories: &ContactHistories) {
        let trees = histories.iter().filter(|history| terrain.is_tree(history.triangle));
        if let Some(history) =
            trees.max_by(|one, other| one.normal_force.total_cmp(&other.normal_force))
        {
            self.pressed = stems.of_triangle(history.triangle);
        }
    }

    /// What a stem can still take (J), positive while it stands.
    fn left_j(&self, stems: &Stems, stem: u32) -> f64 {
        let taken = self.taken.iter().find(|(known, _)| *known == stem).map_or(0.0, |(_, j)| *j);
        self.limits_j[stems.ground_of(stem)] - taken
    }

    /// Notes what a stem has taken (J), negative where its springs gave something back.
    fn take(&mut self, stem: u32, joule: f64) {
        match self.taken.iter_mut().find(|(known, _)| *known == stem) {
            Some((_, taken)) => *taken += joule,
            None => self.taken.push((stem, joule)),
        }
    }
}

impl<'a> Fall<'a> {
    /// Strikes the stems that cannot take the blow in hand; the rigid limit knows no springs that would yield.
    pub(super) fn strike(&mut self) {
        let terrain: &'a Terrain = self.settings.terrain;
        let Some(stems) = terrain.stems.as_ref() else { return };
        self.load.look(terrain, stems, &self.state.histories);
        let motion_j = self.state.motion_j(&self.world.body);
        let pressed = self.load.pressed;
        self.state.may_yield =
            pressed.is_some_and(|stem| self.load.left_j(stems, stem) <= 1.1 * motion_j);
        if self.settings.step.scheme.has_springs() {
            return;
        }
        let c = self.state.c;
        self.state.look(&self.world, &c, self.world.body.radius * (1.0 + TOUCH));
        let touches = self.state.touches;
        for touch in touches.iter() {
            let Some(stem) = stems.of_triangle(touch.triangle) else { continue };
            let left_j = self.load.left_j(stems, stem);
            if self.state.near.gone.contains(&stem) {
                continue;
            }
            let law = self.world.law(touch.triangle);
            let motion = (&self.state.v, &self.state.w);
            let Some((v, w)) =
                yielding_impact(&self.world.body, (law, &touch.normal), motion, left_j)
            else {
                continue;
            };
            let of_stem =
                |history: &ContactHistory| stems.of_triangle(history.triangle) == Some(stem);
            if !self.state.histories.iter().any(of_stem) {
                let approach_m_s = -touch.normal.dot(&self.state.v);
                self.in_contact().begin_impact(
                    &ContactHistory::new(touch, false),
                    approach_m_s,
                    0.0,
                );
            }
            (self.state.v, self.state.w) = (v, w);
            self.recorder.ledger.trees_j += left_j;
            self.fell(stems, stem);
        }
    }

    /// The longest step (s) in which the stem pressed hardest does not take more than is left of it.
    pub(super) fn longest_before_yield_s(&self) -> f64 {
        let Some(stems) = self.settings.terrain.stems.as_ref() else { return f64::INFINITY };
        match self.load.pressed {
            Some(stem) if self.state.may_yield && self.settings.step.scheme.has_springs() => {
                let left_j = self.load.left_j(stems, stem);
                let of_stem =
                    |history: &ContactHistory| stems.of_triangle(history.triangle) == Some(stem);
                self.state.time_to_take_s(&self.world, left_j, of_stem)
            }
            _ => f64::INFINITY,
        }
    }

    /// After a step in which `trees_j` went into contacts with trees: the stem pressed hardest has taken it, and may
    /// have given way.
    pub(super) fn bend(&mut self, trees_j: f64, stepper: &mut Stepper) {
        let terrain: &'a Terrain = self.settings.terrain;
        let Some(stems) = terrain.stems.as_ref().filter(|_| trees_j != 0.0) else { return };
        self.load.look(terrain, stems, &self.state.histories);
        let Some(stem) = self.load.pressed else { return };
        self.load.take(stem, trees_j);
        let left_j = self.load.left_j(stems, stem);
        if left_j > AT_LIMIT * self.load.limits_j[stems.ground_of(stem)] {
            return;
        }
        let normal_force: Vec3 = self
            .state
            .histories
            .iter()
            .filter(|history| stems.of_triangle(history.triangle) == Some(stem))
            .map(|history| history.n * history.normal_force.max(f64::MIN_POSITIVE))
            .sum();
        self.give_back(-left_j, &normal_force);
        self.fell(stems, stem);
        *stepper = Stepper::new(self.settings.step, &self.world, self.state);
    }

    /// Gives back what the last step took beyond the limit (J), negative for what it left, along the push of the stem.
    fn give_back(&mut self, joule: f64, normal_force: &Vec3) {
        let v = self.state.v;
        let along =
            normal_force.try_normalize(0.0).or_else(|| v.try_normalize(0.0)).unwrap_or(Vec3::z());
        let speed = along.dot(&v);
        let after = (speed * speed + 2.0 * joule / self.world.body.mass).max(0.0).sqrt();
        // a rock that is still on its way in, as nearly always, goes against the push
        let after = if speed > 0.0 { after } else { -after };
        self.state.v += along * (after - speed);
        self.recorder.ledger.trees_j -= joule;
    }

    /// A stem is gone for this rock, with all that its contacts remember.
    fn fell(&mut self, stems: &Stems, stem: u32) {
        self.state.near.gone.push(stem);
        self.state.near.forget();
        self.state.histories.retain(|history| stems.of_triangle(history.triangle) != Some(stem));
        self.state.fresh = false;
        self.state.plane_kernel.forget();
        self.load.pressed = None;
    }
}

//! Stems that give way.
//!
//! What a rock puts into its contact with a stem, springs and friction included, counts against what the stem can take. When
//! that is what was left of the stem, the stem is gone and the rock goes on: the schemes with springs cut their step there,
//! in the rigid limit the impulse ends there. What a stem took in earlier contacts with the same rock is not given back. A stem
//! gives way to one rock alone: the next, also one that shares its world, finds it whole.
//!
//! The limit is an energy (J), drawn for each stem and rock from the scene's distribution: what a
//! trunk takes until it breaks is known from pull and impact tests as an energy, and it needs no
//! model of the trunk's motion.

use super::contact_state::{ContactEnvironment, ContactState};
use super::loss::Loss;
use super::yielding::yielding_impact;
use crate::contact::ContactPoint;
use crate::contact::TOUCH;
use crate::contact::history::ContactHistory;
use crate::rock::Vec3;
use crate::terrain::Terrain;
use crate::terrain::stems::Stems;

/// A stem that has more than this times the motion left (–) cannot give way.
/// The tenth on top is for what weight may add within the contact.
pub(super) const WITHSTANDS: f64 = 1.1;

/// How a stem gives way to a blow in the rigid limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Broken {
    stem: u32,
    /// Velocity (m/s) and spin (rad/s) with which the rock goes on.
    pub(crate) motion: (Vec3, Vec3),
    /// What was left of the stem and is lost (J).
    pub(crate) taken_j: f64,
}

impl ContactState {
    /// Sees whether a stem that is pressed may give way in the next step, and returns the longest step (s) in which it does
    /// not take more than is left of it.
    pub(crate) fn longest_before_yield_s(&mut self, world: &ContactEnvironment) -> f64 {
        let Some(stems) = world.terrain.stems.as_ref() else { return f64::INFINITY };
        self.stem_load.look(world.terrain, stems, &self.histories);
        let motion_j = self.motion_j(&world.body);
        let (mut longest_s, mut may_yield) = (f64::INFINITY, false);
        for &(stem, _) in &self.stem_load.pressed {
            let left_j = self.stem_load.left_j(stems, stem);
            // all of the rock's motion would not break it: no step need be limited
            if left_j <= WITHSTANDS * motion_j {
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
    pub(crate) fn bend(&mut self, world: &ContactEnvironment, loss: &mut Loss) -> bool {
        let Some(stems) = world.terrain.stems.as_ref().filter(|_| loss.trees != 0.0) else {
            return false;
        };
        self.stem_load.look(world.terrain, stems, &self.histories);
        // what broke in the limit of stiff springs has had its energy and is gone: the rest went into what stands
        let standing_j = loss.trees - std::mem::take(&mut self.stem_load.broken_j);
        if standing_j == 0.0 {
            return false;
        }
        let mut gives_way = false;
        for (stem, share) in self.stem_load.pressed.clone() {
            let taken_j = share * standing_j;
            let Some(beyond_j) = self.stem_load.yields(stems, stem, taken_j) else { continue };
            // the push of all contacts with this stem: energy is given back along it
            let of_stem =
                |history: &&ContactHistory| stems.of_triangle(history.triangle) == Some(stem);
            let push =
                |history: &ContactHistory| history.n * history.normal_force.max(f64::MIN_POSITIVE);
            let normal_force: Vec3 = self.histories.iter().filter(of_stem).map(push).sum();
            self.v += given_back(world.body.mass, &self.v, beyond_j, &normal_force);
            loss.trees -= beyond_j;
            self.fell(stems, stem);
            gives_way = true;
        }
        gives_way
    }

    /// How the stem that is struck at `touch` with a velocity and spin gives way, if it cannot take its `share` (–) of the blow.
    ///
    /// Only asked where the motion could break it at all; the impact itself is followed by
    /// `yielding_impact`.
    pub(crate) fn broken_by(
        &self,
        world: &ContactEnvironment,
        (touch, share): (&ContactPoint, f64),
        motion: (&Vec3, &Vec3),
    ) -> Option<Broken> {
        let stems = world.terrain.stems.as_ref()?;
        let stem = stems.of_triangle(touch.triangle)?;
        if self.near.gone.contains(&stem) {
            return None;
        }
        let taken_j = self.stem_load.left_j(stems, stem);
        let body = &world.body;
        let speed2 = body.mass * motion.0.norm_squared() + body.inertia * motion.1.norm_squared();
        let all_j = taken_j / share;
        if all_j > WITHSTANDS * 0.5 * speed2 {
            return None;
        }
        let contact = (world.law(touch.triangle), &touch.normal);
        if share < 1.0 {
            // whether it gives way at all: what is left of it goes into it alone
            yielding_impact(body, contact, motion, all_j)?;
        }
        yielding_impact(body, contact, motion, taken_j).map(|motion| Broken {
            stem,
            motion,
            taken_j,
        })
    }

    /// What share of a blow the stem at `touch` takes of all trees that are struck at once (–): that of the squares of the approaches.
    fn share_of(&self, world: &ContactEnvironment, stems: &Stems, touch: &ContactPoint) -> f64 {
        let (mut own, mut all) = (0.0, 0.0);
        let stem = stems.of_triangle(touch.triangle);
        for other in self.touches.iter() {
            let stands = world.terrain.is_tree(other.triangle)
                && !world.terrain.is_gone(other.triangle, &self.near.gone);
            if stands {
                let approach2 = other.normal.dot(&self.v).min(0.0).powi(2);
                all += approach2;
                own += if stems.of_triangle(other.triangle) == stem { approach2 } else { 0.0 };
            }
        }
        if all > 0.0 { own / all } else { 1.0 }
    }

    /// What is struck at a triangle is pressed: what the blow takes there is its load, also if the rock has left at the end.
    pub(crate) fn press_stem(&mut self, terrain: &Terrain, triangle: u32) {
        let stem = terrain.stems.as_ref().and_then(|stems| stems.of_triangle(triangle));
        if let Some(stem) = stem {
            self.stem_load.press(stem);
        }
    }

    /// A stem is gone within a step whose losses hold what it took.
    pub(crate) fn fell_broken(&mut self, world: &ContactEnvironment, broken: &Broken) {
        self.stem_load.broken_j += broken.taken_j;
        if let Some(stems) = world.terrain.stems.as_ref() {
            self.fell(stems, broken.stem);
        }
    }

    /// Breaks the stems that cannot take the current blow, in the rigid limit; `note` hears of each, with the touch and the
    /// energy it took (J), and whether the rock has just come to it.
    ///
    /// Before the blow itself: a stem that breaks takes its energy, and the rock goes on with what is left.
    pub(crate) fn break_stems(
        &mut self,
        world: &ContactEnvironment,
        mut note: impl FnMut(&Self, &ContactPoint, (f64, bool)),
    ) {
        let Some(stems) = world.terrain.stems.as_ref() else { return };
        let c = self.c;
        self.look(world, &c, world.body.radius * (1.0 + TOUCH));
        let touches = self.touches.clone();
        for touch in touches.iter() {
            let struck = (touch, self.share_of(world, stems, touch));
            let Some(broken) = self.broken_by(world, struck, (&self.v, &self.w)) else { continue };
            let of_stem =
                |history: &ContactHistory| stems.of_triangle(history.triangle) == Some(broken.stem);
            // only the blow that falls next has been announced: a memory alone is of a rock that rolls up to the stem
            let known = |one: &&ContactHistory| one.announced && !one.captured && of_stem(one);
            let is_new = !self.is_struck
                || !self.histories.iter().chain(self.struck.iter()).any(|one| known(&one));
            note(self, touch, (broken.taken_j, is_new));
            (self.v, self.w) = broken.motion;
            self.fell(stems, broken.stem);
        }
        // what stands and throws the rock off is forgotten with the step
        self.stem_load.look(world.terrain, stems, &self.histories);
    }

    /// A stem is gone for this rock, with all that its contacts remember.
    fn fell(&mut self, stems: &Stems, stem: u32) {
        self.near.gone.push(stem);
        self.near.forget();
        self.histories.retain(|history| stems.of_triangle(history.triangle) != Some(stem));
        self.fresh = false;
        self.plane.forget();
        self.stem_load.pressed.clear();
    }
}

/// Change of the velocity `v` (m/s) of a mass (kg) that gives back what the last step took beyond the limit (J), negative for what
/// it left, along the push of the stem.
/// From `m v²/2` along the push: `v₁ = ±√(v² + 2 J/m)`; the part across it is not touched.
pub(super) fn given_back(mass_kg: f64, v: &Vec3, joule: f64, normal_force: &Vec3) -> Vec3 {
    let along =
        normal_force.try_normalize(0.0).or_else(|| v.try_normalize(0.0)).unwrap_or(Vec3::z());
    let speed = along.dot(v);
    let after = (speed * speed + 2.0 * joule / mass_kg).max(0.0).sqrt();
    // a rock that is still on its way in, as nearly always, goes against the push
    let after = if speed > 0.0 { after } else { -after };
    along * (after - speed)
}

//! Impacts within a step, in the order of their times.
//!
//! Rocks that came in faster than the capture speed overlap at the end of a step. When they touched is known: under the
//! same gravity two rocks move in straight lines relative to each other, and one rock over the mesh in a parabola. Each
//! blow is taken at that time, the earliest first, by itself or with all that touch ([`collision`](super::collision)), and the rocks go on from there with what they got; blows
//! that follow from it are found with the new paths. A blow between two rocks alone is therefore exact, whatever the
//! step, and each takes energy.

use super::RigidIsland;
use super::blow_start::BlowStart;
use super::contacts::{BallContact, ImpactScene, LIVELY, OnMesh, StepBody, hit_of};
use super::expected::NEAR;
use super::sweeps::FEW;
use crate::contact::ContactPoint;
use crate::contact::pair::{PairHistory, between};
use crate::rock::Vec3;
use crate::solver::body::Twist;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::impact::frozen_impact;
use crate::solver::island::outcome::BlowInStep;
use crate::solver::loss::{Given, Loss};
use crate::solver::rigid::{HELD, IMPACT, frozen, is_fast};
use crate::solver::roughness::Meeting;
use nalgebra::Rotation3;
use std::cmp::Reverse;

/// Blows on one rock in one step after which the rest is left to the next step.
const MOST: u32 = 400;

/// Local error of a blow in an island of more than [`FEW`] rocks, followed in its own time (–, relative to its speed): a thirtieth
/// of what sustained contact may leave there of a rock's speed. It is an error of the impulses of friction alone: the rebound
/// is exact, momenta are kept, and no blow gives energy.
const IMPACT_OF_MANY: f64 = 1e-3;

/// A blow that is due: time before the end of the step (s, as the bits of a positive number: they keep the order), the
/// place of its contact, the counts of its rocks.
pub(super) type PendingImpact = (u64, Reverse<usize>, [u32; 2]);

impl ImpactScene<'_> {
    /// The rocks of a contact: pairs come first, then every rock with the mesh.
    fn ends_of(&self, place: usize) -> [usize; 2] {
        self.pair_histories
            .get(place)
            .map_or([place.saturating_sub(self.pair_histories.len()); 2], |pair_history| {
                [pair_history.a as usize, pair_history.b as usize]
            })
    }
}

impl RigidIsland {
    /// Takes all impacts of a step of length `dt` (s); whether none is left.
    pub(super) fn strike(&mut self, scene: &mut ImpactScene, dt: f64) -> bool {
        self.due.clear();
        for ball in &mut self.balls {
            (ball.since_s, ball.blows) = (dt, 0);
        }
        for k in 0..scene.pair_histories.len() {
            self.expect_pair(scene, k);
        }
        for k in 0..self.balls.len() {
            self.expect_ground(scene, k);
        }
        if self.due.is_empty() {
            return true;
        }
        self.lay_links(scene.pair_histories);
        let mut all = true;
        while let Some((bits, Reverse(place), counts)) = self.due.pop() {
            let ends = scene.ends_of(place);
            if ends.map(|k| self.balls[k].times) != counts {
                continue;
            }
            if ends.iter().any(|&k| self.balls[k].blows >= MOST) {
                all = false;
                continue;
            }
            self.blow(scene, place, f64::from_bits(bits));
            self.expect_more(scene);
        }
        for k in 0..self.balls.len() {
            self.settle_on(scene, k);
        }
        all
    }

    /// The pairs of every rock.
    fn lay_links(&mut self, pair_histories: &[PairHistory]) {
        let ends: Vec<[usize; 2]> = pair_histories
            .iter()
            .map(|pair_history| [pair_history.a as usize, pair_history.b as usize])
            .collect();
        self.of_rocks.lay(&ends, self.balls.len());
    }

    /// Looks for the blows that follow from the last one.
    fn expect_more(&mut self, scene: &mut ImpactScene) {
        for k in 0..self.in_blow.len() {
            let rock = self.in_blow[k];
            for place in self.of_rocks.places(rock) {
                self.expect_pair(scene, self.of_rocks.at(place));
            }
            self.expect_ground(scene, rock);
        }
    }

    /// Takes the blow of a contact, `s` (s) before the end of the step.
    fn blow(&mut self, scene: &mut ImpactScene, place: usize, s: f64) {
        self.in_blow.clear();
        self.in_blow.extend(scene.ends_of(place));
        self.in_blow.dedup();
        let (known, noted) = (self.hits.len(), self.blows_in_step.len());
        for k in 0..self.in_blow.len() {
            self.begin_blow(self.in_blow[k], s);
        }
        if place < scene.pair_histories.len() {
            self.blow_pair(scene, place, s);
        } else {
            self.blow_ground(scene, place - scene.pair_histories.len(), s);
        }
        for blow in &mut self.blows_in_step[noted..] {
            blow.motions[1] = self.balls[blow.rock].motion_before_end(s);
            blow.hits = self.hits[known..].iter().filter(|hit| hit.rock == blow.rock).count();
        }
    }

    /// Notes how a rock moves that a blow strikes `s` (s) before the end of the step.
    pub(super) fn begin_blow(&mut self, rock: usize, s: f64) {
        let motions = [self.balls[rock].motion_before_end(s); 2];
        self.blows_in_step.push(BlowInStep { rock, motions, hits: 0 });
    }

    /// Local error of a blow (–).
    pub(super) fn impact_tolerance(&self) -> f64 {
        if self.balls.len() <= FEW { IMPACT } else { IMPACT_OF_MANY }
    }

    fn blow_pair(&mut self, scene: &mut ImpactScene, place: usize, s: f64) {
        let pair_history = &scene.pair_histories[place];
        let ends = [pair_history.a as usize, pair_history.b as usize];
        let [a, b] = ends.map(|k| &self.balls[k]);
        let ((at, v), (other, w)) = (a.before_end(s), b.before_end(s));
        let approach_m_s = -between(&at, &other).0.dot(&(v - w));
        let lasts_s = BlowStart::lasting_s(&pair_history.law);
        let blow =
            BlowStart { pair: Some(place), turn: None, touches_m: 0.0, approach_m_s, lasts_s };
        if self.blow_together(scene, &blow, s) {
            return;
        }
        let tolerance = self.impact_tolerance();
        let pair_history = &scene.pair_histories[place];
        let Ok([a, b]) = self.balls.get_disjoint_mut(ends) else { return };
        let at = [&*a, &*b].map(|ball| ball.c - ball.v * s);
        let mut ball_contact = BallContact::new((place, pair_history), [a, b], [&at[0], &at[1]]);
        let law = pair_history.law.without_rolling();
        let before = [(a.v, a.w), (b.v, b.w)];
        ball_contact.impact(
            (&law, self.blows.as_deref(), tolerance),
            [a, b],
            a.blows.max(b.blows) >= LIVELY,
        );
        let mut given = [0.0; 2];
        for (k, ball) in [a, b].into_iter().enumerate() {
            let load = ball_contact.load(k);
            ball.take_late(&load, s);
            let (v, w) = mean_late(ball, &before[k], s);
            given[k] = -StepBody::work_j(&load, &v, &w);
            ball.is_struck(s);
        }
        for (end, given) in ends.into_iter().zip(Given::of_ends(given)) {
            self.given[end].add(&given, 1.0);
        }
        self.struck[place] = true;
    }

    fn blow_ground(&mut self, scene: &mut ImpactScene, k: usize, s: f64) {
        let ball = &mut self.balls[k];
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        let (at, v) = ball.before_end(s);
        let reach = world.body.radius * (1.0 + NEAR);
        state.look(&world, &at, reach);
        // a rock that the mesh holds is not on the parabola on which it is looked for
        if state.touches.iter().all(|touch| touch.normal.dot(&v) >= 0.0) {
            state.look(&world, &ball.c, reach);
        }
        let hit = state
            .touches
            .iter()
            .min_by(|a, b| a.normal.dot(&v).total_cmp(&b.normal.dot(&v)))
            .copied();
        let Some(touch) = hit else { return ball.is_struck(s) };
        // how near something is at that instant is known as well as the parabola is the way of the rock
        let touches_m = touch.distance_m.max(world.body.radius);
        state.touches.keep_nearer(touches_m + HELD * world.body.radius);
        if let Some(broken) = state.broken_by(&world, (&v, &ball.w)) {
            let (after, spin) = broken.motion;
            ball.v += after - v;
            ball.c += (after - v) * s;
            ball.w = spin;
            for (touch, loss) in &broken.struck {
                self.losses[k].add(loss, 1.0);
                let approach_m_s = -touch.normal.dot(&v);
                if is_fast(&world, touch, &v) {
                    self.hits.push(hit_of(k, touch, (&at, world.body.radius), approach_m_s));
                }
            }
            state.fell_broken(&world, &broken);
            return ball.is_struck(s);
        }
        let lasts_s = BlowStart::lasting_s(world.law(touch.triangle));
        let meeting = Meeting { n: touch.normal, triangle: touch.triangle, c: at, v };
        let turn = state.facets.struck(&world, &meeting);
        let approach_m_s = -touch.normal.dot(&v);
        let found = state.touches.clone();
        let blow = BlowStart { pair: None, turn, touches_m, approach_m_s, lasts_s };
        if !self.blow_together(scene, &blow, s) {
            scene.members[k].state.touches = found;
            self.rebound(scene, (k, &touch), (&at, &v), (turn, s));
        }
    }

    /// Throws rock `k`, which comes alone to `touch` with its centre at `at` and a velocity `v` (m/s), off all that it touches.
    fn rebound(
        &mut self,
        scene: &mut ImpactScene,
        (k, touch): (usize, &ContactPoint),
        (at, v): (&Vec3, &Vec3),
        (turn, s): (Option<Rotation3<f64>>, f64),
    ) {
        let tolerance = self.impact_tolerance();
        let ball = &mut self.balls[k];
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        let ContactState { touches, stem_load, .. } = state;
        let how = (ball.blows >= LIVELY, tolerance);
        let mut note = |other: &ContactPoint, loss: &Loss, approach_m_s: Option<f64>| {
            stem_load.book((&world, other.triangle), loss, &mut self.losses[k]);
            let hit = |approach_m_s| hit_of(k, other, (at, world.body.radius), approach_m_s);
            self.hits.extend(approach_m_s.map(hit));
        };
        let motion = (v, &ball.w);
        let after = throw_off((&world, touches), (touch, turn), motion, how, &mut note);
        let load = ((after.0 - v) * world.body.mass, (after.1 - ball.w) * world.body.inertia);
        ball.take_late(&load, s);
        ball.is_struck(s);
    }
}

impl RigidIsland {
    /// Holds a rock that has come to the mesh within the step slower than it rebounds, and has fallen on into it since: what a step more would
    /// take for a blow is no more than its weight has done on the rest of this one.
    fn settle_on(&mut self, scene: &mut ImpactScene, k: usize) {
        let tolerance = self.impact_tolerance();
        let ball = &mut self.balls[k];
        if ball.on_mesh != OnMesh::Settles {
            return;
        }
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        state.look(&world, &ball.c, world.body.radius * (1.0 + HELD));
        let ContactState { touches, stem_load, .. } = state;
        let comes = |touch: &&ContactPoint| is_fast(&world, touch, &ball.v);
        let Some(touch) = touches.iter().find(comes).copied() else { return };
        let mut note = |other: &ContactPoint, loss: &Loss, _: Option<f64>| {
            stem_load.book((&world, other.triangle), loss, &mut self.losses[k]);
        };
        let motion = (&ball.v, &ball.w);
        (ball.v, ball.w) =
            throw_off((&world, touches), (&touch, None), motion, (true, tolerance), &mut note);
        ball.pushed = true;
    }
}

/// Velocity and spin after the impact of a rock on all that it touches at the instant at which it comes to `touch`; as a rock alone it
/// is turned against a facet, and back. Gives nothing back if it is `dead`. Notes of every contact what it took, and of those struck
/// the approach (m/s).
fn throw_off(
    (world, touches): (&ContactEnvironment, &[ContactPoint]),
    (touch, turn): (&ContactPoint, Option<Rotation3<f64>>),
    (v, w): (&Vec3, &Vec3),
    (dead, tolerance): (bool, f64),
    note: &mut impl FnMut(&ContactPoint, &Loss, Option<f64>),
) -> Twist {
    let turn = turn.unwrap_or_else(Rotation3::identity);
    let [met, spin] = [v, w].map(|x| turn.inverse() * x);
    let mut struck = frozen(world, touches, &met);
    for contact in &mut struck {
        contact.captured |= dead;
    }
    let thrown = frozen_impact(&world.body, &struck, (&met, &spin), tolerance);
    for (loss, other) in thrown.loss.iter().zip(touches) {
        let is_struck = other.feature == touch.feature || is_fast(world, other, &met);
        let approach_m_s = is_struck.then(|| -other.normal.dot(&met));
        note(other, loss, approach_m_s);
    }
    (turn * thrown.velocity_m_s, turn * thrown.spin_rad_s)
}

/// Mean motion in a blow that fell `s` (s) before the end of the step, from the motions there without and with it.
fn mean_late(ball: &StepBody, before: &(Vec3, Vec3), s: f64) -> (Vec3, Vec3) {
    ((before.0 + ball.v) * 0.5 - ball.body.gravity * s, (before.1 + ball.w) * 0.5)
}

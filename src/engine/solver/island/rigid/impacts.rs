//! Impacts within a step, in the order of their times.
//!
//! Rocks that approach faster than the capture speed overlap at the end of a step. The time of their first contact is
//! known in closed form: under the same gravity two rocks move in straight lines relative to each other, and a rock
//! over the mesh on a parabola. Impacts are resolved in the order of these times, each by itself or together with all
//! rocks in contact ([`collision`](super::collision)). The rocks then continue with their new velocities, and the
//! impacts that follow are predicted on the new paths. An impact between two rocks alone is therefore exact whatever
//! the step, and no impact adds energy.

use super::RigidIsland;
use super::blow_start::BlowStart;
use super::contacts::{BallContact, ImpactScene, OnMesh, REBOUNDS_IN_STEP, StepBody, hit_of};
use super::expected::NEAR;
use super::sweeps::FEW;
use crate::contact::ContactPoint;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::rock::Vec3;
use crate::solver::body::Twist;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::impact::frozen_impact;
use crate::solver::island::outcome::BlowInStep;
use crate::solver::loss::{EnergyGiven, Loss};
use crate::solver::rigid::{HELD, IMPACT, STRUCK_TOGETHER, frozen, is_fast};
use crate::solver::roughness::SurfaceApproach;
use nalgebra::Rotation3;
use std::cmp::Reverse;

/// Impacts of one rock in one step, at most; further ones are left to the next step.
const MOST: u32 = 400;

/// Local error of an impact in an island of more than [`FEW`] rocks, integrated in its own time (–, relative to its speed): a
/// thirtieth of the error that sustained contact may leave there of a rock's speed. It is an error of the friction impulses
/// alone: the rebound is exact, momenta are conserved, and no impact adds energy.
const IMPACT_OF_MANY: f64 = 1e-3;

/// A predicted impact: time before the end of the step (s, as the bits of a positive number, which keep the order), the
/// place of its contact, the versions of the motions of its rocks.
pub(super) type PendingImpact = (u64, Reverse<usize>, [u32; 2]);

impl ImpactScene<'_> {
    /// The rocks of a contact. Places: first all pairs, then every rock with the mesh.
    fn ends_of(&self, place: usize) -> [usize; 2] {
        self.pair_histories
            .get(place)
            .map_or([place.saturating_sub(self.pair_histories.len()); 2], |pair_history| {
                [pair_history.a as usize, pair_history.b as usize]
            })
    }
}

impl RigidIsland {
    /// Resolves all impacts of a step of length `dt` (s); whether none is left.
    pub(super) fn resolve_impacts(&mut self, scene: &mut ImpactScene, dt: f64) -> bool {
        self.pending.clear();
        for ball in &mut self.balls {
            (ball.since_s, ball.impacts) = (dt, 0);
        }
        for k in 0..scene.pair_histories.len() {
            self.predict_pair_impact(scene, k);
        }
        for k in 0..self.balls.len() {
            self.predict_ground_impact(scene, k);
        }
        if self.pending.is_empty() {
            return true;
        }
        self.index_pairs(scene.pair_histories);
        let mut all = true;
        while let Some((bits, Reverse(place), counts)) = self.pending.pop() {
            let ends = scene.ends_of(place);
            if ends.map(|k| self.balls[k].version) != counts {
                continue;
            }
            if ends.iter().any(|&k| self.balls[k].impacts >= MOST) {
                all = false;
                continue;
            }
            self.blow(scene, place, f64::from_bits(bits));
            self.predict_following_impacts(scene);
        }
        for k in 0..self.balls.len() {
            self.capture_on_mesh(scene, k);
        }
        all
    }

    /// Indexes the pairs by rock.
    fn index_pairs(&mut self, pair_histories: &[PairHistory]) {
        let ends: Vec<[usize; 2]> = pair_histories
            .iter()
            .map(|pair_history| [pair_history.a as usize, pair_history.b as usize])
            .collect();
        self.of_rocks.index(&ends, self.balls.len());
    }

    /// Predicts the impacts that follow from the last one.
    fn predict_following_impacts(&mut self, scene: &mut ImpactScene) {
        for k in 0..self.in_blow.len() {
            let rock = self.in_blow[k];
            for place in self.of_rocks.places(rock) {
                self.predict_pair_impact(scene, self.of_rocks.at(place));
            }
            self.predict_ground_impact(scene, rock);
        }
    }

    /// Resolves the impact at a contact, `s` (s) before the end of the step.
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

    /// Records the motion of a rock before an impact, `s` (s) before the end of the step.
    pub(super) fn begin_blow(&mut self, rock: usize, s: f64) {
        let motions = [self.balls[rock].motion_before_end(s); 2];
        self.blows_in_step.push(BlowInStep { rock, motions, hits: 0 });
    }

    /// Local error of an impact (–).
    pub(super) fn impact_tolerance(&self) -> f64 {
        if self.balls.len() <= FEW { IMPACT } else { IMPACT_OF_MANY }
    }

    fn blow_pair(&mut self, scene: &mut ImpactScene, place: usize, s: f64) {
        let pair_history = &scene.pair_histories[place];
        let ends = [pair_history.a as usize, pair_history.b as usize];
        let [a, b] = ends.map(|k| &self.balls[k]);
        let ((at, v), (other, w)) = (a.before_end(s), b.before_end(s));
        let approach_m_s = -normal_and_distance(&at, &other).0.dot(&(v - w));
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
            a.impacts.max(b.impacts) >= REBOUNDS_IN_STEP,
        );
        let mut given = [0.0; 2];
        for (k, ball) in [a, b].into_iter().enumerate() {
            let load = ball_contact.load(k);
            ball.apply_impulse_earlier(&load, s);
            let (v, w) = mean_motion_earlier(ball, &before[k], s);
            given[k] = -StepBody::work_j(&load, &v, &w);
            ball.note_impact(s);
        }
        for (end, given) in ends.into_iter().zip(EnergyGiven::of_ends(given)) {
            self.given[end].add(&given, 1.0);
        }
        self.struck[place] = true;
    }

    fn blow_ground(&mut self, scene: &mut ImpactScene, k: usize, s: f64) {
        let ball = &mut self.balls[k];
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        let (at, v) = ball.before_end(s);
        let reach = world.body.radius * (1.0 + NEAR);
        state.find_contact_points(&world, &at, reach);
        // a rock in sustained contact is not on the parabola of the prediction
        if state.touches.iter().all(|touch| touch.normal.dot(&v) >= 0.0) {
            state.find_contact_points(&world, &ball.c, reach);
        }
        let hit = state
            .touches
            .iter()
            .min_by(|a, b| a.normal.dot(&v).total_cmp(&b.normal.dot(&v)))
            .copied();
        let Some(touch) = hit else { return ball.note_impact(s) };
        // distances at that instant are known as well as the parabola is the rock's path
        let touches_m = touch.distance_m.max(world.body.radius);
        state.touches.retain_nearer(touches_m + HELD * world.body.radius);
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
            state.remove_broken_stems(&world, &broken);
            return ball.note_impact(s);
        }
        let lasts_s = BlowStart::lasting_s(world.law(touch.triangle));
        let meeting = SurfaceApproach { n: touch.normal, triangle: touch.triangle, c: at, v };
        let turn = state.facets.draw_facet(&world, &meeting);
        let approach_m_s = -touch.normal.dot(&v);
        let mut found = state.touches.clone();
        let blow = BlowStart { pair: None, turn, touches_m, approach_m_s, lasts_s };
        if !self.blow_together(scene, &blow, s) {
            // as of a rock alone: a flank near by that neither holds it nor is approached takes no part
            let member = &mut *scene.members[k];
            let radius = member.body.radius;
            found.retain(|touch| {
                let takes_part = member.is_held_on(touch.feature) || touch.normal.dot(&v) < 0.0;
                let room = if takes_part { HELD } else { STRUCK_TOGETHER };
                touch.distance_m <= touches_m + room * radius
            });
            member.state.touches = found;
            self.rebound(scene, (k, &touch), (&at, &v), (turn, s));
        }
    }

    /// Rebound of rock `k`, which comes alone to `touch` with its centre at `at` and a velocity `v` (m/s), from all that it
    /// touches.
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
        let how = (ball.impacts >= REBOUNDS_IN_STEP, tolerance);
        let mut note = |other: &ContactPoint, loss: &Loss, approach_m_s: Option<f64>| {
            stem_load.book((&world, other.triangle), loss, &mut self.losses[k]);
            let hit = |approach_m_s| hit_of(k, other, (at, world.body.radius), approach_m_s);
            self.hits.extend(approach_m_s.map(hit));
        };
        let motion = (v, &ball.w);
        let after = rebound_from((&world, touches), (touch, turn), motion, how, &mut note);
        let load = ((after.0 - v) * world.body.mass, (after.1 - ball.w) * world.body.inertia);
        ball.apply_impulse_earlier(&load, s);
        ball.note_impact(s);
    }
}

impl RigidIsland {
    /// Stops a rock that has come to the mesh within the step too slowly to rebound, and has sunk in since. Its approach at
    /// the end of the step is what weight has added on the rest of it; the next step would take it for an impact.
    fn capture_on_mesh(&mut self, scene: &mut ImpactScene, k: usize) {
        let tolerance = self.impact_tolerance();
        let ball = &mut self.balls[k];
        if ball.on_mesh != OnMesh::Captured {
            return;
        }
        let (world, state) = scene.members[k].with_environment(scene.terrain);
        state.find_contact_points(&world, &ball.c, world.body.radius * (1.0 + HELD));
        let ContactState { touches, stem_load, .. } = state;
        let comes = |touch: &&ContactPoint| is_fast(&world, touch, &ball.v);
        let Some(touch) = touches.iter().find(comes).copied() else { return };
        let mut note = |other: &ContactPoint, loss: &Loss, _: Option<f64>| {
            stem_load.book((&world, other.triangle), loss, &mut self.losses[k]);
        };
        let motion = (&ball.v, &ball.w);
        (ball.v, ball.w) =
            rebound_from((&world, touches), (&touch, None), motion, (true, tolerance), &mut note);
        ball.pushed = true;
    }
}

/// Velocity and spin after the impact of a rock on all that it touches at the instant at which it comes to `touch`. On a
/// facet of rough ground the motion is turned into the facet's frame and back, as for a rock alone. Without restitution
/// if `dead`. Reports the loss at every contact, and the approach (m/s) at those that are struck.
fn rebound_from(
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

/// Mean motion in an impact `s` (s) before the end of the step, from the motions at the end without and with it.
fn mean_motion_earlier(ball: &StepBody, before: &(Vec3, Vec3), s: f64) -> (Vec3, Vec3) {
    ((before.0 + ball.v) * 0.5 - ball.body.gravity * s, (before.1 + ball.w) * 0.5)
}

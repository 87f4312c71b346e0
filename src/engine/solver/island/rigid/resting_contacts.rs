//! Sustained contact: impulses of all contacts of an island over one step, at velocity level.
//!
//! Projected Gauss–Seidel over normal impulse, friction and rolling friction with a warm start (Moreau, Jean). Positions
//! move with the mean of the velocities at both ends of the step, so that a resting contact stays in place and the parabola
//! is exact. A normal impulse never adds energy: it returns at the end of a step at most what it took at its start.
//!
//! Why velocities and not positions: the force of a spring would need steps of `0.3/ω`; an impulse over a step only
//! requires that a contact does not approach at its end. Steps are then as long as the paths of the rocks allow, 0.2 R.

use super::RigidIsland;
use super::contacts::{BallContact, OnMesh, StepBody};
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::rock::Vec3;
use crate::solver::contact_state::ContactEnvironment;
use crate::solver::island::body::BodySlot;
use crate::solver::law::capture_m_s;
use crate::solver::loss::EnergyGiven;
use crate::solver::rigid::{GroundContact, converge, sustained_m_s};
use crate::terrain::Terrain;

/// Whether a contact with this gap (m) and normal speed (m/s) at the start of a step of length `dt` (s) is a sustained
/// one: neither opening nor closing faster than the capture speed, which would be an impact and is found at the end of
/// the step. A gap that the capture speed could close within the step counts as a contact: weight would close it into an
/// overlap.
fn is_sustained((gap, speed): (f64, f64), capture: f64, dt: f64) -> bool {
    let fall = gap.max(0.0);
    speed * speed < capture * capture && fall <= dt * capture
}

impl RigidIsland {
    /// Moves the rocks through the step without its impacts; whether the impulses converged.
    ///
    /// Contacts, weight, warm start, sweeps, positions: the order of Moreau's time stepping.
    pub(super) fn solve_resting_contacts(
        &mut self,
        terrain: &Terrain,
        (members, pair_histories): (&mut [BodySlot], &[PairHistory]),
        dt: f64,
    ) -> bool {
        self.find_ground_contacts(terrain, members, dt);
        self.find_ball_contacts(pair_histories, dt);
        for ball in &mut self.balls {
            ball.v += ball.body.gravity * dt;
        }
        self.clear_warm_start_of_single_rocks();
        self.warm_start();
        self.converge_single_rocks();
        let settled = self.converge((members, pair_histories), dt);
        self.integrate_positions(terrain, members, dt);
        settled
    }

    /// Finds the contacts with the mesh in the middle of the step, so that sliding over curved ground is right to second
    /// order.
    fn find_ground_contacts(&mut self, terrain: &Terrain, members: &mut [BodySlot], dt: f64) {
        self.ground_contacts.clear();
        for (k, (member, ball)) in members.iter_mut().zip(&self.balls).enumerate() {
            let member = &mut **member;
            let world = ContactEnvironment { terrain, body: member.body, laws: &member.laws };
            let middle = ball.c + ball.v * (0.5 * dt);
            member.state.find_contact_points_ahead(&world, &middle);
            for touch in member.state.touches.iter() {
                let law = world.law(touch.triangle);
                let (speed, capture) = (touch.normal.dot(&ball.v), capture_m_s(law));
                let gap = touch.distance_m - ball.body.radius;
                let start = (gap - 0.5 * dt * speed, speed);
                // a flight that passes an edge or corner sideways: the normal turns, no sustained contact
                let passes = member.flying && !touch.is_on_plane();
                if passes || !is_sustained(start, capture, dt) {
                    continue;
                }
                let mut ground_contact = GroundContact::new(k, touch, law);
                ground_contact.target_m_s = sustained_m_s(gap, speed, dt);
                let kept = member.last_forces.iter().find(|kept| kept.0 == touch.feature);
                if let Some((_, normal_force, shear_force, turn)) = kept {
                    // impulses of the last step in the present tangent plane: this warm start saves
                    // most sweeps of a heap at rest
                    let along = shear_force - touch.normal * touch.normal.dot(shear_force);
                    (
                        ground_contact.normal_impulse,
                        ground_contact.shear_impulse,
                        ground_contact.rolling_impulse,
                    ) = (normal_force * dt, along * dt, turn * dt);
                }
                self.ground_contacts.push(ground_contact);
            }
        }
    }

    /// Finds the contacts of rocks with each other in the middle of the step, in the order of the pairs, so that sweeps are
    /// reproducible.
    fn find_ball_contacts(&mut self, pair_histories: &[PairHistory], dt: f64) {
        self.ball_contacts.clear();
        for (k, pair_history) in pair_histories.iter().enumerate() {
            let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.balls[k as usize]);
            let at = [a, b].map(|ball| ball.c + ball.v * (0.5 * dt));
            let capture = capture_m_s(&pair_history.law);
            // a wider gap cannot be a sustained contact: the whole of it closes, half of it opens before the middle
            let widest = a.body.radius + b.body.radius + 2.0 * dt * capture;
            if (at[0] - at[1]).norm_squared() > widest * widest {
                continue;
            }
            let (n, distance) = normal_and_distance(&at[0], &at[1]);
            let gap = distance - a.body.radius - b.body.radius;
            let speed = n.dot(&(a.v - b.v));
            let start = (gap - 0.5 * dt * speed, speed);
            if !is_sustained(start, capture, dt) {
                continue;
            }
            let mut ball_contact = BallContact::new((k, pair_history), [a, b], [&at[0], &at[1]]);
            ball_contact.target_m_s = sustained_m_s(gap, speed, dt);
            (ball_contact.normal_impulse, ball_contact.shear_impulse) = (
                pair_history.normal_force * dt,
                (pair_history.shear_force - n * n.dot(&pair_history.shear_force)) * dt,
            );
            self.ball_contacts.push(ball_contact);
        }
    }

    /// Drops the warm start of rocks that only the mesh touches. Between several faces friction may carry a part of the
    /// normal load; with a warm start that part would persist from step to step, and the faces would press less.
    fn clear_warm_start_of_single_rocks(&mut self) {
        for ball_contact in &self.ball_contacts {
            ball_contact.ends.into_iter().for_each(|k| self.balls[k].has_neighbour = true);
        }
        for ground_contact in &mut self.ground_contacts {
            if !self.balls[ground_contact.rock].has_neighbour {
                ground_contact.clear_impulses();
            }
        }
    }

    /// Solves the contacts of rocks that only the mesh touches, as those of a rock alone.
    fn converge_single_rocks(&mut self) {
        let of_rocks = self.ground_contacts.chunk_by_mut(|one, other| one.rock == other.rock);
        for contacts in of_rocks.filter(|contacts| contacts.len() > 1) {
            let ball = &mut self.balls[contacts[0].rock];
            if ball.has_neighbour {
                continue;
            }
            let motion = (ball.v, ball.w);
            (ball.v, ball.w) = converge(contacts, &ball.body, motion, &mut self.sweeps);
        }
    }

    /// Applies the impulses of the step before.
    pub(super) fn warm_start(&mut self) {
        for ground_contact in &self.ground_contacts {
            let ball = &mut self.balls[ground_contact.rock];
            let load = ground_contact.load(&ball.body);
            ball.apply_impulse(&load);
        }
        for ball_contact in
            self.ball_contacts.iter().filter(|ball_contact| ball_contact.normal_impulse > 0.0)
        {
            for k in 0..2 {
                self.balls[ball_contact.ends[k]].apply_impulse(&ball_contact.load(k));
            }
        }
    }

    /// Moves the rocks with their mean velocities and books the work of the impulses.
    ///
    /// Positions move with `(v₀ + v₁)/2`, and impulses work at this velocity: energy balances to rounding.
    fn integrate_positions(&mut self, terrain: &Terrain, members: &mut [BodySlot], dt: f64) {
        let mean = |ball: &StepBody| -> (Vec3, Vec3) {
            ((ball.v + ball.before.0) * 0.5, (ball.w + ball.before.1) * 0.5)
        };
        self.taken_j = 0.0;
        for ground_contact in
            self.ground_contacts.iter().filter(|ground_contact| ground_contact.normal_impulse > 0.0)
        {
            let ball = &self.balls[ground_contact.rock];
            let (world, state) = members[ground_contact.rock].with_environment(terrain);
            // the work of an impulse is that at the mean velocity, exactly
            let motion = mean(ball);
            let loss = ground_contact.loss(&world.body, &motion);
            let losses = &mut self.losses[ground_contact.rock];
            state.stem_load.book((&world, ground_contact.triangle), &loss, losses);
            self.taken_j -= ground_contact.normal_impulse * ground_contact.n().dot(&motion.0);
        }
        for ball_contact in
            self.ball_contacts.iter().filter(|ball_contact| ball_contact.normal_impulse > 0.0)
        {
            let [a, b] = ball_contact.ends.map(|k| mean(&self.balls[k]).0);
            self.taken_j -= ball_contact.normal_impulse * ball_contact.n.dot(&(a - b));
            let given = [0, 1].map(|k| {
                let (v, w) = mean(&self.balls[ball_contact.ends[k]]);
                -StepBody::work_j(&ball_contact.load(k), &v, &w)
            });
            for (end, given) in ball_contact.ends.into_iter().zip(EnergyGiven::of_ends(given)) {
                self.given[end].add(&given, 1.0);
            }
        }
        for ball_contact in
            self.ball_contacts.iter().filter(|ball_contact| ball_contact.normal_impulse > 0.0)
        {
            ball_contact.ends.into_iter().for_each(|k| self.balls[k].pushed = true);
        }
        for ground_contact in
            self.ground_contacts.iter().filter(|ground_contact| ground_contact.normal_impulse > 0.0)
        {
            let ball = &mut self.balls[ground_contact.rock];
            (ball.pushed, ball.on_mesh) = (true, OnMesh::Held);
        }
        for ball in &mut self.balls {
            ball.c += mean(ball).0 * dt;
        }
    }
}

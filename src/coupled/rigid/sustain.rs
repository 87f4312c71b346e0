//! Sustained contact: impulses of all contacts of an island over one step, at velocity level.
//!
//! Projected Gauss–Seidel over normal impulse, friction and rolling friction with a warm start (Moreau, Jean). Velocity
//! is stepped from its start to its end and acts with its mean, so that a resting contact stays where it is and the
//! parabola is exact; a normal impulse never works on the rocks: what it may give back at the end of a step is at most
//! what it took at its start.

use super::Pile;
use super::ball::{Ball, Foot, Knot};
use crate::contact::pair::{Tie, between};
use crate::coupled::cluster::Given;
use crate::coupled::member::Seat;
use crate::rock::Vec3;
use crate::step::grip::World;
use crate::step::rigid::capture_m_s;
use crate::terrain::Terrain;

/// Whether a contact with this gap (m) and normal speed (m/s) at the start of a step of length `dt` (s) is a sustained
/// one: not if it is left or closed faster than the capture speed. That is an impact, and found at the end of the step. A
/// gap that the capture speed closes within the step may close and no more: left alone, it would close under weight into
/// an overlap.
fn is_sustained((gap, speed): (f64, f64), capture: f64, dt: f64) -> bool {
    let fall = gap.max(0.0);
    speed * speed < capture * capture && fall <= dt * capture
}

/// Normal speed wanted at the end of a step of length `dt` (s) from the gap in its middle and the speed at its start: an
/// open gap may close, and over an edge half of the turn is before the middle and half after it. A push never works.
fn target(gap: f64, speed: f64, dt: f64) -> f64 {
    -(gap / dt).max(speed).max(0.0)
}

impl Pile {
    /// Takes the rocks through the step without its impacts; whether the impulses settled.
    pub(super) fn sustain(
        &mut self,
        terrain: &Terrain,
        (members, ties): (&mut [Seat], &[Tie]),
        dt: f64,
    ) -> bool {
        self.stand(terrain, members, dt);
        self.link(ties, dt);
        for ball in &mut self.balls {
            ball.v += ball.body.gravity * dt;
        }
        self.start_warm();
        let settled = self.settle((members, ties), dt);
        self.go_on(terrain, members, dt);
        settled
    }

    /// Contacts with the mesh in the middle of the step.
    fn stand(&mut self, terrain: &Terrain, members: &mut [Seat], dt: f64) {
        self.feet.clear();
        for (k, (member, ball)) in members.iter_mut().zip(&self.balls).enumerate() {
            let member = &mut **member;
            let world = World { terrain, body: member.body, laws: &member.laws };
            let middle = ball.c + ball.v * (0.5 * dt);
            member.grip.look_ahead(&world, &middle);
            for touch in member.grip.touches.iter() {
                let law = world.law(touch.triangle);
                let (speed, capture) = (touch.normal.dot(&ball.v), capture_m_s(law));
                let gap = touch.distance_m - ball.body.radius;
                let start = (gap - 0.5 * dt * speed, speed);
                if !is_sustained(start, capture, dt) {
                    continue;
                }
                let place = (touch.feature, touch.triangle);
                let mut foot = Foot::new(k, place, touch.normal, law);
                foot.target = target(gap, speed, dt);
                let kept = member.kept.iter().find(|kept| kept.0 == touch.feature);
                if let Some((_, push, drag, turn)) = kept {
                    let along = drag - foot.n * foot.n.dot(drag);
                    (foot.push, foot.drag, foot.turn) = (push * dt, along * dt, turn * dt);
                }
                self.feet.push(foot);
            }
        }
    }

    /// Contacts of rocks with each other in the middle of the step.
    fn link(&mut self, ties: &[Tie], dt: f64) {
        self.knots.clear();
        for (k, tie) in ties.iter().enumerate() {
            let [a, b] = [tie.a, tie.b].map(|k| &self.balls[k as usize]);
            let at = [a, b].map(|ball| ball.c + ball.v * (0.5 * dt));
            let (n, distance) = between(&at[0], &at[1]);
            let gap = distance - a.body.radius - b.body.radius;
            let (speed, capture) = (n.dot(&(a.v - b.v)), capture_m_s(&tie.law));
            let start = (gap - 0.5 * dt * speed, speed);
            if !is_sustained(start, capture, dt) {
                continue;
            }
            let mut knot = Knot::new((k, tie), [a, b], [&at[0], &at[1]]);
            knot.target = target(gap, speed, dt);
            (knot.push, knot.drag) = (tie.push * dt, (tie.drag - n * n.dot(&tie.drag)) * dt);
            self.knots.push(knot);
        }
    }

    /// Acts with the impulses of the step before.
    pub(super) fn start_warm(&mut self) {
        for foot in &self.feet {
            let ball = &mut self.balls[foot.ball];
            let load = foot.load(&ball.body);
            ball.take(&load);
        }
        for knot in self.knots.iter().filter(|knot| knot.push > 0.0) {
            for k in 0..2 {
                self.balls[knot.ends[k]].take(&knot.load(k));
            }
        }
    }

    /// Moves the rocks with their mean velocities and books what the impulses took.
    fn go_on(&mut self, terrain: &Terrain, members: &[Seat], dt: f64) {
        let mean = |ball: &Ball| -> (Vec3, Vec3) {
            ((ball.v + ball.before.0) * 0.5, (ball.w + ball.before.1) * 0.5)
        };
        self.taken_j = 0.0;
        for foot in self.feet.iter().filter(|foot| foot.push > 0.0) {
            let (member, ball) = (&members[foot.ball], &self.balls[foot.ball]);
            let world = World { terrain, body: member.body, laws: &member.laws };
            let motion = mean(ball);
            self.losses[foot.ball].add(&foot.loss(&world, &motion), 1.0);
            self.taken_j -= foot.push * foot.n.dot(&motion.0);
        }
        for knot in self.knots.iter().filter(|knot| knot.push > 0.0) {
            let [a, b] = knot.ends.map(|k| mean(&self.balls[k]).0);
            self.taken_j -= knot.push * knot.n.dot(&(a - b));
            let given = [0, 1].map(|k| {
                let (v, w) = mean(&self.balls[knot.ends[k]]);
                -Ball::work_j(&knot.load(k), &v, &w)
            });
            for (end, given) in knot.ends.into_iter().zip(Given::of_impulses(given)) {
                self.given[end].add(&given, 1.0);
            }
        }
        for knot in self.knots.iter().filter(|knot| knot.push > 0.0) {
            knot.ends.into_iter().for_each(|k| self.balls[k].pushed = true);
        }
        for foot in self.feet.iter().filter(|foot| foot.push > 0.0) {
            self.balls[foot.ball].pushed = true;
        }
        for ball in &mut self.balls {
            ball.c += mean(ball).0 * dt;
        }
    }
}

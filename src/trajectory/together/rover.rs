//! One rock of a world: flying, touching, resting, and what is noted down of it.

use super::{Rover, State};
use crate::coupled::{Given, Hit, Member};
use crate::flight::{Landing, Parabola, leap};
use crate::release::Release;
use crate::rock::{Motion, Vec3};
use crate::step::Scheme;
use crate::step::adaptive::ONSET;
use crate::step::grip::{Loss, World};
use crate::trajectory::calm::Calm;
use crate::trajectory::fall::{Course, IMPACT_TIMES};
use crate::trajectory::{PathState, Stop, Trajectory};
use std::f64::consts::PI;

impl Rover<'_> {
    pub(super) fn flight(&self, course: &Course) -> Parabola {
        Parabola {
            start: self.journey.now.position_m,
            velocity: self.journey.now.velocity_m_s,
            gravity: course.gravity_m_s2,
            radius: self.member.body.radius,
        }
    }

    /// Centre at a time not before its own (m).
    pub(super) fn position_at(&self, course: &Course, time_s: f64) -> Vec3 {
        if self.member.flying && time_s > self.journey.now.time_s {
            self.flight(course).centre(time_s - self.journey.now.time_s)
        } else {
            self.journey.now.position_m
        }
    }

    /// Velocity at a time not before its own (m/s).
    pub(super) fn velocity_at(&self, course: &Course, time_s: f64) -> Vec3 {
        if self.member.flying && time_s > self.journey.now.time_s {
            self.flight(course).velocity(time_s - self.journey.now.time_s)
        } else {
            self.journey.now.velocity_m_s
        }
    }

    /// Begins to watch how far its velocity changes; returns what was watched before.
    pub(super) fn watch_from(&mut self, course: &Course, now_s: f64) -> (Vec3, f64) {
        let velocity = self.velocity_at(course, now_s);
        std::mem::replace(&mut self.off, (velocity, 0.0))
    }

    /// Goes on with what was watched before.
    pub(super) fn watch_on(&mut self, (velocity, off): (Vec3, f64)) {
        let since = (self.off.0 - velocity).norm() + self.off.1;
        self.off = (velocity, off.max(since));
    }

    /// Brings a rock that slept to the present; one that flies without knowing where looks ahead.
    pub(super) fn wake(&mut self, course: &Course, now_s: f64) {
        if self.state == State::Asleep {
            self.state = State::Moving;
            let now = Motion { time_s: now_s, ..self.journey.now };
            self.journey.step_as(now, PathState::Sticking);
        }
        if self.member.flying && self.lands.is_none() {
            self.look_ahead(course);
        }
    }

    /// Finds the end of the flight that begins now.
    pub(super) fn look_ahead(&mut self, course: &Course) {
        let now_s = self.journey.now.time_s;
        let left = course.longest_s - now_s;
        let flight = self.flight(course);
        let effort = &mut self.journey.effort;
        effort.leaps += 1;
        self.lands = Some(match leap(course.terrain, &flight, left, &mut effort.triangles) {
            Landing::Touch(t) => (now_s + t, None),
            Landing::Leaves(t) => (now_s + t, Some(Stop::LeftTerrain)),
            Landing::Flies => (f64::INFINITY, None),
        });
    }

    /// Goes along the parabola; nothing for a rock in contact.
    pub(super) fn fly_to(&mut self, course: &Course, time_s: f64) {
        if matches!(self.state, State::Gone(_)) {
            return;
        }
        let dt = time_s - self.journey.now.time_s;
        if self.member.flying && dt > 0.0 {
            let flight = self.flight(course);
            self.journey.fly(&flight, None, dt);
            self.journey.now.time_s = time_s;
        }
        let now = self.journey.now;
        let grip = &mut self.member.grip;
        (grip.c, grip.v, grip.w) = (now.position_m, now.velocity_m_s, now.spin_rad_s);
    }

    /// Begins an episode of contact.
    pub(super) fn begin(&mut self, course: &Course) {
        if self.member.flying {
            self.member.flying = false;
            self.lands = None;
            self.calm = Calm::from(self.journey.now.position_m);
            self.member.grip.holds.clear();
            self.member.grip.stored = 0.0;
            self.began_j = (self.total_j(course), self.given_j());
        }
    }

    /// What others and the contacts with them have had so far (J).
    fn given_j(&self) -> f64 {
        self.journey.ledger.others_j + self.journey.ledger.passed_on_j
    }

    /// Touches the mesh.
    pub(super) fn land(&mut self, course: &Course) {
        self.begin(course);
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.journey.now;
        let Member { grip, body, laws, .. } = &mut *self.member;
        let world = World { terrain: course.terrain, body: *body, laws };
        grip.begin(&world, c, v, w);
        // A rock that is pressed in from the start has the energy of its springs, too.
        if course.step.scheme != Scheme::Rigid {
            let held = grip.stored_j(&world);
            self.journey.pay(&held, 1.0);
            self.began_j.0 += held.sum();
        }
        let omega =
            grip.holds.iter().map(|hold| world.law(hold.triangle).omega).fold(0.0, f64::max);
        if omega > 0.0 {
            self.h = self.h.min(ONSET / omega);
        }
        self.announce(course);
    }

    pub(super) fn total_j(&self, course: &Course) -> f64 {
        let now = &self.journey.now;
        let body = &self.member.body;
        0.5 * (body.mass * now.velocity_m_s.norm_squared()
            + body.inertia * now.spin_rad_s.norm_squared())
            + body.mass * course.gravity_m_s2 * now.position_m.z
    }

    /// Notes one step of its island.
    pub(super) fn step(
        &mut self,
        course: &Course,
        time_s: f64,
        (loss, given): (Loss, Given),
        slides: bool,
    ) {
        if matches!(self.state, State::Gone(_)) {
            return;
        }
        let to = self.motion_at(time_s);
        let was_flying = self.lands.is_some();
        self.announce(course);
        // A rock may be hit and let go within one step: then it flies another way.
        let is_untouched = given == Given::default() && loss == Loss::default();
        if was_flying && self.member.flying && is_untouched {
            self.journey.step_as(to, PathState::Flight);
            return;
        }
        self.touch(course, to, (loss, given), (slides, was_flying));
        if self.member.flying {
            self.look_ahead(course);
        }
    }

    /// Notes one step of its island in the rigid limit: rocks that fly touch and fly on within a step, too.
    pub(super) fn stride(
        &mut self,
        course: &Course,
        time_s: f64,
        given: (Loss, Given),
        slides: bool,
    ) {
        if matches!(self.state, State::Gone(_)) {
            return;
        }
        let to = self.motion_at(time_s);
        self.announce(course);
        if self.member.flew && self.member.flying && !self.member.was_touched {
            self.journey.step_as(to, PathState::Flight);
            return;
        }
        let flew = self.member.flew;
        self.touch(course, to, given, (slides, flew));
        if self.member.flying {
            self.lands = None;
        }
    }

    /// Notes an impact on the mesh in the step that ends at `time_s` (s).
    pub(super) fn hit(&mut self, hit: &Hit, time_s: f64) {
        if self.state == State::Moving {
            self.journey.begin_impact(hit.point_m, hit.feature, hit.triangle, time_s);
        }
    }

    /// What the solver has made of it (the largest change of its velocity is kept).
    fn motion_at(&mut self, time_s: f64) -> Motion {
        let grip = &self.member.grip;
        self.off.1 = self.off.1.max((grip.v - self.off.0).norm());
        Motion { time_s, position_m: grip.c, velocity_m_s: grip.v, spin_rad_s: grip.w }
    }

    /// Notes one step with contact.
    fn touch(
        &mut self,
        course: &Course,
        to: Motion,
        (loss, given): (Loss, Given),
        (slides, was_flying): (bool, bool),
    ) {
        let before_j = self.total_j(course);
        let dt = to.time_s - self.journey.now.time_s;
        let slides = slides || self.member.grip.holds.iter().any(|hold| hold.slides);
        self.journey.step(to, slides);
        self.journey.pay(&loss, 1.0);
        self.journey.ledger.others_j += given.lost;
        self.journey.ledger.passed_on_j += given.passed_on;
        let change = self.total_j(course) - before_j + loss.sum() + given.sum();
        self.journey.ledger.remainder_j -= change;
        self.journey.end_impact_in_time();
        if was_flying {
            self.lands = None;
            self.calm = Calm::from(self.journey.now.position_m);
            self.began_j = (before_j, self.given_j() - given.sum());
        }
        if self.member.flying {
            self.end_episode(course);
        }
        self.calm.note(dt, &to, self.member.body.radius, &course.rest);
    }

    /// Largest rise of energy over the contact episode that ends now.
    pub(super) fn end_episode(&mut self, course: &Course) {
        self.journey.end_impact();
        let given_j = self.given_j() - self.began_j.1;
        let Member { grip, body, laws, .. } = &mut *self.member;
        let world = World { terrain: course.terrain, body: *body, laws };
        // The rigid limit has no springs, whatever the depth that rounding leaves.
        let is_rigid = course.step.scheme == Scheme::Rigid;
        let stored = if is_rigid { Loss::default() } else { grip.springs_j(&world) };
        self.journey.pay(&stored, -1.0);
        let rise_j = self.total_j(course) - self.began_j.0 + given_j + stored.sum();
        self.journey.ledger.rise_j = self.journey.ledger.rise_j.max(rise_j);
    }

    /// Notes down impacts on the mesh that have just begun.
    pub(super) fn announce(&mut self, course: &Course) {
        let Member { grip, body, laws, .. } = &mut *self.member;
        let world = World { terrain: course.terrain, body: *body, laws };
        for hold in grip.holds.iter_mut().filter(|hold| !hold.announced) {
            hold.announced = true;
            if !hold.captured {
                let until_s =
                    self.journey.now.time_s + IMPACT_TIMES * PI / world.law(hold.triangle).omega;
                let point = grip.c - hold.n * body.radius;
                self.journey.begin_impact(point, hold.feature.kind, hold.triangle, until_s);
            }
        }
    }

    pub(super) fn leave(&mut self, stop: Stop) {
        if self.state == State::Moving {
            self.state = State::Gone(stop);
        }
    }

    /// The journey, complete.
    pub(super) fn end(
        mut self,
        course: &Course,
        index: usize,
        release: &Release,
        now_s: f64,
    ) -> Trajectory {
        let stop = match &self.state {
            State::Moving => Stop::TimeUp,
            State::Asleep => Stop::AtRest,
            State::Gone(stop) => stop.clone(),
        };
        if stop == Stop::TimeUp {
            self.fly_to(course, now_s);
        }
        if !self.member.flying {
            self.end_episode(course);
        }
        self.journey.end_impact();
        self.journey.end_path();
        // Friction that turns round within a step may seem to work: that is an error of the steps.
        let ledger = &mut self.journey.ledger;
        for entry in [&mut ledger.friction_j, &mut ledger.damping_j, &mut ledger.rolling_j] {
            ledger.remainder_j += entry.min(0.0);
            *entry = entry.max(0.0);
        }
        let start = release.motion;
        let fallen = start.position_m.z - self.journey.now.position_m.z;
        let kinetic = start.translational_j(&release.rock) + start.rotational_j(&release.rock);
        self.journey.effort.triangles += self.member.grip.near.tested;
        let released_j = self.member.body.mass * course.gravity_m_s2 * fallen + kinetic;
        Trajectory { index, ..self.journey.into_trajectory(release, stop, released_j) }
    }
}

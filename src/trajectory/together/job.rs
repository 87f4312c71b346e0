//! One island through one window: leap, meet, step, rest.

use super::{Rover, State};
use crate::contact::pair::{Tie, meeting_s};
use crate::coupled::islands::Islands;
use crate::coupled::{Cluster, Done};
use crate::flight::{Landing, Parabola, leap};
use crate::release::Release;
use crate::rock::{Motion, Vec3};
use crate::step::Scheme;
use crate::step::adaptive::{Control, ONSET, Stuck};
use crate::step::grip::World;
use crate::step::tableau::{ESDIRK4, TR_BDF2};
use crate::trajectory::fall::{Course, IMPACT_TIMES};
use crate::trajectory::{PathState, Stop, Trajectory};
use std::f64::consts::PI;

/// A gap between two rocks that is rounding of their flight (–, relative to the sum of their radii).
const ROUNDING: f64 = 1e-11;

/// A time that is nothing (s): the clock cannot tell less after an hour.
const SOON_S: f64 = 1e-12;

/// One island and its window.
pub(super) struct Job<'a> {
    course: &'a Course<'a>,
    ids: Vec<u32>,
    rovers: Vec<Rover<'a>>,
    ties: Vec<Tie>,
    now_s: f64,
    end_s: f64,
}

impl<'a> Job<'a> {
    pub(super) fn new(
        course: &'a Course<'a>,
        ids: Vec<u32>,
        rovers: Vec<Rover<'a>>,
        ties: Vec<Tie>,
        (now_s, end_s): (f64, f64),
    ) -> Self {
        Self { course, ids, rovers, ties, now_s, end_s }
    }

    pub(super) fn into_parts(self) -> (Vec<u32>, Vec<Rover<'a>>, Vec<Tie>) {
        (self.ids, self.rovers, self.ties)
    }

    /// Takes the island to the end of its window.
    pub(super) fn run(&mut self) {
        for rover in &mut self.rovers {
            rover.wake(self.course, self.now_s);
        }
        loop {
            let next_s = self.next_event_s().min(self.end_s);
            if self.rovers.iter().all(|rover| rover.member.flying) {
                if next_s >= self.end_s {
                    return;
                }
                self.fly_to(next_s);
                self.begin_contacts();
            } else if !self.steps(next_s) {
                return;
            }
        }
    }

    /// When the next flying rock touches mesh or another flying rock (s).
    fn next_event_s(&self) -> f64 {
        let flying = self.rovers.iter().filter(|rover| rover.member.flying);
        let landings = flying.filter_map(|rover| rover.lands.as_ref().map(|(time_s, _)| *time_s));
        let first = landings.fold(f64::INFINITY, f64::min);
        self.ties.iter().filter_map(|tie| self.meeting_s(tie)).fold(first, f64::min)
    }

    /// When two flying rocks meet (s).
    fn meeting_s(&self, tie: &Tie) -> Option<f64> {
        let [a, b] = [tie.a, tie.b].map(|k| &self.rovers[k as usize]);
        if !a.member.flying || !b.member.flying || tie.is_held() {
            return None;
        }
        let at = |rover: &Rover| {
            let (c, v) = (rover.position_at(self.course, self.now_s), rover.velocity_at(self.course, self.now_s));
            (c, v, rover.member.body.radius)
        };
        let ((c_a, v_a, r_a), (c_b, v_b, r_b)) = (at(a), at(b));
        meeting_s(&(c_a - c_b), &(v_a - v_b), r_a + r_b).map(|t| self.now_s + t)
    }

    /// Whether two flying rocks approach and touch but for rounding.
    fn meets_now(&self, tie: &Tie) -> bool {
        let touching = |tie: &Tie| {
            let [a, b] = [tie.a, tie.b].map(|k| &self.rovers[k as usize]);
            let apart = a.journey.now.position_m - b.journey.now.position_m;
            apart.norm() <= (a.member.body.radius + b.member.body.radius) * (1.0 + ROUNDING)
        };
        self.meeting_s(tie).is_some_and(|t| t - self.now_s <= SOON_S || touching(tie))
    }

    /// Moves flying rocks along their parabolas.
    fn fly_to(&mut self, time_s: f64) {
        for rover in self.rovers.iter_mut().filter(|rover| rover.member.flying) {
            rover.fly_to(self.course, time_s);
        }
        self.now_s = time_s;
    }

    /// Begins all contacts that are due now.
    fn begin_contacts(&mut self) {
        let due: Vec<bool> =
            self.ties.iter().map(|tie| self.meets_now(tie)).collect();
        for (k, _) in due.iter().enumerate().filter(|(_, due)| **due) {
            let ends = [self.ties[k].a as usize, self.ties[k].b as usize];
            for end in ends {
                self.rovers[end].begin(self.course);
            }
            let [a, b] = ends.map(|end| &self.rovers[end].member.grip);
            let tie = &mut self.ties[k];
            let (n, _) = crate::contact::pair::between(&a.c, &b.c);
            (tie.n, tie.closed) = (n, true);
            tie.captured = -n.dot(&(a.v - b.v)) < tie.law.capture_m_s;
            let h = ONSET / tie.law.omega;
            ends.into_iter().for_each(|end| self.rovers[end].h = self.rovers[end].h.min(h));
        }
        for rover in self.rovers.iter_mut().filter(|rover| rover.member.flying) {
            let due = rover.lands.as_ref().is_some_and(|(time_s, _)| *time_s <= self.now_s);
            match rover.lands.take_if(|_| due) {
                Some((_, Some(stop))) => rover.leave(stop),
                Some((_, None)) => rover.land(self.course),
                None => {}
            }
        }
    }

    /// Steps the island until a flying rock is due, all fly, or the window is over; whether it goes on.
    fn steps(&mut self, until_s: f64) -> bool {
        let control = Control {
            tableau: if self.course.step.scheme == Scheme::Reference { &ESDIRK4 } else { &TR_BDF2 },
            tolerance: self.course.step.tolerance_m_s,
        };
        let now_s = self.now_s;
        self.rovers.iter_mut().for_each(|rover| rover.fly_to(self.course, now_s));
        let mut cluster = self.cluster();
        let mut goes_on = true;
        while self.now_s < until_s {
            let room = until_s - self.now_s;
            let sweeps = cluster.sweeps + cluster.jumps;
            let tried = match self.course.step.scheme {
                Scheme::Dda => cluster.advance_fixed(self.course.step, room),
                _ => cluster.advance(&control, room),
            };
            let done = match tried {
                Ok(done) => done,
                Err(stuck) => {
                    self.fail(&stuck);
                    goes_on = false;
                    break;
                }
            };
            self.now_s = if done.dt >= room { until_s } else { self.now_s + done.dt };
            let all_fly = self.note(&mut cluster, &done, sweeps);
            if all_fly {
                break;
            }
        }
        self.dissolve(cluster);
        if self.now_s >= self.end_s {
            self.fall_asleep();
            return false;
        }
        if goes_on {
            self.begin_contacts();
        }
        goes_on
    }

    /// The island as the solver sees it.
    fn cluster(&mut self) -> Cluster<'a> {
        let h = self.rovers.iter().filter(|rover| !rover.member.flying).map(|rover| rover.h);
        let h = h.fold(f64::INFINITY, f64::min);
        let empty = || Box::new(crate::coupled::Member::default());
        let members = self.rovers.iter_mut().map(|rover| std::mem::replace(&mut rover.member, empty()));
        let members = members.collect();
        let mut cluster = Cluster::new(self.course.terrain, members, std::mem::take(&mut self.ties));
        cluster.h = h;
        cluster
    }

    fn dissolve(&mut self, cluster: Cluster<'a>) {
        self.ties = cluster.ties;
        for (rover, member) in self.rovers.iter_mut().zip(cluster.members) {
            rover.h = if member.flying { f64::INFINITY } else { cluster.h };
            rover.member = member;
        }
    }

    /// Writes one step into the journeys; whether all rocks fly now.
    fn note(&mut self, cluster: &mut Cluster<'a>, done: &Done, sweeps: u64) -> bool {
        let swept = cluster.sweeps + cluster.jumps - sweeps;
        let mut slides = vec![false; self.rovers.len()];
        for tie in cluster.ties.iter().filter(|tie| tie.closed && tie.slides) {
            (slides[tie.a as usize], slides[tie.b as usize]) = (true, true);
        }
        for (k, rover) in self.rovers.iter_mut().enumerate() {
            std::mem::swap(&mut rover.member, &mut cluster.members[k]);
            let effort = &mut rover.journey.effort;
            effort.steps += 1;
            effort.rejected += done.rejected;
            effort.sweeps += swept;
            effort.unsettled += u64::from(done.unsettled);
            let given = (done.losses[k], done.given_j[k]);
            rover.step(self.course, self.now_s, given, slides[k]);
            std::mem::swap(&mut rover.member, &mut cluster.members[k]);
        }
        cluster.members.iter().all(|member| member.flying)
    }

    fn fail(&mut self, stuck: &Stuck) {
        for rover in &mut self.rovers {
            rover.leave(Stop::Failed(stuck.to_string()));
        }
    }

    /// Puts to sleep what has been quiet for long enough together with all that it touches.
    fn fall_asleep(&mut self) {
        let mut islands = Islands::alone(self.rovers.len());
        for tie in self.ties.iter().filter(|tie| tie.is_held()) {
            islands.join(tie.a, tie.b);
        }
        for list in islands.lists() {
            let rest = self.course.rest;
            let quiet = |k: &u32| {
                let rover = &self.rovers[*k as usize];
                rover.state == State::Moving && !rover.member.flying && rover.quiet_s >= rest.time_s
            };
            if list.iter().all(quiet) {
                for k in list {
                    self.rovers[k as usize].state = State::Asleep;
                }
            }
        }
    }
}

impl<'a> Rover<'a> {
    fn flight(&self, course: &Course) -> Parabola {
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

    /// Brings a rock that slept to the present; one that flies without knowing where looks ahead.
    fn wake(&mut self, course: &Course, now_s: f64) {
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
    fn look_ahead(&mut self, course: &Course) {
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
    fn fly_to(&mut self, course: &Course, time_s: f64) {
        if matches!(self.state, State::Gone(_)) {
            return;
        }
        let dt = time_s - self.journey.now.time_s;
        if self.member.flying && dt > 0.0 {
            let flight = self.flight(course);
            self.journey.fly(&flight, dt);
            self.journey.now.time_s = time_s;
        }
        let now = self.journey.now;
        let grip = &mut self.member.grip;
        (grip.c, grip.v, grip.w) = (now.position_m, now.velocity_m_s, now.spin_rad_s);
    }

    /// Begins an episode of contact.
    fn begin(&mut self, course: &Course) {
        if self.member.flying {
            self.member.flying = false;
            self.lands = None;
            self.quiet_s = 0.0;
            self.member.grip.holds.clear();
            self.member.grip.stored = 0.0;
            self.began_j = (self.total_j(course), self.journey.ledger.others_j);
        }
    }

    /// Touches the mesh.
    fn land(&mut self, course: &Course) {
        self.begin(course);
        let Motion { position_m: c, velocity_m_s: v, spin_rad_s: w, .. } = self.journey.now;
        let crate::coupled::Member { grip, body, laws, .. } = &mut *self.member;
        let world = World { terrain: course.terrain, body: *body, laws };
        grip.begin(&world, c, v, w);
        let omega = grip.holds.iter().map(|hold| world.law(hold.triangle).omega).fold(0.0, f64::max);
        if omega > 0.0 {
            self.h = self.h.min(ONSET / omega);
        }
        self.announce(course);
    }

    fn total_j(&self, course: &Course) -> f64 {
        let now = &self.journey.now;
        let body = &self.member.body;
        0.5 * (body.mass * now.velocity_m_s.norm_squared() + body.inertia * now.spin_rad_s.norm_squared())
            + body.mass * course.gravity_m_s2 * now.position_m.z
    }

    /// Notes one step of its island.
    fn step(
        &mut self,
        course: &Course,
        time_s: f64,
        (loss, given_j): (crate::step::grip::Loss, f64),
        slides: bool,
    ) {
        if matches!(self.state, State::Gone(_)) {
            return;
        }
        let before_j = self.total_j(course);
        let grip = &self.member.grip;
        let to = Motion { time_s, position_m: grip.c, velocity_m_s: grip.v, spin_rad_s: grip.w };
        let dt = time_s - self.journey.now.time_s;
        let slides = slides || grip.holds.iter().any(|hold| hold.slides);
        let was_flying = self.lands.is_some();
        self.announce(course);
        if was_flying && self.member.flying {
            self.journey.step_as(to, PathState::Flight);
            return;
        }
        self.journey.step(to, slides);
        self.journey.pay(&loss, 1.0);
        self.journey.ledger.others_j += given_j;
        let change = self.total_j(course) - before_j + loss.sum() + given_j;
        self.journey.ledger.remainder_j -= change;
        self.journey.end_impact_in_time();
        if was_flying {
            self.lands = None;
            self.quiet_s = 0.0;
            self.began_j = (before_j, self.journey.ledger.others_j - given_j);
        }
        if self.member.flying {
            self.end_episode(course);
            self.look_ahead(course);
        }
        let slow = to.velocity_m_s.norm().max(to.spin_rad_s.norm() * self.member.body.radius);
        self.quiet_s = if slow < course.rest.speed_m_s { self.quiet_s + dt } else { 0.0 };
    }

    /// Largest rise of energy over the contact episode that ends now.
    fn end_episode(&mut self, course: &Course) {
        self.journey.end_impact();
        let given_j = self.journey.ledger.others_j - self.began_j.1;
        let crate::coupled::Member { grip, body, laws, .. } = &mut *self.member;
        let world = World { terrain: course.terrain, body: *body, laws };
        let stored = grip.springs_j(&world);
        self.journey.pay(&stored, -1.0);
        let rise_j = self.total_j(course) - self.began_j.0 + given_j + stored.sum();
        self.journey.ledger.rise_j = self.journey.ledger.rise_j.max(rise_j);
    }

    /// Notes down impacts on the mesh that have just begun.
    fn announce(&mut self, course: &Course) {
        let crate::coupled::Member { grip, body, laws, .. } = &mut *self.member;
        let world = World { terrain: course.terrain, body: *body, laws };
        for hold in grip.holds.iter_mut().filter(|hold| !hold.announced) {
            hold.announced = true;
            if !hold.captured {
                let until_s = self.journey.now.time_s
                    + IMPACT_TIMES * PI / world.law(hold.triangle).omega;
                let point = grip.c - hold.n * body.radius;
                self.journey.begin_impact(point, hold.feature.kind, hold.triangle, until_s);
            }
        }
    }

    fn leave(&mut self, stop: Stop) {
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
        let journey = self.journey;
        let start = release.motion;
        let fallen = start.position_m.z - journey.now.position_m.z;
        let kinetic = start.translational_j(&release.rock) + start.rotational_j(&release.rock);
        let mut effort = journey.effort;
        effort.triangles += self.member.grip.near.tested;
        Trajectory {
            index,
            rock: release.rock,
            start,
            end: journey.now,
            stop,
            extremes: journey.extremes,
            impact_count: journey.impact_count,
            tree_impact_count: journey.tree_impact_count,
            impacts: journey.impacts,
            path: journey.path,
            ledger: journey.ledger,
            released_j: self.member.body.mass * course.gravity_m_s2 * fallen + kinetic,
            effort,
        }
    }
}

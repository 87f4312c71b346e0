//! One island through one window: leap, meet, step, rest.

mod rigid;

use super::split::{Ahead, Place, is_busy, meeting_ties, place_of};
use super::{Census, Rover, State};
use crate::contact::pair::{Tie, meeting_s};
use crate::coupled::islands::Islands;
use crate::coupled::{Cluster, Done};
use crate::step::Scheme;
use crate::step::adaptive::{Control, ONSET, Stuck};
use crate::step::tableau::{ESDIRK4, TR_BDF2};
use crate::trajectory::Stop;
use crate::trajectory::fall::Course;
use rayon::prelude::*;

/// A gap between two rocks that is rounding of their flight (–, relative to the sum of their radii).
const ROUNDING: f64 = 1e-11;

/// A time that is nothing (s): the clock cannot tell less after an hour.
const SOON_S: f64 = 1e-12;

/// An island of no more rocks than this is stepped as a whole.
const FEW: usize = 4;
/// In how many windows one is cut in which most of an island's rocks cannot meet.
const CUTS: u32 = 4;
/// Shortest of them, in radians of the stiffest contact (–): an impact should not be cut into pieces.
const SHORTEST_PART: f64 = 6.0;

/// Rocks on their way. They are handed on between islands, and a pointer moves faster than a journey.
type Rovers<'a> = Vec<Box<Rover<'a>>>;

/// One island and its window.
pub(super) struct Job<'a> {
    course: &'a Course<'a>,
    ids: Vec<u32>,
    rovers: Rovers<'a>,
    ties: Vec<Tie>,
    now_s: f64,
    end_s: f64,
    kick: f64,
    /// Whether a rock was thrown so far that it may have met one of another island.
    pub(super) missed: bool,
    pub(super) census: Census,
}

impl<'a> Job<'a> {
    pub(super) fn new(
        (course, kick): (&'a Course<'a>, f64),
        ids: Vec<u32>,
        rovers: Rovers<'a>,
        ties: Vec<Tie>,
        (now_s, end_s): (f64, f64),
    ) -> Self {
        Self {
            course,
            ids,
            rovers,
            ties,
            now_s,
            end_s,
            kick,
            missed: false,
            census: Census::default(),
        }
    }

    pub(super) fn into_parts(self) -> (Vec<u32>, Rovers<'a>, Vec<Tie>) {
        (self.ids, self.rovers, self.ties)
    }

    /// Takes the island to the end of its window.
    pub(super) fn run(&mut self) {
        if self.is_rigid_heap() {
            self.run_rigid();
            return;
        }
        if !self.falls_apart() {
            self.run_whole();
            return;
        }
        let (start_s, end_s) = (self.now_s, self.end_s);
        for k in 1..=CUTS {
            let part = f64::from(k) / f64::from(CUTS);
            self.end_s = if k == CUTS { end_s } else { start_s + part * (end_s - start_s) };
            self.run_parts();
            self.now_s = self.end_s;
        }
    }

    /// Whether most of the island's rocks are not joined in a much shorter window: then shorter windows are cheaper than
    /// stepping all together.
    fn falls_apart(&self) -> bool {
        let (count, dt) = (self.rovers.len(), (self.end_s - self.now_s) / f64::from(CUTS));
        let stiffest = self.ties.iter().map(|tie| tie.law.omega).fold(0.0, f64::max);
        if count <= FEW || dt * stiffest < SHORTEST_PART {
            return false;
        }
        let ahead = Ahead { dt, kick: self.kick };
        let mut meetings = meeting_ties(&self.ties, &self.places(dt), ahead);
        let largest = meetings.islands.sizes().into_iter().max().unwrap_or(0);
        4 * largest as usize <= 3 * count
    }

    fn places(&self, dt: f64) -> Vec<Place> {
        let place = |rover: &Rover| place_of(rover, self.course, (self.now_s, dt));
        self.rovers.iter().map(|rover| place(rover)).collect()
    }

    /// Takes the parts that cannot meet before the end of the window there, each on its own.
    fn run_parts(&mut self) {
        let dt = self.end_s - self.now_s;
        let places = self.places(dt);
        let mut meetings = meeting_ties(&self.ties, &places, Ahead { dt, kick: self.kick });
        let mut lists = meetings.islands.lists();
        lists.retain(|list| is_busy(list.iter().map(|&k| &*self.rovers[k as usize]), self.end_s));
        let mut part = vec![(u32::MAX, 0); self.rovers.len()];
        for (list, number) in lists.iter().zip(0..) {
            for (&k, place) in list.iter().zip(0..) {
                part[k as usize] = (number, place);
            }
        }
        let mut ties: Vec<Vec<Tie>> = lists.iter().map(|_| Vec::new()).collect();
        let mut pairs = meetings.pairs.iter().peekable();
        self.ties.retain(|tie| {
            let (number, a) = part[tie.a as usize];
            let meets = pairs.next_if(|pair| **pair == (tie.a, tie.b)).is_some();
            let goes = meets && number != u32::MAX;
            if goes {
                ties[number as usize].push(Tie { a, b: part[tie.b as usize].1, ..*tie });
            }
            !goes
        });
        let mut homes: Vec<Option<Box<Rover>>> = self.rovers.drain(..).map(Some).collect();
        let mut jobs = Vec::with_capacity(lists.len());
        for (list, ties) in lists.into_iter().zip(ties) {
            let rovers = list.iter().filter_map(|&k| homes[k as usize].take()).collect();
            let window = (self.now_s, self.end_s);
            jobs.push(Job::new((self.course, self.kick), list, rovers, ties, window));
        }
        jobs.par_iter_mut().for_each(Job::run);
        for job in jobs {
            self.missed |= job.missed;
            self.census.add(&job.census);
            let (list, rovers, ties) = job.into_parts();
            self.ties.extend(ties.into_iter().map(|tie| Tie {
                a: list[tie.a as usize],
                b: list[tie.b as usize],
                ..tie
            }));
            for (&k, rover) in list.iter().zip(rovers) {
                homes[k as usize] = Some(rover);
            }
        }
        self.ties.sort_unstable_by_key(|tie| (tie.a, tie.b));
        self.rovers.extend(homes.into_iter().flatten());
        let rovers = &self.rovers;
        self.missed |= meetings.missed(&places, dt, |k| rovers[k].fastest_m_s);
    }

    /// Takes all of the island to the end of the window together.
    fn run_whole(&mut self) {
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
            let (c, v) = (
                rover.position_at(self.course, self.now_s),
                rover.velocity_at(self.course, self.now_s),
            );
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
        let due: Vec<bool> = self.ties.iter().map(|tie| self.meets_now(tie)).collect();
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
            for end in ends {
                self.rovers[end].h = self.rovers[end].h.min(h);
            }
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
            let spent = (cluster.sweeps, cluster.jumps);
            let tried = match self.course.step.scheme {
                Scheme::Dda => cluster.advance_fixed(self.course.step, room),
                Scheme::Rigid => cluster.advance_rigid(self.course.step.step_s, room),
                _ => cluster.advance(&control, room),
            };
            let done = match tried {
                Ok(done) => done,
                Err(stuck) => {
                    self.fail(stuck);
                    goes_on = false;
                    break;
                }
            };
            self.now_s = if done.dt >= room { until_s } else { self.now_s + done.dt };
            let all_fly = self.note(&mut cluster, &done, spent);
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
        let members = self.rovers.iter_mut().map(|rover| rover.member.lend()).collect();
        let mut cluster =
            Cluster::new(self.course.terrain, members, std::mem::take(&mut self.ties));
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
    fn note(
        &mut self,
        cluster: &mut Cluster<'a>,
        done: &Done,
        (swept, jumped): (u64, u64),
    ) -> bool {
        let (sweeps, jumps) = (cluster.sweeps - swept, cluster.jumps - jumped);
        let rocks = self.rovers.len() as u64;
        self.census.add(&Census {
            steps: 1,
            rock_steps: rocks,
            rejected: done.rejected,
            sweeps,
            jumps,
            unsettled: u64::from(done.unsettled),
            largest: rocks,
            ..Census::default()
        });
        let mut slides = vec![false; self.rovers.len()];
        for tie in cluster.ties.iter().filter(|tie| tie.closed && tie.slides) {
            (slides[tie.a as usize], slides[tie.b as usize]) = (true, true);
        }
        for (k, rover) in self.rovers.iter_mut().enumerate() {
            std::mem::swap(&mut rover.member, &mut cluster.members[k]);
            let effort = &mut rover.journey.effort;
            effort.steps += 1;
            effort.rejected += done.rejected;
            effort.sweeps += sweeps + jumps;
            effort.unsettled += u64::from(done.unsettled);
            let given = (done.losses[k], done.given_j[k]);
            rover.step(self.course, self.now_s, given, slides[k]);
            std::mem::swap(&mut rover.member, &mut cluster.members[k]);
        }
        cluster.members.iter().all(|member| member.flying)
    }

    fn fail(&mut self, stuck: Stuck) {
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

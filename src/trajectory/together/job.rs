//! One island through one window: leap, meet, step, rest.

mod rigid;

use super::{Census, Rover, State};
use crate::contact::pair::{Tie, meeting_s};
use crate::coupled::islands::Islands;
use crate::coupled::{Cluster, Done, Given};
use crate::step::Scheme;
use crate::step::adaptive::{Control, ONSET, Stuck};
use crate::step::grip::Loss;
use crate::step::tableau::{ESDIRK4, TR_BDF2};
use crate::trajectory::Stop;
use crate::trajectory::fall::Course;

/// A gap between two rocks that is rounding of their flight (–, relative to the sum of their radii).
const ROUNDING: f64 = 1e-11;

/// A time that is nothing (s): the clock cannot tell less after an hour.
const SOON_S: f64 = 1e-12;

/// Rocks on their way. They are handed on between islands, and a pointer moves faster than a journey.
type Rovers<'a> = Vec<Box<Rover<'a>>>;

/// How a rock notes a step with its losses (J), what it gave to others (J), and whether it slides.
type Going<'a> = fn(&mut Rover<'a>, &Course, f64, (Loss, Given), bool);

/// One island and its window.
pub(super) struct Job<'a> {
    pub(super) course: &'a Course<'a>,
    pub(super) ids: Vec<u32>,
    pub(super) rovers: Rovers<'a>,
    pub(super) ties: Vec<Tie>,
    pub(super) now_s: f64,
    pub(super) end_s: f64,
    /// Whether it goes back by itself where a rock was thrown further than was allowed for.
    pub(super) goes_back: bool,
    /// Whether a rock was thrown so far that it may have met one of another island.
    pub(super) missed: bool,
    pub(super) census: Census,
}

impl<'a> Job<'a> {
    pub(super) fn new(
        course: &'a Course<'a>,
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
            goes_back: true,
            missed: false,
            census: Census::default(),
        }
    }

    pub(super) fn into_parts(self) -> (Vec<u32>, Rovers<'a>, Vec<Tie>) {
        (self.ids, self.rovers, self.ties)
    }

    /// Takes all of the island to the end of the window together.
    pub(super) fn run_whole(&mut self) {
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
    pub(super) fn next_event_s(&self) -> f64 {
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
            impact: f64::INFINITY,
            plane_impacts: false,
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
            let all_fly = self.note(&mut cluster, &done, (spent, Rover::step));
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
            rover.pressed_m_s = member.pressed_m_s(self.course.terrain);
            rover.member = member;
        }
        for tie in self.ties.iter().filter(|tie| tie.is_held()) {
            for k in [tie.a, tie.b] {
                let rover = &mut self.rovers[k as usize];
                rover.pressed_m_s += tie.push.abs() / (rover.member.body.mass * tie.law.omega);
            }
        }
    }

    /// Writes one step into the journeys; whether all rocks fly now.
    fn note(
        &mut self,
        cluster: &mut Cluster<'a>,
        done: &Done,
        ((swept, jumped), go): ((u64, u64), Going<'a>),
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
        // Only the rigid limit lists hits.
        let mut hits = done.hits.iter().peekable();
        let mut slides = vec![false; self.rovers.len()];
        for tie in cluster.ties.iter().filter(|tie| tie.closed && tie.slides) {
            (slides[tie.a as usize], slides[tie.b as usize]) = (true, true);
        }
        for (k, rover) in self.rovers.iter_mut().enumerate() {
            std::mem::swap(&mut rover.member, &mut cluster.members[k]);
            while let Some(hit) = hits.next_if(|hit| hit.rock == k) {
                rover.hit(hit, self.now_s);
            }
            let effort = &mut rover.journey.effort;
            effort.steps += 1;
            effort.rejected += done.rejected;
            effort.sweeps += sweeps + jumps;
            effort.unsettled += u64::from(done.unsettled);
            let given = (done.losses[k], done.given[k]);
            go(rover, self.course, self.now_s, given, slides[k]);
            rover.spend(self.course);
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
            let quiet = |k: &u32| {
                let rover = &self.rovers[*k as usize];
                rover.state == State::Moving && !rover.member.flying && rover.calm.rests()
            };
            if list.iter().all(quiet) {
                for k in list {
                    self.rovers[k as usize].state = State::Asleep;
                }
            }
        }
    }
}

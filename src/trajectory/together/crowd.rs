//! All rocks of a world, and the windows of time they go through.

use super::job::Job;
use super::split::{Meetings, Place, is_busy, meetings_in_passing, meetings_of_islands, place_of};
use super::wide::Wide;
use super::{Answer, Census, Rover, State, TOUCHING, capture, law_between};
use crate::contact::pair::Tie;
use crate::coupled::TRAVEL;
use crate::coupled::broad::{Ball, overlapping};
use crate::ground::{Capture, Damping, Ground, Law};
use crate::release::Release;
use crate::step::Scheme;
use crate::trajectory::Trajectory;
use crate::trajectory::fall::Course;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Way of the fastest rock in one window, relative to its radius (–): the islands stay small.
const WAY: f64 = 0.1;
/// Longest window (s).
const LONGEST_S: f64 = 0.02;
/// Shortest window (s): one very small and fast rock must not stop the world.
const SHORTEST_S: f64 = 1e-5;
/// Times that the world goes back to one moment, each time knowing of throws twice as fast: enough for a rock of a
/// billionth of the mass along ten ever heavier ones.
const RETURNS: usize = 16;
/// Windows after which a new moment is kept to go back to.
const WINDOWS: usize = 64;
/// The same in the rigid limit, where a window is dear and a moment cheap beside it.
const WINDOWS_RIGID: usize = 8;

/// All rocks of a world.
pub(super) struct Crowd<'a> {
    course: &'a Course<'a>,
    answer: (Ground, Damping),
    capture: Capture,
    pub(super) rovers: Vec<Option<Box<Rover<'a>>>>,
    /// Contacts and bonds, in the order of the numbers of their rocks.
    pub(super) ties: Vec<Tie>,
    /// Who was near whom when that was asked last.
    wide: Wide,
    pub(super) now_s: f64,
    pub(super) census: Census,
}

impl<'a> Crowd<'a> {
    pub(super) fn new(
        course: &'a Course<'a>,
        answer: &Answer,
        rovers: Vec<Option<Box<Rover<'a>>>>,
    ) -> Self {
        Self {
            course,
            answer: (answer.ground, Damping::of(answer.ground.restitution)),
            capture: capture(course),
            rovers,
            ties: Vec::new(),
            wide: Wide::default(),
            now_s: 0.0,
            census: Census::default(),
        }
    }

    #[expect(clippy::expect_used, reason = "rovers are away only while their island is computed")]
    pub(super) fn rover(&self, k: u32) -> &Rover<'a> {
        self.rovers[k as usize].as_ref().expect("a rover is at home between windows")
    }

    pub(super) fn is_rigid(&self) -> bool {
        self.course.step.scheme == Scheme::Rigid
    }

    pub(super) fn law(&self, a: u32, b: u32) -> Law {
        let [a, b] = [a, b].map(|k| &self.rover(k).member.body);
        law_between(a, b, &self.answer, &self.capture)
    }

    pub(super) fn tie(&mut self, tie: Tie) {
        let place = self.ties.partition_point(|known| (known.a, known.b) < (tie.a, tie.b));
        self.ties.insert(place, tie);
    }

    /// A bonded rock does not fly: its contacts begin with the world.
    pub(super) fn hold(&mut self, k: u32) {
        let course = self.course;
        if let Some(rover) = self.rovers[k as usize].as_mut().filter(|rover| rover.member.flying) {
            rover.land(course);
        }
    }

    /// Pairs that touch as far as typed coordinates can say.
    pub(super) fn touching_at_start(&self) -> Vec<(u32, u32)> {
        let ball = |rover: &Rover| Ball {
            centre: rover.member.grip.c,
            radius: rover.member.body.radius * (1.0 + TOUCHING),
        };
        overlapping(&self.rovers.iter().flatten().map(|rover| ball(rover)).collect::<Vec<_>>())
    }

    /// Goes through windows until nothing moves or time is up; false if `stop` was raised. After each window `see` is told
    /// the time (s) and the counts so far; where the world goes back, so does the time.
    pub(super) fn run(&mut self, stop: &AtomicBool, mut see: impl FnMut(f64, &Census)) -> bool {
        while self.is_under_way() {
            let moment = self.moment();
            for tried in 0..=RETURNS {
                let Some(missed) = self.windows(stop, &mut see) else { return false };
                if !missed || tried == RETURNS {
                    break;
                }
                self.go_back(&moment);
                self.census.returns += 1;
            }
            self.rovers.iter_mut().flatten().for_each(|rover| rover.foreseen_m_s = 0.0);
        }
        true
    }

    fn is_under_way(&self) -> bool {
        let mut rovers = self.rovers.iter().flatten();
        self.now_s < self.course.longest_s && rovers.any(|rover| rover.state == State::Moving)
    }

    /// Goes through the next windows, up to one in which a rock may have met one that it was not compared with; whether
    /// there was such a one, `None` if `stop` was raised.
    fn windows(&mut self, stop: &AtomicBool, see: &mut impl FnMut(f64, &Census)) -> Option<bool> {
        for _ in 0..if self.is_rigid() { WINDOWS_RIGID } else { WINDOWS } {
            if !self.is_under_way() {
                break;
            }
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let missed = self.window();
            see(self.now_s, &self.census);
            if missed {
                return Some(true);
            }
        }
        Some(false)
    }

    /// One window: islands, each on its own. Whether a rock was thrown further than was allowed for and may have met
    /// one of another island.
    fn window(&mut self) -> bool {
        let length = self.window_length();
        let end_s = (self.now_s + length).min(self.course.longest_s);
        let (course, now_s) = (self.course, self.now_s);
        self.rovers.iter_mut().flatten().for_each(|rover| {
            rover.watch_from(course, now_s);
        });
        let present: Vec<u32> = self.present();
        let dt = end_s - self.now_s;
        let place = |&k: &u32| place_of(self.rover(k), self.course, (self.now_s, dt));
        let places: Vec<Place> = present.iter().map(place).collect();
        let mut wide = std::mem::take(&mut self.wide);
        let mut meetings = self.meetings(&mut wide, &present, &places, dt);
        self.wide = wide;
        let jobs = self.jobs(&present, &mut meetings, end_s);
        let done: Vec<Job> = jobs
            .into_par_iter()
            .map(|mut job| {
                job.run();
                job
            })
            .collect();
        let mut missed = false;
        // what was not lent stays
        self.ties.retain(|tie| tie.a != tie.b);
        for job in done {
            missed |= job.missed;
            self.census.add(&job.census);
            self.take_back(job);
        }
        self.ties.sort_unstable_by_key(|tie| (tie.a, tie.b));
        self.now_s = end_s;
        self.census.windows += 1;
        let after = |k: usize| {
            let rover = self.rover(present[k]);
            (rover.position_at(self.course, end_s), rover.off.1)
        };
        let thrown = meetings.missed(&places, dt, after, |astray| {
            overlapping(
                &places.iter().zip(astray).map(|(p, off)| p.swept(*off, dt)).collect::<Vec<_>>(),
            )
        });
        for &k in &thrown {
            if let Some(rover) = &mut self.rovers[present[k] as usize] {
                rover.foresee();
            }
        }
        missed || !thrown.is_empty()
    }

    /// The rocks that are in the world.
    fn present(&self) -> Vec<u32> {
        let count = self.rovers.len() as u32;
        (0..count).filter(|&k| !matches!(self.rover(k).state, State::Gone(_))).collect()
    }

    fn window_length(&self) -> f64 {
        let mut length = LONGEST_S;
        // In the rigid limit nothing happens between the steps: a window is one.
        let way = if self.is_rigid() { TRAVEL } else { WAY };
        for rover in self.rovers.iter().flatten().filter(|rover| rover.state == State::Moving) {
            let speed = rover.velocity_at(self.course, self.now_s).norm();
            length = length.min(way * rover.member.body.radius / speed.max(1e-9));
        }
        length.max(SHORTEST_S)
    }

    /// Who may meet whom; numbers are places in `present`.
    fn meetings(&self, wide: &mut Wide, present: &[u32], places: &[Place], dt: f64) -> Meetings {
        let at = |k: u32| present.binary_search(&k).unwrap_or_default() as u32;
        let held: Vec<(u32, u32)> = self.ties.iter().map(|tie| (at(tie.a), at(tie.b))).collect();
        if self.is_rigid() {
            return meetings_in_passing(places, dt, &held, |reaches| {
                wide.overlapping(places, reaches)
            });
        }
        meetings_of_islands(places, dt, |reaches| {
            let mut pairs = wide.overlapping(places, reaches);
            if !held.is_empty() {
                pairs.extend(&held);
                pairs.sort_unstable();
                pairs.dedup();
            }
            pairs
        })
    }

    /// Takes every island in which something may happen before `end_s` out of the world.
    fn jobs(&mut self, present: &[u32], meetings: &mut Meetings, end_s: f64) -> Vec<Job<'a>> {
        let mut lists = meetings.islands.lists();
        lists.retain(|list| is_busy(list.iter().map(|&k| self.rover(present[k as usize])), end_s));
        let mut part = vec![(usize::MAX, 0); present.len()];
        for (number, list) in lists.iter().enumerate() {
            for (&k, place) in list.iter().zip(0..) {
                part[k as usize] = (number, place);
            }
        }
        let mut ties: Vec<Vec<Tie>> = lists.iter().map(|_| Vec::new()).collect();
        let mut known = 0;
        for &(a, b) in &meetings.pairs {
            let (number, place) = part[a as usize];
            if number == usize::MAX {
                continue;
            }
            let [one, two] = [a, b].map(|k| present[k as usize]);
            let before = |tie: &Tie| (tie.a, tie.b) < (one, two);
            while self.ties.get(known).is_some_and(before) {
                known += 1;
            }
            let lent = self.ties.get_mut(known).filter(|tie| (tie.a, tie.b) == (one, two));
            let tie = if let Some(tie) = lent {
                // the place of a tie that is lent: both ends one rock
                let stays = Tie { b: tie.a, ..*tie };
                std::mem::replace(tie, stays)
            } else {
                Tie::new(one, two, self.law(one, two))
            };
            // the ends of a lent tie keep the order of the list
            known += usize::from(self.ties.get(known).is_some_and(|tie| tie.a == tie.b));
            ties[number].push(Tie { a: place, b: part[b as usize].1, ..tie });
        }
        let mut jobs = Vec::with_capacity(lists.len());
        for (list, ties) in lists.into_iter().zip(ties) {
            let ids: Vec<u32> = list.iter().map(|&k| present[k as usize]).collect();
            let rovers = ids.iter().filter_map(|&k| self.rovers[k as usize].take()).collect();
            jobs.push(Job::new(self.course, ids, rovers, ties, (self.now_s, end_s)));
        }
        jobs
    }

    fn take_back(&mut self, job: Job<'a>) {
        let (ids, rovers, ties) = job.into_parts();
        for tie in ties.into_iter().filter(Tie::is_held) {
            let (a, b) = (ids[tie.a as usize], ids[tie.b as usize]);
            let gone = |k: u32| matches!(rovers[k as usize].state, State::Gone(_));
            if !gone(tie.a) && !gone(tie.b) {
                self.ties.push(Tie { a, b, ..tie });
            }
        }
        for (&k, rover) in ids.iter().zip(rovers) {
            self.rovers[k as usize] = Some(rover);
        }
    }

    /// The journeys, complete.
    pub(super) fn end(self, releases: &[Release]) -> Vec<Trajectory> {
        let Self { course, rovers, now_s, .. } = self;
        let rovers = rovers.into_iter().flatten().enumerate();
        rovers
            .zip(releases)
            .map(|((k, rover), release)| rover.end(course, k, release, now_s))
            .collect()
    }
}

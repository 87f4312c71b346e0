//! All rocks of a world, and the windows of time they go through.

use super::job::Job;
use super::{Answer, Rover, State, TOUCHING, capture, law_between};
use crate::contact::pair::Tie;
use crate::coupled::broad::{Ball, overlapping};
use crate::coupled::islands::Islands;
use crate::ground::{Capture, Damping, Ground, Law};
use crate::release::Release;
use crate::rock::Vec3;
use crate::trajectory::Trajectory;
use crate::trajectory::fall::Course;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

/// Way of the fastest rock in one window, relative to its radius (–): the islands stay small.
const WAY: f64 = 0.1;
/// Longest window (s).
const LONGEST_S: f64 = 0.02;
/// Shortest window (s): one very small and fast rock must not stop the world.
const SHORTEST_S: f64 = 1e-5;
/// Speed that a rock may have after being hit, over the fastest speed around it (–): twice for a light one under a
/// heavy one.
const KICK: f64 = 2.2;
/// Passes in which islands grow by the reach of those that may be hit.
const PASSES: usize = 3;

/// All rocks of a world.
pub(super) struct Crowd<'a> {
    course: &'a Course<'a>,
    answer: (Ground, Damping),
    capture: Capture,
    rovers: Vec<Option<Rover<'a>>>,
    /// Contacts and bonds, by the numbers of the rocks.
    ties: BTreeMap<(u32, u32), Tie>,
    now_s: f64,
}

impl<'a> Crowd<'a> {
    pub(super) fn new(
        course: &'a Course<'a>,
        answer: &Answer,
        rovers: Vec<Option<Rover<'a>>>,
    ) -> Self {
        Self {
            course,
            answer: (answer.ground, Damping::of(answer.ground.restitution)),
            capture: capture(course),
            rovers,
            ties: BTreeMap::new(),
            now_s: 0.0,
        }
    }

    #[expect(clippy::expect_used, reason = "rovers are away only while their island is computed")]
    pub(super) fn rover(&self, k: u32) -> &Rover<'a> {
        self.rovers[k as usize].as_ref().expect("a rover is at home between windows")
    }

    pub(super) fn law(&self, a: u32, b: u32) -> Law {
        let [a, b] = [a, b].map(|k| &self.rover(k).member.body);
        law_between(a, b, &self.answer, &self.capture)
    }

    pub(super) fn tie(&mut self, tie: Tie) {
        self.ties.insert((tie.a, tie.b), tie);
    }

    /// A bonded rock does not fly.
    pub(super) fn hold(&mut self, k: u32) {
        if let Some(rover) = &mut self.rovers[k as usize] {
            rover.member.flying = false;
        }
    }

    /// Pairs that touch as far as typed coordinates can say.
    pub(super) fn touching_at_start(&self) -> Vec<(u32, u32)> {
        let ball = |rover: &Rover| Ball {
            centre: rover.member.grip.c,
            radius: rover.member.body.radius * (1.0 + TOUCHING),
        };
        overlapping(&self.rovers.iter().flatten().map(ball).collect::<Vec<_>>())
    }

    /// Goes through windows until nothing moves or time is up; false if `stop` was raised.
    pub(super) fn run(&mut self, stop: &AtomicBool) -> bool {
        loop {
            let under_way = self.rovers.iter().flatten().any(|rover| rover.state == State::Moving);
            if !under_way || self.now_s >= self.course.longest_s {
                return true;
            }
            if stop.load(Ordering::Relaxed) {
                return false;
            }
            self.window();
        }
    }

    /// One window: islands, each on its own.
    fn window(&mut self) {
        let length = self.window_length();
        let end_s = (self.now_s + length).min(self.course.longest_s);
        let (pairs, mut islands) = self.islands(end_s - self.now_s);
        let jobs = self.jobs(&pairs, &mut islands, end_s);
        let done: Vec<Job> = jobs
            .into_par_iter()
            .map(|mut job| {
                job.run();
                job
            })
            .collect();
        for job in done {
            self.take_back(job);
        }
        self.now_s = end_s;
    }

    fn window_length(&self) -> f64 {
        let mut length = LONGEST_S;
        for rover in self.rovers.iter().flatten().filter(|rover| rover.state == State::Moving) {
            let speed = rover.velocity_at(self.course, self.now_s).norm();
            length = length.min(WAY * rover.member.body.radius / speed.max(1e-9));
        }
        length.max(SHORTEST_S)
    }

    /// Pairs that may touch within `dt` and the islands they form.
    fn islands(&self, dt: f64) -> (Vec<(u32, u32)>, Islands) {
        let count = self.rovers.len();
        let g = self.course.gravity_m_s2;
        let present: Vec<u32> =
            (0..count as u32).filter(|&k| !matches!(self.rover(k).state, State::Gone(_))).collect();
        let places: Vec<(Vec3, f64, f64)> = present
            .iter()
            .map(|&k| {
                let rover = self.rover(k);
                let speed = if rover.state == State::Asleep {
                    0.0
                } else {
                    rover.velocity_at(self.course, self.now_s).norm() + g * dt
                };
                (rover.position_at(self.course, self.now_s), rover.member.body.radius, speed)
            })
            .collect();
        let mut fastest: Vec<f64> = places.iter().map(|place| place.2).collect();
        let (mut pairs, mut islands) = (Vec::new(), Islands::alone(count));
        for _ in 0..PASSES {
            let ball = |((centre, radius, _), speed): (&(Vec3, f64, f64), &f64)| Ball {
                centre: *centre,
                radius: radius * (1.0 + 1e-6) + KICK * speed * dt,
            };
            let balls: Vec<Ball> = places.iter().zip(&fastest).map(ball).collect();
            pairs = overlapping(&balls);
            for pair in &mut pairs {
                *pair = (present[pair.0 as usize], present[pair.1 as usize]);
            }
            pairs.extend(self.ties.keys());
            pairs.sort_unstable();
            pairs.dedup();
            islands = Islands::alone(count);
            for &(a, b) in &pairs {
                islands.join(a, b);
            }
            let mut most = vec![0.0f64; count];
            for (place, &k) in places.iter().zip(&present) {
                let root = islands.of(k) as usize;
                most[root] = most[root].max(place.2);
            }
            for (speed, &k) in fastest.iter_mut().zip(&present) {
                *speed = most[islands.of(k) as usize];
            }
        }
        (pairs, islands)
    }

    /// Takes every island in which something may happen before `end_s` out of the world.
    fn jobs(&mut self, pairs: &[(u32, u32)], islands: &mut Islands, end_s: f64) -> Vec<Job<'a>> {
        let mut of_root: BTreeMap<u32, Vec<(u32, u32)>> = BTreeMap::new();
        for &(a, b) in pairs {
            of_root.entry(islands.of(a)).or_default().push((a, b));
        }
        let mut jobs = Vec::new();
        for ids in islands.lists() {
            if !self.is_busy(&ids, end_s) {
                continue;
            }
            let pairs = of_root.remove(&ids[0]).unwrap_or_default();
            let place = |k: u32| ids.binary_search(&k).unwrap_or_default() as u32;
            let ties = pairs.iter().map(|&(a, b)| {
                let known = self.ties.remove(&(a, b));
                let tie = known.unwrap_or_else(|| Tie::new(a, b, self.law(a, b)));
                Tie { a: place(a), b: place(b), ..tie }
            });
            let ties = ties.collect();
            let rovers = ids.iter().filter_map(|&k| self.rovers[k as usize].take()).collect();
            jobs.push(Job::new(self.course, ids, rovers, ties, (self.now_s, end_s)));
        }
        jobs
    }

    /// Whether anything of an island moves other than along a parabola that goes on beyond `end_s`.
    fn is_busy(&self, ids: &[u32], end_s: f64) -> bool {
        match ids {
            [k] => {
                let rover = self.rover(*k);
                let flies_on =
                    rover.member.flying && rover.lands.as_ref().is_some_and(|(t, _)| *t > end_s);
                rover.state == State::Moving && !flies_on
            }
            _ => ids.iter().any(|&k| self.rover(k).state == State::Moving),
        }
    }

    fn take_back(&mut self, job: Job<'a>) {
        let (ids, rovers, ties) = job.into_parts();
        for tie in ties.into_iter().filter(Tie::is_held) {
            let (a, b) = (ids[tie.a as usize], ids[tie.b as usize]);
            let gone = |k: u32| matches!(rovers[k as usize].state, State::Gone(_));
            if !gone(tie.a) && !gone(tie.b) {
                self.ties.insert((a, b), Tie { a, b, ..tie });
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

//! An island whose rocks mostly do not meet in a much shorter window is taken apart: each part goes through that on its
//! own.

use super::Rover;
use super::job::Job;
use super::moment::Kept;
use super::split::{Ahead, Meetings, Place, Spread, is_busy, meeting_ties, place_of};
use crate::contact::pair::Tie;
use crate::rock::Vec3;
use rayon::prelude::*;

/// An island of no more rocks than this is stepped as a whole.
const FEW: usize = 4;
/// In how many windows one is cut in which most of an island's rocks cannot meet.
const CUTS: u32 = 4;
/// Shortest of them, in radians of the stiffest contact (–): less than a step of a quiet heap.
const SHORTEST_PART: f64 = 1.5;
/// Within so many radians of the stiffest contact a hit is handed on to the next few rocks only (–).
const FAR: f64 = 12.0;
/// Times that a window is gone through again because a rock was thrown further than was allowed for, before that is left
/// to the whole world.
const RETURNS: usize = 6;

impl Job<'_> {
    /// Takes the island to the end of its window.
    pub(super) fn run(&mut self) {
        if self.is_rigid_heap() {
            self.run_rigid();
            return;
        }
        if self.flies_through() {
            return;
        }
        let stiffest = self.ties.iter().map(|tie| tie.law.omega).fold(0.0, f64::max);
        let Some(cuts) = self.falls_apart(stiffest) else {
            self.run_whole();
            return;
        };
        let (start_s, end_s) = (self.now_s, self.end_s);
        for k in 1..=cuts {
            let part = f64::from(k) / f64::from(cuts);
            self.end_s = if k == cuts { end_s } else { start_s + part * (end_s - start_s) };
            if self.goes_back {
                self.run_parts_again(stiffest);
            } else {
                self.run_parts(stiffest);
            }
            self.now_s = self.end_s;
        }
    }

    /// Whether all of the island flies and neither meets nor lands before the end of its window.
    fn flies_through(&self) -> bool {
        let flies_on = |rover: &Rover| {
            let lands = rover.lands.as_ref();
            rover.member.flying && lands.is_some_and(|(time_s, _)| *time_s > self.end_s)
        };
        self.rovers.iter().all(|rover| flies_on(rover)) && self.next_event_s() > self.end_s
    }

    /// In how many much shorter windows most of the island's rocks are not joined: then those are cheaper than stepping
    /// all together.
    fn falls_apart(&self, stiffest: f64) -> Option<u32> {
        let (count, length) = (self.rovers.len(), self.end_s - self.now_s);
        let mut cuts = CUTS;
        while count > FEW && length / f64::from(cuts) * stiffest >= SHORTEST_PART {
            let dt = length / f64::from(cuts);
            let mut meetings = self.meetings(&self.places(dt), (dt, stiffest));
            let largest = meetings.islands.sizes().into_iter().max().unwrap_or(0);
            if 4 * largest as usize <= 3 * count {
                return Some(cuts);
            }
            cuts *= CUTS;
        }
        None
    }

    fn places(&self, dt: f64) -> Vec<Place> {
        let place = |rover: &Rover| place_of(rover, self.course, (self.now_s, dt));
        self.rovers.iter().map(|rover| place(rover)).collect()
    }

    fn meetings(&self, places: &[Place], (dt, stiffest): (f64, f64)) -> Meetings {
        let spread = if dt * stiffest > FAR { Spread::Island } else { Spread::Neighbours };
        meeting_ties(&self.ties, places, Ahead { dt, spread })
    }

    /// Takes the parts there, and again if a rock was thrown further than was allowed for.
    fn run_parts_again(&mut self, stiffest: f64) {
        let kept: Vec<Kept> = self.rovers.iter().map(|rover| rover.keep()).collect();
        let ties = self.ties.clone();
        for _ in 0..RETURNS {
            if !self.run_parts(stiffest) {
                return;
            }
            for (rover, kept) in self.rovers.iter_mut().zip(&kept) {
                rover.go_back(kept);
            }
            self.ties.clone_from(&ties);
            self.missed = false;
            self.census.returns += 1;
        }
        self.run_parts(stiffest);
    }

    /// Takes the parts that cannot meet before the end of the window there, each on its own; whether some may have met
    /// after all.
    fn run_parts(&mut self, stiffest: f64) -> bool {
        let dt = self.end_s - self.now_s;
        let places = self.places(dt);
        let mut meetings = self.meetings(&places, (dt, stiffest));
        let (course, now_s) = (self.course, self.now_s);
        let before: Vec<(Vec3, f64)> =
            self.rovers.iter_mut().map(|rover| rover.watch_from(course, now_s)).collect();
        let mut homes: Vec<Option<Box<Rover>>> = Vec::new();
        let mut jobs = self.take_apart(&mut meetings, &mut homes);
        jobs.par_iter_mut().for_each(Job::run);
        self.join(jobs, homes);
        let after = |k: usize| {
            let rover = &self.rovers[k];
            (rover.position_at(self.course, self.end_s), rover.off.1)
        };
        // Pairs without a tie are looked at by the island that this one is a part of.
        let thrown = meetings
            .missed(&places, dt, after, |_| self.ties.iter().map(|tie| (tie.a, tie.b)).collect());
        for &k in &thrown {
            self.rovers[k].foresee();
        }
        for (rover, before) in self.rovers.iter_mut().zip(before) {
            rover.watch_on(before);
        }
        self.missed |= !thrown.is_empty();
        self.missed
    }
}

impl<'a> Job<'a> {
    /// Makes a job of every part in which something may happen; the other rocks stay in `homes`, and ties between parts
    /// with the island.
    fn take_apart(
        &mut self,
        meetings: &mut Meetings,
        homes: &mut Vec<Option<Box<Rover<'a>>>>,
    ) -> Vec<Self> {
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
        homes.extend(self.rovers.drain(..).map(Some));
        let window = (self.now_s, self.end_s);
        let mut jobs = Vec::with_capacity(lists.len());
        for (list, ties) in lists.into_iter().zip(ties) {
            let rovers = list.iter().filter_map(|&k| homes[k as usize].take()).collect();
            let part = Self::new(self.course, list, rovers, ties, window);
            jobs.push(Self { goes_back: false, ..part });
        }
        jobs
    }

    /// Takes the parts and their rocks back.
    fn join(&mut self, jobs: Vec<Self>, mut homes: Vec<Option<Box<Rover<'a>>>>) {
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
    }
}

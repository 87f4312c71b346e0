//! All rocks of a world, and the windows of time they go through.
//!
//! Rocks of a world meet each other seldom. Time is cut into windows so short that the fastest rock moves a tenth of
//! its radius; in each window rocks that may meet form islands, which are computed apart from each other and in
//! parallel. The prediction of who may meet whom assumes a bound on how far a rock is thrown by what it hits. Where a
//! rock was thrown farther, the world goes back to the snapshot before and takes the larger bound: the result does
//! not depend on the guess, only the run time does.

use super::cached_pairs::CachedPairs;
use super::prediction::{
    Meetings, PredictedRock, is_busy, meetings_in_passing, meetings_of_islands, place_of, places_in,
};
use super::window::IslandWindow;
use super::{BodyState, PairMaterial, TOUCHING, WorldBody, WorldStats, law_between};
use crate::contact::pair::PairHistory;
use crate::ground::{Capture, Damping, Ground, Law};
use crate::simulation::settings::RunSettings;
use crate::solver::impact::BlowTable;
use crate::solver::island::broad_phase::{Ball, overlapping};
use crate::solver::island::{RigidIsland, TRAVEL, blows_of};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Way of the fastest rock in one window, relative to its radius (–): the islands stay small.
///
/// A rock cannot cross another one unseen: two that fly at each other close a fifth of a radius a
/// window.
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
/// The same in the rigid limit, where a window costs much and a snapshot little.
const WINDOWS_RIGID: usize = 8;

/// All rocks of a world.
pub(super) struct BodyWorld<'a> {
    /// Scheme, terrain, recorders and limits, the same for all rocks.
    pub(super) settings: &'a RunSettings<'a>,
    /// The same for heaps that go on in the rigid limit, if they do.
    pub(super) heaps: Option<&'a RunSettings<'a>>,
    /// What contacts between two rocks are made of: springs, friction, and the damping of their restitution.
    answer: (Ground, Damping),
    /// Impacts slower than this rule says do not rebound.
    capture: Capture,
    /// The rocks by number; `None` while an island computes them.
    pub(super) bodies: Vec<Option<Box<WorldBody<'a>>>>,
    /// Contacts and bonds, in the order of the numbers of their rocks.
    pub(super) pair_histories: Vec<PairHistory>,
    /// Who was near whom when that was asked last.
    wide: CachedPairs,
    /// Start of the next window (s).
    pub(super) now_s: f64,
    /// What the world has cost so far, counted.
    pub(super) statistics: WorldStats,
    /// Blows between two of its rocks, in the rigid limit.
    blows: Option<Arc<BlowTable>>,
    /// Work space of islands: the first island is given what the first had before.
    spare: Vec<RigidIsland>,
}

impl<'a> BodyWorld<'a> {
    /// A world at time 0, with no contacts and no bonds.
    pub(super) fn new(
        (settings, heaps): (&'a RunSettings<'a>, Option<&'a RunSettings<'a>>),
        answer: &PairMaterial,
        bodies: Vec<Option<Box<WorldBody<'a>>>>,
    ) -> Self {
        let mut world = Self {
            settings,
            heaps,
            answer: (answer.ground, Damping::of(answer.ground.restitution)),
            capture: settings.capture(None),
            bodies,
            pair_histories: Vec::new(),
            wide: CachedPairs::default(),
            now_s: 0.0,
            statistics: WorldStats::default(),
            blows: None,
            spare: Vec::new(),
        };
        if (world.is_rigid() || heaps.is_some()) && world.bodies.len() > 1 {
            let [a, b] = [0, 1].map(|k| &world.body(k).member.body);
            world.blows = blows_of(&world.law(0, 1), [a, b]).map(Arc::new);
        }
        world
    }

    /// Rock `k`.
    #[expect(clippy::expect_used, reason = "bodies are away only while their island is computed")]
    pub(super) fn body(&self, k: u32) -> &WorldBody<'a> {
        self.bodies[k as usize].as_ref().expect("a body is at home between windows")
    }

    /// Whether contacts have no springs: the limit of infinite stiffness.
    pub(super) fn is_rigid(&self) -> bool {
        !self.settings.step.scheme.has_springs()
    }

    /// The contact law of two rocks: two springs in series on their reduced mass `m_a m_b/(m_a + m_b)`.
    pub(super) fn law(&self, a: u32, b: u32) -> Law {
        let [a, b] = [a, b].map(|k| &self.body(k).member.body);
        law_between(a, b, &self.answer, &self.capture)
    }

    /// Adds a pair, at its place in the order of numbers: a binary search in O(log n), a shift in O(n).
    pub(super) fn tie(&mut self, pair_history: &PairHistory) {
        let place = self
            .pair_histories
            .partition_point(|known| (known.a, known.b) < (pair_history.a, pair_history.b));
        self.pair_histories.insert(place, *pair_history);
    }

    /// A bonded rock does not fly: its contacts begin with the world.
    pub(super) fn hold(&mut self, k: u32) {
        let settings = self.settings;
        if let Some(body) = self.bodies[k as usize].as_mut().filter(|body| body.member.flying) {
            body.land(settings);
        }
    }

    /// Pairs that touch as far as typed coordinates can say.
    pub(super) fn touching_at_start(&self) -> Vec<(u32, u32)> {
        let ball = |body: &WorldBody| Ball {
            centre: body.member.state.c,
            radius: body.member.body.radius * (1.0 + TOUCHING),
        };
        overlapping(&self.bodies.iter().flatten().map(|body| ball(body)).collect::<Vec<_>>())
    }

    /// Goes through windows until nothing moves or time is up; false if `stop` was raised. After each window `see` is told
    /// the time (s) and the counts so far; where the world goes back, so does the time.
    pub(super) fn run(&mut self, stop: &AtomicBool, mut see: impl FnMut(f64, &WorldStats)) -> bool {
        while self.is_under_way() {
            let snapshot = self.snapshot();
            for tried in 0..=RETURNS {
                let Some(missed) = self.windows(stop, &mut see) else { return false };
                if !missed || tried == RETURNS {
                    break;
                }
                self.go_back(&snapshot);
                self.statistics.returns += 1;
            }
            self.bodies.iter_mut().flatten().for_each(|body| body.foreseen_m_s = 0.0);
        }
        true
    }

    /// Whether a rock still moves and time is left.
    fn is_under_way(&self) -> bool {
        let mut bodies = self.bodies.iter().flatten();
        self.now_s < self.settings.longest_s && bodies.any(|body| body.state == BodyState::Moving)
    }

    /// Goes through the next windows, up to one in which a rock may have met one that it was not compared with; whether
    /// there was such a one, `None` if `stop` was raised.
    fn windows(
        &mut self,
        stop: &AtomicBool,
        see: &mut impl FnMut(f64, &WorldStats),
    ) -> Option<bool> {
        // the flag is read between windows only: an island that has begun is finished
        for _ in 0..if self.is_rigid() { WINDOWS_RIGID } else { WINDOWS } {
            if !self.is_under_way() {
                break;
            }
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let missed = self.window();
            see(self.now_s, &self.statistics);
            if missed {
                return Some(true);
            }
        }
        Some(false)
    }

    /// One window: islands, each on its own. Whether a rock was deviated further than was allowed for and may have met
    /// one of another island.
    fn window(&mut self) -> bool {
        let length = self.window_length();
        // the last window ends with the time limit of the scene
        let end_s = (self.now_s + length).min(self.settings.longest_s);
        // what each does from here on is measured against its flight
        let (settings, now_s) = (self.settings, self.now_s);
        self.bodies.iter_mut().flatten().for_each(|body| {
            body.watch_from(settings, now_s);
        });
        let present: Vec<u32> = self.present();
        let dt = end_s - self.now_s;
        let place = |&k: &u32| place_of(self.body(k), self.settings, (self.now_s, dt));
        let places: Vec<PredictedRock> = present.iter().map(place).collect();
        let mut wide = std::mem::take(&mut self.wide);
        // broad phase: pairs whose swept balls overlap, O(n log n) in the number of rocks
        let mut meetings = self.meetings(&mut wide, &present, &places, dt);
        self.wide = wide;
        let jobs = self.jobs(&present, &mut meetings, end_s);
        let done: Vec<IslandWindow> = jobs
            // the order of the results is that of the jobs, not of the threads: sums come out with the same bits
            .into_par_iter()
            .map(|mut job| {
                job.run();
                job
            })
            .collect();
        let mut missed = false;
        // what was not lent stays
        self.pair_histories.retain(|pair_history| pair_history.a != pair_history.b);
        for job in done.into_iter().rev() {
            missed |= job.missed;
            self.statistics.add(&job.statistics);
            self.take_back(job);
        }
        // islands give back in any order of pairs; the order of numbers makes the next window independent of it
        // (each rises by itself, and a stable sort merges what rises)
        self.pair_histories.sort_by_key(|pair_history| (pair_history.a, pair_history.b));
        self.now_s = end_s;
        self.statistics.windows += 1;
        // where each rock really came to, and by how much its velocity changed on the way
        let after = |k: usize| {
            let body = self.body(present[k]);
            (body.position_at(self.settings, end_s), body.off.1)
        };
        // rocks that left the tube in which they were looked for, checked against all others at their true places
        let deviated = meetings.missed(&places, dt, after, |deviation_m| {
            overlapping(
                &places
                    .iter()
                    .zip(deviation_m)
                    .map(|(p, off)| p.swept(*off, dt))
                    .collect::<Vec<_>>(),
            )
        });
        for &k in &deviated {
            if let Some(body) = &mut self.bodies[present[k] as usize] {
                body.foresee();
            }
        }
        missed || !deviated.is_empty()
    }

    /// The rocks that are in the world, asleep or moving; the lists of a window count places among these.
    fn present(&self) -> Vec<u32> {
        let count = self.bodies.len() as u32;
        (0..count).filter(|&k| !matches!(self.body(k).state, BodyState::Gone(_))).collect()
    }

    /// Length of the next window (s): the way of the fastest rock over its radius, between two bounds.
    fn window_length(&self) -> f64 {
        // 1e-9 m/s keeps a rock that stands still from dividing by nothing; the longest window decides then
        let mut length = LONGEST_S;
        // In the rigid limit nothing happens between the steps: a window is one.
        let way = if self.is_rigid() { TRAVEL } else { WAY };
        // way R/|v|: the window of the smallest fast rock is that of all
        for body in self.bodies.iter().flatten().filter(|body| body.state == BodyState::Moving) {
            let speed = body.velocity_at(self.settings, self.now_s).norm();
            length = length.min(way * body.member.body.radius / speed.max(1e-9));
        }
        length.max(SHORTEST_S)
    }

    /// Who may meet whom; numbers are places in `present`.
    fn meetings(
        &self,
        wide: &mut CachedPairs,
        present: &[u32],
        places: &[PredictedRock],
        dt: f64,
    ) -> Meetings {
        // held and bonded pairs stay together in one island however small the window
        let at = |k: u32| present.binary_search(&k).unwrap_or_default() as u32;
        let held: Vec<(u32, u32)> = self
            .pair_histories
            .iter()
            .map(|pair_history| (at(pair_history.a), at(pair_history.b)))
            .collect();
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
    /// Rocks are moved, not copied; what stays behind is the empty place.
    fn jobs(
        &mut self,
        present: &[u32],
        meetings: &mut Meetings,
        end_s: f64,
    ) -> Vec<IslandWindow<'a>> {
        // an island in which nothing moves, lands or meets is left as it is: its rocks sleep or fly through
        let mut lists = meetings.islands.lists();
        lists.retain(|list| is_busy(list.iter().map(|&k| self.body(present[k as usize])), end_s));
        let part = places_in(&lists, present.len());
        let mut counts = vec![0; lists.len()];
        for &(a, _) in &meetings.pairs {
            if let Some(count) = counts.get_mut(part[a as usize].0) {
                *count += 1;
            }
        }
        let mut pair_histories: Vec<Vec<PairHistory>> =
            counts.into_iter().map(Vec::with_capacity).collect();
        // both lists of pairs rise: one pass over both finds what is known of each pair
        let mut known = 0;
        for &(a, b) in &meetings.pairs {
            let (number, place) = part[a as usize];
            if number == usize::MAX {
                continue;
            }
            let [one, two] = [a, b].map(|k| present[k as usize]);
            let before = |pair_history: &PairHistory| (pair_history.a, pair_history.b) < (one, two);
            while self.pair_histories.get(known).is_some_and(before) {
                known += 1;
            }
            let lent = self
                .pair_histories
                .get_mut(known)
                .filter(|pair_history| (pair_history.a, pair_history.b) == (one, two));
            let pair_history = if let Some(pair_history) = lent {
                // the place of a pair that is lent: both ends one rock
                let stays = PairHistory { b: pair_history.a, ..*pair_history };
                std::mem::replace(pair_history, stays)
            } else {
                PairHistory::new(one, two, self.law(one, two))
            };
            // the ends of a lent pair keep the order of the list
            known += usize::from(
                self.pair_histories
                    .get(known)
                    .is_some_and(|pair_history| pair_history.a == pair_history.b),
            );
            pair_histories[number].push(PairHistory {
                a: place,
                b: part[b as usize].1,
                ..pair_history
            });
        }
        let mut jobs = Vec::with_capacity(lists.len());
        for (list, pair_histories) in lists.into_iter().zip(pair_histories) {
            // rocks move by pointer into the island: nothing is copied
            let ids: Vec<u32> = list.iter().map(|&k| present[k as usize]).collect();
            let settings = self.settings_of(&ids, &pair_histories);
            let bodies = ids.iter().filter_map(|&k| self.bodies[k as usize].take()).collect();
            let times_s = (self.now_s, end_s);
            let mut job = IslandWindow::new(settings, ids, bodies, pair_histories, times_s);
            job.rigid =
                self.spare.pop().unwrap_or_else(|| RigidIsland::of_material(self.blows.clone()));
            jobs.push(job);
        }
        jobs
    }

    /// Puts rocks and held pairs of an island back; pairs that have let go, and those of rocks that left, are
    /// forgotten.
    fn take_back(&mut self, mut job: IslandWindow<'a>) {
        self.spare.push(std::mem::take(&mut job.rigid));
        let (ids, bodies, pair_histories) = job.into_parts();
        for pair_history in pair_histories.into_iter().filter(PairHistory::is_held) {
            let (a, b) = (ids[pair_history.a as usize], ids[pair_history.b as usize]);
            let gone = |k: u32| matches!(bodies[k as usize].state, BodyState::Gone(_));
            if !gone(pair_history.a) && !gone(pair_history.b) {
                self.pair_histories.push(PairHistory { a, b, ..pair_history });
            }
        }
        for (&k, body) in ids.iter().zip(bodies) {
            self.bodies[k as usize] = Some(body);
        }
    }
}

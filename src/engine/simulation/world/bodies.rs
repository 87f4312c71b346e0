//! All rocks of a world, and the windows of time through which they are advanced.
//!
//! Collisions between rocks are rare. Time is divided into windows so short that the fastest rock
//! moves a tenth of its radius. In each window, rocks that may meet form islands, which are
//! computed separately and in parallel. The prediction of who may meet whom assumes a bound on the
//! velocity change of a rock by a collision. Where a rock exceeded the bound, the world returns to
//! the last snapshot and uses a larger bound: the guess decides the computing time, never the
//! result.

use super::cached_pairs::CachedPairs;
use super::prediction::{
    ContactCandidates, PredictedRock, candidates_on_straight_paths, candidates_within_islands,
    is_busy, island_of_each, predicted_rock,
};
use super::window::IslandWindow;
use super::{BodyState, PairMaterial, TOUCH_TOLERANCE, WorldBody, WorldStats, law_between};
use crate::contact::pair::PairHistory;
use crate::ground::{Capture, Damping, Ground, Law};
use crate::simulation::settings::RunSettings;
use crate::solver::impact::BlowTable;
use crate::solver::island::broad_phase::{Ball, overlapping};
use crate::solver::island::{RigidIsland, TRAVEL, blows_of};
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Distance of the fastest rock in one window, relative to its radius (–): the islands stay small.
///
/// A rock cannot cross another one undetected: two that fly at each other approach by a fifth of a
/// radius per window.
const WINDOW_TRAVEL: f64 = 0.1;
/// Longest window (s).
const LONGEST_WINDOW_S: f64 = 0.02;
/// Shortest window (s): one very small and fast rock must not stop the world.
const SHORTEST_WINDOW_S: f64 = 1e-5;
/// Number of times that the world returns to one snapshot, each time with twice the velocity
/// change: enough for a rock of a billionth of the mass along ten ever heavier ones.
const MAX_WORLD_RETURNS: usize = 16;
/// Number of windows between two snapshots.
const WINDOWS_PER_SNAPSHOT: usize = 64;
/// The same in the rigid limit, where a window costs much and a snapshot little.
const WINDOWS_PER_SNAPSHOT_RIGID: usize = 8;

/// All rocks of a world.
pub(super) struct BodyWorld<'a> {
    /// Scheme, terrain, recorders and limits, the same for all rocks.
    pub(super) settings: &'a RunSettings<'a>,
    /// The same for heaps that are computed in the rigid limit, if any are.
    pub(super) heaps: Option<&'a RunSettings<'a>>,
    /// Material of contacts between two rocks, and the damping of its restitution.
    pair_ground: (Ground, Damping),
    /// Rule of the capture speed: slower impacts do not rebound.
    capture: Capture,
    /// The rocks by number; `None` while an island computes them.
    pub(super) bodies: Vec<Option<Box<WorldBody<'a>>>>,
    /// Contacts and bonds, in the order of the numbers of their rocks.
    pub(super) pair_histories: Vec<PairHistory>,
    /// Neighbour list of the last search.
    cached_pairs: CachedPairs,
    /// Start of the next window (s).
    pub(super) now_s: f64,
    /// Cost of the world so far, in counts.
    pub(super) statistics: WorldStats,
    /// Table of impacts between two of its rocks, in the rigid limit.
    blows: Option<Arc<BlowTable>>,
    /// Work space of islands that is reused: the first island gets that of the first before.
    spare_workspaces: Vec<RigidIsland>,
}

impl<'a> BodyWorld<'a> {
    /// A world at time 0, with no contacts and no bonds.
    pub(super) fn new(
        (settings, heaps): (&'a RunSettings<'a>, Option<&'a RunSettings<'a>>),
        material: &PairMaterial,
        bodies: Vec<Option<Box<WorldBody<'a>>>>,
    ) -> Self {
        let mut world = Self {
            settings,
            heaps,
            pair_ground: (material.ground, Damping::of(material.ground.restitution)),
            capture: settings.capture(None),
            bodies,
            pair_histories: Vec::new(),
            cached_pairs: CachedPairs::default(),
            now_s: 0.0,
            statistics: WorldStats::default(),
            blows: None,
            spare_workspaces: Vec::new(),
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

    /// The contact law of two rocks: springs in series on the reduced mass `m_a m_b/(m_a + m_b)`.
    pub(super) fn law(&self, a: u32, b: u32) -> Law {
        let [a, b] = [a, b].map(|k| &self.body(k).member.body);
        law_between(a, b, &self.pair_ground, &self.capture)
    }

    /// Adds a pair in the order of numbers: a binary search in O(log n), a shift in O(n).
    pub(super) fn add_pair(&mut self, pair: &PairHistory) {
        let place =
            self.pair_histories.partition_point(|known| (known.a, known.b) < (pair.a, pair.b));
        self.pair_histories.insert(place, *pair);
    }

    /// Begins contact of a bonded rock: it does not fly, its contacts begin with the world.
    pub(super) fn begin_contact_of(&mut self, k: u32) {
        let settings = self.settings;
        if let Some(body) = self.bodies[k as usize].as_mut().filter(|body| body.member.flying) {
            body.land(settings);
        }
    }

    /// Pairs of rocks that touch, to the accuracy of typed coordinates.
    pub(super) fn touching_at_start(&self) -> Vec<(u32, u32)> {
        let ball = |body: &WorldBody| Ball {
            centre: body.member.state.c,
            radius: body.member.body.radius * (1.0 + TOUCH_TOLERANCE),
        };
        overlapping(&self.bodies.iter().flatten().map(|body| ball(body)).collect::<Vec<_>>())
    }

    /// Advances through windows until nothing moves or time is up; false if `stop` was raised.
    /// After each window `observe` is called with the time (s) and the counts so far; where the
    /// world returns to a snapshot, so does the time.
    pub(super) fn run(
        &mut self,
        stop: &AtomicBool,
        mut observe: impl FnMut(f64, &WorldStats),
    ) -> bool {
        while self.is_under_way() {
            let snapshot = self.snapshot();
            for tried in 0..=MAX_WORLD_RETURNS {
                let Some(missed) = self.run_windows(stop, &mut observe) else { return false };
                if !missed || tried == MAX_WORLD_RETURNS {
                    break;
                }
                self.restore(&snapshot);
                self.statistics.returns += 1;
            }
            self.bodies.iter_mut().flatten().for_each(|body| body.predicted_dv_m_s = 0.0);
        }
        true
    }

    /// Whether a rock still moves and time is left.
    fn is_under_way(&self) -> bool {
        let mut bodies = self.bodies.iter().flatten();
        self.now_s < self.settings.longest_s && bodies.any(|body| body.state == BodyState::Moving)
    }

    /// Advances through the next windows, up to the first in which a rock may have met one that was
    /// not predicted. Returns whether there was such a window; `None` if `stop` was raised.
    fn run_windows(
        &mut self,
        stop: &AtomicBool,
        observe: &mut impl FnMut(f64, &WorldStats),
    ) -> Option<bool> {
        // the flag is read between windows only: a window that has begun is completed
        for _ in 0..if self.is_rigid() { WINDOWS_PER_SNAPSHOT_RIGID } else { WINDOWS_PER_SNAPSHOT }
        {
            if !self.is_under_way() {
                break;
            }
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let missed = self.run_window();
            observe(self.now_s, &self.statistics);
            if missed {
                return Some(true);
            }
        }
        Some(false)
    }

    /// Advances one window, each island separately. Returns whether a rock deviated further than
    /// was allowed for and may have met one of another island.
    fn run_window(&mut self) -> bool {
        let length = self.window_length();
        // the last window ends with the time limit of the scene
        let end_s = (self.now_s + length).min(self.settings.longest_s);
        // from here on the deviation of each rock is measured from its flight
        let (settings, now_s) = (self.settings, self.now_s);
        self.bodies.iter_mut().flatten().for_each(|body| {
            body.start_deviation(settings, now_s);
        });
        let present: Vec<u32> = self.present();
        let dt = end_s - self.now_s;
        let predict = |&k: &u32| predicted_rock(self.body(k), self.settings, (self.now_s, dt));
        let rocks: Vec<PredictedRock> = present.iter().map(predict).collect();
        let mut cached_pairs = std::mem::take(&mut self.cached_pairs);
        // broad phase: pairs whose swept spheres overlap, O(n log n) in the number of rocks
        let mut candidates = self.candidates(&mut cached_pairs, &present, &rocks, dt);
        self.cached_pairs = cached_pairs;
        let islands = self.lend_islands(&present, &mut candidates, end_s);
        let done: Vec<IslandWindow> = islands
            // results have the order of the islands, not of the threads: sums come out with the
            // same bits
            .into_par_iter()
            .map(|mut island| {
                island.run();
                island
            })
            .collect();
        let mut missed = false;
        // pairs that were not lent stay
        self.pair_histories.retain(|pair| pair.a != pair.b);
        for island in done.into_iter().rev() {
            missed |= island.missed;
            self.statistics.add(&island.statistics);
            self.take_back(island);
        }
        // islands return pairs in any order; ordering by number makes the next window independent
        // of it (each list rises by itself, and a stable sort merges rising lists)
        self.pair_histories.sort_by_key(|pair| (pair.a, pair.b));
        self.now_s = end_s;
        self.statistics.windows += 1;
        // true position of each rock, and the largest change of its velocity on the way
        let after = |k: usize| {
            let body = self.body(present[k]);
            (body.position_at(self.settings, end_s), body.deviation.1)
        };
        // rocks that left their predicted swept volume are checked against all others at their true
        // positions
        let deviated = candidates.missed(&rocks, dt, after, |deviation_m| {
            overlapping(
                &rocks
                    .iter()
                    .zip(deviation_m)
                    .map(|(rock, deviation_m)| rock.swept(*deviation_m, dt))
                    .collect::<Vec<_>>(),
            )
        });
        for &k in &deviated {
            if let Some(body) = &mut self.bodies[present[k] as usize] {
                body.raise_predicted_dv();
            }
        }
        missed || !deviated.is_empty()
    }

    /// The rocks that are in the world, asleep or moving; the lists of a window use indices into
    /// this list.
    fn present(&self) -> Vec<u32> {
        let count = self.bodies.len() as u32;
        (0..count).filter(|&k| !matches!(self.body(k).state, BodyState::Removed(_))).collect()
    }

    /// Length of the next window (s), such that the fastest rock relative to its radius moves a
    /// given fraction of it, between two bounds.
    fn window_length(&self) -> f64 {
        // 1e-9 m/s avoids a division by zero; the longest window decides then
        let mut length = LONGEST_WINDOW_S;
        // In the rigid limit nothing happens between the steps: a window is one step.
        let travel = if self.is_rigid() { TRAVEL } else { WINDOW_TRAVEL };
        // travel R/|v|: the smallest fast rock decides the window of all
        for body in self.bodies.iter().flatten().filter(|body| body.state == BodyState::Moving) {
            let speed = body.velocity_at(self.settings, self.now_s).norm();
            length = length.min(travel * body.member.body.radius / speed.max(1e-9));
        }
        length.max(SHORTEST_WINDOW_S)
    }

    /// Predicts who may meet whom; numbers are indices into `present`.
    fn candidates(
        &self,
        cached_pairs: &mut CachedPairs,
        present: &[u32],
        rocks: &[PredictedRock],
        dt: f64,
    ) -> ContactCandidates {
        // held and bonded pairs stay in one island, however short the window
        let at = |k: u32| present.binary_search(&k).unwrap_or_default() as u32;
        let held: Vec<(u32, u32)> =
            self.pair_histories.iter().map(|pair| (at(pair.a), at(pair.b))).collect();
        if self.is_rigid() {
            return candidates_on_straight_paths(rocks, dt, &held, |reaches| {
                cached_pairs.overlapping(rocks, reaches)
            });
        }
        candidates_within_islands(rocks, dt, |reaches| {
            let mut pairs = cached_pairs.overlapping(rocks, reaches);
            if !held.is_empty() {
                pairs.extend(&held);
                pairs.sort_unstable();
                pairs.dedup();
            }
            pairs
        })
    }

    /// Takes every island in which something may happen before `end_s` out of the world. Rocks are
    /// moved, not copied; an empty slot stays behind.
    fn lend_islands(
        &mut self,
        present: &[u32],
        candidates: &mut ContactCandidates,
        end_s: f64,
    ) -> Vec<IslandWindow<'a>> {
        // an island in which nothing moves, lands or meets is left as it is: its rocks sleep or fly
        // on
        let mut lists = candidates.islands.lists();
        lists.retain(|list| is_busy(list.iter().map(|&k| self.body(present[k as usize])), end_s));
        let membership = island_of_each(&lists, present.len());
        let mut counts = vec![0; lists.len()];
        for &(a, _) in &candidates.pairs {
            if let Some(count) = counts.get_mut(membership[a as usize].0) {
                *count += 1;
            }
        }
        let mut pair_histories: Vec<Vec<PairHistory>> =
            counts.into_iter().map(Vec::with_capacity).collect();
        // both lists of pairs rise: one pass over both finds the history of each pair
        let mut known = 0;
        for &(a, b) in &candidates.pairs {
            let (number, place) = membership[a as usize];
            if number == usize::MAX {
                continue;
            }
            let [id_a, id_b] = [a, b].map(|k| present[k as usize]);
            let before = |pair: &PairHistory| (pair.a, pair.b) < (id_a, id_b);
            while self.pair_histories.get(known).is_some_and(before) {
                known += 1;
            }
            let lent =
                self.pair_histories.get_mut(known).filter(|pair| (pair.a, pair.b) == (id_a, id_b));
            let pair = if let Some(pair) = lent {
                // marks the slot of a lent pair: both ends are the same rock
                let stays = PairHistory { b: pair.a, ..*pair };
                std::mem::replace(pair, stays)
            } else {
                PairHistory::new(id_a, id_b, self.law(id_a, id_b))
            };
            // the marked slot keeps the order of the list
            known +=
                usize::from(self.pair_histories.get(known).is_some_and(|pair| pair.a == pair.b));
            pair_histories[number].push(PairHistory {
                a: place,
                b: membership[b as usize].1,
                ..pair
            });
        }
        let mut islands = Vec::with_capacity(lists.len());
        for (list, pair_histories) in lists.into_iter().zip(pair_histories) {
            // rocks move by pointer into the island: nothing is copied
            let ids: Vec<u32> = list.iter().map(|&k| present[k as usize]).collect();
            let settings = self.settings_of(&ids, &pair_histories);
            let bodies = ids.iter().filter_map(|&k| self.bodies[k as usize].take()).collect();
            let times_s = (self.now_s, end_s);
            let mut island = IslandWindow::new(settings, ids, bodies, pair_histories, times_s);
            island.rigid = self
                .spare_workspaces
                .pop()
                .unwrap_or_else(|| RigidIsland::of_material(self.blows.clone()));
            islands.push(island);
        }
        islands
    }

    /// Returns rocks and held pairs of an island to the world. Pairs that have opened, and those of
    /// removed rocks, are discarded.
    fn take_back(&mut self, mut island: IslandWindow<'a>) {
        self.spare_workspaces.push(std::mem::take(&mut island.rigid));
        let (ids, bodies, pair_histories) = island.into_parts();
        for pair in pair_histories.into_iter().filter(PairHistory::is_held) {
            let (a, b) = (ids[pair.a as usize], ids[pair.b as usize]);
            let gone = |k: u32| matches!(bodies[k as usize].state, BodyState::Removed(_));
            if !gone(pair.a) && !gone(pair.b) {
                self.pair_histories.push(PairHistory { a, b, ..pair });
            }
        }
        for (&k, body) in ids.iter().zip(bodies) {
            self.bodies[k as usize] = Some(body);
        }
    }
}

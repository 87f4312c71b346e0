//! Subdivision of an island: if most of its rocks do not meet in a much shorter window, each part
//! is advanced through that window separately.
//!
//! A window of the world is as long as the distance of the fastest rock allows. Inside a heap an
//! impact travels through many rocks in that time, so the prediction joins all of the heap. In a
//! window of about a radian of the stiffest contact an impact reaches only the next rocks, and a
//! loose heap separates into parts. Parts are cheap: the cost of an island's step grows faster than
//! its number of rocks.

use super::WorldBody;
use super::prediction::{
    ContactCandidates, HitSpread, PredictedRock, PredictionWindow, candidates_among_pairs, is_busy,
    island_of_each, predicted_rock,
};
use super::snapshot::BodySnapshot;
use super::window::IslandWindow;
use crate::contact::pair::PairHistory;
use crate::rock::Vec3;
use rayon::prelude::*;

/// An island of no more rocks than this is stepped as a whole: subdivision costs a search and
/// copies, and saves nothing below this.
const SMALL_ISLAND: usize = 4;
/// Smallest number of shorter windows into which a window is cut, and the factor to the next
/// number.
const CUT_FACTOR: u32 = 4;
/// Shortest window, in radians of the stiffest contact (–): less than a step of a quiet heap. The
/// radians of a contact are `ω t` with `ω = √(p_N/m)`: a spring reverses an impact in π of them.
const SHORTEST_CUT_RAD: f64 = 1.5;
/// Longest window in which an impact is transmitted to the next few rocks only, in radians of the
/// stiffest contact (–).
const NEIGHBOUR_SPREAD_RAD: f64 = 12.0;
/// Number of times that an island repeats a window in which a rock deviated further than was
/// allowed for, before that is left to the world.
const MAX_ISLAND_RETURNS: usize = 6;

impl IslandWindow<'_> {
    /// Advances the island to the end of its window.
    ///
    /// In the order of cost: all fly and nothing happens; a rigid heap; parts that do not meet; all
    /// together.
    pub(super) fn run(&mut self) {
        self.load_or_unload();
        if self.is_rigid_heap() {
            self.run_rigid();
            return;
        }
        if self.flies_through() {
            return;
        }
        // the contact between rocks with the highest frequency; contacts with the mesh join no
        // rocks
        let stiffest =
            self.pair_histories.iter().map(|pair| pair.law.omega_rad_s()).fold(0.0, f64::max);
        let Some(cuts) = self.useful_cuts(stiffest) else {
            self.run_whole();
            return;
        };
        // `end_s` moves from cut to cut, so that no part is advanced beyond its cut
        let (start_s, end_s) = (self.now_s, self.end_s);
        for k in 1..=cuts {
            let part = f64::from(k) / f64::from(cuts);
            self.end_s = if k == cuts { end_s } else { start_s + part * (end_s - start_s) };
            if self.may_repeat {
                self.run_parts_with_repeats(stiffest);
            } else {
                self.run_parts(stiffest);
            }
            self.now_s = self.end_s;
        }
    }

    /// Whether all rocks of the island fly and neither collide nor land before the end of its
    /// window.
    fn flies_through(&self) -> bool {
        self.bodies.iter().all(|body| body.flies_beyond(self.end_s))
            && self.next_event_s() > self.end_s
    }

    /// Number of shorter windows in which most of the island's rocks are not joined, so that these
    /// are cheaper than stepping all together.
    ///
    /// Tries few cuts first: the result is the first number for which no part is larger than three
    /// quarters of the island.
    fn useful_cuts(&self, stiffest: f64) -> Option<u32> {
        let (count, length) = (self.bodies.len(), self.end_s - self.now_s);
        let mut cuts = CUT_FACTOR;
        while count > SMALL_ISLAND && length / f64::from(cuts) * stiffest >= SHORTEST_CUT_RAD {
            let dt = length / f64::from(cuts);
            let mut candidates = self.candidates(&self.predicted_rocks(dt), (dt, stiffest));
            let largest = candidates.islands.sizes().into_iter().max().unwrap_or(0);
            if 4 * largest <= 3 * count {
                return Some(cuts);
            }
            cuts *= CUT_FACTOR;
        }
        None
    }

    /// State of its rocks, and bounds of their motion within `dt` (s).
    fn predicted_rocks(&self, dt: f64) -> Vec<PredictedRock> {
        let predict = |body: &WorldBody| predicted_rock(body, self.settings, (self.now_s, dt));
        self.bodies.iter().map(|body| predict(body)).collect()
    }

    /// Predicts who may meet whom within `dt` (s).
    fn candidates(&self, rocks: &[PredictedRock], (dt, stiffest): (f64, f64)) -> ContactCandidates {
        let spread = if dt * stiffest > NEIGHBOUR_SPREAD_RAD {
            HitSpread::Island
        } else {
            HitSpread::Neighbours
        };
        candidates_among_pairs(&self.pair_histories, rocks, PredictionWindow { dt, spread })
    }

    /// Advances the parts, and repeats that if a rock deviated further than was allowed for.
    ///
    /// As the world does with its windows (`bodies`), on a smaller scale: a return here costs this
    /// island alone.
    fn run_parts_with_repeats(&mut self, stiffest: f64) {
        // as the world takes a snapshot before its windows
        let snapshots: Vec<BodySnapshot> = self.bodies.iter().map(|body| body.snapshot()).collect();
        let pair_histories = self.pair_histories.clone();
        for _ in 0..MAX_ISLAND_RETURNS {
            if !self.run_parts(stiffest) {
                return;
            }
            for (body, snapshot) in self.bodies.iter_mut().zip(&snapshots) {
                body.restore(snapshot);
            }
            self.pair_histories.clone_from(&pair_histories);
            self.missed = false;
            self.statistics.returns += 1;
        }
        self.run_parts(stiffest);
    }

    /// Advances the parts that cannot meet to the end of the window, each separately; returns
    /// whether some may have met after all.
    fn run_parts(&mut self, stiffest: f64) -> bool {
        let dt = self.end_s - self.now_s;
        let rocks = self.predicted_rocks(dt);
        let mut candidates = self.candidates(&rocks, (dt, stiffest));
        let (settings, now_s) = (self.settings, self.now_s);
        let before: Vec<(Vec3, f64)> =
            self.bodies.iter_mut().map(|body| body.start_deviation(settings, now_s)).collect();
        let mut slots: Vec<Option<Box<WorldBody>>> = Vec::new();
        let mut islands = self.split(&mut candidates, &mut slots);
        islands.par_iter_mut().for_each(IslandWindow::run);
        self.merge(islands, slots);
        let after = |k: usize| {
            let body = &self.bodies[k];
            (body.position_at(self.settings, self.end_s), body.deviation.1)
        };
        // Pairs without a history are checked by the island of which this one is a part.
        let deviated = candidates.missed(&rocks, dt, after, |_| {
            self.pair_histories.iter().map(|pair| (pair.a, pair.b)).collect()
        });
        for &k in &deviated {
            self.bodies[k].raise_predicted_dv();
        }
        for (body, before) in self.bodies.iter_mut().zip(before) {
            body.resume_deviation(before);
        }
        self.missed |= !deviated.is_empty();
        self.missed
    }
}

impl<'a> IslandWindow<'a> {
    /// Makes a window of every part in which something may happen. The other rocks stay in `slots`,
    /// and pairs between parts stay with the island.
    fn split(
        &mut self,
        candidates: &mut ContactCandidates,
        slots: &mut Vec<Option<Box<WorldBody<'a>>>>,
    ) -> Vec<Self> {
        let mut lists = candidates.islands.lists();
        lists.retain(|list| is_busy(list.iter().map(|&k| &*self.bodies[k as usize]), self.end_s));
        let membership = island_of_each(&lists, self.bodies.len());
        let mut pair_histories: Vec<Vec<PairHistory>> = lists.iter().map(|_| Vec::new()).collect();
        let mut pairs = candidates.pairs.iter().peekable();
        // a pair goes with its part if both ends are in it; pairs between parts stay with the
        // island until the parts are merged
        self.pair_histories.retain(|pair| {
            let (number, a) = membership[pair.a as usize];
            let meets = pairs.next_if(|ends| **ends == (pair.a, pair.b)).is_some();
            let goes = meets && number != usize::MAX;
            if goes {
                pair_histories[number].push(PairHistory {
                    a,
                    b: membership[pair.b as usize].1,
                    ..*pair
                });
            }
            !goes
        });
        slots.extend(self.bodies.drain(..).map(Some));
        let window = (self.now_s, self.end_s);
        let mut islands = Vec::with_capacity(lists.len());
        for (list, pair_histories) in lists.into_iter().zip(pair_histories) {
            let bodies = list.iter().filter_map(|&k| slots[k as usize].take()).collect();
            let part = Self::new(self.settings, list, bodies, pair_histories, window);
            islands.push(Self { may_repeat: false, ..part });
        }
        islands
    }

    /// Takes the parts and their rocks back.
    fn merge(&mut self, islands: Vec<Self>, mut slots: Vec<Option<Box<WorldBody<'a>>>>) {
        for island in islands {
            self.missed |= island.missed;
            self.statistics.add(&island.statistics);
            let (list, bodies, pair_histories) = island.into_parts();
            self.pair_histories.extend(pair_histories.into_iter().map(|pair| PairHistory {
                a: list[pair.a as usize],
                b: list[pair.b as usize],
                ..pair
            }));
            for (&k, body) in list.iter().zip(bodies) {
                slots[k as usize] = Some(body);
            }
        }
        // ascending order again: the result must not depend on how the island was cut
        self.pair_histories.sort_unstable_by_key(|pair| (pair.a, pair.b));
        self.bodies.extend(slots.into_iter().flatten());
    }
}

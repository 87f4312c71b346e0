//! One island through one window: leap, meet, step, rest.
//!
//! An island is a set of rocks that may touch each other before the window ends, joined through pairs that are near
//! or bonded. Islands of one window share nothing, so they run in parallel and give the same bytes on any number of
//! threads. Inside an island all rocks in contact take the same step, because their springs form one system of
//! equations; rocks in flight follow exact parabolas and join when they touch.
//!
//! Time runs event by event: all fly to the next touch (`fly_to`), contacts that are due begin (`begin_contacts`),
//! the contact system is stepped until the next event (`steps`), and so on to the end of the window.

mod held_together;
mod rigid;

use super::{WorldBody, WorldStats};
use crate::contact::pair::{PairHistory, PairImpact, meeting_s};
use crate::simulation::Stop;
use crate::simulation::settings::RunSettings;
use crate::solver::island::{Island, IslandAdvance, RigidIsland};
use crate::solver::loss::{EnergyGiven, Loss};
use crate::solver::step_control::{ONSET, StepError};

/// A gap between two rocks that is rounding of their flight (–, relative to the sum of their radii).
///
/// Roots of the quadratic of a meeting are right to some 1e-15 of the distance flown, not of the
/// gap.
const GAP_ROUNDING: f64 = 1e-11;

/// A time that is nothing (s): the clock cannot tell less after an hour.
const SOON_S: f64 = 1e-12;

/// Rocks on their way. They are handed on between islands, and a pointer moves faster than a journey.
type Bodies<'a> = Vec<Box<WorldBody<'a>>>;

/// How a rock notes a step with its losses (J), what it gave to others (J), and whether it slides.
type Going<'a> = fn(&mut WorldBody<'a>, &RunSettings, f64, (Loss, EnergyGiven), bool);

/// One island and its window.
pub(super) struct IslandWindow<'a> {
    /// Scheme, tolerances, terrain and recorders, the same for all islands.
    pub(super) settings: &'a RunSettings<'a>,
    /// Numbers of its rocks in the world, rising.
    pub(super) ids: Vec<u32>,
    /// Its rocks, in the order of `ids`.
    pub(super) bodies: Bodies<'a>,
    /// Pairs that may touch, with what a held contact remembers; their ends count places in `bodies`.
    pub(super) pair_histories: Vec<PairHistory>,
    /// Time to which all rocks in contact have been taken (s).
    pub(super) now_s: f64,
    /// End of the window (s); nothing of the island is computed beyond it.
    pub(super) end_s: f64,
    /// Whether it goes back by itself where a rock was deviated further than was allowed for.
    pub(super) goes_back: bool,
    /// Whether a rock was deviated so far that it may have met one of another island.
    pub(super) missed: bool,
    /// What the island cost, counted.
    pub(super) statistics: WorldStats,
    /// Work space of rigid steps.
    pub(super) rigid: RigidIsland,
}

impl<'a> IslandWindow<'a> {
    /// The island at the start `now_s` of its window, before anything has moved.
    pub(super) fn new(
        settings: &'a RunSettings<'a>,
        ids: Vec<u32>,
        bodies: Bodies<'a>,
        pair_histories: Vec<PairHistory>,
        (now_s, end_s): (f64, f64),
    ) -> Self {
        Self {
            settings,
            ids,
            bodies,
            pair_histories,
            now_s,
            end_s,
            goes_back: true,
            missed: false,
            statistics: WorldStats::default(),
            rigid: RigidIsland::default(),
        }
    }

    /// Gives rocks and pairs back to the world.
    /// Ends of pairs still count places in the island.
    pub(super) fn into_parts(self) -> (Vec<u32>, Bodies<'a>, Vec<PairHistory>) {
        (self.ids, self.bodies, self.pair_histories)
    }

    /// Takes all of the island to the end of the window together.
    ///
    /// Ends when all fly beyond the window, or when the steps have reached its end.
    pub(super) fn run_whole(&mut self) {
        // a sleeping rock in a busy island may be pushed, so it takes part from the start
        for body in &mut self.bodies {
            body.wake(self.settings, self.now_s);
        }
        loop {
            let next_s = self.next_event_s().min(self.end_s);
            if self.bodies.iter().all(|body| body.member.flying) {
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
    /// O(n + pairs): it is asked again after every event.
    pub(super) fn next_event_s(&self) -> f64 {
        let flying = self.bodies.iter().filter(|body| body.member.flying);
        let landings = flying.filter_map(|body| body.lands.as_ref().map(|(time_s, _)| *time_s));
        // both kinds of events are closed forms: the landing was found when the flight began, the meeting is a
        // quadratic
        let first = landings.fold(f64::INFINITY, f64::min);
        self.pair_histories
            .iter()
            .filter_map(|pair_history| self.meeting_s(pair_history))
            .fold(first, f64::min)
    }

    /// When two flying rocks meet (s).
    fn meeting_s(&self, pair_history: &PairHistory) -> Option<f64> {
        let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.bodies[k as usize]);
        // a pair with an end in contact is watched by the stepper, which sees the gap in every step
        if !a.member.flying || !b.member.flying || pair_history.is_held() {
            return None;
        }
        let at = |body: &WorldBody| {
            let (c, v) = (
                body.position_at(self.settings, self.now_s),
                body.velocity_at(self.settings, self.now_s),
            );
            (c, v, body.member.body.radius)
        };
        // gravity acts on both alike and drops out: the relative path of two flying rocks is a straight line
        let ((c_a, v_a, r_a), (c_b, v_b, r_b)) = (at(a), at(b));
        meeting_s(&(c_a - c_b), &(v_a - v_b), r_a + r_b).map(|t| self.now_s + t)
    }

    /// Whether two flying rocks approach and touch but for rounding.
    fn meets_now(&self, pair_history: &PairHistory) -> bool {
        let touching = |pair_history: &PairHistory| {
            let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.bodies[k as usize]);
            let apart = a.recorder.now.position_m - b.recorder.now.position_m;
            apart.norm() <= (a.member.body.radius + b.member.body.radius) * (1.0 + GAP_ROUNDING)
        };
        self.meeting_s(pair_history)
            // a root just ahead of the clock, or a gap that rounding has left open: without the second test the same
            // event would be found again and again
            .is_some_and(|t| t - self.now_s <= SOON_S || touching(pair_history))
    }

    /// Moves flying rocks along their parabolas.
    fn fly_to(&mut self, time_s: f64) {
        for body in self.bodies.iter_mut().filter(|body| body.member.flying) {
            body.fly_to(self.settings, time_s);
        }
        self.now_s = time_s;
    }

    /// Begins all contacts that are due now.
    ///
    /// Several may be due at one instant, of the same rock too: each is begun, and the next step
    /// solves them together.
    fn begin_contacts(&mut self) {
        let due: Vec<bool> =
            self.pair_histories.iter().map(|pair_history| self.meets_now(pair_history)).collect();
        for (k, _) in due.iter().enumerate().filter(|(_, due)| **due) {
            let ends = [self.pair_histories[k].a as usize, self.pair_histories[k].b as usize];
            for end in ends {
                self.bodies[end].begin(self.settings);
            }
            let [a, b] = ends.map(|end| &self.bodies[end].member.state);
            let pair_history = &mut self.pair_histories[k];
            // the normal points from b to a; a negative normal speed approaches
            let (n, _) = crate::contact::pair::between(&a.c, &b.c);
            (pair_history.n, pair_history.closed) = (n, true);
            // below the capture speed a rebound would be smaller than the errors of the steps: dashpot of full damping
            let approach_m_s = -n.dot(&(a.v - b.v));
            pair_history.captured = approach_m_s < pair_history.law.capture_m_s;
            if !pair_history.captured {
                pair_history.impact = PairImpact::begun(approach_m_s);
                // the first step of an impact resolves the onset of its spring, whatever step the island had before
                let h = ONSET / pair_history.law.omega_rad_s();
                for end in ends {
                    self.bodies[end].h = self.bodies[end].h.min(h);
                }
            }
        }
        for body in self.bodies.iter_mut().filter(|body| body.member.flying) {
            let due = body.lands.as_ref().is_some_and(|(time_s, _)| *time_s <= self.now_s);
            match body.lands.take_if(|_| due) {
                Some((_, Some(stop))) => body.leave(stop),
                Some((_, None)) => body.land(self.settings),
                None => {}
            }
        }
    }

    /// Steps the island until a flying rock is due, all fly, or the window is over; whether it goes on.
    fn steps(&mut self, until_s: f64) -> bool {
        let now_s = self.now_s;
        self.bodies.iter_mut().for_each(|body| body.fly_to(self.settings, now_s));
        let mut island = self.cluster();
        let mut goes_on = true;
        while self.now_s < until_s {
            // no step passes the next event, the end of the window, or the end of a facet of rough ground
            let room = (until_s - self.now_s).min(self.before_step(&mut island));
            let spent = (island.sweeps, island.newton_steps);
            let Some(done) = self.advance(&mut island, room) else {
                goes_on = false;
                break;
            };
            let left_s = until_s - self.now_s;
            // the last step ends exactly at the event: a remainder of rounding would make an empty step of its own
            self.now_s = if done.dt >= left_s { until_s } else { self.now_s + done.dt };
            let all_fly = self.note(&mut island, &done, (spent, WorldBody::step));
            if all_fly {
                break;
            }
        }
        self.dissolve(island);
        if self.now_s >= self.end_s {
            self.leave_terrain();
            self.fall_asleep();
            return false;
        }
        if goes_on {
            self.begin_contacts();
        }
        goes_on
    }

    /// One step of at most `room` (s); none where it fails: it is that of all rocks of the island, and none may go on from a guess.
    fn advance(&mut self, island: &mut Island<'a>, room: f64) -> Option<IslandAdvance> {
        let step = self.settings.step;
        // three drivers of one system: error control, the fixed step of the paper, velocity stepping without
        // springs
        let tried = if step.scheme.controls_error() {
            island.advance(step, room)
        } else if step.scheme.has_springs() {
            island.advance_fixed(step, room)
        } else {
            island.advance_rigid(step.step_s, room)
        };
        let failed = |stuck: StepError| {
            for body in &mut self.bodies {
                body.leave(Stop::Failed(stuck.to_string()));
            }
        };
        tried.map_err(failed).ok()
    }

    /// Makes the rocks of the island ready for a step in contact; returns the longest that it may be (s).
    fn before_step(&mut self, island: &mut Island<'a>) -> f64 {
        // most scenes have neither stems nor rough ground: nothing to do before a step
        let mut longest_s = f64::INFINITY;
        let has_stems = self.settings.terrain.stems.is_some();
        for (body, member) in self.bodies.iter_mut().zip(&mut island.members) {
            if !has_stems && !member.state.facets.are_rough() {
                continue;
            }
            let met = member.state.facets.is_tilted();
            std::mem::swap(&mut body.member, member);
            longest_s = longest_s.min(body.before_step(self.settings));
            std::mem::swap(&mut body.member, member);
            if met != member.state.facets.is_tilted() {
                island.h = island.h.min(ONSET / member.omega(self.settings.terrain));
            }
        }
        longest_s
    }

    /// The island as the solver sees it.
    fn cluster(&mut self) -> Island<'a> {
        // the stiffest of the rocks in contact decides the step of all
        let h = self.bodies.iter().filter(|body| !body.member.flying).map(|body| body.h);
        let h = h.fold(f64::INFINITY, f64::min);
        // the solver borrows the rocks' state; the journeys stay here
        let members = self.bodies.iter_mut().map(|body| body.member.lend()).collect();
        let pair_histories = std::mem::take(&mut self.pair_histories);
        let mut island = Island::new(self.settings.terrain, members, pair_histories);
        island.rigid = std::mem::take(&mut self.rigid);
        island.h = h;
        island
    }

    /// Takes rocks and pairs back from the solver, with the step that each may begin with next time, and the speed
    /// (m/s) `F/(m ω)` that its pressed springs could give it: how far it might be thrown when a neighbour lets go.
    fn dissolve(&mut self, island: Island<'a>) {
        (self.pair_histories, self.rigid) = (island.pair_histories, island.rigid);
        for (body, member) in self.bodies.iter_mut().zip(island.members) {
            body.h = if member.flying { f64::INFINITY } else { island.h };
            body.pressed_m_s = member.pressed_m_s(self.settings.terrain);
            body.member = member;
        }
        for pair_history in self.pair_histories.iter().filter(|pair_history| pair_history.is_held())
        {
            for k in [pair_history.a, pair_history.b] {
                let body = &mut self.bodies[k as usize];
                body.pressed_m_s += pair_history.normal_force.abs()
                    / (body.member.body.mass * pair_history.law.omega_rad_s());
            }
        }
    }

    /// Writes one step into the journeys; whether all rocks fly now.
    fn note(
        &mut self,
        island: &mut Island<'a>,
        done: &IslandAdvance,
        ((swept, jumped), go): ((u64, u64), Going<'a>),
    ) -> bool {
        let (sweeps, jumps) = (island.sweeps - swept, island.newton_steps - jumped);
        let rocks = self.bodies.len() as u64;
        // the island pays once for a step, whatever the number of its rocks
        self.statistics.add(&WorldStats {
            steps: 1,
            rock_steps: rocks,
            rejected: done.rejected,
            sweeps,
            jumps,
            unsettled: u64::from(done.unsettled),
            largest: rocks,
            ..WorldStats::default()
        });
        // only the rigid limit lists blows, and what each has struck of the mesh
        let (mut blows, mut hits) = (done.blows.iter().peekable(), &done.hits[..]);
        // a contact between two rocks that slips makes both paths "sliding"
        let mut slides = vec![false; self.bodies.len()];
        for pair_history in island
            .pair_histories
            .iter()
            .filter(|pair_history| pair_history.closed && pair_history.slides)
        {
            (slides[pair_history.a as usize], slides[pair_history.b as usize]) = (true, true);
        }
        for (k, body) in self.bodies.iter_mut().enumerate() {
            std::mem::swap(&mut body.member, &mut island.members[k]);
            while let Some(blow) = blows.next_if(|blow| blow.rock == k) {
                let (own, others) = hits.split_at(blow.hits);
                body.pass(self.settings, (blow, own), (self.now_s, slides[k]));
                hits = others;
            }
            let effort = &mut body.recorder.effort;
            // each rock is charged the steps of its island: work of one rock cannot be told apart in one system
            effort.steps += 1;
            effort.rejected += done.rejected;
            effort.sweeps += sweeps + jumps;
            effort.unsettled += u64::from(done.unsettled);
            let given = (done.losses[k], done.given[k]);
            go(body, self.settings, self.now_s, given, slides[k]);
            body.spend(self.settings);
            std::mem::swap(&mut body.member, &mut island.members[k]);
        }
        island.members.iter().all(|member| member.flying)
    }
}

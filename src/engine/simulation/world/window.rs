//! One island through one window: flight, collision, contact, rest.
//!
//! An island is a set of rocks that may touch each other before the window ends, joined through
//! pairs that are near or bonded. Islands of one window share nothing, so they run in parallel and
//! give the same bytes on any number of threads. Inside an island all rocks in contact take the
//! same step, because their springs form one system of equations. Rocks in flight follow exact
//! parabolas and join the system when they touch.
//!
//! Event-driven: all rocks fly to the next contact (`fly_to`), contacts that are due begin
//! (`begin_contacts`), the contact system is stepped until the next event (`step_until`), and so on
//! to the end of the window.

mod held_together;
mod rigid;

use super::{WorldBody, WorldStats};
use crate::contact::pair::{PairHistory, PairImpact, collision_time_s};
use crate::simulation::Stop;
use crate::simulation::settings::RunSettings;
use crate::solver::island::{Island, IslandAdvance, RigidIsland};
use crate::solver::loss::{EnergyGiven, Loss};
use crate::solver::step_control::{ONSET, StepError};

/// Gap between two rocks that is rounding of their flight (–, relative to the sum of their radii).
///
/// Roots of the quadratic of a collision are accurate to some 1e-15 of the distance flown, not of
/// the gap.
const GAP_ROUNDING: f64 = 1e-11;

/// Time difference that is rounding (s): the clock resolves no less after an hour.
const TIME_ROUNDING_S: f64 = 1e-12;

/// Rocks of an island. They move between islands, and a pointer moves faster than a trajectory.
type Bodies<'a> = Vec<Box<WorldBody<'a>>>;

/// Function by which a rock records a step, with its losses (J), the energy given to others (J),
/// and whether it slides.
type RecordStep<'a> = fn(&mut WorldBody<'a>, &RunSettings, f64, (Loss, EnergyGiven), bool);

/// One island and its window.
pub(super) struct IslandWindow<'a> {
    /// Scheme, tolerances, terrain and recorders, the same for all islands.
    pub(super) settings: &'a RunSettings<'a>,
    /// Numbers of its rocks in the world, rising.
    pub(super) ids: Vec<u32>,
    /// Its rocks, in the order of `ids`.
    pub(super) bodies: Bodies<'a>,
    /// Candidate pairs, with the history of those in contact; their ends are indices into `bodies`.
    pub(super) pair_histories: Vec<PairHistory>,
    /// Time to which all rocks in contact have been advanced (s).
    pub(super) now_s: f64,
    /// End of the window (s); nothing of the island is computed beyond it.
    pub(super) end_s: f64,
    /// Whether the island repeats a part of its window by itself where a rock deviated further than
    /// was allowed for.
    pub(super) may_repeat: bool,
    /// Whether a rock deviated so far that it may have met one of another island.
    pub(super) missed: bool,
    /// Cost of the island, in counts.
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
            may_repeat: true,
            missed: false,
            statistics: WorldStats::default(),
            rigid: RigidIsland::default(),
        }
    }

    /// Returns rocks and pairs to the world; the ends of pairs are still indices into the island.
    pub(super) fn into_parts(self) -> (Vec<u32>, Bodies<'a>, Vec<PairHistory>) {
        (self.ids, self.bodies, self.pair_histories)
    }

    /// Advances all of the island together to the end of the window.
    ///
    /// Stops when all rocks fly beyond the window, or when the steps have reached its end.
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
            } else if !self.step_until(next_s) {
                return;
            }
        }
    }

    /// Time at which the next flying rock touches the mesh or another flying rock (s).
    ///
    /// Cost O(n + pairs): it is computed again after every event.
    pub(super) fn next_event_s(&self) -> f64 {
        let flying = self.bodies.iter().filter(|body| body.member.flying);
        let landings =
            flying.filter_map(|body| body.flight_end.as_ref().map(|(time_s, _)| *time_s));
        // both kinds of events are closed forms: the landing was found when the flight began, the
        // collision is the root of a quadratic
        let first = landings.fold(f64::INFINITY, f64::min);
        self.pair_histories.iter().filter_map(|pair| self.meeting_s(pair)).fold(first, f64::min)
    }

    /// Time at which two flying rocks collide (s); none if they do not.
    fn meeting_s(&self, pair: &PairHistory) -> Option<f64> {
        let [a, b] = [pair.a, pair.b].map(|k| &self.bodies[k as usize]);
        // a pair with a rock in contact is left to the stepper, which computes the gap in every
        // step
        if !a.member.flying || !b.member.flying || pair.is_held() {
            return None;
        }
        let at = |body: &WorldBody| {
            let (c, v) = (
                body.position_at(self.settings, self.now_s),
                body.velocity_at(self.settings, self.now_s),
            );
            (c, v, body.member.body.radius)
        };
        // gravity acts on both alike and drops out: the relative path of two flying rocks is a
        // straight line
        let ((c_a, v_a, r_a), (c_b, v_b, r_b)) = (at(a), at(b));
        collision_time_s(&(c_a - c_b), &(v_a - v_b), r_a + r_b).map(|t| self.now_s + t)
    }

    /// Whether two flying rocks approach and touch, to within rounding.
    fn meets_now(&self, pair: &PairHistory) -> bool {
        let is_touching = || {
            let [a, b] = [pair.a, pair.b].map(|k| &self.bodies[k as usize]);
            let apart = a.recorder.now.position_m - b.recorder.now.position_m;
            apart.norm() <= (a.member.body.radius + b.member.body.radius) * (1.0 + GAP_ROUNDING)
        };
        self.meeting_s(pair)
            // a root just ahead of the clock, or a gap that rounding has left open: without the
            // second test the same event would be found again and again
            .is_some_and(|t| t - self.now_s <= TIME_ROUNDING_S || is_touching())
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
    /// Several may be due at one instant, also of the same rock: each is begun, and the next step
    /// solves them together.
    fn begin_contacts(&mut self) {
        let due: Vec<bool> = self.pair_histories.iter().map(|pair| self.meets_now(pair)).collect();
        for (k, _) in due.iter().enumerate().filter(|(_, due)| **due) {
            let ends = [self.pair_histories[k].a as usize, self.pair_histories[k].b as usize];
            for end in ends {
                self.bodies[end].begin_contact(self.settings);
            }
            let [a, b] = ends.map(|end| &self.bodies[end].member.state);
            let pair = &mut self.pair_histories[k];
            // the normal points from b to a; a negative normal speed approaches
            let (n, _) = crate::contact::pair::normal_and_distance(&a.c, &b.c);
            (pair.n, pair.closed) = (n, true);
            // below the capture speed a rebound would be smaller than the errors of the steps:
            // dashpot of full damping
            let approach_m_s = -n.dot(&(a.v - b.v));
            pair.captured = approach_m_s < pair.law.capture_m_s;
            if !pair.captured {
                pair.impact = PairImpact::new(approach_m_s);
                // the first step of an impact resolves the onset of its spring, whatever step the
                // island had before
                let h = ONSET / pair.law.omega_rad_s();
                for end in ends {
                    self.bodies[end].next_step_s = self.bodies[end].next_step_s.min(h);
                }
            }
        }
        for body in self.bodies.iter_mut().filter(|body| body.member.flying) {
            let due = body.flight_end.as_ref().is_some_and(|(time_s, _)| *time_s <= self.now_s);
            match body.flight_end.take_if(|_| due) {
                Some((_, Some(stop))) => body.remove(stop),
                Some((_, None)) => body.land(self.settings),
                None => {}
            }
        }
    }

    /// Steps the island until a flying rock is due, all rocks fly, or the window is over. Returns
    /// whether the window continues.
    fn step_until(&mut self, until_s: f64) -> bool {
        let now_s = self.now_s;
        self.bodies.iter_mut().for_each(|body| body.fly_to(self.settings, now_s));
        let mut island = self.lend_to_solver();
        let mut continues = true;
        while self.now_s < until_s {
            // no step passes the next event, the end of the window, or the end of a facet of rough
            // ground
            let longest_s = (until_s - self.now_s).min(self.before_step(&mut island));
            let spent = (island.sweeps, island.newton_steps);
            let Some(done) = self.advance(&mut island, longest_s) else {
                continues = false;
                break;
            };
            let left_s = until_s - self.now_s;
            // the last step ends exactly at the event: a remainder by rounding would be an empty
            // step of its own
            self.now_s = if done.dt >= left_s { until_s } else { self.now_s + done.dt };
            let all_fly = self.record_step(&mut island, &done, (spent, WorldBody::record_step));
            if all_fly {
                break;
            }
        }
        self.take_back_from_solver(island);
        if self.now_s >= self.end_s {
            self.remove_past_border();
            self.put_to_sleep();
            return false;
        }
        if continues {
            self.begin_contacts();
        }
        continues
    }

    /// One step of at most `longest_s` (s). None where it fails: the step is that of all rocks of
    /// the island, and none may continue from a guess.
    fn advance(&mut self, island: &mut Island<'a>, longest_s: f64) -> Option<IslandAdvance> {
        let step = self.settings.step;
        // three drivers of one system: error control, the fixed step of the paper, velocity
        // stepping without springs
        let tried = if step.scheme.controls_error() {
            island.advance(step, longest_s)
        } else if step.scheme.has_springs() {
            island.advance_fixed(step, longest_s)
        } else {
            island.advance_rigid(step.step_s, longest_s)
        };
        let failed = |error: StepError| {
            for body in &mut self.bodies {
                body.remove(Stop::Failed(error.to_string()));
            }
        };
        tried.map_err(failed).ok()
    }

    /// Prepares the rocks of the island for a step in contact; returns the longest step (s).
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

    /// Lends the rocks and pairs of the island to the solver.
    fn lend_to_solver(&mut self) -> Island<'a> {
        // the stiffest rock in contact decides the step of all
        let h = self.bodies.iter().filter(|body| !body.member.flying).map(|body| body.next_step_s);
        let h = h.fold(f64::INFINITY, f64::min);
        // the solver borrows the state of the rocks; their records stay here
        let members = self.bodies.iter_mut().map(|body| body.member.lend()).collect();
        let pair_histories = std::mem::take(&mut self.pair_histories);
        self.bodies.iter_mut().for_each(|body| body.is_bonded = false);
        for pair in pair_histories.iter().filter(|pair| pair.bond.is_some()) {
            for end in [pair.a, pair.b] {
                self.bodies[end as usize].is_bonded = true;
            }
        }
        let mut island = Island::new(self.settings.terrain, members, pair_histories);
        island.rigid = std::mem::take(&mut self.rigid);
        island.h = h;
        island
    }

    /// Takes rocks and pairs back from the solver. Each rock gets the step with which it may begin
    /// next time, and the speed `F/(m ω)` (m/s) that its compressed springs could give it when a
    /// neighbour separates.
    fn take_back_from_solver(&mut self, island: Island<'a>) {
        (self.pair_histories, self.rigid) = (island.pair_histories, island.rigid);
        for (body, member) in self.bodies.iter_mut().zip(island.members) {
            body.next_step_s = if member.flying { f64::INFINITY } else { island.h };
            body.spring_dv_m_s = member.pressed_m_s(self.settings.terrain);
            body.member = member;
        }
        for pair in self.pair_histories.iter().filter(|pair| pair.is_held()) {
            for k in [pair.a, pair.b] {
                let body = &mut self.bodies[k as usize];
                body.spring_dv_m_s +=
                    pair.normal_force.abs() / (body.member.body.mass * pair.law.omega_rad_s());
            }
        }
    }

    /// Records one step of all rocks; returns whether all rocks fly now.
    fn record_step(
        &mut self,
        island: &mut Island<'a>,
        done: &IslandAdvance,
        ((swept, jumped), record): ((u64, u64), RecordStep<'a>),
    ) -> bool {
        let (sweeps, jumps) = (island.sweeps - swept, island.newton_steps - jumped);
        let rocks = self.bodies.len() as u64;
        // the island counts a step once, whatever the number of its rocks
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
        // only the rigid limit lists impulsive impacts, and their contacts with the mesh
        let (mut blows, mut hits) = (done.blows.iter().peekable(), &done.hits[..]);
        // a slipping contact between two rocks makes both paths "sliding"
        let mut slides = vec![false; self.bodies.len()];
        for pair in island.pair_histories.iter().filter(|pair| pair.closed && pair.slides) {
            (slides[pair.a as usize], slides[pair.b as usize]) = (true, true);
        }
        for (k, body) in self.bodies.iter_mut().enumerate() {
            std::mem::swap(&mut body.member, &mut island.members[k]);
            while let Some(blow) = blows.next_if(|blow| blow.rock == k) {
                let (own, others) = hits.split_at(blow.hits);
                body.record_blow(self.settings, (blow, own), (self.now_s, slides[k]));
                hits = others;
            }
            let effort = &mut body.recorder.effort;
            // each rock is charged the steps of its island: the work of one rock cannot be
            // separated in one system
            effort.steps += 1;
            effort.rejected += done.rejected;
            effort.sweeps += sweeps + jumps;
            effort.unsettled += u64::from(done.unsettled);
            let given = (done.losses[k], done.given[k]);
            record(body, self.settings, self.now_s, given, slides[k]);
            body.check_budget(self.settings);
            std::mem::swap(&mut body.member, &mut island.members[k]);
        }
        island.members.iter().all(|member| member.flying)
    }
}

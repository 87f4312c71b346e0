//! A sphere on soil: what its impacts and its slip do to the laws of the grounds, and what soil takes of its speed.
//!
//! Laws and speed change between steps, so all schemes are treated alike.
//!
//! Two laws, each on grounds that ask for it: the scar of Lu et al. (2019), `solver::scar`, and
//! friction that grows with slip of Leine et al. (2014), `solver::slip`. A third, restitution that
//! falls with the speed of the impact, is the ground's own (`Law::struck_at`).

use super::fall::{Fall, Slips};
use crate::contact::MOST;
use crate::contact::history::ContactHistory;
use crate::rock::Vec3;
use crate::solver::scar::GroundBlow;
use crate::solver::struck::Blow;
use arrayvec::ArrayVec;

/// Growth of `κ s` within one step, about (–): friction changes between steps.
/// Taken at the step's middle, so what is left of the error is of second order in it.
const GROWTH_OF_STEP: f64 = 0.02;

impl Fall<'_> {
    /// Lets the rock dig into the soil that has just been struck, and gives the impacts their dashpots, or the grounds where there are no springs;
    /// returns what it keeps of its speed (–).
    ///
    /// Order: the soil takes its share first, and the dashpots are those of the speed that is left.
    /// `kept` is a factor on the velocity, so the direction stays and the spin is untouched: drag
    /// acts at the centre.
    pub(super) fn answer_blows(&mut self) -> f64 {
        if self.state.blows.is_empty() {
            return 1.0;
        }
        let kept = if self.soil.scars.are_any() { self.dig() } else { 1.0 };
        self.slow(kept);
        let world = self.settings.around(self.body, self.laws);
        for blow in &self.state.blows {
            // one that goes on beside it keeps its own
            let ratio = world.law(blow.triangle).ratio_at(kept * blow.approach_m_s);
            let struck =
                |one: &&mut ContactHistory| (one.triangle, one.n) == (blow.triangle, blow.n);
            if let Some((ratio, history)) = ratio.zip(self.state.histories.iter_mut().find(struck))
            {
                history.damping_ratio = ratio;
            }
        }
        let of = |blow: &Blow| (world.ground_of(blow.triangle), kept * blow.approach_m_s);
        let mut struck: ArrayVec<(u16, f64), MOST> = self.state.blows.iter().map(of).collect();
        self.state.blows.clear();
        // the fastest on each ground last
        struck.sort_by(|one, other| one.1.total_cmp(&other.1));
        for (ground, approach_m_s) in struck {
            self.laws[usize::from(ground)].struck_at(approach_m_s);
        }
        kept
    }

    /// What the rock keeps of its speed as it digs into what it strikes (–).
    fn dig(&mut self) -> f64 {
        let world = self.settings.around(self.body, self.laws);
        let (state, scars) = (&self.state, &mut *self.soil.scars);
        let holding = state.histories.iter().chain(state.struck.iter());
        let in_soil = scars.is_in_soil(&world, holding.map(|history| history.triangle));
        let blow = |&Blow { approach_m_s, n: normal, triangle }: &Blow| {
            let ground = world.ground_of(triangle);
            GroundBlow { ground, normal, approach_m_s, of_point_m_s: approach_m_s }
        };
        let struck: ArrayVec<GroundBlow, MOST> = state.blows.iter().map(blow).collect();
        scars.enter(&self.body, &struck, (state.v.norm(), in_soil))
    }

    /// Before a step: what strikes, how friction has grown, and the longest step (s).
    /// The longest step is the least of what stems, scars and growing friction allow.
    pub(super) fn before_step(&mut self) -> f64 {
        let longest_s = self.in_contact().before_step();
        self.answer_blows();
        self.state.plane.ploughs = self.soil.scars.are_any();
        let kept = self.soil.scars.plough_ahead();
        self.slow(kept);
        let mut longest_s = longest_s.min(self.soil.scars.longest_s(self.state.v.norm()));
        if self.soil.slip.is_any() {
            self.soil.slips = self.fastest_slip();
            let speed_m_s = self.soil.slips.map_or(0.0, |slips| slips.speed_m_s);
            // d(κ s)/dt = κ |slip|: a step of GROWTH/per_s lets κ s grow by that much
            let per_s = self.soil.slip.fastest_per_m() * speed_m_s;
            longest_s = longest_s.min(GROWTH_OF_STEP / per_s);
            // of the middle of the step
            self.rub_after(0.5 * speed_m_s * longest_s.min(self.soil.last_step_s));
        }
        longest_s
    }

    /// After a step of `dt` (s) that began with the centre at `before`: what has been ploughed and slipped, and what it takes to leave.
    ///
    /// Ways of the step just taken: the centre's for ploughing, the contact point's slip (mean of
    /// both ends) for friction.
    pub(super) fn soil_after_step(&mut self, before: &Vec3, dt: f64) {
        self.soil.last_step_s = dt;
        if self.soil.scars.are_any() {
            let world = self.settings.around(self.body, self.laws);
            let contacts = self.state.histories.iter().map(|history| (history.triangle, history.n));
            let floor = self.soil.scars.floor(&world, contacts);
            let way_m = (self.state.c - before).norm();
            let ends = self.state.is_free().then_some(self.state.v);
            let kept = self.soil.scars.plough(&self.body, (way_m, floor), ends);
            self.slow(kept);
        }
        if let Some(Slips { speed_m_s, n, ground }) = self.soil.slips.take() {
            let after_m_s = self.body.slip(&n, &self.state.v, &self.state.w).norm();
            self.soil.slip.grow(0.5 * (speed_m_s + after_m_s) * dt, Some(ground));
        }
    }

    /// Takes a share of the speed; the soil has it.
    /// `ΔE = m v² (1 − kept²)/2` goes to the soil.
    fn slow(&mut self, kept: f64) {
        if kept >= 1.0 {
            return;
        }
        let v = self.recorder.slowed_in_soil(&self.state.v, kept);
        let world = self.settings.around(self.body, self.laws);
        self.state.redirect(&world, v, self.state.w);
    }

    /// Gives the grounds their friction after all the way slipped and so much more (m).
    ///
    /// Only where the value really changes, to the bit, is the stepper told: a redirect costs it
    /// what it knows of the last step.
    fn rub_after(&mut self, ahead_m: f64) {
        let mut changes = false;
        for (ground, law) in self.laws.iter_mut().enumerate() {
            let friction = self.soil.slip.friction(ground as u16, law, ahead_m);
            changes |= law.rub_with(friction);
        }
        if changes {
            let (v, w) = (self.state.v, self.state.w);
            let world = self.settings.around(self.body, self.laws);
            self.state.redirect(&world, v, w);
        }
    }

    /// The contact that slips fastest of those that hold the rock.
    fn fastest_slip(&self) -> Option<Slips> {
        let world = self.settings.around(self.body, self.laws);
        let slips = |history: &ContactHistory| {
            let speed_m_s = self.body.slip(&history.n, &self.state.v, &self.state.w).norm();
            Slips { speed_m_s, n: history.n, ground: world.ground_of(history.triangle) }
        };
        let fastest =
            |one: Slips, other: Slips| if other.speed_m_s > one.speed_m_s { other } else { one };
        self.state.histories.iter().map(slips).reduce(fastest)
    }
}

//! A step of an island, tried with any length, and the impacts that begin and end within it.
//!
//! An impact that begins within a step waits for its end, as that of a rock alone does ([`step_control`]). One that ends within it is a kink,
//! of which the error estimate sees too little: from a radian before its end on, a step that passes it takes away several per cent of
//! its energy. So what still presses a rock with a part of the impact is not let go within a step, which ends where it opens.

use super::assembly::Island;
use super::body::IslandBody;
use super::pair_contact::PairContact;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::solver::contact_state::Onset;
use crate::solver::law::StageContact;
use crate::solver::step_control::{
    self, Begun, Control, ONSET, OnsetSearch, StepError, TRAVEL, TrialStep, TryOutcome,
};

/// Speed that a spring may still give a rock as its contact opens within a step (–, relative to that of its impact): 4e-4 of
/// the energy, and the step that passes the kink misses a part of that.
const LET_GO: f64 = 0.02;
/// Speed missed behind a kink that is left as it is (–, relative to the local error allowed).
const MISSED: f64 = 0.3;
/// Most cuts of a step for contacts that open within it.
const MOST_CUTS: u32 = 4;
/// Shortest part of a try to which one that opens cuts it (–): it is found by a straight line from force to force.
const LEAST_CUT: f64 = 0.05;

/// A step of the island, tried with any length.
struct IslandTrial<'i, 'a> {
    island: &'i mut Island<'a>,
    control: &'i Control,
    /// The stiffest contact at the step's start (rad/s).
    omega: f64,
    onsets: OnsetSearch,
    /// Cuts for contacts that open.
    cuts: u32,
}

impl IslandTrial<'_, '_> {
    /// What a try of `dt` (s) comes to.
    fn outcome(&mut self, dt: f64) -> TryOutcome {
        let (rad, hh) = (dt * self.omega, self.control.tableau.diagonal * dt);
        self.island.let_wait(self.onsets.waits(rad));
        let Some(error) = self.island.attempt(self.control, dt) else {
            return TryOutcome::Unsettled;
        };
        let is_met = self.island.is_met();
        if is_met {
            let begun = Begun::within(dt, self.omega);
            let begun = self.island.begun(begun, hh, self.control.impact);
            if let Some(share) = self.onsets.cut(&begun, rad) {
                return TryOutcome::Cut(share);
            }
        }
        if error > 1.0 || error.is_nan() {
            return TryOutcome::Error(error);
        }
        let opens = self.island.opens((dt, hh), self.control.impact);
        if opens < 1.0 && self.cuts < MOST_CUTS {
            self.cuts += 1;
            return TryOutcome::Cut(opens.max(LEAST_CUT));
        }
        // a step that resolves the springs by far cannot gain more than its error, and what has just begun stores less: only coarse
        // ones are asked
        if !is_met && rad > step_control::RESOLVED && self.island.gains(hh) {
            return TryOutcome::Gains;
        }
        TryOutcome::Error(error)
    }
}

impl TrialStep for IslandTrial<'_, '_> {
    /// The island's own next step, which the controller updates.
    fn h(&mut self) -> &mut f64 {
        &mut self.island.h
    }

    fn limit(&mut self) -> f64 {
        self.island.travel_limit(TRAVEL)
    }

    fn try_step(&mut self, dt: f64) -> TryOutcome {
        let outcome = self.outcome(dt);
        if !matches!(outcome, TryOutcome::Error(error) if error <= 1.0) {
            // memories that came up in a try that failed have never been
            for member in self.island.members.iter_mut().map(|slot| &mut **slot) {
                member.state.histories.truncate(member.known);
            }
        }
        outcome
    }
}

impl Island<'_> {
    /// Tries steps of at most `h_max` (s) in contacts of at most `omega` (rad/s) until one is accurate: its length (s), and how many
    /// were thrown away.
    ///
    /// # Errors
    /// [`StepError`] if the step had to become too short to matter.
    pub(super) fn settle_step(
        &mut self,
        control: &Control,
        omega: f64,
        h_max: f64,
    ) -> Result<(f64, u64), StepError> {
        let mut rejected = 0;
        let mut trial =
            IslandTrial { island: self, control, omega, onsets: OnsetSearch::NEW, cuts: 0 };
        let dt = step_control::settle(&mut trial, control, (h_max, omega), &mut rejected)?;
        Ok((dt, rejected))
    }

    /// Says whether impacts that come up in the next try wait for its end.
    fn let_wait(&mut self, waits: bool) {
        self.onset = Onset { waits, is_met: false };
        self.members.iter_mut().for_each(|member| member.state.onset = self.onset);
    }

    /// Whether the present try has run into an impact.
    fn is_met(&self) -> bool {
        self.onset.is_met || self.members.iter().any(|member| member.state.onset.is_met)
    }

    /// Where in the present try the first impact begins that it runs into; `relative` is the local error allowed to one of two bodies
    /// alone (–).
    fn begun(&self, mut begun: Begun, hh: f64, relative: f64) -> Begun {
        for member in self.members.iter().map(|slot| &**slot) {
            let how = (member.allowed_share(relative), member.body.radius);
            member.state.see_begun(&mut begun, (&member.end, hh), how);
        }
        for pair in self.pairs.iter().filter(|pair| pair.waits) {
            let [a, b] = pair.ends.map(|end| &self.members[end]);
            let apart_m_s = self.apart_m_s(pair);
            let (n, distance) = normal_and_distance(&a.state.c, &b.state.c);
            let gap_m = distance - a.body.radius - b.body.radius;
            let start = (gap_m > 0.0).then(|| (gap_m, -n.dot(&(a.state.v - b.state.v))));
            let end = (pair.pen_at(apart_m_s, hh), -apart_m_s);
            let allowed = a.allowed_share(relative).max(b.allowed_share(relative));
            begun.see(end, start, (allowed, a.body.radius.min(b.body.radius)));
        }
        begun
    }

    /// Normal speed apart at the try's end (m/s).
    fn apart_m_s(&self, pair: &PairContact) -> f64 {
        let ends = pair.ends.map(|end| (self.members[end].end.v, self.members[end].end.w));
        pair.speed([&ends[0], &ends[1]])
    }

    /// The share (–) of the present try of `dt` (s) after which the first contact opens that still presses with a part of its impact; 1
    /// if none does. `relative` is the local error allowed in an impact (–).
    fn opens(&self, (dt, hh): (f64, f64), relative: f64) -> f64 {
        let rocks = self.members.iter().map(|member| member.opens((dt, hh), relative));
        let rocks = rocks.fold(1.0, f64::min);
        let mut pairs = self.pairs.iter().peekable();
        let of_pair = |(k, history): (usize, &PairHistory)| {
            let pair = pairs.next_if(|pair| pair.pair_history == k);
            if history.impact.speed_m_s <= 0.0 || history.bond.is_some() {
                return 1.0;
            }
            let ends = [history.a, history.b].map(|k| &self.members[k as usize]);
            let pulls = |pair: &PairContact| {
                let apart_m_s = self.apart_m_s(pair);
                pair.normal.bilateral_force(pair.pen_at(apart_m_s, hh), apart_m_s)
            };
            let before = history.normal_force;
            // rocks that are so far apart that they are not asked have been let go halfway
            let after = pair.map_or(-before, pulls);
            let inv_m = ends.map(|end| 1.0 / end.body.mass).iter().sum::<f64>();
            let allowed_m_s = ends.map(|end| end.allowed_m_s(relative));
            let omega = history.law.omega_rad_s();
            Kink { forces: (before, after), inv_m, omega, dt }
                .share(history.impact.speed_m_s, allowed_m_s[0].min(allowed_m_s[1]))
        };
        self.pair_histories.iter().enumerate().map(of_pair).fold(rocks, f64::min)
    }

    /// What the present place touches is met whatever becomes of the tries.
    pub(super) fn accept_meetings(&mut self) {
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            let (world, state) = member.with_environment(self.terrain);
            state.accept_meetings(&world);
        }
    }

    /// After an accepted step: the impacts at whose beginning it ended press from now on, and the next step resolves them.
    pub(super) fn begin_late(&mut self) {
        if self.is_met() {
            self.fresh = false;
            self.h = self.h.min(ONSET / self.omega());
        }
        self.let_wait(false);
    }
}

/// A contact over a try of `dt` (s) within which it may open.
struct Kink {
    /// Its force before the try and, negative if it could pull, after it (N).
    forces: (f64, f64),
    /// One over the mass that it moves (1/kg).
    inv_m: f64,
    /// Its frequency (rad/s).
    omega: f64,
    dt: f64,
}

impl Kink {
    /// The share (–) of the try after which it opens; 1 if it does not, if its spring gives little of an impact of `impact_m_s`, or so
    /// late in the try that what the step misses behind the kink is less than is `allowed_m_s`.
    fn share(&self, impact_m_s: f64, allowed_m_s: f64) -> f64 {
        let (before, after) = self.forces;
        let share = before / (before - after);
        let gives_m_s = before * self.inv_m / self.omega;
        // the force behind the kink on the mean, over the part of the try that is left
        let missed_m_s = -0.5 * after * self.inv_m * self.dt * (1.0 - share);
        let is_late = after < 0.0 && gives_m_s > LET_GO * impact_m_s;
        if is_late && missed_m_s > MISSED * allowed_m_s { share } else { 1.0 }
    }
}

impl IslandBody {
    /// The same of its contacts with the mesh.
    fn opens(&self, (dt, hh): (f64, f64), relative: f64) -> f64 {
        let (state, end) = (&self.state, &self.end);
        if !state.is_rebounding() {
            return 1.0;
        }
        let of_contact = |contact: &StageContact| {
            let before = state.histories[contact.history].normal_force;
            let depth_m = contact.pen_at(&end.v, hh);
            let after = contact.normal.bilateral_force(depth_m, contact.n.dot(&end.v));
            let (inv_m, omega) = (1.0 / self.body.mass, contact.law.omega_rad_s());
            Kink { forces: (before, after), inv_m, omega, dt }
                .share(state.impact.speed_m_s, self.allowed_m_s(relative))
        };
        self.contacts().iter().map(of_contact).fold(1.0, f64::min)
    }
}

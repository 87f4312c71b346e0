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
    self, Control, FirstOnset, ONSET, OnsetSearch, StepError, TRAVEL, TrialStep, TryOutcome,
};

/// Speed that a spring may still give a rock as its contact opens within a step (–, relative to that of its impact): 4e-4 of
/// the energy, and the step that passes the kink misses a part of that.
const RELEASED: f64 = 0.02;
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
        self.island.defer_impacts(self.onsets.defers(rad));
        let Some(error) = self.island.attempt(self.control, dt) else {
            return TryOutcome::NotConverged;
        };
        let is_reached = self.island.has_reached_onset();
        if is_reached {
            let first_onset = FirstOnset::within(dt, self.omega);
            let first_onset = self.island.first_onset(first_onset, hh, self.control.impact);
            if let Some(share) = self.onsets.cut(&first_onset, rad) {
                return TryOutcome::Cut(share);
            }
        }
        if error > 1.0 || error.is_nan() {
            return TryOutcome::Error(error);
        }
        let first_opening = self.island.first_opening((dt, hh), self.control.impact);
        if first_opening < 1.0 && self.cuts < MOST_CUTS {
            self.cuts += 1;
            return TryOutcome::Cut(first_opening.max(LEAST_CUT));
        }
        // a step that resolves the springs by far cannot gain more than its error, and what has just begun stores less: only coarse
        // ones are asked
        if !is_reached && rad > step_control::RESOLVED && self.island.gains_energy(hh) {
            return TryOutcome::EnergyGain;
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
                member.state.histories.truncate(member.histories_at_start);
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
    pub(super) fn find_accepted_step(
        &mut self,
        control: &Control,
        omega: f64,
        h_max: f64,
    ) -> Result<(f64, u64), StepError> {
        let mut rejected = 0;
        let mut trial =
            IslandTrial { island: self, control, omega, onsets: OnsetSearch::NEW, cuts: 0 };
        let dt =
            step_control::find_accepted_step(&mut trial, control, (h_max, omega), &mut rejected)?;
        Ok((dt, rejected))
    }

    /// Says whether impacts that come up in the next try wait for its end.
    fn defer_impacts(&mut self, deferred: bool) {
        self.onset = Onset { deferred, is_reached: false };
        self.members.iter_mut().for_each(|member| member.state.onset = self.onset);
    }

    /// Whether the present try has run into an impact.
    fn has_reached_onset(&self) -> bool {
        self.onset.is_reached || self.members.iter().any(|member| member.state.onset.is_reached)
    }

    /// Where in the present try the first impact begins that it runs into; `relative` is the local error allowed to one of two bodies
    /// alone (–).
    fn first_onset(&self, mut first_onset: FirstOnset, hh: f64, relative: f64) -> FirstOnset {
        for member in self.members.iter().map(|slot| &**slot) {
            let how = (member.allowed_share(relative), member.body.radius);
            member.state.add_onsets(&mut first_onset, (&member.end, hh), how);
        }
        for pair in self.pairs.iter().filter(|pair| pair.deferred) {
            let [a, b] = pair.ends.map(|end| &self.members[end]);
            let separation_m_s = self.separation_m_s(pair);
            let (n, distance) = normal_and_distance(&a.state.c, &b.state.c);
            let gap_m = distance - a.body.radius - b.body.radius;
            let start = (gap_m > 0.0).then(|| (gap_m, -n.dot(&(a.state.v - b.state.v))));
            let end = (pair.penetration_at(separation_m_s, hh), -separation_m_s);
            let allowed = a.allowed_share(relative).max(b.allowed_share(relative));
            first_onset.add(end, start, (allowed, a.body.radius.min(b.body.radius)));
        }
        first_onset
    }

    /// Normal speed apart at the try's end (m/s).
    fn separation_m_s(&self, pair: &PairContact) -> f64 {
        let ends = pair.ends.map(|end| (self.members[end].end.v, self.members[end].end.w));
        pair.speed([&ends[0], &ends[1]])
    }

    /// The share (–) of the present try of `dt` (s) after which the first contact opens that still presses with a part of its impact; 1
    /// if none does. `relative` is the local error allowed in an impact (–).
    fn first_opening(&self, (dt, hh): (f64, f64), relative: f64) -> f64 {
        let rocks = self.members.iter().map(|member| member.first_opening((dt, hh), relative));
        let rocks = rocks.fold(1.0, f64::min);
        let mut pairs = self.pairs.iter().peekable();
        let of_pair = |(k, history): (usize, &PairHistory)| {
            let pair = pairs.next_if(|pair| pair.pair_history == k);
            if history.impact.speed_m_s <= 0.0 || history.bond.is_some() {
                return 1.0;
            }
            let ends = [history.a, history.b].map(|k| &self.members[k as usize]);
            let pulls = |pair: &PairContact| {
                let separation_m_s = self.separation_m_s(pair);
                pair.normal.bilateral_force(pair.penetration_at(separation_m_s, hh), separation_m_s)
            };
            let before = history.normal_force;
            // rocks that are so far apart that they are not asked have been let go halfway
            let after = pair.map_or(-before, pulls);
            let inv_m = ends.map(|end| 1.0 / end.body.mass).iter().sum::<f64>();
            let allowed_m_s = ends.map(|end| end.allowed_m_s(relative));
            let omega = history.law.omega_rad_s();
            OpeningContact { forces: (before, after), inv_m, omega, dt }
                .share(history.impact.speed_m_s, allowed_m_s[0].min(allowed_m_s[1]))
        };
        self.pair_histories.iter().enumerate().map(of_pair).fold(rocks, f64::min)
    }

    /// What the present place touches is met whatever becomes of the tries.
    pub(super) fn accept_new_contacts(&mut self) {
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            let (world, state) = member.with_environment(self.terrain);
            state.accept_new_contacts(&world);
        }
    }

    /// After an accepted step: the impacts at whose beginning it ended press from now on, and the next step resolves them.
    pub(super) fn begin_deferred_impacts(&mut self) {
        if self.has_reached_onset() {
            self.fresh = false;
            self.h = self.h.min(ONSET / self.omega());
        }
        self.defer_impacts(false);
    }
}

/// A contact over a try of `dt` (s) within which it may open.
struct OpeningContact {
    /// Its force before the try and, negative if it could pull, after it (N).
    forces: (f64, f64),
    /// One over the mass that it moves (1/kg).
    inv_m: f64,
    /// Its frequency (rad/s).
    omega: f64,
    dt: f64,
}

impl OpeningContact {
    /// The share (–) of the try after which it opens; 1 if it does not, if its spring gives little of an impact of `impact_m_s`, or so
    /// late in the try that what the step misses behind the kink is less than is `allowed_m_s`.
    fn share(&self, impact_m_s: f64, allowed_m_s: f64) -> f64 {
        let (before, after) = self.forces;
        let share = before / (before - after);
        let gives_m_s = before * self.inv_m / self.omega;
        // the force behind the kink on the mean, over the part of the try that is left
        let missed_m_s = -0.5 * after * self.inv_m * self.dt * (1.0 - share);
        let is_late = after < 0.0 && gives_m_s > RELEASED * impact_m_s;
        if is_late && missed_m_s > MISSED * allowed_m_s { share } else { 1.0 }
    }
}

impl IslandBody {
    /// The same of its contacts with the mesh.
    fn first_opening(&self, (dt, hh): (f64, f64), relative: f64) -> f64 {
        let (state, end) = (&self.state, &self.end);
        if !state.is_rebounding() {
            return 1.0;
        }
        let of_contact = |contact: &StageContact| {
            let before = state.histories[contact.history].normal_force;
            let depth_m = contact.penetration_at(&end.v, hh);
            let after = contact.normal.bilateral_force(depth_m, contact.n.dot(&end.v));
            let (inv_m, omega) = (1.0 / self.body.mass, contact.law.omega_rad_s());
            OpeningContact { forces: (before, after), inv_m, omega, dt }
                .share(state.impact.speed_m_s, self.allowed_m_s(relative))
        };
        self.contacts().iter().map(of_contact).fold(1.0, f64::min)
    }
}

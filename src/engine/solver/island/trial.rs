//! A trial step of an island, and the impacts that begin and end within it.
//!
//! The onset of an impact within a step is deferred to its end, as for a rock alone
//! ([`step_control`]). The end of an impact within a step is a kink of the force, which the error
//! estimate hardly sees: a step that passes it, from a radian before it on, takes several per cent
//! of the energy of the impact. So a contact that still carries a part of its impact must not open
//! within a step: the step is cut where it opens.

use super::assembly::Island;
use super::body::IslandBody;
use super::pair_contact::PairContact;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::solver::contact_state::Onset;
use crate::solver::law::StageContact;
use crate::solver::step_control::{
    self, Control, FirstOnset, ONSET, OnsetSearch, StepError, TRAVEL, TrialStep, TryOutcome,
};

/// Speed that a spring may still give a rock as its contact opens within a step (–, relative to the
/// impact speed): 4e-4 of the energy, of which the step that passes the kink misses a part.
const RELEASED: f64 = 0.02;
/// Speed error after a kink that is tolerated (–, relative to the local error allowed).
const SPEED_ERROR: f64 = 0.3;
/// Most cuts of a step for contacts that open within it.
const MOST_CUTS: u32 = 4;
/// Shortest part of a try to which an opening contact cuts it (–): the time follows from linear
/// interpolation of the force.
const LEAST_CUT: f64 = 0.05;

/// A step of the island that can be tried with any length.
struct IslandTrial<'i, 'a> {
    island: &'i mut Island<'a>,
    control: &'i Control,
    /// Frequency of the stiffest contact at the step's start (rad/s).
    omega: f64,
    onsets: OnsetSearch,
    /// Number of cuts for contacts that open.
    cuts: u32,
}

impl IslandTrial<'_, '_> {
    /// Outcome of a try of `dt` (s).
    fn outcome(&mut self, dt: f64) -> TryOutcome {
        let (rad, hh) = (dt * self.omega, self.control.tableau.diagonal * dt);
        self.island.defer_impacts(self.onsets.defers(rad));
        let Some(error) = self.island.attempt(self.control, dt) else {
            return TryOutcome::NotConverged;
        };
        let has_onset = self.island.has_reached_onset();
        if has_onset {
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
        // a step that resolves the springs well cannot gain more than its error, and a contact that
        // has just begun stores less: only coarse steps are checked
        if !has_onset && rad > step_control::RESOLVED && self.island.gains_energy(hh) {
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
            // histories that a rejected try has added are discarded
            for member in self.island.members.iter_mut().map(|slot| &mut **slot) {
                member.state.histories.truncate(member.histories_at_start);
            }
        }
        outcome
    }
}

impl Island<'_> {
    /// Tries steps of at most `h_max` (s), with a stiffest contact of `omega` (rad/s), until one is
    /// accurate; its length (s), and the number of rejected tries.
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

    /// Sets whether impacts that begin in the next try are deferred to its end.
    fn defer_impacts(&mut self, deferred: bool) {
        self.onset = Onset { deferred, is_reached: false };
        self.members.iter_mut().for_each(|member| member.state.onset = self.onset);
    }

    /// Whether the present try contains the onset of an impact.
    fn has_reached_onset(&self) -> bool {
        self.onset.is_reached || self.members.iter().any(|member| member.state.onset.is_reached)
    }

    /// The first onset of an impact in the present try; `relative` is the local error allowed in an
    /// impact of two bodies alone (–).
    fn first_onset(&self, mut first_onset: FirstOnset, hh: f64, relative: f64) -> FirstOnset {
        for member in self.members.iter().map(|slot| &**slot) {
            let scales = (member.allowed_share(relative), member.body.radius);
            member.state.add_onsets(&mut first_onset, (&member.end, hh), scales);
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

    /// Normal separation speed at the try's end (m/s).
    fn separation_m_s(&self, pair: &PairContact) -> f64 {
        let ends = pair.ends.map(|end| (self.members[end].end.v, self.members[end].end.w));
        pair.speed([&ends[0], &ends[1]])
    }

    /// Share (–) of the present try of `dt` (s) at which the first contact opens that still carries
    /// a part of its impact; 1 if none does. `relative` is the local error allowed in an impact
    /// (–).
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
            let force_at_end = |pair: &PairContact| {
                let separation_m_s = self.separation_m_s(pair);
                pair.normal.bilateral_force(pair.penetration_at(separation_m_s, hh), separation_m_s)
            };
            let before = history.normal_force;
            // pairs too far apart to be candidates have opened halfway
            let after = pair.map_or(-before, force_at_end);
            let inv_m = ends.map(|end| 1.0 / end.body.mass).iter().sum::<f64>();
            let allowed_m_s = ends.map(|end| end.allowed_m_s(relative));
            let omega = history.law.omega_rad_s();
            OpeningContact { forces: (before, after), inv_m, omega, dt }
                .share(history.impact.speed_m_s, allowed_m_s[0].min(allowed_m_s[1]))
        };
        self.pair_histories.iter().enumerate().map(of_pair).fold(rocks, f64::min)
    }

    /// Accepts the new contacts at the present position, independently of the following tries.
    pub(super) fn accept_new_contacts(&mut self) {
        for member in self.members.iter_mut().map(|slot| &mut **slot) {
            let (world, state) = member.with_environment(self.terrain);
            state.accept_new_contacts(&world);
        }
    }

    /// After an accepted step: deferred impacts that begin at its end act from now on, and the next
    /// step resolves them.
    pub(super) fn begin_deferred_impacts(&mut self) {
        if self.has_reached_onset() {
            self.fresh = false;
            self.h = self.h.min(ONSET / self.omega());
        }
        self.defer_impacts(false);
    }
}

/// A contact that may open within a try of `dt` (s).
struct OpeningContact {
    /// Its force before the try, and after it; negative if it would pull (N).
    forces: (f64, f64),
    /// Inverse effective mass (1/kg).
    inv_m: f64,
    /// Its frequency (rad/s).
    omega: f64,
    dt: f64,
}

impl OpeningContact {
    /// Share (–) of the try at which it opens; 1 if it does not, if its spring gives little of an
    /// impact of `impact_m_s`, or so late that the speed error after the kink is less than a part
    /// of `allowed_m_s`.
    fn share(&self, impact_m_s: f64, allowed_m_s: f64) -> f64 {
        let (before, after) = self.forces;
        let share = before / (before - after);
        let released_m_s = before * self.inv_m / self.omega;
        // mean force after the kink, over the rest of the try
        let missed_m_s = -0.5 * after * self.inv_m * self.dt * (1.0 - share);
        let is_relevant = after < 0.0 && released_m_s > RELEASED * impact_m_s;
        if is_relevant && missed_m_s > SPEED_ERROR * allowed_m_s { share } else { 1.0 }
    }
}

impl IslandBody {
    /// The same for its contacts with the mesh.
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

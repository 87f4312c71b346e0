//! Impacts that begin within an implicit step of rocks in lasting contact, which roll along and strike a wall, a tree or each other.
//!
//! The force of a dashpot is there at once, a jump within a step, and what is allowed to lasting contact is no measure of an impact. So a
//! contact that may rebound presses nothing in the step in which it comes up, the step ends where it begins, and from there on it is
//! followed in its own time: that of a rock alone by explicit stages ([`explicit_impact`](crate::solver::explicit_impact)), that in an
//! island by implicit ones, which are short and held to the speed of the impact.

use super::{ONSET, PLACE_ROUNDING, RockTrial};
use crate::math;
use crate::solver::contact_state::ContactState;
use crate::solver::law::StageContact;
use crate::solver::stage::StageMotion;

/// Most cuts of a step for impacts that begin within it.
pub(crate) const MOST_CUTS: u32 = 12;
/// A step this short ends where an impact begins, as exactly as anybody can tell (rad of the stiffest contact).
pub(crate) const ONSET_ACCURACY_RAD: f64 = 1e-8;

/// How the tries of one step meet the impacts that begin within it.
#[derive(Debug)]
pub(crate) struct OnsetSearch {
    /// Whether they wait for the step's end, and how often it has been cut for that.
    defers: bool,
    cuts: u32,
}

impl OnsetSearch {
    /// Before the first try.
    pub(crate) const NEW: Self = Self { defers: true, cuts: 0 };

    /// Whether what comes up in a try of so many radians presses nothing in it.
    pub(crate) fn defers(&self, rad: f64) -> bool {
        self.defers && rad > ONSET_ACCURACY_RAD
    }

    /// The share (–) to which a try of so many radians has to be cut where impacts have `first_onset` that it runs into; none if they have
    /// just begun as it ends.
    pub(crate) fn cut(&mut self, first_onset: &FirstOnset, rad: f64) -> Option<f64> {
        let share = first_onset.share();
        if share >= 1.0 {
            return None;
        }
        self.cuts += 1;
        if share * rad > ONSET_ACCURACY_RAD && self.cuts < MOST_CUTS {
            return Some(share);
        }
        // it has popped up, or is not to be met: it presses from where it is found
        self.defers = false;
        Some((ONSET / rad).min(1.0))
    }
}

/// Where in a try of `dt` (s) the first of the impacts that it runs into begins.
#[derive(Debug)]
pub(crate) struct FirstOnset {
    dt: f64,
    /// The stiffest contact (rad/s).
    omega: f64,
    is_at_end: bool,
    share: f64,
}

impl FirstOnset {
    /// In a try of `dt` (s) with a stiffest contact of `omega` (rad/s).
    pub(crate) const fn within(dt: f64, omega: f64) -> Self {
        Self { dt, omega, is_at_end: false, share: 1.0 }
    }

    /// A contact of a rock of a radius (m) that has come up is pressed in at the try's `end` (m) and comes at a speed (m/s); at its
    /// `start`, if that is known, there was a gap (m), above 0, and it came at a speed. It has just begun while it is pressed in by
    /// no more than `allowed` (–), the local error relative to the speed of the impact, of what that speed presses in.
    pub(crate) fn add(
        &mut self,
        end: (f64, f64),
        start: Option<(f64, f64)>,
        (allowed, radius_m): (f64, f64),
    ) {
        let (pressed_m, approach_m_s) = end;
        let negligible_m = (allowed * approach_m_s / self.omega).max(PLACE_ROUNDING * radius_m);
        self.is_at_end |= pressed_m > 0.0;
        if pressed_m > negligible_m {
            // a little behind its beginning, so that the next step begins with it
            let wanted_m = 0.5 * negligible_m;
            let share = if let Some((gap_m, start_approach_m_s)) = start {
                // what has come up presses nothing in the try, so its way is smooth
                let [from, to] = [
                    [-gap_m - wanted_m, start_approach_m_s * self.dt],
                    [pressed_m - wanted_m, approach_m_s * self.dt],
                ];
                let share = math::hermite_crossing(from, to, false);
                // one that was apart has not popped up, however near it was
                share.max(2.0 * ONSET_ACCURACY_RAD / (self.dt * self.omega))
            } else if approach_m_s > 0.0 {
                1.0 - (pressed_m - wanted_m) / approach_m_s / self.dt
            } else {
                0.0
            };
            self.share = self.share.min(share);
        }
    }

    /// The share (–) of it, 1 or more where what has come up has hardly begun, not positive where it has been there from the start.
    fn share(&self) -> f64 {
        // one that has come and gone within the step
        if self.is_at_end { self.share } else { 0.5 }
    }
}

impl ContactState {
    /// Sees what of a rock has come up in the present try, which ends at `end`; `hh` is the part of it that its last stage is implicit
    /// in (s). With the local error allowed in an impact, relative to its speed (–), and the radius of the rock (m).
    pub(crate) fn add_onsets(
        &self,
        first_onset: &mut FirstOnset,
        (end, hh): (&StageMotion, f64),
        (allowed, radius_m): (f64, f64),
    ) {
        let has_come_up = |one: &&StageContact| self.histories[one.history].met_m_s > 0.0;
        for contact in self.stage_contacts().iter().filter(has_come_up) {
            let met = (contact.penetration_at(&end.v, hh), -contact.n.dot(&end.v));
            first_onset.add(met, None, (allowed, radius_m));
        }
    }
}

impl RockTrial<'_, '_> {
    /// The share (–) of a step of `dt` (s) after which an impact has just begun that it runs into; none if it runs into none. `hh` is
    /// the part of the step that its last stage is implicit in (s).
    pub(super) fn until_impact(&mut self, end: &StageMotion, (dt, hh): (f64, f64)) -> Option<f64> {
        if !self.state.onset.is_reached {
            return None;
        }
        let mut first_onset = FirstOnset::within(dt, self.omega);
        let (allowed, radius_m) = (self.control.impact, self.world.body.radius);
        self.state.add_onsets(&mut first_onset, (end, hh), (allowed, radius_m));
        self.onsets.cut(&first_onset, dt * self.omega)
    }
}

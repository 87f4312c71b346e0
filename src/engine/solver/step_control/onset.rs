//! Onsets of impacts within an implicit step of rocks in sustained contact that strike a wall, a
//! tree or each other.
//!
//! The force of a dashpot sets in at once, as a jump within a step, and the error allowed in
//! sustained contact is no measure of an impact. So the force of a new contact that may rebound is
//! deferred: it is zero in the step in which the contact comes up, and the step is cut to end at
//! the onset. From there on the impact is resolved on its own time scale: for a rock alone by
//! explicit stages ([`explicit_impact`](crate::solver::explicit_impact)), in an island by implicit
//! ones, which are short and held to an error relative to the speed of the impact.

use super::{ONSET, PLACE_ROUNDING, RockTrial};
use crate::math;
use crate::solver::contact_state::ContactState;
use crate::solver::law::StageContact;
use crate::solver::stage::StageMotion;

/// Most cuts of a step for onsets within it.
pub(crate) const MOST_CUTS: u32 = 12;
/// A step this short locates an onset as exactly as rounding allows (rad of the stiffest contact).
pub(crate) const ONSET_ACCURACY_RAD: f64 = 1e-8;

/// Search for the first onset within a step, over its tries.
#[derive(Debug)]
pub(crate) struct OnsetSearch {
    /// Whether new contacts are deferred, and how often the step has been cut.
    defers: bool,
    cuts: u32,
}

impl OnsetSearch {
    /// Before the first try of a step.
    pub(crate) const NEW: Self = Self { defers: true, cuts: 0 };

    /// Whether new contacts are deferred in a try of so many radians.
    pub(crate) fn defers(&self, rad: f64) -> bool {
        self.defers && rad > ONSET_ACCURACY_RAD
    }

    /// The share (–) to which a try of so many radians must be cut for its first onset; `None` if
    /// that is at the end of the try.
    pub(crate) fn cut(&mut self, first_onset: &FirstOnset, rad: f64) -> Option<f64> {
        let share = first_onset.share();
        if share >= 1.0 {
            return None;
        }
        self.cuts += 1;
        if share * rad > ONSET_ACCURACY_RAD && self.cuts < MOST_CUTS {
            return Some(share);
        }
        // the contact exists from the start, or its onset is not found: it acts from here on
        self.defers = false;
        Some((ONSET / rad).min(1.0))
    }
}

/// The first onset of an impact within a try of a step.
#[derive(Debug)]
pub(crate) struct FirstOnset {
    dt: f64,
    /// The stiffest contact (rad/s).
    omega: f64,
    is_closed_at_end: bool,
    share: f64,
}

impl FirstOnset {
    /// No onset yet, in a try of `dt` (s) with a stiffest contact of `omega` (rad/s).
    pub(crate) const fn within(dt: f64, omega: f64) -> Self {
        Self { dt, omega, is_closed_at_end: false, share: 1.0 }
    }

    /// Adds a new contact of a rock with radius `radius_m` (m).
    ///
    /// `end` is penetration (m) and approach speed (m/s) at the end of the try; `start`, if known,
    /// is the positive gap (m) and the approach speed at its start. The contact counts as just
    /// begun while its penetration is at most that which its speed gives within the share `allowed`
    /// (–), the local error allowed relative to the speed.
    pub(crate) fn add(
        &mut self,
        end: (f64, f64),
        start: Option<(f64, f64)>,
        (allowed, radius_m): (f64, f64),
    ) {
        let (penetration_m, approach_m_s) = end;
        let negligible_m = (allowed * approach_m_s / self.omega).max(PLACE_ROUNDING * radius_m);
        self.is_closed_at_end |= penetration_m > 0.0;
        if penetration_m > negligible_m {
            // slightly beyond the onset, so that the contact is closed at the start of the next
            // step
            let wanted_m = 0.5 * negligible_m;
            let share = if let Some((gap_m, start_approach_m_s)) = start {
                // a deferred contact exerts no force in the try, so its motion is smooth
                let [from, to] = [
                    [-gap_m - wanted_m, start_approach_m_s * self.dt],
                    [penetration_m - wanted_m, approach_m_s * self.dt],
                ];
                let share = math::hermite_crossing(from, to, false);
                // the onset of one that was open is after the start, however small its gap
                share.max(2.0 * ONSET_ACCURACY_RAD / (self.dt * self.omega))
            } else if approach_m_s > 0.0 {
                1.0 - (penetration_m - wanted_m) / approach_m_s / self.dt
            } else {
                0.0
            };
            self.share = self.share.min(share);
        }
    }

    /// Share of the try at which the first onset lies (–): 1 or more where contacts have hardly
    /// begun, not positive where one exists from the start.
    fn share(&self) -> f64 {
        // a contact may also close and open again within the step
        if self.is_closed_at_end { self.share } else { 0.5 }
    }
}

impl ContactState {
    /// Adds the rock's contacts that are new in the present try, which ends at `end`. `hh` is the
    /// length of its last implicit stage (s), `allowed` the local error allowed in an impact (–,
    /// relative to its speed).
    pub(crate) fn add_onsets(
        &self,
        first_onset: &mut FirstOnset,
        (end, hh): (&StageMotion, f64),
        (allowed, radius_m): (f64, f64),
    ) {
        let is_new = |one: &&StageContact| self.histories[one.history].onset_m_s > 0.0;
        for contact in self.stage_contacts().iter().filter(is_new) {
            let at_end = (contact.penetration_at(&end.v, hh), -contact.n.dot(&end.v));
            first_onset.add(at_end, None, (allowed, radius_m));
        }
    }
}

impl RockTrial<'_, '_> {
    /// Share (–) of a try of `dt` (s) at which the first onset within it lies; `None` without one.
    /// `hh` is the length of its last implicit stage (s).
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

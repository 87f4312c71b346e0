//! Impacts that begin within an implicit step of a rock in lasting contact, which rolls along and strikes a wall or a tree.
//!
//! The force of a dashpot is there at once, a jump within a step, and what is allowed to lasting contact is no measure of an impact. So a
//! contact that may rebound presses nothing in the step in which it comes up, the step ends where it begins, and from there on it is
//! followed in its own time ([`explicit_impact`](crate::solver::explicit_impact)).

use super::{ONSET, PLACE_ROUNDING, RockTrial};
use crate::solver::stage::End;

/// Most cuts of a step for impacts that begin within it.
pub(crate) const MOST_CUTS: u32 = 12;
/// A step this short ends where an impact begins, as exactly as anybody can tell (rad of the stiffest contact).
pub(crate) const MET: f64 = 1e-8;

impl RockTrial<'_, '_> {
    /// The share (–) of a step of `dt` (s) after which an impact has just begun that it runs into; none if it runs into none. `hh` is
    /// the part of the step that its last stage is implicit in (s).
    pub(super) fn until_impact(&mut self, end: &End, (dt, hh): (f64, f64)) -> Option<f64> {
        if !self.state.onset.is_met {
            return None;
        }
        let share = self.begun(end, (dt, hh));
        if share >= 1.0 {
            return None;
        }
        self.cuts += 1;
        if share * dt * self.omega > MET && self.cuts < MOST_CUTS {
            return Some(share);
        }
        // it has popped up, or is not to be met: it presses from where it is found
        self.waits = false;
        Some((ONSET / (dt * self.omega)).min(1.0))
    }

    /// The same, 1 or more where what has come up has hardly begun, not positive where it has been there from the start.
    fn begun(&self, end: &End, (dt, hh): (f64, f64)) -> f64 {
        let least_m = PLACE_ROUNDING * self.world.body.radius;
        let contacts = &self.state.contacts[..self.state.contact_count];
        let come = contacts.iter().filter(|it| self.state.histories[it.history].met_m_s > 0.0);
        let (mut is_at_end, mut share) = (false, 1.0f64);
        for contact in come {
            let (pressed_m, comes_m_s) = (contact.pen_at(&end.v, hh), -contact.n.dot(&end.v));
            let begins_m = (self.control.impact * comes_m_s / self.omega).max(least_m);
            is_at_end |= pressed_m > 0.0;
            if pressed_m > begins_m {
                // a little behind its beginning, so that the next step begins with it
                let since_s = (pressed_m - 0.5 * begins_m) / comes_m_s;
                share = share.min(if comes_m_s > 0.0 { 1.0 - since_s / dt } else { 0.0 });
            }
        }
        // one that has come and gone within the step
        if is_at_end { share } else { 0.5 }
    }
}

//! Impacts that begin within an implicit step.
//!
//! A dashpot acts at once when a contact begins. Inside a step its force is a jump, and no step is
//! short enough for the error estimate to meet a tight tolerance. So a contact that closes fast
//! enough to rebound exerts no force in the step in which it begins, and the step is cut at its
//! onset, as the steps of an explicitly integrated impact are ([`explicit`](super::explicit)).

use super::explicit::ROUNDING_OF_PLACE;
use super::{BlockContactState, BlockState, Springs};
use crate::body::Block;
use crate::solver::environment::ContactEnvironment;
use crate::solver::step_control::{Control, MOST_CUTS, ONSET_ACCURACY_RAD, RESOLVED};

/// Onsets of impacts in the trial steps of one step.
#[derive(Debug)]
pub(super) struct Onsets {
    /// Penetration to which an onset is resolved: per approach speed (s), and at least (m).
    onset_s: f64,
    least_m: f64,
    /// Cuts so far, and whether contacts that begin press at once.
    cuts: u32,
    pub(super) acts_at_once: bool,
}

impl Onsets {
    /// For a largest contact frequency (rad/s) and the radius of a rock (m).
    pub(super) fn new(control: &Control, (omega, radius_m): (f64, f64)) -> Self {
        let onset_s = control.impact / omega;
        Self { onset_s, least_m: ROUNDING_OF_PLACE * radius_m, cuts: 0, acts_at_once: false }
    }

    /// Time (s) of the first onset in a stage that ends at `end`, `now_s` (s) after the step's
    /// start and `way_s` (s) after its base.
    pub(super) fn first(
        &self,
        springs: &Springs,
        (block, end, way_s): (&Block, &BlockState, f64),
        now_s: f64,
    ) -> Option<f64> {
        let begun = springs.contacts.iter().filter(|contact| contact.is_suspended);
        let begun = begun.filter_map(|contact| {
            let u = end.velocity_at(block, &contact.lever);
            let (pressed_m, closing_m_s) =
                (contact.penetration_after(&u, way_s), -contact.n.dot(&u));
            let onset_m = (self.onset_s * closing_m_s).max(self.least_m);
            if pressed_m <= onset_m {
                return None;
            }
            // a little after its onset, so that the next step begins with it; a contact that does
            // not close has appeared where it is
            let since_s = (pressed_m - 0.5 * onset_m) / closing_m_s;
            Some(if closing_m_s > 0.0 { (now_s - since_s).max(0.0) } else { 0.0 })
        });
        begun.reduce(f64::min)
    }

    /// Share (–) to which a trial step of `rad` radians is cut. A contact that has appeared, and
    /// one that is still not resolved after many cuts, presses from where it is found, in a step so
    /// short that little of the impact is over by its end: the tolerance of lasting contact does
    /// not apply to it.
    pub(super) fn cut(&mut self, share: f64, rad: f64) -> f64 {
        self.cuts += 1;
        self.acts_at_once = share * rad <= ONSET_ACCURACY_RAD || self.cuts >= MOST_CUTS;
        if self.acts_at_once { (RESOLVED / rad).min(1.0) } else { share }
    }

    /// Error of a trial step of `rad` radians over the allowed one (–). If a contact begins to
    /// press in it, the step is accepted once it is so short that the onset cannot be located
    /// within it: its error is that of the jump.
    pub(super) fn bounded(&self, error: f64, rad: f64) -> f64 {
        if self.acts_at_once && rad <= ONSET_ACCURACY_RAD { error.clamp(0.0, 1.0) } else { error }
    }
}

impl BlockContactState {
    /// After an accepted step that was cut at an onset: its impacts begin with the next step.
    pub(super) fn restart_at_onset(&mut self, world: &ContactEnvironment) {
        let late = |contact: &super::SpringContact| contact.is_suspended;
        if !self.springs.contacts.iter().any(late) {
            return;
        }
        let mut impacts = self.springs.histories.iter().filter(|one| !one.captured);
        if impacts.any(|one| one.age_rad <= 0.0) {
            self.springs.h = self.first_step_s(world);
            self.springs.invalidate_rates();
        }
    }
}

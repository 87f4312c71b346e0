//! Impacts that begin within an implicit step.
//!
//! The force of a dashpot is there at once when a contact begins: inside a step it is a jump, and no step is so short that its error says it
//! is accurate where little is allowed. So a contact that comes up fast enough to rebound presses nothing in the step in which it
//! comes up, and the step is cut where it begins, as those of an impact in its own time are ([`explicit`](super::explicit)).

use super::explicit::ROUNDING_OF_PLACE;
use super::{BlockContactState, BlockState, Springs};
use crate::body::Block;
use crate::solver::environment::ContactEnvironment;
use crate::solver::step_control::{Control, MET, MOST_CUTS, RESOLVED};

/// Where in the tries of one step impacts begin.
#[derive(Debug)]
pub(super) struct Onsets {
    /// Penetration (m) up to which one need not be met more exactly, by speed of approach (s) and at least.
    onset_s: f64,
    least_m: f64,
    /// Cuts so far, and whether what comes up presses at once.
    cuts: u32,
    pub(super) acts_at_once: bool,
}

impl Onsets {
    /// With a stiffest contact (rad/s) and the radius of a rock (m).
    pub(super) fn new(control: &Control, (omega, radius_m): (f64, f64)) -> Self {
        let onset_s = control.impact / omega;
        Self { onset_s, least_m: ROUNDING_OF_PLACE * radius_m, cuts: 0, acts_at_once: false }
    }

    /// When (s) the first impact has begun that a stage has run into, which ends at `end`, `now_s` (s) after the step's start and `way_s`
    /// (s) after its base.
    pub(super) fn first(
        &self,
        springs: &Springs,
        (block, end, way_s): (&Block, &BlockState, f64),
        now_s: f64,
    ) -> Option<f64> {
        let begun = springs.contacts.iter().filter(|contact| contact.is_suspended);
        let begun = begun.filter_map(|contact| {
            let u = end.velocity_at(block, &contact.lever);
            let (pressed_m, comes_m_s) = (contact.penetration_after(&u, way_s), -contact.n.dot(&u));
            let onset_m = (self.onset_s * comes_m_s).max(self.least_m);
            if pressed_m <= onset_m {
                return None;
            }
            // a little behind its beginning, so that the next step begins with it; what does not come has popped up
            let since_s = (pressed_m - 0.5 * onset_m) / comes_m_s;
            Some(if comes_m_s > 0.0 { (now_s - since_s).max(0.0) } else { 0.0 })
        });
        begun.reduce(f64::min)
    }

    /// The share (–) to which a try of so many radians is cut. One that has popped up, and what is still not met after many cuts, presses
    /// from where it is found, in a step so short that little of the impact is over by its end: what is allowed to lasting contact is no measure of it.
    pub(super) fn cut(&mut self, share: f64, rad: f64) -> f64 {
        self.cuts += 1;
        self.acts_at_once = share * rad <= MET || self.cuts >= MOST_CUTS;
        if self.acts_at_once { (RESOLVED / rad).min(1.0) } else { share }
    }

    /// The error of a try of so many radians, over the one allowed (–). One in which a contact comes to press is accepted once it is so short
    /// that nobody can tell where in it: its error is that of the jump.
    pub(super) fn bounded(&self, error: f64, rad: f64) -> f64 {
        if self.acts_at_once && rad <= MET { error.clamp(0.0, 1.0) } else { error }
    }
}

impl BlockContactState {
    /// After an accepted step: the impacts at whose beginning it was cut begin with the next one.
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

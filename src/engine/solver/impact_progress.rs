//! How far an impact that is followed in its own time has come.
//!
//! An impact that has not ended after `IMPACT_DURATION_RAD` radians of its contact is none any more: the rock
//! rolls, slides or rests, and implicit steps take over, whose length does not hang on `ω`.

use crate::contact::pair::IMPACT_DURATION_RAD;

/// What an impact needs besides the rock's state.
#[derive(Debug, Clone, Default)]
pub(crate) struct ImpactProgress {
    /// The step to try next (s), if there is one.
    pub(super) h: f64,
    /// Fastest approach of the contacts (m/s).
    pub(super) speed_m_s: f64,
    /// How much longer it is followed in its own time (rad).
    pub(super) left: f64,
    /// Energy that the steps have gained (J).
    pub(super) gained: f64,
    /// Whether springs of several grounds were pressed at once: where their patches meet or part one takes over what the other held.
    pub(super) mixes: bool,
}

impl ImpactProgress {
    /// Forgets the impact before.
    pub(crate) fn forget(&mut self) {
        (self.speed_m_s, self.left) = (0.0, 0.0);
    }

    /// Goes on for so long (rad) where it is not followed in its own time.
    pub(super) fn pass(&mut self, rad: f64) {
        self.left = (self.left - rad).max(0.0);
    }

    /// A contact begins at `speed_m_s` that may rebound; `slowest` is the speed from which on it is followed here.
    pub(crate) fn meet(&mut self, speed_m_s: f64, slowest: f64) {
        if speed_m_s <= slowest {
            return;
        }
        if self.left <= 0.0 {
            (self.h, self.gained, self.mixes) = (0.0, 0.0, false);
        }
        // a further contact within an impact prolongs it, and the fastest approach sets the scale
        // of its error
        (self.speed_m_s, self.left) = (self.speed_m_s.max(speed_m_s), IMPACT_DURATION_RAD);
    }
}

//! How far an impact that is followed in its own time has come.
//!
//! An impact that has not ended after `LASTS_RAD` radians of its contact is none any more: the rock
//! rolls, slides or rests, and implicit steps take over, whose length does not hang on `ω`.

use crate::contact::pair::LASTS_RAD;

/// What an impact needs besides the rock's state.
#[derive(Debug, Clone, Default)]
pub(crate) struct ImpactProgress {
    /// The step to try next (s), if there is one.
    pub(super) h: f64,
    /// Fastest approach of the contacts (m/s).
    pub(super) speed_m_s: f64,
    /// How much longer it is followed in its own time (rad).
    pub(super) left_rad: f64,
    /// Energy that the steps have gained (J).
    pub(super) gained_j: f64,
    /// Whether springs of several grounds were pressed at once: where their patches meet or part one takes over what the other held.
    pub(super) mixes_grounds: bool,
}

impl ImpactProgress {
    /// Forgets the impact before.
    pub(crate) fn forget(&mut self) {
        (self.speed_m_s, self.left_rad) = (0.0, 0.0);
    }

    /// Goes on for so long (rad) where it is not followed in its own time.
    pub(super) fn elapse(&mut self, rad: f64) {
        self.left_rad = (self.left_rad - rad).max(0.0);
    }

    /// A contact begins at `speed_m_s` that may rebound; `slowest` is the speed from which on it is followed here.
    pub(crate) fn add_contact(&mut self, speed_m_s: f64, slowest: f64) {
        if speed_m_s <= slowest {
            return;
        }
        if self.left_rad <= 0.0 {
            (self.h, self.gained_j, self.mixes_grounds) = (0.0, 0.0, false);
        }
        // a further contact within an impact prolongs it, and the fastest approach sets the scale
        // of its error
        (self.speed_m_s, self.left_rad) = (self.speed_m_s.max(speed_m_s), LASTS_RAD);
    }
}

//! Progress of an impact that is resolved on its own time scale.
//!
//! An impact that has not ended after `IMPACT_DURATION_RAD` radians of its contact has become sustained
//! contact: the rock rolls, slides or rests. Implicit steps take over, whose length does not depend
//! on `ω`.
use crate::contact::pair::IMPACT_DURATION_RAD;

/// State of an impact beside that of the rock.
#[derive(Debug, Clone, Default)]
pub(crate) struct ImpactProgress {
    /// The step to try next (s), if there is one.
    pub(super) h: f64,
    /// Fastest approach of the contacts (m/s).
    pub(super) speed_m_s: f64,
    /// Remaining time for which it is resolved on its own time scale (rad).
    pub(super) left_rad: f64,
    /// Energy gained by the steps so far (J).
    pub(super) gained_j: f64,
    /// Whether springs of several grounds were pressed at once: where their patches merge or split,
    /// one takes over what the other stored.
    pub(super) mixes_grounds: bool,
}

impl ImpactProgress {
    /// Forgets the previous impact.
    pub(crate) fn forget(&mut self) {
        (self.speed_m_s, self.left_rad) = (0.0, 0.0);
    }

    /// Reduces the remaining time by `rad` (rad), where other steps than its own were taken.
    pub(super) fn elapse(&mut self, rad: f64) {
        self.left_rad = (self.left_rad - rad).max(0.0);
    }

    /// Adds a contact that may rebound and begins at `speed_m_s`. Impacts no faster than `slowest`
    /// (m/s) are not resolved by themselves.
    pub(crate) fn add_contact(&mut self, speed_m_s: f64, slowest: f64) {
        if speed_m_s <= slowest {
            return;
        }
        if self.left_rad <= 0.0 {
            (self.h, self.gained_j, self.mixes_grounds) = (0.0, 0.0, false);
        }
        // a further contact prolongs the impact, and the fastest approach sets the scale of its
        // error
        (self.speed_m_s, self.left_rad) = (self.speed_m_s.max(speed_m_s), IMPACT_DURATION_RAD);
    }
}

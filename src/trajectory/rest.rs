//! When a rock is at rest: slow for long enough, and not about to get faster.
//!
//! A rock that tips over a ridge or a pyramid that gives way starts slowly. So the rest time counts only if the rock was no
//! faster in the second half of it than in the first; a speed far below that of the rule is the settling of springs and says
//! nothing.

use crate::plan::RestRule;

/// Share of the rest speed below which a change of speed says nothing (–).
const NOISE: f64 = 1e-3;

/// How long a rock has been slow, and how fast it was then.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rest {
    quiet_s: f64,
    /// Largest speeds in the first and the second half of the rest time (m/s).
    fastest: [f64; 2],
}

impl Rest {
    /// Whether the rock is at rest after `dt` (s) more at `speed_m_s`, the larger of that of its centre and of its surface.
    pub(super) fn is_reached(&mut self, rule: &RestRule, dt: f64, speed_m_s: f64) -> bool {
        if speed_m_s >= rule.speed_m_s {
            *self = Self::default();
            return false;
        }
        let half = usize::from(self.quiet_s >= 0.5 * rule.time_s);
        self.quiet_s += dt;
        self.fastest[half] = self.fastest[half].max(speed_m_s);
        if self.quiet_s < rule.time_s {
            return false;
        }
        let [first, second] = self.fastest;
        if half == 1 && second <= first.max(NOISE * rule.speed_m_s) {
            return true;
        }
        // It gets faster, or all that time was one long step: look again.
        *self = Self::default();
        self.fastest[0] = speed_m_s;
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: RestRule = RestRule { speed_m_s: 0.02, time_s: 0.3 };

    fn reached_after(speed: impl Fn(f64) -> f64) -> Option<f64> {
        let (mut rest, dt) = (Rest::default(), 0.01);
        (1..1000).map(|k| f64::from(k) * dt).find(|t| rest.is_reached(&RULE, dt, speed(*t)))
    }

    /// What slows down or swings on is at rest once the time is over; what speeds up never is.
    #[test]
    fn what_speeds_up_is_not_at_rest() {
        assert!(reached_after(|_| 0.0).is_some_and(|t| t < 0.32));
        assert!(reached_after(|t| 0.01 * (-t).exp()).is_some_and(|t| t < 0.32));
        assert!(reached_after(|t| 0.01 * (40.0 * t).sin().abs()).is_some());
        assert!(reached_after(|t| 1e-3 * (4.0 * t).exp()).is_none());
        assert!(reached_after(|t| 0.03 * t).is_none());
    }
}

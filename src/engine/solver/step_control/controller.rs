//! Trying steps until one is accurate: the one controller of all steps whose error is controlled, in space, on a plane, of blocks and in
//! islands.

use super::{Control, StepError};
use crate::math;
use crate::solver::tableau::RATIO;

/// The step controller's safety factor (–).
const SAFETY: f64 = 0.9;
/// A step shorter than this, in radians of the stiffest contact, cannot help any more (–).
const SHORTEST: f64 = 1e-9;

/// What one try of a step came to.
#[derive(Debug, Clone, Copy)]
pub(crate) enum TryOutcome {
    /// Its local error relative to the tolerance; accepted up to 1.
    Error(f64),
    /// Accurate, but with more energy than before: it has met a kink of the law in an unlucky place, and a shorter one
    /// does not.
    EnergyGain,
    /// Something begins at this share of it (–, 0..1), where it has to end: that is no error.
    Cut(f64),
    /// A stage did not settle.
    NotConverged,
    /// The rock has left where the trial holds.
    OutOfDomain,
}

/// Why no step was found.
#[derive(Debug, Clone, Copy)]
pub(crate) enum StepFailure {
    /// No step, however short, settles.
    NotConverged,
    /// The trial does not hold where the rock goes.
    OutOfDomain,
}

impl From<StepFailure> for StepError {
    fn from(_: StepFailure) -> Self {
        Self::NotConverged
    }
}

/// A step that can be tried with any length.
pub(crate) trait TrialStep {
    /// The step to try next (s).
    fn h(&mut self) -> &mut f64;
    /// The longest step that cannot jump over a feature (s).
    fn limit(&mut self) -> f64;
    /// Tries it with length `dt` (s).
    fn try_step(&mut self, dt: f64) -> TryOutcome;
}

/// Tries steps until one is accurate and returns its length (s), at most `h_max`, which does not count against the step to
/// try next; the stiffest contact has `omega` (rad/s).
/// The one place where steps are accepted, for stages in space, on a plane and in islands alike.
pub(crate) fn find_accepted_step(
    trial: &mut impl TrialStep,
    control: &Control,
    (h_max, omega): (f64, f64),
    rejected: &mut u64,
) -> Result<f64, StepFailure> {
    loop {
        let limit = trial.limit();
        let proposed = trial.h().min(limit);
        let dt = proposed.min(h_max);
        let ratio = match trial.try_step(dt) {
            TryOutcome::Error(error) if error <= 1.0 => {
                // a step cut short by `h_max` says nothing of how long it could have been
                let least = if dt < proposed { proposed } else { 0.0 };
                *trial.h() = scaled_by_error(control, dt, error).max(least);
                return Ok(dt);
            }
            TryOutcome::Error(error) if error.is_finite() => scaled_by_error(control, 1.0, error),
            TryOutcome::EnergyGain => 0.4,
            TryOutcome::Cut(share) => share,
            TryOutcome::OutOfDomain => return Err(StepFailure::OutOfDomain),
            _ => 0.25,
        };
        *rejected += 1;
        *trial.h() = dt * ratio;
        // one that began so short may be tried again as it is
        if ratio < 1.0 && dt * ratio * omega < SHORTEST {
            return Err(StepFailure::NotConverged);
        }
    }
}

fn scaled_by_error(control: &Control, dt: f64, error: f64) -> f64 {
    dt * (SAFETY * math::pow(error, -control.tableau.exponent)).clamp(RATIO.0, RATIO.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::step_control::RESOLVED;
    use crate::solver::tableau::ESDIRK4;

    /// A contact that has popped up at the start of a step: it has to press at once, which the step is then tried with.
    struct Popped {
        h: f64,
        presses: bool,
    }

    impl TrialStep for Popped {
        fn h(&mut self) -> &mut f64 {
            &mut self.h
        }

        fn limit(&mut self) -> f64 {
            f64::INFINITY
        }

        fn try_step(&mut self, dt: f64) -> TryOutcome {
            if std::mem::replace(&mut self.presses, true) {
                TryOutcome::Error(0.5)
            } else {
                TryOutcome::Cut((RESOLVED / dt).min(1.0))
            }
        }
    }

    /// A step may begin shorter than any that helps, after an impact that ended with such a one or because little is asked for: to try it again as it is
    /// is not to give up. Boxes that slid on blunt folds failed so with `reference`: 3 of 200, and 2 of 8 where edges were let go as well.
    #[test]
    fn a_step_that_begins_short_settles() {
        let control =
            Control { tableau: &ESDIRK4, tolerance: 1e-8, impact: 1e-10, impact_kernels: true };
        let short = [1.0, 1e-6, 0.5 * SHORTEST, 1e-3 * SHORTEST];
        for (h, most_s) in short.into_iter().flat_map(|h| [(h, 1.0), (1.0, h)]) {
            let (mut trial, mut rejected) = (Popped { h, presses: false }, 0);
            let dt = find_accepted_step(&mut trial, &control, (most_s, 1.0), &mut rejected);
            assert!(dt.is_ok_and(|dt| dt > 0.0 && dt <= most_s), "{h:e} {most_s:e}: {dt:?}");
        }
    }
}

//! A setting so much coarser or finer.

use crate::math;
use crate::solver::Settings;
use crate::solver::step_control::COARSEST_M_S;

/// Longest way of a corner that is still less than its ball: a step may not jump over what it should strike (–).
const LONGEST_WAY: f64 = 1.0;

/// The same setting with another tolerance or step. In contact the steps of a block are mostly bound by the way of its corners, which goes
/// with them: else a finer setting would take the same steps, and its error would seem to be none.
pub(super) fn finer(step: &Settings, relative: f64, has_blocks: bool) -> Settings {
    let mut finer = *step;
    if step.scheme.controls_error() {
        // what is coarser than the coarsest that is felt is no coarser: finer than that it has to be
        let felt_m_s = step.tolerance_m_s.min(COARSEST_M_S);
        finer.tolerance_m_s =
            if relative < 1.0 { felt_m_s * relative } else { step.tolerance_m_s * relative };
    } else {
        finer.step_s *= relative;
    }
    if has_blocks {
        let way = step.corner_way * math::pow(relative, per_tolerance(step));
        finer.corner_way = way.min(LONGEST_WAY);
    }
    finer
}

/// Length of the steps against what refines a scheme: `step ~ tolerance^(1/(p̂+1))` with the order `p̂` of the embedded method.
fn per_tolerance(step: &Settings) -> f64 {
    step.scheme.tableau().map_or(1.0, |tableau| tableau.exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::{CORNER_WAY, Scheme};
    use crate::study::bench::settings;

    /// Steps of a block get shorter with the setting; a sphere's setting has no corners.
    #[test]
    fn corners_go_with_the_steps() {
        for scheme in Scheme::ALL {
            let eighth = scheme.of([0.125, 0.5, math::pow(0.125, 0.25), 0.125]);
            let own = settings(scheme, 0.01, None);
            let short = finer(&own, 0.125, true).corner_way;
            assert!((short / (CORNER_WAY * eighth) - 1.0).abs() < 1e-12, "{scheme:?} {short}");
            assert!((finer(&own, 0.125, false).corner_way - CORNER_WAY).abs() < 1e-15);
            assert!(finer(&own, 4096.0, true).corner_way <= LONGEST_WAY);
        }
    }
}

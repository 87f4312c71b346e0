//! The step in force: what the scene asks for, the rest filled in.

use crate::scene::SolverTable;
use crate::solver::{CORNER_WAY, MOST_WITH_SPRINGS, RIGID_STEP_S, Settings};

/// Local error of the adaptive scheme (m/s): statistics of runout no longer change below it.
const TOLERANCE_M_S: f64 = 0.05;
/// Local error of the reference scheme (m/s).
const REFERENCE_TOLERANCE_M_S: f64 = 1e-8;

/// The step in force, defaults filled in. What a scheme has no use for is 0 (tolerance) or without limit (step).
pub(super) fn in_force(solver: &SolverTable) -> Settings {
    let scheme = solver.scheme();
    // the scene check has made sure that dda has a step of its own
    let tolerance_m_s = scheme.of([0.0, TOLERANCE_M_S, REFERENCE_TOLERANCE_M_S, 0.0]);
    let step_s = if scheme.has_springs() { f64::INFINITY } else { RIGID_STEP_S };
    Settings {
        scheme,
        tolerance_m_s: solver.tolerance_m_s.unwrap_or(tolerance_m_s),
        step_s: solver.step_s.unwrap_or(step_s),
        shear_memory: solver.shear_memory.unwrap_or(true),
        impact_kernels: scheme.controls_error(),
        rigid_heaps: scheme.leaves_heaps_rigid(),
        corner_way: solver.corner_way.unwrap_or(CORNER_WAY),
        capture_speed_m_s: solver.capture_speed_m_s,
    }
}

/// How an impact on one plane is followed, in words.
pub(super) fn plane_impacts(step: &Settings) -> &'static str {
    let followed = if step.impact_kernels {
        "followed as a whole, in their own time; all others step by step"
    } else {
        "left out: every impact is followed step by step"
    };
    step.scheme.of([
        "left out: the fixed step knows no other",
        followed,
        followed,
        "in no time: the limit of stiff springs",
    ])
}

/// What goes by explicit stages where rocks have shapes, in words; nothing where they take no time or the step is fixed.
pub(super) fn block_impacts(step: &Settings, rolls: bool) -> Option<&'static str> {
    step.scheme.controls_error().then_some(if step.impact_kernels && !rolls {
        "impacts of blocks, in their own time; those of more than six contacts, and contacts that last, go by implicit stages"
    } else {
        "left out: every impact of a block goes by implicit stages"
    })
}

/// How islands are stepped, in words.
pub(super) fn islands(step: &Settings, has_bonds: bool) -> String {
    if !step.scheme.has_springs() {
        return "; impacts in the order of their times, sustained contact swept".to_owned();
    }
    if !step.rigid_heaps || has_bonds {
        return String::new();
    }
    format!(
        "; heaps of more than {MOST_WITH_SPRINGS} that touch go on as with rigid where none is struck hard: what a spring does within a blow is left out there"
    )
}

/// Scheme and step in force, in words.
pub(super) fn scheme(step: &Settings) -> String {
    let name = step.scheme.name();
    if step.scheme.controls_error() {
        format!("{name}, local error {} m/s", step.tolerance_m_s)
    } else if step.scheme.has_fixed_step() {
        let memory = if step.shear_memory { "with" } else { "as printed, without" };
        format!("{name}, steps of {} s, {memory} shear memory", step.step_s)
    } else {
        format!("{name}, steps of up to {} s", step.step_s)
    }
}

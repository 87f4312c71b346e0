//! The exact cases in their own units: what is exact, what comes out, how far apart. The table of the README.

use super::cases::{CASES, Case, CaseKind, CaseMeasure};
use super::exact::{PAPER, USUAL};
use crate::simulation::Scratch;
use crate::solver::Scheme;
use std::fmt::Write as _;

/// The columns: scheme with tolerance (m/s) or step (s). The first is the one whose value is shown.
const COLUMNS: [(Scheme, f64); 4] =
    [(USUAL.finest(), 1e-8), (USUAL, 1e-4), (USUAL, 0.05), (PAPER, 1e-5)];
/// A measure that should not change at all is no row: its exact value is below this (m, rad/s).
const STAYS: f64 = 1e-12;

/// One number of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactValue {
    /// Name of the case.
    pub case: &'static str,
    /// What happens, in a sentence.
    pub title: &'static str,
    /// What is measured, with its unit.
    pub what: &'static str,
    /// The exact value.
    pub exact: f64,
    /// What each of the columns gives.
    pub found: [f64; COLUMNS.len()],
}

/// Every case whose exact value is that of its springs. The columns all have springs, so one exact value.
pub fn values() -> Vec<ExactValue> {
    let is_sprung = |case: &&Case| case.exact.is_some() && case.kind != CaseKind::Slaps;
    CASES.iter().filter(is_sprung).flat_map(of_case).collect()
}

fn of_case(case: &Case) -> Vec<ExactValue> {
    let terrain = case.terrain();
    let mut scratch = Scratch::default();
    let journeys = COLUMNS.map(|(scheme, fineness)| {
        case.follow(&terrain, &case.settings(scheme, fineness), &mut scratch)
    });
    let start = (case.setup)(COLUMNS[0].0.has_springs()).centre_m;
    let moves = |measure: &CaseMeasure| {
        measure.exact.abs() > STAYS && start.iter().all(|at| (at - measure.exact).abs() > STAYS)
    };
    let value = |measure: CaseMeasure| ExactValue {
        case: case.name,
        title: case.title,
        what: measure.what,
        exact: measure.exact,
        found: journeys.each_ref().map(|journey| (measure.of)(journey)),
    };
    case.measures(&terrain, COLUMNS[0].0).into_iter().filter(moves).map(value).collect()
}

/// The table, as it stands in the README. Errors are absolute, in the unit of the row.
pub fn table(values: &[ExactValue]) -> String {
    let mut text = String::from("| exact case | exact | `reference`, 1e-8 m/s |");
    for (scheme, fineness) in COLUMNS {
        let (name, unit) = (scheme.name(), scheme.fineness_unit());
        let _ = write!(text, " error of `{name}`, {fineness:e} {unit} |");
    }
    let _ = writeln!(text, "\n|---|---|---|{}", "---|".repeat(COLUMNS.len()));
    for ExactValue { title, what, exact, found, .. } in values {
        let _ = write!(text, "| {title}: {what} | {exact:.10} | {:.10} |", found[0]);
        for found in found {
            let _ = write!(text, " {:.1e} |", (found - exact).abs());
        }
        text += "\n";
    }
    text
}

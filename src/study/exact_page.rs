//! The page of the exact cases: orders and savings as tables, then the figures.

use super::exact::{CaseStudy, Curve, LADDERS};
use super::exact_figure::order_in_words;
use crate::report::format;
use crate::step::Scheme;
use std::fmt::Write as _;

const INTRODUCTION: &str = "\
# Error against run time on the exact cases

Every scheme over a ladder of tolerances or steps, each case against its exact solution: schemes with springs against the
solution with springs, the rigid scheme against its limit. The error is the largest of the case's measures. Run times are
medians of repeated runs of one journey on one thread and differ from machine to machine; the counters in `exact.csv` do
not. The order is the slope of log error over log contact steps where the error is between 1e-8 and 0.1.

";

/// Writes the page.
pub(super) fn page(studies: &[CaseStudy]) -> String {
    let mut page = String::from(INTRODUCTION);
    orders(&mut page, studies);
    savings(&mut page, studies);
    page += "## Cases\n\n";
    for study in studies {
        let case = &study.case;
        let _ = writeln!(
            page,
            "### {}\n\n{}. Exact solution: {}.\n",
            case.name, case.title, case.source
        );
        let _ = writeln!(page, "![{0}](figures/{0}.svg)\n", case.name);
    }
    page
}

fn orders(page: &mut String, studies: &[CaseStudy]) {
    *page += "## Order of convergence\n\n| case |";
    for rungs in LADDERS {
        let _ = write!(page, " {} |", rungs.scheme.name());
    }
    let _ = writeln!(page, "\n|---|{}", "---|".repeat(LADDERS.len()));
    for study in studies {
        let _ = write!(page, "| {} |", study.case.name);
        for curve in &study.curves {
            let _ = write!(page, " {}; {} |", order_in_words(curve), reached(curve));
        }
        *page += "\n";
    }
    *page += "\n\"No order to see\": fewer than three errors between rounding and 0.1, or as many steps on every rung, because the error control finds nothing to refine.\n\n";
}

/// The smallest error on the ladder.
fn reached(curve: &Curve) -> String {
    let least = curve.points.iter().map(|point| point.error).fold(f64::INFINITY, f64::min);
    if least.is_finite() { format!("reaches {least:.0e}") } else { "fails".to_owned() }
}

fn savings(page: &mut String, studies: &[CaseStudy]) {
    let (ours, paper) = (Scheme::Adaptive.name(), Scheme::Dda.name());
    let _ = writeln!(
        page,
        "## What `{ours}` saves against `{paper}`\n\nAt each error that `{paper}` reaches: its cheapest run over the cheapest run of `{ours}` that is at least as good. \
         Both leap over free flight, so the ratio is that of the contact steps alone. At errors of some per cent an impact takes either scheme only a handful of steps and little can be saved; the ratio grows as the error falls, because one is first order and the other second.\n\n| case | error | run time | passes over the contacts |\n|---|---|---|---|"
    );
    for study in studies {
        for saving in study.savings() {
            let _ = writeln!(
                page,
                "| {} | {:.1e} | {} | {} |",
                study.case.name,
                saving.error,
                format::significant(saving.time, 2),
                format::significant(saving.sweeps, 2)
            );
        }
    }
    *page += "\n";
}

//! The page of the exact cases: orders and savings as tables, then the figures.

use super::exact::{CaseStudy, Curve, LADDERS, PAPER, Saving, USUAL};
use super::exact_figure::order_in_words;
use super::exact_values::{self, ExactValue};
use super::order::{self, OrderLadder};
use crate::report::format;
use std::fmt::Write as _;

const INTRODUCTION: &str = "\
# Error against run time on the exact cases

Every scheme over a ladder of tolerances or steps, each case against its exact solution: schemes with springs against the
solution with springs, the rigid scheme against its limit. The error is the largest of the case's measures. Run times are
medians of repeated runs of one journey on one thread (of long runs its own processor time) and differ from machine to
machine; the counters in `exact.csv` do not. The order is the slope of log error over log contact steps where the error is between 1e-8 and 0.1.

";

/// Writes the page.
pub(super) fn page(
    studies: &[CaseStudy],
    ladders: &[OrderLadder],
    values: &[ExactValue],
) -> String {
    let mut page = String::from(INTRODUCTION);
    page += "## Exact values\n\nErrors are absolute, in the unit of the row; all columns are schemes with springs, so there is one exact value.\n\n";
    page += &exact_values::table(values);
    page += "\n";
    page += &order::table(ladders);
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
        if study.says_something() {
            let _ = writeln!(page, "![{0}](figures/{0}.svg)\n", case.name);
        } else {
            page += "Every scheme is exact to rounding: there is no error to draw.\n\n";
        }
    }
    page
}

fn orders(page: &mut String, studies: &[CaseStudy]) {
    *page += "## Order of convergence under error control\n\nOver the ladders of the figures below. Kinks of the motion (touch, slip, lift-off) and the control decide here, not the smooth motion between them.\n\n| case |";
    for rungs in LADDERS {
        let _ = write!(page, " {} |", rungs.scheme.name());
    }
    let _ = writeln!(page, "\n|---|{}", "---|".repeat(LADDERS.len()));
    for study in studies {
        let _ = write!(page, "| {} |", study.case.name);
        for rungs in LADDERS {
            let _ = match study.curve(rungs.scheme) {
                Some(curve) => write!(page, " {}; {} |", order_in_words(curve), reached(curve)),
                None => write!(page, " – |"),
            };
        }
        *page += "\n";
    }
    *page += "\n\"No order to see\": fewer than three errors between rounding and 0.1, less than eight times the steps from the coarsest of them to the finest, because the error control finds little to refine, or errors that do not follow the steps. \"At rounding\": the same where errors come below 1e-8, so that what is left above it tells no order.\n\n";
}

/// The smallest error on the ladder.
fn reached(curve: &Curve) -> String {
    let least = curve.points.iter().map(|point| point.error).fold(f64::INFINITY, f64::min);
    if least.is_finite() { format!("reaches {least:.0e}") } else { "fails".to_owned() }
}

fn savings(page: &mut String, studies: &[CaseStudy]) {
    let (ours, paper) = (USUAL.name(), PAPER.name());
    let _ = writeln!(
        page,
        "## What `{ours}` saves against `{paper}`\n\nAt equal error: the cheapest run of `{paper}` over the cheapest run of `{ours}` that is at least as good. Both leap over free flight, \
         so the ratio is that of the contact steps alone (as published, `{paper}` also steps through the air). At errors of some per cent an impact takes either scheme only a handful of \
         steps and little can be saved; the ratio grows as the error falls, because one is first order and the other second. Errors below 1e-8 count as 1e-8.\n\n\
         | case | smallest error of both | times faster | times fewer passes | ten times faster at errors below |\n|---|---|---|---|---|"
    );
    for study in studies {
        let savings = study.savings();
        let Some(last) = savings.last() else {
            let _ = writeln!(page, "| {} | they do not both converge | | | |", study.case.name);
            continue;
        };
        let two = |value: f64| format::significant(value, 2);
        let from = ten_times_below(&savings)
            .map_or_else(|| "nowhere on the ladder".to_owned(), |error| format!("{error:.0e}"));
        let _ = writeln!(
            page,
            "| {} | {:.0e} | **{}** | {} | {from} |",
            study.case.name,
            last.error,
            two(last.time),
            two(last.sweeps)
        );
    }
    *page += "\nAt every error that `dda` reaches:\n\n| case | error | times faster | times fewer passes |\n|---|---|---|---|\n";
    for study in studies {
        for Saving { error, time, sweeps } in study.savings() {
            let two = |value: f64| format::significant(value, 2);
            let _ = writeln!(
                page,
                "| {} | {error:.1e} | {} | {} |",
                study.case.name,
                two(time),
                two(sweeps)
            );
        }
    }
    *page += "\n";
}

/// The largest error from which on, down to the smallest, the default scheme is ten times faster; `None` where the last is not.
fn ten_times_below(savings: &[Saving]) -> Option<f64> {
    let from = savings.iter().rev().take_while(|saving| saving.time >= 10.0).last()?;
    Some(from.error)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors fall along the ladder: the answer is where the tail that saves ten times begins.
    #[test]
    fn ten_times_faster_counts_from_the_fine_end() {
        let ladder = |times: &[f64]| -> Vec<Saving> {
            let errors = std::iter::successors(Some(1.0), |error| Some(0.1 * error));
            let saving = |(error, &time)| Saving { error, time, sweeps: 1.0 };
            errors.zip(times).map(saving).collect()
        };
        let found = |times: &[f64]| ten_times_below(&ladder(times));
        assert!((found(&[2.0, 12.0, 5.0, 11.0, 90.0]).unwrap() - 1e-3).abs() < 1e-12);
        assert!((found(&[20.0, 30.0]).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(found(&[20.0, 9.0]), None);
        assert_eq!(found(&[]), None);
    }
}

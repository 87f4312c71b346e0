//! The page of the stiff and extreme cases.

use super::{CaseOutcome, WAYS};
use std::fmt::Write as _;

const INTRODUCTION: &str = "\
# Stiff and extreme cases

Every case with every scheme, each number against its analytic expectation or a bound. A case outside its bound makes the
exit status of `rockfall study stability` 1. `stability.csv` has every number; the tables below show, case by case, how
many were held and the one nearest to its bound. `rockfall study stability SCENE` holds conservation over all releases of a
scene.

";

/// Writes the page.
pub(in crate::study) fn page(outcomes: &[CaseOutcome]) -> String {
    let mut page = String::from(INTRODUCTION);
    for way in WAYS {
        let unit = way.scheme.fineness_unit();
        let _ = writeln!(page, "- `{}` at {} {unit}", way.scheme.name(), way.fineness);
    }
    page += "\n![Stiffness against step](map.svg)\n\n| case |";
    for way in WAYS {
        let _ = write!(page, " {} |", way.scheme.name());
    }
    let _ = writeln!(page, " tightest |\n|---|{}---|", "---|".repeat(WAYS.len()));
    let mut cases: Vec<&str> = outcomes.iter().map(|outcome| outcome.case).collect();
    cases.dedup();
    for case in cases {
        let of_case = || outcomes.iter().filter(move |outcome| outcome.case == case);
        let _ = write!(page, "| {case} |");
        for way in WAYS {
            let all = of_case().filter(|outcome| outcome.scheme == way.scheme);
            let (held, count) =
                all.fold((0, 0), |(held, count), one| (held + usize::from(one.holds()), count + 1));
            let _ = match count {
                0 => write!(page, " – |"),
                _ => write!(page, " {held} of {count} |"),
            };
        }
        let tightest = of_case().max_by(|a, b| use_of(a).total_cmp(&use_of(b)));
        let words = tightest.map_or(String::new(), |one| {
            format!(
                "{} ({}, {}): {:.1e}, bound {:.1e}",
                one.law,
                one.scheme.name(),
                one.setting,
                one.found,
                one.bound
            )
        });
        let _ = writeln!(page, " {words} |");
    }
    broken(&mut page, outcomes);
    page
}

/// How much of its bound a number uses (–).
fn use_of(outcome: &CaseOutcome) -> f64 {
    if !outcome.holds() {
        return f64::INFINITY;
    }
    if outcome.bound > 0.0 { outcome.found / outcome.bound } else { 0.0 }
}

fn broken(page: &mut String, outcomes: &[CaseOutcome]) {
    let broken: Vec<&CaseOutcome> = outcomes.iter().filter(|outcome| !outcome.holds()).collect();
    if broken.is_empty() {
        let _ = writeln!(page, "\nAll {} bounds are kept.", outcomes.len());
        return;
    }
    let _ = writeln!(
        page,
        "\n## Outside their bounds\n\n| case | setting | scheme | what | found | bound |\n|---|---|---|---|---|---|"
    );
    for CaseOutcome { case, setting, scheme, law, found, bound } in broken {
        let _ = writeln!(
            page,
            "| {case} | {setting} | {} | {law} | {found:.2e} | {bound:.2e} |",
            scheme.name()
        );
    }
}

/// All numbers as CSV.
pub(in crate::study) fn csv(outcomes: &[CaseOutcome]) -> String {
    let mut text = String::from("case,setting,scheme,law,found,bound,holds\n");
    for outcome in outcomes {
        let CaseOutcome { case, setting, scheme, law, found, bound } = outcome;
        let _ = writeln!(
            text,
            "{case},\"{setting}\",{},\"{law}\",{found:.3e},{bound:.3e},{}",
            scheme.name(),
            outcome.holds()
        );
    }
    text
}

//! The answer at each line and barrier, a sentence each: what a run says last.

use super::bound::Is;
use super::format::{
    self, counted, decimal, percent, percent_at_most, percents, sign, significant,
};
use super::model::energy_unit;
use super::words::Words;
use crate::hazard::{
    AnnualPlace, BarrierSummary, EventRate, LineSummary, Percentile, Proportion, Statistic,
};
use crate::output::Results;
use crate::scene::Language;

/// What arrives at every line and what every barrier has to take, in the order of the scene, in words.
pub fn answers(results: &Results) -> Vec<String> {
    let summary = &results.summary;
    let barriers = &summary.barriers;
    // what passes a barrier's line is the barrier's answer; its other places are no lines of the scene
    let is_own = |line: &&LineSummary| {
        !line.info.of_barrier && barriers.iter().all(|one| one.barrier.name != line.info.name)
    };
    let is_object =
        |line: &LineSummary| summary.asked.objects.iter().any(|one| one.name == line.info.name);
    let lines = summary.lines.iter().filter(is_own).map(|one| line(one, is_object(one)));
    let places = summary.annual.iter().flat_map(|annual| &annual.places).filter_map(in_a_year);
    lines.chain(barriers.iter().map(barrier)).chain(places).collect()
}

/// How often a year rocks come to an object with the largest energy asked for.
fn in_a_year(place: &AnnualPlace) -> Option<String> {
    let without = place.without_barriers.above.last().filter(|_| place.is_object)?;
    let with = place.with_barriers.as_ref().and_then(|figures| figures.above.last());
    let said = |rate: &EventRate| {
        let [value, low, high] =
            [rate.per_year, rate.low_95, rate.high_95].map(|one| significant(one, 2));
        let sign = sign(Is::at_least_if(rate.censored));
        format!("{sign}{value} times a year ({})", interval(&low, &high))
    };
    let barriers = with
        .map_or(String::new(), |with| format!(" without barriers, {} with them", said(&with.rate)));
    let (unit, size) = energy_unit(without.energy_j);
    let energy = significant(without.energy_j / size, 3);
    let name = &place.name;
    Some(format!("object \"{name}\": {energy} {unit} or more {}{barriers}", said(&without.rate)))
}

fn line(of: &LineSummary, is_object: bool) -> String {
    let name = &of.info.name;
    let [what, comes, come] =
        if is_object { ["object", "hits", "hit"] } else { ["line", "crosses", "cross"] };
    if of.reach.count == 0 {
        let may_come = but_may_come(of.reach.censored);
        return format!(
            "{what} \"{name}\": no rock {comes} it{may_come} {}",
            interval_of_none(&of.reach)
        );
    }
    let p95 = |column: &str, said: fn(&Percentile) -> String| {
        let found = of.statistics.get(column).and_then(known_p95);
        found.map_or_else(|| "needs more rocks".to_owned(), said)
    };
    format!(
        "{what} \"{name}\": {} of the rocks {come} it {}; P95 of energy {}, of height {}",
        share(&of.reach),
        share_interval(&of.reach),
        p95("total_j", energy),
        p95("height_m", height),
    )
}

fn barrier(of: &BarrierSummary) -> String {
    let name = &of.barrier.name;
    if of.arriving.count == 0 {
        let may_come = but_may_come(of.arriving.censored);
        return format!(
            "barrier \"{name}\": no rock arrives{may_come} {}",
            interval_of_none(&of.arriving)
        );
    }
    // with what rocks would come that may still come is not known
    let (them, by_whom) = if of.arriving.censored {
        ("those that came", ", by those that came")
    } else {
        ("them", "")
    };
    let design = match (&of.design_values, &of.barrier.design) {
        (Some(design), _) => {
            let (unit, size) = energy_unit(design.energy_j);
            format!(
                "; its rule asks for {} and {}{by_whom}",
                known((design.energy_j, design.energy_95_j), size, unit),
                known((design.height_m, design.height_95_m), 1.0, "m")
            )
        }
        (None, Some(_)) => {
            let more = of.design_lacks;
            let rocks = counted(more, "rock", "rocks");
            format!("; its rule needs {} more {rocks}", decimal(more as f64, 0))
        }
        (None, None) => String::new(),
    };
    format!(
        "barrier \"{name}\": {} of the rocks arrive {}, it stops {} of {them} {}{design}",
        share(&of.arriving),
        share_interval(&of.arriving),
        share(&of.stopped),
        share_interval(&of.stopped),
    )
}

/// Two written bounds; the terminal speaks English, whatever the language of the page.
fn interval(low: &str, high: &str) -> String {
    Words::of(Language::En).interval(low, high)
}

/// The 95th percentile, where there are rocks enough to bound it.
fn known_p95(statistic: &Statistic) -> Option<&Percentile> {
    statistic.percentiles.get("p95").filter(|p95| p95.lacks(statistic.rocks).is_none())
}

fn energy(p95: &Percentile) -> String {
    let (unit, size) = energy_unit(p95.value);
    with_interval(p95, size, unit)
}

fn height(p95: &Percentile) -> String {
    with_interval(p95, 1.0, "m")
}

fn with_interval(p95: &Percentile, size: f64, unit: &str) -> String {
    known((p95.value, [p95.low_95, p95.high_95]), size, unit)
}

/// A value with its interval in a unit so many times as large.
fn known((value, ends): (f64, [Option<f64>; 2]), size: f64, unit: &str) -> String {
    let [low, high] = ends.map(|end| end.map_or(f64::NAN, |end| end / size));
    let [value, low, high] = format::with_interval([value / size, low, high]);
    format!("{value} {unit} ({})", interval(&low, &high))
}

fn share(of: &Proportion) -> String {
    let [share, ..] = shares(of);
    sign(Is::at_least_if(of.censored)).to_owned() + &share
}

/// Stands behind none that is only a lower bound.
fn but_may_come(is_bound: bool) -> &'static str {
    if is_bound { ", some may still come" } else { "" }
}

fn share_interval(of: &Proportion) -> String {
    let [_, low, high] = shares(of);
    format!("({})", interval(&low, &high))
}

/// The interval of a share of which none was seen: its upper end is a bound, and is not rounded down.
fn interval_of_none(of: &Proportion) -> String {
    format!("({})", interval(&percent(0.0, 0), &percent_at_most(of.high_95)))
}

/// A share and the ends of its interval.
fn shares(of: &Proportion) -> [String; 3] {
    percents([of.share, of.low_95, of.high_95], digits)
}

/// One decimal below a tenth, where a full per cent would be coarse.
fn digits(share: f64) -> usize {
    usize::from(share < 0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a million rocks the interval of a share is narrower than a per cent: then it has the digit that shows it.
    #[test]
    fn a_narrow_interval_of_a_share_is_seen() {
        let said = |count: usize, of: usize| {
            let found = Proportion::new(count, of);
            format!("{} {}", share(&found), share_interval(&found)).replace('\u{2009}', " ")
        };
        assert_eq!(said(940_000, 1_000_000), "94.00 % (93.95 % to 94.05 %)");
        assert_eq!(said(940, 1000), "94.0 % (92.3 % to 95.4 %)");
        assert_eq!(said(0, 1_000_000), "0 % (0 % to 0.00030 %)");
        assert_eq!(said(3, 3_000), "0.10 % (0.02 % to 0.30 %)");
    }

    /// An object is hit, a line crossed: both stand below each other.
    #[test]
    fn objects_are_hit() {
        let said = |name: &str, is_object: bool| {
            let info = crate::hazard::LineInfo {
                name: name.to_owned(),
                length_m: 1.0,
                corners_m: Vec::new(),
                of_barrier: false,
                floor: None,
            };
            let found = crate::hazard::Line::new(info).summary(100, None);
            line(&found, is_object)
        };
        assert!(said("path", false).starts_with("line \"path\": no rock crosses it"));
        assert!(said("barn", true).starts_with("object \"barn\": no rock hits it"));
    }

    /// None of 2000 bounds a share by 0.15 %, one decimal of which would be 0.1 %.
    #[test]
    fn none_of_many_is_bounded_from_above() {
        let said = |of: usize| interval_of_none(&Proportion::new(0, of)).replace('\u{2009}', " ");
        assert_eq!(said(2000), "(0 % to 0.15 %)");
        assert_eq!(said(10_000), "(0 % to 0.030 %)");
        assert_eq!(said(1), "(0 % to 95 %)");
    }
}

//! What a year brings, from the summary: tables and curves. Every title says that its numbers are a year.

use super::super::format;
use super::super::model::{About, AnnualView, BandPoint, Estimate, Table};
use super::estimate;
use crate::hazard::{
    Annual, AnnualFigures, AnnualPlace, ExceedancePoint, Rate, ReturnEnergy, Risk,
};
use crate::output::Results;

/// Curves of all places.
pub(super) fn views(results: &Results) -> Vec<AnnualView> {
    let Some(annual) = &results.summary.annual else { return Vec::new() };
    let view = |place: &AnnualPlace| {
        let figures = &place.without_barriers;
        AnnualView {
            name: place.name.clone(),
            is_object: place.is_object,
            without: band(figures),
            with: place.with_barriers.as_ref().map(band),
            return_periods_years: figures.returns.iter().map(|one| one.years).collect(),
        }
    };
    annual.places.iter().map(view).collect()
}

/// A curve by rising energy.
fn band(figures: &AnnualFigures) -> Vec<BandPoint> {
    let point = |at: &ExceedancePoint| BandPoint {
        x: at.energy_j,
        y: estimate(at.per_year, Some(at.low_95), Some(at.high_95)),
    };
    figures.curve.iter().rev().map(point).collect()
}

/// Three tables a place: how often, with what energy, at what risk.
pub(super) fn tables(results: &Results) -> Vec<Table> {
    let Some(annual) = &results.summary.annual else { return Vec::new() };
    let each =
        |place: &AnnualPlace| [Some(passages(annual, place)), Some(returns(place)), risks(place)];
    annual.places.iter().flat_map(each).flatten().collect()
}

/// Name of a place with what it is.
fn named(place: &AnnualPlace) -> String {
    let what = if place.is_object { "object" } else { "line" };
    format!("{what} “{}”", place.name)
}

/// All figures of a place: without barriers first.
fn both(place: &AnnualPlace) -> impl Iterator<Item = (&'static str, &AnnualFigures)> {
    let without = if place.with_barriers.is_some() { ", without barriers" } else { "" };
    let with = place.with_barriers.iter().map(|figures| (", with barriers", figures));
    [(without, &place.without_barriers)].into_iter().chain(with)
}

fn passages(annual: &Annual, place: &AnnualPlace) -> Table {
    let all = if place.is_object { "Hits" } else { "Passages" };
    let mut rows = Vec::new();
    let mut say = |name: String, rate: &Rate| rows.push((name, cells(rate, annual)));
    for (which, figures) in both(place) {
        say(format!("{all}{which}"), &figures.passages);
        for above in &figures.above {
            say(format!("… with {} kJ or more{which}", kj(above.energy_j)), &above.rate);
        }
    }
    for saved in &place.saved {
        say(format!("Kept away by “{}”", saved.barrier), &saved.passages);
        for above in &saved.above {
            say(format!("… with {} kJ or more", kj(above.energy_j)), &above.rate);
        }
    }
    let columns = [
        "a year (1/a)",
        "return period (a)",
        "probability in a year (%)",
        "conditional on release (%)",
        "change with ln(rate) (1/a)",
        "change with exponent (1/a)",
    ];
    Table {
        about: About::Year,
        title: format!("How often a year: {}", named(place)),
        note: format!(
            "Numbers a year unless the column says otherwise: {} events a year at the sources times the share of their rocks that come. \
             {} rocks, which know what {} of equal weight would. 95 % intervals; where none was seen, a one-sided bound. Change with \
             ln(rate): 10 % more events make it 10 % of that more. Probability in a year: 1 − e^−λ.",
            format::significant(annual.events_per_year, 4),
            format::decimal(annual.rocks as f64, 0),
            format::decimal(annual.effective_rocks, 0)
        ),
        columns: columns.map(str::to_owned).into(),
        rows,
    }
}

fn kj(joule: f64) -> String {
    format::plain(joule / 1e3)
}

fn of(rate: &Rate, map: impl Fn(f64) -> f64) -> Estimate {
    estimate(map(rate.per_year), Some(map(rate.low_95)), Some(map(rate.high_95)))
}

fn cells(rate: &Rate, annual: &Annual) -> Vec<Option<Estimate>> {
    let period = |per_year: f64| if per_year > 0.0 { 1.0 / per_year } else { f64::NAN };
    let years = Estimate::new(period(rate.per_year), period(rate.high_95), period(rate.low_95));
    vec![
        Some(of(rate, |x| x)),
        Some(years),
        Some(of(rate, |x| -100.0 * libm::expm1(-x))),
        Some(of(rate, |x| 100.0 * x / annual.events_per_year)),
        Some(estimate(rate.by_log_rate, None, None)),
        rate.by_exponent.map(|slope| estimate(slope, None, None)),
    ]
}

fn returns(place: &AnnualPlace) -> Table {
    let row = |(which, one): (&str, &ReturnEnergy)| {
        let kilo = |joule: f64| joule / 1e3;
        let energy = match one.energy_j {
            Some(joule) => estimate(kilo(joule), Some(kilo(one.low_95)), one.high_95.map(kilo)),
            // more seldom than that, but perhaps not by much
            None => estimate(f64::NAN, None, one.high_95.filter(|high| *high > 0.0).map(kilo)),
        };
        let slope = |slope: Option<f64>| slope.map(|joule| estimate(kilo(joule), None, None));
        let name = format!("{} years{which}", format::plain(one.years));
        (name, vec![Some(energy), slope(one.by_log_rate), slope(one.by_exponent)])
    };
    let all =
        both(place).flat_map(|(which, figures)| figures.returns.iter().map(move |r| (which, r)));
    let columns = ["total energy (kJ)", "change with ln(rate) (kJ)", "change with exponent (kJ)"];
    Table {
        about: About::Year,
        title: format!("Energy of return periods: {}", named(place)),
        note: "Passed with at least that energy once in so many years on average; no number where rocks come more seldom. The 95 % \
               interval is that of the frequency, read along the energy; where too few rocks bound it, it is open."
            .to_owned(),
        columns: columns.map(str::to_owned).into(),
        rows: all.map(row).collect(),
    }
}

fn risks(place: &AnnualPlace) -> Option<Table> {
    let row = |(which, risk): (&str, &Risk)| {
        let Risk { kind, rate } = risk;
        let slope = |slope: f64| estimate(slope, None, None);
        let cells =
            vec![Some(of(rate, |x| x)), Some(slope(rate.by_log_rate)), rate.by_exponent.map(slope)];
        (format!("{}{which}", kind.name()), cells)
    };
    let all =
        both(place).flat_map(|(which, figures)| figures.risks.iter().map(move |r| (which, r)));
    let rows: Vec<_> = all.map(row).collect();
    let columns = ["a year (1/a)", "change with ln(rate) (1/a)", "change with exponent (1/a)"];
    (!rows.is_empty()).then(|| Table {
        about: About::Year,
        title: format!("Risk a year: {}", named(place)),
        note: "Hits a year × presence × vulnerability. The interval is that of the hits: presence and vulnerability are taken as \
               written in the scene. What is tolerable is not said here."
            .to_owned(),
        columns: columns.map(str::to_owned).into(),
        rows,
    })
}

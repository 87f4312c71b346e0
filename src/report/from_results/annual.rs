//! What a year brings, from the summary: tables and curves. Every title says that its numbers are a year.

use super::super::format;
use super::super::model::{About, AnnualView, BandPoint, Estimate, EstimateTable, Is};
use super::super::words::{Words, fill};
use super::lines::steps;
use super::{energy_unit_of, estimate};
use crate::hazard::{
    Annual, AnnualBarrier, AnnualFigures, AnnualPlace, EventRate, ExceedancePoint, ReturnEnergy,
    Risk, RiskKind, Saved,
};
use crate::math;
use crate::output::Results;

/// Curves of all places.
pub(super) fn views(results: &Results) -> Vec<AnnualView> {
    let Some(annual) = &results.summary.annual else { return Vec::new() };
    let view = |place: &AnnualPlace| {
        let figures = &place.without_barriers;
        AnnualView {
            name: place.name.clone(),
            is_object: place.is_object,
            most_per_year: figures.passages.high_95,
            rocks: annual.rocks,
            effective_rocks: annual.effective_rocks,
            without: band(figures),
            // where no barrier stands before, both are the same curve
            with: place.with_barriers.as_ref().filter(|with| *with != figures).map(band),
            return_periods_years: figures.returns.iter().map(|one| one.years).collect(),
        }
    };
    annual.places.iter().map(view).collect()
}

/// A curve by rising energy: λ(E ≥ e) is that of the next rock above e, and of none above the largest.
fn band(figures: &AnnualFigures) -> Vec<BandPoint> {
    let seen = figures.curve.iter().rev().map(|at: &ExceedancePoint| {
        (at.energy_j, estimate(at.per_year, Some(at.low_95), Some(at.high_95)))
    });
    let unseen = figures.unseen.iter().map(|at| (at.energy_j, Estimate::new(0.0, 0.0, at.high_95)));
    let mut from_j = 0.0;
    let falls = seen.chain(unseen).map(|(to_j, y)| {
        let x = std::mem::replace(&mut from_j, to_j);
        BandPoint { x, y }
    });
    let mut curve = steps(falls);
    curve.extend(curve.last().map(|last| BandPoint { x: from_j, y: last.y }));
    curve
}

/// The first table of the page: how often a year rocks come to each object and line with the largest energy asked for,
/// without barriers and with them.
pub(super) fn headline(results: &Results, words: &Words) -> Option<EstimateTable> {
    let annual = results.summary.annual.as_ref()?;
    // what a barrier meets is told of the barrier
    let is_barrier = |place: &&AnnualPlace| {
        let barriers = &results.summary.barriers;
        barriers.iter().any(|one| one.barrier.name == place.name)
    };
    let mut places: Vec<&AnnualPlace> =
        annual.places.iter().filter(|place| !is_barrier(place)).collect();
    // objects are what the year is asked for; lines keep their order behind them
    places.sort_by_key(|place| !place.is_object);
    let row = |place: &AnnualPlace, (which, figures): (&str, &AnnualFigures)| {
        let above = figures.above.last()?;
        let energy = format::plain(above.energy_j / 1e3);
        let name = named("{name}", place, words);
        let found: [(&str, &dyn std::fmt::Display); 3] =
            [("name", &name), ("energy", &energy), ("barriers", &which)];
        let cells = cells(&above.rate, annual);
        let shown = [0, 1, 4, 5].map(|column| cells[column]);
        Some((fill(words.year().head_row, &found), shown.into()))
    };
    let rows: Vec<_> = places
        .into_iter()
        .flat_map(|place| both(place, words).filter_map(move |one| row(place, one)))
        .collect();
    let columns = how_often(words);
    (!rows.is_empty()).then(|| {
        let mut table = EstimateTable {
            about: About::Year,
            title: words.year().head_title.to_owned(),
            columns: [0, 1, 4, 5].map(|column| columns[column].clone()).into(),
            rows,
            ..EstimateTable::default()
        };
        let has_exponent = leave_out_exponent(&mut table);
        let exponent = if has_exponent { words.year().head_exponent } else { "" };
        table.note = fill(words.year().head_note, &[("exponent", &exponent)])
            + zero_note(&table.rows, words);
        table
    })
}

/// Leaves the last column out where it is empty: sources without a power law have no exponent. Whether it stays.
fn leave_out_exponent(table: &mut EstimateTable) -> bool {
    let is_empty = table.rows.iter().all(|(_, cells)| cells.last().is_none_or(Option::is_none));
    if is_empty {
        table.columns.pop();
        table.rows.iter_mut().for_each(|(_, cells)| cells.truncate(table.columns.len()));
    }
    !is_empty
}

/// Three tables a place: how often, with what energy, at what risk; and one a barrier.
pub(super) fn tables(results: &Results, words: &Words) -> Vec<EstimateTable> {
    let Some(annual) = &results.summary.annual else { return Vec::new() };
    let each = |place: &AnnualPlace| {
        [Some(passages(annual, place, words)), Some(returns(place, words)), risks(place, words)]
    };
    // where no rock comes, one sentence says what there is to say
    let met = annual.places.iter().filter(|place| place.without_barriers.passages.rocks > 0);
    let places = met.flat_map(each).flatten();
    let all = places.chain(annual.barriers.iter().map(|one| barrier(annual, one, words)));
    let mut tables: Vec<EstimateTable> = all.collect();
    for table in &mut tables {
        leave_out_exponent(table);
    }
    tables
}

/// Columns of how often something happens.
fn how_often(words: &Words) -> Vec<String> {
    let by = |text: &str| fill(text, &[("unit", &"1/a")]);
    vec![
        words.col_year.to_owned(),
        words.col_period.to_owned(),
        words.col_probability.to_owned(),
        words.col_conditional.to_owned(),
        by(words.col_by_rate),
        by(words.col_by_exponent),
    ]
}

fn barrier(annual: &Annual, one: &AnnualBarrier, words: &Words) -> EstimateTable {
    let AnnualBarrier { name, arriving, stopped, over, through } = one;
    let rows = [
        (words.rocks_arrive, arriving),
        (words.are_stopped, stopped),
        (words.go_over, over),
        (words.break_through, through),
    ];
    EstimateTable {
        about: About::Year,
        place: name.clone(),
        title: fill(words.barrier_year_title, &[("name", &words.quoted(name))]),
        note: words.barrier_year_note.to_owned() + words.drawn().rough,
        columns: how_often(words),
        rows: rows.map(|(what, rate)| (what.to_owned(), cells(rate, annual))).into(),
    }
}

/// A title with the name of a place and what it is.
fn named(text: &str, place: &AnnualPlace, words: &Words) -> String {
    let what = if place.is_object { words.object } else { words.line };
    let name = fill(what, &[("name", &words.quoted(&place.name))]);
    fill(text, &[("name", &name)])
}

/// All figures of a place: without barriers first.
fn both<'a>(
    place: &'a AnnualPlace,
    words: &Words,
) -> impl Iterator<Item = (&'static str, &'a AnnualFigures)> + use<'a> {
    // barriers that change nothing here have no rows of their own
    let with = place.with_barriers.iter().filter(|with| **with != place.without_barriers);
    let and_with = words.and_with;
    let with: Vec<_> = with.map(|figures| (and_with, figures)).collect();
    let without = if with.is_empty() { "" } else { words.and_without };
    [(without, &place.without_barriers)].into_iter().chain(with)
}

/// What barriers keep away from a place; one that no rock meets on the way there has no rows.
fn kept_away(place: &AnnualPlace) -> impl Iterator<Item = &Saved> {
    place.saved.iter().filter(|saved| saved.passages.rocks > 0)
}

fn passages(annual: &Annual, place: &AnnualPlace, words: &Words) -> EstimateTable {
    let all = if place.is_object { words.hits } else { words.passages };
    let or_more = |joule: f64| fill(words.or_more, &[("energy", &format::plain(joule / 1e3))]);
    let mut rows = Vec::new();
    let mut say = |name: String, rate: &EventRate| rows.push((name, cells(rate, annual)));
    for (which, figures) in both(place, words) {
        say(format!("{all}{which}"), &figures.passages);
        for above in &figures.above {
            say(or_more(above.energy_j) + which, &above.rate);
        }
    }
    for saved in kept_away(place) {
        say(fill(words.kept_away, &[("name", &words.quoted(&saved.barrier))]), &saved.passages);
        for above in &saved.above {
            say(or_more(above.energy_j), &above.rate);
        }
    }
    EstimateTable {
        about: About::Year,
        place: place.name.clone(),
        title: named(words.often_title, place, words),
        note: fill(
            words.often_note,
            &[
                ("events", &format::significant(annual.events_per_year, 4)),
                ("rocks", &format::decimal(annual.rocks as f64, 0)),
                ("effective", &format::decimal(annual.effective_rocks, 0)),
            ],
        ) + zero_note(&rows, words)
            + words.drawn().rough,
        columns: how_often(words),
        rows,
    }
}

/// A rate or what follows from it; a plain 0 where not even its upper end is more, as no rock can do that.
fn of(rate: &EventRate, map: impl Fn(f64) -> f64) -> Estimate {
    if rate.high_95 == 0.0 && !rate.censored {
        return Estimate::plain(0.0);
    }
    let is = Is::at_least_if(rate.censored);
    let found = estimate(map(rate.per_year), Some(map(rate.low_95)), Some(map(rate.high_95)));
    Estimate { is, ..found }
}

/// What a plain 0 means, where one stands in the first column.
fn zero_note(rows: &[(String, Vec<Option<Estimate>>)], words: &Words) -> &'static str {
    let is_plain = |at: &Estimate| at.value == 0.0 && at.high.is_nan();
    let first = |cells: &[Option<Estimate>]| cells.first().copied().flatten();
    let is_any = rows.iter().any(|(_, cells)| first(cells).is_some_and(|at| is_plain(&at)));
    if is_any { words.drawn().plain_zero } else { "" }
}

/// A derivative without an interval of its own: two digits, as it is a rough number.
fn slope_of(slope: f64) -> Estimate {
    Estimate::plain(math::rounded(slope, 2))
}

fn cells(rate: &EventRate, annual: &Annual) -> Vec<Option<Estimate>> {
    let period = |per_year: f64| if per_year > 0.0 { 1.0 / per_year } else { f64::NAN };
    let years = Estimate::new(period(rate.per_year), period(rate.high_95), period(rate.low_95));
    let is = if rate.censored { Is::AtMost } else { Is::Value };
    let years = Estimate { is, ..years };
    vec![
        Some(of(rate, |x| x)),
        Some(years),
        Some(of(rate, |x| -100.0 * libm::expm1(-x))),
        Some(of(rate, |x| 100.0 * x / annual.events_per_year)),
        Some(slope_of(rate.by_log_rate)),
        rate.by_exponent.map(slope_of),
    ]
}

fn returns(place: &AnnualPlace, words: &Words) -> EstimateTable {
    let energies = both(place, words).flat_map(|(_, figures)| &figures.returns);
    let (unit, size_j) = energy_unit_of(energies.filter_map(|one| one.energy_j.or(one.high_95)));
    let row = |(which, is, one): (&str, Is, &ReturnEnergy)| {
        let sized = |joule: f64| joule / size_j;
        let energy = match one.energy_j {
            Some(joule) => Estimate {
                is,
                ..estimate(sized(joule), Some(sized(one.low_95)), one.high_95.map(sized))
            },
            // more seldom than that, but perhaps not by much
            None => estimate(f64::NAN, None, one.high_95.filter(|high| *high > 0.0).map(sized)),
        };
        let slope = |slope: Option<f64>| slope.map(|joule| slope_of(sized(joule)));
        let name = fill(words.years, &[("n", &format::plain(one.years))]) + which;
        (name, vec![Some(energy), slope(one.by_log_rate), slope(one.by_exponent)])
    };
    let all = both(place, words).flat_map(|(which, figures)| {
        let is = Is::at_least_if(figures.passages.censored);
        figures.returns.iter().map(move |r| (which, is, r))
    });
    let by = |text: &str| fill(text, &[("unit", &unit)]);
    let columns = [words.energy_axis, words.col_by_rate, words.col_by_exponent].map(by);
    EstimateTable {
        about: About::Year,
        place: place.name.clone(),
        title: named(words.returns_title, place, words),
        note: words.returns_note.to_owned() + words.drawn().rough,
        columns: columns.into(),
        rows: all.map(row).collect(),
    }
}

fn risks(place: &AnnualPlace, words: &Words) -> Option<EstimateTable> {
    let row = |which: &str, risk: &Risk| {
        let Risk { kind, rate } = risk;
        let cells = vec![
            Some(of(rate, |x| x)),
            Some(slope_of(rate.by_log_rate)),
            rate.by_exponent.map(slope_of),
        ];
        (format!("{}{which}", risk_name(*kind, words)), cells)
    };
    let mut rows = Vec::new();
    for (which, figures) in both(place, words) {
        rows.extend(figures.risks.iter().map(|risk| row(which, risk)));
    }
    for saved in kept_away(place) {
        let which = fill(words.risk_kept_away, &[("name", &words.quoted(&saved.barrier))]);
        rows.extend(saved.risks.iter().map(|risk| row(&which, risk)));
    }
    let by = |text: &str| fill(text, &[("unit", &"1/a")]);
    let columns = [words.col_year, words.col_by_rate, words.col_by_exponent].map(by);
    (!rows.is_empty()).then(|| EstimateTable {
        about: About::Year,
        place: place.name.clone(),
        title: named(words.risk_title, place, words),
        note: words.risk_note.to_owned(),
        columns: columns.into(),
        rows,
    })
}

fn risk_name(kind: RiskKind, words: &Words) -> &'static str {
    match kind {
        RiskKind::PersonHit => words.person_hit,
        RiskKind::VehiclesHit => words.vehicles_hit,
        RiskKind::Individual => words.individual_risk,
        RiskKind::Deaths => words.deaths,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where not one rock can have so much energy there is no chance to tell of: it stood there as 0.00 (0.00 to 0.00).
    #[test]
    fn what_no_rock_can_do_is_a_plain_0() {
        let rate = |high_95: f64, censored: bool| EventRate {
            rocks: 0,
            per_year: 0.0,
            low_95: 0.0,
            high_95,
            censored,
            by_log_rate: 0.0,
            by_exponent: None,
        };
        let is_plain = |rate: EventRate| {
            let found = of(&rate, |x| x);
            let words = Words::of(crate::scene::Language::En);
            let note = zero_note(&[(String::new(), vec![Some(found)])], words);
            assert_eq!(found.high.is_nan(), !note.is_empty());
            found.high.is_nan()
        };
        assert!(is_plain(rate(0.0, false)));
        assert!(!is_plain(rate(1e-4, false)) && !is_plain(rate(0.0, true)));
    }

    /// Sources without a power law have no exponent: no column of nothing.
    #[test]
    fn a_column_in_which_nothing_stands_is_left_out() {
        let one = Some(Estimate::new(1.0, 0.5, 2.0));
        let of = |last: [Option<Estimate>; 2]| EstimateTable {
            columns: vec!["a year".to_owned(), "by exponent".to_owned()],
            rows: last.map(|last| ("a place".to_owned(), vec![one, last])).into(),
            ..EstimateTable::default()
        };
        let mut table = of([None, one]);
        assert!(leave_out_exponent(&mut table));
        assert_eq!(table, of([None, one]));
        let mut table = of([None, None]);
        assert!(!leave_out_exponent(&mut table));
        assert!(table.columns == ["a year"] && table.rows.iter().all(|(_, cells)| *cells == [one]));
    }
}

//! The chapters that answer: each picture, and behind it the tables about the same.

use super::{NumberedFigures, escape, tables};
use crate::report::figures::FIGURES;
use crate::report::format;
use crate::report::model::{About, Report};
use crate::report::{annual, barriers, lines};
use std::collections::BTreeSet;

/// All tables about something that tell of a place, or of several where the name is empty.
fn tables_of(report: &Report, about: About, place: &str) -> String {
    let shown = report.tables.iter().filter(|table| table.about == about && table.place == place);
    shown.map(|table| tables::table(table, report.words())).collect()
}

/// Tables about something of the places that no figure is drawn of.
fn other_tables(report: &Report, about: About, drawn: &BTreeSet<&str>) -> String {
    let shown = report
        .tables
        .iter()
        .filter(|table| table.about == about && !drawn.contains(table.place.as_str()));
    shown.map(|table| tables::table(table, report.words())).collect()
}

fn sentence(words: Option<String>) -> String {
    words.map_or(String::new(), |words| format!("<p>{}</p>\n", escape(&format::sentence(&words))))
}

/// Where rocks go.
pub(super) fn where_to(report: &Report, drawn: &NumberedFigures<'_>) -> String {
    let pictures = drawn.all(&["stops.svg", "runout.svg", "reach_angle.svg"]);
    let measured = drawn.figure("measured.svg").replace("<figure>", SHEET);
    let agreement = tables_of(report, About::Measured, "");
    let maps = drawn.all(&["maps.svg", "maps_values.svg", "maps_ends.svg"]);
    let shapes = tables_of(report, About::Shapes, "");
    pictures + &shapes + &measured + &agreement + &maps
}

/// Figures of the list that have a place of their own on the page.
const PLACED: [&str; 5] = ["plan.svg", "stops.svg", "side.svg", "runout.svg", "reach_angle.svg"];

/// A figure of about a page.
const SHEET: &str = "<figure class=\"sheet\">";

/// How fast and how high, and all figures of the list without a place of their own. In print the table fills the page below
/// the ways of single rocks: six histograms take most of one.
pub(super) fn how_fast(report: &Report, drawn: &NumberedFigures<'_>) -> String {
    let others = FIGURES.iter().map(|figure| figure.file).filter(|file| !PLACED.contains(file));
    drawn.all(&["side.svg", "profile.svg", "along.svg"])
        + &tables_of(report, About::Rocks, "")
        + &drawn.all(&others.collect::<Vec<_>>())
}

/// Each line: its figure and its table together.
pub(super) fn at_lines(report: &Report, drawn: &NumberedFigures<'_>) -> String {
    let mut body = drawn.figure("retention.svg");
    let mut told: BTreeSet<&str> = report.barriers.iter().map(|one| one.name.as_str()).collect();
    for line in report.lines.iter().filter(|line| !line.is_barrier) {
        body += &drawn.figure(&format!("line_{}.svg", line.number));
        body += &sentence(lines::nobody(report.words(), line));
        body += &tables_of(report, About::Lines, &line.name);
        told.insert(&line.name);
    }
    body + &other_tables(report, About::Lines, &told)
}

/// All barriers in one table; each with its figure, what passes its line, and what arrives at it.
pub(super) fn at_barriers(report: &Report, drawn: &NumberedFigures<'_>) -> String {
    let mut body = String::new();
    for (number, barrier) in report.barriers.iter().enumerate() {
        body += &drawn.figure(&format!("barrier_{}.svg", number + 1));
        body += &sentence(barriers::nobody(report.words(), barrier));
        body += &tables_of(report, About::Barriers, &barrier.name);
        body += &tables_of(report, About::Lines, &barrier.name);
    }
    body + &tables_of(report, About::Barriers, "")
}

/// What a year brings: maps, then each place with its curve and its tables.
pub(super) fn in_a_year(report: &Report, drawn: &NumberedFigures<'_>) -> String {
    let (mut body, mut told) = (String::new(), BTreeSet::new());
    for (number, place) in report.annual.iter().enumerate() {
        body += &drawn.figure(&format!("annual_{}.svg", number + 1));
        body += &sentence(annual::nobody(report.words(), place));
        body += &tables_of(report, About::Year, &place.name);
        told.insert(place.name.as_str());
    }
    body += &other_tables(report, About::Year, &told);
    // the sheet of maps fills a page of print: places fill up the one before it
    body + &drawn.figure("maps_year.svg").replace("<figure>", SHEET)
}

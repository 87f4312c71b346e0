//! Tables of estimates: numbers with as many digits as their intervals leave meaningful.

use super::{escape, note};
use crate::report::format::{self, Toward};
use crate::report::model::{Estimate, EstimateRow, EstimateTable, Is, energy_unit};
use crate::report::words::{Words, fill};
use std::fmt::Write as _;

/// The headline statistics of all rocks.
pub(super) fn headline(rows: &[EstimateRow], words: &Words) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let row = |row: &EstimateRow| {
        let (estimate, unit) = in_short_unit(row);
        let (value, interval) = in_words(&estimate, words);
        format!(
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{value}</td><td class=\"number\">{interval}</td><td>{}</td></tr>\n",
            escape(&with_joints(&row.name)),
            escape(unit)
        )
    };
    let rows: String = rows.iter().map(row).collect();
    format!(
        "<table class=\"headline\">\n<thead><tr><th>{}</th><th class=\"number\">{}</th><th class=\"number\">{}</th><th>{}</th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n{}",
        escape(words.all_rocks),
        escape(words.value),
        escape(words.interval_head),
        escape(words.unit),
        note(words.headline_note)
    )
}

/// Long words of the first table, with the joints at which a narrow column may part them.
const JOINTS: [&str; 6] = [
    "Auslauf|strecke",
    "Pauschal|gefälle",
    "Geschwindig|keit",
    "Translations|energie",
    "Gesamt|energie",
    "Sprung|höhe",
];

/// A text with soft hyphens in such words: without them print breaks a word anywhere, and without a hyphen.
fn with_joints(text: &str) -> String {
    JOINTS.iter().fold(text.to_owned(), |text, word| {
        text.replace(&word.replace('|', ""), &word.replace('|', "\u{ad}"))
    })
}

/// Each headline statistic with its interval, in columns for a terminal.
pub fn plain_headline(rows: &[EstimateRow], words: &Words) -> Vec<String> {
    let said = |row: &EstimateRow| {
        let (estimate, unit) = in_short_unit(row);
        let (value, interval) = in_words(&estimate, words);
        let interval = match (estimate.is, interval) {
            (Is::Lacking(_), lacking) => lacking,
            (_, none) if none == format::NO_NUMBER => words.no_interval.to_owned(),
            (_, interval) => fill(words.interval_95, &[("interval", &interval)]),
        };
        (format!("{value} {unit}"), interval)
    };
    let wide = |text: &str| text.chars().count();
    let name_width = rows.iter().map(|row| wide(&row.name)).max().unwrap_or(0);
    let values: Vec<_> = rows.iter().map(said).collect();
    let value_width = values.iter().map(|(value, _)| wide(value)).max().unwrap_or(0);
    let line = |(row, (value, interval)): (&EstimateRow, &(String, String))| {
        format!("{:<name_width$}  {value:>value_width$}  {interval}", row.name)
    };
    rows.iter().zip(&values).map(line).collect()
}

/// Joules as kJ where that is shorter; other units as they are.
fn in_short_unit(row: &EstimateRow) -> (Estimate, &str) {
    if row.unit != "J" {
        return (row.estimate, &row.unit);
    }
    let (unit, size) = match row.estimate.is {
        // no number, whose size would tell
        Is::Lacking(_) => ("kJ", 1e3),
        _ => energy_unit(row.estimate.value),
    };
    (row.estimate.over(size), unit)
}

/// Value and interval with as many digits as the interval leaves meaningful; a bound carries its sign, and what too few
/// rocks cannot give says how many are missing.
fn in_words(estimate: &Estimate, words: &Words) -> (String, String) {
    if let Is::Lacking(rocks) = estimate.is {
        return (format::NO_NUMBER.to_owned(), words.more_rocks(rocks));
    }
    // what has no value, as the return period of what never came, is no bound either
    let sign = if estimate.value.is_nan() { "" } else { format::sign(estimate.is) };
    let width = estimate.high - estimate.low;
    if estimate.value == 0.0 && estimate.high > 0.0 {
        // none seen: what matters is how many there may be
        return (format!("{sign}0"), one_sided(estimate, words, 2));
    }
    if width.is_nan() && format::is_as_written(estimate.value) {
        let value = format!("{sign}{}", format::decimal(estimate.value, 0));
        return (value, one_sided(estimate, words, 4));
    }
    let [value, low, high] = format::with_interval([estimate.value, estimate.low, estimate.high]);
    (format!("{sign}{value}"), words.interval(&low, &high))
}

fn one_sided(estimate: &Estimate, words: &Words, digits: usize) -> String {
    let end = |v: f64, toward: Toward| format::significant(toward.to_digits(v, digits), digits);
    words.interval(&end(estimate.low, Toward::Below), &end(estimate.high, Toward::Above))
}

/// Rows up to which a table stays on one printed page.
const LONGEST: usize = 9;

/// A table with its heading and note.
pub(super) fn table(table: &EstimateTable, words: &Words) -> String {
    // a long one may go on overleaf
    let class = if table.rows.len() > LONGEST { "dense long" } else { "dense" };
    let mut heads = String::new();
    for column in &table.columns {
        let _ = write!(heads, "<th class=\"number\">{}</th>", escape(column));
    }
    let mut rows = String::new();
    for (name, cells) in &table.rows {
        let _ = write!(rows, "<tr><th scope=\"row\">{}</th>", escape(name));
        for cell in cells {
            rows.push_str(&table_cell(cell.as_ref(), words));
        }
        rows.push_str("</tr>\n");
    }
    format!(
        "<h3>{}</h3>\n<div class=\"wide\"><table class=\"{class}\">\n<thead><tr><th></th>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n{}",
        escape(&table.title),
        note(&table.note)
    )
}

fn table_cell(estimate: Option<&Estimate>, words: &Words) -> String {
    let Some(estimate) = estimate else {
        return format!("<td class=\"number\">{}</td>", format::NO_NUMBER);
    };
    let (value, interval) = in_words(estimate, words);
    let below = if interval == format::NO_NUMBER {
        String::new()
    } else {
        // how many rocks are missing is said in words, which take two lines rather than push the last column off the page
        let words = if matches!(estimate.is, Is::Lacking(_)) { " class=\"lacking\"" } else { "" };
        format!("<br><small{words}>{interval}</small>")
    };
    format!("<td class=\"number\">{value}{below}</td>")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Language;

    /// The return period of what no rock did is at least that of the upper end of its frequency, and no number of its own: it was "≤ –".
    #[test]
    fn what_has_no_value_has_no_sign() {
        let years = Estimate { is: Is::AtMost, ..Estimate::new(f64::NAN, 51.2, f64::NAN) };
        let (value, interval) = in_words(&years, Words::of(Language::En));
        assert_eq!((value.as_str(), interval.as_str()), (format::NO_NUMBER, "at least 51.2"));
    }

    #[test]
    fn long_words_have_joints() {
        assert_eq!(with_joints("Pauschalgefälle, 50 %"), "Pauschal\u{ad}gefälle, 50 %");
        assert_eq!(with_joints("Reach angle, 50 %"), "Reach angle, 50 %");
        // the words are those of the German page
        let words = Words::of(Language::De);
        assert!(with_joints(words.reach_angle).contains('\u{ad}'));
    }

    /// What is missing is said in words that may take two lines: five columns of them pushed the largest values of 24 rocks off the page.
    #[test]
    fn what_is_missing_may_take_two_lines() {
        let estimate = Estimate { is: Is::Lacking(35), ..Estimate::new(1.0, 0.5, 2.0) };
        let cell = |is| table_cell(Some(&Estimate { is, ..estimate }), Words::of(Language::En));
        assert!(cell(Is::Lacking(35)).contains("<small class=\"lacking\">35 more"));
        assert!(cell(Is::Value).contains("<small>0.5"));
    }

    /// Five digits tell most intervals; of a share that is nearly whole they would leave none.
    #[test]
    fn the_interval_of_a_share_that_is_nearly_whole_is_seen() {
        let said = |value: f64, low: f64, high: f64| {
            in_words(&Estimate::new(value, low, high), Words::of(Language::En))
        };
        let pair = |value: &str, interval: &str| (value.to_owned(), interval.to_owned());
        assert_eq!(said(99.9992, 99.9990, 99.9994), pair("99.9992", "99.9990 to 99.9994"));
        assert_eq!(said(94.0, 93.9, 94.1), pair("94.00", "93.90 to 94.10"));
        assert_eq!(said(100.0, 100.0, 100.0), pair("100.0", "100.0 to 100.0"));
    }
}

//! The report page: one file, no scripts, nothing fetched; prints to A4.

mod words;

use super::figure::{Drawing, Heading};
use super::format::{self, escape};
use super::input::{Estimate, Report, Row, Table, energy_unit};
use crate::math;
use crate::trajectory::Stop;
use std::fmt::Write as _;
use words::{GLOSSARY, METHOD, STYLE};

/// The page with the figures inlined.
pub fn page(report: &Report, figures: &[(Heading, Drawing)]) -> String {
    let mut page = head(&report.text.title);
    let parts = [
        title_block(report),
        warnings(report),
        headline(report),
        tables(report),
        figure_section(figures),
        method(report),
        inputs(report),
        plan(report),
        quality(report),
        glossary(),
        footer(report),
    ];
    page.extend(parts);
    page.push_str("</main>\n</body>\n</html>\n");
    page
}

fn head(title: &str) -> String {
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}: rockfall report</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n"
    )
}

fn section(title: &str, body: &str) -> String {
    if body.is_empty() {
        return String::new();
    }
    format!("<section>\n<h2>{}</h2>\n{body}</section>\n", escape(title))
}

fn list(lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let mut items = String::new();
    for line in lines {
        let _ = writeln!(items, "<li>{}</li>", escape(line));
    }
    format!("<ul>\n{items}</ul>\n")
}

fn pairs(rows: &[(String, String)]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let row = |(name, value): &(String, String)| {
        format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(name), escape(value))
    };
    format!("<table class=\"pairs\">\n{}</table>\n", rows.iter().map(row).collect::<String>())
}

fn title_block(report: &Report) -> String {
    let text = &report.text;
    let subtitle = match text.subtitle.as_str() {
        "" => String::new(),
        words => format!("<p class=\"subtitle\">{}</p>\n", escape(words)),
    };
    let count = format::decimal(report.releases.len() as f64, 0);
    format!(
        "<header>\n<h1>{}</h1>\n{subtitle}<p class=\"facts\">{count} releases · {} kept paths · seed {} · rockfall {}</p>\n{}</header>\n",
        escape(&text.title),
        report.paths.len(),
        text.seed,
        escape(&text.version),
        pairs(&text.title_block)
    )
}

fn warnings(report: &Report) -> String {
    if report.text.warnings.is_empty() {
        return String::new();
    }
    format!(
        "<section class=\"warnings\">\n<h2>Read this first</h2>\n{}</section>\n",
        list(&report.text.warnings)
    )
}

fn headline(report: &Report) -> String {
    if report.headline.is_empty() {
        return String::new();
    }
    let row = |row: &Row| {
        let (estimate, unit) = in_short_unit(row);
        let (value, interval) = in_words(&estimate);
        format!(
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{value}</td><td class=\"number\">{interval}</td><td>{}</td></tr>\n",
            escape(&row.name),
            escape(unit)
        )
    };
    let rows: String = report.headline.iter().map(row).collect();
    let body = format!(
        "<table>\n<thead><tr><th>Quantity</th><th class=\"number\">Value</th><th class=\"number\">95 % interval</th><th>Unit</th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n\
         <p class=\"note\">Intervals say how far chance in the sample moves a number. They do not say how well ground values and terrain are known.</p>\n"
    );
    section("Results", &body)
}

/// Each headline statistic with its interval, in columns for a terminal.
pub fn plain_headline(rows: &[Row]) -> Vec<String> {
    let words = |row: &Row| {
        let (estimate, unit) = in_short_unit(row);
        let (value, interval) = in_words(&estimate);
        let unit = unit.to_owned();
        let interval = match interval {
            none if none == format::NO_NUMBER => "too few rocks for an interval".to_owned(),
            interval => format!("95 % interval {interval}"),
        };
        (format!("{value} {unit}"), interval)
    };
    let wide = |text: &str| text.chars().count();
    let name_width = rows.iter().map(|row| wide(&row.name)).max().unwrap_or(0);
    let values: Vec<_> = rows.iter().map(words).collect();
    let value_width = values.iter().map(|(value, _)| wide(value)).max().unwrap_or(0);
    let line = |(row, (value, interval)): (&Row, &(String, String))| {
        format!("{:<name_width$}  {value:>value_width$}  {interval}", row.name)
    };
    rows.iter().zip(&values).map(line).collect()
}

/// Joules as kJ or MJ where that is shorter; other units as they are.
fn in_short_unit(row: &Row) -> (Estimate, &str) {
    if row.unit != "J" {
        return (row.estimate, &row.unit);
    }
    let (unit, size) = energy_unit(row.estimate.value);
    let Estimate { value, low, high } = row.estimate;
    (Estimate { value: value / size, low: low / size, high: high / size }, unit)
}

/// Value and interval with as many digits as the interval leaves meaningful.
fn in_words(estimate: &Estimate) -> (String, String) {
    let width = estimate.high - estimate.low;
    if width.is_nan() && estimate.value.fract() == 0.0 && estimate.value.abs() < 1e7 {
        // a count, or a number as it was written
        return (format::decimal(estimate.value, 0), format::NO_NUMBER.to_owned());
    }
    let digits = if width.is_finite() && width > 0.0 && estimate.value != 0.0 {
        // the last digit is at most a fifth of the interval
        let leading = math::log10(estimate.value.abs()).floor() - math::log10(0.2 * width).floor();
        (leading as i32 + 1).clamp(3, 6) as usize
    } else {
        4
    };
    let bound = |v: f64| format::significant(format::rounded(v, digits), digits);
    let value = bound(estimate.value);
    let interval = format::interval(&bound(estimate.low), &bound(estimate.high));
    (value, interval)
}

fn tables(report: &Report) -> String {
    report.tables.iter().map(table).collect()
}

fn table(table: &Table) -> String {
    let mut heads = String::new();
    for column in &table.columns {
        let _ = write!(heads, "<th class=\"number\">{}</th>", escape(column));
    }
    let mut rows = String::new();
    for (name, cells) in &table.rows {
        let _ = write!(rows, "<tr><th scope=\"row\">{}</th>", escape(name));
        for cell in cells {
            rows.push_str(&table_cell(cell.as_ref()));
        }
        rows.push_str("</tr>\n");
    }
    let note = match table.note.as_str() {
        "" => String::new(),
        words => format!("<p class=\"note\">{}</p>\n", escape(words)),
    };
    let body = format!(
        "{note}<div class=\"wide\"><table class=\"dense\">\n<thead><tr><th></th>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
    );
    section(&table.title, &body)
}

fn table_cell(estimate: Option<&Estimate>) -> String {
    let Some(estimate) = estimate else {
        return format!("<td class=\"number\">{}</td>", format::NO_NUMBER);
    };
    let (value, interval) = in_words(estimate);
    let below = if interval == format::NO_NUMBER {
        String::new()
    } else {
        format!("<br><small>{interval}</small>")
    };
    format!("<td class=\"number\">{value}{below}</td>")
}

fn figure_section(figures: &[(Heading, Drawing)]) -> String {
    let mut body = String::new();
    for (number, (figure, drawing)) in figures.iter().enumerate() {
        let _ = write!(
            body,
            "<figure>\n{}<figcaption><b>Figure {}. {}.</b> {}</figcaption>\n</figure>\n",
            drawing.svg,
            number + 1,
            escape(&figure.title),
            escape(&drawing.caption)
        );
    }
    section("Figures", &body)
}

fn method(report: &Report) -> String {
    let scheme = escape(&report.text.scheme);
    section("Method", &format!("<p>{} {scheme}</p>\n", METHOD.join(" ")))
}

fn inputs(report: &Report) -> String {
    let text = &report.text;
    let mut body = pairs(&text.inputs);
    if !text.mesh_health.is_empty() {
        let lines: String = text.mesh_health.iter().map(|line| escape(line) + "\n").collect();
        let _ = write!(body, "<h3>Health of the meshes</h3>\n<pre>{lines}</pre>\n");
    }
    section("Inputs", &body)
}

fn plan(report: &Report) -> String {
    let lines = &report.text.plan;
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines.iter().map(|line| escape(line) + "\n").collect();
    section("Plan: what was computed, what was left out and why", &format!("<pre>{lines}</pre>\n"))
}

fn quality(report: &Report) -> String {
    let text = &report.text;
    let failed = report.releases.iter().filter(|f| matches!(f.stop, Stop::Failed(_))).count();
    let left = report.releases.iter().filter(|f| f.stop == Stop::LeftTerrain).count();
    let count = |n: usize| format::decimal(n as f64, 0);
    let remainder = text.energy_remainder.map_or("not recorded".to_owned(), |share| {
        format!("{} of the energy released, in the worst rock", format::significant(share, 2))
    });
    let or_unknown =
        |words: &str| if words.is_empty() { "not stated".to_owned() } else { words.to_owned() };
    let row = |name: &str, value: String| (name.to_owned(), value);
    let rows = [
        row("Terrain", or_unknown(&text.terrain_source)),
        row("Ground values", or_unknown(&text.parameter_source)),
        row("Releases", count(report.releases.len())),
        row("Lost rocks", format!("{} failed, {} left the terrain", count(failed), count(left))),
        row("Energy not accounted for", remainder),
        row("Seed", text.seed.to_string()),
        row("Version", text.version.clone()),
    ];
    section("Quality statement", &pairs(&rows))
}

fn glossary() -> String {
    let entry = |(term, meaning): &(&str, &str)| {
        format!("<dt>{}</dt><dd>{}</dd>\n", escape(term), escape(meaning))
    };
    let entries: String = GLOSSARY.iter().map(entry).collect();
    section("Definitions", &format!("<dl>\n{entries}</dl>\n"))
}

fn footer(report: &Report) -> String {
    let text = &report.text;
    let rate = text.rate_per_s.filter(|r| r.is_finite()).map_or(String::new(), |rate| {
        format!(" · {} rocks per second, files included", format::significant(rate, 3))
    });
    let remainder = text.energy_remainder.map_or(String::new(), |share| {
        format!(" · numerical remainder {}", format::significant(share, 2))
    });
    format!(
        "<footer>rockfall {} · seed {} · scene <code>{}</code>{rate}{remainder}</footer>\n",
        escape(&text.version),
        text.seed,
        escape(&text.scene_hash)
    )
}

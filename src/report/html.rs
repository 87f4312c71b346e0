//! The report page: one file, no scripts, nothing fetched; prints to A4.
//!
//! The first page answers: the map, what arrives at lines and barriers, and what must be known before the numbers are
//! used. Then one chapter a question.

mod tables;
mod words;

pub use tables::plain_headline;

use super::barriers;
use super::figure::{Drawing, Heading};
use super::format::{self, escape};
use super::lines;
use super::model::{About, Check, Report};
use crate::simulation::Stop;
use std::fmt::Write as _;
use words::{GLOSSARY, METHOD, STYLE};

/// What is drawn, in the order of the page.
type Figures = [(Heading, Drawing)];

/// A chapter: its anchor, what it asks, and its content.
struct Chapter {
    anchor: &'static str,
    title: &'static str,
    body: String,
}

/// The page with the figures inlined.
pub fn page(report: &Report, figures: &Figures) -> String {
    let chapter = |anchor, title, body| Chapter { anchor, title, body };
    let chapters = [
        chapter("where", "Where do they go?", where_to(report, figures)),
        chapter("how", "How fast and how high?", how_fast(report, figures)),
        chapter("lines", "What arrives at each line?", at_lines(report, figures)),
        chapter(
            "barriers",
            "What each barrier meets, and what passes it",
            at_barriers(report, figures),
        ),
        chapter("year", "What does a year bring?", in_a_year(report, figures)),
        chapter("sure", "How sure is that?", how_sure(report, figures)),
        chapter("out", "What was computed, what was left out and why", plan(report)),
        chapter("inputs", "Method and inputs", method(report) + &inputs(report)),
        chapter("words", "Definitions", glossary()),
    ];
    let shown: Vec<&Chapter> = chapters.iter().filter(|one| !one.body.is_empty()).collect();
    let mut page = head(&report.text.title);
    page += &first_page(report, figures);
    page += &contents(&shown);
    for (number, one) in shown.iter().enumerate() {
        let _ = write!(
            page,
            "<section id=\"{}\">\n<h2>{} {}</h2>\n{}</section>\n",
            one.anchor,
            number + 1,
            escape(one.title),
            one.body
        );
    }
    page += &footer(report);
    page.push_str("</main>\n</body>\n</html>\n");
    page
}

pub(super) fn head(title: &str) -> String {
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}: rockfall report</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n"
    )
}

pub(super) fn section(title: &str, body: &str) -> String {
    if body.is_empty() {
        return String::new();
    }
    format!("<section>\n<h2>{}</h2>\n{body}</section>\n", escape(title))
}

pub(super) fn list(lines: &[String]) -> String {
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

/// A note in small print; nothing of no words.
fn note(words: &str) -> String {
    if words.is_empty() {
        String::new()
    } else {
        format!("<p class=\"note\">{}</p>\n", escape(words))
    }
}

/// Site and question, the map, what arrives, and what must be known first.
fn first_page(report: &Report, figures: &Figures) -> String {
    let text = &report.text;
    let subtitle = match text.subtitle.as_str() {
        "" => String::new(),
        words => format!("<p class=\"subtitle\">{}</p>\n", escape(words)),
    };
    let count = |n: usize| format::decimal(n as f64, 0);
    let facts = format!(
        "{} {} · {} stored {} · seed {} · rockfall {}",
        count(report.releases.len()),
        format::counted(report.releases.len(), "release", "releases"),
        count(report.paths.len()),
        format::counted(report.paths.len(), "path", "paths"),
        text.seed,
        text.version
    );
    let view = if report.has_view {
        " · <a href=\"view.html\">the slope in 3D</a> · <a href=\"view.glb\">view.glb</a>"
    } else {
        ""
    };
    format!(
        "<header>\n<h1>{}</h1>\n{subtitle}<p class=\"facts\">{}{view}</p>\n{}{}</header>\n{}{}<section id=\"answer\">\n{}{}</section>\n",
        escape(&text.title),
        escape(&facts),
        pairs(&text.title_block),
        question(report),
        warnings(report),
        figure(figures, "plan.svg").replacen("<figure>", "<figure class=\"map\">", 1),
        report.arrivals.iter().map(tables::table).collect::<String>(),
        tables::headline(&report.headline),
    )
}

/// What was asked, in one sentence, from what the scene names.
fn question(report: &Report) -> String {
    let names = |is_barrier: bool| -> Vec<String> {
        let marks = report.marks.iter().filter(|mark| mark.barrier.is_some() == is_barrier);
        marks.map(|mark| format!("“{}”", mark.name)).collect()
    };
    let (lines, barriers) = (names(false), names(true));
    let mut words = "How far do rocks from the release zone come, how fast and how high".to_owned();
    if !lines.is_empty() {
        let _ = write!(words, ", what arrives at {}", lines.join(", "));
    }
    if !barriers.is_empty() {
        let _ = write!(words, ", and what do {} meet and let pass", barriers.join(", "));
    }
    format!("<p class=\"question\">{}?</p>\n", escape(&words))
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

fn contents(chapters: &[&Chapter]) -> String {
    let mut items = String::new();
    for one in chapters {
        let _ = writeln!(items, "<li><a href=\"#{}\">{}</a></li>", one.anchor, escape(one.title));
    }
    format!("<nav>\n<ol>\n{items}</ol>\n</nav>\n")
}

/// The figure of a file, numbered as it stands among all; nothing if it was not drawn.
fn figure(figures: &Figures, file: &str) -> String {
    let Some(at) = figures.iter().position(|(heading, _)| heading.file == file) else {
        return String::new();
    };
    let (heading, drawing) = &figures[at];
    format!(
        "<figure>\n{}<figcaption><b>Figure {}. {}.</b> {}</figcaption>\n</figure>\n",
        drawing.svg,
        at + 1,
        escape(&heading.title),
        escape(&drawing.caption)
    )
}

fn all(figures: &Figures, files: &[&str]) -> String {
    files.iter().map(|file| figure(figures, file)).collect()
}

/// All tables about something.
fn tables_about(report: &Report, about: About) -> String {
    report.tables.iter().filter(|table| table.about == about).map(tables::table).collect()
}

fn where_to(report: &Report, figures: &Figures) -> String {
    let files = [
        "stops.svg",
        "runout.svg",
        "reach_angle.svg",
        "maps.svg",
        "maps_values.svg",
        "measured.svg",
    ];
    all(figures, &files) + &tables_about(report, About::Measured)
}

fn how_fast(report: &Report, figures: &Figures) -> String {
    all(figures, &["side.svg", "along.svg", "distributions.svg"])
        + &tables_about(report, About::Rocks)
}

fn sentence(words: Option<String>) -> String {
    words.map_or(String::new(), |words| format!("<p>{}</p>\n", escape(&words)))
}

fn at_lines(report: &Report, figures: &Figures) -> String {
    let own = report.lines.iter().filter(|line| !line.is_barrier);
    let each = own.map(|line| {
        figure(figures, &format!("line_{}.svg", line.number)) + &sentence(lines::nobody(line))
    });
    figure(figures, "retention.svg")
        + &each.collect::<String>()
        + &tables_about(report, About::Lines)
}

fn at_barriers(report: &Report, figures: &Figures) -> String {
    let each = report.barriers.iter().enumerate().map(|(number, barrier)| {
        figure(figures, &format!("barrier_{}.svg", number + 1))
            + &sentence(barriers::nobody(barrier))
    });
    each.collect::<String>() + &tables_about(report, About::Barriers)
}

fn in_a_year(report: &Report, figures: &Figures) -> String {
    let numbers = 1..=report.annual.len();
    let each = numbers.map(|number| figure(figures, &format!("annual_{number}.svg")));
    each.collect::<String>() + &tables_about(report, About::Year)
}

fn how_sure(report: &Report, figures: &Figures) -> String {
    let study = figure(figures, ERROR_STUDY);
    let study = if study.is_empty() {
        note(
            "Sampling is what the intervals say. Errors of steps and mesh are not in them: `rockfall study error SCENE --out DIR/error`, with DIR the \
             folder of these results, finds both and what they cost; `rockfall draw DIR` then shows its figure here.",
        )
    } else {
        study
    };
    study + &checks(&report.checks) + &quality(report)
}

/// File of the figure that `rockfall study error` leaves.
pub(super) const ERROR_STUDY: &str = "error.svg";

fn checks(checks: &[Check]) -> String {
    if checks.is_empty() {
        return String::new();
    }
    let row = |check: &Check| {
        format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n",
            escape(&check.name),
            if check.passes { "plausible" } else { "<b>look here</b>" },
            escape(&check.found)
        )
    };
    let rows: String = checks.iter().map(row).collect();
    format!("<h3>Plausibility</h3>\n<table class=\"checks\">\n{rows}</table>\n")
}

pub(super) fn figure_section(figures: &[(Heading, Drawing)]) -> String {
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
    format!("<p>{} {scheme}</p>\n", METHOD.join(" "))
}

fn inputs(report: &Report) -> String {
    let text = &report.text;
    let mut body = pairs(&text.inputs);
    if !text.mesh_health.is_empty() {
        let lines: String = text.mesh_health.iter().map(|line| escape(line) + "\n").collect();
        let _ = write!(body, "<h3>Health of the meshes</h3>\n<pre>{lines}</pre>\n");
    }
    body
}

fn plan(report: &Report) -> String {
    let lines = &report.text.plan;
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines.iter().map(|line| escape(line) + "\n").collect();
    format!("<pre>{lines}</pre>\n")
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
    format!("<h3>Quality statement</h3>\n{}", pairs(&rows))
}

fn glossary() -> String {
    let entry = |(term, meaning): &(&str, &str)| {
        format!("<dt>{}</dt><dd>{}</dd>\n", escape(term), escape(meaning))
    };
    let entries: String = GLOSSARY.iter().map(entry).collect();
    format!("<dl>\n{entries}</dl>\n")
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

//! The report page: one file, no scripts, nothing fetched; prints to A4.
//!
//! The first page answers: the map, what arrives at lines and barriers, and what must be known before the numbers are
//! used. Then one chapter a question.

mod chapters;
mod front;
mod style;
mod tables;

pub use tables::plain_headline;

use super::figure::{Drawing, Heading};
use super::format;
use super::model::{Check, Plausibility, Report};
use super::words::{Words, fill};
use crate::output::RunTimes;
use crate::simulation::Stop;
use std::cell::Cell;
use std::fmt::Write as _;
use style::STYLE;

/// Text for the page. A number stays in one line with its sign for per cent: a thin space breaks, a narrow no-break space does not.
fn escape(text: &str) -> String {
    format::escape(text).replace('\u{2009}', "\u{202f}").replace(" %", "\u{a0}%")
}

/// What is drawn, in the order of the page.
type Figures = [(Heading, Drawing)];
/// Figures, the language of their captions, and how many stand on the page so far: they are numbered as a reader meets
/// them.
struct NumberedFigures<'a> {
    figures: &'a Figures,
    words: &'a Words,
    count: Cell<usize>,
}

impl NumberedFigures<'_> {
    /// The figure of a file with the next number; nothing if it was not drawn.
    fn figure(&self, file: &str) -> String {
        let found = self.figures.iter().find(|(heading, _)| heading.file == file);
        found.map_or(String::new(), |figure| {
            self.count.set(self.count.get() + 1);
            numbered(figure, self.count.get(), self.words)
        })
    }

    fn all(&self, files: &[&str]) -> String {
        files.iter().map(|file| self.figure(file)).collect()
    }
}

/// A chapter: its anchor, what it asks, and its content.
struct Chapter {
    anchor: &'static str,
    title: &'static str,
    body: String,
}

/// The page with the figures inlined.
pub fn page(report: &Report, figures: &Figures) -> String {
    let chapter = |anchor, title, body| Chapter { anchor, title, body };
    let words = report.words();
    let drawn = NumberedFigures { figures, words, count: Cell::new(0) };
    let mut page = head(&report.text.title, words);
    page += &front::page(report, &drawn);
    let chapters = [
        chapter("where", words.ch_where, chapters::where_to(report, &drawn)),
        chapter("how", words.ch_how, chapters::how_fast(report, &drawn)),
        chapter("lines", words.ch_lines, chapters::at_lines(report, &drawn)),
        chapter("barriers", words.ch_barriers, chapters::at_barriers(report, &drawn)),
        chapter("year", words.ch_year, chapters::in_a_year(report, &drawn)),
        chapter("sure", words.ch_sure, how_sure(report, &drawn)),
        chapter("out", words.ch_out, plan(report)),
        chapter("inputs", words.ch_inputs, method(report) + &inputs(report)),
        chapter("words", words.ch_words, glossary(report)),
    ];
    let shown: Vec<&Chapter> = chapters.iter().filter(|one| !one.body.is_empty()).collect();
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

pub(super) fn head(title: &str, words: &Words) -> String {
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}{}{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n",
        words.code,
        words.colon(),
        words.rockfall_report
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

fn contents(chapters: &[&Chapter]) -> String {
    let mut items = String::new();
    for one in chapters {
        let _ = writeln!(items, "<li><a href=\"#{}\">{}</a></li>", one.anchor, escape(one.title));
    }
    format!("<nav>\n<ol>\n{items}</ol>\n</nav>\n")
}

/// What chance, steps and mesh do to the numbers.
fn how_sure(report: &Report, drawn: &NumberedFigures<'_>) -> String {
    let words = report.words();
    let study = drawn.figure(super::studied::FIGURE);
    let study = if study.is_empty() { note(words.no_error_study) } else { study };
    study + &checks(&report.checks, words) + &quality(report)
}

/// A figure with its number, title and caption.
fn numbered((heading, drawing): &(Heading, Drawing), number: usize, words: &Words) -> String {
    let head = fill(words.figure, &[("n", &number), ("title", &heading.title)]);
    format!(
        "<figure>\n{}<figcaption><b>{}</b> {}</figcaption>\n</figure>\n",
        drawing.svg,
        escape(&head),
        escape(&drawing.caption)
    )
}

fn checks(checks: &[Check], words: &Words) -> String {
    if checks.is_empty() {
        return String::new();
    }
    let row = |check: &Check| {
        format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n",
            escape(&check.name),
            match check.verdict {
                Plausibility::Plausible => escape(words.plausible),
                Plausibility::AtLimit => escape(words.at_limit),
                Plausibility::NotJudged => escape(words.drawn().not_judged),
                Plausibility::Off => format!("<b>{}</b>", escape(words.look_here)),
            },
            escape(&check.found)
        )
    };
    let rows: String = checks.iter().map(row).collect();
    let head = escape(words.plausibility);
    format!("<h3>{head}</h3>\n<table class=\"checks\">\n{rows}</table>\n")
}

pub(super) fn figure_section(figures: &Figures, words: &Words) -> String {
    let each = figures.iter().enumerate().map(|(k, figure)| numbered(figure, k + 1, words));
    section(words.figures, &each.collect::<String>())
}

fn method(report: &Report) -> String {
    format!("<p>{}</p>\n", escape(&report.text.method))
}

fn inputs(report: &Report) -> String {
    let (text, words) = (&report.text, report.words());
    let mut body = pairs(&text.inputs);
    if !text.mesh_health.is_empty() {
        let lines: String = text.mesh_health.iter().map(|line| escape(line) + "\n").collect();
        let _ = write!(
            body,
            "<h3>{}</h3>\n{}<pre lang=\"en\">{lines}</pre>\n",
            escape(words.mesh_health),
            note(words.in_english)
        );
    }
    body
}

fn plan(report: &Report) -> String {
    pairs(&report.text.plan)
}

fn quality(report: &Report) -> String {
    let text = &report.text;
    let failed = report.releases.iter().filter(|f| matches!(f.stop, Stop::Failed(_))).count();
    let left = report.releases.iter().filter(|f| f.stop == Stop::LeftTerrain).count();
    let count = |n: usize| format::decimal(n as f64, 0);
    let words = report.words();
    let remainder = text.energy_remainder.map_or(words.not_recorded.to_owned(), |share| {
        fill(words.remainder, &[("share", &format::significant(share, 2))])
    });
    let lost = fill(words.lost_rocks_are, &[("failed", &count(failed)), ("left", &count(left))]);
    let or_unknown =
        |said: &str| if said.is_empty() { words.not_stated.to_owned() } else { said.to_owned() };
    let rows = [
        (words.terrain, or_unknown(&text.terrain_source)),
        (words.ground_values, or_unknown(&text.parameter_source)),
        (words.releases, count(report.releases.len())),
        (words.lost_rocks, lost),
        (words.not_accounted, remainder),
        (words.seed_row, text.seed.to_string()),
        (words.version, text.version.clone()),
    ];
    let rows = rows.map(|(name, value)| (name.to_owned(), value));
    format!("<h3>{}</h3>\n{}", escape(words.quality), pairs(&rows))
}

/// What only the rotational energy of spheres says, in every language.
const SPHERE: &str = "2/5 m R²";

fn glossary(report: &Report) -> String {
    let words = report.words();
    let entry = |(term, meaning): &(&str, &str)| {
        let turns = !report.shapes.is_empty() && meaning.contains(SPHERE);
        let meaning = if turns { words.shapes().turning } else { meaning };
        format!("<dt>{}</dt><dd>{}</dd>\n", escape(term), escape(meaning))
    };
    let entries: String = words.glossary.iter().map(entry).collect();
    format!("<dl>\n{entries}</dl>\n")
}

/// How long the computation took, on how many threads, in how much memory.
fn run_time(took: &RunTimes, words: &Words) -> String {
    let number = |value: f64| format::significant(value, 3);
    let (seconds, rate) = (number(took.seconds), number(took.releases_per_second));
    let found: [(&str, &dyn std::fmt::Display); 3] =
        [("t", &seconds), ("k", &took.threads), ("n", &rate)];
    let memory = took.memory_bytes.map_or(String::new(), |bytes| {
        format!(" · {}", fill(words.memory_used, &[("m", &number(1e-6 * bytes as f64))]))
    });
    format!(" · {}{memory}", fill(words.rate, &found))
}

fn footer(report: &Report) -> String {
    let text = &report.text;
    let words = report.words();
    let took = text.took.map_or(String::new(), |took| run_time(&took, words));
    let remainder = text.energy_remainder.map_or(String::new(), |share| {
        let share = format::significant(share, 2);
        format!(" · {}", fill(words.numerical_remainder, &[("share", &share)]))
    });
    format!(
        "<footer>rockfall {} · {} {} · {} <code>{}</code>{took}{remainder}</footer>\n",
        escape(&text.version),
        words.seed,
        text.seed,
        words.scene,
        escape(&text.scene_hash)
    )
}

//! `compare.html`: one page in the style of the report, without a script.

use super::Comparison;
use super::table::{ComparedStatistic, Group, LEFT_OPEN, in_words, signed_percent};
use crate::report::figure::{Drawing, Heading};
use crate::report::format::{self, escape};
use crate::report::html::{figure_section, head, list, section};
use crate::report::words::Words;
use std::fmt::Write as _;

/// How the intervals came about.
const METHOD: &str = "Percentiles differ by as much as two values that may both be the percentiles of their runs: by the shares of rocks below them \
    (test inversion, Francisco and Fuller 1991), and where releases pair, by how many lie below one of the two only. Where all pairs are alike, the \
    difference is 0. Means by the differences of pairs, shares \
    by adjusted counts (Bonett and Price 2012 for pairs, Agresti and Caffo 2000 without). An interval covers chance in the \
    sample only, not how well ground values and terrain are known. Of twenty statistics that do not differ, one is \
    expected to be called clear. B − A is the difference of the values before they are rounded.";

/// The same where rocks weigh what they stand for.
const WEIGHTED: &str = "Where rocks weigh what they stand for, each statistic is that of its own run: percentiles by shares of their weight. Means are known by what each \
    release moves them by (delta method), shares and passages class by class \
    of size and source, as if one more rock of the heaviest class counted in each run (Fay and Feuer 1997).";

/// The page with the figures inlined.
pub(super) fn page(comparison: &Comparison, figures: &[(Heading, Drawing)]) -> String {
    let words = comparison.words;
    let mut page = head(&words.say("Two runs compared"), words);
    page.push_str(&heading(comparison));
    if !comparison.notes.is_empty() {
        let _ = writeln!(
            page,
            "<section class=\"warnings\">\n<h2>{}</h2>\n{}</section>",
            escape(words.read_first),
            list(&comparison.notes.iter().map(|note| words.say(note)).collect::<Vec<_>>())
        );
    }
    page.push_str(&section(&words.say("Inputs that differ"), &inputs(comparison)));
    page.push_str(&figure_section(figures, words));
    for group in comparison.groups.iter().filter(|group| !group.rows.is_empty()) {
        page.push_str(&section(&words.say(&group.name), &table(group, comparison)));
    }
    let mut method = format!("<p>{}</p>\n", escape(&words.say(METHOD)));
    if comparison.is_weighted() {
        let _ = writeln!(method, "<p>{}</p>", escape(&words.say(WEIGHTED)));
    }
    page.push_str(&section(&words.say("How it was compared"), &method));
    page.push_str("</main>\n</body>\n</html>\n");
    page
}

fn heading(comparison: &Comparison) -> String {
    let [a, b] = &comparison.names;
    let words = comparison.words;
    let who = |letter: &str, (folder, title): &(String, String), count: usize| {
        format!(
            "<tr><th scope=\"row\">{letter}</th><td>{} <small>{}, {} {}</small></td></tr>\n",
            escape(title),
            escape(folder),
            format::decimal(count as f64, 0),
            format::counted(count, words.release_one, words.release_many)
        )
    };
    let pairs = match (comparison.same_run, comparison.paired) {
        (true, _) => "Both are one and the same run: every difference is zero.",
        (_, true) => {
            "One seed: the same rocks are released in both, and differences are taken pair by pair."
        }
        _ if comparison.one_seed => {
            "One seed, but other sources or other classes of size: nothing pairs."
        }
        _ => "Two seeds: nothing pairs.",
    };
    format!(
        "<header>\n<h1>{}</h1>\n<p class=\"facts\">{}</p>\n<table class=\"pairs\">\n{}{}</table>\n</header>\n",
        escape(&words.say("Two runs compared")),
        escape(&words.say(pairs)),
        who("A", a, comparison.releases[0]),
        who("B", b, comparison.releases[1])
    )
}

fn inputs(comparison: &Comparison) -> String {
    if comparison.inputs.is_empty() {
        let same = "None: scene, meshes, seed, version and releases are the same.";
        return format!("<p>{}</p>\n", escape(&comparison.words.say(same)));
    }
    let mut rows = String::new();
    let words = comparison.words;
    for (name, values) in &comparison.inputs {
        let name = match name.strip_prefix(super::inputs::PLAN) {
            Some(part) => format!("{}{}", words.plan_of, words.part(part)),
            None => words.say(name),
        };
        let [a, b] = values.each_ref().map(|value| words.say_all(value));
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>",
            escape(&name),
            escape(&a),
            escape(&b)
        );
    }
    format!(
        "<table class=\"dense\">\n<thead><tr><th></th><th>A</th><th>B</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n"
    )
}

fn table(group: &Group, comparison: &Comparison) -> String {
    let words = comparison.words;
    let mut rows = String::new();
    for row in &group.rows {
        let _ = writeln!(rows, "{}", table_row(row, words));
    }
    let note = group.of_fewer().map_or(String::new(), |note| {
        format!("<p class=\"note\">{}</p>\n", escape(&words.say(&note)))
    });
    // beside shares by frequency nobody shall divide counts
    let counts = if comparison.is_weighted() { "Rocks computed" } else { "Rocks" };
    let heads = [counts, "A", "B", "B − A", "95 % interval", "of A"];
    let heads = heads.map(|head| format!("<th class=\"number\">{}</th>", escape(&words.say(head))));
    format!(
        "<div class=\"wide\"><table class=\"dense\">\n<thead><tr><th></th>{}<th></th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table></div>\n{note}",
        heads.concat()
    )
}

fn table_row(row: &ComparedStatistic, words: &Words) -> String {
    let name = match row.unit {
        "" => row.name_in(words),
        unit => format!("{} ({})", row.name_in(words), words.say(unit)),
    };
    let [a, b, change, interval] = in_words(row, words);
    let count = |k: usize| format::decimal(row.rocks[k] as f64, 0);
    let share = match row.difference.a {
        0.0 => format::NO_NUMBER.to_owned(),
        a => signed_percent(row.difference.value / a.abs(), 1),
    };
    let verdict = match row.difference.interval {
        None => "",
        Some(_) if row.difference.is_clear() => "clear",
        Some(_) if row.difference.is_none() => "the same",
        Some((low, high)) if low.is_infinite() || high.is_infinite() => LEFT_OPEN,
        Some(_) => "within chance",
    };
    let said = escape(&words.say(verdict));
    let verdict = if verdict == "clear" { format!("<b>{said}</b>") } else { said };
    let cells: String = [format!("{} | {}", count(0), count(1)), a, b, change, interval, share]
        .map(|cell| format!("<td class=\"number\">{cell}</td>"))
        .concat();
    format!(
        "<tr><th scope=\"row\">{}</th>{cells}<td class=\"verdict\">{verdict}</td></tr>",
        escape(&name)
    )
}

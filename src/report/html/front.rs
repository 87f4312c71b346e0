//! The first page: site and question, what must be known first, the map, what arrives, and the numbers of all rocks.

use super::{NumberedFigures, escape, list, pairs, tables};
use crate::report::format;
use crate::report::model::Report;
use crate::report::words::fill;

/// Site and question, the map, what arrives, and what must be known first.
pub(super) fn page(report: &Report, drawn: &NumberedFigures<'_>) -> String {
    let text = &report.text;
    let subtitle = match text.subtitle.as_str() {
        "" => String::new(),
        words => format!("<p class=\"subtitle\">{}</p>\n", escape(words)),
    };
    let count = |n: usize| format::decimal(n as f64, 0);
    let words = report.words();
    let counted = |n: usize, one, many| format!("{} {}", count(n), format::counted(n, one, many));
    let facts = format!(
        "{} · {} · {} {} · rockfall {}",
        counted(report.releases.len(), words.release_one, words.release_many),
        counted(report.paths.len(), words.stored_path_one, words.stored_path_many),
        words.seed,
        text.seed,
        text.version
    );
    let shapes = match &report.shapes[..] {
        [] => String::new(),
        names => {
            format!(" · {}", fill(words.shapes().shapes, &[("names", &names.join(", "))]))
        }
    };
    let facts = facts + &shapes;
    let view = if report.has_view {
        format!(" · <a href=\"view.html\">{}</a>", escape(words.slope_in_3d))
    } else {
        String::new()
    };
    let map = drawn.figure("plan.svg").replacen("<figure>", "<figure class=\"map\">", 1);
    let arrivals: String =
        report.arrivals.iter().map(|table| tables::table(table, words)).collect();
    format!(
        "<header class=\"site\">\n<h1>{}</h1>\n{subtitle}<p class=\"facts\">{}{view}</p>\n{}{}</header>\n\
         <div class=\"front\">\n{map}<section class=\"rocks\">\n{}</section>\n{}\
         <section id=\"answer\" class=\"answer\">\n{arrivals}</section>\n</div>\n",
        escape(&text.title),
        escape(&facts),
        pairs(&text.title_block),
        question(report),
        tables::headline(&report.headline, words),
        warnings(report),
    )
}

/// What was asked, in one sentence, from what the scene names.
fn question(report: &Report) -> String {
    let words = report.words();
    let names = |is_barrier: bool| -> Vec<String> {
        let marks = report.marks.iter().filter(|mark| mark.barrier.is_some() == is_barrier);
        marks.map(|mark| words.quoted(&mark.name)).collect()
    };
    let (lines, barriers) = (names(false), names(true));
    let mut asked =
        if zones(report) > 1 { words.question_zones } else { words.question }.to_owned();
    for (text, names) in [(words.question_lines, lines), (words.question_barriers, barriers)] {
        if !names.is_empty() {
            asked += &fill(text, &[("names", &first_of(&names))]);
        }
    }
    let mark = if words.code == "fr" { "\u{a0}?" } else { "?" };
    format!("<p class=\"question\">{}{mark}</p>\n", escape(&asked))
}

/// Zones that rocks come from: outlines of one name are one zone.
fn zones(report: &Report) -> usize {
    let mut names: Vec<&str> = report.zones.iter().map(|zone| zone.name.as_str()).collect();
    names.sort_unstable();
    names.dedup_by(|next, kept| !next.is_empty() && next == kept);
    names.len()
}

/// Names that one sentence still holds; of more it has one less, and says how many there are.
const MOST_NAMES: usize = 4;

fn first_of(names: &[String]) -> String {
    if names.len() <= MOST_NAMES {
        return names.join(", ");
    }
    format!("{}, … ({})", names[..MOST_NAMES - 1].join(", "), names.len())
}

fn warnings(report: &Report) -> String {
    if report.text.warnings.is_empty() {
        return String::new();
    }
    format!(
        "<section class=\"warnings\">\n<h2>{}</h2>\n{}</section>\n",
        escape(report.words().read_first),
        list(&report.text.warnings.iter().map(|text| format::sentence(text)).collect::<Vec<_>>())
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_names_no_more_lines_than_it_holds() {
        let names: Vec<String> = ["a", "b", "c", "d", "e"].map(str::to_owned).into();
        assert_eq!(first_of(&names[..4]), "a, b, c, d");
        assert_eq!(first_of(&names), "a, b, c, … (5)");
    }
}

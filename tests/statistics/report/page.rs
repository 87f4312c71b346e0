//! The page as a reader meets it: what comes first, how figures are numbered, and that all of it can be read on a dark ground.

use super::{inputs, places, slope, svg};
use rockfall::report::model::{Report, ZoneMark};
use rockfall::report::{self, html};

/// The first page holds site, question, map and numbers, before all else.
#[test]
fn the_first_page_holds_the_answer() {
    let report = places::site();
    let page = html::page(&report, &report::drawings(&report));
    let parts = [
        "<h1>",
        "class=\"question\"",
        "class=\"front\"",
        "<figure class=\"map\">",
        "class=\"rocks\"",
        "class=\"headline\"",
        "class=\"warnings\"",
        "class=\"answer\"",
        "<nav>",
        "<h2>1 ",
    ];
    let places = parts.map(|part| page.find(part).unwrap());
    assert!(places.is_sorted(), "{places:?}");
}

/// Of several zones the question speaks in the plural; outlines of one name are one zone.
#[test]
fn the_question_knows_how_many_zones_there_are() {
    let site = places::site();
    let of = |names: &[&str]| {
        let named = |name: &&str| ZoneMark { name: (*name).to_owned(), ..site.zones[0].clone() };
        let report = Report { zones: names.iter().map(named).collect(), ..places::site() };
        html::page(&report, &[]).contains("from the release zones come")
    };
    assert!(!of(&[""]) && !of(&["wall", "wall"]));
    assert!(of(&["wall", "gully", "wall"]) && of(&["", ""]));
}

/// Figures are numbered as a reader meets them, in every language and whatever was drawn.
#[test]
fn numbers_of_figures_rise_down_the_page() {
    for (name, report) in inputs() {
        let drawn = report::drawings(&report);
        let page = html::page(&report, &drawn);
        let numbers: Vec<usize> = page
            .split("<figcaption><b>Figure ")
            .skip(1)
            .map(|rest| rest.split('.').next().unwrap().parse().unwrap())
            .collect();
        assert_eq!(numbers, (1..=drawn.len()).collect::<Vec<_>>(), "{name}");
    }
}

/// Pasted on a dark slide, or seen in a browser that prefers the dark: the paper is white and every word has its own ink.
#[test]
fn nothing_is_unreadable_on_a_dark_ground() {
    for (name, report) in inputs() {
        let drawn = report::drawings(&report);
        for (figure, drawing) in &drawn {
            let place = format!("{} of {name}", figure.file);
            let (root, rest) = drawing.svg.split_once(">\n<title>").unwrap();
            let view: Vec<&str> = svg::attribute(root, "viewBox").unwrap().split(' ').collect();
            let (_, body) = rest.split_once("</title>").unwrap();
            let paper = body.trim_start().split('>').next().unwrap();
            let of_paper = |key| svg::attribute(paper, key).unwrap();
            assert_eq!([of_paper("x"), of_paper("y"), of_paper("fill")], ["0", "0", "#ffffff"]);
            assert_eq!([of_paper("width"), of_paper("height")], view[2..], "{place}");
            for (at, _) in body.match_indices("<text ") {
                let words = body[at..].split("</text>").next().unwrap();
                let tag = words.split('>').next().unwrap();
                let spans = words.matches("<tspan font-weight").count();
                let inked = words.matches("<tspan font-weight").count() > 0
                    && words.matches(" fill=\"#").count() >= spans;
                assert!(svg::attribute(tag, "fill").is_some() || inked, "{place}: {words}");
            }
        }
        let page = html::page(&report, &drawn);
        assert!(
            page.contains("color-scheme: only light")
                && page.contains("background: #fff; color: #222")
        );
    }
}

#[test]
fn what_the_user_wrote_cannot_break_the_page() {
    let mut report = slope::report(3, 3);
    let nasty = "</pre></title><script>alert(1)</script> & \"quotes\" 'n' \u{0}\u{b}";
    report.text.title = nasty.to_owned();
    report.text.subtitle = nasty.to_owned();
    report.text.plan = vec![(nasty.to_owned(), nasty.to_owned())];
    report.text.warnings = vec![nasty.to_owned()];
    report.text.inputs = vec![(nasty.to_owned(), nasty.to_owned())];
    report.headline[0].name = nasty.to_owned();
    report.tables[0].title = nasty.to_owned();
    let page = html::page(&report, &report::drawings(&report));
    assert!(!page.contains("<script"));
    assert!(!page.contains(['\u{0}', '\u{b}']));
    svg::check_nesting(&page, "nasty text");
}

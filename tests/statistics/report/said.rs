//! What captions and keys say where few or none are there: only what is drawn, with the numbers and forms that hold.

use super::{places, slope, svg};
use rockfall::report::model::{
    Estimate, MapMark, ProfileStretch, ProfileView, Report, ReportQuantity, ReportStretch,
};
use rockfall::report::{self, html};
use rockfall::scene::Language;

/// Caption and drawing of a figure; nothing where it is not drawn.
fn figure(report: &Report, file: &str) -> Option<(String, String)> {
    let drawn = report::drawings(report);
    let found = drawn.into_iter().find(|(heading, _)| heading.file == file);
    found.map(|(_, drawing)| (drawing.caption, drawing.svg))
}

fn plan(report: &Report) -> (String, String) {
    figure(report, "plan.svg").expect("every report has a plan")
}

/// A line far from all rocks is not in the frame: the key has no line, and the caption says which is missing.
#[test]
fn a_key_names_what_is_drawn() {
    let far = |name: &str, y: f64| MapMark {
        name: name.to_owned(),
        corners_m: vec![[0.0, y], [10.0, y]],
        barrier: None,
        is_object: false,
    };
    let report = Report { marks: vec![far("road far off", 1e5)], ..slope::report(20, 20) };
    let (caption, svg) = plan(&report);
    assert!(caption.contains("Outside the frame: “road far off”."), "{caption}");
    assert!(!svg.contains("evaluation line") && !svg.contains("road far off"));
    let (caption, svg) = plan(&places::site());
    assert!(!caption.contains("Outside the frame") && svg.contains("evaluation line"));
}

/// Without stored paths there is no side view, and the plan does not say how paths are coloured.
#[test]
fn without_paths_no_figure_shows_any() {
    let report = slope::report(60, 0);
    assert!(figure(&report, "side.svg").is_none());
    let (caption, _) = plan(&report);
    assert!(caption.contains("No path of the 60 releases is stored"), "{caption}");
    assert!(!caption.contains("colour gives the speed"), "{caption}");
    let page = html::page(&report, &report::drawings(&report));
    assert!(!page.contains("Side view"), "no chapter names it");
}

/// One is not many, in any language; French says none as one.
#[test]
fn one_release_is_said_as_one() {
    for (language, words) in [
        (Language::En, "paths of 1 of 1 release;"),
        (Language::De, "Bahnen von 1 von 1 Ablösung;"),
        (Language::Fr, "Trajectoires de 1 départ sur 1"),
        (Language::It, "Traiettorie di 1 distacco su 1;"),
    ] {
        let report = Report { language, ..slope::report(1, 1) };
        let (caption, _) = plan(&report);
        assert!(caption.contains(words), "{caption}");
        let drawn = report::drawings(&report);
        assert!(drawn.iter().all(|(_, drawing)| !drawing.caption.contains('|')), "{language:?}");
    }
    let (caption, _) = plan(&slope::report(3, 2));
    assert!(caption.contains("paths of 2 of 3 releases;"), "{caption}");
}

/// A place that no rock came to has a sentence: its curve was an empty frame from 1 to 10 J, where energies were asked for.
#[test]
fn a_year_without_a_rock_has_no_curve() {
    let mut report = places::site();
    assert!(figure(&report, "annual_1.svg").is_some());
    let view = &mut report.annual[0];
    view.with = None;
    view.without.iter_mut().for_each(|point| point.y.value = 0.0);
    assert!(figure(&report, "annual_1.svg").is_none());
}

/// The limit beside measured ends is that of as many independent ones as they are worth, and means have intervals.
#[test]
fn measured_ends_say_how_many_are_independent() {
    let mut report = places::site();
    let observed = report.observed.as_mut().unwrap();
    observed.worth = 14.0;
    observed.agreement.ks_limit = observed.agreement.ks_limit_worth(14.0);
    let (caption, _) = figure(&report, "measured.svg").unwrap();
    assert!(caption.contains("The limit is that of 14 independent ends"), "{caption}");
    assert!(caption.contains("limit at 5 % 0.37;"), "{caption}");
    assert!(caption.contains("it is no test of them") && caption.contains(" to "), "{caption}");
}

/// Without percentiles no line is drawn, and none is explained.
#[test]
fn styles_of_lines_are_said_where_there_are_lines() {
    let mut report = slope::report(40, 4);
    let lines = "Lines: P50 full";
    assert!(figure(&report, "distributions.svg").unwrap().0.contains(lines));
    report.quantiles.clear();
    assert!(!figure(&report, "distributions.svg").unwrap().0.contains(lines));
}

/// One path is no median of several.
#[test]
fn the_only_path_is_called_so() {
    let said = |paths: usize| figure(&slope::report(20, paths), "along.svg").map(|(said, _)| said);
    let one = said(1).expect("one path is drawn");
    assert!(one.contains("the only stored path") && !one.contains("median runout"), "{one}");
    let three = said(3).expect("three paths are drawn");
    assert!(three.contains("median runout") && !three.contains("only"), "{three}");
}

/// Of fewer rocks than bound it no P95 is drawn along the way, and the key has none; of more it has.
#[test]
fn a_key_without_p95_where_none_is_drawn() {
    let with = |value: f64| {
        let found = ReportStretch { median: 1.0, p95: Estimate::plain(value), largest: 3.0 };
        let stretch = |from_m: f64| ProfileStretch { from_m, height_m: found, speed_m_s: found };
        let stretches = [0.0, 5.0, 10.0].map(stretch).to_vec();
        let profile = Some(ProfileView { step_m: 5.0, stretches, marks: Vec::new() });
        let report = Report { profile, ..slope::report(60, 0) };
        let (_, svg) = figure(&report, "profile.svg").expect("it is drawn");
        svg.contains(">P95</text>")
    };
    assert_eq!([with(2.0), with(f64::NAN)], [true, false]);
}

/// Values of percentiles stand where none of their dotted lines runs, wherever these fall.
#[test]
fn no_mark_runs_through_the_values_of_runout() {
    let mut report = slope::report(400, 0);
    let longest = report.releases.iter().map(|fall| fall.runout_m).fold(0.0, f64::max);
    let quantiles = report.quantiles.get_mut(&ReportQuantity::Runout).expect("runout is known");
    // one in each corner, none at rest between them
    let parts = [0.02, 0.12, 0.9, 0.97, 0.98];
    for (quantile, part) in quantiles.iter_mut().zip(parts) {
        quantile.at = Estimate::new(part * longest, 0.99 * part * longest, 1.01 * part * longest);
    }
    let (_, drawn) = figure(&report, "runout.svg").expect("it is drawn");
    let of_text = |tag: &str| svg::attribute(tag, "x").and_then(|x| x.parse::<f64>().ok());
    let texts = drawn.split("<text").skip(1).filter(|text| text.contains("\u{2009}m<"));
    let ends: Vec<(f64, f64)> = texts
        .filter_map(|text| {
            let words = text.split('>').nth(1)?.split('<').next()?;
            // tenths of a pixel; letters are half as wide as high, at least
            Some((of_text(text)?, of_text(text)? + 50.0 * words.chars().count() as f64))
        })
        .collect();
    assert!(ends.len() >= parts.len(), "{}", ends.len());
    let dotted = drawn.split("stroke-dasharray=\"12 18\">").skip(1);
    let uprights: Vec<f64> = dotted
        .filter_map(|rest| rest.split("</g>").next())
        .flat_map(|group| group.split('<').skip(1))
        .flat_map(svg::points)
        .map(|(x, _)| x)
        .collect();
    assert!(!uprights.is_empty());
    for (left, right) in ends {
        assert!(
            uprights.iter().all(|x| *x < left || *x > right),
            "{left} to {right}: {uprights:?}"
        );
    }
}

//! Figures and page from made data: whatever comes in, what goes out is a file that opens and a drawing that stays on its paper.

pub(crate) mod boxes;
mod page;
mod places;
mod raster;
mod said;
mod slender;
mod slope;
mod studies;
mod svg;

use places::net;
use rockfall::report::axis::Axis;
use rockfall::report::canvas::{Label, Pen, paint};
use rockfall::report::colour;
use rockfall::report::figure::WIDTH_PX;
use rockfall::report::figures::FIGURES;
use rockfall::report::model::{
    Estimate, Is, Path, ReleaseEnd, Report, ReportPathPoint, ReportQuantity, Text,
};
use rockfall::report::panel::{FOOT_PX, Panel};
use rockfall::report::svg::path::PaperFrame;
use rockfall::report::words::Words;
use rockfall::report::{self, html};
use rockfall::scene::Language;
use rockfall::simulation::{PathState, Stop};

/// What is drawn is written: a file for every figure, and the page with all of them in it.
#[test]
fn every_drawing_is_on_the_disk_and_on_the_page() {
    let dir = tempfile::tempdir().unwrap();
    for (name, report) in inputs() {
        let dir = dir.path().join(name);
        report::draw(&report, &dir).unwrap();
        let page = std::fs::read_to_string(dir.join("report.html")).unwrap();
        for (heading, drawing) in report::drawings(&report) {
            let file = std::fs::read_to_string(dir.join("figures").join(&heading.file)).unwrap();
            assert!(file == drawing.svg && page.contains(&file), "{name}: {}", heading.file);
        }
    }
}

/// What a report may be fed: the common and the odd.
fn inputs() -> Vec<(&'static str, Report)> {
    let full = slope::report(1000, 300);
    let one = slope::report(1, 1);
    vec![
        ("full", full.clone()),
        ("empty", Report::default()),
        ("one_release", one.clone()),
        ("no_path", Report { paths: Vec::new(), ..slope::report(30, 0) }),
        ("no_ground", Report { ground: None, ..full.clone() }),
        ("no_motion", slope::filled(Report { releases: vec![still(); 20], ..Report::default() })),
        ("one_point", slope::filled(Report { paths: vec![one_point()], ..one.clone() })),
        ("not_numbers", slope::filled(broken(full))),
        ("huge", slope::filled(stretched(one, 1e7))),
        ("small", small()),
        ("all_ends", slope::filled(all_ends(slope::report(400, 20)))),
        ("barriers", Report { barriers: vec![net(60), net(0)], ..slope::report(30, 5) }),
        ("site", places::site()),
        ("left", left()),
        ("metres", slender::metres()),
        ("steep", slender::steep()),
    ]
}

/// A rock that stays where it is released.
fn still() -> ReleaseEnd {
    ReleaseEnd {
        stop: Stop::AtRest,
        runout_m: 0.0,
        drop_m: 0.0,
        reach_angle_deg: 0.0,
        max_speed_m_s: 0.0,
        max_translational_j: 0.0,
        max_rotational_j: 0.0,
        max_total_j: 0.0,
        max_height_m: 0.0,
        impacts: 0,
        tree_impacts: 0,
        start_m: [2_600_000.0, 1_200_000.0, 500.0],
        end_m: [2_600_000.0, 1_200_000.0, 500.0],
        weight: 1.0,
    }
}

fn one_point() -> Path {
    let place_m = [2_600_050.0, 1_200_100.0, 900.0];
    let state = PathState::Flight;
    Path {
        index: 0,
        points: vec![ReportPathPoint {
            time_s: 0.0,
            place_m,
            speed_m_s: 0.0,
            clearance_m: 0.0,
            state,
        }],
    }
}

/// Values that a failed rock may leave behind.
fn broken(mut report: Report) -> Report {
    for (i, fall) in report.releases.iter_mut().enumerate() {
        match i % 5 {
            0 => fall.runout_m = f64::NAN,
            1 => fall.end_m = [f64::NAN; 3],
            2 => fall.max_speed_m_s = f64::INFINITY,
            3 => fall.max_total_j = f64::NEG_INFINITY,
            _ => fall.reach_angle_deg = f64::NAN,
        }
    }
    for path in &mut report.paths {
        for (i, point) in path.points.iter_mut().enumerate() {
            match i % 7 {
                0 => point.clearance_m = f64::NAN,
                3 => point.speed_m_s = f64::NAN,
                5 => point.place_m[i % 3] = f64::NAN,
                _ => {}
            }
        }
    }
    report
}

fn stretched(mut report: Report, factor: f64) -> Report {
    let fall = &mut report.releases[0];
    fall.end_m[0] += factor;
    fall.runout_m = factor;
    fall.max_total_j *= factor;
    report
}

/// Every way to end, often: the longest key a map can have.
fn all_ends(mut report: Report) -> Report {
    let stops = [Stop::AtRest, Stop::LeftTerrain, Stop::TimeUp, Stop::Failed("made".to_owned())];
    report.releases = vec![report.releases; 10].concat();
    for (i, fall) in report.releases.iter_mut().enumerate() {
        fall.stop = stops[i % 4].clone();
        // a narrow map leaves the key little room
        fall.start_m[0] = 2_600_070.0;
        fall.end_m[0] = 2_600_070.0 + (i % 9) as f64;
    }
    Report { ground: None, paths: Vec::new(), ..report }
}

/// Most rocks leave the terrain: runout is open upwards, the reach angle downwards.
fn left() -> Report {
    let mut report = slope::report(400, 40);
    report.releases.iter_mut().step_by(2).for_each(|fall| fall.stop = Stop::LeftTerrain);
    let mut report = slope::filled(report);
    report.runout_exceedance.truncate(60);
    for (quantity, is) in
        [(ReportQuantity::Runout, Is::AtLeast), (ReportQuantity::ReachAngle, Is::AtMost)]
    {
        for quantile in report.quantiles.get_mut(&quantity).into_iter().flatten() {
            let at = &mut quantile.at;
            at.is = is;
            if is == Is::AtLeast { at.high = f64::NAN } else { at.low = f64::NAN }
        }
    }
    report
}

/// A table-top experiment: everything within a metre, at the origin.
fn small() -> Report {
    let mut report = slope::report(40, 40);
    let shrink = |p: [f64; 3]| [(p[0] - 2.6e6) * 1e-3, (p[1] - 1.2e6) * 1e-3, p[2] * 1e-3];
    for fall in &mut report.releases {
        (fall.start_m, fall.end_m) = (shrink(fall.start_m), shrink(fall.end_m));
        fall.runout_m *= 1e-3;
        fall.max_total_j *= 1e-9;
    }
    for point in report.paths.iter_mut().flat_map(|path| &mut path.points) {
        point.place_m = shrink(point.place_m);
        point.clearance_m *= 1e-3;
    }
    slope::filled(Report { ground: None, ..report })
}

#[test]
fn every_input_gives_drawings_that_stay_on_their_paper_and_off_each_other() {
    let mut faults = Vec::new();
    for (name, report) in inputs() {
        for language in Language::ALL {
            let report = Report { language, ..report.clone() };
            for (figure, drawing) in report::drawings(&report) {
                let place = format!("{} of {name}, {language:?}", figure.file);
                svg::check(&drawing.svg, &place);
                faults.extend(boxes::faults(&drawing.svg, &place));
                let words = svg::strip_tags(&drawing.svg) + &drawing.caption;
                let is_left = ["NaN", "{", "}"].iter().any(|odd| words.contains(odd));
                assert!(!is_left, "{place}: {}", drawing.caption);
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_page_is_well_formed_and_fetches_nothing() {
    let all = inputs().into_iter().flat_map(|(name, report)| {
        Language::ALL.map(|language| (name, Report { language, ..report.clone() }))
    });
    for (name, report) in all {
        let page = html::page(&report, &report::drawings(&report));
        svg::check_nesting(&page, name);
        let fetched = ["<script", "<link", "src=", "@import", "url(http"];
        assert!(fetched.iter().all(|f| !page.contains(f)), "{name}");
        // not in the whole page: the letters may stand in a packed picture
        assert!(!svg::strip_tags(&page).contains("NaN"), "{name}");
    }
}

/// Figures share one page: an id defined twice would let one figure use the clip of another.
#[test]
fn no_id_is_given_twice_on_the_page() {
    let report = slope::report(30, 10);
    let page = html::page(&report, &report::drawings(&report));
    let mut ids: Vec<&str> =
        page.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
    assert!(count > 0);
}

#[test]
fn the_same_report_gives_the_same_bytes() {
    let page = || {
        let report = slope::report(200, 50);
        html::page(&report, &report::drawings(&report))
    };
    assert_eq!(page(), page());
}

/// 100 000 releases and 500 paths, ends spread over the slope.
fn large() -> Report {
    let mut report = slope::report(1000, 500);
    let mut dice = slope::Dice::new(5);
    let few = report.releases.clone();
    while report.releases.len() < 100_000 {
        let mut fall = few[report.releases.len() % few.len()].clone();
        fall.end_m[0] += 12.0 * dice.normal();
        fall.end_m[1] += 20.0 * dice.roll();
        fall.runout_m += 5.0 * dice.normal();
        report.releases.push(fall);
    }
    slope::filled(report)
}

/// What lies on top of each other is drawn once, paths are thinned, pictures are packed.
#[test]
fn a_large_run_gives_a_page_of_less_than_five_megabytes() {
    let report = large();
    let drawn = report::drawings(&report);
    for (figure, drawing) in &drawn {
        svg::check(&drawing.svg, &figure.file);
        println!("{} {} kB", figure.file, drawing.svg.len() / 1000);
    }
    let page = html::page(&report, &drawn);
    println!("page {} kB", page.len() / 1000);
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
}

/// What a study of error against cost draws: both axes logarithmic, dashed lines, values beyond the frame.
fn log_log() -> String {
    let frame = PaperFrame { left: 70.0, top: 10.0, right: 660.0, bottom: 300.0 };
    let x = Axis::log(3e-6, 0.7, "Step (s)");
    let panel = Panel::new(frame, x, Axis::log(1e-9, 1e-1, "Error (–)"));
    paint("loglog", (WIDTH_PX, 300.0 + FOOT_PX), "Error", |canvas| {
        panel.grid(canvas);
        let line = |power: i32| {
            (0..60)
                .map(|i| 10f64.powf(-7.0 + 0.15 * f64::from(i)))
                .map(move |h| (h, h.powi(power)))
                .collect::<Vec<_>>()
        };
        panel.line(canvas, &line(1), Pen::full(colour::BLUE, 1.5));
        panel.line(canvas, &line(2), Pen::full(colour::VERMILLION, 1.5).dashed());
        panel.axes(canvas);
    })
}

/// A line beyond the range must be cut where it leaves the frame. Drawn as it is it would run over the axes; moved onto the frame it
/// would change its direction.
#[test]
fn lines_on_logarithmic_axes_end_at_the_frame() {
    let svg = log_log();
    svg::check(&svg, "log-log");
    for colour in [colour::BLUE, colour::VERMILLION] {
        let points = svg::stroked_with(&svg, &colour::hex(colour));
        assert_eq!(points.len(), 2, "a straight line, thinned: {points:?}");
        for (x, y) in points {
            let at_an_edge = [x - 700.0, x - 6600.0, y - 100.0, y - 3000.0];
            assert!(at_an_edge.iter().any(|d| d.abs() <= 1.0), "({x}, {y})");
            assert!((699.0..=6601.0).contains(&x) && (99.0..=3001.0).contains(&y), "({x}, {y})");
        }
    }
}

#[test]
fn text_in_a_figure_stays_text() {
    let svg = paint("text", (300.0, 50.0), "<title> & \"quotes\"", |canvas| {
        canvas.text(&Label::new("a < b & 10⁻⁵ > 0", (10.0, 20.0)));
    });
    svg::check(&svg, "text");
    assert!(svg.contains("a &lt; b &amp; 10"));
}

/// A line and a net that nobody reaches have a sentence, and no empty axes.
#[test]
fn what_nobody_reaches_has_a_sentence_and_no_figure() {
    let report = places::site();
    let drawn = report::drawings(&report);
    let files: Vec<&str> = drawn.iter().map(|(heading, _)| heading.file.as_str()).collect();
    assert!(files.contains(&"line_2.svg") && files.contains(&"barrier_1.svg"), "{files:?}");
    assert!(!files.contains(&"line_3.svg") && !files.contains(&"barrier_2.svg"), "{files:?}");
    let page = html::page(&report, &drawn);
    assert!(page.contains("crosses the line “nobody&#39;s line”"));
    assert!(page.contains("No rock arrives at barrier"));
    // what a year brings too
    assert!(files.contains(&"annual_3.svg") && !files.contains(&"annual_2.svg"), "{files:?}");
    assert!(page.contains(
        "Object “hut”: none of 700 rocks, as precise as 350 of equal weight, comes here: fewer than"
    ));
}

/// The page speaks its language: head, chapters, axes, captions and glossary; and nothing of the English ones is left.
#[test]
fn a_page_speaks_the_language_of_its_scene() {
    let said = [
        (Language::De, ["Sprunghöhe", "Auslaufstrecke", "Pauschalgefälle", "Zuerst zu lesen"]),
        (
            Language::Fr,
            ["Hauteur de rebond", "Distance de propagation", "Angle d’énergie", "À lire d’abord"],
        ),
        (
            Language::It,
            [
                "Altezza di rimbalzo",
                "Distanza di arresto",
                "Angolo di propagazione",
                "Da leggere per primo",
            ],
        ),
    ];
    let english = [
        "Bounce height",
        "Runout",
        "Reach angle",
        "Read this first",
        "releases",
        "Speed",
        "Figure 1. Plan",
    ];
    for (language, words) in said {
        let mut report = Report { language, ..places::site() };
        // tables and headline of a made report are not gathered, and their words are given
        (report.tables, report.arrivals, report.headline) = (Vec::new(), Vec::new(), Vec::new());
        report.text = Text { warnings: vec!["given".to_owned()], ..Text::default() };
        let page = svg::strip_tags(&html::page(&report, &report::drawings(&report)));
        for word in words {
            assert!(page.contains(word), "{language:?}: {word}");
        }
        for word in english {
            assert!(!page.contains(word), "{language:?}: {word}");
        }
    }
}

/// A percentile that rocks beyond the terrain decide is written as a bound; what too few rocks cannot give, as their
/// number.
#[test]
fn bounds_and_missing_rocks_are_named() {
    let mut report = left();
    report.headline[0].estimate = report.quantiles[&ReportQuantity::Runout][0].at;
    report.headline[1].estimate = Estimate::lacking(52);
    let page = html::page(&report, &report::drawings(&report));
    assert!(page.contains("≥\u{2009}"), "a lower bound has its sign");
    assert!(page.contains("52 more rocks needed"));
    let lines = html::plain_headline(&report.headline, Words::of(Language::En));
    assert!(lines[0].contains('≥') && lines[1].ends_with("52 more rocks needed"), "{lines:?}");
}

#[test]
fn every_figure_has_its_own_file() {
    let mut files: Vec<&str> = FIGURES.iter().map(|f| f.file).collect();
    files.sort_unstable();
    files.dedup();
    assert_eq!(files.len(), FIGURES.len());
}

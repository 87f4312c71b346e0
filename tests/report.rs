//! Figures and page from made data: whatever comes in, what goes out is a file that opens and a drawing that stays on its paper.

#[path = "report/slope.rs"]
mod slope;
#[path = "report/svg.rs"]
mod svg;

use rockfall::report::axis::Axis;
use rockfall::report::colour;
use rockfall::report::figure::{FIGURES, WIDTH_PX};
use rockfall::report::input::{BarrierView, Fall, Path, PlaceView, Point, Report};
use rockfall::report::panel::{FOOT_PX, Panel};
use rockfall::report::paper::{Label, Pen, paint};
use rockfall::report::raster::GroundRaster;
use rockfall::report::svg::path::Frame;
use rockfall::report::{self, html};
use rockfall::rock::Vec3;
use rockfall::trajectory::{PathState, Stop};

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
    ]
}

/// A barrier that so many rocks reach, some of them with no ground below, and fewer at another place.
fn net(rocks: usize) -> BarrierView {
    let top_m = |k: usize| if k % 7 == 6 { f64::INFINITY } else { 0.3 + 0.1 * k as f64 };
    let place = |offset_m: f64, rocks: usize| PlaceView {
        offset_m,
        arriving: 0.5,
        rocks: (0..rocks).map(|k| (top_m(k), 1e4 * k as f64)).collect(),
    };
    BarrierView {
        name: "<net> & \"fence\"".to_owned(),
        height_m: 3.0,
        capacity_j: 4e5,
        design: (rocks > 0).then_some((4.2, 6e5)),
        places: vec![place(0.0, rocks), place(-10.0, rocks / 2), place(20.0, 0)],
    }
}

/// A rock that stays where it is released.
fn still() -> Fall {
    Fall {
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
    }
}

fn one_point() -> Path {
    let place_m = [2_600_050.0, 1_200_100.0, 900.0];
    let state = PathState::Flight;
    Path {
        index: 0,
        points: vec![Point { time_s: 0.0, place_m, speed_m_s: 0.0, clearance_m: 0.0, state }],
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
fn every_input_gives_drawings_that_stay_on_their_paper() {
    for (name, report) in inputs() {
        for (figure, drawing) in report::drawings(&report) {
            let place = format!("{} of {name}", figure.file);
            svg::check(&drawing.svg, &place);
            assert!(!drawing.caption.contains("NaN"), "{place}: {}", drawing.caption);
        }
    }
}

#[test]
fn the_page_is_well_formed_and_fetches_nothing() {
    for (name, report) in inputs() {
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
fn what_the_user_wrote_cannot_break_the_page() {
    let mut report = slope::report(3, 3);
    let nasty = "</pre></title><script>alert(1)</script> & \"quotes\" 'n' \u{0}\u{b}";
    report.text.title = nasty.to_owned();
    report.text.subtitle = nasty.to_owned();
    report.text.plan = vec![nasty.to_owned()];
    report.text.warnings = vec![nasty.to_owned()];
    report.text.inputs = vec![(nasty.to_owned(), nasty.to_owned())];
    report.headline[0].name = nasty.to_owned();
    report.tables[0].title = nasty.to_owned();
    let page = html::page(&report, &report::drawings(&report));
    assert!(!page.contains("<script"));
    assert!(!page.contains(['\u{0}', '\u{b}']));
    svg::check_nesting(&page, "nasty text");
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
    let frame = Frame { left: 70.0, top: 10.0, right: 660.0, bottom: 300.0 };
    let x = Axis::log(3e-6, 0.7, "Step (s)");
    let panel = Panel::new(frame, x, Axis::log(1e-9, 1e-1, "Error (–)"));
    paint("loglog", (WIDTH_PX, 300.0 + FOOT_PX), "Error", |paper| {
        panel.grid(paper);
        let line = |power: i32| {
            (0..60)
                .map(|i| 10f64.powf(-7.0 + 0.15 * f64::from(i)))
                .map(move |h| (h, h.powi(power)))
                .collect::<Vec<_>>()
        };
        panel.line(paper, &line(1), Pen::full(colour::BLUE, 1.5));
        panel.line(paper, &line(2), Pen::full(colour::VERMILLION, 1.5).dashed());
        panel.axes(paper);
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
    let svg = paint("text", (300.0, 50.0), "<title> & \"quotes\"", |paper| {
        paper.text(&Label::new("a < b & 10⁻⁵ > 0", (10.0, 20.0)));
    });
    svg::check(&svg, "text");
    assert!(svg.contains("a &lt; b &amp; 10"));
}

#[test]
fn every_figure_has_its_own_file() {
    let mut files: Vec<&str> = FIGURES.iter().map(|f| f.file).collect();
    files.sort_unstable();
    files.dedup();
    assert_eq!(files.len(), FIGURES.len());
}

/// On a mesh of 1 m a bilinear raster can be off by the curvature over a triangle and a cell: the made slope bends by less than
/// 0.5·0.31² + 0.25·1.3 = 0.37 /m (away from the kink at the cliff), so by 0.37·(1² + 0.35²)/4 = 0.11 m.
#[test]
fn the_raster_gives_the_height_of_the_mesh() {
    let origin = Vec3::new(2_600_000.0, 1_200_000.0, 800.0);
    let raster = GroundRaster::from_terrain(&slope::terrain(1.0, origin), 600);
    let mut dice = slope::Dice::new(3);
    let mut worst: f64 = 0.0;
    for _ in 0..2000 {
        let (x, y) = (1.0 + 138.0 * dice.roll(), 1.0 + 166.0 * dice.roll());
        let found = raster.height_at(origin.x + x, origin.y + y);
        worst = worst.max((found - 800.0 - slope::height_m(x, y)).abs());
    }
    assert!(worst < 0.11, "{worst} m off");
    assert!(raster.height_at(origin.x - 5.0, origin.y).is_nan());
    assert!(raster.height_at(origin.x + 20.0, origin.y + 300.0).is_nan());
}

/// On cells of half a metre every second cell centre lies exactly on an edge between two triangles: it belongs to one of them.
#[test]
fn no_hole_between_triangles() {
    let raster = GroundRaster::from_terrain(&slope::terrain(1.0, Vec3::zeros()), 400);
    assert!((raster.cell_m - 0.5).abs() < 1e-12);
    let holes = raster.height_m.iter().filter(|z| z.is_nan()).count();
    assert_eq!(holes, 0);
}

/// 60 open prisms of 0.2 to 0.45 m on cells of a third of a metre: each leaves a mark, none is hollow.
#[test]
fn every_stem_leaves_a_mark() {
    let origin = Vec3::new(0.0, 0.0, 0.0);
    let raster = GroundRaster::from_terrain(&slope::terrain(2.0, origin), 600);
    let patches = raster.tree_patches();
    assert!(
        (50..=60).contains(&patches.len()),
        "{} patches (touching stems are one)",
        patches.len()
    );
    let area_m2 = raster.trees.iter().filter(|&&t| t).count() as f64 * raster.cell_m.powi(2);
    // a cell that a stem touches counts: a ring of half a cell around radius 0.2..0.45
    let (least, most) = (60.0 * 3.1 * 0.2_f64.powi(2), 60.0 * 3.2 * (0.45 + raster.cell_m).powi(2));
    assert!((least..most).contains(&area_m2), "{area_m2} m²");
}

#[test]
fn a_raster_read_back_is_the_same_raster() {
    let dir = tempfile::tempdir().unwrap();
    let origin = Vec3::new(2_600_000.123, 1_200_000.456, 800.0);
    let raster = GroundRaster::from_terrain(&slope::terrain(3.0, origin), 97);
    raster.write(dir.path()).unwrap();
    let back = GroundRaster::read(dir.path()).unwrap().unwrap();
    assert_eq!(back.trees, raster.trees);
    let bits = |r: &GroundRaster| r.height_m.iter().map(|z| z.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&back), bits(&raster));
    assert_eq!(
        (back.west_m, back.south_m, back.cell_m),
        (raster.west_m, raster.south_m, raster.cell_m)
    );
    assert!(GroundRaster::read(&dir.path().join("nowhere")).unwrap().is_none());
}

#[test]
fn a_wrong_grid_file_says_what_is_wrong() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("maps/ground.asc");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let cases = [
        ("ncols x", "ncols"),
        (
            "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize -1\nNODATA_value -9999\n1 2",
            "positive",
        ),
        (
            "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1",
            "ncols × nrows = 2",
        ),
        (
            "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 abc",
            "value 2",
        ),
    ];
    for (text, expected) in cases {
        std::fs::write(&path, text).unwrap();
        let message = GroundRaster::read(dir.path()).unwrap_err().to_string();
        assert!(message.contains(expected) && message.contains("ground.asc"), "{message}");
    }
}

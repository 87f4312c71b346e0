//! Lines, barriers and maps as a site in map coordinates has them: long names, seven digits, crowds and nobody.

use super::{slope, svg};
use rockfall::hazard::{Agreement, ObservedPath};
use rockfall::output::ReleaseZone;
use rockfall::report::model::{
    AnnualView, BandPoint, BarrierView, Behind, CellMap, DesignView, Estimate, LinePoint, MapMark,
    Observed, PlaceView, Quantile, Report, ReportLine, ReportQuantity, RockView, ZoneMark,
};

const EAST_M: f64 = 2_600_000.0;
const NORTH_M: f64 = 1_200_000.0;

/// A barrier that so many rocks reach, some of them with no ground below, and fewer at another place.
pub(crate) fn net(rocks: usize) -> BarrierView {
    let top_m = |k: usize| if k % 7 == 6 { f64::INFINITY } else { 0.3 + 0.1 * k as f64 };
    let place = |offset_m: f64, rocks: usize| PlaceView {
        offset_m,
        arriving: 0.5,
        stopped: (rocks > 0).then_some(Estimate::new(40.0, 30.0, 55.0)),
        rocks: (0..rocks)
            .map(|k| RockView { top_m: top_m(k), total_j: 1e4 * k as f64, weight: 1.0 })
            .collect(),
    };
    let design = DesignView {
        height_m: Estimate::new(4.2, 3.9, 5.0),
        energy_j: Estimate::new(6e5, 5e5, f64::NAN),
    };
    BarrierView {
        name: "<net> & \"fence\"".to_owned(),
        height_m: 3.0,
        capacity_j: 4e5,
        design: (rocks > 0).then_some(design),
        design_lacks: if rocks > 0 { 0 } else { 59 },
        percentile: Some(95.0),
        left_is_uphill: Some(false),
        places: vec![place(0.0, rocks), place(-10.0, rocks / 2), place(20.0, 0)],
    }
}

/// A line that so many rocks cross; every third is stopped by a barrier before.
fn line(number: usize, name: &str, rocks: usize) -> ReportLine {
    let energy = |k: usize| 400.0 * 1.07_f64.powi(i32::try_from(k % 120).expect("below 120"));
    let point = |k: usize| LinePoint {
        release: k,
        along_m: (k * 7 % 60) as f64,
        height_m: 0.02 * (k % 90) as f64 - 0.01,
        total_j: energy(k),
        passes: !k.is_multiple_of(3),
        weight: 1.0,
    };
    let share = |k: usize| Estimate::new(1.0 / (k + 2) as f64, 0.5 / (k + 2) as f64, 0.9);
    let curve = |size: f64| -> Vec<BandPoint> {
        (0..rocks.min(50)).map(|k| BandPoint { x: size * k as f64, y: share(k) }).collect()
    };
    let marked = |size: f64| {
        [0.5, 0.95].map(|p| Quantile { probability: p, at: Estimate::plain(p * size) }).into()
    };
    ReportLine {
        name: name.to_owned(),
        number,
        is_barrier: false,
        elevation_m: 900.0 - number as f64,
        least_radius_m: 0.5,
        length_m: 60.0,
        releases: 1000,
        reach: Estimate::new(rocks as f64 / 1000.0, 0.0, 0.4),
        is_weighted: false,
        crossing_again: 1,
        crossings: (0..rocks).map(point).collect(),
        energy_quantiles: marked(3e5),
        height_quantiles: marked(1.5),
        energy_exceedance: curve(9e3),
        height_exceedance: curve(0.04),
        behind: (number == 2).then(|| Behind {
            barriers: vec!["upper net".to_owned()],
            reach: Estimate::new(0.01, 0.005, 0.02),
            energy_exceedance: curve(4e3),
            height_exceedance: curve(0.02),
        }),
        arriving: (number == 2).then(|| Estimate::new(0.01, 0.005, 0.02)),
    }
}

/// Lines and nets across the slope, two of them near each other, with names that hardly fit.
fn marks() -> Vec<MapMark> {
    let mark = |name: &str, y: f64, barrier| MapMark {
        name: name.to_owned(),
        corners_m: vec![[EAST_M - 400.0, NORTH_M + y], [EAST_M + 500.0, NORTH_M + y + 3.0]],
        barrier,
        is_object: false,
    };
    vec![
        mark("cantonal road between the upper and the lower village, western verge", 30.0, None),
        mark("footpath", 34.0, None),
        mark("upper net of the first stage of construction", 90.0, Some((4.0, 1e6))),
        mark("lower net", 60.0, Some((3.0, 5e5))),
    ]
}

fn maps() -> CellMap {
    let cells = || (0..40 * 60_u32).filter(|cell| (cell * 7) % 11 < 6);
    let layer = |of: fn(u32) -> f64| cells().map(|cell| (cell, of(cell))).collect();
    CellMap {
        west_m: EAST_M + 20.0,
        south_m: NORTH_M,
        cell_m: 2.5,
        joined: 1,
        columns: 40,
        reach: layer(|cell| 1e-4 * f64::from(1 + cell % 3000)),
        intensity: layer(|cell| f64::from(1 + cell % 3)),
        energy_j: layer(|cell| 50.0 * f64::from(1 + cell % 2000).powi(2)),
        height_m: layer(|cell| 0.01 * f64::from(cell % 700)),
        deposits: layer(|cell| f64::from(1 + cell % 90)),
        exceeds: layer(|cell| 1e-3 * f64::from(1 + cell % 300)),
        intensity_cells: [400, 400, 400],
        few_cells: 130,
        open: None,
    }
}

/// A curve over four decades of energy; behind barriers a tenth of it.
fn year(name: &str, has_barriers: bool) -> AnnualView {
    let curve = |size: f64| -> Vec<BandPoint> {
        (0..60)
            .map(|k| (1.16_f64.powi(k), size * 0.85_f64.powi(k)))
            .map(|(x, y)| BandPoint { x: 1e3 * x, y: Estimate::new(y, 0.6 * y, 1.6 * y) })
            .collect()
    };
    AnnualView {
        name: name.to_owned(),
        is_object: !has_barriers,
        without: curve(0.03),
        with: has_barriers.then(|| curve(0.003)),
        return_periods_years: vec![30.0, 100.0, 300.0, 1000.0],
        most_per_year: 0.04,
        rocks: 700,
        effective_rocks: 350.0,
    }
}

/// Measured ends beside computed ones.
fn observed() -> Observed {
    let way = |k: u32| ObservedPath {
        start_m: [EAST_M + 70.0, NORTH_M + 190.0],
        end_m: [EAST_M + 30.0 + f64::from(k * 7 % 80), NORTH_M + 10.0 + f64::from(k * 13 % 90)],
        open: None,
    };
    let (measured, computed): (Vec<ObservedPath>, Vec<ObservedPath>) =
        ((0..40).map(way).collect(), (5..300).map(way).collect());
    let agreement = Agreement::of(&measured, &computed).expect("neither is empty");
    let worth = measured.len() as f64;
    Observed { measured, computed, weights: None, from_own_places: false, worth, agreement }
}

/// A site with all of it.
pub(crate) fn site() -> Report {
    let area = [[40.0, 185.0], [100.0, 185.0], [100.0, 195.0], [40.0, 195.0]];
    Report {
        zones: vec![ZoneMark {
            name: String::new(),
            outline: ReleaseZone::Polygon(area.map(|[x, y]| [EAST_M + x, NORTH_M + y]).into()),
        }],
        marks: marks(),
        lines: vec![
            line(2, "cantonal road between the upper and the lower village, western verge", 230),
            line(1, "footpath", 12),
            line(3, "nobody's line", 0),
        ],
        barriers: vec![net(60), net(0)],
        maps: Some(maps()),
        annual: vec![
            year("valley road between the villages", true),
            AnnualView { without: Vec::new(), most_per_year: 0.004, ..year("hut", false) },
            year("house", false),
        ],
        observed: Some(observed()),
        ..slope::report(700, 60)
    }
}

/// Bars along a line show what its rocks stand for: where they stand for nothing there is none.
#[test]
fn bars_along_a_line_weigh_its_rocks() {
    let bars = |of_right: f64| {
        let mut report = site();
        for at in report.lines.iter_mut().flat_map(|line| &mut line.crossings) {
            at.weight = if at.along_m < 30.0 { 1.0 } else { of_right };
        }
        let drawn = rockfall::report::drawings(&report);
        let line = drawn.iter().find(|(heading, _)| heading.file == "line_2.svg");
        let (_, drawing) = line.expect("rocks cross it");
        let sky = rockfall::report::colour::hex(rockfall::report::colour::SKY);
        let is_bar = |tag: &&str| tag.starts_with("rect") && tag.contains(&sky);
        drawing.svg.split('<').filter(is_bar).count()
    };
    // twelve of 5 m
    assert_eq!((bars(1.0), bars(0.0)), (12, 6));
}

/// Lines that lie close to each other have numbers, whose names stand once below the maps; where there is room the names
/// themselves stand in each map.
#[test]
fn names_that_would_be_read_as_those_of_other_lines_are_numbers() {
    let marks = |apart_m: f64| -> Vec<MapMark> {
        let line = |k: usize| MapMark {
            name: format!("parcel boundary {}", 1370 + k),
            corners_m: [20.0, 120.0]
                .map(|x| [EAST_M + x, NORTH_M + 5.0 + apart_m * k as f64])
                .into(),
            barrier: None,
            is_object: false,
        };
        (0..9).map(line).collect()
    };
    let said = |apart_m: f64, file: &str| {
        let report = Report { marks: marks(apart_m), ..site() };
        let drawn = rockfall::report::drawings(&report);
        let (_, drawing) =
            drawn.into_iter().find(|(heading, _)| heading.file == file).expect("is drawn");
        let rim = drawing.svg.matches("stroke=\"#fff\" stroke-width=\"30\"").count();
        (
            drawing.svg.matches("parcel boundary 1374").count(),
            drawing.svg.contains(">5</text>"),
            rim > 0,
        )
    };
    // each on its rim, in both maps
    assert_eq!(said(16.0, "maps.svg"), (4, false, true));
    assert_eq!(said(5.0, "maps.svg"), (1, true, true));
    assert_eq!(said(2.0, "plan.svg"), (1, true, true));
}

/// Where the percentiles of the height lie close to each other no line runs through the name of the other one, and the one that has no room for its
/// own shares that of its neighbour: no line stays without a name.
#[test]
fn a_percentile_is_not_named_on_the_line_of_another() {
    let names = |median_m: f64| {
        let mut report = site();
        for line in &mut report.lines {
            for (quantile, at) in line.height_quantiles.iter_mut().zip([median_m, 0.1]) {
                quantile.at = Estimate::plain(at);
            }
        }
        let drawn = rockfall::report::drawings(&report);
        let (_, drawing) = drawn
            .into_iter()
            .find(|(heading, _)| heading.file == "line_2.svg")
            .expect("rocks cross it");
        [">P50", ">P95", ">P50, P95"]
            .map(|name| drawing.svg.matches(&format!("{name}</text>")).count())
    };
    // energy and height, each on its rim
    assert_eq!([names(0.005), names(0.8)], [[2, 2, 2], [4, 4, 0]]);
}

/// Several zones of release have their names on the plan view; where these have no room, or would be read as those of others, letters
/// whose names stand once below. One zone needs no name.
#[test]
fn zones_of_release_are_told_apart() {
    let zones = |count: usize, apart_m: f64| -> Vec<ZoneMark> {
        let zone = |k: usize| {
            let (x, y) = (EAST_M + 20.0 + apart_m * k as f64, NORTH_M + 185.0);
            ZoneMark {
                name: format!("upper cliff, sector {}", 40 + k),
                outline: ReleaseZone::Line(vec![[x, y], [x + 0.5 * apart_m, y]]),
            }
        };
        (0..count).map(zone).collect()
    };
    let said = |count: usize, apart_m: f64| {
        let report = Report { zones: zones(count, apart_m), marks: Vec::new(), ..site() };
        let drawn = rockfall::report::drawings(&report);
        let (_, plan) =
            drawn.into_iter().find(|(heading, _)| heading.file == "plan.svg").expect("is drawn");
        let names = plan.svg.matches("upper cliff, sector 40").count();
        (names, plan.svg.contains(">A</text>"))
    };
    // on its rim; in the key; not at all
    assert_eq!(said(2, 60.0), (2, false));
    assert_eq!(said(12, 6.0), (1, true));
    // more than there are letters have two
    assert_eq!(said(40, 4.0), (1, true));
    assert_eq!(said(1, 60.0), (0, false));
}

/// Sectors of a cliff adjoin each other: their names stand beside their middle, whichever way they were drawn, not at the corner of two.
#[test]
fn the_name_of_a_zone_stands_at_its_middle() {
    let name_of = |turned: bool| {
        let zone = |k: usize| {
            let x = EAST_M + 20.0 + 60.0 * k as f64;
            let mut ends = vec![[x, NORTH_M + 185.0], [x + 60.0, NORTH_M + 185.0]];
            if turned {
                ends.reverse();
            }
            ZoneMark { name: format!("sector {k}"), outline: ReleaseZone::Line(ends) }
        };
        let zones = vec![zone(0), zone(1)];
        let report = Report { zones, marks: Vec::new(), ..site() };
        let drawn = rockfall::report::drawings(&report);
        let (_, plan) =
            drawn.into_iter().find(|(heading, _)| heading.file == "plan.svg").expect("is drawn");
        let names = plan.svg.lines().filter(|line| line.contains("sector"));
        names.map(str::to_owned).collect::<Vec<String>>()
    };
    let names = name_of(false);
    assert!(names.len() >= 2);
    assert_eq!(names, name_of(true));
}

/// Where one rock has a thousand times the energy of another, both can be read: on a logarithmic scale, which the caption says with
/// what is left out below.
#[test]
fn energies_of_unlike_rocks_along_their_ways_are_all_readable() {
    let caption = |factor: f64| {
        let mut report = site();
        let strongest = report.paths[0].index;
        for (index, fall) in report.releases.iter_mut().enumerate() {
            fall.max_translational_j = if index == strongest { factor * 1e4 } else { 1e4 };
            fall.max_total_j = fall.max_translational_j;
        }
        let drawn = rockfall::report::drawings(&report);
        let (_, along) =
            drawn.into_iter().find(|(heading, _)| heading.file == "along.svg").expect("is drawn");
        assert!(along.svg.contains(">P95</text>"));
        along.caption
    };
    let [alike, unlike, faint] = [1.0, 1000.0, 123_456.0].map(caption);
    assert!(!alike.contains("logarithmic"), "{alike}");
    assert!(
        unlike.contains("logarithmic") && unlike.contains("a factor of 1\u{2009}000; below"),
        "{unlike}"
    );
    // 10 kJ beside 1.2 GJ
    assert!(faint.contains("a factor of 120\u{2009}000; below 2 kJ"), "{faint}");
}

/// Energy goes with the square of the speed: where a rock is half as fast as at its fastest, its curve stands at a quarter.
#[test]
fn at_half_its_speed_a_rock_has_a_quarter_of_its_energy() {
    let mut report = site();
    report.quantiles.clear();
    report.paths.truncate(1);
    let most_m_s = report.releases[report.paths[0].index].max_speed_m_s;
    let points = &mut report.paths[0].points;
    points.truncate(4);
    for (k, (point, share)) in points.iter_mut().zip([0.0, 1.0, 0.5, 0.4]).enumerate() {
        point.place_m = [EAST_M + 10.0 * k as f64, NORTH_M, 500.0];
        point.speed_m_s = share * most_m_s;
        point.clearance_m = 0.0;
    }
    let drawn = rockfall::report::drawings(&report);
    let (_, along) =
        drawn.into_iter().find(|(heading, _)| heading.file == "along.svg").expect("is drawn");
    let tags = along.svg.split('<').filter_map(|rest| rest.split('>').next());
    let curves: Vec<Vec<(f64, f64)>> = tags.map(svg::points).filter(|p| p.len() == 4).collect();
    // that of the speed comes first, then that of the energy
    for (curve, share) in [(&curves[0], 0.5), (&curves[1], 0.25)] {
        let [bottom, top, half] = [0, 1, 2].map(|k| curve[k].1);
        let found = (half - bottom) / (top - bottom);
        assert!((found - share).abs() < 5e-3, "{found} for {share}: {curve:?}");
    }
}

/// Of too few rocks no P95 is known: then neither figure nor caption has one.
#[test]
fn few_rocks_along_their_ways_have_no_percentiles_beside_them() {
    let mut report = site();
    for known in report.quantiles.values_mut() {
        known.retain(|one| one.probability < 0.92);
    }
    let drawn = rockfall::report::drawings(&report);
    let (_, along) =
        drawn.into_iter().find(|(heading, _)| heading.file == "along.svg").expect("is drawn");
    assert!(!along.svg.contains(">P50</text>") && !along.caption.contains("P95"));
}

/// A percentile has the same digits in a figure as in a table: those that its interval leaves.
#[test]
fn a_number_is_written_alike_in_figures_and_tables() {
    let mut report = site();
    let quantiles = report.quantiles.get_mut(&ReportQuantity::Runout).expect("is known");
    quantiles[0].at = Estimate::new(265.5, 261.9, 269.2);
    let drawn = rockfall::report::drawings(&report);
    let (_, runout) =
        drawn.into_iter().find(|(heading, _)| heading.file == "runout.svg").expect("is drawn");
    assert!(runout.svg.contains("266\u{2009}m") && runout.svg.contains("261 to 270"));
    assert!(!runout.svg.contains("265.5"));
}

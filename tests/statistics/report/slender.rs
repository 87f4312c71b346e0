//! What is a few metres wide or high, or does not move at all.

use super::{places, slope, still, svg};
use rockfall::report;
use rockfall::report::model::{CellMap, Path, ReleaseEnd, Report, ReportPathPoint};
use rockfall::report::raster::GroundRaster;
use rockfall::rock::Vec3;
use rockfall::simulation::PathState;

/// A way of a rock over a table of 5 m on maps in cells of 0.1 m: ticks at halves of a metre.
pub(crate) fn metres() -> Report {
    let cells = || (4..50_u32).map(|row| 50 * row + 24);
    let layer = |value: f64| cells().map(|cell| (cell, value)).collect();
    let maps = CellMap {
        west_m: 0.0,
        south_m: 0.0,
        cell_m: 0.1,
        columns: 50,
        reach: layer(1.0),
        intensity: layer(1.0),
        energy_j: layer(2.0),
        height_m: layer(0.01),
        deposits: layer(1.0),
        exceeds: layer(0.2),
        ..places::site().maps.expect("a site has maps")
    };
    Report { maps: Some(maps), ..slope::filled(falls([0.3, 0.01])) }
}

/// Rocks that fall 100 times as far as they go.
pub(crate) fn steep() -> Report {
    slope::filled(falls([0.01, 1.9]))
}

/// Rocks above each other that go and fall so far (m).
fn falls([far, deep]: [f64; 2]) -> Report {
    let end = |k: u32| [f64::from(k % 3) * far, f64::from(k) * 0.3 * far, 100.0 - deep];
    let start = |k: u32| [f64::from(k % 3) * far, 0.0, 100.0];
    let releases = (0..8).map(|k| ReleaseEnd { start_m: start(k), end_m: end(k), ..still() });
    let way = |k: u32| [(0.0, start(k)), (0.6, end(k))].map(|(t, at)| point(t, at)).into();
    let paths = (0..8).map(|k| Path { index: k as usize, points: way(k) });
    Report { releases: releases.collect(), paths: paths.collect(), ..Report::default() }
}

fn point(time_s: f64, place_m: [f64; 3]) -> ReportPathPoint {
    let state = PathState::Flight;
    ReportPathPoint { time_s, place_m, speed_m_s: 1.0, clearance_m: 0.0, state }
}

/// Rocks that stay where they are released are a bar in the histogram of reach angles, and dots above their ground.
#[test]
fn rocks_that_stay_are_seen() {
    let origin = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);
    let ground = GroundRaster::from_terrain(&slope::terrain(2.0, origin), 200);
    let at = |k: u32| {
        let (x, y) = (f64::from(40 + k), 150.0);
        [origin.x + x, origin.y + y, slope::height_m(x, y) + 0.5]
    };
    let rest = |k| ReleaseEnd { start_m: at(k), end_m: at(k), ..still() };
    let path =
        |k: u32| Path { index: k as usize, points: [0.0, 1.0].map(|t| point(t, at(k))).into() };
    let report = slope::filled(Report {
        ground: Some(ground),
        releases: (0..20).map(rest).collect(),
        paths: (0..20).map(path).collect(),
        ..Report::default()
    });
    let drawn = report::drawings(&report);
    let svg_of = |file: &str| &drawn.iter().find(|(figure, _)| figure.file == file).unwrap().1.svg;
    let side = svg_of("side.svg");
    assert_eq!(side.matches("<circle").count(), 20, "a dot for each rock");
    let ground = svg::stroked_with(side, "#5e4e3e");
    assert!(!ground.is_empty(), "no ground below them");
    let bars = svg_of("reach_angle.svg").split('<').filter(|tag| tag.contains("#56b4e9"));
    let width = |tag: &str| svg::attribute(tag, "width").map(|w| w.parse::<f64>().unwrap());
    let widest = bars.filter_map(width).fold(0.0, f64::max);
    assert!(widest > 30.0, "a bar of {widest} tenths of a pixel");
}

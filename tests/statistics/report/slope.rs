//! A made slope with made falls: a cliff, a talus and a meadow, rocks that bounce down as parabolas.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on has failed")]

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rockfall::report::model::{
    About, BandPoint, Estimate, EstimateRow, EstimateTable, Path, Quantile, ReleaseEnd, Report,
    ReportPathPoint, ReportQuantity, StopShare, Text,
};
use rockfall::report::raster::GroundRaster;
use rockfall::rock::Vec3;
use rockfall::simulation::{PathState, Stop};
use rockfall::terrain::grid::triangulate;
use rockfall::terrain::make::{Stem, stem};
use rockfall::terrain::stl::Soup;
use rockfall::terrain::weld::{Piece, Up, weld};
use rockfall::terrain::{Sheet, Terrain};

/// Chance that is the same on every machine.
pub(crate) struct Dice(ChaCha8Rng);

impl Dice {
    pub(crate) fn new(seed: usize) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed as u64))
    }

    /// Even in 0..1.
    pub(crate) fn roll(&mut self) -> f64 {
        self.0.random()
    }

    /// About normal.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..6).map(|_| self.roll()).sum::<f64>() - 3.0
    }
}

/// Height of the slope (m) at metres east and north of its corner; it falls to the south.
pub(crate) fn height_m(x: f64, y: f64) -> f64 {
    let gully = 3.0 * ((x - 70.0) / 22.0).tanh().powi(2);
    let bumps = 0.5 * (x * 0.31).sin() * (y * 0.23).cos() + 0.25 * (x * 0.9 + y * 0.7).sin();
    let fall = if y > 170.0 {
        104.0 + 1.9 * (y - 170.0)
    } else if y > 50.0 {
        20.0 + 0.7 * (y - 50.0)
    } else {
        20.0 * (y / 50.0).powi(2) * 0.65 + 0.14 * y
    };
    fall + gully + bumps
}

/// The slope as a mesh of `2 n²`-ish triangles with stems of trees, at map coordinates of `origin`.
pub(crate) fn terrain(step_m: f64, origin: Vec3) -> Terrain {
    let (columns, rows) = ((140.0 / step_m) as usize + 1, (200.0 / step_m) as usize + 1);
    let slope = triangulate(columns, rows, |column, row| {
        let (x, y) = (column as f64 * step_m, row as f64 * step_m);
        Some(Vec3::new(x, y, height_m(x, y)))
    });
    let mut dice = Dice::new(7);
    let trees = (0..60).flat_map(|_| {
        let (x_m, y_m) = (10.0 + 120.0 * dice.roll(), 15.0 + 60.0 * dice.roll());
        stem(&Stem { x_m, y_m, dbh_m: 0.4 + 0.5 * dice.roll(), height_m: 12.0 }, height_m(x_m, y_m))
    });
    let soups = [Soup::from(slope), Soup::from(trees.collect::<Vec<_>>())];
    let names = ["slope.stl", "trees.stl"];
    let pieces = [0, 1].map(|sheet| Piece {
        file: names[sheet].as_ref(),
        soup: &soups[sheet],
        up: Up::Z,
        scale: 1.0,
        sheet: sheet as u16,
    });
    let sheets = [0, 1].map(|k| Sheet { path: names[k].into(), ground: 0, is_tree: k == 1 });
    Terrain::new(weld(&pieces, origin, None).unwrap(), sheets.into())
}

const STEP_S: f64 = 0.05;
const RADIUS_M: f64 = 0.4;

/// One rock that bounces down the slope, with points every 0.05 s.
pub(crate) fn bounce(index: usize, origin: Vec3) -> (ReleaseEnd, Path) {
    let mut dice = Dice::new(index);
    let (x, y) = (50.0 + 40.0 * dice.roll(), 188.0 + 4.0 * dice.roll());
    let start = Vec3::new(x, y, height_m(x, y) + RADIUS_M + 0.5);
    let (mut at, mut v) = (start, Vec3::new(0.3 * dice.normal(), -0.8, 0.0));
    let mut points = Vec::new();
    let (mut stop, mut impacts) = (Stop::TimeUp, 0);
    while points.len() < 1200 && stop == Stop::TimeUp {
        points.push(point(points.len(), at, v));
        v.z -= 9.81 * STEP_S;
        at += v * STEP_S;
        if at.y < 0.0 || at.x < 0.0 || at.x > 140.0 {
            stop = Stop::LeftTerrain;
        } else if at.z - RADIUS_M < height_m(at.x, at.y) {
            impacts += 1;
            v = rebound(at, v, &mut dice);
            at.z = height_m(at.x, at.y) + RADIUS_M;
            stop = if v.norm() < 0.9 { Stop::AtRest } else { stop };
        }
    }
    if index % 97 == 13 {
        stop = Stop::Failed("made up".to_owned());
    }
    let mut fall = summary(&points, dice.roll());
    (fall.stop, fall.impacts, fall.end_m) = (stop, impacts, at.into());
    fall.runout_m = (at.x - start.x).hypot(at.y - start.y);
    fall.drop_m = start.z - at.z;
    fall.reach_angle_deg = fall.drop_m.atan2(fall.runout_m).to_degrees();
    let on_map = |p: [f64; 3]| [p[0] + origin.x, p[1] + origin.y, p[2] + origin.z];
    (fall.start_m, fall.end_m) = (on_map(fall.start_m), on_map(fall.end_m));
    for point in &mut points {
        point.place_m = on_map(point.place_m);
    }
    (fall, Path { index, points })
}

fn point(step: usize, at: Vec3, v: Vec3) -> ReportPathPoint {
    let clearance = at.z - RADIUS_M - height_m(at.x, at.y);
    let state = if clearance > 0.05 { PathState::Flight } else { PathState::Sliding };
    let time_s = step as f64 * STEP_S;
    ReportPathPoint {
        time_s,
        place_m: at.into(),
        speed_m_s: v.norm(),
        clearance_m: clearance.max(0.0),
        state,
    }
}

/// Velocity after an impact on ground tilted by chance.
fn rebound(at: Vec3, v: Vec3, dice: &mut Dice) -> Vec3 {
    let slope =
        |dx: f64, dy: f64| (height_m(at.x + dx, at.y + dy) - height_m(at.x - dx, at.y - dy)) / 0.2;
    let tilt = Vec3::new(0.12 * dice.normal(), 0.12 * dice.normal(), 0.0);
    let normal = (Vec3::new(-slope(0.1, 0.0), -slope(0.0, 0.1), 1.0) + tilt).normalize();
    let into = -v.dot(&normal).min(0.0);
    let along = v - normal * v.dot(&normal);
    let kept = 1.0 - (0.45 * into / along.norm().max(1e-9)).min(1.0);
    along * kept * (0.94 + 0.04 * dice.roll()) + normal * (0.2 + 0.4 * dice.roll()) * into
}

/// Largest values along the points; what the end decides is filled in by the caller.
fn summary(points: &[ReportPathPoint], random: f64) -> ReleaseEnd {
    let most = |value: fn(&ReportPathPoint) -> f64| points.iter().map(value).fold(0.0, f64::max);
    let mass_kg = 2700.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M.powi(3);
    let max_speed_m_s = most(|p| p.speed_m_s);
    let translational_j = 0.5 * mass_kg * max_speed_m_s * max_speed_m_s;
    ReleaseEnd {
        stop: Stop::TimeUp,
        runout_m: 0.0,
        drop_m: 0.0,
        reach_angle_deg: 0.0,
        max_speed_m_s,
        max_translational_j: translational_j,
        max_rotational_j: (0.12 + 0.2 * random) * translational_j,
        max_total_j: 1.2 * translational_j,
        max_height_m: most(|p| p.clearance_m),
        impacts: 0,
        tree_impacts: 0,
        start_m: points[0].place_m,
        end_m: points[0].place_m,
        weight: 1.0,
    }
}

/// A report on `count` falls of which `paths` are kept.
pub(crate) fn report(count: usize, paths: usize) -> Report {
    let origin = Vec3::new(2_600_000.0, 1_200_000.0, 800.0);
    let falls = (0..count).map(|i| bounce(i, origin));
    let (releases, mut kept): (Vec<ReleaseEnd>, Vec<Path>) = falls.unzip();
    kept.truncate(paths);
    let ground = Some(GroundRaster::from_terrain(&terrain(1.0, origin), 600));
    filled(Report { text: text(), releases, paths: kept, ground, ..Report::default() })
}

/// Adds the estimates that a run would bring (rough ones: only their looks matter here).
pub(crate) fn filled(mut report: Report) -> Report {
    for quantity in [
        ReportQuantity::Runout,
        ReportQuantity::ReachAngle,
        ReportQuantity::Speed,
        ReportQuantity::Translational,
        ReportQuantity::Rotational,
        ReportQuantity::Total,
        ReportQuantity::Height,
        ReportQuantity::Impacts,
    ] {
        let mut values: Vec<f64> = report.releases.iter().map(|f| quantity.of(f)).collect();
        values.sort_by(f64::total_cmp);
        let all = [0.5, 0.95, 0.99].map(|p| Quantile { probability: p, at: quantile(&values, p) });
        report.quantiles.insert(quantity, all.to_vec());
        if quantity == ReportQuantity::Runout {
            report.runout_exceedance = exceedance(&values);
        }
    }
    report.stops = shares(&report.releases);
    report.headline = headline(&report);
    report.tables = vec![line_table(&report)];
    report
}

fn quantile(sorted: &[f64], p: f64) -> Estimate {
    let n = sorted.len() as f64;
    let half = 1.96 * (n * p * (1.0 - p)).sqrt();
    let at = |rank: f64| {
        if rank < 0.0 || rank >= n { f64::NAN } else { sorted[rank as usize] }
    };
    Estimate::new(at((n * p - 1e-9).floor()), at(n * p - half), at(n * p + half))
}

fn wilson(count: f64, n: f64) -> Estimate {
    let (z, p) = (1.96, count / n.max(1.0));
    let middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    Estimate::new(p, (middle - half).max(0.0), (middle + half).min(1.0))
}

fn exceedance(sorted: &[f64]) -> Vec<BandPoint> {
    let n = sorted.len();
    let stride = (n / 400).max(1);
    let points = (0..n).step_by(stride).chain(n.checked_sub(1));
    points.map(|i| BandPoint { x: sorted[i], y: wilson((n - 1 - i) as f64, n as f64) }).collect()
}

fn shares(releases: &[ReleaseEnd]) -> Vec<StopShare> {
    let kinds = [Stop::AtRest, Stop::LeftTerrain, Stop::TimeUp, Stop::Failed(String::new())];
    let same = |a: &Stop, b: &Stop| std::mem::discriminant(a) == std::mem::discriminant(b);
    kinds
        .into_iter()
        .map(|stop| {
            let count = releases.iter().filter(|f| same(&f.stop, &stop)).count();
            StopShare { stop, count, share: wilson(count as f64, releases.len() as f64) }
        })
        .collect()
}

fn headline(report: &Report) -> Vec<EstimateRow> {
    let row = |name: &str, quantity: ReportQuantity, i: usize| {
        let estimate = report.quantiles[&quantity][i].at;
        let unit = quantity.unit(0.0).0.to_owned();
        EstimateRow { name: name.to_owned(), estimate, unit }
    };
    vec![
        row("Runout, median", ReportQuantity::Runout, 0),
        row("Runout, P95", ReportQuantity::Runout, 1),
        row("Runout, P99", ReportQuantity::Runout, 2),
        row("Maximum speed, P95", ReportQuantity::Speed, 1),
        row("Maximum total energy, P95", ReportQuantity::Total, 1),
        row("Bounce height, P95", ReportQuantity::Height, 1),
        row("Reach angle, median", ReportQuantity::ReachAngle, 0),
    ]
}

fn line_table(report: &Report) -> EstimateTable {
    let row = |name: &str, quantity: ReportQuantity| {
        let cells = report.quantiles[&quantity].iter().map(|q| Some(q.at));
        (name.to_owned(), cells.chain([None]).collect())
    };
    EstimateTable {
        about: About::Lines,
        title: "Line “road”".to_owned(),
        note: "812 first crossings by 1000 releases; 3 rocks cross more than once.".to_owned(),
        columns: ["P50", "P95", "P99", "Maximum"].map(str::to_owned).to_vec(),
        rows: vec![
            row("Speed (m/s)", ReportQuantity::Speed),
            row("Translational energy (J)", ReportQuantity::Translational),
            row("Rotational energy (J)", ReportQuantity::Rotational),
            row("Height (m)", ReportQuantity::Height),
        ],
        place: String::new(),
    }
}

fn text() -> Text {
    let lines = |all: &[&str]| all.iter().map(|&line| line.to_owned()).collect();
    Text {
        title_block: vec![("Client".to_owned(), "Road authority".to_owned())],
        title: "Made slope: cliff, talus & meadow".to_owned(),
        subtitle: "A <test> scene with parabolas for rocks".to_owned(),
        method: "Steps are adaptive with a local error of 0.05 m/s.".to_owned(),
        inputs: vec![
            ("Rocks".to_owned(), "radius 0.4 m, density 2700 kg/m³".to_owned()),
            ("Stop rule".to_owned(), "slower than 0.02 m/s for 0.3 s in contact".to_owned()),
        ],
        mesh_health: lines(&[
            "slope.stl: 55 720 triangles, one sheet, no holes, no slivers",
            "trees.stl: 960 triangles, 60 open sheets (stems)",
        ]),
        plan: [
            ("terrain", "56 680 triangles; 61 % of edges flat or hollow: left out of contact"),
            (
                "flight",
                "leapt over: nothing but gravity acts between touches, the parabola is exact",
            ),
            ("rock against rock", "left out: releases are independent"),
            ("paths", "kept for 300 of 1000 releases"),
        ]
        .map(|(name, said)| (name.to_owned(), said.to_owned()))
        .into(),
        warnings: lines(&["Maximum speed above 40 m/s in 3 rocks: unusual for single blocks."]),
        terrain_source: "made by formula, 1 m grid".to_owned(),
        parameter_source: "made up".to_owned(),
        seed: 2017,
        version: "0.1.0".to_owned(),
        scene_hash: "5f1c9a77e0".to_owned(),
        took: Some(rockfall::output::RunTimes {
            seconds: 2.5,
            releases_per_second: 1234.0,
            threads: 2,
            memory_bytes: Some(51_000_000),
        }),
        energy_remainder: Some(3.2e-7),
    }
}

//! The report's numbers, gathered from the result files of a run: a report drawn again is the same report.

mod barriers;
mod lines;
mod measured;

use super::input::{
    BandPoint, Estimate, Fall, Path, Point, Quantile, Quantity, Report, Row, StopShare, Table, Text,
};
use super::raster::GroundRaster;
use crate::error::Result;
use crate::hazard::{self, Exceedance, Hazard, PERCENTS, Percentile, Sample, StopKind};
use crate::output::PathRow;
use crate::output::Results;
use crate::rock::Vec3;
use crate::trajectory::Stop;

/// Quantities of the tables, with their names in the hazard.
const TABLED: [(Quantity, hazard::Quantity); 8] = [
    (Quantity::Runout, hazard::Quantity::Runout),
    (Quantity::ReachAngle, hazard::Quantity::ReachAngle),
    (Quantity::Speed, hazard::Quantity::MaxSpeed),
    (Quantity::Translational, hazard::Quantity::MaxTranslational),
    (Quantity::Rotational, hazard::Quantity::MaxRotational),
    (Quantity::Total, hazard::Quantity::MaxTotal),
    (Quantity::Height, hazard::Quantity::MaxHeight),
    (Quantity::Impacts, hazard::Quantity::Impacts),
];

/// Gathers the report of a finished run.
///
/// # Errors
/// A result file that cannot be read.
pub fn gather(results: &Results, ground: Option<GroundRaster>) -> Result<Report> {
    let hazard = &results.hazard;
    let releases =
        results.rows()?.map(|row| row.map(|row| fall_of(&row))).collect::<Result<_>>()?;
    Ok(Report {
        text: text_of(results),
        releases,
        paths: paths_of(results)?,
        ground,
        runout_exceedance: band(&hazard.sample(hazard::Quantity::Runout).exceedance()),
        quantiles: TABLED.map(|(here, there)| (here, quantiles(hazard, there))).into(),
        stops: StopKind::ALL
            .into_iter()
            .filter(|kind| !kind.is_unusual() || hazard.ended(*kind).count > 0)
            .map(|kind| stop_share(hazard, kind))
            .collect(),
        headline: headline(hazard),
        tables: [table(hazard)]
            .into_iter()
            .chain(lines::tables(results))
            .chain(barriers::tables(results))
            .chain(measured::tables(results)?)
            .collect(),
        lines: lines::lines(results)?,
        barriers: barriers::views(results)?,
        maps: lines::maps(results)?,
        observed: measured::observed(results)?,
    })
}

/// The exceedance curve with its band upright: the intervals of the percentiles lie along x, figures want them along y.
fn band(curve: &[Exceedance]) -> Vec<BandPoint> {
    let low: Vec<(f64, f64)> = curve.iter().filter_map(|at| Some((at.low_95?, at.share))).collect();
    let high: Vec<(f64, f64)> =
        curve.iter().filter_map(|at| Some((at.high_95?, at.share))).collect();
    let point = |at: &Exceedance| BandPoint {
        x: at.value,
        y: Estimate {
            value: at.share,
            low: share_at(&low, at.value),
            high: share_at(&high, at.value),
        },
    };
    curve.iter().map(point).collect()
}

/// Share at `x` on a curve of points that rise in x and fall in share: 1 before the curve, 0 after it.
fn share_at(curve: &[(f64, f64)], x: f64) -> f64 {
    let k = curve.partition_point(|&(value, _)| value < x);
    match (k.checked_sub(1).and_then(|before| curve.get(before)), curve.get(k)) {
        (Some(&(x0, y0)), Some(&(x1, y1))) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (None, Some(_)) => 1.0,
        _ => 0.0,
    }
}

fn estimate(value: f64, low: Option<f64>, high: Option<f64>) -> Estimate {
    Estimate { value, low: low.unwrap_or(f64::NAN), high: high.unwrap_or(f64::NAN) }
}

fn of_percentile(percentile: &Percentile) -> Estimate {
    estimate(percentile.value, percentile.low_95, percentile.high_95)
}

fn stop_of(kind: StopKind) -> Stop {
    match kind {
        StopKind::AtRest => Stop::AtRest,
        StopKind::LeftTerrain => Stop::LeftTerrain,
        StopKind::TimeUp => Stop::TimeUp,
        StopKind::OverBudget => Stop::OverBudget,
        StopKind::NotReleased => Stop::NotReleased(""),
        StopKind::Failed => Stop::Failed(String::new()),
    }
}

fn fall_of(row: &hazard::Row) -> Fall {
    Fall {
        stop: stop_of(row.stop),
        runout_m: row.runout_m,
        drop_m: row.drop_m,
        reach_angle_deg: row.reach_angle_deg,
        max_speed_m_s: row.max_speed_m_s,
        max_translational_j: row.max_translational_j,
        max_rotational_j: row.max_rotational_j,
        max_total_j: row.max_total_j,
        max_height_m: row.max_height_m,
        impacts: row.impacts,
        tree_impacts: row.tree_impacts,
        start_m: row.start_m,
        end_m: row.end_m,
    }
}

fn paths_of(results: &Results) -> Result<Vec<Path>> {
    let mut paths: Vec<Path> = Vec::new();
    for row in results.paths()? {
        let row: PathRow = row?;
        if paths.last().is_none_or(|path| path.index != row.index) {
            paths.push(Path { index: row.index, points: Vec::new() });
        }
        if let Some(path) = paths.last_mut() {
            path.points.push(Point {
                time_s: row.time_s,
                place_m: row.position_m,
                speed_m_s: Vec3::from(row.velocity_m_s).norm(),
                clearance_m: row.clearance_m,
                state: row.state,
            });
        }
    }
    Ok(paths)
}

fn quantiles(hazard: &Hazard, quantity: hazard::Quantity) -> Vec<Quantile> {
    let sample = hazard.sample(quantity);
    let one = |percent: u8| {
        let probability = f64::from(percent) / 100.0;
        sample
            .percentile(probability)
            .map(|found| Quantile { probability, at: of_percentile(&found) })
    };
    PERCENTS.into_iter().filter_map(one).collect()
}

fn stop_share(hazard: &Hazard, kind: StopKind) -> StopShare {
    let ended = hazard.ended(kind);
    let share = estimate(ended.share, Some(ended.low_95), Some(ended.high_95));
    StopShare { stop: stop_of(kind), count: ended.count, share }
}

/// What an engineer asks first: the middle and the far end of runout, and the design values of the rest.
pub(super) fn headline(hazard: &Hazard) -> Vec<Row> {
    use hazard::Quantity::{MaxHeight, MaxSpeed, MaxTotal, MaxTranslational, ReachAngle, Runout};
    let asked = [
        ("Runout, 50 %", Runout, 0.50, "m"),
        ("Runout, 95 %", Runout, 0.95, "m"),
        ("Runout, 99 %", Runout, 0.99, "m"),
        ("Reach angle, 50 %", ReachAngle, 0.50, "°"),
        ("Maximum speed, 95 %", MaxSpeed, 0.95, "m/s"),
        ("Maximum translational energy, 95 %", MaxTranslational, 0.95, "J"),
        ("Maximum total energy, 95 %", MaxTotal, 0.95, "J"),
        ("Maximum bounce height, 95 %", MaxHeight, 0.95, "m"),
    ];
    let row = |(name, quantity, p, unit): (&str, hazard::Quantity, f64, &str)| {
        let found = hazard.sample(quantity).percentile(p)?;
        Some(Row { name: name.to_owned(), estimate: of_percentile(&found), unit: unit.to_owned() })
    };
    asked.into_iter().filter_map(row).collect()
}

fn table(hazard: &Hazard) -> Table {
    let rows = TABLED.map(|(here, there)| (here.name(), here, hazard.sample(there)));
    let note = format!(
        "Over {} rocks. Percentiles with distribution-free 95 % intervals (order statistics); a bound that the sample is too small for is left open.",
        hazard.rocks()
    );
    statistics_table("Statistics over all releases", note, &rows)
}

/// An estimate in a unit so many times as large.
fn scaled_by(x: Estimate, size: f64) -> Estimate {
    Estimate { value: x.value / size, low: x.low / size, high: x.high / size }
}

/// A table of mean, percentiles and maximum: name, the quantity whose unit it has, and the values of each row.
fn statistics_table(title: &str, note: String, rows: &[(&str, Quantity, Sample)]) -> Table {
    let percents = PERCENTS.map(|percent| format!("{percent} %"));
    let columns =
        ["mean".to_owned()].into_iter().chain(percents).chain(["maximum".to_owned()]).collect();
    let rows = rows.iter().map(|(name, like, sample)| {
        let (unit, size) = like.unit(sample.values().last().copied().unwrap_or(0.0));
        let scaled = |x: Estimate| scaled_by(x, size);
        let mean = sample.mean().map(|mean| estimate(mean.value, mean.low_95, mean.high_95));
        let most = sample.values().last().map(|&most| estimate(most, None, None));
        let middle = PERCENTS.map(|percent| {
            sample.percentile(f64::from(percent) / 100.0).map(|found| of_percentile(&found))
        });
        let cells =
            [mean].into_iter().chain(middle).chain([most]).map(|cell| cell.map(scaled)).collect();
        let name = if unit.is_empty() { (*name).to_owned() } else { format!("{name} ({unit})") };
        (name, cells)
    });
    Table { title: title.to_owned(), note, columns, rows: rows.collect() }
}

fn text_of(results: &Results) -> Text {
    let summary = &results.summary;
    let lines = |value: &serde_json::Value| -> Vec<String> {
        let table = value.get("table").and_then(serde_json::Value::as_array);
        table.into_iter().flatten().filter_map(|line| line.as_str().map(str::to_owned)).collect()
    };
    // The plan's lines are a name and what is said of it.
    let planned = |name: &str| {
        let said = |line: &String| line.strip_prefix(name).map(|rest| rest.trim().to_owned());
        summary.plan.iter().find_map(said).unwrap_or_default()
    };
    Text {
        title: summary.title.clone(),
        subtitle: planned("file "),
        scheme: format!("Scheme in force: {}.", planned("scheme ")),
        title_block: summary.title_block.clone(),
        inputs: summary.inputs.clone(),
        terrain_source: [summary.sources[0].clone(), planned("terrain ")]
            .into_iter()
            .filter(|words| !words.is_empty())
            .collect::<Vec<_>>()
            .join("; "),
        parameter_source: summary.sources[1].clone(),
        plan: summary.plan.clone(),
        warnings: [&summary.warnings[..], &summary.totals.warnings(results.hazard.rocks())]
            .concat(),
        mesh_health: lines(&summary.mesh_health),
        seed: summary.identity.seed,
        version: summary.identity.version.clone(),
        scene_hash: summary.identity.scene_hash.clone(),
        rate_per_s: Some(summary.run.releases_per_second),
        energy_remainder: summary.largest_energy_balance_error.map(|largest| largest.value),
    }
}

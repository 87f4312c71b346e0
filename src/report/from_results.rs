//! The report's numbers, gathered from the result files of a run: a report drawn again is the same report.

mod annual;
mod arrivals;
mod barriers;
mod design;
pub(super) mod first;
mod lines;
mod maps;
mod measured;
mod method;
mod profile;
mod shapes;

use self::first::LeftAtHoles;
use super::by_frequency;
use super::model::{
    BandPoint, Check, Estimate, EstimateRow, EstimateTable, Is, Path, Plausibility, Quantile,
    ReleaseEnd, Report, ReportPathPoint, ReportQuantity, StopShare, Text,
};
use super::raster::GroundRaster;
use super::words::{Words, fill};
use super::{format, plausibility};
use crate::error::Result;
use crate::hazard::{self, Exceedance, Hazard, Open, PERCENTS, Percentile, Sample, StopKind};
use crate::output::PathRow;
use crate::output::Results;
use crate::plan::PlanEntry;
use crate::rock::Vec3;
use crate::simulation::Stop;

/// Quantities of the tables, with their names in the hazard.
const TABLED: [(ReportQuantity, hazard::Quantity); 8] = [
    (ReportQuantity::Runout, hazard::Quantity::Runout),
    (ReportQuantity::ReachAngle, hazard::Quantity::ReachAngle),
    (ReportQuantity::Speed, hazard::Quantity::MaxSpeed),
    (ReportQuantity::Translational, hazard::Quantity::MaxTranslational),
    (ReportQuantity::Rotational, hazard::Quantity::MaxRotational),
    (ReportQuantity::Total, hazard::Quantity::MaxTotal),
    (ReportQuantity::Height, hazard::Quantity::MaxHeight),
    (ReportQuantity::Impacts, hazard::Quantity::Impacts),
];

/// Gathers the report of a finished run.
///
/// # Errors
/// A result file that cannot be read.
pub fn gather(results: &Results, ground: Option<GroundRaster>) -> Result<Report> {
    let hazard = &results.hazard;
    let language = results.summary.language;
    let words = Words::of(language);
    let weight = by_frequency::weighing(hazard);
    let releases: Vec<ReleaseEnd> =
        results.rows()?.map(|row| row.map(|row| fall_of(&row, &weight))).collect::<Result<_>>()?;
    let lines = lines::lines(results, ground.as_ref())?;
    let order: Vec<String> = lines.iter().map(|line| line.name.clone()).collect();
    let profile = profile::view(results, &releases)?;
    let (shapes, of_shapes) = shapes::told(results, words)?;
    let mut report = Report {
        language,
        profile,
        text: text_of(results, words),
        releases,
        paths: paths_of(results)?,
        runout_exceedance: band(&hazard.sample(hazard::Quantity::Runout).exceedance()),
        quantiles: TABLED.map(|(here, there)| (here, quantiles(hazard, there))).into(),
        stops: StopKind::ALL
            .into_iter()
            .filter(|kind| !kind.is_unusual() || hazard.ended(*kind).count > 0)
            .map(|kind| stop_share(hazard, kind))
            .collect(),
        headline: headline(hazard, words),
        arrivals: annual::headline(results, words)
            .into_iter()
            .chain(arrivals::tables(results, words, &order))
            .collect(),
        zones: lines::zones(results),
        marks: lines::marks(results),
        tables: [table(hazard, words)]
            .into_iter()
            .chain(annual::tables(results, words))
            .chain(lines::tables(results, words))
            .chain(barriers::tables(results, words, ground.as_ref()))
            .chain(measured::tables(results, words)?)
            .chain(of_shapes)
            .collect(),
        shapes,
        lines,
        is_weighted: hazard.weights().is_some(),
        annual: annual::views(results),
        has_view: false,
        barriers: barriers::views(results, ground.as_ref())?,
        maps: maps::maps(results)?,
        year_maps: maps::of_year(results)?,
        observed: measured::observed(results)?,
        ground,
        checks: Vec::new(),
    };
    report.checks = plausibility::checks(&report, results);
    let said =
        |check: &Check| fill(words.check_failed, &[("name", &check.name), ("found", &check.found)]);
    let failed = report.checks.iter().filter(|check| check.verdict == Plausibility::Off);
    let failed: Vec<String> = failed.map(said).collect();
    let off = report.observed.as_ref().and_then(|found| measured::off(found, words));
    let before_all = off
        .into_iter()
        .chain(first::warnings_first(hazard, LeftAtHoles::of(results)?.as_ref(), words))
        .collect();
    report.text.warnings = [before_all, report.text.warnings, failed].concat();
    Ok(report)
}

/// The exceedance curve with its band upright: the intervals of the percentiles lie along x, figures want them along y.
fn band(curve: &[Exceedance]) -> Vec<BandPoint> {
    let low: Vec<(f64, f64)> = curve.iter().filter_map(|at| Some((at.low_95?, at.share))).collect();
    let high: Vec<(f64, f64)> =
        curve.iter().filter_map(|at| Some((at.high_95?, at.share))).collect();
    // beyond the last known upper bound the share is no larger than there
    let least = high.last().map_or(f64::NAN, |(_, share)| *share);
    let point = |at: &Exceedance| BandPoint {
        x: at.value,
        y: Estimate::new(at.share, share_at(&low, at.value, 0.0), share_at(&high, at.value, least)),
    };
    // where rocks that left the terrain decide, there is no curve
    curve.iter().filter(|at| !at.censored).map(point).collect()
}

/// A unit of energy for a whole table: kJ where it has no number.
fn energy_unit_of(estimates: impl Iterator<Item = f64>) -> (&'static str, f64) {
    let largest = estimates.filter(|value| value.is_finite()).reduce(f64::max);
    largest.map_or(("kJ", 1e3), |largest| ReportQuantity::Total.unit(largest))
}

/// Share at `x` on a curve of points that rise in x and fall in share: 1 before the curve, `after` behind it.
fn share_at(curve: &[(f64, f64)], x: f64, after: f64) -> f64 {
    let k = curve.partition_point(|&(value, _)| value < x);
    match (k.checked_sub(1).and_then(|before| curve.get(before)), curve.get(k)) {
        (Some(&(x0, y0)), Some(&(x1, y1))) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (None, Some(_)) => 1.0,
        _ => after,
    }
}

fn estimate(value: f64, low: Option<f64>, high: Option<f64>) -> Estimate {
    Estimate::new(value, low.unwrap_or(f64::NAN), high.unwrap_or(f64::NAN))
}

/// A percentile of so many rocks, whose true values may be open on one side; too few rocks give none.
fn of_percentile(found: &Percentile, (rocks, open): (usize, Option<Open>)) -> Estimate {
    if let Some(missing) = found.lacks(rocks) {
        return Estimate::lacking(missing);
    }
    let is = Is::on_side(found.censored, open);
    Estimate { is, ..estimate(found.value, found.low_95, found.high_95) }
}

/// Percentile `p` (0..1) of a sample whose true values may be open on one side; none of nothing.
fn percentile_of(sample: &Sample, p: f64, open: Option<Open>) -> Option<Estimate> {
    Some(of_percentile(&sample.percentile(p)?, (sample.values().len(), open)))
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

fn fall_of(row: &hazard::Row, weight: impl Fn(usize) -> f64) -> ReleaseEnd {
    ReleaseEnd {
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
        weight: if row.stop.is_released() { weight(row.index) } else { 0.0 },
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
            path.points.push(ReportPathPoint {
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
        let at = percentile_of(&sample, probability, Some(quantity.open()))?;
        at.value.is_finite().then_some(Quantile { probability, at })
    };
    PERCENTS.into_iter().filter_map(one).collect()
}

fn stop_share(hazard: &Hazard, kind: StopKind) -> StopShare {
    let ended = hazard.ended(kind);
    let share = estimate(ended.share, Some(ended.low_95), Some(ended.high_95));
    StopShare { stop: stop_of(kind), count: ended.count, share }
}

/// What an engineer asks first: the middle and the far end of runout, and the design values of the rest.
pub(super) fn headline(hazard: &Hazard, words: &Words) -> Vec<EstimateRow> {
    use hazard::Quantity::{MaxHeight, MaxSpeed, MaxTotal, MaxTranslational, ReachAngle, Runout};
    let asked = [
        (words.runout, Runout, 0.50, "m"),
        (words.runout, Runout, 0.95, "m"),
        (words.runout, Runout, 0.99, "m"),
        (words.reach_angle, ReachAngle, 0.50, "°"),
        (words.max_speed, MaxSpeed, 0.95, "m/s"),
        (words.max_translational, MaxTranslational, 0.95, "J"),
        (words.max_total, MaxTotal, 0.95, "J"),
        (words.max_height, MaxHeight, 0.95, "m"),
    ];
    let row = |(name, quantity, p, unit): (&str, hazard::Quantity, f64, &str)| {
        let percent = format::decimal(100.0 * p, 0);
        let name = fill(words.percentile_of, &[("quantity", &name), ("percent", &percent)]);
        let estimate = percentile_of(&hazard.sample(quantity), p, Some(quantity.open()))?;
        Some(EstimateRow { name, estimate, unit: unit.to_owned() })
    };
    asked.into_iter().filter_map(row).collect()
}

fn table(hazard: &Hazard, words: &Words) -> EstimateTable {
    let rows = TABLED
        .map(|(here, there)| (here.name(words), here, hazard.sample(there), Some(there.open())));
    let how = if hazard.weights().is_some() { words.woodruff } else { words.order_statistics };
    let note = fill(
        words.all_statistics_note,
        &[("rocks", &words.rocks(hazard.released())), ("how", &how)],
    );
    statistics_table(words, words.all_statistics.to_owned(), note, &rows)
}

/// Columns of a table of statistics: mean, percentiles, maximum.
fn statistics(words: &Words) -> Vec<String> {
    let percents = PERCENTS.map(|percent| format!("{percent}\u{2009}%"));
    let ends = [words.mean, words.maximum].map(str::to_owned);
    let [mean, maximum] = ends;
    [mean].into_iter().chain(percents).chain([maximum]).collect()
}

/// What a row of a table of statistics is made from: name, the quantity whose unit it has, values, and on which side
/// true values may lie.
type StatisticsRow<'a> = (&'a str, ReportQuantity, Sample, Option<Open>);

/// A table of mean, percentiles and maximum; energies all in one unit.
fn statistics_table(
    words: &Words,
    title: String,
    note: String,
    rows: &[StatisticsRow<'_>],
) -> EstimateTable {
    let columns = statistics(words);
    let largest = |sample: &Sample| sample.values().last().copied().unwrap_or(0.0);
    let energies = rows.iter().filter(|(_, like, ..)| like.is_energy());
    let most_j = energies.map(|(.., sample, _)| largest(sample)).fold(0.0, f64::max);
    let rows = rows.iter().map(|(name, like, sample, open)| {
        let (unit, size) = like.unit(if like.is_energy() { most_j } else { largest(sample) });
        let mean = sample.mean().map(|mean| Estimate {
            is: Is::on_side(sample.bounds() > 0, *open),
            ..estimate(mean.value, mean.low_95, mean.high_95)
        });
        let most = sample.largest().map(|(most, is_bound)| Estimate {
            is: Is::on_side(is_bound, *open),
            ..Estimate::plain(most)
        });
        let middle =
            PERCENTS.map(|percent| percentile_of(sample, f64::from(percent) / 100.0, *open));
        let cells = [mean].into_iter().chain(middle).chain([most]);
        let name = if unit.is_empty() { (*name).to_owned() } else { format!("{name} ({unit})") };
        let clean = |x: Estimate| {
            // a thousandth of a degree is rounding too: rocks that roll level do not descend
            let is_rounding = matches!(like, ReportQuantity::Height | ReportQuantity::ReachAngle);
            if is_rounding { x.above_a_mm() } else { x.over(size) }
        };
        (name, cells.map(|cell| cell.map(clean)).collect())
    });
    EstimateTable { title, note, columns, rows: rows.collect(), ..EstimateTable::default() }
}

/// Warnings that concern rocks above a speed, where some came so fast.
fn fast_warnings(results: &Results) -> Vec<String> {
    let speeds = results.hazard.sample(hazard::Quantity::MaxSpeed);
    let fastest = speeds.values().last().copied().unwrap_or(0.0);
    let all = &results.summary.site.fast_warnings;
    all.iter().filter(|one| fastest > one.above_m_s).map(|one| one.text.clone()).collect()
}

/// The title block, its rows named in the language of the page.
fn title_block(rows: &[(String, String)], words: &Words) -> Vec<(String, String)> {
    let name = |name: &str| match name {
        "Client" => words.client.to_owned(),
        "Project" => words.project.to_owned(),
        "Author" => words.author.to_owned(),
        "Date" => words.date.to_owned(),
        other => other.to_owned(),
    };
    rows.iter().map(|(known, value)| (name(known), value.clone())).collect()
}

fn text_of(results: &Results, words: &Words) -> Text {
    let summary = &results.summary;
    let lines = |value: &serde_json::Value| -> Vec<String> {
        let table = value.get("table").and_then(serde_json::Value::as_array);
        table.into_iter().flatten().filter_map(|line| line.as_str().map(str::to_owned)).collect()
    };
    let planned = |name: &str| {
        let entry = summary.plan_entries.iter().find(|entry| entry.name == name);
        entry.map(|entry| words.say(&entry.said)).unwrap_or_default()
    };
    let said_of = |entry: &PlanEntry| (words.part(&entry.name), words.say_all(&entry.said));
    let planned_all = |name: &'static str| {
        summary.plan_entries.iter().filter(move |entry| entry.name == name).map(said_of)
    };
    Text {
        title: summary.title.clone(),
        subtitle: planned("file"),
        method: method::paragraph(&summary.plan_entries, words),
        title_block: title_block(&summary.title_block, words),
        inputs: summary
            .inputs
            .iter()
            .map(|(name, said)| (words.say(name), words.say_all(said)))
            .chain(planned_all("shape"))
            .collect(),
        terrain_source: [summary.sources[0].clone(), planned("terrain")]
            .into_iter()
            .filter(|words| !words.is_empty())
            .collect::<Vec<_>>()
            .join("; "),
        parameter_source: words.say(&summary.sources[1]),
        plan: summary.plan_entries.iter().map(said_of).collect(),
        warnings: [
            &summary.warnings[..],
            &fast_warnings(results)[..],
            &hazard::barrier_warnings(&summary.barriers)[..],
            first::untouched_trees(results).as_slice(),
            first::untouched_ground(results).as_slice(),
            &results.hazard.warnings(),
        ]
        .concat()
        .iter()
        .map(|warning| words.say(warning))
        .collect(),
        mesh_health: lines(&summary.mesh_health),
        seed: summary.identity.seed,
        version: summary.identity.version.clone(),
        scene_hash: summary.identity.scene_hash.clone(),
        took: Some(summary.run),
        energy_remainder: summary.largest_energy_balance_error.map(|largest| largest.value),
    }
}

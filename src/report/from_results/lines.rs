//! Lines of the report, gathered from the summary and the crossings.

use super::super::by_frequency;
use super::super::format;
use super::super::model::{
    About, BandPoint, Behind, Estimate, EstimateTable, Is, LinePoint, MapMark, Quantile,
    ReportLine, ReportQuantity, ZoneMark,
};
use super::super::raster::GroundRaster;
use super::super::words::open::missing as missing_rocks;
use super::super::words::{Words, fill};
use super::{estimate, percentile_of, statistics_table};
use crate::error::Result;
use crate::frequency::Weights;
use crate::hazard::{
    self, Barrier, CrossingRow, LineQuantity, PERCENTS, Proportion, Residual, Sample,
};
use crate::output::{ReleaseZone, Results};

/// A row: what it is of, its name, and the quantity of a release with the same unit.
type Tabled = (LineQuantity, fn(&Words) -> &'static str, ReportQuantity);

/// Quantities of a line's table: name, and the quantity of a release with the same unit.
const TABLED: [Tabled; 7] = [
    (LineQuantity::Speed, |words| words.speed, ReportQuantity::Speed),
    (LineQuantity::Translational, |words| words.translational, ReportQuantity::Translational),
    (LineQuantity::Rotational, |words| words.rotational, ReportQuantity::Rotational),
    (LineQuantity::Total, |words| words.total, ReportQuantity::Total),
    (LineQuantity::Height, |words| words.height_vertical, ReportQuantity::Height),
    (LineQuantity::HeightNormal, |words| words.height_normal, ReportQuantity::Height),
    (LineQuantity::Descent, |words| words.descent, ReportQuantity::ReachAngle),
];
/// Points of a curve of exceedance: more than there are pixels.
const POINTS: usize = 400;

/// The lines of the scene with their numbers in it, from 1: other places of barriers stand with the barriers.
pub(super) fn shown(results: &Results) -> impl Iterator<Item = (usize, &hazard::Line)> {
    results.lines_of_scene().enumerate().map(|(k, line)| (k + 1, line))
}

/// The barrier on a line, if one stands there.
fn barrier_on<'a>(results: &'a Results, name: &str) -> Option<&'a Barrier> {
    let mut barriers = results.summary.barriers.iter().map(|one| &one.barrier);
    barriers.find(|barrier| barrier.name == name)
}

/// Lines and barriers on the map.
pub(super) fn marks(results: &Results) -> Vec<MapMark> {
    let mark = |(_, line): (usize, &hazard::Line)| MapMark {
        name: line.info.name.clone(),
        corners_m: line.info.corners_m.clone(),
        barrier: barrier_on(results, &line.info.name).map(|b| (b.height_m, b.capacity_j)),
        is_object: results.is_object(&line.info.name),
    };
    shown(results).map(mark).collect()
}

/// Zones of release on the map.
pub(super) fn zones(results: &Results) -> Vec<ZoneMark> {
    let mark = |(name, outline): (Option<&str>, &ReleaseZone)| ZoneMark {
        name: name.unwrap_or_default().to_owned(),
        outline: outline.clone(),
    };
    results.summary.site.named_zones().map(mark).collect()
}

/// All lines with their first crossings, in downslope order.
pub(super) fn lines(results: &Results, ground: Option<&GroundRaster>) -> Result<Vec<ReportLine>> {
    let releases = results.hazard.released();
    let is_weighted = results.hazard.weights().is_some();
    let elevation = |corners: &[[f64; 2]]| ground.map_or(f64::NAN, |g| mean_height(g, corners));
    let mut lines: Vec<ReportLine> = shown(results)
        .filter(|(_, line)| !results.is_object(&line.info.name))
        .map(|(number, line)| ReportLine {
            number,
            is_barrier: barrier_on(results, &line.info.name).is_some(),
            elevation_m: elevation(&line.info.corners_m),
            is_weighted,
            ..empty(line, releases)
        })
        .collect();
    let weights = results.hazard.weights_or_equal();
    let barriers: Vec<Barrier> =
        results.summary.barriers.iter().map(|one| one.barrier.clone()).collect();
    let weight = by_frequency::weighing(&results.hazard);
    hazard::by_rock(results.crossings()?, |rock| take(&barriers, (rock, &weight), &mut lines))?;
    for line in &mut lines {
        let residual = results.summary.residual.iter().find(|at| at.line == line.name);
        line.behind = residual
            .filter(|at| !at.behind.is_empty())
            .map(|at| behind(line, at, (&weights, results)));
        line.arriving = match &line.behind {
            Some(behind) => Some(behind.reach),
            None => arriving(results, &line.name),
        };
        let all = || line.crossings.iter();
        let open: Vec<usize> = results.open.at(&line.name).collect();
        line.energy_exceedance = exceedance(all().map(energy), (&weights, &open));
        line.height_exceedance = exceedance(all().map(height), (&weights, &open));
    }
    sort_downslope(&mut lines);
    Ok(lines)
}

/// The highest line first; on level ground the one that most rocks reach. Stable: the rest, and lines without ground, keep the
/// order of the scene.
fn sort_downslope(lines: &mut [ReportLine]) {
    // heights of level ground differ in the last bits of their means
    let micrometres = |line: &ReportLine| match line.elevation_m {
        unknown if unknown.is_nan() => f64::NEG_INFINITY,
        known => (1e6 * known).round(),
    };
    lines.sort_by(|a, b| {
        let higher = micrometres(b).total_cmp(&micrometres(a));
        higher.then(b.crossings.len().cmp(&a.crossings.len()))
    });
}

/// Crossings of a rock at their lines; `weight` says what a release weighs.
fn take(
    barriers: &[Barrier],
    (rock, weight): (&[CrossingRow], impl Fn(usize) -> f64),
    lines: &mut [ReportLine],
) {
    let passes = hazard::unstopped(barriers, rock);
    for (row, passes) in rock.iter().zip(passes) {
        if let Some(line) = lines.iter_mut().find(|line| line.name == row.line) {
            line.least_radius_m = line.least_radius_m.min(row.radius_m);
            line.crossings.push(LinePoint {
                release: row.index,
                along_m: row.along_m,
                height_m: row.height_m,
                total_j: row.total_j(),
                passes,
                weight: weight(row.index),
            });
        }
    }
}

/// Release and total energy (J) of a crossing.
fn energy(at: &LinePoint) -> (usize, f64) {
    (at.release, at.total_j)
}

/// Release and height without what a rock presses into the ground (m); NaN where there is no ground.
fn height(at: &LinePoint) -> (usize, f64) {
    (at.release, if at.height_m < 0.0 { 0.0 } else { at.height_m })
}

fn behind(line: &ReportLine, at: &Residual, (weights, results): (&Weights, &Results)) -> Behind {
    let open: Vec<usize> = results.open.behind_barriers(&line.name).collect();
    let passing = || line.crossings.iter().filter(|at| at.passes);
    Behind {
        barriers: at.behind.clone(),
        reach: of_share(&at.with.reach),
        energy_exceedance: exceedance(passing().map(energy), (weights, &open)),
        height_exceedance: exceedance(passing().map(height), (weights, &open)),
    }
}

/// Share of the releases that arrive at a barrier, where one before it stops some of those that cross its line.
fn arriving(results: &Results, name: &str) -> Option<Estimate> {
    let mut barriers = results.summary.barriers.iter();
    let barrier = barriers.find(|one| one.barrier.name == name)?;
    (barrier.arriving.count < barrier.crossing).then(|| of_share(&barrier.arriving))
}

/// Mean height of the ground along a line (m); NaN where there is none.
fn mean_height(ground: &GroundRaster, corners: &[[f64; 2]]) -> f64 {
    let pieces = corners.windows(2).flat_map(|pair| {
        (0..=20).map(move |k| {
            let share = f64::from(k) / 20.0;
            [0, 1].map(|axis| pair[0][axis] + share * (pair[1][axis] - pair[0][axis]))
        })
    });
    let heights: Vec<f64> =
        pieces.map(|[x, y]| ground.height_at(x, y)).filter(|z| z.is_finite()).collect();
    heights.iter().sum::<f64>() / heights.len() as f64
}

/// Share of all releases above each of some values, by what each stands for, with its interval; of rocks that may still
/// come, nobody knows how high.
fn exceedance(
    values: impl Iterator<Item = (usize, f64)>,
    (weights, open): (&Weights, &[usize]),
) -> Vec<BandPoint> {
    let mut sorted: Vec<(usize, f64)> = values.filter(|(_, value)| value.is_finite()).collect();
    sorted.sort_by(|one, other| one.1.total_cmp(&other.1));
    let stride = sorted.len().div_ceil(POINTS).max(1);
    let last = sorted.len().checked_sub(1);
    let ranks = (0..sorted.len()).step_by(stride).chain(last);
    let share = |above: &[(usize, f64)]| {
        let above = above.iter().map(|(release, _)| *release);
        of_share(&hazard::share_up_to(weights, above, open.iter().copied()))
    };
    let point = |rank: usize| BandPoint { x: sorted[rank].1, y: share(&sorted[rank + 1..]) };
    let first = sorted.first().map(|_| BandPoint { x: 0.0, y: share(&sorted) });
    steps(first.into_iter().chain(ranks.map(point)))
}

/// A curve that keeps each value of `y` up to the `x` at which it falls.
pub(super) fn steps(points: impl Iterator<Item = BandPoint>) -> Vec<BandPoint> {
    let mut curve: Vec<BandPoint> = Vec::new();
    for point in points {
        let before = curve.last().map(|last| BandPoint { x: point.x, y: last.y });
        curve.extend(before.into_iter().chain([point]));
    }
    curve
}

/// A share with its interval.
pub(super) fn of_share(share: &Proportion) -> Estimate {
    let is = Is::at_least_if(share.censored);
    Estimate { is, ..estimate(share.share, Some(share.low_95), Some(share.high_95)) }
}

fn empty(line: &hazard::Line, releases: usize) -> ReportLine {
    let (energy, height) = (line.sample(LineQuantity::Total), line.sample(LineQuantity::Height));
    ReportLine {
        name: line.info.name.clone(),
        number: 0,
        is_barrier: false,
        elevation_m: f64::NAN,
        least_radius_m: f64::INFINITY,
        length_m: line.info.length_m,
        releases,
        reach: of_share(&line.reach(releases)),
        is_weighted: false,
        crossing_again: line.crossing_again(),
        crossings: Vec::new(),
        energy_quantiles: quantiles(&energy),
        height_quantiles: quantiles(&height),
        energy_exceedance: Vec::new(),
        height_exceedance: Vec::new(),
        behind: None,
        arriving: None,
    }
}

fn quantiles(sample: &Sample) -> Vec<Quantile> {
    let one = |percent: &u8| {
        let probability = f64::from(*percent) / 100.0;
        let at = percentile_of(sample, probability, None)?;
        at.value.is_finite().then_some(Quantile { probability, at })
    };
    PERCENTS.iter().filter_map(one).collect()
}

/// One table a line that rocks cross.
pub(super) fn tables(results: &Results, words: &Words) -> Vec<EstimateTable> {
    let releases = results.hazard.released();
    let is_weighted = results.hazard.weights().is_some();
    let table = |(_, line): (usize, &hazard::Line)| {
        let reach = line.reach(releases);
        let [share, low, high] =
            format::percents([reach.share, reach.low_95, reach.high_95], |_| 2);
        let count = |n: usize| format::decimal(n as f64, 0);
        let (title, plain, weighted) = if results.is_object(&line.info.name) {
            (words.object_table, words.object_note, by_frequency::OBJECT)
        } else {
            (words.line_table, words.line_note, by_frequency::LINE)
        };
        let note = if is_weighted { words.say(weighted) } else { plain.to_owned() };
        let note = fill(
            &note,
            &[
                ("count", &count(reach.count)),
                ("releases", &count(releases)),
                ("reach", &(format::sign(Is::at_least_if(reach.censored)).to_owned() + &share)),
                ("interval", &words.interval(&low, &high)),
                ("again", &count(line.crossing_again())),
            ],
        );
        let missing = line.may_still_come(releases);
        let note = note + &missing_rocks(words.open().at_line, missing.as_ref());
        let rows =
            TABLED.map(|(quantity, name, like)| (name(words), like, line.sample(quantity), None));
        let title = fill(title, &[("name", &words.quoted(&line.info.name))]);
        let statistics = statistics_table(words, title, note, &rows);
        let place = line.info.name.clone();
        (reach.count > 0).then_some(EstimateTable { about: About::Lines, place, ..statistics })
    };
    shown(results).filter_map(table).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A barrier a quarter of a metre above a line stands before it, however many rocks cross each.
    #[test]
    fn lines_follow_each_other_down_the_slope() {
        let at = |(number, elevation_m, rocks): (usize, f64, usize)| {
            let info = hazard::LineInfo {
                name: number.to_string(),
                length_m: 1.0,
                corners_m: Vec::new(),
                of_barrier: false,
                floor: None,
            };
            let point = |release| LinePoint {
                release,
                along_m: 0.0,
                height_m: 0.0,
                total_j: 1.0,
                passes: true,
                weight: 1.0,
            };
            let crossings = (0..rocks).map(point).collect();
            ReportLine { number, elevation_m, crossings, ..empty(&hazard::Line::new(info), 10) }
        };
        let order = |of: &[(usize, f64, usize)]| -> Vec<usize> {
            let mut lines: Vec<ReportLine> = of.iter().copied().map(at).collect();
            sort_downslope(&mut lines);
            lines.iter().map(|line| line.number).collect()
        };
        assert_eq!(order(&[(1, 3.50, 10), (2, 3.75, 9)]), [2, 1]);
        assert_eq!(
            order(&[(1, f64::NAN, 9), (2, 0.0, 3), (3, 1e-13, 4), (4, 0.0, 3)]),
            [3, 2, 4, 1]
        );
    }

    /// Five rocks of one energy: all of them exceed whatever is less, none has more.
    #[test]
    fn a_curve_falls_where_the_rocks_are() {
        let weights = Weights::equal(5);
        let curve = exceedance((0..5).map(|release| (release, 480.0)), (&weights, &[]));
        let at = |x: f64| curve.iter().filter(move |point| point.x <= x);
        assert!(at(479.0).all(|point| (point.y.value - 1.0).abs() < 1e-12));
        let first = curve.iter().find(|point| point.x > 0.0);
        assert!(first.is_some_and(|first| (first.y.value - 1.0).abs() < 1e-12), "{curve:?}");
        assert!(curve.last().is_some_and(|last| last.y.value.abs() < 1e-12));
    }
}

//! Whether the whole looks like rockfall: what was looked at, what was found, what is known from the field.

use super::model::{Check, Estimate, Is, Plausibility, ReleaseEnd, Report};
use super::raster::GroundRaster;
use super::words::fill;
use super::{by_frequency, format};
use super::{reach_angle, runout};
use crate::hazard::{Hazard, Quantity, Sample};
use crate::output::Results;
use crate::simulation::Stop;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Speed that single blocks seldom pass (m/s).
const FAST_M_S: f64 = 40.0;
/// Share of the rocks, by what they stand for, that may be faster (–): a few wild ones in a large sample are no sign of a wrong model.
const FEW: f64 = 0.001;
/// Depth of a closed hollow of the ground from which it holds a rock (m).
const HOLLOW_M: f64 = 0.2;
/// Share of the rocks at rest, by what they stand for, that may lie in closed hollows (–).
const IN_HOLLOWS: f64 = 0.25;
/// Edge of the triangles over the diameter of the rocks (–) from which the ground is smooth for them.
const COARSE: f64 = 5.0;
/// Share of the area of all deposits on which half of them may lie (–).
const CROWDED: f64 = 0.1;
/// Rocks at rest from which on their crowding says something.
const CROWD: usize = 400;
/// Share of the rocks, by what they stand for, above which those that would have gone on leave open what is seen of all (–).
const MOST: f64 = 0.5;
/// Rocks from which on a median says something.
const ENOUGH: usize = 20;

/// All checks that can be made.
pub(super) fn checks(report: &Report, results: &Results) -> Vec<Check> {
    let mut checks = Vec::new();
    if report.released() >= ENOUGH {
        checks.extend(reach(report));
        checks.extend(speed(report));
        checks.extend(report.ground.as_ref().and_then(|ground| hollows(report, ground)));
    }
    checks.extend(mesh(report, results));
    checks
}

fn check(name: &str, found: String, passes: bool) -> Check {
    let verdict = if passes { Plausibility::Plausible } else { Plausibility::Off };
    Check { name: name.to_owned(), found, verdict }
}

/// What looks right where most rocks would have gone on is not judged: faster and farther they may be anything.
fn not_judged(report: &Report, check: Check) -> Check {
    let open = report.releases.iter().filter(|fall| runout::is_open(fall));
    let is_early = weight(open) > MOST * weight(&report.releases);
    if !is_early || check.verdict == Plausibility::Off {
        return check;
    }
    let found = check.found + report.words().drawn().not_judged_why;
    Check { found, verdict: Plausibility::NotJudged, ..check }
}

fn reach(report: &Report) -> Option<Check> {
    let at = reach_angle::median(report)?;
    let Estimate { value: median, is, .. } = at;
    // an upper bound that is not below the bands proves nothing, neither right nor wrong
    let is_free = is == Is::AtMost && median > 40.0;
    let verdict = if is_free { Plausibility::Plausible } else { reach_angle::observed(&at) };
    let words = report.words();
    let median = format!("{}{}", format::sign(is), format::significant(median, 3));
    let found = fill(words.check_reach_found, &[("median", &median)]);
    let check = Check { name: words.check_reach.to_owned(), found, verdict };
    Some(if is == Is::AtMost { not_judged(report, check) } else { check })
}

/// Says in the terminal that more rocks are faster than single blocks are than a few wild ones.
pub fn fast_rocks(hazard: &Hazard) -> Option<String> {
    let speeds = hazard.values(Quantity::MaxSpeed);
    let fastest = speeds.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    if fastest <= FAST_M_S || hazard.released() < ENOUGH {
        return None;
    }
    let share = hazard.share_with(Quantity::MaxSpeed, |v| v > FAST_M_S).share;
    (share > FEW).then(|| {
        format!(
            "the fastest rock has {} m/s, and {} of the rocks are faster than {FAST_M_S} m/s, which single blocks seldom are: check terrain, friction and restitution",
            format::significant(fastest, 3),
            told(share)
        )
    })
}

/// A share with two digits; one of nearly all rocks does not look like all of them.
fn told(share: f64) -> String {
    if share > 0.99 {
        return format::percent_of_part(share, 0);
    }
    format!("{}\u{2009}%", format::significant(100.0 * share, 2))
}

fn speed(report: &Report) -> Option<Check> {
    let is_fast =
        |fall: &&ReleaseEnd| fall.max_speed_m_s.is_finite() && fall.max_speed_m_s > FAST_M_S;
    let fast: Vec<&ReleaseEnd> = report.releases.iter().filter(is_fast).collect();
    let speeds = report.releases.iter().map(|fall| fall.max_speed_m_s);
    let fastest = speeds.filter(|v| v.is_finite()).reduce(f64::max)?;
    let share = weight(fast.iter().copied()) / weight(&report.releases);
    let words = report.words();
    let count = |n: usize| format::decimal(n as f64, 0);
    let text = match fast.len() {
        0 => words.check_speed_found.to_owned(),
        _ => worded(report, words.check_fast_found, by_frequency::FAST),
    };
    let found = fill(
        &text,
        &[
            ("v", &format::significant(fastest, 3)),
            ("n", &count(fast.len())),
            ("of", &count(report.released())),
            ("share", &told(share)),
            ("limit", &FAST_M_S),
        ],
    );
    let passes = fast.is_empty() || share <= FEW;
    Some(not_judged(report, check(words.check_speed, found, passes)))
}

/// What rocks weigh together.
fn weight<'a>(rocks: impl IntoIterator<Item = &'a ReleaseEnd>) -> f64 {
    rocks.into_iter().map(|fall| fall.weight).sum()
}

/// The text of a check: as it is, or where rocks weigh what they stand for.
fn worded(report: &Report, counted: &str, weighed: &str) -> String {
    if report.is_weighted { report.words().say(weighed) } else { counted.to_owned() }
}

fn hollows(report: &Report, ground: &GroundRaster) -> Option<Check> {
    let depth = depths(ground);
    let at_rest: Vec<&ReleaseEnd> =
        report.releases.iter().filter(|fall| fall.stop == Stop::AtRest).collect();
    if at_rest.len() < ENOUGH {
        return None;
    }
    let is_held = |fall: &&&ReleaseEnd| depth.at(ground, &fall.end_m) > HOLLOW_M;
    let held: Vec<&ReleaseEnd> = at_rest.iter().filter(is_held).copied().collect();
    let share = weight(held.iter().copied()) / weight(at_rest.iter().copied());
    // by number: a few rocks that weigh much always lie on few cells
    let (half_m2, all_m2) = areas_m2(ground, &at_rest);
    let number = |value: f64| format::significant(value, 2);
    let words = report.words();
    let mut found = fill(
        &worded(report, words.check_deposits_found, by_frequency::DEPOSITS),
        &[
            ("n", &format::decimal(held.len() as f64, 0)),
            ("of", &format::decimal(at_rest.len() as f64, 0)),
            ("share", &format::percent_of_part(share, 0)),
            ("depth", &HOLLOW_M),
            ("half", &number(half_m2)),
            ("all", &number(all_m2)),
        ],
    );
    let is_crowded = at_rest.len() >= CROWD && half_m2 < CROWDED * all_m2;
    let passes = share <= IN_HOLLOWS && !is_crowded;
    if !passes {
        found += words.check_pits;
    }
    Some(check(words.check_deposits, found, passes))
}

/// Area of the fewest cells that hold half of the rocks, and of all cells that hold one (m²).
fn areas_m2(ground: &GroundRaster, rocks: &[&ReleaseEnd]) -> (f64, f64) {
    let mut counts: BTreeMap<(i64, i64), usize> = BTreeMap::new();
    for rock in rocks {
        let [x, y, _] = rock.end_m.map(|x| (x / ground.cell_m).floor() as i64);
        *counts.entry((x, y)).or_default() += 1;
    }
    let mut sizes: Vec<usize> = counts.into_values().collect();
    sizes.sort_unstable_by_key(|count| Reverse(*count));
    let mut held = 0;
    let half = sizes.iter().take_while(|count| {
        let is_open = 2 * held < rocks.len();
        held += **count;
        is_open
    });
    let area = |cells: usize| cells as f64 * ground.cell_m * ground.cell_m;
    (area(half.count()), area(sizes.len()))
}

/// How deep water would stand in every cell.
struct Depths(Vec<f64>);

impl Depths {
    fn at(&self, ground: &GroundRaster, end: &[f64; 3]) -> f64 {
        let column = ((end[0] - ground.west_m) / ground.cell_m).floor();
        let row = ((end[1] - ground.south_m) / ground.cell_m).floor();
        if !(column >= 0.0 && row >= 0.0 && column < ground.columns as f64) {
            return 0.0;
        }
        self.0.get(row as usize * ground.columns + column as usize).copied().unwrap_or(0.0)
    }
}

/// Fills the ground from its edges inwards, lowest outlet first (priority flood, Barnes et al. 2014).
fn depths(ground: &GroundRaster) -> Depths {
    let (columns, rows) = (ground.columns, ground.rows());
    let mut level = vec![f64::NAN; ground.height_m.len()];
    // heights as whole numbers of a tenth of a millimetre: a heap needs an order
    let key = |z: f64| (z * 1e4).round() as i64;
    let mut open: BinaryHeap<Reverse<(i64, usize)>> = BinaryHeap::new();
    let neighbours = |cell: usize| {
        let (column, row) = (cell % columns, cell / columns);
        [
            (column > 0).then(|| cell - 1),
            (column + 1 < columns).then(|| cell + 1),
            (row > 0).then(|| cell - columns),
            (row + 1 < rows).then(|| cell + columns),
        ]
    };
    for (cell, &z) in ground.height_m.iter().enumerate() {
        let is_edge =
            neighbours(cell).iter().any(|next| next.is_none_or(|n| ground.height_m[n].is_nan()));
        if z.is_finite() && is_edge {
            level[cell] = z;
            open.push(Reverse((key(z), cell)));
        }
    }
    while let Some(Reverse((_, cell))) = open.pop() {
        for next in neighbours(cell).into_iter().flatten() {
            let z = ground.height_m[next];
            if level[next].is_nan() && z.is_finite() {
                level[next] = z.max(level[cell]);
                open.push(Reverse((key(level[next]), next)));
            }
        }
    }
    let depth = level.iter().zip(&ground.height_m).map(|(level, z)| level - z);
    Depths(depth.map(|depth| if depth.is_finite() { depth } else { 0.0 }).collect())
}

/// The mesh against the rocks; both as they stand in the summary.
fn mesh(report: &Report, results: &Results) -> Option<Check> {
    let edges = results.summary.mesh_health.get("edge_quantiles_m")?;
    let median_m = edges.get(2)?.as_f64()?;
    let radii = results.rows().ok()?.filter_map(Result::ok).map(|row| row.radius_m);
    let released = radii.zip(&report.releases).filter(|(_, fall)| fall.weight > 0.0);
    let sample = Sample::weighted(released.map(|(radius, fall)| (radius, fall.weight)));
    let diameter_m = 2.0 * sample.percentile(0.5)?.value;
    let times = median_m / diameter_m;
    let words = report.words();
    let number = |value: f64| format::significant(value, 2);
    let mut found = fill(
        &worded(report, words.check_mesh_found, by_frequency::MESH),
        &[
            ("edge", &number(median_m)),
            ("times", &number(times)),
            ("diameter", &number(diameter_m)),
        ],
    );
    if times > COARSE {
        found += words.check_coarse;
    }
    Some(check(words.check_mesh, found, times <= COARSE))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope with one pit of 1 m: rocks in the pit lie 1 m below its outlet, all others in none.
    #[test]
    fn water_stands_in_a_pit_up_to_its_outlet() {
        let columns = 20;
        let height = |cell: usize| {
            let (column, row) = (cell % columns, cell / columns);
            // the outlet of (10, 10) is its lower neighbour at row 9
            row as f64 - if (column, row) == (10, 10) { 2.0 } else { 0.0 }
        };
        let ground = GroundRaster {
            west_m: 100.0,
            south_m: 200.0,
            cell_m: 2.0,
            columns,
            height_m: (0..columns * 20).map(height).collect(),
            trees: vec![false; columns * 20],
        };
        let depth = depths(&ground);
        let at = |x: f64, y: f64| depth.at(&ground, &[x, y, 0.0]);
        assert!((at(121.0, 221.0) - 1.0).abs() < 1e-3, "{}", at(121.0, 221.0));
        assert!(at(119.0, 221.0).abs() < 1e-3 && at(99.0, 221.0).abs() < 1e-12);
        assert!(depth.0.iter().filter(|depth| **depth > 1e-3).count() == 1);
    }
}

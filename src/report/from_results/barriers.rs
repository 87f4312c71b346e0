//! What barriers stop and what their rule asks for, from the summary and the crossings.

use super::super::format;
use super::super::model::{About, BarrierView, DesignView, Estimate, PlaceView, Quantity, Table};
use super::super::raster::GroundRaster;
use super::{estimate, of_percentile};
use crate::error::Result;
use crate::hazard::{
    self, Arrival, AtPlace, BarrierSummary, Design, PERCENTS, Proportion, Rule, Statistic,
};
use crate::math;
use crate::output::Results;
use std::collections::BTreeMap;

/// The rocks that arrive at each barrier, for its figure.
pub(super) fn views(results: &Results, ground: Option<&GroundRaster>) -> Result<Vec<BarrierView>> {
    let summaries = &results.summary.barriers;
    if summaries.is_empty() {
        return Ok(Vec::new());
    }
    let barriers: Vec<hazard::Barrier> = summaries.iter().map(|one| one.barrier.clone()).collect();
    let arrivals = hazard::arrivals(&barriers, results.crossings()?)?;
    let view = |(one, places): (&BarrierSummary, Vec<Vec<Arrival>>)| BarrierView {
        name: one.barrier.name.clone(),
        height_m: one.barrier.height_m,
        capacity_j: one.barrier.capacity_j,
        design: one.design_values.as_ref().map(design_view),
        design_lacks: one.design_lacks,
        percentile: one.barrier.design.as_ref().map(|rule| rule.percentile),
        left_is_uphill: left_is_uphill(results, one, ground),
        places: one.by_place.iter().zip(places).map(place_view).collect(),
    };
    Ok(summaries.iter().zip(arrivals).map(view).collect())
}

fn design_view(design: &Design) -> DesignView {
    let of = |value: f64, [low, high]: [Option<f64>; 2]| estimate(value, low, high);
    DesignView {
        height_m: of(design.height_m, design.height_95_m),
        energy_j: of(design.energy_j, design.energy_95_j),
    }
}

/// What the rule of a barrier asks for, or how many rocks are missing; none without a rule.
pub(super) fn design(one: &BarrierSummary) -> Option<DesignView> {
    let lacking = Estimate::lacking(one.design_lacks);
    let lacking =
        (one.design_lacks > 0).then_some(DesignView { height_m: lacking, energy_j: lacking });
    one.design_values.as_ref().map(design_view).or(lacking)
}

/// Whether the ground on the left of a barrier's line is higher than on its right, 10 m to each side of its middle.
fn left_is_uphill(
    results: &Results,
    one: &BarrierSummary,
    ground: Option<&GroundRaster>,
) -> Option<bool> {
    let line = results.lines.iter().find(|line| line.info.name == one.barrier.name)?;
    let corners = &line.info.corners_m;
    let pair = corners.get(corners.len().checked_sub(1)? / 2..)?.get(..2)?;
    let [dx, dy] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
    let (x, y) = (0.5 * (pair[0][0] + pair[1][0]), 0.5 * (pair[0][1] + pair[1][1]));
    let aside = 10.0 / math::hypot(dx, dy);
    let height =
        |side: f64| ground.map(|g| g.height_at(x - side * aside * dy, y + side * aside * dx));
    let (left, right) = (height(1.0)?, height(-1.0)?);
    (left - right).is_finite().then_some(left > right)
}

fn place_view((place, rocks): (&AtPlace, Vec<Arrival>)) -> PlaceView {
    PlaceView {
        offset_m: place.offset_m,
        arriving: place.arriving.share,
        rocks: rocks.iter().map(|rock| (rock.top_m, rock.total_j)).collect(),
    }
}

/// One table over all barriers, and two of each: what arrives, and how it would do at other heights and places.
pub(super) fn tables(results: &Results, ground: Option<&GroundRaster>) -> Vec<Table> {
    let barriers = &results.summary.barriers;
    if barriers.is_empty() {
        return Vec::new();
    }
    let reached = barriers.iter().filter(|one| one.arriving.count > 0);
    let each = reached
        .flat_map(|one| [arriving(one), sensitivity(one, left_is_uphill(results, one, ground))]);
    [counts(barriers)].into_iter().chain(each).collect()
}

fn counts(barriers: &[BarrierSummary]) -> Table {
    let columns = [
        "height (m)",
        "capacity (kJ)",
        "arriving",
        "arriving (%)",
        "stopped (%)",
        "over",
        "through",
        "design height (m)",
        "design energy (kJ)",
    ];
    let rules: Vec<String> = barriers.iter().filter_map(in_words).collect();
    Table {
        about: About::Barriers,
        title: "Barriers".to_owned(),
        note: format!(
            "A barrier stops a rock whose highest point is not above its edge and whose total energy it takes. What one stops \
             does not arrive at those behind it. Shares with Wilson's 95 % interval. {}",
            rules.join(" ")
        ),
        columns: columns.map(str::to_owned).into(),
        rows: barriers.iter().map(|one| (one.barrier.name.clone(), cells(one))).collect(),
    }
}

fn plain(value: f64) -> Estimate {
    estimate(value, None, None)
}

fn percent(share: &Proportion) -> Option<Estimate> {
    let [value, low, high] = [share.share, share.low_95, share.high_95].map(|x| 100.0 * x);
    (share.of > 0).then(|| estimate(value, Some(low), Some(high)))
}

fn cells(one: &BarrierSummary) -> Vec<Option<Estimate>> {
    let design = design(one);
    vec![
        Some(plain(one.barrier.height_m)),
        Some(plain(one.barrier.capacity_j / 1e3)),
        Some(plain(one.arriving.count as f64)),
        percent(&one.arriving),
        percent(&one.stopped),
        Some(plain(one.over as f64)),
        Some(plain(one.through as f64)),
        design.map(|design| design.height_m),
        design.map(|design| design.energy_j.over(1e3)),
    ]
}

/// The rule of a barrier with its factors one by one.
fn in_words(one: &BarrierSummary) -> Option<String> {
    let rule: &Rule = one.barrier.design.as_ref()?;
    let Some(design) = one.design_values.as_ref() else {
        return Some(format!(
            "No design of “{}”: P{} needs {} more {}.",
            one.barrier.name,
            rule.percentile,
            one.design_lacks,
            format::counted(one.design_lacks, "rock that arrives", "rocks that arrive")
        ));
    };
    let factors = |what: &str, list: &BTreeMap<String, f64>| {
        let each: Vec<String> = list
            .iter()
            .map(|(name, factor)| format!("{} {factor}", name.replace('_', " ")))
            .collect();
        if each.is_empty() {
            format!("no factor on {what}")
        } else {
            format!("on {what}: {}", each.join(", "))
        }
    };
    let standard = rule.standard.as_deref().map_or("a rule of its own", |name| name);
    let distance = rule.free_distance_m.map_or(String::new(), |free_m| {
        format!(" At least {} m must stay free behind it.", format::significant(free_m, 3))
    });
    Some(format!(
        "Design of “{}” by {standard}: P{} of total energy {:.1} kJ and of the highest point {:.2} m; {}; {}; {}; free height {} m.{distance}",
        one.barrier.name,
        rule.percentile,
        design.energy_percentile_j / 1e3,
        design.height_percentile_m,
        factors("speed (squared in the energy)", &rule.speed_factors),
        factors("mass", &rule.mass_factors),
        factors("height", &rule.height_factors),
        rule.free_height_m
    ))
}

/// The population that is left for a barrier by those before it.
fn arriving(one: &BarrierSummary) -> Table {
    let percents = PERCENTS.map(|percent| format!("{percent}\u{2009}%"));
    let columns =
        ["mean".to_owned()].into_iter().chain(percents).chain(["maximum".to_owned()]).collect();
    let row = |name: &str, like: Quantity, of: &Statistic| {
        let most = of.max.map(|most| most.value);
        let (unit, size) = like.unit(most.unwrap_or(0.0));
        let mean = of.mean.map(|mean| estimate(mean.value, mean.low_95, mean.high_95));
        let middle = PERCENTS.map(|percent| {
            let found = of.percentiles.get(&format!("p{percent}"))?;
            Some(of_percentile(found, (of.rocks, None)))
        });
        let cells = [mean].into_iter().chain(middle).chain([most.map(plain)]);
        (format!("{name} ({unit})"), cells.map(|cell| cell.map(|x| x.over(size))).collect())
    };
    let before = one.crossing - one.arriving.count;
    Table {
        about: About::Barriers,
        title: format!("Rocks that arrive at barrier “{}”", one.barrier.name),
        note: format!(
            "{} {} its line; a barrier before has stopped {before}; {} {} left.",
            one.crossing,
            format::counted(one.crossing, "rock crosses", "rocks cross"),
            one.arriving.count,
            format::counted(one.arriving.count, "is", "are"),
        ),
        columns,
        rows: vec![
            row("Total energy", Quantity::Total, &one.energy_j),
            row("Height of the highest point", Quantity::Height, &one.top_m),
        ],
    }
}

fn sensitivity(one: &BarrierSummary, left_is_uphill: Option<bool>) -> Table {
    let heights = one.by_place.first().into_iter().flat_map(|own| &own.by_height);
    let stopped = heights
        .map(|(height_m, _)| format!("stopped at {} m (%)", format::significant(*height_m, 3)));
    let mut columns: Vec<String> = ["arriving (%)".to_owned()].into_iter().chain(stopped).collect();
    let has_design = one.by_place.iter().any(|place| place.design_values.is_some());
    if has_design {
        columns.extend(["design height (m)", "design energy (kJ)"].map(str::to_owned));
    }
    let row = |place: &AtPlace| {
        let name = match place.offset_m {
            0.0 => "at its place".to_owned(),
            aside => side(aside, left_is_uphill),
        };
        let mut cells = vec![percent(&place.arriving)];
        cells.extend(place.by_height.iter().map(|(_, share)| percent(share)));
        if has_design {
            let design = place.design_values.as_ref().map(design_view);
            cells.push(design.map(|design| design.height_m));
            cells.push(design.map(|design| design.energy_j.over(1e3)));
        }
        (name, cells)
    };
    Table {
        about: About::Barriers,
        title: format!("Barrier “{}” at other heights and places", one.barrier.name),
        note: "Share of the rocks arriving there that a barrier of that height and the same capacity would stop. The other \
               barriers stay where they are. No design value stands where too few rocks arrive."
            .to_owned(),
        columns,
        rows: one.by_place.iter().map(row).collect(),
    }
}

/// A distance beside a line in words (m, positive on its left): uphill or downhill where the ground says which.
fn side(aside_m: f64, left_is_uphill: Option<bool>) -> String {
    let towards = match (aside_m > 0.0, left_is_uphill) {
        (is_left, Some(uphill)) => {
            if is_left == uphill {
                "uphill"
            } else {
                "downhill"
            }
        }
        (true, None) => "to the left",
        (false, None) => "to the right",
    };
    format!("{}\u{2009}m {towards}", format::plain(aside_m.abs()))
}

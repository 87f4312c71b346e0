//! What barriers stop and what their rule asks for, from the summary and the crossings.

use super::super::by_frequency;
use super::super::format;
use super::super::model::{
    About, BarrierView, Estimate, EstimateTable, Is, PlaceView, ReportQuantity, RockView,
    energy_unit,
};
use super::super::raster::GroundRaster;
use super::super::words::open::missing as missing_rocks;
use super::super::words::{Words, fill};
use super::design::{design, design_view, energy_in_words, with_design_if_any};
use super::{energy_unit_of, estimate, of_percentile, statistics};
use crate::error::Result;
use crate::frequency::Weights;
use crate::hazard::{
    self, Arrival, AtPlace, BarrierSummary, Design, PERCENTS, Proportion, Rule, Statistic,
};
use crate::math;
use crate::output::Results;
use std::collections::BTreeMap;
use std::fmt::Display;

/// The rocks that arrive at each barrier, for its figure.
pub(super) fn views(results: &Results, ground: Option<&GroundRaster>) -> Result<Vec<BarrierView>> {
    let summaries = &results.summary.barriers;
    if summaries.is_empty() {
        return Ok(Vec::new());
    }
    let barriers: Vec<hazard::Barrier> = summaries.iter().map(|one| one.barrier.clone()).collect();
    let arrivals = hazard::arrivals(&barriers, results.crossings()?)?;
    let weights = results.hazard.weights();
    let view = |(one, places): (&BarrierSummary, Vec<Vec<Arrival>>)| BarrierView {
        name: one.barrier.name.clone(),
        height_m: one.barrier.height_m,
        capacity_j: one.barrier.capacity_j,
        design: one.design_values.as_ref().map(design_view),
        design_lacks: one.design_lacks,
        percentile: one.barrier.design.as_ref().map(|rule| rule.percentile),
        left_is_uphill: left_is_uphill(results, one, ground),
        places: one
            .by_place
            .iter()
            .zip(places)
            .map(|place| place_view(place, weights.as_ref()))
            .collect(),
    };
    Ok(summaries.iter().zip(arrivals).map(view).collect())
}

/// Distance to each side of a barrier at which the ground says where uphill is (m).
const ASIDE_M: f64 = 10.0;

/// Whether the ground on the left of a barrier's line is higher than on its right, beside its middle: 10 m to each side, or where the
/// terrain does not reach so far, as far as its other places do. None on level ground.
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
    let length = math::hypot(dx, dy);
    let height = |aside_m: f64| {
        let part = aside_m / length;
        ground.map(|g| g.height_at(x - part * dy, y + part * dx))
    };
    let places_m = one.by_place.iter().map(|place| place.offset_m.abs()).fold(0.0, f64::max);
    is_higher_ahead(height, [ASIDE_M, places_m])
}

/// Whether heights rise with the distance, by the first of some distances to both sides that tells (m).
fn is_higher_ahead(height: impl Fn(f64) -> Option<f64>, distances_m: [f64; 2]) -> Option<bool> {
    let rise = |aside_m: f64| Some(height(aside_m)? - height(-aside_m)?);
    let mut known = distances_m.into_iter().filter_map(rise);
    known.find(|rise| rise.is_finite() && *rise != 0.0).map(|rise| rise > 0.0)
}

/// `weights`: none where all rocks weigh the same.
fn place_view((place, rocks): (&AtPlace, Vec<Arrival>), weights: Option<&Weights>) -> PlaceView {
    let rock = |rock: &Arrival| RockView {
        top_m: rock.top_m,
        total_j: rock.total_j,
        weight: weights.map_or(1.0, |weights| weights.of_release(rock.release)),
    };
    PlaceView {
        offset_m: place.offset_m,
        arriving: place.arriving.share,
        stopped: place.at_own_height().and_then(percent),
        rocks: rocks.iter().map(rock).collect(),
    }
}

/// One table over all barriers, and two of each: what arrives, and how it would do at other heights and places.
pub(super) fn tables(
    results: &Results,
    words: &Words,
    ground: Option<&GroundRaster>,
) -> Vec<EstimateTable> {
    let barriers = &results.summary.barriers;
    if barriers.is_empty() {
        return Vec::new();
    }
    let reached = barriers.iter().filter(|one| one.arriving.count > 0);
    let each = reached.flat_map(|one| {
        let left_is_uphill = left_is_uphill(results, one, ground);
        [arriving(one, words), sensitivity(one, words, left_is_uphill)]
    });
    let mut tables: Vec<EstimateTable> =
        [counts(barriers, words)].into_iter().chain(each).collect();
    if results.hazard.weights().is_some() {
        for table in &mut tables {
            say_by_frequency(table, words);
        }
    }
    tables
}

/// Says of a table which numbers are shares of events, and which of computed rocks.
fn say_by_frequency(table: &mut EstimateTable, words: &Words) {
    for column in &mut table.columns {
        if [words.col_arriving, words.col_over, words.col_through].contains(&column.as_str()) {
            *column = fill(&words.say(by_frequency::COMPUTED), &[("what", column)]);
        }
    }
    let note = std::mem::take(&mut table.note);
    table.note = by_frequency::noted(note, Some(by_frequency::SHARES), words);
}

/// A unit for some design energies.
fn unit_of<'a>(designs: impl Iterator<Item = &'a Option<Design>>) -> (&'static str, f64) {
    energy_unit_of(designs.flatten().map(|design| design.energy_j))
}

fn counts(barriers: &[BarrierSummary], words: &Words) -> EstimateTable {
    let (unit, size_j) = unit_of(barriers.iter().map(|one| &one.design_values));
    let design_energy = fill(words.col_design_energy, &[("unit", &unit)]);
    let columns = [
        words.col_height,
        words.col_capacity,
        words.col_arriving,
        words.col_arriving_percent,
        words.col_stopped,
        words.col_over,
        words.col_through,
        words.col_design_height,
        &design_energy,
    ];
    let rules: Vec<String> = barriers.iter().filter_map(|one| in_words(one, words)).collect();
    let table = EstimateTable {
        about: About::Barriers,
        title: words.barriers_title.to_owned(),
        note: fill(words.barriers_note, &[("rules", &rules.join(" "))]).trim_end().to_owned(),
        columns: columns.map(str::to_owned).into(),
        rows: barriers.iter().map(|one| (one.barrier.name.clone(), cells(one, size_j))).collect(),
        ..EstimateTable::default()
    };
    with_design_if_any(table, barriers)
}

fn plain(value: f64) -> Estimate {
    estimate(value, None, None)
}

fn percent(share: &Proportion) -> Option<Estimate> {
    let [value, low, high] = [share.share, share.low_95, share.high_95].map(|x| 100.0 * x);
    let is = Is::at_least_if(share.censored);
    (share.of > 0).then(|| Estimate { is, ..estimate(value, Some(low), Some(high)) })
}

fn cells(one: &BarrierSummary, size_j: f64) -> Vec<Option<Estimate>> {
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
        design.map(|design| design.energy_j.over(size_j)),
    ]
}

/// The rule of a barrier with its factors one by one.
fn in_words(one: &BarrierSummary, words: &Words) -> Option<String> {
    let rule: &Rule = one.barrier.design.as_ref()?;
    let name = words.quoted(&one.barrier.name);
    let Some(design) = one.design_values.as_ref() else {
        let found: [(&str, &dyn Display); 3] =
            [("name", &name), ("percentile", &rule.percentile), ("n", &one.design_lacks)];
        return Some(fill(words.rule_lacks, &found));
    };
    let standard = rule.standard.as_deref().unwrap_or(words.own_rule);
    let distance = rule.free_distance_m.map_or(String::new(), |free_m| {
        fill(words.free_distance, &[("m", &format::significant(free_m, 3))])
    });
    let factors = |what, list| factors(what, list, words);
    let (unit, size) = energy_unit(design.energy_percentile_j);
    let said = fill(
        words.rule,
        &[
            ("name", &name),
            ("standard", &standard),
            ("percentile", &rule.percentile),
            ("energy", &percentile(&one.energy_j, design.energy_percentile_j, size)),
            ("unit", &unit),
            ("top", &percentile(&one.top_m, design.height_percentile_m, 1.0)),
            ("speed", &factors(words.factor_speed, &rule.speed_factors)),
            ("mass", &factors(words.factor_mass, &rule.mass_factors)),
            ("height", &factors(words.factor_height, &rule.height_factors)),
            ("free", &rule.free_height_m),
        ],
    );
    Some(said + &energy_in_words((rule, design), words) + &distance)
}

/// The percentile of a rule over a unit, with as many digits as in the table of what arrives.
fn percentile(of: &Statistic, value: f64, unit: f64) -> String {
    let known = of.percentiles.values().find(|found| found.value.to_bits() == value.to_bits());
    let end = |end: Option<f64>| end.map_or(f64::NAN, |end| end / unit);
    let (low, high) = known.map_or((None, None), |found| (found.low_95, found.high_95));
    let [value, ..] = format::with_interval([value / unit, end(low), end(high)]);
    value
}

/// The name of a factor: those of the standards in the language of the page, the scene's own as written there.
fn factor_name(name: &str, words: &Words) -> String {
    match name {
        "topography" => words.drawn().topography.to_owned(),
        "simulation" => words.drawn().simulation.to_owned(),
        "block_volume" => words.drawn().block_volume.to_owned(),
        own => own.replace('_', " "),
    }
}

/// Partial factors on something, one by one.
fn factors(what: &str, list: &BTreeMap<String, f64>, words: &Words) -> String {
    let each: Vec<String> = list
        .iter()
        .map(|(name, factor)| format!("{} {factor}", factor_name(name, words)))
        .collect();
    let text = if each.is_empty() { words.no_factor } else { words.factors };
    fill(text, &[("what", &what), ("list", &each.join(", "))])
}

/// The population that is left for a barrier by those before it.
fn arriving(one: &BarrierSummary, words: &Words) -> EstimateTable {
    let row = |name: &str, like: ReportQuantity, of: &Statistic| {
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
    let count = |n: usize| format::decimal(n as f64, 0);
    EstimateTable {
        about: About::Barriers,
        place: one.barrier.name.clone(),
        title: named(words.arriving_title, one, words),
        note: fill(
            words.arriving_note,
            &[
                ("crossing", &count(one.crossing)),
                ("before", &count(before)),
                ("left", &count(one.arriving.count)),
            ],
        ) + &missing_rocks(words.open().at_line, one.may_still_come.as_ref()),
        columns: statistics(words),
        rows: vec![
            row(words.total, ReportQuantity::Total, &one.energy_j),
            row(words.top, ReportQuantity::Height, &one.top_m),
        ],
    }
}

/// A title with the name of a barrier.
fn named(text: &str, one: &BarrierSummary, words: &Words) -> String {
    fill(text, &[("name", &words.quoted(&one.barrier.name))])
}

fn sensitivity(one: &BarrierSummary, words: &Words, left_is_uphill: Option<bool>) -> EstimateTable {
    let heights = one.by_place.first().into_iter().flat_map(|own| &own.by_height);
    let stopped =
        heights.map(|(m, _)| fill(words.col_stopped_at, &[("m", &format::significant(*m, 3))]));
    let mut columns: Vec<String> =
        [words.col_arriving_percent.to_owned()].into_iter().chain(stopped).collect();
    let has_design = one.by_place.iter().any(|place| place.design_values.is_some());
    let (unit, size_j) = unit_of(one.by_place.iter().map(|place| &place.design_values));
    if has_design {
        columns.push(words.col_design_height.to_owned());
        columns.push(fill(words.col_design_energy, &[("unit", &unit)]));
    }
    let row = |place: &AtPlace| {
        let name = match place.offset_m {
            0.0 => words.at_its_place.to_owned(),
            aside => side(aside, words, left_is_uphill),
        };
        let mut cells = vec![percent(&place.arriving)];
        cells.extend(place.by_height.iter().map(|(_, share)| percent(share)));
        if has_design {
            let design = place.design_values.as_ref().map(design_view);
            cells.push(design.map(|design| design.height_m));
            cells.push(design.map(|design| design.energy_j.over(size_j)));
        }
        (name, cells)
    };
    let of_design = one.barrier.design.as_ref().map_or("", |_| words.sensitivity_design);
    EstimateTable {
        about: About::Barriers,
        place: one.barrier.name.clone(),
        title: named(words.sensitivity_title, one, words),
        note: words.sensitivity_note.to_owned() + of_design,
        columns,
        rows: one.by_place.iter().map(row).collect(),
    }
}

/// A distance beside a line in words (m, positive on its left): uphill or downhill where the ground says which.
fn side(aside_m: f64, words: &Words, left_is_uphill: Option<bool>) -> String {
    let towards = match (aside_m > 0.0, left_is_uphill) {
        (is_left, Some(uphill)) => {
            if is_left == uphill {
                words.uphill
            } else {
                words.downhill
            }
        }
        (true, None) => words.to_the_left,
        (false, None) => words.to_the_right,
    };
    format!("{}\u{2009}m {towards}", format::plain(aside_m.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Language;

    /// On a terrain of 5 m nothing is known 10 m aside, and the other places of the barrier say where it falls.
    #[test]
    fn a_small_terrain_has_an_uphill_too() {
        let slope = |half_m: f64| {
            move |at_m: f64| Some(if at_m.abs() > half_m { f64::NAN } else { -0.5 * at_m })
        };
        assert_eq!(is_higher_ahead(slope(100.0), [10.0, 0.2]), Some(false));
        assert_eq!(is_higher_ahead(slope(2.5), [10.0, 0.2]), Some(false));
        assert_eq!(is_higher_ahead(slope(2.5), [10.0, 0.0]), None, "no other place");
        assert_eq!(is_higher_ahead(|_| Some(3.0), [10.0, 0.2]), None, "level");
    }

    /// Names of the standards' factors are words of the program, names of others are the user's.
    #[test]
    fn factors_of_a_standard_are_named_in_the_language() {
        let list = ["block_volume", "dichte_m", "topography"].map(|name| (name.to_owned(), 1.02));
        let said = |language| factors("", &list.clone().into(), Words::of(language));
        assert!(said(Language::De).contains("Blockvolumen 1.02, dichte m 1.02, Topografie 1.02"));
        assert!(said(Language::En).contains("block volume 1.02, dichte m 1.02, topography 1.02"));
    }

    /// Designs of a few joules are said in joules.
    #[test]
    fn design_energies_have_the_unit_of_their_size() {
        let design = |energy_j: f64| Design {
            energy_percentile_j: energy_j,
            speed_percentile_m_s: None,
            energy_j,
            capacity_j: None,
            energy_95_j: [None; 2],
            height_percentile_m: 1.0,
            height_m: 1.0,
            height_95_m: [None; 2],
        };
        assert_eq!(unit_of([&Some(design(14.6)), &None].into_iter()).0, "J");
        assert_eq!(unit_of([&Some(design(14.6)), &Some(design(1e6))].into_iter()).0, "kJ");
    }
}

//! The first tables of the page: what arrives at each line, and at each barrier.

use super::super::model::{About, Estimate, EstimateTable};
use super::super::site;
use super::super::words::{Words, fill};
use super::design::{design as of_rule, has_design, with_design_if_any};
use super::lines::{of_share, shown};
use super::{energy_unit_of, of_percentile, percentile_of};
use crate::hazard::{BarrierSummary, Line, LineQuantity, Residual, SilentClasses, Statistic};
use crate::output::Results;
use crate::report::format::significant;

/// The percentile of the headline (–).
const P: f64 = 0.95;
/// Letters up to which the names of several barriers stand in a row of the table.
const LONGEST: usize = 40;

/// One table over the lines in this order, one over the barriers; each where there are some.
pub(super) fn tables(results: &Results, words: &Words, order: &[String]) -> Vec<EstimateTable> {
    [lines(results, words, order), barriers(results, words)].into_iter().flatten().collect()
}

fn of(statistic: &Statistic) -> Option<Estimate> {
    Some(of_percentile(statistic.percentiles.get("p95")?, (statistic.rocks, None)))
}

fn percent(share: Estimate) -> Estimate {
    share.over(0.01)
}

fn lines(results: &Results, words: &Words, order: &[String]) -> Option<EstimateTable> {
    let releases = results.hazard.released();
    let is_barrier =
        |name: &str| results.summary.barriers.iter().any(|one| one.barrier.name == name);
    let mut own: Vec<_> = shown(results).filter(|(_, line)| !is_barrier(&line.info.name)).collect();
    own.sort_by_key(|(_, line)| order.iter().position(|name| *name == line.info.name));
    let p95 = |line: &Line, of| percentile_of(&line.sample(of), P, None);
    let energies = own.iter().filter_map(|(_, line)| p95(line, LineQuantity::Total));
    let (unit, size) = energy_unit_of(energies.map(|at| at.value));
    let mut rows = Vec::new();
    for (_, line) in &own {
        let reach = of_share(&line.reach(releases));
        let residual = results.summary.residual.iter().find(|at| at.line == line.info.name);
        let residual = residual.filter(|at| !at.behind.is_empty());
        let name = match residual {
            Some(_) => fill(words.line_without, &[("name", &line.info.name)]),
            None => line.info.name.clone(),
        };
        let cells = vec![
            Some(percent(reach)),
            p95(line, LineQuantity::Speed),
            p95(line, LineQuantity::Total).map(|at| at.over(size)),
            p95(line, LineQuantity::Height).map(Estimate::above_a_mm),
            p95(line, LineQuantity::HeightNormal).map(Estimate::above_a_mm),
        ];
        rows.push((name, cells));
        rows.extend(residual.map(|at| behind(at, words, size)));
        rows.extend(silent(line, results, words));
    }
    let needs = results.hazard.weights().map_or("", |_| words.year().weighed_needs);
    let columns = [
        words.col_reach.to_owned(),
        words.col_speed.to_owned(),
        fill(words.col_energy, &[("unit", &unit)]),
        words.col_height_vertical.to_owned(),
        words.col_height_normal.to_owned(),
    ];
    (!rows.is_empty()).then(|| EstimateTable {
        about: About::Lines,
        title: words.arrives_title.to_owned(),
        note: words.arrives_note.to_owned() + needs,
        columns: columns.into(),
        rows,
        ..EstimateTable::default()
    })
}

/// A row for each class of which no rock comes to a line: its share is 0 of so many, and the other numbers know nothing of it.
fn silent(line: &Line, results: &Results, words: &Words) -> Vec<(String, Vec<Option<Estimate>>)> {
    let row = |classes: SilentClasses| {
        let volumes = classes.volume_m3.map_or(String::new(), |[low, high]| {
            let [low, high] = [low, high].map(|volume| significant(volume, 2));
            if low == high { format!(", {low} m³") } else { format!(", {low}–{high} m³") }
        });
        let (name, n, source) = (&line.info.name, classes.reach.of, classes.source);
        let name = words.say(&format!("{name}: 0 of {n} rocks of {source}{volumes}"));
        (name, vec![Some(percent(of_share(&classes.reach))), None, None, None, None])
    };
    let silent = line.silent(results.summary.asked.frequency.as_ref());
    silent.into_iter().map(row).collect()
}

fn behind(at: &Residual, words: &Words, size: f64) -> (String, Vec<Option<Estimate>>) {
    let barriers = at.behind.join(", ");
    let name = if at.behind.len() > 1 && barriers.chars().count() > LONGEST {
        format!("{}{}", at.line, words.and_with)
    } else {
        fill(words.line_with, &[("name", &at.line), ("barriers", &barriers)])
    };
    let cells = vec![
        Some(percent(of_share(&at.with.reach))),
        None,
        of(&at.with.energy_j).map(|at| at.over(size)),
        of(&at.with.height_m).map(Estimate::above_a_mm),
        None,
    ];
    (name, cells)
}

fn barriers(results: &Results, words: &Words) -> Option<EstimateTable> {
    let all = &results.summary.barriers;
    let design = |one: &BarrierSummary| one.design_values.as_ref().map(|design| design.energy_j);
    let energies = all.iter().flat_map(|one| [of(&one.energy_j).map(|at| at.value), design(one)]);
    let (unit, size) = energy_unit_of(energies.flatten());
    let row = |one: &BarrierSummary| {
        let barrier = &one.barrier;
        let name =
            format!("{} ({})", barrier.name, site::size(barrier.height_m, barrier.capacity_j));
        // of rocks that weigh differently: what is not stopped
        let passing = if results.hazard.weights().is_some() {
            let stopped = of_share(&one.stopped);
            Estimate::new(1.0 - stopped.value, 1.0 - stopped.high, 1.0 - stopped.low)
        } else {
            of_share(&crate::hazard::Proportion::new(one.over + one.through, one.arriving.count))
        };
        let some = |share| (one.arriving.count > 0).then_some(share);
        let cells = vec![
            Some(percent(of_share(&one.arriving))),
            some(percent(passing)),
            of(&one.energy_j).map(|at| at.over(size)),
            of(&one.top_m),
            of_rule(one).map(|design| design.energy_j.over(size)),
            of_rule(one).map(|design| design.height_m),
        ];
        (name, cells)
    };
    let columns = [
        words.col_arriving_of.to_owned(),
        words.col_passing.to_owned(),
        fill(words.col_energy, &[("unit", &unit)]),
        words.col_top.to_owned(),
        fill(words.col_design_energy, &[("unit", &unit)]),
        words.col_design_height.to_owned(),
    ];
    let has_design = has_design(all);
    let told =
        |text: &str, of_design: &str| text.to_owned() + if has_design { of_design } else { "" };
    let table = EstimateTable {
        about: About::Barriers,
        title: told(words.barriers_head_title, words.barriers_head_design),
        note: told(words.barriers_head_note, words.barriers_head_note_design),
        columns: columns.into(),
        rows: all.iter().map(row).collect(),
        ..EstimateTable::default()
    };
    (!all.is_empty()).then(|| with_design_if_any(table, all))
}

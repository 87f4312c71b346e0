//! What barriers stop and what their rule asks for, from the summary.

use super::super::input::{Estimate, Table};
use super::estimate;
use crate::hazard::{BarrierSummary, Proportion, Rule};
use crate::output::Results;
use std::collections::BTreeMap;

/// One table over all barriers, and one of sensitivity.
pub(super) fn tables(results: &Results) -> Vec<Table> {
    let barriers = &results.summary.barriers;
    if barriers.is_empty() {
        return Vec::new();
    }
    vec![counts(barriers), sensitivity(barriers)]
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

fn cells(one: &BarrierSummary) -> Vec<Option<Estimate>> {
    let plain = |value: f64| Some(estimate(value, None, None));
    let percent = |share: &Proportion| {
        let [value, low, high] = [share.share, share.low_95, share.high_95].map(|x| 100.0 * x);
        Some(estimate(value, Some(low), Some(high)))
    };
    let design = one.design_values.as_ref();
    vec![
        plain(one.barrier.height_m),
        plain(one.barrier.capacity_j / 1e3),
        plain(one.arriving.count as f64),
        percent(&one.arriving),
        percent(&one.stopped),
        plain(one.over as f64),
        plain(one.through as f64),
        design.and_then(|design| plain(design.height_m)),
        design.and_then(|design| plain(design.energy_j / 1e3)),
    ]
}

/// The rule of a barrier with its factors one by one.
fn in_words(one: &BarrierSummary) -> Option<String> {
    let rule: &Rule = one.barrier.design.as_ref()?;
    let design = one.design_values.as_ref()?;
    let factors = |what: &str, list: &BTreeMap<String, f64>| {
        let each: Vec<String> =
            list.iter().map(|(name, factor)| format!("{name} {factor}")).collect();
        if each.is_empty() {
            format!("no factor on {what}")
        } else {
            format!("on {what}: {}", each.join(", "))
        }
    };
    Some(format!(
        "Design of “{}”: P{} of energy {:.1} kJ and of the highest point {:.2} m; {}; {}; {}; free height {} m.",
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

fn sensitivity(barriers: &[BarrierSummary]) -> Table {
    let columns = barriers[0].by_height.iter().map(|(height_m, _)| {
        let share = height_m / barriers[0].barrier.height_m;
        format!("{:.0} % of its height", 100.0 * share)
    });
    let row = |one: &BarrierSummary| {
        let cells =
            one.by_height.iter().map(|(_, share)| Some(estimate(100.0 * share, None, None)));
        (format!("{}: stopped (%)", one.barrier.name), cells.collect())
    };
    Table {
        title: "Barriers of other height".to_owned(),
        note: "Share of the same arriving rocks that a barrier of that height and equal capacity would stop.".to_owned(),
        columns: columns.collect(),
        rows: barriers.iter().map(row).collect(),
    }
}

//! The first tables of the page: what arrives at each line, and at each barrier.

use super::super::format;
use super::super::model::{About, Estimate, Quantity, Table};
use super::lines::{of_share, shown};
use super::{of_percentile, percentile_of};
use crate::hazard::{BarrierSummary, LineQuantity, Residual, Statistic};
use crate::output::Results;

/// The percentile of the headline (–).
const P: f64 = 0.95;

/// One table over the lines in this order, one over the barriers; each where there are some.
pub(super) fn tables(results: &Results, order: &[String]) -> Vec<Table> {
    [lines(results, order), barriers(results)].into_iter().flatten().collect()
}

fn of(statistic: &Statistic) -> Option<Estimate> {
    Some(of_percentile(statistic.percentiles.get("p95")?, (statistic.rocks, None)))
}

/// A unit of energy for a whole table.
fn energy_unit(estimates: impl Iterator<Item = f64>) -> (&'static str, f64) {
    Quantity::Total.unit(estimates.filter(|value| value.is_finite()).fold(0.0, f64::max))
}

fn percent(share: Estimate) -> Estimate {
    share.over(0.01)
}

fn lines(results: &Results, order: &[String]) -> Option<Table> {
    let releases = results.hazard.rocks();
    let is_barrier =
        |name: &str| results.summary.barriers.iter().any(|one| one.barrier.name == name);
    let mut own: Vec<_> = shown(results).filter(|(_, line)| !is_barrier(&line.info.name)).collect();
    own.sort_by_key(|(_, line)| order.iter().position(|name| *name == line.info.name));
    let p95 = |line: &crate::hazard::Line, of| percentile_of(&line.sample(of), P, None);
    let energies = own.iter().filter_map(|(_, line)| p95(line, LineQuantity::Total));
    let (unit, size) = energy_unit(energies.map(|at| at.value));
    let mut rows = Vec::new();
    for (_, line) in &own {
        let reach = of_share(&line.reach(releases));
        let residual = results.summary.residual.iter().find(|at| at.line == line.info.name);
        let residual = residual.filter(|at| !at.behind.is_empty());
        let name = match residual {
            Some(_) => format!("{}, without barriers", line.info.name),
            None => line.info.name.clone(),
        };
        let cells = vec![
            Some(percent(reach)),
            p95(line, LineQuantity::Speed),
            p95(line, LineQuantity::Total).map(|at| at.over(size)),
            p95(line, LineQuantity::Height),
            p95(line, LineQuantity::HeightNormal),
        ];
        rows.push((name, cells));
        rows.extend(residual.map(|at| behind(at, size)));
    }
    let columns = [
        "reach (% of releases)".to_owned(),
        "speed P95 (m/s)".to_owned(),
        format!("total energy P95 ({unit})"),
        "height P95, vertical (m)".to_owned(),
        "height P95, normal (m)".to_owned(),
    ];
    (!rows.is_empty()).then(|| Table {
        about: About::Lines,
        title: "What arrives at each line".to_owned(),
        note: "Small figures: 95 % intervals of chance in the sample. P95 needs 59 rocks that cross; where fewer do, the number \
               missing stands in its place. With barriers: without the rocks that a barrier stops before the line; what gets \
               through one keeps its energy."
            .to_owned(),
        columns: columns.into(),
        rows,
    })
}

fn behind(at: &Residual, size: f64) -> (String, Vec<Option<Estimate>>) {
    let name = format!("{}, with {}", at.line, at.behind.join(", "));
    let cells = vec![
        Some(percent(of_share(&at.with.reach))),
        None,
        of(&at.with.energy_j).map(|at| at.over(size)),
        of(&at.with.height_m),
        None,
    ];
    (name, cells)
}

fn barriers(results: &Results) -> Option<Table> {
    let all = &results.summary.barriers;
    let design = |one: &BarrierSummary| one.design_values.as_ref().map(|design| design.energy_j);
    let energies = all.iter().flat_map(|one| {
        [of(&one.energy_j).map(|at| at.value), design(one), Some(one.barrier.capacity_j)]
    });
    let (unit, size) = energy_unit(energies.flatten());
    let row = |one: &BarrierSummary| {
        let barrier = &one.barrier;
        let name = format!(
            "{} ({} m, {} {unit})",
            barrier.name,
            format::plain(barrier.height_m),
            format::significant(barrier.capacity_j / size, 3)
        );
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
            super::barriers::design(one).map(|design| design.energy_j.over(size)),
            super::barriers::design(one).map(|design| design.height_m),
        ];
        (name, cells)
    };
    let columns = [
        "arriving (% of releases)".to_owned(),
        "of these pass it (%)".to_owned(),
        format!("total energy P95 ({unit})"),
        "highest point P95 (m)".to_owned(),
        format!("design energy ({unit})"),
        "design height (m)".to_owned(),
    ];
    (!all.is_empty()).then(|| Table {
        about: About::Barriers,
        title: "What each barrier meets, and what its design needs".to_owned(),
        note: "Rocks stopped by a barrier before are left out. Design values are the percentile of the rule with all its factors; \
               their intervals are those of the percentile."
            .to_owned(),
        columns: columns.into(),
        rows: all.iter().map(row).collect(),
    })
}

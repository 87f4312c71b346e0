//! What rocks of each shape did.

use super::super::model::{About, Estimate, EstimateTable, ReportQuantity};
use super::super::words::{Words, fill};
use super::percentile_of;
use crate::body::ShapeKind;
use crate::error::Result;
use crate::hazard::{Quantity, Row, RowBounds, Sample};
use crate::output::Results;
use std::collections::BTreeMap;

/// What of every kind of shape is told, and at which percentile (–).
const TOLD: [(Quantity, f64); 4] = [
    (Quantity::Runout, 0.5),
    (Quantity::Runout, 0.95),
    (Quantity::MaxSpeed, 0.95),
    (Quantity::MaxTotal, 0.95),
];

/// Rocks of one kind, each with what it weighs.
type Weighed = Vec<(f64, Row, RowBounds)>;

/// Rocks by the kind of their shape, in the order of scenes; empty where all are spheres of old.
fn by_kind(results: &Results) -> Result<BTreeMap<ShapeKind, Weighed>> {
    let weights = results.hazard.weights();
    let mut kinds: BTreeMap<ShapeKind, Weighed> = BTreeMap::new();
    for row in results.rows()? {
        let row = row?;
        let Some(shape) = row.shape else { return Ok(kinds) };
        let weighs = weights.as_ref().map_or(1.0, |all| all.of_release(row.index));
        let bounds = RowBounds::of(&row, results.summary.site.floor);
        kinds.entry(shape.kind).or_default().push((weighs, row, bounds));
    }
    Ok(kinds)
}

/// The kinds of shapes by name, and a row for each; nothing of spheres alone.
pub(super) fn told(
    results: &Results,
    words: &Words,
) -> Result<(Vec<&'static str>, Option<EstimateTable>)> {
    let kinds = by_kind(results)?;
    let names = kinds.keys().map(|kind| words.shapes().name(*kind)).collect();
    Ok((names, (!kinds.is_empty()).then(|| table(&kinds, words))))
}

fn table(kinds: &BTreeMap<ShapeKind, Weighed>, words: &Words) -> EstimateTable {
    let own = words.shapes();
    let cells = |rocks: &Weighed| TOLD.map(|(quantity, p)| estimate(rocks, quantity, p));
    let mut rows: Vec<(&str, usize, [Option<Estimate>; 4])> =
        kinds.iter().map(|(kind, rocks)| (own.name(*kind), rocks.len(), cells(rocks))).collect();
    let energies = rows.iter().filter_map(|(.., cells)| cells[3].map(|at| at.value));
    let (unit, size) =
        ReportQuantity::Total.unit(energies.filter(|value| value.is_finite()).fold(0.0, f64::max));
    for (.., cells) in &mut rows {
        cells[3] = cells[3].map(|at| at.over(size));
    }
    let columns = [
        own.col_rocks.to_owned(),
        own.col_median.to_owned(),
        own.col_farthest.to_owned(),
        own.col_speed.to_owned(),
        fill(own.col_energy, &[("unit", &unit)]),
    ];
    let row = |(name, count, cells): (&str, usize, [Option<Estimate>; 4])| {
        let count = Some(Estimate::plain(count as f64));
        (name.to_owned(), [count].into_iter().chain(cells).collect())
    };
    EstimateTable {
        about: About::Shapes,
        title: own.table_title.to_owned(),
        note: own.table_note.to_owned(),
        columns: columns.into(),
        rows: rows.into_iter().map(row).collect(),
        ..EstimateTable::default()
    }
}

fn estimate(rocks: &Weighed, quantity: Quantity, p: f64) -> Option<Estimate> {
    let counted = rocks.iter().filter(|(_, row, _)| row.stop.is_released());
    let values =
        counted.map(|(weighs, row, bounds)| (quantity.of(row), *weighs, bounds.has(quantity)));
    percentile_of(&Sample::censored(values, quantity.open()), p, Some(quantity.open()))
}

//! `frequency.csv`: how often a year which energy is passed, at every line and object.

use super::table::CsvTable;
use crate::error::Result;
use crate::hazard::{Annual, AnnualFigures, AnnualPlace, ExceedancePoint};
use serde::Serialize;
use std::path::Path;

/// Name of the file.
pub(super) const FREQUENCY: &str = "frequency.csv";

/// A point of a curve.
#[derive(Serialize)]
struct CurveRow<'a> {
    place: &'a str,
    barriers: &'a str,
    energy_j: f64,
    per_year: f64,
    low_95: f64,
    high_95: f64,
}

/// Columns of the file; all numbers are a year, none is conditional on release.
const COLUMNS: [&str; 6] = [
    "place",
    "barriers",
    "energy_j",
    "frequency_per_year",
    "frequency_low_95_per_year",
    "frequency_high_95_per_year",
];

/// Writes all curves, by rising energy.
pub(super) fn write(dir: &Path, annual: &Annual) -> Result<()> {
    let mut table = CsvTable::create(dir.join(FREQUENCY), &COLUMNS)?;
    for AnnualPlace { name, without_barriers, with_barriers, .. } in &annual.places {
        let with = with_barriers.iter().map(|figures| ("with", figures));
        for (barriers, figures) in [("without", without_barriers)].into_iter().chain(with) {
            let AnnualFigures { curve, .. } = figures;
            for point in curve.iter().rev() {
                let ExceedancePoint { energy_j, per_year, low_95, high_95, .. } = *point;
                let place = name.as_str();
                table.write(&CurveRow { place, barriers, energy_j, per_year, low_95, high_95 })?;
            }
        }
    }
    table.sync().map(|_| ())
}

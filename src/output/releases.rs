//! Rows of `releases.csv`: the rock, and what it stands for where a scene has several classes of size or sources.

use super::{Output, RELEASES, RunInfo, table};
use crate::error::Result;
use crate::frequency::Frequency;
use crate::hazard::Row;
use crate::simulation::{RockShape, Trajectory};
use serde::Serialize;
use std::path::Path;

/// Columns that follow all others where rocks stand for several classes.
pub(super) const CLASS_COLUMNS: [&str; 4] =
    ["source", "class_from_m3", "class_to_m3", "class_per_year"];

/// The class that a rock was drawn for.
#[derive(Debug, Clone, Copy, Serialize)]
struct ClassCells<'a> {
    source: &'a str,
    /// Smallest and largest volume (m³); none where the scene's rocks say how large they are.
    from_m3: Option<f64>,
    to_m3: Option<f64>,
    /// Events a year that all released rocks of the class share (1/year).
    per_year: f64,
}

impl<'a> ClassCells<'a> {
    fn of(frequency: &'a Frequency, release: usize) -> Self {
        let class = frequency.stratum(release);
        let [from_m3, to_m3] = [0, 1].map(|end| class.volume_m3.map(|volumes| volumes[end]));
        let source = &frequency.sources()[class.source].name;
        Self { source, from_m3, to_m3, per_year: class.per_year }
    }
}

/// The columns of a run's table; one that goes on keeps those that it has.
pub(super) fn columns(dir: &Path, info: &RunInfo, goes_on: bool) -> Result<Vec<&'static str>> {
    let mut columns = Row::COLUMNS.to_vec();
    if info.has_blocks {
        columns.extend(Row::SHAPE_COLUMNS);
    }
    if info.has_scars {
        columns.extend(Row::SOIL_COLUMNS);
    }
    let classes = info.asked.frequency.as_ref().map_or(0, |frequency| frequency.strata().len());
    let tells_class = if goes_on {
        table::has_columns(&dir.join(RELEASES), &CLASS_COLUMNS)?
    } else {
        classes > 1
    };
    if tells_class {
        columns.extend(CLASS_COLUMNS);
    }
    Ok(columns)
}

impl Output {
    /// The row of a journey, which is written.
    pub(super) fn write_release(&mut self, fall: &Trajectory) -> Result<Row> {
        let mut row = Row::of(fall, self.info.origin_m);
        if self.info.has_blocks {
            row.shape.get_or_insert(RockShape::SPHERE);
        }
        row.soil_j = self.info.has_scars.then_some(fall.ledger.soil_j);
        match self.info.asked.frequency.as_ref().filter(|_| self.tells_class) {
            Some(frequency) => {
                self.releases.write(&(&row, ClassCells::of(frequency, row.index)))?;
            }
            None => self.releases.write(&row)?,
        }
        Ok(row)
    }
}

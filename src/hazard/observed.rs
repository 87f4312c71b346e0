//! Measured ends of rocks beside computed ones.

mod agreement;
mod apart;
mod distance;
mod placement;
mod spread;

pub use agreement::Agreement;
pub use apart::EndDistances;
pub use distance::{KOLMOGOROV_95, RunoutDistances, ks_limit, runouts};
pub use placement::OpenEnds;
pub use spread::{EndSpread, effective, mean_95, rank};

use super::row::{Row, StopKind};
use crate::count::counted;
use crate::error::{Error, Result};
use crate::file::{self, LONGEST_TEXT};
use crate::gis::FARTHEST_M;
use crate::math;
use crate::scene::MeasuredEnds;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A rock's way in plan view, measured or computed (map coordinates).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ObservedPath {
    /// Where it was released (m).
    pub start_m: [f64; 2],
    /// Where it ended, or was last seen (m).
    pub end_m: [f64; 2],
    /// How a computed rock was last seen that would have gone on: its runout is at least what was seen, and where it would have ended is not known.
    #[serde(skip)]
    pub open: Option<StopKind>,
}

/// A way and what it weighs (–).
pub type Weighted = (ObservedPath, f64);

/// Columns that a file of measured ends must have; it may have more.
#[derive(Debug, Deserialize)]
#[expect(clippy::struct_field_names, reason = "the names are those of the columns")]
struct Measured {
    release_x_m: f64,
    release_y_m: f64,
    x_m: f64,
    y_m: f64,
}

impl ObservedPath {
    /// Horizontal distance from release to end (m).
    pub fn runout_m(&self) -> f64 {
        let [x, y] = self.vector_m();
        math::hypot(x, y)
    }

    fn vector_m(&self) -> [f64; 2] {
        [self.end_m[0] - self.start_m[0], self.end_m[1] - self.start_m[1]]
    }

    /// Whether its runout is at least so long (m); none is as short as can be.
    pub fn ran(&self, least_runout_m: Option<f64>) -> bool {
        least_runout_m.is_none_or(|least_m| self.runout_m() >= least_m)
    }

    /// The way of a computed rock; one that failed has no end to compare.
    pub fn of(row: &Row) -> Option<Self> {
        let flat = |[x, y, _]: [f64; 3]| [x, y];
        let has_end = row.stop.is_released() && row.stop != StopKind::Failed;
        let open = row.stop.is_open().then_some(row.stop);
        has_end.then(|| Self { start_m: flat(row.start_m), end_m: flat(row.end_m), open })
    }

    /// Reads measured ways from a CSV file with the columns `release_x_m`, `release_y_m`, `x_m`, `y_m`.
    ///
    /// # Errors
    /// A file that cannot be read, a row without these numbers, or an end nearer to its release than any computed one may be.
    pub fn read(ends: &MeasuredEnds) -> Result<Vec<Self>> {
        Ok(Self::read_lines(ends)?.into_iter().map(|(_, way)| way).collect())
    }

    /// The same, each with its line in the file.
    ///
    /// # Errors
    /// As for [`ObservedPath::read`].
    pub fn read_lines(ends: &MeasuredEnds) -> Result<Vec<(u64, Self)>> {
        let path = ends.file.as_path();
        let table = file::read_table(path, LONGEST_TEXT)?;
        let mut reader = file::table_reader(&table);
        let headers = reader.headers().cloned().unwrap_or_default();
        let way = |row: csv::Result<csv::StringRecord>| {
            let line_of = |position: Option<&csv::Position>| file::line_of(&table, position);
            let row = row.map_err(|why| (line_of(why.position()), why.to_string()))?;
            let line = line_of(row.position());
            let measured = row.deserialize(Some(&headers)).map_err(|why| (line, why.to_string()));
            let way = measured.map(|row: Measured| Self {
                start_m: [row.release_x_m, row.release_y_m],
                end_m: [row.x_m, row.y_m],
                open: None,
            })?;
            // a number that is none, or no place, would go into every mean
            let far = way
                .start_m
                .iter()
                .chain(&way.end_m)
                .find(|m| !(-FARTHEST_M..=FARTHEST_M).contains(*m));
            far.map_or(Ok((line, way)), |m| Err((line, format!("found {m:?}"))))
        };
        let ways: std::result::Result<Vec<(u64, Self)>, (u64, String)> =
            reader.records().map(way).collect();
        let ways = ways.map_err(|(line, found)| {
            let remedy = "write numbers in the columns release_x_m, release_y_m, x_m, y_m, map coordinates within 1e8 m";
            Error::input(path, format!("line {line}"), found, file::table_remedy(&table, remedy))
        })?;
        if ways.len() < 2 {
            let ends = counted(ways.len(), "end", "ends");
            let found = format!("found {} measured {ends}", ways.len());
            return Err(Error::input(path, "rows", found, "write at least two"));
        }
        if let Some((line, way)) = ways.iter().find(|(_, way)| !way.ran(ends.least_runout_m)) {
            let found = format!("found an end {:.2} m from its release", way.runout_m());
            let remedy = "write a smaller least_runout_m in [calibrate], which is for lists without such ends";
            return Err(Error::input(path, format!("line {line}"), found, remedy));
        }
        Ok(ways)
    }
}

/// The column that tells which throws are of one block.
#[derive(Debug, Deserialize)]
struct BlockColumn {
    #[serde(alias = "block_id")]
    block: String,
}

impl ObservedPath {
    /// The block of each measured end, from the column `block` or `block_id`; empty where there is none.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read_blocks(path: &Path) -> Result<Vec<String>> {
        let table = file::read_table(path, LONGEST_TEXT)?;
        let rows = file::table_reader(&table).into_deserialize();
        let blocks = rows.map(|row: csv::Result<BlockColumn>| row.ok().map(|thrown| thrown.block));
        Ok(blocks.collect::<Option<_>>().unwrap_or_default())
    }
}

/// Unit vector of the mean way.
fn mean_direction(ways: &[ObservedPath]) -> [f64; 2] {
    let sum =
        ways.iter().map(ObservedPath::vector_m).fold([0.0, 0.0], |s, v| [s[0] + v[0], s[1] + v[1]]);
    let length = math::hypot(sum[0], sum[1]).max(f64::MIN_POSITIVE);
    [sum[0] / length, sum[1] / length]
}

//! Tables and maps of a run, opened anew or where it was interrupted.

use super::progress::{PROGRESS, Progress};
use super::table::CsvTable;
use super::{RunInfo, maps};
use crate::error::{Error, Result};
use crate::hazard::{MapState, Maps};
use std::path::Path;

/// The maps so far; none when they are not asked for or complete.
pub(super) fn open_maps(
    dir: &Path,
    info: &RunInfo,
    found: Option<&Progress>,
) -> Result<Option<Maps>> {
    let Some(frame) = info.maps else { return Ok(None) };
    let state = match found {
        None => MapState::default(),
        Some(found)
            if found.done == found.identity.releases && !maps::has_state(dir, found.done) =>
        {
            return Ok(None);
        }
        Some(found) => maps::read_state(dir, found)?,
    };
    Ok(Some(Maps::new(frame, &info.asked.counted_j(), state)))
}

/// Opens one table: new, or behind the rows that are known to be good.
pub(super) fn open(
    dir: &Path,
    name: &str,
    columns: &[&str],
    found: Option<&Progress>,
) -> Result<CsvTable> {
    let path = dir.join(name);
    let Some(found) = found else { return CsvTable::create(path, columns) };
    match found.bytes.get(name) {
        Some(&bytes) => CsvTable::go_on(path, bytes, found.sums.get(name).copied()),
        None => Err(Error::input(
            &dir.join(PROGRESS),
            "bytes",
            format!("no length of {name}"),
            super::checksum::RESTORE,
        )),
    }
}

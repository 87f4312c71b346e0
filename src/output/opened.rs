//! Tables and maps of a run, opened anew or where it was interrupted.

use super::progress::{PROGRESS, Progress};
use super::table::CsvTable;
use super::{RunInfo, maps};
use crate::error::{Error, Result};
use crate::hazard::{MapState, Maps};
use std::collections::BTreeMap;
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
        Some(found) => maps::read_state(dir, found.done)?,
    };
    Ok(Some(Maps::new(frame, &info.asked.counted_j(), state)))
}

/// Opens one table: new, or behind the rows that are known to be good.
pub(super) fn open(
    dir: &Path,
    name: &str,
    columns: &[&str],
    bytes: Option<&BTreeMap<String, u64>>,
) -> Result<CsvTable> {
    let path = dir.join(name);
    match bytes.map(|bytes| bytes.get(name)) {
        None => CsvTable::create(path, columns),
        Some(Some(&bytes)) => CsvTable::go_on(path, bytes),
        Some(None) => Err(Error::input(
            &dir.join(PROGRESS),
            "bytes",
            format!("no length of {name}"),
            super::atomic_file::RESTORE,
        )),
    }
}

//! How far a run has come, said on the disk: the rows first, then that they are there.

use super::checksum::{self, FileSums};
use super::progress::Progress;
use super::table::CsvTable;
use super::{CROSSINGS, IMPACTS, Output, PATHS, RELEASES, maps, read, removal};
use crate::error::Result;
use std::collections::BTreeMap;
use std::path::Path;

/// What a run goes on from; files of one that was finished must be as it left them.
///
/// # Errors
/// If they are not.
pub(super) fn unchanged(dir: &Path, found: Option<Progress>) -> Result<Option<Progress>> {
    let finished = found.as_ref().map(|found| &found.finished).filter(|files| !files.is_empty());
    finished.map_or(Ok(()), |files| read::check_files(dir, files))?;
    Ok(found)
}

impl Output {
    /// The tables that are written, with their names.
    pub(super) fn tables(&mut self) -> impl Iterator<Item = (&'static str, &mut CsvTable)> {
        let Self { releases, paths, impacts, crossings, .. } = self;
        let kept = [(PATHS, paths), (IMPACTS, impacts), (CROSSINGS, crossings)].into_iter();
        let kept = kept.filter_map(|(name, table)| Some((name, table.as_mut()?)));
        std::iter::once((RELEASES, releases)).chain(kept)
    }

    /// Puts all rows on the disk; lengths (bytes) and checksums of the tables.
    pub(super) fn ends(&mut self) -> Result<(BTreeMap<String, u64>, FileSums)> {
        let (mut bytes, mut sums) = (BTreeMap::new(), FileSums::new());
        for (name, table) in self.tables() {
            bytes.insert(name.to_owned(), table.sync()?);
            sums.insert(name.to_owned(), table.sum());
        }
        Ok((bytes, sums))
    }

    /// Puts all rows on the disk, and then says that they are there.
    pub(super) fn mark(&mut self) -> Result<()> {
        let (bytes, mut sums) = self.ends()?;
        let done = self.hazard.rocks();
        if let Some(maps) = &self.maps {
            maps::write_state(&self.dir, (maps, done), &mut sums)?;
        }
        let progress = Progress {
            title: self.info.title.clone(),
            identity: self.info.identity.clone(),
            done,
            bytes,
            sums,
            totals: self.hazard.totals.clone(),
            seconds: self.seconds(),
            finished: BTreeMap::new(),
        };
        progress.write(&self.dir)?;
        // The state before is of use until the progress says otherwise.
        self.maps.as_ref().map_or(Ok(()), |_| maps::keep_state(&self.dir, Some(done)))?;
        // finished results that are gone on with are not what they were
        removal::remove(&self.dir.join(checksum::SUMS))
    }

    pub(super) fn seconds(&self) -> f64 {
        self.seconds_before + self.begun.elapsed().as_secs_f64()
    }
}

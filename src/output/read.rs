//! Results read back: what figures and pages are drawn from.

use super::progress::{Identity, PROGRESS};
use super::rows::{ImpactRow, PathRow};
use super::summary::{SUMMARY, Summary};
use super::vector;
use super::{CROSSINGS, IMPACTS, PATHS, RELEASES, table};
use crate::error::{Error, Result};
use crate::hazard::{CrossingRow, Hazard, Line, LineInfo, Row, Totals};
use std::path::{Path, PathBuf};

/// The complete results in a folder.
#[derive(Debug)]
pub struct Results {
    /// The folder.
    pub dir: PathBuf,
    /// Its `summary.json`.
    pub summary: Summary,
    /// All rocks together, from `releases.csv` and the totals of the summary.
    pub hazard: Hazard,
    /// All first crossings line by line, from `crossings.csv`.
    pub lines: Vec<Line>,
}

/// Reads the results in `dir`.
///
/// # Errors
///
/// If the folder holds no results, or those of a run that is not finished, or if `releases.csv` or `summary.json`
/// is not as it was written.
pub fn read(dir: &Path) -> Result<Results> {
    let Some(summary) = Summary::read(dir)? else {
        let why = if dir.join(PROGRESS).exists() {
            "holds a run that is not finished: go on with `rockfall run SCENE --resume`"
        } else {
            "holds no results: there is no summary.json; write some with `rockfall run SCENE --out DIR`"
        };
        return Err(Error::Request(format!("{}: {why}", dir.display())));
    };
    let hazard = recall(dir, &summary.identity, summary.identity.releases, summary.totals.clone())?;
    let infos: Vec<LineInfo> = summary.lines.iter().map(|line| line.info.clone()).collect();
    let lines = recall_lines(dir, &infos, true)?;
    Ok(Results { dir: dir.to_owned(), summary, hazard, lines })
}

impl Results {
    /// The rows of `releases.csv`, one by one.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or has other columns; each row says for itself if it cannot be understood.
    pub fn rows(&self) -> Result<impl Iterator<Item = Result<Row>>> {
        releases(&self.dir)
    }

    /// The rows of `paths.csv`, one by one, in the order of releases and of time; none if no path was kept.
    ///
    /// # Errors
    ///
    /// As [`Self::rows`].
    pub fn paths(&self) -> Result<impl Iterator<Item = Result<PathRow>>> {
        if_there(self.dir.join(PATHS), &PathRow::COLUMNS)
    }

    /// Writes `maps/ends.geojson`, and `maps/paths.geojson` and `maps/paths.vtk` where paths were kept.
    pub(super) fn write_vectors(&self) -> Result<()> {
        let (folder, epsg) =
            (self.dir.join(super::maps::FOLDER), self.summary.maps.and_then(|maps| maps.epsg));
        vector::write_ends(&folder.join("ends.geojson"), epsg, self.rows()?)?;
        if self.dir.join(PATHS).exists() {
            vector::write_paths(&folder.join("paths.geojson"), epsg, self.paths()?)?;
            vector::write_vtk(&folder.join("paths.vtk"), self.summary.origin_m, self.paths()?)?;
        }
        Ok(())
    }

    /// The rows of `crossings.csv`, one by one, in the order of releases and of lines; none without lines.
    ///
    /// # Errors
    ///
    /// As [`Self::rows`].
    pub fn crossings(&self) -> Result<impl Iterator<Item = Result<CrossingRow>>> {
        crossings(&self.dir)
    }

    /// The rows of `impacts.csv`, one by one, in the order of releases and of time; none if no impact was kept.
    ///
    /// # Errors
    ///
    /// As [`Self::rows`].
    pub fn impacts(&self) -> Result<impl Iterator<Item = Result<ImpactRow<'static>>>> {
        if_there(self.dir.join(IMPACTS), &ImpactRow::COLUMNS)
    }
}

/// The rows of `crossings.csv` in `dir`.
pub(super) fn crossings(dir: &Path) -> Result<impl Iterator<Item = Result<CrossingRow>> + use<>> {
    if_there(dir.join(CROSSINGS), &CrossingRow::COLUMNS)
}

/// The lines with the crossings that are on the disk, if any are there.
pub(super) fn recall_lines(dir: &Path, infos: &[LineInfo], has_rows: bool) -> Result<Vec<Line>> {
    let mut lines: Vec<Line> = infos.iter().cloned().map(Line::new).collect();
    if lines.is_empty() || !has_rows {
        return Ok(lines);
    }
    for row in table::rows::<CrossingRow>(dir.join(CROSSINGS), &CrossingRow::COLUMNS)? {
        let row = row?;
        let Some(line) = lines.iter_mut().find(|line| line.info.name == row.line) else {
            let remedy =
                format!("it must agree with {SUMMARY}: restore it, or run again with --overwrite");
            return Err(Error::input(
                &dir.join(CROSSINGS),
                "rows",
                format!("the line {}", row.line),
                remedy,
            ));
        };
        line.add(&row);
    }
    Ok(lines)
}

/// All rocks of the first `done` rows, which must be the releases asked for, in order, and no more.
pub(super) fn recall(
    dir: &Path,
    identity: &Identity,
    done: usize,
    totals: Totals,
) -> Result<Hazard> {
    let mut hazard = Hazard::with(totals);
    for row in releases(dir)? {
        let row = row?;
        let expected = identity.first_release + hazard.rocks();
        if row.index != expected {
            return Err(broken(
                dir,
                format!("release {} where {expected} should stand", row.index),
            ));
        }
        hazard.add(&row);
    }
    if hazard.rocks() == done {
        Ok(hazard)
    } else {
        Err(broken(dir, format!("{} rows instead of {done}", hazard.rocks())))
    }
}

fn releases(dir: &Path) -> Result<impl Iterator<Item = Result<Row>> + use<>> {
    table::rows(dir.join(RELEASES), &Row::COLUMNS)
}

fn if_there<R: serde::de::DeserializeOwned>(
    path: PathBuf,
    columns: &'static [&'static str],
) -> Result<impl Iterator<Item = Result<R>>> {
    let there = path.exists().then(|| table::rows(path, columns)).transpose()?;
    Ok(there.into_iter().flatten())
}

fn broken(dir: &Path, found: String) -> Error {
    let remedy = format!(
        "it must agree with {SUMMARY} or {PROGRESS}: restore it, or run again with --overwrite"
    );
    Error::input(&dir.join(RELEASES), "rows", found, remedy)
}

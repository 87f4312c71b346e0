//! What a result folder holds already, and whether a run may use it.

use super::annual::FREQUENCY;
use super::atomic_file::final_path;
use super::checksum::{FileSums, SUMS};
use super::lock::FolderLock;
use super::progress::{Identity, PROGRESS, Progress};
use super::removal::{remove, remove_all};
use super::summary::{SUMMARY, Summary};
use super::{CROSSINGS, IMPACTS, PATHS, RELEASES, RunInfo, TABLES, maps};
use crate::count::number_of;
use crate::error::{Error, Result};
use crate::file::{part_of, write_atomic};
use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// What to do with results that the folder holds already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Refuse to touch them: the folder must hold no results.
    Fresh,
    /// Refuse to touch them, as [`Self::Fresh`]; for shards that are being merged, which cannot be resumed.
    Merge,
    /// Go on with an interrupted run; start where there are no results, do nothing where they are complete.
    Resume,
    /// Go on with them, and with more releases than they were computed for.
    Extend,
    /// Replace them.
    Overwrite,
}

/// Result files besides `progress.json`.
const FILES: [&str; 10] = [
    RELEASES,
    PATHS,
    IMPACTS,
    CROSSINGS,
    FREQUENCY,
    "report.html",
    "view.html",
    "view.glb",
    SUMMARY,
    SUMS,
];
/// Folder of the figures.
const FIGURES: &str = "figures";
/// File in it that names those which belong to the results.
const DRAWN: &str = ".drawn";

/// Makes `dir` ready: empty of results (none), or with what a resumed run goes on from. What is made anew the `lock`
/// removes again if nothing comes of it.
pub(super) fn prepare(
    dir: &Path,
    (info, mode): (&RunInfo, Mode),
    lock: &mut FolderLock,
) -> Result<Option<Progress>> {
    let found = look(dir, info, mode)?;
    if found.is_none() {
        // First of all the folder says whose it is: killed at any moment from here on, the run can be resumed.
        Progress::none_of(info).write(dir)?;
        clear(dir)?;
        let maps = dir.join(maps::FOLDER);
        let folder = (!maps.exists()).then(|| maps.clone());
        let files = TABLES.iter().map(|name| dir.join(name));
        let state = std::iter::once(maps::state_path(dir, 0));
        let all = folder.into_iter().chain(state).chain(files).chain([dir.join(PROGRESS)]);
        all.for_each(|path| lock.made(path));
    }
    Ok(found)
}

/// The run to go on with; none when the folder may be emptied. An error when it must not be touched.
pub(super) fn look(dir: &Path, info: &RunInfo, mode: Mode) -> Result<Option<Progress>> {
    let found = claimed(dir, &info.identity, mode)?;
    let goes_on = |found: &Progress| mode == Mode::Extend && found.done < info.identity.releases;
    // A finished run has thrown away what its maps would go on from: its rocks are computed once more, the same.
    let has_all = |found: &Progress| {
        !goes_on(found) || info.maps.is_none() || maps::has_state(dir, found.done)
    };
    Ok(found.filter(has_all))
}

/// Refuses a folder that a run with this identity may not touch, or cannot write; leaves it as it is.
///
/// # Errors
///
/// If it holds results that `mode` does not allow to touch, cannot be written, or is being written by another process.
pub fn check_folder(dir: &Path, identity: &Identity, mode: Mode) -> Result<()> {
    if mode == Mode::Fresh {
        claimed(dir, identity, mode)?;
    }
    check_writable(dir)
}

/// Refuses a folder that cannot be made or written, before hours of work for it; leaves no trace.
///
/// # Errors
///
/// If a file stands in its place, it cannot be written, or another process is writing into it.
pub fn check_writable(dir: &Path) -> Result<()> {
    FolderLock::on(dir).map(drop)
}

/// The run that has a claim on the folder; none when it may be emptied. An error when it must not be touched.
fn claimed(dir: &Path, identity: &Identity, mode: Mode) -> Result<Option<Progress>> {
    if mode == Mode::Overwrite {
        return Ok(None);
    }
    let summary = Summary::read(dir)?;
    let finished = summary.is_some();
    let found = match (Progress::read(dir)?, summary) {
        (Some(progress), _) => progress,
        (None, Some(summary)) => finished_run(dir, summary),
        (None, None) => return unclaimed(dir),
    };
    if found.done == 0 {
        // A run that ended before its first row, by a wrong scene for instance, has no claim on the folder.
        return Ok(None);
    }
    let (title, old) = (&found.title, &found.identity);
    let asked = if mode == Mode::Extend { as_long_as(old, identity) } else { identity.clone() };
    if let Some(difference) = old.asks_otherwise(&asked) {
        return refuse(
            dir,
            &format!("holds other results: {difference} (\"{title}\")"),
            "take another --out or replace them with --overwrite",
        );
    }
    match mode {
        Mode::Resume | Mode::Extend if old.version != identity.version => {
            let both =
                format!("was begun with version {}, this is {}", old.version, identity.version);
            refuse(dir, &both, "go on with that version or start again with --overwrite")
        }
        Mode::Resume | Mode::Extend => Ok(Some(found)),
        _ if finished => refuse(
            dir,
            "holds the finished results of this very run",
            "take another --out or replace them with --overwrite",
        ),
        _ => {
            let how_far = format!(
                "holds {} of {} of an interrupted run",
                found.done,
                number_of(old.releases as u64, "release")
            );
            let remedy = if mode == Mode::Merge {
                "take another --out or replace them with --overwrite"
            } else {
                "go on with --resume or start again with --overwrite"
            };
            refuse(dir, &how_far, remedy)
        }
    }
}

/// What is asked, cut to the releases that are there: a run may be extended, never shortened.
fn as_long_as(old: &Identity, asked: &Identity) -> Identity {
    if old.is_part() || old.releases > asked.releases {
        return asked.clone();
    }
    Identity { releases: old.releases, of_releases: old.of_releases, ..asked.clone() }
}

/// Number of releases that the results in `dir` were asked for last; none where there are no results.
///
/// # Errors
///
/// If a file that should tell cannot be read.
pub fn releases_in(dir: &Path) -> Result<Option<usize>> {
    let identity = match Progress::read(dir)? {
        Some(progress) => Some(progress.identity),
        None => Summary::read(dir)?.map(|summary| summary.identity),
    };
    Ok(identity.map(|identity| identity.releases))
}

/// A finished run seen as one that has nothing left to do.
fn finished_run(dir: &Path, summary: Summary) -> Progress {
    let Summary { title, identity, totals, run, bytes: mut finished, map_bytes, .. } = summary;
    finished.extend(map_bytes);
    let length = |name: &str| Some((name.to_owned(), fs::metadata(dir.join(name)).ok()?.len()));
    let bytes = TABLES.into_iter().filter_map(length).collect();
    let (done, seconds) = (identity.releases, run.seconds);
    let sums = FileSums::new();
    Progress { title, identity, done, bytes, sums, totals, seconds, finished }
}

/// A folder that says nothing of its results must hold none.
fn unclaimed(dir: &Path) -> Result<Option<Progress>> {
    let file = FILES.iter().map(|name| dir.join(name)).find(|path| path.exists());
    let within = |folder: &str, is_result: fn(&Path) -> bool| {
        let entries = fs::read_dir(dir.join(folder)).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).find(|path| is_result(path))
    };
    let result = file
        .or_else(|| within(FIGURES, is_figure))
        .or_else(|| within(maps::FOLDER, maps::is_result));
    let Some(path) = result else { return Ok(None) };
    let name = path.strip_prefix(dir).unwrap_or(&path).display();
    refuse(
        dir,
        &format!("holds {name}, but no {SUMMARY} that says of which scene"),
        "take another --out or replace it with --overwrite",
    )
}

/// Says which figures the results are about to be drawn in: they, and no others in their folder, go with the results.
///
/// # Errors
///
/// If the folder cannot be written.
pub fn announce_figures(dir: &Path, names: &[&str]) -> Result<()> {
    let mut all = drawn(dir)?;
    all.extend(names.iter().map(|name| (*name).to_owned()));
    all.sort();
    all.dedup();
    let figures = dir.join(FIGURES);
    fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
    write_atomic(&figures.join(DRAWN), (all.join("\n") + "\n").as_bytes())
}

/// Names of the figures that have been drawn.
fn drawn(dir: &Path) -> Result<Vec<String>> {
    let path = dir.join(FIGURES).join(DRAWN);
    match fs::read_to_string(&path) {
        Ok(text) => Ok(text.lines().map(str::to_owned).collect()),
        Err(why) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&why.kind()) => {
            Ok(Vec::new())
        }
        Err(why) => Err(Error::file("read", &path)(why)),
    }
}

fn is_figure(path: &Path) -> bool {
    final_path(path).extension().is_some_and(|ending| ending == "svg")
}

fn refuse(dir: &Path, found: &str, remedy: &str) -> Result<Option<Progress>> {
    Err(Error::Request(format!("{}: {found}; {remedy}", dir.display())))
}

/// Removes the results of an earlier run, and no other file: what is drawn must never mix two runs.
fn clear(dir: &Path) -> Result<()> {
    let drawn = drawn(dir)?;
    let figures = dir.join(FIGURES);
    remove_all(&figures, |path| {
        let whole = final_path(path);
        let name = whole.file_name().and_then(OsStr::to_str);
        name.is_some_and(|name| name == DRAWN || drawn.iter().any(|known| known == name))
    })?;
    remove_all(&dir.join(maps::FOLDER), maps::is_result)?;
    FILES.iter().try_for_each(|name| remove(&dir.join(name)))?;
    remove_parts(dir)
}

/// Removes what is left of files that were being written when a run was killed.
pub(super) fn remove_parts(dir: &Path) -> Result<()> {
    FILES.iter().chain([&PROGRESS]).try_for_each(|name| remove(&part_of(&dir.join(name))))
}

//! The parts of a run, computed apart, put together to the bytes of the whole.

use super::progress::Progress;
use super::read;
use super::summary::{SUMMARY, Summary};
use super::{IMPACTS, Mode, Output, PATHS, Results, RunInfo, maps, table};
use crate::error::{Error, Result};
use crate::hazard::Row;
use crate::rock::Vec3;
use std::path::{Path, PathBuf};

/// A finished part of a run.
struct Shard {
    dir: PathBuf,
    progress: Progress,
    summary: Summary,
}

/// Puts the finished parts of a run (`--shard`), in any order, together in the folder `dir`.
///
/// # Errors
///
/// If a folder holds no finished part, if the parts are not of one run, overlap or leave releases out, or if `dir`
/// holds results that `mode` does not allow to touch.
pub fn merge(parts: &[PathBuf], dir: &Path, mode: Mode) -> Result<Results> {
    let mut shards = parts.iter().map(|part| Shard::read(part)).collect::<Result<Vec<_>>>()?;
    shards.sort_by_key(|shard| shard.progress.identity.first_release);
    let Some(first) = shards.first() else {
        return Err(Error::Request("merge: found no folder; write those of all shards".to_owned()));
    };
    check_whole(&shards)?;
    check_apart(&shards, dir)?;
    let mut output = Output::create(first.run_info(&shards)?, dir, mode)?;
    for shard in &shards {
        output.append(shard)?;
    }
    output.finish()
}

impl Shard {
    fn read(dir: &Path) -> Result<Self> {
        let refuse = |found: &str, remedy: &str| {
            Err(Error::Request(format!("{}: {found}; {remedy}", dir.display())))
        };
        match (Progress::read(dir)?, Summary::read(dir)?) {
            (Some(progress), Some(summary)) if progress.is_complete() => {
                read::check_files(dir, &summary.bytes)?;
                Ok(Self { dir: dir.to_owned(), progress, summary })
            }
            (Some(progress), _) => {
                let (done, all) = (progress.done, progress.identity.releases);
                refuse(
                    &format!("{done} of {all} releases of this shard are written"),
                    "go on with the same command and --resume",
                )
            }
            (None, Some(_)) => refuse(
                "holds a whole run, not a part of one",
                "name folders written with `rockfall run SCENE --shard K/N --out DIR`",
            ),
            (None, None) => refuse(
                "holds no results",
                "name folders written with `rockfall run SCENE --shard K/N --out DIR`",
            ),
        }
    }

    /// What the whole run would have said of itself.
    fn run_info(&self, shards: &[Self]) -> Result<RunInfo> {
        let Summary {
            title,
            identity,
            origin_m,
            plan_entries,
            inputs,
            title_block,
            sources,
            language,
            warnings,
            mesh_health,
            lines,
            maps,
            barriers,
            asked,
            observed,
            observed_worth,
            observed_least_runout_m,
            site,
            ..
        } = self.summary.clone();
        let keeps = |table: &str| self.progress.bytes.contains_key(table);
        let of_releases = identity.of_releases;
        let has_blocks = table::has_columns(&self.dir.join(super::RELEASES), &Row::SHAPE_COLUMNS)?;
        let has_scars = table::has_columns(&self.dir.join(super::RELEASES), &Row::SOIL_COLUMNS)?;
        Ok(RunInfo {
            title,
            identity: super::Identity { first_release: 0, releases: of_releases, ..identity },
            origin_m: Vec3::from(origin_m),
            site,
            // rows are copied, and hold the names already
            ground_of_sheet: Vec::new(),
            lines: lines.into_iter().map(|line| line.info).collect(),
            maps,
            // rows are copied, and the profile is joined
            profile_step_m: 0.0,
            barriers: barriers.into_iter().map(|one| one.barrier).collect(),
            asked,
            observed,
            observed_worth,
            observed_least_runout_m,
            keeps_paths: keeps(PATHS),
            keeps_impacts: keeps(IMPACTS),
            has_blocks,
            has_scars,
            is_shard: false,
            threads: shards.iter().map(|shard| shard.summary.run.threads).max().unwrap_or(0),
            plan: plan_entries,
            inputs,
            title_block,
            sources,
            language,
            warnings,
            mesh_health,
        })
    }
}

/// The shards, by their first release, must be of one run and have each of its releases once.
fn check_whole(shards: &[Shard]) -> Result<()> {
    let mut next = 0;
    for shard in shards {
        let (own, first) = (&shard.progress.identity, &shards[0]);
        let refuse = |found: &str, remedy: &str| {
            Err(Error::Request(format!("{}: {found}; {remedy}", shard.dir.display())))
        };
        if let Some(difference) = own.runs_otherwise(&first.progress.identity) {
            let found = format!("{difference}, as in {}", first.dir.display());
            return refuse(&found, "name the shards of one run");
        }
        if own.first_release < next {
            return refuse(
                &format!("holds releases {:?} again", own.first_release..next.min(own.range().end)),
                "name each shard once",
            );
        }
        if own.first_release > next {
            return missing(next..own.first_release);
        }
        next = own.range().end;
    }
    let all = shards.first().map_or(0, |shard| shard.progress.identity.of_releases);
    if next < all { missing(next..all) } else { Ok(()) }
}

fn missing(releases: std::ops::Range<usize>) -> Result<()> {
    Err(Error::Request(format!(
        "merge: releases {releases:?} are in none of the folders; name all shards of the run"
    )))
}

/// A shard must not be overwritten by the whole.
fn check_apart(shards: &[Shard], dir: &Path) -> Result<()> {
    let Ok(target) = dir.canonicalize() else { return Ok(()) };
    let same = |shard: &&Shard| shard.dir.canonicalize().is_ok_and(|dir| dir == target);
    match shards.iter().find(same) {
        None => Ok(()),
        Some(shard) => Err(Error::Request(format!(
            "--out {}: is the folder of a shard; write another one",
            shard.dir.display()
        ))),
    }
}

impl Output {
    /// Writes the rows of a shard, which must begin with the first of [`Self::remaining`].
    fn append(&mut self, shard: &Shard) -> Result<()> {
        let Progress { identity, done, totals, bytes, seconds, .. } = &shard.progress;
        read::recall(&shard.dir, identity, *done, &mut self.hazard)?;
        self.hazard.totals.join(totals);
        self.seconds_before += seconds;
        for (name, table) in self.tables() {
            let Some(&bytes) = bytes.get(name) else {
                return Err(Error::input(
                    &shard.dir.join(SUMMARY),
                    name,
                    "is missing in this shard alone",
                    "run the shard again with --overwrite",
                ));
            };
            table.append(&shard.dir.join(name), bytes)?;
        }
        read::recall_lines(&shard.dir, &mut self.lines, self.year.as_mut())?;
        if let Some(all) = &mut self.maps {
            all.join(maps::read_state(&shard.dir, &shard.progress)?);
        }
        self.mark()
    }
}

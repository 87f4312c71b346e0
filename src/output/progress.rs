//! What tells one run from another, and how far a run has come.

use super::RunInfo;
use super::atomic_file::{read_json, write_json};
use super::checksum::FileSums;
use crate::error::Result;
use crate::hazard::Totals;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// Name of the file that an interrupted run and a part of a run leave, and a finished run removes.
pub(super) const PROGRESS: &str = "progress.json";

/// What decides every byte of the results.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Hash of the scene file and of its meshes.
    pub scene_hash: String,
    /// Version of rockfall, and after the + the fingerprint of its sources.
    pub version: String,
    /// Seed in force (scene or command line).
    pub seed: u64,
    /// Number of the first release; 0 but for a part of a run (`--only`, `--shard`).
    pub first_release: usize,
    /// Number of releases.
    pub releases: usize,
    /// Number of releases of the whole run.
    pub of_releases: usize,
}

impl Identity {
    /// Release numbers asked for.
    pub fn range(&self) -> Range<usize> {
        self.first_release..self.first_release + self.releases
    }

    /// Whether other releases of the same run stand elsewhere.
    pub fn is_part(&self) -> bool {
        self.releases < self.of_releases
    }

    /// What tells the whole run from another; none when they are the same.
    pub(super) fn runs_otherwise(&self, other: &Self) -> Option<String> {
        if self.version != other.version {
            return Some(format!("version {}, not {}", self.version, other.version));
        }
        let whole = |part: &Self| Self { first_release: 0, releases: 0, ..part.clone() };
        whole(self).asks_otherwise(&whole(other))
    }

    /// What the user asked differently; none when only the version may differ.
    pub(super) fn asks_otherwise(&self, other: &Self) -> Option<String> {
        if self.scene_hash != other.scene_hash {
            return Some("another scene".to_owned());
        }
        if self.seed != other.seed {
            return Some(format!("seed {}, not {}", self.seed, other.seed));
        }
        let (mine, others) = (self.range(), other.range());
        if mine != others {
            return Some(format!("releases {mine:?}, not {others:?}"));
        }
        let (mine, others) = (self.of_releases, other.of_releases);
        (mine != others).then(|| format!("releases of {mine}, not of {others}"))
    }
}

/// How far a run has come: all that the next session needs beside the rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Progress {
    pub(super) title: String,
    #[serde(flatten)]
    pub(super) identity: Identity,
    /// Releases whose rows are on the disk.
    pub(super) done: usize,
    /// Length of each table up to there (bytes).
    pub(super) bytes: BTreeMap<String, u64>,
    /// CRC-32 of each of them up to there, and of the maps so far; empty in results of before.
    #[serde(default)]
    pub(super) sums: FileSums,
    pub(super) totals: Totals,
    /// Time spent so far (s).
    pub(super) seconds: f64,
    /// Of a finished run, the lengths of the tables as they were written (bytes).
    #[serde(skip)]
    pub(super) finished: BTreeMap<String, u64>,
}

impl Progress {
    /// A run that begins.
    pub(super) fn none_of(info: &RunInfo) -> Self {
        Self {
            title: info.title.clone(),
            identity: info.identity.clone(),
            done: 0,
            bytes: BTreeMap::new(),
            sums: FileSums::new(),
            totals: Totals::default(),
            seconds: 0.0,
            finished: BTreeMap::new(),
        }
    }

    /// Whether no release is left.
    pub(super) fn is_complete(&self) -> bool {
        self.done == self.identity.releases
    }

    /// Reads what an interrupted run left in `dir`; none if nothing.
    pub(super) fn read(dir: &Path) -> Result<Option<Self>> {
        read_json(&dir.join(PROGRESS))
    }

    /// Replaces the last one in one stroke.
    pub(super) fn write(&self, dir: &Path) -> Result<()> {
        write_json(&dir.join(PROGRESS), self)
    }
}

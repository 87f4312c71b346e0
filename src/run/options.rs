//! What is asked of a run.

use crate::error::{Error, Result};
use crate::output::{self, Identity, Mode};
use crate::plan::VERSION;
use crate::scene::Scene;
use crate::study::target_precision::TargetPrecision;
use std::ops::Range;
use std::path::PathBuf;

/// How a plan is to be run.
#[derive(Debug, Clone)]
pub struct RunOptions {
    /// Folder for results and report; made if it is not there.
    pub out: PathBuf,
    /// What to do with results that it holds already.
    pub existing: Mode,
    /// Which releases are computed.
    pub selection: Selection,
    /// Worker threads, 1 or more; `None` = all cores. Results do not depend on it.
    pub threads: Option<usize>,
    /// Go on with more releases until the interval of this percentile is narrow enough; `None` = the plan's number.
    pub until: Option<TargetPrecision>,
}

impl RunOptions {
    /// All releases, on all cores, into a folder that holds no results yet.
    pub fn into_folder(out: impl Into<PathBuf>) -> Self {
        Self {
            out: out.into(),
            existing: Mode::Fresh,
            selection: Selection::All,
            threads: None,
            until: None,
        }
    }

    /// Refuses a folder that a run of the scene could not write into: so much is known before the terrain is read.
    ///
    /// # Errors
    /// A folder that holds results which [`RunOptions::existing`] does not allow to touch, that cannot be made or written, or
    /// that another process is writing into.
    pub fn check_folder(&self, scene: &Scene) -> Result<()> {
        let identity = self.identity((scene.hash_in_force(), scene.seed), scene.release.count);
        output::check_folder(&self.out, &identity, self.existing)
    }

    /// What tells these results from others: those of a scene, by its hash, and a seed.
    pub(super) fn identity(&self, (scene_hash, seed): (String, u64), count: usize) -> Identity {
        let asked = self.selection.range(count);
        Identity {
            scene_hash,
            version: VERSION.to_owned(),
            seed,
            first_release: asked.start,
            releases: asked.len(),
            of_releases: count,
        }
    }
}

/// Which releases a run computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selection {
    /// All of them.
    All,
    /// This one alone, with its full path.
    Only(usize),
    /// The `number`-th of `of` nearly equal parts, both from 1.
    Shard {
        /// Which part.
        number: usize,
        /// Of how many.
        of: usize,
    },
}

impl Selection {
    /// Its release numbers among `count`.
    pub fn range(self, count: usize) -> Range<usize> {
        // In 128 bits the product of two counts cannot overflow.
        let cut = |number: usize, of: usize| (count as u128 * number as u128 / of as u128) as usize;
        match self {
            Self::All => 0..count,
            Self::Only(index) => index..index + 1,
            Self::Shard { number, of } => cut(number - 1, of)..cut(number, of),
        }
    }

    /// Refuses a selection that is not there among `count` releases.
    ///
    /// # Errors
    /// A release number that is too large; a part 0, beyond the last, or with fewer than one release.
    pub fn check(self, count: usize) -> Result<()> {
        let refuse = |why: String| Err(Error::Request(why));
        match self {
            Self::Only(only) if only >= count => refuse(format!(
                "--only {only}: found {count} releases; write a number from 0 to {}",
                count - 1
            )),
            Self::Shard { number, of } if number == 0 || number > of => refuse(format!(
                "--shard {number}/{of}: the part is outside 1 to {of}; write for instance 1/{of}"
            )),
            Self::Shard { number, of } if of > count => refuse(format!(
                "--shard {number}/{of}: found {count} releases; write at most as many parts"
            )),
            _ => Ok(()),
        }
    }
}

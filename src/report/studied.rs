//! The study of a scene's errors that stands beside its results: found, and taken only if it is of that very scene.

use crate::error::{Error, Result};
use crate::output::write_atomic;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// What tells of which scene a study is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Studied {
    /// Hash of the scene and of its meshes.
    pub scene_hash: String,
    /// Where its chance starts.
    pub seed: u64,
    /// Releases under each setting.
    pub releases: usize,
}

/// Its file beside the figure.
const FILE: &str = "study.json";
/// The figure that `rockfall study error` leaves.
pub(super) const FIGURE: &str = "error.svg";
/// Folder of a study below the results, or beside them with a folder for each scene.
const FOLDER: &str = "error";

impl Studied {
    /// Writes it into the folder of a study.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, dir: &Path) -> Result<()> {
        let path = dir.join(FILE);
        let text = serde_json::to_string_pretty(self)
            .map_err(|why| Error::file("write", &path)(std::io::Error::other(why)))?;
        write_atomic(&path, (text + "\n").as_bytes())
    }

    fn read(dir: &Path) -> Option<Self> {
        serde_json::from_str(&fs::read_to_string(dir.join(FILE)).ok()?).ok()
    }
}

/// The figure of a study of the scene whose results stand in `dir`, and of how many releases it is: from `dir/error`, or
/// from where `rockfall study error` and `rockfall run` put both of themselves, `reports/error/NAME` and `reports/NAME`.
pub(super) fn figure(dir: &Path, (scene_hash, seed): (&str, u64)) -> Option<(String, usize)> {
    let whole = dir.canonicalize().unwrap_or_else(|_| dir.to_owned());
    let beside = || Some(whole.parent()?.join(FOLDER).join(whole.file_name()?));
    let places: Vec<PathBuf> = std::iter::once(dir.join(FOLDER)).chain(beside()).collect();
    places.into_iter().find_map(|place| {
        let studied = Studied::read(&place)?;
        if studied.scene_hash != scene_hash || studied.seed != seed {
            return None;
        }
        let svg = fs::read_to_string(place.join(FIGURE)).ok()?;
        Some((svg[svg.find("<svg")?..].to_owned(), studied.releases))
    })
}

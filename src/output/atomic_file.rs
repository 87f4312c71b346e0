//! JSON files that are either whole or not there.

use crate::error::{Error, Result};
use crate::file::{PART, write_atomic};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What to do about a file of a run that is not what the run has written.
pub(super) const RESTORE: &str =
    "restore the file as it was written, or run again with --overwrite";

/// The path without the ending of a file that is not yet whole.
pub(super) fn final_path(path: &Path) -> PathBuf {
    if path.extension().is_some_and(|ending| ending == PART) {
        path.with_extension("")
    } else {
        path.to_owned()
    }
}

/// Writes a value as indented JSON, whole.
pub(super) fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let mut text = serde_json::to_vec_pretty(value)
        .map_err(|why| Error::file("write", path)(std::io::Error::other(why)))?;
    text.push(b'\n');
    write_atomic(path, &text)
}

/// Reads a JSON file; none when there is no such file.
pub(super) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>> {
    let text = match fs::read(path) {
        Ok(text) => text,
        Err(why) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&why.kind()) => {
            return Ok(None);
        }
        Err(why) => return Err(Error::file("read", path)(why)),
    };
    serde_json::from_slice(&text)
        .map(Some)
        .map_err(|why| Error::input(path, format!("line {}", why.line()), why.to_string(), RESTORE))
}

/// Length of a file that a run has written (bytes).
///
/// # Errors
/// If it is not there, or cannot be read.
pub(super) fn length(path: &Path) -> Result<u64> {
    match fs::metadata(path) {
        Ok(file) => Ok(file.len()),
        Err(why) if why.kind() == ErrorKind::NotFound => {
            let found = "the run has written this file, and it is not there";
            Err(Error::input(path, "file", found, RESTORE))
        }
        Err(why) => Err(Error::file("read", path)(why)),
    }
}

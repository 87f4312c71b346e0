//! JSON files that are either whole or not there.

use super::checksum::{self, RESTORE};
use crate::error::{Error, Result};
use crate::file::{PART, write_atomic};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The path without the ending of a file that is not yet whole.
pub(super) fn final_path(path: &Path) -> PathBuf {
    if path.extension().is_some_and(|ending| ending == PART) {
        path.with_extension("")
    } else {
        path.to_owned()
    }
}

/// Writes an object as indented JSON, whole, with its checksum at the end.
pub(super) fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|why| Error::file("write", path)(std::io::Error::other(why)))?;
    write_atomic(path, checksum::sealed(text).as_bytes())
}

/// Reads a JSON file; none when there is no such file. One that ends with a checksum must have it.
pub(super) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>> {
    let text = match fs::read(path) {
        Ok(text) => text,
        Err(why) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&why.kind()) => {
            return Ok(None);
        }
        Err(why) => return Err(Error::file("read", path)(why)),
    };
    let value = serde_json::from_slice(&text).map_err(|why| {
        Error::input(path, format!("line {}", why.line()), why.to_string(), RESTORE)
    })?;
    checksum::check_sealed(path, &text)?;
    Ok(Some(value))
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

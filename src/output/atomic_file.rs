//! Files that are either whole or not there.

use crate::error::{Error, Result};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Ending of a file that is not yet whole.
const PART: &str = "part";

/// Writes a file under a temporary name beside it, and renames it when it is on the disk.
///
/// A reader, or a crash, finds the old file or the new one, never a part of it.
///
/// # Errors
///
/// If the disk is full or the folder cannot be written; the old file then stands as it was.
pub fn write_atomic(path: &Path, contents: &[u8]) -> Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".");
    name.push(PART);
    let part = path.with_file_name(name);
    let write = || {
        let mut file = File::create(&part)?;
        file.write_all(contents)?;
        file.sync_all()?;
        fs::rename(&part, path)?;
        sync_folder_of(path)
    };
    write().map_err(|why| {
        // The part is of no use and may fill the disk; that it cannot be removed either would add nothing.
        let _ = fs::remove_file(&part);
        Error::file("write", path)(why)
    })
}

/// The path without the ending of a file that is not yet whole.
pub(super) fn final_path(path: &Path) -> PathBuf {
    if path.extension().is_some_and(|ending| ending == PART) {
        path.with_extension("")
    } else {
        path.to_owned()
    }
}

/// Puts the names in a folder on the disk: a power failure must not bring an old file back.
fn sync_folder_of(path: &Path) -> std::io::Result<()> {
    match path.parent().filter(|_| cfg!(unix)) {
        Some(folder) if folder != Path::new("") => File::open(folder)?.sync_all(),
        Some(_) => File::open(".")?.sync_all(),
        None => Ok(()), // elsewhere a folder cannot be opened as a file
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
    serde_json::from_slice(&text).map(Some).map_err(|why| {
        Error::input(
            path,
            format!("line {}", why.line()),
            why.to_string(),
            "restore the file as it was written, or run again with --overwrite",
        )
    })
}

//! The user's files, opened with care: a pipe that nobody writes to, a device without end or a file as long as a disk is
//! refused before it is read.

use crate::error::{Error, Result};
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

/// Longest text a scene, a list or a table may have (bytes).
pub const LONGEST_TEXT: u64 = 256 << 20;
/// Longest mesh or grid file (bytes): a binary STL with eighty million triangles.
pub const LONGEST_MESH: u64 = 4 << 30;

/// Opens a file for reading, which must be one with an end, at most `longest` bytes away.
///
/// # Errors
/// A file that is not there, may not be read, is a pipe, a socket or a device, or is too long.
pub fn open(path: &Path, longest: u64) -> Result<File> {
    // looked at before it is opened: a pipe would keep us waiting for its writer
    let about = fs::metadata(path).map_err(Error::file("read", path))?;
    if !about.is_file() && !about.is_dir() {
        let found = "found a pipe, a socket or a device, which has no end";
        let remedy = "write the path of a file; what comes out of a pipe, write into one first";
        return Err(Error::input(path, "file", found, remedy));
    }
    if about.len() > longest {
        return Err(too_long(path, about.len(), longest));
    }
    File::open(path).map_err(Error::file("read", path))
}

/// Reads a whole file, see [`open`].
///
/// # Errors
/// As [`open`].
pub fn read(path: &Path, longest: u64) -> Result<Vec<u8>> {
    let file = open(path, longest)?;
    let mut bytes = Vec::new();
    // a length is only what the system says: files that it makes up say 0 and may have no end
    let read = file.take(longest + 1).read_to_end(&mut bytes).map_err(Error::file("read", path))?;
    if read as u64 > longest {
        return Err(too_long(path, read as u64, longest));
    }
    no_pointer(path, &bytes)?;
    Ok(bytes)
}

/// Reads the first 4096 bytes of a file, see [`open`].
///
/// # Errors
/// As [`open`].
pub fn head(path: &Path) -> Result<Vec<u8>> {
    let mut head = Vec::new();
    let file = open(path, LONGEST_MESH)?;
    file.take(4096).read_to_end(&mut head).map_err(Error::file("read", path))?;
    no_pointer(path, &head)?;
    Ok(head)
}

/// How a file begins that stands in place of a large one until Git LFS has fetched that.
const POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// Refuses the pointer of a file that was not fetched, of whatever kind the file would be.
fn no_pointer(path: &Path, start: &[u8]) -> Result<()> {
    if !start.starts_with(POINTER) {
        return Ok(());
    }
    let remedy = "fetch the file itself with `git lfs pull`";
    Err(Error::input(path, "start", "found a pointer of Git LFS", remedy))
}

/// Reads a whole text, see [`open`].
///
/// # Errors
/// As [`open`], and text that is not UTF-8.
pub fn read_text(path: &Path) -> Result<String> {
    String::from_utf8(read(path, LONGEST_TEXT)?).map_err(|_| {
        let why = std::io::Error::new(
            std::io::ErrorKind::InvalidData,
            "stream did not contain valid UTF-8",
        );
        Error::file("read", path)(why)
    })
}

fn too_long(path: &Path, found: u64, longest: u64) -> Error {
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    let found = format!("found {:.1} GB or more", gigabytes(found));
    let remedy = format!(
        "write a file of at most {:.1} GB: a coarser mesh, or a part of it",
        gigabytes(longest)
    );
    Error::input(path, "length", found, remedy)
}

/// Refuses to write over a file that is read: `out` must not be one of the `inputs`, by whatever name.
///
/// # Errors
/// If it is.
pub fn keep_inputs(out: &Path, inputs: &[&Path]) -> Result<()> {
    let Ok(target) = out.canonicalize() else { return Ok(()) };
    let same = |input: &&&Path| input.canonicalize().is_ok_and(|input| input == target);
    match inputs.iter().find(same) {
        None => Ok(()),
        Some(input) => Err(Error::Request(format!(
            "{}: is the file that is read ({}); write another one",
            out.display(),
            input.display()
        ))),
    }
}

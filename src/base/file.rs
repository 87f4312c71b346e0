//! The user's files, opened with care: a pipe that nobody writes to, a device without end or a file as long as a disk is
//! refused before it is read. Files are written whole or not at all.

use crate::error::{Error, Result};
use std::fs::{self, File};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

/// Longest text a scene, a list or a table may have (bytes).
pub const LONGEST_TEXT: u64 = 256 << 20;
/// Longest mesh or grid file (bytes): a binary STL with eighty million triangles.
pub const LONGEST_MESH: u64 = 4 << 30;

/// How a pointer of Git LFS begins: where the file itself was not fetched, its few lines stand under the file's name.
/// <https://github.com/git-lfs/git-lfs/blob/main/docs/spec.md>
const LFS_BEGINS: &[u8] = b"version https://git-lfs";

/// Opens a file for reading, which must be one with an end, at most `longest` bytes away.
///
/// # Errors
/// A file that is not there, may not be read, is a pipe, a socket or a device, is too long, or is a pointer of Git LFS.
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
    let mut file = File::open(path).map_err(Error::file("read", path))?;
    if about.is_file() {
        refuse_pointer(&mut file, path)?;
    }
    Ok(file)
}

/// Refuses a pointer of Git LFS in the place of the file; leaves any other file at its first byte.
fn refuse_pointer(file: &mut File, path: &Path) -> Result<()> {
    let mut start = Vec::new();
    let length = LFS_BEGINS.len() as u64;
    Read::by_ref(file).take(length).read_to_end(&mut start).map_err(Error::file("read", path))?;
    if start == LFS_BEGINS {
        let found = "found a pointer of Git LFS in the place of the file";
        return Err(Error::input(
            path,
            "start",
            found,
            "fetch the file itself with `git lfs pull`",
        ));
    }
    file.rewind().map_err(Error::file("read", path))
}

/// The bytes of a table, every line of which ends with a line feed alone: the reader of tables takes the second byte of another end
/// for the beginning of the next line, whose number it then misses by one.
///
/// # Errors
/// As [`read`].
pub fn read_table(path: &Path, longest: u64) -> Result<Vec<u8>> {
    let mut bytes = read(path, longest)?;
    let mut before = 0;
    bytes.retain(|&byte| std::mem::replace(&mut before, byte) != b'\r' || byte != b'\n');
    bytes.iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
    Ok(bytes)
}

/// A reader of a table that was read so: blanks around names and numbers are none of them.
pub fn table_reader(table: &[u8]) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(table)
}

/// The line of a row in a table that was read so, from 1: the reader of tables says where it began to look for the row, which is before
/// the empty lines that it passes over.
pub fn line_of(table: &[u8], position: Option<&csv::Position>) -> u64 {
    let Some(position) = position else { return 1 };
    let rest = table.get(position.byte() as usize..).unwrap_or_default();
    let empty = rest.iter().take_while(|&&byte| byte == b'\n').count();
    position.line() + empty as u64
}

/// What to do about a table that cannot be read: what it should be, behind what its bytes tell of why it is not.
pub fn table_remedy(table: &[u8], asked: &str) -> String {
    if std::str::from_utf8(table).is_err() {
        return format!("save it in UTF-8: it is in another encoding, as Latin-1; {asked}");
    }
    let first = table.split(|&byte| byte == b'\n').next().unwrap_or_default();
    if !first.contains(&b',') && first.iter().any(|byte| b";\t".contains(byte)) {
        return format!("put commas between its columns, and points into its numbers; {asked}");
    }
    asked.to_owned()
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
    Ok(head)
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

/// Ending of a file that is not yet whole.
pub const PART: &str = "part";

/// Writes a file that the user has named: [whole or not at all](write_atomic), through a link to where it leads; straight
/// on where something else than a file is named, as a pipe.
///
/// # Errors
/// As [`write_atomic`].
pub fn write(path: &Path, contents: &[u8]) -> Result<()> {
    match fs::metadata(path) {
        Ok(about) if !about.is_file() => {
            fs::write(path, contents).map_err(Error::file("write", path))
        }
        Ok(_) => {
            write_atomic(&fs::canonicalize(path).map_err(Error::file("write", path))?, contents)
        }
        Err(_) => write_atomic(path, contents),
    }
}

/// Writes a file under a temporary name beside it, and renames it when it is on the disk.
///
/// A reader, or a crash, finds the old file or the new one, never a part of it.
///
/// # Errors
///
/// If the disk is full or the folder cannot be written; the old file then stands as it was.
pub fn write_atomic(path: &Path, contents: &[u8]) -> Result<()> {
    let part = part_of(path);
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

/// The name of a file until it is whole.
pub fn part_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".");
    name.push(PART);
    path.with_file_name(name)
}

/// Puts the names in a folder on the disk: a power failure must not bring an old file back.
fn sync_folder_of(path: &Path) -> std::io::Result<()> {
    match path.parent().filter(|_| cfg!(unix)) {
        Some(folder) if folder != Path::new("") => File::open(folder)?.sync_all(),
        Some(_) => File::open(".")?.sync_all(),
        None => Ok(()), // elsewhere a folder cannot be opened as a file
    }
}

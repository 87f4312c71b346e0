//! Checksums: damage that leaves a file as long as it was is noticed before anything is said of it.
//!
//! Tables are summed while they are written. CRC-32 finds what disks, copies and editors do to a file; it is no seal
//! against somebody who means to deceive.

use crate::error::{Error, Result};
use crate::file::write_atomic;
use flate2::Crc;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{ErrorKind, Read, Write};
use std::path::Path;

/// What to do about a file of a run that is not what the run has written.
pub(super) const RESTORE: &str =
    "restore the file as it was written, or run again with --overwrite";

/// Name of the file that holds the checksums, in a form that other programs know (`rhash -c`, `cksfv -f`).
pub(super) const SUMS: &str = "results.sfv";

/// First line of the file.
const HEAD: &str =
    "; CRC-32 of the files that rockfall reads again; summary.json ends with its own\n";

/// CRC-32 by name of file, below the folder of the results.
pub(super) type FileSums = BTreeMap<String, u32>;

/// Reads the checksums in `dir`; none in results of a version that wrote none.
pub(super) fn read(dir: &Path) -> Result<FileSums> {
    let path = dir.join(SUMS);
    let text = match fs::read_to_string(&path) {
        Err(why) if why.kind() == ErrorKind::NotFound => return Ok(FileSums::new()),
        text => text.map_err(Error::file("read", &path))?,
    };
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with(';'));
    let entry = |(number, line): (usize, &str)| {
        let parts = line.rsplit_once(' ');
        let entry = parts.and_then(|(name, sum)| Some((name, u32::from_str_radix(sum, 16).ok()?)));
        let found = || format!("`{line}`, which is no name and checksum");
        let (name, sum) = entry
            .ok_or_else(|| Error::input(&path, format!("line {}", number + 1), found(), RESTORE))?;
        Ok((name.to_owned(), sum))
    };
    lines.map(entry).collect()
}

/// Writes the checksums into `dir`.
pub(super) fn write(dir: &Path, sums: &FileSums) -> Result<()> {
    let mut text = HEAD.to_owned();
    for (name, sum) in sums {
        // writing to a string cannot fail
        let _ = writeln!(text, "{name} {sum:08x}");
    }
    write_atomic(&dir.join(SUMS), text.as_bytes())
}

/// Adds the files of these names that are there.
pub(super) fn add<'a>(
    dir: &Path,
    sums: &mut FileSums,
    names: impl IntoIterator<Item = &'a str>,
) -> Result<()> {
    for name in names {
        let path = dir.join(name);
        if path.exists() {
            sums.insert(name.to_owned(), sum_of(&path, u64::MAX)?.sum());
        }
    }
    Ok(())
}

/// Adds the checksums of files that are read again by those who draw the finished results in `dir`.
///
/// # Errors
/// When a file cannot be read, or that of the checksums cannot be written.
pub fn add_checksums(dir: &Path, names: &[&str]) -> Result<()> {
    let mut sums = read(dir)?;
    add(dir, &mut sums, names.iter().copied())?;
    write(dir, &sums)
}

/// Every file whose checksum is known must be as it was written; whether one may be missing is for others to say.
pub(super) fn check_all(dir: &Path) -> Result<()> {
    let sums = read(dir)?;
    let there = sums.iter().map(|(name, sum)| (dir.join(name), *sum));
    there.filter(|(path, _)| path.exists()).try_for_each(|(path, sum)| check(&path, Some(sum)))
}

/// A file must have the checksum with which it was written, where that is known.
pub(super) fn check(path: &Path, written: Option<u32>) -> Result<()> {
    let Some(written) = written else { return Ok(()) };
    compare(path, sum_of(path, u64::MAX)?.sum(), written)
}

/// Refuses a file of which another checksum was written than is found.
pub(super) fn compare(path: &Path, found: u32, written: u32) -> Result<()> {
    if found == written {
        return Ok(());
    }
    let both = format!("found {found:08x} where the run had written {written:08x}");
    Err(Error::input(path, "checksum", both, RESTORE))
}

/// What sums a file up to a length (bytes), or to its end.
fn sum_of(path: &Path, bytes: u64) -> Result<Crc> {
    let file = File::open(path).map_err(Error::file("read", path))?;
    let (mut rest, mut part, mut crc) = (file.take(bytes), vec![0; 1 << 17], Crc::new());
    loop {
        match rest.read(&mut part).map_err(Error::file("read", path))? {
            0 => return Ok(crc),
            read => crc.update(&part[..read]),
        }
    }
}

/// CRC-32 of what is held in memory.
pub(super) fn of_bytes(bytes: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum()
}

/// Before and behind the checksum at the end of a JSON object.
const CLOSING: [&str; 2] = [",\n  \"crc32\": \"", "\"\n}\n"];

/// An indented JSON object, which must not be empty, with the checksum of all before it as its last value.
pub(super) fn sealed(mut object: String) -> String {
    let inner = object.strip_suffix("\n}").map_or(object.len(), str::len);
    object.truncate(inner);
    let sum = of_bytes(object.as_bytes());
    let [before, behind] = CLOSING;
    // writing to a string cannot fail
    let _ = write!(object, "{before}{sum:08x}{behind}");
    object
}

/// Refuses an object that does not have the checksum at its end; one without any is taken.
pub(super) fn check_sealed(path: &Path, object: &[u8]) -> Result<()> {
    let [before, behind] = CLOSING.map(str::as_bytes);
    let parts = object.strip_suffix(behind).and_then(|rest| rest.split_last_chunk::<8>());
    let Some((inner, digits)) =
        parts.and_then(|(rest, sum)| Some((rest.strip_suffix(before)?, sum)))
    else {
        return Ok(());
    };
    let found = of_bytes(inner);
    let written =
        std::str::from_utf8(digits).ok().and_then(|sum| u32::from_str_radix(sum, 16).ok());
    // digits that are none are damage too
    compare(path, found, written.unwrap_or(!found))
}

/// A file that is summed while it grows.
#[derive(Debug)]
pub(super) struct SummedFile {
    pub(super) file: File,
    // a table is also written through a shared reference, as a file is
    crc: RefCell<Crc>,
}

impl SummedFile {
    /// A file without a byte.
    pub(super) fn empty(file: File) -> Self {
        Self { file, crc: RefCell::default() }
    }

    /// A file that goes on behind its first `bytes`, which must have the checksum, where it is known.
    pub(super) fn behind(
        file: File,
        (path, bytes): (&Path, u64),
        written: Option<u32>,
    ) -> Result<Self> {
        let crc = sum_of(path, bytes)?;
        written.map_or(Ok(()), |written| compare(path, crc.sum(), written))?;
        Ok(Self { file, crc: RefCell::new(crc) })
    }

    /// CRC-32 of all that it holds.
    pub(super) fn sum(&self) -> u32 {
        self.crc.borrow().sum()
    }
}

impl Write for &SummedFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = (&self.file).write(bytes)?;
        self.crc.borrow_mut().update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        (&self.file).flush()
    }
}

impl Write for SummedFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        (&*self).write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        (&*self).flush()
    }
}

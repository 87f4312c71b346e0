//! CSV files that grow row by row and can be cut back to a length that is known to be good.

use super::checksum::SummedFile;
use crate::count::number_of;
use crate::error::{Error, Result};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom};
use std::path::{Path, PathBuf};

mod header;

pub(super) use header::Columns;

/// Buffer of a reader or writer (bytes).
const BUFFER: usize = 1 << 17;

/// A CSV file being written.
#[derive(Debug)]
pub(super) struct CsvTable {
    path: PathBuf,
    writer: csv::Writer<SummedFile>,
}

impl CsvTable {
    /// Creates the file, or empties it, and writes the names of the columns.
    pub(super) fn create(path: PathBuf, columns: &[&str]) -> Result<Self> {
        let file = File::create(&path).map_err(Error::file("create", &path))?;
        let mut table = Self::over(path, SummedFile::empty(file));
        table.writer.write_record(columns).map_err(|why| in_file(&table.path, columns, why))?;
        Ok(table)
    }

    /// Goes on behind the first `bytes` of the file and drops the rest: rows torn by a crash. What stays must have the
    /// checksum, where it is known.
    pub(super) fn go_on(path: PathBuf, bytes: u64, sum: Option<u32>) -> Result<Self> {
        let found = super::atomic_file::length(&path)?;
        let mut file =
            OpenOptions::new().write(true).open(&path).map_err(Error::file("open", &path))?;
        if found < bytes {
            return Err(Error::input(
                &path,
                "length",
                format!(
                    "{} where the interrupted run had written {bytes}",
                    number_of(found, "byte")
                ),
                super::checksum::RESTORE,
            ));
        }
        file.set_len(bytes)
            .and_then(|()| file.seek(SeekFrom::Start(bytes)))
            .map_err(Error::file("cut", &path))?;
        let file = SummedFile::behind(file, (&path, bytes), sum)?;
        Ok(Self::over(path, file))
    }

    fn over(path: PathBuf, file: SummedFile) -> Self {
        let writer =
            csv::WriterBuilder::new().has_headers(false).buffer_capacity(BUFFER).from_writer(file);
        Self { path, writer }
    }

    /// Appends one row.
    pub(super) fn write(&mut self, row: &impl Serialize) -> Result<()> {
        self.writer.serialize(row).map_err(|why| in_file(&self.path, &[], why))
    }

    /// Appends the rows of another table, which must be `bytes` long: what was known to be good when it was written.
    pub(super) fn append(&mut self, other: &Path, bytes: u64) -> Result<()> {
        let file = File::open(other).map_err(Error::file("read", other))?;
        let found = file.metadata().map_err(Error::file("read", other))?.len();
        if found != bytes {
            return Err(Error::input(
                other,
                "length",
                format!("{} where the run had written {bytes}", number_of(found, "byte")),
                super::checksum::RESTORE,
            ));
        }
        let mut rows = BufReader::with_capacity(BUFFER, file);
        rows.skip_until(b'\n').map_err(Error::file("read", other))?; // the names of the columns
        self.writer.flush().map_err(Error::file("write", &self.path))?;
        // A copy cannot say which of the two files failed; a full disk is by far the most likely.
        let mut file = self.writer.get_ref();
        std::io::copy(&mut rows, &mut file).map(|_| ()).map_err(Error::file("write", &self.path))
    }

    /// Puts all rows on the disk and gives the length of the file (bytes).
    pub(super) fn sync(&mut self) -> Result<u64> {
        let flushed = self.writer.flush();
        let file = &self.writer.get_ref().file;
        flushed
            .and_then(|()| file.sync_data())
            .and_then(|()| file.metadata())
            .map(|about| about.len())
            .map_err(Error::file("write", &self.path))
    }

    /// CRC-32 of the rows that are on the disk.
    pub(super) fn sum(&self) -> u32 {
        self.writer.get_ref().sum()
    }
}

/// Reads the rows of a CSV file one by one.
pub(super) fn rows<R: DeserializeOwned>(
    path: PathBuf,
    (columns, groups): Columns,
) -> Result<impl Iterator<Item = Result<R>>> {
    let file = File::open(&path).map_err(Error::file("read", &path))?;
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).buffer_capacity(BUFFER).from_reader(file);
    let mut record = csv::StringRecord::new();
    reader.read_record(&mut record).map_err(|why| in_file(&path, columns, why))?;
    let found: Vec<&str> = record.iter().collect();
    let Some(gaps) = header::gaps(&found, (columns, groups)) else {
        return Err(Error::input(
            &path,
            "line 1",
            header::flaw(&found, (columns, groups)),
            super::checksum::RESTORE,
        ));
    };
    let all: Vec<String> = found.iter().map(|&column| column.to_owned()).collect();
    let next = move || {
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        next_row(&mut reader, (&mut record, &gaps), &path, &all).transpose()
    };
    Ok(std::iter::from_fn(next))
}

/// Whether the rows of a CSV file have these columns too.
pub(super) fn has_columns(path: &Path, columns: &[&str]) -> Result<bool> {
    let file = File::open(path).map_err(Error::file("read", path))?;
    let mut reader = csv::Reader::from_reader(file);
    let header = reader.headers().map_err(|why| in_file(path, columns, why))?;
    Ok(columns.iter().all(|column| header.iter().any(|found| found == *column)))
}

/// The next row; none at the end of the file.
fn next_row<R: DeserializeOwned>(
    reader: &mut csv::Reader<File>,
    (record, gaps): (&mut csv::StringRecord, &[usize]),
    path: &Path,
    columns: &[&str],
) -> Result<Option<R>> {
    let more = reader.read_record(record).map_err(|why| in_file(path, columns, why))?;
    let filled = (!gaps.is_empty()).then(|| filled(record, gaps));
    let record = filled.as_ref().unwrap_or(record);
    more.then(|| record.deserialize(None).map_err(|why| in_file(path, columns, why))).transpose()
}

/// A row with an empty field in each gap: that reads as nothing.
fn filled(record: &csv::StringRecord, gaps: &[usize]) -> csv::StringRecord {
    let mut all = csv::StringRecord::new();
    for (index, field) in record.iter().enumerate() {
        gaps.iter().filter(|gap| **gap == index).for_each(|_| all.push_field(""));
        all.push_field(field);
    }
    all
}

/// Says in which line and column of which file something is wrong.
fn in_file(path: &Path, columns: &[&str], why: csv::Error) -> Error {
    let line = why.position().map_or("a line".to_owned(), |at| format!("line {}", at.line()));
    let remedy = "restore the row as it was written, or run again with --overwrite";
    match why.into_kind() {
        csv::ErrorKind::Io(why) => Error::file("read or write", path)(why),
        csv::ErrorKind::Deserialize { err, .. } => {
            // The reader does not tell the column of an unknown word; the word itself is then in the message.
            let column = err.field().and_then(|field| columns.get(field as usize));
            let place = column.map_or(line.clone(), |column| format!("{line}, {column}"));
            Error::input(path, place, err.kind().to_string(), remedy)
        }
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            Error::input(path, line, format!("{len} values instead of {expected_len}"), remedy)
        }
        csv::ErrorKind::Utf8 { .. } => Error::input(path, line, "bytes that are no text", remedy),
        other => Error::input(path, line, format!("{other:?}"), remedy),
    }
}

#[cfg(test)]
mod tests {
    use super::CsvTable;

    /// A full disk is met when the rows are put on it; the message names the file.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_is_an_error_that_names_the_file() {
        let mut table = CsvTable::create("/dev/full".into(), &["index"]).unwrap();
        table.write(&1).unwrap();
        let said = table.sync().unwrap_err().to_string();
        assert!(said.starts_with("/dev/full: cannot write: No space left"), "{said}");
    }
}

//! What a LAS or LAZ file says of itself (ASPRS LAS 1.4), held against its length before anything of it is believed: the
//! decoder takes the memory and the time that the numbers ask for.

use crate::error::{Error, Result};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Where the header says what.
mod at {
    pub(super) const HEADER_BYTES: u64 = 94;
    pub(super) const MINOR_VERSION: u64 = 25;
    pub(super) const POINTS_BEGIN: u64 = 96;
    pub(super) const RECORDS: u64 = 100;
    pub(super) const POINT_FORMAT: u64 = 104;
    pub(super) const POINT_BYTES: u64 = 105;
    pub(super) const OLD_POINTS: u64 = 107;
    /// From version 1.4 on: long records behind the points.
    pub(super) const LONG_RECORDS_BEGIN: u64 = 235;
    pub(super) const LONG_RECORDS: u64 = 243;
    pub(super) const POINTS: u64 = 247;
}

/// Bit of the format of packed points.
const PACKED: u64 = 0x80;
/// Bytes of a record's head, of a long record's, and where that says how long it is.
const RECORD_BYTES: u64 = 54;
const LONG_RECORD_BYTES: u64 = 60;
const LONG_RECORD_LENGTH: u64 = 20;
/// Packed points of one byte, at most: measured ground takes two bytes a point and more, a lattice of level points a tenth.
const POINTS_OF_A_BYTE: u64 = 64;
/// Number of the record of `LASzip`, its compressor in layers, and where its list of items begins with their number.
const LASZIP: u64 = 22_204;
const LAYERED: u64 = 3;
const ITEMS: u64 = 32;
/// Points of a file of no length to speak of.
const POINTS_AT_LEAST: u64 = 1 << 16;

/// Refuses a file that announces more than it can hold; one that ends in its header is left to the decoder.
pub(super) fn check<R: Read + Seek>(bytes: &mut R, file: &Path) -> Result<()> {
    let length = bytes.seek(SeekFrom::End(0)).map_err(Error::file("read", file))?;
    let found = Announced { bytes, length }.excess().unwrap_or(None);
    bytes.rewind().map_err(Error::file("read", file))?;
    let Some(what) = found else { return Ok(()) };
    let found = format!("found more {what} than its {length} bytes hold");
    let remedy = "the file is damaged or cut off: write it again with pdal translate";
    Err(Error::input(file, "LAS header", found, remedy))
}

struct Announced<'a, R> {
    bytes: &'a mut R,
    length: u64,
}

impl<R: Read + Seek> Announced<'_, R> {
    fn number(&mut self, place: SeekFrom, length: usize) -> io::Result<u64> {
        let mut little = [0; 8];
        self.bytes.seek(place)?;
        self.bytes.read_exact(&mut little[..length])?;
        Ok(u64::from_le_bytes(little))
    }

    fn at(&mut self, place: u64, length: usize) -> io::Result<u64> {
        self.number(SeekFrom::Start(place), length)
    }

    /// What there is too much of.
    fn excess(&mut self) -> io::Result<Option<&'static str>> {
        let is_packed = self.at(at::POINT_FORMAT, 1)? & PACKED != 0;
        let (begin, point_bytes) = (self.at(at::POINTS_BEGIN, 4)?, self.at(at::POINT_BYTES, 2)?);
        let is_new = self.at(at::MINOR_VERSION, 1)? >= 4;
        let points = if is_new { self.at(at::POINTS, 8)? } else { 0 };
        let points = points.max(self.at(at::OLD_POINTS, 4)?);
        let most = POINTS_AT_LEAST + self.length.saturating_mul(POINTS_OF_A_BYTE);
        let end = points.checked_mul(point_bytes.max(1)).and_then(|bytes| bytes.checked_add(begin));
        if end.is_none() || (is_packed && points > most) {
            return Ok(Some("points"));
        }
        if !is_packed && end > Some(self.length) {
            return Ok(Some("points"));
        }
        if self.at(at::RECORDS, 4)?.saturating_mul(RECORD_BYTES) > self.length {
            return Ok(Some("records"));
        }
        if is_new && !self.long_records_fit()? {
            return Ok(Some("long records"));
        }
        if is_packed && self.chunks()? > self.length {
            return Ok(Some("chunks of points"));
        }
        if is_packed && !self.layers_fit()? {
            return Ok(Some("layers of points"));
        }
        Ok(None)
    }

    fn long_records_fit(&mut self) -> io::Result<bool> {
        let count = self.at(at::LONG_RECORDS, 4)?;
        if count.saturating_mul(LONG_RECORD_BYTES) > self.length {
            return Ok(false);
        }
        let mut place = self.at(at::LONG_RECORDS_BEGIN, 8)?;
        for _ in 0..count {
            if place.saturating_add(LONG_RECORD_BYTES) > self.length {
                return Ok(false);
            }
            let length = self.at(place + LONG_RECORD_LENGTH, 8)?;
            place = place.saturating_add(LONG_RECORD_BYTES).saturating_add(length);
        }
        Ok(place <= self.length || count == 0)
    }

    /// Where the table of chunks of a packed file begins, behind the last of them.
    fn table(&mut self) -> io::Result<u64> {
        let points = self.at(at::POINTS_BEGIN, 4)?;
        // a writer that could not go back has put the place of the table at the end
        Ok(match self.at(points, 8)? {
            u64::MAX => self.number(SeekFrom::End(-8), 8)?,
            table => table,
        })
    }

    /// How many chunks a packed file says it has.
    fn chunks(&mut self) -> io::Result<u64> {
        let table = self.table()?;
        // behind the version
        self.at(table.saturating_add(4), 4)
    }

    /// Whether the layers of every chunk fit into the file, where points are packed in layers (formats 6 to 10): a chunk is a
    /// first point as it is, the number of points, how long each layer is, and the layers.
    fn layers_fit(&mut self) -> io::Result<bool> {
        let Some((point_bytes, layers)) = self.layers()? else { return Ok(true) };
        let mut place = self.at(at::POINTS_BEGIN, 4)? + 8;
        let end = self.table()?.min(self.length);
        while place < end {
            let sizes = place + point_bytes + 4;
            place = sizes.saturating_add(4 * layers);
            for layer in 0..layers {
                place = place.saturating_add(self.at(sizes + 4 * layer, 4)?);
            }
            if place > self.length {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Bytes of a point and the number of its layers; none where points are not packed in layers.
    fn layers(&mut self) -> io::Result<Option<(u64, u64)>> {
        let Some(record) = self.laszip_record()? else { return Ok(None) };
        if self.at(record, 2)? != LAYERED {
            return Ok(None);
        }
        let (mut bytes, mut layers) = (0, 0);
        for item in 0..self.at(record + ITEMS, 2)? {
            let place = record + ITEMS + 2 + 6 * item;
            let (kind, size) = (self.at(place, 2)?, self.at(place + 2, 2)?);
            let more = match kind {
                10 => (30, 9),
                11 => (6, 1),
                12 => (8, 2),
                13 => (29, 1),
                14 => (size, size),
                _ => return Ok(None),
            };
            (bytes, layers) = (bytes + more.0, layers + more.1);
        }
        Ok((layers > 0).then_some((bytes, layers)))
    }

    /// Where the record begins that says how points are packed.
    fn laszip_record(&mut self) -> io::Result<Option<u64>> {
        let mut place = self.at(at::HEADER_BYTES, 2)?;
        for _ in 0..self.at(at::RECORDS, 4)? {
            if self.at(place + 18, 2)? == LASZIP {
                return Ok(Some(place + RECORD_BYTES));
            }
            place += RECORD_BYTES + self.at(place + 20, 2)?;
        }
        Ok(None)
    }
}

//! Strips and tiles packed with LZW.
//!
//! `tiff` 0.11.3 reads a tile at the edge of an image row by row, and its LZW reader then takes the last codes, which wait
//! in the decoder and no longer in the file, for a missing end code: tiles that GDAL writes are refused. Here a whole strip
//! or tile is unpacked at once, and its predictor undone.

use std::io::{Read, Seek, SeekFrom};
use tiff::decoder::{ChunkType, Decoder};
use tiff::tags::Tag;
use tiff::{TiffError, TiffFormatError, TiffResult};
use weezl::{BitOrder, LzwStatus};

/// TIFF's number of this packing.
const LZW: u16 = 5;
/// TIFF's numbers of predictors: differences of neighbours, and of bytes sorted by their weight.
const HORIZONTAL: u16 = 2;
const FLOATING_POINT: u16 = 3;

/// Where the packed parts of an image stand, and what is in them.
#[derive(Debug)]
pub(super) struct PackedParts {
    offsets: Vec<u64>,
    lengths: Vec<u64>,
    is_tiled: bool,
    /// Bytes of a sample.
    bytes: usize,
    /// 1 unsigned, 2 signed, 3 floating point.
    format: u16,
    predictor: u16,
    big_endian: bool,
}

impl PackedParts {
    /// What must be known of an image that is packed so; none of another one.
    pub(super) fn of<R: Read + Seek>(decoder: &mut Decoder<R>) -> TiffResult<Option<Self>> {
        let mut number = |tag| decoder.find_tag_unsigned::<u16>(tag);
        if number(Tag::Compression)? != Some(LZW) {
            return Ok(None);
        }
        let bits = number(Tag::BitsPerSample)?.unwrap_or(1);
        let format = number(Tag::SampleFormat)?.unwrap_or(1);
        let predictor = number(Tag::Predictor)?.unwrap_or(1);
        if ![8, 16, 32, 64].contains(&bits) || (format == 3 && bits < 32) {
            return Ok(None);
        }
        let is_tiled = decoder.get_chunk_type() == ChunkType::Tile;
        let (offsets, lengths) = if is_tiled {
            (Tag::TileOffsets, Tag::TileByteCounts)
        } else {
            (Tag::StripOffsets, Tag::StripByteCounts)
        };
        let mut list =
            |tag| decoder.find_tag_unsigned_vec::<u64>(tag).map(Option::unwrap_or_default);
        Ok(Some(Self {
            offsets: list(offsets)?,
            lengths: list(lengths)?,
            is_tiled,
            bytes: usize::from(bits) / 8,
            format,
            predictor,
            big_endian: decoder.byte_order() == tiff::tags::ByteOrder::BigEndian,
        }))
    }

    /// The samples of a strip or tile of `wide` columns, with the filling of a tile; `rows` of them hold data.
    pub(super) fn samples<R: Read + Seek>(
        &self,
        decoder: &mut Decoder<R>,
        chunk: u32,
        [wide, high, rows]: [u32; 3],
    ) -> TiffResult<Vec<f64>> {
        let broken = || TiffError::FormatError(TiffFormatError::InconsistentSizesEncountered);
        let at = chunk as usize;
        let (offset, length) =
            (self.offsets.get(at).ok_or_else(broken)?, self.lengths.get(at).ok_or_else(broken)?);
        let mut packed = Vec::new();
        let reader = decoder.inner();
        reader.seek(SeekFrom::Start(*offset))?;
        reader.take(*length).read_to_end(&mut packed)?;
        let rows = if self.is_tiled { high } else { rows };
        let row_bytes = wide as usize * self.bytes;
        let mut bytes = unpacked(&packed, row_bytes * rows as usize).ok_or_else(broken)?;
        let mut samples = Vec::with_capacity(wide as usize * rows as usize);
        for row in bytes.chunks_mut(row_bytes) {
            self.take_row(row, &mut samples);
        }
        Ok(samples)
    }

    /// Undoes the predictor of a row and takes its samples.
    fn take_row(&self, row: &mut [u8], samples: &mut Vec<f64>) {
        if self.predictor == FLOATING_POINT {
            for k in 1..row.len() {
                row[k] = row[k].wrapping_add(row[k - 1]);
            }
            let wide = row.len() / self.bytes;
            // the most significant bytes of all samples come first
            let bits = |k: usize| {
                (0..self.bytes).fold(0, |all, b| all << 8 | u64::from(row[b * wide + k]))
            };
            samples.extend((0..wide).map(|k| self.number(bits(k))));
            return;
        }
        let mut before = 0u64;
        for sample in row.chunks_exact(self.bytes) {
            let join = |all: u64, byte: &u8| all << 8 | u64::from(*byte);
            let mut bits = if self.big_endian {
                sample.iter().fold(0, join)
            } else {
                sample.iter().rev().fold(0, join)
            };
            if self.predictor == HORIZONTAL {
                bits = bits.wrapping_add(before);
                before = bits;
            }
            samples.push(self.number(bits));
        }
    }

    /// The number that the low bits stand for.
    fn number(&self, bits: u64) -> f64 {
        match (self.format, self.bytes) {
            (3, 4) => f32::from_bits(bits as u32).into(),
            (3, _) => f64::from_bits(bits),
            (2, 1) => (bits as u8).cast_signed().into(),
            (2, 2) => (bits as u16).cast_signed().into(),
            (2, 4) => (bits as u32).cast_signed().into(),
            (2, _) => bits.cast_signed() as f64,
            (_, 1) => (bits as u8).into(),
            (_, 2) => (bits as u16).into(),
            (_, 4) => (bits as u32).into(),
            _ => bits as f64,
        }
    }
}

/// So many bytes unpacked; none if there are fewer.
fn unpacked(packed: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut decoder = weezl::decode::Decoder::with_tiff_size_switch(BitOrder::Msb, 8);
    let (mut bytes, mut from, mut to) = (vec![0; length], 0, 0);
    while to < length {
        let part = decoder.decode_bytes(&packed[from..], &mut bytes[to..]);
        (from, to) = (from + part.consumed_in, to + part.consumed_out);
        match part.status {
            Ok(LzwStatus::Ok) => {}
            Ok(LzwStatus::Done | LzwStatus::NoProgress) | Err(_) => break,
        }
    }
    (to == length).then_some(bytes)
}

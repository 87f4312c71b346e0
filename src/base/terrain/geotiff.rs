//! GeoTIFF elevation models (OGC 19-008r4), cloud-optimised ones among them.
//!
//! The `tiff` crate decodes strips and tiles; the georeference is read here. Only the first image of a file counts: it is
//! the one of full resolution, the others are overviews and masks of it.

mod lzw;
mod place;
mod write;

pub use write::{Image, encode};

use crate::error::{Error, Result};
use crate::terrain::grid::{self, Grid};
use lzw::PackedParts;
use place::ImagePlacement;
use std::io::{BufReader, ErrorKind, Read, Seek};
use std::path::Path;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

/// Tags of OGC 19-008r4 and of GDAL.
pub(crate) mod tag {
    pub(crate) const MODEL_PIXEL_SCALE: u16 = 33_550;
    pub(crate) const MODEL_TIEPOINT: u16 = 33_922;
    pub(crate) const MODEL_TRANSFORMATION: u16 = 34_264;
    pub(crate) const GEO_KEY_DIRECTORY: u16 = 34_735;
    pub(crate) const GDAL_METADATA: u16 = 42_112;
    pub(crate) const GDAL_NODATA: u16 = 42_113;
}

/// Stands in cells without a value, in GeoTIFF and ASCII grids alike.
pub const NO_DATA: f32 = -9999.0;
/// Heights below this (m) are no terrain but a number for "no data" that the file does not declare; the deepest dry place
/// of the Earth is 430 m below the sea, the deepest sea 11 000 m.
const LOWEST_M: f64 = -12_000.0;

/// Cells that one byte of a file can hold at most (–): a run of LZW codes of 12 bits grows to 4096 bytes a code. More are
/// announced by a file that is damaged.
const CELLS_OF_A_BYTE: u64 = 4096;
/// Cells of a file of no length to speak of.
const CELLS_AT_LEAST: u64 = 1 << 16;

/// One elevation model.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// Its heights.
    pub grid: Grid,
    /// EPSG code of its coordinates; absent when the file names none.
    pub epsg: Option<u32>,
    /// Unit of its values where the file names one that is not the metre.
    pub unit: Option<String>,
}

/// Reads a GeoTIFF; `box_m` (west, south, east, north in map coordinates) reads that part alone. `epsg` is the scene's
/// code, for the command that a refusal proposes.
///
/// # Errors
/// A file that cannot be read or is damaged, has no georeference, a rotated or geographic one, cells that are not square,
/// several bands, or heights that are not finite.
pub fn read(path: &Path, box_m: Option<[f64; 4]>, epsg: Option<u32>) -> Result<Raster> {
    let file = crate::file::open(path, crate::file::LONGEST_MESH)?;
    let length = file.metadata().map_err(Error::file("read", path))?.len();
    parse(BufReader::with_capacity(1 << 16, file), length, path, (box_m, epsg))
}

impl Raster {
    /// The same, of heights; `file` is for messages.
    ///
    /// # Errors
    /// Values in another unit than the metre.
    pub fn of_heights(self, file: &Path) -> Result<Self> {
        match &self.unit {
            Some(unit) => Err(place::heights_in_feet(file, format!("found heights in {unit}"))),
            None => Ok(self),
        }
    }
}

/// Reads the bytes of a GeoTIFF, `length` of them; `file` is for messages.
///
/// # Errors
/// As [`read`].
pub fn parse<R: Read + Seek>(
    reader: R,
    length: u64,
    file: &Path,
    (box_m, epsg): (Option<[f64; 4]>, Option<u32>),
) -> Result<Raster> {
    let broken = |why: TiffError| damaged(file, &why);
    let most = CELLS_AT_LEAST + length.saturating_mul(CELLS_OF_A_BYTE);
    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::try_from(most.saturating_mul(8)).unwrap_or(usize::MAX);
    limits.ifd_value_size = usize::try_from(length).unwrap_or(usize::MAX);
    let mut decoder = Decoder::new(reader).map_err(broken)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(broken)?;
    let place = ImagePlacement::read(&mut decoder, file, epsg)?;
    one_band(&mut decoder, file)?;
    if u64::from(width) * u64::from(height) > most {
        let found = format!("{width} x {height} cells in {length} bytes");
        let remedy = format!("the file is cut off or damaged; write it again: {}", translate(file));
        return Err(Error::input(file, "ImageWidth, ImageLength", found, remedy));
    }
    let window = place.window((width, height), box_m);
    if box_m.is_some() && (window[2] < 2 || window[3] < 2) {
        return Err(grid::nothing_there(file, place.outline((width, height))));
    }
    let mut heights = WindowHeights::over(window, most);
    heights.fill(&mut decoder, (width, height), &place, file)?;
    let grid = place.grid(heights.window, heights.values);
    Ok(Raster { grid, epsg: place.epsg, unit: place.unit })
}

/// The part of an image that is read: first column, first row, columns, rows.
type Window = [u32; 4];

/// The heights of a window, the first row of the file first.
struct WindowHeights {
    window: Window,
    values: Vec<Option<f64>>,
    /// More than the file can hold.
    most_cells: u64,
}

impl WindowHeights {
    fn over(window: Window, most_cells: u64) -> Self {
        let [_, _, columns, rows] = window;
        let values = vec![None; columns as usize * rows as usize];
        Self { window, values, most_cells }
    }

    /// Decodes the strips or tiles that meet the window.
    fn fill<R: Read + Seek>(
        &mut self,
        decoder: &mut Decoder<R>,
        (width, height): (u32, u32),
        place: &ImagePlacement,
        file: &Path,
    ) -> Result<()> {
        let [first_column, first_row, columns, rows] = self.window;
        let (wide, high) = decoder.chunk_dimensions();
        let most = self.most_cells;
        if wide == 0 || high == 0 || u64::from(wide) * u64::from(high) > most {
            let remedy = format!("write it again: {}", translate(file));
            return Err(Error::input(
                file,
                "strips",
                "found strips or tiles of no size, or of more than the file holds",
                remedy,
            ));
        }
        if columns == 0 || rows == 0 {
            return Ok(());
        }
        let lengths = chunk_lengths(decoder);
        let packed = PackedParts::of(decoder).map_err(|why| damaged(file, &why))?;
        let across = width.div_ceil(wide);
        for down in first_row / high..=(first_row + rows - 1) / high {
            for along in first_column / wide..=(first_column + columns - 1) / wide {
                let chunk = down * across + along;
                // a chunk of no bytes was never written: no data
                if lengths.get(chunk as usize) == Some(&0) {
                    continue;
                }
                let corner = [along * wide, down * high];
                let inside = [wide.min(width - corner[0]), high.min(height - corner[1])];
                let (decoded, row) = match &packed {
                    Some(packed) => {
                        let samples = packed.samples(decoder, chunk, [wide, high, inside[1]]);
                        (samples.map(DecodingResult::F64), wide)
                    }
                    None => (decoder.read_chunk(chunk), inside[0]),
                };
                let decoded = decoded.map_err(|why| damaged(file, &why))?;
                self.take(&decoded, (corner, inside, row), place, file)?;
            }
        }
        Ok(())
    }

    /// Copies the part of a chunk that lies in the window; its rows are so many samples apart.
    fn take(
        &mut self,
        decoded: &DecodingResult,
        (corner, [wide, high], row_samples): ([u32; 2], [u32; 2], u32),
        place: &ImagePlacement,
        file: &Path,
    ) -> Result<()> {
        let value = sample(decoded);
        let [first_column, first_row, columns, rows] = self.window;
        let east = (corner[0] + wide).min(first_column + columns);
        let south = (corner[1] + high).min(first_row + rows);
        for row in corner[1].max(first_row)..south {
            for column in corner[0].max(first_column)..east {
                let at = (row - corner[1]) as usize * row_samples as usize
                    + (column - corner[0]) as usize;
                let Some(height_m) = value(at) else { continue };
                let to = (row - first_row) as usize * columns as usize
                    + (column - first_column) as usize;
                self.values[to] = place
                    .height_m(height_m)
                    .map_err(|why| implausible(file, (column, row), height_m, why))?;
            }
        }
        Ok(())
    }
}

/// The samples of a chunk as `f64`, exactly.
fn sample(decoded: &DecodingResult) -> Box<dyn Fn(usize) -> Option<f64> + '_> {
    match decoded {
        DecodingResult::U8(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::U16(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::U32(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::U64(all) => Box::new(|at| all.get(at).map(|&x| x as f64)),
        DecodingResult::I8(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::I16(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::I32(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::I64(all) => Box::new(|at| all.get(at).map(|&x| x as f64)),
        DecodingResult::F16(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::F32(all) => Box::new(|at| all.get(at).map(|&x| x.into())),
        DecodingResult::F64(all) => Box::new(|at| all.get(at).copied()),
    }
}

/// Stored bytes of every strip or tile; empty where the file does not say.
fn chunk_lengths<R: Read + Seek>(decoder: &mut Decoder<R>) -> Vec<u64> {
    let mut list = |tag| decoder.find_tag_unsigned_vec::<u64>(tag).ok().flatten();
    list(Tag::TileByteCounts).or_else(|| list(Tag::StripByteCounts)).unwrap_or_default()
}

fn one_band<R: Read + Seek>(decoder: &mut Decoder<R>, file: &Path) -> Result<()> {
    let found = match decoder.colortype().map_err(|why| damaged(file, &why))? {
        ColorType::Gray(_) => return Ok(()),
        ColorType::Multiband { num_samples, .. } => format!("found {num_samples} bands"),
        other => format!("found a picture ({other:?})"),
    };
    let remedy = format!("write the band of the heights alone: {} -b 1", translate(file));
    Err(Error::input(file, "bands", found, remedy))
}

/// A GDAL command that writes the file anew.
fn translate(file: &Path) -> String {
    format!("gdal_translate {} out.tif", file.display())
}

fn damaged(file: &Path, why: &TiffError) -> Error {
    if matches!(why, TiffError::IoError(why) if why.kind() == ErrorKind::UnexpectedEof) {
        let remedy = "the file is cut off: copy or download it again";
        return Error::input(file, "TIFF", "found its end before all of its heights", remedy);
    }
    let remedy = format!(
        "write it again as deflated or plain 32-bit floats: {} -ot Float32 -co COMPRESS=DEFLATE",
        translate(file)
    );
    Error::input(file, "TIFF", format!("found {why}"), remedy)
}

/// Why a number is no height.
#[derive(Clone, Copy)]
enum Implausible {
    Infinite,
    Undeclared,
}

fn implausible(file: &Path, (column, row): (u32, u32), found: f64, why: Implausible) -> Error {
    let place = format!("column {}, row {}", column + 1, row + 1);
    let remedy = match why {
        Implausible::Infinite => {
            "write finite heights, or that number as the file's no-data value".to_owned()
        }
        Implausible::Undeclared => format!(
            "if that means no data, write it into the file: gdal_edit.py -a_nodata {found} {}",
            file.display()
        ),
    };
    Error::input(file, place, format!("found a height of {found} m"), remedy)
}

//! Rasters in plan view: ESRI ASCII grids for every editor, GeoTIFF for every GIS.

use super::whole::{as_whole, write_whole};
use crate::error::{Error, Result};
use crate::frequency::Weights;
use crate::hazard::{Asked, Layer, MapFrame, MapState, Maps, Matrix, year_maps};
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use tiff::encoder::colortype::Gray32Float;
use tiff::encoder::compression::DeflateLevel;
use tiff::encoder::{Compression, TiffEncoder};
use tiff::tags::Tag;

/// Folder of the rasters below the result folder.
pub(super) const FOLDER: &str = "maps";
/// Ending of the file that a resumed run begins from.
const STATE: &str = "state";
/// Stands in cells where no rock came.
const NO_DATA: f32 = -9999.0;

/// Writes all layers; a cell where no rock came holds no data.
///
/// Layers of a year stand beside them where the run is no part of another; the ends of their intervals as GeoTIFF alone.
pub(super) fn write(
    dir: &Path,
    maps: &Maps,
    (asked, releases): (&Asked, usize),
    is_part: bool,
) -> Result<()> {
    let weights = match &asked.frequency {
        Some(frequency) => frequency.weights(releases),
        None => Weights::equal(releases),
    };
    let folder = dir.join(FOLDER);
    fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
    for layer in Layer::ALL {
        let cells = raster(&maps.frame, maps.values(layer, &weights));
        write_raster(&folder.join(layer.file()), layer.in_words(), (&maps.frame, &cells), true)?;
    }
    let layers = if is_part { Vec::new() } else { year_maps(maps, asked, releases) };
    for layer in layers {
        let cells = raster(&maps.frame, layer.values.into_iter());
        let path = folder.join(&layer.file);
        let said = (layer.name.as_str(), layer.unit);
        write_raster(&path, said, (&maps.frame, &cells), !layer.is_bound)?;
    }
    Ok(())
}

/// All cells; no data where there is no value, or no number.
fn raster(frame: &MapFrame, values: impl Iterator<Item = (u32, f64)>) -> Vec<f32> {
    let mut cells = vec![NO_DATA; frame.cells()];
    for (cell, value) in values.filter(|(_, value)| value.is_finite()) {
        cells[cell as usize] = value as f32;
    }
    cells
}

/// Writes one layer, with name and unit, as GeoTIFF, and as an ESRI ASCII grid where it is wanted.
fn write_raster(
    path: &Path,
    said: (&str, &str),
    (frame, cells): (&MapFrame, &[f32]),
    as_text: bool,
) -> Result<()> {
    // names hold points: with_extension would cut them
    let named = |ending: &str| {
        let mut name = path.as_os_str().to_owned();
        name.push(ending);
        PathBuf::from(name)
    };
    if as_text {
        write_whole(&named(".asc"), ascii(frame, cells).as_bytes())?;
    }
    let tif = named(".tif");
    let bytes = geotiff(frame, said, cells)
        .map_err(|why| Error::file("write", &tif)(std::io::Error::other(why)))?;
    write_whole(&tif, &bytes)
}

/// Rows from north to south, as both formats have them.
fn rows<'a>(frame: &MapFrame, cells: &'a [f32]) -> impl Iterator<Item = &'a [f32]> {
    cells.chunks(frame.columns as usize).rev()
}

fn ascii(frame: &MapFrame, cells: &[f32]) -> String {
    let MapFrame { west_m, south_m, cell_m, columns, rows: count, .. } = frame;
    let mut text = format!(
        "ncols {columns}\nnrows {count}\nxllcorner {west_m}\nyllcorner {south_m}\ncellsize {cell_m}\nNODATA_value {NO_DATA}\n"
    );
    for row in rows(frame, cells) {
        for (column, value) in row.iter().enumerate() {
            let gap = if column == 0 { "" } else { " " };
            // writing to a string cannot fail
            let _ = write!(text, "{gap}{value}");
        }
        text.push('\n');
    }
    text
}

/// One deflated band of 32-bit floats with the keys of OGC 19-008r4 (GeoTIFF 1.1): pixel is area, projected system by
/// its EPSG code where one is given. Name and unit of the band stand where GDAL keeps them.
fn geotiff(
    frame: &MapFrame,
    (name, unit): (&str, &str),
    cells: &[f32],
) -> tiff::TiffResult<Vec<u8>> {
    const GDAL_METADATA: u16 = 42_112;
    const GEO_KEY_DIRECTORY: u16 = 34_735;
    const MODEL_PIXEL_SCALE: u16 = 33_550;
    const MODEL_TIEPOINT: u16 = 33_922;
    const GDAL_NODATA: u16 = 42_113;
    let mut bytes = Cursor::new(Vec::new());
    let mut file = TiffEncoder::new(&mut bytes)?
        .with_compression(Compression::Deflate(DeflateLevel::default()));
    let mut image = file.new_image::<Gray32Float>(frame.columns, frame.rows)?;
    let north_m = frame.south_m + f64::from(frame.rows) * frame.cell_m;
    let tie = [0.0, 0.0, 0.0, frame.west_m, north_m, 0.0];
    let tags = image.encoder();
    tags.write_tag(Tag::Unknown(MODEL_PIXEL_SCALE), &[frame.cell_m, frame.cell_m, 0.0][..])?;
    tags.write_tag(Tag::Unknown(MODEL_TIEPOINT), &tie[..])?;
    // GTModelType projected, GTRasterType pixel is area, ProjectedCRS
    let keys: Vec<u16> = match frame.epsg.and_then(|code| u16::try_from(code).ok()) {
        Some(code) => vec![1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, code],
        None => vec![1, 1, 0, 1, 1025, 0, 1, 1],
    };
    tags.write_tag(Tag::Unknown(GEO_KEY_DIRECTORY), &keys[..])?;
    let unit = match unit {
        "" => String::new(),
        unit => format!("<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{unit}</Item>"),
    };
    let said = format!(
        "<GDALMetadata><Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">{name}</Item>{unit}</GDALMetadata>"
    );
    tags.write_tag(Tag::Unknown(GDAL_METADATA), said.as_str())?;
    tags.write_tag(Tag::Unknown(GDAL_NODATA), "-9999")?;
    let values: Vec<f32> = rows(frame, cells).flatten().copied().collect();
    image.write_data(&values)?;
    Ok(bytes.into_inner())
}

/// Where the maps after so many rocks wait for a resumed run.
pub(super) fn state_path(dir: &Path, done: usize) -> PathBuf {
    dir.join(FOLDER).join(format!("{done}.{STATE}"))
}

/// Puts what a resumed run needs on the disk.
pub(super) fn write_state(dir: &Path, maps: &Maps, done: usize) -> Result<()> {
    let path = state_path(dir, done);
    let folder = dir.join(FOLDER);
    fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
    let text = serde_json::to_vec(&maps.state())
        .map_err(|why| Error::file("write", &path)(std::io::Error::other(why)))?;
    write_whole(&path, &text)
}

/// Whether it is there: a finished run has removed it.
pub(super) fn has_state(dir: &Path, done: usize) -> bool {
    state_path(dir, done).exists()
}

/// Reads it back.
pub(super) fn read_state(dir: &Path, done: usize) -> Result<MapState> {
    let path = state_path(dir, done);
    super::whole::read_json(&path)?.ok_or_else(|| {
        Error::input(
            &path,
            "file",
            "found nothing",
            "restore the file as it was written, or start again with --overwrite",
        )
    })
}

/// Whether a file in the folder of the maps, whole or not, has a name that a run writes: it may hold others, a terrain
/// for instance.
pub(super) fn is_result(path: &Path) -> bool {
    let whole = as_whole(path);
    let text = |part: Option<&OsStr>| part.and_then(OsStr::to_str).unwrap_or_default().to_owned();
    let (stem, ending) = (text(whole.file_stem()), text(whole.extension()));
    match ending.as_str() {
        // the ground that figures are drawn on stands beside the maps
        "asc" if ["ground", "trees"].contains(&stem.as_str()) => true,
        "asc" | "tif" => Layer::ALL.iter().any(|layer| layer.file() == stem) || is_of_year(&stem),
        "geojson" => {
            ["ends", "paths", "lines", "barriers", "release_zone"].contains(&stem.as_str())
        }
        "vtk" => ["paths", "terrain"].contains(&stem.as_str()),
        STATE => stem.parse::<usize>().is_ok(),
        _ => false,
    }
}

/// Whether a name is that of a layer of a year.
fn is_of_year(stem: &str) -> bool {
    let value = stem.trim_end_matches("_low_95").trim_end_matches("_high_95");
    value == Matrix::FILE
        || value.starts_with("frequency_") && value.ends_with("per_year")
        || value.starts_with("energy_T") && value.ends_with("_j")
}

/// Removes the states of all other moments, whole or not: a run that was killed may have left some.
pub(super) fn keep_state(dir: &Path, done: Option<usize>) -> Result<()> {
    let kept = done.map(|done| state_path(dir, done));
    super::folder::remove_all(&dir.join(FOLDER), |path| {
        let whole = as_whole(path);
        let is_state = whole.extension().is_some_and(|ending| ending == STATE);
        is_state && is_result(path) && Some(whole) != kept
    })
}

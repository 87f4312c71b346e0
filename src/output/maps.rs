//! Rasters in plan view: ESRI ASCII grids for every editor, GeoTIFF for every GIS.

use super::atomic_file::final_path;
use super::checksum::{self, FileSums};
use super::progress::Progress;
use crate::error::{Error, Result};
use crate::file::write_atomic;
use crate::frequency::Weights;
use crate::hazard::{AnnualRequest, Layer, MapFrame, MapState, Maps, Matrix, year_maps};
use crate::terrain::geotiff::{Image, NO_DATA, encode};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Folder of the rasters below the result folder.
pub(super) const FOLDER: &str = "maps";
/// Ending of the file that a resumed run begins from.
const STATE: &str = "state";

/// Writes all layers; a cell where no rock came holds no data.
///
/// Layers of a year stand beside them where the run is no part of another; ends of intervals and derivatives as GeoTIFF alone.
pub(super) fn write(
    dir: &Path,
    maps: &Maps,
    (asked, weights): (&AnnualRequest, &Weights),
    is_part: bool,
) -> Result<()> {
    let folder = dir.join(FOLDER);
    fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
    for layer in Layer::ALL {
        let cells = raster(&maps.frame, maps.values(layer, weights));
        write_raster(&folder.join(layer.file()), layer.in_words(), (&maps.frame, &cells), true)?;
    }
    let layers = if is_part { Vec::new() } else { year_maps(maps, asked, weights) };
    for layer in layers {
        let cells = raster(&maps.frame, layer.values.into_iter());
        let path = folder.join(&layer.file);
        let said = (layer.name.as_str(), layer.unit);
        write_raster(&path, said, (&maps.frame, &cells), !layer.is_beside)?;
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
        write_atomic(&named(".asc"), ascii(frame, cells).as_bytes())?;
    }
    let tif = named(".tif");
    let bytes = geotiff(frame, said, cells)
        .map_err(|why| Error::file("write", &tif)(std::io::Error::other(why)))?;
    write_atomic(&tif, &bytes)
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

fn geotiff(frame: &MapFrame, said: (&str, &str), cells: &[f32]) -> tiff::TiffResult<Vec<u8>> {
    let north_m = frame.south_m + f64::from(frame.rows) * frame.cell_m;
    let values: Vec<f32> = rows(frame, cells).flatten().copied().collect();
    encode(&Image {
        corner_m: [frame.west_m, north_m],
        cell_m: frame.cell_m,
        columns: frame.columns,
        rows: frame.rows,
        epsg: frame.epsg,
        nodata: NO_DATA,
        said: Some(said),
        values: &values,
    })
}

/// Length of each raster that a run has written (bytes), by its name in the folder of the results.
pub(super) fn lengths(dir: &Path) -> BTreeMap<String, u64> {
    let entries = fs::read_dir(dir.join(FOLDER)).into_iter().flatten().flatten();
    let rasters = entries.filter(|entry| is_layer(&entry.path()));
    let length = |entry: fs::DirEntry| {
        let name = format!("{FOLDER}/{}", entry.file_name().display());
        Some((name, entry.metadata().ok()?.len()))
    };
    rasters.filter_map(length).collect()
}

/// Name without its ending, and ending; nothing for what is no text.
fn stem_and_ending(path: &Path) -> [&str; 2] {
    [path.file_stem(), path.extension()]
        .map(|part| part.and_then(OsStr::to_str).unwrap_or_default())
}

/// Whether a file is the raster of a layer.
fn is_layer(path: &Path) -> bool {
    let [stem, ending] = stem_and_ending(path);
    ["asc", "tif"].contains(&ending)
        && (Layer::ALL.iter().any(|layer| layer.file() == stem) || is_of_year(stem))
}

/// Where the maps after so many rocks wait for a resumed run.
pub(super) fn state_path(dir: &Path, done: usize) -> PathBuf {
    dir.join(state_name(done))
}

/// Name of that file in the folder of the results.
fn state_name(done: usize) -> String {
    format!("{FOLDER}/{done}.{STATE}")
}

/// Puts what a resumed run needs on the disk; its name and checksum go into `sums`.
pub(super) fn write_state(
    dir: &Path,
    (maps, done): (&Maps, usize),
    sums: &mut FileSums,
) -> Result<()> {
    let path = state_path(dir, done);
    let folder = dir.join(FOLDER);
    fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
    let text = serde_json::to_vec(&maps.state())
        .map_err(|why| Error::file("write", &path)(std::io::Error::other(why)))?;
    write_atomic(&path, &text)?;
    sums.insert(state_name(done), checksum::of_bytes(&text));
    Ok(())
}

/// Whether it is there: a finished run has removed it.
pub(super) fn has_state(dir: &Path, done: usize) -> bool {
    state_path(dir, done).exists()
}

/// Reads it back.
pub(super) fn read_state(dir: &Path, progress: &Progress) -> Result<MapState> {
    let path = state_path(dir, progress.done);
    let state = super::atomic_file::read_json(&path)?
        .ok_or_else(|| Error::input(&path, "file", "found nothing", super::checksum::RESTORE))?;
    checksum::check(&path, progress.sums.get(&state_name(progress.done)).copied())?;
    Ok(state)
}

/// Whether a file in the folder of the maps, whole or not, has a name that a run writes: it may hold others, a terrain
/// for instance.
pub(super) fn is_result(path: &Path) -> bool {
    let whole = final_path(path);
    let [stem, ending] = stem_and_ending(&whole);
    match ending {
        // the ground that figures are drawn on stands beside the maps
        "asc" if ["ground", "trees"].contains(&stem) => true,
        "tif" if stem == "ground" => true,
        "asc" | "tif" => is_layer(&whole),
        "geojson" => ["ends", "paths", "lines", "barriers", "release_zone", "zones", "scene_lines"]
            .contains(&stem),
        "vtk" => ["paths", "terrain"].contains(&stem),
        STATE => stem.parse::<usize>().is_ok(),
        _ => false,
    }
}

/// Whether a name is that of a layer of a year.
fn is_of_year(stem: &str) -> bool {
    let beside = ["_low_95", "_high_95", "_by_log_rate", "_by_exponent"];
    let value = beside.iter().fold(stem, |stem, end| stem.trim_end_matches(end));
    value == Matrix::FILE
        || value.starts_with("frequency_") && value.ends_with("per_year")
        || value.starts_with("energy_T") && value.ends_with("_j")
}

/// Removes the states of all other moments, whole or not: a run that was killed may have left some.
pub(super) fn keep_state(dir: &Path, done: Option<usize>) -> Result<()> {
    let kept = done.map(|done| state_path(dir, done));
    super::removal::remove_all(&dir.join(FOLDER), |path| {
        let whole = final_path(path);
        let is_state = whole.extension().is_some_and(|ending| ending == STATE);
        is_state && is_result(path) && Some(whole) != kept
    })
}

//! The one door for terrain files: what a file is, is told from its first bytes and never from its name.

#[cfg(feature = "cloud")]
mod cloud_tiles;
mod obj;
mod odd_cells;
mod ply;
pub(super) mod surface;
#[cfg(test)]
mod tests;

pub use obj::parse as parse_obj;
pub use ply::parse as parse_ply;

#[cfg(feature = "cloud")]
use super::cloud;
use super::geotiff;
use super::grid::{self, Grid};
use super::make;
pub use super::options::{Crop, Options};
use super::options::{MeshSource, wider};
use super::stl::{self, Facet, Format, Soup};
use crate::error::{Error, Result};
use crate::rock::Vec3;
use std::path::Path;

/// A file as it was read, before it is cropped, resampled and cut into triangles.
#[derive(Debug)]
pub(super) enum Loaded {
    /// Triangles, in coordinates of the file.
    Mesh(Soup),
    /// Heights, in map coordinates.
    Grid(ElevationModel),
    /// Was one of the others, of which no rock reaches anything.
    Unreached(Format),
    /// Trees, in map coordinates.
    Trees(make::TreeList),
    /// Ground points, in map coordinates.
    #[cfg(feature = "cloud")]
    Cloud(cloud::Cloud),
    /// Was a tile of a cloud, whose points another file has taken over; its EPSG code.
    #[cfg(feature = "cloud")]
    Joined(std::path::PathBuf, Option<u32>),
}

impl Loaded {
    /// Whether its points have classes.
    pub(super) fn is_cloud(&self) -> bool {
        match self {
            Self::Mesh(_) | Self::Grid(_) | Self::Unreached(_) | Self::Trees(_) => false,
            #[cfg(feature = "cloud")]
            Self::Cloud(_) | Self::Joined(..) => true,
        }
    }
}

/// An elevation model.
#[derive(Debug)]
pub(super) struct ElevationModel {
    grid: Grid,
    format: Format,
    epsg: Option<u32>,
    /// What was done with it, in words.
    notes: Vec<String>,
    /// What looks wrong in it.
    warnings: Vec<String>,
    /// How many other grids its surface goes on in.
    joined: usize,
}

impl ElevationModel {
    fn of(grid: Grid, format: Format, epsg: Option<u32>) -> Loaded {
        Loaded::Grid(Self {
            grid,
            format,
            epsg,
            notes: Vec::new(),
            warnings: Vec::new(),
            joined: 0,
        })
    }
}

/// How a file begins, and what it is.
const MARKS: [(&[u8], Format); 6] = [
    (b"II*\0", Format::GeoTiff),
    (b"MM\0*", Format::GeoTiff),
    (b"II+\0", Format::GeoTiff),
    (b"MM\0+", Format::GeoTiff),
    (b"ply", Format::Ply),
    (b"LASF", Format::Cloud),
];

/// Files that GDAL or a laser tool turns into one of the formats: how they begin, name, command.
const ELSEWHERE: [(&[u8], &str, &str); 5] = [
    (b"SQLite format 3\0", "a GeoPackage", "gdal_translate -of GTiff"),
    (b"\x89HDF", "an HDF5 or NetCDF file", "gdal_translate -of GTiff"),
    (b"CDF", "a NetCDF file", "gdal_translate -of GTiff"),
    (b"<VRTDataset", "a virtual raster", "gdal_translate -of GTiff"),
    (b"\0\0\0\x0cjP", "a JPEG 2000 picture", "gdal_translate -of GTiff"),
];

/// Reads a file of any format.
pub(super) fn read(path: &Path, options: &Options) -> Result<Loaded> {
    let head = crate::file::head(path)?;
    let format = format_of(&head);
    let whole = || crate::file::read(path, crate::file::LONGEST_MESH);
    match format {
        Some(Format::GeoTiff) => {
            let window = if let Some(Crop::Box(box_m, margin_m)) = &options.crop {
                Some(wider(*box_m, *margin_m))
            } else {
                None
            };
            let geotiff::Raster { grid, epsg, .. } =
                geotiff::read(path, window, options.epsg)?.of_heights(path)?;
            Ok(ElevationModel::of(grid, Format::GeoTiff, epsg))
        }
        Some(Format::AsciiGrid) => {
            let grid = Grid::read(path)?;
            grid.check_cells(path, options.epsg)?;
            Ok(ElevationModel::of(grid, Format::AsciiGrid, None))
        }
        Some(Format::Ply) => ply::parse(&whole()?, path).map(Loaded::Mesh),
        Some(Format::Obj) => obj::parse(&whole()?, path).map(Loaded::Mesh),
        Some(Format::Cloud) => read_cloud(path, options),
        Some(Format::Ascii | Format::Binary | Format::Trees) | None => {
            if let Some((_, kind, command)) =
                ELSEWHERE.iter().find(|(mark, ..)| head.starts_with(mark))
            {
                let remedy = format!("write it as GeoTIFF: {command} {} out.tif", path.display());
                return Err(Error::input(path, "start", format!("found {kind}"), remedy));
            }
            if make::begins_like_list(&head) {
                let remedy =
                    "write it under [[trees]] file, or as zones, lines, barriers or ground_zones";
                return Err(wrong(path, "start", "found a drawing or a list of trees", remedy));
            }
            let is_named_stl = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("stl"));
            let length = std::fs::metadata(path).map_err(Error::file("read", path))?.len();
            if !is_named_stl && !stl::may_be_stl(&head, length) && !stl::is_of_other_kind(&head) {
                return Err(unknown(path, &head));
            }
            stl::read(path).map(Loaded::Mesh)
        }
    }
}

/// Why a file of no format that is read is refused.
fn unknown(path: &Path, head: &[u8]) -> Error {
    let name = path.display();
    let line = head.split(|&byte| byte == b'\n').find(|line| !line.trim_ascii().is_empty());
    let line = String::from_utf8_lossy(line.unwrap_or_default());
    let mut words = line.split([' ', '\t', ',', ';', '\r']).filter(|word| !word.is_empty());
    let is_list = words.clone().count() >= 3 && words.all(|word| word.parse::<f64>().is_ok());
    if is_list {
        let remedy = format!(
            "make an elevation model of it: gdal_translate -of GTiff {name} out.tif for points on a grid, gdal_grid for others"
        );
        return wrong(path, "start", "found a list of points", &remedy);
    }
    let remedy = format!(
        "write GeoTIFF, ESRI ASCII grid, STL, PLY, OBJ, LAS or LAZ; from what else GDAL reads: gdal_translate -of GTiff {name} out.tif"
    );
    wrong(path, "start", "found none of the formats that are read", &remedy)
}

/// Reads an elevation model: `GeoTIFF` or ESRI ASCII grid.
///
/// # Errors
/// A file that cannot be read, or is none of them.
pub fn read_grid(path: &Path) -> Result<Grid> {
    if let Loaded::Grid(heights) = read(path, &Options::default())? {
        return Ok(heights.grid);
    }
    Err(wrong(path, "start", "found no grid", "write a GeoTIFF or an ESRI ASCII grid"))
}

#[cfg(feature = "cloud")]
fn read_cloud(path: &Path, options: &Options) -> Result<Loaded> {
    cloud::read(path, options).map(Loaded::Cloud)
}

#[cfg(not(feature = "cloud"))]
fn read_cloud(path: &Path, _: &Options) -> Result<Loaded> {
    let remedy = "build rockfall with `--features cloud`, or make an elevation model of it: pdal translate IN.laz OUT.tif -w gdal --writers.gdal.resolution=1 --writers.gdal.output_type=min";
    Err(Error::input(path, "start", "found a LAS or LAZ point cloud", remedy))
}

/// Joins what must be one before it is cropped and cut: tiles of a point cloud. Grids are joined later, cell by cell.
#[cfg(feature = "cloud")]
pub(super) fn join_tiles(all: &mut [Loaded], sources: &[MeshSource]) -> Result<()> {
    cloud_tiles::join(all, sources)
}

#[cfg(not(feature = "cloud"))]
#[expect(clippy::unnecessary_wraps, reason = "with clouds it can fail")]
pub(super) fn join_tiles(_: &mut [Loaded], _: &[MeshSource]) -> Result<()> {
    Ok(())
}

fn format_of(head: &[u8]) -> Option<Format> {
    let marked = MARKS.iter().find(|(mark, _)| head.starts_with(mark)).map(|(_, format)| *format);
    marked
        .or_else(|| grid::begins_like_grid(head).then_some(Format::AsciiGrid))
        .or_else(|| obj::begins_like_obj(head).then_some(Format::Obj))
}

/// The triangles of a convex polygon: a fan from its first corner.
fn fan(polygon: &[Vec3]) -> impl Iterator<Item = Facet> + '_ {
    (2..polygon.len()).map(|k| [polygon[0], polygon[k - 1], polygon[k]])
}

fn parsed(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

fn wrong(file: &Path, place: impl Into<String>, found: impl Into<String>, remedy: &str) -> Error {
    Error::input(file, place, found, remedy)
}

//! ESRI ASCII grids, and triangles from grids of heights.

use crate::count::number_of;
use crate::error::{Error, Result};
use crate::file::{self, LONGEST_MESH};
use crate::gis::FARTHEST_M;
use crate::rock::Vec3;
use crate::terrain::facets::{Facet, Facets};
use lattice::Lattice;
use std::fmt::Write;
use std::path::Path;

/// A grid of heights at the centres of square cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Number of columns, from west to east.
    pub columns: usize,
    /// Number of rows, from **north to south** as in the file.
    pub rows: usize,
    /// Map position (m) of the lower left (south-west) **corner** of the grid.
    pub corner_m: [f64; 2],
    /// Side of a cell (m), positive.
    pub cell_m: f64,
    /// Values row by row, the northern row first; `None` = no data.
    pub values: Vec<Option<f64>>,
}

/// Sides of cells that a slope may have (m).
const SMALLEST_CELL_M: f64 = 1e-3;
/// Side of a cell of a centimetre in degrees: smaller ones are none.
const SMALLEST_CELL_DEG: f64 = 1e-7;
/// Sides of cells that a slope may have (m).
const LARGEST_CELL_M: f64 = 1e5;
/// Heights beyond this (m) are no height on Earth.
const HIGHEST_M: f64 = 1e5;

/// Share of a cell (–) that rounding of its place can never reach: 1e-5 of the smallest cell at the farthest place.
const ROUNDING_OF_CELL: f64 = 1e-3;

/// Heights (m) that mean "no data" more often than a height.
pub(super) const USUAL_NODATA: [f64; 2] = [-9999.0, -999.0];

/// Number written for "no data".
const NODATA: f64 = -9999.0;

impl Grid {
    /// The value in a column (from the west) and row (from the north).
    pub fn value(&self, column: usize, row: usize) -> Option<f64> {
        self.values[row * self.columns + column]
    }

    /// Map position of a cell's centre (m).
    pub fn centre_m(&self, column: usize, row: usize) -> [f64; 2] {
        let from_south = (self.rows - row) as f64 - 0.5;
        [
            self.corner_m[0] + (column as f64 + 0.5) * self.cell_m,
            self.corner_m[1] + from_south * self.cell_m,
        ]
    }

    /// The whole-metre map position near the middle of the grid (z at the lowest value): what to subtract before
    /// writing STL.
    pub fn map_origin_m(&self) -> Vec3 {
        let half = |count: usize| 0.5 * count as f64 * self.cell_m;
        let lowest = self.values.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let middle = Vec3::new(
            self.corner_m[0] + half(self.columns),
            self.corner_m[1] + half(self.rows),
            lowest,
        );
        middle.map(|x| if x.is_finite() { x.floor() } else { 0.0 })
    }

    /// The surface through the cell centres as facets around `map_origin_m`, see [`triangulate`].
    ///
    /// The origin is subtracted from the corner before a cell's place is added: no digit of the grid is lost to the size
    /// of map coordinates.
    pub fn facets(&self, map_origin_m: Vec3) -> Vec<Facet> {
        self.surface(map_origin_m).iter().collect()
    }

    /// The same facets over common points: those of all cells, with or without a height.
    pub(super) fn surface(&self, map_origin_m: Vec3) -> Facets {
        let point = |column: usize, row_from_south: usize| {
            let z = self.value(column, self.rows - 1 - row_from_south)?;
            Some(self.centre_around(column, row_from_south, map_origin_m, z))
        };
        Lattice::of(self.columns, self.rows, point).cut(self.apart_m(), |_, _| true)
    }

    /// Cell centres around any origin are farther apart than this (m): by a cell, less what rounding can take.
    fn apart_m(&self) -> f64 {
        (1.0 - ROUNDING_OF_CELL) * self.cell_m
    }

    /// A cell's centre at the height `z_m` of the map, around `map_origin_m`.
    fn centre_around(
        &self,
        column: usize,
        row_from_south: usize,
        map_origin_m: Vec3,
        z_m: f64,
    ) -> Vec3 {
        let corner_m = [self.corner_m[0] - map_origin_m.x, self.corner_m[1] - map_origin_m.y];
        let [x, y] = [(corner_m[0], column), (corner_m[1], row_from_south)]
            .map(|(corner, cells)| corner + (cells as f64 + 0.5) * self.cell_m);
        Vec3::new(x, y, z_m - map_origin_m.z)
    }

    /// Refuses cells of no size that a terrain has, as those of a grid in degrees; `epsg` is the scene's code.
    pub(super) fn check_cells(&self, file: &Path, epsg: Option<u32>) -> Result<()> {
        let (cell, [x, y]) = (self.cell_m, self.corner_m);
        if (SMALLEST_CELL_M..=LARGEST_CELL_M).contains(&cell) {
            return Ok(());
        }
        let wrong =
            |found: String, remedy: &str| Err(Error::input(file, "cellsize", found, remedy));
        if (SMALLEST_CELL_DEG..SMALLEST_CELL_M).contains(&cell)
            && x.abs() <= 360.0
            && y.abs() <= 90.0
        {
            let code = epsg.map_or_else(|| "CODE".to_owned(), |code| code.to_string());
            let remedy = format!(
                "write it in metres: gdalwarp -s_srs EPSG:4326 -t_srs EPSG:{code} -tr 1 1 -r bilinear {} out.tif",
                file.display()
            );
            return wrong(
                format!("found {cell} at ({x}, {y}), like longitude and latitude"),
                &remedy,
            );
        }
        wrong(format!("found {cell:e}"), "write metres, from 0.001 to 100000")
    }

    /// Whether it can be a slope: cells and heights of this world, and at least one triangle.
    ///
    /// # Errors
    /// If not, with what is wrong.
    pub fn check_slope(&self, file: &Path) -> Result<()> {
        let wrong = |place: &str, found: String, remedy: &str| {
            Err(Error::input(file, place, found, remedy))
        };
        self.check_cells(file, None)?;
        if let Some(far) = self.corner_m.iter().find(|m| m.abs() > FARTHEST_M) {
            let found = format!("found {far:e}");
            return wrong("xllcorner, yllcorner", found, "write map coordinates within 1e8 m");
        }
        if let Some(high) = self.values.iter().flatten().find(|m| m.abs() > HIGHEST_M) {
            let remedy = "write metres within 100000, and NODATA_value where there is none";
            return wrong("heights", format!("found {high:e}"), remedy);
        }
        let heights = self.values.iter().flatten().count();
        if self.surface(Vec3::zeros()).is_empty() {
            let found = format!(
                "found {heights} heights in {} x {} cells, and no three that make a triangle",
                self.columns, self.rows
            );
            return wrong(
                "heights",
                found,
                "write a grid of at least 2 x 2 heights beside each other",
            );
        }
        Ok(())
    }

    /// Reads an ESRI ASCII grid: `xllcorner` or `xllcenter`, keywords in any case and order.
    ///
    /// # Errors
    /// A missing or unknown keyword, or a number that is missing, superfluous or unreadable, with its line.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = file::read(path, LONGEST_MESH)?;
        Self::parse(&String::from_utf8_lossy(&bytes), path)
    }

    /// Reads the text of an ESRI ASCII grid; `file` is for messages.
    ///
    /// # Errors
    /// As [`Grid::read`].
    pub fn parse(text: &str, file: &Path) -> Result<Self> {
        let (header, data_line) = Header::parse(text, file)?;
        let (columns, rows) = (header.columns, header.rows);
        let mut values = Vec::new();
        for (number, line) in text.lines().enumerate().skip(data_line) {
            for word in line.split_ascii_whitespace() {
                let value =
                    word.parse().ok().filter(|x: &f64| x.is_finite() || header.is_nodata(*x));
                let value = value.ok_or_else(|| {
                    let found = format!("`{word}` is not a finite number");
                    Error::input(file, line_name(number), found, "write heights like 1063.95")
                })?;
                if header.nodata.is_none() && USUAL_NODATA.contains(&value) {
                    let found = format!("found a height of {word} m");
                    let remedy = format!(
                        "if that means no data, write the line `NODATA_value {word}` below `cellsize`"
                    );
                    return Err(Error::input(file, line_name(number), found, remedy));
                }
                values.push((!header.is_nodata(value)).then_some(value));
            }
            if values.len() > columns * rows {
                let found = format!("more than ncols x nrows = {columns} x {rows} values");
                return Err(Error::input(
                    file,
                    line_name(number),
                    found,
                    "correct ncols and nrows",
                ));
            }
        }
        if values.len() < columns * rows {
            let found = number_of(values.len() as u64, "value");
            let found = format!("{found} for ncols x nrows = {columns} x {rows}");
            let place = format!("line {} (the last)", text.lines().count());
            return Err(Error::input(
                file,
                place,
                found,
                "the file is cut off, or correct ncols and nrows",
            ));
        }
        Ok(Self { columns, rows, corner_m: header.corner_m, cell_m: header.cell_m, values })
    }

    /// The grid as ESRI ASCII text, `xllcorner` form, no data = −9999, shortest digits that read back the same.
    pub fn text(&self) -> String {
        let mut text = format!(
            "ncols {}\nnrows {}\nxllcorner {:?}\nyllcorner {:?}\ncellsize {:?}\nNODATA_value {NODATA}\n",
            self.columns, self.rows, self.corner_m[0], self.corner_m[1], self.cell_m
        );
        for row in self.values.chunks(self.columns.max(1)) {
            for (column, value) in row.iter().enumerate() {
                let blank = if column == 0 { "" } else { " " };
                let _ = write!(text, "{blank}{}", value.unwrap_or(NODATA)); // a String takes everything
            }
            text.push('\n');
        }
        text
    }

    /// Writes an ESRI ASCII grid.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        file::write(path, self.text().as_bytes())
    }
}

fn line_name(index: usize) -> String {
    format!("line {}", index + 1)
}

/// The keywords at the start of the file.
struct Header {
    columns: usize,
    rows: usize,
    corner_m: [f64; 2],
    cell_m: f64,
    nodata: Option<f64>,
}

/// Keywords and where their value goes.
const KEYWORDS: [&str; 8] = [
    "ncols",
    "nrows",
    "cellsize",
    "nodata_value",
    "xllcorner",
    "yllcorner",
    "xllcenter",
    "yllcenter",
];

impl Header {
    /// Reads keywords until the first line that begins with a number; returns that line's index too.
    fn parse(text: &str, file: &Path) -> Result<(Self, usize)> {
        let mut found: [Option<f64>; 8] = [None; 8];
        let mut data_line = 0;
        for (number, line) in text.lines().enumerate() {
            let mut words = line.trim_start_matches('\u{feff}').split_ascii_whitespace();
            let Some(keyword) = words.next() else { continue };
            data_line = number;
            if keyword.parse::<f64>().is_ok() {
                break;
            }
            let place = KEYWORDS.iter().position(|known| known.eq_ignore_ascii_case(keyword));
            let value = words.next().and_then(|word| word.parse().ok());
            let (Some(place), Some(value), None) = (place, value, words.next()) else {
                let remedy = format!("write one of {} and one number", KEYWORDS.join(", "));
                return Err(Error::input(
                    file,
                    line_name(number),
                    format!("`{}`", clipped(line)),
                    remedy,
                ));
            };
            found[place] = Some(value);
        }
        Ok((Self::from_values(found, file)?, data_line))
    }

    fn from_values(found: [Option<f64>; 8], file: &Path) -> Result<Self> {
        let lacks = |keyword: &str, value: Option<f64>| {
            let remedy =
                "an ESRI ASCII grid begins with ncols, nrows, xllcorner, yllcorner, cellsize";
            let found = value.map_or_else(String::new, |value| format!(": found {value}"));
            Error::input(file, "header", format!("no usable `{keyword}`{found}"), remedy)
        };
        let [columns, rows, cell, nodata, x_corner, y_corner, x_centre, y_centre] = found;
        let count = |value: Option<f64>, keyword: &str| {
            // 1e9 columns: beyond any grid, and columns x rows fits usize
            let usable = value.filter(|n| (1.0..1e9).contains(n) && n.fract() == 0.0);
            usable.map(|n| n as usize).ok_or_else(|| lacks(keyword, value))
        };
        let cell_m =
            cell.filter(|m| *m > 0.0 && m.is_finite()).ok_or_else(|| lacks("cellsize", cell))?;
        let place = |corner: Option<f64>, centre: Option<f64>, keyword: &str| {
            let place = corner.or(centre.map(|m| m - 0.5 * cell_m));
            place.filter(|m| m.is_finite()).ok_or_else(|| lacks(keyword, place))
        };
        Ok(Self {
            columns: count(columns, "ncols")?,
            rows: count(rows, "nrows")?,
            corner_m: [
                place(x_corner, x_centre, "xllcorner")?,
                place(y_corner, y_centre, "yllcorner")?,
            ],
            cell_m,
            nodata,
        })
    }

    fn is_nodata(&self, value: f64) -> bool {
        // Bits, so that `nodata_value nan` works too; the same text gives the same bits.
        self.nodata.is_some_and(|nodata| nodata.to_bits() == value.to_bits())
    }
}

/// Whether bytes begin like an ESRI ASCII grid.
pub(super) fn begins_like_grid(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(64)]);
    let word = head.trim_start_matches('\u{feff}').split_ascii_whitespace().next();
    word.is_some_and(|word| KEYWORDS.iter().any(|known| known.eq_ignore_ascii_case(word)))
}

/// A part was asked for in which a file has no cells; `outline` is what it has: west, south, east, north (m).
pub(super) fn nothing_there(file: &Path, [west, south, east, north]: [f64; 4]) -> Error {
    let found = format!(
        "found no cells of the file there: it has {west}..{east} east, {south}..{north} north"
    );
    Error::input(file, "crop", found, "write map coordinates inside the file")
}

fn clipped(line: &str) -> String {
    line.chars().take(40).collect()
}

mod lattice;
mod mosaic;
mod window;

pub use lattice::triangulate;
pub(super) use mosaic::Standing;

#[cfg(feature = "cloud")]
pub(super) use window::{BoxM, distance};

#[cfg(test)]
mod tests;

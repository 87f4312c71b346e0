//! ESRI ASCII grids, the one raster format that every GIS and every editor opens.

use super::GroundRaster;
use crate::error::{Error, Result};
use crate::output::{add_checksums, write_atomic, write_ground};
use crate::terrain::geotiff::{Image, NO_DATA};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// File names below the result folder.
const GROUND: &str = "maps/ground.asc";
const TREES: &str = "maps/trees.asc";

impl GroundRaster {
    /// Writes `maps/ground.asc` and `maps/trees.asc` (1 = a tree stands in the cell) below `dir`.
    ///
    /// # Errors
    /// When a file or the folder cannot be written.
    pub fn write(&self, dir: &Path) -> Result<()> {
        let maps = dir.join("maps");
        fs::create_dir_all(&maps).map_err(Error::file("create", &maps))?;
        let height = |i: usize| {
            if self.height_m[i].is_finite() { self.height_m[i] } else { f64::from(NO_DATA) }
        };
        let tree = |i: usize| f64::from(u8::from(self.trees[i]));
        self.write_grid(&dir.join(GROUND), height)?;
        self.write_grid(&dir.join(TREES), tree)
    }

    /// The same beside finished results, whose checksums then hold both grids.
    ///
    /// # Errors
    /// When a file or the folder cannot be written.
    pub fn write_with_checksums(&self, dir: &Path) -> Result<()> {
        self.write(dir)?;
        add_checksums(dir, &[GROUND, TREES])
    }

    /// Writes `maps/ground.tif`.
    ///
    /// # Errors
    /// When the file or the folder cannot be written.
    pub fn write_tif(&self, dir: &Path, epsg: Option<u32>) -> Result<()> {
        let height = |&z: &f64| if z.is_finite() { z as f32 } else { NO_DATA };
        let rows = self.height_m.chunks(self.columns).rev();
        let values: Vec<f32> = rows.flatten().map(height).collect();
        let north_m = self.south_m + self.rows() as f64 * self.cell_m;
        write_ground(
            dir,
            &Image {
                corner_m: [self.west_m, north_m],
                cell_m: self.cell_m,
                columns: self.columns as u32,
                rows: self.rows() as u32,
                epsg,
                nodata: NO_DATA,
                said: None,
                values: &values,
            },
        )
    }

    fn write_grid(&self, path: &Path, value: impl Fn(usize) -> f64) -> Result<()> {
        let mut text = format!(
            "ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value {NO_DATA}\n",
            self.columns,
            self.rows(),
            self.west_m,
            self.south_m,
            self.cell_m
        );
        // the format runs from north to south
        for row in (0..self.rows()).rev() {
            for column in 0..self.columns {
                let gap = if column == 0 { "" } else { " " };
                // writing to a string cannot fail
                let _ = write!(text, "{gap}{}", value(row * self.columns + column));
            }
            text.push('\n');
        }
        write_atomic(path, text.as_bytes())
    }

    /// Reads back what [`GroundRaster::write`] wrote: the same raster, bit for bit. `Ok(None)` when there is no `maps/ground.asc`.
    ///
    /// # Errors
    /// When a file is there but cannot be read, is not a grid, or when the two grids do not match.
    pub fn read(dir: &Path) -> Result<Option<Self>> {
        let path = dir.join(GROUND);
        if !path.exists() {
            return Ok(None);
        }
        let mut raster = read_grid(&path)?;
        let path = dir.join(TREES);
        if path.exists() {
            let trees = read_grid(&path)?;
            if (trees.columns, trees.rows()) != (raster.columns, raster.rows()) {
                let found = format!("{} columns, {} rows", trees.columns, trees.rows());
                let remedy = format!("write the size of {GROUND}, or remove the file");
                return Err(Error::input(&path, "ncols, nrows", found, remedy));
            }
            raster.trees = trees.height_m.iter().map(|&z| z > 0.0).collect();
        }
        Ok(Some(raster))
    }
}

fn read_grid(path: &Path) -> Result<GroundRaster> {
    let text = fs::read_to_string(path).map_err(Error::file("read", path))?;
    let mut words = text.split_ascii_whitespace();
    let mut header = |name: &str| -> Result<f64> {
        let (key, value) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
        let number = value.parse::<f64>().ok().filter(|v| v.is_finite());
        number.filter(|_| key.eq_ignore_ascii_case(name)).ok_or_else(|| {
            Error::input(path, name, format!("`{key} {value}`"), format!("write `{name} NUMBER`"))
        })
    };
    let (columns, rows) = (header("ncols")?, header("nrows")?);
    let (west_m, south_m) = (header("xllcorner")?, header("yllcorner")?);
    let (cell_m, no_data) = (header("cellsize")?, header("NODATA_value")?);
    if !(columns >= 1.0 && rows >= 1.0 && columns * rows <= 1e9 && cell_m > 0.0) {
        let found = format!("{columns} × {rows} cells of {cell_m}");
        return Err(Error::input(path, "header", found, "write positive sizes"));
    }
    let (columns, rows) = (columns as usize, rows as usize);
    let values = read_values(path, words, no_data)?;
    if values.len() != columns * rows {
        let found = format!("{} values", values.len());
        let remedy = format!("write ncols × nrows = {}", columns * rows);
        return Err(Error::input(path, "values", found, remedy));
    }
    // the format runs from north to south
    let height_m: Vec<f64> = values.chunks(columns).rev().flatten().copied().collect();
    let trees = vec![false; height_m.len()];
    Ok(GroundRaster { west_m, south_m, cell_m, columns, height_m, trees })
}

fn read_values<'a>(
    path: &Path,
    words: impl Iterator<Item = &'a str>,
    no_data: f64,
) -> Result<Vec<f64>> {
    let read = |(i, word): (usize, &str)| match word.parse::<f64>() {
        Ok(z) if z.total_cmp(&no_data).is_eq() => Ok(f64::NAN),
        Ok(z) => Ok(z),
        Err(_) => {
            let place = format!("value {}", i + 1);
            Err(Error::input(path, place, format!("`{word}`"), "write a number"))
        }
    };
    words.enumerate().map(read).collect()
}

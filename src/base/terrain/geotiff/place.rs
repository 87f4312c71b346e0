//! Where the cells of a GeoTIFF lie: pixel scale and tie point or transformation, area or point, coordinate system.

use super::{Implausible, LOWEST_M, Window, damaged, tag, translate};
use crate::error::{Error, Result};
use crate::gis::FARTHEST_M;
use crate::terrain::grid::{Grid, USUAL_NODATA};
use std::io::{Read, Seek};
use std::path::Path;
use tiff::decoder::Decoder;
use tiff::tags::Tag;

/// Keys of the directory (OGC 19-008r4, annex B).
mod key {
    pub(super) const MODEL_TYPE: u16 = 1024;
    pub(super) const RASTER_TYPE: u16 = 1025;
    pub(super) const PROJECTED: u16 = 3072;
    pub(super) const LINEAR_UNITS: u16 = 3076;
    pub(super) const VERTICAL: u16 = 4096;
    pub(super) const VERTICAL_UNITS: u16 = 4099;
}

/// `GTModelType` of longitude and latitude.
const GEOGRAPHIC: u16 = 2;
/// `GTModelType` of coordinates from the middle of the Earth.
const GEOCENTRIC: u16 = 3;
/// `GTRasterType`: heights belong to the points at the pixels' upper left corners, not to areas.
const PIXEL_IS_POINT: u16 = 2;
/// EPSG code of the metre.
const METRE: u16 = 9001;
/// Vertical systems with heights in feet (EPSG registry, v10): GDAL writes their code and no unit.
const IN_FEET: [u16; 9] = [5702, 5754, 6130, 6131, 6132, 6360, 8050, 8052, 8228];
/// "Defined by the user": no EPSG code.
const USER_DEFINED: u16 = 32_767;
/// Relative difference of width and height up to which a cell is square (–): digits of a writer.
const SQUARE: f64 = 1e-6;

/// Where the cells of an image lie.
#[derive(Debug)]
pub(super) struct ImagePlacement {
    /// Map position of the outer corner of the first pixel (m).
    first_m: [f64; 2],
    cell_m: f64,
    /// Whether rows run from south to north; nearly always they run from north to south.
    northward: bool,
    /// EPSG code of the projected system.
    pub(super) epsg: Option<u32>,
    nodata: Option<f64>,
    /// Unit of the values where it is not the metre.
    pub(super) unit: Option<String>,
}

impl ImagePlacement {
    pub(super) fn read<R: Read + Seek>(
        decoder: &mut Decoder<R>,
        file: &Path,
        epsg: Option<u32>,
    ) -> Result<Self> {
        let keys = GeoKeys::read(decoder, file)?;
        let warp = warp(file, epsg.or(keys.epsg()));
        keys.check(file, &warp)?;
        let unit = unscaled(decoder, file)?;
        let [x_m, dx_m, y_m, dy_m] = transform(decoder, file, &warp)?;
        let wrong = |found: String| Error::input(file, "georeference", found, warp.as_str());
        if !(x_m.abs() < FARTHEST_M && y_m.abs() < FARTHEST_M) {
            return Err(wrong(format!("found the first pixel at ({x_m}, {y_m})")));
        }
        if !(dx_m > 0.0 && dx_m < FARTHEST_M && (dx_m - dy_m.abs()).abs() <= SQUARE * dx_m) {
            return Err(wrong(format!("found cells of {dx_m} x {} m, not square", dy_m.abs())));
        }
        // A point stands in the middle of its cell: the cell begins half a cell before it.
        let half = if keys.get(key::RASTER_TYPE) == Some(PIXEL_IS_POINT) { 0.5 } else { 0.0 };
        Ok(Self {
            first_m: [x_m - half * dx_m, y_m - half * dy_m],
            cell_m: dx_m,
            northward: dy_m > 0.0,
            epsg: keys.epsg(),
            nodata: nodata(decoder, file)?,
            unit,
        })
    }

    /// The window of the image that covers a box; all of it without one.
    pub(super) fn window(&self, (width, height): (u32, u32), box_m: Option<[f64; 4]>) -> Window {
        let Some([west, south, east, north]) = box_m else { return [0, 0, width, height] };
        let span = |low: f64, high: f64, count: u32| {
            // a cell more on each side: triangles run from centre to centre
            let first = (low.floor() - 1.0).clamp(0.0, count.into());
            let end = (high.ceil() + 1.0).clamp(first, count.into());
            (first as u32, (end - first) as u32)
        };
        let [x, y] = self.first_m;
        let (first_column, columns) =
            span((west - x) / self.cell_m, (east - x) / self.cell_m, width);
        let (low, high) =
            if self.northward { (south - y, north - y) } else { (y - north, y - south) };
        let (first_row, rows) = span(low / self.cell_m, high / self.cell_m, height);
        [first_column, first_row, columns, rows]
    }

    /// West, south, east and north of the whole image (m).
    pub(super) fn outline(&self, (width, height): (u32, u32)) -> [f64; 4] {
        let [x, y] = self.first_m;
        let (wide, high) = (f64::from(width) * self.cell_m, f64::from(height) * self.cell_m);
        if self.northward { [x, y, x + wide, y + high] } else { [x, y - high, x + wide, y] }
    }

    /// The grid of a window, northern row first.
    pub(super) fn grid(&self, window: Window, mut values: Vec<Option<f64>>) -> Grid {
        let [first_column, first_row, columns, rows] = window;
        let [x, y] = self.first_m;
        let south_m = if self.northward {
            values = values.chunks(columns.max(1) as usize).rev().flatten().copied().collect();
            y + f64::from(first_row) * self.cell_m
        } else {
            y - f64::from(first_row + rows) * self.cell_m
        };
        Grid {
            columns: columns as usize,
            rows: rows as usize,
            corner_m: [x + f64::from(first_column) * self.cell_m, south_m],
            cell_m: self.cell_m,
            values,
        }
    }

    /// A height, or none where the file says so.
    pub(super) fn height_m(&self, found: f64) -> std::result::Result<Option<f64>, Implausible> {
        // A no-data value in few digits stands for the same 32-bit number.
        let is_nodata = |nodata: f64| {
            found.to_bits() == nodata.to_bits()
                || (found as f32).to_bits() == (nodata as f32).to_bits()
        };
        if found.is_nan() || self.nodata.is_some_and(is_nodata) {
            return Ok(None);
        }
        if found.is_infinite() {
            return Err(Implausible::Infinite);
        }
        if found < LOWEST_M || (self.nodata.is_none() && USUAL_NODATA.contains(&found)) {
            return Err(Implausible::Undeclared);
        }
        Ok(Some(found))
    }
}

/// Position and size of the first pixel: x, width, y, height (m); a height below 0 runs south.
fn transform<R: Read + Seek>(
    decoder: &mut Decoder<R>,
    file: &Path,
    warp: &str,
) -> Result<[f64; 4]> {
    let mut list = |number: u16| {
        let found = decoder.find_tag(Tag::from_u16_exhaustive(number));
        found.ok().flatten().and_then(|value| value.into_f64_vec().ok())
    };
    let [scale, ties, matrix] =
        [tag::MODEL_PIXEL_SCALE, tag::MODEL_TIEPOINT, tag::MODEL_TRANSFORMATION].map(&mut list);
    let refused = |place: &str, found: &str| Err(Error::input(file, place, found, warp));
    if let Some(matrix) = matrix {
        let &[dx, xy, _, x, yx, dy, _, y, ..] = matrix.as_slice() else {
            return refused("ModelTransformation", "found fewer than 8 numbers");
        };
        let small = SQUARE * dx.abs();
        // written so that NaN is refused too
        if !(xy.abs() <= small && yx.abs() <= small && dx > 0.0) {
            return refused("ModelTransformation", "found a rotated or mirrored grid");
        }
        return Ok([x, dx, y, dy]);
    }
    match (scale.as_deref(), ties.as_deref()) {
        (Some([dx, dy, ..]), Some([i, j, _, x, y, _])) => Ok([x - i * dx, *dx, y + j * dy, -dy]),
        (_, Some(_)) => refused(
            "ModelTiepoint",
            "found control points instead of one tie point and a pixel scale",
        ),
        _ => {
            let remedy = format!(
                "write where it lies: {} -a_srs EPSG:CODE -a_ullr WEST NORTH EAST SOUTH",
                translate(file)
            );
            Err(Error::input(file, "georeference", "found none", remedy))
        }
    }
}

/// The unit that GDAL's metadata name, if it is not the metre.
fn unit_of_heights(metadata: &str) -> Option<&str> {
    let (_, rest) = metadata.split_once("role=\"unittype\"")?;
    let (_, rest) = rest.split_once('>')?;
    let unit = rest.split('<').next()?.trim();
    let is_metre =
        ["", "m", "metre", "metres", "meter", "meters"].contains(&unit.to_lowercase().as_str());
    (!is_metre).then_some(unit)
}

/// Refuses values that are stored times a scale or plus an offset; their unit, if it is not the metre.
fn unscaled<R: Read + Seek>(decoder: &mut Decoder<R>, file: &Path) -> Result<Option<String>> {
    let tag = Tag::from_u16_exhaustive(tag::GDAL_METADATA);
    let text = decoder.find_tag(tag).ok().flatten().and_then(|value| value.into_string().ok());
    let unit = text.as_deref().and_then(unit_of_heights).map(str::to_owned);
    let scaled =
        |text: &String| ["role=\"scale\"", "role=\"offset\""].iter().any(|w| text.contains(w));
    if !text.as_ref().is_some_and(scaled) {
        return Ok(unit);
    }
    let remedy = format!("write the heights themselves: {} -unscale -ot Float32", translate(file));
    Err(Error::input(file, "GDAL_METADATA", "found heights with a scale or an offset", remedy))
}

fn nodata<R: Read + Seek>(decoder: &mut Decoder<R>, file: &Path) -> Result<Option<f64>> {
    let tag = Tag::from_u16_exhaustive(tag::GDAL_NODATA);
    let Some(value) = decoder.find_tag(tag).map_err(|why| damaged(file, &why))? else {
        return Ok(None);
    };
    let text = value.into_string().unwrap_or_default();
    let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
    if let Ok(number) = text.parse() {
        return Ok(Some(number));
    }
    let remedy = format!("write a number: gdal_edit.py -a_nodata -9999 {}", file.display());
    Err(Error::input(file, "GDAL_NODATA", format!("found `{text}`"), remedy))
}

/// The directory of keys: key, tag of its value, count, value or offset.
struct GeoKeys(Vec<[u16; 4]>);

impl GeoKeys {
    fn read<R: Read + Seek>(decoder: &mut Decoder<R>, file: &Path) -> Result<Self> {
        let tag = Tag::from_u16_exhaustive(tag::GEO_KEY_DIRECTORY);
        let value = decoder.find_tag(tag).map_err(|why| damaged(file, &why))?;
        let numbers = match value.map(tiff::decoder::ifd::Value::into_u16_vec) {
            None => return Ok(Self(Vec::new())),
            Some(numbers) => numbers.map_err(|why| damaged(file, &why))?,
        };
        let entries = numbers.get(4..).unwrap_or_default();
        Ok(Self(entries.chunks_exact(4).map(|key| [key[0], key[1], key[2], key[3]]).collect()))
    }

    /// The value of a key that stands in the directory itself.
    fn get(&self, key: u16) -> Option<u16> {
        self.0.iter().find(|[id, tag, ..]| *id == key && *tag == 0).map(|key| key[3])
    }

    fn epsg(&self) -> Option<u32> {
        let known = |code: &u16| *code != 0 && *code != USER_DEFINED;
        self.get(key::PROJECTED).filter(known).map(Into::into)
    }

    fn check(&self, file: &Path, warp: &str) -> Result<()> {
        let refused = |place: &str, found: String| Err(Error::input(file, place, found, warp));
        match self.get(key::MODEL_TYPE) {
            Some(GEOGRAPHIC) => {
                return refused(
                    "GTModelType",
                    "found longitude and latitude, which are no metres".into(),
                );
            }
            Some(GEOCENTRIC) => {
                return refused(
                    "GTModelType",
                    "found geocentric coordinates, which have no up".into(),
                );
            }
            _ => {}
        }
        for (name, key) in
            [("ProjLinearUnits", key::LINEAR_UNITS), ("VerticalUnits", key::VERTICAL_UNITS)]
        {
            if let Some(unit) =
                self.get(key).filter(|unit| ![0, METRE, USER_DEFINED].contains(unit))
            {
                let said = match unit {
                    9002 => " (foot)",
                    9003 => " (US survey foot)",
                    _ => "",
                };
                let found = format!("found the unit EPSG:{unit}{said}, not metres (EPSG:{METRE})");
                if key == key::VERTICAL_UNITS {
                    return Err(heights_in_feet(file, found));
                }
                // its own code is that of a system in feet
                let remedy = format!(
                    "{} with the code of a system in metres; heights in feet are left in feet by it",
                    self::warp(file, None)
                );
                return Err(Error::input(file, name, found, remedy));
            }
        }
        match self.get(key::VERTICAL) {
            Some(code) if IN_FEET.contains(&code) => {
                Err(heights_in_feet(file, format!("found heights in feet (EPSG:{code})")))
            }
            _ => Ok(()),
        }
    }
}

/// Heights in another unit are refused; `found` says in which.
pub(super) fn heights_in_feet(file: &Path, found: String) -> Error {
    let remedy = format!(
        "write them in metres: gdal_calc.py -A {} --outfile out.tif --calc A*0.3048, then gdal_edit.py -a_srs EPSG:CODE -units m out.tif with the code of the map alone",
        file.display()
    );
    Error::input(file, "heights", found, remedy)
}

/// The command that makes a north-up grid of square cells in metres.
fn warp(file: &Path, epsg: Option<u32>) -> String {
    let code = epsg.map_or_else(|| "EPSG:CODE".to_owned(), |code| format!("EPSG:{code}"));
    format!("write it anew: gdalwarp -t_srs {code} -tr 1 1 -r bilinear {} out.tif", file.display())
}

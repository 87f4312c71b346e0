//! `[release] table`: blocks one by one, from a CSV file.

use crate::error::{Error, Result};
use crate::file::{self, LONGEST_TEXT};
use serde::Deserialize;
use std::f64::consts::PI;
use std::path::Path;

/// Which column of a release table says how large its blocks are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(expecting = "\"radius_m\" or \"mass_kg\"")]
pub enum SizeFrom {
    /// The radius of the sphere of equal volume.
    #[serde(rename = "radius_m")]
    Radius,
    /// The mass, over the density of the scene.
    #[serde(rename = "mass_kg")]
    Mass,
}

impl SizeFrom {
    /// The name of the column.
    pub const fn column(self) -> &'static str {
        match self {
            Self::Radius => "radius_m",
            Self::Mass => "mass_kg",
        }
    }
}

/// What a row says of a block's size where it says it twice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BothSizes {
    /// Line of the file.
    pub line: u64,
    /// Radius (m).
    pub radius_m: f64,
    /// Mass (kg).
    pub mass_kg: f64,
}

/// One block of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockRow {
    /// Place in plan view (m), map coordinates.
    pub at_m: [f64; 2],
    /// Height of the centre (m), map coordinates; none if `height_m` of the scene says how high.
    pub height_m: Option<f64>,
    /// Radius (m); none if the scene's `radius_m` is drawn.
    pub radius_m: Option<f64>,
    /// Radius and mass as written, where both are.
    pub both: Option<BothSizes>,
    /// Which block it is, from the column `block` or `block_id`.
    pub block: Option<String>,
}

/// Columns of a place, the first that are there: a file of measured ends has the ends under the plain names.
const PLACES: [[&str; 3]; 2] =
    [["release_x_m", "release_y_m", "release_z_m"], ["x_m", "y_m", "z_m"]];
const REMEDY: &str =
    "write numbers under release_x_m, release_y_m (or x_m, y_m), and radius_m or mass_kg if known";

/// Columns of a table by their number.
struct BlockColumns {
    x: usize,
    y: usize,
    z: Option<usize>,
    radius: Option<usize>,
    mass: Option<usize>,
    block: Option<usize>,
}

/// Reads a table. With `has_height` the scene says how high blocks lie, else the table must; a mass becomes the radius of
/// a sphere of the density (kg/m³). Where there are both, the radius counts unless the scene says otherwise.
///
/// # Errors
/// A file that cannot be read, a row without these numbers, no row at all.
pub(super) fn read(
    path: &Path,
    has_height: bool,
    (density_kg_m3, size_from): (f64, Option<SizeFrom>),
) -> Result<Vec<BlockRow>> {
    let table = file::read_table(path, LONGEST_TEXT)?;
    let wrong = |line: u64, found: String| {
        Error::input(path, format!("line {line}"), found, file::table_remedy(&table, REMEDY))
    };
    let mut reader = file::table_reader(&table);
    let headers = reader.headers().cloned().unwrap_or_default();
    let columns = BlockColumns::of(&headers, has_height).map_err(|found| wrong(1, found))?;
    columns.check_size(size_from).map_err(|found| wrong(1, found))?;
    let mut blocks = Vec::new();
    for row in reader.records() {
        let row = row
            .map_err(|why| wrong(file::line_of(&table, why.position()), format!("found {why}")))?;
        let line = file::line_of(&table, row.position());
        let sized = (density_kg_m3, size_from.unwrap_or(SizeFrom::Radius));
        let block = columns.block((line, &row), sized).map_err(|found| wrong(line, found))?;
        blocks.push(block);
    }
    if blocks.is_empty() {
        return Err(Error::input(path, "rows", "found no block", REMEDY));
    }
    Ok(blocks)
}

impl BlockColumns {
    fn of(headers: &csv::StringRecord, has_height: bool) -> std::result::Result<Self, String> {
        let at = |name: &str| headers.iter().position(|header| header == name);
        let lacks =
            || format!("found the columns {}", headers.iter().collect::<Vec<_>>().join(", "));
        let names = PLACES.iter().find(|names| at(names[0]).is_some()).ok_or_else(lacks)?;
        let [x, y, z] = names.map(at);
        let (Some(x), Some(y)) = (x, y) else { return Err(lacks()) };
        let z = z.filter(|_| !has_height);
        if z.is_none() && !has_height {
            return Err(format!("found no column {} and no height_m in the scene", names[2]));
        }
        let block = at("block").or_else(|| at("block_id"));
        Ok(Self { x, y, z, radius: at("radius_m"), mass: at("mass_kg"), block })
    }

    /// The column that the scene asks for must be there.
    fn check_size(&self, size_from: Option<SizeFrom>) -> std::result::Result<(), String> {
        let is_there = |asked: SizeFrom| match asked {
            SizeFrom::Radius => self.radius.is_some(),
            SizeFrom::Mass => self.mass.is_some(),
        };
        size_from.filter(|asked| !is_there(*asked)).map_or(Ok(()), |asked| {
            Err(format!("found no column {}, which [release] size_from names", asked.column()))
        })
    }

    fn block(
        &self,
        (line, row): (u64, &csv::StringRecord),
        (density_kg_m3, size_from): (f64, SizeFrom),
    ) -> std::result::Result<BlockRow, String> {
        let number = |column: usize| {
            let text = row.get(column).unwrap_or_default();
            let number = text.parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| format!("found `{text}` in column {}", column + 1))
        };
        let size = |column: usize| match number(column)? {
            size if size > 0.0 => Ok(size),
            size => Err(format!("found {size} in column {}", column + 1)),
        };
        let of_mass = |mass: f64| crate::math::cbrt(mass / (density_kg_m3 * 4.0 / 3.0 * PI));
        let radius_m = match (self.radius, self.mass, size_from) {
            (_, Some(mass), SizeFrom::Mass) | (None, Some(mass), _) => Some(of_mass(size(mass)?)),
            (Some(radius), ..) => Some(size(radius)?),
            (None, None, _) => None,
        };
        // the one that does not count may be missing
        let written = |column: Option<usize>| column.and_then(|column| size(column).ok());
        let both = written(self.radius)
            .zip(written(self.mass))
            .map(|(radius_m, mass_kg)| BothSizes { line, radius_m, mass_kg });
        let height_m = self.z.map(number).transpose()?;
        let block = self.block.and_then(|column| row.get(column)).map(str::to_owned);
        Ok(BlockRow { at_m: [number(self.x)?, number(self.y)?], height_m, radius_m, both, block })
    }
}

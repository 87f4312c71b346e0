//! What people draw in a GIS: points, lines and polygons with properties, from GeoJSON and Shapefile.
//!
//! Coordinates are map coordinates in metres; a third one is not used. Outlines come out the same from every format:
//! anticlockwise from their south-western corner, holes clockwise.

mod geojson;
mod shapefile;
#[cfg(test)]
mod tests;
pub(crate) mod wkt;

pub use geojson::parse as parse_geojson;
pub use shapefile::parse as parse_shapefile;

use crate::error::{Error, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A point in plan view, in map coordinates: easting and northing (m).
pub type Corner = [f64; 2];

/// Coordinates farther out than this (m) are no place on Earth, as in a mesh.
pub const FARTHEST_M: f64 = 1e8;
/// Names of columns in a Shapefile are cut off after so many bytes.
const COLUMN_BYTES: usize = 10;

/// A polygon; no ring repeats its first corner.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// Its outline (m).
    pub outline_m: Vec<Corner>,
    /// Outlines of its holes (m).
    pub holes_m: Vec<Vec<Corner>>,
}

/// A geometry; several parts of one feature stand together.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// Points (m).
    Points(Vec<Corner>),
    /// Lines (m).
    Lines(Vec<Vec<Corner>>),
    /// Polygons.
    Polygons(Vec<Polygon>),
}

impl Geometry {
    /// What it is, in the plural.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Points(_) => "points",
            Self::Lines(_) => "lines",
            Self::Polygons(_) => "polygons",
        }
    }
}

/// The value of a property.
#[derive(Debug, Clone, PartialEq)]
pub enum PropertyValue {
    /// A finite number.
    Number(f64),
    /// A text.
    Text(String),
}

/// One drawn thing.
#[derive(Debug, Clone, PartialEq)]
pub struct GisFeature {
    /// Where it stands in the file, from 1.
    pub number: usize,
    /// Its geometry.
    pub shape: Geometry,
    /// Its properties by name; empty ones are left out.
    pub properties: BTreeMap<String, PropertyValue>,
}

/// All that a file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct GisLayer {
    /// The file.
    pub file: PathBuf,
    /// EPSG code of its coordinates, where the file names one.
    pub epsg: Option<u32>,
    /// Name of its system, where the file has a name and no code.
    pub system: Option<String>,
    /// Its features with a geometry, in file order.
    pub features: Vec<GisFeature>,
}

impl GisLayer {
    /// West, south, east and north of all features (m).
    pub fn box_m(&self) -> [f64; 4] {
        let corners = self.features.iter().flat_map(|feature| match &feature.shape {
            Geometry::Points(points) => points.clone(),
            Geometry::Lines(lines) => lines.concat(),
            Geometry::Polygons(all) => all.iter().flat_map(|one| one.outline_m.clone()).collect(),
        });
        let nothing = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        corners.fold(nothing, |[west, south, east, north], [x, y]| {
            [west.min(x), south.min(y), east.max(x), north.max(y)]
        })
    }
}

/// Whether a property of a file is read for a name: the same in any case, whole or as a Shapefile cuts it off.
pub fn reads(name: &str, known: &str) -> bool {
    let is_short = name.get(..COLUMN_BYTES).is_some_and(|short| known.eq_ignore_ascii_case(short));
    is_short || known.eq_ignore_ascii_case(name)
}

impl GisFeature {
    /// A property by name in any case, also where a Shapefile has cut the name off.
    pub fn property(&self, name: &str) -> Option<&PropertyValue> {
        let named = |name: &str| self.named(name).next().map(|(_, value)| value);
        let short = name.get(..COLUMN_BYTES);
        self.properties.get(name).or_else(|| named(name)).or_else(|| named(short?))
    }

    /// The properties of a name, however it is written.
    fn named(&self, name: &str) -> impl Iterator<Item = (&String, &PropertyValue)> {
        self.properties.iter().filter(move |(known, _)| known.eq_ignore_ascii_case(name))
    }

    /// Refuses two properties that differ in case alone; `file` is for the message.
    ///
    /// # Errors
    /// If there are two: which one counts is not known.
    pub fn check_one(&self, name: &str, file: &Path) -> Result<()> {
        let mut all = self.named(name).map(|(known, _)| known);
        let (Some(one), Some(other)) = (all.next(), all.next()) else { return Ok(()) };
        let found = format!("found the properties {one} and {other}");
        Err(self.wrong(file, found, "keep one of them: case makes no difference"))
    }

    /// A property in words.
    pub fn text(&self, name: &str) -> Option<String> {
        self.property(name).map(|value| match value {
            PropertyValue::Number(number) => number.to_string(),
            PropertyValue::Text(text) => text.clone(),
        })
    }

    /// A property as a number above 0, or none where there is none.
    ///
    /// # Errors
    /// Another value, or two properties of that name; `file` is for the message.
    pub fn positive(&self, name: &str, file: &Path) -> Result<Option<f64>> {
        self.check_one(name, file)?;
        let number = match self.property(name) {
            None => return Ok(None),
            Some(PropertyValue::Number(number)) => Some(*number),
            Some(PropertyValue::Text(text)) => text.trim().parse().ok(),
        };
        if let Some(number) = number.filter(|number| *number > 0.0 && number.is_finite()) {
            return Ok(Some(number));
        }
        let found = format!("found {name} = {}", self.text(name).unwrap_or_default());
        Err(self.wrong(file, found, "write a number above 0, or leave the property out"))
    }

    /// Something is wrong with this feature.
    pub fn wrong(&self, file: &Path, found: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::input(file, format!("feature {}", self.number), found, remedy)
    }
}

/// Reads a GeoJSON file, or a Shapefile with its table (`.dbf`) and system (`.prj`) beside it.
///
/// # Errors
/// A file that cannot be read or is of another format, coordinates that are no metres of a map, no feature at all.
pub fn read(path: &Path) -> Result<GisLayer> {
    let bytes = crate::file::read(path, crate::file::LONGEST_TEXT)?;
    let layer = if shapefile::begins_like_shapefile(&bytes) {
        let beside = |ending: &str| {
            let file = companion(path, ending);
            file.map(|file| crate::file::read(&file, crate::file::LONGEST_TEXT)).transpose()
        };
        shapefile::parse(&bytes, beside("dbf")?.as_deref(), beside("prj")?.as_deref(), path)?
    } else {
        if let Some((_, kind)) = ELSEWHERE.iter().find(|(mark, _)| bytes.starts_with(mark)) {
            return Err(Error::input(path, "start", format!("found {kind}"), as_geojson(path)));
        }
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes).trim_ascii_start();
        if !text.starts_with(b"{") && !text.starts_with(b"[") {
            let found = "found neither GeoJSON nor a Shapefile (.shp)";
            return Err(Error::input(path, "start", found, as_geojson(path)));
        }
        geojson::parse(&bytes, path)?
    };
    if layer.features.is_empty() {
        let remedy = "draw points, lines or polygons, or leave the file out of the scene";
        return Err(Error::input(path, "features", "found none", remedy));
    }
    Ok(layer)
}

/// Whether bytes begin like a drawing: GeoJSON, a Shapefile, or a `GeoPackage`, which is refused with words.
pub(crate) fn begins_like_drawing(head: &[u8]) -> bool {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    shapefile::begins_like_shapefile(head)
        || text.trim_ascii_start().starts_with(b"{")
        || head.starts_with(ELSEWHERE[0].0)
}

/// How other files begin, and what they are.
const ELSEWHERE: [(&[u8], &str); 4] = [
    (b"SQLite format 3\0", "a GeoPackage"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"<?xml", "an XML file (KML, GML)"),
    (b"<kml", "a KML file"),
];

/// All files that [`read`] reads: a Shapefile is three.
pub fn files(path: &Path) -> Vec<PathBuf> {
    let is_shapefile = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("shp"));
    let beside = ["dbf", "prj"].into_iter().filter(|_| is_shapefile);
    let beside = beside.filter_map(|ending| companion(path, ending));
    std::iter::once(path.to_owned()).chain(beside).collect()
}

/// The file of another ending beside a Shapefile, if it is there.
fn companion(path: &Path, ending: &str) -> Option<PathBuf> {
    let both = [ending.to_owned(), ending.to_uppercase()];
    both.iter().map(|ending| path.with_extension(ending)).find(|file| file.exists())
}

/// A file name to convert into: another one than that of the file.
fn out(path: &Path) -> String {
    let stem = path.file_stem().map_or_else(|| "out".into(), |stem| stem.to_string_lossy());
    let is_taken = path.extension().is_some_and(|ending| ending == "geojson");
    if is_taken { format!("{stem}_map.geojson") } else { format!("{stem}.geojson") }
}

/// What to do about a file of another format.
fn as_geojson(path: &Path) -> String {
    format!("write it as GeoJSON: ogr2ogr {} {}", out(path), path.display())
}

/// The command that brings a file into the system of an EPSG code; `from` is the code of its own system, or empty where the
/// file names it.
pub fn transformed(file: &Path, epsg: Option<u32>, from: &str) -> String {
    let code = epsg.map_or_else(|| "CODE".to_owned(), |code| code.to_string());
    let from = if from.is_empty() { String::new() } else { format!("-s_srs EPSG:{from} ") };
    format!("ogr2ogr {from}-t_srs EPSG:{code} {} {}", out(file), file.display())
}

/// Why a feature without a geometry is refused: left out it would take its events a year, or its stem, with it.
fn without_shape(file: &Path, feature: String) -> Error {
    let remedy = "draw it where it lies, or remove the feature";
    Error::input(file, feature, "found no geometry", remedy)
}

/// Why coordinates in degrees are of no use, and the command that makes metres of them.
fn degrees(file: &Path) -> Error {
    let remedy =
        format!("write it in the map coordinates of the scene: {}", transformed(file, None, ""));
    Error::input(file, "coordinate system", "found longitude and latitude", remedy)
}

/// A place on the map, or what is wrong with it.
fn place(x: f64, y: f64) -> std::result::Result<Corner, String> {
    let fits = |m: f64| (-FARTHEST_M..=FARTHEST_M).contains(&m);
    if fits(x) && fits(y) { Ok([x, y]) } else { Err(format!("found the coordinates ({x}, {y})")) }
}

/// Polygons from rings in any order and direction: every ring that lies in no other is an outline, one that lies in an
/// outline is a hole of it. Of two equal rings the second lies in the first, so that it is no outline of its own.
fn polygons(rings: Vec<Vec<Corner>>) -> Vec<Polygon> {
    let rings: Vec<Vec<Corner>> = rings.into_iter().map(|ring| canonical(ring, true)).collect();
    let depth = |ring: usize| {
        let is_around = |&other: &usize| {
            let is_same = other < ring && rings[other] == rings[ring];
            other != ring && (is_same || encloses(&rings[other], &rings[ring]))
        };
        let around = (0..rings.len()).filter(is_around);
        around.collect::<Vec<usize>>()
    };
    let depths: Vec<Vec<usize>> = (0..rings.len()).map(depth).collect();
    let is_outline = |ring: &usize| depths[*ring].len().is_multiple_of(2);
    let holes_of = |outline: usize| {
        let inside = |ring: &usize| {
            depths[*ring].contains(&outline) && depths[*ring].len() == depths[outline].len() + 1
        };
        (0..rings.len()).filter(inside).map(|ring| canonical(rings[ring].clone(), false)).collect()
    };
    let outlines = (0..rings.len()).filter(is_outline);
    outlines
        .map(|ring| Polygon { outline_m: rings[ring].clone(), holes_m: holes_of(ring) })
        .collect()
}

/// Whether a ring lies inside another one: told by its first corner that does not lie on the other's corners.
fn encloses(ring: &[Corner], other: &[Corner]) -> bool {
    let Some(&[x, y]) = other.iter().find(|corner| !ring.contains(corner)) else { return false };
    let sides = (0..ring.len()).map(|k| (ring[k], ring[(k + 1) % ring.len()]));
    let crosses = |&([ax, ay], [bx, by]): &(Corner, Corner)| {
        (ay <= y) != (by <= y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
    };
    sides.filter(crosses).count() % 2 == 1
}

/// A ring without repeated corners, in the given direction, from its western-most (then southern-most) corner.
fn canonical(mut ring: Vec<Corner>, anticlockwise: bool) -> Vec<Corner> {
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let turning: f64 = (1..ring.len().saturating_sub(1))
        .map(|k| {
            let [u, v] = [ring[k], ring[k + 1]].map(|c| [c[0] - ring[0][0], c[1] - ring[0][1]]);
            u[0] * v[1] - u[1] * v[0]
        })
        .sum();
    if (turning > 0.0) != anticlockwise {
        ring.reverse();
    }
    let first = (0..ring.len())
        .min_by(|&i, &j| ring[i][0].total_cmp(&ring[j][0]).then(ring[i][1].total_cmp(&ring[j][1])));
    ring.rotate_left(first.unwrap_or(0));
    ring
}

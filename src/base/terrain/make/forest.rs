//! A forest from a list of trees, standing on a slope.

use super::stems::FOOT_M;
use super::stems::{Stem, prism, ring};
use crate::count::counted;
use crate::error::{Error, Result};
use crate::file::{self, LONGEST_TEXT};
use crate::gis::{self, Geometry};
use crate::terrain::Terrain;
use crate::terrain::stl::Facet;
use serde::Deserialize;
use std::path::Path;

/// What a list must look like.
const REMEDY: &str =
    "write comma-separated numbers with decimal points under the header x,y,dbh_m,height_m";

/// Largest diameter at breast height and height that are believed (m): the thickest and the tallest known tree have 11.6 m
/// and 116 m. Beyond them a list is in centimetres or feet.
const LARGEST_M: [(&str, f64); 2] = [("dbh_m", 12.0), ("height_m", 120.0)];

/// One row of a list.
#[derive(Debug, Deserialize)]
#[expect(clippy::struct_field_names, reason = "the names are those of the columns")]
struct TreeRow {
    #[serde(alias = "x")]
    x_m: f64,
    #[serde(alias = "y")]
    y_m: f64,
    dbh_m: f64,
    height_m: f64,
}

/// A list of trees.
#[derive(Debug, Clone, PartialEq)]
pub struct TreeList {
    /// Each tree with its line in a text or its number in a drawing.
    trees: Vec<(u64, Stem)>,
    /// `line` or `feature`: what the numbers count.
    counted: &'static str,
    /// EPSG code of its coordinates, where the file names one.
    pub epsg: Option<u32>,
}

/// Whether a file that begins so can be a list of trees: a drawing, or a table with the column `dbh_m`.
pub(in crate::terrain) fn begins_like_list(head: &[u8]) -> bool {
    let line = head.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let names = String::from_utf8_lossy(line);
    gis::begins_like_drawing(head) || names.split(',').any(|name| name.trim() == "dbh_m")
}

/// Whether a file under `[[trees]]` is meant as a list of trees: begins like one, or is a table by its name.
pub(in crate::terrain) fn is_list(path: &Path, head: &[u8]) -> bool {
    let is_table = |ending: &std::ffi::OsStr| {
        ["csv", "tsv", "txt"].iter().any(|one| ending.eq_ignore_ascii_case(one))
    };
    begins_like_list(head) || path.extension().is_some_and(is_table)
}

/// What is wrong with the size of a tree.
fn implausible(stem: &Stem) -> Option<String> {
    let sizes = [stem.dbh_m, stem.height_m];
    let wrong = |value: f64, most: f64| !(value > 0.0 && value <= most);
    let mut found = LARGEST_M.iter().zip(sizes).filter(|((_, most), value)| wrong(*value, *most));
    found.next().map(|((key, _), value)| format!("found {key} = {value}"))
}

/// What to do about such a tree.
const IN_METRES: &str = "write a number above 0, in metres: a stem of 30 cm has dbh_m = 0.3";

/// Points with the properties `dbh_m` and `height_m`.
fn read_drawn(path: &Path) -> Result<TreeList> {
    let layer = gis::read(path)?;
    let mut trees = Vec::new();
    for feature in layer.features {
        let Geometry::Points(points) = &feature.shape else {
            let found = format!("found {}", feature.shape.name());
            return Err(feature.wrong(path, found, "write points"));
        };
        let value = |name: &str| {
            let remedy = "write the properties dbh_m and height_m (m) of every point";
            let lacks = || feature.wrong(path, format!("found no {name}"), remedy);
            feature.positive(name, path)?.ok_or_else(lacks)
        };
        let (dbh_m, height_m) = (value("dbh_m")?, value("height_m")?);
        if let Some(found) = implausible(&Stem { x_m: 0.0, y_m: 0.0, dbh_m, height_m }) {
            return Err(feature.wrong(path, found, IN_METRES));
        }
        let stem = |&[x_m, y_m]: &[f64; 2]| Stem { x_m, y_m, dbh_m, height_m };
        trees.extend(points.iter().map(|point| (feature.number as u64, stem(point))));
    }
    Ok(TreeList { trees, counted: "feature", epsg: layer.epsg })
}

/// Reads a list of trees: a CSV file with the columns `x, y, dbh_m, height_m` (m) in any order, it may have more; or a
/// GeoJSON file or Shapefile of points with the properties `dbh_m` and `height_m`. Each comes with its line or feature.
///
/// # Errors
/// A file that cannot be read, a header or a row without these, a diameter or height that is not above 0 or larger than any tree's, no row at all.
pub fn read_list(path: &Path) -> Result<TreeList> {
    if gis::begins_like_drawing(&file::head(path)?) {
        return read_drawn(path);
    }
    let table = file::read_table(path, LONGEST_TEXT)?;
    let mut reader = file::table_reader(&table);
    let remedy = || file::table_remedy(&table, REMEDY);
    let header = |found: String| Error::input(path, "line 1", found, remedy());
    let headers = reader.headers().map_err(|why| header(format!("found {why}")))?.clone();
    if !headers.is_empty() && headers.iter().all(|name| name != "dbh_m") {
        let found = headers.iter().collect::<Vec<_>>().join(",");
        return Err(header(format!("found the header {found}")));
    }
    let mut trees = Vec::new();
    for row in reader.records() {
        let wrong =
            |line: u64, found: String| Error::input(path, format!("line {line}"), found, remedy());
        let row = row
            .map_err(|why| wrong(file::line_of(&table, why.position()), format!("found {why}")))?;
        let line = file::line_of(&table, row.position());
        let TreeRow { x_m, y_m, dbh_m, height_m } =
            row.deserialize(Some(&headers)).map_err(|_| {
                wrong(line, format!("found {}", row.iter().collect::<Vec<_>>().join(",")))
            })?;
        if !(x_m.is_finite() && y_m.is_finite()) {
            return Err(wrong(line, format!("found a place ({x_m}, {y_m})")));
        }
        let stem = Stem { x_m, y_m, dbh_m, height_m };
        if let Some(found) = implausible(&stem) {
            return Err(Error::input(path, format!("line {line}"), found, IN_METRES));
        }
        trees.push((line, stem));
    }
    if trees.is_empty() {
        return Err(Error::input(path, "rows", "found no tree", REMEDY));
    }
    Ok(TreeList { trees, counted: "line", epsg: None })
}

/// Stems that stand on a slope, and those of their list that do not.
#[derive(Debug, Clone, PartialEq)]
pub struct Planted {
    /// Their facets, in map coordinates (m).
    pub facets: Vec<Facet>,
    /// How many stand.
    pub standing: usize,
    /// What to say of those that are left out, as no ground lies below them; none where all stand.
    pub left_out: Option<String>,
}

impl Planted {
    /// How many stand, in words.
    pub fn stems(&self) -> String {
        format!("{} {}", self.standing, counted(self.standing, "stem", "stems"))
    }
}

/// Eight-sided stems on a slope; everything in the map coordinates of `terrain`.
///
/// A stem's top is its height above the ground at its axis; its foot stays below the lowest ground round it, so that
/// no gap opens on the lower side. A tree with no slope below its axis is left out: lists reach beyond a crop, and terrains have holes.
///
/// # Errors
/// No tree with slope below its axis: then the list is not in the coordinates of the slope. `file` is for the message.
pub fn plant(file: &Path, list: &TreeList, terrain: &Terrain) -> Result<Planted> {
    let origin_m = terrain.origin_m;
    let ground_m =
        |x: f64, y: f64| Some(terrain.ground_below(x - origin_m.x, y - origin_m.y)? + origin_m.z);
    let (mut facets, mut astray) = (Vec::new(), Vec::new());
    for tree in &list.trees {
        let Stem { x_m, y_m, dbh_m, height_m } = tree.1;
        let Some(axis_m) = ground_m(x_m, y_m) else {
            astray.push(tree);
            continue;
        };
        let half_m = 0.5 * dbh_m;
        let around = ring().into_iter();
        let lowest_m = around
            .filter_map(|[x, y]| ground_m(x_m + half_m * x, y_m + half_m * y))
            .fold(axis_m, f64::min);
        facets.extend(prism(&tree.1, [lowest_m - FOOT_M, axis_m + height_m], &ring()));
    }
    let standing = list.trees.len() - astray.len();
    match astray[..] {
        [first, ..] if standing == 0 => Err(list.beside((file, first), terrain)),
        _ => Ok(Planted { facets, standing, left_out: list.left_out(&astray) }),
    }
}

impl TreeList {
    /// What to say of trees without ground; none of none.
    fn left_out(&self, astray: &[&(u64, Stem)]) -> Option<String> {
        let (number, first) = astray.first()?;
        Some(format!(
            "{} of {} stems are left out, as no ground lies below them, the first {} {} {number} at ({}, {}): beside the slope as it is cropped, or over a hole. Where they should stand, look at crop, at the coordinates of the list and at holes of the slope",
            astray.len(),
            self.trees.len(),
            if self.counted == "line" { "in" } else { "as" },
            self.counted,
            first.x_m,
            first.y_m
        ))
    }

    /// Why a list is refused of which no tree stands on the slope.
    fn beside(&self, (file, (number, first)): (&Path, &(u64, Stem)), terrain: &Terrain) -> Error {
        let (low, high) = terrain.index.bounds();
        let (low, high) = (low + terrain.origin_m, high + terrain.origin_m);
        let nor = match self.trees.len() {
            1 => String::new(),
            all => format!(", nor below any other of {all} stems"),
        };
        let found = format!("found no slope at ({}, {}){nor}", first.x_m, first.y_m);
        let remedy = format!(
            "write a place on the slope, its box is {}..{} east, {}..{} north, in map coordinates; a slope file with coordinates of its own needs origin_m in the scene (`mesh stems`: --origin-m)",
            low.x, high.x, low.y, high.y
        );
        Error::input(file, format!("{} {number}", self.counted), found, remedy)
    }
}

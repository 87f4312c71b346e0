//! LAS and LAZ point clouds: the ground points, thinned to the lowest of each cell, joined in plan view.
//!
//! The `las` crate reads both (LAZ through a decoder in pure Rust), `spade` makes the Delaunay triangulation with exact
//! predicates: points in rows and on circles, as thinned clouds have them, are no trouble.

mod announced;
mod decoder;
mod tiles;

use super::facets::Facets;
use super::grid::{BoxM, distance};
use super::options::{Crop, Options, wider};
use super::stl::{Format, Soup};
use crate::error::{Error, Result};
use crate::gis::wkt;
use crate::rock::Vec3;
use decoder::{guarded, with_room};
use las::crs::{GeoTiffData, GeoTiffKeyEntry};
use las::{PointDataBuilder, Reader};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// `ProjLinearUnits` and `VerticalUnits` of GeoTIFF's keys; 9001 is the metre.
const UNIT_KEYS: [u16; 2] = [3076, 4099];
/// ASPRS class of ground.
const GROUND: u8 = 2;
/// Cell of which the lowest point is kept when the scene does not say (m).
const CELL_M: f64 = 1.0;
/// Points that are decoded at once.
const AT_ONCE: u64 = 100_000;
/// Cells to one side of the origin that can be numbered; a cell of a millimetre spans the Earth in fewer.
const MOST_CELLS: f64 = 1e12;

/// The ground points of a file, thinned.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    /// In map coordinates (m), in the order of their cells.
    points_m: Vec<Vec3>,
    pub(super) epsg: Option<u32>,
    cell_m: f64,
    /// Points in the file, and those of the ground classes.
    counts: [u64; 2],
    /// Files that it is of.
    tiles: usize,
}

/// Reads the ground points of a LAS or LAZ file.
///
/// # Errors
/// A file that cannot be read or is damaged, coordinates in degrees, no point of the classes asked for.
pub fn read(path: &Path, options: &Options) -> Result<Cloud> {
    let file = crate::file::open(path, crate::file::LONGEST_MESH)?;
    parse(std::io::BufReader::new(file), path, options)
}

/// Reads the bytes of a LAS or LAZ file; `file` is for messages.
///
/// # Errors
/// As [`read`].
pub fn parse<R>(bytes: R, file: &Path, options: &Options) -> Result<Cloud>
where
    R: std::io::Read + std::io::Seek + Send + Sync + 'static,
{
    with_room(|| decode(bytes, file, options)).map_err(Error::file("decode", file))?
}

fn decode<R>(bytes: R, file: &Path, options: &Options) -> Result<Cloud>
where
    R: std::io::Read + std::io::Seek + Send + Sync + 'static,
{
    let refused = |found: String| {
        let remedy = "the file is damaged: write it again with pdal translate";
        Error::input(file, "LAS", found, remedy)
    };
    let broken = |why: las::Error| refused(format!("found {why}"));
    let given_up = || refused("found what the decoder gives up on".to_owned());
    let mut bytes = bytes;
    announced::check(&mut bytes, file)?;
    let mut reader = guarded(|| Reader::new(bytes)).ok_or_else(given_up)?.map_err(broken)?;
    let epsg = guarded(|| system(&reader, file, options.epsg)).ok_or_else(given_up)??;
    let classes = if options.classes.is_empty() { &[GROUND][..] } else { &options.classes };
    let within = match &options.crop {
        Some(Crop::Box(box_m, margin_m)) => Some(wider(*box_m, *margin_m)),
        _ => None,
    };
    let mut thinner = Thinner::new(options.resample_m.unwrap_or(CELL_M), within);
    let mut part = PointDataBuilder::new().for_header(reader.header()).build();
    loop {
        let filled = guarded(|| reader.fill_points(AT_ONCE, &mut part));
        let count = filled.ok_or_else(given_up)?.map_err(broken)?;
        if count == 0 {
            break;
        }
        let places = part.x().zip(part.y()).zip(part.z());
        for (((x, y), z), class) in places.zip(part.classification()) {
            thinner.take(Vec3::new(x, y, z), class, classes);
        }
    }
    thinner.finish(file, classes, epsg)
}

/// EPSG code of the file's coordinates; degrees are refused.
fn system(reader: &Reader, file: &Path, epsg: Option<u32>) -> Result<Option<u32>> {
    let header = reader.header();
    let refused = || {
        let code = epsg.map_or_else(|| "CODE".to_owned(), |code| code.to_string());
        let remedy = format!(
            "write it in metres: pdal translate {} out.laz reprojection --filters.reprojection.out_srs=EPSG:{code}",
            file.display()
        );
        Err(Error::input(file, "coordinate system", "found longitude and latitude", remedy))
    };
    if let Some(text) = header.get_wkt_crs_bytes() {
        let system = wkt::system(String::from_utf8_lossy(text).trim_end_matches('\0'));
        if let Some(unit) = &system.other_unit {
            return Err(other_unit(file, unit));
        }
        return if system.is_geographic { refused() } else { Ok(system.epsg) };
    }
    let Some(keys) = header.get_geotiff_crs().ok().flatten() else { return Ok(None) };
    if keys.get_gt_model_type_geo_key_value() == Some(2) {
        return refused();
    }
    let is_unit = |entry: &&GeoTiffKeyEntry| UNIT_KEYS.contains(&entry.id);
    for entry in keys.entries.iter().filter(is_unit) {
        if let GeoTiffData::U16(unit @ 9002..=9099) = entry.data {
            return Err(other_unit(file, &format!("EPSG:{unit}")));
        }
    }
    Ok(keys.get_projected_crs_geo_key_value().filter(|code| *code != 32_767).map(Into::into))
}

/// Lengths in another unit than the metre.
fn other_unit(file: &Path, unit: &str) -> Error {
    let remedy = format!(
        "write it in metres: pdal translate {} out.laz reprojection --filters.reprojection.out_srs=EPSG:CODE, and where heights are in feet, assign --filters.assign.value=\"Z = Z * 0.3048\"",
        file.display()
    );
    Error::input(file, "unit", format!("found the unit {unit}, not the metre"), remedy)
}

/// Keeps the lowest point of each cell.
struct Thinner {
    cell_m: f64,
    within: Option<BoxM>,
    lowest: BTreeMap<(i64, i64), Vec3>,
    seen: BTreeSet<u8>,
    counts: [u64; 2],
}

impl Thinner {
    fn new(cell_m: f64, within: Option<BoxM>) -> Self {
        Self { cell_m, within, lowest: BTreeMap::new(), seen: BTreeSet::new(), counts: [0; 2] }
    }

    fn take(&mut self, point: Vec3, class: u8, classes: &[u8]) {
        self.counts[0] += 1;
        self.seen.insert(class);
        let cell = [point.x, point.y].map(|m| (m / self.cell_m).floor());
        let fits = point.z.is_finite() && cell.iter().all(|n| n.abs() < MOST_CELLS);
        let inside = self.within.is_none_or(|box_m| distance(box_m, [point.x, point.y]) <= 0.0);
        if !classes.contains(&class) || !fits {
            return;
        }
        self.counts[1] += 1;
        if inside {
            let kept = self.lowest.entry((cell[0] as i64, cell[1] as i64)).or_insert(point);
            // the first of equally low ones stays
            if point.z < kept.z {
                *kept = point;
            }
        }
    }

    fn finish(self, file: &Path, classes: &[u8], epsg: Option<u32>) -> Result<Cloud> {
        if self.counts[1] == 0 {
            let found = format!(
                "found no point of the classes {classes:?} among {}; there are {:?}",
                self.counts[0], self.seen
            );
            let remedy = "write classes = [...] in the scene, or classify the ground: pdal translate IN OUT smrf";
            return Err(Error::input(file, "classes", found, remedy));
        }
        let points_m = self.lowest.into_values().collect();
        Ok(Cloud { points_m, epsg, cell_m: self.cell_m, counts: self.counts, tiles: 1 })
    }
}

/// A point with its number.
struct Numbered {
    at: Point2<f64>,
    number: usize,
}

impl HasPosition for Numbered {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

impl Cloud {
    /// Its points in map coordinates (m).
    pub fn points_m(&self) -> &[Vec3] {
        &self.points_m
    }

    /// The highest point in a box and a cell around it.
    pub(super) fn highest_in(&self, box_m: BoxM) -> Option<f64> {
        let near = |point: &&Vec3| distance(box_m, [point.x, point.y]) <= self.cell_m;
        self.points_m.iter().filter(near).map(|point| point.z).max_by(f64::total_cmp)
    }

    /// The box of all points that rocks from the starts can come to, as of grids.
    pub(super) fn reached(&self, starts: &[(BoxM, f64)], slope: f64) -> Option<BoxM> {
        let below = |point: &&Vec3| {
            let at = [point.x, point.y];
            starts.iter().any(|&(start, top)| point.z <= top - slope * distance(start, at))
        };
        let mut reached = self.points_m.iter().filter(below).map(|p| [p.x, p.y, p.x, p.y]);
        let first = reached.next()?;
        Some(reached.fold(first, |[west, south, east, north], [x, y, ..]| {
            [west.min(x), south.min(y), east.max(x), north.max(y)]
        }))
    }

    /// The points in a box; all without one.
    #[must_use]
    pub(super) fn cropped(mut self, box_m: Option<BoxM>) -> Self {
        if let Some(box_m) = box_m {
            self.points_m.retain(|point| distance(box_m, [point.x, point.y]) <= 0.0);
        }
        self
    }

    /// Triangles between its points around `map_origin_m`.
    pub(super) fn into_soup(self, file: &Path, map_origin_m: Vec3) -> Result<Soup> {
        let mut soup = Soup::of_format(Format::Cloud);
        soup.epsg = self.epsg;
        let [all, ground] = self.counts;
        soup.notes.push(format!("{all} points, {ground} of them ground"));
        if self.tiles > 1 {
            soup.notes.push(format!("of {} tiles that touch", self.tiles));
        }
        let kept = self.points_m.len();
        soup.notes.push(format!("thinned to {kept}, the lowest of each cell of {} m", self.cell_m));
        let (facets, longest_m) = delaunay(&self.points_m, map_origin_m);
        soup.facets = facets;
        if soup.facets.is_empty() {
            let found = format!("found {kept} points, which make no triangle");
            let remedy = "write a larger crop, or another cloud";
            return Err(Error::input(file, "points", found, remedy));
        }
        soup.notes.push(format!(
            "joined in plan view out to the convex hull, over gaps too: the longest edge is {longest_m:.1} m"
        ));
        Ok(soup)
    }
}

/// The triangles, always in the same order, and the longest edge in plan view (m).
fn delaunay(points_m: &[Vec3], map_origin_m: Vec3) -> (Facets, f64) {
    let local: Vec<Vec3> = points_m.iter().map(|point| point - map_origin_m).collect();
    // the library refuses numbers below 1e-43, which are 0 here
    let plain = |m: f64| if m.abs() < f64::from(f32::MIN_POSITIVE) { 0.0 } else { m };
    let numbered = (0..).zip(&local);
    let numbered =
        numbered.map(|(number, p)| Numbered { at: Point2::new(plain(p.x), plain(p.y)), number });
    let Ok(mesh) = DelaunayTriangulation::<Numbered>::bulk_load(numbered.collect()) else {
        return (Facets::default(), 0.0);
    };
    let mut triangles: Vec<[usize; 3]> = mesh
        .inner_faces()
        .map(|face| lowest_first(face.vertices().map(|vertex| vertex.data().number)))
        .collect();
    triangles.sort_unstable();
    settle_ties(&mut triangles, &local);
    triangles.sort_unstable();
    let corners = triangles.iter().map(|corners| corners.map(|k| k as u32)).collect();
    let facets = Facets::Shared { points: local, corners, apart_m: 0.0 };
    let edges = facets.iter().flat_map(|[a, b, c]| [b - a, c - b, a - c]);
    let longest_m = edges.map(|edge| edge.xy().norm()).fold(0.0, f64::max);
    (facets, longest_m)
}

/// The same triangle from its lowest number.
fn lowest_first(mut corners: [usize; 3]) -> [usize; 3] {
    let first = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
    corners.rotate_left(first);
    corners
}

/// Determinant of four points on one circle, over the fourth power of the longest side (–): rounding of coordinates.
const ON_CIRCLE: f64 = 1e-6;

/// Where four points lie on one circle, as in a lattice, either diagonal between them is Delaunay's: the one whose ends
/// differ less in height is taken, as in the cells of grids.
fn settle_ties(triangles: &mut [[usize; 3]], local: &[Vec3]) {
    let mut sides: Vec<([usize; 2], usize)> = Vec::with_capacity(3 * triangles.len());
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        sides.extend([[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], t)));
    }
    sides.sort_unstable();
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let ([low, high], [one, other]) = (pair[0].0, [pair[0].1, pair[1].1]);
        // an edge that an earlier tie has moved to another triangle is none of these two's
        let third = |t: usize, from: usize, to: usize| {
            let corners = triangles[t];
            (0..3).find_map(|k| {
                let is_side = corners[k] == from && corners[(k + 1) % 3] == to;
                is_side.then_some(corners[(k + 2) % 3])
            })
        };
        let (from, to) = if third(one, low, high).is_some() { (low, high) } else { (high, low) };
        let (Some(left), Some(right)) = (third(one, from, to), third(other, to, from)) else {
            continue;
        };
        let quad = [from, right, to, left].map(|v| local[v]);
        if lie_on_circle(quad) && is_better([quad[1], quad[3]], [quad[0], quad[2]]) {
            triangles[one] = lowest_first([from, right, left]);
            triangles[other] = lowest_first([right, to, left]);
        }
    }
}

fn lie_on_circle(quad: [Vec3; 4]) -> bool {
    let longest2 =
        (0..4).map(|k| (quad[(k + 1) % 4] - quad[k]).xy().norm_squared()).fold(0.0, f64::max);
    let [a, b, c, d] = quad.map(|p| robust::Coord { x: p.x, y: p.y });
    robust::incircle(a, b, c, d).abs() <= ON_CIRCLE * longest2 * longest2
}

/// Whether the first diagonal folds the surface less than the second; of equal ones, the one that runs north-east.
fn is_better([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> bool {
    let (own, other) = ((a.z - b.z).abs(), (c.z - d.z).abs());
    let runs_north_east = |u: Vec3, v: Vec3| (u.x - v.x) * (u.y - v.y) > 0.0;
    own < other || (own <= other && runs_north_east(a, b) && !runs_north_east(c, d))
}

//! `[release]`.

use super::blocks::{BlockRow, SizeFrom};
use super::check::{Allowed, Checked, Complaint, drawn};
use super::frequency::SourceTable;
use super::places::{Area, Corner, Polyline, ReleasePoint};
use super::shapes::Orientation;
use super::zones::Zones;
use crate::random::{Distribution, entries};
use serde::Deserialize;
use std::path::PathBuf;

/// How rocks are released.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [release]")]
pub struct ReleaseTable {
    /// Number of releases, at least 1.
    pub count: usize,
    /// Whether all rocks share one world and can touch each other.
    #[serde(default)]
    pub together: bool,
    /// Vertical gap between the lowest point of the rock and the ground below (m), 0 or more.
    pub height_m: Option<Distribution>,
    /// Velocity of the centre (m/s).
    #[serde(deserialize_with = "entries")]
    pub velocity_m_s: [Distribution; 3],
    /// Angular velocity (rad/s).
    #[serde(deserialize_with = "entries")]
    pub spin_rad_s: [Distribution; 3],
    /// How rocks with a shape are turned; absent = at random.
    pub orientation: Option<Orientation>,
    /// Where: points in map coordinates (m), cycled through.
    pub points_m: Option<Vec<ReleasePoint>>,
    /// Where: uniform along a polyline in map coordinates (m).
    pub line_m: Option<Polyline>,
    /// Where: uniform over an area in map coordinates (m).
    pub polygon_m: Option<Area>,
    /// Where: blocks one by one, from a CSV file; once a [`Scene`](super::Scene) is read, as seen from the working directory.
    pub table: Option<PathBuf>,
    /// Which of a table's two columns of size counts, where it has both; absent = the radius, with a warning where they contradict.
    pub size_from: Option<SizeFrom>,
    /// The blocks of the table, once a scene is read.
    #[serde(skip)]
    pub blocks: Vec<BlockRow>,
    /// Where: points, lines or polygons of a GeoJSON file or Shapefile.
    pub zones: Option<PathBuf>,
    /// What that file holds, once the scene is read.
    #[serde(skip)]
    pub zone_list: Option<Zones>,
}

/// Most releases of one run: their values take 0.1 kB each in memory.
pub const MOST_RELEASES: usize = 1_000_000_000;

/// Boxes that a cell is compared with at most, see [`ReleaseTable::boxes_m`].
const MOST_BOXES: usize = 64;

const WHERE: &str = "write exactly one of points_m, line_m, polygon_m, table and zones";

impl ReleaseTable {
    /// `placed`: the sources of `[frequency]` say where.
    pub(super) fn check(&self, placed: bool) -> Checked {
        if self.count == 0 {
            return Err(Complaint::about("count", "write 1 or more"));
        }
        if self.count > MOST_RELEASES {
            return Err(Complaint::about("count", format!("write at most {MOST_RELEASES}")));
        }
        let given = [
            ("points_m", self.points_m.is_some()),
            ("line_m", self.line_m.is_some()),
            ("polygon_m", self.polygon_m.is_some()),
            ("table", self.table.is_some()),
            ("zones", self.zones.is_some()),
        ];
        let mut given = given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key);
        match (given.next(), given.next()) {
            (None, _) if placed => {}
            (Some(one), _) if placed => {
                let remedy = "remove it: each of [[frequency.sources]] has its place";
                return Err(Complaint::about(one, remedy));
            }
            (None, _) => return Err(Complaint::missing("points_m", WHERE)),
            (Some(one), Some(other)) => {
                let found = format!("found {one} beside it");
                return Err(Complaint::about(other, WHERE).finding(found));
            }
            _ => {}
        }
        if self.size_from.is_some() && self.table.is_none() {
            let remedy = "remove it, or write table = \"blocks.csv\": it says which column of a table counts";
            return Err(Complaint::about("size_from", remedy));
        }
        self.check_height()
    }

    /// Boxes around the places of release and those of `sources` (m): west, south, east, north. One for each of a few
    /// places, else one for all.
    pub(super) fn boxes_m(&self, sources: &[SourceTable]) -> Vec<[f64; 4]> {
        let mut boxes =
            boxes_of(self.points_m.as_deref(), self.line_m.as_ref(), self.polygon_m.as_ref());
        boxes.extend(self.blocks.iter().filter_map(|block| box_of(&[block.at_m])));
        let zones = self.zone_list.iter().flat_map(Zones::list);
        boxes.extend(zones.filter_map(|zone| box_of(&zone.corners_m())));
        boxes.extend(sources.iter().flat_map(|one| {
            boxes_of(one.points_m.as_deref(), one.line_m.as_ref(), one.polygon_m.as_ref())
        }));
        if boxes.len() <= MOST_BOXES {
            return boxes;
        }
        let corners: Vec<Corner> =
            boxes.iter().flat_map(|b| [[b[0], b[1]], [b[2], b[3]]]).collect();
        box_of(&corners).into_iter().collect()
    }

    /// `height_m` and a third coordinate exclude each other, and one of them is needed.
    fn check_height(&self) -> Checked {
        let points = self.points_m.as_deref().unwrap_or_default();
        if self.points_m.is_some() && points.is_empty() {
            return Err(Complaint::about("points_m", "write at least one point"));
        }
        let placed = |point: &&ReleasePoint| point.height_m.is_some();
        match &self.height_m {
            Some(_) if points.iter().any(|point| placed(&point)) => Err(Complaint::about(
                "height_m",
                "remove it, or write the points as [x, y]: their third coordinate already says how high",
            )),
            Some(height) => drawn("height_m", height, Allowed::NotNegative, ""),
            // the table is read later, and must have heights then
            None if self.table.is_some() => Ok(()),
            None if !points.is_empty() && points.iter().all(|point| placed(&point)) => Ok(()),
            None => Err(Complaint::missing(
                "height_m",
                "write height_m = 0.5 or another gap between rock and ground, or points [x, y, z]",
            )),
        }
    }
}

/// Boxes around each point, a line or an area.
fn boxes_of(
    points_m: Option<&[ReleasePoint]>,
    line_m: Option<&Polyline>,
    polygon_m: Option<&Area>,
) -> Vec<[f64; 4]> {
    let points = points_m.unwrap_or_default().iter().filter_map(|point| box_of(&[point.at_m]));
    let line = line_m.into_iter().filter_map(|line| box_of(line.corners_m()));
    let area = polygon_m.into_iter().filter_map(|area| box_of(area.corners_m()));
    points.chain(line).chain(area).collect()
}

/// The box of some corners; none without any.
fn box_of(corners: &[Corner]) -> Option<[f64; 4]> {
    let &[x, y] = corners.first()?;
    let grow = |[west, south, east, north]: [f64; 4], [x, y]: &Corner| {
        [west.min(*x), south.min(*y), east.max(*x), north.max(*y)]
    };
    Some(corners.iter().fold([x, y, x, y], grow))
}

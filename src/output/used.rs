//! What a run started from, for a GIS: the ground as it was used, and the places that the scene names.

use super::maps::FOLDER;
use super::vector::GeoJsonFile;
use crate::error::{Error, Result};
use crate::file::write_atomic;
use crate::plan::{Part, Plan};
use crate::release::{ReleasePlace, Releases};
use crate::scene::{Area, BarrierTable, Corner, Polyline, Zone, ZonePlace};
use crate::terrain::geotiff::{Image, encode};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Files below the result folder: the ground, places of release, lines and barriers.
const FILES: [&str; 3] = ["ground.tif", "zones.geojson", "scene_lines.geojson"];

/// Writes the ground as `GeoTIFF`; `image` holds it row by row from the north.
///
/// # Errors
/// When a file or the folder cannot be written.
pub fn write_ground(dir: &Path, image: &Image) -> Result<()> {
    let folder = dir.join(FOLDER);
    fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
    let path = folder.join(FILES[0]);
    let bytes =
        encode(image).map_err(|why| Error::file("write", &path)(std::io::Error::other(why)))?;
    write_atomic(&path, &bytes)
}

/// Writes the places of release, and lines and barriers, as GeoJSON that a scene can name again.
///
/// # Errors
/// When a file or the folder cannot be written.
pub fn write_drawings(dir: &Path, plan: &Plan) -> Result<()> {
    let folder = dir.join(FOLDER);
    fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
    let [_, zones, lines] = FILES.map(|name| folder.join(name));
    let mut file = GeoJsonFile::create(&zones, plan.epsg)?;
    for (geometry, properties) in
        plan.releases.places().iter().flat_map(|place| places(place, &plan.releases))
    {
        file.add(&geometry, &properties)?;
    }
    file.finish()?;
    let mut file = GeoJsonFile::create(&lines, plan.epsg)?;
    let barriers = if let Part::Kept(all) = &plan.barriers { all.as_slice() } else { &[] };
    for line in plan.recorders().lines {
        let corners = line.corners_m(plan.terrain.origin_m);
        let barrier = barriers.iter().find(|barrier| barrier.name == line.name);
        // the scene's own digits where it has them: those of the evaluation line went through the origin
        let written = barrier.map(|barrier| barrier.points_m.corners_m().to_vec());
        file.add(&line_string(&written.unwrap_or(corners)), &of_line(&line.name, barrier))?;
    }
    file.finish()
}

/// Copies both from one of the folders of a run in parts.
///
/// # Errors
/// When a file cannot be read or written.
pub fn copy_used(from: &Path, to: &Path) -> Result<()> {
    for name in FILES {
        let path = from.join(FOLDER).join(name);
        if path.exists() {
            let bytes = fs::read(&path).map_err(Error::file("read", &path))?;
            write_atomic(&to.join(FOLDER).join(name), &bytes)?;
        }
    }
    Ok(())
}

fn of_line(name: &str, barrier: Option<&BarrierTable>) -> Value {
    match barrier {
        None => json!({ "name": name }),
        Some(barrier) => {
            json!({ "name": name, "height_m": barrier.height_m, "capacity_j": barrier.capacity_j })
        }
    }
}

/// Geometry and properties of every place of release.
fn places(place: &ReleasePlace, releases: &Releases) -> Vec<(Value, Value)> {
    match place {
        ReleasePlace::Points(points) => {
            let points: Vec<Corner> = points.iter().map(|point| point.at_m).collect();
            vec![(json!({ "type": "MultiPoint", "coordinates": points }), json!({}))]
        }
        ReleasePlace::Line(line) => vec![(line_string(line.corners_m()), json!({}))],
        ReleasePlace::Area(area) => {
            vec![(json!({ "type": "Polygon", "coordinates": rings(area) }), json!({}))]
        }
        ReleasePlace::Zones(zones) => {
            let zone = |(number, zone): (usize, &Zone)| {
                let share = releases.share_of_zone(zones, number);
                let mut properties = json!({ "name": zone.name, "share": share });
                let [least, largest] = zone.volumes_m3;
                let values = [
                    ("weight", zone.weight),
                    ("volume_m3", zone.volume_m3),
                    ("frequency_per_year", zone.frequency_per_year),
                    ("per_year_at_1m3", zone.per_year_at_1m3),
                    ("exponent", zone.exponent),
                    ("volume_min_m3", least),
                    ("volume_max_m3", largest),
                ];
                for (name, value) in values {
                    if let Some(value) = value {
                        properties[name] = json!(value);
                    }
                }
                (geometry(&zone.place), properties)
            };
            zones.list().iter().enumerate().map(zone).collect()
        }
    }
}

fn geometry(place: &ZonePlace) -> Value {
    match place {
        ZonePlace::Points(points) => json!({ "type": "MultiPoint", "coordinates": points }),
        ZonePlace::Lines(lines) => {
            let all: Vec<&[Corner]> = lines.iter().map(Polyline::corners_m).collect();
            json!({ "type": "MultiLineString", "coordinates": all })
        }
        ZonePlace::Areas(areas) => {
            let all: Vec<Vec<Vec<Corner>>> = areas.iter().map(rings).collect();
            json!({ "type": "MultiPolygon", "coordinates": all })
        }
    }
}

fn line_string(corners: &[Corner]) -> Value {
    json!({ "type": "LineString", "coordinates": corners })
}

/// Outline and holes, each with its first corner again at the end.
fn rings(area: &Area) -> Vec<Vec<Corner>> {
    let closed = |ring: &[Corner]| ring.iter().chain(ring.first()).copied().collect();
    let holes = area.holes_m().iter().map(Vec::as_slice);
    std::iter::once(area.corners_m()).chain(holes).map(closed).collect()
}

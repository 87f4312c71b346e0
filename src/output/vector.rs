//! Ends and paths for GIS (GeoJSON) and for `ParaView` (VTK), written from the tables when a run is complete.

use super::site::ReleaseZone;
use super::{PathRow, Summary};
use crate::body::ShapeKind;
use crate::error::{Error, Result};
use crate::hazard::{BarrierSummary, LineSummary, Row, Statistic};
use crate::rock::Vec3;
use crate::terrain::Terrain;
use serde_json::{Value, json};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes one feature a release at its end, with what `releases.csv` says of it.
pub(super) fn write_ends(
    path: &Path,
    epsg: Option<u32>,
    rows: impl Iterator<Item = Result<Row>>,
) -> Result<()> {
    let mut file = GeoJsonFile::create(path, epsg)?;
    for row in rows {
        let row = row?;
        // a failed rock may have no place
        if row.end_m.iter().all(|x| x.is_finite()) {
            let geometry = json!({ "type": "Point", "coordinates": row.end_m });
            file.add(
                &geometry,
                &json!({
                    "index": row.index,
                    "stop": row.stop.word(),
                    "radius_m": row.radius_m,
                    "runout_m": row.runout_m,
                    "reach_angle_deg": row.reach_angle_deg,
                    "max_speed_m_s": row.max_speed_m_s,
                    "max_total_j": row.max_total_j,
                }),
            )?;
        }
    }
    file.finish()
}

/// Writes one feature a kept path, with what its rock did point by point; `rows` and `rocks` release by release.
pub(super) fn write_paths(
    path: &Path,
    epsg: Option<u32>,
    (rows, mut rocks): (impl Iterator<Item = Result<PathRow>>, impl Iterator<Item = Result<Row>>),
) -> Result<()> {
    let mut file = GeoJsonFile::create(path, epsg)?;
    let mut points: Vec<PathRow> = Vec::new();
    let mut write = |points: &mut Vec<PathRow>| -> Result<()> {
        let Some(first) = points.first() else { return Ok(()) };
        let rock = loop {
            match rocks.next().transpose()? {
                Some(rock) if rock.index < first.index => {}
                rock => break rock.filter(|rock| rock.index == first.index),
            }
        };
        if let (Some(rock), true) = (rock, points.len() > 1) {
            let places: Vec<_> = points.iter().map(|row| row.position_m).collect();
            let geometry = json!({ "type": "LineString", "coordinates": places });
            file.add(&geometry, &along(&rock, points))?;
        }
        points.clear();
        Ok(())
    };
    for row in rows {
        let row = row?;
        if points.first().is_some_and(|first| first.index != row.index) {
            write(&mut points)?;
        }
        points.push(row);
    }
    write(&mut points)?;
    file.finish()
}

/// What a rock did, and at every point of its path the time, speed, energies and height above the ground.
fn along(rock: &Row, points: &[PathRow]) -> serde_json::Value {
    // digits beyond these only make the file long
    let short =
        |value: f64, digits: f64| value.is_finite().then(|| (value * digits).round() / digits);
    let each = |value: &dyn Fn(&PathRow) -> f64, digits: f64| -> Vec<Option<f64>> {
        points.iter().map(|row| short(value(row), digits)).collect()
    };
    let speed = |row: &PathRow| Vec3::from(row.velocity_m_s).norm();
    let spin = |row: &PathRow| rock.radius_m * Vec3::from(row.spin_rad_s).norm();
    let is_sphere = rock.shape.is_none_or(|shape| shape.kind == ShapeKind::Sphere);
    json!({
        "index": rock.index,
        "stop": rock.stop.word(),
        "radius_m": rock.radius_m,
        "mass_kg": rock.mass_kg,
        "max_speed_m_s": rock.max_speed_m_s,
        "max_total_j": rock.max_total_j,
        "max_height_m": rock.max_height_m,
        "duration_s": rock.time_s,
        "time_s": each(&|row| row.time_s, 1e4),
        "speed_m_s": each(&speed, 1e4),
        "translational_j": each(&|row| 0.5 * rock.mass_kg * speed(row).powi(2), 1e3),
        // a homogeneous sphere: I = 2/5 m R²; paths do not say what turns of a block
        "rotational_j": is_sphere.then(|| each(&|row| 0.2 * rock.mass_kg * spin(row).powi(2), 1e3)),
        "height_m": each(&|row| row.clearance_m, 1e4),
    })
}

/// Writes `lines.geojson`, `barriers.geojson` and `release_zone.geojson` into `folder`, each where there is something.
pub(super) fn write_site(folder: &Path, epsg: Option<u32>, summary: &Summary) -> Result<()> {
    let is_barrier = |name: &String| summary.barriers.iter().find(|one| one.barrier.name == *name);
    let line = |corners: &[[f64; 2]]| json!({ "type": "LineString", "coordinates": corners });
    let own = summary.lines.iter().filter(|line| !line.info.of_barrier);
    let (barriers, lines): (Vec<&LineSummary>, Vec<&LineSummary>) =
        own.partition(|line| is_barrier(&line.info.name).is_some());
    let p95 = |line: &LineSummary, column: &str| {
        let found = line.statistics.get(column).and_then(|of| of.percentiles.get("p95"));
        found.filter(|found| line.reach.count >= found.needs).map(|found| found.value)
    };
    let said = |at: &LineSummary| {
        json!({
            "name": at.info.name,
            "length_m": at.info.length_m,
            "reach": at.reach.share,
            "reach_low_95": at.reach.low_95,
            "reach_high_95": at.reach.high_95,
            "total_p95_j": p95(at, "total_j"),
            "height_p95_m": p95(at, "height_m"),
        })
    };
    let mut file = GeoJsonFile::create_if(!lines.is_empty(), folder.join("lines.geojson"), epsg)?;
    for at in &lines {
        file.add(&line(&at.info.corners_m), &said(at))?;
    }
    file.finish()?;
    let mut file =
        GeoJsonFile::create_if(!barriers.is_empty(), folder.join("barriers.geojson"), epsg)?;
    for at in &barriers {
        let mut said = said(at);
        if let Some(one) = is_barrier(&at.info.name) {
            said["height_m"] = one.barrier.height_m.into();
            said["capacity_j"] = one.barrier.capacity_j.into();
            said["arriving"] = one.arriving.share.into();
            said["arriving_total_p95_j"] = arriving_p95(one, &one.energy_j).into();
            said["arriving_top_p95_m"] = arriving_p95(one, &one.top_m).into();
            said["stopped"] = one.stopped.share.into();
            said["design_height_m"] = one.design_values.as_ref().map(|of| of.height_m).into();
            said["design_energy_j"] = one.design_values.as_ref().map(|of| of.energy_j).into();
        }
        file.add(&line(&at.info.corners_m), &said)?;
    }
    file.finish()?;
    let zones: Vec<(Option<&str>, &ReleaseZone)> =
        summary.site.named_zones().filter(|(_, zone)| !zone.corners_m().is_empty()).collect();
    let mut file =
        GeoJsonFile::create_if(!zones.is_empty(), folder.join("release_zone.geojson"), epsg)?;
    for (number, (name, zone)) in zones.iter().enumerate() {
        let mut said = if zones.len() > 1 {
            json!({ "source": number + 1 })
        } else {
            json!({ "releases": summary.identity.of_releases })
        };
        if let Some(name) = name {
            said["name"] = (*name).into();
        }
        file.add(&geometry(zone), &said)?;
    }
    file.finish()
}

/// A 95th percentile of the rocks that arrive at a barrier, those stopped before left out; none of too few.
fn arriving_p95(barrier: &BarrierSummary, of: &Statistic) -> Option<f64> {
    let found = of.percentiles.get("p95");
    found.filter(|found| barrier.arriving.count >= found.needs).map(|found| found.value)
}

fn geometry(zone: &ReleaseZone) -> Value {
    let mut corners = zone.corners_m().to_vec();
    match zone {
        ReleaseZone::Points(_) => json!({ "type": "MultiPoint", "coordinates": corners }),
        ReleaseZone::Line(_) => json!({ "type": "LineString", "coordinates": corners }),
        ReleaseZone::Polygon(_) => {
            // a ring ends where it begins
            corners.extend(zone.corners_m().first().copied());
            json!({ "type": "Polygon", "coordinates": [corners] })
        }
    }
}

/// A GeoJSON file that grows feature by feature.
///
/// RFC 7946 knows longitude and latitude only. The older member `crs` says that these are map coordinates; GDAL and
/// QGIS read it.
pub(super) struct GeoJsonFile {
    path: PathBuf,
    /// None: there is nothing to write, and no file.
    file: Option<BufWriter<File>>,
    is_first: bool,
}

impl GeoJsonFile {
    pub(super) fn create(path: &Path, epsg: Option<u32>) -> Result<Self> {
        Self::create_if(true, path.to_owned(), epsg)
    }

    fn create_if(is_wanted: bool, path: PathBuf, epsg: Option<u32>) -> Result<Self> {
        let create = || File::create(&path).map_err(Error::file("create", &path));
        let file = is_wanted.then(create).transpose()?.map(BufWriter::new);
        let mut features = Self { path, file, is_first: true };
        let crs = epsg.map_or(String::new(), |code| {
            let name = format!("urn:ogc:def:crs:EPSG::{code}");
            format!("\"crs\":{},", json!({ "type": "name", "properties": { "name": name } }))
        });
        features.put(&format!("{{\"type\":\"FeatureCollection\",{crs}\"features\":[\n"))?;
        Ok(features)
    }

    fn put(&mut self, text: &str) -> Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        file.write_all(text.as_bytes()).map_err(Error::file("write", &self.path))
    }

    pub(super) fn add(
        &mut self,
        geometry: &serde_json::Value,
        properties: &serde_json::Value,
    ) -> Result<()> {
        let comma = if std::mem::replace(&mut self.is_first, false) { "" } else { ",\n" };
        let feature = json!({ "type": "Feature", "geometry": geometry, "properties": properties });
        self.put(&format!("{comma}{feature}"))
    }

    pub(super) fn finish(mut self) -> Result<()> {
        self.put("\n]}\n")?;
        let Some(file) = &mut self.file else { return Ok(()) };
        file.flush().map_err(Error::file("write", &self.path))
    }
}

/// Writes all kept paths as straight pieces of a legacy VTK unstructured grid in ASCII, with release, time, speed and
/// clearance at every point; `ParaView`, pyvista and meshio read it. Coordinates are those of the mesh files, whose (0, 0, 0)
/// lies at `origin_m` on the map: paths and meshes open in one view.
pub(super) fn write_vtk(
    path: &Path,
    origin_m: [f64; 3],
    rows: impl Iterator<Item = Result<PathRow>>,
) -> Result<()> {
    let rows: Vec<PathRow> = rows.collect::<Result<_>>()?;
    let file = File::create(path).map_err(Error::file("create", path))?;
    let mut file = BufWriter::new(file);
    write_grid(&mut file, Vec3::from(origin_m), &rows)
        .and_then(|()| file.flush())
        .map_err(Error::file("write", path))
}

/// A column of numbers: name, and the value of a row.
type NumberColumn = (&'static str, fn(&PathRow) -> f64);

fn write_grid(to: &mut impl Write, origin_m: Vec3, rows: &[PathRow]) -> std::io::Result<()> {
    writeln!(to, "# vtk DataFile Version 3.0")?;
    writeln!(
        to,
        "rockfall paths in the coordinates of the meshes; map = these + ({}, {}, {}) m",
        origin_m.x, origin_m.y, origin_m.z
    )?;
    writeln!(to, "ASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double", rows.len())?;
    for row in rows {
        let local = Vec3::from(row.position_m) - origin_m;
        writeln!(to, "{} {} {}", local.x, local.y, local.z)?;
    }
    let follows = |k: &usize| rows[*k].index == rows[k - 1].index;
    let pieces: Vec<usize> = (1..rows.len()).filter(follows).collect();
    writeln!(to, "CELLS {} {}", pieces.len(), 3 * pieces.len())?;
    for piece in &pieces {
        writeln!(to, "2 {} {piece}", piece - 1)?;
    }
    writeln!(to, "CELL_TYPES {}", pieces.len())?;
    for _ in &pieces {
        writeln!(to, "3")?;
    }
    writeln!(to, "POINT_DATA {}", rows.len())?;
    let columns: [NumberColumn; 4] = [
        ("release", |row| row.index as f64),
        ("time_s", |row| row.time_s),
        ("speed_m_s", |row| Vec3::from(row.velocity_m_s).norm()),
        // VTK readers stumble over NaN
        ("clearance_m", |row| if row.clearance_m.is_nan() { -9999.0 } else { row.clearance_m }),
    ];
    for (name, value) in columns {
        writeln!(to, "SCALARS {name} double 1\nLOOKUP_TABLE default")?;
        for row in rows {
            writeln!(to, "{}", value(row))?;
        }
    }
    Ok(())
}

/// Writes the welded terrain as `maps/terrain.vtk` below `dir`: legacy VTK polygons in binary, in the coordinates of the mesh
/// files as the paths are, with the number of the ground and whether it is a tree on every triangle.
///
/// # Errors
/// When the file cannot be written.
pub fn write_terrain(dir: &Path, terrain: &Terrain, mesh_origin_m: [f64; 3]) -> Result<()> {
    let path = dir.join(super::maps::FOLDER).join("terrain.vtk");
    super::write_atomic(&path, &terrain_vtk(terrain, mesh_origin_m))
}

fn terrain_vtk(terrain: &Terrain, mesh_origin_m: [f64; 3]) -> Vec<u8> {
    let shift = terrain.origin_m - Vec3::from(mesh_origin_m);
    let (points, count) = (terrain.vertices_m.len(), terrain.triangles.len());
    let mut bytes = format!(
        "# vtk DataFile Version 3.0\nrockfall terrain in the coordinates of the meshes\nBINARY\nDATASET POLYDATA\nPOINTS {points} double\n"
    )
    .into_bytes();
    // the format is big-endian
    for vertex in &terrain.vertices_m {
        let place: [f64; 3] = (vertex + shift).into();
        bytes.extend(place.into_iter().flat_map(f64::to_be_bytes));
    }
    bytes.extend(format!("\nPOLYGONS {count} {}\n", 4 * count).bytes());
    for corners in &terrain.triangles {
        let cell = [3, corners[0], corners[1], corners[2]];
        bytes.extend(cell.into_iter().flat_map(u32::to_be_bytes));
    }
    bytes.extend(format!("\nCELL_DATA {count}\n").bytes());
    let sheet = |triangle: usize| &terrain.sheets[usize::from(terrain.sheet_of[triangle])];
    let columns: [(&str, &dyn Fn(usize) -> u32); 2] = [
        ("ground", &|triangle| u32::from(sheet(triangle).ground)),
        ("is_tree", &|triangle| u32::from(sheet(triangle).is_tree)),
    ];
    for (name, value) in columns {
        bytes.extend(format!("SCALARS {name} int 1\nLOOKUP_TABLE default\n").bytes());
        bytes.extend((0..count).flat_map(|triangle| value(triangle).to_be_bytes()));
        bytes.push(b'\n');
    }
    bytes
}

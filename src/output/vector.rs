//! Ends and paths for GIS (GeoJSON) and for `ParaView` (VTK), written from the tables when a run is complete.

use super::PathRow;
use crate::error::{Error, Result};
use crate::hazard::Row;
use crate::rock::Vec3;
use serde_json::json;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes one feature a release at its end, with what `releases.csv` says of it.
pub(super) fn write_ends(
    path: &Path,
    epsg: Option<u32>,
    rows: impl Iterator<Item = Result<Row>>,
) -> Result<()> {
    let mut file = Features::create(path, epsg)?;
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

/// Writes one feature a kept path; `rows` release by release.
pub(super) fn write_paths(
    path: &Path,
    epsg: Option<u32>,
    rows: impl Iterator<Item = Result<PathRow>>,
) -> Result<()> {
    let mut file = Features::create(path, epsg)?;
    let mut line: (usize, Vec<[f64; 3]>) = (0, Vec::new());
    for row in rows {
        let row = row?;
        if row.index != line.0 {
            file.add_line(&line)?;
            line = (row.index, Vec::new());
        }
        line.1.push(row.position_m);
    }
    file.add_line(&line)?;
    file.finish()
}

/// A GeoJSON file that grows feature by feature.
///
/// RFC 7946 knows longitude and latitude only. The older member `crs` says that these are map coordinates; GDAL and
/// QGIS read it.
pub(super) struct Features<'a> {
    path: &'a Path,
    file: BufWriter<File>,
    is_first: bool,
}

impl<'a> Features<'a> {
    pub(super) fn create(path: &'a Path, epsg: Option<u32>) -> Result<Self> {
        let file = File::create(path).map_err(Error::file("create", path))?;
        let mut features = Self { path, file: BufWriter::new(file), is_first: true };
        let crs = epsg.map_or(String::new(), |code| {
            let name = format!("urn:ogc:def:crs:EPSG::{code}");
            format!("\"crs\":{},", json!({ "type": "name", "properties": { "name": name } }))
        });
        features.put(&format!("{{\"type\":\"FeatureCollection\",{crs}\"features\":[\n"))?;
        Ok(features)
    }

    fn put(&mut self, text: &str) -> Result<()> {
        self.file.write_all(text.as_bytes()).map_err(Error::file("write", self.path))
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

    fn add_line(&mut self, (index, points): &(usize, Vec<[f64; 3]>)) -> Result<()> {
        if points.len() < 2 {
            return Ok(());
        }
        let geometry = json!({ "type": "LineString", "coordinates": points });
        self.add(&geometry, &json!({ "index": index }))
    }

    pub(super) fn finish(mut self) -> Result<()> {
        self.put("\n]}\n")?;
        self.file.flush().map_err(Error::file("write", self.path))
    }
}

/// Writes all kept paths as straight pieces of a legacy VTK unstructured grid in ASCII, with release, time, speed and
/// clearance at every point; `ParaView`, pyvista and meshio read it. Coordinates are local to `origin_m`, as programs that
/// draw in single precision need them.
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
type Column = (&'static str, fn(&PathRow) -> f64);

fn write_grid(to: &mut impl Write, origin_m: Vec3, rows: &[PathRow]) -> std::io::Result<()> {
    writeln!(to, "# vtk DataFile Version 3.0")?;
    writeln!(
        to,
        "rockfall paths; map = local + ({}, {}, {}) m",
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
    let columns: [Column; 4] = [
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

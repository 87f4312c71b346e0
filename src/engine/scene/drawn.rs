//! `[[lines]]` and `[[barriers]]` as they are written: in the scene, or drawn in a file of a GIS.

use super::barrier::{BarrierTable, DesignTable};
use super::check::{Complaint, name_flaw};
use super::places::Polyline;
use super::record::LineTable;
use super::refusal::Refusal;
use crate::error::Result;
use crate::gis::{self, Geometry, GisFeature};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// `[[lines]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with name and points_m, or with file")]
pub struct LineEntry {
    /// Name in the results.
    pub name: Option<String>,
    /// Its corners in map coordinates (m).
    pub points_m: Option<Polyline>,
    /// GeoJSON or Shapefile with lines, instead of `points_m`.
    pub file: Option<PathBuf>,
    /// Property that holds the name of each line in the file; absent = `name`.
    pub name_from: Option<String>,
}

/// `[[barriers]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with name, points_m, height_m and capacity_j, or with file"
)]
pub struct BarrierEntry {
    /// Name in the results.
    pub name: Option<String>,
    /// Its corners in map coordinates (m).
    pub points_m: Option<Polyline>,
    /// GeoJSON or Shapefile with lines, instead of `points_m`.
    pub file: Option<PathBuf>,
    /// Property that holds the name of each line in the file; absent = `name`.
    pub name_from: Option<String>,
    /// Height above the ground (m), positive; a property of the same name of a line in the file comes first.
    pub height_m: Option<f64>,
    /// Energy that it takes (J), positive; a property of the same name of a line in the file comes first.
    pub capacity_j: Option<f64>,
    /// Other places to try it at (m).
    #[serde(default)]
    pub offsets_m: Vec<f64>,
    /// How a design is derived.
    pub design: Option<DesignTable>,
}

/// A key that an entry must have.
fn required<T>(key: &str, value: Option<T>) -> std::result::Result<T, Complaint> {
    value.ok_or_else(|| Complaint::missing(key, format!("write {key} = …; it has no default")))
}

/// The name and line of an entry that is written in the scene.
fn written(
    (name, points_m): (&Option<String>, &Option<Polyline>),
    name_from: Option<&String>,
) -> std::result::Result<(String, Polyline), Complaint> {
    if name_from.is_some() {
        return Err(Complaint::about("name_from", "remove it: it names a property of a file"));
    }
    let name = required("name", name.clone())?;
    Ok((name, required("points_m", points_m.clone())?))
}

impl LineEntry {
    /// Its line, if it is written in the scene.
    pub(super) fn written(&self) -> std::result::Result<LineTable, Complaint> {
        let Self { name, points_m, file: _, name_from } = self;
        let (name, points_m) = written((name, points_m), name_from.as_ref())?;
        Ok(LineTable { name, points_m })
    }

    /// The lines of its file.
    pub(super) fn read(&self, file: &Path) -> std::result::Result<Vec<LineTable>, Refusal> {
        none_beside(self.points_m.as_ref())?;
        let drawn = drawn(file, self.name.as_deref(), self.name_from.as_deref())?;
        Ok(drawn
            .into_iter()
            .map(|line| LineTable { name: line.name, points_m: line.line })
            .collect())
    }
}

impl BarrierEntry {
    /// Its barrier, if it is written in the scene.
    pub(super) fn written(&self) -> std::result::Result<BarrierTable, Complaint> {
        let (name, points_m) = written((&self.name, &self.points_m), self.name_from.as_ref())?;
        let height_m = required("height_m", self.height_m)?;
        let capacity_j = required("capacity_j", self.capacity_j)?;
        let barrier = self.table(name, points_m, [height_m, capacity_j]);
        barrier.check()?;
        Ok(barrier)
    }

    /// The barriers of its file.
    pub(super) fn read(&self, file: &Path) -> std::result::Result<Vec<BarrierTable>, Refusal> {
        none_beside(self.points_m.as_ref())?;
        let mut barriers = Vec::new();
        for line in drawn(file, self.name.as_deref(), self.name_from.as_deref())? {
            let value = |key: &str, own: Option<f64>| -> Result<f64> {
                line.feature.positive(key, file)?.or(own).ok_or_else(|| {
                    let remedy = format!(
                        "write {key} as a property of the line, or in the scene beside the file"
                    );
                    line.feature.wrong(file, format!("found no {key}"), remedy)
                })
            };
            let values = [value("height_m", self.height_m)?, value("capacity_j", self.capacity_j)?];
            let barrier = self.table(line.name.clone(), line.line.clone(), values);
            barrier.check()?;
            barriers.push(barrier);
        }
        Ok(barriers)
    }

    fn table(
        &self,
        name: String,
        points_m: Polyline,
        [height_m, capacity_j]: [f64; 2],
    ) -> BarrierTable {
        let (offsets_m, design) = (self.offsets_m.clone(), self.design.clone());
        BarrierTable { name, points_m, height_m, capacity_j, offsets_m, design }
    }
}

fn none_beside(points_m: Option<&Polyline>) -> std::result::Result<(), Complaint> {
    match points_m {
        None => Ok(()),
        Some(_) => Err(Complaint::about("points_m", "remove it: the lines stand in the file")),
    }
}

/// A line of a file.
struct DrawnLine {
    name: String,
    line: Polyline,
    feature: GisFeature,
}

/// The property that names a feature.
///
/// # Errors
/// A name that tables and files cannot hold, or two properties of that name; an empty one is none.
pub(super) fn name_of(feature: &GisFeature, property: &str, file: &Path) -> Result<Option<String>> {
    feature.check_one(property, file)?;
    let Some(name) = feature.text(property) else { return Ok(None) };
    match name_flaw(&name).filter(|_| !name.trim().is_empty()) {
        Some(remedy) => Err(feature.wrong(file, format!("found {property} = {name:?}"), remedy)),
        None => Ok(Some(name)),
    }
}

/// The lines of a file with their names: the entry's own (numbered if there are several), else those of a property.
fn drawn(file: &Path, name: Option<&str>, name_from: Option<&str>) -> Result<Vec<DrawnLine>> {
    let mut all = Vec::new();
    for feature in gis::read(file)?.features {
        let Geometry::Lines(parts) = &feature.shape else {
            let found = format!("found {}", feature.shape.name());
            return Err(feature.wrong(
                file,
                found,
                "write lines, or leave the feature out of the file",
            ));
        };
        let property = name_from.unwrap_or("name");
        let own = name_of(&feature, property, file)?.filter(|text| !text.trim().is_empty());
        if name.is_none() && own.is_none() {
            let remedy = "write the property, name_from = \"…\" for another one, or name = \"…\" in the scene";
            return Err(feature.wrong(file, format!("found no property {property}"), remedy));
        }
        let own = name.map(str::to_owned).or(own).unwrap_or_default();
        for (part, corners) in parts.iter().enumerate() {
            let line = Polyline::try_from(corners.clone())
                .map_err(|flaw| feature.wrong(file, flaw.found, flaw.remedy))?;
            // an entry's own name is numbered over all lines, whatever feature they are parts of
            let is_first = part == 0 || name.is_some();
            let name = if is_first { own.clone() } else { format!("{own} part {}", part + 1) };
            all.push(DrawnLine { name, line, feature: feature.clone() });
        }
    }
    if name.is_some() && all.len() > 1 {
        for (number, line) in (1..).zip(&mut all) {
            line.name = format!("{} {number}", line.name);
        }
    }
    Ok(all)
}

//! `[[ground_zones]]`: grounds by polygon.

use super::check::{Checked, Complaint, suggest};
use super::refusal::Refusal;
use crate::gis::{self, Geometry};
use crate::terrain::patches::Patch;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Polygons that lay a ground on the slope.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with file and ground or ground_from")]
pub struct GroundZones {
    /// GeoJSON or Shapefile with polygons.
    pub file: PathBuf,
    /// Property that names the ground of each polygon.
    pub ground_from: Option<String>,
    /// Ground of all polygons, instead of `ground_from`.
    pub ground: Option<String>,
    /// Whether triangles are cut along the borders; absent = a triangle has the ground at its centroid.
    #[serde(default)]
    pub cut: bool,
}

impl GroundZones {
    pub(super) fn check(&self, grounds: &[&str]) -> Checked {
        match (&self.ground, &self.ground_from) {
            (None, None) => Err(Complaint::missing(
                "ground_from",
                "write ground_from = a property that names the ground, or ground = one name for all polygons",
            )),
            (Some(_), Some(_)) => {
                Err(Complaint::about("ground", "remove it, or remove ground_from"))
            }
            (Some(name), None) if !grounds.contains(&name.as_str()) => Err(Complaint::about(
                "ground",
                format!("write a name from [grounds]; {}", suggest(name, grounds)),
            )),
            _ => Ok(()),
        }
    }

    /// Its polygons, each with the number of its ground; and the EPSG code that the file names.
    pub(super) fn read(
        &self,
        file: &Path,
        grounds: &[&str],
    ) -> std::result::Result<Vec<Patch>, Refusal> {
        let mut patches = Vec::new();
        for feature in gis::read(file)?.features {
            let Geometry::Polygons(polygons) = &feature.shape else {
                let found = format!("found {} under [[ground_zones]]", feature.shape.name());
                let remedy = "draw the zone as a polygon, or leave the feature out of the file: only areas have a ground";
                return Err(feature.wrong(file, found, remedy).into());
            };
            let name = match (&self.ground, &self.ground_from) {
                (Some(name), _) => name.clone(),
                (None, Some(property)) => feature.text(property).ok_or_else(|| {
                    let found = format!("found no property {property}");
                    feature.wrong(file, found, "write the name of a ground there")
                })?,
                (None, None) => String::new(), // the check has made sure that there is one
            };
            let Some(ground) = grounds.iter().position(|known| *known == name) else {
                let remedy = format!("write a name from [grounds]; {}", suggest(&name, grounds));
                return Err(feature.wrong(file, format!("found the ground {name}"), remedy).into());
            };
            let rings = polygons.iter().flat_map(|polygon| {
                std::iter::once(&polygon.outline_m).chain(&polygon.holes_m).cloned()
            });
            patches.push(Patch { rings_m: rings.collect(), ground: ground as u16 });
        }
        Ok(patches)
    }
}

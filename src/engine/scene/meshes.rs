//! `[[terrain]]`, `[[trees]]` and `[mesh]`.

use super::check::{Allowed, Checked, Complaint, number, optional, suggest};
use super::places::finite;
use crate::math;
use crate::terrain::formats::{Crop, Options};
use crate::terrain::weld::Up;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// One file under `[[terrain]]` or `[[trees]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with mesh or file, and ground")]
pub struct MeshFile {
    /// The STL file; once a [`Scene`](super::Scene) is read, as seen from the working directory.
    pub mesh: Option<PathBuf>,
    /// A file of any format, instead of `mesh`: `GeoTIFF`, ESRI ASCII grid, PLY, OBJ, STL, LAS or LAZ.
    pub file: Option<PathBuf>,
    /// Name of its ground under `[grounds]`.
    pub ground: String,
    /// Which axis of the file points up.
    #[serde(default)]
    pub up: Up,
    /// Metres in one unit of the file (m), positive.
    #[serde(default = "metres")]
    pub scale: f64,
    /// What part of an elevation model is used.
    pub crop: Option<CropTable>,
    /// Side of the cells that are used of an elevation model (m), positive, not below its own.
    pub resample_m: Option<f64>,
    /// Classes of the points of a cloud that are ground (ASPRS); absent = 2.
    #[serde(default)]
    pub classes: Vec<u8>,
}

/// A part of an elevation model: a box, or what rocks can reach.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with box_m, or with reach_angle_deg and margin_m"
)]
pub struct CropTable {
    /// West, south, east and north (m), map coordinates.
    pub box_m: Option<[f64; 4]>,
    /// Angle below the horizontal (degrees), above 0 and below 90: what lies below a line falling so steeply from the highest
    /// ground of a place of release is kept.
    pub reach_angle_deg: Option<f64>,
    /// What is kept around it (m), 0 or more.
    pub margin_m: Option<f64>,
}

/// `[mesh]`: how files become one mesh; optional as a whole.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [mesh]")]
pub struct MeshTable {
    /// Corners closer than this become one (m), 0 or more; absent = chosen from the size of the mesh.
    pub weld_tolerance_m: Option<f64>,
}

/// Files are in metres unless they say otherwise.
fn metres() -> f64 {
    1.0
}

impl MeshFile {
    /// The file that it names.
    pub fn path(&self) -> &Path {
        self.file.as_deref().or(self.mesh.as_deref()).unwrap_or(Path::new(""))
    }

    pub(super) fn check(&self, grounds: &[&str]) -> Checked {
        self.check_file()?;
        number("scale", self.scale, Allowed::Positive, "0.001 for a file in millimetres")?;
        optional("resample_m", self.resample_m, Allowed::Positive, "")?;
        if let Some(crop) = &self.crop {
            crop.check().map_err(|wrong| wrong.inside("crop"))?;
        }
        if grounds.contains(&self.ground.as_str()) {
            return Ok(());
        }
        let remedy = format!("write a name from [grounds]; {}", suggest(&self.ground, grounds));
        Err(Complaint::about("ground", remedy))
    }

    fn check_file(&self) -> Checked {
        match (&self.mesh, &self.file) {
            (None, None) => Err(Complaint::missing(
                "mesh",
                "write mesh = \"slope.stl\", or file = \"dem.tif\" for an elevation model or another mesh",
            )),
            (Some(_), Some(_)) => Err(Complaint::about("file", "remove it, or remove mesh")),
            (Some(_), None) => {
                let of_grids = [
                    ("crop", self.crop.is_some()),
                    ("resample_m", self.resample_m.is_some()),
                    ("classes", !self.classes.is_empty()),
                ];
                match of_grids.iter().find(|(_, given)| *given) {
                    Some((key, _)) => Err(Complaint::about(
                        key,
                        "remove it, or write file = … instead of mesh = …: it is for elevation models and point clouds",
                    )),
                    None => Ok(()),
                }
            }
            (None, Some(_)) => Ok(()),
        }
    }

    /// How its file is to be read; `starts` are boxes around the places of release (m).
    pub(super) fn options(&self, starts: &[[f64; 4]], epsg: Option<u32>) -> Option<Options> {
        self.file.as_ref().map(|_| Options {
            crop: self.crop.as_ref().map(|crop| crop.part(starts)),
            resample_m: self.resample_m,
            classes: self.classes.clone(),
            epsg,
        })
    }
}

impl CropTable {
    fn check(&self) -> Checked {
        optional("margin_m", self.margin_m, Allowed::NotNegative, "")?;
        match (&self.box_m, self.reach_angle_deg) {
            (None, None) => Err(Complaint::missing(
                "box_m",
                "write box_m = [west, south, east, north], or reach_angle_deg and margin_m",
            )),
            (Some(_), Some(_)) => {
                Err(Complaint::about("box_m", "remove it, or remove reach_angle_deg"))
            }
            (Some(box_m), None) => {
                let [west, south, east, north] = *box_m;
                if finite(box_m).is_ok() && west < east && south < north {
                    return Ok(());
                }
                Err(Complaint::about(
                    "box_m",
                    "write [west, south, east, north] in metres, west below east and south below north",
                ))
            }
            (None, Some(angle)) if !(angle > 0.0 && angle < 90.0) => Err(Complaint::about(
                "reach_angle_deg",
                "write an angle above 0 and below 90; few rocks come out below 25",
            )),
            (None, Some(_)) if self.margin_m.is_none() => Err(Complaint::missing(
                "margin_m",
                "write what is kept around the reach, 50.0 for instance",
            )),
            _ => Ok(()),
        }
    }

    fn part(&self, starts: &[[f64; 4]]) -> Crop {
        let margin_m = self.margin_m.unwrap_or(0.0);
        match (self.box_m, self.reach_angle_deg) {
            (Some(box_m), _) => Crop::Box(box_m, margin_m),
            (None, angle) => {
                let slope = math::tan(angle.unwrap_or_default().to_radians());
                Crop::Reach { starts: starts.to_vec(), slope, margin_m }
            }
        }
    }
}

impl MeshTable {
    pub(super) fn check(&self) -> Checked {
        let hint = "a thousandth of the shortest edge is plenty";
        optional("weld_tolerance_m", self.weld_tolerance_m, Allowed::NotNegative, hint)
    }
}

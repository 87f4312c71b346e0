//! `[[terrain]]`, `[[trees]]` and `[mesh]`.

use super::check::{Allowed, Checked, Complaint, number, optional, suggest};
use crate::terrain::weld::Up;
use serde::Deserialize;
use std::path::PathBuf;

/// One mesh file under `[[terrain]]` or `[[trees]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with mesh and ground")]
pub struct MeshFile {
    /// The STL file; once a [`Scene`](super::Scene) is read, as seen from the working directory.
    pub mesh: PathBuf,
    /// Name of its ground under `[grounds]`.
    pub ground: String,
    /// Which axis of the file points up.
    #[serde(default)]
    pub up: Up,
    /// Metres in one unit of the file (m), positive.
    #[serde(default = "metres")]
    pub scale: f64,
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
    pub(super) fn check(&self, grounds: &[&str]) -> Checked {
        number("scale", self.scale, Allowed::Positive, "0.001 for a file in millimetres")?;
        if grounds.contains(&self.ground.as_str()) {
            return Ok(());
        }
        let remedy = format!("write a name from [grounds]; {}", suggest(&self.ground, grounds));
        Err(Complaint::about("ground", remedy))
    }
}

impl MeshTable {
    pub(super) fn check(&self) -> Checked {
        let hint = "a thousandth of the shortest edge is plenty";
        optional("weld_tolerance_m", self.weld_tolerance_m, Allowed::NotNegative, hint)
    }
}

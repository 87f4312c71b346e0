//! Where things stand on the map, and what is said only once rocks have fallen.

use crate::hazard::LineFloor;
use crate::plan::FastWarning;
use serde::{Deserialize, Serialize};

/// Where meshes and releases lie, in map coordinates.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Site {
    /// Map position of the mesh files' (0, 0, 0) (m).
    pub mesh_origin_m: [f64; 3],
    /// Where rocks are released.
    pub release: ReleaseZone,
    /// Where further sources release theirs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub further_releases: Vec<ReleaseZone>,
    /// Names of all these places, in the order of [`zones`](Self::zones); empty where the scene names none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub release_names: Vec<String>,
    /// What the user should know if rocks come so fast.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fast_warnings: Vec<FastWarning>,
    /// The lowest ground of the terrain; none where rocks push each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<LineFloor>,
}

impl Site {
    /// Every place where rocks are released.
    pub fn zones(&self) -> impl Iterator<Item = &ReleaseZone> {
        std::iter::once(&self.release).chain(&self.further_releases)
    }

    /// The same, each with its name where it has one.
    pub fn named_zones(&self) -> impl Iterator<Item = (Option<&str>, &ReleaseZone)> {
        let names = self.release_names.iter().map(|name| Some(name.as_str()));
        names.chain(std::iter::repeat(None)).zip(self.zones())
    }
}

/// Where rocks are released, in plan view (m).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", content = "corners_m", rename_all = "snake_case")]
pub enum ReleaseZone {
    /// From these points.
    Points(Vec<[f64; 2]>),
    /// Along a line.
    Line(Vec<[f64; 2]>),
    /// Over an area.
    Polygon(Vec<[f64; 2]>),
}

impl Default for ReleaseZone {
    fn default() -> Self {
        Self::Points(Vec::new())
    }
}

impl ReleaseZone {
    /// Its corners or points (m).
    pub fn corners_m(&self) -> &[[f64; 2]] {
        match self {
            Self::Points(corners) | Self::Line(corners) | Self::Polygon(corners) => corners,
        }
    }
}

//! What is asked of a terrain's file beside its triangles.

use super::Sheet;
use super::weld::Up;

/// What is asked of a file beside its triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// What part of an elevation model or point cloud is used; absent = all.
    pub crop: Option<Crop>,
    /// Side of the cells to use (m): of a grid not below its own; of a cloud, the cell of which the lowest point is kept.
    pub resample_m: Option<f64>,
    /// Classes of the points that are ground (ASPRS); empty = 2.
    pub classes: Vec<u8>,
    /// EPSG code of the scene.
    pub epsg: Option<u32>,
}

/// A part of the map.
#[derive(Debug, Clone, PartialEq)]
pub enum Crop {
    /// A box: west, south, east, north (m), and what is kept around it (m).
    Box([f64; 4], f64),
    /// What rocks can reach.
    Reach {
        /// Boxes of the places where rocks start (m).
        starts: Vec<[f64; 4]>,
        /// Tangent of the lowest angle under which a rock comes to its start from above (–).
        slope: f64,
        /// What is kept around it (m).
        margin_m: f64,
    },
}

/// A box with more around it.
pub(super) fn wider([west, south, east, north]: [f64; 4], margin_m: f64) -> [f64; 4] {
    [west - margin_m, south - margin_m, east + margin_m, north + margin_m]
}

/// One file and how it enters the terrain.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSource {
    /// The file, its ground, and whether it is a tree.
    pub sheet: Sheet,
    /// Its up axis.
    pub up: Up,
    /// Metres per unit of the file, positive.
    pub scale: f64,
    /// What is asked of a file of any format; `None` = an STL file, whatever its name.
    pub options: Option<Options>,
}

impl MeshSource {
    /// An STL file as it stands: z up, metres.
    pub fn stl(sheet: Sheet) -> Self {
        Self { sheet, up: Up::Z, scale: 1.0, options: None }
    }
}

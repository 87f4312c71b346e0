//! Rows of `paths.csv` and `impacts.csv`; positions in map coordinates.

use super::checksum::RESTORE;
use crate::error::{Error, Result};
use crate::rock::Vec3;
use crate::simulation::{FeatureKind, Impact, PathPoint, PathState};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::PathBuf;

/// One instant of a kept path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PathRow {
    /// Release number.
    pub index: usize,
    /// Time since release (s).
    pub time_s: f64,
    /// Centre (m).
    pub position_m: [f64; 3],
    /// Velocity of the centre (m/s).
    pub velocity_m_s: [f64; 3],
    /// Angular velocity (rad/s).
    pub spin_rad_s: [f64; 3],
    /// Vertical distance from the ground below to the lowest point of the rock (m); NaN where there is none.
    pub clearance_m: f64,
    /// Flight, sliding or sticking.
    pub state: PathState,
    /// How a block is turned, a unit quaternion w, x, y, z; none in a scene of spheres, where the file has no such columns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attitude: Option<[f64; 4]>,
}

impl PathRow {
    /// Columns of `paths.csv`.
    pub const COLUMNS: [&'static str; 13] = [
        "index",
        "time_s",
        "x_m",
        "y_m",
        "z_m",
        "vx_m_s",
        "vy_m_s",
        "vz_m_s",
        "wx_rad_s",
        "wy_rad_s",
        "wz_rad_s",
        "clearance_m",
        "state",
    ];

    /// Columns that follow them where a scene has blocks.
    pub const SHAPE_COLUMNS: [&'static str; 4] = ["qw", "qx", "qy", "qz"];

    /// The row of one instant of rock `index`; `origin_m` is the map position of the local (0, 0, 0).
    pub fn of(index: usize, point: &PathPoint, origin_m: Vec3) -> Self {
        Self {
            index,
            time_s: point.motion.time_s,
            position_m: (point.motion.position_m + origin_m).into(),
            velocity_m_s: point.motion.velocity_m_s.into(),
            spin_rad_s: point.motion.spin_rad_s.into(),
            clearance_m: point.clearance_m,
            state: point.state,
            attitude: point.attitude,
        }
    }

    /// Whether all numbers are finite. A clearance may be NaN.
    fn is_finite(&self) -> bool {
        let all = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        all(&[self.time_s])
            && all(&self.position_m)
            && all(&self.velocity_m_s)
            && all(&self.spin_rad_s)
            && !self.clearance_m.is_infinite()
            && self.attitude.is_none_or(|attitude| all(&attitude))
    }

    /// The first number that is none where it should be, with the name of its column.
    fn not_finite(&self) -> Option<(&'static str, f64)> {
        // rows are read by the million, and all of a run are finite
        if self.is_finite() {
            return None;
        }
        let motion = [&self.position_m, &self.velocity_m_s, &self.spin_rad_s].into_iter().flatten();
        let clearance_m = if self.clearance_m.is_nan() { 0.0 } else { self.clearance_m };
        let plain = [&self.time_s].into_iter().chain(motion).chain([&clearance_m]).copied();
        let plain = Self::COLUMNS.into_iter().skip(1).zip(plain);
        let turned = Self::SHAPE_COLUMNS.into_iter().zip(self.attitude.into_iter().flatten());
        plain.chain(turned).find(|(_, value)| !value.is_finite())
    }

    /// What is wrong with a row behind one of another release or time, as place and found.
    fn flaw(&self, (index, time_s): (usize, f64)) -> Option<(&'static str, String)> {
        if let Some((column, value)) = self.not_finite() {
            return Some((column, format!("found {value}, which is no finite number")));
        }
        if self.index < index {
            return Some(("index", format!("found {} behind {index}", self.index)));
        }
        let falls = self.index == index && self.time_s < time_s;
        let found = || format!("found {} behind {time_s} of the same release", self.time_s);
        falls.then(|| ("time_s", found()))
    }

    /// The rows of a file as a run writes them: finite, release after release, and of each in the order of time.
    pub(super) fn checked(
        path: PathBuf,
        rows: impl Iterator<Item = Result<Self>>,
    ) -> impl Iterator<Item = Result<Self>> {
        let (mut before, mut line) = ((0, f64::NEG_INFINITY), 1);
        rows.map(move |row| {
            let row = row?;
            // the first line names the columns
            line += 1;
            match row.flaw(before) {
                None => before = (row.index, row.time_s),
                Some((column, found)) => {
                    return Err(Error::input(
                        &path,
                        format!("line {line}, {column}"),
                        found,
                        RESTORE,
                    ));
                }
            }
            Ok(row)
        })
    }
}

/// One impact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImpactRow<'a> {
    /// Release number.
    pub index: usize,
    /// Time of first touch (s).
    pub time_s: f64,
    /// Touched point (m).
    pub point_m: [f64; 3],
    /// What of the mesh was touched.
    pub feature: FeatureKind,
    /// Name of the ground.
    pub ground: Cow<'a, str>,
    /// Speed of the centre before (m/s).
    pub speed_in_m_s: f64,
    /// Speed of the centre after (m/s).
    pub speed_out_m_s: f64,
    /// Mechanical energy lost (J).
    pub energy_lost_j: f64,
    /// What of it the drag of soil took (J); none where no ground has a scar layer and the file has no such column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub soil_j: Option<f64>,
}

impl<'a> ImpactRow<'a> {
    /// Columns of `impacts.csv`.
    pub const COLUMNS: [&'static str; 10] = [
        "index",
        "time_s",
        "x_m",
        "y_m",
        "z_m",
        "feature",
        "ground",
        "speed_in_m_s",
        "speed_out_m_s",
        "energy_lost_j",
    ];

    /// The column that follows them where a ground has a scar layer.
    pub const SOIL_COLUMNS: [&'static str; 1] = crate::hazard::Row::SOIL_COLUMNS;

    /// The row of one impact of rock `index` on the named ground.
    pub fn of(index: usize, impact: &Impact, ground: &'a str, origin_m: Vec3) -> Self {
        Self {
            index,
            time_s: impact.time_s,
            point_m: (impact.point_m + origin_m).into(),
            feature: impact.feature,
            ground: Cow::Borrowed(ground),
            speed_in_m_s: impact.speed_in_m_s,
            speed_out_m_s: impact.speed_out_m_s,
            energy_lost_j: impact.energy_lost_j,
            soil_j: None,
        }
    }
}

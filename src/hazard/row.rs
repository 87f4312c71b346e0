//! One released rock as a row of numbers: the only way into the statistics, from a run as from a file.

use crate::rock::Vec3;
use crate::simulation::{RockShape, Stop, Trajectory};
use serde::{Deserialize, Serialize};

/// One row of `releases.csv`; positions in map coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Release number, from 0.
    pub index: usize,
    /// Why the rock ended.
    pub stop: StopKind,
    /// Simulated time from release to end (s).
    pub time_s: f64,
    /// Radius (m).
    pub radius_m: f64,
    /// Mass (kg).
    pub mass_kg: f64,
    /// Centre at release (m).
    pub start_m: [f64; 3],
    /// Centre at the end (m).
    pub end_m: [f64; 3],
    /// Velocity at the end (m/s).
    pub end_velocity_m_s: [f64; 3],
    /// Angular velocity at the end (rad/s).
    pub end_spin_rad_s: [f64; 3],
    /// Horizontal distance from release to end (m).
    pub runout_m: f64,
    /// Height lost from release to end (m), positive downwards.
    pub drop_m: f64,
    /// Reach angle, atan(drop/runout) (degrees).
    pub reach_angle_deg: f64,
    /// Largest speed of the centre (m/s).
    pub max_speed_m_s: f64,
    /// Largest translational energy (J).
    pub max_translational_j: f64,
    /// Largest rotational energy (J).
    pub max_rotational_j: f64,
    /// Largest sum of both at one instant (J).
    pub max_total_j: f64,
    /// Largest vertical distance from the ground below to the lowest point of the rock (m).
    pub max_height_m: f64,
    /// Impacts, trees included.
    pub impacts: u32,
    /// Impacts on trees.
    pub tree_impacts: u32,
    /// |numerical remainder of the energy| / energy released (–).
    pub energy_balance_error: f64,
    /// Accepted contact steps.
    pub steps: u64,
    /// Free flights leapt over.
    pub leaps: u64,
    /// Passes over the contacts.
    pub sweeps: u64,
    /// Energy lost to sliding friction on the slope (J).
    pub friction_j: f64,
    /// Energy lost to dashpots on the slope (J).
    pub damping_j: f64,
    /// Energy lost to rolling friction on the slope (J).
    pub rolling_j: f64,
    /// Energy lost in contacts with trees (J).
    pub trees_j: f64,
    /// What the numerics lost (positive) or gained (negative) beside the rest (J).
    pub remainder_j: f64,
    /// Energy lost in contacts with other rocks, half of what each takes (J).
    pub others_j: f64,
    /// Energy handed on to other rocks, negative if received (J).
    pub passed_on_j: f64,
    /// Energy that the springs of its contacts with the mesh hold at the end, more than at release (J).
    #[serde(default)]
    pub springs_j: f64,
    /// Its shape; none in a scene of spheres, where the file has no such columns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<RockShape>,
    /// Energy lost to the drag of soil (J); none where no ground has a scar layer and the file has no such column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub soil_j: Option<f64>,
}

/// [`Stop`] without the reason of a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopKind {
    /// Came to rest.
    AtRest,
    /// Flew out of the box of the meshes.
    LeftTerrain,
    /// Still moving at the longest simulated time.
    TimeUp,
    /// Still moving when its budget of work was spent.
    OverBudget,
    /// The computation could not go on.
    Failed,
    /// Never began: no place was found where it could start.
    NotReleased,
}

impl StopKind {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 6] = [
        Self::AtRest,
        Self::LeftTerrain,
        Self::TimeUp,
        Self::OverBudget,
        Self::Failed,
        Self::NotReleased,
    ];

    /// Whether the rock began: only then it has its part of what a source releases.
    pub fn is_released(self) -> bool {
        self != Self::NotReleased
    }

    /// Whether no sound run ends a rock so: what never happened then needs no line in a table.
    pub fn is_unusual(self) -> bool {
        matches!(self, Self::OverBudget | Self::NotReleased)
    }

    /// Whether the rock would have gone on: where it ended says only how far it came at least. What a rock had done before
    /// the step that failed is as sound as before any other end.
    pub fn is_open(self) -> bool {
        matches!(self, Self::LeftTerrain | Self::TimeUp | Self::OverBudget | Self::Failed)
    }

    /// Its word in `releases.csv` and `summary.json`.
    pub fn word(self) -> &'static str {
        match self {
            Self::AtRest => "at_rest",
            Self::LeftTerrain => "left_terrain",
            Self::TimeUp => "time_up",
            Self::OverBudget => "over_budget",
            Self::NotReleased => "not_released",
            Self::Failed => "failed",
        }
    }
}

impl From<&Stop> for StopKind {
    fn from(stop: &Stop) -> Self {
        match stop {
            Stop::AtRest => Self::AtRest,
            Stop::LeftTerrain => Self::LeftTerrain,
            Stop::TimeUp => Self::TimeUp,
            Stop::OverBudget => Self::OverBudget,
            Stop::NotReleased(_) => Self::NotReleased,
            Stop::Failed(_) => Self::Failed,
        }
    }
}

impl Row {
    /// Columns of `releases.csv`, in order; a vector takes three.
    pub const COLUMNS: [&'static str; 39] = [
        "index",
        "stop",
        "time_s",
        "radius_m",
        "mass_kg",
        "start_x_m",
        "start_y_m",
        "start_z_m",
        "end_x_m",
        "end_y_m",
        "end_z_m",
        "end_vx_m_s",
        "end_vy_m_s",
        "end_vz_m_s",
        "end_wx_rad_s",
        "end_wy_rad_s",
        "end_wz_rad_s",
        "runout_m",
        "drop_m",
        "reach_angle_deg",
        "max_speed_m_s",
        "max_translational_j",
        "max_rotational_j",
        "max_total_j",
        "max_height_m",
        "impacts",
        "tree_impacts",
        "energy_balance_error",
        "steps",
        "leaps",
        "sweeps",
        "friction_j",
        "damping_j",
        "rolling_j",
        "trees_j",
        "remainder_j",
        "others_j",
        "passed_on_j",
        "springs_j",
    ];

    /// Columns that follow them where a scene has blocks: shape, sides 2 and 3 over side 1, and how it was turned at release.
    pub const SHAPE_COLUMNS: [&'static str; 7] =
        ["shape", "side_2", "side_3", "start_qw", "start_qx", "start_qy", "start_qz"];

    /// The column that follows them where a ground has a scar layer.
    pub const SOIL_COLUMNS: [&'static str; 1] = ["soil_j"];

    /// The row of one journey; `origin_m` is the map position of the local (0, 0, 0).
    pub fn of(fall: &Trajectory, origin_m: Vec3) -> Self {
        let (start, end, most) = (&fall.start, &fall.end, &fall.extremes);
        Self {
            index: fall.index,
            stop: (&fall.stop).into(),
            time_s: end.time_s,
            radius_m: fall.rock.radius_m,
            mass_kg: fall.rock.mass_kg(),
            start_m: (start.position_m + origin_m).into(),
            end_m: (end.position_m + origin_m).into(),
            end_velocity_m_s: end.velocity_m_s.into(),
            end_spin_rad_s: end.spin_rad_s.into(),
            runout_m: fall.runout_m(),
            drop_m: fall.drop_m(),
            reach_angle_deg: fall.reach_angle_deg(),
            max_speed_m_s: most.speed_m_s,
            max_translational_j: most.translational_j,
            max_rotational_j: most.rotational_j,
            max_total_j: most.total_j,
            max_height_m: most.height_m,
            impacts: fall.impact_count,
            tree_impacts: fall.tree_impact_count,
            energy_balance_error: fall.energy_balance_error(),
            steps: fall.effort.steps,
            leaps: fall.effort.leaps,
            sweeps: fall.effort.sweeps,
            friction_j: fall.ledger.friction_j,
            damping_j: fall.ledger.damping_j,
            rolling_j: fall.ledger.rolling_j,
            trees_j: fall.ledger.trees_j,
            remainder_j: fall.ledger.remainder_j,
            others_j: fall.ledger.others_j,
            passed_on_j: fall.ledger.passed_on_j,
            springs_j: fall.ledger.springs_j,
            shape: fall.shape,
            soil_j: None,
        }
    }
}

//! The quantities of which statistics are kept.

use super::quantile::Open;
use super::row::{Row, StopKind};

/// A quantity that every released rock has one value of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Horizontal distance from release to end (m).
    Runout,
    /// Height lost from release to end (m).
    Drop,
    /// Reach angle, atan(drop/runout) (degrees).
    ReachAngle,
    /// Largest speed of the centre (m/s).
    MaxSpeed,
    /// Largest translational energy (J).
    MaxTranslational,
    /// Largest rotational energy (J).
    MaxRotational,
    /// Largest sum of both at one instant (J).
    MaxTotal,
    /// Largest vertical distance from the ground below to the lowest point of the rock (m).
    MaxHeight,
    /// Impacts, trees included.
    Impacts,
    /// Impacts on trees.
    TreeImpacts,
    /// Simulated time from release to end (s).
    Time,
}

impl Quantity {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 11] = [
        Self::Runout,
        Self::Drop,
        Self::ReachAngle,
        Self::MaxSpeed,
        Self::MaxTranslational,
        Self::MaxRotational,
        Self::MaxTotal,
        Self::MaxHeight,
        Self::Impacts,
        Self::TreeImpacts,
        Self::Time,
    ];

    /// Its column in `releases.csv`, with the unit as suffix.
    pub fn column(self) -> &'static str {
        match self {
            Self::Runout => "runout_m",
            Self::Drop => "drop_m",
            Self::ReachAngle => "reach_angle_deg",
            Self::MaxSpeed => "max_speed_m_s",
            Self::MaxTranslational => "max_translational_j",
            Self::MaxRotational => "max_rotational_j",
            Self::MaxTotal => "max_total_j",
            Self::MaxHeight => "max_height_m",
            Self::Impacts => "impacts",
            Self::TreeImpacts => "tree_impacts",
            Self::Time => "time_s",
        }
    }

    /// On which side of what was seen the true value of a rock lies that would have gone on.
    pub fn open(self) -> Open {
        if self == Self::ReachAngle { Open::Below } else { Open::Above }
    }

    /// Whether what was seen of a rock that ended so is only a bound. Largest values and counts of one that left the terrain are those
    /// on the terrain given; one that ran out of time or failed might have come to larger ones there.
    pub fn is_bound_after(self, stop: StopKind) -> bool {
        let is_of_the_end =
            matches!(self, Self::Runout | Self::Drop | Self::Time | Self::ReachAngle);
        stop.is_open() && (is_of_the_end || stop != StopKind::LeftTerrain)
    }

    /// Its value for one rock.
    pub fn of(self, row: &Row) -> f64 {
        match self {
            Self::Runout => row.runout_m,
            Self::Drop => row.drop_m,
            Self::ReachAngle => row.reach_angle_deg,
            Self::MaxSpeed => row.max_speed_m_s,
            Self::MaxTranslational => row.max_translational_j,
            Self::MaxRotational => row.max_rotational_j,
            Self::MaxTotal => row.max_total_j,
            Self::MaxHeight => row.max_height_m,
            Self::Impacts => f64::from(row.impacts),
            Self::TreeImpacts => f64::from(row.tree_impacts),
            Self::Time => row.time_s,
        }
    }
}

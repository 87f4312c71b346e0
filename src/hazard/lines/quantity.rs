//! The quantities at an evaluation line.

use super::CrossingRow;

/// A quantity at a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum LineQuantity {
    /// Speed of the centre (m/s).
    Speed,
    /// Translational energy (J).
    Translational,
    /// Rotational energy (J).
    Rotational,
    /// Sum of both (J).
    Total,
    /// Vertical height of the lowest point over the ground (m).
    Height,
    /// Height along the normal of the slope (m).
    HeightNormal,
    /// Slope of the path against the horizontal (degrees).
    Descent,
}

impl LineQuantity {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 7] = [
        Self::Speed,
        Self::Translational,
        Self::Rotational,
        Self::Total,
        Self::Height,
        Self::HeightNormal,
        Self::Descent,
    ];

    /// Its name in `summary.json`, the column of `crossings.csv` where there is one.
    pub fn column(self) -> &'static str {
        match self {
            Self::Speed => "speed_m_s",
            Self::Translational => "translational_j",
            Self::Rotational => "rotational_j",
            Self::Total => "total_j",
            Self::Height => "height_m",
            Self::HeightNormal => "height_normal_m",
            Self::Descent => "descent_deg",
        }
    }

    /// Its value at one crossing.
    pub fn of(self, row: &CrossingRow) -> f64 {
        match self {
            Self::Speed => row.speed_m_s,
            Self::Translational => row.translational_j,
            Self::Rotational => row.rotational_j,
            Self::Total => row.total_j(),
            Self::Height => row.height_m,
            Self::HeightNormal => row.height_normal_m,
            Self::Descent => row.descent_deg,
        }
    }

    /// What heights like those of this crossing can never lie below (m), of [`HEIGHTS`]. The lowest point of a block may lie below the ground under
    /// its centre, on even ground by no more than half of how high the block stands. The plane of the triangle below a rock that leaves an edge
    /// may go through it.
    pub(super) fn least_heights_m(row: &CrossingRow) -> [f64; HEIGHTS.len()] {
        let half_m = (row.highest_m() - row.height_m) / 2.0;
        [if row.top_m.is_some() { -half_m } else { 0.0 }, -half_m]
    }
}

/// Those that may lie below 0 by as much as a rock is large.
pub(super) const HEIGHTS: [LineQuantity; 2] = [LineQuantity::Height, LineQuantity::HeightNormal];

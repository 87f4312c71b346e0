//! Sizes and rates of blocks that a scene may have.

use super::check::{Allowed, Checked, number};

/// Largest exponent (–): measured ones are below 2, and far steeper laws have one size only.
pub(super) const STEEPEST: f64 = 20.0;
/// What rates must be.
pub(super) const COUNTABLE: &str = "write rates, exponent and volumes that make 1e-120 to 1e12 events a year in every class of size";

/// Volumes of blocks (m³) that a run can follow, from a pebble to a hillside.
pub(super) const VOLUMES_M3: [f64; 2] = [1e-6, 1e6];

/// Whether two volumes (m³) rise and can be followed.
pub(super) fn are_volumes([least, largest]: [f64; 2], may_be_equal: bool) -> bool {
    let rise = least < largest || may_be_equal && least <= largest;
    rise && least >= VOLUMES_M3[0] && largest <= VOLUMES_M3[1]
}

pub(super) fn positive_list(key: &str, list: Option<&[f64]>) -> Checked {
    list.unwrap_or_default().iter().try_for_each(|value| number(key, *value, Allowed::Positive, ""))
}

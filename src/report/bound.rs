//! Whether an estimate is a value or a bound.

use crate::hazard::Open;

/// What an estimate says of the quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Is {
    /// Its value.
    #[default]
    Value,
    /// A lower bound: rocks that left the terrain would have gone on.
    AtLeast,
    /// An upper bound, for the same reason.
    AtMost,
    /// Nothing: so many rocks are missing.
    Lacking(usize),
}

impl Is {
    /// What comes to a place: a lower bound where rocks that would have gone on decide it.
    pub(super) fn at_least_if(is_bound: bool) -> Self {
        Self::on_side(is_bound, None)
    }

    /// A number that bounds decide or not, where the truth lies on the side `open` of them; of counts it lies above.
    pub(super) fn on_side(is_bound: bool, open: Option<Open>) -> Self {
        match (is_bound, open) {
            (true, Some(Open::Below)) => Self::AtMost,
            (true, _) => Self::AtLeast,
            (false, _) => Self::Value,
        }
    }
}

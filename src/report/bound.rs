//! Whether an estimate is a value or a bound.

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
        if is_bound { Self::AtLeast } else { Self::Value }
    }
}

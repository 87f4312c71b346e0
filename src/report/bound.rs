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

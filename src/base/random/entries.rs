//! Lists of a fixed length, as scenes write them: one entry too many is as wrong as one too few.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// A list of exactly `N` entries. Arrays read by `serde` alone forget what stands behind the last entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entries<T, const N: usize>(pub [T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Entries<T, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let all = Vec::<T>::deserialize(from)?;
        let found = all.len();
        let wanted = format!("an array of length {N}");
        let wrong = |_| D::Error::invalid_length(found, &wanted.as_str());
        all.try_into().map(Self).map_err(wrong)
    }
}

/// For `#[serde(deserialize_with)]` on an array.
///
/// # Errors
/// What stands there is not a list of exactly `N` entries, or an entry is not a `T`; the message is the reader's.
pub fn entries<'de, D, T, const N: usize>(from: D) -> Result<[T; N], D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    Entries::deserialize(from).map(|Entries(all)| all)
}

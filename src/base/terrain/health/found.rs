//! Of what is found all over a mesh, the number and the largest.

use super::MOST_NAMED;

/// How many there are, and the largest of them, the largest first.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Found<T> {
    /// All.
    pub count: usize,
    /// Up to fifty.
    pub largest: Vec<T>,
}

impl<T> Default for Found<T> {
    fn default() -> Self {
        Self { count: 0, largest: Vec::new() }
    }
}

impl<T> Found<T> {
    pub(super) fn largest(mut all: Vec<T>, size: impl Fn(&T) -> f64) -> Self {
        all.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let count = all.len();
        all.truncate(MOST_NAMED);
        Self { count, largest: all }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

//! The passages of one rock through the cells of a map, or through stretches of distance.
//!
//! A rock mostly stays in the same place, so a new passage is compared with the last entry only.
//! Entries of a place that the rock came back to are merged at the end, by one sort: O(n log n) in
//! the number of entries, and no table as large as the map.

/// One rock in one place.
pub(super) trait Passage: Copy {
    /// Number of the place.
    fn place_number(&self) -> u32;

    /// Largest height in it (m).
    fn height_m(&self) -> f64;

    /// Takes the larger values of another passage of the same place.
    fn merge(&mut self, other: &Self);
}

/// The passages of one rock so far.
#[derive(Debug)]
pub(super) struct Passages<T>(Vec<T>);

impl<T: Passage> Passages<T> {
    pub(super) fn new() -> Self {
        Self(Vec::new())
    }

    pub(super) fn last(&self) -> Option<&T> {
        self.0.last()
    }

    /// The largest height so far (m) in this place, if the rock is there now: lower heights need no
    /// search.
    pub(super) fn known_m(&self, place: u32) -> Option<f64> {
        self.last().filter(|last| last.place_number() == place).map(T::height_m)
    }

    /// Number of entries so far, and the last, into which the next may be merged. The last must be
    /// copied: it is the only entry that changes after it has been added.
    pub(super) fn mark(&self) -> (usize, Option<T>) {
        (self.0.len(), self.0.last().copied())
    }

    /// Restores a mark.
    pub(super) fn restore(&mut self, (count, last): (usize, Option<T>)) {
        self.0.truncate(count);
        if let (Some(now), Some(last)) = (self.0.last_mut(), last) {
            *now = last;
        }
    }

    /// Merges with the last entry if that is in the same place, which holds for most steps.
    pub(super) fn add(&mut self, passage: T) {
        match self.0.last_mut().filter(|last| last.place_number() == passage.place_number()) {
            Some(last) => last.merge(&passage),
            None => self.0.push(passage),
        }
    }

    /// One entry per place, in the order of places. The sort is stable, so the result depends only
    /// on the order in which the rock passed.
    pub(super) fn into_found(mut self) -> Vec<T> {
        self.0.sort_by_key(Passage::place_number);
        self.0.dedup_by(|next, kept| {
            let same = next.place_number() == kept.place_number();
            if same {
                kept.merge(next);
            }
            same
        });
        self.0
    }
}

//! A list of passages of one rock: through cells, or along stretches of its way.
//!
//! A rock mostly stays where it is, so a new passage is compared with the last entry alone; what
//! came back to an earlier place is joined at the end, by one sort. O(n log n) in the number of
//! entries, and no table as large as the map.

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

    /// The largest height so far (m) in the place where the rock is, if it is this one: lower ones need no search.
    pub(super) fn known_m(&self, place: u32) -> Option<f64> {
        self.last().filter(|last| last.place_number() == place).map(T::height_m)
    }

    /// How many there are so far, and the last, which the next may join.
    /// The last must be copied: it is the one entry that changes after it has been added.
    pub(super) fn mark(&self) -> (usize, Option<T>) {
        (self.0.len(), self.0.last().copied())
    }

    /// Goes back to a mark.
    pub(super) fn restore(&mut self, (count, last): (usize, Option<T>)) {
        self.0.truncate(count);
        if let (Some(now), Some(last)) = (self.0.last_mut(), last) {
            *now = last;
        }
    }

    /// Adds to the last if that is in the same place: most steps stay in theirs.
    pub(super) fn add(&mut self, passage: T) {
        match self.0.last_mut().filter(|last| last.place_number() == passage.place_number()) {
            Some(last) => last.merge(&passage),
            None => self.0.push(passage),
        }
    }

    /// One entry a place, in the order of places.
    /// A stable sort, so joining does not depend on anything but the order in which the rock went.
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

//! Queue of the contacts of an island that are still to be solved, and an index of the contacts of every rock.
//!
//! A contact is solved again only after the motion of one of its rocks has changed. The cost of a sweep over a large heap
//! therefore follows the number of changes and not the number of contacts.

use std::ops::Range;

/// A set of contacts, one bit for each.
/// Iterated in ascending or descending order by counting the zeros of words: no heap, no sorting.
#[derive(Debug, Default)]
pub(super) struct ContactQueue(Vec<u64>);

impl ContactQueue {
    /// Every number below `count`.
    pub(super) fn all(&mut self, count: usize) {
        self.0.clear();
        self.0.resize(count.div_ceil(64), u64::MAX);
        let over = 64 * self.0.len() - count;
        if let Some(last) = self.0.last_mut() {
            *last >>= over;
        }
    }

    pub(super) fn add(&mut self, k: usize) {
        self.0[k / 64] |= 1 << (k % 64);
    }

    pub(super) fn remove(&mut self, k: usize) {
        self.0[k / 64] &= !(1 << (k % 64));
    }

    /// The first at or after `k`.
    #[inline]
    pub(super) fn from(&self, k: usize) -> Option<usize> {
        let mut at = k / 64;
        let mut word = *self.0.get(at)? & (u64::MAX << (k % 64));
        while word == 0 {
            at += 1;
            word = *self.0.get(at)?;
        }
        Some(64 * at + word.trailing_zeros() as usize)
    }

    /// The last before `k`.
    #[inline]
    pub(super) fn below(&self, k: usize) -> Option<usize> {
        let mut at = k / 64;
        let mut word = self.0.get(at).map_or(0, |word| word & !(u64::MAX << (k % 64)));
        while word == 0 {
            at = at.checked_sub(1)?;
            word = self.0[at];
        }
        Some(64 * at + 63 - word.leading_zeros() as usize)
    }

    pub(super) fn last(&self) -> Option<usize> {
        self.below(64 * self.0.len())
    }
}

/// The contacts of every rock, in compressed rows.
#[derive(Debug, Default)]
pub(super) struct ContactsOfRocks {
    /// First entry of each rock in `lists`, and the lists of all rocks one after the other.
    first: Vec<u32>,
    lists: Vec<u32>,
}

impl ContactsOfRocks {
    /// Indexes contacts, given by their two rocks (twice the same for a contact with the mesh), by rock.
    /// Counting sort: two passes, no allocation but that of the lists.
    pub(super) fn index(&mut self, ends: &[[usize; 2]], rocks: usize) {
        let Self { first, lists } = self;
        let of = |[a, b]: [usize; 2]| [Some(a), Some(b).filter(|b| *b != a)].into_iter().flatten();
        first.clear();
        first.resize(rocks + 1, 0);
        for &ends in ends {
            of(ends).for_each(|k| first[k] += 1);
        }
        let mut sum = 0;
        for first in first.iter_mut() {
            sum += *first;
            *first = sum;
        }
        lists.clear();
        lists.resize(sum as usize, 0);
        // filled from the end, so that each list ascends and `first` ends at the beginning of each list
        for place in (0..ends.len()).rev() {
            for k in of(ends[place]) {
                first[k] -= 1;
                lists[first[k] as usize] = place as u32;
            }
        }
    }

    /// Range of the contacts of a rock in the lists.
    pub(super) fn places(&self, rock: usize) -> Range<usize> {
        self.first[rock] as usize..self.first[rock + 1] as usize
    }

    /// The contact at a place in the lists.
    pub(super) fn at(&self, place: usize) -> usize {
        self.lists[place] as usize
    }

    /// The contacts of a rock in ascending order.
    pub(super) fn of(&self, rock: usize) -> impl Iterator<Item = usize> {
        self.lists[self.places(rock)].iter().map(|contact| *contact as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::ContactQueue;

    /// Onwards and backwards give the same numbers, and none that was not put in.
    #[test]
    fn a_set_gives_back_its_numbers_in_order() {
        let mut set = ContactQueue::default();
        set.all(130);
        assert_eq!((set.from(0), set.last()), (Some(0), Some(129)));
        (0..130).filter(|k| k % 7 != 3).for_each(|k| set.remove(k));
        set.add(64);
        let onwards: Vec<usize> = std::iter::successors(set.from(0), |k| set.from(k + 1)).collect();
        let mut backwards: Vec<usize> =
            std::iter::successors(set.last(), |k| set.below(*k)).collect();
        backwards.reverse();
        let expected: Vec<usize> = (0..130).filter(|k| k % 7 == 3 || *k == 64).collect();
        assert_eq!(onwards, expected);
        assert_eq!(backwards, expected);
        set.all(0);
        assert_eq!((set.from(0), set.last()), (None, None));
    }
}

//! Which contacts of an island are to be solved, and the contacts of every rock.
//!
//! A sweep over a large heap costs what happens in it and not what is there: a contact is asked once more only after one of its
//! rocks was set in another motion.

use std::ops::Range;

/// A set of contacts, a bit for each.
/// Found again in ascending or descending order by counting zeros of words: no heap, no sorting.
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

/// The contacts of every rock.
#[derive(Debug, Default)]
pub(super) struct ContactsOfRocks {
    /// Where the list of each rock begins, and the lists, one after the other.
    first: Vec<u32>,
    lists: Vec<u32>,
}

impl ContactsOfRocks {
    /// Lists for every rock the numbers of what joins it to another, or to itself alone.
    /// Counting sort: two passes, no allocation but the lists themselves.
    pub(super) fn lay(&mut self, ends: &[[usize; 2]], rocks: usize) {
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
        // filled from behind, so that each list is in order and its beginning is left where it belongs
        for place in (0..ends.len()).rev() {
            for k in of(ends[place]) {
                first[k] -= 1;
                lists[first[k] as usize] = place as u32;
            }
        }
    }

    /// Places in the lists of the contacts of a rock.
    pub(super) fn places(&self, rock: usize) -> Range<usize> {
        self.first[rock] as usize..self.first[rock + 1] as usize
    }

    /// The contact at a place.
    pub(super) fn at(&self, place: usize) -> usize {
        self.lists[place] as usize
    }

    /// The contacts of a rock, rising.
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

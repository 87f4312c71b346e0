//! Islands: rocks that may touch each other, directly or through others.

use crate::contact::pair::PairHistory;

/// A forest of sets; the smallest number of a set stands for it.
#[derive(Debug, Clone)]
pub struct Partition(Vec<u32>);

impl Partition {
    /// `count` rocks, each alone.
    pub fn alone(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// `count` rocks, joined where they hold each other.
    pub fn held(count: usize, pair_histories: &[PairHistory]) -> Self {
        let held = pair_histories.iter().filter(|pair_history| pair_history.is_held());
        Self::joined(count, held.map(|pair_history| (pair_history.a, pair_history.b)))
    }

    /// `count` rocks, joined by pairs.
    pub fn joined(count: usize, pairs: impl Iterator<Item = (u32, u32)>) -> Self {
        let mut islands = Self::alone(count);
        pairs.for_each(|(a, b)| islands.join(a, b));
        islands
    }

    /// The rock that stands for the island of `k`.
    pub fn of(&mut self, k: u32) -> u32 {
        let mut root = k;
        while self.0[root as usize] != root {
            // halving the path keeps it short
            self.0[root as usize] = self.0[self.0[root as usize] as usize];
            root = self.0[root as usize];
        }
        root
    }

    /// Makes one island of two.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// How many rocks each island has, at the place of the rock that stands for it; 0 elsewhere.
    pub fn sizes(&mut self) -> Vec<u32> {
        let count = self.0.len();
        let mut sizes = vec![0; count];
        for k in 0..count as u32 {
            sizes[self.of(k) as usize] += 1;
        }
        sizes
    }

    /// The members of every island, in ascending order.
    pub fn lists(&mut self) -> Vec<Vec<u32>> {
        let sizes = self.sizes();
        let mut number = vec![0; sizes.len()];
        let mut lists = Vec::new();
        for (k, &size) in sizes.iter().enumerate().filter(|(_, size)| **size > 0) {
            number[k] = lists.len();
            lists.push(Vec::with_capacity(size as usize));
        }
        for k in 0..sizes.len() as u32 {
            lists[number[self.of(k) as usize]].push(k);
        }
        lists
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_rocks_share_an_island_whatever_the_order() {
        let mut islands = Partition::alone(6);
        for (a, b) in [(5, 3), (1, 0), (3, 1)] {
            islands.join(a, b);
        }
        assert_eq!(islands.lists(), [vec![0, 1, 3, 5], vec![2], vec![4]]);
    }
}

//! Which of many things hang together.

use crate::parallel;

/// Things that one thread joins among themselves: of a lattice of triangles, forty rows of a large tile.
const SHARE: u32 = 1 << 18;

/// Things 0..n in groups that grow together (union–find with path halving; the lowest member stands for its group).
#[derive(Debug)]
pub struct Groups {
    parent: Vec<u32>,
}

impl Groups {
    /// Every thing alone.
    pub fn of(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// Things that are joined by pairs.
    pub fn of_pairs(count: usize, pairs: impl IntoIterator<Item = (u32, u32)>) -> Self {
        let mut groups = Self::of(count);
        pairs.into_iter().for_each(|(a, b)| groups.join(a, b));
        groups
    }

    /// Things that are joined with those beside them; shares of near numbers are joined on all threads.
    pub fn joined<I: Iterator<Item = u32>>(count: usize, beside: impl Fn(u32) -> I + Sync) -> Self {
        let mut groups = Self::of(count);
        let share_of = |thing: u32| thing / SHARE;
        parallel::update_shares(&mut groups.parent, SHARE as usize, |first, parents| {
            let share = share_of(first as u32);
            let mut own = Self::of(parents.len());
            for thing in 0..parents.len() as u32 {
                let inside =
                    beside(share * SHARE + thing).filter(|&other| share_of(other) == share);
                inside.for_each(|other| own.join(thing, other % SHARE));
            }
            for (parent, own) in parents.iter_mut().zip(own.parent) {
                *parent = share * SHARE + own;
            }
        });
        let leaves_its_share =
            |thing: u32| beside(thing).any(|other| share_of(other) != share_of(thing));
        for thing in parallel::filter(count, leaves_its_share) {
            beside(thing).for_each(|other| groups.join(thing, other));
        }
        groups
    }

    /// The lowest member of a thing's group.
    pub fn lowest(&mut self, mut thing: u32) -> u32 {
        while self.parent[thing as usize] != thing {
            let above = self.parent[self.parent[thing as usize] as usize];
            self.parent[thing as usize] = above;
            thing = above;
        }
        thing
    }

    /// Joins the groups of two things.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.lowest(a), self.lowest(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// Number of members of every group, by its lowest member.
    pub fn sizes(&mut self) -> Vec<usize> {
        let mut sizes = self.counts();
        sizes.retain(|&size| size > 0);
        sizes
    }

    /// The same at the place of that member; 0 elsewhere.
    fn counts(&mut self) -> Vec<usize> {
        let mut counts = vec![0; self.parent.len()];
        for thing in 0..self.parent.len() as u32 {
            counts[self.lowest(thing) as usize] += 1;
        }
        counts
    }

    /// Members of every group in ascending order, by its lowest.
    pub fn lists(&mut self) -> Vec<Vec<u32>> {
        let counts = self.counts();
        let (mut number, mut lists) = (vec![0; counts.len()], Vec::new());
        for (thing, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            number[thing] = lists.len();
            lists.push(Vec::with_capacity(count));
        }
        for thing in 0..counts.len() as u32 {
            lists[number[self.lowest(thing) as usize]].push(thing);
        }
        lists
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Groups joined share by share are those joined one after the other, however far the neighbours are in number.
    #[test]
    fn shares_change_no_group() {
        let count = 5 * SHARE as usize / 2;
        let beside = |thing: u32| {
            let near = (!thing.is_multiple_of(7)).then(|| thing - 1);
            let far = (thing.is_multiple_of(1001)).then(|| (thing as usize * 31 % count) as u32);
            near.into_iter().chain(far)
        };
        let mut one_by_one = Groups::of(count);
        (0..count as u32).for_each(|t| beside(t).for_each(|other| one_by_one.join(t, other)));
        let mut joined = Groups::joined(count, beside);
        assert!((0..count as u32).all(|t| joined.lowest(t) == one_by_one.lowest(t)));
        let sizes = joined.sizes();
        assert!(sizes == one_by_one.sizes() && sizes.len() > 1000 && sizes.iter().any(|&n| n > 7));
    }

    #[test]
    fn joined_things_share_a_group_whatever_the_order() {
        let mut groups = Groups::of_pairs(6, [(5, 3), (1, 0), (3, 1)]);
        assert_eq!(groups.lists(), [vec![0, 1, 3, 5], vec![2], vec![4]]);
    }
}

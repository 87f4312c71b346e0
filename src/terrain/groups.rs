//! Which of many things hang together.

/// Things 0..n in groups that grow together (union–find with path halving; the lowest member stands for its group).
#[derive(Debug)]
pub(super) struct Groups {
    parent: Vec<u32>,
}

impl Groups {
    /// Every thing alone.
    pub(super) fn of(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// The lowest member of a thing's group.
    pub(super) fn lowest(&mut self, mut thing: u32) -> u32 {
        while self.parent[thing as usize] != thing {
            let above = self.parent[self.parent[thing as usize] as usize];
            self.parent[thing as usize] = above;
            thing = above;
        }
        thing
    }

    /// Joins the groups of two things.
    pub(super) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.lowest(a), self.lowest(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// Number of members of every group, by its lowest member.
    pub(super) fn sizes(&mut self) -> Vec<usize> {
        let mut sizes = vec![0; self.parent.len()];
        for thing in 0..self.parent.len() as u32 {
            sizes[self.lowest(thing) as usize] += 1;
        }
        sizes.retain(|&size| size > 0);
        sizes
    }
}

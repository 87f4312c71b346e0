//! In which order the rocks of an island are eliminated, and which blocks their factor then has.
//!
//! Approximate minimum degree (Amestoy, Davis & Duff 1996) on the graph of rocks: each rock that is eliminated becomes an
//! element, the clique of those that are left of its neighbours. What is joined to it then is its column of the factor.
//! Integers only: the order is the same on every machine.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Order of elimination and pattern of the factor; rows and columns count places in the order.
#[derive(Debug, Default)]
pub(super) struct Ordering {
    /// Place of each rock.
    pub(super) place: Vec<usize>,
    /// Where the rows of each column begin, and the end of the last.
    pub(super) starts: Vec<usize>,
    /// Rows below the diagonal, column by column, ascending.
    pub(super) rows: Vec<usize>,
}

/// What is left of the graph: rocks and elements, each by the number of its rock.
struct Graph {
    /// Rocks that a rock is joined to otherwise than by an element.
    joined: Vec<Vec<usize>>,
    /// Elements that a rock belongs to.
    elements: Vec<Vec<usize>>,
    /// Rocks of an element when it was made.
    cliques: Vec<Vec<usize>>,
    is_eliminated: Vec<bool>,
    /// Upper bound of the rocks that each is joined to.
    degree: Vec<usize>,
    /// Rocks of each element that are not in the newest one, where `counted` says that this was reckoned.
    outside: Vec<usize>,
    counted: Vec<usize>,
    /// Where each rock was last found to be in the newest element.
    marked: Vec<usize>,
}

impl Ordering {
    /// Orders `rocks` rocks of which these pairs are joined.
    pub(super) fn of(rocks: usize, pairs: &[(usize, usize)]) -> Self {
        let mut graph = Graph::new(rocks, pairs);
        let mut queue: BinaryHeap<Reverse<(usize, usize)>> =
            (0..rocks).map(|k| Reverse((graph.degree[k], k))).collect();
        let mut order = Vec::with_capacity(rocks);
        while let Some(Reverse((degree, k))) = queue.pop() {
            // entries of the queue grow old where a degree has changed since
            if graph.is_eliminated[k] || graph.degree[k] != degree {
                continue;
            }
            order.push(k);
            for one in graph.eliminate(k, order.len()) {
                queue.push(Reverse((graph.degree[one], one)));
            }
        }
        Self::from(&order, &graph.cliques)
    }

    fn from(order: &[usize], columns: &[Vec<usize>]) -> Self {
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, &k)| place[k] = at);
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for &k in order {
            let begin = rows.len();
            rows.extend(columns[k].iter().map(|&one| place[one]));
            rows[begin..].sort_unstable();
            starts.push(rows.len());
        }
        Self { place, starts, rows }
    }
}

impl Graph {
    fn new(rocks: usize, pairs: &[(usize, usize)]) -> Self {
        let mut joined = vec![Vec::new(); rocks];
        for &(a, b) in pairs {
            joined[a].push(b);
            joined[b].push(a);
        }
        for list in &mut joined {
            list.sort_unstable();
            list.dedup();
        }
        Self {
            degree: joined.iter().map(Vec::len).collect(),
            joined,
            elements: vec![Vec::new(); rocks],
            cliques: vec![Vec::new(); rocks],
            is_eliminated: vec![false; rocks],
            outside: vec![0; rocks],
            counted: vec![0; rocks],
            marked: vec![0; rocks],
        }
    }

    /// Makes an element of a rock, the `step`-th that is eliminated; returns the rocks whose degrees have changed.
    fn eliminate(&mut self, k: usize, step: usize) -> Vec<usize> {
        self.is_eliminated[k] = true;
        self.marked[k] = step;
        let mut clique = Vec::new();
        let absorbed = std::mem::take(&mut self.elements[k]);
        let own = std::mem::take(&mut self.joined[k]);
        let of_elements = absorbed.iter().flat_map(|&element| &self.cliques[element]);
        for &one in of_elements.chain(&own) {
            if self.marked[one] != step && !self.is_eliminated[one] {
                self.marked[one] = step;
                clique.push(one);
            }
        }
        let gone = |element: &usize| absorbed.contains(element);
        for &one in &clique {
            self.elements[one].retain(|element| !gone(element));
            for &element in &self.elements[one] {
                if self.counted[element] != step {
                    self.counted[element] = step;
                    self.outside[element] = self.live(element);
                }
                self.outside[element] -= 1;
            }
        }
        for &one in &clique {
            self.renew(one, (k, step), clique.len());
        }
        self.cliques[k].clone_from(&clique);
        clique
    }

    /// Rocks of an element that are left.
    fn live(&self, element: usize) -> usize {
        self.cliques[element].iter().filter(|&&one| !self.is_eliminated[one]).count()
    }

    /// The lists and the degree of a rock of the newest element.
    fn renew(&mut self, one: usize, (k, step): (usize, usize), clique: usize) {
        let Self { joined, elements, marked, outside, degree, .. } = self;
        joined[one].retain(|&other| marked[other] != step);
        // an element that lies within the newest says nothing more
        elements[one].retain(|&element| outside[element] > 0);
        let others: usize = elements[one].iter().map(|&element| outside[element]).sum();
        degree[one] = joined[one].len() + others + clique - 1;
        elements[one].push(k);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of the factor of a graph in a given order, by elimination as it is defined.
    fn by_definition(
        rocks: usize,
        pairs: &[(usize, usize)],
        place: &[usize],
    ) -> Vec<(usize, usize)> {
        let mut joined = vec![vec![false; rocks]; rocks];
        for &(a, b) in pairs {
            let (a, b) = (place[a], place[b]);
            (joined[a][b], joined[b][a]) = (true, true);
        }
        let mut found = Vec::new();
        for k in 0..rocks {
            let rows: Vec<usize> = (k + 1..rocks).filter(|&row| joined[k][row]).collect();
            found.extend(rows.iter().map(|&row| (k, row)));
            for &a in &rows {
                rows.iter().for_each(|&b| joined[a][b] = true);
            }
        }
        found
    }

    fn pattern(ordering: &Ordering) -> Vec<(usize, usize)> {
        let column = |k: usize| {
            let rows = &ordering.rows[ordering.starts[k]..ordering.starts[k + 1]];
            rows.iter().map(move |&row| (k, row))
        };
        (0..ordering.place.len()).flat_map(column).collect()
    }

    /// A grid of rocks with some diagonals.
    fn grid(side: usize) -> Vec<(usize, usize)> {
        let at = |i: usize, j: usize| side * i + j;
        let mut pairs = Vec::new();
        for i in 0..side {
            for j in 0..side {
                if i + 1 < side {
                    pairs.push((at(i + 1, j), at(i, j)));
                }
                if j + 1 < side {
                    pairs.push((at(i, j + 1), at(i, j)));
                }
                if (i * 7 + j * 3) % 4 == 0 && i + 1 < side && j + 1 < side {
                    pairs.push((at(i + 1, j + 1), at(i, j)));
                }
            }
        }
        pairs
    }

    #[test]
    fn the_pattern_is_that_of_elimination() {
        let star: Vec<(usize, usize)> = (1..9).map(|k| (k, 0)).collect();
        for (rocks, pairs) in [(9, star), (64, grid(8)), (3, Vec::new())] {
            let ordering = Ordering::of(rocks, &pairs);
            let mut places = ordering.place.clone();
            places.sort_unstable();
            assert!(places.iter().copied().eq(0..rocks), "{places:?}");
            assert_eq!(pattern(&ordering), by_definition(rocks, &pairs, &ordering.place));
        }
    }

    /// A star has no fill when its middle comes late; of a grid, minimum degree leaves a good part of the band's fill out.
    #[test]
    fn the_order_keeps_the_fill_small() {
        let star: Vec<(usize, usize)> = (1..9).map(|k| (k, 0)).collect();
        assert_eq!(Ordering::of(9, &star).rows.len(), 8);
        let (side, pairs) = (24, grid(24));
        let found = Ordering::of(side * side, &pairs).rows.len();
        let straight: Vec<usize> = (0..side * side).collect();
        let band = by_definition(side * side, &pairs, &straight).len();
        assert!(3 * found < 2 * band, "{found} of {band}");
    }
}

//! The edges of a triangle mesh and the triangles that share them.
//!
//! Side `3 t + k` is the side of triangle `t` from its corner `k` to its corner `(k + 1) % 3`. An edge has the number of the
//! first of its sides, and every side knows the next one on its edge: four bytes a side tell all.

use crate::parallel;

/// The two ends of a side, the lower number first.
#[inline]
pub fn ends(triangles: &[[u32; 3]], side: u32) -> [u32; 2] {
    let (corners, k) = (triangles[side as usize / 3], side as usize % 3);
    let [a, b] = [corners[k], corners[if k == 2 { 0 } else { k + 1 }]];
    [a.min(b), a.max(b)]
}

/// Who shares the edges of a mesh.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Edges {
    /// Of each side the next one on its edge; of the last one the first.
    next: Vec<[u32; 3]>,
    count: usize,
}

impl Edges {
    /// Lists the edges of `triangles` (vertex indices, all three different).
    pub fn of(triangles: &[[u32; 3]]) -> Self {
        let (starts, mut sides) = sides_by_lower_vertex(triangles);
        let bucket_of = |vertex: usize| starts[vertex] as usize..starts[vertex + 1] as usize;
        // a vertex has about three edges to later ones; only the fans of a thousand are worth sorting
        for vertex in 0..starts.len() - 1 {
            if bucket_of(vertex).len() > LONG {
                sides[bucket_of(vertex)].sort_unstable();
            }
        }
        let next = |side: u32| {
            let [lower, upper] = ends(triangles, side);
            let bucket = &sides[bucket_of(lower as usize)];
            let is_long = bucket.len() > LONG;
            let from = if is_long { bucket.partition_point(|one| one.0 < upper) } else { 0 };
            let sides = bucket[from..].iter().take_while(|one| !is_long || one.0 == upper);
            let mut on_edge = sides.filter(|one| one.0 == upper).map(|one| one.1);
            let first = on_edge.next().unwrap_or(side);
            on_edge.find(|&other| other > side).unwrap_or(first)
        };
        let next = parallel::map(triangles.len(), |t| [0, 1, 2].map(|k| next(3 * t as u32 + k)));
        let mut edges = Self { next, count: 0 };
        edges.count = parallel::count(edges.sides(), |side| edges.is_edge(side));
        edges
    }

    /// The same edges when triangle `k` is the one that was `order[k]`: what [`Edges::of`] would list, without sorting
    /// again.
    #[must_use]
    pub fn reordered(self, order: &[u32]) -> Self {
        let mut place = vec![0u32; order.len()];
        for (now, &before) in (0..).zip(order) {
            place[before as usize] = now;
        }
        let now = |side: u32| 3 * place[side as usize / 3] + side % 3;
        let next = |side: u32| {
            let next = self.next(side);
            if next == side || self.next(next) == side {
                return now(next);
            }
            // three or more: what comes after it in the new order
            let all = || self.sides_on(side).map(now);
            let later = all().filter(|&other| other > now(side)).min();
            later.or_else(|| all().min()).unwrap_or(now(side))
        };
        let next = parallel::map(order.len(), |now| [0, 1, 2].map(|k| next(3 * order[now] + k)));
        Self { next, count: self.count }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Memory that they take (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val::<[[u32; 3]]>(&self.next)
    }

    /// Whether there is no edge.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    #[inline]
    fn next(&self, side: u32) -> u32 {
        self.next[side as usize / 3][side as usize % 3]
    }

    /// All sides on the edge of a side, from that one on.
    #[inline]
    pub fn sides_on(&self, side: u32) -> impl Iterator<Item = u32> + '_ {
        let next = move |&last: &u32| Some(self.next(last)).filter(|&next| next != side);
        std::iter::successors(Some(side), next)
    }

    /// The edge of a side: the first side on it.
    #[inline]
    pub fn edge_of(&self, side: u32) -> u32 {
        self.sides_on(side).min().unwrap_or(side)
    }

    /// Whether a side is the first one on its edge, whose number the edge has.
    #[inline]
    pub fn is_edge(&self, side: u32) -> bool {
        let next = self.next(side);
        // of a ring that ascends, the last one points back
        next >= side && (self.next(next) == side || self.edge_of(side) == side)
    }

    /// All edges by their numbers, ascending.
    pub fn all(&self) -> impl Iterator<Item = u32> + '_ {
        (0..3 * self.next.len() as u32).filter(|&side| self.is_edge(side))
    }

    /// What `of` gives for the edges, where it gives something, on all threads.
    pub(super) fn filter_map<T: Clone + Send>(
        &self,
        of: impl Fn(u32) -> Option<T> + Sync,
    ) -> Vec<T> {
        parallel::filter_map(self.sides(), |side| {
            Some(side as u32).filter(|&side| self.is_edge(side)).and_then(&of)
        })
    }

    /// Sides of all triangles: three each.
    fn sides(&self) -> usize {
        3 * self.next.len()
    }

    /// The triangles on an edge, ascending: one at a border, two inside a sheet, more where sheets meet.
    #[inline]
    pub fn triangles_on(&self, edge: u32) -> impl Iterator<Item = u32> + '_ {
        self.sides_on(edge).map(|side| side / 3)
    }

    /// The two triangles on an edge inside a sheet.
    #[inline]
    pub fn pair_on(&self, edge: u32) -> Option<[u32; 2]> {
        self.sides_of_pair(edge).map(|sides| sides.map(|side| side / 3))
    }

    /// The two sides on an edge inside a sheet.
    #[inline]
    pub(super) fn sides_of_pair(&self, edge: u32) -> Option<[u32; 2]> {
        let next = self.next(edge);
        (next != edge && self.next(next) == edge).then_some([edge, next])
    }

    /// How many triangles lie on the edge of a side.
    #[inline]
    pub fn count_on(&self, side: u32) -> usize {
        self.sides_on(side).count()
    }

    /// Whether the edge of a side has one triangle only.
    #[inline]
    pub fn is_border(&self, side: u32) -> bool {
        self.next(side) == side
    }

    /// The edges with one triangle only.
    pub fn borders(&self) -> Vec<u32> {
        parallel::filter(self.sides(), |side| self.is_border(side))
    }
}

/// More sides than this in the bucket of a vertex are sorted.
const LONG: usize = 32;

/// Where the bucket of each vertex begins, and the sides of all triangles by lower vertex, ascending, each with its upper
/// vertex.
fn sides_by_lower_vertex(triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<(u32, u32)>) {
    let lower = |[a, b, c]: &[u32; 3]| [*a.min(b), *b.min(c), *c.min(a)];
    let above =
        |found: u32, triangle: usize| triangles[triangle].iter().fold(found, |a, &b| a.max(b + 1));
    let vertices = parallel::fold(triangles.len(), &0, above, u32::max) as usize;
    let (starts, sides) = grouped(triangles.iter().map(lower), triangles.len(), vertices);
    let with_upper = |side: u32| (ends(triangles, side)[1], side);
    let sides = parallel::map(sides.len(), |place| with_upper(sides[place]));
    (starts, sides)
}

/// Where the places of each vertex begin, and the places in a list of 3 `triangles` vertices by vertex, ascending.
pub(super) fn grouped<'a>(
    list: impl Iterator<Item = [u32; 3]> + Clone + 'a,
    triangles: usize,
    vertices: usize,
) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; vertices + 2];
    // counted two places on: while places are given out, each start moves to where the next one is
    list.clone().flatten().for_each(|vertex| starts[vertex as usize + 2] += 1);
    for vertex in 2..starts.len() {
        starts[vertex] += starts[vertex - 1];
    }
    let mut places = vec![0u32; 3 * triangles];
    for (place, vertex) in (0..).zip(list.flatten()) {
        let free = &mut starts[vertex as usize + 1];
        places[*free as usize] = place;
        *free += 1;
    }
    starts.pop();
    (starts, places)
}

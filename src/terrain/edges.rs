//! The edges of a triangle mesh and the triangles that share them.

use rayon::iter::{IntoParallelRefIterator, IntoParallelRefMutIterator, ParallelIterator};

/// Every edge of a mesh once, with the triangles on it.
///
/// Edge `k` of a triangle runs from its vertex `k` to its vertex `(k + 1) % 3`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Edges {
    /// The two vertices of each edge, the lower index first; sorted.
    pub ends: Vec<[u32; 2]>,
    /// The three edges of each triangle.
    pub of_triangle: Vec<[u32; 3]>,
    /// `triangles[starts[e]..starts[e + 1]]` lie on edge `e`.
    starts: Vec<u32>,
    /// Triangles by edge, ascending within an edge.
    triangles: Vec<u32>,
}

/// A side of a triangle in the bucket of its lower vertex: the upper vertex, and its place `3 t + k`.
type Side = (u32, u32);

impl Edges {
    /// Lists the edges of `triangles` (vertex indices, all three different).
    pub fn of(triangles: &[[u32; 3]]) -> Self {
        let (buckets, sides) = sides_by_lower_vertex(triangles);
        let mut edges = Self { of_triangle: vec![[0; 3]; triangles.len()], ..Self::default() };
        edges.triangles.reserve_exact(sides.len());
        for (lower, bucket) in (0..).zip(buckets.windows(2)) {
            let mut last = None;
            for &(upper, side) in &sides[bucket[0] as usize..bucket[1] as usize] {
                if last != Some(upper) {
                    edges.starts.push(edges.triangles.len() as u32);
                    edges.ends.push([lower, upper]);
                    last = Some(upper);
                }
                let (triangle, k) = (side / 3, side as usize % 3);
                edges.of_triangle[triangle as usize][k] = edges.ends.len() as u32 - 1;
                edges.triangles.push(triangle);
            }
        }
        edges.starts.push(edges.triangles.len() as u32);
        // lists that grew have room to spare: a tenth of all that a terrain takes
        edges.ends.shrink_to_fit();
        edges.starts.shrink_to_fit();
        edges
    }

    /// The same edges when triangle `k` is the one that was `order[k]`: what [`Edges::of`] would list, without sorting
    /// again.
    #[must_use]
    pub fn reordered(mut self, order: &[u32]) -> Self {
        let mut place = vec![0u32; order.len()];
        for (now, &before) in (0..).zip(order) {
            place[before as usize] = now;
        }
        self.triangles.par_iter_mut().for_each(|triangle| *triangle = place[*triangle as usize]);
        drop(place);
        for on_edge in self.starts.windows(2) {
            self.triangles[on_edge[0] as usize..on_edge[1] as usize].sort_unstable();
        }
        self.of_triangle =
            order.par_iter().map(|&before| self.of_triangle[before as usize]).collect();
        self
    }

    /// Number of edges.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Memory that they take (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val::<[[u32; 2]]>(&self.ends)
            + size_of_val::<[[u32; 3]]>(&self.of_triangle)
            + size_of_val::<[u32]>(&self.starts)
            + size_of_val::<[u32]>(&self.triangles)
    }

    /// Whether there is no edge.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The triangles on an edge, ascending: one at a border, two inside a sheet, more where sheets meet.
    pub fn triangles_on(&self, edge: u32) -> &[u32] {
        let edge = edge as usize;
        &self.triangles[self.starts[edge] as usize..self.starts[edge + 1] as usize]
    }

    /// How many triangles lie on an edge.
    pub fn count_on(&self, edge: u32) -> i32 {
        i32::try_from(self.triangles_on(edge).len()).unwrap_or(i32::MAX)
    }

    /// The edges with one triangle only.
    pub fn borders(&self) -> Vec<u32> {
        (0..self.len() as u32).filter(|&edge| self.triangles_on(edge).len() == 1).collect()
    }
}

/// The sides of all triangles sorted by lower vertex, upper vertex and place, and where the bucket of each vertex begins.
fn sides_by_lower_vertex(triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<Side>) {
    let ends = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b)));
    let vertices = triangles.iter().flatten().max().map_or(0, |&highest| highest as usize + 1);
    let mut starts = vec![0u32; vertices + 1];
    for (lower, _) in triangles.iter().copied().flat_map(ends) {
        starts[lower as usize + 1] += 1;
    }
    for vertex in 0..vertices {
        starts[vertex + 1] += starts[vertex];
    }
    let mut free = starts.clone();
    let mut sides: Vec<Side> = vec![(0, 0); 3 * triangles.len()];
    for (side, (lower, upper)) in (0..).zip(triangles.iter().copied().flat_map(ends)) {
        let place = &mut free[lower as usize];
        sides[*place as usize] = (upper, side);
        *place += 1;
    }
    // buckets are short: a vertex has about three edges to later ones
    for bucket in starts.windows(2) {
        sides[bucket[0] as usize..bucket[1] as usize].sort_unstable();
    }
    (starts, sides)
}

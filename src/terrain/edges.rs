//! The edges of a triangle mesh and the triangles that share them.

use rayon::slice::ParallelSliceMut;

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

impl Edges {
    /// Lists the edges of `triangles` (vertex indices, all three different).
    pub fn of(triangles: &[[u32; 3]]) -> Self {
        // One row per side of a triangle: its ends (packed, lower first) and its place 3 t + k.
        let mut sides: Vec<(u64, u32)> = Vec::with_capacity(3 * triangles.len());
        for (t, corners) in triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let ends = u64::from(a.min(b)) << 32 | u64::from(a.max(b));
                sides.push((ends, (3 * t + k) as u32));
            }
        }
        sides.par_sort_unstable(); // no two rows are equal: one order only, on any number of threads
        Self::gather(&sides, triangles.len())
    }

    /// Numbers the runs of equal ends.
    fn gather(sides: &[(u64, u32)], triangles: usize) -> Self {
        let mut edges = Self { of_triangle: vec![[0; 3]; triangles], ..Self::default() };
        edges.triangles.reserve_exact(sides.len());
        let mut last = None;
        for &(ends, side) in sides {
            if last != Some(ends) {
                edges.starts.push(edges.triangles.len() as u32);
                edges.ends.push([(ends >> 32) as u32, ends as u32]);
                last = Some(ends);
            }
            let (triangle, k) = (side / 3, side as usize % 3);
            edges.of_triangle[triangle as usize][k] = edges.ends.len() as u32 - 1;
            edges.triangles.push(triangle);
        }
        edges.starts.push(edges.triangles.len() as u32);
        edges
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

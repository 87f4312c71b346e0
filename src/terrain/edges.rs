//! The edges of a triangle mesh and the triangles that share them.

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
        todo!()
    }

    /// Number of edges.
    pub fn len(&self) -> usize {
        self.ends.len()
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
}

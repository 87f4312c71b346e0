//! Places where a border vertex lies on the inside of a border edge: neighbours that touch without sharing an edge.

use crate::rock::Vec3;
use crate::terrain::weld::Welded;

/// Reach relative to the length of the edge (–), for meshes welded with tolerance zero: rounding of the foot.
const REACH_OF_EDGE: f64 = 1e-12;

/// A border vertex on the inside of a border edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TJunction {
    /// The vertex.
    pub vertex: u32,
    /// The edge it lies on, without being one of its ends.
    pub edge: u32,
}

/// All T-junctions within the weld tolerance, sorted by vertex and edge.
pub fn t_junctions(welded: &Welded) -> Vec<TJunction> {
    let mut border = welded.edges.borders();
    border.sort_by_key(|&edge| welded.ends(edge));
    let cells = Cells::of(welded, &border);
    let mut found = Vec::new();
    for &edge in &border {
        cells.visit_near(edge, |vertex| {
            if lies_inside(welded, vertex, edge) {
                found.push(TJunction { vertex, edge });
            }
        });
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// Whether the vertex is no end of the edge and within the tolerance of its inside, farther than that from its ends along it:
/// both pieces are shorter than the edge then.
fn lies_inside(welded: &Welded, vertex: u32, edge: u32) -> bool {
    let ends = welded.ends(edge);
    if ends.contains(&vertex) {
        return false;
    }
    let (along, share) = (welded.edge_m(edge), share_along(welded, ends, vertex));
    let to = welded.vertices_m[vertex as usize] - welded.vertices_m[ends[0] as usize];
    let reach_m = welded.tolerance_m.max(REACH_OF_EDGE * along.norm());
    let least = reach_m / along.norm();
    share > least && share < 1.0 - least && (to - share * along).norm() <= reach_m
}

/// Where the foot of a vertex lies between two others (–): 0 at the first, 1 at the second.
pub(super) fn share_along(welded: &Welded, ends: [u32; 2], vertex: u32) -> f64 {
    let [a, b, to] = [ends[0], ends[1], vertex].map(|v| welded.vertices_m[v as usize]);
    (to - a).dot(&(b - a)) / (b - a).norm_squared()
}

/// Border vertices sorted into cells about as large as a border edge, so that every edge passes few of them.
struct Cells<'a> {
    welded: &'a Welded,
    cell_m: f64,
    /// Cell and vertex, sorted.
    vertices: Vec<([i64; 3], u32)>,
}

impl<'a> Cells<'a> {
    fn of(welded: &'a Welded, border: &[u32]) -> Self {
        let length_m: f64 = border.iter().map(|&edge| welded.edge_m(edge).norm()).sum();
        let cell_m = (length_m / border.len().max(1) as f64).max(2.0 * welded.tolerance_m);
        let mut cells = Self { welded, cell_m, vertices: Vec::new() };
        let mut ends: Vec<u32> = border.iter().flat_map(|&edge| welded.ends(edge)).collect();
        ends.sort_unstable();
        ends.dedup();
        cells.vertices =
            ends.into_iter().map(|v| (cells.cell(welded.vertices_m[v as usize]), v)).collect();
        cells.vertices.sort_unstable();
        cells
    }

    fn cell(&self, point_m: Vec3) -> [i64; 3] {
        (point_m / self.cell_m).map(|x| x.floor() as i64).into()
    }

    /// Calls `seen` with every border vertex near the edge, some more than once.
    fn visit_near(&self, edge: u32, mut seen: impl FnMut(u32)) {
        let start_m = self.welded.vertices_m[self.welded.ends(edge)[0] as usize];
        let along_m = self.welded.edge_m(edge);
        // Pieces no longer than a cell: a long slanting edge passes cells in a line, not the whole box around it.
        let pieces = (along_m.norm() / self.cell_m).ceil().max(1.0);
        let margin = Vec3::repeat(self.welded.tolerance_m + 1e-9 * self.cell_m);
        for piece in 0..pieces as u64 {
            let from = start_m + along_m * (piece as f64 / pieces);
            let to = start_m + along_m * ((piece + 1) as f64 / pieces);
            let low = self.cell(from.inf(&to) - margin);
            let high = self.cell(from.sup(&to) + margin);
            for (x, y) in (low[0]..=high[0]).flat_map(|x| (low[1]..=high[1]).map(move |y| (x, y))) {
                self.column([x, y, low[2]], high[2]).iter().for_each(|&(_, vertex)| seen(vertex));
            }
        }
    }

    /// Vertices of the cells from `low` up to height `top`.
    fn column(&self, low: [i64; 3], top: i64) -> &[([i64; 3], u32)] {
        let start = self.vertices.partition_point(|&(cell, _)| cell < low);
        let count =
            self.vertices[start..].partition_point(|&(cell, _)| cell <= [low[0], low[1], top]);
        &self.vertices[start..start + count]
    }
}

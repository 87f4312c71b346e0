//! Triangles are split at border vertices that lie on their border edges, so that sheets which touch there share edges.
//!
//! What a ball presses into is counted by faces, edges and vertices, which is an energy only where two triangles that touch
//! share an edge, a vertex or nothing. Sheets that meet along a line on which one has corners that the other has not share
//! vertices there but no edges: rocks gained and lost up to a third of their energy, in a plain surface as in a fold.

use super::t_junctions::{TJunction, share_along, t_junctions};
use super::{Tally, Welded, has_area};
use crate::rock::Vec3;
use std::collections::BTreeSet;

/// What was done at T-junctions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Splits {
    /// Border vertices on the inside of a border edge, each once.
    pub junctions: Tally,
    /// Facets that were split there.
    pub facets: usize,
    /// What they were split into.
    pub pieces: usize,
    /// Vertices on the inside of a border edge of a triangle too thin to be split.
    pub left: Tally,
}

impl Welded {
    /// Splits triangles until no border vertex lies on the inside of a border edge. Pieces keep the sheet and the facet of the
    /// whole.
    ///
    /// The triangle on an edge gives way by up to the weld tolerance. So a piece may have a border on which a vertex lies that
    /// was beside the whole: it is split anew. Each piece of an edge is shorter than the edge, so this ends.
    pub(super) fn split_at_t_junctions(&mut self) {
        let (mut vertices, mut facets, mut more) = (BTreeSet::new(), BTreeSet::new(), 0);
        let left = loop {
            let found = t_junctions(self);
            vertices.extend(found.iter().map(|junction| junction.vertex));
            let before = self.triangles.len();
            for (t, on_sides) in by_triangle(self, &found) {
                if self.split(t, on_sides) {
                    facets.insert((self.sheet_of[t as usize], self.facet_of[t as usize]));
                }
            }
            if self.triangles.len() == before {
                break found.into_iter().map(|junction| junction.vertex).collect();
            }
            more += self.triangles.len() - before;
            self.list_edges();
        };
        self.splits = Splits {
            junctions: self.tally(&vertices),
            facets: facets.len(),
            pieces: facets.len() + more,
            left: self.tally(&left),
        };
    }

    fn tally(&self, vertices: &BTreeSet<u32>) -> Tally {
        let mut tally = Tally::default();
        for &vertex in vertices {
            tally.add(self.on_map(self.vertices_m[vertex as usize]));
        }
        tally
    }

    /// Splits a triangle at vertices on its sides, in the order in which they lie there; says whether any piece came of it.
    /// The first piece takes its place, the others stand behind all triangles.
    fn split(&mut self, t: u32, on_sides: [Vec<u32>; 3]) -> bool {
        let first = self.triangles.len();
        let whole = self.triangles[t as usize];
        let up = normal(&self.corners_m(t as usize));
        for (k, on_side) in on_sides.into_iter().enumerate() {
            let (mut from, to) = (whole[k], whole[(k + 1) % 3]);
            let mut piece = self.with_side(t, first, [from, to]);
            for vertex in on_side {
                let apex = self.triangles[piece].into_iter().find(|v| ![from, to].contains(v));
                let Some(apex) = apex else { continue };
                let halves = [[from, vertex, apex], [vertex, to, apex]];
                if !halves.iter().all(|half| self.faces(half, &up)) {
                    continue;
                }
                self.triangles[piece] = halves[0];
                piece = self.triangles.len();
                self.triangles.push(halves[1]);
                from = vertex;
            }
        }
        let count = self.triangles.len();
        self.sheet_of.resize(count, self.sheet_of[t as usize]);
        self.facet_of.resize(count, self.facet_of[t as usize]);
        count > first
    }

    /// The piece of a triangle, itself or from `first` on, that has a whole side of it.
    fn with_side(&self, t: u32, first: usize, ends: [u32; 2]) -> usize {
        let has = |&piece: &usize| ends.iter().all(|end| self.triangles[piece].contains(end));
        (first..self.triangles.len()).find(has).unwrap_or(t as usize)
    }

    /// Whether a piece has an area, on the same side as the whole.
    fn faces(&self, piece: &[u32; 3], up: &Vec3) -> bool {
        let corners = piece.map(|v| self.vertices_m[v as usize]);
        has_area(&corners) && normal(&corners).dot(up) > 0.0
    }
}

fn normal([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (b - a).cross(&(c - a))
}

/// T-junctions by triangle, those of each of its sides in the direction in which it runs.
fn by_triangle(welded: &Welded, found: &[TJunction]) -> Vec<(u32, [Vec<u32>; 3])> {
    let share = |junction: &TJunction| {
        let (corners, k) =
            (welded.triangles[junction.edge as usize / 3], junction.edge as usize % 3);
        share_along(welded, [corners[k], corners[(k + 1) % 3]], junction.vertex)
    };
    let mut sorted: Vec<(u32, f64, u32)> =
        found.iter().map(|junction| (junction.edge, share(junction), junction.vertex)).collect();
    sorted.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    let of_triangle = |group: &[(u32, f64, u32)]| {
        let on = |k: u32| group.iter().filter(move |one| one.0 % 3 == k).map(|one| one.2).collect();
        (group[0].0 / 3, [0, 1, 2].map(on))
    };
    sorted.chunk_by(|a, b| a.0 / 3 == b.0 / 3).map(of_triangle).collect()
}

#[cfg(test)]
mod tests;

//! The same terrain with fewer, larger triangles: to see what the mesh itself does to an answer.
//!
//! Some vertices are chosen, about evenly over the surface; every other vertex moves to the chosen one that is nearest
//! along the mesh, and triangles that lose a corner by that go. No vertex is invented, so the surface keeps its roughness
//! at the lengths that are left, and what is not connected stays apart, however close. Stems are shapes, not surveys: they
//! stay as they are.

use super::Terrain;
use super::edges::{Edges, ends};
use super::weld::Welded;
use crate::rock::Vec3;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Distance along the mesh between chosen vertices over the edge length wanted (–): the distance from vertex to vertex along
/// edges is on average this much longer than the straight one, and neighbours are chosen a little further apart than they
/// must be.
const APART: f64 = 0.9;
/// A triangle with an area below this share of its longest edge squared (–) is a line.
const NO_AREA: f64 = 1e-10;

/// The terrain with edges of the slope about `times` (–, 1 or more) as long. Deterministic.
#[must_use]
pub fn coarser(terrain: &Terrain, times: f64) -> Terrain {
    let apart_m = APART * times * slope_edge_m(terrain);
    let moved_to = chosen(terrain, apart_m);
    let mut coarse = empty(terrain);
    let mut seen = BTreeSet::new();
    for (t, corners) in terrain.triangles.iter().enumerate() {
        let corners = corners.map(|v| moved_to[v as usize]);
        let mut key = corners;
        key.sort_unstable();
        if has_area(terrain, corners) && seen.insert(key) {
            coarse.triangles.push(corners);
            coarse.sheet_of.push(terrain.sheet_of[t]);
            coarse.facet_of.push(terrain.facet_of[t]);
        }
    }
    keep_used_vertices(&mut coarse, &terrain.vertices_m);
    coarse.edges = Edges::of(&coarse.triangles);
    Terrain::new(coarse, terrain.sheets.clone())
}

/// Mean length of the slope's edges (m).
pub fn slope_edge_m(terrain: &Terrain) -> f64 {
    let slope = (0..terrain.triangles.len() as u32).filter(|&t| !terrain.is_tree(t));
    let (mut sum, mut sides) = (0.0, 0.0);
    for t in slope {
        let [a, b, c] = terrain.corners_m(t);
        sum += (b - a).norm() + (c - b).norm() + (a - c).norm();
        sides += 3.0;
    }
    if sides > 0.0 { sum / sides } else { 0.0 }
}

fn empty(terrain: &Terrain) -> Welded {
    Welded { origin_m: terrain.origin_m, map_origin_m: terrain.origin_m, ..Welded::default() }
}

/// Where each vertex goes: to the chosen one nearest along the mesh.
fn chosen(terrain: &Terrain, apart_m: f64) -> Vec<u32> {
    let count = terrain.vertices_m.len();
    let mut nearest: Vec<(f64, u32)> = vec![(f64::INFINITY, 0); count];
    let trees = is_on_tree(terrain);
    for vertex in in_turn(terrain, &trees) {
        if nearest[vertex as usize].0 >= apart_m || trees[vertex as usize] {
            spread(terrain, vertex, &mut nearest);
        }
    }
    nearest.into_iter().map(|(_, to)| to).collect()
}

/// Vertices in the order in which they are asked: trees first, then corners and borders, so that these stay, then the rest.
fn in_turn(terrain: &Terrain, trees: &[bool]) -> Vec<u32> {
    let edges = &terrain.features.edges;
    let mut rank = vec![3u8; terrain.vertices_m.len()];
    for edge in edges.borders() {
        for v in ends(&terrain.triangles, edge) {
            rank[v as usize] = 2;
        }
    }
    for (v, rank) in rank.iter_mut().enumerate().filter(|(_, rank)| **rank == 2) {
        // a corner of a sheet has no more than two neighbours along the border and one across
        *rank -= u8::from(terrain.neighbours(v as u32).count() <= 3);
    }
    let mut turn: Vec<u32> = (0..rank.len() as u32).collect();
    turn.sort_by_key(|&v| (!trees[v as usize], rank[v as usize], v));
    turn
}

/// Which vertices belong to trees.
fn is_on_tree(terrain: &Terrain) -> Vec<bool> {
    let mut trees = vec![false; terrain.vertices_m.len()];
    for (t, corners) in terrain.triangles.iter().enumerate() {
        if terrain.is_tree(t as u32) {
            for &v in corners {
                trees[v as usize] = true;
            }
        }
    }
    trees
}

/// Gives `from` every vertex to which it is nearer along the mesh than all chosen before it (Dijkstra 1959).
fn spread(terrain: &Terrain, from: u32, nearest: &mut [(f64, u32)]) {
    let at = |v: u32| terrain.vertices_m[v as usize];
    nearest[from as usize] = (0.0, from);
    let mut front = BinaryHeap::from([(Reverse(Metres(0.0)), from)]);
    while let Some((Reverse(Metres(way)), v)) = front.pop() {
        if nearest[v as usize] != (way, from) {
            continue;
        }
        for next in terrain.neighbours(v) {
            let way = way + (at(next) - at(v)).norm();
            if way < nearest[next as usize].0 {
                nearest[next as usize] = (way, from);
                front.push((Reverse(Metres(way)), next));
            }
        }
    }
}

/// A length that is a number, so that it can be ordered.
#[derive(Clone, Copy, PartialEq)]
struct Metres(f64);

impl Eq for Metres {}

impl Ord for Metres {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Metres {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

fn has_area(terrain: &Terrain, corners: [u32; 3]) -> bool {
    let [a, b, c]: [Vec3; 3] = corners.map(|v| terrain.vertices_m[v as usize]);
    let longest2 = (b - a).norm_squared().max((c - a).norm_squared()).max((c - b).norm_squared());
    (b - a).cross(&(c - a)).norm() > NO_AREA * longest2
}

/// Numbers the vertices anew in the order in which triangles use them.
fn keep_used_vertices(coarse: &mut Welded, all_m: &[Vec3]) {
    let mut number = vec![u32::MAX; all_m.len()];
    for corner in coarse.triangles.iter_mut().flatten() {
        let known = &mut number[*corner as usize];
        if *known == u32::MAX {
            *known = coarse.vertices_m.len() as u32;
            coarse.vertices_m.push(all_m[*corner as usize]);
        }
        *corner = *known;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::stl::{Facet, Soup};
    use crate::terrain::weld::{Piece, Up, weld};
    use crate::terrain::{Sheet, make};
    use std::path::Path;

    fn terrain(slope: Vec<Facet>, trees: Vec<Facet>) -> Terrain {
        let soups = [slope, trees].map(Soup::from);
        let piece = |sheet: usize| Piece {
            file: Path::new("made"),
            soup: &soups[sheet],
            up: Up::Z,
            scale: 1.0,
            sheet: sheet as u16,
        };
        let pieces: Vec<Piece> =
            (0..2).filter(|&k| !soups[k].facets.is_empty()).map(piece).collect();
        let welded = weld(&pieces, Vec3::zeros(), None).unwrap();
        let sheet = |is_tree| Sheet { path: "made".into(), ground: 0, is_tree };
        Terrain::new(welded, vec![sheet(false), sheet(true)])
    }

    /// Area in the map plane (m²).
    fn plan_area_m2(terrain: &Terrain) -> f64 {
        let area = |t: u32| {
            let [a, b, c] = terrain.corners_m(t);
            0.5 * (b - a).cross(&(c - a)).z.abs()
        };
        (0..terrain.triangles.len() as u32).map(area).sum()
    }

    /// A natural slope: edges as much longer as asked (a fifth: vertices cannot be chosen evenly), as many fewer triangles,
    /// the whole area still covered, once, without holes, on vertices that it had.
    #[test]
    fn a_coarser_slope_covers_the_same_ground() {
        let fine = terrain(make::natural_slope(61, 82).facets, Vec::new());
        let rim = |terrain: &Terrain| terrain.features.edges.borders().len() as f64;
        for times in [2.0, 4.0] {
            let coarse = coarser(&fine, times);
            let longer = slope_edge_m(&coarse) / slope_edge_m(&fine);
            assert!((longer / times - 1.0).abs() < 0.2, "{longer} for {times}");
            let fewer = fine.triangles.len() as f64 / coarse.triangles.len() as f64;
            assert!((fewer / (times * times) - 1.0).abs() < 0.4, "{fewer} for {times}²");
            // edges cut across the last row of triangles at most; folds would cover ground twice
            let area = plan_area_m2(&coarse) / plan_area_m2(&fine);
            assert!((area - 1.0).abs() < 0.02, "{area}");
            assert!(
                (rim(&fine) / rim(&coarse) / times - 1.0).abs() < 0.5,
                "holes: {}",
                rim(&coarse)
            );
            let is_old = |v: &Vec3| fine.vertices_m.contains(v);
            assert!(coarse.vertices_m.iter().all(is_old));
            assert_eq!(coarse.triangles, coarser(&fine, times).triangles);
        }
    }

    /// Two sheets 1 cm apart stay two sheets; stems keep every triangle.
    #[test]
    fn what_is_not_connected_stays_apart() {
        let lower = make::jittered_plane(10.0, 20, 0.0);
        let upper = lower.iter().map(|facet| facet.map(|p| p + Vec3::z() * 0.01));
        let both: Vec<Facet> = lower.iter().copied().chain(upper).collect();
        let stem = make::tetrahedron(1.0);
        let fine = terrain(both, stem.clone());
        let coarse = coarser(&fine, 3.0);
        let stems = |terrain: &Terrain| {
            (0..terrain.triangles.len() as u32).filter(|&t| terrain.is_tree(t)).count()
        };
        assert_eq!((stems(&fine), stems(&coarse)), (stem.len(), stem.len()));
        let one = coarser(&terrain(lower, Vec::new()), 3.0);
        assert_eq!(coarse.triangles.len() - stem.len(), 2 * one.triangles.len());
    }
}

//! Terrain too fine for a page, drawn coarser.

use super::part::{TerrainPart, TriangleSoup};
use crate::report::format;
use crate::rock::Vec3;
use rayon::slice::ParallelSliceMut;
use std::collections::BTreeSet;

/// How much longer the cells become when there are still too many triangles (–).
const LONGER: f64 = 1.2;

/// Ground of at most so many triangles: vertices that share a cell become one, in their middle.
pub(super) fn ground(part: &TerrainPart, most: usize, notes: &mut Vec<String>) -> TriangleSoup {
    let all = part.len();
    if all <= most {
        return part.soup();
    }
    let mut cell_m = mean_edge_m(part) * (all as f64 / most as f64).sqrt();
    loop {
        let (thinned, moved_m) = joined(part, cell_m);
        if thinned.triangles.len() <= most {
            notes.push(format!(
                "Ground drawn with {} of {} triangles; no point of it moved by more than {} m. The rocks fell on all.",
                format::decimal(thinned.triangles.len() as f64, 0),
                format::decimal(all as f64, 0),
                format::significant(moved_m, 2)
            ));
            return thinned;
        }
        cell_m *= LONGER;
    }
}

fn mean_edge_m(part: &TerrainPart) -> f64 {
    let length = |a: [f64; 3], b: [f64; 3]| (Vec3::from(b) - Vec3::from(a)).norm();
    let sides = part.triangles().map(|[a, b, _]| length(part.place_m(a), part.place_m(b)));
    (sides.sum::<f64>() / part.len() as f64).max(1e-9)
}

/// The part with one vertex a cell, and the longest way that one moved (m).
fn joined(part: &TerrainPart, cell_m: f64) -> (TriangleSoup, f64) {
    let at = |v: u32| part.place_m(v);
    let cell = |v: u32| at(v).map(|x| (x / cell_m).floor() as i64);
    let mut order: Vec<u32> = (0..part.vertices() as u32).collect();
    order.par_sort_unstable_by_key(|&v| (cell(v), v));
    let mut number = vec![0; part.vertices()];
    let (mut places_m, mut moved_m): (Vec<[f64; 3]>, f64) = (Vec::new(), 0.0);
    for group in order.chunk_by(|&a, &b| cell(a) == cell(b)) {
        let middle: [f64; 3] = std::array::from_fn(|axis| {
            group.iter().map(|&v| at(v)[axis]).sum::<f64>() / group.len() as f64
        });
        for &v in group {
            let way: f64 = (0..3).map(|axis| (at(v)[axis] - middle[axis]).powi(2)).sum();
            moved_m = moved_m.max(way.sqrt());
            number[v as usize] = places_m.len() as u32;
        }
        places_m.push(middle);
    }
    let mut seen = BTreeSet::new();
    let left = |corners: [u32; 3]| {
        let corners = corners.map(|v| number[v as usize]);
        let mut key = corners;
        key.sort_unstable();
        (key[0] < key[1] && key[1] < key[2] && seen.insert(key)).then_some(corners)
    };
    let triangles = part.triangles().filter_map(left).collect();
    (TriangleSoup { places_m, triangles }, moved_m)
}

/// Whole trees, evenly chosen, of at most so many triangles.
pub(super) fn trees(soup: TriangleSoup, most: usize, notes: &mut Vec<String>) -> TriangleSoup {
    let all = soup.triangles.len();
    if all <= most {
        return soup;
    }
    let tree_of = trees_of(&soup);
    let every = all.div_ceil(most) as u32;
    let kept = |corners: &&[u32; 3]| tree_of[corners[0] as usize].is_multiple_of(every);
    let triangles: Vec<[u32; 3]> = soup.triangles.iter().filter(kept).take(most).copied().collect();
    notes.push(format!("Of the trees one in {every} is drawn. The rocks fell among all."));
    TriangleSoup { triangles, ..soup }
}

/// Number of the connected piece that each vertex belongs to, from 0 in order of the vertices.
fn trees_of(soup: &TriangleSoup) -> Vec<u32> {
    let mut root: Vec<u32> = (0..soup.places_m.len() as u32).collect();
    let find = |root: &mut Vec<u32>, mut v: u32| {
        while root[v as usize] != v {
            root[v as usize] = root[root[v as usize] as usize];
            v = root[v as usize];
        }
        v
    };
    for [a, b, c] in &soup.triangles {
        for other in [b, c] {
            let (one, two) = (find(&mut root, *a), find(&mut root, *other));
            root[one.max(two) as usize] = one.min(two);
        }
    }
    let mut count = 0;
    let mut number = vec![0; root.len()];
    for v in 0..root.len() as u32 {
        let first = find(&mut root, v);
        if first == v {
            number[v as usize] = count;
            count += 1;
        } else {
            number[v as usize] = number[first as usize];
        }
    }
    number
}

//! Terrain too fine for a page, drawn coarser.

use super::part::{TerrainPart, TriangleSoup};
use crate::parallel;
use crate::report::format;
use crate::rock::Vec3;
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
    let cells = ThinningCells::over(part, cell_m);
    // half the memory where the numbers are small: ten million vertices are sorted
    if cells.count() <= u128::from(u32::MAX) {
        return joined_by(part, cells.sorted(part, |number| number as u64));
    }
    joined_by(part, cells.sorted(part, |number| number))
}

/// Cubes over a part, numbered by x, then y, then z.
struct ThinningCells {
    cell_m: f64,
    first: [i64; 3],
    sizes: [u128; 3],
}

impl ThinningCells {
    fn over(part: &TerrainPart, cell_m: f64) -> Self {
        let nothing = ([i64::MAX; 3], [i64::MIN; 3]);
        let both = |one: ([i64; 3], [i64; 3]), other: ([i64; 3], [i64; 3])| {
            let each = |k: usize| (one.0[k].min(other.0[k]), one.1[k].max(other.1[k]));
            let [x, y, z] = [each(0), each(1), each(2)];
            ([x.0, y.0, z.0], [x.1, y.1, z.1])
        };
        let add = |all, v: usize| {
            let at = cell(part.place_m(v as u32), cell_m);
            both(all, (at, at))
        };
        let (first, last) = parallel::fold(part.vertices(), &nothing, add, both);
        let size = |k: usize| u128::from(last[k].abs_diff(first[k])) + 1;
        Self { cell_m, first, sizes: [size(0), size(1), size(2)] }
    }

    fn count(&self) -> u128 {
        self.sizes.iter().fold(1, |all: u128, &size| all.saturating_mul(size))
    }

    /// The number of each vertex's cell, over its own 32 bits; ascending.
    fn sorted<K: Clone + Default + Ord + Send>(
        &self,
        part: &TerrainPart,
        word: impl Fn(u128) -> K + Sync,
    ) -> Vec<K> {
        let number = |v: u32| {
            let at = cell(part.place_m(v), self.cell_m);
            let [x, y, z] = [0, 1, 2].map(|k| u128::from(at[k].abs_diff(self.first[k])));
            ((x * self.sizes[1] + y) * self.sizes[2] + z) << VERTEX_BITS | u128::from(v)
        };
        let mut words: Vec<K> = parallel::map(part.vertices(), |v| word(number(v as u32)));
        words.sort_unstable();
        words
    }
}

/// Bits of the number of a vertex.
const VERTEX_BITS: u32 = 32;

fn cell(place_m: [f64; 3], cell_m: f64) -> [i64; 3] {
    place_m.map(|x| (x / cell_m).floor() as i64)
}

fn joined_by<K: Copy + Into<u128>>(part: &TerrainPart, order: Vec<K>) -> (TriangleSoup, f64) {
    let at = |v: u32| part.place_m(v);
    let cell = |word: &K| Into::<u128>::into(*word) >> VERTEX_BITS;
    let vertex = |word: &K| Into::<u128>::into(*word) as u32;
    let mut number = vec![0; part.vertices()];
    let (mut places_m, mut moved_m): (Vec<[f64; 3]>, f64) = (Vec::new(), 0.0);
    for group in order.chunk_by(|a, b| cell(a) == cell(b)) {
        let middle: [f64; 3] = std::array::from_fn(|axis| {
            group.iter().map(|word| at(vertex(word))[axis]).sum::<f64>() / group.len() as f64
        });
        for v in group.iter().map(vertex) {
            let way: f64 = (0..3).map(|axis| (at(v)[axis] - middle[axis]).powi(2)).sum();
            moved_m = moved_m.max(way.sqrt());
            number[v as usize] = places_m.len() as u32;
        }
        places_m.push(middle);
    }
    drop(order);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::stl::Soup;
    use crate::terrain::weld::{Piece, Up, weld};
    use crate::terrain::{Sheet, Terrain, make};
    use std::collections::BTreeMap;
    use std::path::Path;

    /// Vertices of one cube become one in their middle, numbered by x, y and z of the cubes, whatever the words are as long
    /// as.
    #[test]
    fn a_cube_has_one_vertex() {
        let soup = Soup::from(make::natural_slope(40, 30).facets);
        let made = Path::new("made");
        let piece = Piece { file: made, soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
        let sheet = Sheet { path: made.into(), ground: 0, is_tree: false };
        let terrain = Terrain::new(weld(&[piece], Vec3::zeros(), None).unwrap(), vec![sheet]);
        let part = TerrainPart::of(&terrain, false);
        let cell_m = 3.0 * mean_edge_m(&part);
        let mut cubes: BTreeMap<[i64; 3], Vec<[f64; 3]>> = BTreeMap::new();
        for v in 0..part.vertices() as u32 {
            cubes.entry(cell(part.place_m(v), cell_m)).or_default().push(part.place_m(v));
        }
        let (found, moved_m) = joined(&part, cell_m);
        assert!(found.places_m.len() == cubes.len() && cubes.len() * 3 < part.vertices());
        for (place_m, own) in found.places_m.iter().zip(cubes.values()) {
            for axis in 0..3 {
                let middle = own.iter().map(|at| at[axis]).sum::<f64>() / own.len() as f64;
                assert!((place_m[axis] - middle).abs() < 1e-9);
            }
        }
        assert!(moved_m > 0.0 && moved_m < 3f64.sqrt() * cell_m);
        let cells = ThinningCells::over(&part, cell_m);
        let (long, _) = joined_by(&part, cells.sorted(&part, |number| number));
        assert!(long.places_m == found.places_m && long.triangles == found.triangles);
    }
}

//! A valley side fine enough for the rocks that fall down it: every kind of ground, a wood, and room to come to rest.

use super::noise::{fade, gradient, hash};
use super::slopes::{Slope, blend, drape, ramp};
use super::stems::{Stem, stem};
use crate::terrain::stl::Facet;

/// Across and down (m).
const SIZE_M: [f64; 2] = [160.0, 264.0];
/// Edge of a cell (m): about twice the diameter of the rocks.
const CELL_M: f64 = 2.0;
/// Where the face, the talus and the meadow begin (m down).
const FACE_M: f64 = 20.0;
const TALUS_M: f64 = 50.0;
const MEADOW_M: f64 = 150.0;
/// Lower edge of the wood (m down), its columns and rows of trees.
const WOOD_M: f64 = 112.0;
const WOOD: [u64; 2] = [16, 4];

/// A valley side to look at: 160 m wide, 264 m long; a bench, a 53° rock face from y = 20 m to 50 m, a 34° talus with two
/// gullies to y = 150 m, a meadow of 6°. 21 120 triangles.
pub fn valley_slope() -> Slope {
    drape(SIZE_M, SIZE_M.map(|size_m| (size_m / CELL_M) as usize), height_m)
}

fn height_m(x_m: f64, y_m: f64) -> f64 {
    // edge of the face and foot of the talus wander
    let down_m = y_m + 9.0 * gradient(51, 40.0, x_m, 0.0) + 2.5 * gradient(52, 14.0, x_m, y_m);
    let even = 132.0 - 0.15 * y_m - 1.2 * ramp(down_m - FACE_M, 2.0)
        + 0.67 * ramp(down_m - TALUS_M, 6.0)
        + 0.58 * ramp(down_m - MEADOW_M, 14.0);
    let face = blend((down_m - FACE_M + 4.0) / 8.0) * (1.0 - blend((down_m - TALUS_M) / 8.0));
    let talus = 1.0 - blend((down_m - MEADOW_M + 12.0) / 24.0);
    let rough = 3.0 * gradient(53, 26.0, x_m, y_m)
        + 1.3 * gradient(54, 12.0, x_m, y_m)
        + 0.5 * gradient(55, 6.0, x_m, y_m);
    let gully = |middle_m: f64, wide_m: f64| {
        let across = (x_m - middle_m - 8.0 * gradient(56, 50.0, y_m, middle_m)) / wide_m;
        1.0 / (1.0 + across * across)
    };
    let gullies = 3.0 * gully(52.0, 9.0) + 2.2 * gully(104.0, 12.0);
    let flow = blend((down_m - FACE_M) / 20.0) * talus;
    even - gullies * flow + rough * (0.05 + 0.3 * talus + 0.5 * face)
}

/// A belt of wood on the lower talus of [`valley_slope`]: stems on a shaken lattice, 0.25 m to 0.65 m thick, with a lane
/// without trees where the larger gully comes down.
pub(super) fn valley_trees(slope: &Slope) -> Vec<Facet> {
    let places = (0..WOOD[1]).flat_map(|row| (0..WOOD[0]).map(move |column| (column, row)));
    let tree = |(column, row): (u64, u64)| {
        let shaken = |seed: u64| 3.2 * hash(seed, column, row);
        let x_m = 6.0 + 10.0 * column as f64 + 5.0 * (row % 2) as f64 + shaken(61);
        let y_m = WOOD_M + 9.0 * row as f64 + shaken(62);
        let size = fade(0.5 + 0.5 * hash(63, column, row));
        (x_m < SIZE_M[0] - 3.0 && (x_m - 52.0).abs() > 9.0).then_some(Stem {
            x_m,
            y_m,
            dbh_m: 0.25 + 0.4 * size,
            height_m: 9.0 + 14.0 * size,
        })
    };
    let stems = places.filter_map(tree);
    stems.flat_map(|one| stem(&one, (slope.height_m)(one.x_m, one.y_m))).collect()
}

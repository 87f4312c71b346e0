//! Tree stems as prisms.

use crate::rock::Vec3;
use crate::terrain::stl::Facet;
use std::f64::consts::FRAC_1_SQRT_2;

/// How deep a stem stands in the ground (m): its foot stays hidden on steep ground.
pub(super) const FOOT_M: f64 = 0.5;

/// One tree of a list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stem {
    /// Position of the axis, east (m).
    pub x_m: f64,
    /// Position of the axis, north (m).
    pub y_m: f64,
    /// Diameter at breast height (m), positive; the same over the whole height.
    pub dbh_m: f64,
    /// Height above ground (m), positive.
    pub height_m: f64,
}

/// An eight-sided closed stem; the corners lie on the circle of the diameter. `ground_m` is the height of the ground at
/// the axis (m).
pub fn stem(tree: &Stem, ground_m: f64) -> Vec<Facet> {
    prism(tree, [ground_m - FOOT_M, ground_m + tree.height_m], &ring())
}

/// Corners of an eight-sided stem, anticlockwise, in half diameters from its axis.
pub(super) fn ring() -> [[f64; 2]; 8] {
    let h = FRAC_1_SQRT_2;
    [[1.0, 0.0], [h, h], [0.0, 1.0], [-h, h], [-1.0, 0.0], [-h, -h], [0.0, -1.0], [h, -h]]
}

/// A four-sided closed stem whose sides are `dbh_m` wide and face the axes.
pub fn square_stem(tree: &Stem, ground_m: f64) -> Vec<Facet> {
    let heights_m = [ground_m - FOOT_M, ground_m + tree.height_m];
    prism(tree, heights_m, &[[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
}

/// A closed prism from the lower to the upper height (m) over the ring of corners, facing outwards.
pub(super) fn prism(tree: &Stem, [low_m, high_m]: [f64; 2], ring: &[[f64; 2]]) -> Vec<Facet> {
    let half_m = 0.5 * tree.dbh_m;
    let at = |k: usize, z_m: f64| {
        let [x, y] = ring[k % ring.len()];
        Vec3::new(tree.x_m + half_m * x, tree.y_m + half_m * y, z_m)
    };
    let mut facets = Vec::with_capacity(4 * ring.len() - 4);
    for k in 0..ring.len() {
        facets.push([at(k, low_m), at(k + 1, low_m), at(k + 1, high_m)]);
        facets.push([at(k, low_m), at(k + 1, high_m), at(k, high_m)]);
    }
    for k in 1..ring.len() - 1 {
        facets.push([at(0, high_m), at(k, high_m), at(k + 1, high_m)]);
        facets.push([at(0, low_m), at(k + 1, low_m), at(k, low_m)]);
    }
    facets
}

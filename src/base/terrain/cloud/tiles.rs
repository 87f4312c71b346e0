//! Tiles of one point cloud: those that touch are thinned and joined as one, so that no gap stays between them.
//!
//! The cells that thin a cloud lie on one lattice for all files. So the lowest point of each cell of all tiles together is
//! the one that a single file of all points would keep, and the surface is that of the single file.

use super::Cloud;
use crate::rock::Vec3;
use crate::terrain::grid::BoxM;
use std::collections::BTreeMap;

/// Tiles farther apart than this (in cells) are clouds of their own.
const APART_CELLS: f64 = 10.0;

impl Cloud {
    /// West, south, east and north of its points, a margin around it (m).
    fn around(&self, margin_m: f64) -> BoxM {
        let nothing = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        let [west, south, east, north] =
            self.points_m.iter().fold(nothing, |[west, south, east, north], p| {
                [west.min(p.x), south.min(p.y), east.max(p.x), north.max(p.y)]
            });
        [west - margin_m, south - margin_m, east + margin_m, north + margin_m]
    }

    pub(in crate::terrain) fn touches(&self, other: &Self) -> bool {
        let [a, b] = [self, other].map(|cloud| cloud.around(0.5 * APART_CELLS * cloud.cell_m));
        a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
    }

    /// Takes the points of another tile: the lowest of each cell stays, the first of equally low ones.
    pub(in crate::terrain) fn add(&mut self, tile: &Self) {
        let cell = |point: &Vec3| [point.x, point.y].map(|m| (m / self.cell_m).floor() as i64);
        let mut lowest: BTreeMap<[i64; 2], Vec3> = BTreeMap::new();
        for &point in self.points_m.iter().chain(&tile.points_m) {
            let kept = lowest.entry(cell(&point)).or_insert(point);
            if point.z < kept.z {
                *kept = point;
            }
        }
        self.points_m = lowest.into_values().collect();
        self.counts = [0, 1].map(|k| self.counts[k] + tile.counts[k]);
        self.tiles += tile.tiles;
        self.epsg = self.epsg.or(tile.epsg);
    }
}

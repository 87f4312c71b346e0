//! Tiles of one point cloud: those that touch are thinned and joined as one, so that no gap stays between them.
//!
//! The cells that thin a cloud lie on one lattice for all files. So the lowest point of each cell of all tiles together is
//! the one that a single file of all points would keep, and the surface is that of the single file.

use super::{BoxM, Cloud};
use crate::error::{Error, Result};
use crate::rock::Vec3;
use crate::terrain::formats::Loaded;
use crate::terrain::groups::Groups;
use crate::terrain::read::Source;
use std::collections::BTreeMap;

/// Tiles farther apart than this (in cells) are clouds of their own.
const APART_CELLS: f64 = 10.0;

/// Joins the clouds that touch into the first of them.
///
/// # Errors
/// Tiles that touch with different grounds or options.
pub(in crate::terrain) fn join(all: &mut [Loaded], sources: &[Source]) -> Result<()> {
    let mut groups = Groups::of(all.len());
    for one in 0..all.len() {
        for other in one + 1..all.len() {
            if let (Loaded::Cloud(own), Loaded::Cloud(beside)) = (&all[one], &all[other])
                && own.touches(beside)
            {
                alike(&sources[one], &sources[other])?;
                groups.join(one as u32, other as u32);
            }
        }
    }
    for tile in 1..all.len() {
        let first = groups.lowest(tile as u32) as usize;
        if first == tile {
            continue;
        }
        let (before, from) = all.split_at_mut(tile);
        if let (Loaded::Cloud(whole), Loaded::Cloud(tile)) = (&mut before[first], &from[0]) {
            whole.add(tile);
            from[0] = Loaded::Joined(sources[first].sheet.path.clone(), tile.epsg);
        }
    }
    Ok(())
}

/// Refuses tiles that touch and are not meant alike.
fn alike(one: &Source, other: &Source) -> Result<()> {
    let what = if one.sheet.ground != other.sheet.ground {
        "ground"
    } else if one.options != other.options {
        "resample_m, classes or crop"
    } else {
        return Ok(());
    };
    let found =
        format!("found another {what} than of {}, which it touches", one.sheet.path.display());
    let remedy = "write the same for all tiles of a cloud; other grounds draw as [[ground_zones]]";
    Err(Error::input(&other.sheet.path, what, found, remedy))
}

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

    fn touches(&self, other: &Self) -> bool {
        let [a, b] = [self, other].map(|cloud| cloud.around(0.5 * APART_CELLS * cloud.cell_m));
        a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
    }

    /// Takes the points of another tile: the lowest of each cell stays, the first of equally low ones.
    fn add(&mut self, tile: &Self) {
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

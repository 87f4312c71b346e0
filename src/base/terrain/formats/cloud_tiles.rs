//! Tiles of point clouds among the files of a terrain.

use super::Loaded;
use crate::error::{Error, Result};
use crate::groups::Groups;
use crate::terrain::options::MeshSource;

/// Joins the clouds that touch into the first of them.
///
/// # Errors
/// Tiles that touch with different grounds or options.
pub(super) fn join(all: &mut [Loaded], sources: &[MeshSource]) -> Result<()> {
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
fn alike(one: &MeshSource, other: &MeshSource) -> Result<()> {
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

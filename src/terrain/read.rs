//! From mesh files to the terrain: read, weld, examine, index.

use super::health::Health;
use super::stl::{self, Soup};
use super::weld::{Piece, Up, weld};
use super::{Sheet, Terrain};
use crate::error::Result;
use crate::rock::Vec3;

/// One mesh file and how it enters the terrain.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The file, its ground, and whether it is a tree.
    pub sheet: Sheet,
    /// Its up axis.
    pub up: Up,
    /// Metres per unit of the file, positive.
    pub scale: f64,
}

impl Terrain {
    /// Reads and welds mesh files; says what was found in them.
    ///
    /// `map_origin_m` is the map position of the files' (0, 0, 0), `tolerance_m` the weld tolerance
    /// (`None` = chosen from the size of the mesh).
    ///
    /// # Errors
    /// A file that cannot be read or is no STL, no triangle with an area, coordinates too large for a
    /// binary file.
    pub fn read(
        sources: &[Source],
        map_origin_m: Vec3,
        tolerance_m: Option<f64>,
    ) -> Result<(Self, Health)> {
        let soups = sources.iter().map(|source| stl::read(&source.sheet.path));
        let soups: Vec<Soup> = soups.collect::<Result<_>>()?;
        let pieces: Vec<Piece> = (0..)
            .zip(sources.iter().zip(&soups))
            .map(|(sheet, (source, soup))| Piece {
                file: &source.sheet.path,
                soup,
                up: source.up,
                scale: source.scale,
                sheet,
            })
            .collect();
        let welded = weld(&pieces, map_origin_m, tolerance_m)?;
        let health = Health::of(&welded, &pieces);
        health.check()?;
        let sheets = sources.iter().map(|source| source.sheet.clone()).collect();
        Ok((Self::new(welded, sheets), health))
    }
}

//! Grounds by polygon: zones of a map laid on the triangles of the slope.
//!
//! A triangle has the ground of the zone in which its centroid lies, the last one drawn where several overlap. Triangles
//! that a border crosses are cut along it on request; how much area would lie on the wrong side without is counted either
//! way.

mod borders;
mod cut;
mod drawing;
mod triangulate;
#[cfg(test)]
mod tests;

use super::facets::Facet;
use super::stl::Soup;
use crate::error::{Error, Result};
pub use crate::gis::Corner;
use crate::math;
use crate::rock::Vec3;
use borders::Borders;
use cut::cut;

/// One zone.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Its outlines and those of its holes, in map coordinates (m): inside is what an odd number of them encloses.
    pub rings_m: Vec<Vec<Corner>>,
    /// Index of its ground in the scene's list of grounds.
    pub ground: u16,
}

/// All zones of a scene, the last one on top.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Patches {
    /// The zones.
    pub list: Vec<Patch>,
    /// Whether triangles are cut along the borders.
    pub cut: bool,
}

impl Patches {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}

/// What zones have done to the triangles of the slope. Areas in plan view.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Patched {
    /// Number of zones.
    pub zones: usize,
    /// Area with another ground than its file's (m²).
    pub laid_m2: f64,
    /// Triangles that a border crosses.
    pub crossed: usize,
    /// What they are, or would be, cut into.
    pub pieces: usize,
    /// Area on the other side of a border than the centroid of its triangle (m²): it changes hands by cutting.
    pub other_side_m2: f64,
    /// Whether they were cut.
    pub is_cut: bool,
}

/// Lays zones on one file after the other.
#[derive(Debug)]
pub(super) struct ZonePainter {
    borders: Borders,
    /// What has been done so far.
    pub(super) done: Patched,
}

impl ZonePainter {
    pub(super) fn new(patches: &Patches) -> Self {
        let done = Patched { zones: patches.list.len(), is_cut: patches.cut, ..Patched::default() };
        Self { borders: Borders::of(&patches.list), done }
    }

    /// The ground of every facet of a soup whose own is `base`; cuts facets first if that was asked for. `placed` turns a
    /// point of the file into one of the map.
    ///
    /// # Errors
    /// A triangle crossed by so many corners of borders that cutting it would take for ever.
    pub(super) fn lay(
        &mut self,
        soup: &mut Soup,
        base: u16,
        placed: &dyn Fn(Vec3) -> Vec3,
    ) -> Result<Vec<u16>> {
        let mut grounds = Vec::with_capacity(soup.facets.len());
        // numbers of facets change when some are cut
        let (mut off, mut normals_off) = (soup.normals_off.iter().peekable(), Vec::new());
        let facets = std::mem::take(&mut soup.facets).cut(|number, facet| {
            let first = grounds.len() as u32;
            let corners = facet.map(|corner| plan(placed(corner)));
            let whole = self.borders.ground_at(middle(corners)).unwrap_or(base);
            let mut pieces = cut(facet, corners, &self.borders).map_err(too_many)?;
            self.count(&pieces, (whole, base), placed);
            if !self.done.is_cut {
                pieces.clear();
            }
            let mut lay = |corners: [Corner; 3], ground: u16| {
                if ground != base {
                    self.done.laid_m2 += area_m2(corners);
                }
                grounds.push(ground);
            };
            if pieces.is_empty() {
                lay(corners, whole);
            }
            for piece in &pieces {
                let corners = piece.map(|corner| plan(placed(corner)));
                lay(corners, self.borders.ground_at(middle(corners)).unwrap_or(base));
            }
            if off.next_if(|&&facet| facet as usize == number).is_some() {
                normals_off.extend(first..grounds.len() as u32);
            }
            Ok::<_, Error>(pieces)
        })?;
        (soup.facets, soup.normals_off) = (facets, normals_off);
        Ok(grounds)
    }

    fn count(
        &mut self,
        pieces: &[Facet],
        (whole, base): (u16, u16),
        placed: &dyn Fn(Vec3) -> Vec3,
    ) {
        if pieces.is_empty() {
            return;
        }
        self.done.crossed += 1;
        self.done.pieces += pieces.len();
        for piece in pieces {
            let corners = piece.map(|corner| plan(placed(corner)));
            if self.borders.ground_at(middle(corners)).unwrap_or(base) != whole {
                self.done.other_side_m2 += area_m2(corners);
            }
        }
    }
}

fn too_many(corners: usize) -> Error {
    Error::Request(format!(
        "ground_zones: {corners} corners of borders in one triangle of the slope; simplify the zones, or write cut = false"
    ))
}

fn plan(point: Vec3) -> Corner {
    [point.x, point.y]
}

fn middle([a, b, c]: [Corner; 3]) -> Corner {
    [0, 1].map(|axis| a[axis] + ((b[axis] - a[axis]) + (c[axis] - a[axis])) / 3.0)
}

/// Area of a triangle (m²).
fn area_m2([a, b, c]: [Corner; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs()
}

/// How near a point lies to a line that it is taken to lie on it (m): drawings are snapped to corners and edges of a grid in
/// decimal digits, which come back a little beside them. Ten times the rounding of map coordinates, far below any survey.
const SNAP_M: f64 = 1e-7;

/// On which side of the line from `a` to `b` a point lies: positive on the left, exact in sign (Shewchuk 1997), 0 within
/// [`SNAP_M`] of it. Twice the area of the triangle (m²).
fn side(a: Corner, b: Corner, p: Corner) -> f64 {
    let area = exact_side(a, b, p);
    if area.abs() <= SNAP_M * math::hypot(b[0] - a[0], b[1] - a[1]) { 0.0 } else { area }
}

/// The same without a margin.
fn exact_side(a: Corner, b: Corner, p: Corner) -> f64 {
    let coord = |[x, y]: Corner| robust::Coord { x, y };
    robust::orient2d(coord(a), coord(b), coord(p))
}

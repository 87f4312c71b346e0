//! One triangle cut along the borders that cross it.
//!
//! Two triangles with a common edge cut it at the same points, bit for bit: a point on an edge follows from the edge and the
//! border alone. So no gap and no T-junction opens.

use super::borders::Borders;
use super::drawing::{BorderedTriangle, MOST_NODES};
use super::triangulate::triangulate;
use super::{Corner, area_m2, side};
use crate::terrain::stl::Facet;

/// Pieces must cover their triangle to this share of its area (–), or it stays whole.
const COVERED: f64 = 1e-4;

/// The pieces of a facet, wound like it; none where no border crosses it. `corners` are its corners on the map.
///
/// # Errors
/// More nodes than can be handled: their number.
pub(super) fn cut(
    facet: &Facet,
    corners: [Corner; 3],
    borders: &Borders,
) -> Result<Vec<Facet>, usize> {
    let near = borders.near(corners);
    if near.is_empty() {
        return Ok(Vec::new());
    }
    let turn = side(corners[0], corners[1], corners[2]);
    // A vertical triangle has no inside on the map.
    if turn.abs() <= 0.0 {
        return Ok(Vec::new());
    }
    let order = if turn > 0.0 { [0, 1, 2] } else { [0, 2, 1] };
    let mut drawing = BorderedTriangle::of(order.map(|k| (corners[k], facet[k])));
    for border in near {
        drawing.draw(border);
        if drawing.nodes.len() > MOST_NODES {
            return Err(drawing.nodes.len());
        }
    }
    if drawing.nodes.len() == 3 && drawing.lines.is_empty() {
        return Ok(Vec::new());
    }
    drawing.cross();
    if drawing.nodes.len() > MOST_NODES {
        return Err(drawing.nodes.len());
    }
    let triangles = triangulate(&drawing);
    let covered: f64 = triangles.iter().map(|t| area_m2(t.map(|k| drawing.nodes[k].at))).sum();
    let whole = area_m2(corners);
    if (covered - whole).abs() > COVERED * whole {
        return Ok(Vec::new());
    }
    let wound = |[a, b, c]: [usize; 3]| if turn > 0.0 { [a, b, c] } else { [a, c, b] };
    Ok(triangles.into_iter().map(|t| wound(t).map(|k| drawing.nodes[k].point)).collect())
}

//! Triangles that lose their area where corners that are near become one.
//!
//! A few are no harm: the triangles around them close over the place. Where the tolerance is as long as the edges, the slope goes with them.

use super::{Piece, has_area};
use crate::error::{Error, Result};
use crate::math;
use crate::rock::Vec3;

/// Of the triangles of a file no more than one in so many loses its area.
pub(super) const MOST_LOST: usize = 10;
/// Nor do triangles with more than this part of its area (–): needles have none, cells of a grid have all of it.
const MOST_AREA: f64 = 0.01;
/// Of the triangles one in so many may have shorter edges than what is proposed is made for.
const SHORTER: usize = 100;
/// What is proposed over the shortest edge (–): two corners of an edge become one where both are near a third, so below a half.
const OF_EDGE: f64 = 0.45;

/// Refuses a tolerance that the scene has written, if with it the triangles that have `lost` their area, piece by piece, are more than a
/// trace of a file.
///
/// # Errors
/// Names the first such file, what it loses and a tolerance that leaves it whole.
pub(super) fn check(pieces: &[Piece], lost: &[Vec<u32>], tolerance_m: f64) -> Result<()> {
    for (piece, lost) in pieces.iter().zip(lost).filter(|(_, lost)| !lost.is_empty()) {
        let facets = &piece.soup.facets;
        let corners = |number: usize| facets.at(number).map(|corner| piece.placed(corner));
        let area_m2 = |number: usize| double_area_m2(&corners(number)) / 2.0;
        let all_m2: f64 = (0..facets.len()).map(area_m2).sum();
        let share = lost.iter().map(|number| area_m2(*number as usize)).sum::<f64>() / all_m2;
        if share <= MOST_AREA && MOST_LOST * lost.len() <= facets.len() {
            continue;
        }
        let found = format!(
            "found {tolerance_m}, by which {} of {} triangles with {} % of the area are lost, as corners so near become one",
            lost.len(),
            facets.len(),
            math::rounded(100.0 * share, 2),
        );
        let edge_m = short_edge_m(&(0..facets.len()).map(corners).collect::<Vec<_>>());
        let least = math::rounded(OF_EDGE * edge_m, 2);
        let remedy = format!("write {least} or less: the triangles have edges of {} m", {
            math::rounded(edge_m, 2)
        });
        return Err(Error::input(piece.file, "[mesh] weld_tolerance_m", found, remedy));
    }
    Ok(())
}

fn double_area_m2([a, b, c]: &[Vec3; 3]) -> f64 {
    (b - a).cross(&(c - a)).norm()
}

/// The shortest edge (m) of triangles with an area, but for a few with shorter ones.
fn short_edge_m(triangles: &[[Vec3; 3]]) -> f64 {
    let shortest = |[a, b, c]: &[Vec3; 3]| (b - a).norm().min((c - b).norm()).min((a - c).norm());
    let mut edges: Vec<f64> = triangles.iter().filter(|one| has_area(one)).map(shortest).collect();
    edges.sort_by(f64::total_cmp);
    edges.get(edges.len() / SHORTER).copied().unwrap_or_default()
}

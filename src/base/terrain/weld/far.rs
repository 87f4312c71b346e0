//! Files and triangles that lie far from all others: mistakes, and costly ones.
//!
//! Corners are merged within a share of the common box. A file in other coordinates, or one triangle at (0, 0, 0) of a slope in map
//! coordinates, makes that box, and with it the tolerance, so large that the slope itself collapses.

use super::collapsed::MOST_LOST;
use super::{Piece, PieceBox, TOLERANCE_OF_SIZE, longest_m};
use crate::error::{Error, Result};
use crate::math;
use crate::rock::Vec3;

/// The common box is no larger than so many times all files side by side (–).
const APART: f64 = 10.0;
/// Triangles that tell where most of them lie.
const SAMPLES: usize = 1000;

/// Refuses files that lie far from each other.
///
/// # Errors
/// Names the file that lies the farthest from the first one.
pub(super) fn check_apart(pieces: &[Piece], spans: &[PieceBox], size_m: f64) -> Result<()> {
    let side_by_side_m: f64 = spans.iter().map(longest_m).sum();
    let Some((first, others)) = pieces.split_first() else { return Ok(()) };
    if size_m <= APART * side_by_side_m {
        return Ok(());
    }
    let middle = |span: &PieceBox| span.0 / 2.0 + span.1 / 2.0;
    let off_m = |span: &PieceBox| (middle(span) - middle(&spans[0])).norm();
    let farthest = others
        .iter()
        .zip(&spans[1..])
        .filter(|(piece, _)| !piece.soup.facets.is_empty())
        .max_by(|a, b| off_m(a.1).total_cmp(&off_m(b.1)));
    let Some((piece, span)) = farthest else { return Ok(()) };
    let found = format!(
        "it lies {:.0} m from {}, and no file is more than {:.0} m wide",
        off_m(span),
        first.file.display(),
        spans.iter().map(longest_m).fold(0.0, f64::max)
    );
    let remedy = "write the files of a scene in coordinates of one system: elevation models, point clouds and lists are in map \
                  coordinates, and origin_m says where on the map (0, 0, 0) of STL, PLY and OBJ files lies";
    Err(Error::input(piece.file, "coordinates", found, remedy))
}

/// Refuses a mesh if merging within the default tolerance has made flat so many triangles of a piece (`collapsed`, piece by piece)
/// that it is no more what it was: one triangle lies far off, or a scale is wrong.
///
/// # Errors
/// Names the first such file, and the triangle that lies the farthest from most others.
pub(super) fn check_collapsed(
    pieces: &[Piece],
    collapsed: &[Vec<u32>],
    (tolerance_m, size_m): (f64, f64),
) -> Result<()> {
    let of = |piece: &Piece| piece.soup.facets.len();
    let counts = collapsed.iter().map(Vec::len);
    let spoiled = pieces.iter().zip(counts).find(|(piece, lost)| MOST_LOST * lost > of(piece));
    let (Some((piece, lost)), Some((far, number, off_m))) = (spoiled, farthest(pieces)) else {
        return Ok(());
    };
    let found = format!(
        "{lost} of {} triangles have no area once corners within {} m are merged, {TOLERANCE_OF_SIZE:e} of the box of \
         all files, which is {size_m:.0} m long; triangle {} of {} lies {off_m:.0} m from most others",
        of(piece),
        math::rounded(tolerance_m, 2),
        number + 1,
        far.file.display()
    );
    let remedy = "remove that triangle if it is no part of the slope, check scale and coordinates of all files, or write weld_tolerance_m";
    Err(Error::input(piece.file, "mesh", found, remedy))
}

/// The triangle that lies the farthest from most others: its piece, its number, how far (m).
fn farthest<'p>(pieces: &'p [Piece<'p>]) -> Option<(&'p Piece<'p>, usize, f64)> {
    let middle = middle_of_most(pieces);
    let off_m = |piece: &Piece, number: usize| {
        let corners = piece.soup.facets.at(number).map(|corner| piece.placed(corner));
        corners.into_iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max)
    };
    let all = pieces.iter().flat_map(|piece| (0..piece.soup.facets.len()).map(move |k| (piece, k)));
    all.map(|(piece, number)| (piece, number, off_m(piece, number)))
        .reduce(|known, next| if next.2 > known.2 { next } else { known })
}

/// The median place of triangles taken evenly out of all (m).
fn middle_of_most(pieces: &[Piece]) -> Vec3 {
    let count: usize = pieces.iter().map(|piece| piece.soup.facets.len()).sum();
    let every = count.div_ceil(SAMPLES).max(1);
    let taken = |piece: &Piece| {
        let numbers = (0..piece.soup.facets.len()).step_by(every);
        let places = numbers.map(|number| piece.placed(piece.soup.facets.at(number)[0]));
        places.collect::<Vec<Vec3>>()
    };
    let places: Vec<Vec3> = pieces.iter().flat_map(taken).collect();
    Vec3::from_fn(|axis, _| {
        let mut along: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        along.sort_by(f64::total_cmp);
        along.get(along.len() / 2).copied().unwrap_or(0.0)
    })
}

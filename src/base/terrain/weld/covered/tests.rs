use crate::rock::Vec3;
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Joined, Piece, Up, Welded, join, weld};
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Triangle;
use proptest::prelude::*;
use std::path::Path;

/// Sheets of a file each.
fn welded(sheets: &[Vec<Facet>], tolerance_m: f64) -> Welded {
    let soups: Vec<Soup> = sheets.iter().cloned().map(Soup::from).collect();
    let piece =
        |(sheet, soup)| Piece { file: Path::new("t.stl"), soup, up: Up::Z, scale: 1.0, sheet };
    let pieces: Vec<Piece> = (0..).zip(&soups).map(piece).collect();
    weld(&pieces, Vec3::zeros(), Some(tolerance_m)).unwrap()
}

/// A square sheet from x = `from`, 12 m wide, of so many cells each way, with one diagonal or the other.
fn sheet(from: f64, cells: u32, other: bool, z: impl Fn(f64, f64) -> f64) -> Vec<Facet> {
    let at = |i: u32, j: u32| {
        let along = |k: u32| 12.0 * f64::from(k) / f64::from(cells);
        Vec3::new(from + along(i), along(j), z(from + along(i), along(j)))
    };
    let halves = |i: u32, j: u32| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if other { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
    };
    (0..cells).flat_map(|i| (0..cells).flat_map(move |j| halves(i, j))).collect()
}

fn slope(x: f64, y: f64) -> f64 {
    0.3 * x - 0.7 * y
}

/// The same corners with other diagonals, a coarser and a finer sheet, a tilt within the tolerance, each in the same file and in one
/// of its own: what came first stays, whole and alone.
#[test]
fn a_sheet_that_lies_on_another_is_left_out() {
    let first = sheet(0.0, 6, false, slope);
    let tilted = |x: f64, y: f64| slope(x, y) + 1e-6 * (x - 4.0);
    let seconds = [
        sheet(0.0, 6, true, slope),
        sheet(0.0, 3, true, slope),
        sheet(0.0, 12, false, slope),
        sheet(0.0, 5, false, slope),
        sheet(0.0, 6, false, tilted),
        sheet(0.0, 7, true, tilted),
    ];
    for second in seconds {
        let files = welded(&[first.clone(), second.clone()], 1e-5);
        let file = welded(&[[&first[..], &second].concat()], 1e-5);
        for found in [files, file] {
            assert_eq!((found.triangles.len(), found.vertices_m.len()), (72, 49));
            assert_eq!(found.covered.count + found.duplicates.count, second.len());
            assert_eq!(found.facet_of, (0..72).collect::<Vec<u32>>());
        }
    }
}

/// Where tiles overlap only what is covered as a whole goes: of twelve columns of cells five, and half of the next.
#[test]
fn what_is_covered_in_part_stays() {
    let found = welded(&[sheet(0.0, 12, false, slope), sheet(6.5, 12, true, slope)], 1e-5);
    let whole = found.triangles.len() + found.splits.facets - found.splits.pieces;
    assert_eq!((found.covered.count, whole), (5 * 24, 4 * 144 - 5 * 24));
    assert!((found.covered.examples_m[0][0] - 6.5).abs() < 1e-12);
}

/// No stack of sheets, each within the tolerance of the next, collapses onto its first one; sheets farther off stay.
#[test]
fn sheets_beyond_the_tolerance_stay() {
    let at = |z: f64| sheet(0.0, 3, false, move |_, _| z);
    let counts = |heights: &[f64]| {
        let sheets: Vec<_> = heights.iter().map(|&z| at(z)).collect();
        welded(&sheets, 0.01).triangles.len() / 18
    };
    assert_eq!(counts(&[0.0, 0.011]), 2);
    assert_eq!(counts(&[0.0, 0.011, 0.019]), 2);
    assert_eq!(counts(&[0.0, 0.011, 0.019, 0.027]), 3);
}

/// Ridges, narrow fins and needles in a seam are no sheets on each other.
#[test]
fn folds_and_needles_stay() {
    let at = |x: f64, z: f64| [Vec3::new(x, 0.0, z), Vec3::new(x, 5.0, z)];
    let strip = |[a, b]: [Vec3; 2], [c, d]: [Vec3; 2]| [[a, b, d], [a, d, c]];
    let ridge = [strip(at(-1.0, 0.0), at(0.0, 1.0)), strip(at(0.0, 1.0), at(0.02, 0.0))].concat();
    let needle = vec![
        [Vec3::zeros(), Vec3::new(5.0, 0.0, 0.0), Vec3::new(2.5, 0.004, 0.0)],
        [Vec3::zeros(), Vec3::new(5.0, 0.0, 0.0), Vec3::new(2.5, -3.0, 0.0)],
        [Vec3::zeros(), Vec3::new(2.5, 0.004, 0.0), Vec3::new(0.0, 3.0, 0.0)],
    ];
    for facets in [ridge, needle] {
        let count = facets.len();
        assert_eq!(welded(&[facets], 1e-3).triangles.len(), count);
    }
}

fn apart_m(mesh: &Welded, point: &Vec3) -> f64 {
    let to = |t: usize| {
        let [a, b, c] = mesh.corners_m(t).map(Into::into);
        Triangle::new(a, b, c).distance_to_local_point((*point).into(), true)
    };
    (0..mesh.triangles.len()).map(to).fold(f64::INFINITY, f64::min)
}

proptest! {
    /// Whatever is left out, the surface is the same within the tolerance: level triangles at heights of some tolerances.
    #[test]
    fn nothing_else_is_left_out(corners in prop::collection::vec(prop::array::uniform3(0u8..7), 3..90), flat in any::<bool>()) {
        let tolerance_m = 0.02;
        let z = |k: u8| if flat { 0.0 } else { 0.6 * tolerance_m * f64::from(k) };
        let points: Vec<Vec3> = corners.iter().map(|&[x, y, k]| Vec3::new(x.into(), y.into(), z(k / 2))).collect();
        let facets: Vec<Facet> = points.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let soup = Soup::from(facets);
        let piece = Piece { file: Path::new("t.stl"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
        let Ok(Joined(all)) = join(&[piece], Vec3::zeros(), Some(tolerance_m)) else { return Ok(()) };
        let found = Joined(all.clone()).finish();
        for t in 0..all.triangles.len() {
            let [a, b, c] = all.corners_m(t);
            for (s, t) in [(0.1, 0.1), (0.3, 0.3), (0.7, 0.15), (0.15, 0.7), (0.01, 0.5)] {
                // a strip as wide as the tolerance may be left, as may what gives way to a vertex on it
                let apart_m = apart_m(&found, &(a + (b - a) * s + (c - a) * t));
                prop_assert!(apart_m <= 2.0 * tolerance_m, "{apart_m}");
            }
        }
    }
}

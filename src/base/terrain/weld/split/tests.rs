use super::*;
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Piece, Up, weld};
use proptest::prelude::*;
use std::path::Path;

const TOLERANCE_M: f64 = 1e-4;

fn welded(sheets: &[Vec<Facet>]) -> Welded {
    let soups: Vec<Soup> = sheets.iter().map(|facets| Soup::from(facets.clone())).collect();
    let piece =
        |(sheet, soup)| Piece { file: Path::new("t.stl"), soup, up: Up::Z, scale: 1.0, sheet };
    let pieces: Vec<Piece> = (0..).zip(&soups).map(piece).collect();
    weld(&pieces, Vec3::zeros(), Some(TOLERANCE_M)).unwrap()
}

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Area (m²) and area vector (m²) of all triangles of a sheet.
fn areas(welded: &Welded, sheet: u16) -> (f64, Vec3) {
    (0..welded.triangles.len()).filter(|&t| welded.sheet_of[t] == sheet).fold(
        (0.0, Vec3::zeros()),
        |(area, vector), t| {
            let own = normal(&welded.corners_m(t)) / 2.0;
            (area + own.norm(), vector + own)
        },
    )
}

/// A triangle with corners of others on all its sides, and what is said of it.
#[test]
fn a_triangle_is_split_at_every_vertex_on_its_sides() {
    let [a, b, c] = [v(0.0, 0.0, 0.0), v(8.0, 0.0, 0.0), v(0.0, 8.0, 0.0)];
    let off = |from: Vec3, to: Vec3, shares: [f64; 2], out: Vec3| -> Facet {
        let at = |share: f64| from + (to - from) * share;
        [at(shares[1]), at(shares[0]), at(0.5) + out]
    };
    let mut beside = vec![
        off(a, b, [0.0, 0.3], v(0.0, -3.0, 0.0)),
        off(a, b, [0.3, 0.7], v(0.0, -3.0, 0.0)),
        off(b, c, [0.5, 1.0], v(3.0, 3.0, 0.0)),
        off(c, a, [0.25, 0.75], v(-3.0, 0.0, 0.0)),
    ];
    beside.rotate_left(2);
    let welded = welded(&[vec![[a, b, c]], beside]);
    let (area, vector) = areas(&welded, 0);
    assert!((area - 32.0).abs() < 1e-12 && (vector.z - 32.0).abs() < 1e-12, "{area} {vector:?}");
    // five vertices: five pieces more, all of the facet 0 of the sheet 0
    let pieces = (0..welded.triangles.len()).filter(|&t| welded.sheet_of[t] == 0);
    assert!(pieces.clone().all(|t| welded.facet_of[t] == 0));
    assert_eq!((pieces.count(), welded.splits.facets, welded.splits.pieces), (6, 1, 6));
    assert_eq!((welded.splits.junctions.count, welded.splits.left.count), (5, 0));
    // not shared: one piece of each of two sides, two of the third; two sides of four others, of which two share one
    assert_eq!(welded.edges.borders().len(), 4 + 2 * 4 - 2);
}

/// A vertex farther from the edge than the tolerance stays apart, and so does one that is within it of the edge's line
/// beyond its ends.
#[test]
fn what_lies_beside_an_edge_stays_apart() {
    let whole = [v(0.0, 0.0, 0.0), v(8.0, 0.0, 0.0), v(4.0, 6.0, 3.0)];
    let stem = |x: f64, y: f64| [v(x, y, 0.0), v(x + 0.1, y - 0.2, 9.0), v(x - 0.1, y - 0.2, 9.0)];
    for (x, y, is_split) in [
        (3.0, -0.9 * TOLERANCE_M, true),
        (3.0, -1.1 * TOLERANCE_M, false),
        (8.0 + 1.1 * TOLERANCE_M, 0.0, false),
        (8.0 - 0.9 * TOLERANCE_M, -0.9 * TOLERANCE_M, false),
    ] {
        let welded = welded(&[vec![whole], vec![stem(x, y)]]);
        assert_eq!(welded.triangles.len(), 2 + usize::from(is_split), "{x} {y}");
    }
}

/// A needle whose apex lies on its own base, within the tolerance, is left as it is and counted.
#[test]
fn what_is_too_thin_to_be_split_is_kept() {
    let needle = [v(0.0, 0.0, 0.0), v(8.0, 0.0, 0.0), v(4.0, 0.5 * TOLERANCE_M, 0.0)];
    let welded = welded(&[vec![needle]]);
    assert_eq!((welded.triangles.len(), welded.splits.facets), (1, 0));
    assert_eq!((welded.splits.junctions.count, welded.splits.left.count), (1, 1));
}

/// A fan over every piece of a line, up to one point: the side of a sheet.
fn side(places: &[f64], apex: Vec3, bend: impl Fn(f64) -> Vec3) -> Vec<Facet> {
    places.windows(2).map(|pair| [bend(pair[0]), bend(pair[1]), apex]).collect()
}

proptest! {
    /// Sheets around one line, each with its own corners on it, some of them a little beside it: the area stays, no border
    /// vertex lies on a border edge, and all that is split is on the line.
    #[test]
    fn sheets_around_a_line_become_one_conforming_mesh(
        cuts in prop::collection::vec(prop::collection::vec(0.01f64..0.99, 1..6), 2..5),
        beside in prop::collection::vec(0.0f64..0.7, 2..5),
        direction in (-1.0f64..1.0, -1.0f64..1.0),
    ) {
        let (start, along) = (v(-3.0, 1.0, 0.5), v(7.0, 5.0 * direction.0, 5.0 * direction.1));
        let sheets: Vec<Vec<Facet>> = cuts.iter().enumerate().map(|(k, cuts)| {
            let mut places = [&[0.0, 1.0], &cuts[..]].concat();
            places.sort_by(f64::total_cmp);
            let off = beside[k % beside.len()] * TOLERANCE_M;
            let inner = |share: f64| f64::from(u8::from(share > 0.0 && share < 1.0));
            let apex = start + along * 0.4 + v(0.0, 4.0 - 3.0 * k as f64, k as f64 * 2.0);
            side(&places, apex, |share| start + along * share + v(0.0, 0.0, off * inner(share)))
        }).collect();
        let area = |facets: &[Facet]| -> f64 { facets.iter().map(|f| normal(f).norm() / 2.0).sum() };
        let welded = welded(&sheets);
        for (k, facets) in sheets.iter().enumerate() {
            let (found, vector) = areas(&welded, k as u16);
            // each corner moves by the tolerance at most, along at most 13 m of edges
            prop_assert!((found - area(facets)).abs() < 13.0 * TOLERANCE_M);
            prop_assert!(vector.norm() > found - 13.0 * TOLERANCE_M, "a piece is turned over");
        }
        prop_assert_eq!(t_junctions(&welded).len(), welded.splits.left.count);
        prop_assert_eq!(welded.splits.left.count, 0);
        // each edge on the line has a triangle of every sheet
        let on_line = |&edge: &u32| welded.ends(edge).iter().all(|&v| {
            let to = welded.vertices_m[v as usize] + welded.origin_m - start;
            to.cross(&along).norm() / along.norm() < 3.0 * TOLERANCE_M
        });
        for edge in welded.edges.all().filter(on_line) {
            prop_assert_eq!(welded.edges.count_on(edge), sheets.len());
        }
    }
}

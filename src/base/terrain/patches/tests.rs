// Round numbers: equality is meant.
#![allow(clippy::float_cmp)]

use super::*;
use crate::terrain::grid::triangulate as map_grid;
use crate::terrain::weld::{Piece, Up, weld};
use proptest::prelude::*;
use std::path::Path;

const BASE: u16 = 0;
const SCREE: u16 = 7;

/// A tilted lattice of 12 x 12 squares of 1 m.
fn slope() -> Vec<Facet> {
    map_grid(13, 13, |column, row| {
        let (x, y) = (column as f64, row as f64);
        Some(Vec3::new(x, y, 0.5 * x - 0.25 * y))
    })
}

fn ring(corners: &[Corner]) -> Patch {
    Patch { rings_m: vec![corners.to_vec()], ground: SCREE }
}

/// Facets, grounds and tally after laying zones on the slope.
fn laid(list: Vec<Patch>, cut: bool) -> (Soup, Vec<u16>, Patched) {
    let mut soup = Soup::from(slope());
    let mut layer = ZonePainter::new(&Patches { list, cut });
    let grounds = layer.lay(&mut soup, BASE, &|point| point).unwrap();
    (soup, grounds, layer.done)
}

fn plan_area_m2(facet: &Facet) -> f64 {
    area_m2(facet.map(plan))
}

fn area_of(soup: &Soup, grounds: &[u16], ground: u16) -> f64 {
    let has = soup.facets.iter().zip(grounds).filter(|(_, g)| **g == ground);
    has.map(|(facet, _)| plan_area_m2(&facet)).sum()
}

/// Length of all edges of the welded mesh with one triangle (m, in plan view): the outline's 48. A gap or a T-junction
/// would add to it; a border that ends at the outline divides its edges and adds nothing.
fn open_m(soup: &Soup) -> f64 {
    let piece = Piece { file: Path::new("t.stl"), soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], Vec3::zeros(), Some(1e-6)).unwrap();
    welded.edges.borders().into_iter().map(|edge| welded.edge_m(edge).xy().norm()).sum()
}

fn is_closed(soup: &Soup) -> bool {
    (open_m(soup) - 48.0).abs() < 1e-4
}

#[test]
fn cut_triangles_have_exactly_the_area_of_the_zone() {
    let zone = [[2.3, 1.7], [9.1, 3.2], [7.7, 10.4], [5.0, 6.1], [1.2, 8.8]];
    let exact: f64 = (0..5)
        .map(|k| {
            let ([ax, ay], [bx, by]) = (zone[k], zone[(k + 1) % 5]);
            0.5 * (ax * by - bx * ay)
        })
        .sum();
    let (soup, grounds, done) = laid(vec![ring(&zone)], true);
    let found = area_of(&soup, &grounds, SCREE);
    assert!((found - exact).abs() < 1e-9, "{found} {exact}");
    assert!((done.laid_m2 - exact).abs() < 1e-9);
    assert!((area_of(&soup, &grounds, BASE) - (144.0 - exact)).abs() < 1e-9);
    assert!(is_closed(&soup));
    assert_eq!(soup.facets.len(), 288 - done.crossed + done.pieces);
    // every piece lies in the plane of the slope and faces up
    for [a, b, c] in soup.facets.iter() {
        assert!([a, b, c].iter().all(|p| (p.z - (0.5 * p.x - 0.25 * p.y)).abs() < 1e-12));
        assert!((b - a).cross(&(c - a)).z > 0.0);
    }
}

/// Left whole, triangles go by their centroid; what is said to be on the other side is what cutting would move.
#[test]
fn whole_triangles_go_by_their_centroid() {
    let zone = [[0.0, 0.0], [6.25, 0.0], [6.25, 12.0], [0.0, 12.0]];
    let (soup, grounds, done) = laid(vec![ring(&zone)], false);
    assert_eq!(soup.facets, slope());
    // A square cut by the border at a quarter: its triangles have their centroids at 1/3 and 2/3, outside both.
    assert_eq!(area_of(&soup, &grounds, SCREE), 72.0);
    assert_eq!((done.crossed, done.laid_m2), (24, 72.0));
    assert!((done.other_side_m2 - 3.0).abs() < 1e-12, "{done:?}");
    let (cut, grounds, done) = laid(vec![ring(&zone)], true);
    assert!((area_of(&cut, &grounds, SCREE) - 75.0).abs() < 1e-12);
    assert!((done.other_side_m2 - 3.0).abs() < 1e-12);
}

/// Along edges and through corners of the mesh nothing is crossed, or only where the border leaves them.
#[test]
fn borders_along_edges_cut_nothing() {
    let zone = [[3.0, 3.0], [6.0, 3.0], [6.0, 6.0], [3.0, 6.0]];
    let (soup, grounds, done) = laid(vec![ring(&zone)], true);
    assert_eq!((soup.facets.len(), done.crossed), (288, 0));
    assert_eq!(area_of(&soup, &grounds, SCREE), 9.0);
    // against the diagonals: through their middle and through corners
    let diamond = [[2.0, 6.0], [6.0, 2.0], [10.0, 6.0], [6.0, 10.0]];
    let (soup, grounds, _) = laid(vec![ring(&diamond)], true);
    assert_eq!(area_of(&soup, &grounds, SCREE), 32.0);
    assert!(is_closed(&soup));
}

#[test]
fn holes_overlaps_and_small_zones_are_respected() {
    let outer = vec![[1.5, 1.5], [10.5, 1.5], [10.5, 10.5], [1.5, 10.5]];
    let hole = vec![[4.5, 4.5], [4.5, 7.5], [7.5, 7.5], [7.5, 4.5]];
    let holed = Patch { rings_m: vec![outer.clone(), hole.clone()], ground: SCREE };
    let (soup, grounds, _) = laid(vec![holed], true);
    assert!((area_of(&soup, &grounds, SCREE) - 72.0).abs() < 1e-9);
    // the last one on top
    let (soup, grounds, done) = laid(vec![ring(&outer), Patch { ground: 3, ..ring(&hole) }], true);
    assert!((area_of(&soup, &grounds, 3) - 9.0).abs() < 1e-9);
    assert!((area_of(&soup, &grounds, SCREE) - 72.0).abs() < 1e-9);
    assert!(done.zones == 2 && is_closed(&soup));
    // a zone within one triangle
    let small = [[5.6, 5.1], [5.8, 5.1], [5.8, 5.3]];
    let (soup, grounds, done) = laid(vec![ring(&small)], true);
    assert!((area_of(&soup, &grounds, SCREE) - 0.02).abs() < 1e-12);
    assert!(done.crossed == 1 && is_closed(&soup));
}

proptest! {
    /// Any two zones, crossing as they like: no gap, no overlap, no area lost, and ground as the map has it.
    #[test]
    fn cutting_loses_nothing(
        one in prop::collection::vec(prop::array::uniform2(0i16..481), 3..9),
        other in prop::collection::vec(prop::array::uniform2(0i16..481), 3..9),
    ) {
        // decimals: many corners lie on edges and corners of the mesh, but for their last digit
        let corners = |list: &[[i16; 2]]| list.iter().map(|c| c.map(|x| f64::from(x) / 40.0)).collect::<Vec<Corner>>();
        let list = vec![ring(&corners(&one)), Patch { ground: 3, ..ring(&corners(&other)) }];
        let (soup, grounds, done) = laid(list.clone(), true);
        let whole: f64 = soup.facets.iter().map(|facet| plan_area_m2(&facet)).sum();
        prop_assert!((whole - 144.0).abs() < 1e-4, "{whole}");
        prop_assert!(is_closed(&soup));
        prop_assert_eq!(soup.facets.len(), 288 - done.crossed + done.pieces);
        // places off the borders have the ground of their zone
        let borders = Borders::of(&list);
        for (facet, &ground) in soup.facets.iter().zip(&grounds) {
            let [a, b, c] = facet.map(plan);
            if plan_area_m2(&facet) > 1e-6 {
                for weight in [[0.8, 0.1], [0.1, 0.8], [0.1, 0.1]] {
                    let [u, v] = weight;
                    let at = [0, 1].map(|k| a[k] * u + b[k] * v + c[k] * (1.0 - u - v));
                    prop_assert_eq!(borders.ground_at(at).unwrap_or(BASE), ground);
                }
            }
        }
    }
}

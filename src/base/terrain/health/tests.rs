use super::*;
use crate::rock::Vec3;
use crate::terrain::make::{jittered_plane, stem, tetrahedron};
use crate::terrain::stl::{Facet, Soup, binary_bytes, parse};
use crate::terrain::weld::{Up, weld};
use proptest::prelude::*;
use std::path::Path;

fn health_of(soups: &[Soup], tolerance_m: Option<f64>) -> Health {
    let piece = |soup| Piece { file: Path::new("t.stl"), soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let pieces: Vec<Piece> = soups.iter().map(piece).collect();
    let map_origin_m = Vec3::new(1000.0, 0.0, 0.0);
    Health::of(&weld(&pieces, map_origin_m, tolerance_m).unwrap(), &pieces)
}

fn health(facets: Vec<Facet>) -> Health {
    health_of(&[Soup::from(facets)], None)
}

fn p(x: f64, y: f64) -> Vec3 {
    Vec3::new(x, y, 0.0)
}

#[test]
fn a_sound_plane_has_one_border_and_nothing_wrong() {
    let found = health(jittered_plane(50.0, 10, 0.5));
    assert_eq!(
        (found.border_edges.count, found.border_loops, &found.parts[..]),
        (40, 1, &[200][..])
    );
    for tally in [&found.zero_area, &found.duplicates, &found.needles, &found.non_manifold_edges] {
        assert_eq!(tally.count, 0);
    }
    assert_eq!((found.t_junctions.count, found.flipped_edges.count), (0, 0));
    // a 100 m x 100 m square, to the rounding of 200 summed areas
    assert!((found.area_m2 - 1e4).abs() < 1e-8, "{}", found.area_m2);
    assert_eq!((found.low_m[0], found.high_m[0]), (950.0, 1050.0));
}

/// Corners that fall together leave triangles without area: where they are most of a mesh, that is said, and of one in three it is not.
#[test]
fn a_mesh_of_which_most_has_no_area_says_so() {
    let line = [p(0.0, 0.0), p(1.0, 0.0), p(2.0, 0.0)];
    let mesh = |flat: usize| {
        let plane =
            [[p(0.0, 0.0), p(2.0, 0.0), p(0.0, 2.0)], [p(2.0, 0.0), p(2.0, 2.0), p(0.0, 2.0)]];
        health(plane.into_iter().chain(std::iter::repeat_n(line, flat)).collect())
    };
    let said: Vec<String> = mesh(3).warnings().collect();
    assert!(said.len() == 1 && said[0].starts_with("3 of 5 triangles have no area"), "{said:?}");
    assert!(mesh(3).to_string().contains("warning: 3 of 5 triangles"));
    assert_eq!(mesh(1).warnings().count(), 0);
}

/// A hole is one more border; a stem with a lid and a foot has none and is a part of its own.
#[test]
fn holes_and_loose_parts_are_counted() {
    let mut slope = jittered_plane(50.0, 10, 0.0);
    slope.drain(88..92); // two cells inside
    let tree = crate::terrain::make::Stem { x_m: 3.0, y_m: 4.0, dbh_m: 0.5, height_m: 10.0 };
    let found = health_of(&[Soup::from(slope), Soup::from(stem(&tree, 0.0))], None);
    assert_eq!((found.border_edges.count, found.border_loops), (40 + 6, 2));
    assert_eq!(found.parts, [196, 28]);
    assert_eq!(found.files.len(), 2);
    // eight sides up and down; the lower lid of six facets faces down
    assert!((found.files[1].facing_down - 6.0 / 28.0).abs() < 1e-15);
}

/// Two small squares beside one long edge: their common corner lies on its inside.
fn t_mesh(off_m: f64) -> Vec<Facet> {
    let middle = p(5.0 + off_m, 5.0);
    vec![
        [p(0.0, 0.0), p(5.0, 0.0), p(5.0, 10.0)],
        [p(5.0, 0.0), p(9.0, 0.0), middle],
        [middle, p(9.0, 10.0), p(5.0, 10.0)],
    ]
}

#[test]
fn a_border_vertex_on_the_inside_of_an_edge_is_a_t_junction() {
    let found = health(t_mesh(0.0));
    assert_eq!(
        (found.t_junctions.count, &found.t_junctions.examples_m[..]),
        (1, &[[1005.0, 5.0, 0.0]][..])
    );
    // the three triangles that met there are four: each shares an edge with the next
    assert_eq!(
        (found.split_facets, found.split_into, found.triangles, found.parts.len()),
        (1, 2, 4, 1)
    );
    assert_eq!((found.t_junctions_left.count, found.border_loops), (0, 1));
    // default tolerance: 1e-6 of the longest side (10 m)
    assert_eq!(health(t_mesh(0.9e-5)).t_junctions.count, 1);
    assert_eq!(health(t_mesh(1.1e-5)).t_junctions.count, 0);
}

/// The cells only save time: brute force over all border vertices and edges finds the same T-junctions.
#[test]
fn cells_find_the_t_junctions_that_brute_force_finds() {
    let mut facets: Vec<Facet> = Vec::new();
    for k in 0..60 {
        let f = |n: usize| f64::from((k * n % 17) as u32) / 2.0;
        // a little beside each other, so that nothing is split
        let (low, tip) = (p(f(3) + 1e-6 * k as f64, f(7)), Vec3::new(f(5), f(11), 1.0 + k as f64));
        facets.push([low, low + p(0.0, 40.0 * f64::from(u32::from(k % 9 == 0)) + 3.0), tip]);
    }
    let soup = Soup::from(facets);
    let piece = Piece { file: Path::new("t.stl"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let mut welded = weld(&[piece], Vec3::zeros(), Some(1e-9)).unwrap();
    assert_eq!(welded.splits.facets, 0);
    welded.tolerance_m = 1e-3;
    let mut expected = Vec::new();
    for edge in welded.edges.borders() {
        let [a, b] = welded.ends(edge);
        let (start, along) = (welded.vertices_m[a as usize], welded.edge_m(edge));
        for vertex in (0..welded.vertices_m.len() as u32).filter(|v| ![a, b].contains(v)) {
            let to = welded.vertices_m[vertex as usize] - start;
            let beside = to.cross(&along).norm() / along.norm();
            let share = to.dot(&along) / along.norm_squared();
            let from_ends_m = share.min(1.0 - share) * along.norm();
            if beside <= 1e-3 && from_ends_m > 1e-3 {
                expected.push(crate::terrain::weld::t_junctions::TJunction { vertex, edge });
            }
        }
    }
    expected.sort_unstable();
    assert!(expected.len() > 10, "the example has {} T-junctions", expected.len());
    assert_eq!(crate::terrain::weld::t_junctions::t_junctions(&welded), expected);
}

#[test]
fn flipped_needles_fins_and_copies_are_found_where_they_are() {
    let mut facets = jittered_plane(50.0, 10, 0.0);
    facets[70].swap(1, 2);
    let [a, b, _] = facets[20];
    facets.push([a, b, a + Vec3::new(0.0, 0.0, 5.0)]); // a fin on an inner edge
    facets.push(facets[5]);
    facets.push([p(60.0, 0.0), p(61.0, 0.0), p(60.5, 0.5e-4)]); // 20 000 times as long as high
    facets.push([p(60.0, 9.0), p(61.0, 9.0), p(61.0, 9.0)]);
    let found = health_of(&[Soup::from(facets)], Some(1e-6));
    assert_eq!((found.flipped_edges.count, found.non_manifold_edges.count), (3, 1));
    assert_eq!((found.duplicates.count, found.needles.count, found.zero_area.count), (1, 1, 1));
    assert_eq!(found.needles.examples_m, [[1060.0, 0.0, 0.0]]);
    assert_eq!(found.zero_area.examples_m, [[1060.0, 9.0, 0.0]]);
    let table = found.to_string();
    assert!(
        table.contains("left out, the first is kept") && table.contains("(1060.000, 9.000, 0.000)"),
        "{table}"
    );
}

#[test]
fn binary_files_at_map_coordinates_are_refused_and_text_is_not() {
    let far: Vec<Facet> =
        tetrahedron(4.0).iter().map(|f| f.map(|q| q + Vec3::new(683_000.0, 0.0, 0.0))).collect();
    let binary = parse(binary_bytes(&far), Path::new("t.stl")).unwrap();
    // 32-bit numbers are 1/16 m apart at 683 000, 1.6 % of 4 m
    let refused = health_of(&[binary], None).check().unwrap_err().to_string();
    assert!(refused.contains("6.25e-2") && refused.contains("origin_m"), "{refused}");
    assert!(health_of(&[Soup::from(far)], None).check().is_ok());
}

proptest! {
    /// Sums that hold for every soup, however broken: facets are kept or left out, every triangle has three sides and
    /// belongs to one part.
    #[test]
    fn the_books_balance(corners in prop::collection::vec(prop::array::uniform3(-6i8..6), 3..150)) {
        let points: Vec<Vec3> = corners.iter().map(|c| Vec3::from(c.map(f64::from))).collect();
        let soup = Soup::from(points.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect::<Vec<Facet>>());
        let pieces = [Piece { file: Path::new("t.stl"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 }];
        let Ok(welded) = weld(&pieces, Vec3::zeros(), None) else { return Ok(()) };
        let found = Health::of(&welded, &pieces);
        let made = soup.facets.len() + found.split_into - found.split_facets;
        let left_out = found.zero_area.count + found.duplicates.count + found.covered.count;
        prop_assert_eq!(found.triangles + left_out, made);
        prop_assert_eq!(found.parts.iter().sum::<usize>(), found.triangles);
        let sides: usize = welded.edges.all().map(|edge| welded.edges.count_on(edge)).sum();
        prop_assert_eq!(welded.edges.all().count(), found.edges);
        prop_assert_eq!(sides, 3 * found.triangles);
        prop_assert!(found.edge_quantiles_m.is_sorted() && found.edge_quantiles_m[0] > found.tolerance_m);
        prop_assert!(found.border_loops <= found.border_edges.count);
        prop_assert!(serde_json::to_string(&found).is_ok());
    }
}

use super::*;
use crate::terrain::facets::Facets;
use crate::terrain::grid::Grid;
use proptest::prelude::*;

fn piece(soup: &Soup, sheet: u16) -> Piece<'_> {
    Piece { file: Path::new("t.stl"), soup, up: Up::Z, scale: 1.0, sheet }
}

fn weld_one(facets: Vec<[Vec3; 3]>, tolerance_m: Option<f64>) -> Result<Welded> {
    let soup = Soup::from(facets);
    weld(&[piece(&soup, 0)], Vec3::zeros(), tolerance_m)
}

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Euler: a square of n x n cells has (n + 1)² vertices, 2 n² triangles and 3 n² + 2 n edges.
#[test]
fn a_lattice_welds_to_the_counts_of_euler() {
    let welded = weld_one(crate::terrain::make::jittered_plane(50.0, 20, 0.6), None).unwrap();
    let counts = (welded.vertices_m.len(), welded.triangles.len(), welded.edges.len());
    assert_eq!(counts, (21 * 21, 800, 3 * 400 + 40));
    assert_eq!(welded.edges.borders().len(), 80);
}

#[test]
fn edge_k_runs_from_vertex_k_to_the_next() {
    let welded = weld_one(crate::terrain::make::tetrahedron(1.0), None).unwrap();
    for (t, corners) in (0u32..).zip(&welded.triangles) {
        for k in 0..3 {
            let edge = welded.edges.edge_of(3 * t + k as u32);
            let mut ends = [corners[k], corners[(k + 1) % 3]];
            ends.sort_unstable();
            assert_eq!(welded.ends(edge), ends);
            assert_eq!(welded.edges.count_on(edge), 2);
            assert!(welded.edges.triangles_on(edge).any(|on| on == t));
        }
    }
}

/// Coordinates of a 32-bit file minus whole metres are exact in f64, so nothing is lost on the way to the map.
#[test]
fn map_coordinates_come_back_bit_for_bit() {
    let corner = v(f64::from(2_600_000.3_f32), f64::from(1_199_999.7_f32), f64::from(1523.17_f32));
    let soup = Soup::from(vec![[corner, corner + v(4.0, 0.0, 0.0), corner + v(0.0, 4.0, 1.0)]]);
    let welded = weld(&[piece(&soup, 0)], v(-0.5, 7.0, 0.0), None).unwrap();
    assert_eq!(welded.origin_m.map(f64::fract), v(0.5, 0.0, 0.0));
    let on_file = welded.on_map(welded.vertices_m[0]) - v(-0.5, 7.0, 0.0);
    assert_eq!(on_file, corner);
    assert!(welded.vertices_m.iter().all(|p| p.amax() <= 2.5));
}

#[test]
fn sheets_and_facets_are_remembered_across_files_and_seams() {
    let left = Soup::from(vec![[v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)]]);
    let right = Soup::from(vec![
        [v(1.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(5.0, 5.0, 0.0)],
        [v(1.0, -0.0, 0.0), v(1.0, 1.0, 0.0), v(1e-7, 1.0, -0.0)],
    ]);
    let welded = weld(&[piece(&left, 3), piece(&right, 8)], Vec3::zeros(), None).unwrap();
    assert_eq!((welded.sheet_of, welded.facet_of), (vec![3, 8], vec![0, 1]));
    assert_eq!((welded.vertices_m.len(), welded.edges.len(), welded.moved_corners), (4, 5, 1));
    assert_eq!(
        (welded.zero_area.count, welded.zero_area.examples_m.clone()),
        (1, vec![[1.0, 0.0, 0.0]])
    );
}

/// A grid tells that its points are apart; without that, each is looked for. The mesh is the same to the last bit, with
/// holes, with points that no facet uses, and with further files that share vertices.
#[test]
fn points_known_to_be_apart_are_welded_as_if_they_were_not() {
    let side = 60;
    let height = |k: usize| {
        let (x, y) = ((k % side) as f64, (k / side) as f64);
        (!(k * k / 7).is_multiple_of(11)).then_some(0.3 * x + 0.1 * (x * y % 13.0) - 0.2 * y)
    };
    let grid = Grid {
        columns: side,
        rows: side,
        corner_m: [2_600_000.25, 1_200_000.5],
        cell_m: 0.7,
        values: (0..side * side).map(height).collect(),
    };
    let known = grid.surface(Vec3::new(2_600_000.0, 1_200_000.0, 0.0));
    assert!(matches!(known, Facets::Shared { apart_m, .. } if apart_m > 0.69));
    let seam = known.at(17);
    let Facets::Shared { points, corners, .. } = known.clone() else { panic!("a lattice") };
    let unknown = Facets::Shared { points, corners, apart_m: 0.0 };
    let soup = |facets| Soup { facets, ..Soup::from(Vec::new()) };
    let apart = soup(known.iter().collect::<Vec<_>>().into());
    let (known, unknown) = (soup(known), soup(unknown));
    // shares two vertices, one of them nearly
    let beside = soup(vec![[seam[1], seam[0] + v(1e-6, 0.0, 0.0), v(1.0, 2.0, 60.0)]].into());
    for tolerance_m in [None, Some(0.0), Some(0.01)] {
        let welded = |first: &Soup| {
            let pieces = [piece(first, 0), piece(&beside, 1)];
            [&pieces[..1], &pieces].map(|some| weld(some, Vec3::zeros(), tolerance_m).unwrap())
        };
        let found = welded(&known);
        assert!(found == welded(&unknown) && found == welded(&apart), "{tolerance_m:?}");
        assert!(found[0].triangles.len() > 4000 && found[0].moved_corners == 0);
    }
    // points that a large tolerance merges are looked for
    let coarse = |first: &Soup| weld(&[piece(first, 0)], Vec3::zeros(), Some(0.8)).unwrap();
    let found = coarse(&known);
    assert!(found == coarse(&unknown) && found.moved_corners > 1000);
}

#[test]
fn y_up_files_in_millimetres_stand_upright_in_metres() {
    let soup = Soup::from(vec![[v(0.0, 0.0, 0.0), v(1000.0, 0.0, 0.0), v(0.0, 3000.0, -2000.0)]]);
    let turned = Piece { up: Up::Y, scale: 0.001, ..piece(&soup, 0) };
    let welded = weld(&[turned], Vec3::zeros(), None).unwrap();
    let top = welded.on_map(welded.vertices_m[2]);
    assert!((top - v(0.0, 2.0, 3.0)).norm() < 1e-15, "{top}"); // one rounding of the scale
}

#[test]
fn the_first_of_equal_triangles_stays_whatever_the_winding() {
    let [a, b, c, d] = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0), v(1.0, 1.0, 0.0)];
    let welded =
        weld_one(vec![[a, b, c], [c, b, a], [b, d, c], [b, c, a], [d, b, c]], None).unwrap();
    assert_eq!(welded.facet_of, [0, 2]);
    assert_eq!(welded.duplicates.count, 3);
    assert_eq!(welded.triangles[0], [0, 1, 2]);
}

/// A chain of points 0.8 tolerances apart must not fall together: 0 takes 1 (0.8), 2 stays (1.6), 2 takes 3.
#[test]
fn chains_of_close_points_do_not_collapse() {
    let apex = [v(0.0, 1.0, 0.0), v(0.0, 0.0, 1.0)];
    let at = |k: usize| v(0.008 * k as f64, 0.0, 0.0);
    let facets = (0..4).map(|k| [at(k), apex[0], apex[1]]).collect();
    let welded = weld_one(facets, Some(0.01)).unwrap();
    assert_eq!((welded.facet_of, welded.duplicates.count), (vec![0, 2], 2));
}

#[test]
fn unusable_requests_are_refused_with_a_cure() {
    let flat = vec![[Vec3::zeros(), v(1.0, 0.0, 0.0), v(2.0, 0.0, 0.0)]];
    let soup = Soup::from(flat.clone());
    let scaled = |scale| weld(&[Piece { scale, ..piece(&soup, 0) }], Vec3::zeros(), None);
    for (refused, part) in [
        (weld_one(flat.clone(), None), "none of 1 facets has an area"),
        (weld(&[], Vec3::zeros(), None), "no mesh file"),
        (weld_one(flat.clone(), Some(-1.0)), "weld tolerance = -1 m"),
        (weld_one(flat.clone(), Some(f64::NAN)), "weld tolerance = NaN m"),
        (scaled(0.0), "0 is not a positive number"),
        (scaled(f64::INFINITY), "inf is not a positive number"),
        (scaled(1e308), "triangle 1: coordinates beyond 1e8 m"),
    ] {
        let message = refused.expect_err(part).to_string();
        assert!(message.contains(part), "{message}");
    }
}

/// Sorting runs on all threads; the rows are all different, so their order is unique.
#[test]
fn any_number_of_threads_welds_the_same_mesh() {
    let soup = Soup::from(crate::terrain::make::natural_slope(60, 80).facets);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| weld(&[piece(&soup, 0)], Vec3::zeros(), Some(0.05)).unwrap())
    };
    assert_eq!(on(1), on(5));
}

fn corners() -> impl Strategy<Value = Vec<[u8; 3]>> {
    prop::collection::vec(prop::array::uniform3(0u8..12), 3..120)
}

proptest! {
    /// What the welder promises: kept points lie more than the tolerance apart, every corner has one within it, and
    /// the mesh is free of repeated corners, duplicates and unused vertices.
    #[test]
    fn welding_keeps_its_promises(corners in corners(), tolerance_m in 0.0..3.0) {
        let points: Vec<Vec3> = corners.iter().map(|c| Vec3::from(c.map(f64::from)) * 0.7).collect();
        let facets: Vec<[Vec3; 3]> = points.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let soup = Soup::from(facets.clone());
        let Ok(Joined(joined)) = join(&[piece(&soup, 0)], Vec3::zeros(), Some(tolerance_m)) else { return Ok(()) };
        let kept = &joined.vertices_m;
        for (i, a) in kept.iter().enumerate() {
            prop_assert!(kept[..i].iter().all(|b| (a - b).norm() > tolerance_m));
        }
        for (t, triangle) in joined.triangles.iter().enumerate() {
            let source = facets[joined.facet_of[t] as usize];
            for k in 0..3 {
                let moved = joined.on_map(kept[triangle[k] as usize]) - source[k];
                prop_assert!(moved.norm() <= tolerance_m + 1e-12); // rounding of the recentring
            }
        }
        let welded = Joined(joined).finish();
        let kept = welded.vertices_m.len() as u32;
        prop_assert!((0..kept).all(|v| welded.triangles.iter().flatten().any(|&u| u == v)));
        let mut sets: Vec<[u32; 3]> = welded.triangles.clone();
        for set in &mut sets {
            set.sort_unstable();
        }
        sets.sort_unstable();
        prop_assert!(sets.windows(2).all(|pair| pair[0] != pair[1]));
        prop_assert!(sets.iter().all(|set| set[0] < set[1] && set[1] < set[2]));
        let all = facets.len() + welded.splits.pieces - welded.splits.facets;
        prop_assert_eq!(welded.zero_area.count + welded.duplicates.count + welded.covered.count + welded.triangles.len(), all);
    }
}

/// A slope of 12 800 triangles in cells of 1.25 m, in map coordinates.
fn slope_on_the_map() -> Vec<[Vec3; 3]> {
    let at = v(2_600_000.0, 1_200_000.0, 500.0);
    let plane = crate::terrain::make::jittered_plane(50.0, 80, 0.6);
    plane.into_iter().map(|facet| facet.map(|corner| corner + at)).collect()
}

fn told(answer: Result<Welded>) -> String {
    answer.err().map(|error| error.to_string()).unwrap_or_default()
}

/// One triangle at (0, 0, 0) makes the box of a slope on the map so large that corners 2.6 m apart were merged, and the slope was gone.
#[test]
fn a_stray_triangle_does_not_take_the_slope_along() {
    let mut facets = slope_on_the_map();
    facets.insert(7, [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)]);
    let message = told(weld_one(facets.clone(), None));
    assert!(
        message.contains("triangle 8 of t.stl lies") && message.contains("weld_tolerance_m"),
        "{message}"
    );
    assert_eq!(weld_one(facets, Some(1e-3)).unwrap().triangles.len(), 12_801);
}

/// Trees in coordinates of the slope's file beside an elevation model on the map.
#[test]
fn files_in_other_coordinates_are_refused() {
    let slope = Soup::from(slope_on_the_map());
    let weld_both = |other: &Soup| weld(&[piece(&slope, 0), piece(other, 1)], Vec3::zeros(), None);
    let tree = Soup::from(crate::terrain::make::tetrahedron(1.0));
    let message = told(weld_both(&tree));
    assert!(message.contains("origin_m"), "{message}");
    let at = v(2_600_060.0, 1_200_000.0, 500.0);
    let near = Soup::from(vec![[at, at + v(1.0, 0.0, 0.0), at + v(0.0, 1.0, 0.0)]]);
    assert_eq!(weld_both(&near).unwrap().triangles.len(), 12_801);
}

/// Trees in millimetres beside a slope in metres: the tolerance that fits their box would flatten the slope.
#[test]
fn a_wrong_scale_does_not_flatten_the_slope() {
    let slope = Soup::from(crate::terrain::make::jittered_plane(50.0, 400, 0.6));
    let trees = Soup::from(crate::terrain::make::tetrahedron(500_000.0));
    let millimetres = |scale: f64| [piece(&slope, 0), Piece { scale, ..piece(&trees, 1) }];
    let message = told(weld(&millimetres(1.0), Vec3::zeros(), None));
    assert!(message.contains("t.stl: mesh: ") && message.contains("check scale"), "{message}");
    assert!(weld(&millimetres(1e-3), Vec3::zeros(), None).is_ok());
}

/// A tolerance longer than the edges merges the slope away without a trace: 6 m on cells of 1.25 m. Needles that merge are no loss, however
/// many corners move.
#[test]
fn a_tolerance_longer_than_the_edges_is_refused() {
    let soup = Soup::from(slope_on_the_map());
    let within = |soup: &Soup, tolerance_m: f64| {
        let joined = join_files(&[piece(soup, 0)], Vec3::zeros(), Some(tolerance_m));
        joined.err().map(|error| error.to_string()).unwrap_or_default()
    };
    let message = within(&soup, 6.0);
    for words in ["t.stl: [mesh] weld_tolerance_m: found 6, by which ", " of 12800 triangles with "]
    {
        assert!(message.contains(words), "{message}");
    }
    let written = message.split_once("write ").unwrap().1.split(' ').next().unwrap();
    let least: f64 = written.parse().unwrap();
    assert!(least > 0.2 && least < 0.7, "{message}");
    assert_eq!(within(&soup, least), "");
    // 5 % of needles, a millimetre wide
    let mut facets = slope_on_the_map();
    let at = facets[0][0];
    facets.extend((0..640).map(|k| {
        let at = at + v(0.05 * f64::from(k), 0.0, 40.0);
        [at, at + v(0.0, 1.0, 0.0), at + v(0.0, 1.0, 1e-3)]
    }));
    assert_eq!(within(&Soup::from(facets), 0.002), "");
}

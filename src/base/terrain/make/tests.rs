use super::*;
use crate::rock::Vec3;
use crate::terrain::health::Health;
use crate::terrain::stl::{Soup, area_vector, binary_bytes};
use crate::terrain::weld::{Piece, Up, weld};
use std::f64::consts::FRAC_PI_4;
use std::path::Path;

fn health(facets: Vec<Facet>) -> Health {
    let soup = Soup::from(facets);
    let pieces = [Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 }];
    Health::of(&weld(&pieces, Vec3::zeros(), None).unwrap(), &pieces)
}

fn nothing_is_wrong(found: &Health) -> bool {
    [
        &found.zero_area,
        &found.duplicates,
        &found.needles,
        &found.non_manifold_edges,
        &found.t_junctions,
    ]
    .iter()
    .all(|tally| tally.count == 0)
        && found.flipped_edges.count == 0
}

#[test]
fn the_shipped_files_are_what_the_generator_makes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrain");
    for (name, facets) in shipped() {
        let file = std::fs::read(folder.join(&name)).unwrap();
        assert!(
            file == binary_bytes(&facets),
            "terrain/{name} differs from what `rockfall mesh make` writes"
        );
    }
}

#[test]
fn every_made_mesh_is_sound() {
    for (name, facets) in shipped() {
        let found = health(facets);
        assert!(nothing_is_wrong(&found), "{name}: {found}");
        // stems and the tetrahedron are closed, the containers are two boxes without lids
        let closed = name.contains("trees") || name.contains("tetrahedron");
        let loops = if closed { 0 } else { 1 + usize::from(name.contains("containers")) };
        assert_eq!(found.border_loops, loops, "{name}");
        assert!(closed || found.files[0].facing_down == 0.0, "{name}");
    }
    for facets in [tetrahedron(1.0), containers(0.6, 0.4, 0.3, 0.2), stairs(5, 0.5, 1.0, 3.0)] {
        assert!(nothing_is_wrong(&health(facets)));
    }
}

#[test]
fn the_natural_slope_has_the_sizes_of_the_speed_studies() {
    for (across, down, triangles) in [(61, 82, 10_004), (193, 258, 99_588)] {
        assert_eq!(natural_slope(across, down).facets.len(), triangles);
    }
    let found = health(natural_slope(61, 82).facets);
    assert_eq!((found.low_m[1], found.high_m[1]), (0.0, 400.0));
    // the octaves add at most 16 m to a drop of 250 m tan 38° = 195 m
    assert!((found.high_m[2] - 195.0).abs() < 16.0 && found.low_m[2].abs() < 8.0, "{found}");
}

/// Lead of the sum of the two lattices: 0.06 m + 0.02 m, never more.
#[test]
fn the_paper_slope_is_ten_metres_at_45_degrees_with_humps_of_8_cm() {
    let slope = paper_slope();
    let mut highest: f64 = 0.0;
    for corner in slope.facets.iter().flatten() {
        let hump_m = corner.z - (11.0 - corner.y).clamp(0.0, 10.0);
        highest = highest.max(hump_m.abs());
    }
    assert!((0.05..=0.08).contains(&highest), "{highest}");
}

/// Noise has no jump where its lattice changes cells: halving the distance halves the difference.
#[test]
fn noise_is_continuous_and_bounded() {
    for (x, y) in [(3.0, 5.5), (-2.0, 1.25), (0.0, 0.0)] {
        for noise in [noise::value, noise::gradient] {
            let jump = |d: f64| (noise(4, 1.0, x + d, y) - noise(4, 1.0, x - d, y)).abs();
            assert!(jump(1e-9) < 1e-8 && jump(1e-3) < 1e-2);
        }
    }
    let far = |k: u32| noise::value(9, 1.0, 0.37 * f64::from(k), 0.73 * f64::from(k));
    assert!((0..10_000).all(|k| far(k).abs() <= 1.0));
    let mean = (0..10_000).map(far).sum::<f64>() / 1e4;
    // 10 000 numbers with a standard deviation of about 0.35: four standard errors
    assert!(mean.abs() < 4.0 * 0.35 / 100.0, "{mean}");
}

/// Every corner of the plane lies in it, whatever the angle: to the rounding of 70 m.
#[test]
fn the_jittered_plane_is_flat_and_nowhere_folded() {
    let (sin, cos) = 0.6_f64.sin_cos();
    for facet in jittered_plane(50.0, 24, 0.6) {
        let normal = area_vector(&facet);
        assert!(normal.dot(&Vec3::new(0.0, sin, cos)) > 0.1 * normal.norm());
        assert!(facet.iter().all(|p| (p.y * sin + p.z * cos).abs() < 2e-14));
    }
}

#[test]
fn groove_ridge_and_tetrahedron_have_their_angles() {
    for (facets, sign) in [(v_groove(5.0, FRAC_PI_4), -1.0), (ridge(5.0, FRAC_PI_4), 1.0)] {
        assert_eq!(facets.len(), 4);
        for facet in facets {
            let middle = (facet[0] + facet[1] + facet[2]) / 3.0;
            let normal = area_vector(&facet).normalize();
            assert!((normal.z - 0.5_f64.sqrt()).abs() < 1e-15);
            assert!(normal.x * middle.x * sign > 0.0, "a flank falls the wrong way");
        }
    }
    for facet in tetrahedron(2.0) {
        for k in 0..3 {
            assert!(((facet[k] - facet[(k + 1) % 3]).norm() - 2.0).abs() < 1e-15);
        }
        let middle = Vec3::new(0.0, 0.0, -0.75 * 2.0 * (2.0_f64 / 3.0).sqrt());
        assert!(area_vector(&facet).dot(&(facet[0] - middle)) > 0.0, "a face looks inwards");
    }
}

/// Divergence theorem: the volume of a closed outward mesh is a sixth of the sum of its triple products.
#[test]
fn stems_are_closed_and_have_the_volume_of_their_prism() {
    let tree = Stem { x_m: 100.0, y_m: -50.0, dbh_m: 0.6, height_m: 12.0 };
    let octagon_m2 = 2.0 * 2.0_f64.sqrt() * 0.09;
    for (facets, base_m2) in [(stem(&tree, 7.0), octagon_m2), (square_stem(&tree, 7.0), 0.36)] {
        let corner = facets[0][0];
        let volume: f64 = facets
            .iter()
            .map(|f| (f[0] - corner).dot(&area_vector(&f.map(|p| p - corner))) / 6.0)
            .sum();
        // the foot reaches 0.5 m into the ground
        assert!((volume - 12.5 * base_m2).abs() < 1e-10, "{volume}");
        assert_eq!(health(facets).border_edges.count, 0);
    }
}

/// One tree is one stem.
#[test]
fn stems_are_counted_in_words() {
    let said = |standing| Planted { facets: Vec::new(), standing, left_out: None }.stems();
    assert_eq!([said(1), said(2)], ["1 stem", "2 stems"]);
}

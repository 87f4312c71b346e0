use super::*;
use crate::math::turn;
use nalgebra::Unit;

fn close(found: f64, known: f64) {
    assert!((found / known - 1.0).abs() < 1e-13, "{found} {known}");
}

fn sorted(mut moments: [f64; 3]) -> [f64; 3] {
    moments.sort_by(f64::total_cmp);
    moments
}

/// Volumes and moments in closed form: a box, EOTA's cube and wheel, a hexagonal prism about its
/// axis, Lu's block.
#[test]
fn bodies_have_their_closed_forms() {
    let solid = Solid::of(&box_surface([3.0, 2.0, 1.0]));
    close(solid.volume, 6.0);
    let [a, b, c] = sorted(solid.moments);
    close(a / 6.0, 5.0 / 12.0);
    close(b / 6.0, 10.0 / 12.0);
    close(c / 6.0, 13.0 / 12.0);
    let cube = Solid::of(&eota([1.122; 3]));
    close(cube.volume, 17.0 / 24.0 * 1.122_f64.powi(3));
    for moment in cube.moments {
        close(moment / cube.volume, 21.0 / 170.0 * 1.122_f64.powi(2));
    }
    let wheel = Solid::of(&eota([1.0, 1.0, 0.5]));
    let [a, _, c] = sorted(wheel.moments);
    close(a / wheel.volume, 21.0 / 340.0 * 1.25);
    close(c / a, 1.6);
    let prism = Solid::of(&prism_surface(6, 0.5));
    close(prism.moments[2] / prism.volume, 5.0 / 12.0);
    close(
        Solid::of(&box_surface([0.93, 0.93, 0.47])).moments[2] / (0.93 * 0.93 * 0.47),
        0.93_f64.powi(2) / 6.0,
    );
}

/// The farthest corner over the radius of equal volume, of unrounded blocks, in closed form: 1.1074
/// and 1.3051.
#[test]
fn eota_blocks_reach_as_far_as_they_should() {
    for (sides, corner, reach) in [
        ([1.0, 1.0, 1.0], Vec3::new(0.5, 0.25, 0.25), 1.107_387),
        ([1.0, 1.0, 0.5], Vec3::new(0.5, 0.25, 0.125), 1.305_109),
    ] {
        let surface = eota(sides);
        let solid = Solid::of(&surface);
        let volume = 17.0 / 24.0 * sides[2];
        let known = corner.norm() / crate::math::cbrt(0.75 * volume / std::f64::consts::PI);
        let most = surface.points.iter().map(Vec3::norm).fold(0.0, f64::max);
        close(most / solid.equal_radius(), known);
        assert!((known - reach).abs() < 1e-6);
    }
}

/// Rotated and moved by a million metres the moments stay the same, up to the digits of such
/// coordinates.
#[test]
fn moments_do_not_depend_on_place_and_turn() {
    let mut surface = eota([1.0, 0.8, 0.5]);
    let known = sorted(Solid::of(&surface).moments);
    let turned = turn(&Unit::new_normalize(Vec3::new(0.3, -1.0, 0.6)), 1.1);
    for p in &mut surface.points {
        *p = turned * *p + Vec3::new(1e6, -2e6, 3e5);
    }
    let solid = Solid::of(&surface);
    assert!((solid.centre - Vec3::new(1e6, -2e6, 3e5)).norm() < 1e-9);
    for (found, known) in sorted(solid.moments).iter().zip(known) {
        assert!((found / known - 1.0).abs() < 1e-8);
    }
}

/// Euler's formula, and 26 faces of EOTA's block, 6 of a box, 80 of the 42 points.
#[test]
fn cores_have_all_their_faces() {
    for (points, faces) in [
        (eota([1.0; 3]).points, 26),
        (box_surface([3.0, 2.0, 1.0]).points, 6),
        (sphere_points(), 80),
        (prism_surface(5, 1.0).points, 7),
    ] {
        let core = Core::of(&points).unwrap();
        assert_eq!(core.faces.len(), faces);
        assert_eq!(core.corners.len() + core.faces.len(), core.ridges.len() + 2);
    }
}

/// Points stored with few digits lie only nearly in the planes of their faces: all faces are found
/// all the same, none twice and none across another.
#[test]
fn faces_of_rounded_coordinates_do_not_overlap() {
    let turned = turn(&Unit::new_normalize(Vec3::new(0.3, -1.0, 0.6)), 1.1);
    for digits in [6, 7, 8, 9, 10, 11, 12] {
        let step = 10.0_f64.powi(-digits);
        let points = prism_surface(16, 0.6).points;
        let rounded = points.iter().map(|p| (turned * p).map(|x| (x / step).round() * step));
        let core = Core::of(&rounded.collect::<Vec<_>>()).unwrap();
        assert_eq!(core.corners.len() + core.faces.len(), core.ridges.len() + 2, "{digits}");
        assert!(digits < 10 || core.faces.len() == 18, "{digits}: {}", core.faces.len());
    }
}

/// A rounded box keeps its faces in place and loses only its corners, by (√3 − 1) of the radius of
/// the balls.
#[test]
fn rounding_keeps_faces() {
    let surface = box_surface([2.0, 2.0, 2.0]);
    let solid = Solid::of(&surface);
    let shape = Shape::of(&solid, &surface.points, 0.1).unwrap();
    let unit = solid.equal_radius();
    let rock = Rock { radius_m: unit, density_kg_m3: 1000.0 };
    let block = Block::new(&shape, &rock);
    assert!((block.mass_kg - 8000.0).abs() < 1e-9);
    assert!((block.support_m(&Vec3::x()) - 1.0).abs() < 1e-5);
    assert!((shape.cut_off - 0.1 * (3.0_f64.sqrt() - 1.0)).abs() < 1e-6);
    close(block.inertia_kg_m2[0], 8000.0 * 4.0 / 6.0);
    assert_eq!(Shape::of(&solid, &surface.points, 2.0), Err(BadSurface::NoCore));
}

/// A scan of many points: its thinned hull states its deviation, and every point is within it.
#[test]
fn a_scan_is_thinned_to_a_stated_distance() {
    let points: Vec<Vec3> = (0..500)
        .map(|k| {
            let (z, angle) = (2.0 * (f64::from(k) + 0.5) / 500.0 - 1.0, 2.399_963 * f64::from(k));
            let (sin, cos) = crate::math::sin_cos(angle);
            let r = (1.0 - z * z).sqrt();
            Vec3::new(1.4 * r * cos, r * sin, 0.7 * z)
        })
        .collect();
    let surface = Surface { points: points.clone(), triangles: Vec::new() };
    let rough = surface.thinned(24, 0.0).unwrap();
    let fine = surface.thinned(64, 0.0).unwrap();
    assert!(rough.corners.len() <= 24 && fine.corners.len() > 48);
    assert!(
        fine.deviation_m < rough.deviation_m && rough.deviation_m < 0.3 && fine.deviation_m > 0.0
    );
    let core = Core::of(&fine.corners).unwrap();
    assert!(points.iter().all(|p| core.distance(p) <= fine.deviation_m * (1.0 + 1e-12)));
}

/// A box without one triangle is no body.
#[test]
fn an_open_surface_is_refused() {
    let mut surface = box_surface([1.0; 3]);
    assert_eq!(surface.check_closed(), Ok(()));
    surface.triangles.pop();
    assert_eq!(surface.check_closed(), Err(BadSurface::Open(3)));
}

/// Two boxes side by side are no block: their hull is neither.
#[test]
fn two_surfaces_are_no_block() {
    let mut both = box_surface([1.0; 3]);
    let count = both.points.len() as u32;
    let beside: Vec<Vec3> = both.points.iter().map(|p| p + Vec3::new(3.0, 0.0, 0.0)).collect();
    let turned: Vec<_> = both.triangles.iter().map(|t| t.map(|k| k + count)).collect();
    both.points.extend(beside);
    both.triangles.extend(turned);
    assert_eq!(both.check_closed(), Err(BadSurface::Parts(2)));
}

/// Four corners make a body, wherever they are: of a regular tetrahedron's corners three lie in a
/// plane as seen along the axes.
#[test]
fn few_corners_span_a_body() {
    let regular = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let slender = [[0.0, 0.0, 0.0], [1.0, 0.9, 0.8], [0.9, 1.0, 0.7], [1.1, 0.7, 1.0]];
    for corners in [regular, slender] {
        let surface = Surface { points: corners.map(Vec3::from).to_vec(), triangles: Vec::new() };
        let thinned = surface.thinned(32, 0.0).unwrap();
        assert_eq!((thinned.corners.len(), thinned.hull_corners), (4, 4));
        assert!(thinned.deviation_m < 1e-12);
    }
}

/// However round its corners, rounding does not enlarge a body: no ball is outside a face by more
/// than a twentieth of its radius, also where edges and faces are shorter than that; faces of boxes
/// stay where they are.
#[test]
fn rounding_stands_out_of_no_face() {
    let scan: Vec<Vec3> = (0..32)
        .map(|k| {
            let (z, angle) = (2.0 * (f64::from(k) + 0.5) / 32.0 - 1.0, 2.399_963 * f64::from(k));
            let ((sin, cos), r) = (crate::math::sin_cos(angle), (1.0 - z * z).sqrt());
            let bump = 1.0 - 0.15 * f64::from(k * 7 % 5) / 5.0;
            Vec3::new(r * cos, 0.8 * r * sin, 0.6 * z) * bump
        })
        .collect();
    let disc: Vec<Vec3> =
        sphere_points().iter().map(|p| p.component_mul(&Vec3::new(1.0, 1.0, 0.4))).collect();
    // a pyramid whose tip is cut off
    let spike: Vec<Vec3> = (0..6)
        .map(|k| {
            let ((sin, cos), r) =
                (crate::math::sin_cos(2.1 * f64::from(k / 2)), if k % 2 == 0 { 1.0 } else { 0.1 });
            Vec3::new(r * cos, r * sin, 3.0 * (1.0 - r))
        })
        .collect();
    for points in
        [scan, disc, spike, eota([1.0, 1.0, 0.5]).points, box_surface([3.0, 2.0, 1.0]).points]
    {
        let hull = Core::of(&points).unwrap();
        let fan = |face: &HullFace| {
            let own = face.corners.clone();
            (2..own.len()).map(move |k| [own[0], own[k - 1], own[k]].map(u32::from))
        };
        let triangles = hull.faces.iter().flat_map(fan).collect();
        let solid = Solid::of(&Surface { points: hull.corners.clone(), triangles });
        let unit = solid.equal_radius();
        for ball in [0.05, 0.1, 0.2, 0.3, 0.4] {
            let Ok(shape) = Shape::of(&solid, &points, ball) else { continue };
            for face in &hull.faces {
                let normal = solid.axes.inverse_transform_vector(&face.normal);
                let most =
                    shape.core.corners.iter().map(|p| p.dot(&normal)).fold(f64::MIN, f64::max);
                let level = (face.level - face.normal.dot(&solid.centre)) / unit;
                let out = most + ball - level;
                assert!(out <= 0.05 * ball * (1.0 + 1e-9), "{ball}: {out}");
                assert!(points.len() != 8 || out.abs() < 1e-9, "{ball}: {out}");
            }
        }
    }
}

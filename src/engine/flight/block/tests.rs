use super::clearance::Clearance;
use super::*;
use crate::body::{Shape, Solid, box_surface, eota, sphere_points};
use crate::math::turn;
use crate::random::{Purpose, RandomStream, stream, unit};
use crate::rock::Rock;
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Piece, Up, weld};
use crate::terrain::{Sheet, Terrain};
use nalgebra::{Rotation3, Unit};
use parry3d_f64::math::{Pose as Place, Vector};
use parry3d_f64::query::distance;
use parry3d_f64::shape::{ConvexPolyhedron, Triangle};
use std::path::Path;

/// Random flights of the test; `ROCKFALL_FLIGHTS` sets another number.
const FLIGHTS: usize = 1500;

fn even(chance: &mut RandomStream, low: f64, high: f64) -> f64 {
    low + (high - low) * unit(chance)
}

/// Cells of 1 m with heights up to 0.5 m: peaks, ridges and hollows of every angle.
fn rough() -> Terrain {
    let n = 12;
    let mut chance = stream(5, Purpose::Place, 0);
    let heights: Vec<f64> = (0..(n + 1) * (n + 1)).map(|_| even(&mut chance, 0.0, 0.5)).collect();
    let at =
        |i: usize, j: usize| Vec3::new(i as f64 - 6.0, j as f64 - 6.0, heights[i * (n + 1) + j]);
    let mut facets: Vec<Facet> = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            facets.extend([[a, b, c], [a, c, d]]);
        }
    }
    made(facets)
}

fn made(facets: Vec<Facet>) -> Terrain {
    let soup = Soup::from(facets);
    let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], Vec3::zeros(), Some(1e-9)).unwrap();
    Terrain::new(welded, vec![Sheet { path: "made".into(), ground: 0, is_tree: false }])
}

fn blocks() -> Vec<Block> {
    let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
    let surfaces = [box_surface([1.5, 1.0, 0.6]), eota([1.0, 1.0, 0.5]), eota([1.0; 3])];
    let mut shapes: Vec<Shape> =
        surfaces.iter().map(|s| Shape::of(&Solid::of(s), &s.points, 0.1).unwrap()).collect();
    let half = [0.9, 0.6, 0.4];
    let corners: Vec<Vec3> =
        sphere_points().iter().map(|p| p.component_mul(&Vec3::from(half))).collect();
    shapes.push(Shape::of(&Solid::ellipsoid(half), &corners, 0.2).unwrap());
    shapes.iter().map(|shape| Block::new(shape, &rock)).collect()
}

/// Distance between block and mesh by another program (GJK): all triangles against the hull of the
/// corners at that time.
fn gap_m(terrain: &Terrain, flight: &BlockFlight, t: f64) -> f64 {
    let pose = flight.pose(t);
    let into = |p: &Vec3| Vector::new(p.x, p.y, p.z);
    let corners: Vec<Vector> =
        flight.block.core.corners.iter().map(|own| into(&pose.point(own))).collect();
    let hull = ConvexPolyhedron::from_convex_hull(&corners).unwrap();
    let place = Place::default();
    let mut nearest = f64::INFINITY;
    terrain.index.near(&pose.centre, flight.block.bound_m + 0.1, |start, count| {
        for t in start..start + count {
            let [a, b, c] = terrain.corners_m(t).map(|p| into(&p));
            let found = distance(&place, &hull, &place, &Triangle::new(a, b, c)).unwrap();
            nearest = nearest.min(found.distance);
        }
    });
    nearest - flight.block.ball_m
}

/// Random tumbling flights over peaks and ridges: nothing is touched before the time found, and at
/// that time there is a contact.
#[test]
fn no_touch_is_missed() {
    let (terrain, blocks) = (rough(), blocks());
    let asked = std::env::var("ROCKFALL_FLIGHTS").ok().and_then(|n| n.parse().ok());
    let mut near = Neighbours::default();
    let (mut touched, mut missed, mut worst) = (0, 0, 0.0_f64);
    for flight in 0..asked.unwrap_or(FLIGHTS) {
        let mut chance = stream(11, Purpose::Start, flight);
        let mut vector = |most: f64| Vec3::from([0; 3].map(|_| even(&mut chance, -most, most)));
        let block = &blocks[flight % blocks.len()];
        let (place, velocity, axis, momentum) =
            (vector(4.0), vector(12.0), vector(1.0), vector(35.0));
        // clear of the highest peak, however it is turned
        let start = Vec3::new(place.x, place.y, 2.7 + 0.3 * place.z);
        let own = momentum.component_mul(&Vec3::from(block.inertia_kg_m2));
        let attitude = turn(&Unit::new_normalize(axis), 3.0 * axis.x);
        let path = Parabola { start, velocity, gravity: 9.81, radius: block.bound_m };
        let top = Top::new(block.inertia_kg_m2, attitude, own);
        let flight = BlockFlight { block, top, path };
        let ends =
            match first_touch(&terrain, &flight, 5.0, (&mut near, &mut WindowScratch::default())) {
                FlightEnd::Touch(t) => {
                    touched += 1;
                    worst = worst.max(gap_m(&terrain, &flight, t).abs());
                    t
                }
                FlightEnd::Leaves(t) => t,
                FlightEnd::Flies => 5.0,
            };
        let is_inside =
            |k: u32| gap_m(&terrain, &flight, ends * (f64::from(k) + 0.5) / 60.0) < -1e-6;
        missed += usize::from((0..60).any(is_inside));
    }
    assert!(touched > FLIGHTS / 2, "{touched}");
    assert!(missed == 0 && worst < 1e-6, "{missed} missed, {worst:e} m off at a touch");
}

/// Distance of two lines less `ball`, times the size of `u × w`, and that size: one line through
/// two points, the other through `e` along a unit vector `w`.
fn between_lines([a, b]: [Vec3; 2], (e, w): (&Vec3, &Vec3), ball: f64) -> (f64, f64) {
    let across = (b - a).cross(w);
    ((a - e).dot(&across).abs() - ball * across.norm(), across.norm())
}

/// The search of a window of 1 s at its start.
fn search<'a>(
    (terrain, ahead): (&'a Terrain, &'a FeaturesAhead),
    flight: &'a BlockFlight<'a>,
    (corners, tested): (&'a mut CornerMotions, &'a mut u64),
) -> WindowSearch<'a> {
    corners.begin(flight.block.core.corners.len());
    let (bounds, state) = (flight.top.point_bounds(), flight.state(0.0, 1.0, &mut None));
    WindowSearch { terrain, flight, ahead, bounds, state, corners, tested }
}

/// The features ahead of a block in a window of 1 s, among all that are near.
fn features_ahead(terrain: &Terrain, flight: &BlockFlight) -> FeaturesAhead {
    let (block, mut near) = (flight.block, Neighbours::default());
    near.collect(terrain, &flight.path.start, block.ball_m, 3.0 * block.bound_m, block.ball_m);
    let mut ahead = FeaturesAhead::default();
    ahead.collect(terrain, flight, &mut near, (0.0, 1.0));
    ahead
}

/// Gaps of edges and of faces are nowhere less than their bounds, and these are close to them over
/// short times.
#[test]
fn gaps_are_no_less_than_their_bounds() {
    let (terrain, blocks) = (rough(), blocks());
    let (ahead, most, mut worst) = (FeaturesAhead::default(), 0.02, 0.0_f64);
    let mut kept = 0;
    for case in 0..400 {
        let mut chance = stream(17, Purpose::Start, case);
        let mut vector = |most: f64| Vec3::from([0; 3].map(|_| even(&mut chance, -most, most)));
        let block = &blocks[case % blocks.len()];
        let own = vector(9.0).component_mul(&Vec3::from(block.inertia_kg_m2));
        let attitude = turn(&Unit::new_normalize(vector(1.0)), 2.0);
        let (start, velocity) = (vector(1.0), vector(8.0));
        let path = Parabola { start, velocity, gravity: 9.81, radius: block.bound_m };
        let top = Top::new(block.inertia_kg_m2, attitude, own);
        let flight = BlockFlight { block, top, path };
        let (bounds, mut corners, mut tested) =
            (flight.top.point_bounds(), CornerMotions::default(), 0);
        let mut search = search((&terrain, &ahead), &flight, (&mut corners, &mut tested));
        let (e, w, point) = (vector(2.0), vector(1.0).normalize(), vector(3.0));
        let ridge = block.core.ridges[case % block.core.ridges.len()].ends.map(usize::from);
        let face = &block.core.faces[case % block.core.faces.len()];
        let flying = ridge.map(|k| search.corner_motion(k));
        let of_lines = Clearance::of_lines(&flying, block.ball_m, (&e, &w), (&bounds, most));
        let turned = |own: &Vec3| search.turned(own);
        let moving = (&search.centre(), turned);
        let plane = ((&face.normal, face.level), block.ball_m);
        let of_face = Clearance::of_own_plane(plane, &point, moving, (&bounds, most));
        let size = between_lines(flying.map(|end| end.p), (&e, &w), 0.0).1;
        for share in [0.01, 0.1, 0.4, 0.7, 1.0] {
            let pose = flight.pose(share * most);
            let height = (pose.attitude * face.normal).dot(&(point - pose.centre)) - face.level;
            assert!(of_face.at_least_m(share * most) <= height - block.ball_m + 1e-9);
            let Some(gap) = of_lines else { continue };
            let t = share * gap.valid_s;
            let pose = flight.pose(t);
            let ends = ridge.map(|k| pose.point(&block.core.corners[k]));
            let now = between_lines(ends, (&e, &w), block.ball_m).0 / size;
            // only where the lines have not met before
            if gap.open_time_s(1e-9, gap.valid_s) >= t {
                kept += 1;
                assert!(gap.at_least_m(t) <= now + 1e-9, "{case}: {share} {now} {t} {gap:?}");
                worst = worst.max(if share < 0.1 { now - gap.at_least_m(t) } else { 0.0 });
            }
        }
    }
    println!("{kept} {worst:e}");
    assert!(kept > 1000 && worst < 1e-5, "{kept} {worst:e}");
}

/// The ball of a corner that flies beside a sheet reaches through the sheet's plane, and touches
/// its border however it leaves that plane.
#[test]
fn a_corner_beside_a_sheet_comes_to_its_border() {
    let sheet = [(0.0, -5.0), (0.0, 5.0), (-8.0, 0.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let (terrain, blocks) = (made(vec![sheet]), blocks());
    let block = &blocks[0];
    let corner = Vec3::new(2.0, 0.0, 0.3) * block.ball_m;
    let start = corner - block.core.corners[0] - terrain.origin_m;
    let velocity = Vec3::new(-1.0, 0.0, 0.01);
    let path = Parabola { start, velocity, gravity: 0.0, radius: block.bound_m };
    let top = Top::new(block.inertia_kg_m2, Rotation3::identity(), Vec3::zeros());
    let flight = BlockFlight { block, top, path };
    let ahead = features_ahead(&terrain, &flight);
    let (mut corners, mut tested) = Default::default();
    let mut search = search((&terrain, &ahead), &flight, (&mut corners, &mut tested));
    let step = search.safe_step(BlockPart::Corner(0), 1.0);
    assert!(step > 0.0 && step < 2.0 * block.ball_m, "{step} {}", block.ball_m);
}

/// A weightless block that rotates low over level ground never touches it, also where times are
/// rounded.
#[test]
fn what_rounding_leaves_of_a_window_is_no_touch() {
    let [a, b, c, d] =
        [(-1e3, -1e3), (1e3, -1e3), (1e3, 1e3), (-1e3, 1e3)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let (terrain, blocks) = (made(vec![[a, b, c], [a, c, d]]), blocks());
    let (mut near, mut scratch) = (Neighbours::default(), WindowScratch::default());
    for index in 0..3000 {
        let mut chance = stream(19, Purpose::Start, index);
        let block = &blocks[0];
        let [speed, spin, height] =
            [(1.0, 4.0), (1.0, 6.0), (0.01, 0.2)].map(|(low, high)| even(&mut chance, low, high));
        let start = Vec3::z() * (block.support_m(&-Vec3::z()) + height);
        let velocity = Vec3::x() * speed;
        let path = Parabola { start, velocity, gravity: 0.0, radius: block.bound_m };
        let momentum = Vec3::z() * (spin * block.inertia_kg_m2[2]);
        let top = Top::new(block.inertia_kg_m2, Rotation3::identity(), momentum);
        let flight = BlockFlight { block, top, path };
        near.forget();
        let end = first_touch(&terrain, &flight, 3.0, (&mut near, &mut scratch));
        assert_eq!(end, FlightEnd::Flies, "{index}");
    }
}

/// A block that rotates about a peak just below one of its edges does not approach it. The ends of
/// the edge must not report an approach either, though one of them moves towards a plane through
/// the peak that is fixed to the terrain.
#[test]
fn a_block_that_turns_about_a_peak_keeps_off_it() {
    let peak = Vec3::zeros();
    let base = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let base = base.map(|(x, y)| Vec3::new(x, y, -1.0));
    let sides: Vec<Facet> = (0..4).map(|k| [base[k], base[(k + 1) % 4], peak]).collect();
    let (terrain, blocks) = (made(sides), blocks());
    let block = &blocks[0];
    // with an edge along x straight below its centre
    let attitude = turn(&Vec3::x_axis(), 0.9);
    let end = |k: u8| attitude * block.core.corners[usize::from(k)];
    let middle = |ends: [u8; 2]| (end(ends[0]) + end(ends[1])) * 0.5;
    let (edge, lowest) = block
        .core
        .ridges
        .iter()
        .map(|ridge| middle(ridge.ends))
        .enumerate()
        .min_by(|a, b| a.1.z.total_cmp(&b.1.z))
        .unwrap();
    let start = -lowest + Vec3::z() * (block.ball_m + 1e-9) - terrain.origin_m;
    // the point of the block over the peak stands still, but for parting
    let (spin, arm) = (Vec3::y(), lowest - Vec3::z() * block.ball_m);
    let velocity = Vec3::z() * 1e-6 - spin.cross(&arm);
    let path = Parabola { start, velocity, gravity: 0.0, radius: block.bound_m };
    let inertia = Vec3::from(block.inertia_kg_m2);
    let momentum = attitude * inertia.component_mul(&(attitude.inverse() * spin));
    let top = Top::new(block.inertia_kg_m2, attitude, momentum);
    let flight = BlockFlight { block, top, path };
    let ahead = features_ahead(&terrain, &flight);
    let (mut corners, mut tested) = Default::default();
    let mut search = search((&terrain, &ahead), &flight, (&mut corners, &mut tested));
    assert!(!search.ahead.edges.is_empty());
    let step = search.safe_step(BlockPart::Ridge(edge), 1.0);
    assert!(step > 1e-5, "{step:e}");
}

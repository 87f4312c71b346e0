use super::*;
use crate::body::{Shape, Solid, box_surface, eota, sphere_points};
use crate::math::turn;
use crate::random::{Purpose, RandomStream, stream, unit};
use crate::rock::Rock;
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Piece, Up, weld};
use crate::terrain::{Sheet, Terrain};
use nalgebra::Unit;
use parry3d_f64::math::{Pose as Place, Vector};
use parry3d_f64::query::distance;
use parry3d_f64::shape::{ConvexPolyhedron, Triangle};
use std::path::Path;

/// Random flights of the test; `ROCKFALL_FLIGHTS` asks for more.
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

/// Distance between block and mesh by another program (GJK): all triangles against the hull of the corners as they stand.
fn gap_m(terrain: &Terrain, tumble: &Tumble, t: f64) -> f64 {
    let pose = tumble.pose(t);
    let into = |p: &Vec3| Vector::new(p.x, p.y, p.z);
    let corners: Vec<Vector> =
        tumble.block.core.corners.iter().map(|own| into(&pose.point(own))).collect();
    let hull = ConvexPolyhedron::from_convex_hull(&corners).unwrap();
    let place = Place::default();
    let mut nearest = f64::INFINITY;
    terrain.index.near(&pose.centre, tumble.block.bound_m + 0.1, |start, count| {
        for t in start..start + count {
            let [a, b, c] = terrain.corners_m(t).map(|p| into(&p));
            let found = distance(&place, &hull, &place, &Triangle::new(a, b, c)).unwrap();
            nearest = nearest.min(found.distance);
        }
    });
    nearest - tumble.block.ball_m
}

/// Random tumbling flights over peaks and ridges: nothing is touched before the time that is found, and then it is.
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
        let tumble = Tumble { block, top, path };
        let ends =
            match first_touch(&terrain, &tumble, 5.0, (&mut near, &mut WindowScratch::default())) {
                FlightEnd::Touch(t) => {
                    touched += 1;
                    worst = worst.max(gap_m(&terrain, &tumble, t).abs());
                    t
                }
                FlightEnd::Leaves(t) => t,
                FlightEnd::Flies => 5.0,
            };
        let is_inside =
            |k: u32| gap_m(&terrain, &tumble, ends * (f64::from(k) + 0.5) / 60.0) < -1e-6;
        missed += usize::from((0..60).any(is_inside));
    }
    assert!(touched > FLIGHTS / 2, "{touched}");
    assert!(missed == 0 && worst < 1e-6, "{missed} missed, {worst:e} m off at a touch");
}

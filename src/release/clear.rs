//! Room for a rock where it starts.

use crate::flight::{FlightEnd, Parabola, time_of_impact};
use crate::rock::Vec3;
use crate::terrain::Terrain;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Triangle;

/// A rock over steep ground may be in it although its lowest point is clear: then it is lifted, straight up, until it
/// just touches. The place itself where it is clear already, or where no such height is near.
pub(super) fn clear_of(terrain: &Terrain, centre: Vec3, radius_m: f64) -> Vec3 {
    if distance_m(terrain, &centre, radius_m) >= radius_m {
        return centre;
    }
    let start = centre + Vec3::z() * (LIFT * radius_m);
    let down = Parabola { start, velocity: -Vec3::z(), gravity: 0.0, radius: radius_m };
    match time_of_impact(terrain, &down, LIFT * radius_m, &mut 0) {
        FlightEnd::Touch(way_m) if way_m > 0.0 => start - Vec3::z() * way_m,
        _ => centre,
    }
}

/// A rock in steep ground is lifted by up to this many radii (–): enough for slopes up to 80°.
const LIFT: f64 = 6.0;

/// Distance from a point to the nearest triangle (m), or `reach_m` when none is nearer.
pub(super) fn distance_m(terrain: &Terrain, point: &Vec3, reach_m: f64) -> f64 {
    let mut nearest = reach_m;
    terrain.index.near(point, reach_m, |start, count| {
        for triangle in start..start + count {
            let [a, b, c] = terrain.corners_m(triangle).map(Into::into);
            let distance = Triangle::new(a, b, c).distance_to_local_point((*point).into(), true);
            nearest = nearest.min(distance);
        }
    });
    nearest
}

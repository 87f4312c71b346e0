//! Places before a face that is too steep for rocks to start over it.

use super::Terrain;
use super::cliffs::Cliff;
use crate::rock::Vec3;

/// Cosine of the mean slope from which on a face is a wall: 75°, where a rock above its place is lifted by three radii (–).
const WALL_COSINE: f64 = 0.258_819;
/// Steps away from a wall (m), and how many: no middle of a face lies deeper in it.
const STEP_M: f64 = 0.25;
const MOST_STEPS: u32 = 200;

/// Places before a wall, at the height of its middle, from which all ground is so far (m), in map coordinates to a decimal;
/// empty where the face is no wall, or leaves no room.
pub fn places_before(terrain: &Terrain, cliff: &Cliff, room_m: f64) -> Vec<[f64; 3]> {
    if cliff.normal.z >= WALL_COSINE {
        return Vec::new();
    }
    let level = cliff.normal.xy().norm();
    let outward = Vec3::new(cliff.normal.x / level, cliff.normal.y / level, 0.0);
    let place = |at: &[f64; 3]| {
        let steps = (0..MOST_STEPS).map(|k| Vec3::from(*at) + outward * (STEP_M * f64::from(k)));
        let mut places = steps.map(|at| at.map(|x| (10.0 * x).round() / 10.0));
        let found = places.find(|at| has_room(terrain, &(at - terrain.origin_m), room_m));
        found.map(Into::into)
    };
    cliff.line_m.iter().filter_map(place).collect()
}

/// Whether a rock starts clear of ground and trees there, and with ground below it.
fn has_room(terrain: &Terrain, centre: &Vec3, radius_m: f64) -> bool {
    terrain.distance_m(centre, radius_m) >= radius_m
        && !terrain.is_under_slope(centre)
        && terrain.ground_below(centre.x, centre.y).is_some()
}

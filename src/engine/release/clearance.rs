//! Clearance of a rock at its start.

use super::{Release, Releases, TYPED_DEPTH, release_name};
use crate::error::{Error, Result};
use crate::flight::{FlightEnd, Parabola, time_of_impact};
use crate::groups::Groups;
use crate::math;
use crate::rock::{Motion, Vec3};
use crate::terrain::Terrain;
use std::f64::consts::TAU;

/// The centre of a rock, lifted straight up until it just touches: over steep ground a rock may be
/// in it although its lowest point is clear. The place itself if it is clear already, or if no
/// clear height is near.
pub(super) fn lifted_clear(terrain: &Terrain, centre: Vec3, radius_m: f64) -> Vec3 {
    if terrain.distance_m(&centre, radius_m) >= radius_m {
        return centre;
    }
    let start = centre + Vec3::z() * (MAX_LIFT * radius_m);
    let down = Parabola { start, velocity: -Vec3::z(), gravity: 0.0, radius: radius_m };
    match time_of_impact(terrain, &down, MAX_LIFT * radius_m, &mut 0) {
        FlightEnd::Touch(way_m) if way_m > 0.0 => start - Vec3::z() * way_m,
        _ => centre,
    }
}

/// Largest lift of a rock in steep ground, in radii (–): enough for slopes up to 80°.
const MAX_LIFT: f64 = 6.0;

impl Releases {
    /// Refuses a rock that starts deeper in ground or tree than its weight would press it.
    pub(super) fn check_clear(
        &self,
        terrain: &Terrain,
        (index, around_m): (usize, f64),
        release: &Release,
    ) -> Result<()> {
        let Release { rock, motion: Motion { position_m: centre, .. }, grounds } = release;
        let stiffness = grounds.iter().map(|ground| ground.normal_stiffness_n_m);
        let pressed_m =
            rock.mass_kg() * self.gravity_m_s2 / stiffness.fold(f64::INFINITY, f64::min);
        let depth_m = around_m - terrain.distance_m(centre, around_m);
        // beyond the edge there is no ground above it
        let buried = terrain.is_under_slope(centre);
        let inside_tree = is_inside_tree(terrain, centre);
        let is_deep = depth_m > 2.0 * pressed_m + TYPED_DEPTH * around_m;
        if !(is_deep || buried || inside_tree) {
            return Ok(());
        }
        let [x, y, z]: [f64; 3] = (centre + terrain.origin_m).into();
        let who = format!("{} at ({x}, {y}, {z})", release_name(index));
        let found = if buried {
            "found its centre under the terrain".to_owned()
        } else if is_deep {
            format!("found it {depth_m:.2e} m deep in the ground or a tree")
        } else {
            "found its centre inside a tree".to_owned()
        };
        let remedy = format!(
            "write a higher place, or another: a rock of radius {around_m} m needs its centre that far from every triangle"
        );
        Err(Error::input(&self.file, who, found, remedy))
    }
}

/// Whether a rock is in the slope: it was to be lifted, but no height near its place is clear. A
/// tree beside it does not count.
pub(super) fn is_in_slope(terrain: &Terrain, centre: &Vec3, radius_m: f64) -> bool {
    let reach_m = radius_m * (1.0 - TYPED_DEPTH);
    terrain.slope_distance_m(centre, reach_m) < reach_m
}

/// Whether a point is inside a tree, hollow or not: in every horizontal direction there is the same
/// connected part of the trees' triangles. Walls that do not join enclose nothing.
pub(super) fn is_inside_tree(terrain: &Terrain, point: &Vec3) -> bool {
    if terrain.sheets.iter().all(|sheet| !sheet.is_tree) {
        return false;
    }
    let directions: [Vec3; DIRECTIONS] = std::array::from_fn(|k| {
        // not along the axes, as the sides of made stems are
        let (sin, cos) = math::sin_cos(TAU * (k as f64 + 0.37) / DIRECTIONS as f64);
        Vec3::new(cos, sin, 0.0) * TREE_SEARCH_M
    });
    let mut near = Vec::new();
    terrain.index.near(point, TREE_SEARCH_M, |start, count| {
        near.extend((start..start + count).filter(|&t| terrain.is_tree(t)));
    });
    let mut parts = Groups::of(near.len());
    let mut first_at = std::collections::BTreeMap::new();
    for (k, &t) in near.iter().enumerate() {
        for vertex in terrain.triangles[t as usize] {
            parts.join(k as u32, *first_at.entry(vertex).or_insert(k as u32));
        }
    }
    let is_met = |part: &[u32], direction: &Vec3| {
        part.iter().any(|&k| {
            let corners = terrain.corners_m(near[k as usize]).map(|corner| corner - point);
            is_crossed(&corners, direction)
        })
    };
    parts.lists().iter().any(|part| directions.iter().all(|direction| is_met(part, direction)))
}

/// Search distance (m): no tree is thicker than twice this.
const TREE_SEARCH_M: f64 = 4.0;
/// Number of horizontal directions searched.
const DIRECTIONS: usize = 12;

/// Whether the segment from the origin to `end` passes through a triangle.
fn is_crossed([a, b, c]: &[Vec3; 3], end: &Vec3) -> bool {
    // signs of the volumes that the segment spans with the sides
    let sides = [a.cross(b).dot(end), b.cross(c).dot(end), c.cross(a).dot(end)];
    let is_through = sides.iter().all(|x| *x >= 0.0) || sides.iter().all(|x| *x <= 0.0);
    let n = (b - a).cross(&(c - a));
    let (height, reach) = (n.dot(a), n.dot(end));
    is_through && reach != 0.0 && (0.0..=1.0).contains(&(height / reach))
}

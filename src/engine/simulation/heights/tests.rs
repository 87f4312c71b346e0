use super::super::rock_geometry::{AttitudePath, BlockRotation};
use super::*;
use crate::body::{Block, Shape, Solid, box_surface, eota};
use crate::flight::top::Top;
use crate::flight::{FlightEnd, time_of_impact};
use crate::random::{Purpose, RandomStream, stream, unit};
use crate::rock::{Motion, Rock, Vec3};
use crate::terrain::Sheet;
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Piece, Up, weld};
use nalgebra::{Rotation3, UnitQuaternion};
use std::path::Path;

const ROCK: Rock = Rock { radius_m: 0.4, density_kg_m3: 2700.0 };
/// Flights of each test.
const FLIGHTS: usize = 400;
/// Time between two samples (s).
const STEP_S: f64 = 1e-4;
/// Samples may be higher by this (m): rounding of the heights of steep triangles.
const ROUNDING_M: f64 = 1e-9;

fn terrain(facets: Vec<Facet>) -> Terrain {
    let soup = Soup::from(facets);
    let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], Vec3::zeros(), Some(1e-9)).unwrap();
    Terrain::new(welded, vec![Sheet { path: "made".into(), ground: 0, is_tree: false }])
}

fn even(chance: &mut RandomStream, low: f64, high: f64) -> f64 {
    low + (high - low) * unit(chance)
}

/// A triangulated grid over x and y, each given line by line, without the cells for which
/// `leaves_out` is true at their south-western corner.
fn lattice(
    [x, y]: [&[f64]; 2],
    mut height_m: impl FnMut(f64, f64) -> f64,
    leaves_out: impl Fn(f64, f64) -> bool,
) -> Vec<Facet> {
    let rows: Vec<Vec<Vec3>> =
        y.iter().map(|&y| x.iter().map(|&x| Vec3::new(x, y, height_m(x, y))).collect()).collect();
    let mut facets = Vec::new();
    for pair in rows.windows(2) {
        for k in 0..x.len() - 1 {
            let [a, b, c, d] = [pair[0][k], pair[0][k + 1], pair[1][k + 1], pair[1][k]];
            if !leaves_out(a.x, a.y) {
                facets.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    facets
}

/// Lines from `low` to `high`, `count` cells.
fn lines(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|k| low + (high - low) * k as f64 / count as f64).collect()
}

/// 40 m by 40 m, sloping towards +x at 30°, with corners up to 1 m up or down; the cells that are
/// left out are holes.
fn rough(leaves_out: impl Fn(f64, f64) -> bool) -> Vec<Facet> {
    let mut chance = stream(3, Purpose::Place, 0);
    let line = lines(-20.0, 20.0, 27);
    lattice([&line, &line], |x, _| -0.577 * x + even(&mut chance, -1.0, 1.0), leaves_out)
}

/// A wall of 88° from z = 50 m down to 0 in strips, at x from 0 to 1.746 m; level above, uneven
/// below.
fn wall() -> Vec<Facet> {
    let mut chance = stream(4, Purpose::Place, 0);
    let tan = 50.0 / 1.746;
    let x: Vec<f64> = [lines(-20.0, 0.0, 8), lines(0.0, 1.746, 3), lines(1.746, 60.0, 40)].concat();
    let x: Vec<f64> = x.windows(2).filter(|w| w[0] < w[1]).map(|w| w[0]).chain([60.0]).collect();
    let foot =
        |x: f64, chance: &mut RandomStream| if x > 2.0 { even(chance, -0.5, 0.5) } else { 0.0 };
    let height = |x: f64, _| 50.0 - tan * x.clamp(0.0, 1.746) + foot(x, &mut chance);
    lattice([&x, &lines(-20.0, 20.0, 25)], height, |_, _| false)
}

/// Rough ground, and roofs over it: a tilted one 6 m up, one that intersects it, and one that
/// intersects the ground.
fn roofs() -> Vec<Facet> {
    let roof = |at: [f64; 2], half: f64, height_m: fn(f64, f64) -> f64| {
        let [x, y] = at.map(|at| lines(at - half, at + half, 3));
        lattice([&x, &y], height_m, |_, _| false)
    };
    let mut facets = rough(|_, _| false);
    facets.extend(roof([-3.0, 2.0], 4.1, |x, y| 8.0 - 0.3 * x + 0.2 * y));
    facets.extend(roof([-1.0, 1.0], 3.3, |x, y| 8.0 + 0.3 * x - 0.1 * y));
    facets.extend(roof([9.0, -6.0], 3.7, |x, _| -4.0 + 0.4 * (x - 9.0)));
    facets
}

/// The flight of a block or a sphere up to its contact; or a short path over which a block rotates
/// as in a step in contact.
struct Flown {
    path: Parabola,
    top: Option<Top>,
    turns: Option<[BlockRotation; 2]>,
    duration_s: f64,
}

/// A flight from a random point over the terrain or a little beside it, up to `over_m` above the
/// ground and up to `fast_m_s` fast.
fn thrown(
    terrain: &Terrain,
    block: Option<&Block>,
    (over_m, fast_m_s): (f64, f64),
    chance: &mut RandomStream,
) -> Option<Flown> {
    let (low, high) = terrain.index.bounds();
    let at = [0, 1].map(|k| even(chance, low[k] - 1.0, high[k] + 1.0));
    // under a roof as well as over it
    let under = even(chance, low.z, high.z + 10.0);
    let ground = terrain.ground_under(at[0], at[1], under).unwrap_or(high.z);
    let radius = block.map_or(ROCK.radius_m, |block| block.bound_m);
    let z = ground + radius + over_m * unit(chance);
    let start = Vec3::new(at[0], at[1], z);
    let speed = |chance: &mut RandomStream| even(chance, -fast_m_s, fast_m_s);
    let velocity = Vec3::new(speed(chance), speed(chance), 0.5 * speed(chance));
    let path = Parabola { start, velocity, gravity: 9.81, radius };
    if terrain.distance_m(&start, radius) < radius {
        return None;
    }
    let duration_s = match time_of_impact(terrain, &path, 5.0, &mut 0) {
        FlightEnd::Touch(t) => t,
        // and on past the last ground
        FlightEnd::Leaves(t) => t + 1.0,
        FlightEnd::Flies => 5.0,
    };
    let top = block.map(|block| {
        let axis = Vec3::new(unit(chance) - 0.5, unit(chance) - 0.5, unit(chance) - 0.5);
        let turn: Rotation3<f64> = UnitQuaternion::new(axis * 6.0).to_rotation_matrix();
        let own = Vec3::new(unit(chance) - 0.5, unit(chance) - 0.5, unit(chance) - 0.5) * 30.0;
        Top::new(
            block.inertia_kg_m2,
            turn,
            turn * own.component_mul(&Vec3::from(block.inertia_kg_m2)),
        )
    });
    Some(Flown { path, top, turns: None, duration_s })
}

/// Compares the largest heights of some parts of a flight with the largest of their samples;
/// returns how much higher they are (m).
fn compare(terrain: &Terrain, block: Option<&Block>, flown: &Flown) -> f64 {
    let geometry = RockGeometry { rock: ROCK, block };
    let start = Motion {
        time_s: 7.0,
        position_m: flown.path.start,
        velocity_m_s: flown.path.velocity,
        spin_rad_s: Vec3::zeros(),
    };
    let Flown { path, top, turns, duration_s } = flown;
    let step = turns.as_ref().map(|[from, to]| AttitudePath::Step([from, to]));
    let attitude_path = step.or(top.as_ref().map(AttitudePath::Top));
    let flight = RockFlight { start, path, attitude_path, duration_s: *duration_s };
    let heights = Heights { terrain, geometry: &geometry, flight: &flight };
    let sample = |t: f64| {
        let at = flight.at(t);
        let centre = at.motion.position_m;
        let ground = terrain.ground_under(centre.x, centre.y, centre.z)?;
        Some(centre.z - geometry.depth_below_centre_m(&at) - ground)
    };
    let error_m = if block.is_some() { ERROR_M } else { 0.0 } + ROUNDING_M;
    let mut more_m = 0.0_f64;
    for [from, to] in [[0.0, 1.0], [0.0, 0.3], [0.45, 0.61], [0.9, 1.0], [0.5, 0.5]] {
        let [from_s, to_s] = [from * duration_s, to * duration_s];
        let count = ((to_s - from_s) / STEP_S).ceil().max(1.0) as u32;
        let samples = (0..=count)
            .filter_map(|k| sample(from_s + (to_s - from_s) * f64::from(k) / f64::from(count)));
        let sampled_m = samples.reduce(f64::max);
        let found = heights.largest([from_s, to_s], f64::NEG_INFINITY);
        let Some(sampled_m) = sampled_m else {
            // less than one sample of the path is over ground
            assert!(found.is_none_or(|top| top.height_m < 50.0), "{found:?} {path:?}");
            continue;
        };
        let top = found.unwrap_or_else(|| panic!("nothing but {sampled_m} in {path:?}"));
        assert!(top.height_m >= sampled_m - error_m, "{top:?} {sampled_m} {path:?}");
        // the rock has this height then, or just beside: behind a brink it is the limit of the
        // heights
        assert!(from_s <= top.time_s && top.time_s <= to_s, "{top:?}");
        let beside = [-2e-6, -1e-9, 0.0, 1e-9, 2e-6].map(|off| sample(top.time_s + off));
        let near = |height: &f64| (height - top.height_m).abs() < 2e-3;
        assert!(beside.iter().flatten().any(near), "{top:?} {beside:?} {path:?}");
        more_m = more_m.max(top.height_m - sampled_m);
        // with a lower known height it is found again, with a higher one nothing is found
        let again = heights.largest([from_s, to_s], sampled_m - 0.1);
        assert!(again.is_some_and(|again| again.height_m >= sampled_m - error_m), "{again:?}");
        assert_eq!(heights.largest([from_s, to_s], top.height_m + error_m), None, "{top:?}");
    }
    more_m
}

/// Largest difference between the heights found and those of samples over many flights (m).
fn compared(facets: Vec<Facet>, block: Option<&Block>, flights: usize) -> f64 {
    let terrain = terrain(facets);
    let mut chance = stream(11, Purpose::Shape, 1);
    let (mut seen, mut more_m) = (0, 0.0_f64);
    while seen < flights {
        // low and high, slow and fast, steep and flat
        let over_m = [0.1, 2.0, 12.0][seen % 3];
        let fast_m_s = [0.5, 4.0, 25.0][seen / 3 % 3];
        if let Some(flown) = thrown(&terrain, block, (over_m, fast_m_s), &mut chance) {
            more_m = more_m.max(compare(&terrain, block, &flown));
            seen += 1;
        }
    }
    more_m
}

#[test]
fn over_rough_ground_no_sample_is_higher() {
    let more_m = compared(rough(|_, _| false), None, FLIGHTS);
    // slopes up to 60° or so under 25 m/s, half of a sample's time
    assert!(more_m < 1e-2, "{more_m}");
}

#[test]
fn beside_a_wall_no_sample_is_higher() {
    let more_m = compared(wall(), None, FLIGHTS);
    // 28.6 m of wall per metre of path, 2.5 mm of path between two samples
    assert!(more_m > 1e-3 && more_m < 0.1, "{more_m}");
}

#[test]
fn under_and_over_roofs_no_sample_is_higher() {
    let more_m = compared(roofs(), None, FLIGHTS);
    assert!(more_m < 1e-2, "{more_m}");
}

#[test]
fn over_holes_and_borders_no_sample_is_higher() {
    let is_hole = |x: f64, y: f64| x.abs() < 4.0 && y.abs() < 6.0 || x > 11.0 && y > 11.0;
    let more_m = compared(rough(is_hole), None, FLIGHTS);
    assert!(more_m < 1e-2, "{more_m}");
}

#[test]
fn no_sample_of_a_block_is_higher() {
    for (surface, facets) in [
        (box_surface([1.0, 0.7, 0.4]), wall()),
        (eota([1.0, 1.0, 0.5]), roofs()),
        (box_surface([1.0, 0.3, 0.3]), rough(|_, _| false)),
    ] {
        let shape = Shape::of(&Solid::of(&surface), &surface.points, 0.1).unwrap();
        let block = Block::new(&shape, &ROCK);
        let more_m = compared(facets, Some(&block), FLIGHTS / 10);
        assert!(more_m < 0.1, "{more_m}");
    }
}

/// In contact a block rotates by up to 0.3 rad a step, while another corner becomes the lowest.
#[test]
fn no_sample_of_a_step_in_contact_is_higher() {
    let surface = box_surface([1.0, 0.7, 0.4]);
    let shape = Shape::of(&Solid::of(&surface), &surface.points, 0.1).unwrap();
    let block = Block::new(&shape, &ROCK);
    let terrain = terrain(rough(|_, _| false));
    let mut chance = stream(12, Purpose::Shape, 2);
    let mut seen = 0;
    while seen < FLIGHTS {
        let Some(flown) = thrown(&terrain, Some(&block), (0.1, 4.0), &mut chance) else { continue };
        let turn = |chance: &mut RandomStream, size: f64| {
            let axis = [(); 3].map(|()| unit(chance) - 0.5);
            UnitQuaternion::new(Vec3::from(axis) * size).to_rotation_matrix()
        };
        let attitude = turn(&mut chance, 6.0);
        let rotation = |attitude| BlockRotation { attitude, rotational_j: 0.0 };
        let turns = [rotation(attitude), rotation(turn(&mut chance, 0.35) * attitude)];
        let duration_s = flown.duration_s.min(0.03);
        compare(
            &terrain,
            Some(&block),
            &Flown { top: None, turns: Some(turns), duration_s, ..flown },
        );
        seen += 1;
    }
}

/// Highest point of a sphere over a terrain; the coordinates are those of its facets.
fn sphere(terrain: &Terrain, path: &Parabola, duration_s: f64) -> Option<HighPoint> {
    let path = &Parabola { start: path.start - terrain.origin_m, ..*path };
    let geometry = RockGeometry { rock: ROCK, block: None };
    let (position_m, velocity_m_s) = (path.start, path.velocity);
    let start = Motion { time_s: 0.0, position_m, velocity_m_s, spin_rad_s: Vec3::zeros() };
    let flight = RockFlight { start, path, attitude_path: None, duration_s };
    Heights { terrain, geometry: &geometry, flight: &flight }
        .largest([0.0, duration_s], f64::NEG_INFINITY)
}

/// Straight up and down over a corner, along an edge, over a fan of more triangles than are
/// evaluated together, without gravity, and where no ground is below.
#[test]
fn a_flight_over_corners_and_edges_has_its_height() {
    let fan = |k: u32| {
        let rim = |k: u32| {
            let (sin, cos) = math::sin_cos(f64::from(k % 300) * std::f64::consts::TAU / 300.0);
            Vec3::new(10.0 * cos, 10.0 * sin, -10.0)
        };
        [Vec3::zeros(), rim(k), rim(k + 1)]
    };
    let cone = terrain((0..300).map(fan).collect());
    let path = |start: [f64; 3], velocity: [f64; 3], gravity: f64| Parabola {
        start: start.into(),
        velocity: velocity.into(),
        gravity,
        radius: ROCK.radius_m,
    };
    let height = |path: &Parabola| sphere(&cone, path, 1.0).unwrap().height_m;
    // up for 0.5 s: 10/8 m more than the start
    let up = height(&path([0.0, 0.0, 1.0], [0.0, 0.0, 5.0], 10.0));
    let up_only = sphere(&cone, &path([0.0, 0.0, 1.0], [0.0, 0.0, 5.0], 10.0), 0.5).unwrap();
    assert!((up_only.height_m - up).abs() < 1e-9, "{up_only:?}");
    assert!((up - (1.0 - 0.4 + 1.25)).abs() < 1e-9, "{up}");
    let beside = height(&path([3.0, 0.0, 1.0], [0.0, 0.0, 5.0], 10.0));
    assert!((beside - (4.0 - 0.4 + 1.25)).abs() < 1e-9, "{beside}");
    // over the top along an edge, level: highest where the cone is lowest
    let level = height(&path([-4.0, 0.0, 1.0], [9.0, 0.0, 0.0], 0.0));
    assert!((level - (1.0 - 0.4 + 5.0)).abs() < 1e-9, "{level}");
    // a straight path down beside an edge where the flank falls as fast: the same height everywhere
    let along = height(&path([1.0, 1e-3, 1.0], [3.0, 0.0, -3.0], 0.0));
    let lower = 1e-3 * math::tan(std::f64::consts::PI / 300.0);
    assert!((along - (2.0 - 0.4 + lower)).abs() < 1e-9, "{along}");
    let still = height(&path([0.0, 0.0, 1.0], [0.0; 3], 0.0));
    assert!((still - 0.6).abs() < 1e-9, "{still}");
    assert_eq!(sphere(&cone, &path([30.0, 0.0, 1.0], [1.0, 0.0, 0.0], 10.0), 1.0), None);
    // below the mesh there is no ground
    assert_eq!(sphere(&cone, &path([5.0, 0.0, -9.0], [0.0, 1.0, 0.0], 10.0), 0.3), None);
}

/// A pile of more sheets than are evaluated together: the uppermost is the ground.
#[test]
fn of_a_pile_of_sheets_the_uppermost_counts() {
    let sheet = |k: u32| {
        let z = f64::from(k) / 10.0;
        let [a, b, c, d] =
            [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]].map(|[x, y]| Vec3::new(x, y, z));
        [[a, b, c], [a, c, d]]
    };
    let pile = terrain((0..30).flat_map(sheet).collect());
    let start = Vec3::new(-2.9, 0.3, 4.0);
    let path = Parabola {
        start,
        velocity: Vec3::new(5.0, 0.1, 2.0),
        gravity: 10.0,
        radius: ROCK.radius_m,
    };
    let top = sphere(&pile, &path, 0.6).unwrap();
    // 0.2 m of climb over the sheet at 2.9 m; the middles of pieces of a millimetre
    assert!((top.height_m - (4.2 - 0.4 - 2.9)).abs() < 1e-6, "{top:?}");
}

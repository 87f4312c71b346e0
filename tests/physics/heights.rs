//! The largest height of a rock against every point of its path, in flight and in contact.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rockfall::plan::Plan;
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::simulation::{PathState, Scratch, simulate_release};
use rockfall::terrain::stl::{Facet, write_binary};
use std::path::Path;

/// Releases on the slope in Tyrol, with a path point every 4 ms; what differs is put in for `SHAPE` and `GROUND`.
const SCENE: &str = r#"
title = "heights"
seed = 5
origin_m = [177233.32, 377092.44, 0.0]

[[terrain]]
mesh = "../terrain/tyrol.stl"
ground = "rock"

[grounds.rock]
normal_stiffness_n_m = 1e8
shear_stiffness_n_m = 2.5e7
friction_angle_deg = 38.0
GROUND

[rocks]
density_kg_m3 = 2700.0
radius_m = 0.6
SHAPE

[release]
count = 300
height_m = 0.1
velocity_m_s = [0.0, 0.0, 0.0]
spin_rad_s = [0.0, 0.0, 0.0]
polygon_m = [[177333.32, 377242.44], [177533.32, 377242.44], [177533.32, 377292.44], [177333.32, 377292.44]]

[solver]
scheme = "rigid"
longest_s = 4.0

[record]
paths = 300
path_step_s = 0.004
profile_step_m = 3.0

[maps]
cell_m = 2.0
"#;

/// A scene of blocks or spheres on a ground.
fn plan(shape: &str, ground: &str) -> Plan {
    let text = SCENE.replace("SHAPE", shape).replace("GROUND", ground);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/heights.toml");
    Plan::of_scene(&Scene::parse(&text, &file).unwrap()).unwrap()
}

/// How many of some rocks have a path point that is higher over the ground than their largest height, and by how much (m).
fn higher(shape: &str, ground: &str) -> (usize, f64) {
    let plan = plan(shape, ground);
    let mut scratch = Scratch::default();
    let (mut rocks, mut most_m) = (0, 0.0_f64);
    for index in 0..plan.count {
        let fall = simulate_release(&plan, index, None, &mut scratch).unwrap();
        let heights = fall.path.iter().map(|point| point.clearance_m);
        let more_m = heights.fold(0.0, f64::max) - fall.extremes.height_m;
        // within a step a block turns between two attitudes, and its lowest point is known to a millimetre
        rocks += usize::from(more_m > 1e-3);
        most_m = most_m.max(more_m);
    }
    (rocks, most_m)
}

/// A plate that leans out over steep ground, still in contact, stood up to 0.16 m higher than its largest height, 20 of 300.
#[test]
fn no_point_of_a_plate_is_higher_than_its_largest_height() {
    let plate = "[[rocks.shapes]]\nkind = \"box\"\naxes = [1.0, 0.6, 0.3]\ncorner_radius = 0.1";
    let found = higher(plate, "restitution = 0.2\nroughness_deg = 10.0");
    assert_eq!(found.0, 0, "{found:?}");
}

/// A sphere that rolls from a slope onto a steeper one has more room straight below it.
#[test]
fn no_point_of_a_rolling_sphere_is_higher_than_its_largest_height() {
    let found = higher("", "restitution = 0.0\nrolling_friction = 0.3");
    assert_eq!(found.0, 0, "{found:?}");
}

/// In every cell of the maps and every stretch of the profile a rock is as high as its path there, in flight as in contact. Steps
/// that could raise a height by a millimetre are not looked at, a block's height is found to another, and it turns within a step: how many points are higher than cell and stretch say, and by how much (m).
fn higher_than_its_place(shape: &str, ground: &str) -> [(usize, f64); 2] {
    let plan = plan(shape, ground);
    let grid = plan.recorders().cells.unwrap();
    let step_m = plan.recorders().profile_step_m.unwrap();
    let mut scratch = Scratch::default();
    let mut higher = [(0, 0.0_f64); 2];
    for index in 0..plan.count {
        let fall = simulate_release(&plan, index, None, &mut scratch).unwrap();
        let start = fall.start.position_m;
        for point in &fall.path {
            let at = point.motion.position_m;
            let [column, row] = grid.place(at.x, at.y).map(|place| place.floor() as i64);
            let cell = grid.cell(column, row).unwrap();
            let in_cell = fall.passages.iter().find(|one| one.cell == cell).unwrap().height_m;
            let number = ((at.x - start.x).hypot(at.y - start.y) / step_m) as u32;
            let in_stretch = fall.stretches.iter().find(|one| one.number == number).unwrap();
            for (known_m, (points, most_m)) in
                [in_cell, in_stretch.height_m].into_iter().zip(&mut higher)
            {
                let more_m = point.clearance_m - known_m;
                *points += usize::from(more_m > 3e-3);
                *most_m = most_m.max(more_m);
            }
        }
    }
    higher
}

/// Cells and stretches in which a rock only rolled had a height of 0.
#[test]
fn cells_and_stretches_are_as_high_as_the_path_in_them() {
    let found = higher_than_its_place("", "restitution = 0.0\nrolling_friction = 0.3");
    assert_eq!(found.map(|(points, _)| points), [0, 0], "{found:?}");
    let plate = "[[rocks.shapes]]\nkind = \"box\"\naxes = [1.0, 0.6, 0.3]\ncorner_radius = 0.1";
    let found = higher_than_its_place(plate, "restitution = 0.2\nroughness_deg = 10.0");
    assert_eq!(found.map(|(points, _)| points), [0, 0], "{found:?}");
}

/// A slope of 30° over 120 m, so wide.
fn strip(wide_m: f64) -> [Facet; 2] {
    let corners = [[0.0, 0.0, 60.0], [wide_m, 0.0, 60.0], [wide_m, 120.0, 0.0], [0.0, 120.0, 0.0]];
    [[0, 1, 2], [0, 2, 3]].map(|facet| facet.map(|k| Vec3::from(corners[k])))
}

/// Rocks of a strip of 6 km cross it and do not run along it: its profile had stretches of 100 m. Where the terrain is as long as it is
/// wide, a stretch stays a fiftieth of its diagonal.
#[test]
fn the_profile_of_a_strip_is_that_of_its_slope() {
    let step_m = |wide_m: f64| {
        let dir = tempfile::tempdir().unwrap();
        write_binary(&dir.path().join("slope.stl"), &strip(wide_m)).unwrap();
        let text = SCENE
            .replace("SHAPE", "")
            .replace("GROUND", "restitution = 0.3\nrolling_friction = 0.2")
            .replace("../terrain/tyrol.stl", "slope.stl")
            .replace("origin_m = [177233.32, 377092.44, 0.0]", "")
            .replace("profile_step_m = 3.0", "");
        let (before, after) = text.split_once("polygon_m").unwrap();
        let (_, after) = after.split_once('\n').unwrap();
        let text = format!("{before}line_m = [[20.0, 5.0], [90.0, 5.0]]\n{after}");
        let scene = Scene::parse(&text, &dir.path().join("strip.toml")).unwrap();
        Plan::of_scene(&scene).unwrap().recorders().profile_step_m.unwrap()
    };
    let steps_m = [120.0, 300.0, 6000.0].map(step_m);
    assert_eq!(steps_m.map(|step_m| step_m as u32), [2, 2, 10]);
}

/// A rock is in every stretch as fast as at each point of its path there, and has in flight in every cell as much energy: also where it
/// rises over the edge of a cell and leaves it slower than it came, or slows down in contact.
#[test]
fn a_rock_is_as_fast_in_its_stretches_and_cells_as_on_its_path() {
    let plan = plan("", "restitution = 0.6\nrolling_friction = 0.4");
    let grid = plan.recorders().cells.unwrap();
    let step_m = plan.recorders().profile_step_m.unwrap();
    let mut scratch = Scratch::default();
    let (mut points, mut faster) = (0, [0; 2]);
    for index in 0..plan.count {
        let fall = simulate_release(&plan, index, None, &mut scratch).unwrap();
        let start = fall.start.position_m;
        for point in &fall.path {
            let (motion, is_flying) = (&point.motion, point.state == PathState::Flight);
            let at = motion.position_m;
            let [column, row] = grid.place(at.x, at.y).map(|place| place.floor() as i64);
            let cell = grid.cell(column, row).unwrap();
            let in_cell = fall.passages.iter().find(|one| one.cell == cell).unwrap();
            let number = ((at.x - start.x).hypot(at.y - start.y) / step_m) as u32;
            let in_stretch = fall.stretches.iter().find(|one| one.number == number).unwrap();
            let total_j = motion.translational_j(&fall.rock) + motion.rotational_j(&fall.rock);
            // but for rounding
            faster[0] += usize::from(is_flying && total_j > in_cell.total_j * (1.0 + 1e-9));
            let speed_m_s = motion.velocity_m_s.norm();
            // in contact the way bends within a step, and the speed is not even: a stretch is known to a thousandth
            let known = if is_flying { 1.0 + 1e-9 } else { 1.001 };
            faster[1] += usize::from(speed_m_s > in_stretch.speed_m_s * known);
            points += usize::from(is_flying);
        }
    }
    assert!(points > 10_000, "{points} points in flight");
    assert_eq!(faster, [0, 0], "points above the energy of a cell and the speed of a stretch");
}

/// A rock rolls up a plane, or out on the level, in steps as long as several cells: in each it is as fast as where it enters it, by `7/10 m v²` that height
/// and rolling friction take, and in each stretch likewise.
#[test]
fn a_rolling_rock_is_as_fast_in_a_cell_as_where_it_enters_it() {
    for (scheme, degrees) in [("adaptive", 27.0_f64), ("rigid", 27.0), ("adaptive", 0.0)] {
        let slope = degrees.to_radians().tan();
        let at = |x: f64, y: f64| Vec3::new(x, y, slope * y);
        let [a, b, c, d] = [at(0.0, 0.0), at(60.0, 0.0), at(60.0, 60.0), at(0.0, 60.0)];
        let dir = tempfile::tempdir().unwrap();
        write_binary(&dir.path().join("plane.stl"), &[[a, b, c], [a, c, d]]).unwrap();
        let friction = if degrees > 0.0 { "" } else { "rolling_friction = 0.3\n" };
        let (cos, r) = (degrees.to_radians().cos(), 1.0);
        let z = slope * 10.5 + r / cos;
        let speed = [12.0 * cos, 12.0 * degrees.to_radians().sin()];
        let text = format!(
            "title = \"t\"\nseed = 1\ngravity_m_s2 = 9.81\n[[terrain]]\nmesh = \"plane.stl\"\nground = \"rock\"\n\
             [grounds.rock]\nnormal_stiffness_n_m = 1e9\nshear_stiffness_n_m = 2.5e8\nfriction_angle_deg = 60.0\n\
             restitution = 0.0\n{friction}[rocks]\ndensity_kg_m3 = 2700.0\nradius_m = {r}\n[release]\ncount = 1\n\
             velocity_m_s = [0.0, {}, {}]\nspin_rad_s = [-12.0, 0.0, 0.0]\npoints_m = [[30.5, 10.5, {z}]]\n\
             [solver]\nscheme = \"{scheme}\"\nlongest_s = 1.0\n[record]\nprofile_step_m = 1.0\n[maps]\ncell_m = 1.0\n",
            speed[0], speed[1]
        );
        let plan = crate::common::plan_in(dir.path(), &text);
        let fall = &crate::common::falls(&plan)[0];
        let grid = plan.recorders().cells.unwrap();
        // 7/10 m v² falls by the height, or by what rolling friction takes on the way: μ_r m g
        let decline = 9.81 * if degrees > 0.0 { slope } else { 0.3 };
        let left = |y: f64| 0.7 * 144.0 - decline * (y - 10.5);
        let mut seen = 0;
        for y in 11..15 {
            // places are local, borders of cells whole metres of the map
            let start = fall.start.position_m;
            let [column, row] = grid
                .place(start.x, start.y + f64::from(y) - 10.0)
                .map(|place| place.floor() as i64);
            let cell = grid.cell(column, row).unwrap();
            let passage = fall.passages.iter().find(|one| one.cell == cell).unwrap();
            let exact_j = fall.rock.mass_kg() * left(f64::from(y));
            let off = passage.total_j / exact_j - 1.0;
            assert!(off.abs() < 2e-3, "{scheme} {degrees}°, {y} m: {off:e}");
            let stretch = fall.stretches.iter().find(|one| one.number == y as u32 - 11).unwrap();
            // stretches begin at the release
            let exact = (left(f64::from(y) - 0.5) / 0.7).sqrt();
            assert!(
                (stretch.speed_m_s / exact - 1.0).abs() < 2e-3,
                "{scheme} {degrees}°, {y}: {stretch:?}"
            );
            seen += 1;
        }
        assert_eq!(seen, 4);
    }
}

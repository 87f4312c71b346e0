//! Crossings of lines against the parabola, and lines and maps against each other.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use rockfall::plan::{Part, Plan};
use rockfall::scene::Scene;
use rockfall::simulation::{Scratch, Stop, Trajectory, simulate_release};
use std::path::Path;

fn plan_of(text: &str) -> Plan {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/inline.toml");
    let scene = Scene::parse(text, &file).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    Plan::compile(&scene, terrain).unwrap()
}

/// The quick example up to a section, and what follows instead.
fn quick_until(section: &str, more: &str) -> Plan {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/quick.toml");
    let text = std::fs::read_to_string(file).unwrap();
    let (before, _) = text.split_once(section).unwrap();
    plan_of(&format!("{before}\n{more}"))
}

fn quick(more: &str) -> Plan {
    quick_until("[[lines]]", more)
}

/// Its slope and rocks, with a release of its own.
fn thrown(release: &str) -> Plan {
    quick_until("[release]", release)
}

fn falls(plan: &Plan, count: usize) -> Vec<Trajectory> {
    let mut scratch = Scratch::default();
    (0..count).map(|index| simulate_release(plan, index, None, &mut scratch).unwrap()).collect()
}

const LINES: &str = r#"
[[lines]]
name = "row edge"
points_m = [[0.0, 26.0], [40.0, 26.0]]
[[lines]]
name = "in two pieces"
points_m = [[0.0, 26.0], [17.3, 26.0], [40.0, 26.0]]
[[lines]]
name = "reversed"
points_m = [[40.0, 26.0], [0.0, 26.0]]
[[lines]]
name = "bent"
points_m = [[0.0, 40.0], [20.0, 42.0], [40.0, 40.0]]
[[lines]]
name = "behind the release"
points_m = [[0.0, 0.5], [40.0, 0.5]]
"#;

/// Rocks thrown along y straight over the corner at which two pieces meet: none passes between the pieces by rounding, and the
/// corner is met once.
#[test]
fn a_corner_is_crossed_once() {
    let point = |k: u32| format!("[18.3, {}, 30.0]", 45.0 + 0.0137 * f64::from(k));
    let points: Vec<String> = (0..60).map(point).collect();
    let line = |k: u32| {
        let (west, east) = (49.1 + 0.37 * f64::from(k), 57.9 - 0.21 * f64::from(k));
        let corners = format!("[[10.1, {west}], [18.3, 53.7], [30.7, {east}]]");
        format!("[[lines]]\nname = \"{k}\"\npoints_m = {corners}\n")
    };
    let lines: String = (0..20).map(line).collect();
    let plan = thrown(&format!(
        "[release]\ncount = 60\nvelocity_m_s = [0.0, 12.0, 3.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
         points_m = [{}]\n{lines}",
        points.join(",")
    ));
    for (index, fall) in falls(&plan, 60).iter().enumerate() {
        assert_eq!(fall.crossings.len(), 20, "rock {index}");
        for crossing in &fall.crossings {
            let corner_m = (18.3_f64 - 10.1).hypot(53.7 - (49.1 + 0.37 * crossing.line as f64));
            assert!((crossing.along_m - corner_m).abs() < 1e-9 && crossing.times == 1);
        }
    }
}

/// A rock thrown flat from 20 m above the meadow flies past the line before it lands. By hand: at 10 m/s the line 8 m
/// away is passed after 0.8 s, 0.5 · 9.81 · 0.8² lower, at `v_z` = −7.848 m/s, 8 m along.
#[test]
fn a_flight_crosses_where_the_parabola_says() {
    let plan = thrown(
        "[release]\ncount = 1\nvelocity_m_s = [0.0, 10.0, 0.0]\nspin_rad_s = [0.0, 3.0, 0.0]\n\
         points_m = [[18.0, 45.0, 30.0]]\n[[lines]]\nname = \"l\"\npoints_m = [[10.0, 53.0], [30.0, 53.0]]\n",
    );
    let fall = &falls(&plan, 1)[0];
    let crossing = fall.crossings[0];
    let origin = plan.terrain.origin_m;
    let mut motion = crossing.motion;
    motion.position_m += origin;
    // rounding of a dozen operations on numbers near 50
    let near = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-12, "{found} {exact}");
    near(motion.time_s, 0.8);
    near(crossing.along_m, 8.0);
    near(motion.position_m.y, 53.0);
    near(motion.position_m.z, 30.0 - 0.5 * 9.81 * 0.64);
    near(motion.velocity_m_s.z, -9.81 * 0.8);
    near(crossing.descent_deg(), (0.7848_f64).atan().to_degrees());
    near(
        motion.rotational_j(&fall.rock),
        0.2 * fall.rock.mass_kg() * (3.0 * fall.rock.radius_m).powi(2),
    );
    let ground = plan.terrain.ground_below(18.0 - origin.x, 53.0 - origin.y).unwrap() + origin.z;
    near(crossing.height_m, motion.position_m.z - fall.rock.radius_m - ground);
    assert!(crossing.height_normal_m <= crossing.height_m && crossing.times == 1);
}

/// The same line whole, in pieces and backwards: the same crossings, to rounding of the length along it. A rock that
/// starts below a line and goes down never crosses it.
#[test]
fn the_same_line_gives_the_same_crossings() {
    let plan = quick(LINES);
    let falls = falls(&plan, 60);
    for fall in &falls {
        let at = |line: usize| fall.crossings.iter().find(|crossing| crossing.line == line);
        let (Some(whole), Some(pieces), Some(back)) = (at(0), at(1), at(2)) else {
            assert!([0, 1, 2].iter().all(|line| at(*line).is_none()), "rock {}", fall.index);
            continue;
        };
        assert!((whole.motion.time_s - pieces.motion.time_s).abs() < 1e-9);
        assert!((whole.along_m - pieces.along_m).abs() < 1e-9);
        assert!((whole.along_m + back.along_m - 40.0).abs() < 1e-9);
        assert!((whole.motion.position_m.y + plan.terrain.origin_m.y - 26.0).abs() < 1e-9);
        assert_eq!(whole.times, pieces.times);
        // along the normal of a slope of angle β the centre is cos β times as high over it as straight down
        let (at_m, r) = (whole.motion.position_m, fall.rock.radius_m);
        let (_, normal) = plan.terrain.slope_under(at_m.x, at_m.y, at_m.z).unwrap();
        let along_normal_m = (whole.height_m + r) * normal.z.abs() - r;
        assert!((whole.height_normal_m - along_normal_m).abs() < 1e-9, "rock {}", fall.index);
        assert!(at(4).is_none());
    }
    assert!(falls.iter().filter(|fall| !fall.crossings.is_empty()).count() > 50);
}

/// A rock that crosses the edge between two rows of cells passes a cell on either side, and its energy in one of them
/// is not below that at the edge.
#[test]
fn lines_and_maps_agree() {
    let plan = quick(&format!("{LINES}\n[maps]\ncell_m = 2.0\n"));
    let Part::Kept(cells) = plan.maps else { panic!("the maps are asked for") };
    let (mut crossed, mut at_rest) = (0, 0);
    for fall in falls(&plan, 60) {
        let Some(crossing) = fall.crossings.iter().find(|crossing| crossing.line == 0) else {
            assert!(fall.passages.iter().all(|passage| passage.cell / cells.columns < 13));
            continue;
        };
        crossed += 1;
        let column = (crossing.along_m / 2.0).floor() as u32;
        let total_j =
            crossing.motion.translational_j(&fall.rock) + crossing.motion.rotational_j(&fall.rock);
        let beside = |row: u32| {
            let number = row * cells.columns + column;
            fall.passages.iter().find(|passage| passage.cell == number)
        };
        let (above, below) = (beside(12).unwrap(), beside(13).unwrap());
        // the ends of both parts are the crossing itself, computed along another way
        let most = above.total_j.max(below.total_j);
        assert!(most >= total_j * (1.0 - 1e-9), "{most} {total_j}");
        let largest = fall.passages.iter().map(|passage| passage.total_j).fold(0.0, f64::max);
        // what leaves the terrain may be fastest beyond the last cell
        if fall.stop == Stop::AtRest {
            let most = fall.extremes.total_j;
            assert!((largest / most - 1.0).abs() < 1e-9, "{largest} {most}");
            at_rest += 1;
        }
    }
    assert!(crossed > 40 && at_rest > 20, "{crossed} {at_rest}");
}

/// Watching costs time, never an answer.
#[test]
fn watching_changes_no_rock() {
    let (lean, full) = (quick(""), quick(&format!("{LINES}\n[maps]\ncell_m = 2.0\n")));
    assert!(!lean.lines.is_kept() && !lean.maps.is_kept());
    for (one, other) in falls(&lean, 20).into_iter().zip(falls(&full, 20)) {
        assert!(one.crossings.is_empty() && one.passages.is_empty());
        let blind = Trajectory { crossings: vec![], passages: vec![], ..other };
        assert_eq!(format!("{one:?}"), format!("{blind:?}"));
    }
}

/// A rock thrown up the slope comes back: its first crossing counts, by hand `(45 − 40)/8` s after the throw, and it is
/// known to have crossed again.
#[test]
fn a_rock_that_comes_back_crosses_twice_and_counts_once() {
    let plan = thrown(
        "[release]\ncount = 1\nvelocity_m_s = [0.0, -8.0, 6.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
         points_m = [[18.0, 45.0, 6.0]]\n[[lines]]\nname = \"l\"\npoints_m = [[0.0, 40.0], [40.0, 40.0]]\n",
    );
    let fall = &falls(&plan, 1)[0];
    let crossing = fall.crossings[0];
    assert_eq!((fall.crossings.len(), crossing.times), (1, 2), "{:?}", fall.end);
    assert!((crossing.motion.time_s - 0.625).abs() < 1e-12);
    assert!((crossing.along_m - 18.0).abs() < 1e-12 && crossing.motion.velocity_m_s.y < 0.0);
}

/// A plane that falls 0.4 to the south, with a hole across it. Rocks that fall through the hole have left at its rim: they
/// cross no line and pass no cell behind it, while rocks that leap the hole are seen at both.
#[test]
fn a_rock_under_the_mesh_crosses_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let mut grid = String::from(
        "ncols 21\nnrows 101\nxllcorner 0\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n",
    );
    for row in 0..101 {
        let y = 2.0 * f64::from(100 - row) + 1.0;
        let height = if (120.0..150.0).contains(&y) { -9999.0 } else { 0.4 * y };
        grid += &vec![height.to_string(); 21].join(" ");
        grid.push('\n');
    }
    std::fs::write(dir.path().join("hole.asc"), grid).unwrap();
    let text = r#"
title = "hole"
seed = 3
[[terrain]]
file = "hole.asc"
ground = "g"
[grounds.g]
normal_stiffness_n_m = 1e8
tangential_ratio = 0.25
friction_angle_deg = 32.0
restitution = 0.5
rolling_friction = 0.1
roughness_deg = 15.0
[rocks]
density_kg_m3 = 2700.0
radius_m = 0.4
[release]
count = 60
height_m = 1.0
velocity_m_s = [0.0, -6.0, { uniform = [0.0, 12.0] }]
spin_rad_s = [0.0, 0.0, 0.0]
line_m = [[10.0, 190.0], [30.0, 190.0]]
[solver]
scheme = "rigid"
[[lines]]
name = "behind"
points_m = [[1.0, 110.0], [41.0, 110.0]]
[[lines]]
name = "far behind"
points_m = [[1.0, 90.0], [41.0, 90.0]]
[maps]
cell_m = 2.0
"#;
    let scene = Scene::parse(text, &dir.path().join("scene.toml")).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    let plan = Plan::compile(&scene, terrain).unwrap();
    let Part::Kept(cells) = plan.maps else { panic!("the maps are asked for") };
    let mut fallen = 0;
    for fall in falls(&plan, 60) {
        for crossing in &fall.crossings {
            assert!(crossing.height_m > -0.1, "rock {}: {crossing:?}", fall.index);
        }
        let end = fall.end.position_m;
        // through the hole: it left where it lost the ground, at the upper rim, and not where it would have left the box below
        let is_inside = (2.0..40.0).contains(&(end.x + plan.terrain.origin_m.x));
        if fall.stop == Stop::LeftTerrain && fall.crossings.is_empty() && is_inside {
            fallen += 1;
            let origin_m = plan.terrain.origin_m;
            assert!(
                (150.5..151.001).contains(&(end.y + origin_m.y)),
                "rock {} at {end}",
                fall.index
            );
            let south = |cell: u32| cells.south_m + 2.0 * f64::from(cell / cells.columns);
            let behind = |cell: u32| south(cell) + origin_m.y < 148.0;
            assert!(!fall.passages.iter().any(|one| behind(one.cell)), "rock {}", fall.index);
        }
    }
    assert!(fallen > 5, "{fallen}");
}

/// Names of lines and zones in files stand in tables too: one with a line break is refused, with the file and its feature.
#[test]
fn a_name_in_a_file_that_breaks_lines_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let drawing = |kind: &str, corners: &str| {
        format!(
            r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","properties":{{"name":"a\nb"}},
            "geometry":{{"type":"{kind}","coordinates":{corners}}}}}]}}"#
        )
    };
    std::fs::write(dir.path().join("lines.geojson"), drawing("LineString", "[[0,40],[60,40]]"))
        .unwrap();
    std::fs::write(dir.path().join("zones.geojson"), drawing("Point", "[10,10]")).unwrap();
    let quick = std::fs::read_to_string("examples/quick.toml").unwrap();
    let (physics, _) = quick.split_once("[[lines]]").unwrap();
    let place = physics.lines().find(|line| line.starts_with("line_m")).unwrap();
    let zones = physics.replace(place, "zones = \"zones.geojson\"");
    let lines = format!("{physics}\n[[lines]]\nfile = \"lines.geojson\"\n");
    for (scene, drawing) in [(lines, "lines.geojson"), (zones, "zones.geojson")] {
        let file = dir.path().join("scene.toml");
        std::fs::write(&file, scene).unwrap();
        let said = Scene::read(&file).unwrap_err().to_string();
        let found = format!("{drawing}: feature 1: found name = \"a\\nb\"; write it in one line");
        assert!(said.contains(&found), "{said}");
    }
}

/// A rock that is released on a line does not cross it by that, whichever side rounding puts it on; one that is thrown up over it and comes
/// back does, once. The plan says what lies so. Corners of lines below a release are no other places.
#[test]
fn a_line_is_not_crossed_by_standing_on_it() {
    let lines = "[[lines]]\nname = \"on\"\npoints_m = [[1.7, 30.1], [38.3, 31.7]]\n\
        [[lines]]\nname = \"corner\"\npoints_m = [[1.7, 30.1], [20.0, 30.9], [38.3, 31.7]]\n\
        [[lines]]\nname = \"passed\"\npoints_m = [[1.0, 33.0], [39.0, 33.0]]\n";
    let on_the_line = |k: u32| {
        let share = f64::from(k) / 100.0;
        format!("[{}, {}, 20.0]", 1.7 + share * (38.3 - 1.7), 30.1 + share * (31.7 - 30.1))
    };
    let points: Vec<String> = (20..80).map(on_the_line).collect();
    let released = |velocity: &str| {
        thrown(&format!(
            "[release]\ncount = 60\nvelocity_m_s = {velocity}\nspin_rad_s = [0.0, 0.0, 0.0]\n\
             points_m = [{}]\n{lines}",
            points.join(",")
        ))
    };
    for velocity in ["[0.0, 0.0, 0.0]", "[0.0, 6.0, 1.0]"] {
        let plan = released(velocity);
        for name in ["on", "corner"] {
            let said =
                format!("60 of 60 releases tried out lie on the line “{name}” before they move");
            let said = said.replace("60 of 60", "1000 of 1000");
            assert!(
                plan.warnings.iter().any(|text| text.starts_with(&said)),
                "{:?}",
                plan.warnings
            );
        }
        assert!(!plan.warnings.iter().any(|text| text.contains("“passed”")));
        for fall in falls(&plan, 60) {
            let early = fall.crossings.iter().filter(|one| one.motion.time_s < 1e-3);
            assert_eq!(early.count(), 0, "rock {}: {:?}", fall.index, fall.crossings);
            let times = |line: usize| {
                fall.crossings
                    .iter()
                    .filter(|one| one.line == line)
                    .map(|one| one.times)
                    .sum::<u32>()
            };
            assert_eq!(times(0), times(1), "rock {}", fall.index);
            if velocity != "[0.0, 0.0, 0.0]" {
                assert_eq!(times(2), 1, "rock {}", fall.index);
            }
        }
    }
    // thrown straight up the face, a rock passes over the line on its way back
    let back = thrown(
        "[release]\ncount = 1\nvelocity_m_s = [0.0, -3.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
         points_m = [[20.0, 15.0]]\nheight_m = 0.1\n[[lines]]\nname = \"l\"\npoints_m = [[1.0, 15.0], [39.0, 15.0]]\n",
    );
    let fall = &falls(&back, 1)[0];
    assert_eq!(fall.crossings.iter().map(|one| one.times).collect::<Vec<_>>(), [1]);
    assert!(fall.crossings[0].motion.time_s > 0.1);
}

/// An entry's own name is numbered over all lines of its file, parts of one feature too; names of the file get their part.
#[test]
fn lines_of_a_file_are_numbered() {
    let dir = tempfile::tempdir().unwrap();
    let feature = |kind: &str, name: &str, corners: &str| {
        format!(
            r#"{{"type":"Feature","properties":{{"name":"{name}"}},"geometry":{{"type":"{kind}","coordinates":{corners}}}}}"#
        )
    };
    let features = [
        feature("LineString", "west", "[[0,40],[10,40]]"),
        feature("MultiLineString", "east", "[[[20,40],[30,40]],[[30,44],[40,44]]]"),
    ];
    let text = format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","));
    std::fs::write(dir.path().join("nets.geojson"), text).unwrap();
    let terrain = format!("{}/terrain/", env!("CARGO_MANIFEST_DIR"));
    let quick = std::fs::read_to_string("examples/quick.toml").unwrap();
    let quick = quick.replace("../terrain/", &terrain);
    let (physics, _) = quick.split_once("[[lines]]").unwrap();
    for (name, expected) in [
        ("name = \"Netz\"\n", ["Netz 1", "Netz 2", "Netz 3"]),
        ("", ["west", "east", "east part 2"]),
    ] {
        let file = dir.path().join("scene.toml");
        std::fs::write(&file, format!("{physics}\n[[lines]]\nfile = \"nets.geojson\"\n{name}"))
            .unwrap();
        let scene = Scene::read(&file).unwrap();
        let found: Vec<&str> = scene.lines.iter().map(|line| line.name.as_str()).collect();
        assert_eq!(found, expected);
    }
}

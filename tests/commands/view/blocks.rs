//! Blocks in the view: their hulls are those of the bodies, and they are turned as the tables say, on the way and at rest.

use super::{glb, run};
use crate::program::rockfall;
use nalgebra::{Quaternion, UnitQuaternion};
use rockfall::body::{Shape, Solid};
use rockfall::output::{self, PathRow};
use rockfall::plan::Plan;
use rockfall::report::view::hulls::BlockHulls;
use rockfall::report::view::pack::Section;
use rockfall::report::view::{GLB, PAGE, page};
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::simulation::PathState;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::process::Command;

const FILE: &str = "examples/blocks.toml";
/// Blocks of the test.
const COUNT: usize = 16;

fn plan(text: &str) -> Plan {
    let scene = Scene::parse(text, Path::new(FILE)).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    Plan::compile(&scene, terrain).unwrap()
}

fn example() -> Plan {
    plan(&std::fs::read_to_string(FILE).unwrap())
}

fn turn(attitude: [f64; 4]) -> UnitQuaternion<f64> {
    let [w, x, y, z] = attitude;
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

fn paths_of(out: &Path) -> Vec<Vec<PathRow>> {
    let mut paths: Vec<Vec<PathRow>> = Vec::new();
    for row in output::read(out).unwrap().paths().unwrap() {
        let row = row.unwrap();
        match paths.last_mut().filter(|path| path[0].index == row.index) {
            Some(path) => path.push(row),
            None => paths.push(vec![row]),
        }
    }
    paths
}

/// Volumes in units of R³: of the core with its faces moved out, and of the rounded hull (Steiner's formula).
fn bounds_of_volume(shape: &Shape) -> (f64, f64) {
    let (core, r) = (&shape.core, shape.ball);
    let corner = |k: u8| core.corners[usize::from(k)];
    let (mut inner, mut area) = (0.0, 0.0);
    for face in &core.faces {
        let first = corner(face.corners[0]);
        for two in face.corners[1..].windows(2) {
            let [a, b] = [two[0], two[1]].map(corner);
            inner += first.dot(&a.cross(&b)) / 6.0;
            area += 0.5 * (a - first).cross(&(b - first)).norm();
        }
    }
    let bend = core.ridges.iter().map(|ridge| {
        let [a, b] = ridge.ends.map(corner);
        // the faces meet at the angle between the ways into them; the normals turn by the rest
        0.5 * (b - a).norm() * (PI - ridge.into[0].angle(&ridge.into[1]))
    });
    let curved = bend.sum::<f64>() * r * r + 4.0 / 3.0 * PI * r * r * r;
    (inner + area * r, inner + area * r + curved)
}

/// Closed, inside the rounded hull, with its faces where the body has them, and of the volume between.
fn is_hull_of(hulls: &BlockHulls, release: usize, shape: &Shape) {
    let surface = hulls.hull(release).unwrap().surface();
    surface.check_closed().unwrap();
    let volume = Solid::of(&surface).volume;
    let (least, most) = bounds_of_volume(shape);
    assert!(volume > least && volume < most, "{release}: {least} {volume} {most}");
    // radii are those of the sphere of equal volume; what corners lack is little
    assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 0.05, "{release}: {volume}");
    let reach = |n: &Vec3| surface.points.iter().map(|p| p.dot(n)).fold(f64::MIN, f64::max);
    // half a step along each axis
    let rounding = 0.5 * 3.0_f64.sqrt() / 16_384.0;
    for face in &shape.core.faces {
        let off = reach(&face.normal) - face.level - shape.ball;
        assert!(off.abs() <= rounding, "{release}: {off}");
    }
    for k in 0..200 {
        let k = f64::from(k);
        let n = Vec3::new((1.7 * k).sin(), (2.3 * k).cos(), (0.9 * k).sin()).normalize();
        let exact = shape.core.corners.iter().map(|p| p.dot(&n)).fold(f64::MIN, f64::max);
        let short = exact + shape.ball - reach(&n);
        assert!(short > -rounding && short < shape.ball, "{release}: {short}");
    }
}

/// The hulls on the disk are those of the bodies that fell, in boxes whose sides are drawn as in blocks of one shape, scans
/// among them.
#[test]
fn hulls_on_the_disk_are_those_of_the_bodies() {
    let dir = tempfile::tempdir().unwrap();
    let out = run(dir.path(), FILE, COUNT);
    let text = std::fs::read_to_string(out.join(PAGE)).unwrap();
    let hulls = BlockHulls::read(page::section(&text, page::BLOCKS).unwrap()).unwrap();
    let plan = example();
    for release in 0..COUNT {
        is_hull_of(&hulls, release, &plan.releases.shape(release).unwrap());
    }
    assert!(hulls.hull(COUNT).is_none());
    // four numbers of an attitude cost no more than other numbers of a path may: 1.5 bytes each
    let (packed, rows) = (page::section(&text, "paths").unwrap(), paths_of(&out).concat().len());
    assert!(2 * packed.len() <= 3 * 7 * rows, "{} of {rows}", packed.len());
    assert!(!text.contains("balls of their volume"));
    // a page without blocks holds nothing of this
    assert!(!std::fs::read_to_string("reports/quick/view.html").unwrap().contains("turnAt"));
}

/// In the scene file: every named shape and a scan, most slender and most round.
#[test]
fn every_kind_of_shape_has_its_hull() {
    let example = std::fs::read_to_string(FILE).unwrap();
    let (head, rest) = example.split_once("# compact blocks").unwrap();
    let (_, tail) = rest.split_once("[release]").unwrap();
    let dir = tempfile::tempdir().unwrap();
    let scan = dir.path().join("scan.stl");
    std::fs::write(&scan, stone()).unwrap();
    let mesh = format!("kind = \"mesh\"\nmesh = {scan:?}\ncorners = 48");
    for (shape, radius) in [
        ("kind = \"eota111\"", 0.1),
        ("kind = \"eota221\"", 0.25),
        ("kind = \"box\"\naxes = [4.0, 1.0, 0.7]", 0.02),
        ("kind = \"ellipsoid\"\naxes = [1.0, 0.8, 0.5]", 0.1),
        ("kind = \"prism\"\nsides = 6\nratio = 0.6", 0.15),
        ("kind = \"prism\"\nsides = 32\nratio = 1.0", 0.3),
        (&mesh, 0.05),
    ] {
        let table = format!("[[rocks.shapes]]\n{shape}\ncorner_radius = {radius}\n\n[release]");
        let shape = plan(&format!("{head}{table}{tail}")).releases.shape(0).unwrap();
        let surface = shape.cut_surface();
        surface.check_closed().unwrap_or_else(|why| panic!("{shape:?}: {why}"));
        let volume = Solid::of(&surface).volume;
        let (least, most) = bounds_of_volume(&shape);
        assert!(volume > least && volume < most, "{table}: {least} {volume} {most}");
    }
}

/// A scan as text STL: a lumpy ellipsoid of 24 × 12 facets, its poles closed.
fn stone() -> String {
    let point = |ring: u32, step: u32| {
        let (along, round) = (PI * f64::from(ring) / 12.0, TAU * f64::from(step % 24) / 24.0);
        let lump = 1.0 + 0.04 * (5.0 * round).sin();
        let out = if ring.is_multiple_of(12) { 0.0 } else { along.sin() * lump };
        format!("vertex {} {} {}\n", out * round.cos(), 0.7 * out * round.sin(), 0.5 * along.cos())
    };
    let mut text = "solid stone\n".to_owned();
    let mut facet = |three: [String; 3]| {
        text.extend(["facet normal 0 0 0\nouter loop\n", &three.concat(), "endloop\nendfacet\n"]);
    };
    for ring in 0..12 {
        for step in 0..24 {
            let [a, b] = [0, 1].map(|next| point(ring, step + next));
            let [c, d] = [0, 1].map(|next| point(ring + 1, step + next));
            if ring > 0 {
                facet([a.clone(), d.clone(), b]);
            }
            if ring < 11 {
                facet([a, c, d]);
            }
        }
    }
    text + "endsolid stone\n"
}

/// On the page every attitude is that of the table to a third of a degree, and the rounds between two instants are those of
/// the spin: where it turns by more than half a round, and only there, the short way is not the one that is shown.
#[test]
fn blocks_on_the_page_are_turned_as_the_table_says() {
    let dir = tempfile::tempdir().unwrap();
    let scene = std::fs::read_to_string(FILE).unwrap();
    let folder = std::fs::canonicalize("terrain").unwrap();
    // so long between two instants that many go round in between
    let scene = scene.replace("../terrain", folder.to_str().unwrap());
    let scene = scene.replace("path_step_s = 0.05", "path_step_s = 0.2");
    let path = dir.path().join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    let out = run(dir.path(), path.to_str().unwrap(), 2 * COUNT);
    let text = std::fs::read_to_string(out.join(PAGE)).unwrap();
    let section = Section::read(page::section(&text, "paths").unwrap()).unwrap();
    let turns = section.numbers("turn");
    let rows: Vec<PathRow> = paths_of(&out).concat();
    assert_eq!(turns.len(), rows.len());
    let said = Command::new("node")
        .args([
            "tests/commands/view/turns.js",
            concat!(env!("CARGO_MANIFEST_DIR"), "/src/report/view/web"),
        ])
        .arg(out.join(PAGE))
        .output();
    let Ok(said) = said else {
        eprintln!("node is not installed: how the page turns blocks was not tried");
        return;
    };
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let said = String::from_utf8(said.stdout).unwrap();
    let lines: Vec<[f64; 8]> = said
        .lines()
        .map(|line| {
            let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    assert_eq!(lines.len(), rows.len());
    let (mut worst, mut tried, mut round) = (0.0_f64, 0, 0);
    for (k, (line, row)) in lines.iter().zip(&rows).enumerate() {
        let at = |from: usize| turn([0, 1, 2, 3].map(|i| line[from + i]));
        worst = worst.max(at(0).angle_to(&turn(row.attitude.unwrap())).to_degrees());
        let Some(next) = rows.get(k + 1).filter(|next| next.index == row.index) else { continue };
        // a flight without a change of spin: a fourth of the way is a fourth of what it spins
        let [w, v] = [row, next].map(|row| Vec3::from(row.spin_rad_s));
        if next.state != PathState::Flight || row.state != PathState::Flight {
            continue;
        }
        let angle = w.norm() * (next.time_s - row.time_s);
        if (w - v).norm() < 0.02 * w.norm() && angle < 0.95 * TAU && angle > 0.05 {
            let part = at(4).angle_to(&at(0));
            assert!((part - 0.25 * angle).abs() < 0.03 * angle + 0.01, "{k}: {part} {angle}");
            tried += 1;
            round += usize::from(angle > PI);
        }
    }
    assert!(worst < 0.28, "{worst}");
    assert!(tried > 15 && round > 5, "{tried} {round}");
}

/// In the file for other programs: hulls and radii of the bodies, a keyframe at every instant of the path with the attitude of
/// the table, so many between that none turns by more than a quarter, and at the end the attitude in which it rests.
#[test]
fn blocks_of_the_exported_scene_turn_the_right_way() {
    let dir = tempfile::tempdir().unwrap();
    let out = run(dir.path(), FILE, COUNT);
    let file = std::fs::read(out.join(GLB)).unwrap();
    glb::check(&file);
    let scene = glb::Scene::read(&file);
    let releases: Vec<_> =
        output::read(&out).unwrap().rows().unwrap().map(Result::unwrap).collect();
    let plan = example();
    let mut between = 0;
    for path in paths_of(&out) {
        let index = path[0].index;
        let node = scene.node(&format!("rock {index}"));
        let radius_m = releases[index].radius_m;
        assert_eq!(node["scale"], serde_json::json!([radius_m, radius_m, radius_m]));
        let shape = plan.releases.shape(index).unwrap();
        let places = scene.places_of(node);
        for axis in 0..3 {
            let most = places.iter().map(|p| f64::from(p[axis])).fold(f64::MIN, f64::max);
            let exact = shape.core.corners.iter().map(|p| p[axis]).fold(f64::MIN, f64::max);
            assert!(most <= exact + shape.ball + 1e-4 && most > exact, "{index} {axis}");
        }
        let (times, turns) = scene.rotation_of(node);
        between += times.len() - path.len();
        goes_the_way(&path, (&times, &turns));
        lies_on_the_ground(&plan, path.last().unwrap(), &places, radius_m);
    }
    assert!(between > 20, "{between}");
}

/// All instants are there, quarters between them, in the sense of the spin.
fn goes_the_way(path: &[PathRow], (times, turns): (&[f32], &[[f32; 4]])) {
    let unit = |turn: &[f32; 4]| {
        let [x, y, z, w] = turn.map(f64::from);
        assert!((x * x + y * y + z * z + w * w - 1.0).abs() < 1e-6);
        UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
    };
    let mut keys = times.iter().zip(turns).peekable();
    let first = keys.next().unwrap();
    assert_eq!(first.0.to_bits(), (path[0].time_s as f32).to_bits());
    let mut last = unit(first.1);
    for two in path.windows(2) {
        let mut gone = Vec3::zeros();
        let mut pieces = 0;
        while let Some((_, turn)) = keys.next_if(|(time, _)| **time <= two[1].time_s as f32) {
            let next = unit(turn);
            assert!(next.dot(&last) > 0.7, "{}", next.dot(&last));
            gone += (next * last.inverse()).scaled_axis();
            (last, pieces) = (next, pieces + 1);
        }
        assert!(pieces > 0, "{}", two[1].time_s);
        assert!(last.angle_to(&turn(two[1].attitude.unwrap())) < 1e-5, "{}", two[1].time_s);
        let [w, v] = [0, 1].map(|k| Vec3::from(two[k].spin_rad_s));
        let spun = (w + v) * (0.5 * (two[1].time_s - two[0].time_s));
        // keyframes only where a quarter is not enough
        assert_eq!(pieces, (gone.norm() / (0.5 * PI) - 1e-5).ceil().max(1.0) as usize, "{gone}");
        // nearer to what the spin says than a round more or less
        let axis = gone.try_normalize(1e-6).unwrap_or_else(Vec3::x);
        assert!((gone - spun).dot(&axis).abs() <= PI + 1e-4, "{gone} {spun}");
    }
    assert!(keys.next().is_none());
}

/// The lowest corner as it is drawn is as far above the ground as the table says of the block, but for what is cut off.
fn lies_on_the_ground(plan: &Plan, end: &PathRow, places: &[[f32; 3]], radius_m: f64) {
    if !end.clearance_m.is_finite() {
        return;
    }
    let turn = turn(end.attitude.unwrap());
    let low = |p: &[f32; 3]| (turn * Vec3::from(p.map(f64::from))).z * radius_m;
    let lowest = places.iter().map(low).fold(f64::MAX, f64::min);
    let local = Vec3::from(end.position_m) - plan.terrain.origin_m;
    let ground = plan.terrain.ground_below(local.x, local.y).unwrap();
    let above = local.z + lowest - ground - end.clearance_m;
    assert!(above > -1e-4 * radius_m && above < 0.1 * radius_m, "{}: {above}", end.index);
}

/// Drawn again, and put together from two shards, both files are the same bytes.
#[test]
fn blocks_survive_drawing_again_and_merging() {
    let dir = tempfile::tempdir().unwrap();
    let out = run(dir.path(), FILE, COUNT);
    let both = |folder: &Path| [PAGE, GLB].map(|file| std::fs::read(folder.join(file)).unwrap());
    let before = both(&out);
    let done = |args: &[&str]| {
        let said = rockfall(args);
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    };
    done(&["draw", out.to_str().unwrap()]);
    assert!(both(&out) == before);
    let count = COUNT.to_string();
    let folder = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let (one, two, all) = (folder("one"), folder("two"), folder("all"));
    let ran = ["run", FILE, "--quiet", "--releases", &count, "--out"];
    done(&[&ran[..], &[&one, "--shard", "1/2"]].concat());
    done(&[&ran[..], &[&two, "--shard", "2/2"]].concat());
    done(&["merge", &two, &one, "--out", &all]);
    assert!(both(Path::new(&all)) == before);
    super::browser_draws(&out);
}

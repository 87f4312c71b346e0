//! Stems that give way, and stems made from a list of trees.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test fails by panicking; infinite times are equal or not"
)]

use crate::common;

use common::together::{Sphere, WORLD, World};
use common::{GROUND, ROCK};
use proptest::prelude::*;
use rockfall::contact::ContactPoints;
use rockfall::contact::neighbours::Neighbours;
use rockfall::flight::{Parabola, time_of_impact, time_of_impact_without};
use rockfall::plan::{Recorders, RestRule};
use rockfall::random::{Distribution, Purpose, stream};
use rockfall::release::Release;
use rockfall::rock::{Motion, Vec3};
use rockfall::simulation::{RecordOptions, RunSettings, Scratch, Stop, Trajectory, simulate};
use rockfall::solver::{Scheme, Settings};
use rockfall::terrain::make::{Stem, square_stem};
use rockfall::terrain::stems::Stems;
use rockfall::terrain::stl::{Facet, Soup};
use rockfall::terrain::weld::{Piece, Up, weld};
use rockfall::terrain::{Sheet, Terrain};
use std::path::Path;
use std::process::Command;

/// Ground far below the stems, see [`stand_on`].
fn stand(stems: usize, limit_j: Option<f64>) -> Terrain {
    stand_on(-50.0, stems, limit_j)
}

/// Ground at a height (m), and stems of 1 m from 4 m below 0 every 4 m along x; they can take `limit_j` each.
pub(crate) fn stand_on(ground_m: f64, stems: usize, limit_j: Option<f64>) -> Terrain {
    let square = [[-9.0, -9.0], [30.0, -9.0], [30.0, 9.0], [-9.0, 9.0]];
    let square = square.map(|[x, y]| Vec3::new(x, y, ground_m));
    let plate: Vec<Facet> =
        vec![[square[0], square[1], square[2]], [square[0], square[2], square[3]]];
    let tree = |k: usize| Stem { x_m: 4.0 * k as f64, y_m: 0.0, dbh_m: 1.0, height_m: 8.0 };
    let trees: Vec<Facet> = (0..stems).flat_map(|k| square_stem(&tree(k), -4.0)).collect();
    let soups = [Soup::from(plate), Soup::from(trees)];
    let piece =
        |(sheet, soup)| Piece { file: Path::new("made"), soup, up: Up::Z, scale: 1.0, sheet };
    let pieces: Vec<Piece> = (0..).zip(&soups).map(piece).take(1 + stems.min(1)).collect();
    let welded = weld(&pieces, Vec3::zeros(), Some(1e-9)).unwrap();
    let sheet = |is_tree| Sheet { path: "made".into(), ground: u16::from(is_tree), is_tree };
    let mut terrain = Terrain::new(welded, vec![sheet(false), sheet(true)]);
    let limit = limit_j.map(|joule| Distribution::fixed(joule).unwrap());
    terrain.stems = Stems::of(&terrain, vec![None, limit]).unwrap();
    terrain
}

/// A rock that comes along x at 10 m/s, `beside_m` off the axis, without gravity.
fn shoot(terrain: &Terrain, scheme: Scheme, beside_m: f64, scratch: &mut Scratch) -> Trajectory {
    let start = [Vec3::new(-4.0, beside_m, 0.0), Vec3::new(10.0, 0.0, 0.0)];
    shoot_from(terrain, scheme, start, scratch)
}

/// The same from another place (m) with another velocity (m/s).
pub(crate) fn shoot_from(
    terrain: &Terrain,
    scheme: Scheme,
    [place_m, velocity_m_s]: [Vec3; 2],
    scratch: &mut Scratch,
) -> Trajectory {
    let step = Settings {
        scheme,
        tolerance_m_s: if scheme == Scheme::Reference { 1e-8 } else { 1e-3 },
        step_s: if scheme == Scheme::Dda { 1e-5 } else { 1e-2 },
        shear_memory: true,
        impact_kernels: true,
        rigid_heaps: true,
        corner_way: rockfall::solver::CORNER_WAY,
        capture_speed_m_s: None,
    };
    let course = RunSettings {
        terrain,
        gravity_m_s2: 0.0,
        step: &step,
        rest: RestRule { speed_m_s: 0.02, time_s: 0.3 },
        longest_s: 20.0,
        recorders: Recorders::default(),
        seed: 1,
    };
    let motion = Motion {
        time_s: 0.0,
        position_m: place_m - terrain.origin_m,
        velocity_m_s,
        spin_rad_s: Vec3::zeros(),
    };
    let grounds = vec![GROUND; 2];
    let release = Release { rock: ROCK, motion, grounds };
    let keep = RecordOptions { path_step_s: None, impacts: true };
    simulate(&course, &release, keep, stream(1, Purpose::Impacts, 0), scratch)
}

fn energy_j(fall: &Trajectory, motion: &Motion) -> f64 {
    motion.translational_j(&fall.rock) + motion.rotational_j(&fall.rock)
}

fn lost_j(fall: &Trajectory) -> f64 {
    energy_j(fall, &fall.start) - energy_j(fall, &fall.end)
}

/// Schemes, and the share of the energy that one contact may lose to numerics: a dozen steps of 10⁻³ or 10⁻⁸ m/s at
/// 10 m/s for those with error control; `π ωΔt/2` of a whole bounce for the fixed step, which damps its springs by
/// itself; the rigid limit is exact but for rounding.
const SCHEMES: [(Scheme, f64); 4] = [
    (Scheme::Adaptive, 2e-3),
    (Scheme::Reference, 2e-8),
    (Scheme::Dda, 1.4e-2),
    (Scheme::Rigid, 1e-9),
];

/// `E = m v²/2` of the shot.
fn shot_j() -> f64 {
    0.5 * ROCK.mass_kg() * 100.0
}

/// The law: what a stem that gives way takes is its limit, to the joule, and the rock loses nothing else. What does
/// not break takes what a stem that stands for good takes.
#[test]
fn a_rock_loses_what_the_stems_take_and_no_more() {
    for (scheme, numerics) in SCHEMES {
        let shoot = |stems: usize, share: Option<f64>, beside_m: f64| {
            let terrain = stand(stems, share.map(|share| share * shot_j()));
            shoot(&terrain, scheme, beside_m, &mut Scratch::default())
        };
        // one weak stem: passed straight, at sqrt(1 - 0.3) of the speed
        let weak = shoot(1, Some(0.3), 0.0);
        assert_eq!(weak.stop, Stop::LeftTerrain, "{scheme:?}");
        let lost = lost_j(&weak) / shot_j();
        assert!((lost - 0.3).abs() < numerics, "{scheme:?}: {lost}, {:?}", weak.ledger);
        assert!((weak.ledger.trees_j - 0.3 * shot_j()).abs() < 1e-9 * shot_j(), "{scheme:?}");
        let (start, end) = (weak.start, weak.end);
        assert!((end.position_m.y - start.position_m.y).abs() < 1e-9, "{scheme:?}: turned aside");
        assert_eq!(weak.tree_impact_count, 1, "{scheme:?}");
        // three of them take 0.9 of the energy, the fourth stands and throws the rock back
        let four = shoot(4, Some(0.3), 0.0);
        assert!(four.end.velocity_m_s.x < 0.0, "{scheme:?}: {:?}", four.end);
        let passed = shoot(3, Some(0.3), 0.0);
        assert!((passed.ledger.trees_j - 0.9 * shot_j()).abs() < 1e-9 * shot_j(), "{scheme:?}");
        assert!((lost_j(&passed) - 0.9 * shot_j()).abs() < 3.0 * numerics * shot_j(), "{scheme:?}");
        // a strong one is as good as one that stands for good, bit for bit
        let (strong, rigid) = (shoot(1, Some(1.5), 0.0), shoot(1, None, 0.0));
        assert!(strong.end.velocity_m_s.x < 0.0);
        assert_eq!(strong, rigid, "{scheme:?}");
        // a hit beside the axis with friction and spin
        let beside = shoot(1, Some(0.1), 0.8);
        assert!(beside.end.velocity_m_s.x > 0.0);
        let (lost, ledger) = (lost_j(&beside), beside.ledger);
        let booked = ledger.trees_j + ledger.remainder_j;
        assert!((lost - booked).abs() < 1e-9 * shot_j(), "{scheme:?}: {lost} {ledger:?}");
        assert!(ledger.trees_j <= 0.1 * shot_j() * (1.0 + 1e-9), "{scheme:?}: {ledger:?}");
    }
}

#[test]
fn the_next_rock_finds_the_stems_whole() {
    let terrain = stand(2, Some(0.3 * shot_j()));
    let mut scratch = Scratch::default();
    let first = shoot(&terrain, Scheme::Adaptive, 0.0, &mut scratch);
    let second = shoot(&terrain, Scheme::Adaptive, 0.0, &mut scratch);
    assert_eq!(first, second);
    assert_eq!(first, shoot(&terrain, Scheme::Adaptive, 0.0, &mut Scratch::default()));
}

/// Stems that cannot be told from the slope they stand on would leave holes in it.
#[test]
fn a_stem_must_not_share_corners_with_what_stays() {
    let mut terrain = stand(1, None);
    for triangle in 0..terrain.triangles.len() as u32 {
        assert!(!terrain.is_gone(triangle, &[0]));
    }
    let limits = || vec![None, Some(Distribution::fixed(1.0).unwrap())];
    assert_eq!(Stems::of(&terrain, limits()).unwrap().unwrap().count(), 1);
    let tree = (0..terrain.triangles.len()).find(|&t| terrain.is_tree(t as u32)).unwrap();
    terrain.sheet_of[tree] = 0;
    assert!(Stems::of(&terrain, limits()).is_err());
}

fn arb_flight() -> impl Strategy<Value = Parabola> {
    let place = (-6.0..16.0, -4.0..4.0, -4.0..6.0);
    let velocity = (-8.0..8.0, -8.0..8.0, -8.0..8.0);
    (place, velocity, 0.1..0.6, prop_oneof![Just(0.0), Just(9.8)]).prop_map(
        |((x, y, z), (u, v, w), radius, gravity)| Parabola {
            start: Vec3::new(x, y, z),
            velocity: Vec3::new(u, v, w),
            gravity,
            radius,
        },
    )
}

proptest! {
    /// With stems 1 and 2 of three gone, flights and touches are those of a terrain that never had them.
    #[test]
    fn what_is_gone_was_never_there(flight in arb_flight()) {
        let three = stand(3, Some(1.0));
        let stems = three.stems.as_ref().unwrap();
        let of_first = (0..three.triangles.len() as u32)
            .find(|&t| stems.of_triangle(t).is_some() && three.corners_m(t).iter().all(|c| c.x + three.origin_m.x < 1.0));
        let first = stems.of_triangle(of_first.unwrap()).unwrap();
        let gone: Vec<u32> = (0..3).filter(|&stem| stem != first).collect();
        let one = stand(1, None);
        let at = |terrain: &Terrain| Parabola { start: flight.start - terrain.origin_m, ..flight };
        let past = time_of_impact_without(&three, &at(&three), 2.0, &gone, &mut 0);
        let never = time_of_impact(&one, &at(&one), 2.0, &mut 0);
        // the box that a rock leaves may be another, what it touches is the same
        let touch = |landing| if let rockfall::flight::FlightEnd::Touch(t) = landing { t } else { f64::INFINITY };
        prop_assert!((touch(past) - touch(never)).abs() < 1e-9 || touch(past) == touch(never));
        let touches = |terrain: &Terrain, gone: &[u32]| {
            let mut near = Neighbours::default();
            near.broken_stems.extend(gone);
            let centre = at(terrain).start;
            near.collect(terrain, &centre, flight.radius, 0.35, 0.1);
            let mut touches = ContactPoints::default();
            near.touches(terrain, &centre, flight.radius + 0.1, &mut touches);
            touches.iter().map(|touch| (touch.distance_m, touch.normal)).collect::<Vec<_>>()
        };
        let (past, never) = (touches(&three, &gone), touches(&one, &[]));
        prop_assert_eq!(past.len(), never.len());
        // in any order: that of the triangles is another where there are more of them
        for one in &past {
            let same = |other: &(f64, Vec3)| (one.0 - other.0).abs() < 1e-9 && (one.1 - other.1).norm() < 1e-9;
            prop_assert!(never.iter().any(same), "{:?} {:?}", past, never);
        }
    }
}

fn rockfall(words: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_rockfall")).args(words).output().unwrap()
}

/// The quick example with a limit for its trees.
fn quick(dir: &Path, name: &str, limit: &str) -> String {
    let text = std::fs::read_to_string("examples/quick.toml").unwrap();
    let terrain = std::env::current_dir().unwrap().join("terrain");
    let text = text.replace("../terrain", terrain.to_str().unwrap());
    let at = text.find("[grounds.trunk]\n").unwrap() + "[grounds.trunk]\n".len();
    let scene = dir.join(format!("{name}.toml"));
    std::fs::write(&scene, format!("{}{limit}\n{}", &text[..at], &text[at..])).unwrap();
    scene.to_str().unwrap().to_owned()
}

/// Stems that no rock can break change no byte; weak ones let more rocks through, the same on any number of threads.
#[test]
fn a_limit_beyond_reach_changes_no_byte() {
    let dir = tempfile::tempdir().unwrap();
    let releases = |name: &str, limit: &str, threads: &str| {
        let scene = quick(dir.path(), name, limit);
        let out = dir.path().join(format!("{name}{threads}"));
        let out = out.to_str().unwrap();
        let words = ["run", "--quiet", "--releases", "60", "--threads", threads, "--out", out];
        let done = rockfall(&[&words[..], &[&scene]].concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        std::fs::read_to_string(Path::new(out).join("releases.csv")).unwrap()
    };
    let bare = releases("bare", "", "1");
    assert!(bare.lines().count() == 61);
    assert_eq!(bare, releases("strong", "breaks_above_j = 1e12", "1"));
    let weak = "breaks_above_j = { uniform = [1.0, 100.0] }";
    let passed = releases("weak", weak, "1");
    assert_ne!(bare, passed);
    assert_eq!(passed, releases("weak", weak, "3"));
}

#[test]
fn stems_from_a_list_stand_in_the_slope() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let list =
        "species, x, y, dbh_m, height_m\nspruce, 10, 5, 0.4, 20\nlarch, 12.5, 9, 0.25, 15.5\n";
    std::fs::write(path("list.csv"), list).unwrap();
    let stems = |words: &[&str]| rockfall(&[&["mesh", "stems"], words].concat());
    let slope = "terrain/quick_slope.stl";
    let made = stems(&[&path("list.csv"), slope, &path("stems.stl")]);
    let said = String::from_utf8_lossy(&made.stdout).into_owned();
    assert!(made.status.success() && said.starts_with("2 stems, 56 triangles"), "{made:?}");
    let soup = rockfall::terrain::stl::read(Path::new(&path("stems.stl"))).unwrap();
    let top = soup.facets.iter().flatten().map(|corner| corner.z).fold(f64::MIN, f64::max);
    let (ground, _) = slope_at(slope, 10.0, 5.0);
    assert!((top - (ground + 20.0)).abs() < 1e-3, "{top} {ground}");
    // the foot of each is below the ground all round
    for corner in soup.facets.iter().flatten() {
        let (ground, _) = slope_at(slope, corner.x, corner.y);
        assert!((corner.z - ground).abs() > 0.4, "{corner:?} {ground}");
    }
    // the same list on the map, where the scene has an origin
    std::fs::write(
        path("map.csv"),
        "x,y,dbh_m,height_m\n2600010,1200005,0.4,20\n2600012.5,1200009,0.25,15.5\n",
    )
    .unwrap();
    let words = [&path("map.csv"), slope, &path("map.stl"), "--origin-m", "2600000,1200000,0"];
    assert!(stems(&words).status.success());
    let map = rockfall::terrain::stl::read(Path::new(&path("map.stl"))).unwrap();
    for (one, other) in soup.facets.iter().flatten().zip(map.facets.iter().flatten()) {
        assert!((one - other).norm() < 1e-5);
    }
}

/// Height of a slope file (m) and its terrain.
fn slope_at(file: &str, x: f64, y: f64) -> (f64, Terrain) {
    let sheet = Sheet { path: file.into(), ground: 0, is_tree: false };
    let source = rockfall::terrain::read::MeshSource::stl(sheet);
    let (terrain, _) = Terrain::read(&[source], Vec3::zeros(), None).unwrap();
    let origin = terrain.origin_m;
    (terrain.ground_below(x - origin.x, y - origin.y).unwrap() + origin.z, terrain)
}

#[test]
fn a_bad_list_is_refused_with_its_line() {
    let dir = tempfile::tempdir().unwrap();
    let bad = [
        ("x,y,dbh_m,height_m\n", "rows: found no tree; write comma-separated"),
        (
            "x,y,dbh_m,height_m\n10,5,0.4,20\n10,5,-0.4,20\n",
            "line 3: found dbh_m = -0.4; write a number above 0",
        ),
        (
            "x,y,dbh_m,height_m\n10,5,0.4,inf\n",
            "line 2: found height_m = inf; write a number above 0",
        ),
        (
            "x,y,dbh_m,height_m\n10,5,thick,20\n",
            "line 2: found 10,5,thick,20; write comma-separated",
        ),
        (
            "x;y;dbh_m;height_m\n10;5;0,4;20\n",
            "line 1: found the header x;y;dbh_m;height_m; put commas between its columns",
        ),
        (
            "x,y,dbh_cm,height_m\n10,5,40,20\n",
            "line 1: found the header x,y,dbh_cm,height_m; write comma",
        ),
        (
            "x,y,dbh_m,height_m\n1e6,5,0.4,20\n",
            "line 2: found no slope at (1000000, 5); write a place",
        ),
        ("x,y,dbh_m,height_m\nnan,5,0.4,20\n", "line 2: found a place (NaN, 5); write comma"),
    ];
    for (text, promised) in bad {
        let list = dir.path().join("list.csv");
        std::fs::write(&list, text).unwrap();
        let out = dir.path().join("out.stl");
        let [list, out] = [&list, &out].map(|path| path.to_str().unwrap());
        let said = rockfall(&["mesh", "stems", list, "terrain/quick_slope.stl", out]);
        let stderr = String::from_utf8_lossy(&said.stderr).into_owned();
        assert_eq!(said.status.code(), Some(2), "{stderr}");
        assert!(stderr.starts_with(&format!("error: {list}: {promised}")), "{stderr}");
        assert!(!Path::new(out).exists());
    }
}

/// Rocks of one world break stems as rocks alone do, also side by side in one island: each loses what the stem could take, and
/// finds a stem whole that another has broken.
#[test]
fn rocks_of_one_world_break_stems_each_for_itself() {
    let limit_j = 0.3 * shot_j();
    let terrain = stand(1, Some(limit_j));
    for (scheme, numerics) in SCHEMES {
        let world = World {
            scheme,
            tolerance_m_s: if scheme == Scheme::Reference { 1e-8 } else { 1e-3 },
            step_s: if scheme == Scheme::Dda { 1e-5 } else { 1e-2 },
            grounds: 2,
            ..WORLD
        };
        let at = |x: f64, z: f64| -> Sphere {
            (ROCK.radius_m, ROCK.density_kg_m3, [x, 0.0, z], [10.0, 0.0, 0.0], [0.0; 3])
        };
        // one far above, two in one island, and one that comes later to a stem that is broken for the others
        let spheres = [at(-4.0, 3.0), at(-4.0, 0.0), at(-4.0, -1.05), at(-6.0, 0.0)];
        let (falls, _) = world.run(&terrain, &spheres, 3.0);
        for fall in &falls {
            let lost = lost_j(fall) / shot_j();
            assert!(
                (lost - 0.3).abs() < numerics.max(1e-6),
                "{scheme:?}: {lost} {:?}",
                fall.ledger
            );
            assert!(
                (fall.ledger.trees_j - limit_j).abs() < 1e-6 * shot_j(),
                "{scheme:?} {:?} {limit_j} {:?}",
                fall.ledger,
                fall.start
            );
            assert_eq!(fall.tree_impact_count, 1, "{scheme:?}");
            // what the stem took is booked once
            let remainder = fall.ledger.remainder_j.abs() / shot_j();
            assert!(remainder < numerics.max(1e-6), "{scheme:?}: {:?}", fall.ledger);
        }
    }
}

//! Grounds of the catalogue, and how a file's axes lie: what the program says of them.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::{asked, program};

use asked::{Asked, USUAL, plate, scene, word};
use program::rockfall;
use rockfall::rock::Vec3;
use rockfall::scene::{CATALOGUE, Scene, known_ground};
use rockfall::terrain::stl::write_ascii;
use std::fs;
use std::path::Path;

fn said(args: &[&str]) -> String {
    let done = rockfall(args);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// A source without rolling friction leaves a sphere that nothing stops: warned of until the scene gives it.
#[test]
fn a_ground_on_which_nothing_stops_a_sphere_is_warned_of() {
    let dir = tempfile::tempdir().unwrap();
    let scene = scene(dir.path(), &plate(5.0, 0.0), &USUAL);
    let text = fs::read_to_string(&scene).unwrap();
    let plan = |ground: &str| {
        fs::write(&scene, text.replace("restitution = 0.4", ground)).unwrap();
        said(&["plan", word(&scene)])
    };
    let warning = "[grounds.rock] like crsp/talus: its source has no rolling friction, and without any nothing stops a sphere";
    let bare = plan("like = \"crsp/talus\"");
    assert!(bare.contains(warning) && bare.contains("rock: on no slope"), "{bare}");
    assert!(bare.contains("rock like crsp/talus: restitution 0.300 to 0.330"), "{bare}");
    let own = plan("like = \"crsp/talus\"\nrolling_friction = 0.5");
    assert!(!own.contains(warning) && own.contains("rock: on slopes of up to 26.6°"), "{own}");
    let stone = plan("like = \"rstone/debris\"");
    assert!(
        !stone.contains("nothing stops") && stone.contains("rock: on slopes of up to"),
        "{stone}"
    );
    // springs of the scene: a quarter, and what that gives back where e = 0.4
    let tangential = plan("restitution = 0.4");
    assert!(
        tangential.contains("rock: shear over normal spring 0.2500, tangential restitution 0.1"),
        "{tangential}"
    );
}

/// What was fitted to a field test stands in the catalogue as in the example of that test.
#[test]
fn fitted_grounds_are_those_of_their_examples() {
    for (example, name) in [("tschamut", "tschamut/meadow"), ("tschamut_blocks", "soil/meadow")] {
        let path = Path::new("examples").join(format!("{example}.toml"));
        let own = Scene::read(&path).unwrap().grounds["meadow"].clone();
        let text = fs::read_to_string(&path).unwrap();
        let (head, rest) = text.split_once("[grounds.meadow]\n").unwrap();
        let (_, rest) = rest.split_once("\n[").unwrap();
        let beside = known_ground(name).unwrap().beside.unwrap();
        // the corner radius of blocks is no value of the ground
        let beside = beside.split(", ").filter(|part| {
            part.contains("_n_m") || part.contains("_deg") || part.contains("_ratio")
        });
        let beside = beside.collect::<Vec<_>>().join("\n");
        let ground = format!("[grounds.meadow]\nlike = \"{name}\"\n{beside}\n[");
        let scene = Scene::parse(&[head, &ground, rest].concat(), &path).unwrap();
        let mut taken = scene.grounds["meadow"].clone();
        assert_eq!(taken.like.take().as_deref(), Some(name));
        // a quarter of the normal spring, as the example writes it
        let ratio = taken.tangential_ratio.take().unwrap().as_fixed().unwrap();
        let springs = [&own.normal_stiffness_n_m, own.shear_stiffness_n_m.as_ref().unwrap()];
        let [normal, shear] = springs.map(|value| value.as_fixed().unwrap());
        assert!((shear - ratio * normal).abs() < 1e-6 * shear, "{ratio}");
        taken.shear_stiffness_n_m.clone_from(&own.shear_stiffness_n_m);
        assert_eq!(taken, own);
    }
}

/// Every entry says where it was read, and that none of the sources knows the tangential ratio, or beside what it was fitted.
#[test]
fn every_entry_names_its_source() {
    let list = said(&["grounds"]);
    for entry in list.split("\n\n").skip(1) {
        assert!(entry.contains("\n    source: "), "{entry}");
        let is_read = entry.contains("\n    tangential ratio: none known\n");
        assert!(
            is_read || entry.contains("\n    fitted beside normal_stiffness_n_m = "),
            "{entry}"
        );
    }
    assert_eq!(list.split("\n\n").count(), 1 + CATALOGUE.len());
    assert!(CATALOGUE.iter().all(|ground| list.contains(ground.name)));
}

/// The same slope from a file whose y points up: turned by 90° about x, in the check and in a scene.
#[test]
fn a_file_whose_y_points_up_is_turned() {
    let dir = tempfile::tempdir().unwrap();
    let (high, low) = ([[0.0, 0.0, 0.0], [30.0, 0.0, 0.0]], [[30.0, 10.0, 5.0], [0.0, 10.0, 5.0]]);
    let [a, b] = high.map(Vec3::from);
    let [c, d] = low.map(Vec3::from);
    let facets = [[a, b, c], [a, c, d]];
    // (x, y, z) of the file becomes (x, −z, y): what becomes (x, y, z) was (x, z, −y)
    let turned = facets.map(|facet| facet.map(|p| Vec3::new(p.x, p.z, -p.y)));
    write_ascii(&dir.path().join("z.stl"), "slope", &facets).unwrap();
    write_ascii(&dir.path().join("y.stl"), "slope", &turned).unwrap();
    let check = |name: &str, up: &[&str]| {
        let file = dir.path().join(name);
        said(&[&["mesh", "check"], up, &[word(&file)]].concat()).replace(name, "slope.stl")
    };
    assert_eq!(check("z.stl", &[]), check("y.stl", &["--up", "y"]));
    assert_eq!(check("z.stl", &[]), check("z.stl", &["--up", "z"]));
    assert_ne!(check("z.stl", &[]), check("y.stl", &[]));
    let place = "count = 5\nheight_m = 1.0\npoints_m = [[15.0, 5.0]]";
    let scene = scene(dir.path(), &facets, &Asked { place, ..USUAL });
    let text = fs::read_to_string(&scene).unwrap();
    let rows = |mesh: &str| {
        fs::write(&scene, text.replace("mesh = \"mesh.stl\"", mesh)).unwrap();
        let out = dir.path().join("out");
        said(&["run", word(&scene), "--quiet", "--overwrite", "--out", word(&out)]);
        fs::read_to_string(out.join("releases.csv")).unwrap()
    };
    assert_eq!(rows("mesh = \"z.stl\""), rows("mesh = \"y.stl\"\nup = \"y\""));
}

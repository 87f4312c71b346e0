//! Rocks that share a world come to an end, like rocks alone.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot run the program has failed"
)]

use crate::asked::{Asked, closed_box, plate, scene, stops, stops_and_words};
use crate::program;
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Three rocks of one world in a closed box.
const THREE: &str =
    "count = 3\ntogether = true\npoints_m = [[0.5, 0.5, 1.0], [1.0, 1.0, 1.0], [1.5, 1.5, 1.2]]";

/// Contact of rocks without bonds.
fn contact(restitution: f64) -> String {
    format!(
        "[rocks.contact]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 1e7\nfriction_angle_deg = 30.0\nrestitution = {restitution:?}\ntensile_strength_pa = 0.0\ncohesion_pa = 0.0"
    )
}

/// Rocks that share a world: between plates that leave one the width of an atom, its work is spent, while the others go
/// on to their rest; in a closed box without loss all end by time or budget.
#[test]
fn worlds_that_never_rest_end_by_time_or_budget() {
    let dir = tempfile::tempdir().unwrap();
    let contact = contact(1.0);
    let plates = [plate(5.0, 0.0), plate(5.0, 0.400_000_001)].concat();
    for scheme in ["rigid", "adaptive"] {
        let more = format!("{contact}\n[solver]\nscheme = \"{scheme}\"");
        let asked = Asked {
            restitution: 1.0,
            place: "count = 2\ntogether = true\npoints_m = [[0.0, 0.0, 0.2000000005], [4.0, 0.0, 0.2000000005]]",
            velocity: [0.0, 0.0, 3.0],
            more: &more,
        };
        let scene = scene(dir.path(), &plates, &asked);
        let begun = Instant::now();
        let (ends, said) = stops_and_words(&scene, &[]);
        println!("{scheme}: {ends:?} in {:?}", begun.elapsed());
        let summary = fs::read_to_string(dir.path().join("out/summary.json")).unwrap();
        if scheme == "rigid" {
            assert_eq!(ends, ["over_budget", "over_budget"]);
            assert!(summary.contains("\"over_budget\": 2"), "counted");
            assert!(
                said.contains("warning: 2 of 2 rocks were still moving when their budget"),
                "{said}"
            );
        }
        let known = ["over_budget", "time_up", "at_rest", "left_terrain"];
        assert!(ends.iter().all(|stop| known.contains(&stop.as_str())), "{ends:?}");
    }
    for scheme in ["rigid", "adaptive"] {
        let more = format!("{contact}\n[solver]\nscheme = \"{scheme}\"\nlongest_s = 5.0");
        let asked =
            Asked { restitution: 1.0, place: THREE, velocity: [3.0, 2.0, 1.0], more: &more };
        let ends = stops(&scene(dir.path(), &closed_box(), &asked), &[]);
        let known = ["time_up", "over_budget"];
        assert!(ends.iter().all(|stop| known.contains(&stop.as_str())), "{scheme}: {ends:?}");
    }
}

/// A world is written as a whole: one that is ended before has nothing to go on with, and says so.
#[test]
#[cfg(unix)]
fn a_terminated_world_is_started_again() {
    let dir = tempfile::tempdir().unwrap();
    let contact = contact(1.0);
    let more = format!("{contact}\n[solver]\nscheme = \"adaptive\"\nlongest_s = 5000.0");
    let asked = Asked { restitution: 1.0, place: THREE, velocity: [3.0, 2.0, 1.0], more: &more };
    let scene = scene(dir.path(), &closed_box(), &asked);
    let out = dir.path().join("killed");
    let words = ["run", scene.to_str().unwrap(), "--quiet", "--out", out.to_str().unwrap()];
    let child = program::command(&words).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !out.exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(200));
    let told = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(told.success());
    let ended = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("interrupted: 0 of 3 releases are written"), "{said}");
    assert!(
        said.contains("start again with: rockfall run") && !said.contains("--resume"),
        "{said}"
    );
}

/// Two runs of a world: that their rocks are not independent is said where their differences are.
#[test]
fn a_comparison_of_worlds_says_that_their_rocks_depend_on_each_other() {
    let dir = tempfile::tempdir().unwrap();
    let contact = contact(0.5);
    for (together, is_said) in [("true", true), ("false", false)] {
        let more = format!("{contact}\n[solver]\nscheme = \"rigid\"\nlongest_s = 0.5");
        let place = format!(
            "count = 2\ntogether = {together}\npoints_m = [[0.5, 0.5, 1.0], [1.5, 1.5, 1.2]]"
        );
        let velocity = [3.0, 2.0, 1.0];
        let asked = Asked { restitution: 0.5, place: &place, velocity, more: &more };
        let scene = scene(dir.path(), &closed_box(), &asked);
        let folder = |name: &str| dir.path().join(format!("{name}_{together}"));
        let [a, b, out] =
            ["a", "b", "compared"].map(folder).map(|path| path.to_str().unwrap().to_owned());
        for (seed, to) in [("1", &a), ("2", &b)] {
            let words = ["run", scene.to_str().unwrap(), "--quiet", "--seed", seed, "--out", to];
            let done = program::rockfall(&words);
            assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        }
        let said = program::rockfall(&["compare", &a, &b, "--out", &out]).stdout;
        let page = fs::read_to_string(folder("compared").join("compare.html")).unwrap();
        for text in [String::from_utf8(said).unwrap(), page] {
            assert_eq!(text.contains("A, B: the rocks of one world meet"), is_said, "{text}");
        }
    }
}

/// Blows through contacts so unlike that they are not followed to their end are told of before the run: by their masses and stiffnesses together, and
/// sooner where nothing rebounds.
#[test]
fn blows_that_are_not_followed_are_told_of() {
    let dir = tempfile::tempdir().unwrap();
    let is_told = |(radii_m, stiffness_n_m, restitution): (&str, &str, f64), scheme: &str| {
        let contact = contact(restitution).replace("1e8", stiffness_n_m);
        let more = format!("{contact}\n[solver]\nscheme = \"{scheme}\"");
        let asked = Asked { restitution, place: THREE, velocity: [0.0; 3], more: &more };
        let scene = scene(dir.path(), &closed_box(), &asked);
        let text = fs::read_to_string(&scene).unwrap();
        let sized = text.replace("radius_m = 0.2", &format!("radius_m = {radii_m}"));
        assert_ne!(text == sized, radii_m != "0.2");
        fs::write(&scene, sized).unwrap();
        let told = program::rockfall(&["plan", scene.to_str().unwrap()]);
        assert!(told.status.success(), "{}", String::from_utf8_lossy(&told.stderr));
        String::from_utf8_lossy(&told.stdout).contains("taken one by one")
    };
    let wide = "{ uniform = [0.005, 0.2] }";
    assert!(!is_told(("0.2", "1e8", 0.5), "rigid"));
    assert!(!is_told((wide, "1e8", 0.5), "rigid"));
    assert!(is_told((wide, "1e8", 0.0), "rigid"));
    assert!(is_told((wide, "1e12", 0.5), "rigid"));
    assert!(!is_told((wide, "1e12", 0.5), "adaptive"));
}

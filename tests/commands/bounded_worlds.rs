//! Rocks that share a world come to an end, like rocks alone.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot run the program has failed"
)]

use crate::asked::{Asked, closed_box, plate, scene, stops, stops_and_words};
use std::fs;
use std::time::Instant;

/// Rocks that share a world: between plates that leave one the width of an atom, its work is spent, while the others go
/// on to their rest; in a closed box without loss all end by time or budget.
#[test]
fn worlds_that_never_rest_end_by_time_or_budget() {
    let dir = tempfile::tempdir().unwrap();
    let contact = "[rocks.contact]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 1e7\nfriction_angle_deg = 30.0\nrestitution = 1.0\ntensile_strength_pa = 0.0\ncohesion_pa = 0.0";
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
        let asked = Asked {
            restitution: 1.0,
            place: "count = 3\ntogether = true\npoints_m = [[0.5, 0.5, 1.0], [1.0, 1.0, 1.0], [1.5, 1.5, 1.2]]",
            velocity: [3.0, 2.0, 1.0],
            more: &more,
        };
        let ends = stops(&scene(dir.path(), &closed_box(), &asked), &[]);
        let known = ["time_up", "over_budget"];
        assert!(ends.iter().all(|stop| known.contains(&stop.as_str())), "{scheme}: {ends:?}");
    }
}

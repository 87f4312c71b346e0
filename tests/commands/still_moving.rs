//! What maps and lines lack of rocks that would have gone on is said beside them, and only where it is true.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::asked;

use asked::{Asked, USUAL, plate, scene, stops};
use std::fs;

/// Rocks thrown to the east over a level plate towards a line. When their time is up before they are there, map and line lack
/// them, and barrier and page say so; when they cross the line and leave over the edge, nothing lacks.
#[test]
fn rocks_that_may_still_come_are_said_beside_maps_and_lines() {
    let places = "[[lines]]\nname = \"road\"\npoints_m = [[3.0, -5.0], [3.0, 5.0]]\n\
        [[lines]]\nname = \"far\"\npoints_m = [[4.5, -5.0], [4.5, 5.0]]\n\
        [[barriers]]\nname = \"net\"\npoints_m = [[2.0, -5.0], [2.0, 5.0]]\nheight_m = 0.1\ncapacity_j = 1.0\n[maps]\ncell_m = 1.0";
    let place = "count = 60\nheight_m = 0.1\nline_m = [[-2.0, -1.0], [2.5, 1.0]]";
    let velocity = [4.0, 0.0, 0.0];
    for (longest_s, lacks) in [(0.4, true), (20.0, false)] {
        let dir = tempfile::tempdir().unwrap();
        let more = format!("{places}\n[solver]\nlongest_s = {longest_s:?}");
        let scene =
            scene(dir.path(), &plate(5.0, 0.0), &Asked { place, velocity, more: &more, ..USUAL });
        let ends = stops(&scene, &[]);
        let open = ends.iter().filter(|end| *end == "time_up").count();
        assert_eq!(open, if lacks { 60 } else { 0 }, "{ends:?}");
        let summary = fs::read_to_string(dir.path().join("out/summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
        let found = &summary["open_on_maps"]["count"];
        assert_eq!(found.as_u64(), lacks.then_some(60), "{found}");
        for line in summary["lines"].as_array().unwrap() {
            let left = 60 - line["reach"]["count"].as_u64().unwrap();
            let found = line["may_still_come"]["count"].as_u64();
            assert_eq!(found, lacks.then_some(left), "{line}");
        }
        let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
        let on_maps = "Rocks that ended on the map and would have gone on: 60 (100";
        assert_eq!(page.matches(on_maps).count(), if lacks { 3 } else { 0 });
        // of a line to which all may still come it is not said that they are few
        assert_eq!(page.contains("its reach probability may be up to 100"), lacks);
        assert!(!page.contains("of so few"));
        let at_line = "Rocks that may still come here, with any energy and height: ";
        // road and net have a table each, the net one of what arrives besides
        assert_eq!(page.matches(at_line).count(), if lacks { 3 } else { 0 });
    }
}

//! The lowest ground under a line, which says what energy a rock must have to come to it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::site;

use serde_json::Value;
use site::{Folder, SIZE, height, scene};
use std::fs;

/// A line across the slope near row 29 of the cells, one that goes on beside the terrain, and a road below both. No ground of the
/// first is lower than its floor, which lies no more than two rows below it; of what has no ground somewhere nothing is known.
#[test]
fn a_line_knows_its_lowest_ground_where_it_has_ground_everywhere() {
    let dir = Folder::new();
    dir.slope();
    let line = |name: &str, east: f64| {
        format!(
            "[[lines]]\nname = \"{name}\"\npoints_m = [[2600004.0, 1200040.5], [{east:?}, 1200040.5]]\n"
        )
    };
    let road = "[[objects]]\nname = \"road\"\nwidth_m = 4.0\npoints_m = [[2600010.0, 1200030.5], [2600040.0, 1200030.5]]\n[frequency]\nper_year = 0.1\n";
    let more = line("inside", 2_600_050.0) + &line("beyond", 2_600_090.0) + road;
    let out = dir.run("run", &scene("file = \"dem.tif\"", &more));
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let floor = |name: &str| {
        let lines = summary["lines"].as_array().unwrap();
        let line = lines.iter().find(|line| line["name"] == name).unwrap();
        line["floor"]["ground_m"].as_f64()
    };
    let lowest =
        |row: usize| (0..SIZE[0]).map(|column| height(column, row)).fold(f64::INFINITY, f64::min);
    let inside = floor("inside").unwrap();
    assert!((lowest(32)..=lowest(29)).contains(&inside), "{inside}");
    assert_eq!(floor("beyond"), None);
    // half of its width and the radius of the rocks, 2.3 m, below its middle, and two rows more
    let road = floor("road").unwrap();
    assert!((lowest(39)..=lowest(35)).contains(&road), "{road}");
}

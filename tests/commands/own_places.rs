//! Measured ends are compared with the rocks that were released where they were.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program::rockfall;
use crate::site::{Folder, scene};
use std::fs;

/// Ten ends from one of two places, one of them high and one low on the slope, and two from the other: the page compares them with the rocks of these
/// places as ten to two, not with all rocks alike.
#[test]
fn each_measured_end_stands_beside_the_rocks_of_its_own_place() {
    let dir = Folder::new();
    dir.slope();
    let places = [[2_600_014.5, 1_200_083.25], [2_600_044.5, 1_200_052.25]];
    let row = |k: usize| {
        let [x, y] = places[usize::from(k >= 10)];
        format!("{x},{y},{x},{}\n", y - 20.0 - k as f64)
    };
    let rows: String = (0..12).map(row).collect();
    dir.put("ends.csv", format!("release_x_m,release_y_m,x_m,y_m\n{rows}"));
    let more = format!(
        "points_m = {places:?}|[calibrate]\ndeposits = \"ends.csv\"\n\
         vary = [{{ ground = \"rock\", key = \"rolling_friction\", from = 0.4, to = 0.9, before = 0.4 }}]\n"
    );
    let line = "line_m = [[2600010.5, 1200090.25], [2600050.5, 1200090.25]]";
    dir.put("own.toml", scene("file = \"dem.tif\"", &more).replace(line, ""));
    let (file, out) = (dir.path("own.toml"), dir.path("out"));
    let [file, to] = [&file, &out].map(|path| path.to_str().unwrap());
    let done = rockfall(&["run", file, "--quiet", "--releases", "200", "--out", to]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let table = fs::read_to_string(out.join("releases.csv")).unwrap();
    let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|one| *one == name).unwrap();
    let (at, runout) = (column("start_y_m"), column("runout_m"));
    let mut runouts = [Vec::new(), Vec::new()];
    for row in table.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let y: f64 = cells[at].parse().unwrap();
        runouts[usize::from((y - places[0][1]).abs() > 0.1)].push(cells[runout].parse().unwrap());
    }
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let [high, low] = [0, 1].map(|k| mean(&runouts[k]));
    let own = (10.0 * high + 2.0 * low) / 12.0;
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    let said = page.split(" m measured, ").nth(1).and_then(|rest| rest.split(" (").next());
    // some rocks have left the terrain: the mean is a lower bound, and marked so
    let number = said.map(|said| said.trim_start_matches(|c: char| !c.is_ascii_digit()));
    let found: f64 = number.and_then(|said| said.parse().ok()).unwrap();
    assert!((high - low).abs() > 5.0, "the places must be unlike: {high} {low}");
    assert!((found - own).abs() <= 0.5 + 1e-9, "{found} for {own}: {high} and {low}");
    assert!(page.contains("from its own place of release"));
}

//! Numbers read off the page are those of the tables: each in its own column, in its unit, inside its interval.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program::rockfall;
use std::fs;
use std::path::Path;

/// The page of an example with 400 releases, and its folder's tables.
fn page(dir: &Path, example: &str) -> String {
    let out = dir.join(example);
    let (scene, to) = (format!("examples/{example}.toml"), out.to_str().unwrap());
    let done = rockfall(&["run", &scene, "--quiet", "--releases", "400", "--out", to]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    fs::read_to_string(out.join("report.html")).unwrap()
}

/// Value, lower and upper end of the cells with an interval, as they are written.
fn cells(part: &str) -> Vec<[f64; 3]> {
    let cell = |text: &str| -> Option<[f64; 3]> {
        let (value, rest) = text.split_once("<br><small>")?;
        let (low, high) = rest.split_once("</small>")?.0.split_once(" to ")?;
        let [value, low, high] = [value, low, high].map(|number| number.parse().ok());
        Some([value?, low?, high?])
    };
    part.split("<td class=\"number\">").skip(1).filter_map(cell).collect()
}

/// Of all cells with an interval the lower end is not above the value, nor the value above the upper end, whether rocks weigh alike or by their
/// frequency, as where what passes a net is what it does not stop.
#[test]
fn every_value_lies_between_the_ends_of_its_interval() {
    let dir = tempfile::tempdir().unwrap();
    for example in ["quick", "road"] {
        let all = cells(&page(dir.path(), example));
        assert!(all.len() > 8, "{example}: {} cells", all.len());
        for [value, low, high] in all {
            assert!(low <= value && value <= high, "{example}: {value} ({low} to {high})");
        }
    }
}

/// At the foot of a face a rock is less far from the slope along its normal than straight down; the mesh is compared with the diameter of
/// the median rock, twice its radius.
#[test]
fn heights_and_diameters_are_what_their_columns_say() {
    let dir = tempfile::tempdir().unwrap();
    let page = page(dir.path(), "quick");
    let row = page.split("<th scope=\"row\">foot of the face</th>").nth(1).unwrap();
    let [.., [vertical, ..], [normal, ..]] = cells(row.split("</tr>").next().unwrap())[..] else {
        panic!("{row}")
    };
    let summary = fs::read_to_string(dir.path().join("quick/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    for (column, said) in [("height_m", vertical), ("height_normal_m", normal)] {
        let p95 = &summary["lines"][0]["statistics"][column]["percentiles"]["p95"]["value"];
        let p95 = p95.as_f64().unwrap();
        assert!((said - p95).abs() <= 0.0051, "{column}: {said} for {p95}");
    }
    assert!(vertical - normal > 0.05, "{vertical} {normal}");
    let mut rows = csv::Reader::from_path(dir.path().join("quick/releases.csv")).unwrap();
    let at = rows.headers().unwrap().iter().position(|name| name == "radius_m").unwrap();
    let mut radii_m: Vec<f64> =
        rows.records().map(|row| row.unwrap()[at].parse().unwrap()).collect();
    radii_m.sort_by(f64::total_cmp);
    let diameter_m = radii_m[199] + radii_m[200];
    let said = page.split("times the diameter of the median rock (").nth(1).unwrap();
    let said: f64 = said.split_once(" m)").unwrap().0.parse().unwrap();
    // two digits are said
    assert!((said / diameter_m - 1.0).abs() < 0.05, "{said} for {diameter_m}");
}

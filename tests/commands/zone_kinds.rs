//! Zones of release that differ in kind, and what is told of the classes of rocks that come from them.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::drawn::zones;
use crate::program::rockfall;
use crate::site::{Folder, scene};
use crate::zone_sources::{over_zones, summary, without_radius};
use std::fs;

/// Points, lines and polygons have no common measure, and laws of other kinds neither: the message says what each of two zones is, and what would do.
#[test]
fn zones_that_cannot_be_compared_are_told_apart() {
    let dir = Folder::new();
    let line =
        "{\"type\":\"LineString\",\"coordinates\":[[2600040.25,1200070.5],[2600048.25,1200070.5]]}";
    let mixed = |properties: [&str; 2], second: &str| {
        let text = over_zones(&dir, properties, "");
        let drawn = zones(properties);
        let (first, other) = drawn.rsplit_once("\"geometry\":").unwrap();
        assert!(other.starts_with("{\"type\":\"Polygon\""));
        dir.put("zones.geojson", format!("{first}\"geometry\":{second}}}]}}"));
        dir.refusal(&text)
    };
    let (often, events) = ("\"frequency_per_year\":0.3", "\"per_year_at_1m3\":0.3");
    for (properties, parts) in [
        (
            ["", ""],
            [
                "feature 2: found lines with neither weight nor frequency where feature 1 has polygons",
                "for every zone, or one file",
            ],
        ),
        (
            [often, events],
            [
                "feature 2: found lines with per_year_at_1m3 where feature 1 has polygons with frequency_per_year",
                "the same one of",
            ],
        ),
        (
            ["\"weight\":2", ""],
            ["feature 2: found no weight, which feature 1 has", "for all zones or for none"],
        ),
    ] {
        let said = mixed(properties, line);
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}\n{said}");
    }
    // of three, the one with another measure is named, and not the one with another geometry
    let three = over_zones(&dir, [often, often], "");
    let drawn = zones([often, often]);
    let (first, _) = drawn.rsplit_once("\"geometry\":").unwrap();
    let other = format!(
        "{{\"type\":\"Feature\",\"properties\":{{\"name\":\"c\",{events}}},\"geometry\":{line}}}"
    );
    dir.put("zones.geojson", format!("{first}\"geometry\":{line}}},{other}]}}"));
    let said = dir.refusal(&three);
    let found = "feature 3: found lines with per_year_at_1m3 where feature 1 has polygons with frequency_per_year";
    assert!(said.contains(found), "{said}");
    let collection = format!(
        "{{\"type\":\"GeometryCollection\",\"geometries\":[{line},{{\"type\":\"Point\",\"coordinates\":[2600040.25,1200070.5]}}]}}"
    );
    let said = mixed([often, often], &collection);
    assert!(
        said.contains("feature 2: found a GeometryCollection of LineString, Point; draw"),
        "{said}"
    );
}

/// Every release tells its source and class, and what all rocks of the class stand for; a class of which nothing comes to a line has a row in the first table
/// of the page, and all are counted in the summary. A scene of one class has neither.
#[test]
fn classes_are_told() {
    let dir = Folder::new();
    // small rocks in the west; large ones start below the road
    let text = over_zones(
        &dir,
        [
            "\"name\":\"west\",\"frequency_per_year\":0.3,\"volume_m3\":0.25",
            "\"name\":\"east, low\",\"frequency_per_year\":0.1,\"volume_min_m3\":0.5,\"volume_max_m3\":2.0",
        ],
        "",
    );
    let text = without_radius(&text).replace("[2600060.0, 1200040.5]", "[2600030.0, 1200040.5]");
    let out = dir.run("classes", &text);
    let mut rows = csv::Reader::from_path(out.join("releases.csv")).unwrap();
    let header = rows.headers().unwrap().clone();
    let classes = ["source", "class_from_m3", "class_to_m3", "class_per_year"];
    assert_eq!(header.iter().skip(header.len() - 4).collect::<Vec<_>>(), classes);
    for (index, row) in rows.records().enumerate() {
        let row = row.unwrap();
        let told: Vec<&str> = row.iter().skip(header.len() - 4).collect();
        let west = ["west", "0.25", "0.25", "0.3"];
        assert_eq!(told, if index % 2 == 0 { west } else { ["east, low", "0.5", "2.0", "0.1"] });
    }
    let by_class = &summary(&out)["lines"][0]["by_class"];
    assert_eq!((&by_class[0]["source"], &by_class[0]["released"]), (&"west".into(), &20.into()));
    assert!(by_class[0]["reached"].as_u64().unwrap() > 0, "{by_class}");
    assert_eq!((&by_class[1]["released"], &by_class[1]["reached"]), (&20.into(), &0.into()));
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("road: 0 of 20 rocks of east, low, 0.50–2.0 m³"), "no row of the class");
    // what is read back of it draws the same page
    let [file, folder] = [dir.path("classes.toml"), out.clone()];
    assert!(file.exists());
    assert!(rockfall(&["draw", folder.to_str().unwrap()]).status.success());
    assert!(fs::read_to_string(out.join("report.html")).unwrap() == page);
    let one = dir.run("one", &scene("file = \"dem.tif\"", ""));
    assert!(!fs::read_to_string(one.join("releases.csv")).unwrap().contains("class_per_year"));
}

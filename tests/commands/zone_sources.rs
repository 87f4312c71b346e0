//! Zones of release as sources: each with the frequency that its properties in a GeoJSON file or Shapefile say.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::drawn;
use crate::site;

use drawn::{column, rings, shapefile, zones};
use rockfall::frequency::{Class, Frequency, FrequencyLaw};
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use serde_json::Value;
use site::{Folder, scene};
use std::fs;
use std::path::Path;

/// A scene over two zones of some properties; `year` stands in `[frequency]`.
pub(crate) fn over_zones(dir: &Folder, properties: [&str; 2], year: &str) -> String {
    dir.slope();
    dir.put("zones.geojson", zones(properties));
    let road =
        "[[lines]]\nname = \"road\"\npoints_m = [[2600002.0, 1200040.5], [2600060.0, 1200040.5]]\n";
    scene("file = \"dem.tif\"", &format!("zones = \"zones.geojson\"|{road}[frequency]\n{year}"))
}

/// The same where the sources have volumes.
pub(crate) fn without_radius(scene: &str) -> String {
    scene.replace("radius_m = 0.3\n", "")
}

fn sources(dir: &Folder, scene: &str) -> Frequency {
    Scene::read(&dir.put("scene.toml", scene)).unwrap().sources().unwrap()
}

pub(crate) fn summary(out: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap()
}

/// Each zone is a source: releases come from them in turn, each rock stands for its part of the zone's frequency, and the
/// passages of a line a year are those summed by hand over its crossings.
#[test]
fn each_zone_releases_as_often_as_it_says() {
    let dir = Folder::new();
    let text = over_zones(
        &dir,
        [
            "\"name\":\"west\",\"frequency_per_year\":0.3",
            "\"name\":\"east\",\"frequency_per_year\":0.1",
        ],
        "",
    );
    let file = dir.put("scene.toml", &text);
    let scene = Scene::read(&file).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    let plan = Plan::compile(&scene, terrain).unwrap();
    // no size is sampled here, and none is said to be
    let said = plan.to_string();
    assert!(said.contains("the same number of rocks is computed for every source"), "{said}");
    assert!(!said.contains("large rocks are computed more often"), "{said}");
    for index in 0..40 {
        assert_eq!(plan.releases.zone_of(index), Some(index % 2));
        let at = plan.release(index).unwrap().motion.position_m + plan.terrain.origin_m;
        let x = [2_600_010.5, 2_600_040.25][index % 2];
        assert!((x..=x + 8.0).contains(&at.x), "{index} at {at}");
    }
    let out = dir.run("run", &text);
    let found = summary(&out);
    let near = |found: &Value, exact: f64| {
        let found = found.as_f64().unwrap();
        assert!((found / exact - 1.0).abs() < 1e-9, "{found} for {exact}");
    };
    near(&found["annual"]["events_per_year"], 0.4);
    let rows = fs::read_to_string(out.join("crossings.csv")).unwrap();
    let index = |row: &str| row.split(',').next().unwrap().parse::<usize>().unwrap();
    let part = |row: &str| [0.3, 0.1][index(row) % 2] / 20.0;
    let by_hand: f64 = rows.lines().skip(1).map(part).sum();
    assert!(by_hand > 0.05, "{rows}");
    near(&found["annual"]["places"][0]["without_barriers"]["passages"]["per_year"], by_hand);
    let reach = &found["annual"]["places"][0]["conditional_on_release"]["share"];
    near(reach, by_hand / 0.4);
    // which zone is which, on the map and for a GIS
    let plan = fs::read_to_string(out.join("figures/plan.svg")).unwrap();
    let zones = fs::read_to_string(out.join("maps/release_zone.geojson")).unwrap();
    for name in ["west", "east"] {
        assert!(plan.contains(&format!("{name}</text>")), "{name}");
        assert!(zones.contains(&format!("\"name\":\"{name}\"")), "{zones}");
    }
}

/// What properties and `[frequency]` say together is a law: a total and a common power law, 1 m³ events, one volume, a range.
#[test]
fn properties_and_table_make_a_law() {
    let dir = Folder::new();
    let common = "exponent = 0.5\nvolume_m3 = [0.25, 4.0]\n";
    let text = over_zones(
        &dir,
        [
            "\"frequency_per_year\":0.3",
            "\"per_year_at_1m3\":0.2,\"exponent\":1.0,\"volume_min_m3\":0.5,\"volume_max_m3\":2.0",
        ],
        common,
    );
    let found = sources(&dir, &without_radius(&text));
    // a (0.25^−½ − 4^−½) = 1.5 a = 0.3
    let common_law = FrequencyLaw::PowerLaw {
        per_year_at_1m3: 0.3 / 1.5,
        exponent: 0.5,
        volume_m3: [0.25, 4.0],
    };
    let own = FrequencyLaw::PowerLaw { per_year_at_1m3: 0.2, exponent: 1.0, volume_m3: [0.5, 2.0] };
    assert_eq!([&found.sources()[0].law, &found.sources()[1].law], [&common_law, &own]);
    // 0.3 in all, and 0.2 (0.5^−1 − 2^−1)
    assert!((found.per_year() - 0.6).abs() < 1e-12);
    let text = over_zones(
        &dir,
        [
            "\"frequency_per_year\":0.3,\"volume_m3\":1.5",
            "\"frequency_per_year\":0.1,\"volume_min_m3\":0.5,\"volume_max_m3\":2.0",
        ],
        "",
    );
    let found = sources(&dir, &without_radius(&text));
    let class = |volume_m3: [f64; 2], per_year: f64| {
        FrequencyLaw::Classes(vec![Class { volume_m3, per_year }])
    };
    let laws = [class([1.5; 2], 0.3), class([0.5, 2.0], 0.1)];
    assert_eq!([&found.sources()[0].law, &found.sources()[1].law], [&laws[0], &laws[1]]);
    // one volume beside a common law is one volume
    let text = over_zones(
        &dir,
        ["\"frequency_per_year\":0.3,\"volume_m3\":1.5", "\"frequency_per_year\":0.1"],
        common,
    );
    assert_eq!(sources(&dir, &without_radius(&text)).sources()[0].law, laws[0]);
}

/// The names of a Shapefile are cut after ten letters: the same bytes as of the GeoJSON file. What a run writes of its zones
/// can be named again, frequency and all.
#[test]
fn shapefile_geojson_and_what_is_written_give_the_same_bytes() {
    let dir = Folder::new();
    let text = over_zones(&dir, ["\"frequency_per_year\":0.3", "\"frequency_per_year\":0.125"], "");
    let first = dir.run("first", &text);
    dir.put("cut.shp", shapefile(&rings()));
    dir.put("cut.dbf", column("frequency_per_year", &["0.3", "0.125"]));
    let table = |out: &Path, name: &str| fs::read_to_string(out.join(name)).unwrap();
    for file in ["cut.shp", "first/maps/zones.geojson"] {
        let name = file.replace(['.', '/'], "_");
        let again = dir.run(&name, &text.replace("zones.geojson", file));
        for name in ["releases.csv", "frequency.csv"] {
            assert!(table(&again, name) == table(&first, name), "{file}: {name}");
        }
    }
    assert!(table(&first, "maps/zones.geojson").contains("\"share\":0.5"));
}

/// What makes no law is refused with the feature and what to write; contradictions too.
#[test]
fn what_is_no_law_is_refused() {
    let dir = Folder::new();
    let (often, volume) = ("\"frequency_per_year\":0.3", "\"volume_m3\":2.0");
    let both = format!("{often},\"per_year_at_1m3\":1");
    let with_volume = format!("{often},{volume}");
    let with_both = format!("{with_volume},\"exponent\":0.5");
    let one_end = format!("{often},\"volume_min_m3\":0.5");
    let swapped = format!("{often},\"volume_min_m3\":5,\"volume_max_m3\":0.5");
    let steep = format!("{often},\"exponent\":50,\"volume_min_m3\":0.5,\"volume_max_m3\":5");
    let law = "exponent = 0.5\n";
    for (properties, year, words) in [
        ([often, ""], "", "feature 2: found no frequency_per_year"),
        ([often, "\"frequency_per_year\":0"], "", "feature 2: found frequency_per_year = 0"),
        ([&both, often], "", "feature 1: found frequency_per_year and per_year_at_1m3"),
        (
            [often, &with_volume],
            "",
            "feature 2: found volumes in feature 2 and none in feature 1, which takes [rocks] radius_m",
        ),
        ([&with_both, often], "", "feature 1: found exponent beside volume_m3"),
        ([often, &one_end], "", "feature 2: found one end of a range"),
        ([often, &swapped], "", "feature 2: found the volumes 5 and 0.5"),
        ([&steep, often], "", "feature 1: found too large an exponent"),
        ([often, "\"frequency_per_year\":1e-300"], "", "feature 2: found 0.000"),
        ([often, often], law, "feature 1: found no volume_min_m3"),
        ([often, "\"per_year_at_1m3\":1"], "", "feature 2: found no exponent"),
        ([&with_volume, &with_volume], "", "found 0.3; remove it: the volumes of [frequency]"),
        ([often, often], "per_year = 0.2\n", "found a law beside the frequency of feature 1"),
        ([often, often], "exponent = -1.0\n", "[frequency] exponent (line"),
        ([often, often], "volume_m3 = [5.0, 1.0]\n", "[frequency] volume_m3 (line"),
    ] {
        let said = dir.refusal(&over_zones(&dir, properties, year));
        assert!(said.contains(words), "{words}\n{said}");
        let remedy = ["write", "remove"].iter().any(|word| said.contains(word));
        assert!(remedy, "{said}");
    }
    // volumes in the zones and no radius_m: nothing is missing; a radius is, where there are no volumes
    let text = over_zones(&dir, [&with_volume, &with_volume], "");
    assert!(dir.plan(&without_radius(&text)).contains("each a source of its own"));
    let text = over_zones(&dir, [often, often], "");
    assert!(dir.refusal(&without_radius(&text)).contains("[rocks] radius_m"));
}

/// Frequencies that nobody asks for, and weights that nobody uses, are said in the plan.
#[test]
fn what_is_not_used_is_said() {
    let dir = Folder::new();
    let often =
        ["\"frequency_per_year\":0.3,\"weight\":2", "\"frequency_per_year\":0.1,\"weight\":1"];
    let text = over_zones(&dir, often, "");
    assert!(dir.plan(&text).contains("the weights of"), "{}", dir.plan(&text));
    let asks_nothing = text.replace("[frequency]\n", "");
    assert!(
        dir.plan(&asks_nothing).contains("write the table [frequency], and each zone is a source")
    );
    // a scene whose files were not read is refused, not a panic
    let file = dir.put("scene.toml", &text);
    let parsed = Scene::parse(&text, &file).unwrap();
    let (terrain, _) = parsed.read_terrain().unwrap();
    assert!(Plan::compile(&parsed, terrain).is_err());
}

/// Terrain is cut to what the rocks of the sources can reach, as for a place of `[release]`.
#[test]
fn terrain_is_cut_around_sources() {
    let dir = Folder::new();
    dir.slope();
    let terrain = "file = \"dem.tif\"\ncrop = { reach_angle_deg = 30.0, margin_m = 4.0 }";
    let alone = scene(terrain, "");
    let place = "line_m = [[2600010.5, 1200090.25], [2600050.5, 1200090.25]]\n";
    assert!(alone.contains(place));
    let law = "per_year = 0.1\n";
    let source =
        format!("{}[[frequency.sources]]\nname = \"wall\"\n{place}{law}", alone.replace(place, ""));
    let triangles = |scene: &str| {
        let plan = dir.plan(scene);
        let line = plan.lines().find(|line| line.starts_with("terrain")).map(str::to_owned);
        line.unwrap_or_else(|| panic!("{plan}"))
    };
    assert_eq!(triangles(&source), triangles(&format!("{alone}[frequency]\n{law}")));
}

/// A point beside an area: without weights their sizes have no common measure, with a frequency each none is needed.
#[test]
fn zones_of_mixed_geometry_are_sources_without_weights() {
    let dir = Folder::new();
    let text = over_zones(&dir, ["\"weight\":1", "\"weight\":1"], "");
    let mixed = |one: &str, two: &str| {
        let feature = |geometry: &str, properties: &str| {
            format!(
                "{{\"type\":\"Feature\",\"properties\":{{{properties}}},\"geometry\":{{{geometry}}}}}"
            )
        };
        let point = "\"type\":\"Point\",\"coordinates\":[2600014.5,1200083.25]";
        let line = "\"type\":\"LineString\",\"coordinates\":[[2600040.5,1200080.25],[2600050.5,1200080.25]]";
        let features = [feature(point, one), feature(line, two)].join(",");
        dir.put(
            "zones.geojson",
            format!("{{\"type\":\"FeatureCollection\",\"features\":[{features}]}}"),
        );
    };
    mixed("\"frequency_per_year\":0.3", "\"frequency_per_year\":0.1");
    let file = dir.put("scene.toml", &text);
    let read = Scene::read(&file).unwrap();
    let zones = read.release.zone_list.as_ref().unwrap();
    assert!((zones.share(0) - 0.75).abs() < 1e-12, "as often as they release rocks");
    assert!(!dir.plan(&text).contains("are not used"));
    let unasked = text.replace("[frequency]\n", "");
    let said = dir.plan(&unasked);
    assert!(said.contains("shared by their frequencies"), "{said}");
    mixed("\"frequency_per_year\":0.3", "");
    assert!(dir.refusal(&text).contains("or frequency_per_year"));
}

/// A zone that a GIS has taken apart has the frequency or weight of the whole in each part: counted for each, it would release twice as often. So it is
/// refused. Parts that only lie somewhere are one zone, which shares its releases by area as one feature of both would.
#[test]
fn a_name_that_stands_twice_is_one_zone_or_refused() {
    let dir = Folder::new();
    let refused = |properties: &str, year: &str| {
        let file = dir.put("scene.toml", over_zones(&dir, [properties; 2], year));
        let why = Scene::read(&file).unwrap_err().to_string();
        assert!(why.contains("feature 2: found the name \"cliff\" of feature 1 again"), "{why}");
        assert!(why.contains("write another name, or make one feature of several parts"), "{why}");
    };
    refused("\"name\":\"cliff\",\"frequency_per_year\":0.3", "");
    refused("\"name\":\"cliff\",\"weight\":2.0", "per_year = 0.1\n");
    dir.put("zones.geojson", zones(["\"name\":\"cliff\""; 2]));
    let said = dir.plan(&scene("file = \"dem.tif\"", "zones = \"zones.geojson\"|"));
    assert!(
        said.contains("over 1 zones in 2 features of ") && said.contains("by their areas"),
        "{said}"
    );
}

/// A hole as large as its polygon leaves nothing, and parts that overlap would count twice.
#[test]
fn rings_that_meet_are_refused() {
    let dir = Folder::new();
    dir.slope();
    let square = |west: u32| {
        let (x, y) = (2_600_010 + west, 1_200_080);
        let [east, north] = [x + 8, y + 8];
        format!("[[{x},{y}],[{east},{y}],[{east},{north}],[{x},{north}],[{x},{y}]]")
    };
    let drawing = |kind: &str, rings: String| {
        format!(
            r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","properties":{{}},"geometry":{{"type":"{kind}","coordinates":[{rings}]}}}}]}}"#
        )
    };
    let twice = drawing("Polygon", format!("{0},{0}", square(0)));
    let overlap = drawing("MultiPolygon", format!("[{}],[{}]", square(0), square(4)));
    for (drawing, says) in
        [(twice, "found a ring twice"), (overlap, "or two parts that overlap; write holes inside")]
    {
        dir.put("zones.geojson", drawing);
        let said = dir.refusal(&scene("file = \"dem.tif\"", "zones = \"zones.geojson\"|"));
        assert!(said.contains("zones.geojson: feature 1: ") && said.contains(says), "{said}");
    }
}

/// Volumes of zones that nothing asks for change no size, and the plan says so.
#[test]
fn volumes_that_are_not_used_are_said() {
    let dir = Folder::new();
    let said = |properties: &str, year: &str| {
        let text = over_zones(&dir, [properties; 2], year).replace("[frequency]\nNONE", "");
        let scene = Scene::read(&dir.put("scene.toml", &text)).unwrap();
        let (terrain, _) = scene.read_terrain().unwrap();
        Plan::compile(&scene, terrain).unwrap().to_string()
    };
    let warning = "says how large the rocks of its zones are, which is not used";
    assert!(said("\"volume_m3\":1.0", "NONE").contains(warning));
    assert!(said("\"volume_m3\":1.0", "per_year = 0.1").contains(warning));
    assert!(!said("\"weight\":1.0", "NONE").contains(warning));
}

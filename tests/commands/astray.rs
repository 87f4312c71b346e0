//! Inputs that are read and do not mean what they seem to: trees beside the slope, coordinates of few digits, names in capitals.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::program::rockfall;
use crate::site::{Folder, ORIGIN, scene};
use rockfall::rock::Vec3;
use rockfall::terrain::stl::{Facet, read, write_ascii};
use std::fmt::Write as _;

const SLOPE: &str = "mesh = \"dem.stl\"";
const TREES: &str = "|[[trees]]\nground = \"scree\"\nmesh = \"stems.stl\"\n";

/// Fifteen thick stems across the slope, which every rock meets, as a mesh moved by so much (m).
fn stems(dir: &Folder, moved: [f64; 3]) {
    dir.slope();
    let rows = (0..15).map(|k| format!("{},1200050.0,2.0,18.0\n", 2_600_010 + 3 * k));
    let list = dir.put("trees.csv", format!("x,y,dbh_m,height_m\n{}", rows.collect::<String>()));
    let (slope, out) = (dir.path("dem.stl"), dir.path("stems.stl"));
    let [list, slope, to] = [&list, &slope, &out].map(|path| path.to_str().unwrap());
    let words = ["mesh", "stems", list, slope, to, "--origin-m", "2600000,1200000,0"];
    assert!(rockfall(&words).status.success());
    let by = Vec3::from(moved);
    let all: Vec<Facet> =
        read(&out).unwrap().facets.iter().map(|facet| facet.map(|at| at + by)).collect();
    write_ascii(&out, "stems", &all).unwrap();
}

/// What is warned of by a run of a scene, its plan included.
fn run(dir: &Folder, scene: &str) -> String {
    let (file, out) = (dir.put("run.toml", scene), dir.path("out"));
    let [file, out] = [&file, &out].map(|path| path.to_str().unwrap());
    let said = rockfall(&["run", file, "--overwrite", "--out", out]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    String::from_utf8(said.stdout).unwrap()
}

/// A forest ten metres above the slope is met by no rock, and was taken without a word.
#[test]
fn trees_that_do_not_stand_on_the_slope_are_said() {
    let dir = Folder::new();
    let text = scene(SLOPE, TREES);
    stems(&dir, [0.0; 3]);
    let said = run(&dir, &text);
    assert!(!said.contains("do not stand") && !said.contains("touched one"), "{said}");
    for (moved, counts) in [
        ([0.0, 0.0, 20.0], "15 with their foot more than 0.5 m above it, 0 with"),
        (
            [0.0, 0.0, -60.0],
            "0 with their foot more than 0.5 m above it, 15 with their top under it",
        ),
        ([-90.0, 0.0, 0.0], "0 with their top under it, 15 beside it"),
    ] {
        stems(&dir, moved);
        let said = run(&dir, &text);
        assert!(said.contains("stems.stl: 15 of 15 stems do not stand on the slope"), "{said}");
        assert!(said.contains(counts), "{counts}: {said}");
        assert!(said.contains("warning: trees: none of 40 rocks touched one"), "{said}");
        let page = std::fs::read_to_string(dir.path("out/report.html")).unwrap();
        assert!(page.contains("15 of 15 stems do not stand") && page.contains("touched one"));
    }
}

/// Six digits are steps of 10 m on the map, on which most cells of 2 m fall together: refused, and `mesh check` says so too.
#[test]
fn a_text_of_few_digits_is_refused() {
    let dir = Folder::new();
    dir.slope();
    let facets = read(&dir.path("dem.stl")).unwrap().facets;
    let mut text = String::from("solid s\n");
    for facet in facets.iter() {
        text += "facet normal 0 0 1\nouter loop\n";
        for corner in facet {
            let [x, y] = [2_600_000.0 + corner.x, 1_200_000.0 + corner.y];
            writeln!(text, "vertex {x:.5e} {y:.5e} {:.2}", corner.z).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    dir.put("dem.stl", text + "endsolid s\n");
    let said = dir.refusal(&scene(SLOPE, "").replace(ORIGIN, ""));
    assert!(said.contains("written in steps of 10, ") && said.contains("three decimals"), "{said}");
}

/// The property WEIGHT is weight; one that is none of those of zones is named.
#[test]
fn properties_of_zones_are_read_in_any_case() {
    let dir = Folder::new();
    dir.slope();
    let zone = |name: &str, x: f64, properties: &str| {
        format!(
            "{{\"type\":\"Feature\",\"properties\":{{\"NAME\":\"{name}\",{properties}}},\"geometry\":{{\"type\":\"LineString\",\"coordinates\":[[{x},1200090.25],[{},1200090.25]]}}}}",
            x + 10.0
        )
    };
    let zones = |a: &str, b: &str| {
        let both = [zone("A", 2_600_010.5, a), zone("B", 2_600_030.5, b)].join(",");
        dir.put("z.geojson", format!("{{\"type\":\"FeatureCollection\",\"features\":[{both}]}}"));
    };
    let text = scene("file = \"dem.tif\"", "zones = \"z.geojson\"|");
    zones("\"WEIGHT\":1,\"Frequency\":2", "\"WEIGHT\":9");
    let said = dir.plan(&text);
    assert!(said.contains("shared by their weights"), "{said}");
    assert!(
        said.contains("z.geojson: properties that are not used: Frequency; zones have name"),
        "{said}"
    );
    zones("\"WEIGHT\":1,\"weight\":2", "\"WEIGHT\":9");
    let said = dir.refusal(&text);
    assert!(said.contains("feature 1: found the properties WEIGHT and weight"), "{said}");
}

/// A release line over a step of 20 m in 1 m: the places on the wall have ground and no tree, and no height is clear of it.
#[test]
fn places_on_a_wall_are_said_to_be_too_steep() {
    let dir = Folder::new();
    let heights = [(0.0, 20.0), (30.0, 20.0), (31.0, 0.0), (62.0, 0.0)];
    let strip = |ends: &[(f64, f64)]| {
        let at = |(x, z): (f64, f64), y: f64| Vec3::new(x, y, z);
        let [a, b] = [ends[0], ends[1]];
        let corners = [at(a, 0.0), at(b, 0.0), at(b, 100.0), at(a, 100.0)];
        [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
    };
    let facets: Vec<Facet> = heights.windows(2).flat_map(strip).collect();
    write_ascii(&dir.path("dem.stl"), "wall", &facets).unwrap();
    let said = dir.plan(&scene(SLOPE, ""));
    let share = said.split("of the terrain; ").nth(1).and_then(|rest| rest.split(" %").next());
    // the wall, and the ground a radius before its foot: 1.3 m of the 40 m of the line
    let share: f64 = share.unwrap().parse().unwrap();
    assert!((1.5..5.0).contains(&share), "{said}");
    assert!(said.contains("% on ground so steep that no height is clear of it)"), "{said}");
}

/// A slope whose heights have lost their sign is a slope as well, with its valleys as ridges. Releases at their own heights then start far above
/// it, and where none comes to it that is said too.
#[test]
fn a_slope_with_negated_heights_is_said() {
    let dir = Folder::new();
    dir.slope();
    let said = run(&dir, &scene(SLOPE, ""));
    assert!(!said.contains("touched the ground"), "{said}");
    let facets = read(&dir.path("dem.stl")).unwrap().facets;
    let mirrored: Vec<Facet> =
        facets.iter().map(|facet| facet.map(|at| Vec3::new(at.x, at.y, -200.0 - at.z))).collect();
    write_ascii(&dir.path("dem.stl"), "slope", &mirrored).unwrap();
    let text = scene(SLOPE, "");
    let line = "line_m = [[2600010.5, 1200090.25], [2600050.5, 1200090.25]]";
    let point = "points_m = [[2600020.5, 1200090.25, 60.0]]";
    let text = text.replace(line, point).replace("height_m = 0.5\n", "");
    let said = dir.plan(&text);
    assert!(
        said.contains(
            "1000 of 1000 releases tried out start more than 100 m above the ground, up to 3"
        ),
        "{said}"
    );
    assert!(!said.contains("touched the ground"), "{said}");
    let said = run(&dir, &text.replace("longest_s = 20.0", "longest_s = 0.5"));
    assert!(said.contains("warning: none of 40 rocks touched the ground"), "{said}");
    let page = std::fs::read_to_string(dir.path("out/report.html")).unwrap();
    assert!(
        page.contains("none of 40 rocks touched the ground") || page.contains("None of 40 rocks")
    );
}

/// The same as of STL: a text PLY of six digits on the map is refused.
#[test]
fn a_ply_of_few_digits_is_refused() {
    let dir = Folder::new();
    dir.slope();
    let facets = read(&dir.path("dem.stl")).unwrap().facets;
    let count = facets.len();
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {count}\nproperty list uchar int vertex_indices\nend_header\n",
        3 * count
    );
    for corner in facets.iter().flatten() {
        let [x, y] = [2_600_000.0 + corner.x, 1_200_000.0 + corner.y];
        writeln!(text, "{x:.5e} {y:.5e} {:.2}", corner.z).unwrap();
    }
    for face in 0..count {
        writeln!(text, "3 {} {} {}", 3 * face, 3 * face + 1, 3 * face + 2).unwrap();
    }
    dir.put("few.ply", text);
    let said = dir.refusal(&scene("file = \"few.ply\"", "").replace(ORIGIN, ""));
    assert!(said.contains("written in steps of 10, ") && said.contains("three decimals"), "{said}");
}

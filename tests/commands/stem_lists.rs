//! Stems from lists of trees, written or drawn: as a mesh of their own, and stood on the slope by the scene itself.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::program::rockfall;
use crate::site::{Folder, scene};
use rockfall::scene::Scene;
use rockfall::terrain::Terrain;
use std::fs;
use std::path::Path;

/// East, north, diameter, height (m).
const TREES: [[f64; 4]; 2] =
    [[2_600_020.5, 1_200_060.5, 0.4, 18.0], [2_600_031.25, 1_200_050.0, 0.6, 22.0]];

fn table() -> String {
    let rows = TREES.map(|tree| tree.map(|number| number.to_string()).join(","));
    format!("x,y,dbh_m,height_m\n{}\n", rows.join("\n"))
}

fn drawing(system: &str) -> String {
    let points = TREES.map(|[x, y, dbh, height]| {
        format!(
            "{{\"type\":\"Feature\",\"properties\":{{\"dbh_m\":{dbh},\"height_m\":{height}}},\"geometry\":{{\"type\":\"Point\",\"coordinates\":[{x},{y}]}}}}"
        )
    });
    format!("{{\"type\":\"FeatureCollection\",{system}\"features\":[{}]}}", points.join(","))
}

/// Stems from drawn points are those from the same list.
#[test]
fn stems_stand_where_points_are_drawn() {
    let dir = Folder::new();
    dir.slope();
    let stems = |list: &Path| {
        let (out, slope) = (dir.path("stems.stl"), dir.path("dem.stl"));
        let words = [
            "mesh",
            "stems",
            list.to_str().unwrap(),
            slope.to_str().unwrap(),
            out.to_str().unwrap(),
            "--origin-m",
            "2600000,1200000,0",
        ];
        let said = rockfall(&words);
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        fs::read(out).unwrap()
    };
    let (list, drawn) = (dir.put("trees.csv", table()), dir.put("trees.geojson", drawing("")));
    assert!(stems(&list) == stems(&drawn));
}

fn with_trees(slope: &str, trees: &str) -> String {
    scene(slope, &format!("|[[trees]]\nground = \"scree\"\n{trees}\n"))
}

/// The scene stands the trees of a list on the elevation model: the same stems as of a mesh of them, with all digits, and
/// the same from every kind of list.
#[test]
fn a_scene_stands_trees_on_its_slope() {
    let dir = Folder::new();
    dir.slope();
    dir.put("trees.csv", table());
    dir.put("trees.geojson", drawing(""));
    let terrain = |text: &str| -> Terrain {
        Scene::read(&dir.put("scene.toml", text)).unwrap().read_terrain().unwrap().0
    };
    let slope = "file = \"dem.tif\"";
    let listed = terrain(&with_trees(slope, "file = \"trees.csv\""));
    let drawn = terrain(&with_trees(slope, "file = \"trees.geojson\""));
    assert_eq!((&listed.vertices_m, &listed.triangles), (&drawn.vertices_m, &drawn.triangles));
    let stems: Vec<u32> =
        (0..listed.triangles.len() as u32).filter(|&t| listed.is_tree(t)).collect();
    // eight sides of two triangles, two lids of six
    assert_eq!(stems.len(), 28 * TREES.len());
    for [x, y, dbh, height] in TREES {
        let at = |t: &&u32| {
            listed.corners_m(**t).map(|corner| corner + listed.origin_m).iter().all(|corner| {
                let off = (corner.x - x).hypot(corner.y - y);
                (off - 0.5 * dbh).abs() < 1e-6
            })
        };
        let own: Vec<&u32> = stems.iter().filter(at).collect();
        assert_eq!(own.len(), 28);
        let tops = own.iter().flat_map(|t| listed.corners_m(**t)).map(|corner| corner.z);
        let [local_x, local_y] = [x - listed.origin_m.x, y - listed.origin_m.y];
        let ground = listed.ground_below(local_x, local_y).unwrap();
        assert!((tops.fold(f64::MIN, f64::max) - ground - height).abs() < 1e-6);
    }
    let plan = dir.plan(&with_trees(slope, "file = \"trees.csv\""));
    assert!(
        plan.contains("list of trees") && plan.contains("2 stems, stood on the slope"),
        "{plan}"
    );
    // a changed tree is another scene
    let hash = || Scene::read(&dir.path("scene.toml")).unwrap().hash;
    let before = hash();
    dir.put("trees.geojson", drawing("").replace("0.6", "0.7"));
    assert_ne!(hash(), before);
}

/// Trees beside the slope as it is cropped are left out, with a word on how many and which is the first; those that stand are what they were. The same for
/// drawn points, and for `mesh stems`.
#[test]
fn trees_over_no_ground_are_left_out() {
    let dir = Folder::new();
    dir.slope();
    let far = |text: String| text.replace("2600020.5", "2700020.5");
    dir.put("trees.csv", far(table()));
    dir.put("trees.geojson", far(drawing("")));
    let all = table();
    let one = all.lines().filter(|line| !line.contains("2600020.5")).collect::<Vec<_>>();
    dir.put("one.csv", one.join("\n"));
    let slope = "file = \"dem.tif\"";
    let facets = |list: &str| {
        let text = with_trees(slope, &format!("file = \"{list}\""));
        let terrain = Scene::read(&dir.put("scene.toml", text)).unwrap().read_terrain().unwrap().0;
        (terrain.vertices_m.clone(), terrain.triangles)
    };
    let standing = facets("one.csv");
    for (list, first) in [("trees.csv", "in line 2"), ("trees.geojson", "as feature 1")] {
        assert!(facets(list) == standing, "{list}");
        let plan = dir.plan(&with_trees(slope, &format!("file = \"{list}\"")));
        let said = format!(
            "{list}: 1 of 2 stems are left out, as no ground lies below them, the first {first} at (2700020.5, 1200060.5)"
        );
        assert!(plan.contains(&said) && plan.contains("1 stem, stood on the slope"), "{plan}");
    }
    let [list, slope, out] = ["trees.csv", "dem.stl", "stems.stl"].map(|name| dir.path(name));
    let [list, slope, out] = [&list, &slope, &out].map(|path| path.to_str().unwrap());
    let said = rockfall(&["mesh", "stems", list, slope, out, "--origin-m", "2600000,1200000,0"]);
    let said = String::from_utf8(said.stdout).unwrap();
    assert!(
        said.starts_with("1 stem, 28 triangles") && said.contains("1 of 2 stems are left out"),
        "{said}"
    );
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let dir = Folder::new();
    dir.slope();
    dir.put("trees.csv", table());
    dir.put("far.csv", table().replace("26000", "27000"));
    dir.put("flat.csv", "x,y,dbh_m,height_m\n2600020.5,1200060.5,0,18\n");
    dir.put("centimetres.csv", table().replace("0.4", "40"));
    dir.put("centimetres.geojson", drawing("").replace("0.4", "40"));
    dir.put("semicolons.csv", table().replace(',', ";"));
    dir.put("german.csv", table().replace("dbh_m", "bhd_cm"));
    dir.put("latin.csv", b"x,y,dbh_m,h\xf6he\n1,2,0.3,20\n");
    dir.put("empty.csv", "");
    let swiss =
        "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"urn:ogc:def:crs:EPSG::21781\"}},";
    dir.put("other.geojson", drawing(swiss));
    dir.put("sizeless.geojson", drawing("").replace("dbh_m", "dbh"));
    let slope = "file = \"dem.tif\"";
    for (text, parts) in [
        (
            with_trees(slope, "file = \"far.csv\""),
            ["line 2", "found no slope at (2700020.5, 1200060.5), nor below any other of 2 stems"],
        ),
        (with_trees(slope, "file = \"flat.csv\""), ["line 2", "found dbh_m = 0"]),
        (
            with_trees(slope, "file = \"centimetres.csv\""),
            ["line 2: found dbh_m = 40", "30 cm has dbh_m = 0.3"],
        ),
        (
            with_trees(slope, "file = \"centimetres.geojson\""),
            ["feature 1: found dbh_m = 40", "30 cm has dbh_m = 0.3"],
        ),
        (
            with_trees(slope, "file = \"semicolons.csv\""),
            ["line 1: found the header x;y;dbh_m;height_m", "under the header x,y,dbh_m,height_m"],
        ),
        (
            with_trees(slope, "file = \"german.csv\""),
            ["line 1: found the header x,y,bhd_cm,height_m", "x,y,dbh_m,height_m"],
        ),
        (with_trees(slope, "file = \"latin.csv\""), ["line 1", "save it in UTF-8"]),
        (
            with_trees(slope, "file = \"semicolons.csv\""),
            ["line 1", "put commas between its columns"],
        ),
        (
            scene("file = \"dem.tif\"\nclasses = [2]", ""),
            ["dem.tif: classes: found it", "LAS, LAZ"],
        ),
        (with_trees(slope, "file = \"empty.csv\""), ["found no tree", "under the header x,y"]),
        (
            with_trees(slope, "file = \"other.geojson\""),
            ["found EPSG:21781", "ogr2ogr -t_srs EPSG:2056"],
        ),
        (with_trees(slope, "file = \"sizeless.geojson\""), ["feature 1", "found no dbh_m"]),
        (
            with_trees(slope, "file = \"trees.csv\"\nresample_m = 4.0"),
            ["crop, resample_m", "so are stems"],
        ),
        (with_trees(slope, "file = \"trees.csv\"\nscale = 2.0"), ["up, scale", "a list of trees"]),
        (with_trees(slope, "file = \"dem.tif\""), ["[[trees]]", "a list of trees with"]),
        (scene("file = \"trees.csv\"", ""), ["a drawing or a list of trees", "[[trees]] file"]),
    ] {
        let said = dir.refusal(&text);
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}\n{said}");
    }
}

/// A wrong row is named by its line in the file, whatever ends the lines, behind empty lines too.
#[test]
fn a_wrong_row_is_named_by_its_line() {
    let dir = Folder::new();
    dir.slope();
    for end in ["\n", "\r\n", "\r"] {
        let (list, slope) = (dir.path("stems.csv"), dir.path("dem.stl"));
        fs::write(&list, ["x,y,dbh_m,height_m", "1,2,0.3,18", "", "", "3,4,0.3,nan"].join(end))
            .unwrap();
        let files =
            [&list, &slope, &dir.path("out.stl")].map(|path| path.to_str().unwrap().to_owned());
        let answer = rockfall(&["mesh", "stems", &files[0], &files[1], &files[2]]);
        let said = String::from_utf8(answer.stderr).unwrap();
        assert!(said.contains("line 5: found height_m = NaN"), "{end:?}: {said}");
    }
}

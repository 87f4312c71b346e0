//! Tiles of one elevation model are one slope: no gap between those that touch, no double surface where they overlap.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::site::{Folder, SIZE, height, scene};
use crate::tiff::{Kind, Spec, write};
use rockfall::scene::Scene;
use rockfall::terrain::Terrain;
use rockfall::terrain::health::Health;
use std::fs;

/// Writes the part of the slope from a column and row (from the north) as a file of its own.
fn put_tile(dir: &Folder, name: &str, [column, row]: [usize; 2], size: [usize; 2]) {
    let spec = Spec::new(Kind::F64, size);
    let (west, north) = (spec.tie[3] + 2.0 * column as f64, spec.tie[4] - 2.0 * row as f64);
    let tile = Spec { tie: vec![0.0, 0.0, 0.0, west, north, 0.0], ..spec };
    let heights = move |x: usize, y: usize| height(column + x, row + y);
    dir.put(name, write(&[(&tile, &heights)]));
}

fn files(names: &[&str]) -> String {
    let tables: Vec<String> = names.iter().map(|name| format!("file = \"{name}\"")).collect();
    tables.join("\n[[terrain]]\nground = \"rock\"\n")
}

fn read(dir: &Folder, terrain: &str) -> (Terrain, Health) {
    Scene::read(&dir.put("scene.toml", scene(terrain, ""))).unwrap().read_terrain().unwrap()
}

/// Corners of all triangles in map coordinates, whatever their order.
fn triangles(terrain: &Terrain) -> Vec<[[u64; 3]; 3]> {
    let on_map = |t: u32| {
        let mut corners = terrain
            .corners_m(t)
            .map(|corner| <[f64; 3]>::from(corner + terrain.origin_m).map(f64::to_bits));
        corners.sort_unstable();
        corners
    };
    let mut all: Vec<_> = (0..terrain.triangles.len() as u32).map(on_map).collect();
    all.sort_unstable();
    all
}

/// Two by two tiles, once side by side and once with five cells in common, are the whole; so are their reports of it.
#[test]
fn tiles_are_the_whole_slope() {
    let dir = Folder::new();
    dir.slope();
    let [wide, high] = SIZE;
    for (number, common) in [(0, 0), (1, 5)] {
        let (x, y) = (13, 22);
        for (name, corner, size) in [
            ("nw", [0, 0], [x + common, y + common]),
            ("ne", [x, 0], [wide - x, y + common]),
            ("sw", [0, y], [x + common, high - y]),
            ("se", [x, y], [wide - x, high - y]),
        ] {
            put_tile(&dir, &format!("{name}{number}.tif"), corner, size);
        }
        let tiles: Vec<String> =
            ["se", "nw", "sw", "ne"].iter().map(|name| format!("{name}{number}.tif")).collect();
        let names: Vec<&str> = tiles.iter().map(String::as_str).collect();
        let (whole, healthy) = read(&dir, "file = \"dem.tif\"");
        let (joined, health) = read(&dir, &files(&names));
        assert!(triangles(&joined) == triangles(&whole), "{common}");
        assert_eq!(
            (health.border_edges.count, health.border_loops, health.parts.len()),
            (healthy.border_edges.count, 1, 1)
        );
        let notes = &health.files[0].notes;
        assert!(notes.iter().any(|note| note.contains("joined with") && note.contains("nw")));
        // without the tile in the middle of the list a corner is missing
        let (fewer, health) = read(&dir, &files(&names[..3]));
        assert!(fewer.triangles.len() < whole.triangles.len());
        assert_eq!(health.parts.len(), 1);
    }
}

/// A run over tiles brings the rocks where the run over the whole brings them, up to rounding in the first impacts.
#[test]
fn rocks_do_not_feel_the_border_of_tiles() {
    let dir = Folder::new();
    dir.slope();
    put_tile(&dir, "upper.tif", [0, 0], [SIZE[0], 20]);
    put_tile(&dir, "lower.tif", [0, 20], [SIZE[0], SIZE[1] - 20]);
    let ends = |name: &str, terrain: &str| {
        let out = dir.run(name, &scene(terrain, ""));
        let table = fs::read_to_string(out.join("releases.csv")).unwrap();
        let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
        let column = head.iter().position(|name| *name == "end_y_m").unwrap();
        let value = |line: &str| line.split(',').nth(column).unwrap().parse::<f64>().unwrap();
        table.lines().skip(1).map(value).collect::<Vec<f64>>()
    };
    let whole = ends("whole", "file = \"dem.tif\"");
    let tiles = ends("tiles", &files(&["upper.tif", "lower.tif"]));
    // the border lies 20 cells of 2 m below the northern edge
    let passed = |all: &[f64]| all.iter().filter(|y| **y < 1_200_060.0).count();
    assert!(passed(&whole) > 20, "{}", passed(&whole));
    assert_eq!(passed(&tiles), passed(&whole));
    let apart = whole.iter().zip(&tiles).map(|(a, b)| (a - b).abs());
    let same = apart.filter(|m| *m < 1e-3).count();
    assert!(same * 10 >= whole.len() * 8, "{same} of {} end in the same place", whole.len());
}

#[test]
fn grids_that_lie_over_each_other_in_other_cells_are_refused() {
    let dir = Folder::new();
    dir.slope();
    let mut spec = Spec::new(Kind::F64, [10, 10]);
    spec.tie[3] += 21.0;
    spec.tie[4] -= 20.0;
    dir.put("shifted.tif", write(&[(&spec, &height)]));
    let said = dir.refusal(&scene(&files(&["dem.tif", "shifted.tif"]), ""));
    assert!(said.contains("found 18 x 18 m of ground that") && said.contains("gdalwarp"), "{said}");
    // beside each other, half a cell off: used, and the gap is told
    spec.tie[3] = 2_600_000.5 + 2.0 * SIZE[0] as f64 - 0.5;
    dir.put("beside.tif", write(&[(&spec, &height)]));
    let plan = dir.plan(&scene(&files(&["dem.tif", "beside.tif"]), ""));
    assert!(plan.contains("a gap of a cell to") && plan.contains("beside.tif"), "{plan}");
}

/// Of tiles that no rock comes to nothing is kept; if it comes to none, that is an error.
#[test]
fn tiles_out_of_reach_are_left_out() {
    let dir = Folder::new();
    dir.slope();
    put_tile(&dir, "upper.tif", [0, 0], [SIZE[0], 20]);
    let high = |_: usize, _: usize| 500.0;
    let mut spec = Spec::new(Kind::F64, [10, 10]);
    spec.tie[4] += 400.0;
    dir.put("peak.tif", write(&[(&spec, &high)]));
    let crop = "crop = { reach_angle_deg = 20.0, margin_m = 4.0 }";
    let tiles = format!(
        "file = \"upper.tif\"\n{crop}\n[[terrain]]\nground = \"rock\"\nfile = \"peak.tif\"\n{crop}"
    );
    let plan = dir.plan(&scene(&tiles, ""));
    assert!(plan.contains("left out: no cell lies below the places of release"), "{plan}");
    let peak = scene(&format!("file = \"peak.tif\"\n{crop}"), "");
    let said = dir.refusal(&peak);
    assert!(said.contains("found no cell below the places of release"), "{said}");
}

//! Other programs read the files: GDAL the grids and vectors with the right georeference, meshio the paths.
//!
//! Where a program is not installed its part is skipped, with a word.
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says what it leaves out"
)]

use crate::made;

use rockfall::output::{self as results, Mode};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// Runs a program; none, with a word, where it is not installed.
fn output(program: &str, words: &[&str]) -> Option<Output> {
    match Command::new(program).args(words).output() {
        Ok(output) => Some(output),
        Err(why) => {
            eprintln!("skipped: {program} cannot be run ({why})");
            None
        }
    }
}

fn text(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What GDAL says of a raster.
fn raster(path: &Path) -> Option<Value> {
    let said = output("gdalinfo", &["-json", "-mm", path.to_str().unwrap()])?;
    Some(serde_json::from_str(&text(&said)).unwrap())
}

#[test]
fn gdal_and_meshio_read_what_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let scene = "examples/tyrol.toml";
    let words = ["run", scene, "--quiet", "--releases", "24", "--out", out.to_str().unwrap()];
    text(&output(env!("CARGO_BIN_EXE_rockfall"), &words).unwrap());
    let summary: Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let maps = out.join("maps");
    rasters(&maps, &summary["maps"]);
    vectors(&maps);
    paths(&maps);
}

/// Both formats lie where the summary says; the GeoTIFF knows its system, an ASCII grid has no place for one.
fn rasters(maps: &Path, frame: &Value) {
    let number = |key: &str| frame[key].as_f64().unwrap();
    let (cell, north) = (number("cell_m"), number("south_m") + number("rows") * number("cell_m"));
    let place = [number("west_m"), cell, 0.0, north, 0.0, -cell];
    let grids = std::fs::read_dir(maps).unwrap().map(|entry| entry.unwrap().path());
    let mut seen = 0;
    // ground and trees, which the figures are drawn on, are grids alone
    // and the ground as used has cells of its own
    let maps = grids.filter(|path| path.file_stem().is_some_and(|stem| stem != "ground"));
    let maps = maps.filter(|path| path.with_extension("tif").exists());
    for asc in maps.filter(|path| path.extension().is_some_and(|end| end == "asc")) {
        let (Some(tif), Some(grid)) = (raster(&asc.with_extension("tif")), raster(&asc)) else {
            return;
        };
        for found in [&tif, &grid] {
            assert_eq!(found["size"], serde_json::json!([frame["columns"], frame["rows"]]));
            let transform = found["geoTransform"].as_array().unwrap();
            for (found, expected) in transform.iter().zip(place) {
                assert!((found.as_f64().unwrap() - expected).abs() < 1e-6, "{transform:?}");
            }
            assert_eq!(found["bands"][0]["noDataValue"].as_f64(), Some(-9999.0));
        }
        // the band says what it is
        let band = &tif["bands"][0];
        assert!(band["description"].as_str().is_some_and(|name| name.len() > 5), "{band}");
        let name = asc.file_stem().unwrap().to_string_lossy().into_owned();
        let unit = match name.rsplit('_').next() {
            Some("j") => Some("J"),
            Some("m") => Some("m"),
            _ => None,
        };
        assert_eq!(band["unit"].as_str().filter(|unit| !unit.is_empty()), unit, "{name}");
        let wkt = tif["coordinateSystem"]["wkt"].as_str().unwrap();
        assert!(wkt.contains("ID[\"EPSG\",31287]"), "{wkt}");
        for end in ["computedMin", "computedMax"] {
            let [one, other] = [&tif, &grid].map(|found| found["bands"][0][end].as_f64().unwrap());
            assert!((one - other).abs() <= 1e-3 * one.abs(), "{}: {one} {other}", asc.display());
        }
        seen += 1;
    }
    assert!(seen >= 10, "{seen} grids");
}

fn vectors(maps: &Path) {
    for (file, kind, count) in [
        ("ends", "3D Point", 24),
        ("paths", "3D Line String", 24),
        ("lines", "Line String", 1),
        ("barriers", "Line String", 2),
        ("release_zone", "Polygon", 1),
    ] {
        let path = maps.join(file).with_extension("geojson");
        let Some(said) = output("ogrinfo", &["-al", "-so", path.to_str().unwrap()]) else { return };
        let said = text(&said);
        assert!(said.contains(&format!("Feature Count: {count}")), "{said}");
        assert!(said.contains(&format!("Geometry: {kind}")), "{said}");
        assert!(said.contains("ID[\"EPSG\",31287]"), "{said}");
        let extent = said.lines().find(|line| line.starts_with("Extent:")).unwrap();
        let numbers: Vec<f64> = extent
            .split(|c: char| !(c.is_ascii_digit() || c == '.'))
            .filter_map(|word| word.parse().ok())
            .collect();
        let inside = |x: f64, y: f64| {
            (177_200.0..178_000.0).contains(&x) && (377_000.0..377_900.0).contains(&y)
        };
        assert!(inside(numbers[0], numbers[1]) && inside(numbers[2], numbers[3]), "{extent}");
    }
}

fn features(path: &Path) -> Vec<Value> {
    let all: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    all["features"].as_array().unwrap().clone()
}

/// What a line's feature says of its reach is what the summary says, each end as itself; and along a path a homogeneous sphere has
/// `(2/5 m R² ω²)/2` in its spin.
#[test]
fn features_say_what_the_tables_say() {
    let dir = tempfile::tempdir().unwrap();
    let mut written = results::Output::create(made::info(12), dir.path(), Mode::Fresh).unwrap();
    written.write(&(0..12).map(made::fall).collect::<Vec<_>>()).unwrap();
    let found = written.finish().unwrap();
    let lines = features(&dir.path().join("maps/lines.geojson"));
    assert_eq!(lines.len(), found.summary.lines.len());
    for (feature, line) in lines.iter().zip(&found.summary.lines) {
        let reach = &line.reach;
        let ends = [reach.low_95, reach.share, reach.high_95];
        let keys = ["reach_low_95", "reach", "reach_high_95"];
        let said = keys.map(|key| feature["properties"][key].as_f64().unwrap());
        let is_near = said.iter().zip(ends).all(|(one, other)| (one - other).abs() < 1e-12);
        assert!(is_near && said[0] < said[1] && said[1] < said[2], "{feature}");
    }
    for feature in features(&dir.path().join("maps/paths.geojson")) {
        let said = &feature["properties"];
        let fall = made::fall(said["index"].as_u64().unwrap() as usize);
        for (point, joule) in fall.path.iter().zip(said["rotational_j"].as_array().unwrap()) {
            let (rock, spin_rad_s) = (&fall.rock, point.motion.spin_rad_s.norm());
            let inertia_kg_m2 = 0.4 * rock.mass_kg() * rock.radius_m.powi(2);
            let exact = 0.5 * inertia_kg_m2 * spin_rad_s.powi(2);
            // written to a thousandth of a joule
            assert!((joule.as_f64().unwrap() - exact).abs() <= 5.1e-4, "{joule} for {exact}");
        }
    }
}

/// The script prints points, cells and the releases seen; without meshio it says so.
const READ_VTK: &str = "
import sys
try:
    import meshio
except ImportError:
    print('none')
    sys.exit()
mesh = meshio.read(sys.argv[1])
print(len(mesh.points), sum(len(cells.data) for cells in mesh.cells), len(set(mesh.point_data['release'].ravel())))
print(*mesh.points.min(axis=0), *mesh.points.max(axis=0))
";

fn paths(maps: &Path) {
    let vtk = maps.join("paths.vtk");
    let Some(said) = output("python3", &["-c", READ_VTK, vtk.to_str().unwrap()]) else { return };
    let said = text(&said);
    if said.trim() == "none" {
        eprintln!("skipped: python3 has no meshio");
        return;
    }
    let numbers: Vec<usize> =
        said.lines().next().unwrap().split(' ').map(|word| word.parse().unwrap()).collect();
    let rows = std::fs::read_to_string(maps.parent().unwrap().join("paths.csv")).unwrap();
    let points = rows.lines().count() - 1;
    assert_eq!(numbers, [points, points - 24, 24]);
    // the terrain opens beside the paths, in the coordinates of the mesh files: within the STL's box
    let bounds =
        |line: &str| -> Vec<f64> { line.split(' ').map(|word| word.parse().unwrap()).collect() };
    let terrain = text(
        &output("python3", &["-c", READ_BOX, maps.join("terrain.vtk").to_str().unwrap()]).unwrap(),
    );
    let (paths, terrain) = (bounds(said.lines().nth(1).unwrap()), bounds(terrain.trim()));
    for axis in 0..2 {
        assert!(terrain[axis].abs() < 500.0, "far from the files' origin: {terrain:?}");
        // a rock that left the terrain is a little beyond it
        let inside =
            paths[axis] > terrain[axis] - 30.0 && paths[3 + axis] < terrain[3 + axis] + 30.0;
        assert!(inside, "{paths:?} {terrain:?}");
    }
}

/// The script prints the lowest and highest corner of a legacy VTK file of polygons in binary.
const READ_BOX: &str = "
import struct, sys
data = open(sys.argv[1], 'rb').read()
head, rest = data.split(b'POINTS ', 1)
line, rest = rest.split(b'\\n', 1)
count = int(line.split()[0])
points = struct.unpack('>%dd' % (3 * count), rest[:24 * count])
print(*[min(points[k::3]) for k in range(3)], *[max(points[k::3]) for k in range(3)])
";

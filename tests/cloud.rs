//! Point clouds: LAZ says what LAS says, and a thinned cloud is the slope it was measured on.
#![cfg(feature = "cloud")]
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test fails by panicking")]

mod program;

use las::point::{Classification, Format};
use las::{Builder, Point, Writer};
use rockfall::rock::Vec3;
use rockfall::terrain::cloud::{self, Cloud};
use rockfall::terrain::formats::Options;
use rockfall::terrain::grid::Grid;
use rockfall::terrain::read::MeshSource;
use rockfall::terrain::stl::write_ascii;
use rockfall::terrain::weld::Up;
use rockfall::terrain::{Sheet, Terrain};
use std::io::Cursor;
use std::path::Path;

/// A tilted plane in map coordinates, with vegetation above and a low point of noise below.
fn points() -> Vec<Point> {
    let mut all = Vec::new();
    for k in 0..6000u32 {
        // a lattice of irrational steps covers the square evenly
        let (u, v) =
            ((f64::from(k) * 0.618_033_988_75).fract(), (f64::from(k) * 0.754_877_666_25).fract());
        let (x, y) = (
            2_600_000.0 + (3200.0 * u).round() / 100.0,
            1_200_000.0 + (3200.0 * v).round() / 100.0,
        );
        let z = ground_m(x, y);
        let (z, class) = match k % 5 {
            0 => (z + 6.0, Classification::HighVegetation),
            1 if k % 100 == 1 => (z - 30.0, Classification::LowPoint),
            _ => (z, Classification::Ground),
        };
        all.push(Point { x, y, z, classification: class, ..Point::default() });
    }
    all
}

fn ground_m(x: f64, y: f64) -> f64 {
    50.0 + 0.5 * (x - 2_600_000.0) - 0.25 * (y - 1_200_000.0)
}

fn written(is_compressed: bool) -> Vec<u8> {
    file_of(points(), is_compressed)
}

fn file_of(points: Vec<Point>, is_compressed: bool) -> Vec<u8> {
    file_in(points, is_compressed, None)
}

/// The same with a coordinate system in words.
fn file_in(points: Vec<Point>, is_compressed: bool, system: Option<&str>) -> Vec<u8> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(6).unwrap();
    builder.point_format.is_compressed = is_compressed;
    for (axis, offset) in [
        (&mut builder.transforms.x, 2_600_000.0),
        (&mut builder.transforms.y, 1_200_000.0),
        (&mut builder.transforms.z, 0.0),
    ] {
        (axis.scale, axis.offset) = (0.001, offset);
    }
    let mut header = builder.into_header().unwrap();
    if let Some(system) = system {
        header.set_wkt_crs(system.as_bytes().to_vec()).unwrap();
    }
    let mut writer = Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for point in points {
        writer.write_point(Point { gps_time: Some(0.0), ..point }).unwrap();
    }
    writer.into_inner().unwrap().into_inner()
}

fn read(bytes: Vec<u8>, options: &Options) -> Cloud {
    cloud::parse(Cursor::new(bytes), Path::new("cloud.laz"), options).unwrap()
}

#[test]
fn laz_says_what_las_says() {
    let (las, laz) = (written(false), written(true));
    assert!(laz.len() < las.len() / 2);
    let las = read(las, &Options::default());
    assert_eq!(read(laz, &Options::default()), las);
    // one point a cell, the ground alone, to a millimetre
    assert!((900..=1024).contains(&las.points_m().len()), "{}", las.points_m().len());
    for point in las.points_m() {
        assert!((point.z - ground_m(point.x, point.y)).abs() < 1.1e-3, "{point}");
    }
    let coarse = read(written(true), &Options { resample_m: Some(4.0), ..Options::default() });
    assert_eq!(coarse.points_m().len(), 64);
    let trees = read(written(true), &Options { classes: vec![5], ..Options::default() });
    assert!(trees.points_m().iter().all(|p| p.z > ground_m(p.x, p.y) + 5.0));
}

/// The triangles cover the hull of the points once, face up, and hold their heights.
#[test]
fn the_surface_is_the_slope() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("cloud.laz");
    std::fs::write(&path, written(true)).unwrap();
    let sheet = Sheet { path, ground: 0, is_tree: false };
    let source = MeshSource { sheet, up: Up::Z, scale: 1.0, options: Some(Options::default()) };
    let origin_m = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);
    let (terrain, health) = Terrain::read(std::slice::from_ref(&source), origin_m, None).unwrap();
    assert!(health.files[0].notes[0].contains("6000 points"), "{:?}", health.files[0].notes);
    assert_eq!(
        (health.non_manifold_edges.count, health.flipped_edges.count, health.border_loops),
        (0, 0, 1)
    );
    for k in 0..1000 {
        let (x, y) = (1.0 + 0.03 * f64::from(k), 2.0 + (7.0 * f64::from(k)) % 28.0);
        let at = terrain
            .ground_below(x + origin_m.x - terrain.origin_m.x, y + origin_m.y - terrain.origin_m.y)
            .unwrap();
        let expected = ground_m(x + origin_m.x, y + origin_m.y);
        assert!((at + terrain.origin_m.z - expected).abs() < 3e-3, "{x} {y}");
    }
    let (again, _) = Terrain::read(&[source], origin_m, None).unwrap();
    assert_eq!((again.vertices_m, again.triangles), (terrain.vertices_m, terrain.triangles));
}

/// Feet, of the map or of the heights alone, are told; metres are read.
#[test]
fn a_cloud_in_feet_is_refused() {
    let system = |map: &str, heights: &str| {
        format!(
            "COMPD_CS[\"a\",PROJCS[\"b\",GEOGCS[\"c\",UNIT[\"degree\",0.0174532925199433]],UNIT[{map}]],VERT_CS[\"d\",UNIT[{heights}]]]"
        )
    };
    let (metre, foot) = ("\"metre\",1", "\"US survey foot\",0.304800609601219");
    let parse = |system: &str| {
        let bytes = file_in(points(), false, Some(system));
        cloud::parse(Cursor::new(bytes), Path::new("cloud.las"), &Options::default())
    };
    for feet in [system(foot, foot), system(metre, foot)] {
        let said = parse(&feet).unwrap_err().to_string();
        assert!(
            said.contains("found the unit US survey foot, not the metre; write it in metres: pdal")
                && said.contains("Z = Z * 0.3048"),
            "{said}"
        );
    }
    assert!(parse(&system(metre, metre)).is_ok());
}

#[test]
fn a_damaged_or_empty_cloud_is_refused() {
    let parse = |bytes: Vec<u8>, options: &Options| {
        cloud::parse(Cursor::new(bytes), Path::new("cloud.las"), options)
    };
    let said = parse(written(false), &Options { classes: vec![17], ..Options::default() })
        .unwrap_err()
        .to_string();
    assert!(said.contains("no point of the classes [17]") && said.contains("{2, 5, 7}"), "{said}");
    let whole = written(true);
    for length in (0..whole.len()).step_by(97) {
        let _ = parse(whole[..length].to_vec(), &Options::default());
    }
    assert!(parse(whole[..300].to_vec(), &Options::default()).is_err());
    // a table of four billion chunks: the decoder would take 64 GB for it
    let number = |at: usize, length: usize| {
        let mut little = [0; 8];
        little[..length].copy_from_slice(&whole[at..at + length]);
        u64::from_le_bytes(little) as usize
    };
    let table = number(number(96, 4), 8);
    let mut greedy = whole.clone();
    greedy[table + 4..table + 8].fill(0xff);
    let said = parse(greedy, &Options::default()).unwrap_err().to_string();
    assert!(said.contains("found more chunks of points than its"), "{said}");
}

/// Numbers that a file cannot hold are refused before memory or time is spent on them; no byte of the header makes a small
/// file take long.
#[test]
fn a_header_that_promises_too_much_is_refused_at_once() {
    let parse = |bytes: Vec<u8>| {
        cloud::parse(Cursor::new(bytes), Path::new("cloud.las"), &Options::default())
    };
    let with = |whole: &[u8], at: usize, number: &[u8]| {
        let mut wrong = whole.to_vec();
        wrong[at..at + number.len()].copy_from_slice(number);
        wrong
    };
    let (las, laz) = (written(false), written(true));
    let long_record = [las.len() as u64, 1u64].map(u64::to_le_bytes).concat();
    let mut long = with(&las, 235, &long_record[..12]);
    // a record behind the points that says it has 16 GB
    long.extend([[0; 20].as_slice(), &(16u64 << 30).to_le_bytes(), &[0; 32]].concat());
    for (bytes, what) in [
        (with(&las, 247, &6001u64.to_le_bytes()), "points"),
        (with(&las, 247, &u64::MAX.to_le_bytes()), "points"),
        (with(&laz, 247, &(1u64 << 40).to_le_bytes()), "points"),
        (with(&las, 107, &u32::MAX.to_le_bytes()), "points"),
        (with(&las, 100, &u32::MAX.to_le_bytes()), "records"),
        (with(&laz, 243, &u32::MAX.to_le_bytes()), "long records"),
        (long, "long records"),
    ] {
        let said = parse(bytes).unwrap_err().to_string();
        assert!(
            said.contains(&format!("LAS header: found more {what} than its")),
            "{what}: {said}"
        );
    }
    // in the first chunk: a point of 30 bytes, how many points, and how long the first of nine layers is
    let begin = u32::from_le_bytes(laz[96..100].try_into().unwrap()) as usize + 8;
    let said = parse(with(&laz, begin + 34, &u32::MAX.to_le_bytes())).unwrap_err().to_string();
    assert!(said.contains("found more layers of points than its"), "{said}");
    // many chunks, all of which fit
    let many: Vec<Point> = (0..25).flat_map(|_| points()).collect();
    assert_eq!(parse(file_of(many, true)).unwrap().points_m(), parse(laz).unwrap().points_m());
    for name in ["new.las", "new.laz", "old.las", "old.laz"] {
        let whole = std::fs::read(Path::new("fuzz/seeds/las").join(name)).unwrap();
        assert!(parse(whole.clone()).is_ok(), "{name}");
        for (at, own) in whole.iter().enumerate() {
            for byte in [0, 0xff, own ^ 1] {
                let start = std::time::Instant::now();
                let _ = parse(with(&whole, at, &[byte]));
                // milliseconds each; 18 s when long records were believed
                assert!(start.elapsed().as_secs() < 5, "{name}: byte {at} = {byte}");
            }
        }
    }
}

fn source(path: &Path, ground: u16, options: Options) -> MeshSource {
    let sheet = Sheet { path: path.to_owned(), ground, is_tree: false };
    MeshSource { sheet, up: Up::Z, scale: 1.0, options: Some(options) }
}

/// A cloud in tiles is the whole cloud, triangle for triangle; one far away stays a surface of its own.
#[test]
fn tiles_of_a_cloud_are_one_surface() {
    let dir = tempfile::tempdir().unwrap();
    let put = |name: &str, points: Vec<Point>| {
        let path = dir.path().join(name);
        std::fs::write(&path, file_of(points, true)).unwrap();
        path
    };
    let part = |from: f64, to: f64| {
        let is_in = |point: &Point| (from..to).contains(&(point.x - 2_600_000.0));
        points().into_iter().filter(is_in).collect::<Vec<_>>()
    };
    let far = points().into_iter().map(|point| Point { x: point.x + 500.0, ..point }).collect();
    let whole = put("whole.laz", points());
    // side by side, and with four metres in common
    let tiles = [("a", 0.0, 11.0), ("b", 11.0, 24.0), ("c", 20.0, 99.0)];
    let tiles = tiles.map(|(name, from, to)| put(&format!("{name}.laz"), part(from, to)));
    let far = put("far.laz", far);
    let origin_m = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);
    let read = |paths: &[&Path]| {
        let sources: Vec<MeshSource> =
            paths.iter().map(|path| source(path, 0, Options::default())).collect();
        Terrain::read(&sources, origin_m, None).unwrap()
    };
    let (one, _) = read(&[&whole]);
    let [a, b, c] = &tiles;
    let (joined, health) = read(&[b, c, a]);
    assert_eq!((&joined.vertices_m, &joined.triangles), (&one.vertices_m, &one.triangles));
    assert_eq!((health.border_loops, health.parts.len()), (1, 1));
    let said = |file: usize| health.files[file].notes.join("; ");
    assert!(said(0).contains("of 3 tiles that touch"), "{}", said(0));
    assert!(said(1).contains("joined with") && said(1).contains("b.laz"), "{}", said(1));
    let (_, health) = read(&[a, &far]);
    assert_eq!(health.parts.len(), 2);
    // tiles that are not meant alike
    let coarse = Options { resample_m: Some(2.0), ..Options::default() };
    for (other, what) in [
        (source(b, 1, Options::default()), "found another ground than of"),
        (source(b, 0, coarse), "found another resample_m, classes or crop than of"),
    ] {
        let sources = [source(a, 0, Options::default()), other];
        let said = Terrain::read(&sources, origin_m, None).unwrap_err().to_string();
        assert!(said.contains("b.laz") && said.contains(what), "{said}");
        assert!(said.contains("write the same for all tiles of a cloud"), "{said}");
    }
}

/// A slope as STL and as points at the same corners: the same triangles, the same statistics.
#[test]
fn a_cloud_and_a_mesh_of_the_same_slope_agree() {
    let dir = tempfile::tempdir().unwrap();
    let (columns, rows) = (31usize, 41usize);
    let height = |column: usize, row: usize| {
        60.0 - 1.75 * row as f64 + 0.25 * ((column * 7 + row * 13) % 5) as f64
    };
    let values =
        (0..rows).flat_map(|row| (0..columns).map(move |column| Some(height(column, row))));
    let corner_m = [2_600_000.0, 1_200_000.0];
    let grid = Grid { columns, rows, corner_m, cell_m: 2.0, values: values.collect() };
    write_ascii(&dir.path().join("slope.stl"), "slope", &grid.facets(Vec3::zeros())).unwrap();
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let points = cells.map(|(column, row)| {
        let [x, y] = grid.centre_m(column, row);
        Point {
            x,
            y,
            z: height(column, row),
            classification: Classification::Ground,
            ..Point::default()
        }
    });
    std::fs::write(dir.path().join("slope.laz"), file_of(points.collect(), true)).unwrap();
    // on a lattice both are cut along the same diagonals
    let source = |name: &str, options| {
        let sheet = Sheet { path: dir.path().join(name), ground: 0, is_tree: false };
        MeshSource { sheet, up: Up::Z, scale: 1.0, options: Some(options) }
    };
    let coarse = Options { resample_m: Some(2.0), ..Options::default() };
    let [mesh, cloud] =
        [("slope.stl", Options::default()), ("slope.laz", coarse)].map(|(name, options)| {
            let terrain = Terrain::read(&[source(name, options)], Vec3::zeros(), None).unwrap().0;
            let corners = |t: u32| {
                let mut corners = terrain.corners_m(t).map(|p| {
                    <[f64; 3]>::from((p + terrain.origin_m) * 1e3).map(|mm| mm.round() as i64)
                });
                corners.sort_unstable();
                corners
            };
            let mut all: Vec<_> = (0..terrain.triangles.len() as u32).map(corners).collect();
            all.sort_unstable();
            all
        });
    assert!(mesh == cloud);
    let runouts = |terrain: &str| -> Vec<f64> {
        let scene = format!(
            "title = \"Cloud\"\nseed = 5\n[[terrain]]\nground = \"rock\"\n{terrain}\n\
             [grounds.rock]\nnormal_stiffness_n_m = 1e9\nshear_stiffness_n_m = 0.25e9\nfriction_angle_deg = 33.0\n\
             restitution = 0.3\nrolling_friction = 0.6\nroughness_deg = 5.0\n\
             [rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.3\n\
             [release]\ncount = 400\nheight_m = 0.5\nvelocity_m_s = [0.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
             line_m = [[2600010.0, 1200075.0], [2600050.0, 1200075.0]]\n[record]\npaths = 0\n"
        );
        let (file, out) = (dir.path().join("scene.toml"), dir.path().join("out"));
        std::fs::write(&file, scene).unwrap();
        program::run_into(&file, &out);
        let table = std::fs::read_to_string(out.join("releases.csv")).unwrap();
        let column =
            table.lines().next().unwrap().split(',').position(|name| name == "runout_m").unwrap();
        table
            .lines()
            .skip(1)
            .map(|line| line.split(',').nth(column).unwrap().parse().unwrap())
            .collect()
    };
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
    let variance = |all: &[f64]| {
        all.iter().map(|x| (x - mean(all)).powi(2)).sum::<f64>() / (all.len() - 1) as f64
    };
    let (mesh, cloud) =
        (runouts("mesh = \"slope.stl\""), runouts("file = \"slope.laz\"\nresample_m = 2.0"));
    let difference = mean(&mesh) - mean(&cloud);
    // four standard errors of the difference of two means
    let error = ((variance(&mesh) + variance(&cloud)) / mesh.len() as f64).sqrt();
    assert!(
        mean(&mesh) > 10.0 && difference.abs() < 4.0 * error,
        "{difference} of {}, {error}",
        mean(&mesh)
    );
}

/// Written by another program (laspy, where it is installed): every version and point format, plain and packed, with the
/// coordinate system as WKT; all hold the same ground.
#[test]
fn what_laspy_writes_is_read() {
    let dir = tempfile::tempdir().unwrap();
    let said = std::process::Command::new("python3")
        .args(["-c", include_str!("made/laspy.py"), dir.path().to_str().unwrap()])
        .output();
    let said = said
        .map(|said| String::from_utf8_lossy(&said.stdout).trim().to_owned())
        .unwrap_or_default();
    let Ok(count) = said.parse::<usize>() else {
        eprintln!("skipped: python3 has no laspy ({said})");
        return;
    };
    let mut first: Option<Cloud> = None;
    let mut seen = 0;
    for entry in std::fs::read_dir(dir.path()).unwrap() {
        let path = entry.unwrap().path();
        let found = cloud::read(&path, &Options::default()).unwrap();
        assert_eq!(found.points_m().len(), 771, "{}", path.display());
        for point in found.points_m() {
            // all of these are multiples of a millimetre, stored as whole numbers of them
            assert!((point.z - ground_m(point.x, point.y)).abs() < 1e-3, "{point}");
        }
        assert_eq!(*first.get_or_insert_with(|| found.clone()), found, "{}", path.display());
        seen += 1;
    }
    assert_eq!(seen, count);
}

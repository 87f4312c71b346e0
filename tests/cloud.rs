//! Point clouds: LAZ says what LAS says, and a thinned cloud is the slope it was measured on.
#![cfg(feature = "cloud")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use las::point::{Classification, Format};
use las::{Builder, Point, Writer};
use rockfall::rock::Vec3;
use rockfall::terrain::cloud::{self, Cloud};
use rockfall::terrain::formats::Options;
use rockfall::terrain::read::Source;
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
    (50.0 + 0.5 * (x - 2_600_000.0) - 0.25 * (y - 1_200_000.0)) * 1.0
}

fn written(is_compressed: bool) -> Vec<u8> {
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
    let mut writer = Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
    for point in points() {
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
    let source = Source { sheet, up: Up::Z, scale: 1.0, options: Some(Options::default()) };
    let origin_m = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);
    let (terrain, health) = Terrain::read(&[source.clone()], origin_m, None).unwrap();
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
}

//! The ground that figures are drawn on.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use super::slope;
use rockfall::report::raster::GroundRaster;
use rockfall::rock::Vec3;
use rockfall::terrain::geotiff;
use rockfall::terrain::grid::Grid;

/// On a mesh of 1 m a bilinear raster can be off by the curvature over a triangle and a cell: the made slope bends by less than
/// 0.5·0.31² + 0.25·1.3 = 0.37 /m (away from the kink at the cliff), so by 0.37·(1² + 0.35²)/4 = 0.11 m.
#[test]
fn the_raster_gives_the_height_of_the_mesh() {
    let origin = Vec3::new(2_600_000.0, 1_200_000.0, 800.0);
    let raster = GroundRaster::from_terrain(&slope::terrain(1.0, origin), 600);
    let mut dice = slope::Dice::new(3);
    let mut worst: f64 = 0.0;
    for _ in 0..2000 {
        let (x, y) = (1.0 + 138.0 * dice.roll(), 1.0 + 166.0 * dice.roll());
        let found = raster.height_at(origin.x + x, origin.y + y);
        worst = worst.max((found - 800.0 - slope::height_m(x, y)).abs());
    }
    assert!(worst < 0.11, "{worst} m off");
    assert!(raster.height_at(origin.x - 5.0, origin.y).is_nan());
    assert!(raster.height_at(origin.x + 20.0, origin.y + 300.0).is_nan());
}

/// On cells of half a metre every second cell centre lies exactly on an edge between two triangles: it belongs to one of them.
#[test]
fn no_hole_between_triangles() {
    let raster = GroundRaster::from_terrain(&slope::terrain(1.0, Vec3::zeros()), 400);
    assert!((raster.cell_m - 0.5).abs() < 1e-12);
    let holes = raster.height_m.iter().filter(|z| z.is_nan()).count();
    assert_eq!(holes, 0);
}

/// 60 open prisms of 0.2 to 0.45 m on cells of a third of a metre: each leaves a mark, none is hollow.
#[test]
fn every_stem_leaves_a_mark() {
    let origin = Vec3::new(0.0, 0.0, 0.0);
    let raster = GroundRaster::from_terrain(&slope::terrain(2.0, origin), 600);
    let patches = raster.tree_patches();
    assert!(
        (50..=60).contains(&patches.len()),
        "{} patches (touching stems are one)",
        patches.len()
    );
    let area_m2 = raster.trees.iter().filter(|&&t| t).count() as f64 * raster.cell_m.powi(2);
    // a cell that a stem touches counts: a ring of half a cell around radius 0.2..0.45
    let (least, most) = (60.0 * 3.1 * 0.2_f64.powi(2), 60.0 * 3.2 * (0.45 + raster.cell_m).powi(2));
    assert!((least..most).contains(&area_m2), "{area_m2} m²");
}

#[test]
fn a_raster_read_back_is_the_same_raster() {
    let dir = tempfile::tempdir().unwrap();
    let origin = Vec3::new(2_600_000.123, 1_200_000.456, 800.0);
    let raster = GroundRaster::from_terrain(&slope::terrain(3.0, origin), 97);
    raster.write(dir.path()).unwrap();
    let back = GroundRaster::read(dir.path()).unwrap().unwrap();
    assert_eq!(back.trees, raster.trees);
    let bits = |r: &GroundRaster| r.height_m.iter().map(|z| z.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&back), bits(&raster));
    assert_eq!(
        (back.west_m, back.south_m, back.cell_m),
        (raster.west_m, raster.south_m, raster.cell_m)
    );
    assert!(GroundRaster::read(&dir.path().join("nowhere")).unwrap().is_none());
}

/// `ground.asc` and `ground.tif` are one grid, also where the triangles are finer than what figures show: the same corner, cells and values, which figures
/// are drawn from in means of whole cells.
#[test]
fn both_files_of_the_ground_are_one_grid() {
    let dir = tempfile::tempdir().unwrap();
    let terrain = slope::terrain(0.25, Vec3::new(2_600_000.0, 1_200_000.0, 800.0));
    let raster = GroundRaster::as_used(&terrain);
    raster.write(dir.path()).unwrap();
    raster.write_tif(dir.path(), Some(2056)).unwrap();
    let [text, image] =
        ["asc", "tif"].map(|ending| dir.path().join(format!("maps/ground.{ending}")));
    let text = Grid::parse(&std::fs::read_to_string(text).unwrap(), "ground.asc".as_ref()).unwrap();
    let image = geotiff::read(&image, None, None).unwrap().grid;
    assert!(text.columns.max(text.rows) > 400, "{} x {}", text.columns, text.rows);
    assert_eq!((text.columns, text.rows), (image.columns, image.rows));
    assert_eq!((text.corner_m, text.cell_m), (image.corner_m, image.cell_m));
    // a GeoTIFF holds 32 bits of a height
    let is_same = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-4,
        (None, None) => true,
        _ => false,
    };
    assert!(text.values.iter().zip(&image.values).all(is_same));
    let coarse = raster.clone().coarser(400);
    assert!(coarse.columns.max(coarse.rows()) <= 400 && coarse.cell_m > raster.cell_m);
    let (x, y) = (2_600_070.0, 1_200_080.0);
    assert!((coarse.height_at(x, y) - raster.height_at(x, y)).abs() < 0.1);
    assert_eq!(coarse.trees.iter().any(|tree| *tree), raster.trees.iter().any(|tree| *tree));
}

#[test]
fn a_wrong_grid_file_says_what_is_wrong() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("maps/ground.asc");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let cases = [
        ("ncols x", "ncols"),
        (
            "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize -1\nNODATA_value -9999\n1 2",
            "positive",
        ),
        (
            "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1",
            "ncols × nrows = 2",
        ),
        (
            "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 abc",
            "value 2",
        ),
    ];
    for (text, expected) in cases {
        std::fs::write(&path, text).unwrap();
        let message = GroundRaster::read(dir.path()).unwrap_err().to_string();
        assert!(message.contains(expected) && message.contains("ground.asc"), "{message}");
    }
}

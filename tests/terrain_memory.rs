//! What reading an elevation model takes of memory: so much a triangle at most, however it is done.
//!
//! One test in one program: other threads' memory would count too.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use peak_alloc::PeakAlloc;
use rockfall::rock::Vec3;
use rockfall::terrain::formats::Options;
use rockfall::terrain::geotiff::{Image, encode};
use rockfall::terrain::read::Source;
use rockfall::terrain::weld::Up;
use rockfall::terrain::{Sheet, Terrain};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Cells on each side: more triangles than the index is built over at once.
const SIDE: u32 = 701;
/// Most memory at a time (bytes a triangle). What stays is about 245: triangles with normals 96, edges 42, index 33,
/// neighbours of vertices 26, the rest 48.
const MOST: usize = 300;

#[test]
fn an_elevation_model_takes_little_more_memory_than_the_terrain_it_becomes() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("dem.tif");
    let height = |k: u32| {
        let (x, y) = (f64::from(k % SIDE), f64::from(k / SIDE));
        (500.0 - 0.5 * y + 3.0 * (x / 17.0).fract() + 2.0 * ((x + 2.0 * y) / 29.0).fract()) as f32
    };
    let values: Vec<f32> = (0..SIDE * SIDE).map(height).collect();
    let image = Image {
        corner_m: [2_600_000.0, 1_200_000.0],
        cell_m: 1.0,
        columns: SIDE,
        rows: SIDE,
        epsg: Some(2056),
        nodata: -9999.0,
        said: None,
        values: &values,
    };
    std::fs::write(&path, encode(&image).unwrap()).unwrap();
    drop(values);
    let sheet = Sheet { path, ground: 0, is_tree: false };
    let source = Source { sheet, up: Up::Z, scale: 1.0, options: Some(Options::default()) };
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let origin_m = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);
    let (terrain, _) = Terrain::read(&[source], origin_m, None).unwrap();
    let (peak, stays) = (MEMORY.peak_usage() - before, MEMORY.current_usage() - before);
    let triangles = terrain.triangles.len();
    assert_eq!(triangles, 2 * (SIDE as usize - 1).pow(2));
    println!("{} bytes a triangle stay, {} at the most", stays / triangles, peak / triangles);
    assert!(peak / triangles <= MOST, "{} bytes a triangle", peak / triangles);
    // what the terrain says of itself is what it takes
    assert!(terrain.bytes().abs_diff(stays) * 20 < stays, "{} {stays}", terrain.bytes());
}

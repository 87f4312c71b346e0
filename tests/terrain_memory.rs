//! What reading an elevation model takes of memory: so much a triangle at most, however it is done.
//!
//! One test in one program: other threads' memory would count too.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by panicking, and says what it measured"
)]

use peak_alloc::PeakAlloc;
use rockfall::plan::Plan;
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::terrain::formats::Options;
use rockfall::terrain::geotiff::{Image, encode};
use rockfall::terrain::read::MeshSource;
use rockfall::terrain::weld::Up;
use rockfall::terrain::{Sheet, Terrain};
use std::path::Path;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Rocks on a model of cells of 1 m.
const SCENE: &str = "title = \"a\"
seed = 1
origin_m = [2600000.0, 1200000.0, 0.0]
[[terrain]]
file = \"dem.tif\"
ground = \"a\"
[grounds.a]
normal_stiffness_n_m = 1e8
shear_stiffness_n_m = 2.5e7
friction_angle_deg = 30.0
restitution = 0.3
[rocks]
density_kg_m3 = 2700.0
radius_m = 0.3
[release]
count = 1
height_m = 0.5
velocity_m_s = [0.0, 0.0, 0.0]
spin_rad_s = [0.0, 0.0, 0.0]
points_m = [[2600200.0, 1199700.0]]
[record]
paths = 0
";

/// Cells on each side, and the most memory at a time (bytes a triangle).
///
/// The larger one is kept small: of 100 bytes that ten million cells may take (2 GB of 20 million triangles), about 80 stay:
/// vertices 12, triangles 12, sides 12, triangles of vertices 14, brims 12, index 10, numbers of facets and sheets 6. Trees
/// of the index that are built beside each other weigh more in a small terrain than in a large one. The smaller one is
/// ready for use: 96 for its faces and 20 for smaller leaves come on top.
const SIZES: [(u32, usize); 2] = [(701, 285), (1401, 100)];

#[test]
fn an_elevation_model_takes_little_more_memory_than_the_terrain_it_becomes() {
    // so many trees of the index are built beside each other
    let threads = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    for (side, most) in SIZES {
        threads.install(|| takes_at_most(side, most));
        for trees in ["", "[[trees]]\nground = \"a\"\nfile = \"trees.csv\"\n"] {
            threads.install(|| takes_no_more_than_the_plan_says(side, trees));
        }
    }
}

/// Where trees of a list are stood on the slope, it is there twice for a while.
fn takes_no_more_than_the_plan_says(side: u32, trees: &str) {
    let dir = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    write_model(&dir.path().join("dem.tif"), side);
    put("trees.csv", "x,y,dbh_m,height_m\n2600100.5,1199900.5,0.4,20\n");
    let scene = put("scene.toml", &format!("{SCENE}{trees}"));
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let plan = Plan::of_scene(&Scene::read(&scene).unwrap()).unwrap();
    let peak = (MEMORY.peak_usage() - before) as f64;
    let said = plan.cost(1).most_memory_bytes();
    println!("{side} {trees:?}: {:.0} of {:.0} MB", 1e-6 * peak, 1e-6 * said);
    assert!(peak < said, "{side} {trees:?}: {peak} {said}");
}

fn takes_at_most(side: u32, most: usize) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("dem.tif");
    write_model(&path, side);
    let sheet = Sheet { path, ground: 0, is_tree: false };
    let source = MeshSource { sheet, up: Up::Z, scale: 1.0, options: Some(Options::default()) };
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let origin_m = Vec3::new(2_600_000.0, 1_200_000.0, 0.0);
    let (terrain, _) = Terrain::read(&[source], origin_m, None).unwrap();
    let (peak, stays) = (MEMORY.peak_usage() - before, MEMORY.current_usage() - before);
    let triangles = terrain.triangles.len();
    assert_eq!(triangles, 2 * (side as usize - 1).pow(2));
    println!("{} bytes a triangle stay, {} at the most", stays / triangles, peak / triangles);
    assert!(peak / triangles <= most, "{} bytes a triangle", peak / triangles);
    // what the terrain says of itself is what it takes
    assert!(terrain.bytes().abs_diff(stays) * 20 < stays, "{} {stays}", terrain.bytes());
}

fn write_model(path: &Path, side: u32) {
    let height = |k: u32| {
        let (x, y) = (f64::from(k % side), f64::from(k / side));
        (500.0 - 0.5 * y + 3.0 * (x / 17.0).fract() + 2.0 * ((x + 2.0 * y) / 29.0).fract()) as f32
    };
    let values: Vec<f32> = (0..side * side).map(height).collect();
    let image = Image {
        corner_m: [2_600_000.0, 1_200_000.0],
        cell_m: 1.0,
        columns: side,
        rows: side,
        epsg: Some(2056),
        nodata: -9999.0,
        said: None,
        values: &values,
    };
    std::fs::write(path, encode(&image).unwrap()).unwrap();
}

//! A large elevation model and a scene over it: what a tile takes of memory and time until the plan is printed.

use rockfall::error::{Error, Result};
use rockfall::terrain::geotiff::{Image, encode};
use std::path::Path;

/// South-western corner, Swiss map coordinates (m).
const CORNER_M: [f64; 2] = [2_600_000.0, 1_200_000.0];

/// Writes `tile.tif`, an elevation model of `side` by `side` cells of 1 m, and `scene.toml` into a folder.
///
/// # Errors
/// A folder or file that cannot be written, more cells than a file can hold.
pub fn write(side: u32, dir: &Path) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(Error::file("write", dir))?;
    let values: Vec<f32> = (0..side * side).map(|k| height_m(k % side, k / side)).collect();
    let image = Image {
        corner_m: [CORNER_M[0], CORNER_M[1] + f64::from(side)],
        cell_m: 1.0,
        columns: side,
        rows: side,
        epsg: Some(2056),
        nodata: -9999.0,
        said: None,
        values: &values,
    };
    let wrong = |why| Error::Request(format!("{side} cells on each side: {why}"));
    let files = [("tile.tif", encode(&image).map_err(wrong)?), ("scene.toml", scene(side).into())];
    for (name, bytes) in files {
        let path = dir.join(name);
        std::fs::write(&path, bytes).map_err(Error::file("write", &path))?;
    }
    Ok(())
}

/// A side that falls to the south at 19°, with ribs of 40 and 25 m and steps of up to 3 m.
fn height_m(column: u32, row: u32) -> f32 {
    let (x, y) = (f64::from(column), f64::from(row));
    let wave = |way: f64| {
        let t = way.fract();
        if t < 0.5 { 16.0 * t * (0.5 - t) } else { -16.0 * (t - 0.5) * (1.0 - t) }
    };
    let ribs = 40.0 * wave(x / 1068.0) + 25.0 * wave((x + 2.0 * y) / 609.0);
    let steps = 3.0 * (x / 17.0).fract() + 2.0 * ((x + 2.0 * y) / 29.0).fract();
    (3000.0 - 0.35 * y + ribs + steps) as f32
}

/// Rocks from a line in the middle.
fn scene(side: u32) -> String {
    let [x, y] = CORNER_M.map(|m| m + f64::from(side / 2));
    format!(
        "title = \"A tile\"\nseed = 5\nepsg = 2056\n\n[[terrain]]\nfile = \"tile.tif\"\nground = \"rock\"\n\n\
         [grounds.rock]\nnormal_stiffness_n_m = 1e9\nshear_stiffness_n_m = 0.25e9\nfriction_angle_deg = 33.0\n\
         restitution = 0.3\nrolling_friction = 0.6\nroughness_deg = 5.0\n\n\
         [rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.3\n\n\
         [release]\ncount = 100\nheight_m = 0.5\nvelocity_m_s = [0.0, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n\
         line_m = [[{x}, {y}], [{}, {y}]]\n",
        x + 40.0
    )
}

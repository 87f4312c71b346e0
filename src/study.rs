//! What the numerics cost and what they are worth: error against run time, stability, exact cases, speed.
//!
//! ```text
//! cases ─┬─► exact      error of every scheme against the exact solution, over run time; order: at fixed steps
//!        └─► stability  stiff and extreme cases, each held against its bound
//! slope ───► speed      rocks per second, where the time goes, what each part costs
//! plan ─┬──► scene      errors of a scene's own statistics: of the sample, the steps, the mesh
//!       └──► conserve   every release: no panic, no failure, no rock lost, no energy gained
//! worlds ──► scaling    cost against the number of rocks that touch each other
//!            verify     exact cases of several rocks and the method paper's examples
//! ```

pub mod aim;
pub mod bench;
pub mod cases;
pub mod conserve;
pub mod exact;
mod exact_figure;
mod exact_page;
pub mod exact_values;
pub mod order;
pub mod scene;
mod scaling;
mod scaling_page;
mod scene_figure;
mod scene_page;
pub mod speed;
pub mod spread;
pub mod verify;
pub mod stability;
mod stability_figure;
mod subject;

use crate::error::{Error, Result};
use crate::output::write_whole;
use conserve::Conservation;
use exact::CaseStudy;
use scene::SceneStudy;
use speed::SpeedStudy;
use stability::{Map, Outcome};
use std::fs;
use std::path::Path;

pub use scaling::{Cost, Phase, World, resident_now, world};
pub use scaling_page::findings;
pub use scene_page::{Wish, sentence, setting};

/// Writes the exact cases' page, table and figures into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_exact(
    studies: &[CaseStudy],
    ladders: &[order::Ladder],
    values: &[exact_values::Value],
    dir: &Path,
) -> Result<()> {
    let figures = dir.join("figures");
    fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
    for study in studies {
        let file = figures.join(format!("{}.svg", study.case.name));
        write_whole(&file, exact_figure::draw(study).as_bytes())?;
    }
    write_whole(&figures.join("order.svg"), order::draw(ladders).as_bytes())?;
    write_whole(&dir.join("order.csv"), order::csv(ladders).as_bytes())?;
    write_whole(&dir.join("exact.csv"), exact::csv(studies).as_bytes())?;
    write_whole(&dir.join("README.md"), exact_page::page(studies, ladders, values).as_bytes())
}

/// Writes a scene's page, table and figure into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_scene(study: &SceneStudy, wish: Option<Wish>, dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_whole(&dir.join("error.svg"), scene_figure::draw(study).as_bytes())?;
    write_whole(&dir.join("error.csv"), scene_page::csv(study).as_bytes())?;
    if !study.meshes.is_empty() {
        write_whole(&dir.join("mesh.csv"), scene_page::mesh_csv(study).as_bytes())?;
    }
    write_whole(&dir.join("README.md"), scene_page::page(study, wish).as_bytes())
}

/// Writes the page, table and figure of the cost of many rocks in one world into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_scaling(worlds: &[World], dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_whole(&dir.join("scaling.svg"), scaling_page::figure(worlds).as_bytes())?;
    write_whole(&dir.join("scaling.csv"), scaling_page::csv(worlds).as_bytes())?;
    write_whole(&dir.join("README.md"), scaling_page::page(worlds).as_bytes())
}

/// Writes the page, table and map of the stiff and extreme cases into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_stability(outcomes: &[Outcome], maps: &[Map], dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_whole(&dir.join("map.svg"), stability_figure::draw(maps).as_bytes())?;
    write_whole(&dir.join("stability.csv"), stability::csv(outcomes).as_bytes())?;
    write_whole(&dir.join("README.md"), stability::page(outcomes).as_bytes())
}

/// Writes the page and table of a scene's conservation into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_conservation(found: &Conservation, dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_whole(&dir.join("conservation.csv"), conserve::csv(found).as_bytes())?;
    write_whole(&dir.join("README.md"), conserve::page(found).as_bytes())
}

/// Writes the page, tables and figure of the speeds into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_speed(study: &SpeedStudy, dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_whole(&dir.join("speed.svg"), speed::draw(study).as_bytes())?;
    write_whole(&dir.join("speed.csv"), speed::csv(study).as_bytes())?;
    write_whole(&dir.join("parts.csv"), speed::parts_csv(study).as_bytes())?;
    write_whole(&dir.join("README.md"), speed::page(study).as_bytes())
}

//! What the numerics cost and what they are worth: error against run time, stability, exact cases.
//!
//! ```text
//! cases ─┬─► exact      error of every scheme against the exact solution, over run time; order: at fixed steps
//!        └─► stability  stiff and extreme cases, each held against its bound
//! plan ─┬──► scene      errors of a scene's own statistics: of the sample, the steps, the mesh
//!       └──► conserve   every release: no panic, no failure, no rock lost, no energy gained
//!            verify     exact cases of several rocks and the method paper's examples
//! ```

pub mod target_precision;
pub mod bench;
pub mod cases;
pub mod conserve;
pub mod exact;
pub mod exact_figure;
mod exact_page;
mod finer;
pub mod exact_values;
pub mod order;
pub mod processor_time;
pub mod scene;
mod scene_csv;
mod scene_figure;
mod scene_page;
pub mod bootstrap;
pub mod verify;
pub mod stability;
mod stability_figure;
mod statistic;
mod weighing;

use crate::error::{Error, Result};
use crate::output::write_atomic;
use conserve::Conservation;
use exact::CaseStudy;
use scene::SceneStudy;
use stability::{CaseOutcome, Map};
use std::fs;
use std::path::Path;

pub use scene_page::{Wish, sentence, setting};

/// Writes the exact cases' page, table and figures into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_exact(
    studies: &[CaseStudy],
    ladders: &[order::OrderLadder],
    values: &[exact_values::ExactValue],
    dir: &Path,
) -> Result<()> {
    let figures = dir.join("figures");
    fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
    for study in studies.iter().filter(|study| study.says_something()) {
        let file = figures.join(format!("{}.svg", study.case.name));
        write_atomic(&file, exact_figure::draw(study).as_bytes())?;
    }
    write_atomic(&figures.join("order.svg"), order::draw(ladders).as_bytes())?;
    write_atomic(&dir.join("order.csv"), order::csv(ladders).as_bytes())?;
    write_atomic(&dir.join("exact.csv"), exact::csv(studies).as_bytes())?;
    write_atomic(&dir.join("README.md"), exact_page::page(studies, ladders, values).as_bytes())
}

/// Writes a scene's page, table and figure into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_scene(study: &SceneStudy, wish: Option<Wish>, dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_atomic(&dir.join("error.svg"), scene_figure::draw(study).as_bytes())?;
    study.studied.write(dir)?;
    write_atomic(&dir.join("error.csv"), scene_csv::csv(study).as_bytes())?;
    if !study.meshes.is_empty() {
        write_atomic(&dir.join("mesh.csv"), scene_csv::mesh_csv(study).as_bytes())?;
    }
    write_atomic(&dir.join("README.md"), scene_page::page(study, wish).as_bytes())
}

/// Writes the page, table and map of the stiff and extreme cases into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_stability(outcomes: &[CaseOutcome], maps: &[Map], dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_atomic(&dir.join("map.svg"), stability_figure::draw(maps).as_bytes())?;
    write_atomic(&dir.join("stability.csv"), stability::csv(outcomes).as_bytes())?;
    write_atomic(&dir.join("README.md"), stability::page(outcomes).as_bytes())
}

/// Writes the page and table of a scene's conservation into `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn write_conservation(found: &Conservation, dir: &Path) -> Result<()> {
    fs::create_dir_all(dir).map_err(Error::file("create", dir))?;
    write_atomic(&dir.join("conservation.csv"), conserve::csv(found).as_bytes())?;
    write_atomic(&dir.join("README.md"), conserve::page(found).as_bytes())
}

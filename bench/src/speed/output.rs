//! What files and report cost, beside computing.

use super::slope::Slope;
use rockfall::error::{Error, Result};
use rockfall::hazard::AnnualRequest;
use rockfall::output::{Identity, Mode, Output, RunInfo, Site};
use rockfall::report;
use rockfall::scene::Language;
use rockfall::simulation::Trajectory;
use rockfall::study::processor_time::ProcessorTime;
use rockfall::terrain::{Sheet, Terrain};
use std::fs;
use std::path::Path;

/// Rocks written at a time, as of a chunk of two seconds.
const CHUNK: usize = 2000;

/// What the results of so many rocks cost, without paths, impacts, lines and maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputCost {
    /// How many rocks.
    pub rocks: usize,
    /// Writing their rows (s).
    pub write_s: f64,
    /// Summary, statistics, figures and page (s).
    pub report_s: f64,
}

/// Writes the journeys over and over until there are `rocks` of them, and the report; the folder `dir` is used up.
///
/// # Errors
/// If the folder cannot be written.
pub fn cost(
    slope: &Slope,
    journeys: &[Trajectory],
    rocks: usize,
    dir: &Path,
) -> Result<OutputCost> {
    let mut output =
        Output::create(info(&slope.terrain, &["slope".to_owned()], rocks), dir, Mode::Overwrite)?;
    let mut write_s = 0.0;
    for start in (0..rocks).step_by(CHUNK) {
        let chunk: Vec<Trajectory> = (start..rocks.min(start + CHUNK))
            .map(|index| Trajectory { index, ..journeys[index % journeys.len()].clone() })
            .collect();
        let clock = ProcessorTime::begin();
        output.write(&chunk)?;
        write_s += clock.seconds();
    }
    let clock = ProcessorTime::begin();
    let results = output.finish()?;
    report::draw_run(&results, &slope.terrain, |_| None)?;
    let report_s = clock.seconds();
    drop(results);
    fs::remove_dir_all(dir).map_err(Error::file("remove", dir))?;
    Ok(OutputCost { rocks, write_s, report_s })
}

/// What the files need to know of a scene with nothing but rocks and terrain.
pub(super) fn info(terrain: &Terrain, grounds: &[String], rocks: usize) -> RunInfo {
    let identity = Identity {
        scene_hash: format!("slope of {} triangles", terrain.triangles.len()),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: 0,
        first_release: 0,
        releases: rocks,
        of_releases: rocks,
    };
    let ground = |sheet: &Sheet| grounds[usize::from(sheet.ground)].clone();
    RunInfo {
        title: "Benchmark".to_owned(),
        identity,
        origin_m: terrain.origin_m,
        site: Site::default(),
        ground_of_sheet: terrain.sheets.iter().map(ground).collect(),
        lines: Vec::new(),
        maps: None,
        barriers: Vec::new(),
        asked: AnnualRequest::default(),
        observed: Vec::new(),
        observed_worth: None,
        observed_least_runout_m: None,
        profile_step_m: 10.0,
        keeps_paths: false,
        keeps_impacts: false,
        has_blocks: false,
        has_scars: false,
        is_shard: false,
        threads: 1,
        plan: Vec::new(),
        warnings: Vec::new(),
        inputs: Vec::new(),
        title_block: Vec::new(),
        sources: Default::default(),
        language: Language::default(),
        mesh_health: serde_json::Value::Null,
    }
}

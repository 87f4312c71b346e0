//! Figures and the page, drawn from plain numbers.
//!
//! ```text
//! Report ─► FIGURES (plan, side, runout, …) ─► figures/*.svg
//!                                          └─► report.html (figures inlined)
//! ```
//!
//! Nothing is computed here that a reader would quote: estimates and intervals come in as [`input`] has them; only the
//! bins of histograms and the envelopes along the fall line are found for display.

pub mod axis;
mod barriers;
pub mod colour;
pub mod contour;
pub mod curves;
mod distributions;
pub mod figure;
pub mod format;
pub mod gather;
mod hillshade;
mod histogram;
pub mod html;
pub mod input;
mod lines;
mod maps;
mod measured;
pub mod panel;
pub mod paper;
mod plan_view;
pub mod raster;
mod reach_angle;
mod runout;
mod side_view;
mod stops;
pub mod svg;

use crate::error::{Error, Result};
use crate::hazard::Hazard;
use crate::output::{self, Claim, Results, write_whole};
use crate::terrain::Terrain;
use figure::{Drawing, FIGURES, Heading};
use input::Report;
use raster::GroundRaster;
use std::fs;
use std::path::Path;

/// Draws a finished run: `figures/*.svg`, `report.html`, and the ground it was drawn on, below the run's folder.
///
/// # Errors
/// When a result file cannot be read or a figure cannot be written.
pub fn draw_run(results: &Results, terrain: &Terrain) -> Result<()> {
    let ground = GroundRaster::from_terrain(terrain, GROUND_CELLS);
    ground.write(&results.dir)?;
    let epsg = results.summary.maps.as_ref().and_then(|maps| maps.epsg);
    GroundRaster::as_used(terrain).write_tif(&results.dir, epsg)?;
    draw(&gather::gather(results, Some(ground))?, &results.dir)
}

/// Draws a run put together from shards; the ground is that of `shard`, one of their folders.
///
/// # Errors
/// When a result file cannot be read or a figure cannot be written.
pub fn draw_merged(results: &Results, shard: &Path) -> Result<()> {
    let ground = GroundRaster::read(shard)?;
    if let Some(ground) = &ground {
        ground.write(&results.dir)?;
    }
    output::copy_used(shard, &results.dir)?;
    draw(&gather::gather(results, ground)?, &results.dir)
}

/// Draws a run again from its files alone; no mesh is read.
///
/// # Errors
/// When a result file cannot be read or a figure cannot be written.
pub fn draw_again(dir: &Path) -> Result<()> {
    let results = output::read(dir)?;
    let _claim = Claim::on(dir)?;
    draw(&gather::gather(&results, GroundRaster::read(dir)?)?, dir)
}

/// Each headline statistic of the rocks with its 95 % interval, line by line, and what the computation warns of.
pub fn headline(hazard: &Hazard) -> Vec<String> {
    let warnings = hazard.totals.warnings(hazard.rocks());
    let mut lines = html::plain_headline(&gather::headline(hazard));
    lines.extend(warnings.iter().map(|warning| format!("warning: {warning}")));
    lines
}

/// Cells along the longer side of the ground that maps are drawn on: about as many as a printed figure shows.
const GROUND_CELLS: usize = 400;

/// Writes `figures/*.svg` and `report.html` below `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn draw(report: &Report, dir: &Path) -> Result<()> {
    let figures = dir.join("figures");
    fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
    let drawn = drawings(report);
    let names: Vec<&str> = drawn.iter().map(|(heading, _)| heading.file.as_str()).collect();
    output::announce_figures(dir, &names)?;
    for (heading, drawing) in &drawn {
        write_whole(&figures.join(&heading.file), drawing.svg.as_bytes())?;
    }
    write_whole(&dir.join("report.html"), html::page(report, &drawn).as_bytes())
}

/// All figures, drawn.
pub fn drawings(report: &Report) -> Vec<(Heading, Drawing)> {
    let heading =
        |file: &str, title: &str| Heading { file: file.to_owned(), title: title.to_owned() };
    let mut drawn: Vec<(Heading, Drawing)> = FIGURES
        .iter()
        .map(|figure| (heading(figure.file, figure.title), (figure.draw)(report)))
        .collect();
    if let Some(observed) = &report.observed {
        drawn.push((
            heading("measured.svg", "Measured and computed"),
            measured::draw(report, observed),
        ));
    }
    if let Some(cells) = &report.maps {
        drawn.push((heading("maps.svg", "Maps"), maps::draw(report, cells)));
    }
    if report.lines.len() > 1 {
        drawn.push((heading("retention.svg", "Retention"), lines::retention(&report.lines)));
    }
    for (number, line) in report.lines.iter().enumerate() {
        // names of lines may hold anything: files are numbered
        let file = format!("line_{}.svg", number + 1);
        let title = format!("Evaluation line “{}”", line.name);
        drawn.push((heading(&file, &title), lines::draw(line, number + 1)));
    }
    for (number, barrier) in report.barriers.iter().enumerate() {
        let file = format!("barrier_{}.svg", number + 1);
        let title = format!("Barrier “{}”", barrier.name);
        drawn.push((heading(&file, &title), barriers::draw(barrier, number + 1)));
    }
    drawn
}

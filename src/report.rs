//! Figures and the page, drawn from plain numbers.
//!
//! ```text
//! Report ─► FIGURES (plan, side, runout, …) ─► figures/*.svg
//!                                          └─► report.html (figures inlined)
//! Results ─► view.html, view.glb (the slope in three dimensions)
//! ```
//!
//! Nothing is computed here that a reader would quote: estimates and intervals come in as `model` has them; only the
//! bins of histograms and the envelopes along the fall line are found for display.

mod along_paths;
mod annual;
mod answers;
pub mod axis;
mod barriers;
mod by_frequency;
pub mod colour;
pub mod compare;
pub mod contour;
pub mod curves;
mod distributions;
pub mod figure;
pub mod figures;
mod bound;
pub mod format;
pub mod from_results;
mod hillshade;
mod histogram;
pub mod html;
pub mod model;
mod lines;
mod maps;
mod measured;
pub mod panel;
pub mod canvas;
mod plan_view;
mod planned;
mod plausibility;
mod profile;
pub mod raster;
mod reach_angle;
mod runout;
mod side_view;
mod site;
mod stops;
pub mod studied;
pub mod svg;
pub mod view;
pub mod words;

pub use answers::answers;
pub use from_results::first::{LeftAtHoles, untouched_ground, untouched_trees};
pub use plausibility::fast_rocks;

use crate::body::Shape;
use crate::error::{Error, Result};
use crate::hazard::Hazard;
use crate::output::{self, FolderLock, Results, write_atomic};
use crate::scene::Language;
use crate::terrain::Terrain;
use figure::{Drawing, Heading};
use figures::FIGURES;
use model::Report;
use raster::GroundRaster;
use std::fs;
use std::path::{Path, PathBuf};
use view::hulls::BlockHull;
use view::mesh::ViewMesh;
use words::{Words, fill};

/// Draws a finished run: `figures/*.svg`, `report.html`, and the ground it was drawn on, below the run's folder; `shape_of`
/// gives the shape of a release.
///
/// # Errors
/// When a result file cannot be read or a figure cannot be written.
pub fn draw_run(
    results: &Results,
    terrain: &Terrain,
    shape_of: impl Fn(usize) -> Option<Shape>,
) -> Result<()> {
    let ground = GroundRaster::as_used(terrain);
    ground.write_with_checksums(&results.dir)?;
    let epsg = results.summary.maps.as_ref().and_then(|maps| maps.epsg);
    ground.write_tif(&results.dir, epsg)?;
    let ground = ground.coarser(GROUND_CELLS);
    if results.summary.maps.is_some() {
        output::write_terrain(&results.dir, terrain, results.summary.site.mesh_origin_m)?;
    }
    let hull_of = |release| shape_of(release).map(|shape| BlockHull::of(&shape));
    view::write(results, ViewMesh::of(terrain), hull_of, Some(&ground))?;
    draw_all(results, Some(ground))
}

/// Draws a run put together from shards; the ground is that of the first of their folders.
///
/// # Errors
/// When a result file cannot be read or a figure cannot be written.
pub fn draw_merged(results: &Results, shards: &[PathBuf]) -> Result<()> {
    let shard = shards[0].as_path();
    let ground = GroundRaster::read(shard)?;
    if let Some(ground) = &ground {
        ground.write_with_checksums(&results.dir)?;
    }
    let ground = ground.map(|ground| ground.coarser(GROUND_CELLS));
    output::copy_used(shard, &results.dir)?;
    // what the run at once would have written beside its maps
    let terrain = "maps/terrain.vtk";
    let (from, to) = (shard.join(terrain), results.dir.join(terrain));
    if results.summary.maps.is_some() && from.exists() {
        fs::copy(&from, &to).map_err(Error::file("write", &to))?;
    }
    if let Some((mesh, hulls)) = view::kept_in(shards)? {
        view::write(results, mesh, |release| hulls.hull(release).cloned(), ground.as_ref())?;
    }
    draw_all(results, ground)
}

/// Draws a run again from its files alone; no mesh is read.
///
/// # Errors
/// When a result file cannot be read or a figure cannot be written.
pub fn draw_again(dir: &Path) -> Result<()> {
    let results = output::read(dir)?;
    let _lock = FolderLock::on(dir)?;
    let ground = GroundRaster::read(dir)?.map(|ground| ground.coarser(GROUND_CELLS));
    if let Some((mesh, hulls)) = view::kept_in(&[dir])? {
        view::write(&results, mesh, |release| hulls.hull(release).cloned(), ground.as_ref())?;
    }
    draw_all(&results, ground)
}

/// Figures and page of results, with a link to their view where there is one.
fn draw_all(results: &Results, ground: Option<GroundRaster>) -> Result<()> {
    let has_view = results.dir.join(view::PAGE).exists();
    draw(&Report { has_view, ..from_results::gather(results, ground)? }, &results.dir)
}

/// The main statistics with their 95 % intervals, one line of text each, and the warnings of the computation.
pub fn headline(hazard: &Hazard, at_holes: Option<&LeftAtHoles>) -> Vec<String> {
    let words = Words::of(Language::En);
    let warnings =
        [from_results::first::warnings_first(hazard, at_holes, words), hazard.warnings()].concat();
    let mut lines = html::plain_headline(&from_results::headline(hazard, words), words);
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
    let mut drawn = drawings(report);
    drawn.extend(error_study(dir, report));
    let names: Vec<&str> = drawn.iter().map(|(heading, _)| heading.file.as_str()).collect();
    output::announce_figures(dir, &names)?;
    for (heading, drawing) in &drawn {
        write_atomic(&figures.join(&heading.file), drawing.svg.as_bytes())?;
    }
    write_atomic(&dir.join("report.html"), html::page(report, &drawn).as_bytes())
}

/// The figure of errors over run time, where this very scene has been studied.
fn error_study(dir: &Path, report: &Report) -> Option<(Heading, Drawing)> {
    let words = report.words();
    let (svg, releases) =
        studied::figure(dir, (report.text.scene_hash.as_str(), report.text.seed))?;
    let heading = Heading { file: studied::FIGURE.to_owned(), title: words.error_study.to_owned() };
    let releases = format::decimal(releases as f64, 0);
    let caption = fill(words.error_study_caption, &[("releases", &releases)]);
    Some((heading, Drawing { svg, caption }))
}

/// All figures, drawn. Lines and barriers that no rock reaches have a sentence on the page and no figure.
pub fn drawings(report: &Report) -> Vec<(Heading, Drawing)> {
    let words = report.words();
    let heading =
        |file: &str, title: &str| Heading { file: file.to_owned(), title: title.to_owned() };
    let named = |template: &str, name: &str| fill(template, &[("name", &words.quoted(name))]);
    // without paths there is nothing to see from the side
    let is_shown = |file: &str| file != side_view::FILE || !report.paths.is_empty();
    let mut drawn: Vec<(Heading, Drawing)> = FIGURES
        .iter()
        .filter(|figure| is_shown(figure.file))
        .map(|figure| (heading(figure.file, (figure.title)(words)), (figure.draw)(report)))
        .collect();
    if let Some(view) = &report.profile {
        drawn.push((heading("profile.svg", words.profile_title), profile::draw(report, view)));
    }
    if let Some(drawing) = along_paths::draw(report) {
        drawn.push((heading("along.svg", words.along_title), drawing));
    }
    if let Some(observed) = &report.observed {
        drawn.push((
            heading("measured.svg", words.measured_title),
            measured::draw(report, observed),
        ));
    }
    if let Some(cells) = &report.maps {
        let headings = [
            heading("maps.svg", words.maps_title),
            heading("maps_values.svg", words.map_values_title),
            heading("maps_ends.svg", words.map_ends_title),
        ];
        drawn.extend(headings.into_iter().zip(maps::draw(report, cells)));
        let of_year = report.year_maps.as_ref().map(|year| maps::draw_year(report, cells, year));
        let of_year = of_year.map(|year| (heading("maps_year.svg", words.year().maps_title), year));
        drawn.extend(of_year);
    }
    if report.lines.len() > 1 {
        drawn.push((
            heading("retention.svg", words.retention),
            lines::retention(&report.lines, words),
        ));
    }
    let annual = report.annual.iter().enumerate();
    for (number, view) in annual.filter(|(_, view)| view.is_met()) {
        let file = format!("annual_{}.svg", number + 1);
        let title = named(words.year_title, &view.name);
        drawn.push((heading(&file, &title), annual::draw(words, view, number + 1)));
    }
    // what passes a barrier's line stands in the barrier's own figure
    let own = report.lines.iter().filter(|line| !line.is_barrier);
    for line in own.filter(|line| line.is_met()) {
        // names of lines may hold anything: files are numbered
        let file = format!("line_{}.svg", line.number);
        let title = named(words.line_title, &line.name);
        drawn.push((heading(&file, &title), lines::draw(words, line)));
    }
    let barriers = report.barriers.iter().enumerate();
    for (number, barrier) in barriers.filter(|(_, one)| one.is_met()) {
        let file = format!("barrier_{}.svg", number + 1);
        let title = named(words.barrier_name, &barrier.name);
        drawn.push((heading(&file, &title), barriers::draw(words, barrier, number + 1)));
    }
    drawn
}

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
pub mod colour;
pub mod contour;
mod distributions;
pub mod figure;
pub mod format;
mod hillshade;
mod histogram;
pub mod html;
pub mod input;
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
use figure::{Drawing, FIGURES, Figure};
use input::Report;
use std::fs;
use std::path::Path;

/// Writes `figures/*.svg` and `report.html` below `dir`.
///
/// # Errors
/// When a file or folder cannot be written.
pub fn draw(report: &Report, dir: &Path) -> Result<()> {
    let figures = dir.join("figures");
    fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
    let drawn = drawings(report);
    for (figure, drawing) in &drawn {
        let path = figures.join(figure.file);
        fs::write(&path, &drawing.svg).map_err(Error::file("write", &path))?;
    }
    let path = dir.join("report.html");
    fs::write(&path, html::page(report, &drawn)).map_err(Error::file("write", &path))
}

/// All figures, drawn.
pub fn drawings(report: &Report) -> Vec<(Figure, Drawing)> {
    FIGURES.iter().map(|figure| (*figure, (figure.draw)(report))).collect()
}

//! What a figure is.

use super::model::Report;
use super::words::Words;

/// Width of figures (px, 1/96 inch): 180 mm, the text width of an A4 page. A slender map has a narrower sheet.
pub const WIDTH_PX: f64 = 680.0;

/// A drawn figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawing {
    /// The file, self-contained.
    pub svg: String,
    /// What it shows, in whole sentences.
    pub caption: String,
}

/// Where a drawn figure goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heading {
    /// File name below `figures/`.
    pub file: String,
    /// Heading on the page.
    pub title: String,
}

/// A figure of the report.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    /// File name below `figures/`.
    pub file: &'static str,
    /// Heading on the page.
    pub title: fn(&Words) -> &'static str,
    /// Draws it; every input gives a figure.
    pub draw: fn(&Report) -> Drawing,
}

//! The list of figures.

use super::model::Report;
use super::words::Words;
use super::{distributions, plan_view, reach_angle, runout, side_view, stops};

/// Width of every figure (px, 1/96 inch): 180 mm, the text width of an A4 page.
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

/// All figures in the order of the page. To add one: a file with a `draw` function and a line here.
pub const FIGURES: [Figure; 6] = [
    Figure { file: "plan.svg", title: |words| words.plan_title, draw: plan_view::draw },
    Figure { file: "stops.svg", title: |words| words.stops_title, draw: stops::draw },
    Figure { file: "side.svg", title: |words| words.side_title, draw: side_view::draw },
    Figure { file: "runout.svg", title: |words| words.runout, draw: runout::draw },
    Figure { file: "reach_angle.svg", title: |words| words.reach_angle, draw: reach_angle::draw },
    Figure {
        file: "distributions.svg",
        title: |words| words.distributions_title,
        draw: distributions::draw,
    },
];

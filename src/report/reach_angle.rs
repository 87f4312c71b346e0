//! The reach angle against what is observed in the field.

use super::axis::Axis;
use super::colour::{GREY, ORANGE};
use super::distributions::Distribution;
use super::figure::{Drawing, WIDTH_PX};
use super::input::{Quantity, Report};
use super::panel::{FOOT_PX, Panel};
use super::paper::{Label, Paper, Pen, paint};
use super::svg::path::Frame;

/// Where medians of observed events lie (degrees): lowest, highest, kind of slope.
const OBSERVED: [(f64, f64, &str); 2] =
    [(20.0, 40.0, "low slope above a meadow"), (32.0, 35.0, "high talus slope")];
const PLOT_PX: f64 = 150.0;
const TOP_PX: f64 = 60.0;

/// Draws the histogram over the bands.
pub(super) fn draw(report: &Report) -> Drawing {
    let frame = Frame { left: 56.0, right: WIDTH_PX - 16.0, top: TOP_PX, bottom: TOP_PX + PLOT_PX };
    let mut angles = Distribution::of(report, Quantity::ReachAngle, frame);
    let x = &angles.panel.x;
    // both bands stay in sight, with room for their names
    angles.panel.x = Axis::linear(x.low.min(10.0), x.high.max(50.0), x.title.clone());
    let svg = paint("reach", (WIDTH_PX, frame.bottom + FOOT_PX), "Reach angle", |paper| {
        for (line, band) in OBSERVED.iter().enumerate() {
            observed(paper, &angles.panel, band, line);
        }
        angles.draw(paper, 50.0);
    });
    let caption = "Reach angle (Fahrböschung), atan(drop / runout), from release to end. Shaded: where the medians of observed \
                   events lie. A median outside both asks for a look at friction, rolling friction and stop rule.";
    Drawing { svg, caption: caption.to_owned() }
}

/// A shaded band with a bracket above the frame that names it.
fn observed(paper: &Paper<'_>, panel: &Panel, &(low, high, name): &(f64, f64, &str), line: usize) {
    let (left, right) = (panel.at(low, 0.0).0, panel.at(high, 0.0).0);
    paper.fill(&Frame { left, right, ..panel.frame }, ORANGE, 0.16);
    let y = panel.frame.top - 26.0 + 16.0 * line as f64;
    let bracket = [(left, y + 4.0), (left, y), (right, y), (right, y + 4.0)];
    paper.line(&bracket, Pen::full(ORANGE, 1.2));
    let words = format!("{name}: {low} to {high}°");
    paper.text(&Label::new(words, (left - 7.0, y)).right().coloured(GREY));
}

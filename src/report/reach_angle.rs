//! The reach angle against what is observed in the field.

use super::axis::Axis;
use super::colour::{GREY, ORANGE};
use super::distributions::Distribution;
use super::figure::{Drawing, WIDTH_PX};
use super::input::{Quantity, Report};
use super::panel::{FOOT_PX, Panel};
use super::paper::{Label, Paper, paint};
use super::svg::path::Frame;

/// Where medians of observed events lie (degrees): lowest, highest, kind of slope, opacity.
const OBSERVED: [(f64, f64, &str, f64); 2] = [
    (20.0, 40.0, "low slope above a meadow: 20 to 40°", 0.13),
    (32.0, 35.0, "high talus slope: 32 to 35°", 0.30),
];
const PLOT_PX: f64 = 150.0;
const TOP_PX: f64 = 62.0;

/// Draws the histogram over the bands.
pub(super) fn draw(report: &Report) -> Drawing {
    let frame =
        Frame { left: 56.0, right: WIDTH_PX - 16.0, top: TOP_PX, bottom: TOP_PX + PLOT_PX };
    let mut angles = Distribution::of(report, Quantity::ReachAngle, frame);
    let x = &angles.panel.x;
    // both bands stay in sight
    angles.panel.x = Axis::linear(x.low.min(15.0), x.high.max(45.0), x.title.clone());
    let svg = paint("reach", (WIDTH_PX, frame.bottom + FOOT_PX), "Reach angle", |paper| {
        for (line, band) in OBSERVED.iter().enumerate() {
            observed(paper, &angles.panel, band, line);
        }
        angles.draw(paper);
    });
    let caption = "Reach angle (Fahrböschung), atan(drop / runout), from release to end. Shaded: where the medians of observed \
                   events lie. A median outside both asks for a look at friction, rolling friction and stop rule.";
    Drawing { svg, caption: caption.to_owned() }
}

fn observed(
    paper: &Paper<'_>,
    panel: &Panel,
    &(low, high, words, opacity): &(f64, f64, &str, f64),
    line: usize,
) {
    let (left, right) = (panel.at(low, 0.0).0, panel.at(high, 0.0).0);
    paper.fill(&Frame { left, right, ..panel.frame }, ORANGE, opacity);
    // the names stand above the head of the histogram, each over the middle of its band
    let y = 9.0 + 14.0 * line as f64;
    let label = Label::new(words, (0.5 * (left + right), y)).centred().coloured(GREY);
    paper.text(&label);
}

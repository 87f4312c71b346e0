//! The reach angle against what is observed in the field.

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{INK, ORANGE, VERMILLION};
use super::distributions::DistributionPanel;
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{Is, Report, ReportQuantity};
use super::panel::{FOOT_PX, Panel};
use super::svg::path::PaperFrame;
use super::words::{Words, fill};

/// Where medians of observed events lie (degrees), lowest and highest: low slopes above a meadow, high talus slopes.
const OBSERVED: [(f64, f64); 2] = [(20.0, 40.0), (32.0, 35.0)];
const PLOT_PX: f64 = 150.0;
const TOP_PX: f64 = 48.0;
/// Opacity of each band.
const SHADES: [f64; 2] = [0.16, 0.34];

/// The median; none without rocks.
pub(super) fn median(report: &Report) -> Option<(f64, Is)> {
    let known = report.quantiles.get(&ReportQuantity::ReachAngle)?;
    let found = known.iter().find(|q| (q.probability - 0.5).abs() < 1e-9)?;
    found.at.value.is_finite().then_some((found.at.value, found.at.is))
}

/// Whether a median lies where those of some observed events lie.
pub(super) fn is_observed(degrees: f64) -> bool {
    OBSERVED.iter().any(|(low, high)| (*low..=*high).contains(&degrees))
}

/// Draws the histogram over the bands.
pub(super) fn draw(report: &Report) -> Drawing {
    let words = report.words();
    let frame =
        PaperFrame { left: 56.0, right: WIDTH_PX - 16.0, top: TOP_PX, bottom: TOP_PX + PLOT_PX };
    let mut angles = DistributionPanel::of(report, ReportQuantity::ReachAngle, frame);
    let x = &angles.panel.x;
    // both bands stay in sight
    angles.panel.x = Axis::linear(x.low.min(10.0), x.high.max(50.0), x.title.clone());
    let svg = paint("reach", (WIDTH_PX, frame.bottom + FOOT_PX), words.reach_angle, |canvas| {
        for (band, shade) in OBSERVED.iter().zip(SHADES) {
            shaded(canvas, &angles.panel, band, shade);
        }
        angles.draw(canvas, 36.0);
        key(canvas, &angles.panel, words);
    });
    let verdict = median(report).map_or(String::new(), |(at, is)| {
        let text = if is_observed(at) { words.median_inside } else { words.median_outside };
        let at = format!("{}{}", format::sign(is), format::significant(at, 3));
        fill(text, &[("median", &at)])
    });
    let caption = fill(words.reach_caption, &[("verdict", &verdict)]);
    Drawing { svg, caption: caption.trim_end().to_owned() }
}

fn shaded(canvas: &Canvas<'_>, panel: &Panel, &(low, high): &(f64, f64), shade: f64) {
    let (left, right) = (panel.at(low, 0.0).0, panel.at(high, 0.0).0);
    canvas.fill(&PaperFrame { left, right, ..panel.frame }, ORANGE, shade);
    for x in [left, right] {
        let side = [(x, panel.frame.top), (x, panel.frame.bottom)];
        canvas.line(&side, Pen { opacity: 0.6, ..Pen::full(VERMILLION, 0.7) });
    }
}

/// The bands by name, in a line of their own above the frame.
fn key(canvas: &Canvas<'_>, panel: &Panel, words: &Words) {
    let y = panel.frame.top - 12.0;
    let mut x = panel.frame.left;
    let names = [words.low_slope, words.high_talus];
    for (((low, high), name), shade) in OBSERVED.iter().zip(names).zip(SHADES) {
        let patch = PaperFrame { left: x, right: x + 16.0, top: y - 5.0, bottom: y + 5.0 };
        canvas.fill(&patch, ORANGE, shade);
        canvas.outline(&patch, Pen::full(INK, 0.4));
        let band = fill(words.band, &[("name", &name), ("low", low), ("high", high)]);
        x += 22.0 + text_width(&band, SMALL) + 22.0;
        canvas.text(&Label::new(band, (patch.right + 5.0, y)));
    }
}

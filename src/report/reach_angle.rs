//! The reach angle against what is observed in the field.

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{INK, ORANGE, VERMILLION};
use super::distributions::DistributionPanel;
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{Estimate, Is, Plausibility, Report, ReportQuantity};
use super::panel::{FOOT_PX, Panel};
use super::runout;
use super::svg::path::PaperFrame;
use super::words::{Words, fill};

/// Where medians of observed events lie (degrees), lowest and highest: low slopes above a meadow, high talus slopes.
const OBSERVED: [(f64, f64); 2] = [(20.0, 40.0), (32.0, 35.0)];
const PLOT_PX: f64 = 150.0;
const TOP_PX: f64 = 48.0;
/// Opacity of each band.
const SHADES: [f64; 2] = [0.16, 0.34];

/// The median (degrees); none without rocks.
pub(super) fn median(report: &Report) -> Option<Estimate> {
    let known = report.quantiles.get(&ReportQuantity::ReachAngle)?;
    let found = known.iter().find(|q| (q.probability - 0.5).abs() < 1e-9)?;
    found.at.value.is_finite().then_some(found.at)
}

/// Whether a median lies where those of some observed events lie, as far as its interval tells; an end that is not known tells nothing.
pub(super) fn observed(median: &Estimate) -> Plausibility {
    let is_in = |degrees: f64| OBSERVED.iter().any(|(low, high)| (*low..=*high).contains(&degrees));
    let is_here = is_in(median.value);
    let mut ends = [median.low, median.high].into_iter().filter(|end| end.is_finite());
    match (is_here, ends.all(|end| is_in(end) == is_here)) {
        (_, false) => Plausibility::AtLimit,
        (true, true) => Plausibility::Plausible,
        (false, true) => Plausibility::Off,
    }
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
    let verdict = median(report).map_or(String::new(), |at| verdict(&at, words));
    let open = match runout::open_rocks(report) {
        0 => String::new(),
        n => fill(words.drawn().reach_open, &[("n", &format::decimal(n as f64, 0))]),
    };
    // the verdict is of the medians, the bound of the rocks
    let verdict = format!("{} {verdict}", open.trim_start());
    let caption = fill(words.reach_caption, &[("verdict", &verdict.trim_start())]);
    Drawing { svg, caption: caption.trim_end().to_owned() }
}

/// Whether the median lies where others were observed. One that may be lower by any amount says nothing, unless even
/// its bound is below them.
fn verdict(median: &Estimate, words: &Words) -> String {
    let is_open = median.is == Is::AtMost && !median.low.is_finite();
    let may_be_observed = OBSERVED.iter().any(|(low, _)| median.value >= *low);
    if is_open && may_be_observed {
        let at = format::significant(median.value, 3);
        return fill(words.open().median, &[("median", &at)]);
    }
    let text = match observed(median) {
        Plausibility::Plausible => words.median_inside,
        Plausibility::AtLimit => words.median_at_limit,
        Plausibility::Off | Plausibility::NotJudged => words.median_outside,
    };
    let at = format!("{}{}", format::sign(median.is), format::significant(median.value, 3));
    fill(text, &[("median", &at)])
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Language;

    /// Which side of a limit the median lies on is told only where its whole interval lies there.
    #[test]
    fn the_interval_decides_what_is_plausible() {
        let said = |value, low, high| observed(&Estimate::new(value, low, high));
        assert_eq!(said(39.9, 39.2, 40.7), Plausibility::AtLimit);
        assert_eq!(said(40.1, 39.8, 40.7), Plausibility::AtLimit);
        assert_eq!(said(39.0, 38.2, 39.7), Plausibility::Plausible);
        assert_eq!(said(42.0, 41.2, 42.7), Plausibility::Off);
        assert_eq!(said(42.0, f64::NAN, f64::NAN), Plausibility::Off);
    }

    /// Three rocks of four have left: nobody knows how flat their way would have become.
    #[test]
    fn an_open_median_is_not_said_to_be_observed() {
        let words = Words::of(Language::En);
        let said = |value: f64, low: f64| {
            let at = Estimate { is: Is::AtMost, ..Estimate::new(value, low, value + 0.1) };
            verdict(&at, words)
        };
        assert_eq!(
            said(28.9, 28.7),
            "The median of ≤\u{2009}28.9° lies where such medians are observed."
        );
        assert!(said(28.9, f64::NAN).starts_with("The median is at most 28.9°"));
        assert!(said(15.0, f64::NAN).contains("outside both"));
    }
}

//! Why the rocks ended, as counts and shares.

use super::axis::Axis;
use super::by_frequency;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{INK, SKY};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{Report, StopShare};
use super::panel::{FOOT_PX, Panel};
use super::svg::path::PaperFrame;
use super::words::{Words, fill};
use crate::math;
use crate::simulation::Stop;

const LINE_PX: f64 = 30.0;
const BAR_PX: f64 = 15.0;
/// Room right of the bars for count, share and interval (px), at least; what is said there takes as much as it needs.
const RIGHT_PX: f64 = 250.0;
/// From a bar's frame to what is said beside it, and from there to the figure's edge (px).
const BESIDE_PX: f64 = 10.0;
const TOP_PX: f64 = 8.0;

/// Draws the bars.
pub(super) fn draw(report: &Report) -> Drawing {
    let words = report.words();
    let lines = report.stops.len().max(1) as f64;
    let bottom = TOP_PX + lines * LINE_PX;
    let names = report.stops.iter().map(|share| text_width(name(&share.stop, words), SMALL));
    let left = names.fold(94.0, f64::max) + 16.0;
    let said: Vec<Label> =
        report.stops.iter().map(|share| said(share, report.is_weighted, words)).collect();
    let beside = said.iter().map(|label| label.width_px() + 2.0 * BESIDE_PX);
    let right = WIDTH_PX - beside.fold(RIGHT_PX, f64::max);
    let frame = PaperFrame { left, top: TOP_PX, right, bottom };
    let ends = report.stops.iter().flat_map(|share| [share.share.value, share.share.high]);
    // the axis ends where the longest bar and its interval do
    let most = Axis::from_zero(ends.map(|share| 100.0 * share), "").high.min(100.0);
    let x = Axis::linear(0.0, most, words.share_of_releases_percent);
    let panel = Panel::new(frame, x, Axis::linear(0.0, lines, ""));
    let svg = paint("stops", (WIDTH_PX, bottom + FOOT_PX), words.stops_alt, |canvas| {
        panel.grid_upright(canvas);
        for (line, (share, said)) in report.stops.iter().zip(said).enumerate() {
            bar(canvas, &panel, (line, share, said), words);
        }
        if report.stops.is_empty() {
            panel.nothing(canvas, words.no_release);
        }
        panel.x_axis(canvas);
        canvas.outline(&frame, Pen::full(INK, 0.8));
    });
    let note = report.is_weighted.then_some(by_frequency::SHARES);
    Drawing { svg, caption: by_frequency::noted(words.stops_caption.to_owned(), note, words) }
}

/// Name of a stop reason in a table or on an axis.
fn name(stop: &Stop, words: &Words) -> &'static str {
    match stop {
        Stop::AtRest => words.at_rest,
        Stop::LeftTerrain => words.left_terrain,
        Stop::TimeUp => words.time_up,
        Stop::OverBudget => words.over_budget,
        Stop::NotReleased(_) => words.not_released,
        Stop::Failed(_) => words.failed,
    }
}

fn bar(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (line, share, said): (usize, &StopShare, Label),
    words: &Words,
) {
    let y = panel.frame.top + (line as f64 + 0.5) * LINE_PX;
    let at = |share: f64| panel.at((100.0 * share).clamp(0.0, panel.x.high), 0.0).0;
    let percent = share.share;
    if percent.value > 0.0 {
        let (left, right) = (panel.frame.left, at(percent.value));
        let bar = PaperFrame { left, right, top: y - 0.5 * BAR_PX, bottom: y + 0.5 * BAR_PX };
        canvas.fill(&bar, SKY, 1.0);
    }
    if percent.low.is_finite() && percent.high.is_finite() {
        let (low, high) = (at(percent.low), at(percent.high));
        let pen = Pen::full(INK, 1.0);
        canvas.line(&[(low, y), (high, y)], pen);
        for x in [low, high] {
            canvas.line(&[(x, y - 3.5), (x, y + 3.5)], pen);
        }
    }
    canvas.text(&Label::new(name(&share.stop, words), (panel.frame.left - 8.0, y)).right());
    canvas.text(&said.moved((panel.frame.right + BESIDE_PX, y)));
}

/// Share, interval and count of a reason.
fn said(share: &StopShare, is_weighted: bool, words: &Words) -> Label {
    let count = format::decimal(share.count as f64, 0);
    let percent = share.share;
    let decimals = decimals_for(percent.high - percent.low);
    let [share, low, high] =
        format::percents([percent.value, percent.low, percent.high], |_| decimals);
    let interval = words.interval(&low, &high);
    // a weighted share is not that of the count
    let (head, interval) = if is_weighted {
        let computed = fill(&words.say(by_frequency::COUNT), &[("n", &count)]);
        (share, format!("{interval}; {computed}"))
    } else {
        (format!("{count} ({share})"), interval)
    };
    Label::new(head, (0.0, 0.0)).followed_by(interval)
}

/// Decimals of a percentage that an interval of some width (share) leaves meaningful.
fn decimals_for(width: f64) -> usize {
    let leading = math::log10(100.0 * width).floor();
    if leading.is_finite() { (1.0 - leading).clamp(1.0, 4.0) as usize } else { 1 }
}

//! How far the rocks ran: exceedance with its band above, histogram below.

use super::axis::Axis;
use super::colour::{BLUE, GREY, INK, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::histogram::{Histogram, percent_of};
use super::input::{Quantile, Quantity, Report};
use super::panel::{FOOT_PX, Panel, align};
use super::paper::{Label, Paper, Pen, SMALL, paint, text_width};
use super::svg::path::Frame;

const TOP_PX: f64 = 12.0;
const UPPER_PX: f64 = 220.0;
const LOWER_PX: f64 = 110.0;
const GAP_PX: f64 = 18.0;
/// From so many releases on the tail is worth a logarithmic scale.
const MANY: usize = 100;

/// Draws both panels over one x axis.
pub(super) fn draw(report: &Report) -> Drawing {
    let values: Vec<f64> = report.releases.iter().map(|fall| fall.runout_m).collect();
    let bins = Histogram::of(&values);
    let (upper, lower) = panels(report, &bins, values.len());
    let quantiles = report.quantiles.get(&Quantity::Runout).map_or(&[][..], Vec::as_slice);
    let height = lower.frame.bottom + FOOT_PX;
    let svg = paint("runout", (WIDTH_PX, height), "Runout", |paper| {
        upper.grid(paper);
        lower.grid(paper);
        exceedance(paper, &upper, report);
        bins.bars(paper, &lower, values.len());
        for quantile in quantiles {
            let pen = Pen::full(INK, 0.7).dotted();
            upper.upright(paper, quantile.at.value, pen);
            lower.upright(paper, quantile.at.value, pen);
        }
        mark(paper, &upper, quantiles);
        upper.axes_above_another(paper);
        lower.axes(paper);
        if values.is_empty() {
            lower.nothing(paper, "no release");
        }
    });
    Drawing { svg, caption: caption(&bins, values.len()) }
}

fn caption(bins: &Histogram, count: usize) -> String {
    let left_out = match bins.left_out {
        0 => String::new(),
        n => format!(" {n} runouts are not finite and in no bin."),
    };
    format!(
        "Horizontal distance from release to end. Above: share of the {} releases that run out farther, with its 95 % band; \
         bars give the 95 % interval of the marked percentiles. Below: share of releases per {} m.{left_out}",
        format::decimal(count as f64, 0),
        format::plain(bins.width)
    )
}

fn panels(report: &Report, bins: &Histogram, count: usize) -> (Panel, Panel) {
    let mut x = bins.axis("Runout (m)");
    // bins far from 0 still show how far that is
    if x.low > 0.0 && x.low < 0.5 * x.high {
        x.low = 0.0;
    }
    let least = report.runout_exceedance.iter().map(|p| p.y.value).filter(|&y| y > 0.0);
    let y = if count >= MANY {
        let least = least.fold(0.1, f64::min).max(1e-4);
        Axis::log(least, 1.0, "Share running farther")
    } else {
        Axis::linear(0.0, 1.0, "Share running farther")
    };
    let tallest = percent_of(bins.largest(), count);
    let shares = Axis::from_zero([1.05 * tallest], "Releases (%)");
    let (top, bottom) = (TOP_PX, TOP_PX + UPPER_PX);
    let right = WIDTH_PX - 16.0;
    let mut upper = Panel::new(Frame { left: 0.0, top, right, bottom }, x.clone(), y);
    let (top, bottom) = (bottom + GAP_PX, bottom + GAP_PX + LOWER_PX);
    let mut lower = Panel::new(Frame { left: 0.0, top, right, bottom }, x, shares);
    align([&mut upper, &mut lower]);
    (upper, lower)
}

/// The curve as the steps it consists of, over its band.
fn exceedance(paper: &Paper<'_>, panel: &Panel, report: &Report) {
    let curve = &report.runout_exceedance;
    let band: Vec<(f64, f64, f64)> = curve.iter().map(|p| (p.x, p.y.low, p.y.high)).collect();
    panel.band(paper, &band, SKY, 0.35);
    // where the curve is 0 a logarithmic axis has no place: the line ends at the last rock
    let shown: Vec<(f64, f64)> = curve
        .iter()
        .map(|p| (p.x, p.y.value))
        .filter(|&(_, y)| !panel.y.is_log || y > 0.0)
        .collect();
    panel.line(paper, &shown, Pen::full(BLUE, 1.6));
    if curve.is_empty() {
        panel.nothing(paper, "no curve");
    }
}

/// Percentiles on the curve with their intervals and values beside them.
fn mark(paper: &Paper<'_>, panel: &Panel, quantiles: &[Quantile]) {
    let mut lowest_free = panel.frame.bottom - 8.0;
    // from the bottom upwards, so that a label can make way
    for quantile in quantiles.iter().rev() {
        let exceeded = 1.0 - quantile.probability;
        let (x, y) = panel.at(quantile.at.value, exceeded);
        if !panel.frame.holds((x, y)) {
            continue;
        }
        let end = |bound: f64| {
            let end = panel.at(bound, exceeded).0;
            if end.is_finite() { end.clamp(panel.frame.left, panel.frame.right) } else { x }
        };
        whisker(paper, (end(quantile.at.low), end(quantile.at.high)), y);
        paper.disc((x, y), 3.0, VERMILLION);
        lowest_free = label(paper, panel, quantile, lowest_free) - SMALL - 3.0;
    }
}

fn whisker(paper: &Paper<'_>, (low, high): (f64, f64), y: f64) {
    let pen = Pen::full(VERMILLION, 1.4);
    paper.line(&[(low, y), (high, y)], pen);
    for x in [low, high] {
        paper.line(&[(x, y - 4.0), (x, y + 4.0)], pen);
    }
}

/// Writes name, value and interval beside a point, no lower than `lowest` (px); returns where it stands.
fn label(paper: &Paper<'_>, panel: &Panel, quantile: &Quantile, lowest: f64) -> f64 {
    let at = quantile.at;
    let name = format!("P{}", format::significant(100.0 * quantile.probability, 2));
    let head = format!("{name} {} m", format::significant(at.value, 4));
    let tail = match (at.low.is_finite(), at.high.is_finite()) {
        (true, true) => {
            format!("({} to {})", format::significant(at.low, 4), format::significant(at.high, 4))
        }
        _ => "(too few rocks for an interval)".to_owned(),
    };
    let bold = 1.06 * text_width(&head, SMALL) + 5.0;
    let width = bold + text_width(&tail, SMALL);
    let (x, y) = panel.at(at.value, 1.0 - quantile.probability);
    // the curve falls: what stands right of a point is clear of it above, what stands left below
    let (left, y) = if x + 8.0 + width < panel.frame.right {
        (x + 8.0, y - 11.0)
    } else {
        ((x - 8.0 - width).max(panel.frame.left + 4.0), y + 11.0)
    };
    let y = y.min(lowest).max(panel.frame.top + SMALL);
    paper.text_on_rim(&Label::new(head, (left, y)).bold());
    paper.text_on_rim(&Label::new(tail, (left + bold, y)).coloured(GREY));
    y
}

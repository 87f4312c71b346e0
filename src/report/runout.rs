//! How far the rocks ran: exceedance with its band above, histogram below.

use super::axis::Axis;
use super::by_frequency;
use super::canvas::{Canvas, Label, Pen, SMALL, paint};
use super::colour::{BLUE, GREY, INK, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::histogram::EqualBins;
use super::model::{Is, Quantile, ReleaseEnd, Report, ReportQuantity};
use super::panel::{FOOT_PX, Panel, align};
use super::svg::path::PaperFrame;
use super::words::{Words, fill};
use crate::hazard::StopKind;

const TOP_PX: f64 = 12.0;
const UPPER_PX: f64 = 220.0;
const LOWER_PX: f64 = 110.0;
const GAP_PX: f64 = 18.0;
/// From so many releases on the tail is worth a logarithmic scale.
const MANY: usize = 100;

/// Draws both panels over one x axis.
pub(super) fn draw(report: &Report) -> Drawing {
    let words = report.words();
    let bins = EqualBins::of(&report.weighed(|fall| fall.runout_m));
    let (upper, lower) = panels(report, &bins);
    let quantiles = report.quantiles.get(&ReportQuantity::Runout).map_or(&[][..], Vec::as_slice);
    let height = lower.frame.bottom + FOOT_PX;
    let svg = paint("runout", (WIDTH_PX, height), words.runout, |canvas| {
        upper.grid(canvas);
        lower.grid(canvas);
        exceedance(canvas, &upper, report);
        bins.bars(canvas, &lower);
        for quantile in quantiles {
            let pen = Pen::full(INK, 0.7).dotted();
            upper.upright(canvas, quantile.at.value, pen);
            lower.upright(canvas, quantile.at.value, pen);
        }
        mark(canvas, &upper, quantiles);
        values(canvas, &upper, report, quantiles);
        open_end(canvas, &upper, report);
        upper.axes_above_another(canvas);
        lower.axes(canvas);
        if report.releases.is_empty() {
            lower.nothing(canvas, words.no_release);
        }
    });
    Drawing { svg, caption: caption(report, &bins) }
}

/// Rocks whose runout is only a lower bound, and whose reach angle an upper one.
pub(super) fn open_rocks(report: &Report) -> usize {
    report.releases.iter().filter(|release| is_open(release)).count()
}

/// Whether a rock would have gone on.
pub(super) fn is_open(release: &ReleaseEnd) -> bool {
    StopKind::from(&release.stop).is_open()
}

/// Says beside the end of a curve why it ends: beyond, rocks that left the terrain decide.
fn open_end(canvas: &Canvas<'_>, panel: &Panel, report: &Report) {
    let open = open_rocks(report);
    let last = report.runout_exceedance.last();
    let Some(last) = last.filter(|last| open > 0 && last.y.value * report.released() as f64 > 1.5)
    else {
        return;
    };
    let (x, y) = panel.at(last.x, last.y.value);
    if !panel.frame.holds((x, y)) {
        return;
    }
    canvas.line(&[(x, y - 7.0), (x, y + 7.0)], Pen::full(BLUE, 1.6));
    canvas.line(&[(x, y), (x + 14.0, y)], Pen::full(BLUE, 1.2).dotted());
    let n = format::decimal(open as f64, 0);
    let words = fill(report.words().open_end, &[("n", &n)]);
    let candidates = [14.0, -14.0, 28.0, -28.0, 42.0, 56.0].into_iter().flat_map(|dy| {
        let at = |dx: f64| Label::new(words.clone(), (x + dx, y + dy)).coloured(BLUE);
        [at(6.0), at(-6.0).right(), at(0.0).centred()]
    });
    let on_curve = |room: &PaperFrame| {
        let mut spots = report.runout_exceedance.iter().map(|p| panel.at(p.x, p.y.value));
        spots.any(|spot| room.holds(spot))
    };
    let free = |label: &Label| {
        let room = label.frame();
        panel.frame.contains(&room) && canvas.is_free(&room) && !on_curve(&room)
    };
    if let Some(label) = candidates.into_iter().find(free) {
        canvas.text_on_rim(&label);
    }
}

fn caption(report: &Report, bins: &EqualBins) -> String {
    let words = report.words();
    let count = |n: usize| format::decimal(n as f64, 0);
    let said = |n: usize, text: &str| {
        if n == 0 { String::new() } else { fill(text, &[("n", &count(n))]) }
    };
    let has_curve = !report.runout_exceedance.is_empty() || report.releases.is_empty();
    let text = if has_curve { words.runout_caption } else { words.drawn().runout_no_curve };
    let open = if has_curve { open_rocks(report) } else { 0 };
    let caption =
        fill(text, &[("n", &count(report.released())), ("width", &format::plain(bins.width))]);
    let caption =
        caption + &said(open, words.runout_open) + &said(bins.left_out, words.runout_left_out);
    by_frequency::noted(caption, report.is_weighted.then_some(by_frequency::CURVES), words)
}

fn panels(report: &Report, bins: &EqualBins) -> (Panel, Panel) {
    let words = report.words();
    let mut x = bins.axis(words.runout_axis);
    // bins far from 0 still show how far that is
    if x.low > 0.0 && x.low < 0.5 * x.high {
        x.low = 0.0;
    }
    let least = report.runout_exceedance.iter().map(|p| p.y.value).filter(|&y| y > 0.0);
    let y = if report.released() >= MANY {
        let marked = report.quantiles.get(&ReportQuantity::Runout).into_iter().flatten();
        let marked = marked.map(|quantile| 0.999 * (1.0 - quantile.probability));
        let least = least.chain(marked).fold(0.1, f64::min).max(1e-4);
        Axis::log(least, 1.0, words.share_farther)
    } else {
        Axis::linear(0.0, 1.0, words.share_farther)
    };
    let shares = Axis::from_zero([1.05 * bins.tallest()], words.releases_percent);
    let (top, bottom) = (TOP_PX, TOP_PX + UPPER_PX);
    let right = WIDTH_PX - 16.0;
    let mut upper = Panel::new(PaperFrame { left: 0.0, top, right, bottom }, x.clone(), y);
    let (top, bottom) = (bottom + GAP_PX, bottom + GAP_PX + LOWER_PX);
    let mut lower = Panel::new(PaperFrame { left: 0.0, top, right, bottom }, x, shares);
    align([&mut upper, &mut lower]);
    (upper, lower)
}

/// The curve as the steps it consists of, over its band.
fn exceedance(canvas: &Canvas<'_>, panel: &Panel, report: &Report) {
    let curve = &report.runout_exceedance;
    let band: Vec<(f64, f64, f64)> = curve.iter().map(|p| (p.x, p.y.low, p.y.high)).collect();
    panel.band(canvas, &band, SKY, 0.35);
    // where the curve is 0 a logarithmic axis has no place: the line ends at the last rock
    let shown: Vec<(f64, f64)> = curve
        .iter()
        .map(|p| (p.x, p.y.value))
        .filter(|&(_, y)| !panel.y.is_log || y > 0.0)
        .collect();
    panel.line(canvas, &shown, Pen::full(BLUE, 1.6));
    if curve.is_empty() {
        // marks of percentiles fall from the upper left to the lower right
        let corner = (panel.frame.left + 12.0, panel.frame.bottom - 14.0);
        canvas.text(&Label::new(report.words().no_curve, corner).coloured(GREY));
    }
}

/// Percentiles on the curve with their intervals; their values in the corner that the curve leaves free.
fn mark(canvas: &Canvas<'_>, panel: &Panel, quantiles: &[Quantile]) {
    for quantile in quantiles {
        let exceeded = 1.0 - quantile.probability;
        let (x, y) = panel.at(quantile.at.value, exceeded);
        if !panel.frame.holds((x, y)) {
            continue;
        }
        let end = |bound: f64| {
            let end = panel.at(bound, exceeded).0;
            if end.is_finite() { end.clamp(panel.frame.left, panel.frame.right) } else { x }
        };
        whisker(canvas, (end(quantile.at.low), end(quantile.at.high)), y);
        canvas.disc((x, y), 3.0, VERMILLION);
        // the curve falls: above and to the right of a point is free, below and to the left too
        let words = match quantile.at.is {
            Is::AtLeast => format!("{}\u{2009}≥", name(quantile)),
            _ => name(quantile),
        };
        let at = |dx: f64, dy: f64| Label::new(words.clone(), (x + dx, y + dy)).bold();
        let candidates =
            [at(6.0, -10.0), at(-6.0, -10.0).right(), at(-6.0, 11.0).right(), at(6.0, 11.0)];
        let inner = PaperFrame { right: panel.frame.right - 5.0, ..panel.frame };
        let fits = |label: &Label| inner.contains(&label.frame()) && canvas.is_free(&label.frame());
        if let Some(label) = candidates.into_iter().find(fits) {
            canvas.text_on_rim(&label);
        }
    }
}

fn name(quantile: &Quantile) -> String {
    format!("P{}", format::significant(100.0 * quantile.probability, 2))
}

fn whisker(canvas: &Canvas<'_>, (low, high): (f64, f64), y: f64) {
    let pen = Pen::full(VERMILLION, 1.4);
    canvas.line(&[(low, y), (high, y)], pen);
    for x in [low, high] {
        canvas.line(&[(x, y - 4.0), (x, y + 4.0)], pen);
    }
}

/// Places along the frame at which values are tried between its corners.
const PLACES: u32 = 12;

/// Room beside values that no mark runs through (px).
const RIM_PX: f64 = 4.0;

/// Values and intervals, one line each, in the free corner.
fn values(canvas: &Canvas<'_>, panel: &Panel, report: &Report, quantiles: &[Quantile]) {
    let line_px = SMALL + 5.0;
    let lines = |left: f64, top: f64| -> Vec<Label> {
        let line = |(i, quantile): (usize, &Quantile)| {
            let (head, tail) = in_words(quantile, report.words());
            Label::new(head, (left, top + line_px * i as f64)).bold().followed_by(tail)
        };
        quantiles.iter().enumerate().map(line).collect()
    };
    let widest = lines(0.0, 0.0).iter().map(Label::width_px).fold(0.0, f64::max);
    let (frame, tall) = (panel.frame, line_px * quantiles.len() as f64);
    let (left, right) = (frame.left + 12.0, frame.right - widest - 12.0);
    let (top, bottom) = (frame.top + 14.0, frame.bottom - tall);
    let between = (1..PLACES).map(|k| left + (right - left) * f64::from(k) / f64::from(PLACES));
    let places = [(right, top), (left, bottom), (left, top), (right, bottom)].into_iter();
    let places = places.chain(between.flat_map(|x| [(x, top), (x, bottom)]));
    let marked: Vec<f64> = quantiles.iter().map(|q| panel.at(q.at.value, 1.0).0).collect();
    // the corner that the curve leaves free, no other text stands in and no mark runs through; else a place between them
    let crowd = |(left, top): (f64, f64)| {
        let room =
            PaperFrame { left, top: top - line_px, right: left + widest, bottom: top + tall };
        let on_curve =
            report.runout_exceedance.iter().filter(|p| room.holds(panel.at(p.x, p.y.value)));
        let taken = lines(left, top).iter().filter(|label| !canvas.is_free(&label.frame())).count();
        let rim = (left - RIM_PX)..=(left + widest + RIM_PX);
        let crossed = marked.iter().filter(|x| rim.contains(*x)).count();
        on_curve.count() + 1000 * (taken + crossed)
    };
    let best = places.min_by_key(|&place| crowd(place));
    for label in best.map_or(Vec::new(), |(left, top)| lines(left, top)) {
        canvas.text_on_rim(&label);
    }
}

/// Name and value, and the interval.
fn in_words(quantile: &Quantile, words: &Words) -> (String, String) {
    let at = quantile.at;
    let [value, low, high] = format::with_interval([at.value, at.low, at.high]);
    let tail = match words.interval(&low, &high) {
        none if none == format::NO_NUMBER => String::new(),
        interval => interval,
    };
    let sign = format::sign(at.is);
    (format!("{} {sign}{value}\u{2009}m", name(quantile)), tail)
}

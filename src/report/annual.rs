//! How often a year which energy is passed: the curve λ(E ≥ e) of a line or object, with its barriers and without them.

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{BLUE, GREY, INK, ORANGE, SKY};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{AnnualView, BandPoint, energy_unit};
use super::panel::{FOOT_PX, Panel};
use super::svg::path::PaperFrame;
use super::words::{Words, fill};
use crate::math;

const TOP_PX: f64 = 26.0;
const HEIGHT_PX: f64 = 300.0;
/// Room for the return periods right of the frame (px).
const RIGHT_PX: f64 = 84.0;
/// Energies far below the largest tell nothing of a design: so many decades are drawn.
const DECADES: f64 = 4.0;
/// Energies that no rock had are drawn up to so many times the largest.
const UNSEEN: f64 = 10.0;
const WITHOUT: Pen = Pen::full(BLUE, 1.7);
const WITH: Pen = Pen::full(ORANGE, 1.7).dashed();

/// What there is to say of a place that no rock comes to; none where one does.
pub(super) fn nobody(words: &Words, view: &AnnualView) -> Option<String> {
    let what = if view.is_object { words.object } else { words.line };
    let place = fill(what, &[("name", &words.quoted(&view.name))]);
    // a bound is not rounded down
    let rate = format::significant(math::rounded_up(view.most_per_year), 2);
    let count = |rocks: f64| format::decimal(rocks, 0);
    let [rocks, effective] = [view.rocks as f64, view.effective_rocks].map(count);
    let found: [(&str, &dyn std::fmt::Display); 4] =
        [("place", &place), ("rate", &rate), ("rocks", &rocks), ("effective", &effective)];
    (!view.is_met()).then(|| fill(words.nobody_year, &found))
}

/// Draws the curves of one place.
pub(super) fn draw(words: &Words, view: &AnnualView, number: usize) -> Drawing {
    let largest_j = largest_j(view);
    let (unit, size) = energy_unit(largest_j);
    let panel = panel(words, view, largest_j, (unit, size));
    let bottom = TOP_PX + HEIGHT_PX + FOOT_PX;
    let title = fill(words.year_title, &[("name", &view.name)]);
    let svg = paint(&format!("annual-{number}"), (WIDTH_PX, bottom), &title, |canvas| {
        panel.grid(canvas);
        panel.grid_upright(canvas);
        for years in &view.return_periods_years {
            period(canvas, &panel, *years, words);
        }
        draw_curve(canvas, &panel, (&view.without, size), (SKY, 0.35), WITHOUT);
        if let Some(with) = &view.with {
            draw_curve(canvas, &panel, (with, size), (ORANGE, 0.18), WITH);
        }
        panel.axes(canvas);
        key(canvas, &panel, view, words);
    });
    Drawing { svg, caption: caption(view, words) }
}

/// The right end of the axis (J): the largest energy that rocks can have, as far as those seen still have a width beside it.
fn largest_j(view: &AnnualView) -> f64 {
    let largest = |points: &mut dyn Iterator<Item = &BandPoint>| {
        points.map(|point| point.x).fold(0.0, f64::max)
    };
    let seen = largest(&mut view.curves().flatten().filter(|point| point.y.value > 0.0));
    largest(&mut view.curves().flatten()).min(UNSEEN * seen)
}

fn caption(view: &AnnualView, words: &Words) -> String {
    let what = if view.is_object { words.hits_of } else { words.passages_of };
    let what = fill(what, &[("name", &words.quoted(&view.name))]);
    let barriers = if view.with.is_some() { words.year_barriers } else { "" };
    fill(words.year_caption, &[("what", &what), ("barriers", &barriers)])
}

fn panel(words: &Words, view: &AnnualView, largest_j: f64, (unit, size): (&str, f64)) -> Panel {
    let positive = |value: &f64| *value > 0.0 && value.is_finite();
    let rates = || view.curves().flatten().map(|point| point.y.value).filter(positive);
    let periods = || view.return_periods_years.iter().map(|years| 1.0 / years);
    let least = rates().chain(periods()).fold(f64::INFINITY, f64::min);
    let most = rates().chain(periods()).fold(0.0, f64::max);
    let from_j = view.curves().flatten().map(|point| point.x).filter(positive);
    let from_j = from_j.fold(f64::INFINITY, f64::min).max(largest_j * math::pow(10.0, -DECADES));
    let frame = PaperFrame {
        left: 0.0,
        top: TOP_PX,
        right: WIDTH_PX - RIGHT_PX,
        bottom: TOP_PX + HEIGHT_PX,
    };
    let x = Axis::log(
        from_j / size,
        largest_j / size,
        fill(words.year_energy_axis, &[("unit", &unit)]),
    );
    let mut panel = Panel::new(frame, x, Axis::log(least, most, words.year_axis));
    panel.frame.left = panel.room_left();
    panel
}

/// A line across at the frequency of a return period.
fn period(canvas: &Canvas<'_>, panel: &Panel, years: f64, words: &Words) {
    let y = 1.0 / years;
    panel.line(canvas, &[(panel.x.low, y), (panel.x.high, y)], Pen::full(GREY, 0.9).dotted());
    let at = panel.at(panel.x.high, y);
    let words = fill(words.years, &[("n", &format::plain(years))]);
    canvas.text(&Label::new(words, (at.0 + 5.0, at.1)).coloured(GREY));
}

fn draw_curve(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (curve, size): (&[BandPoint], f64),
    (fill, opacity): (plotters::style::RGBColor, f64),
    pen: Pen,
) {
    let shown = within(curve, [panel.x.low, panel.x.high].map(|end| end * size));
    let band: Vec<(f64, f64, f64)> =
        shown.iter().map(|point| (point.x / size, point.y.low, point.y.high)).collect();
    panel.band(canvas, &band, fill, opacity);
    // where no rock came a logarithmic axis has no place: the line ends at the last rock
    let seen = shown.iter().filter(|point| point.y.value > 0.0);
    let line: Vec<(f64, f64)> = seen.map(|point| (point.x / size, point.y.value)).collect();
    panel.line(canvas, &line, pen);
}

/// The part of a curve of steps between two energies (J): what goes on beyond them ends there.
fn within(curve: &[BandPoint], [left_j, right_j]: [f64; 2]) -> Vec<BandPoint> {
    let from = curve.iter().rposition(|point| point.x <= left_j).unwrap_or(0);
    let to = curve.iter().position(|point| point.x >= right_j).map_or(curve.len(), |at| at + 1);
    let shown = curve.get(from..to).unwrap_or_default().iter();
    shown.map(|point| BandPoint { x: point.x.clamp(left_j, right_j), ..*point }).collect()
}

fn key(canvas: &Canvas<'_>, panel: &Panel, view: &AnnualView, words: &Words) {
    if view.with.is_none() {
        return;
    }
    let y = panel.frame.top - 10.0;
    let mut x = panel.frame.left;
    for (name, pen) in [(words.without_barriers, WITHOUT), (words.with_barriers, WITH)] {
        canvas.line(&[(x, y), (x + 22.0, y)], pen);
        canvas.text(&Label::new(name, (x + 27.0, y)).coloured(INK));
        x += 27.0 + text_width(name, SMALL) + 20.0;
    }
}

#[cfg(test)]
mod tests {
    use super::within;
    use crate::report::model::{BandPoint, Estimate};

    /// One rock is a line from the left end of the axis up to its energy, and not a point that nobody sees; what lies beyond
    /// an end is cut there.
    #[test]
    fn one_rock_has_a_curve() {
        let at = |x: f64| BandPoint { x, y: Estimate::new(0.5, 0.0, 0.5) };
        let [all, seen] = [[at(0.0), at(339.0)], [at(100.0), at(339.0)]];
        assert_eq!(within(&all, [100.0, 339.0]), seen);
        assert_eq!(within(&all, [100.0, 200.0]), [at(100.0), at(200.0)]);
        let steps = [at(0.0), at(50.0), at(50.0), at(339.0), at(339.0)];
        assert_eq!(within(&steps, [100.0, 339.0]), seen);
        assert!(within(&[], [100.0, 339.0]).is_empty());
    }
}

//! How often a year which energy is passed: the curve λ(E ≥ e) of a line or object, with its barriers and without them.

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{BLUE, GREY, INK, ORANGE, SKY};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{AnnualView, BandPoint, energy_unit};
use super::panel::{FOOT_PX, Panel};
use super::svg::path::Frame;
use crate::math;

const TOP_PX: f64 = 26.0;
const HEIGHT_PX: f64 = 300.0;
/// Room for the return periods right of the frame (px).
const RIGHT_PX: f64 = 84.0;
/// Energies far below the largest tell nothing of a design: so many decades are drawn.
const DECADES: f64 = 4.0;
const WITHOUT: Pen = Pen::full(BLUE, 1.7);
const WITH: Pen = Pen::full(ORANGE, 1.7).dashed();

/// Draws the curves of one place.
pub(super) fn draw(view: &AnnualView, number: usize) -> Drawing {
    let energies = view.curves().flatten().map(|point| point.x);
    let largest_j = energies.fold(0.0, f64::max);
    let (unit, size) = energy_unit(largest_j);
    let panel = panel(view, largest_j, (unit, size));
    let bottom = TOP_PX + HEIGHT_PX + FOOT_PX;
    let title = format!("Frequency a year at {}", view.name);
    let svg = paint(&format!("annual-{number}"), (WIDTH_PX, bottom), &title, |canvas| {
        panel.grid(canvas);
        panel.grid_upright(canvas);
        for years in &view.return_periods_years {
            period(canvas, &panel, *years);
        }
        draw_curve(canvas, &panel, (&view.without, size), (SKY, 0.35), WITHOUT);
        if let Some(with) = &view.with {
            draw_curve(canvas, &panel, (with, size), (ORANGE, 0.18), WITH);
        }
        panel.axes(canvas);
        key(canvas, &panel, view);
        if largest_j <= 0.0 {
            panel.nothing(canvas, "no rock comes here");
        }
    });
    Drawing { svg, caption: caption(view) }
}

fn caption(view: &AnnualView) -> String {
    let what = if view.is_object { "hits of" } else { "passages of" };
    let barriers = match view.with {
        Some(_) => " Full: as if there were no barrier; dashed: what no barrier stops before.",
        None => "",
    };
    format!(
        "A year, not conditional on release: frequency of {what} “{}” with at least the total energy e, λ(E ≥ e), with pointwise \
         95 % band. Grey: frequencies of the return periods.{barriers} Above the largest energy of any rock the curve is not known; \
         its band says how little.",
        view.name
    )
}

fn panel(view: &AnnualView, largest_j: f64, (unit, size): (&str, f64)) -> Panel {
    let positive = |value: &f64| *value > 0.0 && value.is_finite();
    let rates = || view.curves().flatten().map(|point| point.y.value).filter(positive);
    let periods = || view.return_periods_years.iter().map(|years| 1.0 / years);
    let least = rates().chain(periods()).fold(f64::INFINITY, f64::min);
    let most = rates().chain(periods()).fold(0.0, f64::max);
    let from_j = view.curves().flatten().map(|point| point.x).filter(positive);
    let from_j = from_j.fold(f64::INFINITY, f64::min).max(largest_j * math::pow(10.0, -DECADES));
    let frame =
        Frame { left: 0.0, top: TOP_PX, right: WIDTH_PX - RIGHT_PX, bottom: TOP_PX + HEIGHT_PX };
    let x = Axis::log(from_j / size, largest_j / size, format!("Total energy e ({unit})"));
    let mut panel = Panel::new(frame, x, Axis::log(least, most, "λ(E ≥ e) (1/year)"));
    panel.frame.left = panel.room_left();
    panel
}

/// A line across at the frequency of a return period.
fn period(canvas: &Canvas<'_>, panel: &Panel, years: f64) {
    let y = 1.0 / years;
    panel.line(canvas, &[(panel.x.low, y), (panel.x.high, y)], Pen::full(GREY, 0.9).dotted());
    let at = panel.at(panel.x.high, y);
    let words = format!("{} years", format::plain(years));
    canvas.text(&Label::new(words, (at.0 + 5.0, at.1)).coloured(GREY));
}

fn draw_curve(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (curve, size): (&[BandPoint], f64),
    (fill, opacity): (plotters::style::RGBColor, f64),
    pen: Pen,
) {
    let shown = || curve.iter().filter(|point| point.x > 0.0);
    let band: Vec<(f64, f64, f64)> =
        shown().map(|point| (point.x / size, point.y.low, point.y.high)).collect();
    panel.band(canvas, &band, fill, opacity);
    let line: Vec<(f64, f64)> = shown().map(|point| (point.x / size, point.y.value)).collect();
    panel.line(canvas, &line, pen);
}

fn key(canvas: &Canvas<'_>, panel: &Panel, view: &AnnualView) {
    if view.with.is_none() {
        return;
    }
    let y = panel.frame.top - 10.0;
    let mut x = panel.frame.left;
    for (words, pen) in [("without barriers", WITHOUT), ("with barriers", WITH)] {
        canvas.line(&[(x, y), (x + 22.0, y)], pen);
        canvas.text(&Label::new(words, (x + 27.0, y)).coloured(INK));
        x += 27.0 + text_width(words, SMALL) + 20.0;
    }
}

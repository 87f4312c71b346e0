//! The map of stiffness against step: accurate, stable, unstable.

use super::stability::{Map, Verdict};
use crate::math;
use crate::report::axis::Axis;
use crate::report::canvas::{Canvas, Label, NORMAL, Pen, SMALL, paint, text_width};
use crate::report::colour::{GREEN, GREY, INK, ORANGE, PURPLE, WHITE};
use crate::report::figure::WIDTH_PX;
use crate::report::format;
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::svg::path::PaperFrame;
use plotters::style::RGBColor;

const PLOT_PX: f64 = 170.0;
const TOP_PX: f64 = 58.0;
const GAP_PX: f64 = 70.0;
/// Left edge of the frames (px).
const LEFT_PX: f64 = 80.0;

fn colour(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Accurate => GREEN,
        Verdict::Stable => ORANGE,
        Verdict::Unstable => PURPLE,
    }
}

/// Draws one panel a scheme, the rebound in every cell.
pub(super) fn draw(maps: &[Map]) -> String {
    let bottom = TOP_PX + maps.len() as f64 * (PLOT_PX + GAP_PX) - GAP_PX + FOOT_PX;
    paint("stability", (WIDTH_PX, bottom + 4.0), "Stiffness against step", |canvas| {
        key(canvas);
        for (row, map) in maps.iter().enumerate() {
            let panel = panel(map, row);
            cells(canvas, &panel, map);
            canvas.text(
                &Label::new(map.scheme.name(), (panel.frame.left, panel.frame.top - 10.0))
                    .sized(NORMAL)
                    .bold(),
            );
            axes(canvas, &panel, map);
        }
    })
}

/// Axes in powers of ten, a cell round each.
fn panel(map: &Map, row: usize) -> Panel {
    let top = TOP_PX + row as f64 * (PLOT_PX + GAP_PX);
    let name = if map.scheme.controls_error() { "Tolerance (m/s)" } else { "Step (s)" };
    let around = |values: &[f64], title: &str| {
        let end = |value: f64| math::log10(value).round();
        Axis::linear(end(values[0]) - 0.5, end(values[values.len() - 1]) + 0.5, title)
    };
    let frame = PaperFrame { left: LEFT_PX, top, right: WIDTH_PX - 16.0, bottom: top + PLOT_PX };
    let x = around(&map.stiffness_n_m, "Normal stiffness (N/m)");
    Panel::new(frame, x, around(&map.fineness, name))
}

/// Labels in the middle of each column and row, titles beyond.
fn axes(canvas: &Canvas<'_>, panel: &Panel, map: &Map) {
    let PaperFrame { left, top, right, bottom } = panel.frame;
    let label = |value: f64| format::power_of_ten(math::log10(value).round() as i32);
    for &stiffness in &map.stiffness_n_m {
        let x = panel.at(math::log10(stiffness).round(), panel.y.low).0;
        canvas.text(&Label::new(label(stiffness), (x, bottom + 5.0)).below().centred());
    }
    for &fineness in &map.fineness {
        let y = panel.at(panel.x.low, math::log10(fineness).round()).1;
        canvas.text(&Label::new(label(fineness), (left - 6.0, y)).right());
    }
    let title = |words: &str, at: (f64, f64)| Label::new(words, at).centred().sized(NORMAL);
    canvas.text(&title(&panel.x.title, (0.5 * (left + right), bottom + 22.0)).below());
    canvas.text(&title(&panel.y.title, (left - 40.0, 0.5 * (top + bottom))).above().upwards());
    canvas.outline(&panel.frame, Pen::full(INK, 0.8));
}

fn cells(canvas: &Canvas<'_>, panel: &Panel, map: &Map) {
    for cell in &map.cells {
        let (x, y) = (math::log10(cell.stiffness_n_m).round(), math::log10(cell.fineness).round());
        let (left, bottom) = panel.at(x - 0.5, y - 0.5);
        let (right, top) = panel.at(x + 0.5, y + 0.5);
        let frame = PaperFrame { left, top, right, bottom };
        canvas.fill(&frame, colour(cell.verdict), 0.75);
        canvas.outline(&frame, Pen::full(WHITE, 0.8));
        let middle = panel.at(x, y);
        canvas.text(&Label::new(format!("{:.2}", cell.rebound), middle).centred().coloured(INK));
    }
}

fn key(canvas: &Canvas<'_>) {
    let mut x = LEFT_PX;
    for (verdict, words) in [
        (Verdict::Accurate, "accurate: within 2 %"),
        (Verdict::Stable, "stable: finite, no energy gained"),
        (Verdict::Unstable, "unstable"),
    ] {
        canvas.fill(
            &PaperFrame { left: x, top: 8.0, right: x + 14.0, bottom: 20.0 },
            colour(verdict),
            0.75,
        );
        canvas.text(&Label::new(words, (x + 19.0, 14.0)));
        x += 19.0 + text_width(words, SMALL) + 18.0;
    }
    let words = "Rebound over approach speed of a rock of 0.5 m at 5 m/s; exact 0.50, less on soft springs.";
    canvas.text(&Label::new(words, (LEFT_PX, 32.0)).coloured(GREY));
}

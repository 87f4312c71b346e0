//! Rocks per second over triangles, one line a scheme.

use super::SpeedStudy;
use super::slope::SCHEMES;
use rockfall::report::axis::Axis;
use rockfall::report::canvas::{Canvas, Label, NORMAL, Pen, SMALL, paint};
use rockfall::report::figure::WIDTH_PX;
use rockfall::report::format::significant;
use rockfall::report::panel::{FOOT_PX, Panel};
use rockfall::report::svg::path::PaperFrame;
use rockfall::study::exact_figure::{colour, shape};

const PLOT_PX: f64 = 300.0;
const TOP_PX: f64 = 26.0;
/// Room right of the frame for the names of the lines (px).
const KEY_PX: f64 = 150.0;
const TITLE: &str = "Rocks per second and core on a natural slope";

/// Draws the rates.
pub(crate) fn draw(study: &SpeedStudy) -> String {
    let rates = || study.rates.iter();
    let range = |of: fn(&super::Rate) -> f64| {
        rates().map(of).fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (few, many) = range(|rate| rate.triangles as f64);
    let (slow, fast) = range(super::Rate::per_second);
    let frame =
        PaperFrame { left: 0.0, top: TOP_PX, right: WIDTH_PX - KEY_PX, bottom: TOP_PX + PLOT_PX };
    // Whole decades: a size may be a little above its own.
    let x = Axis::log(few, many * 0.99, "Triangles");
    let mut panel = Panel::new(frame, x, Axis::log(slow, fast, "Rocks per second and core"));
    panel.frame.left = panel.room_left();
    paint("speed", (WIDTH_PX, panel.frame.bottom + FOOT_PX), TITLE, |canvas| {
        canvas.text(&Label::new(TITLE, (panel.frame.left, 12.0)).sized(NORMAL).bold());
        panel.grid(canvas);
        panel.grid_upright(canvas);
        for (scheme, _) in SCHEMES {
            let ink = colour(scheme);
            let values: Vec<(f64, f64)> = rates()
                .filter(|rate| rate.scheme == scheme)
                .map(|rate| (rate.triangles as f64, rate.per_second()))
                .collect();
            panel.line(canvas, &values, Pen::full(ink, 1.4));
            for &(x, y) in &values {
                canvas.mark(shape(scheme), panel.at(x, y), 2.6, ink);
            }
        }
        key(canvas, &panel, study);
        panel.axes(canvas);
    })
}

/// Names and rates beside the last points, the highest first, far enough from each other to be read.
fn key(canvas: &Canvas<'_>, panel: &Panel, study: &SpeedStudy) {
    let last = |scheme| study.rates.iter().rev().find(|rate| rate.scheme == scheme);
    let mut ends: Vec<&super::Rate> = SCHEMES.iter().filter_map(|way| last(way.0)).collect();
    ends.sort_by(|a, b| b.per_second().total_cmp(&a.per_second()));
    let mut least = f64::NEG_INFINITY;
    for rate in ends {
        let (_, height) = panel.at(rate.triangles as f64, rate.per_second());
        let at = (panel.frame.right + 10.0, height.max(least));
        let words = format!("{}  {}", rate.scheme.name(), significant(rate.per_second(), 2));
        canvas.text(&Label::new(words, at).bold().coloured(colour(rate.scheme)));
        least = at.1 + SMALL + 4.0;
    }
}

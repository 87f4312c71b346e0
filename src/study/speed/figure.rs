//! Rocks per second over triangles, one line a scheme.

use super::SpeedStudy;
use super::slope::SCHEMES;
use crate::report::axis::Axis;
use crate::report::colour::GREY;
use crate::report::figure::WIDTH_PX;
use crate::report::format::significant;
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::paper::{Label, NORMAL, Pen, SMALL, paint};
use crate::report::svg::path::Frame;
use crate::study::exact_figure::colour;

const PLOT_PX: f64 = 300.0;
const TOP_PX: f64 = 26.0;
/// Room right of the frame for the names of the lines (px).
const KEY_PX: f64 = 150.0;
const TITLE: &str = "Rocks per second and core on a natural slope";

/// Draws the rates.
pub(in crate::study) fn draw(study: &SpeedStudy) -> String {
    let rates = || study.rates.iter();
    let range = |of: fn(&super::Rate) -> f64| {
        rates().map(of).fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (few, many) = range(|rate| rate.triangles as f64);
    let (slow, fast) = range(super::Rate::per_second);
    let frame =
        Frame { left: 0.0, top: TOP_PX, right: WIDTH_PX - KEY_PX, bottom: TOP_PX + PLOT_PX };
    // Whole decades: sizes are a little beside theirs.
    let x = Axis::log(few * 0.9, many * 0.9, "Triangles");
    let mut panel = Panel::new(frame, x, Axis::log(slow, fast, "Rocks per second and core"));
    panel.frame.left = panel.room_left();
    paint("speed", (WIDTH_PX, panel.frame.bottom + FOOT_PX), TITLE, |paper| {
        paper.text(&Label::new(TITLE, (panel.frame.left, 12.0)).sized(NORMAL).bold());
        panel.grid(paper);
        panel.grid_upright(paper);
        for (scheme, _) in SCHEMES {
            let ink = colour(scheme);
            let values: Vec<(f64, f64)> = rates()
                .filter(|rate| rate.scheme == scheme)
                .map(|rate| (rate.triangles as f64, rate.per_second()))
                .collect();
            panel.line(paper, &values, Pen::full(ink, 1.4));
            for &(x, y) in &values {
                paper.disc(panel.at(x, y), 2.8, ink);
            }
            let Some(&(x, y)) = values.last() else { continue };
            let (_, height) = panel.at(x, y);
            let at = (panel.frame.right + 10.0, height);
            paper.text(&Label::new(scheme.name(), at).bold().coloured(ink));
            let words = format!("{} rocks/s", significant(y, 2));
            let below = (at.0, at.1 + SMALL + 2.0);
            paper.text(&Label::new(words, below).coloured(GREY));
        }
        panel.axes(paper);
    })
}

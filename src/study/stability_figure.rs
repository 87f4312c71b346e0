//! The map of stiffness against step: accurate, stable, unstable.

use super::bench::goes_by_tolerance;
use super::stability::{Map, Verdict};
use crate::report::axis::Axis;
use crate::report::colour::{GREEN, GREY, INK, ORANGE, VERMILLION, WHITE};
use crate::report::figure::WIDTH_PX;
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::paper::{Label, NORMAL, Paper, Pen, SMALL, paint, text_width};
use crate::report::svg::path::Frame;
use plotters::style::RGBColor;

const PLOT_PX: f64 = 170.0;
const TOP_PX: f64 = 58.0;
const GAP_PX: f64 = 70.0;
const ROOT_10: f64 = 3.162_277_660_168_379_5;

fn colour(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Accurate => GREEN,
        Verdict::Stable => ORANGE,
        Verdict::Unstable => VERMILLION,
    }
}

/// Draws one panel a scheme, the rebound in every cell.
pub(super) fn draw(maps: &[Map]) -> String {
    let bottom = TOP_PX + maps.len() as f64 * (PLOT_PX + GAP_PX) - GAP_PX + FOOT_PX;
    paint("stability", (WIDTH_PX, bottom + 4.0), "Stiffness against step", |paper| {
        key(paper);
        for (row, map) in maps.iter().enumerate() {
            let panel = panel(map, row);
            cells(paper, &panel, map);
            paper.text(
                &Label::new(map.scheme.name(), (panel.frame.left, panel.frame.top - 10.0))
                    .sized(NORMAL)
                    .bold(),
            );
            panel.axes(paper);
        }
    })
}

/// Axes in powers of ten, a cell round each.
fn panel(map: &Map, row: usize) -> Panel {
    let top = TOP_PX + row as f64 * (PLOT_PX + GAP_PX);
    let name = if goes_by_tolerance(map.scheme) { "Tolerance (m/s)" } else { "Step (s)" };
    let around = |values: &[f64], title: &str| Axis {
        low: values[0] / ROOT_10,
        high: values[values.len() - 1] * ROOT_10,
        is_log: true,
        title: title.to_owned(),
    };
    let frame = Frame { left: 80.0, top, right: WIDTH_PX - 16.0, bottom: top + PLOT_PX };
    Panel::new(
        frame,
        around(&map.stiffness_n_m, "Normal stiffness (N/m)"),
        around(&map.fineness, name),
    )
}

fn cells(paper: &Paper<'_>, panel: &Panel, map: &Map) {
    for cell in &map.cells {
        let (left, bottom) = panel.at(cell.stiffness_n_m / ROOT_10, cell.fineness / ROOT_10);
        let (right, top) = panel.at(cell.stiffness_n_m * ROOT_10, cell.fineness * ROOT_10);
        let frame = Frame { left, top, right, bottom };
        paper.fill(&frame, colour(cell.verdict), 0.75);
        paper.outline(&frame, Pen::full(WHITE, 0.8));
        let middle = (0.5 * (left + right), 0.5 * (top + bottom));
        paper.text(&Label::new(format!("{:.2}", cell.rebound), middle).centred().coloured(INK));
    }
}

fn key(paper: &Paper<'_>) {
    let mut x = 80.0;
    for (verdict, words) in [
        (Verdict::Accurate, "accurate: within 2 % of the approach speed"),
        (Verdict::Stable, "stable: finite, no energy gained"),
        (Verdict::Unstable, "unstable"),
    ] {
        paper.fill(
            &Frame { left: x, top: 8.0, right: x + 14.0, bottom: 20.0 },
            colour(verdict),
            0.75,
        );
        paper.text(&Label::new(words, (x + 19.0, 14.0)));
        x += 19.0 + text_width(words, SMALL) + 18.0;
    }
    let words = "Rebound over approach speed of a rock of 0.5 m at 5 m/s; exact 0.50 (less on the softest springs).";
    paper.text(&Label::new(words, (80.0, 32.0)).coloured(GREY));
}

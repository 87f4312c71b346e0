//! Speed and bounce height of all rocks by the distance from their release.

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{BLUE, GREY, INK, SKY};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{ProfileStretch, ProfileView, Report, ReportStretch};
use super::panel::{FOOT_PX, Panel, align};
use super::side_view::{more_above_px, name_marks, unnamed, without_room};
use super::svg::path::PaperFrame;
use super::words::{Words, fill};

/// Room above the first panel for the key and the names of lines and barriers (px).
const TOP_PX: f64 = 42.0;
const PLOT_PX: f64 = 140.0;
const GAP_PX: f64 = 16.0;
const MAXIMUM: Pen = Pen::full(SKY, 1.0);
const P95: Pen = Pen::full(BLUE, 1.8);
const MEDIAN: Pen = Pen::full(INK, 1.0).dashed();
/// Rocks below which there is no P95.
pub(super) const NEEDS: usize = 59;
/// Range of an axis at least: rocks that only roll are not drawn as if they leapt (m, m/s).
const LEAST: f64 = 0.1;

/// What a panel shows.
type ProfilePanel = fn(&ProfileStretch) -> &ReportStretch;

/// Draws height above speed over one x axis.
pub(super) fn draw(report: &Report, view: &ProfileView) -> Drawing {
    let words = report.words();
    let shown: [(ProfilePanel, &str); 2] =
        [(|at| &at.height_m, words.bounce_axis), (|at| &at.speed_m_s, words.speed_axis)];
    let panels = panels(view, shown, words);
    let size = (WIDTH_PX, panels[1].frame.bottom + FOOT_PX);
    let svg = paint("profile", size, words.profile_title, |canvas| {
        let has_p95 = view
            .stretches
            .iter()
            .any(|at| shown.iter().any(|(of, _)| of(at).p95.value.is_finite()));
        key(canvas, panels[0].frame.left, (words, has_p95));
        for (panel, (of, _)) in panels.iter().zip(shown) {
            draw_panel(canvas, panel, view, of);
        }
        name_marks(canvas, &panels, &view.marks);
        panels[0].axes_above_another(canvas);
        panels[1].axes(canvas);
    });
    let caption = fill(
        words.profile_caption,
        &[
            ("step", &format::plain(view.step_m)),
            ("rocks", &words.rocks(report.released())),
            ("n", &report.released()),
            ("needs", &NEEDS),
        ],
    );
    let marks = if view.marks.is_empty() { "" } else { words.drawn().profile_marks };
    let caption = caption + marks + &unnamed(&without_room(&panels[0], &view.marks), words);
    Drawing { svg, caption }
}

fn panels(view: &ProfileView, shown: [(ProfilePanel, &str); 2], words: &Words) -> [Panel; 2] {
    let end = view.stretches.last().map_or(1.0, |last| last.from_m + view.step_m);
    let mut row = -1.0;
    let mut panels = shown.map(|(of, title)| {
        row += 1.0;
        let top = TOP_PX + row * (PLOT_PX + GAP_PX);
        let frame = PaperFrame { left: 0.0, top, right: WIDTH_PX - 16.0, bottom: top + PLOT_PX };
        let largest = view.stretches.iter().map(|at| of(at).largest).chain([LEAST]);
        let x = Axis::linear(0.0, end, words.profile_axis);
        Panel::new(frame, x, Axis::from_zero(largest, title))
    });
    let [a, b] = &mut panels;
    align([a, b]);
    let more = more_above_px(&panels[0], &view.marks);
    for panel in &mut panels {
        panel.frame.top += more;
        panel.frame.bottom += more;
    }
    panels
}

fn draw_panel(canvas: &Canvas<'_>, panel: &Panel, view: &ProfileView, of: ProfilePanel) {
    panel.grid(canvas);
    let largest = steps(view, |at| of(at).largest);
    let area: Vec<_> = largest.iter().map(|&(x, y)| (x, 0.0, y)).collect();
    panel.band(canvas, &area, SKY, 0.25);
    panel.line(canvas, &largest, MAXIMUM);
    let ends = [steps(view, |at| of(at).p95.low), steps(view, |at| of(at).p95.high)];
    let band: Vec<(f64, f64, f64)> =
        ends[0].iter().zip(&ends[1]).map(|(low, high)| (low.0, low.1, high.1)).collect();
    let is_known = |at: &(f64, f64, f64)| at.1.is_finite() && at.2.is_finite();
    for known in band.split(|at| !is_known(at)).filter(|part| !part.is_empty()) {
        panel.band(canvas, known, BLUE, 0.3);
    }
    for (values, pen) in
        [(steps(view, |at| of(at).p95.value), P95), (steps(view, |at| of(at).median), MEDIAN)]
    {
        for run in values.split(|(_, y)| y.is_nan()).filter(|run| !run.is_empty()) {
            panel.line(canvas, run, pen);
        }
    }
}

/// A value as a line of steps.
fn steps(view: &ProfileView, of: impl Fn(&ProfileStretch) -> f64) -> Vec<(f64, f64)> {
    let ends = |at: &ProfileStretch| {
        let value = of(at);
        [(at.from_m, value), (at.from_m + view.step_m, value)]
    };
    view.stretches.iter().flat_map(ends).collect()
}

/// What the lines are, above all names.
fn key(canvas: &Canvas<'_>, mut left: f64, (words, has_p95): (&Words, bool)) {
    let y = TOP_PX - 30.0;
    let p95 = has_p95.then_some(("P95", P95));
    let first = std::iter::once((words.median, MEDIAN)).chain(p95);
    for (name, pen) in first.chain([(words.maximum, MAXIMUM)]) {
        canvas.line(&[(left, y), (left + 18.0, y)], pen);
        canvas.text(&Label::new(name, (left + 23.0, y)).coloured(GREY));
        left += 23.0 + text_width(name, SMALL) + 18.0;
    }
}

//! The fall seen from the side, with bounce height and speed along the way.

mod along;

use super::axis::Axis;
use super::colour::{BLUE, GREY, SKY};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::input::{Path, Report};
use super::panel::{FOOT_PX, Panel, align};
use super::paper::{Label, Paper, Pen, SMALL, paint, text_width};
use super::svg::path::{Frame, Spot};
use crate::math;
use along::{Envelope, FallLine};
use plotters::style::RGBColor;

const TOP_PX: f64 = 10.0;
/// Least and greatest height of the profile (px).
const PROFILE_PX: (f64, f64) = (130.0, 400.0);
/// Height of each of the two lower panels (px).
const LOWER_PX: f64 = 100.0;
const GAP_PX: f64 = 26.0;
const GROUND_FILL: RGBColor = RGBColor(205, 198, 188);
const GROUND_LINE: RGBColor = RGBColor(94, 78, 62);

/// Draws the profile and the two envelopes over one x axis.
pub(super) fn draw(report: &Report) -> Drawing {
    let line = FallLine::of(report);
    let view = View::of(report, &line);
    let height = view.speed.frame.bottom + FOOT_PX;
    let svg = paint("side", (WIDTH_PX, height), "Side view", |paper| {
        view.profile(paper, report, &line);
        let shown = [(&view.height, &view.heights), (&view.speed, &view.speeds)];
        for (panel, envelope) in shown {
            draw_envelope(paper, panel, envelope);
        }
        view.height.axes_above_another(paper);
        view.speed.axes(paper);
    });
    Drawing { svg, caption: caption(report, &line, &view) }
}

fn caption(report: &Report, line: &FallLine, view: &View) -> String {
    let scale = match view.exaggeration {
        e if (e - 1.0).abs() < 0.01 => "heights and distances at the same scale".to_owned(),
        e => format!("heights drawn {} times as large as distances", format::significant(e, 2)),
    };
    format!(
        "Side view of {} paths projected on the mean fall line, which runs {} from the mean release ({}); {scale}. The ground line is cut along \
         the fall line; the shaded strip spans the ground under the paths beside it. Lower panels: each path's largest value \
         within steps of {} m; P95 and maximum over paths.",
        report.paths.len(),
        line.compass(),
        line.bearing_words(),
        format::plain(view.heights.step_m),
    )
}

/// The three panels and what they show.
struct View {
    ground: Panel,
    height: Panel,
    speed: Panel,
    heights: Envelope,
    speeds: Envelope,
    exaggeration: f64,
}

impl View {
    fn of(report: &Report, line: &FallLine) -> Self {
        let (along, z) = line.extent(report);
        let heights = Envelope::of(report, line, along, |p| p.clearance_m);
        let speeds = Envelope::of(report, line, along, |p| p.speed_m_s);
        let title = "Distance along the mean fall line (m)";
        let x = Axis::linear(along.0, along.1, title);
        let mut ground = stacked(TOP_PX, PROFILE_PX.0, &x, Axis::linear(z.0, z.1, "Height (m)"));
        let titles = ["Bounce height (m)", "Speed (m/s)"];
        let axes = [&heights, &speeds].map(|e| Axis::from_zero(e.most.iter().copied(), ""));
        let [mut height, mut speed] = [0, 1].map(|i| {
            stacked(0.0, LOWER_PX, &x, Axis { title: titles[i].to_owned(), ..axes[i].clone() })
        });
        align([&mut ground, &mut height, &mut speed]);
        let exaggeration = fit_height(&mut ground);
        place_below(&ground, &mut height);
        place_below(&height, &mut speed);
        Self { ground, height, speed, heights, speeds, exaggeration }
    }

    fn profile(&self, paper: &Paper<'_>, report: &Report, line: &FallLine) {
        let panel = &self.ground;
        if let Some(ground) = &report.ground {
            let strip = line.strip(report, ground, (panel.x.low, panel.x.high));
            panel.band(paper, &strip, GROUND_FILL, 0.6);
        }
        let on_paper = |path: &Path| {
            let way = path.points.iter().map(|p| (line.along(p.place_m), p.place_m[2]));
            panel.on_paper(&way.collect::<Vec<_>>())
        };
        let paths: Vec<Vec<Spot>> = report.paths.iter().flat_map(on_paper).collect();
        // one line a path, so that many of them add up to a darker blue
        let opacity = (1.0 - 0.3 * math::log10(report.paths.len().max(1) as f64)).clamp(0.2, 0.9);
        for path in &paths {
            paper.line(path, Pen { opacity, ..Pen::full(BLUE, 0.7) });
        }
        if let Some(ground) = &report.ground {
            let cut = line.profile(ground, (panel.x.low, panel.x.high));
            panel.line(paper, &cut, Pen::full(GROUND_LINE, 1.5));
        }
        if report.paths.is_empty() {
            panel.nothing(paper, "no path kept");
        }
        panel.axes_above_another(paper);
    }
}

fn stacked(top: f64, height: f64, x: &Axis, y: Axis) -> Panel {
    let frame = Frame { left: 0.0, top, right: WIDTH_PX - 16.0, bottom: top + height };
    Panel::new(frame, x.clone(), y)
}

/// Gives the profile the height of equal scale, within limits; returns the exaggeration of heights.
fn fit_height(panel: &mut Panel) -> f64 {
    let px_per_m = panel.frame.width() / (panel.x.high - panel.x.low);
    let equal = px_per_m * (panel.y.high - panel.y.low);
    let height = equal.clamp(PROFILE_PX.0, PROFILE_PX.1);
    panel.frame.bottom = panel.frame.top + height;
    if equal < PROFILE_PX.0 {
        // a low profile keeps its scale and shows more sky instead
        panel.y.high = panel.y.low + height / px_per_m;
        return 1.0;
    }
    height / equal
}

fn place_below(above: &Panel, panel: &mut Panel) {
    let height = panel.frame.height();
    panel.frame.top = above.frame.bottom + GAP_PX;
    panel.frame.bottom = panel.frame.top + height;
}

/// The maximum as a light area of steps, P95 as a heavy line, named above the frame.
fn draw_envelope(paper: &Paper<'_>, panel: &Panel, envelope: &Envelope) {
    panel.grid(paper);
    let steps = |values: &[f64]| -> Vec<(f64, f64)> {
        let ends = |i: usize| [i, i + 1].map(|k| envelope.from_m + k as f64 * envelope.step_m);
        values.iter().enumerate().flat_map(|(i, &v)| ends(i).map(|x| (x, v))).collect()
    };
    for run in runs_of_numbers(&steps(&envelope.most)) {
        let area: Vec<_> = run.iter().map(|&(x, y)| (x, 0.0, y)).collect();
        panel.band(paper, &area, SKY, 0.35);
        panel.line(paper, &run, Pen::full(SKY, 1.0));
    }
    for run in runs_of_numbers(&steps(&envelope.p95)) {
        panel.line(paper, &run, Pen::full(BLUE, 1.6));
    }
    key(paper, panel);
    if envelope.most.iter().all(|v| v.is_nan()) {
        panel.nothing(paper, "no path kept");
    }
}

/// The parts of a line without gaps.
fn runs_of_numbers(line: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    line.split(|(_, y)| y.is_nan()).filter(|run| !run.is_empty()).map(<[_]>::to_vec).collect()
}

fn key(paper: &Paper<'_>, panel: &Panel) {
    let y = panel.frame.top - 9.0;
    let mut right = panel.frame.right;
    for (name, pen) in [("maximum", Pen::full(SKY, 1.6)), ("P95", Pen::full(BLUE, 1.8))] {
        paper.text(&Label::new(name, (right, y)).right().coloured(GREY));
        let end = right - text_width(name, SMALL) - 5.0;
        paper.line(&[(end - 16.0, y), (end, y)], pen);
        right = end - 30.0;
    }
}

//! The fall seen from the side, with bounce height and speed along the way.

mod along;

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, fitted, paint, text_width};
use super::colour::{BLUE, GREY, INK, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{Fall, MapMark, Path, Report};
use super::panel::{FOOT_PX, Panel, align};
use super::svg::path::{Frame, Spot};
use super::words::{Words, fill};
use crate::math;
use along::{Envelope, FallLine};
use plotters::style::RGBColor;

/// Room above the profile for the names of lines and barriers (px).
const TOP_PX: f64 = 24.0;
/// Least and greatest height of the profile (px).
const PROFILE_PX: (f64, f64) = (130.0, 480.0);
/// Height of each of the two lower panels (px).
const LOWER_PX: f64 = 100.0;
const GAP_PX: f64 = 28.0;
const RIGHT_PX: f64 = WIDTH_PX - 16.0;
const GROUND_FILL: RGBColor = RGBColor(205, 198, 188);
const GROUND_LINE: RGBColor = RGBColor(94, 78, 62);
/// Largest of all rocks, those without a stored path too.
const ALL: Pen = Pen::full(VERMILLION, 1.2).dashed();

/// Draws the profile and the two envelopes over one x axis.
pub(super) fn draw(report: &Report) -> Drawing {
    let line = FallLine::of(report);
    let view = View::of(report, &line);
    let height = view.speed.frame.bottom + FOOT_PX;
    let svg = paint("side", (WIDTH_PX, height), report.words().side_title, |canvas| {
        view.profile(canvas, report, &line);
        let shown = [
            (&view.height, &view.heights, largest(report, |fall| fall.max_height_m)),
            (&view.speed, &view.speeds, largest(report, |fall| fall.max_speed_m_s)),
        ];
        for (panel, envelope, largest) in shown {
            draw_envelope(canvas, panel, (envelope, largest), report.words());
        }
        view.height.axes_above_another(canvas);
        view.speed.axes(canvas);
        view.marks(canvas, report, &line);
    });
    Drawing { svg, caption: caption(report, &line, &view) }
}

/// Largest value of all releases; none of nothing.
fn largest(report: &Report, of: fn(&Fall) -> f64) -> Option<f64> {
    report.releases.iter().map(of).filter(|value| value.is_finite()).reduce(f64::max)
}

fn caption(report: &Report, line: &FallLine, view: &View) -> String {
    let words = report.words();
    let count = |n: usize| format::decimal(n as f64, 0);
    fill(
        words.side_caption,
        &[
            ("paths", &count(report.paths.len())),
            ("releases", &count(report.releases.len())),
            ("compass", &line.compass(words)),
            ("bearing", &line.bearing_words(words)),
            ("step", &format::plain(view.heights.step_m)),
        ],
    )
}

/// The three panels and what they show.
struct View {
    ground: Panel,
    height: Panel,
    speed: Panel,
    heights: Envelope,
    speeds: Envelope,
}

impl View {
    fn of(report: &Report, line: &FallLine) -> Self {
        let words = report.words();
        let (along, z) = line.extent(report);
        let heights = Envelope::of(report, line, along, |p| {
            if p.clearance_m < 0.0 { 0.0 } else { p.clearance_m }
        });
        let speeds = Envelope::of(report, line, along, |p| p.speed_m_s);
        let x = Axis::linear(along.0, along.1, words.along_fall_line);
        let mut ground =
            stacked(TOP_PX, PROFILE_PX.0, &x, Axis::linear(z.0, z.1, words.elevation_axis));
        let titles = [words.bounce_axis, words.speed_axis];
        let most =
            [largest(report, |fall| fall.max_height_m), largest(report, |fall| fall.max_speed_m_s)];
        let axis = |i: usize, envelope: &Envelope| {
            let all = most[i].map(|most| 1.04 * most);
            Axis::from_zero(envelope.most.iter().copied().chain(all), titles[i])
        };
        let (mut height, mut speed) = (
            stacked(0.0, LOWER_PX, &x, axis(0, &heights)),
            stacked(0.0, LOWER_PX, &x, axis(1, &speeds)),
        );
        align([&mut ground, &mut height, &mut speed]);
        to_scale(&mut ground);
        for panel in [&mut height, &mut speed] {
            panel.frame.right = ground.frame.right;
        }
        place_below(&ground, &mut height);
        place_below(&height, &mut speed);
        Self { ground, height, speed, heights, speeds }
    }

    fn profile(&self, canvas: &Canvas<'_>, report: &Report, line: &FallLine) {
        let panel = &self.ground;
        let below = report.ground.as_ref().map_or(Vec::new(), |ground| {
            line.ground_below(report, ground, (panel.x.low, panel.x.high))
        });
        let strip: Vec<(f64, f64, f64)> =
            below.iter().map(|&[s, low, _, high]| (s, low, high)).collect();
        panel.band(canvas, &strip, GROUND_FILL, 0.6);
        let on_paper = |path: &Path| {
            let way = path.points.iter().map(|p| (line.along(p.place_m), p.place_m[2]));
            panel.on_paper(&way.collect::<Vec<_>>())
        };
        let paths: Vec<Vec<Spot>> = report.paths.iter().flat_map(on_paper).collect();
        // one line a path, so that many of them add up to a darker blue
        let opacity = (1.0 - 0.3 * math::log10(report.paths.len().max(1) as f64)).clamp(0.2, 0.9);
        for path in &paths {
            canvas.line(path, Pen { opacity, ..Pen::full(BLUE, 0.7) });
        }
        let median: Vec<(f64, f64)> = below.iter().map(|&[s, _, z, _]| (s, z)).collect();
        panel.line(canvas, &median, Pen::full(GROUND_LINE, 1.5));
        if report.paths.is_empty() {
            panel.nothing(canvas, report.words().no_path);
        }
        panel.axes_above_another(canvas);
    }

    /// Where lines and barriers stand, through all panels, named above.
    fn marks(&self, canvas: &Canvas<'_>, report: &Report, line: &FallLine) {
        let place = |mark: &MapMark| Some((line.meets(&mark.corners_m)?, mark.clone()));
        let mut marks: Vec<(f64, MapMark)> = report.marks.iter().filter_map(place).collect();
        marks.sort_by(|a, b| a.0.total_cmp(&b.0));
        let inside = self.ground.x.low..=self.ground.x.high;
        for (at, mark) in marks.into_iter().filter(|(at, _)| inside.contains(at)) {
            let colour = if mark.barrier.is_some() { super::colour::DARK_GREEN } else { INK };
            let pen = Pen::full(colour, if mark.barrier.is_some() { 1.6 } else { 0.9 });
            let pen = if mark.barrier.is_some() { pen } else { pen.dotted() };
            for panel in [&self.ground, &self.height, &self.speed] {
                panel.upright(canvas, at, pen);
            }
            let x = self.ground.at(at, self.ground.y.low).0;
            name_above(canvas, &self.ground.frame, (x, &mark.name), colour);
        }
    }
}

/// The name of a mark above the frame, or in it where a neighbour's stands above already.
fn name_above(canvas: &Canvas<'_>, frame: &Frame, (x, name): (f64, &str), colour: RGBColor) {
    let words = fitted(name, SMALL, 0.4 * frame.width());
    let rows = [frame.top - 9.0, frame.top + 10.0, frame.top + 24.0, frame.top + 38.0];
    let candidates = rows.into_iter().flat_map(|y| {
        [
            Label::new(words.clone(), (x, y)).centred(),
            Label::new(words.clone(), (x - 4.0, y)).right(),
            Label::new(words.clone(), (x + 4.0, y)),
        ]
    });
    let free = |label: &Label| {
        let room = label.frame();
        room.left >= frame.left && room.right <= frame.right && canvas.is_free(&room)
    };
    if let Some(label) = candidates.into_iter().find(free) {
        canvas.text_on_rim(&label.coloured(colour));
    }
}

fn stacked(top: f64, height: f64, x: &Axis, y: Axis) -> Panel {
    let frame = Frame { left: 0.0, top, right: RIGHT_PX, bottom: top + height };
    Panel::new(frame, x.clone(), y)
}

/// Gives the profile one scale in both directions: what is too high for the page becomes narrower.
fn to_scale(panel: &mut Panel) {
    let (wide, high) = (panel.x.high - panel.x.low, panel.y.high - panel.y.low);
    let px_per_m = (panel.frame.width() / wide).min(PROFILE_PX.1 / high);
    panel.frame.right = panel.frame.left + px_per_m * wide;
    let height = (px_per_m * high).max(PROFILE_PX.0);
    panel.frame.bottom = panel.frame.top + height;
    // a low profile shows more sky instead
    panel.y.high = panel.y.low + height / px_per_m;
}

fn place_below(above: &Panel, panel: &mut Panel) {
    let height = panel.frame.height();
    panel.frame.top = above.frame.bottom + GAP_PX;
    panel.frame.bottom = panel.frame.top + height;
}

/// The maximum as a light area of steps, P95 as a heavy line, named above the frame.
fn draw_envelope(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (envelope, largest): (&Envelope, Option<f64>),
    words: &Words,
) {
    panel.grid(canvas);
    let steps = |values: &[f64]| -> Vec<(f64, f64)> {
        let ends = |i: usize| [i, i + 1].map(|k| envelope.from_m + k as f64 * envelope.step_m);
        values.iter().enumerate().flat_map(|(i, &v)| ends(i).map(|x| (x, v))).collect()
    };
    for run in runs_of_numbers(&steps(&envelope.most)) {
        let area: Vec<_> = run.iter().map(|&(x, y)| (x, 0.0, y)).collect();
        panel.band(canvas, &area, SKY, 0.35);
        panel.line(canvas, &run, Pen::full(SKY, 1.0));
    }
    for run in runs_of_numbers(&steps(&envelope.p95)) {
        panel.line(canvas, &run, Pen::full(BLUE, 1.6));
    }
    if let Some(largest) = largest {
        panel.line(canvas, &[(panel.x.low, largest), (panel.x.high, largest)], ALL);
    }
    key(canvas, panel, words);
    if envelope.most.iter().all(|v| v.is_nan()) {
        panel.nothing(canvas, words.no_path);
    }
}

/// The parts of a line without gaps.
fn runs_of_numbers(line: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    line.split(|(_, y)| y.is_nan()).filter(|run| !run.is_empty()).map(<[_]>::to_vec).collect()
}

fn key(canvas: &Canvas<'_>, panel: &Panel, words: &Words) {
    let y = panel.frame.top - 9.0;
    let mut right = panel.frame.right;
    for (name, pen) in [
        (words.largest_of_all, ALL),
        (words.maximum, Pen::full(SKY, 1.6)),
        ("P95", Pen::full(BLUE, 1.8)),
    ] {
        canvas.text(&Label::new(name, (right, y)).right().coloured(GREY));
        let end = right - text_width(name, SMALL) - 5.0;
        canvas.line(&[(end - 16.0, y), (end, y)], pen);
        right = end - 28.0;
    }
}

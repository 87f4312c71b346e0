//! The fall seen from the side.

mod along;

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, fitted, paint};
use super::colour::{BLUE, DARK_GREEN, INK};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{MapMark, Path, Report};
use super::panel::{FOOT_PX, Panel};
use super::svg::path::{PaperFrame, Spot};
use super::words::fill;
use crate::math;
use along::FallLine;
use plotters::style::RGBColor;

/// Room above the profile for the names of lines and barriers (px).
const TOP_PX: f64 = 24.0;
/// Least and greatest height of the profile (px).
const PROFILE_PX: (f64, f64) = (130.0, 350.0);
const RIGHT_PX: f64 = WIDTH_PX - 16.0;
const GROUND_FILL: RGBColor = RGBColor(205, 198, 188);
const GROUND_LINE: RGBColor = RGBColor(94, 78, 62);

/// Draws the profile.
pub(super) fn draw(report: &Report) -> Drawing {
    let line = FallLine::of(report);
    let view = View::of(report, &line);
    let height = view.ground.frame.bottom + FOOT_PX;
    // a steep profile is slender at one scale in both directions
    let width = view.ground.frame.right + (WIDTH_PX - RIGHT_PX);
    let svg = paint("side", (width, height), report.words().side_title, |canvas| {
        view.profile(canvas, report, &line);
        view.marks(canvas, report, &line);
    });
    Drawing { svg, caption: caption(report, &line) }
}

fn caption(report: &Report, line: &FallLine) -> String {
    let words = report.words();
    let count = |n: usize| format::decimal(n as f64, 0);
    fill(
        words.side_caption,
        &[
            ("paths", &count(report.paths.len())),
            ("releases", &count(report.released())),
            ("compass", &line.compass(words)),
            ("bearing", &line.bearing_words(words)),
        ],
    )
}

/// The panel and what it shows.
struct View {
    ground: Panel,
}

impl View {
    fn of(report: &Report, line: &FallLine) -> Self {
        let words = report.words();
        let (along, z) = line.extent(report);
        let x = Axis::linear(along.0, along.1, words.along_fall_line);
        let frame =
            PaperFrame { left: 0.0, top: TOP_PX, right: RIGHT_PX, bottom: TOP_PX + PROFILE_PX.0 };
        let mut ground = Panel::new(frame, x, Axis::linear(z.0, z.1, words.elevation_axis));
        ground.frame.left = ground.room_left();
        to_scale(&mut ground);
        Self { ground }
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
        panel.axes(canvas);
    }

    /// Where lines and barriers stand, named above.
    fn marks(&self, canvas: &Canvas<'_>, report: &Report, line: &FallLine) {
        let place = |mark: &MapMark| Some((line.meets(&mark.corners_m)?, mark.clone()));
        let mut marks: Vec<(f64, MapMark)> = report.marks.iter().filter_map(place).collect();
        marks.sort_by(|a, b| a.0.total_cmp(&b.0));
        let inside = self.ground.x.low..=self.ground.x.high;
        let shown = marks.into_iter().filter(|(at, _)| inside.contains(at));
        let shown: Vec<(f64, MapMark)> = shown.collect();
        name_marks(canvas, std::slice::from_ref(&self.ground), &shown);
    }
}

/// Where lines and barriers stand, through all panels, named above the first.
pub(super) fn name_marks(canvas: &Canvas<'_>, panels: &[Panel], marks: &[(f64, MapMark)]) {
    let Some(first) = panels.first() else { return };
    let look = |mark: &MapMark| match mark.barrier {
        Some(_) => (DARK_GREEN, Pen::full(DARK_GREEN, 1.6)),
        None => (INK, Pen::full(INK, 0.9).dotted()),
    };
    // all lines before the first name: none runs through a name
    for (at, mark) in marks {
        for panel in panels {
            panel.upright(canvas, *at, look(mark).1);
        }
    }
    let place = |at: f64| first.at(at, first.y.low).0;
    let lines: Vec<f64> = marks.iter().map(|(at, _)| place(*at)).collect();
    for (at, mark) in marks {
        name_above(canvas, (&first.frame, &lines), (place(*at), &mark.name), look(mark).0);
    }
}

/// The name of a mark above the frame, or in it where a neighbour's stands above already: between the `lines`, or across one
/// where there is no room between them.
fn name_above(
    canvas: &Canvas<'_>,
    (frame, lines): (&PaperFrame, &[f64]),
    (x, name): (f64, &str),
    colour: RGBColor,
) {
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
    let crossed = |label: &Label| {
        let room = label.frame();
        let through = |line: &f64| (room.left - 2.0..=room.right + 2.0).contains(line);
        room.bottom > frame.top && lines.iter().any(through)
    };
    let (across, between): (Vec<Label>, Vec<Label>) = candidates.filter(free).partition(crossed);
    if let Some(label) = between.into_iter().chain(across).next() {
        canvas.text_on_rim(&label.coloured(colour));
    }
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

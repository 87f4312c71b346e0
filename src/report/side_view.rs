//! The fall seen from the side.

mod along;
mod names;

use super::axis::Axis;
use super::canvas::{Canvas, NORMAL, Pen, paint, text_width};
use super::colour::BLUE;
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{MapMark, Path, Report};
use super::panel::{FOOT_PX, Panel, with_room};
use super::svg::path::{PaperFrame, Spot};
use super::words::{Words, fill};
use crate::math;
use along::FallLine;
pub(super) use names::{more_above_px, name_marks, without_room};
use plotters::style::RGBColor;
use std::collections::BTreeSet;

/// File of the figure.
pub(super) const FILE: &str = "side.svg";
/// Room above the profile for the names of lines and barriers (px).
const TOP_PX: f64 = 24.0;
/// Least and greatest height of the profile (px).
const PROFILE_PX: (f64, f64) = (130.0, 350.0);
const RIGHT_PX: f64 = WIDTH_PX - 16.0;
/// A path shorter than this (px) is no line that is seen.
const STILL_PX: f64 = 1.0;
/// Paths that lead this far from the fall line (degrees) are told: from there on a view shortens them by more than an eighth.
const ASIDE_DEG: f64 = 30.0;
const GROUND_FILL: RGBColor = RGBColor(205, 198, 188);
const GROUND_LINE: RGBColor = RGBColor(94, 78, 62);

/// Draws the profile.
pub(super) fn draw(report: &Report) -> Drawing {
    let line = FallLine::of(report);
    let view = View::of(report, &line);
    let height = view.ground.frame.bottom + FOOT_PX;
    // a steep profile is slender at one scale in both directions, its title is not
    let title = text_width(&view.ground.x.title, NORMAL) + 2.0;
    let width = (view.ground.frame.right + (WIDTH_PX - RIGHT_PX)).max(title);
    let svg = paint("side", (width, height), report.words().side_title, |canvas| {
        view.profile(canvas, report, &line);
        name_marks(canvas, std::slice::from_ref(&view.ground), &view.marks);
    });
    let unnamed = unnamed(&without_room(&view.ground, &view.marks), report.words());
    Drawing { svg, caption: caption(report, &line) + &unnamed }
}

/// Which lines stand in a profile without their names; nothing where all have theirs.
pub(super) fn unnamed(names: &[&str], words: &Words) -> String {
    let names: Vec<String> = names.iter().map(|name| words.quoted(name)).collect();
    let said = fill(words.along().unnamed, &[("names", &names.join(", "))]);
    if names.is_empty() { String::new() } else { said }
}

fn caption(report: &Report, line: &FallLine) -> String {
    let words = report.words();
    let count = |n: usize| format::decimal(n as f64, 0);
    let said = fill(
        words.side_caption,
        &[
            ("paths", &count(report.paths.len())),
            ("releases", &count(report.released())),
            ("compass", &line.compass(words)),
            ("bearing", &line.bearing_words(words)),
        ],
    );
    said + &directions(report, line)
}

/// What one view hides: paths that lead elsewhere, and which source each comes from.
fn directions(report: &Report, line: &FallLine) -> String {
    let words = report.words().drawn();
    let number = |text: &str, n: usize| match n {
        0 => String::new(),
        n => fill(text, &[("n", &format::decimal(n as f64, 0)), ("degrees", &ASIDE_DEG)]),
    };
    let aside = number(words.aside, line.leading_aside(&report.paths, ASIDE_DEG));
    let named = report.zones.iter().map(|zone| zone.name.as_str());
    let sources: BTreeSet<&str> = named.filter(|name| !name.is_empty()).collect();
    let sources = if sources.len() > 1 { sources.len() } else { 0 };
    aside + &number(words.sources, sources)
}

/// The panel and what it shows, with the lines and barriers in it by rising distance (m).
struct View {
    ground: Panel,
    marks: Vec<(f64, MapMark)>,
}

impl View {
    fn of(report: &Report, line: &FallLine) -> Self {
        let words = report.words();
        let (along, z) = line.extent(report);
        let x = Axis::linear(along.0, along.1, words.along_fall_line);
        let frame =
            PaperFrame { left: 0.0, top: TOP_PX, right: RIGHT_PX, bottom: TOP_PX + PROFILE_PX.0 };
        let whole = Panel::new(frame, x, Axis::linear(z.0, z.1, words.elevation_axis));
        let mut ground = with_room(|left| to_scale(&whole, left));
        let marks = marks_within(report, line, (ground.x.low, ground.x.high));
        let more = more_above_px(&ground, &marks);
        ground.frame.top += more;
        ground.frame.bottom += more;
        Self { ground, marks }
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
            if let Some(spot) = stays(path) {
                canvas.disc(spot, 1.5, BLUE);
            }
        }
        let median: Vec<(f64, f64)> = below.iter().map(|&[s, _, z, _]| (s, z)).collect();
        panel.line(canvas, &median, Pen::full(GROUND_LINE, 1.5));
        if report.paths.is_empty() {
            panel.nothing(canvas, report.words().no_path);
        }
        panel.axes(canvas);
    }
}

/// Where a path is that goes nowhere.
fn stays(path: &[Spot]) -> Option<Spot> {
    let &(x, y) = path.first()?;
    let is_near = |spot: &Spot| (spot.0 - x).abs() < STILL_PX && (spot.1 - y).abs() < STILL_PX;
    path.iter().all(is_near).then_some((x, y))
}

/// Lines and barriers that cross the fall line in a range (m), by rising distance along it.
fn marks_within(report: &Report, line: &FallLine, (from, to): (f64, f64)) -> Vec<(f64, MapMark)> {
    let place = |mark: &MapMark| Some((line.meets(&mark.corners_m)?, mark.clone()));
    let mut marks: Vec<(f64, MapMark)> = report.marks.iter().filter_map(place).collect();
    marks.retain(|(at, _)| (from..=to).contains(at));
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks
}

/// The profile with so much room on its left (px), at one scale in both directions: what is too high for the page
/// becomes narrower.
fn to_scale(whole: &Panel, left: f64) -> Panel {
    let mut panel = whole.clone();
    panel.frame.left = left;
    let (wide, high) = (panel.x.high - panel.x.low, panel.y.high - panel.y.low);
    let px_per_m = (panel.frame.width() / wide).min(PROFILE_PX.1 / high);
    panel.frame.right = panel.frame.left + px_per_m * wide;
    let height = (px_per_m * high).max(PROFILE_PX.0);
    panel.frame.bottom = panel.frame.top + height;
    // a low profile shows more sky instead
    panel.y.high = panel.y.low + height / px_per_m;
    panel
}

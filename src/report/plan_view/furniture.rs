//! What a map carries beside itself: north arrow, scale bar, colour bar and the key of its marks.

use super::{EndMark, RIGHT_PX};
use crate::math;
use crate::output::ReleaseZone;
use crate::report::axis::{Axis, nice_step};
use crate::report::canvas::{Canvas, Label, NORMAL, Pen, SMALL, text_width};
use crate::report::colour::{GREEN, INK, WHITE};
use crate::report::format;
use crate::report::model::{MapMark, Report};
use crate::report::panel::{FOOT_PX, Panel};
use crate::report::site::{self, MarkKind};
use crate::report::svg::path::PaperFrame;
use crate::report::words::{Words, fill};

const LINE_PX: f64 = 17.0;
const PEN: Pen = Pen::full(INK, 0.8);

/// North arrow, colour bar up to `fastest` (m/s) if there are paths, and scale bar.
pub(super) fn draw(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (fastest, has_paths): (f64, bool),
    words: &Words,
) {
    let left = panel.frame.right + 18.0;
    north_arrow(canvas, (left + 6.0, panel.frame.top), words.north);
    if has_paths {
        colour_bar(canvas, panel, (left, fastest), words.speed_axis);
    }
    scale_bar(canvas, panel);
}

fn north_arrow(canvas: &Canvas<'_>, (x, top): (f64, f64), north: &str) {
    canvas.text(&Label::new(north, (x, top)).below().centred().bold().sized(NORMAL));
    let (tip, foot) = (top + 13.0, top + 36.0);
    canvas.polygon(&[(x, tip), (x, foot - 5.0), (x - 6.0, foot)], INK, 1.0);
    canvas.line(&[(x, tip), (x + 6.0, foot), (x, foot - 5.0), (x, tip)], PEN);
}

fn colour_bar(canvas: &Canvas<'_>, panel: &Panel, (left, fastest): (f64, f64), title: &str) {
    let top = panel.frame.top + 58.0;
    let bottom = panel.frame.bottom.min(top + 260.0);
    let bar = PaperFrame { left, top, right: left + 12.0, bottom };
    canvas.colour_bar(&bar);
    let scale = Axis::linear(0.0, fastest, "");
    let count = (bar.height() / 30.0).clamp(2.0, 6.0) as usize;
    let mut widest: f64 = 0.0;
    for tick in scale.ticks(count) {
        let y = bottom - scale.share(tick.value) * bar.height();
        canvas.line(&[(bar.right, y), (bar.right + 4.0, y)], PEN);
        widest = widest.max(text_width(&tick.label, SMALL));
        canvas.text(&Label::new(tick.label, (bar.right + 7.0, y)));
    }
    let x = (bar.right + 7.0 + widest + 5.0).min(panel.frame.right + RIGHT_PX - NORMAL);
    let middle = (x, 0.5 * (top + bottom));
    canvas.text(&Label::new(title, middle).below().centred().upwards().sized(NORMAL));
}

/// A bar of round length near the lower right corner of the map.
fn scale_bar(canvas: &Canvas<'_>, panel: &Panel) {
    let per_metre = panel.frame.width() / (panel.x.high - panel.x.low);
    let longest = nice_step((panel.x.high - panel.x.low) * 0.13);
    let length = longest * per_metre;
    let label = format!("{}\u{2009}m", format::plain(longest));
    let needed = length + 6.0 + text_width(&label, SMALL);
    // beside the axis title where there is room, else beside the frame as far as the sheet goes
    let room = 0.5 * (panel.frame.width() - text_width(&panel.x.title, NORMAL)) - 16.0;
    let beside = if needed < room { 0.0 } else { (needed + 18.0).min(RIGHT_PX - 4.0) };
    let (right, y) = (panel.frame.right + beside, panel.frame.bottom + FOOT_PX - 8.0);
    let left = right - length;
    for (from, to, fill) in [(left, left + 0.5 * length, INK), (left + 0.5 * length, right, WHITE)]
    {
        let half = PaperFrame { left: from, top: y - 2.5, right: to, bottom: y + 2.5 };
        canvas.fill(&half, fill, 1.0);
        canvas.outline(&half, Pen::full(INK, 0.6));
    }
    canvas.text(&Label::new(label, (left - 6.0, y)).right());
}

/// From how many rocks on each shade of deposits stands.
fn classes(panel: &Panel, words: &Words) -> String {
    let from: Vec<String> = super::DEPOSITS.iter().map(|(from, _)| from.to_string()).collect();
    let side_m = super::DEPOSIT_PX * (panel.x.high - panel.x.low) / panel.frame.width();
    let side = format::significant(math::rounded(side_m, 2), 2);
    fill(words.drawn().per_square, &[("classes", &from.join(", ")), ("side", &side)])
}

/// The marks on the map and what they mean.
pub(super) struct MapLegend {
    entries: Vec<(Symbol, String)>,
}

enum Symbol {
    Mark(EndMark),
    Density,
    Zone(ReleaseZone),
    Place(MarkKind),
    Tree,
}

impl MapLegend {
    /// Names only what the map shows.
    pub(super) fn of(panel: &Panel, report: &Report) -> Self {
        let words = report.words();
        let mut entries = Vec::new();
        if let Some(zone) = report.zones.first().filter(|_| !report.releases.is_empty()) {
            let count = format::decimal(report.released() as f64, 0);
            entries.push((
                Symbol::Zone(zone.outline.clone()),
                fill(words.key_release, &[("n", &count)]),
            ));
        }
        let names = [
            (EndMark::AtRest, words.at_rest),
            (EndMark::LeftTerrain, words.left_terrain),
            (EndMark::TimeUp, words.time_up),
            (EndMark::Failed, words.failed),
        ];
        for (mark, name) in names {
            let count =
                report.releases.iter().filter(|f| EndMark::of(&f.stop) == Some(mark)).count();
            if count > 0 {
                let is_density = mark == EndMark::AtRest && count > super::MANY;
                let scale = if is_density { classes(panel, words) } else { String::new() };
                let text = format!("{name} ({}){scale}", format::decimal(count as f64, 0));
                entries.push((if is_density { Symbol::Density } else { Symbol::Mark(mark) }, text));
            }
        }
        for (kind, name) in [
            (MarkKind::Line, words.key_line),
            (MarkKind::Object, words.drawn().key_object),
            (MarkKind::Barrier, words.key_barrier),
        ] {
            let is_drawn =
                |mark: &&MapMark| MarkKind::of(mark) == kind && site::is_on_paper(panel, mark);
            if report.marks.iter().find(is_drawn).is_some() {
                entries.push((Symbol::Place(kind), name.to_owned()));
            }
        }
        if report.ground.as_ref().is_some_and(|g| g.trees.contains(&true)) {
            entries.push((Symbol::Tree, words.key_tree.to_owned()));
        }
        Self { entries }
    }

    /// Where each entry stands: (line, left edge).
    fn places(&self, width_px: f64) -> Vec<(usize, f64)> {
        let (mut line, mut x) = (0, 0.0);
        let mut places = Vec::new();
        for (_, text) in &self.entries {
            let width = 14.0 + text_width(text, SMALL) + 24.0;
            if x > 0.0 && x + width > width_px {
                (line, x) = (line + 1, 0.0);
            }
            places.push((line, x));
            x += width;
        }
        places
    }

    pub(super) fn height_px(&self, width_px: f64) -> f64 {
        self.places(width_px).last().map_or(0.0, |(line, _)| (line + 1) as f64 * LINE_PX)
    }

    pub(super) fn draw(&self, canvas: &Canvas<'_>, (left, top): (f64, f64)) {
        for ((symbol, text), (line, x)) in
            self.entries.iter().zip(self.places(canvas.size_px().0 - left))
        {
            let at = (left + x + 7.0, top + (line as f64 + 0.5) * LINE_PX);
            match symbol {
                Symbol::Density => super::density_symbol(canvas, at),
                Symbol::Mark(mark) => mark.draw(canvas, &[at], 3.0),
                Symbol::Zone(zone) => site::zone_symbol(canvas, at, zone),
                Symbol::Place(kind) => site::symbol(canvas, at, *kind),
                Symbol::Tree => canvas.disc(at, 3.0, GREEN),
            }
            canvas.text(&Label::new(text.clone(), (at.0 + 12.0, at.1)));
        }
    }
}

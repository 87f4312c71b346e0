//! What stands on the map beside the rocks: release zone, evaluation lines and barriers, with their names.

use super::canvas::{Canvas, Label, Pen, SMALL, fitted, text_width};
use super::colour::{GREEN, INK, WHITE};
use super::format;
use super::model::{MapMark, Report, ReportQuantity};
use super::panel::Panel;
use super::svg::path::{PaperFrame, Spot, clipped};
use crate::math;
use crate::output::ReleaseZone;

/// Pens of the marks; all lie on a white rim, to be seen over anything.
const LINE: Pen = Pen::full(INK, 1.5);
const BARRIER: Pen = Pen::full(GREEN, 2.6);
const ZONE: Pen = Pen::full(INK, 1.2).dashed();
/// Distance and length of the teeth of a barrier (px).
const TOOTH_PX: (f64, f64) = (9.0, 4.0);
/// More release points than this are told by their key alone.
const MOST_POINTS: usize = 200;
/// A shorter end of a line that looks into the frame has no name: it would be read as that of another one (px).
const LEAST_NAMED_PX: f64 = 16.0;
/// Gap between a line and its name (px).
const GAP_PX: f64 = 8.0;

/// Draws the zones of release.
pub(super) fn zones(canvas: &Canvas<'_>, panel: &Panel, report: &Report) {
    for one in std::iter::once(&report.zone).chain(&report.further_zones) {
        zone(canvas, panel, one);
    }
}

/// Spots along the outlines of the zones, closer to each other than a word is high: text is written beside them.
pub(super) fn outline(panel: &Panel, report: &Report) -> Vec<Spot> {
    let zones = std::iter::once(&report.zone).chain(&report.further_zones);
    let of_zone = |zone: &ReleaseZone| -> Vec<Spot> {
        let mut spots: Vec<Spot> = zone.corners_m().iter().map(|&[x, y]| panel.at(x, y)).collect();
        if matches!(zone, ReleaseZone::Points(_)) {
            return spots;
        }
        spots.extend(spots.first().copied());
        let between = |pair: &[Spot]| -> Vec<Spot> {
            let ((x, y), (to_x, to_y)) = (pair[0], pair[1]);
            let pieces = (math::hypot(to_x - x, to_y - y) / 4.0).ceil().clamp(1.0, 1000.0);
            let share = |k: u32| f64::from(k) / pieces;
            let at = |s: f64| (x + s * (to_x - x), y + s * (to_y - y));
            (0..=pieces as u32).map(|k| at(share(k))).collect()
        };
        spots.windows(2).flat_map(between).collect()
    };
    zones.flat_map(of_zone).collect()
}

fn zone(canvas: &Canvas<'_>, panel: &Panel, zone: &ReleaseZone) {
    let mut spots: Vec<Spot> = zone.corners_m().iter().map(|&[x, y]| panel.at(x, y)).collect();
    match zone {
        ReleaseZone::Points(_) if spots.len() <= MOST_POINTS => {
            for &spot in spots.iter().filter(|&&spot| panel.frame.holds(spot)) {
                canvas.disc(spot, 2.6, INK);
                canvas.disc(spot, 1.6, WHITE);
            }
        }
        ReleaseZone::Points(_) => canvas.dots(&spots, 0.9, INK),
        ReleaseZone::Polygon(_) | ReleaseZone::Line(_) => {
            if matches!(zone, ReleaseZone::Polygon(_)) {
                spots.extend(spots.first().copied());
            }
            for part in clipped(&spots, &panel.frame) {
                canvas.line(&part, Pen { opacity: 0.7, ..Pen::full(WHITE, 3.0) });
                canvas.line(&part, ZONE);
            }
        }
    }
}

/// Draws lines and barriers.
pub(super) fn marks(canvas: &Canvas<'_>, panel: &Panel, report: &Report) {
    for mark in &report.marks {
        for part in on_paper(panel, mark) {
            let pen = if mark.barrier.is_some() { BARRIER } else { LINE };
            canvas.line(&part, Pen { opacity: 0.8, ..Pen::full(WHITE, pen.width_px + 2.2) });
            canvas.line(&part, pen);
            if mark.barrier.is_some() {
                canvas.lines(&teeth(&part), Pen::full(GREEN, 1.2));
            }
        }
    }
}

/// The parts of a mark inside the frame.
fn on_paper(panel: &Panel, mark: &MapMark) -> Vec<Vec<Spot>> {
    let spots: Vec<Spot> = mark.corners_m.iter().map(|&[x, y]| panel.at(x, y)).collect();
    clipped(&spots, &panel.frame)
}

/// Short strokes across a line: a net is told from a line without colour.
fn teeth(part: &[Spot]) -> Vec<Vec<Spot>> {
    let (apart, long) = TOOTH_PX;
    let tooth = |pair: &[Spot]| -> Vec<Vec<Spot>> {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let length = math::hypot(x1 - x0, y1 - y0).max(1e-9);
        let (dx, dy) = ((x1 - x0) / length, (y1 - y0) / length);
        (0..(length / apart) as usize)
            .map(|k| apart * (k as f64 + 0.5))
            .map(|s| {
                let (x, y) = (x0 + s * dx, y0 + s * dy);
                vec![(x + long * dy, y - long * dx), (x - long * dy, y + long * dx)]
            })
            .collect()
    };
    part.windows(2).flat_map(tooth).collect()
}

/// Name of a mark, with height and capacity of a barrier, in a width (px): a name may be cut, a number may not.
pub(super) fn in_words(mark: &MapMark, width_px: f64) -> String {
    let Some(numbers) = mark.barrier.map(|(height_m, capacity_j)| size(height_m, capacity_j))
    else {
        return fitted(&mark.name, SMALL, width_px);
    };
    let numbers = format!(": {numbers}");
    fitted(&mark.name, SMALL, width_px - text_width(&numbers, SMALL)) + &numbers
}

/// Height and capacity of a barrier, as figures and tables say them.
pub(super) fn size(height_m: f64, capacity_j: f64) -> String {
    let (unit, size) = ReportQuantity::Total.unit(capacity_j);
    let capacity = format::significant(capacity_j / size, 3);
    format!("{}\u{2009}m, {capacity}\u{2009}{unit}", format::plain(height_m))
}

/// A name and, where it stands farther from its line, the stroke that leads there.
pub(super) struct PlacedName {
    label: Label,
    stroke: Option<[Spot; 2]>,
}

/// Finds room for the names of lines and barriers and keeps it free; they are drawn with [`names`] when all else is.
/// `said` gives the words of each that fit a width (px).
pub(super) fn places(
    canvas: &Canvas<'_>,
    panel: &Panel,
    report: &Report,
    said: impl Fn(&MapMark, f64) -> String,
) -> Vec<PlacedName> {
    let inner = PaperFrame {
        left: panel.frame.left + 3.0,
        right: panel.frame.right - 3.0,
        top: panel.frame.top + 3.0,
        bottom: panel.frame.bottom - 3.0,
    };
    let place = |mark: &MapMark| {
        let words = said(mark, 0.6 * panel.frame.width());
        let colour = if mark.barrier.is_some() { super::colour::DARK_GREEN } else { INK };
        let styled =
            |name: PlacedName| PlacedName { label: name.label.bold().coloured(colour), ..name };
        let is_free = |name: &PlacedName| {
            let room = name.label.frame();
            inner.contains(&room)
                && canvas.is_free(&room)
                && name.stroke.is_none_or(|stroke| canvas.is_free(&around(stroke)))
        };
        // a name on another's line would be read as that one's
        let others = |name: &PlacedName| {
            let of_others = report.marks.iter().filter(|other| other.name != mark.name);
            of_others.filter(|other| crosses(panel, other, &name.label.frame())).count()
        };
        let candidates = candidates(panel, mark, &words).into_iter().map(styled);
        let found = candidates.filter(is_free).min_by_key(others)?;
        canvas.take(found.label.frame());
        if let Some(stroke) = found.stroke {
            canvas.take(around(stroke));
        }
        Some(found)
    };
    report.marks.iter().filter_map(place).collect()
}

/// Room of an upright stroke.
fn around([from, to]: [Spot; 2]) -> PaperFrame {
    let (top, bottom) = (from.1.min(to.1), from.1.max(to.1));
    PaperFrame { left: from.0 - 0.5, right: from.0 + 0.5, top, bottom }
}

/// Places for the name of a mark, the nearest first.
fn candidates(panel: &Panel, mark: &MapMark, words: &str) -> Vec<PlacedName> {
    let parts = on_paper(panel, mark);
    let corners = || mark.corners_m.iter().map(|&[x, y]| panel.at(x, y));
    let is_whole = corners().all(|corner| panel.frame.holds(corner));
    let named = parts.iter().filter(|part| is_whole || length(part) > LEAST_NAMED_PX);
    let near = named.clone().flat_map(|part| beside(part, words));
    let near = near.map(|label| PlacedName { label, stroke: None });
    near.chain(named.flat_map(|part| farther(part, words))).collect()
}

/// Distances from a line at which a name with a stroke may stand (px).
const FARTHER_PX: [f64; 5] = [22.0, 36.0, 50.0, 64.0, 78.0];

/// Places for a name above and below both ends and the middle, each with an upright stroke to the line.
fn farther(part: &[Spot], words: &str) -> Vec<PlacedName> {
    let (Some(&first), Some(&last)) = (part.first(), part.last()) else { return Vec::new() };
    let middle = (0.5 * (first.0 + last.0), 0.5 * (first.1 + last.1));
    let middle = if part.len() > 2 { part[part.len() / 2] } else { middle };
    let steps = FARTHER_PX.into_iter().flat_map(|by| [-by, by]);
    let at = |by: f64| {
        [middle, first, last].into_iter().flat_map(move |(x, y)| {
            let label = || Label::new(words, (x, y + by));
            let stroke = Some([(x, y), (x, y + by - 7.0 * by.signum())]);
            [label().centred(), label(), label().right()].map(|label| PlacedName { label, stroke })
        })
    };
    steps.flat_map(at).collect()
}

fn length(part: &[Spot]) -> f64 {
    part.windows(2).map(|pair| math::hypot(pair[1].0 - pair[0].0, pair[1].1 - pair[0].1)).sum()
}

/// Whether a mark runs through a room.
fn crosses(panel: &Panel, mark: &MapMark, room: &PaperFrame) -> bool {
    on_paper(panel, mark).iter().any(|part| !clipped(part, room).is_empty())
}

/// Places for a name: above and below both ends and the middle, and beyond both ends.
fn beside(part: &[Spot], words: &str) -> Vec<Label> {
    let (Some(&first), Some(&last)) = (part.first(), part.last()) else { return Vec::new() };
    let (left, right) = if first.0 <= last.0 { (first, last) } else { (last, first) };
    let middle = part[part.len() / 2];
    let at = |(x, y): Spot, by: f64| Label::new(words, (x, y + by));
    let beyond = [at((right.0 + 6.0, right.1), 0.0), at((left.0 - 6.0, left.1), 0.0).right()];
    [-GAP_PX, GAP_PX]
        .into_iter()
        .flat_map(|by| {
            [
                at((right.0 - 4.0, right.1), by).right(),
                at((left.0 + 4.0, left.1), by),
                at(middle, by).centred(),
                at((middle.0 + 6.0, middle.1), by),
                at((middle.0 - 6.0, middle.1), by).right(),
            ]
        })
        .chain(beyond)
        .collect()
}

/// Writes the names.
pub(super) fn names(canvas: &Canvas<'_>, names: &[PlacedName]) {
    for stroke in names.iter().filter_map(|name| name.stroke) {
        canvas.line(&stroke, Pen { opacity: 0.8, ..Pen::full(WHITE, 2.8) });
        canvas.line(&stroke, Pen::full(INK, 0.8));
        canvas.disc(stroke[0], 1.8, INK);
    }
    for name in names {
        canvas.text_on_rim(&name.label);
    }
}

/// A short piece of each kind of mark, for a key.
pub(super) fn symbol(canvas: &Canvas<'_>, at: Spot, is_barrier: bool) {
    let part = [(at.0 - 7.0, at.1), (at.0 + 7.0, at.1)];
    canvas.line(&part, if is_barrier { BARRIER } else { LINE });
    if is_barrier {
        let tooth = |x: f64| vec![(x, at.1 - TOOTH_PX.1), (x, at.1 + TOOTH_PX.1)];
        canvas.lines(&[tooth(at.0 - 3.5), tooth(at.0 + 3.5)], Pen::full(GREEN, 1.2));
    }
}

/// A short piece of the zone's outline, for a key.
pub(super) fn zone_symbol(canvas: &Canvas<'_>, at: Spot, zone: &ReleaseZone) {
    match zone {
        ReleaseZone::Points(_) => {
            canvas.disc(at, 2.6, INK);
            canvas.disc(at, 1.6, WHITE);
        }
        _ => canvas.line(&[(at.0 - 7.0, at.1), (at.0 + 7.0, at.1)], ZONE),
    }
}

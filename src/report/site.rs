//! What stands on the map beside the rocks: release zone, evaluation lines and barriers, with their names.

use super::canvas::{Canvas, Label, Pen, SMALL, fitted};
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

/// Name of a mark, with height and capacity of a barrier.
pub(super) fn in_words(mark: &MapMark) -> String {
    let Some((height_m, capacity_j)) = mark.barrier else { return mark.name.clone() };
    let (unit, size) = ReportQuantity::Total.unit(capacity_j);
    format!(
        "{}: {}\u{2009}m, {}\u{2009}{unit}",
        mark.name,
        format::significant(height_m, 2),
        format::significant(capacity_j / size, 3)
    )
}

/// Finds room for the names of lines and barriers beside them and keeps it free; they are drawn with [`names`] when all
/// else is. `said` gives the words of each.
pub(super) fn places(
    canvas: &Canvas<'_>,
    panel: &Panel,
    report: &Report,
    said: impl Fn(&MapMark) -> String,
) -> Vec<Label> {
    let inner = PaperFrame {
        left: panel.frame.left + 3.0,
        right: panel.frame.right - 3.0,
        top: panel.frame.top + 3.0,
        bottom: panel.frame.bottom - 3.0,
    };
    let place = |mark: &MapMark| {
        let words = fitted(&said(mark), SMALL, 0.6 * panel.frame.width());
        let colour = if mark.barrier.is_some() { super::colour::DARK_GREEN } else { INK };
        let parts = on_paper(panel, mark);
        let named = parts.iter().filter(|part| length(part) > LEAST_NAMED_PX);
        let candidates = named.flat_map(|part| beside(part, &words));
        let free = candidates.map(|label| label.bold().coloured(colour)).filter(|label| {
            let frame = label.frame();
            inner.contains(&frame) && canvas.is_free(&frame)
        });
        // a name on another's line would be read as that one's
        let others = |label: &Label| {
            let of_others = report.marks.iter().filter(|other| other.name != mark.name);
            of_others.filter(|other| crosses(panel, other, &label.frame())).count()
        };
        let found = free.min_by_key(others)?;
        canvas.take(found.frame());
        Some(found)
    };
    report.marks.iter().filter_map(place).collect()
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
pub(super) fn names(canvas: &Canvas<'_>, labels: &[Label]) {
    for label in labels {
        canvas.text_on_rim(label);
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

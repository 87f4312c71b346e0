//! What stands on the map beside the rocks: release zone, evaluation lines and barriers.

pub(super) mod names;

use super::canvas::{Canvas, Label, Pen, SMALL, fitted_among, text_width};
use super::colour::{GREEN, GREY, INK, WHITE};
use super::format;
use super::model::{MapMark, Report, ReportQuantity};
use super::panel::Panel;
use super::svg::path::{PaperFrame, Spot, clipped};
use super::words::{Words, fill};
use crate::math;
use crate::output::ReleaseZone;

/// Pens of the marks; all lie on a white rim, to be seen over anything.
const LINE: Pen = Pen::full(INK, 1.5);
const BARRIER: Pen = Pen::full(GREEN, 2.6);
/// An object has two sides, with this between: it is told from a line without colour.
const OBJECT: [Pen; 2] = [Pen::full(INK, 3.6), Pen::full(WHITE, 1.4)];
const ZONE: Pen = Pen::full(INK, 1.2).dashed();
/// Distance and length of the teeth of a barrier (px).
const TOOTH_PX: (f64, f64) = (9.0, 4.0);
/// More release points than this are told by their key alone.
const MOST_POINTS: usize = 200;

/// What a mark stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MarkKind {
    Line,
    Object,
    Barrier,
}

impl MarkKind {
    pub(super) fn of(mark: &MapMark) -> Self {
        match (&mark.barrier, mark.is_object) {
            (Some(_), _) => Self::Barrier,
            (None, true) => Self::Object,
            (None, false) => Self::Line,
        }
    }

    /// Its pens, one upon the other.
    fn pens(self) -> &'static [Pen] {
        match self {
            Self::Line => &[LINE],
            Self::Object => &OBJECT,
            Self::Barrier => &[BARRIER],
        }
    }
}

/// Draws the zones of release.
pub(super) fn zones(canvas: &Canvas<'_>, panel: &Panel, report: &Report) {
    for one in &report.zones {
        zone(canvas, panel, &one.outline);
    }
}

/// Spots along the outlines of the zones, closer to each other than a word is high: text is written beside them.
pub(super) fn outline(panel: &Panel, report: &Report) -> Vec<Spot> {
    let of_zone = |zone: &ReleaseZone| -> Vec<Spot> {
        let spots = zone_spots(panel, zone);
        if matches!(zone, ReleaseZone::Points(_)) {
            return spots;
        }
        let closed = spots.iter().chain(spots.first()).copied().collect::<Vec<Spot>>();
        let between = |pair: &[Spot]| -> Vec<Spot> {
            let ((x, y), (to_x, to_y)) = (pair[0], pair[1]);
            let pieces = (math::hypot(to_x - x, to_y - y) / 4.0).ceil().clamp(1.0, 1000.0);
            let share = |k: u32| f64::from(k) / pieces;
            let at = |s: f64| (x + s * (to_x - x), y + s * (to_y - y));
            (0..=pieces as u32).map(|k| at(share(k))).collect()
        };
        closed.windows(2).flat_map(between).collect()
    };
    report.zones.iter().flat_map(|zone| of_zone(&zone.outline)).collect()
}

/// Corners or points of a zone on paper.
fn zone_spots(panel: &Panel, zone: &ReleaseZone) -> Vec<Spot> {
    zone.corners_m().iter().map(|&[x, y]| panel.at(x, y)).collect()
}

/// What of a zone lies inside the frame: pieces of its outline, or its points.
fn zone_parts(panel: &Panel, zone: &ReleaseZone) -> Vec<Vec<Spot>> {
    let mut spots = zone_spots(panel, zone);
    match zone {
        ReleaseZone::Points(_) => {
            spots.retain(|&spot| panel.frame.holds(spot));
            return vec![spots];
        }
        ReleaseZone::Polygon(_) => spots.extend(spots.first().copied()),
        ReleaseZone::Line(_) => {}
    }
    clipped(&spots, &panel.frame)
}

fn zone(canvas: &Canvas<'_>, panel: &Panel, zone: &ReleaseZone) {
    for part in zone_parts(panel, zone) {
        match zone {
            ReleaseZone::Points(_) if part.len() <= MOST_POINTS => {
                for &spot in &part {
                    canvas.disc(spot, 2.6, INK);
                    canvas.disc(spot, 1.6, WHITE);
                }
            }
            ReleaseZone::Points(_) => canvas.dots(&part, 0.9, INK),
            ReleaseZone::Polygon(_) | ReleaseZone::Line(_) => {
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
            let pens = MarkKind::of(mark).pens();
            canvas.line(&part, Pen { opacity: 0.8, ..Pen::full(WHITE, pens[0].width_px + 2.2) });
            for pen in pens {
                canvas.line(&part, *pen);
            }
            if mark.barrier.is_some() {
                canvas.lines(&teeth(&part), Pen::full(GREEN, 1.2));
            }
        }
    }
}

/// Grey words in a frame that has nothing to show, where no name stands and neither line nor barrier runs, as near the middle as can be.
pub(super) fn beside_marks(canvas: &Canvas<'_>, panel: &Panel, report: &Report, words: &str) {
    let lines: Vec<Vec<Spot>> =
        report.marks.iter().flat_map(|mark| on_paper(panel, mark)).collect();
    let label = |at: Spot| Label::new(words, at).centred().coloured(GREY);
    let is_free = |at: &Spot| {
        let room = label(*at).frame();
        panel.frame.contains(&room) && canvas.is_free(&room) && is_clear(&room, &lines)
    };
    let places = places(&panel.frame);
    let at = places.iter().copied().find(is_free).unwrap_or(places[0]);
    canvas.text_on_rim(&label(at));
}

/// Shares of a frame's size from its middle, by which words are moved out of the way.
const ASIDE: [f64; 7] = [0.0, 0.15, -0.15, 0.25, -0.25, 0.35, -0.35];

/// Places in a frame, first its middle, then across it and up and down.
fn places(frame: &PaperFrame) -> Vec<Spot> {
    let middle = (0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
    let at =
        |up: f64, across: f64| (middle.0 + across * frame.width(), middle.1 + up * frame.height());
    ASIDE.iter().flat_map(|&up| ASIDE.map(|across| at(up, across))).collect()
}

/// Whether none of some lines runs through a room or close by.
fn is_clear(room: &PaperFrame, lines: &[Vec<Spot>]) -> bool {
    let near = room.grown(TOOTH_PX.1 + 2.0);
    lines.iter().all(|line| clipped(line, &near).is_empty())
}

/// Whether some of a mark lies inside the frame.
pub(super) fn is_on_paper(panel: &Panel, mark: &MapMark) -> bool {
    !on_paper(panel, mark).is_empty()
}

/// Which lines, objects and barriers lie beside the frame; nothing where none does.
pub(super) fn outside(panel: &Panel, report: &Report) -> String {
    let words = report.words();
    let beside = report.marks.iter().filter(|mark| !is_on_paper(panel, mark));
    let names: Vec<String> = beside.map(|mark| words.quoted(&mark.name)).collect();
    if names.is_empty() {
        return String::new();
    }
    fill(words.drawn().outside, &[("names", &names.join(", "))])
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

/// Name of a mark, with height and capacity of a barrier, in a width (px): a name may be cut, but so that it is told from those of `all`
/// marks; a number may not.
pub(super) fn in_words(mark: &MapMark, all: &[MapMark], width_px: f64, words: &Words) -> String {
    let names = all.iter().map(|mark| mark.name.as_str());
    let Some(numbers) = mark.barrier.map(|(height_m, capacity_j)| size(height_m, capacity_j))
    else {
        return fitted_among(&mark.name, names, (SMALL, width_px));
    };
    let numbers = format!("{}{numbers}", words.colon());
    let room = width_px - text_width(&numbers, SMALL);
    fitted_among(&mark.name, names, (SMALL, room)) + &numbers
}

/// Height and capacity of a barrier, as figures and tables say them.
pub(super) fn size(height_m: f64, capacity_j: f64) -> String {
    let (unit, size) = ReportQuantity::Total.unit(capacity_j);
    let capacity = format::significant(capacity_j / size, 3);
    format!("{}\u{2009}m, {capacity}\u{2009}{unit}", format::plain(height_m))
}

/// A short piece of each kind of mark, for a key.
pub(super) fn symbol(canvas: &Canvas<'_>, at: Spot, kind: MarkKind) {
    let part = [(at.0 - 7.0, at.1), (at.0 + 7.0, at.1)];
    kind.pens().iter().for_each(|pen| canvas.line(&part, *pen));
    if kind == MarkKind::Barrier {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Words of 40 px find a place beside a line through the middle of a frame, and not on it.
    #[test]
    fn words_keep_off_a_line_through_the_middle() {
        let frame = PaperFrame { left: 100.0, top: 20.0, right: 340.0, bottom: 170.0 };
        let line = vec![vec![(220.0, 20.0), (220.0, 170.0)]];
        let room = |(x, y): Spot| PaperFrame {
            left: x - 20.0,
            top: y - 6.0,
            right: x + 20.0,
            bottom: y + 6.0,
        };
        let found: Vec<Spot> =
            places(&frame).into_iter().filter(|at| is_clear(&room(*at), &line)).collect();
        assert_eq!(found.first(), Some(&(256.0, 95.0)));
        assert!(!is_clear(&room((225.0, 95.0)), &line) && is_clear(&room((225.0, 95.0)), &[]));
    }
}

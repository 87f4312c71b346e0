//! Names of lines and barriers on a map: beside their lines where that is clear, as numbers with a key where it is not.

use super::on_paper;
use crate::math;
use crate::report::canvas::{Canvas, Label, Pen, SMALL, bold_width, fitted, text_width};
use crate::report::colour::{DARK_GREEN, INK, WHITE};
use crate::report::model::{MapMark, Report};
use crate::report::panel::Panel;
use crate::report::svg::path::{PaperFrame, Spot, clipped};

/// A shorter end of a line that looks into the frame has no name: it would be read as that of another one (px).
const LEAST_NAMED_PX: f64 = 16.0;
/// Gap between a line and its name (px).
const GAP_PX: f64 = 8.0;
/// Free room around a name (px).
const APART_PX: f64 = 2.0;
/// The same before and behind: two numbers side by side are not one.
const ASIDE_PX: f64 = 7.0;
/// A name is read as that of another line that runs within this of it (px): beside its own line, and farther from it.
const READ_PX: [f64; 2] = [1.5, 7.0];
/// Height of a line of the key, and gap between its entries (px).
const KEY_PX: (f64, f64) = (15.0, 18.0);
/// Gap between a number and its name in the key (px).
const NUMBER_GAP_PX: f64 = 4.0;

/// What is written at each mark: the words that fit a width (px).
type NameOf<'a> = &'a dyn Fn(&MapMark, f64) -> String;

/// Room that names were found for.
pub(in crate::report) struct Names {
    placed: Vec<PlacedName>,
    /// Whether each is read as that of its own line, and none lacks.
    is_clear: bool,
}

/// A name and, where it stands farther from its line, the stroke that leads there.
struct PlacedName {
    label: Label,
    stroke: Option<[Spot; 2]>,
}

/// What is wrong with a place, the worst first: lines of others through the name, beside it, and through its stroke.
type Faults = [usize; 3];

impl Names {
    /// Finds room for what is `said` of each mark; numbers where words would be read as those of other lines or have no room.
    pub(in crate::report) fn of(panel: &Panel, report: &Report, said: NameOf<'_>) -> Self {
        let words = Self::placed(panel, report, said);
        if words.is_clear { words } else { Self::numbers(panel, report) }
    }

    /// Numbers of the marks from 1 on, for a [`Key`].
    pub(in crate::report) fn numbers(panel: &Panel, report: &Report) -> Self {
        let number = |mark: &MapMark, _: f64| {
            let at = report.marks.iter().position(|other| std::ptr::eq(other, mark));
            (at.unwrap_or(0) + 1).to_string()
        };
        Self { is_clear: false, ..Self::placed(panel, report, &number) }
    }

    /// Whether they are names and need no key.
    pub(in crate::report) fn is_clear(&self) -> bool {
        self.is_clear
    }

    fn placed(panel: &Panel, report: &Report, said: NameOf<'_>) -> Self {
        let mut found = Self { placed: Vec::new(), is_clear: true };
        let mut taken = Vec::new();
        for mark in &report.marks {
            let words = said(mark, 0.6 * panel.frame.width());
            let candidates = candidates(panel, mark, &words);
            if candidates.is_empty() {
                continue;
            }
            let free = candidates.into_iter().filter(|name| name.is_free(panel, &taken));
            let faults = |name: &PlacedName| name.faults(panel, report, mark);
            let Some(name) = free.min_by_key(faults) else {
                found.is_clear = false;
                continue;
            };
            found.is_clear &= faults(&name)[..2] == [0, 0];
            taken.extend(name.rooms());
            found.placed.push(name);
        }
        found
    }

    /// Keeps their room free of other words.
    pub(in crate::report) fn keep(&self, canvas: &Canvas<'_>) {
        self.placed.iter().flat_map(PlacedName::rooms).for_each(|room| canvas.take(room));
    }

    /// Writes them, when all else is drawn.
    pub(in crate::report) fn write(&self, canvas: &Canvas<'_>) {
        for stroke in self.placed.iter().filter_map(|name| name.stroke) {
            canvas.line(&stroke, Pen { opacity: 0.8, ..Pen::full(WHITE, 2.8) });
            canvas.line(&stroke, Pen::full(INK, 0.8));
            canvas.disc(stroke[0], 1.8, INK);
        }
        for name in &self.placed {
            canvas.text_on_rim(&name.label);
        }
    }
}

impl PlacedName {
    /// Room of the words and of the stroke.
    fn rooms(&self) -> impl Iterator<Item = PaperFrame> + use<> {
        [Some(self.label.frame()), self.stroke.map(around)].into_iter().flatten()
    }

    fn is_free(&self, panel: &Panel, taken: &[PaperFrame]) -> bool {
        let is_free = |room: PaperFrame| {
            let PaperFrame { left, right, top, bottom } = room.grown(APART_PX);
            let aside = ASIDE_PX - APART_PX;
            let around = PaperFrame { left: left - aside, right: right + aside, top, bottom };
            !taken.iter().any(|t| t.meets(&around))
        };
        panel.frame.grown(-3.0).contains(&self.label.frame()) && self.rooms().all(is_free)
    }

    fn faults(&self, panel: &Panel, report: &Report, mark: &MapMark) -> Faults {
        let room = self.label.frame();
        let others = || report.marks.iter().filter(|other| other.name != mark.name);
        let through =
            |room: &PaperFrame| others().filter(|other| crosses(panel, other, room)).count();
        let Some(stroke) = self.stroke else {
            return [through(&room), through(&room.grown(READ_PX[0])), 0];
        };
        [through(&room), through(&room.grown(READ_PX[1])), through(&around(stroke))]
    }
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
    let colour = if mark.barrier.is_some() { DARK_GREEN } else { INK };
    let styled =
        |name: PlacedName| PlacedName { label: name.label.bold().coloured(colour), ..name };
    near.chain(named.flat_map(|part| farther(part, words))).map(styled).collect()
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

/// What the numbers on a map stand for, in lines below it.
#[derive(Debug, Default)]
pub(in crate::report) struct Key {
    /// Number and name, left edge (px) and line of each.
    entries: Vec<(String, String, f64, usize)>,
}

impl Key {
    /// The names of all marks in lines of a width (px); nothing where the map has names itself.
    pub(in crate::report) fn of(report: &Report, said: NameOf<'_>, width_px: f64) -> Self {
        let (mut x, mut line) = (0.0, 0);
        let mut entries = Vec::new();
        for (mark, number) in report.marks.iter().zip(1..) {
            let number = number.to_string();
            let head = bold_width(&number, SMALL) + NUMBER_GAP_PX;
            let name = fitted(&said(mark, width_px - head), SMALL, width_px - head);
            let width = head + text_width(&name, SMALL);
            if x > 0.0 && x + width > width_px {
                (x, line) = (0.0, line + 1);
            }
            entries.push((number, name, x, line));
            x += width + KEY_PX.1;
        }
        Self { entries }
    }

    /// Height that it takes (px).
    pub(in crate::report) fn height_px(&self) -> f64 {
        self.entries.last().map_or(0.0, |(.., line)| (line + 1) as f64 * KEY_PX.0)
    }

    /// Writes it from a corner on.
    pub(in crate::report) fn draw(&self, canvas: &Canvas<'_>, (left, top): Spot) {
        for (number, name, x, line) in &self.entries {
            let (x, y) = (left + x, top + (*line as f64 + 0.5) * KEY_PX.0);
            canvas.text(&Label::new(number.clone(), (x, y)).bold());
            let behind = bold_width(number, SMALL) + NUMBER_GAP_PX;
            canvas.text(&Label::new(name.clone(), (x + behind, y)));
        }
    }
}

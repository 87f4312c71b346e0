//! Names of lines and barriers on a map: beside their lines where that is clear, as numbers with a key where it is not.

mod zones;

use super::{TOOTH_PX, is_on_paper, on_paper};
use crate::math;
use crate::report::canvas::{Canvas, Label, Pen, SMALL, bold_width, fitted, text_width};
use crate::report::colour::{DARK_GREEN, INK, WHITE};
use crate::report::model::{MapMark, Report};
use crate::report::panel::Panel;
use crate::report::svg::path::{PaperFrame, Spot, clipped};

/// Widest name over the width of the frame (–).
const WIDEST: f64 = 0.6;
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
#[derive(Default)]
pub(in crate::report) struct Names {
    placed: Vec<PlacedName>,
    /// Whether lines and barriers have numbers, for a [`Key`].
    are_numbers: bool,
    /// Letters of the zones and what they stand for; none where zones have their names, or need none.
    lettered: Vec<(String, String)>,
}

/// A name and, where it stands farther from its line, the stroke that leads there.
#[derive(Clone)]
struct PlacedName {
    label: Label,
    stroke: Option<[Spot; 2]>,
}

/// What has a name, on paper.
struct Outline<'a> {
    name: &'a str,
    parts: Vec<Vec<Spot>>,
}

/// A name, and places for it, the nearest first.
type Wanted<'a> = (&'a str, Vec<PlacedName>);

/// What is wrong with a place, the worst first: lines of others through the name, beside it, its own through it, and others through its
/// stroke.
type Faults = [usize; 4];

impl Names {
    /// Finds room for what is `said` of each mark; numbers where words would be read as those of other lines or have no room.
    pub(in crate::report) fn of(panel: &Panel, report: &Report, said: NameOf<'_>) -> Self {
        let outlines = outlines(panel, report);
        let marks = || report.marks.iter().zip(&outlines).zip(1..);
        let written = |words: &dyn Fn(&MapMark, usize) -> String| -> Vec<Wanted<'_>> {
            let places = |((mark, outline), number): ((&MapMark, &Outline<'_>), usize)| {
                candidates(panel, mark, &outline.parts, &words(mark, number))
            };
            marks().map(|mark| (mark.0.1.name, places(mark))).collect()
        };
        let mut names = Self::default();
        let words = written(&|mark, _| said(mark, WIDEST * panel.frame.width()));
        names.are_numbers = !names.place(panel, &outlines, words);
        if names.are_numbers {
            names.placed.clear();
            names.place(panel, &outlines, written(&|_, number| number.to_string()));
        }
        names
    }

    /// Adds names where there is room; whether each is read as that of its own line, and none lacks.
    fn place(&mut self, panel: &Panel, outlines: &[Outline<'_>], all: Vec<Wanted<'_>>) -> bool {
        let mut taken: Vec<PaperFrame> = self.rooms().collect();
        let mut is_clear = true;
        for (own, places) in all.into_iter().filter(|(_, places)| !places.is_empty()) {
            let free = places.into_iter().filter(|name| name.is_free(panel, &taken));
            let faults = |name: &PlacedName| name.faults(outlines, own);
            let Some(name) = free.min_by_key(faults) else {
                is_clear = false;
                continue;
            };
            is_clear &= faults(&name)[..2] == [0, 0];
            taken.extend(name.rooms());
            self.placed.push(name);
        }
        is_clear
    }

    /// What numbers and letters on the map stand for, in lines of a width (px); nothing where it has all names itself.
    pub(in crate::report) fn key(
        &self,
        (panel, report): (&Panel, &Report),
        said: NameOf<'_>,
        width_px: f64,
    ) -> Key {
        let mut key = Key::default();
        let marks = report.marks.iter().zip(1..).filter(|_| self.are_numbers);
        for (mark, number) in marks.filter(|(mark, _)| is_on_paper(panel, mark)) {
            key.add(number.to_string(), &|width| said(mark, width), width_px);
        }
        for (letter, name) in &self.lettered {
            key.add(letter.clone(), &|_| name.clone(), width_px);
        }
        key
    }

    /// The same in a frame of the same size and extent elsewhere on the sheet.
    pub(in crate::report) fn moved(&self, (dx, dy): Spot) -> Self {
        let there = |(x, y): Spot| (x + dx, y + dy);
        let moved = |name: &PlacedName| PlacedName {
            label: name.label.clone().moved(there(name.label.at())),
            stroke: name.stroke.map(|ends| ends.map(there)),
        };
        let placed = self.placed.iter().map(moved).collect();
        Self { placed, lettered: self.lettered.clone(), ..*self }
    }

    fn rooms(&self) -> impl Iterator<Item = PaperFrame> {
        self.placed.iter().flat_map(PlacedName::rooms)
    }

    /// Keeps their room free of other words.
    pub(in crate::report) fn keep(&self, canvas: &Canvas<'_>) {
        self.rooms().for_each(|room| canvas.take(room));
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

/// Lines and barriers on paper.
fn outlines<'a>(panel: &Panel, report: &'a Report) -> Vec<Outline<'a>> {
    let outline = |mark: &'a MapMark| Outline { name: &mark.name, parts: on_paper(panel, mark) };
    report.marks.iter().map(outline).collect()
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

    fn faults(&self, outlines: &[Outline<'_>], own: &str) -> Faults {
        let room = self.label.frame();
        let others = || outlines.iter().filter(|other| other.name != own);
        let through = |room: &PaperFrame| others().filter(|other| other.crosses(room)).count();
        // a line that bends or slants runs through words beside its end
        let is_struck = |line: &Outline<'_>| line.name == own && line.crosses(&room);
        let struck = outlines.iter().filter(|line| is_struck(line)).count();
        let Some(stroke) = self.stroke else {
            return [through(&room), through(&room.grown(READ_PX[0])), struck, 0];
        };
        [through(&room), through(&room.grown(READ_PX[1])), struck, through(&around(stroke))]
    }
}

impl Outline<'_> {
    /// Whether it runs through a room.
    fn crosses(&self, room: &PaperFrame) -> bool {
        self.parts.iter().any(|part| !clipped(part, room).is_empty())
    }
}

/// Room of an upright stroke.
fn around([from, to]: [Spot; 2]) -> PaperFrame {
    let (top, bottom) = (from.1.min(to.1), from.1.max(to.1));
    PaperFrame { left: from.0 - 0.5, right: from.0 + 0.5, top, bottom }
}

/// Places for the name of a mark, the nearest first.
fn candidates(panel: &Panel, mark: &MapMark, parts: &[Vec<Spot>], words: &str) -> Vec<PlacedName> {
    let corners = || mark.corners_m.iter().map(|&[x, y]| panel.at(x, y));
    let is_whole = corners().all(|corner| panel.frame.holds(corner));
    let named = parts.iter().filter(|part| is_whole || length(part) > LEAST_NAMED_PX);
    // teeth of a barrier do not reach into its name
    let gap_px = GAP_PX + if mark.barrier.is_some() { TOOTH_PX.1 } else { 0.0 };
    let near = named.clone().flat_map(|part| beside(part, words, gap_px));
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

/// Places for a name: above and below both ends and the middle, and beyond both ends.
fn beside(part: &[Spot], words: &str, gap_px: f64) -> Vec<Label> {
    let (Some(&first), Some(&last)) = (part.first(), part.last()) else { return Vec::new() };
    let (left, right) = if first.0 <= last.0 { (first, last) } else { (last, first) };
    let middle = part[part.len() / 2];
    let at = |(x, y): Spot, by: f64| Label::new(words, (x, y + by));
    let beyond = [at((right.0 + 6.0, right.1), 0.0), at((left.0 - 6.0, left.1), 0.0).right()];
    [-gap_px, gap_px]
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
    /// Adds what stands for words that fit a width, in lines of a width (px).
    fn add(&mut self, symbol: String, said: &dyn Fn(f64) -> String, width_px: f64) {
        let head = bold_width(&symbol, SMALL) + NUMBER_GAP_PX;
        let name = fitted(&said(width_px - head), SMALL, width_px - head);
        let width = head + text_width(&name, SMALL);
        let end = |(symbol, name, x, line): &(String, String, f64, usize)| {
            let head = bold_width(symbol, SMALL) + NUMBER_GAP_PX;
            (x + head + text_width(name, SMALL) + KEY_PX.1, *line)
        };
        let (mut x, mut line) = self.entries.last().map_or((0.0, 0), end);
        if x > 0.0 && x + width > width_px {
            (x, line) = (0.0, line + 1);
        }
        self.entries.push((symbol, name, x, line));
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

//! Names of lines and barriers above a profile: in one row where they find room beside each other, else in rows that rise
//! to the right, each name left of the stroke that leads up to it. So every one is named, and no stroke runs through a name.

use crate::report::canvas::{Canvas, Label, Pen, SMALL, fitted_among, text_width};
use crate::report::colour::{DARK_GREEN, INK};
use crate::report::model::MapMark;
use crate::report::panel::Panel;
use crate::report::svg::path::PaperFrame;
use plotters::style::RGBColor;

/// Height of a row (px), and from the frame to the middle of the lowest one.
const ROW_PX: f64 = 13.0;
const FIRST_PX: f64 = 9.0;
/// Most rows: a figure of more names than that would be a list.
const MOST_ROWS: usize = 12;
/// Gap between a name and its stroke, and between two names (px).
const GAP_PX: f64 = 4.0;
/// Longest name over the width of the frame (–).
const LONGEST: f64 = 0.4;

/// Where a name stands as seen from its line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Above,
    Left,
    Right,
}

/// One name: its ends across (px), its row from below, and where a stroke leads up to it.
#[derive(Debug, Clone, PartialEq)]
struct Name {
    words: String,
    left: f64,
    right: f64,
    side: Side,
    row: usize,
    stroke: Option<f64>,
}

/// The names above a frame, of each mark; none where it lies beside the frame.
#[derive(Debug, Clone, PartialEq)]
struct NamesAbove(Vec<Option<Name>>);

impl NamesAbove {
    /// Finds room for the names of marks at these places of the sheet (px), which rise.
    fn of(frame: &PaperFrame, marks: &[(f64, &str)]) -> Self {
        let inside: Vec<(f64, &str)> =
            marks.iter().copied().filter(|(x, _)| is_inside(frame, *x)).collect();
        let named = in_one_row(frame, &inside).unwrap_or_else(|| rising(frame, &inside));
        let mut named = named.into_iter();
        Self(
            marks
                .iter()
                .map(|(x, _)| if is_inside(frame, *x) { named.next().flatten() } else { None })
                .collect(),
        )
    }

    /// Room that the rows above the first one need (px).
    fn more_px(&self) -> f64 {
        ROW_PX * self.0.iter().flatten().map(|name| name.row).max().unwrap_or(0) as f64
    }

    /// Writes the name of one mark in its colour, with the stroke of its pen up to it.
    fn draw(&self, canvas: &Canvas<'_>, top: f64, (at, colour, pen): (usize, RGBColor, Pen)) {
        let Some(name) = self.0.get(at).and_then(Option::as_ref) else { return };
        let y = top - FIRST_PX - ROW_PX * name.row as f64;
        let label = |x: f64| Label::new(name.words.clone(), (x, y)).coloured(colour);
        // in a narrower font than the widest one a name still stands at its line
        let label = match name.side {
            Side::Above => label(0.5 * (name.left + name.right)).centred(),
            Side::Left => label(name.right).right(),
            Side::Right => label(name.left),
        };
        if let Some(x) = name.stroke {
            canvas.line(&[(x, top), (x, y - 0.5 * SMALL)], pen);
        }
        canvas.text_on_rim(&label);
    }
}

/// All names in one row, each above its mark, else left or right of it; none where one finds no room.
fn in_one_row(frame: &PaperFrame, marks: &[(f64, &str)]) -> Option<Vec<Option<Name>>> {
    let mut row: Vec<Name> = Vec::new();
    for &(x, name) in marks {
        let all = marks.iter().map(|(_, name)| *name);
        let words = fitted_among(name, all, (SMALL, LONGEST * frame.width()));
        let width = text_width(&words, SMALL);
        let places = [
            (x - 0.5 * width, Side::Above),
            (x - GAP_PX - width, Side::Left),
            (x + GAP_PX, Side::Right),
        ];
        let is_free = |(left, _): &(f64, Side)| {
            let right = left + width;
            let is_clear =
                row.iter().all(|one| one.right + GAP_PX < *left || right + GAP_PX < one.left);
            *left >= frame.left && right <= frame.right && is_clear
        };
        let (left, side) = places.into_iter().find(is_free)?;
        row.push(Name { words, left, right: left + width, side, row: 0, stroke: None });
    }
    Some(row.into_iter().map(Some).collect())
}

/// Each name stands right of its line where there is room up to the next one; else it ends left of its stroke, in the lowest
/// row above every stroke that it covers.
fn rising(frame: &PaperFrame, marks: &[(f64, &str)]) -> Vec<Option<Name>> {
    let mut found: Vec<Option<Name>> = Vec::new();
    for (k, &(x, name)) in marks.iter().enumerate() {
        let next = marks.get(k + 1).map_or(frame.right, |(next, _)| *next);
        let one = right_of(x, name, next).or_else(|| left_of((x, name), marks, frame, &found));
        found.push(one);
    }
    found
}

/// A whole name in the lowest row between its line and the next one.
fn right_of(x: f64, name: &str, next: f64) -> Option<Name> {
    let left = x + GAP_PX;
    let right = left + text_width(name, SMALL);
    let words = name.to_owned();
    let one = Name { words, left, right, side: Side::Right, row: 0, stroke: None };
    (right + GAP_PX < next).then_some(one)
}

/// A name left of its stroke, clear of those found.
fn left_of(
    (x, name): (f64, &str),
    marks: &[(f64, &str)],
    frame: &PaperFrame,
    found: &[Option<Name>],
) -> Option<Name> {
    let right = x - GAP_PX;
    let width = (LONGEST * frame.width()).min(right - GAP_PX).max(0.0);
    let words = fitted_among(name, marks.iter().map(|(_, name)| *name), (SMALL, width));
    let left = right - text_width(&words, SMALL);
    let is_free = |row: &usize| {
        found.iter().flatten().all(|one| {
            let is_clear = one.row != *row || one.right + GAP_PX < left;
            let is_above = one.stroke.is_none_or(|at| at < left - GAP_PX) || *row > one.row;
            is_clear && is_above
        })
    };
    let row = (0..MOST_ROWS).find(is_free)?;
    Some(Name { words, left, right, side: Side::Left, row, stroke: Some(x) })
}

/// Where lines and barriers stand, through all panels, named above the first.
pub(in crate::report) fn name_marks(
    canvas: &Canvas<'_>,
    panels: &[Panel],
    marks: &[(f64, MapMark)],
) {
    let Some(first) = panels.first() else { return };
    let look = |mark: &MapMark| match mark.barrier {
        Some(_) => (DARK_GREEN, Pen::full(DARK_GREEN, 1.6)),
        None => (INK, Pen::full(INK, 0.9).dotted()),
    };
    let names = above(first, marks);
    // all lines before the first name: none runs through a name
    for (at, mark) in marks {
        for panel in panels {
            panel.upright(canvas, *at, look(mark).1);
        }
    }
    for (k, (_, mark)) in marks.iter().enumerate() {
        let (colour, pen) = look(mark);
        names.draw(canvas, first.frame.top, (k, colour, pen));
    }
}

/// Where a distance along a panel is on the sheet (px).
fn place(panel: &Panel, at: f64) -> f64 {
    panel.at(at, panel.y.low).0
}

/// Whether a place of the sheet (px) is above a frame and not beside it.
fn is_inside(frame: &PaperFrame, x: f64) -> bool {
    (frame.left..=frame.right).contains(&x)
}

/// The names of marks above a panel, by rising distance along it.
fn above(panel: &Panel, marks: &[(f64, MapMark)]) -> NamesAbove {
    let named: Vec<(f64, &str)> =
        marks.iter().map(|(at, mark)| (place(panel, *at), mark.name.as_str())).collect();
    NamesAbove::of(&panel.frame, &named)
}

/// The names of the marks in a panel that find no room above it, by rising distance.
pub(in crate::report) fn without_room<'a>(
    panel: &Panel,
    marks: &'a [(f64, MapMark)],
) -> Vec<&'a str> {
    let named = above(panel, marks).0.into_iter().zip(marks);
    named
        .filter(|(name, (at, _))| name.is_none() && is_inside(&panel.frame, place(panel, *at)))
        .map(|(_, (_, mark))| mark.name.as_str())
        .collect()
}

/// Room that the names above a panel need beside that of one row (px).
pub(in crate::report) fn more_above_px(panel: &Panel, marks: &[(f64, MapMark)]) -> f64 {
    above(panel, marks).more_px()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: PaperFrame = PaperFrame { left: 50.0, top: 24.0, right: 660.0, bottom: 300.0 };

    fn names(marks: &[(f64, &str)]) -> Vec<Name> {
        NamesAbove::of(&FRAME, marks).0.into_iter().flatten().collect()
    }

    /// Far from each other they need no more room than one.
    #[test]
    fn names_far_apart_stand_in_one_row() {
        let found = names(&[(100.0, "net"), (300.0, "road"), (500.0, "house")]);
        assert_eq!(found.len(), 3);
        assert!(found.iter().all(|name| name.row == 0), "{found:?}");
        let middle = 0.5 * (found[1].left + found[1].right);
        assert!((middle - 300.0).abs() < 1e-9, "above its line: {found:?}");
    }

    /// Eight lines a few pixels apart: each has its name, none over another, and no stroke runs through one.
    #[test]
    fn every_one_of_many_lines_close_together_is_named() {
        let long = "upper edge of the old forest road to the quarry";
        let marks: Vec<(f64, &str)> = (0..8)
            .map(|k| (400.0 + 9.0 * f64::from(k), if k % 3 == 1 { "a" } else { long }))
            .collect();
        let found = names(&marks);
        assert_eq!(found.len(), marks.len());
        for (k, one) in found.iter().enumerate() {
            let x = one.stroke.unwrap_or(one.left);
            assert!(one.left >= 0.0 && (one.right < x || one.row == 0), "{one:?}");
            for other in &found[k + 1..] {
                let is_over =
                    one.row == other.row && one.right > other.left && other.right > one.left;
                assert!(!is_over, "{one:?} over {other:?}");
                let is_struck = other.left < x && x < other.right && one.row >= other.row;
                assert!(!is_struck, "stroke of {one:?} through {other:?}");
            }
        }
    }

    /// Two barriers at one place are two names.
    #[test]
    fn two_marks_at_one_place_are_named_both() {
        let found = names(&[(200.0, "net, west"), (200.0, "net, east")]);
        assert_eq!(found.len(), 2);
        assert_ne!((found[0].row, found[0].left), (found[1].row, found[1].left));
    }

    /// Twenty lines at one place do not find room for all their names: those without are told by name.
    #[test]
    fn names_without_room_are_known() {
        let axis = |high: f64| crate::report::axis::Axis::linear(0.0, high, "");
        let panel = Panel::new(FRAME, axis(610.0), axis(1.0));
        let mark = |k: u32| MapMark {
            name: format!("line {k}"),
            corners_m: Vec::new(),
            barrier: None,
            is_object: false,
        };
        let marks: Vec<(f64, MapMark)> =
            (0..20).map(|k| (400.0 + 3.0 * f64::from(k), mark(k))).collect();
        let named = above(&panel, &marks).0.iter().flatten().count();
        let without = without_room(&panel, &marks);
        assert!(!without.is_empty() && named + without.len() == 20, "{without:?}");
        // beside the frame there is nothing to name
        assert!(without_room(&panel, &[(900.0, mark(0))]).is_empty());
    }
}

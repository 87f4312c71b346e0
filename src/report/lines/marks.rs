//! Marked percentiles of rocks at a line, and names where there is room for them.

use crate::report::canvas::{Canvas, Label, Pen, SMALL, text_width};
use crate::report::colour::{INK, VERMILLION};
use crate::report::model::{Quantile, ReportLine};
use crate::report::panel::Panel;
use crate::report::svg::path::{PaperFrame, Spot, clipped};
use std::fmt::Write;

/// Marked percentiles, the second one dashed.
const MARKED: [f64; 2] = [0.50, 0.95];

/// Marked percentiles of energy and height, each with its name where no other one runs through it.
pub(super) fn percentiles(canvas: &Canvas<'_>, panel: &Panel, line: &ReportLine, size: f64) {
    let of = |list: &[Quantile], probability: f64| {
        let found = list.iter().find(|q| (q.probability - probability).abs() < 1e-9);
        found.map(|q| q.at.value).filter(|value| value.is_finite())
    };
    let upright = |energy: f64| panel.at(energy / size, panel.y.high).0;
    let level = |height: f64| panel.at(panel.x.high, height.max(0.0)).1;
    let energies = MARKED.map(|p| (p, of(&line.energy_quantiles, p)));
    let heights = MARKED.map(|p| (p, of(&line.height_quantiles, p)));
    let lines: Vec<Vec<Spot>> = (energies.iter().filter_map(|(_, e)| e.map(upright)))
        .map(|x| vec![(x, panel.frame.top), (x, panel.frame.bottom)])
        .chain(
            heights
                .iter()
                .filter_map(|(_, h)| h.map(level))
                .map(|y| vec![(panel.frame.left, y), (panel.frame.right, y)]),
        )
        .collect();
    let pen = |probability: f64| {
        let pen = Pen::full(VERMILLION, 1.2);
        if probability < 0.9 { pen } else { pen.dashed() }
    };
    let (mut marked_x, mut marked_y) = (Vec::new(), Vec::new());
    for (p, energy) in energies {
        let Some(energy) = energy else { continue };
        panel.upright(canvas, energy / size, pen(p));
        marked_x.push((p, upright(energy)));
    }
    for (p, height) in heights {
        let Some(height) = height else { continue };
        panel.line(canvas, &[(panel.x.low, height), (panel.x.high, height)], pen(p));
        marked_y.push((p, level(height)));
    }
    let frame = panel.frame;
    let ys =
        [frame.top + 9.0, frame.top + 27.0, 0.5 * (frame.top + frame.bottom), frame.bottom - 9.0];
    names(canvas, panel, (&marked_x, &lines), |x, width| {
        ys.iter().flat_map(|&y| [(x + 3.0, y), (x - 3.0 - width, y)]).collect()
    });
    names(canvas, panel, (&marked_y, &lines), |y, width| {
        let xs = [frame.right - 5.0 - width, 0.5 * (frame.left + frame.right), frame.left + 5.0];
        xs.iter().flat_map(|&x| [(x, y - 8.0), (x, y + 9.0)]).collect()
    });
}

/// Names marked percentiles, rising, each at the first free one of its places; one that finds no room shares the name of the next.
fn names(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (marked, lines): (&[(f64, f64)], &[Vec<Spot>]),
    places: impl Fn(f64, f64) -> Vec<Spot>,
) {
    let mut words = String::new();
    for (probability, at) in marked {
        let _ = write!(words, "P{:.0}", 100.0 * probability);
        let places = places(*at, text_width(&words, SMALL));
        if name(canvas, panel, (&words, &places), lines) {
            words.clear();
        } else {
            words += ", ";
        }
    }
}

/// Writes a word at the first place where no text stands and none of some lines runs; whether there is one.
pub(super) fn name(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (words, places): (&str, &[Spot]),
    lines: &[Vec<Spot>],
) -> bool {
    let labels = places.iter().map(|&at| Label::new(words, at).coloured(INK));
    // its white rim would cover them
    let is_clear =
        |room: PaperFrame| lines.iter().all(|line| clipped(line, &room.grown(1.8)).is_empty());
    let is_free = |label: &Label| {
        let room = label.frame();
        panel.frame.contains(&room) && canvas.is_free(&room) && is_clear(room)
    };
    let free = labels.into_iter().find(is_free);
    if let Some(label) = &free {
        canvas.text_on_rim(label);
    }
    free.is_some()
}

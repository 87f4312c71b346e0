//! Speed, energy and bounce height of a few rocks along their ways.

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{BLUE, GREEN, INK, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{Path, ReleaseEnd, Report, energy_unit};
use super::panel::{FOOT_PX, Panel, align};
use super::svg::path::PaperFrame;
use super::words::{Words, fill};
use crate::math;

const TOP_PX: f64 = 30.0;
const PLOT_PX: f64 = 110.0;
const GAP_PX: f64 = 18.0;
/// Pens of the three rocks: told apart without colour.
const PENS: [Pen; 3] =
    [Pen::full(BLUE, 1.4), Pen::full(VERMILLION, 1.4).dashed(), Pen::full(GREEN, 1.6).dotted()];

/// A rock that is shown, and why.
struct Chosen<'a> {
    why: &'static str,
    fall: &'a ReleaseEnd,
    path: &'a Path,
}

/// Of the rocks with a stored path: the one of median runout, the one with most energy, the one that came farthest.
fn chosen(report: &Report) -> Vec<Chosen<'_>> {
    let with_path = report.paths.iter().filter(|path| path.points.len() > 2);
    let mut rocks: Vec<(&ReleaseEnd, &Path)> =
        with_path.filter_map(|path| Some((report.releases.get(path.index)?, path))).collect();
    rocks.retain(|(fall, _)| {
        fall.runout_m.is_finite() && fall.max_speed_m_s > 0.0 && fall.max_total_j.is_finite()
    });
    rocks.sort_by(|a, b| a.0.runout_m.total_cmp(&b.0.runout_m));
    let middle = rocks.get(rocks.len() / 2).copied();
    let strongest =
        rocks.iter().copied().max_by(|a, b| a.0.max_total_j.total_cmp(&b.0.max_total_j));
    let words = report.words();
    let picked = [
        (words.median_runout, middle),
        (words.most_energy, strongest),
        (words.farthest, rocks.last().copied()),
    ];
    let mut chosen: Vec<Chosen<'_>> = Vec::new();
    for (why, rock) in picked {
        let Some((fall, path)) = rock else { continue };
        if chosen.iter().all(|known| known.path.index != path.index) {
            chosen.push(Chosen { why, fall, path });
        }
    }
    chosen
}

/// Draws the three panels over the way in plan view; none without a stored path.
pub(super) fn draw(report: &Report) -> Option<Drawing> {
    let chosen = chosen(report);
    if chosen.is_empty() {
        return None;
    }
    let words = report.words();
    let most_j = chosen.iter().map(|rock| rock.fall.max_translational_j).fold(0.0, f64::max);
    let (unit, size) = energy_unit(most_j);
    let curves: [Vec<Vec<(f64, f64)>>; 3] = [
        along(&chosen, |rock, k| rock.path.points[k].speed_m_s),
        // translational energy grows with the square of the speed, and is largest where the speed is
        along(&chosen, |rock, k| {
            let share = rock.path.points[k].speed_m_s / rock.fall.max_speed_m_s;
            rock.fall.max_translational_j * share * share / size
        }),
        along(&chosen, |rock, k| {
            let height_m = rock.path.points[k].clearance_m;
            if height_m < 0.0 { 0.0 } else { height_m }
        }),
    ];
    let energy = fill(words.along_energy, &[("unit", &unit)]);
    let titles = [words.speed_axis, energy.as_str(), words.height_axis];
    let panels = panels(&curves, titles, words);
    let bottom = panels[2].frame.bottom + FOOT_PX;
    let svg = paint("along", (WIDTH_PX, bottom), words.along_alt, |canvas| {
        key(canvas, &panels[0], &chosen, words);
        for (k, panel) in panels.iter().enumerate() {
            panel.grid(canvas);
            for (curve, pen) in curves[k].iter().zip(PENS) {
                panel.line(canvas, curve, pen);
            }
            if k == 2 { panel.axes(canvas) } else { panel.axes_above_another(canvas) }
        }
    });
    let who = |rock: &Chosen<'_>| in_words(rock, words.along_rock_caption);
    let who: Vec<String> = chosen.iter().map(who).collect();
    let caption = fill(words.along_caption, &[("who", &who.join(", "))]);
    Some(Drawing { svg, caption })
}

/// Number of a rock and why it is shown.
fn in_words(rock: &Chosen<'_>, text: &str) -> String {
    let n = format::decimal(rock.path.index as f64, 0);
    fill(text, &[("n", &n), ("why", &rock.why)])
}

/// A value of each rock over the distance it has travelled in plan view.
fn along(chosen: &[Chosen<'_>], value: impl Fn(&Chosen<'_>, usize) -> f64) -> Vec<Vec<(f64, f64)>> {
    let curve = |rock: &Chosen<'_>| {
        let points = &rock.path.points;
        let mut way = 0.0;
        (0..points.len())
            .map(|k| {
                let before = points[k.saturating_sub(1)].place_m;
                let here = points[k].place_m;
                let step = math::hypot(here[0] - before[0], here[1] - before[1]);
                way += if step.is_finite() { step } else { 0.0 };
                (way, value(rock, k))
            })
            .collect()
    };
    chosen.iter().map(curve).collect()
}

fn panels(curves: &[Vec<Vec<(f64, f64)>>; 3], titles: [&str; 3], words: &Words) -> [Panel; 3] {
    let ways = curves[0].iter().flatten().map(|p| p.0);
    let x = Axis::from_zero(ways, words.along_axis);
    let mut panels = [0, 1, 2].map(|k| {
        let top = TOP_PX + k as f64 * (PLOT_PX + GAP_PX);
        let frame = PaperFrame { left: 0.0, top, right: WIDTH_PX - 16.0, bottom: top + PLOT_PX };
        let values = curves[k].iter().flatten().map(|p| p.1);
        Panel::new(frame, x.clone(), Axis::from_zero(values, titles[k]))
    });
    let [a, b, c] = &mut panels;
    align([a, b, c]);
    panels
}

fn key(canvas: &Canvas<'_>, panel: &Panel, chosen: &[Chosen<'_>], words: &Words) {
    let y = panel.frame.top - 14.0;
    let mut x = panel.frame.left;
    for (rock, pen) in chosen.iter().zip(PENS) {
        let said = in_words(rock, words.along_rock);
        canvas.line(&[(x, y), (x + 20.0, y)], pen);
        x += 25.0 + text_width(&said, SMALL) + 18.0;
        let left = x - 18.0 - text_width(&said, SMALL);
        canvas.text(&Label::new(said, (left, y)).coloured(INK));
    }
}

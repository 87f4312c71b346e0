//! Speed, energy and bounce height of a few rocks along their ways.

use super::axis::Axis;
use super::canvas::{Canvas, Label, Pen, SMALL, paint, text_width};
use super::colour::{BLUE, GREEN, GREY, INK, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{Path, ReleaseEnd, Report, ReportQuantity, energy_unit};
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

const LEVEL: Pen = Pen::full(GREY, 0.9);
/// Room right of the frames for the names of levels (px).
const RIGHT_PX: f64 = 32.0;
/// Largest energies of rocks that differ by more than this are told apart on a logarithmic scale only (–).
const UNLIKE: f64 = 10.0;
/// How far down the curve of the weakest rock is shown, over its largest energy (–): to a fifth of its speed.
const SHOWN: f64 = 0.04;
/// Least energy of the scale over the largest (–): lower only for the weakest rock itself, down to [`FAINTEST`].
const SMALLEST: f64 = 1e-5;
/// The same where the largest energy of the weakest rock is less: beyond, it has none to speak of.
const FAINTEST: f64 = 1e-9;

/// A rock that is shown, and why.
struct Chosen<'a> {
    why: &'static str,
    fall: &'a ReleaseEnd,
    path: &'a Path,
}

/// Of the rocks with a stored path: the one whose runout is nearest to the median of all rocks, the one with most energy, the one that came farthest.
fn chosen(report: &Report) -> Vec<Chosen<'_>> {
    let with_path = report.paths.iter().filter(|path| path.points.len() > 2);
    let mut rocks: Vec<(&ReleaseEnd, &Path)> =
        with_path.filter_map(|path| Some((report.releases.get(path.index)?, path))).collect();
    rocks.retain(|(fall, _)| {
        fall.runout_m.is_finite() && fall.max_speed_m_s > 0.0 && fall.max_total_j.is_finite()
    });
    rocks.sort_by(|a, b| a.0.runout_m.total_cmp(&b.0.runout_m));
    let mut runouts = report.quantiles.get(&ReportQuantity::Runout).into_iter().flatten();
    let middle = match runouts.find(|one| (one.probability - 0.5).abs() < 1e-9) {
        Some(median) => {
            let off = |rock: &(&ReleaseEnd, &Path)| (rock.0.runout_m - median.at.value).abs();
            rocks.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)))
        }
        None => rocks.get(rocks.len() / 2).copied(),
    };
    let strongest =
        rocks.iter().copied().max_by(|a, b| a.0.max_total_j.total_cmp(&b.0.max_total_j));
    let words = report.words();
    let picked = [
        (if rocks.len() == 1 { words.only_path } else { words.median_runout }, middle),
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
    let energies = levels(report, ReportQuantity::Translational);
    let scale = EnergyScale::of(energies.first().map(|(_, median_j)| *median_j), &chosen);
    let curves: [Vec<Vec<(f64, f64)>>; 3] = [
        along(&chosen, |rock, k| rock.path.points[k].speed_m_s),
        // translational energy grows with the square of the speed, and is largest where the speed is
        along(&chosen, |rock, k| {
            let share = rock.path.points[k].speed_m_s / rock.fall.max_speed_m_s;
            scale.drawn(rock.fall.max_translational_j * share * share)
        }),
        along(&chosen, |rock, k| {
            let height_m = rock.path.points[k].clearance_m;
            if height_m < 0.0 { 0.0 } else { height_m }
        }),
    ];
    let levels = [
        levels(report, ReportQuantity::Speed),
        energies.into_iter().map(|(name, joule)| (name, joule / scale.size_j)).collect(),
        levels(report, ReportQuantity::Height),
    ];
    let panels = panels((&curves, &levels), &scale, words);
    let bottom = panels[2].frame.bottom + FOOT_PX;
    let svg = paint("along", (WIDTH_PX, bottom), words.along_alt, |canvas| {
        key(canvas, &panels[0], &chosen, words);
        for (k, panel) in panels.iter().enumerate() {
            panel.grid(canvas);
            draw_levels(canvas, panel, &levels[k]);
            for (curve, pen) in curves[k].iter().zip(PENS) {
                panel.line(canvas, curve, pen);
            }
            if k == 2 { panel.axes(canvas) } else { panel.axes_above_another(canvas) }
        }
    });
    let who = |rock: &Chosen<'_>| in_words(rock, words.along_rock_caption);
    let who: Vec<String> = chosen.iter().map(who).collect();
    let caption = fill(words.along_caption, &[("who", &who.join(", "))]);
    let rocks = words.rocks(report.released());
    let all = fill(words.along().percentiles, &[("rocks", &rocks)]);
    let all = if levels.iter().any(|of| !of.is_empty()) { all } else { String::new() };
    Some(Drawing { svg, caption: caption + &all + &scale.in_words(words) })
}

/// The scale of energy: logarithmic where the largest energies of the rocks differ much, so that each can be read.
struct EnergyScale {
    unit: &'static str,
    /// Its unit (J).
    size_j: f64,
    /// Lower end of a logarithmic scale (J); none of a linear one.
    least_j: Option<f64>,
    /// Largest over smallest of the rocks' largest energies (–).
    ratio: f64,
}

impl EnergyScale {
    /// Of chosen rocks, where the median of all rocks (J) is known or not.
    fn of(median_j: Option<f64>, chosen: &[Chosen<'_>]) -> Self {
        let largest = || chosen.iter().map(|rock| rock.fall.max_translational_j);
        let (most_j, least_j) =
            (largest().fold(0.0, f64::max), largest().fold(f64::INFINITY, f64::min));
        let ratio = most_j / least_j;
        let median_j = median_j.unwrap_or(f64::INFINITY);
        let lowest_j = (least_j * SHOWN).min(0.5 * median_j).max(SMALLEST * most_j);
        let lowest_j = lowest_j.min(0.3 * least_j).max(FAINTEST * most_j);
        let is_log = ratio > UNLIKE && ratio.is_finite();
        let least_j = is_log.then(|| Axis::ratios(lowest_j, most_j, "").low);
        let (unit, size_j) = energy_unit(most_j);
        Self { unit, size_j, least_j, ratio }
    }

    /// An energy as it is drawn, in its unit: one far below a logarithmic scale stays a number there.
    fn drawn(&self, energy_j: f64) -> f64 {
        energy_j.max(self.least_j.map_or(0.0, |least_j| 0.1 * least_j)) / self.size_j
    }

    fn axis(&self, values: impl Iterator<Item = f64>, title: &str) -> Axis {
        match self.least_j {
            Some(least_j) => Axis::ratios(least_j / self.size_j, values.fold(0.0, f64::max), title),
            None => Axis::from_zero(values, title),
        }
    }

    /// What a logarithmic scale leaves out; nothing of a linear one.
    fn in_words(&self, words: &Words) -> String {
        let said = |least_j: f64| {
            let (unit, size_j) = energy_unit(2.0 * least_j);
            let least = format::plain(math::rounded(least_j / size_j, 3));
            let ratio = format::significant(math::rounded(self.ratio, 2), 2);
            fill(words.along().log_scale, &[("ratio", &ratio), ("least", &least), ("unit", &unit)])
        };
        self.least_j.map_or(String::new(), said)
    }
}

/// Median and P95 of the largest values of all rocks, by name; none of too few rocks to know both.
fn levels(report: &Report, quantity: ReportQuantity) -> Vec<(&'static str, f64)> {
    let all = report.quantiles.get(&quantity).into_iter().flatten();
    let at = |asked: f64| all.clone().find(|one| (one.probability - asked).abs() < 1e-9);
    let (Some(median), Some(p95)) = (at(0.5), at(0.95)) else { return Vec::new() };
    let found = [("P50", median), ("P95", p95)].map(|(name, known)| (name, known.at.value));
    found.into_iter().filter(|(_, value)| value.is_finite() && *value > 0.0).collect()
}

/// Lines across, named beside the frame: the one that is the smaller lower where they are close.
fn draw_levels(canvas: &Canvas<'_>, panel: &Panel, levels: &[(&str, f64)]) {
    let right = panel.frame.right;
    let y = |value: f64| panel.at(panel.x.low, value).1;
    let shown = |value: f64| (panel.y.low..=panel.y.high).contains(&value);
    let close = match levels {
        [(_, low), (_, high)] => 0.5 * (SMALL + 1.0 - (y(*low) - y(*high))).max(0.0),
        _ => 0.0,
    };
    for ((name, value), side) in levels.iter().zip([1.0, -1.0]).filter(|((_, v), _)| shown(*v)) {
        canvas.line(&[(panel.frame.left, y(*value)), (right, y(*value))], LEVEL);
        let at = (right + 4.0, y(*value) + side * close);
        canvas.text(&Label::new(*name, at).coloured(GREY));
    }
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

/// Curves of the rocks and levels of all, panel by panel.
type Drawn<'a> = (&'a [Vec<Vec<(f64, f64)>>; 3], &'a [Vec<(&'static str, f64)>; 3]);

fn panels((curves, levels): Drawn<'_>, scale: &EnergyScale, words: &Words) -> [Panel; 3] {
    let energy = fill(words.along_energy, &[("unit", &scale.unit)]);
    let titles = [words.speed_axis, energy.as_str(), words.height_axis];
    let ways = curves[0].iter().flatten().map(|p| p.0);
    let x = Axis::from_zero(ways, words.along_axis);
    let mut panels = [0, 1, 2].map(|k| {
        let top = TOP_PX + k as f64 * (PLOT_PX + GAP_PX);
        let right = WIDTH_PX - RIGHT_PX;
        let frame = PaperFrame { left: 0.0, top, right, bottom: top + PLOT_PX };
        let values = curves[k].iter().flatten().map(|p| p.1);
        let values = values.chain(levels[k].iter().map(|level| level.1));
        let y =
            if k == 1 { scale.axis(values, titles[k]) } else { Axis::from_zero(values, titles[k]) };
        Panel::new(frame, x.clone(), y)
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

//! Measured and computed ends: distributions of runout, and where the rocks lie.

use super::axis::Axis;
use super::canvas::{Canvas, Label, NORMAL, Pen, paint};
use super::colour::{BLUE, GREY, INK, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{Estimate, Is, Observed, Report};
use super::panel::{FOOT_PX, Panel};
use super::plan_view::ground;
use super::svg::path::{PaperFrame, Spot};
use super::words::{Words, fill};
use crate::hazard::{Agreement, ObservedPath, Open, Sample, Weighted, mean_95, runouts};
use crate::math;

const TOP_PX: f64 = 26.0;
const CURVE_PX: f64 = 210.0;
const GAP_PX: f64 = 34.0;
const TALLEST_PX: f64 = 420.0;
const LEFT_PX: f64 = 66.0;
/// What is said more where computed rocks weigh what they stand for.
const WEIGHED: &str = "Computed rocks weigh what they stand for, measured ones all the same; the limit is that of as many \
    computed rocks of equal weight as would know as much.";
/// What is said more where they are those from the places of the measured ends.
const OWN_PLACES: &str = "Each measured end is compared with the computed rocks from its own place of release: those of a place weigh as much together as the ends \
    measured there.";
/// What is said more where computed rocks are not compared.
const NOT_COMPARED: &str = "{n} computed rocks are not compared: their runout is less than least_runout_m of [calibrate], and a \
    list of throws holds none that stayed where it was set down.";
/// Pens of both distributions: told apart without colour.
const COMPUTED: Pen = Pen::full(BLUE, 1.6);
const MEASURED: Pen = Pen::full(VERMILLION, 1.8).dashed();

/// Draws the two distributions above the map of ends.
pub(super) fn draw(report: &Report, observed: &Observed) -> Drawing {
    let words = report.words();
    let curves = curve_panel(observed, words);
    let map = map_panel(observed, words, curves.frame.bottom + FOOT_PX + GAP_PX);
    let size = (WIDTH_PX, map.frame.bottom + FOOT_PX);
    let svg = paint("measured", size, words.measured_title, |canvas| {
        head(canvas, &curves, words.measured_curves);
        curves.grid(canvas);
        steps(
            canvas,
            &curves,
            (&shares(&observed.computed, observed.weights.as_ref()), COMPUTED),
            words,
        );
        steps(canvas, &curves, (&shares(&observed.measured, None), MEASURED), words);
        curves.axes(canvas);
        key(canvas, &curves, words);
        head(canvas, &map, words.measured_map);
        canvas.clip("map", &map.frame, || {
            if let Some(raster) = &report.ground {
                let _ = ground::draw(canvas, &map, raster, &[]);
            }
            canvas.dots(&ends(&map, &observed.computed), 1.2, BLUE);
            let measured = ends(&map, &observed.measured);
            canvas.dots(&measured, 3.0, INK);
            canvas.dots(&measured, 2.4, VERMILLION);
            let starts = observed.measured.iter().map(|w| map.at(w.start_m[0], w.start_m[1]));
            canvas.dots(&starts.collect::<Vec<_>>(), 1.2, INK);
        });
        map.axes(canvas);
    });
    let at = observed.agreement;
    let number = |value: f64| format::significant(math::rounded(value, 2), 2);
    let mean = mean_of(observed).map(|mean| {
        let [value, low, high] = format::with_interval([mean.value, mean.low, mean.high]);
        format!("{}{value} ({})", format::sign(mean.is), words.interval(&low, &high))
    });
    let caption = fill(
        words.measured_caption,
        &[
            ("measured", &at.measured),
            ("computed", &format::decimal(at.computed as f64, 0)),
            ("mean_measured", &mean[0]),
            ("mean_computed", &mean[1]),
            (
                "ks",
                &(format::sign(Is::at_least_if(at.ks_most.is_some())).to_owned() + &number(at.ks)),
            ),
            ("limit", &number(at.ks_limit)),
            ("side_measured", &number(at.measured_side_m)),
            ("side_computed", &number(at.computed_side_m)),
        ],
    );
    let more = worth(observed, words) + &weighing(observed, words);
    Drawing { svg, caption: caption + &more + &not_compared(&at, words) + &not_ended(&at, words) }
}

/// Mean runouts, measured and computed, with their intervals (m).
pub(super) fn mean_of(observed: &Observed) -> [Estimate; 2] {
    let measured: Vec<f64> = observed.measured.iter().map(ObservedPath::runout_m).collect();
    let at = &observed.agreement;
    let [low, high] = mean_95(&measured, observed.worth).unwrap_or([f64::NAN; 2]);
    let even = vec![1.0; observed.computed.len()];
    let weights = observed.weights.as_ref().unwrap_or(&even);
    let ways = observed.computed.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
    let seen = ways.map(|(way, weight)| (way.runout_m(), *weight, way.open.is_some()));
    let mean = Sample::censored(seen, Open::Above).mean();
    let end = |end: Option<f64>| end.unwrap_or(f64::NAN);
    let ends = mean.map_or([f64::NAN; 2], |mean| [mean.low_95, mean.high_95].map(end));
    let computed = Estimate::new(at.computed_mean_m, ends[0], ends[1]);
    let is = Is::at_least_if(at.open() > 0);
    [Estimate::new(at.measured_mean_m, low, high), Estimate { is, ..computed }]
}

/// For how many independent ends the limit is, and that it is no test of values fitted to these ends.
pub(super) fn worth(observed: &Observed, words: &Words) -> String {
    let count = |n: f64| format::decimal(n, 0);
    let said = fill(
        words.drawn().ends_worth,
        &[("worth", &count(observed.worth)), ("ends", &count(observed.measured.len() as f64))],
    );
    said + words.drawn().ends_no_test
}

/// What caption and table say more where computed rocks weigh what they stand for; else nothing.
pub(super) fn weighing(observed: &Observed, words: &Words) -> String {
    let weighed = if observed.from_own_places { OWN_PLACES } else { WEIGHED };
    let said = observed.weights.as_ref().map(|_| format!(" {}", words.say(weighed)));
    said.unwrap_or_default()
}

/// What is said more where computed rocks are not compared; else nothing.
pub(super) fn not_compared(agreement: &Agreement, words: &Words) -> String {
    let count = agreement.stayed;
    let said = fill(NOT_COMPARED, &[("n", &format::decimal(count as f64, 0))]);
    if count > 0 { format!(" {}", words.say(&said)) } else { String::new() }
}

/// What is said more where computed rocks would have gone on; else nothing.
pub(super) fn not_ended(agreement: &Agreement, words: &Words) -> String {
    let (open, of) = (agreement.open(), agreement.computed);
    if open == 0 {
        return String::new();
    }
    let count = |n: usize| format::decimal(n as f64, 0);
    let places = [open, of, agreement.left_terrain, agreement.still_moving].map(count);
    let share = format::percent_of_part(open as f64 / of as f64, 0);
    fill(
        words.open().at_ends,
        &[
            ("n", &places[0]),
            ("of", &places[1]),
            ("left", &places[2]),
            ("moving", &places[3]),
            ("share", &share),
        ],
    )
}

fn head(canvas: &Canvas<'_>, panel: &Panel, words: &str) {
    let at = (panel.frame.left, panel.frame.top - 10.0);
    canvas.text(&Label::new(words, at).bold().sized(NORMAL));
}

fn key(canvas: &Canvas<'_>, panel: &Panel, words: &Words) {
    for (k, (name, pen)) in
        [(words.measured, MEASURED), (words.computed, COMPUTED)].into_iter().enumerate()
    {
        let y = panel.frame.top + 16.0 + 16.0 * k as f64;
        let x = panel.frame.left + 14.0;
        canvas.line(&[(x, y), (x + 22.0, y)], pen);
        canvas.text(&Label::new(name, (x + 28.0, y)).coloured(GREY));
    }
}

fn curve_panel(observed: &Observed, words: &Words) -> Panel {
    let runouts = observed.measured.iter().chain(&observed.computed).map(ObservedPath::runout_m);
    let frame = PaperFrame {
        left: LEFT_PX,
        top: TOP_PX,
        right: WIDTH_PX - 14.0,
        bottom: TOP_PX + CURVE_PX,
    };
    let x = Axis::from_zero(runouts, words.runout_axis);
    Panel::new(frame, x, Axis::linear(0.0, 1.0, words.share_of_rocks))
}

/// Runouts in ascending order (m), each with the shares of all weight before it and with it.
fn shares(ways: &[ObservedPath], weights: Option<&Vec<f64>>) -> Vec<(f64, [f64; 2])> {
    let weight = |at: usize| weights.map_or(1.0, |all| all[at]);
    let weighted: Vec<Weighted> =
        ways.iter().enumerate().map(|(at, way)| (*way, weight(at))).collect();
    let sorted = runouts(&weighted);
    let all: f64 = sorted.iter().map(|(_, weight)| weight).sum();
    let mut below = 0.0;
    let step = |(x, weight): (f64, f64)| {
        let before = below;
        below += weight;
        (x, [before / all, below / all])
    };
    sorted.into_iter().map(step).collect()
}

/// The empirical distribution as the steps it consists of.
fn steps(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (shares, pen): (&[(f64, [f64; 2])], Pen),
    words: &Words,
) {
    let corners = |&(x, [before, with]): &(f64, [f64; 2])| [(x, before), (x, with)];
    let line: Vec<(f64, f64)> = shares.iter().flat_map(corners).collect();
    panel.line(canvas, &line, pen);
    if line.is_empty() {
        panel.nothing(canvas, words.no_rock);
    }
}

fn map_panel(observed: &Observed, words: &Words, top: f64) -> Panel {
    let places = || {
        let all = observed.measured.iter().chain(&observed.computed);
        all.flat_map(|way| [way.start_m, way.end_m])
    };
    let range = |axis: usize| {
        let (low, high) = places()
            .map(|place| place[axis])
            .filter(|x| x.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        (low - 5.0, high + 5.0)
    };
    let (mut x, y) = (range(0), range(1));
    let panel = |frame: PaperFrame, x: (f64, f64)| {
        let across = Axis::linear(x.0, x.1, words.easting);
        Panel::new(frame, across, Axis::linear(y.0, y.1, words.northing))
    };
    // seven digits of a northing need their room
    let square = PaperFrame { left: 0.0, top: 0.0, right: 400.0, bottom: 400.0 };
    let left = panel(square, x).room_left().max(LEFT_PX);
    let widest = WIDTH_PX - 14.0 - left;
    let scale = (widest / (x.1 - x.0)).min(TALLEST_PX / (y.1 - y.0));
    let more = 0.5 * (widest / scale - (x.1 - x.0)).max(0.0);
    x = (x.0 - more, x.1 + more);
    let bottom = top + scale * (y.1 - y.0);
    panel(PaperFrame { left, top, right: left + widest, bottom }, x)
}

fn ends(panel: &Panel, ways: &[ObservedPath]) -> Vec<Spot> {
    let spots = ways.iter().map(|way| panel.at(way.end_m[0], way.end_m[1]));
    spots.filter(|&spot| panel.frame.holds(spot)).collect()
}

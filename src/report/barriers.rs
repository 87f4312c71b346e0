//! One barrier: what arrives against what it can take, and how many it would stop at other heights and places.

use super::axis::Axis;
use super::canvas::{Canvas, Label, NORMAL, Pen, paint};
use super::colour::{BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{BarrierView, DesignView, Estimate, PlaceView, RockView, energy_unit};
use super::panel::MANY;
use super::panel::{FOOT_PX, Panel};
use super::svg::path::{PaperFrame, Spot};
use super::words::{Words, fill};
use plotters::style::RGBColor;

const TOP_PX: f64 = 26.0;
const CLOUD_PX: f64 = 210.0;
const CURVE_PX: f64 = 160.0;
/// Between a panel's axis title and the head of the next panel (px).
const GAP_PX: f64 = 34.0;
const RIGHT_PX: f64 = WIDTH_PX - 20.0;
/// Colours of other places, in the order of the scene; more places share the last.
const ELSEWHERE: [RGBColor; 4] = [ORANGE, PURPLE, SKY, GREY];

/// Draws the cloud and the two curves of sensitivity.
pub(super) fn draw(words: &Words, barrier: &BarrierView, number: usize) -> Drawing {
    let rocks = barrier.places.first().map_or(&[][..], |own| &own.rocks);
    let most_j = rocks.iter().map(|rock| rock.total_j).fold(barrier.capacity_j, f64::max);
    let (unit, size) = energy_unit(most_j);
    let cloud = cloud_panel(words, (barrier, rocks), (unit, size));
    let top = cloud.frame.bottom + FOOT_PX + GAP_PX;
    let (heights, places) = lower_panels(words, barrier, top);
    let bottom = heights.frame.bottom + FOOT_PX;
    let title = fill(words.barrier_name, &[("name", &barrier.name)]);
    let svg = paint(&format!("barrier-{number}"), (WIDTH_PX, bottom), &title, |canvas| {
        head(canvas, &cloud, words.barrier_cloud);
        draw_cloud(canvas, &cloud, (barrier, rocks, size), words);
        head(canvas, &heights, words.stopped_by_height);
        draw_heights(canvas, &heights, barrier);
        if let Some(places) = &places {
            head(canvas, places, words.stopped_by_place);
            draw_places(canvas, places, barrier);
        }
    });
    Drawing { svg, caption: caption(words, barrier, rocks.len()) }
}

/// What there is to say of a barrier that no rock reaches; none where one does.
pub(super) fn nobody(words: &Words, barrier: &BarrierView) -> Option<String> {
    let name = words.quoted(&barrier.name);
    (!barrier.is_met()).then(|| fill(words.nobody_barrier, &[("name", &name)]))
}

fn caption(words: &Words, barrier: &BarrierView, arriving: usize) -> String {
    let percentile = barrier.percentile.map_or(String::new(), |p| format!("P{p}"));
    let design = match barrier.design {
        Some(_) => words.barrier_design,
        None if barrier.design_lacks > 0 => words.barrier_no_design,
        None => "",
    };
    let lacks = format::decimal(barrier.design_lacks as f64, 0);
    let design = fill(design, &[("percentile", &percentile), ("n", &lacks)]);
    let weighs = if barrier.is_weighted() { words.barrier_weighted } else { "" };
    fill(
        words.barrier_caption,
        &[
            ("name", &words.quoted(&barrier.name)),
            ("rocks", &words.rocks(arriving)),
            ("design", &design),
            ("places", &if barrier.places.len() > 1 { words.barrier_places } else { "." }),
            ("weighs", &weighs),
        ],
    )
}

fn head(canvas: &Canvas<'_>, panel: &Panel, words: &str) {
    let at = (panel.frame.left, panel.frame.top - 10.0);
    canvas.text(&Label::new(words, at).bold().sized(NORMAL));
}

fn cloud_panel(
    words: &Words,
    (barrier, rocks): (&BarrierView, &[RockView]),
    (unit, size): (&str, f64),
) -> Panel {
    let reach = |at: &Estimate| 1.05 * [at.value, at.high].into_iter().fold(0.0, f64::max);
    let (design_m, design_j) =
        barrier.design.map_or((0.0, 0.0), |of| (reach(&of.height_m), reach(&of.energy_j)));
    let energies = rocks.iter().map(|rock| rock.total_j).chain([design_j]);
    let tops = rocks.iter().map(|rock| rock.top_m).filter(|top| top.is_finite());
    let tops = tops.chain([1.05 * barrier.height_m, design_m]);
    let frame = PaperFrame { left: 0.0, top: TOP_PX, right: RIGHT_PX, bottom: TOP_PX + CLOUD_PX };
    let mut panel = Panel::new(
        frame,
        Axis::energies_beside(
            energies.map(|joule| joule / size),
            1.05 * barrier.capacity_j / size,
            fill(words.energy_axis, &[("unit", &unit)]),
        ),
        Axis::from_zero(tops, words.top_axis),
    );
    panel.frame.left += panel.room_left();
    panel
}

fn draw_cloud(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (barrier, rocks, size): (&BarrierView, &[RockView], f64),
    words: &Words,
) {
    panel.grid(canvas);
    let edge = panel.at(barrier.capacity_j / size, barrier.height_m);
    let stopped = PaperFrame {
        left: panel.frame.left,
        right: edge.0,
        top: edge.1,
        bottom: panel.frame.bottom,
    };
    canvas.fill(&stopped, GREEN, 0.12);
    let spots: Vec<Spot> = rocks
        .iter()
        .map(|rock| panel.at(rock.total_j / size, rock.top_m))
        .filter(|&spot| panel.frame.holds(spot))
        .collect();
    canvas.dots(&spots, if spots.len() > MANY { 1.1 } else { 2.0 }, BLUE);
    canvas.outline(&stopped, Pen::full(GREEN, 1.6));
    let weak = rocks.iter().filter(|rock| rock.total_j / size < panel.x.low).count();
    panel.weaker(canvas, words, weak);
    if let Some(design) = barrier.design {
        draw_design(canvas, panel, (&design, size), words.design);
    }
    panel.axes(canvas);
    if rocks.is_empty() {
        panel.nothing(canvas, words.no_rock_arrives);
    }
}

/// The design as a diamond with the intervals of its energy and its height.
fn draw_design(canvas: &Canvas<'_>, panel: &Panel, (design, size): (&DesignView, f64), name: &str) {
    let (energy, height) = (design.energy_j.over(size), design.height_m);
    let (x, y) = panel.at(energy.value, height.value);
    let pen = Pen::full(VERMILLION, 1.4);
    let end = |of: &Estimate, bound: f64| if bound.is_finite() { bound } else { of.value };
    let across = [energy.low, energy.high].map(|at| (end(&energy, at), height.value));
    let up = [height.low, height.high].map(|at| (energy.value, end(&height, at)));
    panel.line(canvas, &across, pen);
    panel.line(canvas, &up, pen);
    canvas.polygon(&[(x, y - 6.0), (x + 6.0, y), (x, y + 6.0), (x - 6.0, y)], VERMILLION, 1.0);
    let at = |dx: f64, dy: f64| Label::new(name, (x + dx, y + dy)).coloured(INK);
    let places = [at(9.0, -11.0), at(-9.0, -11.0).right(), at(9.0, 12.0), at(-9.0, 12.0).right()];
    if let Some(label) = places.iter().find(|label| panel.frame.contains(&label.frame())) {
        canvas.text_on_rim(label);
    }
}

/// The panel over height, and beside it the one over places where the scene names some.
fn lower_panels(words: &Words, barrier: &BarrierView, top: f64) -> (Panel, Option<Panel>) {
    let (half, bottom) = (0.5 * WIDTH_PX, top + CURVE_PX);
    let has_places = barrier.places.len() > 1;
    let first = if has_places { RIGHT_PX - half + 4.0 } else { RIGHT_PX };
    let frame = |left: f64, right: f64| PaperFrame { left, top, right, bottom };
    let offsets = || barrier.places.iter().map(|place| place.offset_m);
    let reach = offsets().map(f64::abs).fold(1.0, f64::max);
    let (low, high) = offsets().fold((-0.2 * reach, 0.2 * reach), |(low, high), x| {
        (low.min(1.15 * x), high.max(1.15 * x))
    });
    let share = || Axis::linear(0.0, 104.0, words.stopped_axis);
    let placed = |frame: PaperFrame, x: Axis| {
        let mut panel = Panel::new(frame, x, share());
        panel.frame.left += panel.room_left();
        panel
    };
    let heights = Axis::linear(0.0, 2.0 * barrier.height_m, words.height_axis);
    let title = match barrier.left_is_uphill {
        Some(true) => words.offset_uphill,
        Some(false) => words.offset_downhill,
        None => words.offset_left,
    };
    let places = || Axis::linear(low, high, title);
    (
        placed(frame(0.0, first), heights),
        has_places.then(|| placed(frame(half, RIGHT_PX), places())),
    )
}

/// Share (%) of the rocks at a place, by what each stands for, that a barrier of every height stops, as a staircase.
fn staircase(barrier: &BarrierView, place: &PlaceView, most_m: f64) -> Vec<(f64, f64)> {
    let is_held = |rock: &&RockView| rock.total_j <= barrier.capacity_j && rock.top_m <= most_m;
    let mut held: Vec<&RockView> = place.rocks.iter().filter(is_held).collect();
    held.sort_by(|one, other| one.top_m.total_cmp(&other.top_m));
    let all: f64 = place.rocks.iter().map(|rock| rock.weight).sum();
    let mut stopped = 0.0;
    let mut points = vec![(0.0, 0.0)];
    for rock in held {
        let before = stopped;
        stopped += rock.weight;
        points.extend([before, stopped].map(|sum| (rock.top_m, 100.0 * sum / all)));
    }
    points.push((most_m, if stopped > 0.0 { 100.0 * stopped / all } else { 0.0 }));
    points
}

/// Pen of a place: 0 is the barrier's own, the others follow in the order of the scene.
fn pen_of(place: usize) -> Pen {
    let Some(other) = place.checked_sub(1) else { return Pen::full(BLUE, 1.8) };
    let pen = Pen::full(ELSEWHERE[other.min(ELSEWHERE.len() - 1)], 1.4);
    if other % 2 == 0 { pen.dashed() } else { pen.dotted() }
}

fn draw_heights(canvas: &Canvas<'_>, panel: &Panel, barrier: &BarrierView) {
    panel.grid(canvas);
    panel.upright(canvas, barrier.height_m, Pen::full(GREEN, 1.4));
    // its own place last, on top of the others
    for (k, place) in barrier.places.iter().enumerate().rev() {
        panel.line(canvas, &staircase(barrier, place, panel.x.high), pen_of(k));
    }
    panel.axes(canvas);
}

fn draw_places(canvas: &Canvas<'_>, panel: &Panel, barrier: &BarrierView) {
    panel.grid(canvas);
    for (k, place) in barrier.places.iter().enumerate() {
        let Some(stopped) = place.stopped else { continue };
        let at = |percent: f64| panel.at(place.offset_m, percent);
        canvas.line(&[at(stopped.low), at(stopped.high)], Pen::full(INK, 1.2));
        // its pen in the other panel: colours alone do not tell them apart
        let (x, y) = at(stopped.value);
        canvas.line(&[(x - 16.0, y), (x + 16.0, y)], pen_of(k));
        canvas.disc((x, y), 4.0, pen_of(k).colour);
    }
    panel.axes(canvas);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: of four rocks one stands for 7 of 10 events. It is the lowest: a barrier above its top holds 70 %, and one above
    /// the next 80 %; the last has more energy than any height holds.
    #[test]
    fn a_heavy_rock_counts_for_what_it_stands_for() {
        let rock = |top_m: f64, total_j: f64, weight: f64| RockView { top_m, total_j, weight };
        let rocks = vec![
            rock(2.0, 1.0, 1.0),
            rock(1.0, 1.0, 7.0),
            rock(9.0, 1.0, 1.0),
            rock(0.5, 99.0, 1.0),
        ];
        let place = PlaceView { offset_m: 0.0, arriving: 1.0, stopped: None, rocks };
        let barrier = BarrierView {
            name: "net".to_owned(),
            height_m: 3.0,
            capacity_j: 10.0,
            design: None,
            design_lacks: 0,
            percentile: None,
            left_is_uphill: None,
            places: vec![place],
        };
        let stairs = staircase(&barrier, &barrier.places[0], 6.0);
        let expected = [(0.0, 0.0), (1.0, 0.0), (1.0, 70.0), (2.0, 70.0), (2.0, 80.0), (6.0, 80.0)];
        assert_eq!(stairs.len(), expected.len());
        for (found, by_hand) in stairs.iter().zip(expected) {
            assert!(
                (found.0 - by_hand.0).abs() + (found.1 - by_hand.1).abs() < 1e-12,
                "{stairs:?}"
            );
        }
        let words = Words::of(crate::scene::Language::En);
        assert!(barrier.is_weighted() && caption(words, &barrier, 4).contains("weighted back"));
    }
}

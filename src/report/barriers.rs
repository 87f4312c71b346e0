//! One barrier: what arrives against what it can take, and how many it would stop at other heights and places.

use super::axis::Axis;
use super::canvas::{Canvas, Label, NORMAL, Pen, paint};
use super::colour::{BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{BarrierView, DesignView, Estimate, PlaceView, kilo};
use super::panel::{FOOT_PX, Panel};
use super::svg::path::{Frame, Spot};
use plotters::style::RGBColor;

const TOP_PX: f64 = 26.0;
const CLOUD_PX: f64 = 210.0;
const CURVE_PX: f64 = 160.0;
/// Between a panel's axis title and the head of the next panel (px).
const GAP_PX: f64 = 34.0;
const RIGHT_PX: f64 = WIDTH_PX - 20.0;
/// From so many rocks on, marks shrink to dots.
const MANY: usize = 400;
/// Colours of other places, in the order of the scene; more places share the last.
const ELSEWHERE: [RGBColor; 4] = [ORANGE, PURPLE, SKY, GREY];

/// Draws the cloud and the two curves of sensitivity.
pub(super) fn draw(barrier: &BarrierView, number: usize) -> Drawing {
    let rocks = barrier.places.first().map_or(&[][..], |own| &own.rocks);
    let most_j = rocks.iter().map(|rock| rock.1).fold(barrier.capacity_j, f64::max);
    let (unit, size) = kilo(most_j);
    let cloud = cloud_panel(barrier, rocks, (unit, size));
    let top = cloud.frame.bottom + FOOT_PX + GAP_PX;
    let (heights, places) = lower_panels(barrier, top);
    let bottom = heights.frame.bottom + FOOT_PX;
    let title = format!("Barrier {}", barrier.name);
    let svg = paint(&format!("barrier-{number}"), (WIDTH_PX, bottom), &title, |canvas| {
        head(canvas, &cloud, "Rocks that arrive, and what it can take");
        draw_cloud(canvas, &cloud, (barrier, rocks), size);
        head(canvas, &heights, "Stopped by height");
        draw_heights(canvas, &heights, barrier);
        if let Some(places) = &places {
            head(canvas, places, "Stopped by place");
            draw_places(canvas, places, barrier);
        }
    });
    Drawing { svg, caption: caption(barrier, rocks.len()) }
}

/// What there is to say of a barrier that no rock reaches; none where one does.
pub(super) fn nobody(barrier: &BarrierView) -> Option<String> {
    let is_met = barrier.places.iter().any(|place| !place.rocks.is_empty());
    (!is_met).then(|| format!("No rock arrives at barrier “{}”.", barrier.name))
}

fn caption(barrier: &BarrierView, arriving: usize) -> String {
    let percentile = barrier.percentile.map_or(String::new(), |p| format!("P{p}"));
    let design = match barrier.design {
        Some(_) => format!(
            " The diamond is the design of its rule, from {percentile} with its factors; its bars are 95 % intervals."
        ),
        None if barrier.design_lacks > 0 => format!(
            " No design value: {percentile} needs {} more {}.",
            barrier.design_lacks,
            format::counted(barrier.design_lacks, "rock that arrives", "rocks that arrive")
        ),
        None => String::new(),
    };
    let places = if barrier.places.len() > 1 {
        ", at its place (full) and at the other places of the scene. Below right: the same share at its own height against its \
         place, with Wilson's 95 % interval."
    } else {
        "."
    };
    format!(
        "Barrier “{}”: {} {}. Above: total energy and height of the highest point of each; inside the green frame it \
         stops them.{design} Below: share of the arriving rocks that a barrier of another height and the same capacity \
         would stop{places}",
        barrier.name,
        format::decimal(arriving as f64, 0),
        format::counted(arriving, "rock arrives", "rocks arrive")
    )
}

fn head(canvas: &Canvas<'_>, panel: &Panel, words: &str) {
    let at = (panel.frame.left, panel.frame.top - 10.0);
    canvas.text(&Label::new(words, at).bold().sized(NORMAL));
}

fn cloud_panel(barrier: &BarrierView, rocks: &[(f64, f64)], (unit, size): (&str, f64)) -> Panel {
    let reach = |at: &Estimate| 1.05 * [at.value, at.high].into_iter().fold(0.0, f64::max);
    let (design_m, design_j) =
        barrier.design.map_or((0.0, 0.0), |of| (reach(&of.height_m), reach(&of.energy_j)));
    let energies = rocks.iter().map(|rock| rock.1).chain([1.05 * barrier.capacity_j, design_j]);
    let tops = rocks.iter().map(|rock| rock.0).filter(|top| top.is_finite());
    let tops = tops.chain([1.05 * barrier.height_m, design_m]);
    let frame = Frame { left: 0.0, top: TOP_PX, right: RIGHT_PX, bottom: TOP_PX + CLOUD_PX };
    let mut panel = Panel::new(
        frame,
        Axis::energies(energies.map(|joule| joule / size), format!("Total energy ({unit})")),
        Axis::from_zero(tops, "Height of the highest point (m)"),
    );
    panel.frame.left += panel.room_left();
    panel
}

fn draw_cloud(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (barrier, rocks): (&BarrierView, &[(f64, f64)]),
    size: f64,
) {
    panel.grid(canvas);
    let edge = panel.at(barrier.capacity_j / size, barrier.height_m);
    let stopped =
        Frame { left: panel.frame.left, right: edge.0, top: edge.1, bottom: panel.frame.bottom };
    canvas.fill(&stopped, GREEN, 0.12);
    let spots: Vec<Spot> = rocks
        .iter()
        .map(|rock| panel.at(rock.1 / size, rock.0))
        .filter(|&spot| panel.frame.holds(spot))
        .collect();
    canvas.dots(&spots, if spots.len() > MANY { 1.1 } else { 2.0 }, BLUE);
    canvas.outline(&stopped, Pen::full(GREEN, 1.6));
    if let Some(design) = barrier.design {
        draw_design(canvas, panel, &design, size);
    }
    panel.axes(canvas);
    if rocks.is_empty() {
        panel.nothing(canvas, "no rock arrives");
    }
}

/// The design as a diamond with the intervals of its energy and its height.
fn draw_design(canvas: &Canvas<'_>, panel: &Panel, design: &DesignView, size: f64) {
    let (energy, height) = (design.energy_j.over(size), design.height_m);
    let (x, y) = panel.at(energy.value, height.value);
    let pen = Pen::full(VERMILLION, 1.4);
    let end = |of: &Estimate, bound: f64| if bound.is_finite() { bound } else { of.value };
    let across = [energy.low, energy.high].map(|at| (end(&energy, at), height.value));
    let up = [height.low, height.high].map(|at| (energy.value, end(&height, at)));
    panel.line(canvas, &across, pen);
    panel.line(canvas, &up, pen);
    canvas.polygon(&[(x, y - 6.0), (x + 6.0, y), (x, y + 6.0), (x - 6.0, y)], VERMILLION, 1.0);
    let at = |dx: f64, dy: f64| Label::new("design", (x + dx, y + dy)).coloured(INK);
    let places = [at(9.0, -11.0), at(-9.0, -11.0).right(), at(9.0, 12.0), at(-9.0, 12.0).right()];
    if let Some(label) = places.iter().find(|label| panel.frame.contains(&label.frame())) {
        canvas.text_on_rim(label);
    }
}

/// The panel over height, and beside it the one over places where the scene names some.
fn lower_panels(barrier: &BarrierView, top: f64) -> (Panel, Option<Panel>) {
    let (half, bottom) = (0.5 * WIDTH_PX, top + CURVE_PX);
    let has_places = barrier.places.len() > 1;
    let first = if has_places { RIGHT_PX - half + 4.0 } else { RIGHT_PX };
    let frame = |left: f64, right: f64| Frame { left, top, right, bottom };
    let offsets = || barrier.places.iter().map(|place| place.offset_m);
    let reach = offsets().map(f64::abs).fold(1.0, f64::max);
    let (low, high) = offsets().fold((-0.2 * reach, 0.2 * reach), |(low, high), x| {
        (low.min(1.15 * x), high.max(1.15 * x))
    });
    let share = || Axis::linear(0.0, 100.0, "Stopped (%)");
    let placed = |frame: Frame, x: Axis| {
        let mut panel = Panel::new(frame, x, share());
        panel.frame.left += panel.room_left();
        panel
    };
    let heights = Axis::linear(0.0, 2.0 * barrier.height_m, "Height (m)");
    let title = match barrier.left_is_uphill {
        Some(true) => "Distance from its place (m), uphill positive",
        Some(false) => "Distance from its place (m), downhill positive",
        None => "Distance from its place (m), left positive",
    };
    let places = || Axis::linear(low, high, title);
    (
        placed(frame(0.0, first), heights),
        has_places.then(|| placed(frame(half, RIGHT_PX), places())),
    )
}

/// Share (%) of the rocks at a place that a barrier of every height stops, as a staircase.
fn staircase(barrier: &BarrierView, place: &PlaceView, most_m: f64) -> Vec<(f64, f64)> {
    let held = place.rocks.iter().filter(|rock| rock.1 <= barrier.capacity_j && rock.0 <= most_m);
    let mut tops: Vec<f64> = held.map(|rock| rock.0).collect();
    tops.sort_by(f64::total_cmp);
    let percent = |count: usize| 100.0 * count as f64 / place.rocks.len().max(1) as f64;
    let steps =
        tops.iter().enumerate().flat_map(|(k, &top)| [(top, percent(k)), (top, percent(k + 1))]);
    [(0.0, 0.0)].into_iter().chain(steps).chain([(most_m, percent(tops.len()))]).collect()
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
        let stops = |rock: &&(f64, f64)| rock.0 <= barrier.height_m && rock.1 <= barrier.capacity_j;
        let share = crate::hazard::Proportion::new(
            place.rocks.iter().filter(stops).count(),
            place.rocks.len(),
        );
        if share.of == 0 {
            continue;
        }
        let at = |percent: f64| panel.at(place.offset_m, percent);
        canvas.line(&[at(100.0 * share.low_95), at(100.0 * share.high_95)], Pen::full(INK, 1.2));
        // its pen in the other panel: colours alone do not tell them apart
        let (x, y) = at(100.0 * share.share);
        canvas.line(&[(x - 16.0, y), (x + 16.0, y)], pen_of(k));
        canvas.disc((x, y), 4.0, pen_of(k).colour);
    }
    panel.axes(canvas);
}

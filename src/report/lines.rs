//! One evaluation line: where rocks pass, how high with how much energy, and how much is exceeded how often.

use super::axis::Axis;
use super::canvas::{Canvas, Label, NORMAL, Pen, SMALL, fitted, paint, text_width};
use super::colour::{BLUE, DARK_GREEN, GREEN, GREY, INK, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::histogram::{Histogram, percent_of};
use super::model::{BandPoint, Line, kilo};
use super::panel::{FOOT_PX, Panel, align};
use super::svg::path::{Frame, Spot};
use crate::hazard::INTENSITY_J;

const TOP_PX: f64 = 26.0;
const ALONG_PX: f64 = 104.0;
const CLOUD_PX: f64 = 196.0;
const CURVE_PX: f64 = 160.0;
/// Between a panel's axis title and the head of the next panel (px).
const GAP_PX: f64 = 34.0;
const RIGHT_PX: f64 = WIDTH_PX - 20.0;
/// From so many crossings on, marks shrink to dots.
const MANY: usize = 400;
/// Marked percentiles, the second one dashed.
const MARKED: [f64; 2] = [0.50, 0.95];

/// What there is to say of a line that no rock crosses; none where one does.
pub(super) fn nobody(line: &Line) -> Option<String> {
    line.crossings.is_empty().then(|| {
        format!(
            "No rock of {} crosses {} “{}”: its reach probability is below {} (95\u{2009}% confidence).",
            format::decimal(line.releases as f64, 0),
            if line.is_barrier { "the line of barrier" } else { "the line" },
            line.name,
            format::percent(line.reach.high, usize::from(line.reach.high < 0.1)),
        )
    })
}

/// Draws the line's panels: where, how high with how much energy, and the exceedance of both beside each other.
pub(super) fn draw(line: &Line) -> Drawing {
    let largest_j = line.crossings.iter().map(|at| at.total_j).fold(0.0, f64::max);
    let (unit, size) = kilo(largest_j);
    let alongs: Vec<f64> = line.crossings.iter().map(|at| at.along_m).collect();
    let bins = Histogram::of(&alongs);
    let (along, cloud) = upper_panels(line, &bins, (unit, size));
    let bottom = cloud.frame.bottom + FOOT_PX + GAP_PX + CURVE_PX + FOOT_PX;
    let curves = lower_panels(line, cloud.frame.bottom + FOOT_PX + GAP_PX, (unit, size));
    let title = format!("Evaluation line {}", line.name);
    let svg = paint(&format!("line-{}", line.number), (WIDTH_PX, bottom), &title, |canvas| {
        head(canvas, &along, "Where rocks pass");
        along.grid(canvas);
        bins.bars(canvas, &along, line.releases);
        along.axes(canvas);
        head(canvas, &cloud, "Height and energy at the first crossing");
        draw_cloud(canvas, &cloud, line, size);
        let behind = |of: fn(&super::model::Behind) -> &Vec<BandPoint>| {
            line.behind.as_ref().map(of).map(Vec::as_slice)
        };
        head(canvas, &curves[0], "Energy exceeded");
        let pair = (&line.energy_exceedance[..], behind(|at| &at.energy_exceedance));
        draw_curve(canvas, &curves[0], pair, size);
        intensities(canvas, &curves[0], size);
        head(canvas, &curves[1], "Height exceeded");
        let pair = (&line.height_exceedance[..], behind(|at| &at.height_exceedance));
        draw_curve(canvas, &curves[1], pair, 1.0);
        if line.behind.is_some() {
            key(canvas, &curves[1]);
        }
    });
    Drawing { svg, caption: caption(line) }
}

fn caption(line: &Line) -> String {
    let count = |n: usize| format::decimal(n as f64, 0);
    let crossing = line.crossings.len();
    let behind = line.behind.as_ref().map_or(String::new(), |behind| {
        format!(
            " Green, dashed: what is left behind {} (reach {}, {} to {}).",
            behind.barriers.join(", "),
            format::percent(behind.reach.value, 2),
            format::percent(behind.reach.low, 2),
            format::percent(behind.reach.high, 2)
        )
    });
    format!(
        "Line “{}”, {} m long: {} of {} releases {} it, {} of them more than once; all values at the first crossing, \
         on the parabola or the step that crosses. Above: share of releases per length of line, from its first corner. \
         Middle: vertical height of the lowest point and total energy, P50 full, P95 dashed. Below: share of all releases \
         that cross with more (conditional on release), with 95 % band; the Swiss limits of intensity are marked.{behind}",
        line.name,
        format::significant(line.length_m, 4),
        count(crossing),
        count(line.releases),
        format::counted(crossing, "crosses", "cross"),
        count(line.crossing_again)
    )
}

fn head(canvas: &Canvas<'_>, panel: &Panel, words: &str) {
    let at = (panel.frame.left, panel.frame.top - 10.0);
    canvas.text(&Label::new(words, at).bold().sized(NORMAL));
}

fn upper_panels(line: &Line, bins: &Histogram, (unit, size): (&str, f64)) -> (Panel, Panel) {
    let tallest = percent_of(bins.largest(), line.releases);
    let shares = Axis::from_zero([1.05 * tallest], "Releases (%)");
    let frame =
        |top: f64, height: f64| Frame { left: 0.0, top, right: RIGHT_PX, bottom: top + height };
    let mut along = Panel::new(
        frame(TOP_PX, ALONG_PX),
        Axis::linear(0.0, line.length_m, "Along the line (m)"),
        shares,
    );
    let energies = line.crossings.iter().map(|at| at.total_j / size);
    let heights = line.crossings.iter().map(|at| above(at.height_m));
    let mut cloud = Panel::new(
        frame(TOP_PX + ALONG_PX + FOOT_PX + GAP_PX, CLOUD_PX),
        Axis::energies(energies, format!("Total energy ({unit})")),
        Axis::from_zero(heights, "Height (m)"),
    );
    align([&mut along, &mut cloud]);
    (along, cloud)
}

fn lower_panels(line: &Line, top: f64, (unit, size): (&str, f64)) -> [Panel; 2] {
    let least = 0.8 / line.releases.max(10) as f64;
    let panel = |k: usize, x: Axis| {
        let half = 0.5 * WIDTH_PX;
        let frame = Frame {
            left: k as f64 * half,
            top,
            right: RIGHT_PX - (1 - k) as f64 * (half - 4.0),
            bottom: top + CURVE_PX,
        };
        let y = Axis::log(least, line.reach.high.clamp(10.0 * least, 1.0), "Share of releases");
        let mut panel = Panel::new(frame, x, y);
        panel.frame.left += panel.room_left();
        panel
    };
    let energies = line.energy_exceedance.iter().map(|p| p.x / size);
    let heights = line.height_exceedance.iter().map(|p| p.x);
    [
        panel(0, Axis::energies(energies, format!("Total energy ({unit})"))),
        panel(1, Axis::from_zero(heights, "Height (m)")),
    ]
}

fn draw_cloud(canvas: &Canvas<'_>, panel: &Panel, line: &Line, size: f64) {
    panel.grid(canvas);
    let spots: Vec<Spot> = line
        .crossings
        .iter()
        .map(|at| panel.at(at.total_j / size, above(at.height_m)))
        .filter(|&spot| panel.frame.holds(spot))
        .collect();
    canvas.dots(&spots, if spots.len() > MANY { 1.1 } else { 2.0 }, BLUE);
    for probability in MARKED {
        let pen = Pen::full(VERMILLION, 1.2);
        let pen = if probability < 0.9 { pen } else { pen.dashed() };
        let of = |list: &[super::model::Quantile]| {
            let found = list.iter().find(|q| (q.probability - probability).abs() < 1e-9);
            found.map(|q| q.at.value).filter(|value| value.is_finite())
        };
        let words = format!("P{:.0}", 100.0 * probability);
        if let Some(energy) = of(&line.energy_quantiles) {
            panel.upright(canvas, energy / size, pen);
            let at = panel.at(energy / size, panel.y.high);
            name(canvas, panel, &words, [(at.0 + 3.0, at.1 + 9.0), (at.0 - 24.0, at.1 + 9.0)]);
        }
        if let Some(height) = of(&line.height_quantiles) {
            panel.line(canvas, &[(panel.x.low, height), (panel.x.high, height)], pen);
            let (x, y) = panel.at(panel.x.high, height.max(0.0));
            name(canvas, panel, &words, [(x - 26.0, y - 8.0), (x - 26.0, y + 9.0)]);
        }
    }
    panel.axes(canvas);
}

/// A height without what a rock presses into the ground; NaN where there is no ground.
fn above(height_m: f64) -> f64 {
    if height_m < 0.0 { 0.0 } else { height_m }
}

/// Writes a word at the first place that is free.
fn name(canvas: &Canvas<'_>, panel: &Panel, words: &str, places: [Spot; 2]) {
    let labels = places.map(|at| Label::new(words, at).coloured(INK));
    let free =
        |label: &&Label| panel.frame.contains(&label.frame()) && canvas.is_free(&label.frame());
    if let Some(label) = labels.iter().find(free) {
        canvas.text_on_rim(label);
    }
}

/// A curve with its band, and the one behind barriers over it.
fn draw_curve(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (without, with): (&[BandPoint], Option<&[BandPoint]>),
    size: f64,
) {
    panel.grid(canvas);
    for (curve, fill, pen) in [
        (Some(without), SKY, Pen::full(BLUE, 1.6)),
        (with, GREEN, Pen::full(DARK_GREEN, 1.6).dashed()),
    ] {
        let Some(curve) = curve else { continue };
        let shown = curve.iter().filter(|p| !panel.x.is_log || p.x > 0.0);
        let band: Vec<(f64, f64, f64)> =
            shown.clone().map(|p| (p.x / size, p.y.low, p.y.high)).collect();
        panel.band(canvas, &band, fill, 0.25);
        let line: Vec<(f64, f64)> =
            shown.map(|p| (p.x / size, p.y.value)).filter(|&(_, y)| y > 0.0).collect();
        panel.line(canvas, &line, pen);
    }
    panel.axes(canvas);
}

/// The limits between weak, medium and strong.
fn intensities(canvas: &Canvas<'_>, panel: &Panel, size: f64) {
    for limit in INTENSITY_J {
        panel.upright(canvas, limit / size, Pen::full(GREY, 0.8).dotted());
        let (x, y) = panel.at(limit / size, panel.y.high);
        let words = format!("{:.0}\u{2009}kJ", limit / 1e3);
        name(
            canvas,
            panel,
            &words,
            [(x + 3.0, y + 9.0), (x - text_width(&words, SMALL) - 3.0, y + 9.0)],
        );
    }
}

fn key(canvas: &Canvas<'_>, panel: &Panel) {
    let y = panel.frame.top - 9.0;
    let mut right = panel.frame.right;
    for (words, pen) in
        [("with barriers", Pen::full(DARK_GREEN, 1.6).dashed()), ("without", Pen::full(BLUE, 1.6))]
    {
        canvas.text(&Label::new(words, (right, y)).right().coloured(GREY));
        let end = right - text_width(words, SMALL) - 5.0;
        canvas.line(&[(end - 18.0, y), (end, y)], pen);
        right = end - 26.0;
    }
}

/// Draws the retention curve over all lines: which share of the releases passes each of them.
pub(super) fn retention(lines: &[Line]) -> Drawing {
    let rows = lines.len() as f64;
    let row_px = 28.0;
    let longest = 0.36 * WIDTH_PX;
    let names: Vec<String> = lines.iter().map(|line| fitted(&line.name, SMALL, longest)).collect();
    let widest = names.iter().map(|name| text_width(name, SMALL)).fold(0.0, f64::max);
    let frame = Frame {
        left: widest + 14.0,
        top: 8.0,
        right: WIDTH_PX - 150.0,
        bottom: 8.0 + row_px * rows,
    };
    let ends = lines.iter().flat_map(|line| [line.reach.value, line.reach.high]);
    // the axis ends where the longest bar and its interval do
    let most = Axis::from_zero(ends.map(|share| 100.0 * share), "").high.min(100.0);
    let panel = Panel::new(
        frame,
        Axis::linear(0.0, most, "Releases that cross (%)"),
        Axis::linear(0.0, rows, ""),
    );
    let svg = paint("retention", (WIDTH_PX, frame.bottom + FOOT_PX), "Retention", |canvas| {
        panel.grid_upright(canvas);
        for (k, line) in lines.iter().enumerate() {
            let y = frame.top + row_px * (k as f64 + 0.5);
            bar(canvas, &panel, (line, &names[k]), y);
        }
        canvas.outline(&frame, Pen::full(INK, 0.8));
        panel.x_axis(canvas);
    });
    let caption = "Reach probability at each line, conditional on release, with Wilson's 95 % interval, from the highest line down. \
                   Light: without barriers; green, where rocks meet a barrier before: what is left by it. What is missing between \
                   two lines one behind the other has stayed there.";
    Drawing { svg, caption: caption.to_owned() }
}

fn bar(canvas: &Canvas<'_>, panel: &Panel, (line, name): (&Line, &str), y: f64) {
    let frame = panel.frame;
    let at = |share: f64| panel.at((100.0 * share).clamp(0.0, panel.x.high), 0.0).0;
    let behind = line.behind.as_ref().map(|behind| behind.reach);
    let rows = [(Some(line.reach), SKY, -7.0), (behind, GREEN, 1.0)];
    for (reach, colour, top) in rows {
        let Some(reach) = reach else { continue };
        let tall = if behind.is_some() { 7.0 } else { 14.0 };
        let bar = Frame {
            left: frame.left,
            right: at(reach.value),
            top: y + top,
            bottom: y + top + tall,
        };
        canvas.fill(&bar, colour, 1.0);
        let middle = 0.5 * (bar.top + bar.bottom);
        canvas.line(&[(at(reach.low), middle), (at(reach.high), middle)], Pen::full(INK, 1.2));
    }
    canvas.text(&Label::new(name, (frame.left - 6.0, y)).right());
    let words = format::percent(line.reach.value, 1);
    let left =
        behind.map_or(String::new(), |reach| format!("left: {}", format::percent(reach.value, 1)));
    canvas.text(&Label::new(words, (frame.right + 6.0, y)).followed_by(left));
}

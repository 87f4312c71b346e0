//! One evaluation line: where rocks pass, how high with how much energy, and how much is exceeded how often.

use super::axis::Axis;
use super::colour::{BLUE, INK, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::histogram::{Histogram, percent_of};
use super::input::{BandPoint, Line, energy_unit};
use super::panel::{FOOT_PX, Panel, align};
use super::paper::{Label, NORMAL, Paper, Pen, SMALL, paint};
use super::svg::path::{Frame, Spot};

const TOP_PX: f64 = 26.0;
const ALONG_PX: f64 = 104.0;
const CLOUD_PX: f64 = 196.0;
const CURVE_PX: f64 = 150.0;
/// Between a panel's axis title and the head of the next panel (px).
const GAP_PX: f64 = 34.0;
const RIGHT_PX: f64 = WIDTH_PX - 14.0;
/// From so many crossings on, marks shrink to dots.
const MANY: usize = 400;
/// Marked percentiles, the second one dashed.
const MARKED: [f64; 2] = [0.50, 0.95];

/// Draws the line's three panels and the exceedance of energy and height beside each other.
pub(super) fn draw(line: &Line, number: usize) -> Drawing {
    let largest_j = line.crossings.iter().map(|at| at.total_j).fold(0.0, f64::max);
    let (unit, size) = energy_unit(largest_j);
    let alongs: Vec<f64> = line.crossings.iter().map(|at| at.along_m).collect();
    let bins = Histogram::of(&alongs);
    let (along, cloud) = upper_panels(line, &bins, (unit, size));
    let bottom = cloud.frame.bottom + FOOT_PX + GAP_PX + CURVE_PX + FOOT_PX;
    let curves = lower_panels(line, cloud.frame.bottom + FOOT_PX + GAP_PX, (unit, size));
    let title = format!("Evaluation line {}", line.name);
    let svg = paint(&format!("line-{number}"), (WIDTH_PX, bottom), &title, |paper| {
        head(paper, &along, "Where rocks pass");
        along.grid(paper);
        bins.bars(paper, &along, line.releases);
        along.axes(paper);
        head(paper, &cloud, "Height and energy at the first crossing");
        draw_cloud(paper, &cloud, line, size);
        head(paper, &curves[0], "Energy exceeded");
        draw_curve(paper, &curves[0], &line.energy_exceedance, size);
        head(paper, &curves[1], "Height exceeded");
        draw_curve(paper, &curves[1], &line.height_exceedance, 1.0);
        if line.crossings.is_empty() {
            along.nothing(paper, "no rock crosses this line");
        }
    });
    Drawing { svg, caption: caption(line) }
}

fn caption(line: &Line) -> String {
    let count = |n: usize| format::decimal(n as f64, 0);
    format!(
        "Line “{}”, {} m long: {} of {} releases cross it, {} of them more than once; all values at the first crossing, \
         on the parabola or the step that crosses. Above: share of releases per length of line, from its first corner. \
         Middle: vertical height of the lowest point and total energy, P50 full, P95 dashed. Below: share of the rocks \
         that cross with more, with 95 % band.",
        line.name,
        format::significant(line.length_m, 4),
        count(line.crossings.len()),
        count(line.releases),
        count(line.crossing_again)
    )
}

fn head(paper: &Paper<'_>, panel: &Panel, words: &str) {
    let at = (panel.frame.left, panel.frame.top - 10.0);
    paper.text(&Label::new(words, at).bold().sized(NORMAL));
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
    let heights = line.crossings.iter().map(|at| at.height_m);
    let mut cloud = Panel::new(
        frame(TOP_PX + ALONG_PX + FOOT_PX + GAP_PX, CLOUD_PX),
        Axis::from_zero(energies, format!("Total energy ({unit})")),
        Axis::from_zero(heights, "Height (m)"),
    );
    align([&mut along, &mut cloud]);
    (along, cloud)
}

fn lower_panels(line: &Line, top: f64, (unit, size): (&str, f64)) -> [Panel; 2] {
    let least = 1.0 / line.crossings.len().max(10) as f64;
    let panel = |k: usize, values: Vec<f64>, title: String| {
        let half = 0.5 * WIDTH_PX;
        let frame = Frame {
            left: k as f64 * half,
            top,
            right: RIGHT_PX - (1 - k) as f64 * (half - 4.0),
            bottom: top + CURVE_PX,
        };
        let y = Axis::log(least, 1.0, "Share exceeding");
        let mut panel = Panel::new(frame, Axis::from_zero(values, title), y);
        panel.frame.left += panel.room_left();
        panel
    };
    let energies = line.energy_exceedance.iter().map(|p| p.x / size).collect();
    let heights = line.height_exceedance.iter().map(|p| p.x).collect();
    [panel(0, energies, format!("Total energy ({unit})")), panel(1, heights, "Height (m)".into())]
}

fn draw_cloud(paper: &Paper<'_>, panel: &Panel, line: &Line, size: f64) {
    panel.grid(paper);
    let spots: Vec<Spot> = line
        .crossings
        .iter()
        .map(|at| panel.at(at.total_j / size, at.height_m))
        .filter(|&spot| panel.frame.holds(spot))
        .collect();
    paper.dots(&spots, if spots.len() > MANY { 1.1 } else { 2.0 }, BLUE);
    for probability in MARKED {
        let pen = Pen::full(VERMILLION, 1.2);
        let pen = if probability < 0.9 { pen } else { pen.dashed() };
        let of = |list: &[super::input::Quantile]| {
            let found = list.iter().find(|q| (q.probability - probability).abs() < 1e-9);
            found.map(|q| q.at.value).filter(|value| value.is_finite())
        };
        if let Some(energy) = of(&line.energy_quantiles) {
            panel.upright(paper, energy / size, pen);
            let at = panel.at(energy / size, panel.y.high);
            let words = format!("P{:.0}", 100.0 * probability);
            paper.text_on_rim(&Label::new(words, (at.0 + 3.0, at.1 + 8.0)).coloured(INK));
        }
        if let Some(height) = of(&line.height_quantiles) {
            panel.line(paper, &[(panel.x.low, height), (panel.x.high, height)], pen);
        }
    }
    panel.axes(paper);
}

fn draw_curve(paper: &Paper<'_>, panel: &Panel, curve: &[BandPoint], size: f64) {
    panel.grid(paper);
    let band: Vec<(f64, f64, f64)> =
        curve.iter().map(|p| (p.x / size, p.y.low, p.y.high)).collect();
    panel.band(paper, &band, SKY, 0.35);
    let shown: Vec<(f64, f64)> =
        curve.iter().map(|p| (p.x / size, p.y.value)).filter(|&(_, y)| y > 0.0).collect();
    panel.line(paper, &shown, Pen::full(BLUE, 1.6));
    panel.axes(paper);
    if curve.is_empty() {
        panel.nothing(paper, "no crossing");
    }
}

/// Draws the retention curve over all lines: which share of the releases passes each of them.
pub(super) fn retention(lines: &[Line]) -> Drawing {
    let rows = lines.len() as f64;
    let row_px = 26.0;
    let widest = lines
        .iter()
        .map(|line| super::paper::text_width(&line.name, SMALL))
        .fold(0.0, f64::max)
        .min(0.4 * WIDTH_PX);
    let frame = Frame {
        left: widest + 14.0,
        top: 8.0,
        right: WIDTH_PX - 60.0,
        bottom: 8.0 + row_px * rows,
    };
    let panel = Panel::new(
        frame,
        Axis::linear(0.0, 100.0, "Releases that cross (%)"),
        Axis::linear(0.0, rows, ""),
    );
    let svg = paint("retention", (WIDTH_PX, frame.bottom + FOOT_PX), "Retention", |paper| {
        panel.grid_upright(paper);
        for (k, line) in lines.iter().enumerate() {
            let y = frame.top + row_px * (k as f64 + 0.5);
            let at = |share: f64| panel.at(100.0 * share.clamp(0.0, 1.0), 0.0).0;
            let bar = Frame {
                left: frame.left,
                right: at(line.reach.value),
                top: y - 7.0,
                bottom: y + 7.0,
            };
            paper.fill(&bar, SKY, 1.0);
            paper.line(&[(at(line.reach.low), y), (at(line.reach.high), y)], Pen::full(INK, 1.3));
            paper.text(&Label::new(line.name.clone(), (frame.left - 6.0, y)).right());
            let words = format::percent(line.reach.value, 1);
            paper.text(&Label::new(words, (frame.right + 6.0, y)));
        }
        paper.outline(&frame, Pen::full(INK, 0.8));
        panel.x_axis(paper);
    });
    let caption = "Reach probability at each line, conditional on release, with Wilson's 95 % interval. Of lines one \
                   behind the other this is the retention curve: what is missing between two of them has stayed there.";
    Drawing { svg, caption: caption.to_owned() }
}

//! One evaluation line: where rocks pass, how high with how much energy, and how much is exceeded how often.

mod marks;

use super::axis::Axis;
use super::bound::Is;
use super::by_frequency;
use super::canvas::{Canvas, Label, NORMAL, Pen, SMALL, fitted_among, paint, text_width};
use super::colour::{BLUE, DARK_GREEN, GREEN, GREY, INK, SKY};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::histogram::EqualBins;
use super::model::{BandPoint, Estimate, ReportLine, energy_unit};
use super::panel::MANY;
use super::panel::{FOOT_PX, Panel, align};
use super::svg::path::{PaperFrame, Spot};
use super::words::{Words, fill};
use crate::hazard::INTENSITY_J;
use marks::{name, percentiles};

const TOP_PX: f64 = 26.0;
const ALONG_PX: f64 = 84.0;
const CLOUD_PX: f64 = 172.0;
const CURVE_PX: f64 = 150.0;
/// Between a panel's axis title and the head of the next panel (px).
const GAP_PX: f64 = 30.0;
/// Room of the key above the heads of the lower panels (px).
const KEY_PX: f64 = 18.0;
const RIGHT_PX: f64 = WIDTH_PX - 20.0;
/// Heights up to here at least are shown (m), or up to the radius of the smallest rock: rocks that only roll are not drawn as if they
/// leapt.
const LEAST_M: f64 = 0.1;

/// What there is to say of a line that no rock crosses; none where one does.
pub(super) fn nobody(words: &Words, line: &ReportLine) -> Option<String> {
    let what = if line.is_barrier { words.the_line_of_barrier } else { words.the_line };
    let below = format::percent_at_most(line.reach.high);
    let nobody = if line.reach.high >= 1.0 && line.reach.is == Is::AtLeast {
        words.drawn().nobody_open.to_owned()
    } else if line.reach.high >= 1.0 {
        words.drawn().nobody_untold.to_owned()
    } else if line.is_weighted {
        words.say(by_frequency::NOBODY)
    } else {
        words.nobody_line.to_owned()
    };
    let said = fill(
        &nobody,
        &[
            ("n", &format::decimal(line.releases as f64, 0)),
            ("what", &what),
            ("name", &words.quoted(&line.name)),
            ("share", &below),
        ],
    );
    (!line.is_met()).then_some(said)
}

/// Draws the line's panels: where, how high with how much energy, and the exceedance of both beside each other.
pub(super) fn draw(words: &Words, line: &ReportLine) -> Drawing {
    let largest_j = line.crossings.iter().map(|at| at.total_j).fold(0.0, f64::max);
    let (unit, size) = energy_unit(largest_j);
    let alongs: Vec<_> = line.crossings.iter().map(|at| (at.along_m, at.weight)).collect();
    let mut bins = EqualBins::of(&alongs);
    bins.all = line.releases as f64;
    let (along, cloud) = upper_panels(words, line, &bins, (unit, size));
    let key_px = if line.behind.is_some() { KEY_PX } else { 0.0 };
    let top = cloud.frame.bottom + FOOT_PX + GAP_PX + key_px;
    let bottom = top + CURVE_PX + FOOT_PX;
    let curves = lower_panels((words, line), top, (unit, size));
    let title = fill(words.line_title, &[("name", &line.name)]);
    let svg = paint(&format!("line-{}", line.number), (WIDTH_PX, bottom), &title, |canvas| {
        head(canvas, &along, words.where_pass);
        along.grid(canvas);
        bins.bars(canvas, &along);
        along.axes(canvas);
        head(canvas, &cloud, words.first_crossing);
        draw_cloud(canvas, &cloud, (line, size), words);
        let behind = |of: fn(&super::model::Behind) -> &Vec<BandPoint>| {
            line.behind.as_ref().map(of).map(Vec::as_slice)
        };
        head(canvas, &curves[0], words.energy_exceeded);
        let pair = (&line.energy_exceedance[..], behind(|at| &at.energy_exceedance));
        draw_curve(canvas, &curves[0], pair, size);
        intensities(canvas, &curves[0], line, size);
        head(canvas, &curves[1], words.height_exceeded);
        let pair = (&line.height_exceedance[..], behind(|at| &at.height_exceedance));
        draw_curve(canvas, &curves[1], pair, 1.0);
        if line.behind.is_some() {
            key(canvas, &curves[0], words);
        }
    });
    let is_shown = |limit: &f64| (curves[0].x.low..=curves[0].x.high).contains(&(limit / size));
    let limits = if INTENSITY_J.iter().any(is_shown) { words.drawn().swiss_limits } else { "" };
    Drawing { svg, caption: caption(words, line, (bins.width, limits)) }
}

fn caption(words: &Words, line: &ReportLine, (bin_m, limits): (f64, &str)) -> String {
    let count = |n: usize| format::decimal(n as f64, 0);
    let behind = line.behind.as_ref().map_or(String::new(), |behind| {
        let at = behind.reach;
        let [reach, low, high] = format::percents([at.value, at.low, at.high], |_| 2);
        fill(
            words.line_behind,
            &[
                ("barriers", &behind.barriers.join(", ")),
                ("reach", &format!("{}{reach}", format::sign(at.is))),
                ("low", &low),
                ("high", &high),
            ],
        )
    });
    let caption = fill(
        words.line_caption,
        &[
            ("name", &words.quoted(&line.name)),
            ("length", &format::significant(line.length_m, 4)),
            ("crossing", &count(line.crossings.len())),
            ("releases", &count(line.releases)),
            ("again", &count(line.crossing_again)),
            ("bin", &format::plain(bin_m)),
        ],
    );
    let note = line.is_weighted.then_some(by_frequency::CURVES);
    by_frequency::noted(caption + limits + &behind, note, words)
}

fn head(canvas: &Canvas<'_>, panel: &Panel, words: &str) {
    let at = (panel.frame.left, panel.frame.top - 10.0);
    canvas.text(&Label::new(words, at).bold().sized(NORMAL));
}

fn least_m(line: &ReportLine) -> f64 {
    LEAST_M.min(line.least_radius_m)
}

fn upper_panels(
    words: &Words,
    line: &ReportLine,
    bins: &EqualBins,
    (unit, size): (&str, f64),
) -> (Panel, Panel) {
    let shares = Axis::from_zero([1.05 * bins.tallest()], words.releases_percent);
    let frame = |top: f64, height: f64| PaperFrame {
        left: 0.0,
        top,
        right: RIGHT_PX,
        bottom: top + height,
    };
    let mut along = Panel::new(
        frame(TOP_PX, ALONG_PX),
        Axis::linear(0.0, line.length_m, words.line_axis),
        shares,
    );
    let energies = line.crossings.iter().map(|at| at.total_j / size);
    let heights = line.crossings.iter().map(|at| above(at.height_m));
    let mut cloud = Panel::new(
        frame(TOP_PX + ALONG_PX + FOOT_PX + GAP_PX, CLOUD_PX),
        Axis::energies(energies, fill(words.energy_axis, &[("unit", &unit)])),
        Axis::from_zero(heights.chain([least_m(line)]), words.height_axis),
    );
    align([&mut along, &mut cloud]);
    (along, cloud)
}

fn lower_panels(
    (words, line): (&Words, &ReportLine),
    top: f64,
    (unit, size): (&str, f64),
) -> [Panel; 2] {
    let least = 0.8 / line.releases.max(10) as f64;
    let panel = |k: usize, x: Axis| {
        let half = 0.5 * WIDTH_PX;
        let frame = PaperFrame {
            left: k as f64 * half,
            top,
            right: RIGHT_PX - (1 - k) as f64 * (half - 4.0),
            bottom: top + CURVE_PX,
        };
        let y = Axis::log(least, line.reach.high.clamp(10.0 * least, 1.0), words.share_of_releases);
        let mut panel = Panel::new(frame, x, y);
        panel.frame.left += panel.room_left();
        panel
    };
    let energies = line.energy_exceedance.iter().map(|p| p.x / size);
    let heights = line.height_exceedance.iter().map(|p| p.x).chain([least_m(line)]);
    [
        panel(0, Axis::energies(energies, fill(words.energy_axis, &[("unit", &unit)]))),
        panel(1, Axis::from_zero(heights, words.height_axis)),
    ]
}

fn draw_cloud(canvas: &Canvas<'_>, panel: &Panel, (line, size): (&ReportLine, f64), words: &Words) {
    panel.grid(canvas);
    let spots: Vec<Spot> = line
        .crossings
        .iter()
        .map(|at| panel.at(at.total_j / size, above(at.height_m)))
        .filter(|&spot| panel.frame.holds(spot))
        .collect();
    canvas.dots(&spots, if spots.len() > MANY { 1.1 } else { 2.0 }, BLUE);
    let weak = line.crossings.iter().filter(|at| at.total_j / size < panel.x.low).count();
    panel.weaker(canvas, words, weak);
    percentiles(canvas, panel, line, size);
    panel.axes(canvas);
}

/// A height without what a rock presses into the ground; NaN where there is no ground.
fn above(height_m: f64) -> f64 {
    if height_m < 0.0 { 0.0 } else { height_m }
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

/// The limits between weak, medium and strong, each named beside its line where no curve runs.
fn intensities(canvas: &Canvas<'_>, panel: &Panel, line: &ReportLine, size: f64) {
    let behind = line.behind.iter().map(|behind| &behind.energy_exceedance);
    let curves = std::iter::once(&line.energy_exceedance).chain(behind).map(|curve| {
        let shown = curve.iter().filter(|p| p.x > 0.0 && p.y.value > 0.0);
        shown.map(|p| panel.at(p.x / size, p.y.value)).collect()
    });
    let curves: Vec<Vec<Spot>> = curves.collect();
    let (top, bottom) = (panel.frame.top + 9.0, panel.frame.bottom - 9.0);
    for limit in INTENSITY_J {
        panel.upright(canvas, limit / size, Pen::full(GREY, 0.8).dotted());
        let (x, _) = panel.at(limit / size, panel.y.high);
        let words = format!("{:.0}\u{2009}kJ", limit / 1e3);
        let before = x - text_width(&words, SMALL) - 3.0;
        let places = [(x + 3.0, top), (before, top), (x + 3.0, bottom), (before, bottom)];
        name(canvas, panel, (&words, &places), &curves);
    }
}

/// Both pens, in a line of their own above the heads: names are long in some languages.
fn key(canvas: &Canvas<'_>, panel: &Panel, words: &Words) {
    let y = panel.frame.top - 10.0 - KEY_PX;
    let mut x = panel.frame.left;
    for (name, pen) in [
        (words.without_barriers, Pen::full(BLUE, 1.6)),
        (words.with_barriers, Pen::full(DARK_GREEN, 1.6).dashed()),
    ] {
        canvas.line(&[(x, y), (x + 20.0, y)], pen);
        canvas.text(&Label::new(name, (x + 25.0, y)).coloured(GREY));
        x += 25.0 + text_width(name, SMALL) + 20.0;
    }
}

/// Draws the retention curve over all lines: which share of the releases passes each of them.
pub(super) fn retention(lines: &[ReportLine], words: &Words) -> Drawing {
    let rows = lines.len() as f64;
    let row_px = 28.0;
    let longest = 0.36 * WIDTH_PX;
    let all = || lines.iter().map(|line| line.name.as_str());
    let names = all().map(|name| fitted_among(name, all(), (SMALL, longest)));
    let names: Vec<String> = names.collect();
    let widest = names.iter().map(|name| text_width(name, SMALL)).fold(0.0, f64::max);
    let shares: Vec<Label> = lines.iter().map(|line| reach_in_words(line, words)).collect();
    let room = shares.iter().map(Label::width_px).fold(0.0, f64::max) + 10.0;
    let frame = PaperFrame {
        left: widest + 14.0,
        top: 8.0,
        right: WIDTH_PX - room.max(150.0),
        bottom: 8.0 + row_px * rows,
    };
    let ends = lines.iter().flat_map(|line| [line.reach.value, line.reach.high]);
    // the axis ends where the longest bar and its interval do
    let most = Axis::from_zero(ends.map(|share| 100.0 * share), "").high.min(100.0);
    let panel = Panel::new(
        frame,
        Axis::linear(0.0, most, words.retention_axis),
        Axis::linear(0.0, rows, ""),
    );
    let svg = paint("retention", (WIDTH_PX, frame.bottom + FOOT_PX), words.retention, |canvas| {
        panel.grid_upright(canvas);
        for (k, line) in lines.iter().enumerate() {
            let y = frame.top + row_px * (k as f64 + 0.5);
            bar(canvas, &panel, (line, &names[k], y));
            canvas.text(&shares[k].clone().moved((frame.right + 6.0, y)));
        }
        canvas.outline(&frame, Pen::full(INK, 0.8));
        panel.x_axis(canvas);
    });
    let is_any = lines.iter().any(|line| line.arriving.is_some());
    let colours = if is_any { words.retention_colours } else { "" };
    Drawing { svg, caption: format!("{}{colours}", words.retention_caption) }
}

/// The share that reaches a line, and what is left of it behind barriers; a lower bound has its sign.
fn reach_in_words(line: &ReportLine, words: &Words) -> Label {
    let said = |reach: &Estimate| {
        let all = [reach.value, reach.low, reach.high];
        let [share, low, high] = format::percents(all, decimals_shown);
        format!("{}{share} ({})", format::sign(reach.is), words.interval(&low, &high))
    };
    // its interval is drawn: written too, it would leave the bars no room beside long names
    let alone = |share: Estimate| said(&share).split(" (").next().unwrap_or_default().to_owned();
    let left = line.arriving.map(|share| fill(words.left, &[("share", &alone(share))]));
    Label::new(said(&line.reach), (0.0, 0.0)).followed_by(left.unwrap_or_default())
}

fn bar(canvas: &Canvas<'_>, panel: &Panel, (line, name, y): (&ReportLine, &str, f64)) {
    let frame = panel.frame;
    let at = |share: f64| panel.at((100.0 * share).clamp(0.0, panel.x.high), 0.0).0;
    let rows = [(Some(line.reach), SKY, -7.0), (line.arriving, GREEN, 1.0)];
    for (reach, colour, top) in rows {
        let Some(reach) = reach else { continue };
        let tall = if line.arriving.is_some() { 7.0 } else { 14.0 };
        let bar = PaperFrame {
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
}

/// Decimals of a share in per cent that show a digit that is not 0, however small it is.
fn decimals_shown(share: f64) -> usize {
    match share {
        small if small > 0.0 && small < 1e-4 => 4,
        small if small > 0.0 && small < 1e-3 => 3,
        small if small > 0.0 && small < 1e-2 => 2,
        _ => 1,
    }
}

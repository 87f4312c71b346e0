//! Maps in the report: how likely rocks come, with what intensity, energy and height, and where they stay.

mod year;

pub(super) use year::draw as draw_year;

use super::axis::{Axis, round_step};
use super::canvas::{
    Canvas, Label, NORMAL, Pen, SMALL, bold_width, fitted, fitted_among, paint, text_width,
};
use super::colour::{self, INK, ORANGE, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{CellMap, MapMark, Report, energy_unit};
use super::panel::{FOOT_PX, Panel, with_room};
use super::plan_view::ground::Shaded;
use super::profile::NEEDS;
use super::site::{self, names::Names};
use super::svg::path::{PaperFrame, Spot};
use super::words::fill;
use super::words::open::missing;
use crate::math;
use plotters::style::RGBColor;

const TOP_PX: f64 = 24.0;
/// Height of one line of a title (px).
const TITLE_LINE_PX: f64 = 14.0;
/// Least gap between the titles of two maps (px).
const TITLE_GAP_PX: f64 = 6.0;
/// Height of one line of a key (px).
const KEY_PX: f64 = 16.0;
/// Gap between the key of the colours and that of the numbers (px).
const KEY_GAP_PX: f64 = 4.0;
/// Least side of a cell in which rocks lie (px): most of them are alone, and a finer one is not seen.
const DEPOSIT_PX: f64 = 2.4;
const TALLEST_PX: f64 = 300.0;
/// Upper ends of the classes of a share of the releases (–).
const SHARES: [f64; 5] = [0.001, 0.01, 0.1, 0.3, 1.0];
/// Colours of the Swiss classes: weak, medium, strong.
const INTENSITY: [RGBColor; 3] = [SKY, ORANGE, VERMILLION];
/// Classes of a map of values: the scale is read at a glance.
const CLASSES: usize = 5;

/// One map: its cells by class, and what the classes are called.
struct ClassedMap {
    title: String,
    cells: Vec<(u32, usize)>,
    classes: Vec<(String, RGBColor)>,
    /// Least side of a cell on paper (px).
    least_px: f64,
}

impl ClassedMap {
    /// Shares of the releases in fixed classes.
    fn of_shares(title: &str, values: &[(u32, f64)]) -> Self {
        let class = |value: f64| SHARES.iter().position(|limit| value <= *limit);
        let name = |limit: f64| format!("≤\u{2009}{}", format::plain(100.0 * limit));
        let classes = SHARES.iter().enumerate();
        Self {
            title: format!("{title} (%)"),
            cells: values.iter().map(|&(cell, v)| (cell, class(v).unwrap_or(4))).collect(),
            classes: classes.map(|(k, limit)| (name(*limit), shade(k))).collect(),
            least_px: 0.0,
        }
    }

    /// Swiss classes.
    fn of_intensity(title: &str, values: &[(u32, f64)]) -> Self {
        let names = ["< 30\u{2009}kJ", "30–300\u{2009}kJ", "> 300\u{2009}kJ"];
        Self {
            title: title.to_owned(),
            cells: values.iter().map(|&(cell, class)| (cell, class as usize - 1)).collect(),
            classes: names.iter().zip(INTENSITY).map(|(n, c)| ((*n).to_owned(), c)).collect(),
            least_px: 0.0,
        }
    }

    /// Values in classes that grow from one to the next, the last one reaching the largest: a few large values do not leave
    /// all others in one class.
    fn of_values(
        title: &str,
        values: &[(u32, f64)],
        (unit, size): (&str, f64),
        steps: &[f64],
    ) -> Self {
        let most = values.iter().map(|(_, v)| v / size).fold(0.0, f64::max);
        let mut ends = [round_step(most, steps); CLASSES];
        for k in (0..CLASSES - 1).rev() {
            // just below the class above
            ends[k] = largest_below(ends[k + 1], steps);
        }
        let class = |v: f64| {
            ends.iter().position(|end| v / size <= end * (1.0 + 1e-9)).unwrap_or(CLASSES - 1)
        };
        let name = |k: usize| format!("≤\u{2009}{}", format::plain(math::rounded(ends[k], 3)));
        Self {
            title: format!("{title} ({unit})"),
            cells: values.iter().map(|&(cell, v)| (cell, class(v))).collect(),
            classes: (0..CLASSES).map(|k| (name(k), shade(k))).collect(),
            least_px: 0.0,
        }
    }

    /// Counts in classes that grow threefold.
    fn of_counts(title: &str, values: &[(u32, f64)]) -> Self {
        let ends = [1.0, 3.0, 10.0, 30.0];
        let class = |v: f64| ends.iter().position(|end| v <= *end).unwrap_or(ends.len());
        let names = ["1", "2–3", "4–10", "11–30", "> 30"];
        Self {
            title: title.to_owned(),
            cells: values.iter().map(|&(cell, v)| (cell, class(v))).collect(),
            classes: names.iter().enumerate().map(|(k, n)| ((*n).to_owned(), shade(k))).collect(),
            least_px: DEPOSIT_PX,
        }
    }
}

/// The largest of some mantissas (1 first, rising) times a power of ten that is below a value of this kind.
fn largest_below(value: f64, mantissas: &[f64]) -> f64 {
    let power = math::pow(10.0, math::log10(value).floor());
    let below = mantissas.iter().rev().map(|mantissa| mantissa * power);
    let last = mantissas.last().copied().unwrap_or(1.0);
    below.into_iter().find(|b| *b < value * (1.0 - 1e-9)).unwrap_or(0.1 * last * power)
}

/// Colour of one of [`CLASSES`].
fn shade(class: usize) -> RGBColor {
    colour::sequential(class as f64 / (CLASSES - 1) as f64)
}

/// Draws all maps but those of a year: over one ground, each part of which is shaded once.
pub(super) fn draw(report: &Report, maps: &CellMap) -> [Drawing; 3] {
    let ground = report.ground.as_ref().map(Shaded::over);
    [draw_reach, draw_values, draw_ends].map(|draw| draw(report, maps, ground.as_ref()))
}

/// Draws reach probability and intensity beside each other.
fn draw_reach(report: &Report, maps: &CellMap, ground: Option<&Shaded>) -> Drawing {
    let words = report.words();
    let layers = [
        ClassedMap::of_shares(words.map_reach, &maps.reach),
        ClassedMap::of_intensity(words.map_intensity, &maps.intensity),
    ];
    let svg = draw_layers("maps", words.maps_alt, (report, maps, ground), &layers);
    let share = |count: usize| {
        let all: usize = maps.intensity_cells.iter().sum();
        format::percent_of_part(count as f64 / all.max(1) as f64, 0)
    };
    let [weak, medium, strong] = maps.intensity_cells.map(share);
    let caption = fill(
        words.maps_caption,
        &[
            ("cell", &format::plain(maps.cell_m / f64::from(maps.joined.max(1)))),
            ("weak", &weak),
            ("medium", &medium),
            ("strong", &strong),
        ],
    );
    let joined = fill(words.maps_joined, &[("n", &maps.joined)]);
    let joined = if maps.joined > 1 { joined } else { String::new() };
    Drawing { svg, caption: caption + &joined + &lacks(report, maps) }
}

/// What a 95th percentile of few rocks is worth, and which rocks are missing; nothing where nothing lacks.
fn lacks(report: &Report, maps: &CellMap) -> String {
    let all: usize = maps.intensity_cells.iter().sum();
    let share = format::percent_of_part(maps.few_cells as f64 / all.max(1) as f64, 0);
    let few = fill(report.words().maps_few, &[("share", &share), ("needs", &NEEDS)]);
    let few = if maps.few_cells == 0 { String::new() } else { few };
    few + &open(report, maps)
}

/// Rocks that would have gone on into other cells; nothing where none would.
fn open(report: &Report, maps: &CellMap) -> String {
    missing(report.words().open().on_maps, maps.open.as_ref())
}

/// Draws energy and height beside each other.
fn draw_values(report: &Report, maps: &CellMap, ground: Option<&Shaded>) -> Drawing {
    let words = report.words();
    let most_j = maps.energy_j.iter().map(|(_, v)| *v).fold(0.0, f64::max);
    let layers = [
        ClassedMap::of_values(words.map_energy, &maps.energy_j, energy_unit(most_j), &[1.0, 3.0]),
        ClassedMap::of_values(words.map_height, &maps.height_m, ("m", 1.0), &[1.0, 2.0, 5.0]),
    ];
    let svg = draw_layers("maps-values", words.map_values_alt, (report, maps, ground), &layers);
    Drawing { svg, caption: words.map_values_caption.to_owned() + &lacks(report, maps) }
}

/// Draws deposits and the probability of more than a weak intensity beside each other.
fn draw_ends(report: &Report, maps: &CellMap, ground: Option<&Shaded>) -> Drawing {
    let words = report.words();
    let layers = [
        ClassedMap::of_counts(words.map_deposits, &maps.deposits),
        ClassedMap::of_shares(words.map_exceeds, &maps.exceeds),
    ];
    let svg = draw_layers("maps-ends", words.map_ends_alt, (report, maps, ground), &layers);
    Drawing { svg, caption: words.map_ends_caption.to_owned() + &open(report, maps) }
}

fn draw_layers(
    name: &str,
    title: &str,
    (report, maps, ground): (&Report, &CellMap, Option<&Shaded>),
    layers: &[ClassedMap],
) -> String {
    let (panels, bottom) = panels(report, maps, layers);
    let all = || report.marks.iter().map(|mark| mark.name.as_str());
    let said = |mark: &MapMark, width: f64| fitted_among(&mark.name, all(), (SMALL, width));
    let corner = |panel: &Panel| (panel.frame.left, panel.frame.top);
    let (left, first_top) = panels.first().map_or((0.0, 0.0), corner);
    // all panels have one extent and scale: names stand in all as in the first
    let names = panels.first().map(|panel| Names::of(panel, report, &said)).unwrap_or_default();
    let marks = panels
        .first()
        .map_or_else(Default::default, |panel| names.key((panel, report), &said, WIDTH_PX - left));
    let height = marks.height_px();
    let room = if height > 0.0 { height + KEY_GAP_PX } else { 0.0 };
    paint(name, (WIDTH_PX, bottom + room), title, |canvas| {
        marks.draw(canvas, (left, bottom + KEY_GAP_PX));
        for (k, (panel, layer)) in panels.iter().zip(layers).enumerate() {
            let (x, y) = corner(panel);
            let title = title_lines(&layer.title, x);
            for (line, words) in title.iter().rev().enumerate() {
                let at = (x, y - 9.0 - TITLE_LINE_PX * line as f64);
                canvas.text(&Label::new(words.clone(), at).bold().sized(NORMAL));
            }
            let names = names.moved((x - left, y - first_top));
            names.keep(canvas);
            canvas.clip(&format!("part{k}"), &panel.frame, || {
                if let Some(shaded) = ground {
                    shaded.draw(canvas, panel);
                }
                for (class, (_, colour)) in layer.classes.iter().enumerate() {
                    cells(canvas, panel, maps, (layer, class), *colour);
                }
                site::zones(canvas, panel, report);
                site::marks(canvas, panel, report);
                names.write(canvas);
            });
            if layer.cells.is_empty() {
                site::beside_marks(canvas, panel, report, report.words().no_rock);
            } else {
                key(canvas, panel, layer);
            }
            panel.axes(canvas);
        }
    })
}

/// A title within its half of the sheet, on a second line where the first has no room for its end, which holds the unit.
fn title_lines(title: &str, left_px: f64) -> Vec<String> {
    let half = 0.5 * WIDTH_PX;
    let room = half - left_px.rem_euclid(half) - TITLE_GAP_PX;
    let has_room = |words: &str| bold_width(words, NORMAL) <= room;
    if has_room(title) {
        return vec![title.to_owned()];
    }
    let breaks = title.rmatch_indices(' ').map(|(at, _)| title.split_at(at));
    let (first, rest) =
        breaks.into_iter().find(|(first, _)| has_room(first)).unwrap_or((title, ""));
    let wider = bold_width(title, NORMAL) / text_width(title, NORMAL).max(1.0);
    [first, rest.trim_start()]
        .into_iter()
        .filter(|words| !words.is_empty())
        .map(|words| fitted(words, NORMAL, room / wider.max(1.0)))
        .collect()
}

/// Equal frames over all cells reached, two beside each other, at equal scale; and the height of the sheet.
fn panels(report: &Report, maps: &CellMap, layers: &[ClassedMap]) -> (Vec<Panel>, f64) {
    let first = with_room(|left| panel_beside(report, maps, left));
    let (width, height) = (first.frame.width(), first.frame.height());
    let mut panels = Vec::new();
    let mut top = TOP_PX;
    for row in layers.chunks(2) {
        let title = |layer: &ClassedMap| title_lines(&layer.title, first.frame.left).len();
        let lines = row.iter().map(title).max().unwrap_or(1);
        top += TITLE_LINE_PX * (lines - 1) as f64;
        for beside in [0.0, 0.5 * WIDTH_PX].into_iter().take(row.len()) {
            let left = beside + first.frame.left;
            let frame = PaperFrame { left, top, right: left + width, bottom: top + height };
            panels.push(Panel::new(frame, first.x.clone(), first.y.clone()));
        }
        let lines = row.iter().map(|layer| key_places(layer, width).1).max().unwrap_or(1);
        top += height + FOOT_PX + 6.0 + lines as f64 * KEY_PX + TOP_PX + 4.0;
    }
    (panels, top - TOP_PX)
}

/// The upper left frame with so much room on its left (px).
fn panel_beside(report: &Report, maps: &CellMap, left: f64) -> Panel {
    let words = report.words();
    let (mut x, mut y) = maps.extent();
    // half of the last label of an axis stands beside its frame
    let beside = 0.5 * text_width(&format::decimal(x.1, 0), SMALL);
    let width = 0.5 * WIDTH_PX - left - beside.max(8.0);
    let scale = (width / (x.1 - x.0)).min(TALLEST_PX / (y.1 - y.0));
    // a slender map is given some ground beside it
    let more = 0.5 * (width / scale - (x.1 - x.0)).max(0.0);
    x = (x.0 - more, x.1 + more);
    let least = 0.5 * (150.0 / scale - (y.1 - y.0)).max(0.0);
    y = (y.0 - least, y.1 + least);
    let bottom = TOP_PX + scale * (y.1 - y.0);
    let frame = PaperFrame { left, top: TOP_PX, right: left + width, bottom };
    let [across, up] = [(x, words.easting), (y, words.northing)]
        .map(|((low, high), title)| Axis::linear(low, high, title));
    Panel::new(frame, across, up)
}

/// The cells of one class; neighbours in a row are one rectangle.
fn cells(
    canvas: &Canvas<'_>,
    panel: &Panel,
    maps: &CellMap,
    (layer, class): (&ClassedMap, usize),
    colour: RGBColor,
) {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for &(cell, _) in layer.cells.iter().filter(|(_, of)| *of == class) {
        match runs.last_mut() {
            Some((first, count))
                if *first + *count == cell && cell / maps.columns == *first / maps.columns =>
            {
                *count += 1;
            }
            _ => runs.push((cell, 1)),
        }
    }
    let half_m = 0.5 * maps.cell_m;
    let corners = |(first, count): (u32, u32)| -> (Spot, Spot) {
        let ((x0, y), (x1, _)) = (maps.centre_m(first), maps.centre_m(first + count - 1));
        (panel.at(x0 - half_m, y + half_m), panel.at(x1 + half_m, y - half_m))
    };
    let bars: Vec<(Spot, Spot)> =
        runs.into_iter().map(corners).map(|ends| at_least(ends, layer.least_px)).collect();
    canvas.group(r#"opacity="0.8""#, || canvas.rectangles(&bars, colour));
}

/// A rectangle about the same middle whose sides are not shorter than this (px).
fn at_least(((x0, y0), (x1, y1)): (Spot, Spot), least_px: f64) -> (Spot, Spot) {
    let more = |from: f64, to: f64| 0.5 * (least_px - (to - from).abs()).max(0.0);
    let (dx, dy) = (more(x0, x1), more(y0, y1));
    ((x0 - dx, y0 - dy), (x1 + dx, y1 + dy))
}

/// Where each entry of a key stands, from the left end and by line, and how many lines there are.
fn key_places(layer: &ClassedMap, width_px: f64) -> (Vec<(f64, usize)>, usize) {
    let (mut x, mut line) = (0.0, 0);
    let mut places = Vec::new();
    for (name, _) in &layer.classes {
        let width = 13.0 + text_width(name, SMALL);
        if x > 0.0 && x + width > width_px {
            (x, line) = (0.0, line + 1);
        }
        places.push((x, line));
        x += width + 9.0;
    }
    (places, line + 1)
}

fn key(canvas: &Canvas<'_>, panel: &Panel, layer: &ClassedMap) {
    let top = panel.frame.bottom + FOOT_PX + 6.0;
    let (places, _) = key_places(layer, panel.frame.width());
    for ((name, colour), (x, line)) in layer.classes.iter().zip(places) {
        let (x, y) = (panel.frame.left + x, top + (line as f64 + 0.5) * KEY_PX);
        let patch = PaperFrame { left: x, right: x + 10.0, top: y - 5.0, bottom: y + 5.0 };
        canvas.fill(&patch, *colour, 0.8);
        canvas.outline(&patch, Pen::full(INK, 0.4));
        canvas.text(&Label::new(name.clone(), (x + 13.0, y)));
    }
}

//! Hillshade, contours and trees of the map.

use crate::math;
use crate::report::axis::round_step;
use crate::report::canvas::{Canvas, Label, Pen, text_width};
use crate::report::colour::{GREEN, GREY, WHITE};
use crate::report::contour::Field;
use crate::report::format;
use crate::report::hillshade;
use crate::report::panel::Panel;
use crate::report::raster::GroundRaster;
use crate::report::svg::path::{PaperFrame, Spot, clipped, thinned};
use plotters::style::RGBColor;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Distance of the places where heights are taken for contours (px).
const GRID_PX: f64 = 2.0;
/// Contours aimed at across the relief of the map.
const CONTOURS: f64 = 22.0;
/// Steps that readers of maps expect: no 2.5.
const CONTOUR_STEPS: [f64; 3] = [1.0, 2.0, 5.0];
/// Every so many contours one is heavy and labelled.
const INDEX_EVERY: i64 = 5;
/// Contours shorter than this are noise of the mesh (px).
const SHORTEST_PX: f64 = 14.0;
/// Least distance between two labels (px).
const LABELS_APART_PX: f64 = 90.0;
/// Size of the heights on contours (px).
const LABEL_PX: f64 = 9.0;
/// Stems smaller than this are drawn as discs (px).
const SMALL_STEM_PX: f64 = 4.0;
const LINE: RGBColor = RGBColor(122, 104, 84);

/// What the map says about its contours.
pub(in crate::report) struct Contours {
    pub(super) interval_m: f64,
    labels: Vec<(Spot, f64, String)>,
}

impl Contours {
    /// Heights on the index contours, upright to read.
    pub(super) fn labels(&self, canvas: &Canvas<'_>) {
        for (at, degrees, text) in &self.labels {
            let label = Label::new(text.clone(), *at).centred().sized(LABEL_PX).coloured(LINE);
            canvas.text_turned(&label, *degrees);
        }
    }
}

/// Draws everything below the paths; heights are written off the spots to be avoided.
pub(in crate::report) fn draw(
    canvas: &Canvas<'_>,
    panel: &Panel,
    ground: &GroundRaster,
    avoided: &[Spot],
) -> Option<Contours> {
    canvas.fragment(&picture(panel, ground));
    let contours = contours((canvas, avoided), panel, ground);
    trees(canvas, panel, ground, GREEN);
    contours
}

/// The ground under several maps. Most of them show the same part of it at the same place of their sheets: packing that picture is
/// most of what a short report costs, and is done once.
pub(in crate::report) struct Shaded<'g> {
    ground: &'g GroundRaster,
    pictures: RefCell<Vec<(Place, String)>>,
}

/// All that a picture of the ground depends on: its frame on paper, and the ends of both axes.
type Place = (PaperFrame, [f64; 4]);

impl<'g> Shaded<'g> {
    pub(in crate::report) fn over(ground: &'g GroundRaster) -> Self {
        Self { ground, pictures: RefCell::default() }
    }

    /// Draws the shape of the ground and its trees, without contours.
    pub(in crate::report) fn draw(&self, canvas: &Canvas<'_>, panel: &Panel) {
        let place = (panel.frame, [panel.x.low, panel.x.high, panel.y.low, panel.y.high]);
        let mut pictures = self.pictures.borrow_mut();
        let at = pictures.iter().position(|(known, _)| *known == place).unwrap_or_else(|| {
            pictures.push((place, picture(panel, self.ground)));
            pictures.len() - 1
        });
        canvas.fragment(&pictures[at].1);
        // cells of a map are green too
        trees(canvas, panel, self.ground, GREY);
    }
}

fn picture(panel: &Panel, ground: &GroundRaster) -> String {
    hillshade::image(&panel.frame, |x, y| slope(panel, ground, (x, y)))
}

/// Map coordinates of a place on the paper (m).
fn on_map(panel: &Panel, (x, y): Spot) -> (f64, f64) {
    let (right, up) = (
        (x - panel.frame.left) / panel.frame.width(),
        (panel.frame.bottom - y) / panel.frame.height(),
    );
    (
        panel.x.low + right * (panel.x.high - panel.x.low),
        panel.y.low + up * (panel.y.high - panel.y.low),
    )
}

/// Rise to the east and to the north per metre, across one cell.
fn slope(panel: &Panel, ground: &GroundRaster, at: Spot) -> (f64, f64) {
    let (x, y) = on_map(panel, at);
    let half = 0.5 * ground.cell_m;
    let across = |dx: f64, dy: f64| {
        let (up, down) = (ground.height_at(x + dx, y + dy), ground.height_at(x - dx, y - dy));
        (up - down) / ground.cell_m
    };
    (across(half, 0.0), across(0.0, half))
}

fn contours(
    (canvas, avoided): (&Canvas<'_>, &[Spot]),
    panel: &Panel,
    ground: &GroundRaster,
) -> Option<Contours> {
    let frame = &panel.frame;
    let size = ((frame.width() / GRID_PX) as usize + 2, (frame.height() / GRID_PX) as usize + 2);
    let field = Field::sample((frame.left, frame.top), GRID_PX, size, |x, y| {
        let (x, y) = on_map(panel, (x, y));
        ground.height_at(x, y)
    });
    let finite = field.values.iter().copied().filter(|z| z.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| (a.min(z), b.max(z)));
    // ground that is flat to a thousandth of the map has no contours worth drawing
    // (without any ground the difference is −∞)
    if high - low <= 1e-3 * (panel.x.high - panel.x.low) {
        return None;
    }
    let interval_m = round_step((high - low) / CONTOURS, &CONTOUR_STEPS);
    let mut labels = Vec::new();
    for i in (low / interval_m).ceil() as i64..=(high / interval_m).floor() as i64 {
        let level_m = i as f64 * interval_m;
        let lines: Vec<Vec<Spot>> = field
            .lines_at(just_below(level_m, interval_m))
            .iter()
            .flat_map(|line| clipped(line, frame))
            .filter(|line| length(line) > SHORTEST_PX)
            .map(|line| thinned(&line, 0.2))
            .collect();
        let is_index = i % INDEX_EVERY == 0;
        let pen = Pen { opacity: 0.75, ..Pen::full(LINE, if is_index { 0.9 } else { 0.4 }) };
        let lines = if is_index {
            let decimals = (-math::log10(interval_m).floor()).max(0.0) as usize;
            let text = format::decimal(level_m, decimals);
            let before = labels.len();
            label_lines((canvas, panel, avoided), &lines, &text, &mut labels);
            // a line does not run through its own label
            let radius = 0.5 * text_width(&text, LABEL_PX) + 2.0;
            labels[before..].iter().fold(lines, |lines, (at, ..)| outside(&lines, *at, radius))
        } else {
            lines
        };
        canvas.lines(&lines, pen);
    }
    Some(Contours { interval_m, labels })
}

/// Where the line of a level is drawn: lower by less than can be seen. Level ground at the very height would else be cut up by the
/// rounding of its heights, which are in single precision.
fn just_below(level_m: f64, interval_m: f64) -> f64 {
    let rounding_m = 4.0 * f64::from(f32::EPSILON) * level_m.abs();
    level_m - rounding_m.max(1e-3 * interval_m)
}

fn length(line: &[Spot]) -> f64 {
    line.windows(2).map(|s| math::hypot(s[1].0 - s[0].0, s[1].1 - s[0].1)).sum()
}

/// The parts of some lines outside a circle.
fn outside(lines: &[Vec<Spot>], at: Spot, radius: f64) -> Vec<Vec<Spot>> {
    let mut parts: Vec<Vec<Spot>> = Vec::new();
    for line in lines {
        let mut part: Vec<Spot> = Vec::new();
        for pair in line.windows(2) {
            for (a, b) in pieces_outside(pair[0], pair[1], at, radius) {
                if part.last() != Some(&a) {
                    parts.push(std::mem::replace(&mut part, vec![a]));
                }
                part.push(b);
            }
        }
        parts.push(part);
    }
    parts.retain(|part| part.len() > 1);
    parts
}

/// What a circle leaves of a segment.
fn pieces_outside(a: Spot, b: Spot, at: Spot, radius: f64) -> Vec<(Spot, Spot)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (ex, ey) = (a.0 - at.0, a.1 - at.1);
    // |a + t (b − a) − at|² = radius²
    let (p, q) = (dx * dx + dy * dy, ex * dx + ey * dy);
    let root2 = q * q - p * (ex * ex + ey * ey - radius * radius);
    if p == 0.0 || root2 <= 0.0 {
        return vec![(a, b)];
    }
    let (enter, leave) = ((-q - root2.sqrt()) / p, (-q + root2.sqrt()) / p);
    let on = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    let first = (enter > 0.0).then(|| (a, if enter < 1.0 { on(enter) } else { b }));
    let second = (leave < 1.0 && enter < 1.0).then(|| (if leave > 0.0 { on(leave) } else { a }, b));
    match (first, second) {
        (Some(first), Some(second)) if first.1 == b || second.0 == a => vec![(a, b)],
        (first, second) => first.into_iter().chain(second).collect(),
    }
}

/// Puts one label on each long line, at its longest straight piece that is far from other labels and from the frame.
fn label_lines(
    (canvas, panel, avoided): (&Canvas<'_>, &Panel, &[Spot]),
    lines: &[Vec<Spot>],
    text: &str,
    labels: &mut Vec<(Spot, f64, String)>,
) {
    for line in lines.iter().filter(|line| length(line) > LABELS_APART_PX) {
        let middle = |s: &[Spot]| (0.5 * (s[0].0 + s[1].0), 0.5 * (s[0].1 + s[1].1));
        let is_free = |at: Spot| {
            let frame = &panel.frame;
            let from_edge = (at.0 - frame.left)
                .min(frame.right - at.0)
                .min(at.1 - frame.top)
                .min(frame.bottom - at.1);
            let nearest = labels.iter().map(|(p, ..)| math::hypot(p.0 - at.0, p.1 - at.1));
            let half = 0.5 * text_width(text, LABEL_PX);
            let room = PaperFrame {
                left: at.0 - half,
                right: at.0 + half,
                top: at.1 - half,
                bottom: at.1 + half,
            };
            canvas.is_free(&room)
                && !avoided.iter().any(|spot| room.holds(*spot))
                && from_edge > half + 4.0
                && nearest.fold(f64::INFINITY, f64::min) > LABELS_APART_PX
        };
        let free = line.windows(2).filter(|&s| is_free(middle(s)));
        let best = free.max_by(|a, b| length(a).total_cmp(&length(b)));
        if let Some(piece) = best {
            let rise = math::atan2(piece[1].1 - piece[0].1, piece[1].0 - piece[0].0).to_degrees();
            // text must not stand on its head
            let degrees = if rise.abs() > 90.0 { rise - 180.0 * rise.signum() } else { rise };
            labels.push((middle(piece), degrees, text.to_owned()));
        }
    }
}

/// Stems: discs where they are small on paper, outlines where they are large.
fn trees(canvas: &Canvas<'_>, panel: &Panel, ground: &GroundRaster, colour: RGBColor) {
    let cell_px = ground.cell_m / (panel.x.high - panel.x.low) * panel.frame.width();
    let mut discs: BTreeMap<u32, Vec<Spot>> = BTreeMap::new();
    let mut large = vec![false; ground.trees.len()];
    for patch in ground.tree_patches() {
        let diameter_px = 2.0 * (patch.len() as f64 / std::f64::consts::PI).sqrt() * cell_px;
        if diameter_px > SMALL_STEM_PX && patch.len() > 9 {
            for &cell in &patch {
                large[cell] = true;
            }
            continue;
        }
        let (x, y) = ground.centroid_m(&patch);
        let spot = panel.at(x, y);
        if panel.frame.holds(spot) {
            // a cell that a stem only touches counts as a whole one: the disc is drawn a little smaller
            let radius_px = (0.4 * diameter_px).clamp(1.1, 6.0);
            discs.entry((radius_px * 10.0).round() as u32).or_default().push(spot);
        }
    }
    for (tenths, spots) in &discs {
        canvas.dots(spots, f64::from(*tenths) / 10.0 + 0.5, WHITE);
        canvas.dots(spots, f64::from(*tenths) / 10.0, colour);
    }
    outlines((canvas, panel), ground, &large, colour);
}

fn outlines(
    (canvas, panel): (&Canvas<'_>, &Panel),
    ground: &GroundRaster,
    large: &[bool],
    colour: RGBColor,
) {
    if !large.contains(&true) {
        return;
    }
    // a rim of empty cells closes every outline
    let size = (ground.columns + 2, ground.rows() + 2);
    let value = |column: f64, row: f64| {
        let inside = (0.0..ground.columns as f64).contains(&column) && row >= 0.0;
        let index = row * ground.columns as f64 + column;
        f64::from(u8::from(inside && large.get(index as usize) == Some(&true)))
    };
    let field = Field::sample((-1.0, -1.0), 1.0, size, value);
    for line in field.lines_at(0.5) {
        let place = |&(column, row): &Spot| {
            let east = ground.west_m + (column + 0.5) * ground.cell_m;
            panel.at(east, ground.south_m + (row + 0.5) * ground.cell_m)
        };
        let outline: Vec<Spot> = line.iter().map(place).collect();
        if outline.iter().any(|&spot| panel.frame.holds(spot)) {
            canvas.polygon(&outline, colour, 0.85);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A terrace at a round height, with heights off by rounding, between a slope above and one below: one line, along its edge.
    #[test]
    fn a_terrace_at_the_height_of_a_contour_has_one_line() {
        let noise = |x: f64, y: f64| {
            f64::from(f32::EPSILON) * 100.0 * (0.5 - f64::from((x + y) as i32 % 2))
        };
        let terrace =
            |x: f64, y: f64| 100.0 + noise(x, y) + (x - 20.0).max(0.0) + (x - 10.0).min(0.0);
        let field = Field::sample((0.0, 0.0), 1.0, (31, 31), terrace);
        assert!(field.lines_at(100.0).len() > 10, "the noise is there");
        let lines = field.lines_at(just_below(100.0, 5.0));
        assert_eq!(lines.len(), 1);
        assert!(lines[0].iter().all(|(x, _)| (x - 10.0).abs() < 0.01), "{lines:?}");
    }
}

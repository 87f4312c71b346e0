//! The map: ground, trees, paths coloured by speed, where rocks are released and stay, lines and barriers.

mod furniture;
pub(super) mod ground;

use super::axis::Axis;
use super::canvas::{Canvas, Pen, paint};
use super::colour::{self, BLUE, DARK_VERMILLION, ORANGE, PURPLE, VERMILLION, WHITE};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::model::{MapMark, Report};
use super::panel::MANY;
use super::panel::TOLERANCE_PX;
use super::panel::{FOOT_PX, Panel};
use super::site::{self, names::Names};
use super::svg::path::{PaperFrame, Spot, clipped, thinned};
use super::words::fill;
use crate::math;
use crate::simulation::Stop;
use std::collections::{BTreeMap, BTreeSet};

/// Tallest map (px): beside the numbers of all rocks its words can be read on the first page of A4.
const TALLEST_PX: f64 = 460.0;
/// Widest map (px), for the same reason.
const WIDEST_PX: f64 = 400.0;
/// Left edge of the key (px).
const KEY_LEFT_PX: f64 = 6.0;
/// Narrowest sheet (px): room for the key.
const NARROWEST_PX: f64 = 360.0;
/// Least height of a map (px): room for the colour bar.
const LOWEST_PX: f64 = 190.0;
/// Column right of the map for north arrow and colour bar (px).
const RIGHT_PX: f64 = 84.0;
/// Least extent of a map over that of the ground (–): rocks that lie still are seen where they lie.
const LEAST: f64 = 0.05;
/// Least upper end of the speed scale (m/s): what only settles is not drawn as if it moved.
const SLOWEST_M_S: f64 = 0.1;
/// Paper around what is shown, as a share of its size.
const MARGIN: f64 = 0.06;
/// How far beside the rocks lines and barriers are followed, as a share of the size of what is shown.
const BESIDE: f64 = 0.3;
/// Side of a square of deposits (px), and rocks in it from which it is drawn with each opacity.
const DEPOSIT_PX: f64 = 3.0;
const DEPOSITS: [(usize, f64); 4] = [(1, 0.35), (3, 0.55), (10, 0.8), (30, 1.0)];
/// Steps of the colour scale along a path: finer ones cannot be told apart on a thin line.
const SPEED_CLASSES: usize = 14;
const TOP_PX: f64 = 10.0;

/// Draws the map.
pub(super) fn draw(report: &Report) -> Drawing {
    let words = report.words();
    let panel = layout(report);
    let key = furniture::MapLegend::of(&panel, report);
    let width = (panel.frame.right + RIGHT_PX).clamp(NARROWEST_PX, WIDTH_PX);
    let said = |mark: &MapMark, width_px: f64| site::in_words(mark, &report.marks, width_px, words);
    let names = Names::of(&panel, report, &said).with_zones(&panel, report);
    let numbered = names.key((&panel, report), &said, width - KEY_LEFT_PX);
    let below = panel.frame.bottom + FOOT_PX + key.height_px(width - KEY_LEFT_PX) + 8.0;
    let height = below + numbered.height_px();
    let fastest = fastest_m_s(report);
    let mut contours = None;
    let svg = paint("plan", (width, height), words.plan_title, |canvas| {
        names.keep(canvas);
        canvas.clip("map", &panel.frame, || {
            if let Some(ground) = &report.ground {
                contours = ground::draw(canvas, &panel, ground, &site::outline(&panel, report));
            }
            paths(canvas, &panel, report, fastest);
            deposits(canvas, &panel, report);
            site::zones(canvas, &panel, report);
            site::marks(canvas, &panel, report);
            // what a barrier holds lies at its line: its white rim would hide single ends
            ends(canvas, &panel, report);
            if let Some(contours) = &contours {
                contours.labels(canvas);
            }
            names.write(canvas);
        });
        if report.releases.is_empty() && report.ground.is_none() {
            panel.nothing(canvas, words.no_release_no_ground);
        }
        panel.axes(canvas);
        furniture::draw(canvas, &panel, (fastest, !report.paths.is_empty()), words);
        key.draw(canvas, (KEY_LEFT_PX, panel.frame.bottom + FOOT_PX + 4.0));
        numbered.draw(canvas, (KEY_LEFT_PX, below - 4.0));
    });
    let interval = contours.map_or(String::new(), |c| {
        fill(words.contour_interval, &[("m", &format::plain(c.interval_m))])
    });
    let count = |n: usize| format::decimal(n as f64, 0);
    let found = [count(report.paths.len()), count(report.released())];
    let caption =
        if report.paths.is_empty() { words.drawn().plan_no_paths } else { words.plan_caption };
    let caption = fill(caption, &[("paths", &found[0]), ("releases", &found[1])]);
    let density = if at_rest(report).count() > MANY { words.plan_density } else { "" };
    let aside = site::outside(&panel, report);
    Drawing { svg, caption: caption + density + &interval + &aside }
}

/// The map frame: equal scale, as large as the page allows, showing all releases, ends and paths.
fn layout(report: &Report) -> Panel {
    let (mut x, mut y) = extent(report);
    let names = (report.words().easting, report.words().northing);
    // the labels' width needs the ticks, the ticks need a frame: a square one is near enough
    let square = PaperFrame { left: 0.0, top: 0.0, right: 400.0, bottom: 400.0 };
    let panel = |frame: PaperFrame, x: Range, y: Range| {
        Panel::new(frame, Axis::linear(x.0, x.1, names.0), Axis::linear(y.0, y.1, names.1))
    };
    let left = panel(square, x, y).room_left();
    let widest = (WIDTH_PX - left - RIGHT_PX).min(WIDEST_PX);
    fill_page(&mut x, &mut y, widest, report);
    let scale = (widest / (x.1 - x.0)).min(TALLEST_PX / (y.1 - y.0));
    let (width, height) = (scale * (x.1 - x.0), scale * (y.1 - y.0));
    let frame = PaperFrame { left, top: TOP_PX, right: left + width, bottom: TOP_PX + height };
    let mut panel = panel(frame, x, y);
    // a flat map has other ticks than the square, with more digits
    let more = (panel.room_left() - panel.frame.left).max(0.0);
    panel.frame.left += more;
    panel.frame.right += more;
    panel
}

type Range = (f64, f64);

/// What must be seen, with a margin; the whole ground when no rock has moved.
fn extent(report: &Report) -> (Range, Range) {
    let ends = report.releases.iter().flat_map(|fall| [fall.start_m, fall.end_m]);
    let points = report.paths.iter().flat_map(|path| path.points.iter().map(|p| p.place_m));
    let places = ends.chain(points).filter(|p| p[0].is_finite() && p[1].is_finite());
    let empty = (f64::INFINITY, f64::NEG_INFINITY);
    let wider = |r: Range, v: f64| (r.0.min(v), r.1.max(v));
    let (mut x, mut y) = places.fold((empty, empty), |(x, y), p| (wider(x, p[0]), wider(y, p[1])));
    if x.0 <= x.1 {
        // lines and barriers are seen too, but one far off does not make the rocks small
        let reach = BESIDE * (x.1 - x.0).max(y.1 - y.0);
        let (x0, y0) = (x, y);
        let near = |v: f64, r: Range| v.clamp(r.0 - reach, r.1 + reach);
        for &[cx, cy] in report.marks.iter().flat_map(|mark| &mark.corners_m) {
            (x, y) = (wider(x, near(cx, x0)), wider(y, near(cy, y0)));
        }
    }
    if x.0 > x.1 {
        (x, y) = report.ground.as_ref().map_or(((0.0, 1.0), (0.0, 1.0)), |g| {
            ((g.west_m, g.east_m()), (g.south_m, g.north_m()))
        });
    }
    let everything = (f64::NEG_INFINITY, f64::INFINITY);
    let least = report
        .ground
        .as_ref()
        .map_or(0.0, |g| LEAST * (g.east_m() - g.west_m).max(g.north_m() - g.south_m));
    let least = if least > 1e-6 { least } else { 0.1 };
    if (x.1 - x.0).max(y.1 - y.0) < least {
        (x, y) = (grown(x, least, everything), grown(y, least, everything));
    }
    let margin = MARGIN * (x.1 - x.0).max(y.1 - y.0);
    ((x.0 - margin, x.1 + margin), (y.0 - margin, y.1 + margin))
}

/// Widens the shorter side towards the shape of the page as far as there is ground to show, and to the least height.
fn fill_page(x: &mut Range, y: &mut Range, widest_px: f64, report: &Report) {
    let ground = report.ground.as_ref();
    let page = TALLEST_PX / widest_px;
    if (y.1 - y.0) / (x.1 - x.0) > page {
        let wanted = (y.1 - y.0) / page;
        let limits = ground.map_or(*x, |g| (g.west_m, g.east_m()));
        *x = grown(*x, wanted, limits);
    } else {
        let wanted = 0.75 * page * (x.1 - x.0);
        let limits = ground.map_or(*y, |g| (g.south_m, g.north_m()));
        *y = grown(*y, wanted, limits);
    }
    let least = LOWEST_PX / widest_px * (x.1 - x.0);
    let everything = (f64::NEG_INFINITY, f64::INFINITY);
    *y = grown(*y, least, everything);
    *x = grown(*x, 0.3 * (y.1 - y.0), everything);
}

/// `range` widened on both sides to `wanted` where the limits allow it; never narrowed.
fn grown(range: Range, wanted: f64, limits: Range) -> Range {
    let more = 0.5 * (wanted - (range.1 - range.0)).max(0.0);
    ((range.0 - more).max(limits.0).min(range.0), (range.1 + more).min(limits.1).max(range.1))
}

/// Round upper end of the speed scale (m/s).
fn fastest_m_s(report: &Report) -> f64 {
    let speeds = report.paths.iter().flat_map(|path| path.points.iter().map(|p| p.speed_m_s));
    Axis::from_zero(speeds.chain([SLOWEST_M_S]), "").high
}

/// The paths, thinned, one group a speed class, slow ones below.
fn paths(canvas: &Canvas<'_>, panel: &Panel, report: &Report, fastest_m_s: f64) {
    let mut classes: Vec<Vec<Vec<Spot>>> = vec![Vec::new(); SPEED_CLASSES];
    for path in &report.paths {
        let spots: Vec<Spot> =
            path.points.iter().map(|p| panel.at(p.place_m[0], p.place_m[1])).collect();
        let class = |i: usize| {
            let mean = 0.5 * (path.points[i].speed_m_s + path.points[i + 1].speed_m_s);
            ((mean / fastest_m_s * SPEED_CLASSES as f64) as usize).min(SPEED_CLASSES - 1)
        };
        let mut from = 0;
        for i in 1..spots.len() {
            if i + 1 == spots.len() || class(i) != class(from) {
                let parts = clipped(&spots[from..=i], &panel.frame);
                classes[class(from)].extend(parts.iter().map(|p| thinned(p, TOLERANCE_PX)));
                from = i;
            }
        }
    }
    let many = report.paths.len() as f64;
    let width_px = (2.2 - 0.5 * math::log10(many.max(1.0))).clamp(0.8, 1.8);
    let opacity = if many > 100.0 { 0.75 } else { 0.95 };
    for (i, lines) in classes.iter().enumerate() {
        let colour = colour::sequential((i as f64 + 0.5) / SPEED_CLASSES as f64);
        canvas.lines(lines, Pen { opacity, ..Pen::full(colour, width_px) });
    }
}

fn at_rest(report: &Report) -> impl Iterator<Item = [f64; 3]> + '_ {
    let at_rest = report.releases.iter().filter(|fall| fall.stop == Stop::AtRest);
    at_rest.map(|fall| fall.end_m)
}

/// Ends by stop reason, but for deposits that are drawn as density.
fn ends(canvas: &Canvas<'_>, panel: &Panel, report: &Report) {
    let radius = if report.releases.len() > MANY { 1.3 } else { 2.6 };
    let is_crowd = at_rest(report).count() > MANY;
    for kind in ENDS.into_iter().filter(|kind| !(is_crowd && *kind == EndMark::AtRest)) {
        let ends = report.releases.iter().filter(|fall| EndMark::of(&fall.stop) == Some(kind));
        kind.draw(canvas, &apart(panel, ends.map(|fall| fall.end_m), 0.8 * radius), radius);
    }
}

/// Squares that are the darker the more rocks lie in them, where rocks at rest are many.
fn deposits(canvas: &Canvas<'_>, panel: &Panel, report: &Report) {
    if at_rest(report).count() <= MANY {
        return;
    }
    let mut cells: BTreeMap<(i64, i64), usize> = BTreeMap::new();
    for end in at_rest(report) {
        let (x, y) = panel.at(end[0], end[1]);
        if panel.frame.holds((x, y)) {
            let cell = ((x / DEPOSIT_PX).floor() as i64, (y / DEPOSIT_PX).floor() as i64);
            *cells.entry(cell).or_default() += 1;
        }
    }
    for (class, &(from, opacity)) in DEPOSITS.iter().enumerate() {
        let to = DEPOSITS.get(class + 1).map_or(usize::MAX, |next| next.0);
        let of_class = cells.iter().filter(|(_, count)| (from..to).contains(count));
        let middle = |cell: i64| (cell as f64 + 0.5) * DEPOSIT_PX;
        let spots: Vec<Spot> = of_class.map(|(&(x, y), _)| (middle(x), middle(y))).collect();
        let colour = if class + 1 == DEPOSITS.len() { DARK_VERMILLION } else { VERMILLION };
        canvas.group(&format!(r#"opacity="{opacity}""#), || {
            canvas.squares(&spots, 0.5 * DEPOSIT_PX, colour);
        });
    }
}

/// A square of each class beside the other, for the key.
fn density_symbol(canvas: &Canvas<'_>, at: Spot) {
    for (class, (_, opacity)) in DEPOSITS.iter().enumerate() {
        let x = at.0 + (class as f64 - 1.5) * 4.0;
        let frame =
            PaperFrame { left: x - 2.0, right: x + 2.0, top: at.1 - 3.0, bottom: at.1 + 3.0 };
        let colour = if class + 1 == DEPOSITS.len() { DARK_VERMILLION } else { VERMILLION };
        canvas.fill(&frame, colour, *opacity);
    }
}

/// Places inside the frame, one for each little square of `raster_px`: what lies on top of each other is drawn once.
fn apart(panel: &Panel, places: impl Iterator<Item = [f64; 3]>, raster_px: f64) -> Vec<Spot> {
    let spots = places.map(|p| panel.at(p[0], p[1])).filter(|&s| panel.frame.holds(s));
    let cells: BTreeSet<(i64, i64)> = spots
        .map(|(x, y)| ((x / raster_px).round() as i64, (y / raster_px).round() as i64))
        .collect();
    cells.into_iter().map(|(x, y)| (x as f64 * raster_px, y as f64 * raster_px)).collect()
}

/// How an end is shown: form and colour, so that a grey print keeps them apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum EndMark {
    AtRest,
    LeftTerrain,
    TimeUp,
    Failed,
}

/// The ways to end, in the order they are drawn.
const ENDS: [EndMark; 4] =
    [EndMark::AtRest, EndMark::LeftTerrain, EndMark::TimeUp, EndMark::Failed];

impl EndMark {
    /// None of a rock that was never released: it has been nowhere.
    fn of(stop: &Stop) -> Option<Self> {
        Some(match stop {
            Stop::AtRest => Self::AtRest,
            Stop::LeftTerrain => Self::LeftTerrain,
            Stop::TimeUp | Stop::OverBudget => Self::TimeUp,
            Stop::Failed(_) => Self::Failed,
            Stop::NotReleased(_) => return None,
        })
    }

    /// Draws marks of a radius (px) on a white rim.
    fn draw(self, canvas: &Canvas<'_>, spots: &[Spot], radius: f64) {
        let rim = radius + 0.6;
        match self {
            Self::AtRest => {
                canvas.dots(spots, rim, WHITE);
                canvas.dots(spots, radius, VERMILLION);
            }
            Self::LeftTerrain => {
                canvas.squares(spots, rim, WHITE);
                canvas.squares(spots, radius, BLUE);
            }
            Self::TimeUp => {
                canvas.squares(spots, rim, ORANGE);
                canvas.squares(spots, 0.5 * radius, WHITE);
            }
            Self::Failed => {
                let is_crowd = spots.len() > MANY;
                let r = if is_crowd { radius } else { radius + 0.8 };
                let strokes = |&(x, y): &Spot| {
                    [vec![(x - r, y - r), (x + r, y + r)], vec![(x - r, y + r), (x + r, y - r)]]
                };
                let crosses: Vec<Vec<Spot>> = spots.iter().flat_map(strokes).collect();
                if !is_crowd {
                    canvas.lines(&crosses, Pen::full(WHITE, 2.8));
                }
                canvas.lines(&crosses, Pen::full(PURPLE, if is_crowd { 0.9 } else { 1.6 }));
            }
        }
    }
}

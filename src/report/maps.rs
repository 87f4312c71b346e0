//! Maps in the report: how likely rocks come, with what intensity, and where they stay.

use super::axis::Axis;
use super::colour::{self, GREY, INK, ORANGE, SKY, VERMILLION};
use super::figure::{Drawing, WIDTH_PX};
use super::format;
use super::input::{CellMap, Report};
use super::panel::{FOOT_PX, Panel};
use super::paper::{Label, NORMAL, Paper, Pen, SMALL, paint};
use super::plan_view::ground;
use super::svg::path::{Frame, Spot};
use plotters::style::RGBColor;

const TOP_PX: f64 = 26.0;
const KEY_PX: f64 = 26.0;
const TALLEST_PX: f64 = 460.0;
/// Classes of reach probability: upper ends (–).
const REACH: [f64; 5] = [0.001, 0.01, 0.1, 0.3, 1.0];
/// Colours of the Swiss classes: weak, medium, strong.
const INTENSITY: [RGBColor; 3] = [SKY, ORANGE, VERMILLION];

/// Draws reach probability and intensity beside each other.
pub(super) fn draw(report: &Report, maps: &CellMap) -> Drawing {
    let panels = panels(maps);
    let bottom = panels[0].frame.bottom + FOOT_PX + KEY_PX;
    let svg = paint("maps", (WIDTH_PX, bottom), "Maps", |paper| {
        for (k, panel) in panels.iter().enumerate() {
            let (title, keys) = if k == 0 {
                ("Reach probability", reach_keys())
            } else {
                ("Intensity (largest energy)", intensity_keys())
            };
            let at = (panel.frame.left, panel.frame.top - 10.0);
            paper.text(&Label::new(title, at).bold().sized(NORMAL));
            paper.clip(&format!("part{k}"), &panel.frame, || {
                if let Some(raster) = &report.ground {
                    let _ = ground::draw(paper, panel, raster);
                }
                for (class, (_, colour)) in keys.iter().enumerate() {
                    let values = if k == 0 { &maps.reach } else { &maps.intensity };
                    cells(paper, panel, maps, (values, k == 0, class), *colour);
                }
            });
            panel.axes(paper);
            key(paper, panel, &keys);
        }
    });
    let share = |count: usize| {
        let all: usize = maps.intensity_cells.iter().sum();
        format::percent(count as f64 / all.max(1) as f64, 0)
    };
    let [weak, medium, strong] = maps.intensity_cells.map(share);
    let caption = format!(
        "Maps of {} m cells. Left: share of the releases that pass each cell (conditional on release). Right: Swiss \
         classes of intensity by the largest total energy of any rock in the cell: weak below 30 kJ ({weak} of the \
         cells reached), medium 30 to 300 kJ ({medium}), strong above ({strong}). All layers lie in maps/ as ASCII grid and GeoTIFF.",
        format::plain(maps.cell_m)
    );
    Drawing { svg, caption }
}

fn reach_keys() -> Vec<(String, RGBColor)> {
    let name = |limit: f64| format!("≤ {}", format::percent(limit, usize::from(limit < 0.01)));
    let colour = |k: usize| colour::sequential(k as f64 / (REACH.len() - 1) as f64);
    REACH.iter().enumerate().map(|(k, limit)| (name(*limit), colour(k))).collect()
}

fn intensity_keys() -> Vec<(String, RGBColor)> {
    ["weak", "medium", "strong"].iter().zip(INTENSITY).map(|(n, c)| ((*n).to_owned(), c)).collect()
}

/// Two equal frames over all cells reached, at equal scale.
fn panels(maps: &CellMap) -> [Panel; 2] {
    let (mut x, mut y) = maps.extent();
    let room = 76.0;
    let widest = 0.5 * WIDTH_PX - room - 8.0;
    let scale = (widest / (x.1 - x.0)).min(TALLEST_PX / (y.1 - y.0));
    // a slender map is given some ground beside it
    let more = 0.5 * (widest / scale - (x.1 - x.0)).max(0.0);
    x = (x.0 - more, x.1 + more);
    let least = 0.5 * (150.0 / scale - (y.1 - y.0)).max(0.0);
    y = (y.0 - least, y.1 + least);
    [0.0, 0.5 * WIDTH_PX].map(|left| {
        let frame = Frame {
            left: left + room,
            top: TOP_PX,
            right: left + room + widest,
            bottom: TOP_PX + scale * (y.1 - y.0),
        };
        let names = if left == 0.0 { ("Easting (m)", "Northing (m)") } else { ("Easting (m)", "") };
        Panel::new(frame, Axis::linear(x.0, x.1, names.0), Axis::linear(y.0, y.1, names.1))
    })
}

fn cells(
    paper: &Paper<'_>,
    panel: &Panel,
    maps: &CellMap,
    (values, by_limit, class): (&[(u32, f64)], bool, usize),
    colour: RGBColor,
) {
    let class_of = |value: f64| {
        if by_limit {
            REACH.iter().position(|limit| value <= *limit).unwrap_or(REACH.len() - 1)
        } else {
            value as usize - 1
        }
    };
    let spots: Vec<Spot> = values
        .iter()
        .filter(|(_, value)| class_of(*value) == class)
        .map(|(cell, _)| maps.centre_m(*cell))
        .map(|(x, y)| panel.at(x, y))
        .collect();
    let half = 0.5 * maps.cell_m / (panel.x.high - panel.x.low) * panel.frame.width();
    paper.group(r#"opacity="0.8""#, || paper.squares(&spots, half + 0.05, colour));
}

fn key(paper: &Paper<'_>, panel: &Panel, keys: &[(String, RGBColor)]) {
    let y = panel.frame.bottom + FOOT_PX + 10.0;
    let mut x = panel.frame.left;
    for (name, colour) in keys {
        let patch = Frame { left: x, right: x + 10.0, top: y - 5.0, bottom: y + 5.0 };
        paper.fill(&patch, *colour, 0.8);
        paper.outline(&patch, Pen::full(INK, 0.4));
        paper.text(&Label::new(name.clone(), (x + 13.0, y)).coloured(GREY));
        x += 20.0 + super::paper::text_width(name, SMALL);
    }
}

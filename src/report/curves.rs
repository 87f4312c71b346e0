//! A plain figure: lines over two axes, or spheres seen from the side.

use super::axis::Axis;
use super::colour::{BLUE, INK, SKY};
use super::figure::WIDTH_PX;
use super::panel::{FOOT_PX, Panel};
use super::paper::{Pen, paint};
use super::svg::path::Frame;

/// What to draw.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    /// What it shows.
    pub title: String,
    /// Name of the x axis with its unit.
    pub x: &'static str,
    /// Name of the y axis with its unit.
    pub y: &'static str,
    /// Lines through values.
    pub lines: Vec<Vec<(f64, f64)>>,
    /// Spheres: centre and radius, in the unit of both axes, which then have one scale.
    pub discs: Vec<(f64, f64, f64)>,
}

const HEIGHT_PX: f64 = 260.0;
const TOP_PX: f64 = 12.0;

impl Curves {
    /// Nothing to draw yet.
    pub fn new(title: impl Into<String>, x: &'static str, y: &'static str) -> Self {
        Self { title: title.into(), x, y, lines: Vec::new(), discs: Vec::new() }
    }

    /// The figure as an SVG file.
    pub fn draw(&self, name: &str) -> String {
        let discs = self.discs.iter().flat_map(|(x, y, r)| [(x - r, y - r), (x + r, y + r)]);
        let all: Vec<(f64, f64)> = self.lines.iter().flatten().copied().chain(discs).collect();
        let range = |of: fn(&(f64, f64)) -> f64| {
            let values = all.iter().map(of);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let (x, mut y) = (range(|p| p.0), range(|p| p.1));
        let frame =
            Frame { left: 60.0, top: TOP_PX, right: WIDTH_PX - 16.0, bottom: TOP_PX + HEIGHT_PX };
        let scale = frame.width() / (x.1 - x.0);
        if !self.discs.is_empty() {
            let middle = 0.5 * (y.0 + y.1);
            let half = (0.5 * frame.height() / scale).max(0.5 * (y.1 - y.0));
            y = (middle - half, middle + half);
        }
        let panel =
            Panel::new(frame, Axis::linear(x.0, x.1, self.x), Axis::linear(y.0, y.1, self.y));
        let size = (WIDTH_PX, TOP_PX + HEIGHT_PX + FOOT_PX);
        paint(name, size, &self.title, |paper| {
            panel.grid(paper);
            for line in &self.lines {
                panel.line(paper, line, Pen::full(BLUE, 1.0));
            }
            for &(x, y, radius) in &self.discs {
                let px = radius * frame.height() / (panel.y.high - panel.y.low);
                paper.disc(panel.at(x, y), px, INK);
                paper.disc(panel.at(x, y), (px - 0.6).max(0.1), SKY);
            }
            panel.axes(paper);
        })
    }
}

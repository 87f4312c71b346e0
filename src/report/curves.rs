//! A plain figure: lines over two axes, or spheres seen from the side.

use super::axis::Axis;
use super::canvas::{Canvas, Label, NORMAL, Pen, SMALL, paint, text_width};
use super::colour::{BLUE, GREY, INK, ORANGE, SKY};
use super::figure::WIDTH_PX;
use super::panel::{FOOT_PX, Panel};
use super::svg::path::PaperFrame;

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
    /// The same by another way of computing.
    pub others: Vec<Vec<(f64, f64)>>,
    /// What the two are called; none where there is only one.
    pub names: Option<[&'static str; 2]>,
    /// The ground behind.
    pub ground: Vec<Vec<(f64, f64)>>,
    /// Spheres: centre and radius, in the unit of both axes, which then have one scale.
    pub discs: Vec<(f64, f64, f64)>,
}

const HEIGHT_PX: f64 = 260.0;
/// Room above the frame for the title, and a line more for the key (px).
const TOP_PX: f64 = 26.0;
const KEY_PX: f64 = 18.0;

impl Curves {
    /// Nothing to draw yet.
    pub fn new(title: impl Into<String>, x: &'static str, y: &'static str) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            lines: Vec::new(),
            others: Vec::new(),
            names: None,
            ground: Vec::new(),
            discs: Vec::new(),
        }
    }

    /// The figure as an SVG file.
    pub fn draw(&self, name: &str) -> String {
        let discs = self.discs.iter().flat_map(|(x, y, r)| [(x - r, y - r), (x + r, y + r)]);
        let lines = [&self.lines, &self.others, &self.ground].into_iter().flatten().flatten();
        let all: Vec<(f64, f64)> = lines.copied().chain(discs).collect();
        let range = |of: fn(&(f64, f64)) -> f64| {
            let values = all.iter().map(of);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let (x, y) = (range(|p| p.0), range(|p| p.1));
        let (mut x, mut y) = (x, y);
        let top = TOP_PX + if self.names.is_some() { KEY_PX } else { 0.0 };
        let frame = PaperFrame { left: 60.0, top, right: WIDTH_PX - 16.0, bottom: top + HEIGHT_PX };
        if self.is_seen_from_the_side() {
            // one scale for both axes
            let scale = f64::min(frame.width() / (x.1 - x.0), frame.height() / (y.1 - y.0));
            x = around(x, frame.width() / scale);
            y = around(y, frame.height() / scale);
        }
        let mut panel =
            Panel::new(frame, Axis::linear(x.0, x.1, self.x), Axis::linear(y.0, y.1, self.y));
        // long labels need more than the usual room
        panel.frame.left = panel.frame.left.max(panel.room_left());
        let size = (WIDTH_PX, top + HEIGHT_PX + FOOT_PX);
        paint(name, size, &self.title, |canvas| {
            let at = (panel.frame.left, 12.0);
            canvas.text(&Label::new(self.title.clone(), at).bold().sized(NORMAL));
            panel.grid(canvas);
            for line in &self.ground {
                panel.line(canvas, line, Pen::full(GREY, 1.4));
            }
            for line in &self.lines {
                panel.line(canvas, line, Pen::full(BLUE, 1.0));
            }
            for line in &self.others {
                panel.line(canvas, line, Pen::full(ORANGE, 1.4).dashed());
            }
            for &(x, y, radius) in &self.discs {
                let px = radius * frame.height() / (panel.y.high - panel.y.low);
                canvas.disc(panel.at(x, y), px, INK);
                canvas.disc(panel.at(x, y), (px - 0.6).max(0.1), SKY);
            }
            panel.axes(canvas);
            self.key(canvas, &panel);
        })
    }

    fn is_seen_from_the_side(&self) -> bool {
        !self.discs.is_empty() || !self.ground.is_empty()
    }

    fn key(&self, canvas: &Canvas<'_>, panel: &Panel) {
        let mut x = panel.frame.left;
        let pens = [Pen::full(BLUE, 1.4), Pen::full(ORANGE, 1.6).dashed()];
        for (name, pen) in self.names.iter().flatten().zip(pens) {
            // above the frame: no curve runs there
            let y = panel.frame.top - 10.0;
            canvas.line(&[(x, y), (x + 20.0, y)], pen);
            canvas.text(&Label::new(*name, (x + 25.0, y)));
            x += 25.0 + text_width(name, SMALL) + 18.0;
        }
    }
}

/// The range of this width about the middle of another.
fn around((low, high): (f64, f64), width: f64) -> (f64, f64) {
    let middle = 0.5 * (low + high);
    (middle - 0.5 * width, middle + 0.5 * width)
}

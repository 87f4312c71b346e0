//! The sheet a figure is drawn on: plotters shapes in pixels, plus groups, images and haloed text.

mod label;

pub use label::{Label, bold_width, fitted, fitted_among, text_width};

use super::colour::{self, INK, WHITE};
use super::format::escape;
use super::svg::path::{self, PaperFrame, Spot, tenths};
use super::svg::{DEPTH, FRAGMENT_MARK, SvgBackend, TENTHS, document};
use label::TAIL_GAP;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{
    Circle, CoordMapper, Drawable, PathElement, PointCollection, Polygon, Rectangle, Text,
};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, RGBColor, ShapeStyle, TextStyle};
use std::cell::RefCell;
use std::fmt::Write as _;

/// Size of small text: tick labels, notes (px; 0.75 pt each).
pub const SMALL: f64 = 10.5;
/// Size of axis titles and panel heads (px).
pub const NORMAL: f64 = 11.5;

/// How many forms of marks there are: disc, square, diamond, triangle.
const SHAPES: usize = 4;

/// How a line looks.
#[derive(Debug, Clone, Copy)]
pub struct Pen {
    /// Colour.
    pub colour: RGBColor,
    /// Width (px).
    pub width_px: f64,
    /// Opacity (0..1).
    pub opacity: f64,
    /// Lengths of dashes and gaps in tenths of a pixel, as SVG wants them; empty for a full line.
    pub dashes: &'static str,
}

impl Pen {
    /// A full line.
    pub const fn full(colour: RGBColor, width_px: f64) -> Self {
        Self { colour, width_px, opacity: 1.0, dashes: "" }
    }

    /// The same line, dashed.
    #[must_use]
    pub const fn dashed(self) -> Self {
        Self { dashes: "45 25", ..self }
    }

    /// The same line, dotted.
    #[must_use]
    pub const fn dotted(self) -> Self {
        Self { dashes: "12 18", ..self }
    }
}

/// Draws one figure and returns the SVG file.
///
/// `name` starts every id, so that figures can stand on one page.
pub fn paint(
    name: &str,
    size_px: (f64, f64),
    title: &str,
    draw: impl FnOnce(&Canvas<'_>),
) -> String {
    let mut body = String::new();
    let backend = SvgBackend::new(&mut body, size_px);
    let boxes = RefCell::default();
    let canvas = Canvas { area: backend.into_drawing_area(), name, size_px, boxes };
    draw(&canvas);
    drop(canvas);
    document(&body, size_px, title)
}

/// The sheet.
#[allow(missing_debug_implementations, reason = "a plotters area has none")]
pub struct Canvas<'a> {
    area: DrawingArea<SvgBackend<'a>, Shift>,
    name: &'a str,
    size_px: (f64, f64),
    /// Room that texts have taken.
    boxes: RefCell<Vec<PaperFrame>>,
}

impl<'a> Canvas<'a> {
    fn put<'e, E, B>(&self, element: &'e E)
    where
        B: CoordMapper,
        &'e E: PointCollection<'e, (i32, i32), B>,
        E: Drawable<SvgBackend<'a>, B>,
    {
        // the canvas writes to a string (cannot fail) and is borrowed for one element at a time
        self.area.draw(element).expect("drawing on a string cannot fail");
    }

    /// Size (px).
    pub fn size_px(&self) -> (f64, f64) {
        self.size_px
    }

    /// Copies a fragment of SVG (in tenths of a pixel) into the drawing.
    pub fn fragment(&self, svg: &str) {
        let nowhere = TextStyle::from(FontDesc::new(FontFamily::SansSerif, 1.0, FontStyle::Normal));
        self.put(&Text::new(format!("{FRAGMENT_MARK}{svg}"), (0, 0), nowhere));
    }

    /// What `draw` draws, in a group with the given attributes.
    pub fn group(&self, attributes: &str, draw: impl FnOnce()) {
        self.fragment(&format!("<g {attributes}>"));
        draw();
        self.fragment("</g>");
    }

    /// What `draw` draws, cut at a frame. `part` tells apart several frames of one figure.
    pub fn clip(&self, part: &str, frame: &PaperFrame, draw: impl FnOnce()) {
        let id = format!("{}-{part}", self.name);
        let ((x0, y0), (x1, y1)) =
            (tenths((frame.left, frame.top)), tenths((frame.right, frame.bottom)));
        self.fragment(&format!(
            r#"<clipPath id="{id}"><rect x="{x0}" y="{y0}" width="{}" height="{}"/></clipPath>"#,
            x1 - x0,
            y1 - y0
        ));
        self.group(&format!(r#"clip-path="url(#{id})""#), draw);
    }

    /// A line through points.
    pub fn line(&self, points: &[Spot], pen: Pen) {
        let style = ShapeStyle {
            color: pen.colour.mix(pen.opacity),
            filled: false,
            stroke_width: (pen.width_px * TENTHS).round() as u32,
        };
        let spots: Vec<(i32, i32)> = points.iter().map(|&p| tenths(p)).collect();
        if spots.is_empty() {
            return;
        }
        let draw = || self.put(&PathElement::new(spots, style));
        if pen.dashes.is_empty() {
            draw();
        } else {
            self.group(&format!(r#"stroke-dasharray="{}""#, pen.dashes), draw);
        }
    }

    /// A filled polygon.
    pub fn polygon(&self, corners: &[Spot], fill: RGBColor, opacity: f64) {
        let spots: Vec<(i32, i32)> = corners.iter().map(|&p| tenths(p)).collect();
        if spots.len() > 2 {
            self.put(&Polygon::new(spots, ShapeStyle::from(fill.mix(opacity)).filled()));
        }
    }

    /// A filled rectangle.
    pub fn fill(&self, frame: &PaperFrame, fill: RGBColor, opacity: f64) {
        let corners = [tenths((frame.left, frame.top)), tenths((frame.right, frame.bottom))];
        self.put(&Rectangle::new(corners, ShapeStyle::from(fill.mix(opacity)).filled()));
    }

    /// The outline of a rectangle.
    pub fn outline(&self, frame: &PaperFrame, pen: Pen) {
        let PaperFrame { left, top, right, bottom } = *frame;
        self.line(&[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], pen);
    }

    /// A disc.
    pub fn disc(&self, centre: Spot, radius_px: f64, fill: RGBColor) {
        let radius = (radius_px * TENTHS).round() as i32;
        self.put(&Circle::new(tenths(centre), radius, ShapeStyle::from(fill).filled()));
    }

    /// A mark of one of `SHAPES` forms: series are told apart without colour.
    pub fn mark(&self, shape: usize, (x, y): Spot, radius_px: f64, fill: RGBColor) {
        let r = 1.2 * radius_px;
        match shape % SHAPES {
            0 => self.disc((x, y), radius_px, fill),
            1 => self.polygon(
                &[(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)],
                fill,
                1.0,
            ),
            2 => self.polygon(
                &[(x, y - 1.4 * r), (x + 1.4 * r, y), (x, y + 1.4 * r), (x - 1.4 * r, y)],
                fill,
                1.0,
            ),
            _ => self.polygon(
                &[(x, y - 1.3 * r), (x + 1.3 * r, y + r), (x - 1.3 * r, y + r)],
                fill,
                1.0,
            ),
        }
    }

    /// Dots of one size in one path: hundreds of thousands stay small.
    pub fn dots(&self, centres: &[Spot], radius_px: f64, colour: RGBColor) {
        let mut data = String::new();
        for &centre in centres {
            path::append_dot(&mut data, centre);
        }
        if !data.is_empty() {
            self.fragment(&format!(
                r#"<path d="{data}" fill="none" stroke="{}" stroke-width="{}" stroke-linecap="round"/>"#,
                colour::hex(colour),
                (2.0 * radius_px * TENTHS).round() as i32
            ));
        }
    }

    /// Squares of one size in one path.
    pub fn squares(&self, centres: &[Spot], half_px: f64, colour: RGBColor) {
        let mut data = String::new();
        for &centre in centres {
            path::append_square(&mut data, centre, half_px);
        }
        if !data.is_empty() {
            self.fragment(&format!(r#"<path d="{data}" fill="{}"/>"#, colour::hex(colour)));
        }
    }

    /// Rectangles between two corners each in one path.
    pub fn rectangles(&self, corners: &[(Spot, Spot)], colour: RGBColor) {
        let mut data = String::new();
        for &(a, b) in corners {
            path::append_rectangle(&mut data, a, b);
        }
        if !data.is_empty() {
            self.fragment(&format!(r#"<path d="{data}" fill="{}"/>"#, colour::hex(colour)));
        }
    }

    /// Many lines in one path of one style.
    pub fn lines(&self, lines: &[Vec<Spot>], pen: Pen) {
        let mut data = String::new();
        for line in lines {
            path::append_line(&mut data, line.iter().map(|&p| tenths(p)));
        }
        if !data.is_empty() {
            self.fragment(&format!(
                r#"<path d="{data}" fill="none" stroke="{}" stroke-width="{}" stroke-opacity="{}" stroke-linecap="round"/>"#,
                colour::hex(pen.colour),
                (pen.width_px * TENTHS).round() as i32,
                pen.opacity
            ));
        }
    }

    /// Text.
    pub fn text(&self, label: &Label) {
        self.take(label.frame());
        self.write(label);
    }

    /// Keeps room free of later texts.
    pub fn take(&self, frame: PaperFrame) {
        self.boxes.borrow_mut().push(frame);
    }

    /// Whether no text stands in a room, nor nearer than 2 px.
    pub fn is_free(&self, frame: &PaperFrame) -> bool {
        let near = frame.grown(2.0);
        !self.boxes.borrow().iter().any(|taken| taken.meets(&near))
    }

    fn write(&self, label: &Label) {
        if label.tail.is_empty() {
            self.put(&Text::new(label.text.clone(), tenths(label.at), label.style()));
            return;
        }
        let room = label.frame();
        let (x, y) = tenths((label.at.0, room.bottom - DEPTH * label.size_px));
        let anchor = match label.anchor.h_pos {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let weight = if label.is_bold { "bold" } else { "normal" };
        let size = (label.size_px * TENTHS).round();
        self.fragment(&format!(
            r#"<text x="{x}" y="{y}" font-size="{size}" text-anchor="{anchor}"><tspan font-weight="{weight}" fill="{}">{}</tspan><tspan dx="{}" fill="{}">{}</tspan></text>"#,
            colour::hex(label.colour),
            escape(&label.text),
            (TAIL_GAP * size).round(),
            colour::hex(if label.colour == WHITE { WHITE } else { colour::GREY }),
            escape(&label.tail)
        ));
    }

    /// Text on a white rim, readable over anything. Two elements: not every reader knows `paint-order`.
    pub fn text_on_rim(&self, label: &Label) {
        let rim = Label { colour: WHITE, ..label.clone() };
        self.group(r##"stroke="#fff" stroke-width="30""##, || self.write(&rim));
        self.text(label);
    }

    /// Text on a white rim, turned by `degrees` clockwise about its place.
    pub fn text_turned(&self, label: &Label, degrees: f64) {
        let (x, y) = tenths(label.at);
        let turn = format!(r#"transform="rotate({degrees:.1} {x} {y})""#);
        let rim = Label { colour: WHITE, ..label.clone() };
        self.group(&turn, || {
            self.group(r##"stroke="#fff" stroke-width="30""##, || self.write(&rim));
            self.write(label);
        });
    }

    /// A vertical bar whose colour runs through the sequential scale from its lower to its upper end.
    pub fn colour_bar(&self, frame: &PaperFrame) {
        let id = format!("{}-scale", self.name);
        let mut stops = String::new();
        for i in 0..=10 {
            let colour = colour::hex(colour::sequential(f64::from(i) / 10.0));
            let _ = write!(stops, r#"<stop offset="{}%" stop-color="{colour}"/>"#, 10 * i);
        }
        let (x, y) = tenths((frame.left, frame.top));
        let (x1, y1) = tenths((frame.right, frame.bottom));
        self.fragment(&format!(
            r#"<linearGradient id="{id}" x1="0" y1="1" x2="0" y2="0">{stops}</linearGradient><rect x="{x}" y="{y}" width="{}" height="{}" fill="url(#{id})"/>"#,
            x1 - x,
            y1 - y
        ));
        self.outline(frame, Pen::full(INK, 0.6));
    }
}

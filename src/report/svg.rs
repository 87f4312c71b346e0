//! A plotters backend that writes SVG fit for print.
//!
//! It differs from the stock backend in what a printed page shows: coordinates in tenths of a pixel instead of whole
//! ones, relative paths without doubled points, text measured with the widths of Helvetica and set on a computed
//! baseline, round joins, and a hook for prepared fragments (images, gradients, clip groups).

pub mod metrics;
pub mod path;

use super::colour;
use super::format::{escape, lowered};
use plotters::style::RGBColor;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontStyle, FontTransform,
};
use std::convert::Infallible;
use std::fmt::Write as _;

/// Tenths in a pixel: one user unit of the drawing is a tenth of a pixel (1/96 inch).
pub const TENTHS: f64 = 10.0;

/// A text that starts with this mark is not text but a fragment of SVG, copied as it stands.
pub const FRAGMENT_MARK: char = '\u{1}';

/// Fonts in order of wish; set once on the root. Room is kept for the widest of them, see [`metrics`].
const FONTS: &str = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// Height of capitals and figures over the font size (Helvetica: 718/1000).
pub(super) const CAP_HEIGHT: f64 = 0.718;
/// Depth of the letters below the baseline over the font size (Helvetica: 207/1000).
pub(super) const DEPTH: f64 = 0.207;
/// Size of a raised figure over the font size, and how far it is raised.
const RAISED_SIZE: f64 = 0.72;
const RAISED_BY: f64 = 0.36;

type DrawResult = Result<(), DrawingErrorKind<Infallible>>;

/// Writes shapes to a string; writing cannot fail.
#[derive(Debug)]
pub struct SvgBackend<'a> {
    body: &'a mut String,
    size_tenths: (u32, u32),
}

impl<'a> SvgBackend<'a> {
    /// A canvas of `size_px` (width, height) that appends to `body`.
    pub fn new(body: &'a mut String, size_px: (f64, f64)) -> Self {
        let tenths = |px: f64| (px * TENTHS).round() as u32;
        Self { body, size_tenths: (tenths(size_px.0), tenths(size_px.1)) }
    }

    // a `String` takes whatever is written to it
    fn put(&mut self, fragment: std::fmt::Arguments<'_>) {
        let _ = self.body.write_fmt(fragment);
    }

    fn stroke(&mut self, style: &impl BackendStyle) {
        let colour = style.color();
        self.put(format_args!(
            r#" fill="none" stroke="{}" stroke-width="{}""#,
            hex(colour),
            style.stroke_width()
        ));
        self.opacity("stroke-opacity", colour);
    }

    fn fill(&mut self, style: &impl BackendStyle) {
        let colour = style.color();
        self.put(format_args!(r#" fill="{}""#, hex(colour)));
        self.opacity("fill-opacity", colour);
    }

    fn opacity(&mut self, name: &str, colour: BackendColor) {
        if colour.alpha < 1.0 {
            self.put(format_args!(r#" {name}="{:.2}""#, colour.alpha));
        }
    }

    fn finish_shape(&mut self, style: &impl BackendStyle, fill: bool) {
        if fill {
            self.fill(style);
        } else {
            self.stroke(style);
        }
        self.body.push_str("/>\n");
    }
}

impl DrawingBackend for SvgBackend<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size_tenths
    }

    fn ensure_prepared(&mut self) -> DrawResult {
        Ok(())
    }

    fn present(&mut self) -> DrawResult {
        Ok(())
    }

    fn draw_pixel(&mut self, at: BackendCoord, colour: BackendColor) -> DrawResult {
        self.draw_rect(at, (at.0 + 1, at.1 + 1), &colour, true)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> DrawResult {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        a: BackendCoord,
        b: BackendCoord,
        style: &S,
        fill: bool,
    ) -> DrawResult {
        let (width, height) = ((b.0 - a.0).abs(), (b.1 - a.1).abs());
        let (x, y) = (a.0.min(b.0), a.1.min(b.1));
        self.put(format_args!(r#"<rect x="{x}" y="{y}" width="{width}" height="{height}""#));
        self.finish_shape(style, fill);
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        points: I,
        style: &S,
    ) -> DrawResult {
        let mut data = String::new();
        path::append_line(&mut data, points);
        if !data.is_empty() {
            self.put(format_args!(r#"<path d="{data}""#));
            self.finish_shape(style, false);
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> DrawResult {
        self.put(format_args!(r#"<circle cx="{}" cy="{}" r="{radius}""#, centre.0, centre.1));
        self.finish_shape(style, fill);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> DrawResult {
        let mut data = String::new();
        path::append_line(&mut data, corners);
        if !data.is_empty() {
            self.put(format_args!(r#"<path d="{data}z""#));
            self.finish_shape(style, true);
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        at: BackendCoord,
    ) -> DrawResult {
        if let Some(fragment) = text.strip_prefix(FRAGMENT_MARK) {
            self.body.push_str(fragment);
            self.body.push('\n');
        } else {
            let element = text_element(text, style, at);
            self.body.push_str(&element);
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let width = metrics::width_em(text) * style.size();
        Ok((width.ceil() as u32, (style.size() * (CAP_HEIGHT + DEPTH)).ceil() as u32))
    }
}

/// One `<text>` element: anchor, baseline and turn written out, since renderers disagree on everything relative.
fn text_element<S: BackendTextStyle>(text: &str, style: &S, at: BackendCoord) -> String {
    let size = style.size();
    let shift = match style.anchor().v_pos {
        VPos::Top => CAP_HEIGHT * size,
        VPos::Center => 0.5 * CAP_HEIGHT * size,
        VPos::Bottom => -DEPTH * size,
    };
    let anchor = match style.anchor().h_pos {
        HPos::Left => "",
        HPos::Center => r#" text-anchor="middle""#,
        HPos::Right => r#" text-anchor="end""#,
    };
    let turn = match style.transform() {
        FontTransform::None => String::new(),
        FontTransform::Rotate90 => format!(r#" transform="rotate(90 {} {})""#, at.0, at.1),
        FontTransform::Rotate180 => format!(r#" transform="rotate(180 {} {})""#, at.0, at.1),
        FontTransform::Rotate270 => format!(r#" transform="rotate(-90 {} {})""#, at.0, at.1),
    };
    let face = match style.style() {
        FontStyle::Bold => r#" font-weight="bold""#,
        FontStyle::Italic | FontStyle::Oblique => r#" font-style="italic""#,
        FontStyle::Normal => "",
    };
    format!(
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{}\"{anchor}{face}{turn}>{}</text>\n",
        at.0,
        (f64::from(at.1) + shift).round() as i32,
        size.round() as i32,
        hex(style.color()),
        with_raised_figures(text, size)
    )
}

/// Escaped text whose raised figures become small figures set higher: the fonts named above lack most of them.
fn with_raised_figures(text: &str, size: f64) -> String {
    let rise = (RAISED_BY * size).round() as i32;
    let small = (RAISED_SIZE * size).round() as i32;
    let mut out = String::new();
    let mut is_raised = false;
    for c in text.chars() {
        let plain = lowered(c);
        if plain.is_some() && !is_raised {
            let _ = write!(out, r#"<tspan dy="-{rise}" font-size="{small}">"#);
        } else if plain.is_none() && is_raised {
            let _ = write!(out, r#"</tspan><tspan dy="{rise}">"#);
        }
        if plain.is_none() && is_raised {
            // the baseline stays where the last shift left it: one span undoes the rise for the rest
            out.push_str(&escape(&c.to_string()));
            out.push_str("</tspan>");
        } else {
            out.push_str(&escape(&plain.unwrap_or(c).to_string()));
        }
        is_raised = plain.is_some();
    }
    if is_raised {
        out.push_str("</tspan>");
    }
    out
}

fn hex(colour: BackendColor) -> String {
    colour::hex(RGBColor(colour.rgb.0, colour.rgb.1, colour.rgb.2))
}

/// A whole SVG file round a drawn body.
///
/// `title` is what a screen reader says and what a browser shows on hovering.
pub fn document(body: &str, size_px: (f64, f64), title: &str) -> String {
    let (width, height) = (size_px.0.round(), size_px.1.round());
    let (wide, high) = (width * TENTHS, height * TENTHS);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {wide} {high}\" role=\"img\" \
         font-family=\"{FONTS}\" text-rendering=\"geometricPrecision\" stroke-linejoin=\"round\">\n<title>{}</title>\n\
         <rect x=\"0\" y=\"0\" width=\"{wide}\" height=\"{high}\" fill=\"#ffffff\"/>\n{body}</svg>\n",
        escape(title)
    )
}

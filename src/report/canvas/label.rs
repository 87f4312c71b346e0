//! Pieces of text: where they stand, how they look, what room they take.

use super::SMALL;
use crate::report::colour::INK;
use crate::report::svg::path::{PaperFrame, Spot};
use crate::report::svg::{CAP_HEIGHT, DEPTH, TENTHS, metrics};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, TextStyle};

/// A piece of text and where it stands.
#[derive(Clone)]
#[allow(missing_debug_implementations, reason = "a plotters anchor has none")]
pub struct Label {
    pub(super) text: String,
    /// What follows in the same line, in plain grey: an interval behind its value.
    pub(super) tail: String,
    pub(super) at: Spot,
    pub(super) size_px: f64,
    pub(super) colour: RGBColor,
    pub(super) is_bold: bool,
    pub(super) turn: FontTransform,
    pub(super) anchor: Pos,
}

impl Label {
    /// Small dark text that starts at `at`, centred in height.
    pub fn new(text: impl Into<String>, at: Spot) -> Self {
        let anchor = Pos::new(HPos::Left, VPos::Center);
        let turn = FontTransform::None;
        let (text, tail) = (text.into(), String::new());
        Self { text, tail, at, size_px: SMALL, colour: INK, is_bold: false, turn, anchor }
    }

    /// At another place.
    #[must_use]
    pub fn moved(mut self, at: Spot) -> Self {
        self.at = at;
        self
    }

    /// Its place.
    pub fn at(&self) -> Spot {
        self.at
    }

    /// Ends at its place.
    #[must_use]
    pub fn right(mut self) -> Self {
        self.anchor.h_pos = HPos::Right;
        self
    }

    /// Has its middle at its place.
    #[must_use]
    pub fn centred(mut self) -> Self {
        self.anchor.h_pos = HPos::Center;
        self
    }

    /// Hangs below its place.
    #[must_use]
    pub fn below(mut self) -> Self {
        self.anchor.v_pos = VPos::Top;
        self
    }

    /// Stands above its place.
    #[must_use]
    pub fn above(mut self) -> Self {
        self.anchor.v_pos = VPos::Bottom;
        self
    }

    /// In another size (px).
    #[must_use]
    pub fn sized(mut self, size_px: f64) -> Self {
        self.size_px = size_px;
        self
    }

    /// In another colour.
    #[must_use]
    pub fn coloured(mut self, colour: RGBColor) -> Self {
        self.colour = colour;
        self
    }

    /// In bold.
    #[must_use]
    pub fn bold(mut self) -> Self {
        self.is_bold = true;
        self
    }

    /// Followed by words in plain grey. One element: however wide the font, the second part begins where the first ends.
    #[must_use]
    pub fn followed_by(mut self, tail: impl Into<String>) -> Self {
        self.tail = tail.into();
        self
    }

    /// Width (px), in the widest font.
    pub fn width_px(&self) -> f64 {
        let head = if self.is_bold { metrics::bold_width_em } else { metrics::width_em };
        let gap = if self.tail.is_empty() { 0.0 } else { TAIL_GAP };
        (head(&self.text) + gap + metrics::width_em(&self.tail)) * self.size_px
    }

    /// The room it takes (px).
    pub fn frame(&self) -> PaperFrame {
        let (width, size) = (self.width_px(), self.size_px);
        let left = match self.anchor.h_pos {
            HPos::Left => self.at.0,
            HPos::Center => self.at.0 - 0.5 * width,
            HPos::Right => self.at.0 - width,
        };
        let baseline = match self.anchor.v_pos {
            VPos::Top => self.at.1 + CAP_HEIGHT * size,
            VPos::Center => self.at.1 + 0.5 * CAP_HEIGHT * size,
            VPos::Bottom => self.at.1 - DEPTH * size,
        };
        let (top, bottom) = (baseline - CAP_HEIGHT * size, baseline + DEPTH * size);
        if matches!(self.turn, FontTransform::None) {
            return PaperFrame { left, top, right: left + width, bottom };
        }
        // a quarter turn to the left about its place
        let ((x, y), right) = (self.at, left + width);
        PaperFrame {
            left: x + top - y,
            top: y - (right - x),
            right: x + bottom - y,
            bottom: y - (left - x),
        }
    }

    /// Reads from bottom to top.
    #[must_use]
    pub fn upwards(mut self) -> Self {
        self.turn = FontTransform::Rotate270;
        self
    }

    /// Whether there is nothing to write.
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    pub(super) fn style(&self) -> TextStyle<'static> {
        let face = if self.is_bold { FontStyle::Bold } else { FontStyle::Normal };
        FontDesc::new(FontFamily::SansSerif, self.size_px * TENTHS, face)
            .transform(self.turn.clone())
            .color(&self.colour)
            .pos(self.anchor)
    }
}

/// Gap before what follows a text, over the font size.
pub(super) const TAIL_GAP: f64 = 0.6;

/// A text cut to a width (px), with an ellipsis where something is missing.
pub fn fitted(text: &str, size_px: f64, width_px: f64) -> String {
    if text_width(text, size_px) <= width_px {
        return text.to_owned();
    }
    let mut short: Vec<char> = text.chars().collect();
    loop {
        let shown: String = short.iter().collect::<String>().trim_end().to_owned() + "…";
        if short.pop().is_none() || text_width(&shown, size_px) <= width_px {
            return shown;
        }
    }
}

/// Width of a text in bold (px).
pub fn bold_width(text: &str, size_px: f64) -> f64 {
    metrics::bold_width_em(text) * size_px
}

/// Width of a text (px).
pub fn text_width(text: &str, size_px: f64) -> f64 {
    metrics::width_em(text) * size_px
}

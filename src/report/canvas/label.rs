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

/// A name cut to a width (px) so that it is told from `all` others: where several would be cut to the same beginning, the word in which they
/// differ stands behind the cut, as the number of a line does.
pub fn fitted_among<'a>(
    name: &str,
    all: impl Iterator<Item = &'a str>,
    (size_px, width_px): (f64, f64),
) -> String {
    let plain = fitted(name, size_px, width_px);
    if plain == name {
        return plain;
    }
    let is_alike = |other: &&str| *other != name && fitted(other, size_px, width_px) == plain;
    let common = |other: &str| name.chars().zip(other.chars()).take_while(|(a, b)| a == b).count();
    let Some(same) = all.filter(is_alike).map(common).min() else { return plain };
    let letters: Vec<char> = name.chars().collect();
    let word = letters[..same].iter().rposition(|letter| *letter == ' ').map_or(same, |at| at + 1);
    let behind: String = letters[word..].iter().collect();
    let head = fitted(name, size_px, HEAD_OF_NAME * width_px);
    let room = width_px - text_width(&head, size_px);
    head + &fitted(&behind, size_px, room)
}

/// Part of its width that the beginning of a name takes which is cut in the middle (–).
const HEAD_OF_NAME: f64 = 0.4;

/// Width of a text in bold (px).
pub fn bold_width(text: &str, size_px: f64) -> f64 {
    metrics::bold_width_em(text) * size_px
}

/// Width of a text (px).
pub fn text_width(text: &str, size_px: f64) -> f64 {
    metrics::width_em(text) * size_px
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forty lines whose names begin alike keep their numbers, and one name alone is cut at its end.
    #[test]
    fn names_that_begin_alike_keep_what_tells_them_apart() {
        let name = |k: u32| format!("Auswertelinie Nummer {k} oberhalb der Kantonsstrasse");
        let names: Vec<String> = (1..=40).map(name).collect();
        let all = || names.iter().map(String::as_str);
        let room = (11.0, 110.0);
        let cut: Vec<String> = all().map(|name| fitted_among(name, all(), room)).collect();
        for (k, short) in (1..).zip(&cut) {
            assert!(
                short.contains(&format!("…{k}")) && text_width(short, room.0) <= room.1,
                "{short}"
            );
            assert_eq!(cut.iter().filter(|other| *other == short).count(), 1, "{short}");
        }
        let alone = fitted_among(&names[0], std::iter::once(names[0].as_str()), room);
        assert_eq!(alone, fitted(&names[0], room.0, room.1));
        assert!(alone.starts_with("Auswertelinie"), "{alone}");
    }
}

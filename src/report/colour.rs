//! Colours that survive colour blindness and a grey printer.

use plotters::style::RGBColor;
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};

/// Text and frames.
pub const INK: RGBColor = RGBColor(34, 34, 34);
/// Secondary text.
pub const GREY: RGBColor = RGBColor(105, 105, 105);
/// Lines that must not compete with data.
pub const PALE: RGBColor = RGBColor(226, 226, 226);
/// Paper.
pub const WHITE: RGBColor = RGBColor(255, 255, 255);
/// Okabe–Ito blue.
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
/// Okabe–Ito sky blue.
pub const SKY: RGBColor = RGBColor(86, 180, 233);
/// Okabe–Ito bluish green.
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
/// A darker green: text that belongs to something green.
pub const DARK_GREEN: RGBColor = RGBColor(0, 96, 70);
/// Okabe–Ito orange.
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
/// Okabe–Ito vermillion.
pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
/// A darker vermillion: the densest class of deposits.
pub const DARK_VERMILLION: RGBColor = RGBColor(140, 45, 0);
/// Okabe–Ito reddish purple.
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);

/// The part of viridis used: its yellow end is lost on white paper.
const LIGHTEST: f64 = 0.86;

/// Colour of a share (0..1) of the scale: light green for little, dark violet for much, so that a grey print reads the same.
pub fn sequential(share: f64) -> RGBColor {
    ViridisRGB.get_color(LIGHTEST * (1.0 - share.clamp(0.0, 1.0)))
}

/// `#rrggbb`.
pub fn hex(colour: RGBColor) -> String {
    format!("#{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2)
}

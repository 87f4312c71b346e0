//! Widths of Helvetica, so that labels find their room without a font file.

use super::{RAISED_SIZE, lowered};

/// Advance widths of the characters 32 to 126 in thousandths of the font size (Adobe Font Metrics, Helvetica).
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278,
    278, // space to /
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, // 0 to 9
    278, 278, 584, 584, 584, 556, 1015, // : to @
    667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, // A to M
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, // N to Z
    278, 278, 278, 469, 556, 333, // [ to `
    556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, // a to m
    556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, // n to z
    334, 260, 334, 584, // { to ~
];

/// Width of a text over the font size.
pub fn width_em(text: &str) -> f64 {
    text.chars().map(char_em).sum()
}

fn char_em(c: char) -> f64 {
    if let Some(plain) = lowered(c) {
        return RAISED_SIZE * char_em(plain);
    }
    let thousandths = match c {
        ' '..='~' => WIDTHS[c as usize - 32],
        '\u{2009}' => 200,
        '·' | '\u{a0}' => 278,
        '−' | '×' | '≤' | '≥' => 584,
        '°' => 400,
        // most letters with accents and the en dash are as wide as a figure
        _ => 556,
    };
    f64::from(thousandths) / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The widths printed in the metrics file: T 611, i 222, c 500, k 500.
    #[test]
    fn a_word_is_as_wide_as_its_letters() {
        assert!((width_em("Tick") - 1.833).abs() < 1e-12);
        assert!(width_em("10⁻⁵") < width_em("10-5") + 0.3);
    }
}

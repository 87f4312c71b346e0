//! Widths of the fonts that a reader's machine may have, so that labels find their room without a font file.
//!
//! A drawing names Helvetica and its look-alikes first; where none is installed a browser takes `DejaVu` Sans, which is up to a
//! fifth wider. Room is measured with the wider of the two, so that nothing is cut or overprinted with either.

use super::{RAISED_SIZE, lowered};

/// A family of fonts with the same widths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FontFamily {
    /// Helvetica, Arial, Liberation Sans.
    Helvetica,
    /// `DejaVu` Sans, Verdana's width.
    DejaVu,
}

impl FontFamily {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Helvetica, Self::DejaVu];
}

// Advance widths of the characters 32 to 126 in thousandths of the font size, as the fonts' own tables have them.
/// Helvetica and Liberation Sans.
const HELVETICA: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];
/// The same, bold.
const HELVETICA_BOLD: [u16; 95] = [
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 333, 333, 584, 584, 584, 611, 975, 722, 722, 722, 722, 667,
    611, 778, 722, 278, 556, 722, 611, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 333, 278, 333, 584, 556, 333, 556, 611, 556, 611, 556, 333, 611, 611, 278, 278, 556,
    278, 889, 611, 611, 611, 611, 389, 556, 333, 611, 556, 778, 556, 556, 500, 389, 280, 389, 584,
];
/// `DejaVu` Sans.
const DEJAVU: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352, 635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838,
];
/// The same, bold.
const DEJAVU_BOLD: [u16; 95] = [
    348, 456, 521, 838, 696, 1002, 872, 306, 457, 457, 523, 838, 380, 415, 380, 365, 696, 696, 696,
    696, 696, 696, 696, 696, 696, 696, 400, 400, 838, 838, 838, 580, 1000, 774, 762, 734, 830, 683,
    683, 821, 837, 372, 372, 775, 637, 995, 837, 850, 733, 850, 770, 720, 682, 812, 774, 1103, 771,
    724, 725, 457, 365, 457, 838, 500, 500, 675, 716, 593, 716, 678, 435, 716, 712, 343, 343, 665,
    343, 1042, 712, 687, 716, 716, 493, 595, 478, 712, 652, 924, 645, 652, 582, 712, 365, 712, 838,
];

/// Width of a text over the font size, in the wider face.
pub fn width_em(text: &str) -> f64 {
    widest(text, false)
}

/// The same in bold.
pub fn bold_width_em(text: &str) -> f64 {
    widest(text, true)
}

fn widest(text: &str, is_bold: bool) -> f64 {
    FontFamily::ALL.into_iter().map(|face| width_em_in(face, text, is_bold)).fold(0.0, f64::max)
}

/// Width of a text over the font size, in one face.
pub fn width_em_in(face: FontFamily, text: &str, is_bold: bool) -> f64 {
    text.chars().map(|c| char_em(face, c, is_bold)).sum()
}

fn char_em(face: FontFamily, c: char, is_bold: bool) -> f64 {
    if let Some(plain) = lowered(c) {
        return RAISED_SIZE * char_em(face, plain, is_bold);
    }
    let table = match (face, is_bold) {
        (FontFamily::Helvetica, false) => &HELVETICA,
        (FontFamily::Helvetica, true) => &HELVETICA_BOLD,
        (FontFamily::DejaVu, false) => &DEJAVU,
        (FontFamily::DejaVu, true) => &DEJAVU_BOLD,
    };
    let is_dejavu = face == FontFamily::DejaVu;
    let thousandths = match c {
        ' '..='~' => table[c as usize - 32],
        '\u{2009}' => 200,
        '·' | '\u{a0}' => table[0].max(278) + if is_bold { 50 } else { 0 },
        '−' | '×' | '≤' | '≥' | '→' => {
            if is_dejavu {
                838
            } else {
                584
            }
        }
        '°' => {
            if is_dejavu {
                500
            } else {
                400
            }
        }
        '–' => {
            if is_dejavu {
                500
            } else {
                556
            }
        }
        '…' => 1000,
        // the widest of the letters with accents and of the quotation marks
        _ => match (is_dejavu, is_bold) {
            (false, false) => 571,
            (false, true) => 619,
            (true, false) => 640,
            (true, true) => 719,
        },
    };
    f64::from(thousandths) / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The widths printed in the metrics file of Helvetica: T 611, i 222, c 500, k 500.
    #[test]
    fn a_word_is_as_wide_as_its_letters() {
        assert!((width_em_in(FontFamily::Helvetica, "Tick", false) - 1.833).abs() < 1e-12);
        assert!(width_em("10⁻⁵") < width_em("10-5") + 0.3);
        assert!(width_em("Tick") >= width_em_in(FontFamily::DejaVu, "Tick", false));
        assert!(bold_width_em("Tick") > width_em("Tick"));
    }
}

//! Ends of intervals, rounded outward: what is told holds all that is known.

use super::{THIN_SPACE, exponent_of, significant};
use crate::math;

/// Which way a number is rounded to its last digit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Toward {
    /// The nearest: a value.
    Nearest,
    /// Down: the lower end of an interval.
    Below,
    /// Up: the upper end.
    Above,
}

/// A value and the ends of its interval.
pub(super) const EACH: [Toward; 3] = [Toward::Nearest, Toward::Below, Toward::Above];

/// What binary leaves behind a number of few digits (–): it is that number.
const BINARY: f64 = 1e-9;

/// An end so many times as far from nothing as the value, or as near to it (–), bounds nothing.
const FAR: f64 = 1e9;

impl Toward {
    /// A number whose last digit stands at the place `last` (power of ten).
    pub(in crate::report) fn at_place(self, number: f64, last: i32) -> f64 {
        if self == Self::Nearest || !number.is_finite() {
            return number;
        }
        // powers of ten with a negative exponent are none of binary
        let size = math::pow(10.0, f64::from(last.abs()));
        let places = if last < 0 { number * size } else { number / size };
        let near = places.round();
        let whole = match self {
            _ if (places - near).abs() <= BINARY * near.abs().max(1.0) => near,
            Self::Above => places.ceil(),
            _ => places.floor(),
        };
        if last < 0 { whole / size } else { whole * size }
    }

    /// A number of so many digits.
    pub(in crate::report) fn to_digits(self, number: f64, digits: usize) -> f64 {
        match exponent_of(number) {
            i32::MAX => number,
            exponent => {
                let digits = i32::try_from(digits).unwrap_or(i32::MAX);
                self.at_place(number, exponent + 1 - digits)
            }
        }
    }
}

/// The same where an end that is a thousand millionth of the value is 0, and none where it is a thousand million times as large: both say no
/// more than that there is no such bound, and stood there as 10⁻¹⁸³.
pub(super) fn within_reach([value, low, high]: [f64; 3]) -> [f64; 3] {
    // also of no number
    if !(value > 0.0 && value.is_finite()) {
        return [value, low, high];
    }
    let low = if low > 0.0 && low * FAR < value { 0.0 } else { low };
    let high = if high > value * FAR { f64::NAN } else { high };
    [value, low, high]
}

/// The upper end of a share (0..1) in per cent, to two digits and never below it: none of 10 000 bounds a share by 0.030 %,
/// and not by 0.0 %.
pub fn percent_at_most(share: f64) -> String {
    format!("{}{THIN_SPACE}%", significant(Toward::Above.to_digits(100.0 * share, 2), 2))
}

#[cfg(test)]
mod tests {
    use super::super::with_interval;

    fn said(all: [f64; 3]) -> String {
        with_interval(all).join(" ").replace('\u{2009}', " ")
    }

    /// Rounded to the nearest, 70.46 to 75.64 left out what lies beside 70.5 and 75.6.
    #[test]
    fn ends_are_rounded_outward() {
        assert_eq!(said([73.32, 70.46, 75.64]), "73.3 70.4 75.7");
        assert_eq!(said([-73.32, -75.64, -70.46]), "−73.3 −75.7 −70.4");
        assert_eq!(said([104.2, 48.0, 322.0]), "100 40 330");
        assert_eq!(said([518.6, 423.6, f64::NAN]), "519 423 –");
        assert_eq!(said([f64::NAN, 51.27, f64::NAN]), "– 51.2 –");
        // what is told in full stays what it is, and so does an interval without width
        assert_eq!(said([0.3, 0.1, 0.7]), "0.30 0.10 0.70");
        assert_eq!(said([1.0 / 3.0; 3]), "0.3333 0.3333 0.3333");
    }

    /// A rock that stands for nearly all events leaves 10⁻¹⁸³ a year below, and 10¹⁸³ years above.
    #[test]
    fn ends_out_of_reach_are_none() {
        assert_eq!(said([0.005, 1e-183, 2.3641]), "0.0050 0 2.4");
        assert_eq!(said([200.0, 0.423, 1e183]), "200 0.42 –");
    }
}

//! Numbers and text as a reader expects them: thin-space thousands, a true minus, raised powers.

mod outward;

use super::bound::Is;
pub use crate::count::{counted, shortest};
use crate::math;
pub(super) use outward::Toward;
pub use outward::percent_at_most;
use outward::{EACH, within_reach};

/// Stands between groups of three digits.
const THIN_SPACE: char = '\u{2009}';
const MINUS: char = '\u{2212}';
/// Stands for a number that is not there.
pub const NO_NUMBER: &str = "–";
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// `value` with a fixed number of decimals, thousands set apart.
pub fn decimal(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return NO_NUMBER.to_owned();
    }
    let plain = format!("{:.decimals$}", value.abs());
    let (whole, rest) = plain.split_at(plain.find('.').unwrap_or(plain.len()));
    let is_negative = value < 0.0 && plain.bytes().any(|b| (b'1'..=b'9').contains(&b));
    let mut text = String::new();
    if is_negative {
        text.push(MINUS);
    }
    for (i, digit) in whole.chars().enumerate() {
        if i > 0 && (whole.len() - i).is_multiple_of(3) {
            text.push(THIN_SPACE);
        }
        text.push(digit);
    }
    text + rest
}

/// A round number as it is, with no more decimals than it has: `2.5`, `10`, `0.025`; what a change of its unit leaves is none of them.
pub fn plain(value: f64) -> String {
    let value = shortest(value);
    let text = value.abs().to_string();
    decimal(value, text.split_once('.').map_or(0, |(_, decimals)| decimals.len()))
}

/// `value` to so many significant digits (at least all whole digits), as a power of ten when very small or large.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return NO_NUMBER.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // the exponent after rounding: 9.996 to three digits is 10.0
    let rounded = format!("{:.*e}", digits.max(1) - 1, value);
    let exponent = rounded.split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    if (-4..9).contains(&exponent) {
        decimal(value, (digits as f64 - 1.0 - f64::from(exponent)).max(0.0) as usize)
    } else {
        scientific(value, digits.max(1) - 1)
    }
}

/// `value` as `m×10ⁿ`, the mantissa with so many decimals and left out where it is 1.
pub fn scientific(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return decimal(value, decimals) };
    let power = power_of_ten(exponent.parse().unwrap_or(0));
    match mantissa.parse::<f64>() {
        Ok(m) if (m - 1.0).abs() < 1e-12 => power,
        Ok(m) if (m + 1.0).abs() < 1e-12 => format!("{MINUS}{power}"),
        Ok(m) => format!("{}×{power}", decimal(m, decimals)),
        Err(_) => NO_NUMBER.to_owned(),
    }
}

/// `10ⁿ` with raised digits.
pub fn power_of_ten(exponent: i32) -> String {
    let mut text = String::from("10");
    if exponent < 0 {
        text.push('⁻');
    }
    let digits = exponent.unsigned_abs().to_string();
    text.extend(digits.bytes().map(|digit| RAISED[usize::from(digit - b'0')]));
    text
}

/// The plain character of a raised one.
pub fn lowered(raised: char) -> Option<char> {
    if raised == '⁻' {
        return Some(MINUS);
    }
    let digit = RAISED.iter().position(|&c| c == raised)?;
    char::from_digit(digit as u32, 10)
}

/// Stands before a number that is only a bound.
pub fn sign(is: Is) -> &'static str {
    match is {
        Is::Value | Is::Lacking(_) => "",
        Is::AtLeast => "≥\u{2009}",
        Is::AtMost => "≤\u{2009}",
    }
}

/// A share (0..1) in per cent with a fixed number of decimals.
pub fn percent(share: f64, decimals: usize) -> String {
    if !share.is_finite() {
        return NO_NUMBER.to_owned();
    }
    format!("{}{THIN_SPACE}%", decimal(100.0 * share, decimals))
}

/// A share of some things in per cent, with as many more decimals as keep a part from looking like all or none of them: 398 of 400 are
/// 99.5 %, and not 100 %.
pub fn percent_of_part(share: f64, decimals: usize) -> String {
    let is_part = share > 0.0 && share < 1.0;
    let with = |more: usize| percent(share, decimals + more);
    let is_told =
        |more: &usize| [0.0, 1.0].iter().all(|all| with(*more) != percent(*all, decimals + more));
    with((0..=usize::from(MOST_MORE)).find(|more| !is_part || is_told(more)).unwrap_or(0))
}

/// Digits that a number may get beyond its own before its interval is seen: a share of 10⁻⁸ still is.
const MOST_MORE: u8 = 6;

/// A number and the ends of its interval, as `write` writes each with so many digits more: none, but where rounding makes all three
/// the same and the ends differ, as many as tell them apart.
fn told_apart(all: [f64; 3], write: impl Fn(f64, Toward, u8) -> String) -> [String; 3] {
    let with = |toward: [Toward; 3], more: u8| [0, 1, 2].map(|k| write(all[k], toward[k], more));
    let [_, low, high] = all;
    let most = if low < high { MOST_MORE } else { 0 };
    // rounded outward the ends would stand apart with any digits
    let is_seen = |more: &u8| {
        let [value, low, high] = with([Toward::Nearest; 3], *more);
        value != low || low != high
    };
    with(EACH, (0..=most).find(is_seen).unwrap_or(0))
}

/// A number and the ends of its interval, where they are known, with as many digits as the interval leaves meaningful; ends outward.
pub(super) fn with_interval(all: [f64; 3]) -> [String; 3] {
    let all @ [value, low, high] = within_reach(all);
    let width = match (low.is_finite(), high.is_finite()) {
        (true, false) => (value - low).abs(),
        (false, true) => (high - value).abs(),
        _ => high - low,
    };
    if !(width.is_finite() && width > 0.0 && value.is_finite()) {
        // what was rounded to two digits before stays so
        if !(low.is_finite() || high.is_finite())
            && (value - math::rounded(value, 2)).abs() < 1e-12 * value.abs()
        {
            let is_plain = (-4..9).contains(&exponent_of(value));
            let write = |number: f64| {
                if number.is_finite() && is_plain { plain(number) } else { significant(number, 2) }
            };
            return all.map(write);
        }
        // alone: a maximum is read as it is, a small derivative or a bound only for its size
        let digits = if value.abs() >= 0.1 { 4 } else { 3 };
        return told_apart(all, |number, toward, more| {
            let digits = digits + usize::from(more);
            // beside no value an end is all that is known; an interval without width has no outside
            let is_alone = value.is_nan();
            let number = if is_alone { toward.to_digits(number, digits) } else { number };
            like(value, digits)(number)
        });
    }
    if all.iter().all(|number| !number.is_finite() || is_as_written(*number)) {
        return all.map(|number| decimal(number, 0));
    }
    let place = last_place(value, width);
    // ends stand to the place of the value, where that is one of its own
    let least = if digits_to(value, place) >= 2 { 1 } else { 2 };
    told_apart(all, |number, toward, more| {
        to_place((number, toward), place - i32::from(more), least)
    })
}

/// The place of the last digit (power of ten) that an interval of that width leaves to a value: it is at most a fifth of the interval,
/// but three digits stay as long as the interval has two of its own there; five at most.
fn last_place(value: f64, width: f64) -> i32 {
    let of_width = exponent_of(width);
    let fifth = exponent_of(0.2 * width);
    if value == 0.0 {
        return fifth;
    }
    let leading = exponent_of(value);
    fifth.min((leading - 2).max(of_width - 1)).max(leading - 4)
}

/// Power of ten of the first digit; 0 of 0, the largest of what is no number.
fn exponent_of(value: f64) -> i32 {
    if !value.is_finite() {
        return i32::MAX;
    }
    if value == 0.0 { 0 } else { math::log10(value.abs()).floor() as i32 }
}

/// Digits that a number has down to a place.
fn digits_to(number: f64, place: i32) -> i32 {
    exponent_of(number) - place + 1
}

/// A number to a place; one that has fewer digits there than it needs, as beside an interval far wider than it is, has two of its own.
fn to_place((number, toward): (f64, Toward), place: i32, least: usize) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    // an end that is no number has no place
    if !number.is_finite() {
        return significant(number, 2);
    }
    match usize::try_from(digits_to(number, place)) {
        Ok(digits) if digits >= least => like(number, digits)(toward.at_place(number, place)),
        _ => significant(math::rounded(toward.to_digits(number, 2), 2), 2),
    }
}

/// Whether a number without interval is a count, or one as it was written.
pub(super) fn is_as_written(value: f64) -> bool {
    value.fract() == 0.0 && value.abs() < 1e7
}

/// A number that stands alone: a maximum, a count.
pub(super) fn alone(value: f64) -> String {
    if is_as_written(value) {
        return decimal(value, 0);
    }
    let [value, ..] = with_interval([value, f64::NAN, f64::NAN]);
    value
}

/// A number to so many digits, zeros behind them.
pub(super) fn to_digits(value: f64, digits: usize) -> String {
    like(value, digits)(value)
}

/// Writes numbers to the last place that a value of so many digits has: its interval ends where it ends.
fn like(value: f64, digits: usize) -> impl Fn(f64) -> String {
    let exponent = exponent_of(value);
    let last = f64::from(exponent) - digits as f64 + 1.0;
    move |v| {
        if (-4..9).contains(&exponent) {
            rounded_at(v, last)
        } else {
            significant(math::rounded(v, digits), digits)
        }
    }
}

/// A number whose last digit stands at the place `last` (power of ten): from 1 on zeros follow it.
pub(super) fn rounded_at(value: f64, last: f64) -> String {
    if last <= 0.0 {
        return decimal(value, -last as usize);
    }
    let place = math::pow(10.0, last);
    decimal((value / place).round() * place, 0)
}

/// A share (0..1) and the ends of its interval in per cent, by the rule of [all numbers](with_interval); so many decimals without one.
pub(super) fn percents(all: [f64; 3], decimals: impl Fn(f64) -> usize) -> [String; 3] {
    let [_, low, high] = all;
    if low < high {
        let numbers = with_interval(all.map(|share| 100.0 * share));
        return numbers.map(|number| format!("{number}{THIN_SPACE}%"));
    }
    all.map(|share| percent(share, decimals(share)))
}

/// Text that may stand inside an element or a quoted attribute of SVG and HTML.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // XML has no way to write the other control characters, nor the two non-characters
            c if c.is_control() && !matches!(c, '\n' | '\t') => {}
            '\u{fffe}' | '\u{ffff}' => {}
            c => safe.push(c),
        }
    }
    safe
}

/// A sentence begins with a capital letter, but for the name of a file or of a key, and ends with a full stop.
pub(super) fn sentence(text: &str) -> String {
    let mut words = text.split_whitespace();
    let word = words.next().unwrap_or_default();
    let is_key = word.contains('_') || words.next() == Some("=");
    let is_file = word.trim_end_matches(['.', ':', ',']).contains(['.', '/', '\\']);
    let mut letters = text.chars();
    let first = if is_file || is_key { None } else { letters.next() };
    let whole: String = first.into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    if whole.ends_with(['.', '!', '?', '…']) { whole } else { whole + "." }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_in_print() {
        assert_eq!(decimal(2_600_000.0, 0), "2\u{2009}600\u{2009}000");
        assert_eq!(decimal(-1234.5, 1), "\u{2212}1\u{2009}234.5");
        assert_eq!(decimal(-0.04, 1), "0.0", "no negative zero");
        assert_eq!(decimal(f64::NAN, 1), NO_NUMBER);
        assert_eq!(significant(9.996, 3), "10.0");
        assert_eq!(significant(0.000_012_34, 3), "1.23×10⁻⁵");
        assert_eq!(significant(123_456.0, 3), "123\u{2009}456");
        assert_eq!(scientific(1e-5, 0), "10⁻⁵");
        assert_eq!(power_of_ten(12), "10¹²");
        assert_eq!(percent(0.9996, 1), "100.0\u{2009}%");
        assert_eq!([2.5, 10.0, 0.025, 1e4].map(plain), ["2.5", "10", "0.025", "10\u{2009}000"]);
    }

    #[test]
    fn a_part_is_not_all() {
        let said = [0.995, 1.0, 0.99996, 0.5, 0.0, 0.004].map(|share| percent_of_part(share, 0));
        let expected = ["99.5", "100", "99.996", "50", "0", "0.4"];
        assert_eq!(said, expected.map(|number| format!("{number}\u{2009}%")));
    }

    /// Only where rounding hides the interval there are more digits, and an interval without width has none to show.
    #[test]
    fn an_interval_is_seen_where_it_has_a_width() {
        let said = |all: [f64; 3]| percents(all, |share| usize::from(share < 0.1)).join(" ");
        let written = |said: &str| said.replace('%', "\u{2009}%");
        assert_eq!(said([0.9400, 0.9396, 0.9404]), written("94.00% 93.96% 94.04%"));
        assert_eq!(said([0.94, 0.93, 0.95]), written("94% 93% 95%"));
        assert_eq!(said([0.0, 0.0, 0.0003]), written("0% 0% 0.030%"));
        assert_eq!(said([0.000_443, 0.000_04, 0.010_056]), written("0.044% 0.0040% 1.1%"));
        assert_eq!(said([0.0, 0.0, 0.0]), written("0.0% 0.0% 0.0%"));
        assert_eq!(said([1.0, 1.0, 1.0]), written("100% 100% 100%"));
        assert_eq!(said([0.5, f64::NAN, f64::NAN]), written("50% – –"));
    }

    /// No number has more digits than its interval leaves it; one far smaller than its interval has two.
    #[test]
    fn an_interval_says_how_many_digits_are_told() {
        let said = |all: [f64; 3]| with_interval(all).join(" ").replace('\u{2009}', " ");
        assert_eq!(said([73.32, 70.41, 75.68]), "73.3 70.4 75.7");
        assert_eq!(said([108.2, 104.9, 113.6]), "108 104 114");
        assert_eq!(said([4.2, 3.53, 7.34]), "4.2 3.5 7.4");
        assert_eq!(said([104.2, 43.0, 330.0]), "100 40 330");
        assert_eq!(said([2.6, 0.49, 4.7]), "2.6 0.4 4.7");
        // counts stay counts
        assert_eq!(said([5.0, 4.0, 6.0]), "5 4 6");
        assert_eq!(said([0.000_98, 0.000_002_2, 0.975_166]), "0.00098 2.2×10⁻⁶ 0.98");
        assert_eq!(said([41_500.0, 41.8, 28_972_000.0]), "42 000 41 29 000 000");
        assert_eq!(said([0.005, 0.0, 2.3641]), "0.0050 0 2.4");
        assert_eq!(said([518.6, 423.6, f64::NAN]), "519 423 –");
    }

    /// A bound that is rounded down is none: none of 2000 leaves up to 0.15 %, which in binary is a little less.
    #[test]
    fn an_upper_end_is_not_rounded_down() {
        let said = [1.0, 0.5, 0.121, 0.0015, 0.0003, 1e-5, 0.0].map(percent_at_most).join(" ");
        let written = "100% 50% 13% 0.15% 0.030% 0.0010% 0%".replace('%', "\u{2009}%");
        assert_eq!(said, written);
    }

    /// `Zones.geojson` is another file than `zones.geojson`.
    #[test]
    fn a_sentence_keeps_the_name_of_a_file() {
        assert_eq!(sentence("zones.geojson says so"), "zones.geojson says so.");
        assert_eq!(sentence("../drawn/zones says so"), "../drawn/zones says so.");
        assert_eq!(sentence("mesh: coarse"), "Mesh: coarse.");
    }

    #[test]
    fn keys_keep_their_small_letters() {
        assert_eq!(sentence("step_s = 0.1 is long"), "step_s = 0.1 is long.");
        assert_eq!(
            sentence("epsg = 4326 is a geographic system"),
            "epsg = 4326 is a geographic system."
        );
        assert_eq!(sentence("rocks fall."), "Rocks fall.");
        assert_eq!(sentence("a/b.stl: odd"), "a/b.stl: odd.");
    }

    #[test]
    fn what_a_user_wrote_stays_text() {
        let nasty = "</title><script>alert('1 & \"2\"')</script>\u{0}\u{1b}";
        let safe = escape(nasty);
        assert!(!safe.contains('<') && !safe.contains('"') && !safe.contains('\u{0}'));
        assert!(safe.contains("&lt;script&gt;"));
    }
}

//! Numbers of things in words.

/// A number of things whose name takes an s where they are many.
pub fn number_of(count: u64, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// One or many of something, by the number of them.
pub fn counted<'a>(count: usize, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}

/// A number that somebody wrote, without what a change of its unit has left behind its twelfth digit: 30 000.4 J are 30.0004 kJ.
pub fn shortest(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_unit_leaves_no_digits_behind() {
        assert_eq!((30_000.4 / 1e3).to_string(), "30.000400000000003");
        let kilo = |value: f64| shortest(value / 1e3).to_string();
        assert_eq!([30_000.4, 30e3, 2_500.0, 1.0].map(kilo), ["30.0004", "30", "2.5", "0.001"]);
        assert!(shortest(f64::INFINITY).is_infinite());
    }

    #[test]
    fn one_thing_is_no_plural() {
        assert_eq!([0, 1, 2].map(|n| number_of(n, "byte")), ["0 bytes", "1 byte", "2 bytes"]);
    }
}

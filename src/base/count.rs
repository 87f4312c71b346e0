//! Numbers of things in words.

/// A number of things whose name takes an s where they are many.
pub fn number_of(count: u64, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// One or many of something, by the number of them.
pub fn counted<'a>(count: usize, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_thing_is_no_plural() {
        assert_eq!([0, 1, 2].map(|n| number_of(n, "byte")), ["0 bytes", "1 byte", "2 bytes"]);
    }
}

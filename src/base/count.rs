//! Numbers of things in words.

/// One or many of something, by the number of them.
pub fn counted<'a>(count: usize, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}

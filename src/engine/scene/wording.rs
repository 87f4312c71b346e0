//! The TOML reader's messages in the words of a scene's author.

use super::check::suggest;

/// One message, taken apart.
pub(super) struct Said {
    /// The key that is missing, if that is the trouble.
    pub(super) missing: Option<String>,
    /// What was found.
    pub(super) found: String,
    /// What to write instead.
    pub(super) remedy: String,
}

impl Said {
    pub(super) fn new(found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { missing: None, found: found.into(), remedy: remedy.into() }
    }
}

/// Takes a message of `serde` or of the TOML parser apart; what is not recognised is passed on as it is.
pub(super) fn of(message: &str) -> Said {
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if message.starts_with("missing field") {
        let key = quoted.first().copied().unwrap_or_default();
        let said = Said::new("found nothing", format!("write {key} = …; it has no default"));
        return Said { missing: Some(key.to_owned()), ..said };
    }
    if message.starts_with("unknown field") || message.starts_with("unknown variant") {
        let (word, known) = quoted.split_first().unwrap_or((&"", &[]));
        // the parser's own name for what a date holds
        if word.starts_with("$__toml") {
            return Said::new("found a date or time", suggest("", known));
        }
        return Said::new(format!("found the unknown word {word}"), suggest(word, known));
    }
    for kind in ["invalid type: ", "invalid value: ", "invalid length "] {
        let parts = message.strip_prefix(kind).and_then(|rest| rest.rsplit_once(", expected "));
        if let Some((found, expected)) = parts {
            if let Some(number) = found.strip_suffix(" as i128") {
                return Said::new(format!("found {number}"), "write a smaller whole number");
            }
            let entries = if kind == "invalid length " { " entries" } else { "" };
            return Said::new(
                format!("found {found}{entries}"),
                format!("write {}", plain(expected)),
            );
        }
    }
    if message == "duplicate key" {
        return Said::new("found it a second time", "write every key and every table once");
    }
    if message == "wanted string or table" {
        let remedy = "write one of the words of this key in quotes; docs/scene.md lists them";
        return Said::new("found no text", remedy);
    }
    match message.split_once("; ") {
        Some((found, remedy)) => Said::new(found, remedy),
        None => Said::new(message, "write it as TOML asks (https://toml.io)"),
    }
}

/// What is wrong with a line that is no TOML, in the cases that come up: no value, a decimal comma, a text without quotes.
pub(super) fn of_line(line: &str) -> Option<Said> {
    let (key, value) = line.split('#').next()?.split_once('=')?;
    let (key, value) = (key.trim(), value.trim());
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    if value.is_empty() {
        return Some(Said::new(format!("found no value of {key}"), format!("write {key} = …")));
    }
    if let Some((whole, decimals)) = value.split_once(',')
        && is_number(whole)
        && is_number(decimals)
    {
        let remedy = format!("write {key} = {whole}.{decimals}, with a decimal point");
        return Some(Said::new(format!("found {value}"), remedy));
    }
    let is_bare = value.starts_with(char::is_alphabetic) && !value.contains(['"', '\'']);
    let is_word = ["true", "false", "inf", "nan"].contains(&value);
    (is_bare && !is_word).then(|| {
        Said::new(
            format!("found {value}"),
            format!("write {key} = \"{value}\": texts stand in quotes"),
        )
    })
}

/// Names of types as a scene's author would say them.
fn plain(expected: &str) -> String {
    match expected {
        "f64" => "a number".to_owned(),
        "u32" => format!("a whole number from 0 to {}", u32::MAX),
        "u64" | "usize" => "a whole number of 0 or more".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a string" | "path string" => "a text in quotes".to_owned(),
        "a sequence" => "a list in [ ]".to_owned(),
        "a map" => "tables with names, such as [grounds.rock]".to_owned(),
        other => match other.strip_prefix("an array of length ") {
            Some(length) => format!("a list of {length} entries"),
            None => other.to_owned(),
        },
    }
}

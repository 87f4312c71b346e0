//! A scene file with other ground values, every other letter of it as it was written.

use super::check::TrailStep;
use super::source::Lookup;
use crate::error::{Error, Result};
use crate::file;
use std::ops::Range;
use std::path::Path;

/// A key of a ground that another gives as well: a scene has one of them.
const OTHERWISE: (&str, &str) = ("tangential_ratio", "shear_stiffness_n_m");

/// The text of a scene file with other values: ground, key (of a table inside of the ground with a point between) and what
/// to write. Paths are written in full, so that the text
/// may stand in another folder.
///
/// # Errors
/// A file that cannot be read, or a ground that is not there.
pub fn rewritten(scene: &Path, values: &[(String, &str, String)]) -> Result<String> {
    let text = file::read_text(scene)?;
    let lookup = Lookup::of(scene, &text);
    let mut changes: Vec<(Range<usize>, String)> = Vec::new();
    for (ground, key, value) in values {
        let table = [TrailStep::Key("grounds".to_owned()), TrailStep::Key(ground.clone())];
        let value_at = |key: &str| {
            let keys = key.split('.').map(|key| TrailStep::Key(key.to_owned()));
            lookup.value_at(&table.iter().cloned().chain(keys).collect::<Vec<_>>())
        };
        let other = value_at(OTHERWISE.1).filter(|_| *key == OTHERWISE.0);
        let change = match (value_at(key), other, lookup.value_at(&table)) {
            (Some(range), ..) => (range, value.clone()),
            (None, Some(other), _) => {
                let start = text[..other.start].rfind(OTHERWISE.1).unwrap_or(other.start);
                (start..other.end, format!("{key} = {value}"))
            }
            // of a table with a header the header alone
            (None, None, Some(header)) => (header.end..header.end, format!("\n{key} = {value}")),
            (None, None, None) => {
                let found = format!("found no [grounds.{ground}]");
                return Err(Error::input(scene, "[grounds]", found, "write the scene as it was"));
            }
        };
        changes.push(change);
    }
    let folder = scene.parent().unwrap_or(Path::new(""));
    for range in lookup.paths() {
        let path: Option<String> =
            text[range.clone()].parse::<toml::Value>().ok().and_then(|path| {
                let path = folder.join(path.as_str()?);
                let full = path.canonicalize().unwrap_or(path);
                Some(toml::Value::String(full.to_str()?.to_owned()).to_string())
            });
        changes.extend(path.map(|path| (range, path)));
    }
    // from the end on, so that the places before stay where they are
    changes.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
    let mut written = text.clone();
    for (range, value) in changes {
        written.replace_range(range, &value);
    }
    Ok(written)
}

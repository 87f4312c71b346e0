//! A scene file with other ground values, every other letter of it as it was written.

use super::check::TrailStep;
use super::source::Lookup;
use crate::error::{Error, Result};
use crate::file;
use std::ops::Range;
use std::path::Path;

/// A key of a ground that another gives as well: a scene has one of them.
const OTHERWISE: (&str, &str) = ("tangential_ratio", "shear_stiffness_n_m");

/// A value of a scene: its ground (none: of every shape), its key (of a table inside of the ground with a point between), and
/// what to write.
pub(super) type NewValue = (Option<String>, &'static str, String);

/// Bytes of a text, and what stands there instead.
type Replacement = (Range<usize>, String);

/// The text of a scene file with other values, which `[calibrate]` notes as fitted. Paths are written in full, so that the
/// text may stand in another folder.
///
/// # Errors
/// A file that cannot be read, or a ground that is not there.
pub fn rewritten(scene: &Path, values: &[NewValue]) -> Result<String> {
    let text = file::read_text(scene)?;
    let lookup = Lookup::of(scene, &text);
    let mut changes: Vec<Replacement> = Vec::new();
    for (ground, key, value) in values {
        let Some(ground) = ground else {
            changes.extend(of_shapes(&lookup, key, value));
            continue;
        };
        let Some(change) = of_ground((&lookup, &text), ground, (key, value)) else {
            let found = format!("found no [grounds.{ground}]");
            return Err(Error::input(scene, "[grounds]", found, "write the scene as it was"));
        };
        changes.push(change);
    }
    changes.extend(note_of_fit(&lookup, &text, values));
    let folder = scene.parent().unwrap_or(Path::new(""));
    for range in lookup.paths() {
        let path: Option<String> =
            text[range.clone()].parse::<toml::Value>().ok().and_then(|path| {
                let path = folder.join(path.as_str()?);
                let full = path.canonicalize().or_else(|_| std::path::absolute(&path)).ok()?;
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

/// A value of a ground; none without that ground.
fn of_ground(
    (lookup, text): (&Lookup, &str),
    ground: &str,
    (key, value): (&str, &str),
) -> Option<Replacement> {
    let table = ["grounds", ground].map(|key| TrailStep::Key(key.to_owned()));
    let value_at = |key: &str| {
        let keys = key.split('.').map(|key| TrailStep::Key(key.to_owned()));
        lookup.value_at(&table.iter().cloned().chain(keys).collect::<Vec<_>>())
    };
    let other = value_at(OTHERWISE.1).filter(|_| key == OTHERWISE.0);
    match (value_at(key), other) {
        (Some(range), _) => Some((range, value.to_owned())),
        (None, Some(other)) => {
            let start = text[..other.start].rfind(OTHERWISE.1).unwrap_or(other.start);
            Some((start..other.end, format!("{key} = {value}")))
        }
        // of a table with a header the header alone
        (None, None) => {
            let header = lookup.value_at(&table)?;
            Some((header.end..header.end, format!("\n{key} = {value}")))
        }
    }
}

/// What was fitted, in the line before the measured ends: results of the scene may then be called calibrated as long as
/// these values stand there. None without `[calibrate]`.
fn note_of_fit(lookup: &Lookup, text: &str, values: &[NewValue]) -> Option<Replacement> {
    let trail = |key: &str| ["calibrate", key].map(|key| TrailStep::Key(key.to_owned()));
    let one = |(ground, key, value): &NewValue| {
        let ground = ground.as_ref().map_or_else(String::new, |name| {
            format!("ground = {}, ", toml::Value::String(name.clone()))
        });
        format!("{{ {ground}key = \"{key}\", value = {value} }}")
    };
    let list = values.iter().map(one).collect::<Vec<_>>().join(", ");
    if let Some(before) = lookup.value_at(&trail("fitted")) {
        return Some((before, format!("[{list}]")));
    }
    let key = lookup.key_at(&trail("deposits"))?;
    let line = text[..key.start].rfind('\n').map_or(0, |end| end + 1);
    // an inline table has all on one line, `calibrate.deposits` its table before the key
    let indent = &text[line..key.start];
    Some(if indent.contains('{') {
        (key.start..key.start, format!("fitted = [{list}], "))
    } else {
        (line..line, format!("{indent}fitted = [{list}]\n"))
    })
}

/// A value of every shape that has it; spheres among them have none.
fn of_shapes(lookup: &Lookup, key: &str, value: &str) -> Vec<Replacement> {
    let key_of = |trail: &[TrailStep]| {
        matches!(trail, [TrailStep::Key(rocks), TrailStep::Key(shapes), TrailStep::Entry(_), TrailStep::Key(last)]
        if rocks == "rocks" && shapes == "shapes" && last == key)
    };
    lookup.values(key_of).map(|range| (range, value.to_owned())).collect()
}

//! `view.html`: sections of packed columns and the script that draws them, in one file that loads nothing.

use super::{Shown, rocks};
use crate::hazard::StopKind;
use crate::math;
use crate::report::format::escape;
use crate::report::words::Words;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// What the page may do: run its own script and style, and nothing else. No request can leave it.
pub const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'";

/// Name of the section with the terrain.
pub const TERRAIN: &str = "terrain";
/// Name of the section with the hulls of blocks.
pub const BLOCKS: &str = "blocks";

/// The scripts, in the order in which they stand in the page.
const SCRIPTS: [&str; 8] = [
    include_str!("web/decode.js"),
    include_str!("web/vectors.js"),
    include_str!("web/shaders.js"),
    include_str!("web/scene.js"),
    include_str!("web/camera.js"),
    include_str!("web/panel.js"),
    include_str!("web/draw.js"),
    include_str!("web/start.js"),
];
/// Those of pages with blocks; they stand before the last, which begins.
const BLOCK_SCRIPTS: [&str; 2] = [include_str!("web/turns.js"), include_str!("web/blocks.js")];
const BODY: &str = include_str!("web/body.html");
const STYLE: &str = include_str!("web/page.css");

/// Total energy that parts the classes of paths (J): the Swiss limits, or lower ones where no rock is that strong.
pub(super) fn class_limits_j(shown: &Shown) -> [f64; 2] {
    let most = shown.rows.iter().map(|row| row.max_total_j).filter(|j| j.is_finite());
    let most = most.fold(0.0, f64::max);
    if most >= crate::hazard::INTENSITY_J[0] {
        return crate::hazard::INTENSITY_J;
    }
    let power = math::log10(most.max(1e-6)).floor() as i32;
    // written and read, not multiplied: the doubles that everybody else has for them
    [power - 1, power].map(|k| format!("1e{k}").parse().unwrap_or(f64::NAN))
}

/// The page.
pub fn page(shown: &Shown) -> String {
    let words = shown.words;
    let said = words.of_view(&format!("{}: view in three dimensions", shown.title));
    let (title, language, body) = (escape(&said), words.code, body(words));
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"{language}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{body}"
    );
    let mut head = json!({
        "version": 1,
        "title": shown.title,
        "notes": shown.notes().iter().map(|note| words.of_view(note)).collect::<Vec<_>>(),
        "classes_j": class_limits_j(shown),
        "stops": StopKind::ALL.map(StopKind::word),
        "walls": shown.walls,
    });
    let spoken = spoken(words);
    if !spoken.is_empty() {
        head["words"] = spoken.into();
    }
    // a `<` in a name must not end the element; JSON reads the escape as the same character
    let head = head.to_string().replace('<', "\\u003c");
    let _ = writeln!(page, "<script type=\"application/json\" id=\"scene\">{head}</script>");
    put(&mut page, TERRAIN, &shown.mesh.text());
    if !shown.ways.ways.is_empty() {
        put(&mut page, "paths", &shown.ways.text());
    }
    if !shown.hulls.is_empty() {
        put(&mut page, BLOCKS, &shown.hulls.text());
    }
    if !shown.rows.is_empty() {
        put(&mut page, "rocks", &rocks::text(shown));
    }
    if let Some(layers) = &shown.layers {
        put(&mut page, "maps", &layers.text());
    }
    let script = script(!shown.hulls.is_empty());
    let _ = write!(page, "<script>\n\"use strict\";\n{script}</script>\n</body>\n</html>\n");
    page
}

/// The script, with what draws blocks where there are some.
fn script(has_blocks: bool) -> String {
    let [all @ .., start] = SCRIPTS;
    let blocks = if has_blocks { BLOCK_SCRIPTS } else { [""; 2] };
    [&all[..], &blocks[..], &[start]].concat().concat()
}

/// The body with its texts, which stand in double braces, in the language of the page.
fn body(words: &Words) -> String {
    let mut parts = BODY.split("{{");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.filter_map(|part| part.split_once("}}")).fold(first, |mut body, (text, rest)| {
        body += &escape(&words.of_view(text));
        body += rest;
        body
    })
}

/// The texts that the scripts say, in the language of the page; none in English.
fn spoken(words: &Words) -> Map<String, Value> {
    words.of_scripts().map(|(text, said)| (text.to_owned(), Value::from(said))).collect()
}

fn opening(name: &str) -> String {
    format!("<script type=\"text/plain\" id=\"{name}\">")
}

fn put(page: &mut String, name: &str, text: &str) {
    let _ = writeln!(page, "{}{text}</script>", opening(name));
}

/// The text of a section of a page; none when there is no such.
pub fn section<'a>(page: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = page.split_once(&opening(name))?;
    rest.split_once("</script>").map(|(text, _)| text)
}

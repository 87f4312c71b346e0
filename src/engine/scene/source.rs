//! Where in the scene file a value stands: turns complaints and the reader's errors into messages that
//! name file, table, key and line. Built only when there is something to complain about.

use super::check::{Complaint, TrailStep};
use super::wording::{self, Said};
use crate::error::{Error, Result};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Endings of files that hold a terrain, as their programs write them.
const TERRAINS: [&str; 8] = ["stl", "ply", "obj", "tif", "tiff", "asc", "las", "laz"];

/// What to say of a terrain where a scene is asked for; none of a file that is none, by its name, or is not there.
pub(super) fn terrain_instead(file: &Path) -> Option<Error> {
    let ending = file.extension()?.to_str()?.to_ascii_lowercase();
    let is_terrain = TERRAINS.contains(&ending.as_str()) && file.is_file();
    let remedy = format!("write a first scene for it: rockfall init {}", file.display());
    is_terrain.then(|| Error::input(file, "start", "found a terrain, no scene", remedy))
}

/// A scene's text with the place of every key and value in it.
pub(super) struct Lookup<'a> {
    file: &'a Path,
    text: &'a str,
    is_toml: bool,
    nodes: Vec<SourceNode>,
}

/// Tables that every scene must have.
const TABLES: [&str; 3] = ["grounds", "rocks", "release"];

/// Keys that name a file, whichever entry of a list they stand in: those that `settle_paths` knows.
const FILES: [&str; 11] = [
    "terrain.mesh",
    "terrain.file",
    "trees.mesh",
    "trees.file",
    "lines.file",
    "barriers.file",
    "ground_zones.file",
    "release.zones",
    "release.table",
    "rocks.shapes.mesh",
    "calibrate.deposits",
];

/// How an empty text is written.
pub(super) const EMPTY: [&str; 2] = ["\"\"", "''"];

/// Tables of which a scene may have several.
const LISTS: [&str; 6] = ["terrain", "trees", "lines", "barriers", "objects", "ground_zones"];

/// One value of the file.
struct SourceNode {
    trail: Vec<TrailStep>,
    /// Bytes of its key; of a list entry the entry itself.
    key: Range<usize>,
    /// Bytes of the value; of a table with a header the header alone.
    value: Range<usize>,
    /// Whether it is a table with a header of its own, `[a.b]` or `[[a]]`.
    headed: bool,
}

impl<'a> Lookup<'a> {
    /// Finds every key; a text that is no TOML has none.
    pub(super) fn of(file: &'a Path, text: &'a str) -> Self {
        let mut nodes = Vec::new();
        let root = DeTable::parse(text);
        if let Ok(root) = &root {
            collect_table(text, &[], root.get_ref(), &mut nodes);
        }
        Self { file, text, is_toml: root.is_ok(), nodes }
    }

    /// Where the value at the end of a trail stands; of a table with a header where the header stands.
    pub(super) fn value_at(&self, trail: &[TrailStep]) -> Option<Range<usize>> {
        self.node(trail).map(|node| node.value.clone())
    }

    /// Where the key at the end of a trail stands.
    pub(super) fn key_at(&self, trail: &[TrailStep]) -> Option<Range<usize>> {
        self.node(trail).map(|node| node.key.clone())
    }

    /// Where paths of files stand.
    pub(super) fn paths(&self) -> impl Iterator<Item = Range<usize>> {
        self.values(names_a_file)
    }

    /// Refuses an empty path: it would be looked for as the folder of the scene.
    pub(super) fn check_paths(&self) -> Result<()> {
        let is_empty = |node: &&SourceNode| EMPTY.contains(&&self.text[node.value.clone()]);
        match self.nodes.iter().filter(|node| names_a_file(&node.trail)).find(is_empty) {
            Some(node) => {
                let remedy =
                    "write the path of the file as seen from the scene file, or leave the key out";
                Err(Error::input(self.file, self.place(&node.trail), "found \"\"", remedy))
            }
            None => Ok(()),
        }
    }

    /// Where the values stand whose trails are wanted.
    pub(super) fn values(
        &self,
        is_wanted: impl Fn(&[TrailStep]) -> bool,
    ) -> impl Iterator<Item = Range<usize>> {
        let wanted = self.nodes.iter().filter(move |node| is_wanted(&node.trail));
        wanted.map(|node| node.value.clone())
    }

    /// The message for a complaint of the scene's own checks.
    pub(super) fn refuse(&self, complaint: Complaint) -> Error {
        let place = self.place(&complaint.trail);
        let found = complaint.found.unwrap_or_else(|| self.as_written(&complaint.trail));
        Error::input(self.file, place, found, complaint.remedy)
    }

    /// The message for what the TOML reader found.
    pub(super) fn refuse_reading(&self, error: &toml::de::Error) -> Error {
        // what is missing at the top has no place: neither is it in the first key
        let span = error.span().unwrap_or(0..0);
        let mut trail = if span.is_empty() { Vec::new() } else { self.trail_at(&span) };
        let mut said = wording::of(error.message());
        if let Some(brackets) = self.wrong_brackets(&trail, &said.found) {
            said = brackets;
        }
        if !self.is_toml {
            let begins = self.text[..span.start].rfind('\n').map_or(0, |at| at + 1);
            let line = self.text[begins..].lines().next();
            said = line.and_then(wording::of_line).unwrap_or(said);
        }
        if let Some(key) = said.missing {
            if trail.is_empty() && TABLES.contains(&key.as_str()) {
                said.remedy = format!("write the table [{key}]");
            }
            trail.push(TrailStep::Key(key));
        }
        let place = if self.is_toml {
            self.place(&trail)
        } else {
            format!("line {}", self.line(span.start))
        };
        Error::input(self.file, place, said.found, said.remedy)
    }

    /// `[terrain]` where `[[terrain]]` should stand, or `[[rocks]]` where `[rocks]` should.
    fn wrong_brackets(&self, trail: &[TrailStep], found: &str) -> Option<Said> {
        let (name, is_entry) = match trail {
            [TrailStep::Key(name)] => (name, false),
            [TrailStep::Key(name), TrailStep::Entry(_)] => (name, true),
            _ => return None,
        };
        if name == "grounds" {
            return None;
        }
        let is_list = LISTS.contains(&name.as_str());
        let headed = self.node(trail).is_some_and(|node| node.headed);
        match (headed, is_entry, is_list) {
            (true, false, true) if found == "found map" => Some(Said::new(
                format!("found [{name}]"),
                format!("write [[{name}]]: there may be several"),
            )),
            (true, true, false) => Some(Said::new(
                format!("found [[{name}]]"),
                format!("write [{name}]: there is only one"),
            )),
            _ => None,
        }
    }

    fn node(&self, trail: &[TrailStep]) -> Option<&SourceNode> {
        self.nodes.iter().find(|node| node.trail == trail)
    }

    /// The trail to the smallest value whose key or text holds the span.
    fn trail_at(&self, span: &Range<usize>) -> Vec<TrailStep> {
        let holds = |range: &Range<usize>| range.start <= span.start && span.end <= range.end;
        let holding = self.nodes.iter().filter_map(|node| {
            [&node.key, &node.value].into_iter().find(|range| holds(range)).map(|r| (r.len(), node))
        });
        // the longer trail wins a tie: [a.b] names both a and b in one header
        let smallest = holding.min_by_key(|(len, node)| (*len, usize::MAX - node.trail.len()));
        smallest.map_or_else(Vec::new, |(_, node)| node.trail.clone())
    }

    /// "[grounds.scree] `friction_angle_deg` (line 12)".
    fn place(&self, trail: &[TrailStep]) -> String {
        let is_headed = |&n: &usize| self.node(&trail[..n]).is_some_and(|node| node.headed);
        let headed = (1..=trail.len()).rev().find(is_headed).unwrap_or(0);
        let mut parts = Vec::new();
        if headed > 0 {
            parts.push(header(&trail[..headed]));
        }
        if headed < trail.len() {
            parts.push(keys(&trail[headed..]));
        }
        let near = (1..=trail.len()).rev().find_map(|n| self.node(&trail[..n]));
        match near {
            Some(node) => format!("{} (line {})", parts.join(" "), self.line(node.key.start)),
            None => parts.join(" "),
        }
    }

    /// Line number from 1.
    fn line(&self, byte: usize) -> usize {
        self.text.bytes().take(byte).filter(|b| *b == b'\n').count() + 1
    }

    /// "found 95", cut short when it is long.
    fn as_written(&self, trail: &[TrailStep]) -> String {
        /// Characters of a value that a message repeats.
        const SHOWN: usize = 60;
        let Some(node) = self.node(trail).filter(|node| !node.headed) else {
            return "found nothing".to_owned();
        };
        let written = &self.text[node.value.clone()];
        let line = written.lines().next().unwrap_or_default();
        let short: String = line.chars().take(SHOWN).collect();
        let more = if short.len() < written.len() { " …" } else { "" };
        format!("found {short}{more}")
    }
}

/// `[a.b]`, or `[[a]] #2` for an entry of an array of tables.
fn header(trail: &[TrailStep]) -> String {
    if let [before @ .., TrailStep::Entry(index)] = trail {
        return format!("[[{}]] #{}", keys(before), index + 1);
    }
    let is_key = |step: &&TrailStep| matches!(step, TrailStep::Key(_));
    let table = keys(&trail.iter().filter(is_key).cloned().collect::<Vec<_>>());
    match trail.iter().rfind(|step| !is_key(step)) {
        Some(TrailStep::Entry(index)) => format!("[{table}] of #{}", index + 1),
        _ => format!("[{table}]"),
    }
}

/// `a.b, entry 3`
fn keys(trail: &[TrailStep]) -> String {
    let in_words = trail.iter().map(|step| match step {
        TrailStep::Key(key) => format!(".{key}"),
        TrailStep::Entry(index) => format!(", entry {}", index + 1),
    });
    let text: String = in_words.collect();
    text.trim_start_matches(['.', ',', ' ']).to_owned()
}

/// Whether a file is named at the end of a trail.
fn names_a_file(trail: &[TrailStep]) -> bool {
    let keys = trail.iter().filter_map(|step| match step {
        TrailStep::Key(key) => Some(key.as_str()),
        TrailStep::Entry(_) => None,
    });
    FILES.iter().any(|file| file.split('.').eq(keys.clone()))
}

fn collect_table(
    text: &str,
    trail: &[TrailStep],
    table: &DeTable<'_>,
    nodes: &mut Vec<SourceNode>,
) {
    for (key, value) in table {
        let mut trail = trail.to_vec();
        trail.push(TrailStep::Key(key.get_ref().to_string()));
        collect(text, trail, key.span(), value, nodes);
    }
}

fn collect(
    text: &str,
    trail: Vec<TrailStep>,
    key: Range<usize>,
    value: &Spanned<DeValue<'_>>,
    nodes: &mut Vec<SourceNode>,
) {
    let headed = value.get_ref().is_table() && text[value.span()].starts_with('[');
    match value.get_ref() {
        DeValue::Table(table) => collect_table(text, &trail, table, nodes),
        DeValue::Array(entries) => {
            for (index, entry) in entries.iter().enumerate() {
                let mut trail = trail.clone();
                trail.push(TrailStep::Entry(index));
                collect(text, trail, entry.span(), entry, nodes);
            }
        }
        _ => {}
    }
    // a header stands where its table begins, however its last key was reached
    let key = if headed { value.span() } else { key };
    nodes.push(SourceNode { trail, key, value: value.span(), headed });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a new user types first: `rockfall run slope.stl`.
    #[test]
    fn a_terrain_is_told_from_a_broken_scene() {
        let terrain = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrain/quick_slope.stl");
        let said = terrain_instead(&terrain).map(|error| error.to_string()).unwrap_or_default();
        assert!(
            said.contains("found a terrain, no scene; write a first scene for it: rockfall init")
        );
        assert!(terrain_instead(Path::new("not_there.stl")).is_none());
        assert!(terrain_instead(Path::new("Cargo.toml")).is_none());
    }
}

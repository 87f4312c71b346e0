//! Two finished runs side by side: what differs between their inputs, and by how much their statistics do.
//!
//! ```text
//! Results A, Results B ─► Comparison ─► differences.csv · figures/*.svg · compare.html
//! ```
//!
//! Releases pair where both runs have the same seed: then release 17 of the one is release 17 of the other, and the
//! intervals of the differences are those of pairs. Nothing else is computed here.

mod bounds;
mod figures;
mod inputs;
mod page;
mod populations;
mod table;
mod weighing;

use crate::error::{Error, Result};
use crate::output::{self, Results, write_atomic};
use crate::report::words::Words;
use populations::Population;
use std::fs;
use std::path::Path;
use table::Group;

/// The page.
pub const PAGE: &str = "compare.html";
/// The table of all differences.
const TABLE: &str = "differences.csv";

/// Two runs and what differs.
#[derive(Debug)]
pub struct Comparison {
    /// Folder and title of each run.
    names: [(String, String); 2],
    /// Releases compared of each run.
    releases: [usize; 2],
    /// Whether the same release numbers are the same rocks.
    paired: bool,
    /// Whether both have the same seed.
    one_seed: bool,
    /// Whether both are one and the same run.
    same_run: bool,
    /// What went in and differs: name, first, second.
    inputs: Vec<(String, [String; 2])>,
    /// What the reader must know.
    notes: Vec<String>,
    groups: Vec<Group>,
    /// The rocks of each group, for the figures.
    populations: Vec<[Population; 2]>,
    /// In the language of the first run.
    words: &'static Words,
}

impl Comparison {
    /// Compares the finished runs in two folders.
    ///
    /// # Errors
    /// A folder without finished results.
    pub fn of(a: &Path, b: &Path) -> Result<Self> {
        let runs = [output::read(a)?, output::read(b)?];
        let [one, other] = [&runs[0].summary.identity, &runs[1].summary.identity];
        let common =
            one.range().start.max(other.range().start)..one.range().end.min(other.range().end);
        let one_seed = one.seed == other.seed && !common.is_empty();
        let paired = one_seed && weighing::are_alike(&runs);
        let same_run = one == other;
        let range =
            |run: &Results| if paired { common.clone() } else { run.summary.identity.range() };
        let ranges = [range(&runs[0]), range(&runs[1])];
        let (populations, mut notes) = populations::of(&runs, &ranges, paired)?;
        if paired && (one.range() != common || other.range() != common) {
            notes.push(if common.len() == 1 {
                format!("Only release {} is in both runs: the others are left out.", common.start)
            } else {
                format!(
                    "Only the releases {} to {} are in both runs: the others are left out.",
                    common.start,
                    common.end - 1
                )
            });
        }
        notes
            .extend(weighing::note(populations[0].each_ref().map(|of| of.among.standing.as_ref())));
        notes.extend(bounds::censored(&populations[0]));
        notes.extend(inputs::moved(&runs));
        notes.extend(weighing::of_worlds(&runs));
        notes.extend(unpaired(paired, one_seed).map(str::to_owned));
        // where every way is the same nothing is left to chance: only barriers or what is asked for differ
        let is_same = |[one, other]: &[Population; 2]| one.is_like(other);
        let same_ways = paired && is_same(&populations[0]);
        let of_one_run = |pair: &[Population; 2]| same_run || same_ways && is_same(pair);
        let groups =
            populations.iter().map(|pair| table::group(pair, paired, of_one_run(pair))).collect();
        Ok(Self {
            names: [(a, &runs[0]), (b, &runs[1])]
                .map(|(dir, run)| (dir.display().to_string(), run.summary.title.clone())),
            releases: ranges.map(|range| range.len()),
            paired,
            one_seed,
            same_run,
            inputs: inputs::differing(&runs),
            notes,
            groups,
            populations,
            words: Words::of(runs[0].summary.language),
        })
    }

    /// Whether rocks weigh what they stand for.
    fn is_weighted(&self) -> bool {
        self.populations.iter().flatten().any(|of| of.among.standing.is_some())
    }

    /// Refuses a folder with the results of a run; an earlier comparison is replaced.
    ///
    /// # Errors
    /// If it is one.
    pub fn check_folder(dir: &Path) -> Result<()> {
        if output::releases_in(dir)?.is_some() {
            return Err(Error::Request(format!(
                "--out {}: holds the results of a run; write another folder",
                dir.display()
            )));
        }
        Ok(())
    }

    /// Writes `differences.csv`, `figures/*.svg` and `compare.html` below `dir`.
    ///
    /// # Errors
    /// When `dir` holds the results of a run, or a file cannot be written.
    pub fn write(&self, dir: &Path) -> Result<()> {
        Self::check_folder(dir)?;
        let figures = dir.join("figures");
        fs::create_dir_all(&figures).map_err(Error::file("create", &figures))?;
        let drawn = figures::all(self);
        for (heading, drawing) in &drawn {
            write_atomic(&figures.join(&heading.file), drawing.svg.as_bytes())?;
        }
        write_atomic(&dir.join(TABLE), table::csv(&self.groups, self.paired).as_bytes())?;
        write_atomic(&dir.join(PAGE), page::page(self, &drawn).as_bytes())
    }

    /// The differences that matter most, line by line for a terminal, and what makes them look surer than they are.
    pub fn headline(&self) -> Vec<String> {
        let misleads = |note: &&String| weighing::is_of_worlds(note) || inputs::is_of_moved(note);
        let notes = self.notes.iter().filter(misleads);
        table::headline(&self.groups).into_iter().chain(notes.cloned()).collect()
    }

    /// Largest difference of any statistic, in its own unit, and the widest interval: both 0 for a run beside itself.
    pub fn largest(&self) -> (f64, f64) {
        let rows = self.groups.iter().flat_map(|group| &group.rows);
        rows.fold((0.0, 0.0), |(value, width), row| {
            let (low, high) = row.difference.interval.unwrap_or((0.0, 0.0));
            (value.max(row.difference.value.abs()), width.max(high - low))
        })
    }
}

/// What it means that releases do not pair; nothing where they do.
fn unpaired(paired: bool, one_seed: bool) -> Option<&'static str> {
    match (paired, one_seed) {
        (true, _) => None,
        (_, true) => Some(
            "The runs have other sources or other classes of size: the same release number is another rock in each, nothing pairs, \
             and differences are known no better than both runs apart.",
        ),
        _ => Some(
            "The runs have different seeds: nothing pairs, and differences are known no better than both runs apart. \
             With one seed the same rocks would be released.",
        ),
    }
}

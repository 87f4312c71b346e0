//! What the releases of both runs stand for, where they do not all weigh the same.

use crate::error::Result;
use crate::frequency::{Frequency, Weights};
use crate::hazard::Row;
use crate::output::Results;
use crate::report::planned::is_one_world;
use std::ops::Range;
use std::sync::Arc;

/// What the releases of a run stand for.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RunWeights {
    pub(super) weights: Weights,
    /// Whether they stand for events a year, and not only for parts of all events.
    pub(super) is_a_year: bool,
}

/// Releases of a run that something is counted among, by rising number, and what they stand for.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct CountedReleases {
    pub(super) releases: Vec<usize>,
    /// None where all of both runs weigh the same.
    pub(super) standing: Option<RunWeights>,
}

impl CountedReleases {
    /// Some releases of each run, among `all` that are compared.
    pub(super) fn of(
        runs: &[Results; 2],
        all: &[Range<usize>; 2],
        releases: [Vec<usize>; 2],
    ) -> [Arc<Self>; 2] {
        let both = [0, 1].map(|k| weights(&runs[k], &releases[k], all[k].clone()));
        let are_equal = both.iter().all(|one| one.weights.are_equal());
        let with = |releases: Vec<usize>, standing: RunWeights| {
            Arc::new(Self { releases, standing: (!are_equal).then_some(standing) })
        };
        let ([a, b], [of_a, of_b]) = (releases, both);
        [with(a, of_a), with(b, of_b)]
    }

    pub(super) fn contains(&self, release: usize) -> bool {
        self.releases.binary_search(&release).is_ok()
    }
}

/// What some releases of a run stand for, among `all` that are compared.
fn weights(run: &Results, releases: &[usize], all: Range<usize>) -> RunWeights {
    let Some(frequency) = &run.summary.asked.frequency else {
        return RunWeights { weights: Weights::equal(releases.len()), is_a_year: false };
    };
    let by_stratum = |releases: &mut dyn Iterator<Item = usize>| {
        let mut rocks = vec![0; frequency.strata().len()];
        releases.for_each(|release| rocks[frequency.stratum_of(release)] += 1);
        rocks
    };
    let rocks = by_stratum(&mut releases.iter().copied());
    let there = by_stratum(&mut all.clone());
    // of a part of the sources there is no number a year
    let is_a_year = there.iter().all(|rocks| *rocks > 0);
    RunWeights { weights: frequency.weights_of(rocks).within(&there), is_a_year }
}

/// What is said of rocks that meet each other.
const OF_WORLDS: &str = "the rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share: a change that is clear here may be chance. Run several seeds of each scene and compare.";

/// What it means that the rocks of a run share one world; nothing where each has the terrain for itself.
pub(super) fn of_worlds(runs: &[Results; 2]) -> Option<String> {
    let is_world = |run: &Results| is_one_world(&run.summary.plan_entries);
    let named = ["A", "B"].into_iter().zip(runs).filter(|(_, run)| is_world(run));
    let who: Vec<&str> = named.map(|(name, _)| name).collect();
    (!who.is_empty()).then(|| format!("{}: {OF_WORLDS}", who.join(", ")))
}

/// Whether a note is one of these.
pub(super) fn is_of_worlds(note: &str) -> bool {
    note.ends_with(OF_WORLDS)
}

/// Those of each run that were released: of pairs, in both runs.
///
/// # Errors
/// Rows that cannot be read.
pub(super) fn released(
    runs: &[Results; 2],
    ranges: &[Range<usize>; 2],
    paired: bool,
) -> Result<[Vec<usize>; 2]> {
    let of = |k: usize| -> Result<Vec<usize>> {
        let is_one = |row: &Row| ranges[k].contains(&row.index) && row.stop.is_released();
        let rows = runs[k].rows()?.filter(|row| row.as_ref().map_or(true, is_one));
        rows.map(|row| row.map(|row| row.index)).collect()
    };
    let [mut one, mut other] = [of(0)?, of(1)?];
    if paired {
        one.retain(|release| other.binary_search(release).is_ok());
        other.clone_from(&one);
    }
    Ok([one, other])
}

/// Whether the same release number means a rock of the same source and class in both: else they are different rocks.
pub(super) fn are_alike(runs: &[Results; 2]) -> bool {
    let are_equal = |run: &Results| {
        let all = run.summary.identity.range();
        weights(run, &all.clone().collect::<Vec<_>>(), all).weights.are_equal()
    };
    if runs.iter().all(are_equal) {
        return true;
    }
    let sources = |run: &Results| -> Vec<usize> {
        let strata = run.summary.asked.frequency.iter().flat_map(Frequency::strata);
        strata.map(|stratum| stratum.source).collect()
    };
    sources(&runs[0]) == sources(&runs[1])
}

/// What the reader must know of it; nothing where all weigh the same.
pub(super) fn note([a, b]: [Option<&RunWeights>; 2]) -> Option<String> {
    let [a, b] = [a?, b?].map(|one| !one.weights.are_equal());
    let who = match (a, b) {
        (true, true) => "Rocks weigh what they stand for".to_owned(),
        (true, false) => "Rocks of A weigh what they stand for, those of B all the same".to_owned(),
        _ => "Rocks of B weigh what they stand for, those of A all the same".to_owned(),
    };
    Some(format!(
        "{who}: shares, means and percentiles are those of events, as in the report of each run. Numbers of rocks are of \
         computed ones: rare sizes are computed more often than they come."
    ))
}

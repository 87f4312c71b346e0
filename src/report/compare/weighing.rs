//! What the releases of both runs stand for, where they do not all weigh the same.

use crate::frequency::{Frequency, Weights};
use crate::output::Results;
use std::ops::Range;

/// What the releases of a run stand for.
#[derive(Debug, Clone)]
pub(super) struct RunWeights {
    pub(super) weights: Weights,
    /// Whether they stand for events a year, and not only for parts of all events.
    pub(super) is_a_year: bool,
}

/// What some releases of each run stand for; none where all of both runs weigh the same.
pub(super) fn of(runs: &[Results; 2], ranges: &[Range<usize>; 2]) -> [Option<RunWeights>; 2] {
    let [a, b] = [0, 1].map(|k| {
        let rocks = ranges[k].len();
        let frequency = runs[k].summary.asked.frequency.as_ref();
        let weights = frequency.map_or_else(|| Weights::equal(rocks), |one| one.weights(rocks));
        RunWeights { weights, is_a_year: frequency.is_some() }
    });
    let are_equal = a.weights.are_equal() && b.weights.are_equal();
    if are_equal { [None, None] } else { [Some(a), Some(b)] }
}

/// Whether the same release number means a rock of the same source and class in both: else they are different rocks.
pub(super) fn are_alike(runs: &[Results; 2]) -> bool {
    let whole = [0, 1].map(|k| runs[k].summary.identity.range());
    if of(runs, &whole)[0].is_none() {
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

//! The choice among the best trials of a search, by rocks that the search has not seen.
//!
//! The best of some hundred trials is the best partly by luck: its rocks happened to end well. Its score is too good, and other values may lie
//! nearer. So the few best are followed again, with more rocks and other ones, which alone select among them (Boesel, Nelson and Kim 2003,
//! Operations Research 51, 814: ranking and selection after a search). The best of these few is lucky too, though less so: its scores are therefore
//! those of rocks that have selected nothing.

use super::search::{ParameterSearch, nearer};
use super::{CalibrationTrial, Ends};
use crate::error::Result;
use serde::{Deserialize, Serialize};

/// Releases of a trial that selects or assesses over those of one that searches: half of the noise.
const MORE: usize = 4;
/// Most trials that are followed again.
const MOST_FINALISTS: usize = 8;
/// How far the seeds of two stages lie apart: farther than those that anyone writes.
const SEEDS_APART: u64 = 1 << 62;

/// What a trial is for: each stage follows rocks of its own, so that none profits from the luck of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrationStage {
    /// It is one of the search.
    #[default]
    Search,
    /// It is compared with other finalists of its search.
    Selection,
    /// It says how good the selected values are.
    Assessment,
}

impl CalibrationStage {
    /// Releases of a trial, of so many in the search.
    pub(super) fn releases(self, of_search: usize) -> usize {
        if self == Self::Search { of_search } else { MORE * of_search }
    }

    /// The seed of its rocks.
    pub(super) fn seed(self, of_scene: u64) -> u64 {
        let stage = match self {
            Self::Search => 0,
            Self::Selection => 1,
            Self::Assessment => 2,
        };
        // modulo 2^64 the seeds of a scene still differ
        of_scene.wrapping_add(stage * SEEDS_APART)
    }

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Search => "search",
            Self::Selection => "selection",
            Self::Assessment => "assessment",
        }
    }
}

/// Finalists of so many trials: with the assessment they take no more releases than the search did.
fn most_of(trials: usize) -> usize {
    (trials / MORE).saturating_sub(1).clamp(1, MOST_FINALISTS)
}

/// What selection and assessment take after so many trials, in trials of the search.
pub(super) fn effort(trials: usize) -> usize {
    MORE * (most_of(trials) + 1)
}

/// The best trials that differ, best first.
fn finalists(trials: &[CalibrationTrial]) -> Vec<Vec<f64>> {
    let mut sorted: Vec<&CalibrationTrial> =
        trials.iter().filter(|trial| trial.fitted.computed > 0).collect();
    sorted.sort_by(|one, other| nearer(one, other));
    // values that make no difference to any rock beside these ends: the first says as much as all
    sorted.dedup_by(|one, other| one.fitted == other.fitted);
    sorted.iter().take(most_of(trials.len())).map(|trial| trial.values.clone()).collect()
}

impl ParameterSearch<'_> {
    /// The trial that other rocks select among the best of a search, as others again assess it, and the number of finalists.
    ///
    /// Only trials of the same search stand for election: those of another have seen ends that this one may not know.
    pub(super) fn select(
        &mut self,
        trials: &[CalibrationTrial],
        ends: Ends,
        tried: &mut dyn FnMut(Ends, &CalibrationTrial),
    ) -> Result<(CalibrationTrial, usize)> {
        let again = self.try_all(&finalists(trials), (ends, CalibrationStage::Selection), tried)?;
        let selected = again.iter().min_by(|one, other| nearer(one, other));
        let values = selected.ok_or_else(|| self.nothing())?.values.clone();
        let assessed = self.trial(&values, (ends, CalibrationStage::Assessment))?;
        tried(ends, &assessed);
        if assessed.fitted.computed == 0 {
            return Err(self.nothing());
        }
        Ok((assessed, again.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hazard::{Agreement, ObservedPath};

    fn trial(value: f64, off_m: f64) -> CalibrationTrial {
        let way =
            |runout_m: f64| ObservedPath { start_m: [0.0; 2], end_m: [runout_m, 0.0], open: None };
        let measured = [1.0, 2.0, 3.0, 4.0].map(way);
        let agreement = Agreement::of(&measured, &measured.map(|m| way(m.runout_m() + off_m)));
        let all = agreement.unwrap();
        let stage = CalibrationStage::Search;
        let (values, fitted, kept_apart) = (vec![value], all, all);
        CalibrationTrial { values, stage, releases: 4, fitted, kept_apart, all }
    }

    /// Of forty trials, each with a twin of other values that changes no rock, the best eight that differ.
    #[test]
    fn finalists_are_the_best_that_differ() {
        let off_m = |at: usize| 0.1 + 0.01 * ((7 * at) % 40) as f64;
        let trials: Vec<CalibrationTrial> =
            (0..80).map(|at| trial(at as f64, off_m(at / 2))).collect();
        let found = finalists(&trials);
        assert_eq!(found.len(), MOST_FINALISTS);
        for (rank, values) in found.iter().enumerate() {
            let at = values[0] as usize;
            assert_eq!(at % 2, 0, "a twin: {found:?}");
            assert_eq!((7 * (at / 2)) % 40, rank, "{found:?}");
        }
    }

    /// Selection and assessment of small searches, too, take no more than the search; of one trial there is one finalist.
    #[test]
    fn finalists_cost_no_more_than_the_search() {
        assert!((8..1000).all(|trials| effort(trials) <= trials));
        assert_eq!([1, 24, 86, 253].map(most_of), [1, 5, 8, 8]);
    }

    /// No stage of any scene has the rocks of another stage, whatever its seed.
    #[test]
    fn every_stage_has_rocks_of_its_own() {
        use CalibrationStage::{Assessment, Search, Selection};
        for seed in [0, 2014, u64::MAX] {
            let [a, b, c] = [Search, Selection, Assessment].map(|stage| stage.seed(seed));
            assert!(a == seed && a != b && b != c && c != a);
        }
    }
}

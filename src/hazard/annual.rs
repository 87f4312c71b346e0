//! What a year brings: how often rocks pass with more than an energy, and what that means to who is there.
//!
//! Four things are kept apart: *failure* frequency (events a year at the source), *reach* probability (conditional on
//! release), *passage* frequency (their product, summed over sources) and *energy exceedance* (passage with more than an
//! energy). Everything here is a number a year; what is conditional on release stands with lines, maps and barriers.

mod barriers;
mod cells;
mod curve;
mod energies;
mod places;
mod risk;
mod strata;

pub use barriers::AnnualBarrier;
pub use cells::{YearMap, file_above, file_of_period, year_maps};
pub use curve::{ExceedancePoint, ReturnEnergy, UnseenPoint};
pub use places::{Above, Annual, AnnualFigures, AnnualPlace, Saved, YearSums, annual};
pub use risk::{Object, Risk, RiskKind, Vehicles};

use super::rate::reaches;
use crate::frequency::{Frequency, radius_of_m3};
use serde::{Deserialize, Serialize};

/// What a scene asks of the year.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct AnnualRequest {
    /// Sources and their laws; none leaves all numbers a year out.
    pub frequency: Option<Frequency>,
    /// Roads, paths and houses; each has an evaluation line of its name.
    pub objects: Vec<Object>,
    /// Classes of hazard.
    pub matrix: Option<Matrix>,
    /// Most energy that a rock of each stratum can ever have (J); may be empty, then nothing is known of it.
    pub most_j: Vec<f64>,
    /// Radius of the largest rock of each stratum (m); of one without entry its law says it, if it has volumes.
    pub largest_m: Vec<f64>,
}

impl AnnualRequest {
    /// Energies (J) above which rocks are counted, here and there: those asked for, and limits between classes of hazard.
    pub fn counted_j(&self) -> Vec<f64> {
        let asked = self.frequency.as_ref().map_or(&[][..], |of| of.energies_j());
        let limits = self.matrix.as_ref().map_or(&[][..], |of| &of.energies_j);
        let mut all = asked.to_vec();
        all.extend(limits.iter().filter(|joule| !asked.contains(joule)));
        all
    }

    /// Radius of the largest rock of a stratum (m); 0 where nothing says it.
    fn largest_m(&self, stratum: usize) -> f64 {
        let of_law = || {
            let stratum = self.frequency.as_ref()?.strata().get(stratum)?;
            stratum.volume_m3.map(|[_, largest]| radius_of_m3(largest))
        };
        self.largest_m.get(stratum).copied().or_else(of_law).unwrap_or(0.0)
    }
}

/// Levels of hazard by energy and return period, as the scene has them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Matrix {
    /// Its name.
    pub name: String,
    /// Where it was read.
    pub source: String,
    /// Limits between the classes of energy (J), rising.
    pub energies_j: Vec<f64>,
    /// Return periods (years), rising.
    pub return_periods_years: Vec<f64>,
    /// A row for each return period, in it a level for each class of energy.
    pub levels: Vec<Vec<u8>>,
}

impl Matrix {
    /// All levels of the table, rising, each once.
    pub fn known_levels(&self) -> Vec<u8> {
        let mut levels = self.levels.concat();
        levels.sort_unstable();
        levels.dedup();
        levels
    }

    /// The highest level of a place, from how often a year rocks come with at least an energy (J), or with any; 0 where they come more
    /// seldom than all periods.
    ///
    /// The energy of a return period reaches a limit if the limit is passed that often.
    pub(super) fn level(&self, mut per_year: impl FnMut(Option<f64>) -> f64) -> u8 {
        let any = per_year(None);
        let above: Vec<f64> = self.energies_j.iter().map(|joule| per_year(Some(*joule))).collect();
        let at = |(years, row): (&f64, &Vec<u8>)| {
            let wanted = 1.0 / years;
            let class = above.iter().filter(|rate| reaches(**rate, wanted)).count();
            row.get(class).copied().filter(|_| reaches(any, wanted))
        };
        self.return_periods_years.iter().zip(&self.levels).filter_map(at).max().unwrap_or(0)
    }
}

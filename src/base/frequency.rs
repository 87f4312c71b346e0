//! How often rocks are released, and what a computed rock stands for.
//!
//! A source releases rocks of a size and so many a year ([`FrequencyLaw`]). Large rocks are rare and decide the hazard, so sizes
//! are sampled by importance: the volumes of each source are cut into classes, its *strata*, and every stratum gets the
//! same number of rocks however rare it is. A rock of stratum `j` stands for `f_j / n_j` events a year, where `f_j` is
//! the stratum's own frequency and `n_j` the number of its rocks. Inside a stratum sizes follow the law itself, so
//! nothing depends on how the strata are cut but the error.
//!
//! Rock `i` belongs to stratum `i mod J`: the same alone, resumed or in a shard, and the numbers `n_j` follow from the
//! number of releases alone. With one stratum all rocks weigh the same.

mod law;
mod weights;

pub use law::{Class, FrequencyLaw, Stratum, power_between};
pub use weights::Weights;

use crate::math;
use serde::{Deserialize, Serialize};

/// Strata for a decade of volume: within one the volume changes by a factor of 2.2.
const STRATA_PER_DECADE: f64 = 3.0;
/// Strata of all sources together, about: enough to flatten any law, few enough to count in every cell of a map.
const STRATA: usize = 120;

/// A source of rocks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RockSource {
    /// Its name.
    pub name: String,
    /// How often it releases rocks of what size.
    pub law: FrequencyLaw,
}

/// All sources of a scene and their strata; one source or more.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "StoredFrequency", into = "StoredFrequency")]
pub struct Frequency {
    sources: Vec<RockSource>,
    strata: Vec<Stratum>,
    energies_j: Vec<f64>,
    return_periods_years: Vec<f64>,
}

/// What a file holds of it: the strata follow.
#[derive(Serialize, Deserialize)]
struct StoredFrequency {
    sources: Vec<RockSource>,
    energies_j: Vec<f64>,
    return_periods_years: Vec<f64>,
}

impl From<StoredFrequency> for Frequency {
    fn from(written: StoredFrequency) -> Self {
        Self::new(written.sources, written.energies_j, written.return_periods_years)
    }
}

impl From<Frequency> for StoredFrequency {
    fn from(one: Frequency) -> Self {
        let Frequency { sources, energies_j, return_periods_years, .. } = one;
        Self { sources, energies_j, return_periods_years }
    }
}

impl Frequency {
    /// The strata of some sources; energies (J) and return periods (years) that are asked for, rising.
    pub fn new(
        sources: Vec<RockSource>,
        mut energies_j: Vec<f64>,
        mut return_periods_years: Vec<f64>,
    ) -> Self {
        for list in [&mut energies_j, &mut return_periods_years] {
            list.sort_by(f64::total_cmp);
            list.dedup();
        }
        let most = (STRATA / sources.len().max(1)).max(1);
        let of = |(number, source): (usize, &RockSource)| source.law.strata(number, most);
        let strata = sources.iter().enumerate().flat_map(of).collect();
        Self { sources, strata, energies_j, return_periods_years }
    }

    /// The sources.
    pub fn sources(&self) -> &[RockSource] {
        &self.sources
    }

    /// The strata, source by source.
    pub fn strata(&self) -> &[Stratum] {
        &self.strata
    }

    /// Energies whose frequency of exceedance is asked for (J), rising.
    pub fn energies_j(&self) -> &[f64] {
        &self.energies_j
    }

    /// Return periods whose energy is asked for (years), rising.
    pub fn return_periods_years(&self) -> &[f64] {
        &self.return_periods_years
    }

    /// Events a year of all sources together (1/year).
    pub fn per_year(&self) -> f64 {
        self.strata.iter().map(|stratum| stratum.per_year).sum()
    }

    /// Whether the sizes are its own; else they are those of the scene's rocks.
    pub fn draws_volumes(&self) -> bool {
        self.strata.iter().any(|stratum| stratum.volume_m3.is_some())
    }

    /// Number of the stratum of a release.
    pub fn stratum_of(&self, release: usize) -> usize {
        release % self.strata.len().max(1)
    }

    /// The stratum of a release.
    pub fn stratum(&self, release: usize) -> &Stratum {
        &self.strata[self.stratum_of(release)]
    }

    /// Which turn it is of a release within its source: fixed points are taken in turn by it. Every stratum of a source
    /// comes to every point.
    pub fn turn(&self, release: usize) -> usize {
        let stratum = self.stratum_of(release);
        let source = self.strata[stratum].source;
        let first = self.strata.partition_point(|one| one.source < source);
        release / self.strata.len() + (stratum - first)
    }

    /// What each rock of a run of so many releases stands for.
    pub fn weights(&self, releases: usize) -> Weights {
        Weights::of(self, releases)
    }

    /// The same by the rocks of each stratum that count: a stratum's events are shared by those that were released, as a
    /// place without room for a rock says nothing of how far rocks come.
    pub fn weights_of(&self, rocks: Vec<usize>) -> Weights {
        Weights::of_rocks(self, rocks)
    }
}

/// Radius (m) of a sphere of a volume (m³).
pub fn radius_of_m3(volume_m3: f64) -> f64 {
    math::cbrt(0.75 * volume_m3 / std::f64::consts::PI)
}

/// Volume (m³) of a sphere of a radius (m).
pub fn volume_m3(radius_m: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3)
}

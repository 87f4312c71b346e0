//! What each rock of a run stands for.

use super::Frequency;

/// Events a year that a rock of each stratum stands for, in a run of so many releases.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    /// Events a year of each stratum (1/year).
    per_year: Vec<f64>,
    /// Rocks of each stratum.
    rocks: Vec<usize>,
}

impl Weights {
    pub(super) fn of(frequency: &Frequency, releases: usize) -> Self {
        let count = frequency.strata.len();
        let rocks = |stratum| releases / count + usize::from(stratum < releases % count);
        Self::of_rocks(frequency, (0..count).map(rocks).collect())
    }

    pub(super) fn of_rocks(frequency: &Frequency, mut rocks: Vec<usize>) -> Self {
        rocks.resize(frequency.strata.len(), 0);
        let per_year = frequency.strata.iter().map(|stratum| stratum.per_year).collect();
        Self { per_year, rocks }
    }

    /// All alike: one event, whatever the time.
    pub fn equal(releases: usize) -> Self {
        Self { per_year: vec![1.0], rocks: vec![releases] }
    }

    /// The same of a part of a run that has so many releases of each stratum, whatever became of them: a stratum without any in it
    /// stands for nothing there, else shares would be of events that the part says nothing of.
    #[must_use]
    pub fn within(mut self, releases: &[usize]) -> Self {
        for (stratum, per_year) in self.per_year.iter_mut().enumerate() {
            if releases.get(stratum).is_none_or(|of_it| *of_it == 0) {
                *per_year = 0.0;
            }
        }
        self
    }

    /// Whether every rock stands for the same.
    pub fn are_equal(&self) -> bool {
        let counts = |stratum: &usize| self.rocks[*stratum] > 0 || self.per_year[*stratum] > 0.0;
        let mut each = (0..self.rocks.len()).filter(counts).map(|stratum| self.of_stratum(stratum));
        let first = each.next();
        each.all(|weight| Some(weight) == first)
    }

    /// Number of strata.
    pub fn strata(&self) -> usize {
        self.rocks.len()
    }

    /// Stratum of a release.
    pub fn stratum_of(&self, release: usize) -> usize {
        release % self.rocks.len()
    }

    /// Rocks of a stratum.
    pub fn rocks(&self, stratum: usize) -> usize {
        self.rocks[stratum]
    }

    /// Rocks of all strata.
    pub fn all_rocks(&self) -> usize {
        self.rocks.iter().sum()
    }

    /// Events a year of a stratum (1/year).
    pub fn per_year(&self, stratum: usize) -> f64 {
        self.per_year[stratum]
    }

    /// Events a year of all strata (1/year).
    pub fn total_per_year(&self) -> f64 {
        self.per_year.iter().sum()
    }

    /// Events a year that a rock of the stratum stands for (1/year); 0 where there is none.
    pub fn of_stratum(&self, stratum: usize) -> f64 {
        match self.rocks[stratum] {
            0 => 0.0,
            rocks => self.per_year[stratum] / rocks as f64,
        }
    }

    /// Events a year that a release stands for (1/year).
    pub fn of_release(&self, release: usize) -> f64 {
        self.of_stratum(self.stratum_of(release))
    }

    /// The largest of all strata (1/year).
    pub fn heaviest(&self) -> f64 {
        (0..self.rocks.len()).map(|stratum| self.of_stratum(stratum)).fold(0.0, f64::max)
    }

    /// Effective number of rocks `(Σw)²/Σw²` (–): so many of equal weight would say as much of all rocks together.
    pub fn effective_rocks(&self) -> f64 {
        let weighed = |power: i32| -> f64 {
            let one = |stratum| self.rocks[stratum] as f64 * self.of_stratum(stratum).powi(power);
            (0..self.rocks.len()).map(one).sum()
        };
        let squares = weighed(2);
        if squares > 0.0 { weighed(1).powi(2) / squares } else { 0.0 }
    }
}

//! Measured ends of rocks beside computed ones.

mod apart;
mod spread;

pub use apart::EndDistances;
pub use spread::{EndSpread, effective, mean_95, rank};

use super::row::{Row, StopKind};
use super::sample::Sample;
use crate::count::counted;
use crate::error::{Error, Result};
use crate::file::{self, LONGEST_TEXT};
use crate::gis::FARTHEST_M;
use crate::math;
use crate::scene::MeasuredEnds;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A rock's way in plan view, measured or computed (map coordinates).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ObservedPath {
    /// Where it was released (m).
    pub start_m: [f64; 2],
    /// Where it ended (m).
    pub end_m: [f64; 2],
}

/// A way and what it weighs (–).
pub type Weighted = (ObservedPath, f64);

/// Columns that a file of measured ends must have; it may have more.
#[derive(Debug, Deserialize)]
#[expect(clippy::struct_field_names, reason = "the names are those of the columns")]
struct Measured {
    release_x_m: f64,
    release_y_m: f64,
    x_m: f64,
    y_m: f64,
}

/// How far computed ends lie from measured ones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Measured rocks.
    pub measured: usize,
    /// Computed rocks.
    pub computed: usize,
    /// Mean runout measured (m).
    pub measured_mean_m: f64,
    /// Mean runout computed (m).
    #[serde(deserialize_with = "or_nothing")]
    pub computed_mean_m: f64,
    /// Largest difference of the two distributions of runout (–), Kolmogorov and Smirnov.
    pub ks: f64,
    /// The difference that equal distributions exceed in 5 % of all samples (–): `1.36 √((n + m)/(n m))`.
    #[serde(deserialize_with = "or_nothing")]
    pub ks_limit: f64,
    /// Area between the two distributions of runout (m): how far rocks must be moved on average to agree.
    #[serde(deserialize_with = "or_nothing")]
    pub area_m: f64,
    /// Standard deviation of the measured ends across the mean measured direction (m).
    #[serde(deserialize_with = "or_nothing")]
    pub measured_side_m: f64,
    /// The same of the computed ends, across the same direction (m).
    #[serde(deserialize_with = "or_nothing")]
    pub computed_side_m: f64,
    /// Computed rocks that are not among them, as their runout is less than any that was measured can be.
    #[serde(default)]
    pub stayed: usize,
    /// Energy distance of the ends in plan view, block by block ([`EndDistances`], m); only where a fit is scored by it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_m: Option<f64>,
}

/// A number, which JSON has none for what is none.
fn or_nothing<'de, D: serde::Deserializer<'de>>(from: D) -> std::result::Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

impl ObservedPath {
    /// Horizontal distance from release to end (m).
    pub fn runout_m(&self) -> f64 {
        let [x, y] = self.vector_m();
        math::hypot(x, y)
    }

    fn vector_m(&self) -> [f64; 2] {
        [self.end_m[0] - self.start_m[0], self.end_m[1] - self.start_m[1]]
    }

    /// Whether its runout is at least so long (m); none is as short as can be.
    pub fn ran(&self, least_runout_m: Option<f64>) -> bool {
        least_runout_m.is_none_or(|least_m| self.runout_m() >= least_m)
    }

    /// The way of a computed rock; one that failed has no end to compare.
    pub fn of(row: &Row) -> Option<Self> {
        let flat = |[x, y, _]: [f64; 3]| [x, y];
        let has_end = row.stop.is_released() && row.stop != StopKind::Failed;
        has_end.then(|| Self { start_m: flat(row.start_m), end_m: flat(row.end_m) })
    }

    /// Reads measured ways from a CSV file with the columns `release_x_m`, `release_y_m`, `x_m`, `y_m`.
    ///
    /// # Errors
    /// A file that cannot be read, a row without these numbers, or an end nearer to its release than any computed one may be.
    pub fn read(ends: &MeasuredEnds) -> Result<Vec<Self>> {
        Ok(Self::read_lines(ends)?.into_iter().map(|(_, way)| way).collect())
    }

    /// The same, each with its line in the file.
    ///
    /// # Errors
    /// As for [`ObservedPath::read`].
    pub fn read_lines(ends: &MeasuredEnds) -> Result<Vec<(u64, Self)>> {
        let path = ends.file.as_path();
        let table = file::read_table(path, LONGEST_TEXT)?;
        let mut reader = file::table_reader(&table);
        let headers = reader.headers().cloned().unwrap_or_default();
        let way = |row: csv::Result<csv::StringRecord>| {
            let line_of = |position: Option<&csv::Position>| file::line_of(&table, position);
            let row = row.map_err(|why| (line_of(why.position()), why.to_string()))?;
            let line = line_of(row.position());
            let measured = row.deserialize(Some(&headers)).map_err(|why| (line, why.to_string()));
            let way = measured.map(|row: Measured| Self {
                start_m: [row.release_x_m, row.release_y_m],
                end_m: [row.x_m, row.y_m],
            })?;
            // a number that is none, or no place, would go into every mean
            let far = way
                .start_m
                .iter()
                .chain(&way.end_m)
                .find(|m| !(-FARTHEST_M..=FARTHEST_M).contains(*m));
            far.map_or(Ok((line, way)), |m| Err((line, format!("found {m:?}"))))
        };
        let ways: std::result::Result<Vec<(u64, Self)>, (u64, String)> =
            reader.records().map(way).collect();
        let ways = ways.map_err(|(line, found)| {
            let remedy = "write numbers in the columns release_x_m, release_y_m, x_m, y_m, map coordinates within 1e8 m";
            Error::input(path, format!("line {line}"), found, file::table_remedy(&table, remedy))
        })?;
        if ways.len() < 2 {
            let ends = counted(ways.len(), "end", "ends");
            let found = format!("found {} measured {ends}", ways.len());
            return Err(Error::input(path, "rows", found, "write at least two"));
        }
        if let Some((line, way)) = ways.iter().find(|(_, way)| !way.ran(ends.least_runout_m)) {
            let found = format!("found an end {:.2} m from its release", way.runout_m());
            let remedy = "write a smaller least_runout_m in [calibrate], which is for lists without such ends";
            return Err(Error::input(path, format!("line {line}"), found, remedy));
        }
        Ok(ways)
    }
}

/// The column that tells which throws are of one block.
#[derive(Debug, Deserialize)]
struct BlockColumn {
    #[serde(alias = "block_id")]
    block: String,
}

impl ObservedPath {
    /// The block of each measured end, from the column `block` or `block_id`; empty where there is none.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read_blocks(path: &Path) -> Result<Vec<String>> {
        let table = file::read_table(path, LONGEST_TEXT)?;
        let rows = file::table_reader(&table).into_deserialize();
        let blocks = rows.map(|row: csv::Result<BlockColumn>| row.ok().map(|thrown| thrown.block));
        Ok(blocks.collect::<Option<_>>().unwrap_or_default())
    }
}

impl Agreement {
    /// Agreements on several slopes as one: means by the number of measured rocks; none of none.
    pub fn joined(each: &[Self]) -> Option<Self> {
        let [first, rest @ ..] = each else { return None };
        if rest.is_empty() {
            return Some(*first);
        }
        let measured: usize = each.iter().map(|one| one.measured).sum();
        let mean = |of: fn(&Self) -> f64| {
            let weighted = each.iter().map(|one| one.measured as f64 * of(one));
            weighted.sum::<f64>() / measured as f64
        };
        Some(Self {
            measured,
            computed: each.iter().map(|one| one.computed).sum(),
            measured_mean_m: mean(|one| one.measured_mean_m),
            computed_mean_m: mean(|one| one.computed_mean_m),
            ks: mean(|one| one.ks),
            ks_limit: mean(|one| one.ks_limit),
            area_m: mean(|one| one.area_m),
            measured_side_m: mean(|one| one.measured_side_m),
            computed_side_m: mean(|one| one.computed_side_m),
            stayed: each.iter().map(|one| one.stayed).sum(),
            ends_m: first.ends_m.map(|_| mean(|one| one.ends_m.unwrap_or(f64::NAN))),
        })
    }

    /// The limit of [`Self::ks_limit`] for measured ends that are worth so many independent ones: throws of one block are alike.
    pub fn ks_limit_worth(&self, worth: f64) -> f64 {
        let both = (self.ks_limit / KOLMOGOROV_95).powi(2);
        KOLMOGOROV_95
            * (both - 1.0 / self.measured as f64 + 1.0 / worth).clamp(0.0, f64::INFINITY).sqrt()
    }

    /// Compares measured and computed ways; none if either is empty.
    pub fn of(measured: &[ObservedPath], computed: &[ObservedPath]) -> Option<Self> {
        let computed: Vec<Weighted> = computed.iter().map(|way| (*way, 1.0)).collect();
        Self::of_weighted(measured, &computed)
    }

    /// Of measured ways beside none that were computed: as far apart as can be, by means that are no numbers.
    pub fn of_nothing(measured: &[ObservedPath]) -> Self {
        let even: Vec<Weighted> = measured.iter().map(|way| (*way, 1.0)).collect();
        let sum: f64 = measured.iter().map(ObservedPath::runout_m).sum();
        Self {
            measured: measured.len(),
            computed: 0,
            measured_mean_m: sum / measured.len() as f64,
            computed_mean_m: f64::NAN,
            ks: 1.0,
            ks_limit: f64::NAN,
            area_m: f64::NAN,
            measured_side_m: EndSpread::of(&even, mean_direction(measured)).across_m(),
            computed_side_m: f64::NAN,
            stayed: 0,
            ends_m: None,
        }
    }

    /// The same where computed ways weigh what they stand for; measured ones stand for one end each. The limit is that of as many
    /// computed ways of equal weight as would know as much, `(Σ w)² / Σ w²` (Kish 1965).
    pub fn of_events(measured: &[ObservedPath], computed: &[Weighted]) -> Option<Self> {
        let found = Self::of_weighted(measured, computed)?;
        let runouts = runouts(computed).into_iter();
        let (n, m) = (found.measured as f64, Sample::weighted(runouts).effective_rocks());
        Some(Self { ks_limit: ks_limit(n, m), ..found })
    }

    /// The same where computed ways weigh unlike (–): those of weight 0 take no part.
    pub fn of_weighted(measured: &[ObservedPath], computed: &[Weighted]) -> Option<Self> {
        let even: Vec<Weighted> = measured.iter().map(|way| (*way, 1.0)).collect();
        let (one, other) = (runouts(&even), runouts(computed));
        let (n, m) = (one.len() as f64, other.len() as f64);
        let mean = |runouts: &[(f64, f64)]| {
            let weight: f64 = runouts.iter().map(|(_, weight)| weight).sum();
            let sum: f64 = runouts.iter().map(|(runout, weight)| runout * weight).sum();
            (!runouts.is_empty()).then(|| sum / weight)
        };
        let (measured_mean_m, computed_mean_m) = (mean(&one)?, mean(&other)?);
        let (ks, area_m) = distances(&one, &other);
        let along = mean_direction(measured);
        Some(Self {
            measured: one.len(),
            computed: other.len(),
            measured_mean_m,
            computed_mean_m,
            ks,
            ks_limit: ks_limit(n, m),
            area_m,
            measured_side_m: EndSpread::of(&even, along).across_m(),
            computed_side_m: EndSpread::of(computed, along).across_m(),
            stayed: 0,
            ends_m: None,
        })
    }
}

/// Largest difference of one distribution from its own sample, times √n, which is exceeded in 5 % of all samples (Kolmogorov
/// 1933).
pub const KOLMOGOROV_95: f64 = 1.36;

/// Difference of two distributions of so many values each that equal ones exceed in 5 % of all samples (–).
pub fn ks_limit(n: f64, m: f64) -> f64 {
    KOLMOGOROV_95 * ((n + m) / (n * m)).sqrt()
}

/// Runouts (m) and weights, ascending; what weighs nothing or is no number is left out.
pub fn runouts(ways: &[Weighted]) -> Vec<(f64, f64)> {
    let runouts = ways.iter().map(|(way, weight)| (way.runout_m(), *weight));
    let mut sorted: Vec<(f64, f64)> =
        runouts.filter(|(runout, weight)| runout.is_finite() && *weight > 0.0).collect();
    sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
    sorted
}

/// Largest difference (–) of two empirical distributions, and the area between them (unit of the values), from sorted
/// values with weights.
pub fn distances(one: &[(f64, f64)], other: &[(f64, f64)]) -> (f64, f64) {
    let total = |values: &[(f64, f64)]| -> f64 { values.iter().map(|(_, weight)| weight).sum() };
    let (whole_one, whole_other) = (total(one), total(other));
    let (mut i, mut j, mut below_one, mut below_other) = (0, 0, 0.0, 0.0);
    let (mut largest, mut area, mut before) = (0.0_f64, 0.0, None);
    while i < one.len() || j < other.len() {
        let next = |values: &[(f64, f64)], at: usize| values.get(at).map_or(f64::INFINITY, |v| v.0);
        let x = next(one, i).min(next(other, j));
        let gap = (below_one / whole_one - below_other / whole_other).abs();
        area += before.map_or(0.0, |before| gap * (x - before));
        while next(one, i) <= x && i < one.len() {
            below_one += one[i].1;
            i += 1;
        }
        while next(other, j) <= x && j < other.len() {
            below_other += other[j].1;
            j += 1;
        }
        largest = largest.max((below_one / whole_one - below_other / whole_other).abs());
        before = Some(x);
    }
    (largest, area)
}

/// Unit vector of the mean way.
fn mean_direction(ways: &[ObservedPath]) -> [f64; 2] {
    let sum =
        ways.iter().map(ObservedPath::vector_m).fold([0.0, 0.0], |s, v| [s[0] + v[0], s[1] + v[1]]);
    let length = math::hypot(sum[0], sum[1]).max(f64::MIN_POSITIVE);
    [sum[0] / length, sum[1] / length]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ways(runouts: &[f64]) -> Vec<ObservedPath> {
        let way = |r: &f64| ObservedPath { start_m: [5.0, 5.0], end_m: [5.0, 5.0 + r] };
        runouts.iter().map(way).collect()
    }

    /// By hand: of 1, 2, 3, 4 and 3, 4, 5, 6 the curves are half apart between 2 and 5; moving each by 2 m makes them
    /// equal.
    #[test]
    fn distances_of_two_small_samples_are_those_found_by_hand() {
        let found =
            Agreement::of(&ways(&[1.0, 2.0, 3.0, 4.0]), &ways(&[6.0, 5.0, 4.0, 3.0])).unwrap();
        assert!((found.ks - 0.5).abs() < 1e-15);
        assert!((found.area_m - 2.0).abs() < 1e-15);
        assert!((found.computed_mean_m - 4.5).abs() < 1e-15);
        assert!(found.computed_side_m.abs() < 1e-12);
        assert!((found.ks_limit - 1.36 * 0.5_f64.sqrt()).abs() < 1e-15);
    }

    /// By hand: of 10 ends that stand for 9 events and one that stands for 90, the runouts 1 and 5 m have the mean 4.64 m, and
    /// the 11 ends are as precise as 99²/(10 · 0.81 + 90²) = 1.21 of equal weight.
    #[test]
    fn ends_that_stand_for_more_events_count_for_more() {
        let computed: Vec<Weighted> = ways(&[[1.0; 10].as_slice(), &[5.0]].concat())
            .into_iter()
            .enumerate()
            .map(|(at, way)| (way, if at < 10 { 0.9 } else { 90.0 }))
            .collect();
        let found = Agreement::of_events(&ways(&[1.0, 1.0, 5.0, 5.0]), &computed).unwrap();
        assert!((found.computed_mean_m - 459.0 / 99.0).abs() < 1e-12);
        assert!((found.ks - (0.5 - 9.0 / 99.0)).abs() < 1e-12 && found.computed == 11);
        let worth = 99.0 * 99.0 / (10.0 * 0.81 + 8100.0);
        assert!((found.ks_limit - 1.36 * (0.25_f64 + 1.0 / worth).sqrt()).abs() < 1e-12);
    }

    /// By hand: 80 ends worth 14 beside 960 have the limit 1.36 √(1/14 + 1/960) = 0.366, not 1.36 √(1/80 + 1/960) = 0.158.
    #[test]
    fn the_limit_is_that_of_independent_ends() {
        let some = |n: usize| ways(&(1..=n).map(|k| k as f64).collect::<Vec<_>>());
        let found = Agreement::of(&some(80), &some(960)).unwrap();
        assert!((found.ks_limit - 0.158).abs() < 5e-4);
        assert!((found.ks_limit_worth(14.0) - 0.366).abs() < 5e-4);
        assert!((found.ks_limit_worth(80.0) - found.ks_limit).abs() < 1e-12);
    }

    /// A computed end that weighs twice is two computed ends, and one that weighs nothing is none.
    #[test]
    fn weights_are_numbers_of_ends() {
        let (measured, twice) = (ways(&[1.0, 2.0, 4.0]), ways(&[3.0, 3.0, 5.0]));
        let weighted: Vec<Weighted> =
            ways(&[9.0, 3.0, 5.0]).into_iter().zip([0.0, 2.0, 1.0]).collect();
        let one = Agreement::of(&measured, &twice).unwrap();
        let other = Agreement::of_weighted(&measured, &weighted).unwrap();
        assert!((one.ks - other.ks).abs() < 1e-15 && (one.area_m - other.area_m).abs() < 1e-15);
        assert!((one.computed_mean_m - other.computed_mean_m).abs() < 1e-15);
        assert_eq!(other.computed, 2);
    }
}

//! How far computed ends lie from measured ones, as numbers.

use super::distance::{KOLMOGOROV_95, RunoutDistances, ks_limit, runouts};
use super::{EndSpread, ObservedPath, Weighted, mean_direction};
use crate::hazard::row::StopKind;
use crate::hazard::sample::Sample;
use serde::{Deserialize, Serialize};

/// How far computed ends lie from measured ones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Measured rocks.
    pub measured: usize,
    /// Computed rocks.
    pub computed: usize,
    /// Mean runout measured (m).
    pub measured_mean_m: f64,
    /// Mean runout computed (m), of open rocks as far as they were seen: the least that it can be.
    #[serde(deserialize_with = "or_nothing")]
    pub computed_mean_m: f64,
    /// Largest difference of the two distributions of runout (–), Kolmogorov and Smirnov: the least that it can be, however open rocks would have ended.
    pub ks: f64,
    /// The most that it can be; none where open rocks leave nothing open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ks_most: Option<f64>,
    /// The difference that equal distributions exceed in 5 % of all samples (–): `1.36 √((n + m)/(n m))`.
    #[serde(deserialize_with = "or_nothing")]
    pub ks_limit: f64,
    /// Area between the two distributions of runout (m): how far rocks must be moved on average to agree, at least.
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
    /// Computed rocks among them that left the terrain: where they would have ended is not known.
    #[serde(default, skip_serializing_if = "is_none")]
    pub left_terrain: usize,
    /// Computed rocks among them that were still moving when their time or budget of work was up.
    #[serde(default, skip_serializing_if = "is_none")]
    pub still_moving: usize,
    /// Energy distance of the ends in plan view, block by block ([`EndDistances`](super::EndDistances), m); only where a fit is scored by it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_m: Option<f64>,
    /// The most that it comes to for the ends that open rocks may have ([`OpenEnds`](super::OpenEnds)); none where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_most_m: Option<f64>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes it so")]
fn is_none(count: &usize) -> bool {
    *count == 0
}

/// A number, which JSON has none for what is none.
fn or_nothing<'de, D: serde::Deserializer<'de>>(from: D) -> std::result::Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
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
        let sum = |of: fn(&Self) -> usize| each.iter().map(of).sum();
        Some(Self {
            measured,
            computed: sum(|one| one.computed),
            measured_mean_m: mean(|one| one.measured_mean_m),
            computed_mean_m: mean(|one| one.computed_mean_m),
            ks: mean(|one| one.ks),
            ks_limit: mean(|one| one.ks_limit),
            area_m: mean(|one| one.area_m),
            measured_side_m: mean(|one| one.measured_side_m),
            computed_side_m: mean(|one| one.computed_side_m),
            ks_most: each.iter().any(|one| one.ks_most.is_some()).then(|| mean(Self::ks_at_most)),
            stayed: sum(|one| one.stayed),
            left_terrain: sum(|one| one.left_terrain),
            still_moving: sum(|one| one.still_moving),
            ends_m: first.ends_m.map(|_| mean(|one| one.ends_m.unwrap_or(f64::NAN))),
            ends_most_m: each
                .iter()
                .any(|one| one.ends_most_m.is_some())
                .then(|| mean(|one| one.ends_at_most_m().unwrap_or(f64::NAN))),
        })
    }

    /// Computed rocks that would have gone on.
    pub fn open(&self) -> usize {
        self.left_terrain + self.still_moving
    }

    /// The most that the KS distance can be (–), however they would have ended.
    pub fn ks_at_most(&self) -> f64 {
        self.ks_most.unwrap_or(self.ks)
    }

    /// The most that the energy distance comes to for the ends that they may have (m); none where a fit is not scored by it.
    pub fn ends_at_most_m(&self) -> Option<f64> {
        self.ends_most_m.or(self.ends_m)
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
            ks_most: None,
            ks_limit: f64::NAN,
            area_m: f64::NAN,
            measured_side_m: EndSpread::of(&even, mean_direction(measured)).across_m(),
            computed_side_m: f64::NAN,
            stayed: 0,
            left_terrain: 0,
            still_moving: 0,
            ends_m: None,
            ends_most_m: None,
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
        let RunoutDistances { ks: [ks, most], area_m } = RunoutDistances::of(&even, computed)?;
        let among =
            computed.iter().filter(|(way, weight)| *weight > 0.0 && way.runout_m().is_finite());
        let [open, left] = among.fold([0, 0], |[open, left], (way, _)| {
            let has_left = way.open == Some(StopKind::LeftTerrain);
            [open + usize::from(way.open.is_some()), left + usize::from(has_left)]
        });
        let along = mean_direction(measured);
        Some(Self {
            measured: one.len(),
            computed: other.len(),
            measured_mean_m,
            computed_mean_m,
            ks,
            ks_most: (most > ks).then_some(most),
            ks_limit: ks_limit(n, m),
            area_m,
            measured_side_m: EndSpread::of(&even, along).across_m(),
            computed_side_m: EndSpread::of(computed, along).across_m(),
            stayed: 0,
            left_terrain: left,
            still_moving: open - left,
            ends_m: None,
            ends_most_m: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ways(runouts: &[f64]) -> Vec<ObservedPath> {
        let way = |r: &f64| ObservedPath { start_m: [5.0, 5.0], end_m: [5.0, 5.0 + r], open: None };
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

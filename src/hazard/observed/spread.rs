//! Where ends lie and how they spread, measured beside computed.

use super::{ObservedPath, Weighted, mean_direction, runouts};
use crate::math;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Ends of one set of rocks along and across a direction.
#[derive(Debug)]
pub struct EndSpread {
    mean_m: [f64; 2],
    sd_m: [f64; 2],
}

impl EndSpread {
    /// Distance between the middles of measured and computed ends.
    pub const OFFSET: &str = "offset of the centroid (m)";
    /// How much of the computed lies farther than all that was measured.
    pub const BEYOND: &str = "share past the farthest measured (–)";

    /// Figures of measured and computed ways: what, of the measured, of the computed.
    pub fn figures(
        measured: &[ObservedPath],
        computed: &[Weighted],
    ) -> Vec<(&'static str, f64, f64)> {
        let along = mean_direction(measured);
        let measured: Vec<Weighted> = measured.iter().map(|way| (*way, 1.0)).collect();
        let [one, two] = [&measured, computed].map(|ways| Self::of(ways, along));
        let [near, far] = [&measured, computed].map(runouts);
        let total =
            |runouts: &[(f64, f64)]| runouts.iter().fold(0.0, |sum, (_, weight)| sum + weight);
        let mean = |runouts: &[(f64, f64)]| {
            runouts.iter().map(|(runout, weight)| runout * weight).sum::<f64>() / total(runouts)
        };
        let offset_m = math::hypot(two.mean_m[0] - one.mean_m[0], two.mean_m[1] - one.mean_m[1]);
        let farthest_m = near.last().map_or(f64::NAN, |(runout, _)| *runout);
        let beyond = &far[far.partition_point(|(runout, _)| *runout <= farthest_m)..];
        vec![
            ("mean runout (m)", mean(&near), mean(&far)),
            (Self::OFFSET, 0.0, offset_m),
            ("standard deviation along (m)", one.sd_m[0], two.sd_m[0]),
            ("standard deviation across (m)", one.sd_m[1], two.sd_m[1]),
            (Self::BEYOND, 0.0, total(beyond) / total(&far)),
        ]
    }

    /// From the middle of measured ends to that of computed ones, on the map (m).
    pub fn offset_m(measured: &[ObservedPath], computed: &[Weighted]) -> [f64; 2] {
        let measured: Vec<Weighted> = measured.iter().map(|way| (*way, 1.0)).collect();
        let [one, two] = [&measured, computed].map(|ways| Self::of(ways, [1.0, 0.0]).mean_m);
        [two[0] - one[0], two[1] - one[1]]
    }

    /// Where weighted ends lie along and across a direction.
    pub(super) fn of(ways: &[Weighted], [x, y]: [f64; 2]) -> Self {
        let turned = |(way, weight): &Weighted| {
            let [dx, dy] = way.vector_m();
            ([x * dx + y * dy, x * dy - y * dx], *weight)
        };
        let is_there = |(at, weight): &([f64; 2], f64)| {
            *weight > 0.0 && at.iter().all(|along| along.is_finite())
        };
        let all: Vec<([f64; 2], f64)> = ways.iter().map(turned).filter(is_there).collect();
        let sum = |of: &dyn Fn(&[f64; 2]) -> f64| -> f64 {
            all.iter().map(|(at, weight)| weight * of(at)).sum()
        };
        let whole = sum(&|_| 1.0);
        let mean_m = [0, 1].map(|axis| sum(&|at| at[axis]) / whole);
        // of n ends that weigh alike the variance of the sample, over n − 1
        let free = whole * (1.0 - 1.0 / all.len() as f64);
        let sd_m = [0, 1].map(|axis| (sum(&|at| (at[axis] - mean_m[axis]).powi(2)) / free).sqrt());
        Self { mean_m, sd_m }
    }

    /// Standard deviation across the direction (m).
    pub(super) fn across_m(&self) -> f64 {
        self.sd_m[1]
    }
}

/// Share of computed runouts below a measured one (–), those equal to it by half; none of none.
pub fn rank(measured: &ObservedPath, computed: &[ObservedPath]) -> Option<f64> {
    let own_m = measured.runout_m();
    let below = |way: &ObservedPath| match way.runout_m().total_cmp(&own_m) {
        Ordering::Less => 1.0,
        Ordering::Equal => 0.5,
        Ordering::Greater => 0.0,
    };
    let sum: f64 = computed.iter().map(below).sum();
    (!computed.is_empty()).then(|| sum / computed.len() as f64)
}

/// Independent values that values in groups are worth: `n / (1 + (m̄ − 1) ρ)` with the intraclass correlation ρ of a
/// one-way analysis of variance (Donner and Koval 1980) and the mean size m̄ of a group. All of them without groups.
pub fn effective(values: &[f64], groups: &[String]) -> f64 {
    let n = values.len() as f64;
    let mut sets: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for (value, group) in values.iter().zip(groups) {
        sets.entry(group).or_default().push(*value);
    }
    let k = sets.len() as f64;
    if groups.len() != values.len() || k < 2.0 || k >= n {
        return n;
    }
    let mean = |set: &[f64]| set.iter().sum::<f64>() / set.len() as f64;
    let whole = mean(values);
    let among =
        sets.values().map(|set| set.len() as f64 * (mean(set) - whole).powi(2)).sum::<f64>();
    let within = |set: &Vec<f64>| set.iter().map(|value| (value - mean(set)).powi(2)).sum::<f64>();
    let (among, within) = (among / (k - 1.0), sets.values().map(within).sum::<f64>() / (n - k));
    let squares = sets.values().map(|set| (set.len() as f64).powi(2)).sum::<f64>();
    let typical = (n - squares / n) / (k - 1.0);
    let alike = ((among - within) / (among + (typical - 1.0) * within)).clamp(0.0, 1.0);
    // no value is worth less than its group
    (n / (1.0 + (n / k - 1.0) * alike)).max(k)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(sizes: &[usize]) -> Vec<String> {
        let each = sizes.iter().enumerate();
        each.flat_map(|(group, size)| vec![group.to_string(); *size]).collect()
    }

    /// Groups whose values are all alike are worth one each; groups that spread like the whole are worth all.
    #[test]
    fn groups_are_worth_what_they_differ_within() {
        let alike = [1.0, 1.0, 1.0, 5.0, 5.0, 5.0, 9.0, 9.0];
        assert!((effective(&alike, &groups(&[3, 3, 2])) - 3.0).abs() < 1e-12);
        let mixed = [1.0, 5.0, 9.0, 1.0, 5.0, 9.0, 1.0, 9.0];
        assert!((effective(&mixed, &groups(&[3, 3, 2])) - 8.0).abs() < 1e-12);
        assert!((effective(&mixed, &[]) - 8.0).abs() < 1e-12);
    }

    /// By hand: ends at 10 and 20 m north, computed 3 m further east and 4 m further north, one of them beyond.
    #[test]
    fn figures_are_those_found_by_hand() {
        let way = |x: f64, y: f64| ObservedPath { start_m: [1.0, 1.0], end_m: [1.0 + x, 1.0 + y] };
        let figures = EndSpread::figures(
            &[way(0.0, 10.0), way(0.0, 20.0)],
            &[(way(3.0, 14.0), 1.0), (way(3.0, 24.0), 1.0)],
        );
        let value = |what: &str| figures.iter().find(|f| f.0.starts_with(what)).unwrap();
        assert!((value("offset").2 - 5.0).abs() < 1e-12);
        assert!((value("standard deviation along").1 - 50.0_f64.sqrt()).abs() < 1e-12);
        assert!(value("standard deviation across").2.abs() < 1e-12);
        assert!((value("share past").2 - 0.5).abs() < 1e-12);
        let computed = [way(0.0, 5.0), way(0.0, 10.0), way(0.0, 15.0), way(0.0, 30.0)];
        assert_eq!(rank(&way(0.0, 10.0), &computed), Some(0.375));
        assert_eq!(rank(&way(0.0, 10.0), &[]), None);
    }
}
